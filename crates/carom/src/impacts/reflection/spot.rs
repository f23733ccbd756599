//! Bodies, the places where they touch, and what they get there.

use crate::fault;
use crate::impulse::{Contact, Resolution, Side, Velocity, resolve};
use crate::math::{DMat3, DVec3};

/// A body at the instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    /// Infinite for what no impulse can move, kg.
    pub mass: f64,
    /// Zero on axes of infinite inertia.
    pub inertia: DMat3,
    pub inverse_inertia: DMat3,
    pub velocity: Velocity,
}

impl Mover {
    /// Whether an impulse changes its velocity.
    pub(super) fn is_movable(&self) -> bool {
        self.mass.is_finite() || self.inverse_inertia != DMat3::ZERO
    }
}

/// A place where two bodies touch, or are tied.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// Which two movers.
    pub movers: [usize; 2],
    /// Lever arms, m.
    pub arms: [DVec3; 2],
    pub contact: Contact,
    /// Whether it also pulls: the row of a joint, which keeps its speed along the normal at zero.
    pub pulls: bool,
}

/// What a spot gets: the impulse on its second body, N·s, split along the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Blow {
    pub normal: f64,
    pub tangent: DVec3,
    pub sticks: bool,
}

impl Blow {
    /// What a spot gets that is struck alone.
    pub(super) fn alone(movers: &[Mover], spot: &Spot) -> Self {
        let Resolution { fraction, friction_impulse, sticks, .. } =
            resolve(&spot.side(movers, 0), &spot.side(movers, 1), &spot.contact);
        Self { normal: fraction, tangent: friction_impulse, sticks }
    }

    /// A push along the normal alone, N·s.
    pub(super) fn smooth(normal: f64) -> Self {
        Self { normal, ..Self::default() }
    }

    /// Whether it is an impulse at all.
    pub fn acts(&self) -> bool {
        self.normal != 0.0 || self.tangent != DVec3::ZERO
    }

    pub(super) fn impulse(&self, spot: &Spot) -> DVec3 {
        self.normal * spot.contact.normal + self.tangent
    }
}

impl Spot {
    /// One of its bodies, as the seed sees it.
    pub fn side(&self, movers: &[Mover], side: usize) -> Side {
        let Mover { mass, inertia, inverse_inertia, velocity } = movers[self.movers[side]];
        Side { mass, inertia, inverse_inertia, arm: self.arms[side], velocity }
    }

    /// Velocity of the second body's point against the first's, m/s.
    pub fn velocity(&self, velocities: impl Fn(usize) -> Velocity) -> DVec3 {
        velocities(self.movers[1]).at(self.arms[1]) - velocities(self.movers[0]).at(self.arms[0])
    }

    pub(super) fn is_rough(&self) -> bool {
        self.contact.static_friction > 0.0 || self.contact.dynamic_friction > 0.0
    }

    /// What the contact's own rule asks for: the least speed along the normal afterwards.
    pub(super) fn wanted(&self, before: f64) -> f64 {
        if self.pulls { 0.0 } else { fault::restitution(self.contact.restitution) * (-before).max(0.0) }
    }
}
