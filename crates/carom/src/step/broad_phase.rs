//! Broad phase: which colliders could touch during a step.
//!
//! Each collider has a box around everything that it can reach during the step. Boxes live in two of parry's trees, one
//! for what moves and one for what does not; boundless planes stand apart. Boxes of moving colliders have a margin, so
//! that the trees stay as they are while little moves.

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::flight::fly_center;
use crate::math::{DVec3, Pose};
use crate::shape::Shape;
use crate::step::events::CLAIM;
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhWorkspace};

/// A box in the world, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: DVec3,
    pub high: DVec3,
}

impl Bounds {
    fn union(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn grown(self, by: f64) -> Bounds {
        Bounds { low: self.low - DVec3::splat(by), high: self.high + DVec3::splat(by) }
    }

    fn aabb(&self) -> Aabb {
        Aabb::new(self.low, self.high)
    }

    pub fn intersects(&self, other: &Bounds) -> bool {
        self.low.cmple(other.high).all() && self.high.cmpge(other.low).all()
    }
}

/// The box around all that a collider can reach in the next `time` seconds of its body's flight.
///
/// The centre of mass stays within `|a|t²/8` of the chord of its path; turning by an angle θ takes no point further
/// than `reach·min(θ, 2)`.
pub(crate) fn swept_bounds(bodies: &Bodies, collider: &ColliderRow, time: f64) -> Bounds {
    let at = |pose: &Pose| {
        let (low, high) = collider.shape.bounds(&pose.then_local(&collider.local));
        Bounds { low, high }
    };
    let here = bodies.center_pose(collider);
    if collider.row == WORLD_ROW {
        return at(&here);
    }
    let (state, constants, influence) =
        (&bodies.states[collider.row], &bodies.constants[collider.row], &bodies.influences[collider.row]);
    let (end, _) = fly_center(state, constants, influence, time);
    let bulge = influence.acceleration.length() * time * time / 8.0
        + constants.linear_damping * state.velocity.length() * time * time / 8.0;
    let angle = constants.spin_limit(state, influence, time) * time;
    let start = at(&here);
    start
        .union(Bounds { low: start.low + (end - here.position), high: start.high + (end - here.position) })
        .grown(bulge + collider.spin_reach * angle.min(2.0))
}

/// A pair of colliders, the one of the lower slot first.
pub(crate) type ColliderPair = (u32, u32);

/// Both trees and what they hold.
pub(crate) struct BroadPhase {
    fixed: Bvh,
    moving: Bvh,
    workspace: BvhWorkspace,
    planes: Vec<u32>,
    moving_keys: Vec<u32>,
    /// The boxes that bodies have been given within the present step, by collider.
    rerouted: Vec<(u32, Bounds)>,
}

/// Margin of a moving collider's box, m per metre of its reach.
const MARGIN: f64 = 0.1;

impl BroadPhase {
    pub fn new() -> Self {
        Self {
            fixed: Bvh::new(),
            moving: Bvh::new(),
            workspace: BvhWorkspace::default(),
            planes: Vec::new(),
            moving_keys: Vec::new(),
            rerouted: Vec::new(),
        }
    }

    pub fn insert(&mut self, bodies: &Bodies, key: u32) {
        let Some(collider) = bodies.collider(key) else { return };
        if matches!(collider.shape, Shape::Plane) {
            self.planes.push(key);
            return;
        }
        let bounds = swept_bounds(bodies, collider, 0.0);
        if collider.row == WORLD_ROW {
            self.fixed.insert(bounds.aabb(), key);
        } else {
            self.moving.insert(bounds.aabb(), key);
            self.moving_keys.push(key);
        }
    }

    pub fn remove(&mut self, key: u32) {
        self.fixed.remove(key);
        self.moving.remove(key);
        self.planes.retain(|&plane| plane != key);
        self.moving_keys.retain(|&moving| moving != key);
    }

    /// All pairs of colliders that could touch in the next `time` seconds and are allowed to, in order.
    pub fn find_pairs(&mut self, bodies: &Bodies, time: f64) -> Vec<ColliderPair> {
        self.rerouted.clear();
        let mut reached = Vec::with_capacity(self.moving_keys.len());
        for &key in &self.moving_keys {
            let Some(collider) = bodies.collider(key) else { continue };
            let bounds = swept_bounds(bodies, collider, time).grown(CLAIM * collider.reach);
            let margin = MARGIN * collider.reach;
            self.moving.insert_or_update_partially(bounds.aabb(), key, margin);
            reached.push((key, bounds));
        }
        self.moving.refit(&mut self.workspace);
        self.moving.optimize_incremental(&mut self.workspace);

        let mut pairs = Vec::new();
        self.moving.traverse_bvtt_single_tree::<false>(&mut self.workspace, &mut |a, b| {
            push_pair(bodies, a, b, &mut pairs);
        });
        for (key, bounds) in &reached {
            self.pairs_with_fixed(bodies, *key, bounds, &mut pairs);
        }
        pairs.sort_unstable();
        pairs
    }

    /// Gives a moving collider another box within a step, and finds its pairs there.
    pub fn move_within_step(
        &mut self,
        bodies: &Bodies,
        key: u32,
        bounds: &Bounds,
        pairs: &mut Vec<ColliderPair>,
    ) {
        let reach = bodies.collider(key).map_or(0.0, |collider| collider.reach);
        let bounds = bounds.grown(CLAIM * reach);
        self.pairs_of(bodies, key, &bounds, pairs);
        self.rerouted.retain(|&(other, _)| other != key);
        for &(other, other_bounds) in &self.rerouted {
            if other_bounds.intersects(&bounds) {
                push_pair(bodies, key, other, pairs);
            }
        }
        self.rerouted.push((key, bounds));
    }

    fn pairs_of(&self, bodies: &Bodies, key: u32, bounds: &Bounds, pairs: &mut Vec<ColliderPair>) {
        let query = bounds.aabb();
        for other in self.moving.intersect_aabb(&query) {
            push_pair(bodies, key, other, pairs);
        }
        self.pairs_with_fixed(bodies, key, bounds, pairs);
    }

    fn pairs_with_fixed(&self, bodies: &Bodies, key: u32, bounds: &Bounds, pairs: &mut Vec<ColliderPair>) {
        let query = bounds.aabb();
        for other in self.fixed.intersect_aabb(&query) {
            push_pair(bodies, key, other, pairs);
        }
        for &plane in &self.planes {
            if below_plane(bodies, plane, bounds) {
                push_pair(bodies, key, plane, pairs);
            }
        }
    }
}

/// Whether the lowest corner of the box along the plane's normal is below the plane.
fn below_plane(bodies: &Bodies, plane: u32, bounds: &Bounds) -> bool {
    let Some(collider) = bodies.collider(plane) else { return false };
    let pose = bodies.center_pose(collider).then_local(&collider.local);
    let up = pose.rotation * DVec3::Y;
    let lowest = DVec3::select(up.cmpgt(DVec3::ZERO), bounds.low, bounds.high);
    (lowest - pose.position).dot(up) <= 0.0
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
    a.slot != b.slot && meet && a.filter.allows(&b.filter)
}

/// The order in which touches of one instant are handled: by bodies, then by their colliders.
pub(crate) fn order(bodies: &Bodies, (a, b): ColliderPair) -> (u32, u32, u32, u32) {
    match (bodies.collider(a), bodies.collider(b)) {
        (Some(a), Some(b)) => (a.slot, b.slot, a.index, b.index),
        _ => (u32::MAX, u32::MAX, a, b),
    }
}
