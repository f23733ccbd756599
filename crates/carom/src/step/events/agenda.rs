//! Touches that are to come, and whom they concern.

use crate::collide::Gap;
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

/// What a pair answers when it is asked for its next touch.
pub(super) struct Answer {
    /// Until when it has been asked, s.
    pub until: f64,
    /// How far apart it was when it was asked, at least, if somebody had to look.
    pub gap: Option<Gap>,
    /// How far apart it stays until then, and is then, as far as that is known, m.
    pub apart: [f64; 2],
    /// When it touches, if it does.
    pub instant: Option<f64>,
}

/// What the touches of a step are kept in, from step to step.
#[derive(Default)]
pub(crate) struct Agenda {
    pub(super) queue: BinaryHeap<Reverse<Event>>,
    pub(super) touches_of_row: Vec<u32>,
    /// The rows that contacts have given new paths at the start of the substep, and whether each is one of them.
    pub(super) renewed: Vec<usize>,
    pub(super) is_renewed: Vec<bool>,
    /// Rows that a touch has given new paths.
    pub(super) rerouted: Vec<usize>,
    /// Pairs that are to be asked.
    pub(super) due: Vec<usize>,
    pub(super) answers: Vec<Answer>,
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
