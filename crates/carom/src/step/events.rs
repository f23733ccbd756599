//! The touches of a step, one after the other in time.
//!
//! Every pair of colliders that could touch is asked when it will; the earliest touch is carried out at its instant,
//! which sends both bodies onto new paths and makes their pairs be asked again. What touches more slowly than the rest
//! threshold is handed to [`rest`](super::rest). Bodies keep clocks of their own: only those that a touch concerns are
//! advanced to it.
//!
//! Order: by time, touches before settling, then by bodies and colliders; so the same scene gives the same bits.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::impacts::strike::strike;
use crate::impacts::time_of_impact::{Approach, RestLaw, Touch};
use crate::report::Impact;
use crate::step::broad_phase::{Bounds, BroadPhase, ColliderPair, order, swept_bounds};
use crate::step::motion::{advance, free_influence};
use crate::step::rest::{Island, Resting};
use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeSet, BinaryHeap};

/// So many impacts of one pair in one step are taken one by one. If it is then down to this fraction of its fastest, the
/// pair is a ball that rattles itself to rest, and rests.
const RATTLE_HITS: u32 = 32;
const RATTLE_SPEED: f64 = 0.01;

/// So many touches of one body in one step are taken one by one; a body with more is wedged, and its touches rest.
const WEDGED_TOUCHES: u32 = 1024;

/// Something that will happen at an instant of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Event {
    time: f64,
    kind: Kind,
    key: (u32, u32, u32, u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// The pair touches, unless its paths have changed since (then the stamps differ).
    Touch { pair: usize, stamp: u32 },
    /// The body of this row, and what it rests on, settle.
    Settle { row: usize },
}

impl Eq for Event {}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        let rank = |kind: &Kind| matches!(kind, Kind::Settle { .. });
        self.time
            .total_cmp(&other.time)
            .then(rank(&self.kind).cmp(&rank(&other.kind)))
            .then(self.key.cmp(&other.key))
            .then(self.kind.cmp(&other.kind))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// A pair of colliders that is watched during this step.
struct Watched {
    colliders: ColliderPair,
    rows: [usize; 2],
    stamp: u32,
    hits: u32,
    fastest: f64,
    /// How long to look away after a touch that vanished under a closer look, as a share of the step.
    patience: f64,
    /// When it was last handed over to settle.
    settled_at: Option<f64>,
}

/// The touches of one step.
pub(crate) struct Events<'a> {
    bodies: &'a mut Bodies,
    broad_phase: &'a BroadPhase,
    resting: &'a mut Resting,
    law: RestLaw,
    end: f64,
    queue: BinaryHeap<Reverse<Event>>,
    pairs: Vec<Watched>,
    /// The watched pairs of each row.
    pairs_of_row: Vec<Vec<usize>>,
    /// The boxes that bodies have been given within this step, by collider.
    rerouted: Vec<(u32, Bounds)>,
    touches_of_row: Vec<u32>,
    unsettled: BTreeSet<usize>,
    impacts: Vec<Impact>,
}

impl<'a> Events<'a> {
    /// Watches `pairs` until `end` seconds into the step.
    pub fn new(
        bodies: &'a mut Bodies,
        broad_phase: &'a BroadPhase,
        resting: &'a mut Resting,
        law: RestLaw,
        end: f64,
    ) -> Self {
        let rows = bodies.states.len();
        Self {
            bodies,
            broad_phase,
            resting,
            law,
            end,
            queue: BinaryHeap::new(),
            pairs: Vec::new(),
            pairs_of_row: vec![Vec::new(); rows],
            rerouted: Vec::new(),
            touches_of_row: vec![0; rows],
            unsettled: BTreeSet::new(),
            impacts: Vec::new(),
        }
    }

