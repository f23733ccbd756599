//! Boxes in the world, and the box around what a collider can reach.

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::flight::fly_center;
use crate::math::{DVec3, Pose};
use crate::shape::Shape;

/// A box in the world, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: DVec3,
    pub high: DVec3,
}

impl Bounds {
    /// Meets nothing.
    pub const NOTHING: Bounds = Bounds { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };
    /// Meets everything.
    pub const EVERYTHING: Bounds = Bounds { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };

    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    pub fn grown(self, by: f64) -> Bounds {
        Bounds { low: self.low - DVec3::splat(by), high: self.high + DVec3::splat(by) }
    }

    pub fn shifted(self, by: DVec3) -> Bounds {
        Bounds { low: self.low + by, high: self.high + by }
    }

    pub fn intersects(&self, other: &Bounds) -> bool {
        self.low.cmple(other.high).all() && self.high.cmpge(other.low).all()
    }

    /// How far everything in `inner` may move without leaving this box, m.
    pub fn room_around(&self, inner: &Bounds) -> f64 {
        (inner.low - self.low).min(self.high - inner.high).min_element()
    }

    /// The same box; everything, if a bound is not a number.
    pub fn or_everything(self) -> Bounds {
        if self.low.cmple(self.high).all() { self } else { Bounds::EVERYTHING }
    }
}

/// The box around a collider at its body's present pose.
pub(super) fn present_bounds(bodies: &Bodies, collider: &ColliderRow) -> Bounds {
    if let Shape::Sphere { radius } = collider.shape
        && collider.spin_reach == 0.0
    {
        let center = bodies.center_pose(collider).position;
        return Bounds { low: center, high: center }.grown(radius);
    }
    let pose: Pose = bodies.center_pose(collider).then_local(&collider.local);
    let (low, high) = collider.shape.bounds(&pose);
    Bounds { low, high }
}

/// The box around all that a collider, whose box is now `start`, can reach in the next `time` seconds of its body's flight.
///
/// The centre of mass stays within `|a|t²/8` of the chord of its path; turning by an angle θ takes no point further
/// than `reach·min(θ, 2)`.
pub(super) fn swept_bounds(bodies: &Bodies, collider: &ColliderRow, start: Bounds, time: f64) -> Bounds {
    if collider.row == WORLD_ROW {
        return start;
    }
    let (state, constants, influence) =
        (&bodies.states[collider.row], &bodies.constants[collider.row], &bodies.influences[collider.row]);
    let (end, _) = fly_center(state, constants, influence, time);
    let bulge = influence.acceleration.length() * time * time / 8.0
        + constants.linear_damping * state.velocity.length() * time * time / 8.0;
    let turn = if collider.spin_reach == 0.0 {
        0.0
    } else {
        collider.spin_reach * (constants.spin_limit(state, influence, time) * time).min(2.0)
    };
    start.union(start.shifted(end - state.position)).grown(bulge + turn)
}
