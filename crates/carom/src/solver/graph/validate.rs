//! Holds the tables of a graph to each other. For tests; slow.

use super::islands::NONE;
use super::*;
use crate::solver::bundle::POINTS;
use std::collections::{BTreeMap, BTreeSet};

impl Graph {
    /// How many contacts there are.
    pub fn len(&self) -> usize {
        self.colors.iter().map(|color| color.contacts.len()).sum()
    }

    /// The rows of all contacts' bodies.
    pub fn all_rows(&self) -> Vec<[u32; 2]> {
        let ids = self.colors.iter().flat_map(|color| &color.contacts);
        ids.map(|&id| self.rows(ContactId(id))).collect()
    }

    /// Panics unless every contact has exactly one lane, no two lanes of a colour share a movable body, and all tables agree.
    pub fn validate(&self, is_movable: impl Fn(u32) -> bool) {
        let mut seen = BTreeSet::new();
        for (number, color) in self.colors.iter().enumerate() {
            let lanes = color.contacts.len();
            assert_eq!(color.bundles.len(), lanes.div_ceil(LANES), "bundles of colour {number}");
            let mut taken = BTreeSet::new();
            for (lane, &id) in color.contacts.iter().enumerate() {
                let place = self.places[id as usize].get();
                assert_eq!(place, Some((number, lane)), "place of contact {id}");
                assert!(seen.insert(id), "contact {id} has two lanes");
                let bundle = &color.bundles[lane / LANES];
                let rows = [bundle.a[lane % LANES], bundle.b[lane % LANES]];
                let kind = if rows.into_iter().all(&is_movable) { MOVING } else { FIXED };
                assert_eq!(number % KINDS, kind, "kind of contact {id} between {rows:?}");
                for row in rows.into_iter().filter(|&row| is_movable(row)) {
                    assert!(taken.insert(row), "body {row} has two lanes of colour {number}");
                }
            }
            let marked: BTreeSet<u32> =
                (0..64 * color.taken.len() as u32).filter(|&row| color.is_taken(row)).collect();
            assert_eq!(marked, taken, "marks of colour {number}");
            for lane in lanes..LANES * color.bundles.len() {
                let (rows, values) = color.bundles[lane / LANES].read(lane % LANES);
                assert_eq!(rows, [0; 2], "rows of empty lane {lane}");
                let masses = field::MASSES.into_iter().chain(field::IMPULSES);
                assert!(masses.into_iter().all(|line| values[line] == 0.0), "empty lane {lane} pushes");
            }
            for bundle in &color.bundles {
                let has = |point: usize| {
                    bundle.lines[field::of_point(point, field::MASS)].0.iter().any(|&mass| mass > 0.0)
                };
                assert!((bundle.points..POINTS).all(|point| !has(point)), "a point is not counted");
            }
        }
        let placed = (0..self.places.len() as u32).filter(|&id| self.places[id as usize].get().is_some());
        assert_eq!(placed.collect::<BTreeSet<_>>(), seen, "places without a lane");
        let free: BTreeSet<u32> = self.free.iter().copied().collect();
        assert_eq!(free.len(), self.free.len(), "an id is free twice");
        assert_eq!(free.len() + seen.len(), self.places.len(), "an id is lost");
        assert!(free.is_disjoint(&seen), "an id is free and used");
        if !self.islands.is_stale {
            self.validate_islands(&is_movable);
        }
    }

    /// Panics unless the islands are those that follow from joining neighbours until nothing changes.
    fn validate_islands(&self, is_movable: &impl Fn(u32) -> bool) {
        let lanes = self.all_rows();
        let movable =
            |rows: &[u32; 2]| rows.iter().copied().filter(|&row| is_movable(row)).collect::<Vec<_>>();
        let mut label: BTreeMap<u32, u32> = lanes.iter().flat_map(movable).map(|row| (row, row)).collect();
        loop {
            let before = label.clone();
            for rows in lanes.iter().map(movable).filter(|rows| rows.len() == 2) {
                let least = label[&rows[0]].min(label[&rows[1]]);
                rows.iter().for_each(|row| _ = label.insert(*row, least));
            }
            if before == label {
                break;
            }
        }
        let of_row = |row: u32| self.islands.of_row.get(row as usize).copied().unwrap_or(NONE);
        let mut names = BTreeMap::new();
        for (&row, &top) in &label {
            let island = of_row(row);
            assert_ne!(island, NONE, "body {row} is in no island");
            assert_eq!(*names.entry(top).or_insert(island), island, "the island of body {row} is torn");
        }
        let islands: BTreeSet<u32> = names.values().copied().collect();
        assert_eq!(islands.len(), names.len(), "two islands have one name");
        assert_eq!(islands.len(), self.islands.sizes.len(), "islands without contacts");
        for (top, island) in names {
            let bodies = label.values().filter(|&&it| it == top).count();
            assert_eq!(self.islands.bodies[island as usize], bodies, "bodies of island {island}");
            let in_it = |rows: &&[u32; 2]| movable(rows).first().is_some_and(|row| label[row] == top);
            let contacts = lanes.iter().filter(in_it).count();
            assert_eq!(self.islands.sizes[island as usize] as usize, contacts, "contacts of island {island}");
        }
    }
}
