//! Where many bodies rest against each other.
//!
//! There everything touches everything, and each blow presses hundreds of contacts a little. What touches for the first time strikes at
//! its own instant, as anywhere else. What rests already and does not bounce has nothing that an instant could tell: it is
//! stopped. So a crowd's contacts see to all of it, however it is pressed, at the end of the substep.

use super::grain;
use crate::bodies::{Bodies, WORLD_ROW};
use crate::impacts::time_of_impact::RestLaw;
use crate::step::pairs::Pair;

/// More bodies than this, resting against each other, are a crowd.
const CROWD: u32 = 12;

/// A pair whose points come nearer in a substep than this share of the smaller body's reach is no longer left to contacts.
const AT_A_STRETCH: f64 = 0.02;

/// Gap that contacts of a crowd see to however slowly its bodies move, as a share of the smaller reach.
const AT_HAND: f64 = 0.1;

/// The bodies in disjoint sets of those that rest against each other.
#[derive(Default)]
pub(super) struct Crowds {
    leaders: Vec<u32>,
    sizes: Vec<u32>,
}

impl Crowds {
    /// Finds the sets, given the rows of all pairs that rest.
    pub fn find(&mut self, bodies: &Bodies, pairs: impl Iterator<Item = [usize; 2]>) {
        let rows = bodies.states.len() as u32;
        self.leaders.clear();
        self.leaders.extend(0..rows);
        let movable = |&row: &usize| row != WORLD_ROW && bodies.constants[row].is_movable();
        for [a, b] in pairs.filter(|rows| rows.iter().all(movable)) {
            let (one, other) = (self.leader(a as u32), self.leader(b as u32));
            self.leaders[one.max(other) as usize] = one.min(other);
        }
        self.sizes.clear();
        self.sizes.resize(rows as usize, 0);
        for row in 0..rows {
            let leader = self.leader(row);
            self.leaders[row as usize] = leader;
            self.sizes[leader as usize] += 1;
        }
    }

    fn leader(&mut self, mut row: u32) -> u32 {
        while self.leaders[row as usize] != row {
            let next = self.leaders[row as usize];
            self.leaders[row as usize] = self.leaders[next as usize];
            row = next;
        }
        row
    }

    /// Whether the body of a row is in a crowd.
    pub fn has(&self, row: usize) -> bool {
        self.leaders.get(row).is_some_and(|&leader| self.sizes[leader as usize] > CROWD)
    }

    /// Whether one of two bodies is.
    pub fn has_either(&self, rows: [usize; 2]) -> bool {
        rows.into_iter().any(|row| self.has(row))
    }

    /// Whether contacts see to a pair that rests, however it is pressed.
    pub fn press(&self, bodies: &Bodies, pair: &Pair, law: RestLaw) -> bool {
        pair.surface.restitution == 0.0
            && self.has_either(pair.rows)
            && approach(bodies, pair, law.substep) <= AT_A_STRETCH * grain(bodies, pair)
    }
}

/// Gap (m) up to which contacts of a crowd see to a pair's points when they are looked at with so much (s) of the step `left`.
pub(super) fn reach_in_crowd(bodies: &Bodies, pair: &Pair, left: f64) -> f64 {
    (AT_HAND * grain(bodies, pair)).max(approach(bodies, pair, left))
}

/// How much nearer to each other the points of two bodies can come within `time` (s) on their present paths, m.
fn approach(bodies: &Bodies, pair: &Pair, time: f64) -> f64 {
    let [a, b] = pair.rows;
    let velocity = bodies.states[b].velocity - bodies.states[a].velocity;
    let acceleration = bodies.influences[b].acceleration - bodies.influences[a].acceleration;
    let turn = |side: usize| bodies.paces[pair.rows[side]].1 * pair.spin_reach[side];
    time * (velocity.length() + turn(0) + turn(1) + 0.5 * time * acceleration.length())
}
