//! Lanes: one instruction for several numbers.
//!
//! Kernels are written once against [`Lanes`] and compiled for each implementation of it. Only `+ − × ÷ √`, comparison and
//! selection are offered, all of them exact to the last bit in IEEE arithmetic: lanes never see each other, so
//! that the width changes nothing but the speed.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Contacts in a bundle.
pub(crate) const LANES: usize = 8;

/// One number for each contact of a bundle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Line(pub [f32; LANES]);

impl Line {
    pub const ZERO: Line = Line([0.0; LANES]);
}

/// Eight numbers of one body, gathered and scattered together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(32))]
pub(crate) struct Row(pub [f32; 8]);

impl Row {
    pub const ZERO: Row = Row([0.0; 8]);
}

/// A row is written back only where this number of it is not zero: nothing moves the world and what is driven.
pub(crate) const WRITABLE: usize = 7;

/// Several numbers in step.
pub(crate) trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// How many; divides [`LANES`].
    const WIDTH: usize;

    /// The same number everywhere.
    fn splat(value: f32) -> Self;

    /// Part number `part` of a line, of [`LANES`]` / WIDTH`.
    fn load(line: &Line, part: usize) -> Self;

    /// Writes part number `part` of a line.
    fn store(self, line: &mut Line, part: usize);

    fn sqrt(self) -> Self;

    /// `self` where it is greater, else `other`.
    fn max(self, other: Self) -> Self {
        Self::select_greater(self, other, [self, other])
    }

    /// `self` where it is less, else `other`.
    fn min(self, other: Self) -> Self {
        Self::select_greater(other, self, [self, other])
    }

    /// The first of `choices` where `left > right`, else the second.
    fn select_greater(left: Self, right: Self, choices: [Self; 2]) -> Self;

    /// Column by column, the rows that `indices` names.
    fn gather(rows: &[Row], indices: &[u32]) -> [Self; 8];

    /// Writes columns back into the rows that `indices` names, where they are writable.
    fn scatter(columns: [Self; 8], rows: &mut [Row], indices: &[u32]);
}

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
    fn gather(rows: &[Row], indices: &[u32]) -> [Self; 8] {
        let mut columns = [Self([0.0; N]); 8];
        for lane in 0..N {
            let row = &rows[indices[lane] as usize];
            for (column, value) in columns.iter_mut().zip(row.0) {
                column.0[lane] = value;
            }
        }
        columns
    }

    #[inline(always)]
    fn scatter(columns: [Self; 8], rows: &mut [Row], indices: &[u32]) {
        for lane in 0..N {
            if columns[WRITABLE].0[lane] != 0.0 {
                rows[indices[lane] as usize] = Row(columns.map(|column| column.0[lane]));
            }
        }
    }
}

/// A vector in each lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector<L> {
    pub x: L,
    pub y: L,
    pub z: L,
}

impl<L: Lanes> Vector<L> {
    #[inline(always)]
    pub fn new(x: L, y: L, z: L) -> Self {
        Self { x, y, z }
    }

    #[inline(always)]
    pub fn dot(self, other: Self) -> L {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub fn scaled(self, by: L) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }
}

impl<L: Lanes> Add for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Lanes> Sub for Vector<L> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

/// A symmetric tensor in each lane: xx, xy, xz, yy, yz, zz.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tensor<L>(pub [L; 6]);

impl<L: Lanes> Tensor<L> {
    #[inline(always)]
    pub fn times(&self, v: Vector<L>) -> Vector<L> {
        let [xx, xy, xz, yy, yz, zz] = self.0;
        Vector {
            x: xx * v.x + xy * v.y + xz * v.z,
            y: xy * v.x + yy * v.y + yz * v.z,
            z: xz * v.x + yz * v.y + zz * v.z,
        }
    }
}
