//! What a step has to tell.

use crate::bodies::BodyId;
use crate::conditions::{Hit, SINGLE};
use crate::impulse::{Contact, Resolution, Side, Velocity, resolve};
use crate::math::{DVec3, Pose};

/// Where on a shape a contact lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A smooth surface: a ball, a capsule's side, a plane.
    Surface,
    /// A corner, numbered by the shape. A cuboid's corner has bit 0, 1, 2 set where x, y, z is positive.
    Vertex(u32),
    /// An edge, numbered by the shape.
    Edge(u32),
    /// A flat face, numbered by the shape. A cuboid's faces are −x, +x, −y, +y, −z, +z.
    Face(u32),
}

/// A collision that was resolved: a first touch of two bodies that closed faster than the rest threshold.
///
/// Holds all that the seed's formula needs, so that [`Impact::resolve`] gives its five steps again.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Simulated time at which it happened, s.
    pub time: f64,
    /// The body that joined the world before `b` (by index).
    pub a: BodyId,
    /// The other body.
    pub b: BodyId,
    /// Which of `a`'s colliders was struck.
    pub collider_a: u32,
    /// Which of `b`'s colliders was struck.
    pub collider_b: u32,
    /// What of `a` was struck.
    pub feature_a: Feature,
    /// What of `b` was struck.
    pub feature_b: Feature,
    /// Where, in the world, m.
    pub point: DVec3,
    /// Distance of the surfaces along the normal at that instant, m: rounding, above or below zero.
    pub separation: f64,
    /// Normal (from `a` to `b`), C_r and friction as used.
    pub contact: Contact,
    /// `a` as it came.
    pub side_a: Side,
    /// `b` as it came.
    pub side_b: Side,
    /// Centre of mass and orientation of `a`'s frame at that instant.
    pub pose_a: Pose,
    /// Centre of mass and orientation of `b`'s frame at that instant.
    pub pose_b: Pose,
    /// `a` as it left: what the engine has stored, single precision and all.
    pub after_a: Velocity,
    /// `b` as it left.
    pub after_b: Velocity,
    /// How many contacts were struck at that instant together with this one, itself included.
    pub together: u32,
    /// In which round of that instant this one was resolved, from 0.
    pub round: u32,
}

impl Impact {
    /// The seed's five steps for this collision, in double precision.
    pub fn resolve(&self) -> Resolution {
        resolve(&self.side_a, &self.side_b, &self.contact)
    }

    /// The collision as the engine has carried it out, for [`conditions`](crate::conditions::conditions).
    pub fn hit(&self) -> Hit {
        Hit {
            point: self.point,
            contact: self.contact,
            a: self.side_a,
            b: self.side_b,
            after_a: self.after_a,
            after_b: self.after_b,
            rounding: SINGLE,
        }
    }
}
