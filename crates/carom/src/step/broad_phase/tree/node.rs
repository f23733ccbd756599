//! A node: eight boxes, axis by axis side by side.

use glam::{Vec3, Vec4};

/// Boxes of a node.
pub const WIDTH: usize = 8;

/// No node, no leaf.
pub const NONE: u32 = u32::MAX;

/// A box relative to the tree's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Local {
    pub low: Vec3,
    pub high: Vec3,
}

impl Local {
    pub const NOTHING: Local = Local { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    pub fn contains(&self, other: &Local) -> bool {
        self.low.cmple(other.low).all() && self.high.cmpge(other.high).all()
    }
}

/// A box to look for, each bound four times.
pub struct Query {
    low: [Vec4; 3],
    high: [Vec4; 3],
}

impl Query {
    pub fn new(bounds: Local) -> Self {
        let four = |bounds: Vec3| bounds.to_array().map(Vec4::splat);
        Self { low: four(bounds.low), high: four(bounds.high) }
    }
}

/// What it holds are leaves' keys or other nodes.
#[derive(Clone)]
pub struct Node {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    pub children: [u32; WIDTH],
    pub count: usize,
    pub parent: u32,
    pub holds_leaves: bool,
}

impl Node {
    pub fn new(holds_leaves: bool) -> Self {
        let (low, high) = ([[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]);
        Self { low, high, children: [NONE; WIDTH], count: 0, parent: NONE, holds_leaves }
    }

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

    pub fn slot_of(&self, child: u32) -> usize {
        self.children.iter().position(|&other| other == child).unwrap_or(0)
    }

    /// A bit for each child that meets the query.
    pub fn meeting(&self, query: &Query) -> u32 {
        let four = |from: usize| {
            let lanes = |bounds: &[f32; WIDTH]| Vec4::from_slice(&bounds[from..from + 4]);
            let along = |axis: usize| {
                lanes(&self.low[axis]).cmple(query.high[axis])
                    & lanes(&self.high[axis]).cmpge(query.low[axis])
            };
            (along(0) & along(1) & along(2)).bitmask()
        };
        // A query without an end meets free slots, too.
        (four(0) | four(4) << 4) & ((1 << self.count) - 1)
    }

    /// The child that has to grow least to take a box in; of several the smallest.
    pub fn roomiest(&self, bounds: &Local) -> usize {
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
        for slot in 1..self.count {
            if (growth[slot], size[slot]) < (growth[best], size[best]) {
                best = slot;
            }
        }
        best
    }
}
