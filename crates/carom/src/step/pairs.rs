//! Pairs of colliders near each other, remembered from step to step.
//!
//! A pair knows a distance that it had at some time, and how far its bodies have moved since: until these could have used it
//! up, nobody has to look at the pair again. What lies still costs nothing, nor does what is far apart.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::Manifold;
use crate::impacts::time_of_impact::tolerance;
use crate::material::Surface;
use crate::report::Feature;
use crate::solver::graph::ContactId;
use crate::step::broad_phase::ColliderPair;

/// Two colliders whose boxes overlap.
pub(crate) struct Pair {
    pub colliders: ColliderPair,
    pub rows: [usize; 2],
    /// What turns, m: how far a turn by one radian can take a point of each collider.
    pub spin_reach: [f64; 2],
    /// Separation up to which the surfaces count as touching, m.
    pub tolerance: f64,
    pub surface: Surface,
    pub sensor: bool,
    /// Whether the pair rests: it has supports then.
    pub rests: bool,
    pub supports: Vec<Support>,
    /// A separation that the two had, plus how far their bodies had moved by then (m): they are at least this less
    /// their present [`Pair::path`] apart.
    clearance: f64,
    /// What happens to it in this step.
    pub now: Present,
}

/// A manifold of a pair that rests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Support {
    pub contact: ContactId,
    features: [(Feature, Feature); 4],
    count: usize,
}

impl Support {
    pub fn new(contact: ContactId, manifold: &Manifold) -> Self {
        let mut features = [(Feature::Surface, Feature::Surface); 4];
        for (entry, point) in features.iter_mut().zip(manifold.points()) {
            *entry = (point.feature_a, point.feature_b);
        }
        Self { contact, features, count: manifold.points().len() }
    }

    /// What touches at each point.
    pub fn features(&self) -> &[(Feature, Feature)] {
        &self.features[..self.count]
    }
}

/// What happens to a pair in the present step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Present {
    /// Counts how often it was asked when it will touch.
    pub stamp: u32,
    /// From when until when it has been asked, s.
    pub asked_from: f64,
    pub asked_until: f64,
    /// Impacts so far.
    pub hits: u32,
    /// The fastest of them, m/s.
    pub fastest: f64,
    /// Whether it is a sensor and what has been in it.
    pub is_sensed: bool,
    /// How long to look away after a touch that vanished under a closer look, as a share of the step.
    pub patience: f64,
}

impl Present {
    const NOTHING: Present = Present {
        stamp: 0,
        asked_from: 0.0,
        asked_until: -1.0,
        hits: 0,
        fastest: 0.0,
        is_sensed: false,
        patience: 1e-9,
    };
}

impl Pair {
    fn new(bodies: &Bodies, colliders: ColliderPair) -> Option<Self> {
        let (a, b) = (bodies.collider(colliders.0)?, bodies.collider(colliders.1)?);
        Some(Self {
            colliders,
            rows: [a.row, b.row],
            spin_reach: [a.spin_reach, b.spin_reach],
            tolerance: tolerance(a, b),
            surface: Surface::between(&a.material, &b.material),
            sensor: a.sensor || b.sensor,
            rests: false,
            supports: Vec::new(),
            clearance: f64::NEG_INFINITY,
            now: Present::NOTHING,
        })
    }

    /// How far the two bodies' points have moved until `time` within the step, m, since a time of no matter.
    fn path(&self, bodies: &Bodies, time: f64) -> f64 {
        let of = |side: usize| {
            let (linear, angular) = bodies.way(self.rows[side], time);
            linear + angular * self.spin_reach[side]
        };
        of(0) + of(1)
    }

    /// A lower bound of the separation at `time`, m.
    pub fn least_separation(&self, bodies: &Bodies, time: f64) -> f64 {
        self.clearance - self.path(bodies, time)
    }

    /// The two are `separation` apart at `time`.
    pub fn measured(&mut self, bodies: &Bodies, separation: f64, time: f64) {
        self.clearance = separation + self.path(bodies, time);
    }
}

/// All pairs, in order of their colliders' keys.
#[derive(Default)]
pub(crate) struct Pairs {
    list: Vec<Pair>,
    of_row: Vec<Vec<u32>>,
}

impl Pairs {
    /// Takes over the pairs that were `found`, in ascending order; those that are no longer among them are returned if
    /// they rest.
    pub fn update(&mut self, bodies: &Bodies, found: &[ColliderPair]) -> Vec<Pair> {
        self.list.sort_by_key(|pair| pair.colliders);
        let mut old = std::mem::take(&mut self.list).into_iter().peekable();
        let mut parted = Vec::new();
        self.list.reserve(found.len());
        for &colliders in found {
            while let Some(gone) = old.next_if(|pair| pair.colliders < colliders) {
                parted.extend(gone.rests.then_some(gone));
            }
            let known = old.next_if(|pair| pair.colliders == colliders);
            let Some(mut pair) = known.or_else(|| Pair::new(bodies, colliders)) else { continue };
            pair.now = Present::NOTHING;
            self.list.push(pair);
        }
        parted.extend(old.filter(|pair| pair.rests));
        self.index(bodies);
        parted
    }

    fn index(&mut self, bodies: &Bodies) {
        self.of_row.resize_with(bodies.states.len(), Vec::new);
        self.of_row.iter_mut().for_each(Vec::clear);
        for (index, pair) in self.list.iter().enumerate() {
            for row in pair.rows.into_iter().filter(|&row| row != WORLD_ROW) {
                self.of_row[row].push(index as u32);
            }
        }
    }

    /// Adds a pair that has come near within the step; its place, if it was not known.
    pub fn add(&mut self, bodies: &Bodies, colliders: ColliderPair) -> Option<usize> {
        let pair = Pair::new(bodies, colliders)?;
        let [a, b] = pair.rows;
        let row = if a == WORLD_ROW { b } else { a };
        if self.of_row[row].iter().any(|&known| self.list[known as usize].colliders == colliders) {
            return None;
        }
        let index = self.list.len();
        for row in pair.rows.into_iter().filter(|&row| row != WORLD_ROW) {
            self.of_row[row].push(index as u32);
        }
        self.list.push(pair);
        Some(index)
    }

    pub fn len(&self) -> usize {
        self.list.len()
    }

    pub fn iter(&self) -> impl Iterator<Item = &Pair> {
        self.list.iter()
    }

    /// How many pairs the body of a row is in.
    pub fn count_of_row(&self, row: usize) -> usize {
        self.of_row[row].len()
    }

    /// One of them.
    pub fn of_row(&self, row: usize, number: usize) -> usize {
        self.of_row[row][number] as usize
    }

    /// Takes out the pairs of a collider.
    pub fn remove(&mut self, collider: u32) -> Vec<Pair> {
        let is_in = |pair: &mut Pair| pair.colliders.0 == collider || pair.colliders.1 == collider;
        let gone = self.list.extract_if(.., is_in).collect();
        self.of_row.iter_mut().for_each(Vec::clear);
        gone
    }

    /// The body of row `from` has moved to row `to`.
    pub fn rename_row(&mut self, from: usize, to: usize) {
        for row in self.list.iter_mut().flat_map(|pair| &mut pair.rows).filter(|row| **row == from) {
            *row = to;
        }
    }
}

impl std::ops::Index<usize> for Pairs {
    type Output = Pair;

    fn index(&self, index: usize) -> &Pair {
        &self.list[index]
    }
}

impl std::ops::IndexMut<usize> for Pairs {
    fn index_mut(&mut self, index: usize) -> &mut Pair {
        &mut self.list[index]
    }
}