    /// Carries out all touches of the step, in time; the impacts, each with its time within the step.
    pub fn run(mut self, pairs: &[ColliderPair]) -> Vec<Impact> {
        for &pair in pairs {
            self.watch(pair);
        }
        let resting: Vec<ColliderPair> = self.resting.iter().collect();
        for (a, b) in resting {
            for key in [a, b] {
                if let Some(row) = self.bodies.collider(key).map(|collider| collider.row) {
                    self.unsettle(row, 0.0);
                }
            }
        }
        for pair in 0..self.pairs.len() {
            self.ask(pair, 0.0);
        }
        while let Some(Reverse(event)) = self.queue.pop() {
            match event.kind {
                Kind::Touch { pair, stamp } if self.pairs[pair].stamp == stamp => {
                    self.touch(pair, event.time);
                }
                Kind::Settle { row } if self.unsettled.contains(&row) => self.settle(row, event.time),
                _ => {}
            }
        }
        self.impacts
    }

    fn watch(&mut self, colliders: ColliderPair) -> Option<usize> {
        let (a, b) = (self.bodies.collider(colliders.0)?, self.bodies.collider(colliders.1)?);
        if a.sensor || b.sensor {
            return None;
        }
        let rows = [a.row, b.row];
        let pair = self.pairs.len();
        self.pairs.push(Watched {
            colliders,
            rows,
            stamp: 0,
            hits: 0,
            fastest: 0.0,
            patience: 1e-9,
            settled_at: None,
        });
        for row in rows.into_iter().filter(|&row| row != WORLD_ROW) {
            self.pairs_of_row[row].push(pair);
        }
        Some(pair)
    }

    /// Asks a pair when it will touch, from `time` on.
    fn ask(&mut self, pair: usize, time: f64) {
        let watched = &mut self.pairs[pair];
        watched.stamp += 1;
        let (colliders, stamp) = (watched.colliders, watched.stamp);
        let rests = self.resting.contains(colliders);
        if let Some(instant) = self.approach(colliders).and_then(|it| it.next_touch(time, self.end, rests)) {
            let key = order(self.bodies, colliders);
            self.queue.push(Reverse(Event { time: instant, kind: Kind::Touch { pair, stamp }, key }));
        }
    }

