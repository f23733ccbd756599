//! Lanes: one instruction for several numbers.
//!
//! Kernels are written once against [`Lanes`] and compiled for each implementation of it. Only `+ − × ÷ √`, comparison and
//! selection are offered, all of them exact to the last bit in IEEE arithmetic: lanes never see each other, so
//! that the width changes nothing but the speed. This file and its folder alone know instruction sets:
//!
//! ```text
//! lanes/machine.rs   which instructions there are, and the one way into them
//! lanes/portable.rs  lanes in plain Rust, the reference
//! lanes/x86.rs       SSE2, AVX2, AVX-512
//! ```

mod machine;
mod portable;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use machine::InstructionSet;
pub(crate) use machine::{Kernel, Machine};
pub(crate) use portable::Portable;

use super::rows::{SharedRows, Source};
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

    /// Has the machine bring lines near that will be read soon, where it can be told to. Changes no number.
    fn bring_near(_lines: &[Line]) {}

    /// Column by column, the rows that `indices` names.
    fn gather(rows: impl Source, indices: &[u32]) -> [Self; 8];

    /// Writes columns back into the rows that `indices` names, where they are writable.
    fn scatter(columns: [Self; 8], rows: SharedRows<'_>, indices: &[u32]);
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

    /// Times (x, y, 0).
    #[inline(always)]
    pub fn times_across(&self, [x, y]: [L; 2]) -> Vector<L> {
        let [xx, xy, xz, yy, yz, _] = self.0;
        Vector { x: xx * x + xy * y, y: xy * x + yy * y, z: xz * x + yz * y }
    }
}

#[cfg(test)]
mod tests;
