//! One spot among others.

use super::{Mover, Spot};
use crate::impulse::Velocity;
use crate::math::{DMat3, DVec3, any_tangent};

/// What a spot's impulses do to its own point and to its two bodies.
pub(super) struct Row {
    /// Speed along the normal before, and the least afterwards, m/s.
    pub before: f64,
    pub wanted: f64,
    /// What a unit impulse along the normal changes that speed by, 1/kg.
    pub per_impulse: f64,
    /// What it changes the two bodies' velocities by, and the moments of the normal that a spin is measured with.
    pub gains: [Velocity; 2],
    pub moments: [DVec3; 2],
    /// K: from an impulse at the point to the change of velocity there, 1/kg.
    pub response: DMat3,
    /// K⁻¹, where there is one, kg.
    pub stiffness: Option<DMat3>,
    /// The most that an impulse across the normal changes the velocity across it, 1/kg.
    pub yielding: f64,
}

impl Row {
    pub fn new(movers: &[Mover], spot: &Spot) -> Self {
        let normal = spot.contact.normal;
        let (a, b) = (spot.side(movers, 0), spot.side(movers, 1));
        let response = a.inverse_effective_mass() + b.inverse_effective_mass();
        let first = any_tangent(normal);
        let second = normal.cross(first);
        let (bend_first, bend_second) = (response * first, response * second);
        let mean = 0.5 * (first.dot(bend_first) + second.dot(bend_second));
        let half = 0.5 * (first.dot(bend_first) - second.dot(bend_second));
        let before = (b.velocity.at(b.arm) - a.velocity.at(a.arm)).dot(normal);
        let moments = [-a.arm.cross(normal), b.arm.cross(normal)];
        Row {
            before,
            wanted: spot.wanted(before),
            per_impulse: normal.dot(response * normal),
            gains: [
                Velocity { linear: -normal / a.mass, angular: a.inverse_inertia * moments[0] },
                Velocity { linear: normal / b.mass, angular: b.inverse_inertia * moments[1] },
            ],
            moments,
            response,
            stiffness: inverse_of(&response),
            yielding: mean + half.hypot(first.dot(bend_second)),
        }
    }
}

/// The inverse of a matrix that has one: of a body that cannot be moved along some axis has none.
fn inverse_of(response: &DMat3) -> Option<DMat3> {
    const SINGULAR: f64 = 1e-9;
    let size = response.x_axis.x + response.y_axis.y + response.z_axis.z;
    (response.determinant() > SINGULAR * size.powi(3)).then(|| response.inverse())
}
