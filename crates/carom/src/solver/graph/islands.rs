//! Islands: which contacts hang together, and how fast their bodies move against each other.
//!
//! They are found anew only when contacts have come or gone.

use super::{Color, Graph};
use crate::solver::bundle::Bundle;
use crate::solver::lanes::Row;

/// Which contacts hang together.
#[derive(Default)]
pub(super) struct Islands {
    pub is_stale: bool,
    /// The island of each row.
    pub of_row: Vec<u32>,
    /// Contacts and bodies in each island.
    pub sizes: Vec<u32>,
    pub bodies: Vec<usize>,
    /// Each island with the rows of what its contacts hold it against and nothing moves: the world, and what is driven.
    pub shores: Vec<(usize, u32)>,
    /// Of each row.
    pub pauses: Vec<Pause>,
    /// How fast the bodies of each island move against each other.
    spreads: Vec<Spread>,
    /// Whether something holds of all rows of each island.
    is_whole: Vec<bool>,
}

/// How long a body is not worth a direct solve, in substeps.
#[derive(Clone, Copy, Default)]
pub(super) struct Pause {
    /// How long from now on.
    pub left: u32,
    /// How long since the last solve, which led nowhere; 0 if it led somewhere.
    pub length: u32,
}

/// No island: the world and what is driven.
pub(super) const NONE: u32 = u32::MAX;

impl Islands {
    /// The body of row `from` has moved to row `to`.
    pub fn rename_row(&mut self, from: usize, to: usize) {
        if let Some(&pause) = self.pauses.get(from) {
            self.pauses[to] = pause;
            self.pauses[from] = Pause::default();
        }
    }

    /// The island of a row's body.
    pub fn of(&self, row: u32) -> Option<usize> {
        self.of_row.get(row as usize).filter(|&&island| island != NONE).map(|&island| island as usize)
    }
}

/// Disjoint sets of rows, each named by its least.
pub(super) struct Sets(Vec<u32>);

impl Sets {
    /// As many sets as rows.
    pub fn of_each(rows: usize) -> Self {
        Self((0..rows as u32).collect())
    }

    /// The name of the set that has `row`.
    pub fn find(&mut self, mut row: u32) -> u32 {
        let root = &mut self.0;
        while root[row as usize] != row {
            root[row as usize] = root[root[row as usize] as usize];
            row = root[row as usize];
        }
        row
    }

    /// Makes one set of those that have `a` and `b`.
    pub fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// The box around the velocities of an island's bodies.
#[derive(Clone, Copy)]
pub(super) struct Spread {
    low: [f32; 3],
    high: [f32; 3],
}

impl Spread {
    const NONE: Spread = Spread { low: [f32::MAX; 3], high: [f32::MIN; 3] };

    fn include(&mut self, velocity: &Row) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(velocity.0[axis]);
            self.high[axis] = self.high[axis].max(velocity.0[axis]);
        }
    }

    /// How fast they move against each other, m/s.
    pub fn width(&self) -> f32 {
        (0..3).map(|axis| self.high[axis] - self.low[axis]).fold(0.0, f32::max)
    }
}

impl Graph {
    /// The island of a lane.
    pub(super) fn island_of(&self, bundle: &Bundle, lane: usize) -> Option<usize> {
        self.islands.of(bundle.a[lane]).or(self.islands.of(bundle.b[lane]))
    }

    /// Lets what `holds` of single rows hold of whole islands only: of an island in which it fails for one row it holds of none.
    pub fn in_whole_islands(&mut self, holds: &mut [bool]) {
        let mut is_whole = std::mem::take(&mut self.islands.is_whole);
        is_whole.clear();
        is_whole.resize(self.islands.sizes.len(), true);
        for (row, _) in holds.iter().enumerate().filter(|(_, holds)| !**holds) {
            if let Some(island) = self.islands.of(row as u32) {
                is_whole[island] = false;
            }
        }
        for (row, holds) in holds.iter_mut().enumerate() {
            *holds &= self.islands.of(row as u32).is_none_or(|island| is_whole[island]);
        }
        self.islands.is_whole = is_whole;
    }

    /// How fast the bodies of each island move against each other.
    pub(super) fn spreads(&mut self, velocities: &[Row]) -> &[Spread] {
        let Islands { of_row, sizes, shores, spreads, .. } = &mut self.islands;
        spreads.clear();
        spreads.resize(sizes.len(), Spread::NONE);
        let rows = of_row.iter().zip(velocities);
        for (&island, velocity) in rows.filter(|(island, _)| **island != NONE) {
            spreads[island as usize].include(velocity);
        }
        for &(island, row) in shores.iter() {
            spreads[island].include(&velocities[row as usize]);
        }
        spreads
    }

    /// Finds the islands, if contacts have come or gone since.
    pub(super) fn find_islands(&mut self, rows: usize) {
        if !self.islands.is_stale {
            return;
        }
        let mut movable = Color::default();
        for color in &self.colors {
            movable.taken.resize(movable.taken.len().max(color.taken.len()), 0);
            movable.taken.iter_mut().zip(&color.taken).for_each(|(all, word)| *all |= word);
        }
        let is_movable = |row: usize| movable.is_taken(row as u32);
        let mut sets = Sets::of_each(rows);
        let lanes = || {
            let bundles = self.colors.iter().flat_map(|color| &color.bundles);
            bundles.flat_map(|bundle| bundle.a.iter().copied().zip(bundle.b))
        };
        for (a, b) in lanes().filter(|&(a, b)| is_movable(a as usize) && is_movable(b as usize)) {
            sets.unite(a, b);
        }
        let mut of_row = vec![NONE; rows];
        let mut sizes = Vec::new();
        for (a, b) in lanes() {
            let Some(row) = [a, b].into_iter().find(|&row| is_movable(row as usize)) else { continue };
            let top = sets.find(row) as usize;
            if of_row[top] == NONE {
                of_row[top] = sizes.len() as u32;
                sizes.push(0);
            }
            sizes[of_row[top] as usize] += 1;
        }
        for row in 0..rows {
            of_row[row] = if is_movable(row) { of_row[sets.find(row as u32) as usize] } else { NONE };
        }
        let mut bodies = vec![0; sizes.len()];
        of_row.iter().filter(|&&island| island != NONE).for_each(|&island| bodies[island as usize] += 1);
        let mut shores = Vec::new();
        for (a, b) in lanes().filter(|&(a, b)| of_row[a as usize] != of_row[b as usize]) {
            let shore =
                if of_row[a as usize] == NONE { (of_row[b as usize], a) } else { (of_row[a as usize], b) };
            let shore = (shore.0 as usize, shore.1);
            // What stands on the ground often has its contacts in a row.
            if shores.last() != Some(&shore) {
                shores.push(shore);
            }
        }
        let mut old = std::mem::take(&mut self.islands);
        old.pauses.resize(rows, Pause::default());
        self.islands = Islands { is_stale: false, of_row, sizes, bodies, shores, ..old };
    }
}
