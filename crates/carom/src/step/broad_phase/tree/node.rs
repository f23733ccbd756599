//! A node: eight boxes, and what is in each.

use crate::boxes::{Boxes, Local, Query, WIDTH};

/// No node, no leaf.
pub const NONE: u32 = u32::MAX;

/// What it holds are leaves' keys or other nodes.
#[derive(Clone)]
pub struct Node {
    boxes: Boxes,
    pub children: [u32; WIDTH],
    pub count: usize,
    pub parent: u32,
    pub holds_leaves: bool,
}

impl Node {
    pub fn new(holds_leaves: bool) -> Self {
        Self { boxes: Boxes::NOTHING, children: [NONE; WIDTH], count: 0, parent: NONE, holds_leaves }
    }

    pub fn get(&self, slot: usize) -> Local {
        self.boxes.get(slot)
    }

    pub fn set(&mut self, slot: usize, bounds: Local) {
        self.boxes.set(slot, bounds);
    }

    pub fn whole(&self) -> Local {
        self.boxes.whole()
    }

    pub fn slot_of(&self, child: u32) -> usize {
        self.children.iter().position(|&other| other == child).unwrap_or(0)
    }

    /// A bit for each child that meets the query.
    pub fn meeting(&self, query: &Query) -> u32 {
        self.boxes.meeting(query, self.count)
    }

    /// The child that has to grow least to take a box in; of several the smallest.
    pub fn roomiest(&self, bounds: &Local) -> usize {
        self.boxes.roomiest(bounds, self.count)
    }
}
