//! What a substep's contacts come to, until it is given to the bodies.
//!
//! Kept from substep to substep, so that nothing is asked of the allocator while all lies still.

use crate::bodies::Bodies;
use crate::ledger::contacts::{Exerted, settle};
use crate::math::DVec3;
use crate::room::Room;
use crate::solver::graph::Wrenches;
use crate::solver::lanes::Row;

/// Of each row, unless said otherwise.
#[derive(Default)]
pub(super) struct Work {
    /// The rows of the bodies that contacts hold, and of those that they hold no more.
    pub rows: Vec<usize>,
    pub freed: Vec<usize>,
    /// Velocities with no contact pushing, and with those that go on pushing as before.
    pub unpushed: Vec<Row>,
    pub persisting: Vec<Row>,
    /// How much contacts with friction push the body, without directions, N·s.
    pub rough_pushes: Vec<f64>,
    /// Whether the forces on it persist.
    pub is_steady: Vec<bool>,
    /// Whether contacts push it.
    pub is_pushed: Vec<bool>,
    /// What each contact exerts.
    pub wrenches: Wrenches,
    /// The sum of the impulses (N·s), and of their turns about the mean place of the centre of mass (N·m·s; m).
    pub impulses: Vec<DVec3>,
    pub turns: Vec<DVec3>,
    pub centers: Vec<DVec3>,
    pub changes: Vec<Change>,
    /// For how long (s) contacts have exerted this and nobody has told the ledger yet.
    pub unsettled: f64,
}

/// What a substep does to a body's velocity, m/s.
#[derive(Clone, Copy, Default)]
pub(super) struct Change {
    pub velocity: DVec3,
    /// What of that rest capture does, if it takes from the body.
    pub captured: Option<DVec3>,
}

impl Work {
    /// Tells the ledger, if there is one, what contacts have exerted in the substep that is over.
    pub fn settle(&mut self, bodies: &mut Bodies) {
        let time = std::mem::take(&mut self.unsettled);
        if time > 0.0 {
            let (impulses, turns, centers) = (&self.impulses, &self.turns, &self.centers);
            settle(bodies, &Exerted { impulses, turns, centers, time });
        }
    }

    /// Makes room for `count` rows, of which nothing is known yet.
    pub fn begin(&mut self, count: usize) {
        fill(&mut self.rough_pushes, count, 0.0);
        fill(&mut self.is_steady, count, true);
        fill(&mut self.is_pushed, count, false);
        fill(&mut self.impulses, count, DVec3::ZERO);
        fill(&mut self.turns, count, DVec3::ZERO);
        self.centers.lengthen(count, DVec3::ZERO);
        self.changes.lengthen(count, Change::default());
    }
}

/// Makes a list the same as another.
pub(super) fn copy<T: Copy>(list: &mut Vec<T>, other: &[T]) {
    list.clear();
    list.extend_from_slice(other);
}

/// Gives a list so many values.
pub(super) fn fill<T: Clone>(list: &mut Vec<T>, count: usize, value: T) {
    list.clear();
    list.lengthen(count, value);
}
