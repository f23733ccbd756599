//! Lanes in plain Rust.

#![allow(unsafe_code, reason = "rows that several threads change at once, each its own")]

use super::{Lanes, Line, Row, SharedRows, Source, WRITABLE};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Lanes in plain Rust, for any machine; the reference for all others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable<const N: usize>([f32; N]);

impl<const N: usize> Portable<N> {
    #[inline(always)]
    fn zip(self, other: Self, with: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|lane| with(self.0[lane], other.0[lane])))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $operator:tt) => {
        impl<const N: usize> $trait for Portable<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |one, other| one $operator other)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<const N: usize> Neg for Portable<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl<const N: usize> Lanes for Portable<N> {
    const WIDTH: usize = N;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; N])
    }

    #[inline(always)]
    fn load(line: &Line, part: usize) -> Self {
        let mut values = [0.0; N];
        values.copy_from_slice(&line.0[part * N..(part + 1) * N]);
        Self(values)
    }

    #[inline(always)]
    fn store(self, line: &mut Line, part: usize) {
        line.0[part * N..(part + 1) * N].copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }

    #[inline(always)]
    fn select_greater(left: Self, right: Self, [yes, no]: [Self; 2]) -> Self {
        let choose = |lane: usize| if left.0[lane] > right.0[lane] { yes.0[lane] } else { no.0[lane] };
        Self(std::array::from_fn(choose))
    }

    #[inline(always)]
    fn gather(rows: impl Source, indices: &[u32]) -> [Self; 8] {
        let mut columns = [Self([0.0; N]); 8];
        for (lane, &index) in indices[..N].iter().enumerate() {
            // SAFETY: a source's rows can be read; no other thread writes to those of this bundle.
            let row = unsafe { *rows.at(index) };
            for (column, value) in columns.iter_mut().zip(row.0) {
                column.0[lane] = value;
            }
        }
        columns
    }

    #[inline(always)]
    fn scatter(columns: [Self; 8], rows: SharedRows<'_>, indices: &[u32]) {
        for (lane, &index) in indices[..N].iter().enumerate() {
            if columns[WRITABLE].0[lane] != 0.0 {
                // SAFETY: what is writable is this bundle's alone.
                unsafe { *rows.at_mut(index) = Row(columns.map(|column| column.0[lane])) };
            }
        }
    }
}
