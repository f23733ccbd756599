//! Storage of bodies.

use crate::math::{DVec3, Quat, Vec3};

/// Names one body of one world, also after it has been removed: an id is never given twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId {
    index: u32,
    generation: u32,
}

impl BodyId {
    pub(crate) fn new(index: u32, generation: u32) -> Self {
        Self { index, generation }
    }

    /// Place in the world's table; the order in which collisions are reported.
    pub fn index(self) -> usize {
        self.index as usize
    }
}

/// Where a body is and how it moves, as of the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    pub(crate) position: DVec3,
    pub(crate) rotation: Quat,
    pub(crate) linear_velocity: Vec3,
    pub(crate) angular_velocity: Vec3,
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
}
