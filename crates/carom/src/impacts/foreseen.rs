//! The states of two bodies at an instant, kept while one question after the other is asked about it.

use crate::flight::RigidState;
use std::cell::Cell;

/// The last state of each of two bodies that somebody asked for, and its time within the step, s.
#[derive(Default)]
pub(super) struct Foreseen([Cell<Option<(f64, RigidState)>>; 2]);

impl Foreseen {
    /// The state of one of the two at `time`; `fly` finds it if it is not known.
    pub fn get(&self, side: usize, time: f64, fly: impl FnOnce() -> RigidState) -> RigidState {
        match self.0[side].get() {
            Some((known, state)) if known == time => state,
            _ => {
                let state = fly();
                self.0[side].set(Some((time, state)));
                state
            }
        }
    }
}
