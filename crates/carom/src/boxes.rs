//! Eight boxes, axis by axis side by side, so that a query is compared with four of them at once: what trees of boxes are made of.
//!
//! They are in single precision, relative to an origin near them: both rounding and the change of origin keep the order of numbers, so that
//! boxes that meet still do.
//!
//! Reference: Dammertz, Hanika and Keller, *Shallow bounding volume hierarchies for fast SIMD ray tracing* (2008).

use crate::math::DVec3;
use glam::{Vec3, Vec4};

/// How many boxes are side by side.
pub(crate) const WIDTH: usize = 8;

/// A box relative to an origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Local {
    pub low: Vec3,
    pub high: Vec3,
}

impl Local {
    pub const NOTHING: Local = Local { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    /// The box from `low` to `high` (m) as it is seen from `origin`.
    pub fn new((low, high): (DVec3, DVec3), origin: DVec3) -> Self {
        Self { low: (low - origin).as_vec3(), high: (high - origin).as_vec3() }
    }

    pub fn contains(&self, other: &Local) -> bool {
        self.low.cmple(other.low).all() && self.high.cmpge(other.high).all()
    }
}

/// A box to look for, each bound four times.
pub(crate) struct Query {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

impl Query {
    pub fn new(bounds: Local) -> Self {
        let four = |bounds: Vec3| bounds.to_array().map(Vec4::splat);
        Self { low: four(bounds.low), high: four(bounds.high) }
    }
}

/// Eight boxes; those that are not set hold nothing.
#[derive(Clone, Debug)]
pub(crate) struct Boxes {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
}

impl Boxes {
    pub const NOTHING: Boxes =
        Boxes { low: [[f32::INFINITY; WIDTH]; 3], high: [[f32::NEG_INFINITY; WIDTH]; 3] };

    pub fn get(&self, slot: usize) -> Local {
        let of = |bounds: &[[f32; WIDTH]; 3]| Vec3::from_array([0, 1, 2].map(|axis| bounds[axis][slot]));
        Local { low: of(&self.low), high: of(&self.high) }
    }

    pub fn set(&mut self, slot: usize, bounds: Local) {
        for axis in 0..3 {
            self.low[axis][slot] = bounds.low[axis];
            self.high[axis][slot] = bounds.high[axis];
        }
    }

    /// The box around all.
    pub fn whole(&self) -> Local {
        // Free slots hold nothing and change nothing.
        let fours = |bounds: &[f32; WIDTH]| [Vec4::from_slice(&bounds[..4]), Vec4::from_slice(&bounds[4..])];
        let least = |bounds: &[f32; WIDTH]| {
            let [one, other] = fours(bounds);
            one.min(other).min_element()
        };
        let most = |bounds: &[f32; WIDTH]| {
            let [one, other] = fours(bounds);
            one.max(other).max_element()
        };
        let (low, high) = (self.low.each_ref().map(least), self.high.each_ref().map(most));
        Local { low: Vec3::from_array(low), high: Vec3::from_array(high) }
    }

    /// A bit for each of the first `count` boxes that meets the query.
    pub fn meeting(&self, query: &Query, count: usize) -> u32 {
        let four = |from: usize| {
            let lanes = |bounds: &[f32; WIDTH]| Vec4::from_slice(&bounds[from..from + 4]);
            let along = |axis: usize| {
                lanes(&self.low[axis]).cmple(query.high[axis])
                    & lanes(&self.high[axis]).cmpge(query.low[axis])
            };
            (along(0) & along(1) & along(2)).bitmask()
        };
        // A query without an end meets free slots, too.
        (four(0) | four(4) << 4) & ((1 << count) - 1)
    }

    /// Which of the first `count` boxes has to grow least to take another one in; of several the smallest.
    pub fn roomiest(&self, bounds: &Local, count: usize) -> usize {
        let mut growth = [0.0_f32; WIDTH];
        let mut size = [0.0_f32; WIDTH];
        for axis in 0..3 {
            let (low, high) = (bounds.low[axis], bounds.high[axis]);
            for slot in 0..WIDTH {
                let (least, most) = (self.low[axis][slot], self.high[axis][slot]);
                growth[slot] += (most.max(high) - most) + (least - least.min(low));
                size[slot] += most - least;
            }
        }
        let mut best = 0;
        for slot in 1..count {
            if (growth[slot], size[slot]) < (growth[best], size[best]) {
                best = slot;
            }
        }
        best
    }
}
