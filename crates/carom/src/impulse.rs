//! **The seed**: two bodies, one contact, one impulse.
//!
//! How two rigid bodies bounce, in the five steps of the lecture that this engine grew out of:
//!
//! 1. Take the unit vector `n`, the collision normal, as a first, wrong impulse.
//! 2. For each body compute the change of linear and angular velocity that this impulse would cause:
//!    `Δv_l = ±n/m`, `Δv_r = ±I⁻¹(r × n)`.
//! 3. For each body, the change of velocity at the collision point: `Δv = Δv_l + Δv_r × r`.
//! 4. All of this is linear, so some multiple `f` of the impulse gives just the separating speed that is wanted:
//!    `v_s = −C_r·v_c = v_c + f·(Δv_b − Δv_a)·n`.
//! 5. Solve for `f`, and apply `v_l += f·Δv_l`, `v_r += f·Δv_r` to each body.
//!
//! And the three conditions to debug it with: the **separating velocity**, the **momentum** (linear, and angular about
//! one freely chosen point, the same for both bodies), and the **energy**.
//!
//! Everything here is a pure function of its arguments in double precision. It is what `explain` prints, what the
//! impact phase of a step applies, and what every faster path is tested against.
//!
//! # Signs
//! `normal` has unit length and points from `a` to `b`; the impulse on `b` is `+f·n`, on `a` it is `−f·n`. Speeds along
//! the normal are those of `b` against `a`: negative while the bodies close, positive while they part.

use crate::math::{DMat3, DVec3};

/// One of the two bodies at the instant of the collision. World axes, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Mass, kg. Infinite for what no impulse can move.
    pub mass: f64,
    /// Inertia about the centre of mass, kg·m²; zero on axes of infinite inertia (they take no part in the books).
    pub inertia: DMat3,
    /// Inverse inertia, 1/(kg·m²); zero on axes of infinite inertia.
    pub inverse_inertia: DMat3,
    /// Lever arm `r`: from the centre of mass to the collision point, m.
    pub arm: DVec3,
    /// Velocity before the collision.
    pub velocity: Velocity,
}

/// A rigid body's velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Of the centre of mass, m/s.
    pub linear: DVec3,
    /// Angular, rad/s.
    pub angular: DVec3,
}

impl Velocity {
    /// The velocity of the body's point at `arm` from its centre of mass: `v + ω × r`.
    pub fn at(&self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }
}

/// How the two bodies touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Unit vector from `a` to `b`.
    pub normal: DVec3,
    /// C_r, 0 to 1: separating speed over closing speed.
    pub restitution: f64,
    /// Coulomb's coefficient up to which the contact sticks.
    pub static_friction: f64,
    /// Coulomb's coefficient with which it slides.
    pub dynamic_friction: f64,
}
