//! Touches that are to come, and whom they concern.

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// A pair will touch at an instant of the step, unless its paths have changed since (then the stamps differ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Event {
    pub time: f64,
    pub key: (u32, u32, u32, u32),
    pub pair: usize,
    pub stamp: u32,
}

impl Eq for Event {}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        let rank = |event: &Event| (event.key, event.pair, event.stamp);
        self.time.total_cmp(&other.time).then(rank(self).cmp(&rank(other)))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// What the touches of a step are kept in, from step to step.
#[derive(Default)]
pub(crate) struct Agenda {
    pub(super) queue: BinaryHeap<Reverse<Event>>,
    pub(super) touches_of_row: Vec<u32>,
    /// Whether contacts have given each row a new path at the start of the substep.
    pub(super) is_renewed: Vec<bool>,
    /// Rows that a touch has given new paths.
    pub(super) rerouted: Vec<usize>,
    /// Pairs that are to be asked.
    pub(super) due: Vec<usize>,
    /// How many impacts there were in the last step.
    pub(super) impacts: usize,
}

impl Agenda {
    /// Forgets all of them, for a step with so many rows.
    pub(super) fn clear(&mut self, rows: usize) {
        self.queue.clear();
        self.rerouted.clear();
        self.touches_of_row.clear();
        self.touches_of_row.resize(rows, 0);
        self.is_renewed.clear();
        self.is_renewed.resize(rows, false);
    }
}