    fn approach(&self, (a, b): ColliderPair) -> Option<Approach<'_>> {
        Some(Approach::new(self.bodies, self.bodies.collider(a)?, self.bodies.collider(b)?, self.law))
    }

    fn touch(&mut self, pair: usize, time: f64) {
        let (colliders, rows) = (self.pairs[pair].colliders, self.pairs[pair].rows);
        for row in rows {
            self.rouse(row, time);
            advance(self.bodies, row, time);
            self.touches_of_row[row] += u32::from(row != WORLD_ROW);
        }
        let rests = self.resting.contains(colliders);
        let Some(approach) = self.approach(colliders) else { return };
        let Some(touch) = approach.confirmed_touch(time, rests) else {
            let later = self.later(pair, time);
            return self.ask(pair, later);
        };
        let surface = approach.surface();
        if !self.comes_to_rest(pair, &touch) {
            self.pairs[pair].hits += 1;
            self.impacts.extend(strike(self.bodies, colliders, &touch, &surface, time));
            for row in rows {
                self.reroute(row, time);
            }
        } else if self.pairs[pair].settled_at == Some(time) {
            // Nothing can be done about this touch: both sides are held by what nothing moves.
            let later = self.later(pair, time);
            self.ask(pair, later);
        } else {
            self.pairs[pair].settled_at = Some(time);
            self.resting.insert(colliders);
            for row in rows {
                self.unsettle(row, time);
            }
        }
    }

    /// When to look again for a touch that vanished under a closer look: a moment later, the next time twice that.
    fn later(&mut self, pair: usize, time: f64) -> f64 {
        let watched = &mut self.pairs[pair];
        watched.patience *= 2.0;
        time + watched.patience * self.end
    }

    /// Whether a touch is to be a contact, not an impact.
    fn comes_to_rest(&mut self, pair: usize, touch: &Touch) -> bool {
        let closing = -touch.closing_speed;
        let watched = &mut self.pairs[pair];
        watched.fastest = watched.fastest.max(closing);
        let rattles = watched.hits >= RATTLE_HITS && closing < RATTLE_SPEED * watched.fastest;
        let wedged = watched.rows.iter().any(|&row| self.touches_of_row[row] >= WEDGED_TOUCHES);
        closing <= touch.rest_speed || rattles || wedged
    }

    /// Wakes the body of a row if it sleeps, and gives gravity back to it.
    fn rouse(&mut self, row: usize, time: f64) {
        if self.bodies.wake(row) {
            self.bodies.clocks[row] = time;
            self.bodies.influences[row] = free_influence(self.bodies, row, self.law.gravity);
        }
    }

    /// A body has got a new path at `time`: find whom it could touch now, and ask all its pairs again.
    fn reroute(&mut self, row: usize, time: f64) {
        if row == WORLD_ROW {
            return;
        }
        if self.pairs_of_row[row].iter().any(|&pair| self.resting.contains(self.pairs[pair].colliders)) {
            self.unsettle(row, time);
        }
        self.find_new_pairs(row, time);
        for index in 0..self.pairs_of_row[row].len() {
            self.ask(self.pairs_of_row[row][index], time);
        }
    }

    fn find_new_pairs(&mut self, row: usize, time: f64) {
        let slot = self.bodies.slot_of_row[row];
        let keys = self.bodies.record(slot).map_or(Vec::new(), |record| record.colliders.clone());
        for key in keys {
            let Some(collider) = self.bodies.collider(key) else { continue };
            let bounds = swept_bounds(self.bodies, collider, self.end - time);
            let mut found = Vec::new();
            self.broad_phase.pairs_of(self.bodies, key, &bounds, &mut found);
            for &(other, ref other_bounds) in &self.rerouted {
                if other_bounds.intersects(&bounds) {
                    crate::step::broad_phase::push_pair(self.bodies, key, other, &mut found);
                }
            }
            self.rerouted.retain(|&(other, _)| other != key);
            self.rerouted.push((key, bounds));
            found.sort_unstable_by_key(|&pair| order(self.bodies, pair));
            found.dedup();
            for pair in found {
                let known = |&index: &usize| self.pairs[index].colliders == pair;
                if !self.pairs_of_row[row].iter().any(known)
                    && let Some(new) = self.watch(pair)
                {
                    let [a, b] = self.pairs[new].rows;
                    self.ask(new, time.max(self.bodies.clocks[a]).max(self.bodies.clocks[b]));
                }
            }
        }
    }

    fn unsettle(&mut self, row: usize, time: f64) {
        if row != WORLD_ROW && self.unsettled.insert(row) {
            let key = (self.bodies.slot_of_row[row], 0, 0, 0);
            self.queue.push(Reverse(Event { time, kind: Kind::Settle { row }, key }));
        }
    }

    fn settle(&mut self, row: usize, time: f64) {
        let island = self.island_of(row);
        for row in &island.rows {
            self.unsettled.remove(row);
        }
        self.unsettled.remove(&row);
        if island.pairs.is_empty() {
            return;
        }
        for &row in &island.rows {
            self.rouse(row, time);
        }
        self.resting.settle(self.bodies, &island, self.law, (time, self.end));
        for &row in &island.rows {
            if self.bodies.constants[row].is_movable() {
                self.find_new_pairs(row, time);
            }
        }
        let mut concerned: Vec<usize> =
            island.rows.iter().flat_map(|&row| self.pairs_of_row[row].iter().copied()).collect();
        concerned.sort_unstable();
        concerned.dedup();
        for pair in concerned {
            self.ask(pair, time);
        }
    }

    /// All that rests on each other around a body; bodies that nothing can move end it.
    fn island_of(&self, row: usize) -> Island {
        let mut rows = BTreeSet::from([row]);
        let mut pairs = BTreeSet::new();
        let mut open = vec![row];
        while let Some(row) = open.pop() {
            if !self.bodies.constants[row].is_movable() {
                continue;
            }
            for &pair in &self.pairs_of_row[row] {
                let watched = &self.pairs[pair];
                if self.resting.contains(watched.colliders) && pairs.insert(watched.colliders) {
                    for row in watched.rows.into_iter().filter(|&row| row != WORLD_ROW) {
                        if rows.insert(row) {
                            open.push(row);
                        }
                    }
                }
            }
        }
        Island { rows: rows.into_iter().collect(), pairs: pairs.into_iter().collect() }
    }
}
