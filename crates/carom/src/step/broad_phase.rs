//! Broad phase: which colliders could touch while their bodies fly?
//!
//! Each collider has a fat box: around all that it can reach during the step, around where it will get in a few more if it goes
//! on as it does, and a margin. Two colliders are a pair as long as their fat boxes meet. Only a body that could leave its fat
//! boxes is looked at: they get new ones, and new pairs are looked for there alone. So what lies still costs a comparison, and what
//! flies a search every few steps.
//!
//! Boxes live in two trees, one for what moves and one for what does not; boundless planes stand apart. Which pairs there
//! are follows from boxes alone, whatever the trees look like.
//!
//! The idea of fat boxes is from Catto's *Dynamic bounding volume hierarchies* (2019).

mod bounds;
mod forecast;
#[cfg(test)]
mod tests;
mod tree;

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::math::DVec3;
use crate::room::Room;
use crate::shape::Shape;
use crate::step::profile::{self, Phase};
use bounds::{Bounds, present_bounds, swept_bounds};
use forecast::Forecast;
use tree::Tree;

/// Lists of pairs that only a world's first step fills keep room for so many.
pub(super) const ROOM: usize = 4096;

/// A pair of colliders, the one of the lower slot first.
pub(crate) type ColliderPair = (u32, u32);

/// Fat boxes, and whose they are.
pub(crate) struct BroadPhase {
    fixed: Tree,
    moving: Tree,
    planes: Vec<u32>,
    /// The fat box of each collider, by its key.
    boxes: Vec<Bounds>,
    /// Why each row's colliders stay in their boxes.
    forecasts: Vec<Forecast>,
    /// Colliders that do not move and have come since pairs were last looked for.
    fresh: Vec<u32>,
    /// Colliders that have got new boxes since pairs were last updated.
    boxed: Vec<u32>,
    found: Vec<ColliderPair>,
    /// Since the world began, at the start of the present step; and how long that is, s.
    time: f64,
    step: f64,
}

/// Margin of a fat box, m per metre of the collider's reach.
const MARGIN: f64 = 0.1;

/// A fat box reaches so many more steps ahead, at least and at most: twice as many as the one before if nobody was near,
/// else half as many.
const AHEAD: [f64; 2] = [4.0, 16.0];

impl BroadPhase {
    pub fn new() -> Self {
        Self {
            fixed: Tree::new(),
            moving: Tree::new(),
            planes: Vec::new(),
            boxes: Vec::new(),
            forecasts: Vec::new(),
            fresh: Vec::new(),
            boxed: Vec::new(),
            found: Vec::new(),
            time: 0.0,
            step: 0.0,
        }
    }

    pub fn insert(&mut self, bodies: &Bodies, key: u32) {
        let Some(collider) = bodies.collider(key) else { return };
        self.boxes.lengthen(key as usize + 1, Bounds::NOTHING);
        self.boxes[key as usize] = Bounds::NOTHING;
        if collider.row != WORLD_ROW {
            // Gets its box when pairs are looked for.
            self.grow(bodies.states.len());
            self.forecasts[collider.row] = Forecast::NONE;
        } else if matches!(collider.shape, Shape::Plane) {
            self.planes.push(key);
            self.fresh.push(key);
        } else {
            let bounds = present_bounds(bodies, collider).or_everything();
            self.boxes[key as usize] = bounds;
            self.fixed.set(key, &bounds);
            self.fresh.push(key);
        }
    }

    pub fn remove(&mut self, key: u32) {
        self.fixed.remove(key);
        self.moving.remove(key);
        self.planes.retain(|&plane| plane != key);
        self.fresh.retain(|&fresh| fresh != key);
        self.boxed.retain(|&boxed| boxed != key);
    }

    /// The body of `row` is no more; that of the last row, `last`, gets its row.
    pub fn remove_row(&mut self, row: usize, last: usize) {
        self.grow(last + 1);
        self.forecasts.swap_remove(row);
    }

    fn grow(&mut self, rows: usize) {
        self.forecasts.lengthen(rows, Forecast::NONE);
    }

    /// Finds the pairs that are new because of new boxes in a step of `time` seconds.
    pub fn find_pairs(&mut self, bodies: &Bodies, time: f64) {
        let _phase = profile::phase(Phase::Find);
        self.time += self.step;
        self.step = time;
        self.grow(bodies.states.len());
        let before = self.boxed.len();
        for row in bodies.rows() {
            if !self.forecasts[row].holds(bodies, row, (self.time, time)) {
                self.fit(bodies, row);
            }
        }
        let boxes = &self.boxes;
        self.moving.follow(|key| boxes[key as usize]);
        self.fixed.follow(|key| boxes[key as usize]);
        self.search(bodies, before);
    }

    /// A body has got a new path from its own time on: finds the pairs that are new because of it.
    pub fn move_within_step(&mut self, bodies: &Bodies, row: usize) {
        let before = self.boxed.len();
        if !self.forecasts[row].holds(bodies, row, (self.time, self.step)) {
            self.fit(bodies, row);
        }
        self.search(bodies, before);
    }

    /// What the last search has found, in order; some of it may be known already.
    pub fn found(&self) -> &[ColliderPair] {
        &self.found
    }

    /// Forgets what the last search has found, with the room that it took if that was a whole world's.
    pub fn forget_found(&mut self) {
        self.found.clear();
        self.found.shrink_to(ROOM);
    }

    /// The colliders that have got new boxes since they were last forgotten: some of their pairs may have parted.
    pub fn boxed(&self) -> &[u32] {
        &self.boxed
    }

