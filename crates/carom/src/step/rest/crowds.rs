//! Where many bodies rest against each other.

use crate::bodies::{Bodies, WORLD_ROW};

/// More bodies than this, resting against each other, are a crowd.
const CROWD: u32 = 32;

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

    /// Whether one of two rows is in a crowd.
    pub fn has(&self, rows: [usize; 2]) -> bool {
        let size = |row: usize| self.leaders.get(row).map_or(0, |&leader| self.sizes[leader as usize]);
        rows.into_iter().any(|row| size(row) > CROWD)
    }
}
