//! The three conditions: what must hold for every collision, whoever resolved it.
//!
//! A collision by itself is a [`Hit`]. What is struck at one instant is resolved in [`Round`]s; momentum and energy then hold for
//! all bodies of a round together.

mod round;

pub use round::{Partner, Round, Strike};

use crate::impulse::{Contact, Side, Velocity};
use crate::math::DVec3;

/// A collision as it happened: the two bodies before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Where it happened, m.
    pub point: DVec3,
    /// Normal, C_r and friction.
    pub contact: Contact,
    /// `a` before.
    pub a: Side,
    /// `b` before.
    pub b: Side,
    /// `a` afterwards.
    pub after_a: Velocity,
    /// `b` afterwards.
    pub after_b: Velocity,
    /// Relative rounding of the velocities and momenta above: [`STORED`] for what the engine stores, [`DOUBLE`] for what
    /// the seed's formula returns.
    pub rounding: f64,
}

/// Relative rounding of what the engine stores: double precision, and what turning momentum into velocity and back costs.
pub const STORED: f64 = 1e-12;

/// Relative rounding of a short calculation in double precision.
pub const DOUBLE: f64 = 64.0 * f64::EPSILON;

/// How far, relative to the fastest, the speeds of several contacts of one round may be from agreeing: they come out of sweeps,
/// which end early where nothing bounces. (Momentum and energy of the round hold to rounding all the same.)
pub const AGREED: f64 = 1e-3;

/// One law, held against one collision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition<T> {
    /// The quantity before.
    pub before: T,
    /// The quantity afterwards.
    pub after: T,
    /// What it had to be afterwards.
    pub expected: T,
    /// How far `after` is from `expected`.
    pub error: f64,
    /// How far rounding alone can put it.
    pub tolerance: f64,
    /// Whether the error is within the tolerance.
    pub holds: bool,
}

/// The three conditions of one collision, or of a contact among those of its round; momentum in its two kinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// `v_s = −C_r·v_c`, m/s; `expected` is a lower bound where several contacts were struck at once.
    pub separating_speed: Condition<f64>,
    /// Σ m v, N·s, of what has finite mass.
    pub linear_momentum: Condition<DVec3>,
    /// Σ (x − O) × m v + I ω about the reference point O, N·m·s, of what has finite mass and inertia.
    pub angular_momentum: Condition<DVec3>,
    /// Σ ½ m v² + ½ ω·I ω, J, of what has finite mass and inertia. With friction `expected` is an upper bound.
    pub energy: Condition<f64>,
    /// Momentum that went into infinite masses, N·s.
    pub linear_to_world: DVec3,
    /// Angular momentum about O that went into infinite masses and inertias, N·m·s.
    pub angular_to_world: DVec3,
    /// O, m.
    pub reference_point: DVec3,
}

impl Conditions {
    /// Whether all of them hold.
    pub fn hold(&self) -> bool {
        self.separating_speed.holds
            && self.linear_momentum.holds
            && self.angular_momentum.holds
            && self.energy.holds
    }
}

/// Holds a collision against the three conditions, angular momentum about the point `about`: [`Round::conditions`] of this one
/// contact, with the impulse of the seed's formula.
pub fn conditions(hit: &Hit, about: DVec3) -> Conditions {
    Round::from(hit).conditions(0, about)
}
