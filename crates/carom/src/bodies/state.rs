//! What users name bodies by, and read of them.

use crate::math::{DVec3, Quat, Vec3};

/// Names one body of one world, also after it has been removed: an id is never given twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl BodyId {
    /// Place in the world's table; the order in which collisions are reported.
    pub fn index(self) -> usize {
        self.index as usize
    }
}

/// Where a body is and how it moves, as of the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    pub(super) position: DVec3,
    pub(super) rotation: Quat,
    pub(super) linear_velocity: Vec3,
    pub(super) angular_velocity: Vec3,
    pub(super) asleep: bool,
}

impl BodyState {
    /// The body's origin in the world, m.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Turns the body's frame into the world's.
    pub fn rotation(&self) -> Quat {
        self.rotation
    }

    /// Velocity of the centre of mass in the world, m/s.
    pub fn linear_velocity(&self) -> Vec3 {
        self.linear_velocity
    }

    /// Angular velocity in the world, rad/s.
    pub fn angular_velocity(&self) -> Vec3 {
        self.angular_velocity
    }

    /// Whether the body was put to sleep and nothing has woken it since.
    pub fn is_asleep(&self) -> bool {
        self.asleep
    }
}