    pub fn forget_boxed(&mut self) {
        self.boxed.clear();
    }

    /// Whether two colliders, which are allowed to touch, are a pair.
    pub fn are_near(&self, bodies: &Bodies, (a, b): ColliderPair) -> bool {
        let (one, other) = (&self.boxes[a as usize], &self.boxes[b as usize]);
        // Most that are asked still are. A plane has no box: only what reaches everywhere meets it.
        if one.intersects(other) {
            return true;
        }
        let is_plane = |key| bodies.collider(key).is_some_and(|it| matches!(it.shape, Shape::Plane));
        match (is_plane(a), is_plane(b)) {
            (true, false) => below_plane(bodies, a, other),
            (false, true) => below_plane(bodies, b, one),
            _ => false,
        }
    }

    /// Gives new boxes to those of a body's colliders that could leave theirs by the end of the step.
    fn fit(&mut self, bodies: &Bodies, row: usize) {
        let Some(record) = bodies.record(bodies.slot_of_row[row]) else { return };
        let left = self.step - bodies.clocks[row];
        let steps_ahead = self.forecasts[row].steps_ahead();
        let ahead = steps_ahead * self.step * bodies.states[row].velocity;
        let (_, turned) = bodies.way(row, bodies.clocks[row]);
        let duration = left + steps_ahead * self.step;
        let mut forecast = Forecast::new(bodies, row, (self.time, duration), steps_ahead);
        for &key in &record.colliders {
            let Some(collider) = bodies.collider(key) else { continue };
            let here = present_bounds(bodies, collider);
            let swept = swept_bounds(bodies, collider, here, left);
            let fat = swept.union(swept.shifted(ahead)).grown(MARGIN * collider.reach).or_everything();
            self.boxes[key as usize] = fat;
            self.moving.set(key, &fat);
            self.boxed.put(key);
            let room = fat.room_around(&here).min(fat.room_around(&here.shifted(forecast.way())));
            forecast.allow(room, (turned, collider.spin_reach));
        }
        self.forecasts[row] = forecast;
    }

    /// Finds the pairs of what has new boxes, from the place `from` in their list on, and of what is fresh.
    fn search(&mut self, bodies: &Bodies, from: usize) {
        self.found.clear();
        let (found, boxes) = (&mut self.found, &self.boxes);
        for &key in &self.boxed[from..] {
            let before = found.len();
            let bounds = boxes[key as usize];
            let mut meet = |other: u32| {
                if boxes[other as usize].intersects(&bounds) {
                    push_pair(bodies, key, other, found);
                }
            };
            self.moving.visit(&bounds, &mut meet);
            self.fixed.visit(&bounds, &mut meet);
            for &plane in self.planes.iter().filter(|&&plane| below_plane(bodies, plane, &bounds)) {
                push_pair(bodies, key, plane, found);
            }
            if let Some(collider) = bodies.collider(key) {
                let factor = if found.len() == before { 2.0 } else { 0.5 };
                self.forecasts[collider.row].look_ahead(factor, AHEAD);
            }
        }
        for key in self.fresh.drain(..) {
            if self.planes.contains(&key) {
                self.moving.visit(&Bounds::EVERYTHING, |other| {
                    if below_plane(bodies, key, &boxes[other as usize]) {
                        push_pair(bodies, key, other, found);
                    }
                });
            } else {
                let bounds = boxes[key as usize];
                self.moving.visit(&bounds, |other| {
                    if boxes[other as usize].intersects(&bounds) {
                        push_pair(bodies, key, other, found);
                    }
                });
            }
        }
        found.sort_unstable();
        found.dedup();
    }
}

/// Whether the lowest corner of the box along the plane's normal is below the plane.
fn below_plane(bodies: &Bodies, plane: u32, bounds: &Bounds) -> bool {
    let Some(collider) = bodies.collider(plane) else { return false };
    let pose = bodies.center_pose(collider).then_local(&collider.local);
    let up = pose.rotation * DVec3::Y;
    let lowest = DVec3::select(up.cmpgt(DVec3::ZERO), bounds.low, bounds.high);
    // Not a number where the box has no end: below, as far as anybody knows.
    let height = (lowest - pose.position).dot(up);
    height <= 0.0 || height.is_nan()
}

/// Appends the pair, the collider of the lower slot first, if the two can have anything to do with each other.
fn push_pair(bodies: &Bodies, a: u32, b: u32, pairs: &mut Vec<ColliderPair>) {
    let (Some(first), Some(second)) = (bodies.collider(a), bodies.collider(b)) else { return };
    if may_touch(bodies, first, second) {
        pairs.push(if first.slot < second.slot { (a, b) } else { (b, a) });
    }
}

/// Whether two colliders can have anything to do with each other: two bodies, one of which an impulse can move (or a
/// sensor sees a moving one), and filters that agree.
fn may_touch(bodies: &Bodies, a: &ColliderRow, b: &ColliderRow) -> bool {
    let movable = |collider: &ColliderRow| bodies.constants[collider.row].is_movable();
    let meet = if a.sensor || b.sensor { !(a.sensor && b.sensor) } else { movable(a) || movable(b) };
    a.slot != b.slot && meet && a.allows(b)
}

/// The order in which touches of one instant are handled: by bodies, then by their colliders.
pub(crate) fn order(bodies: &Bodies, (a, b): ColliderPair) -> (u32, u32, u32, u32) {
    match (bodies.collider(a), bodies.collider(b)) {
        (Some(a), Some(b)) => (a.slot, b.slot, a.index, b.index),
        _ => (u32::MAX, u32::MAX, a, b),
    }
}
