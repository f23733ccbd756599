//! The three conditions: what must hold for every collision, whoever resolved it.

use crate::impulse::{Contact, Side, Velocity, resolve};
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

/// The three conditions of one collision, momentum in its two kinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// `v_s = −C_r·v_c`, m/s.
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

/// One body's share in the books.
struct Books {
    linear: DVec3,
    angular: DVec3,
    energy: f64,
    /// The absolute terms that make up each: what rounding is relative to.
    linear_scale: f64,
    angular_scale: f64,
    energy_scale: f64,
}

fn books(side: &Side, velocity: &Velocity, offset: DVec3) -> Books {
    let linear = if side.mass.is_finite() { side.mass * velocity.linear } else { DVec3::ZERO };
    let spin = side.inertia * velocity.angular;
    let energy = 0.5 * (linear.dot(velocity.linear) + spin.dot(velocity.angular));
    Books {
        linear,
        angular: offset.cross(linear) + spin,
        energy,
        linear_scale: linear.length(),
        angular_scale: offset.length() * linear.length() + spin.length(),
        energy_scale: energy,
    }
}

/// Holds a collision against the three conditions, angular momentum about the point `about`.
///
/// What an infinite partner takes follows from the impulse `j` of the seed's formula: `j` itself, `(p − O) × j` less what
/// its finite parts keep, and the work that its motion does, `j·v` at the point.
pub fn conditions(hit: &Hit, about: DVec3) -> Conditions {
    let Hit { a, b, contact, .. } = hit;
    let lever = hit.point - about;
    let sides = [(a, &a.velocity, &hit.after_a), (b, &b.velocity, &hit.after_b)];
    let before = sides.map(|(side, velocity, _)| books(side, velocity, lever - side.arm));
    let after = sides.map(|(side, _, velocity)| books(side, velocity, lever - side.arm));

    let formula = resolve(a, b, contact);
    let impulse_on_b = formula.fraction * contact.normal + formula.friction_impulse;
    let mut linear_to_world = DVec3::ZERO;
    let mut angular_to_world = DVec3::ZERO;
    let mut work_of_world = 0.0;
    for (side, impulse) in [(a, -impulse_on_b), (b, impulse_on_b)] {
        let twist = side.arm.cross(impulse);
        let kept_twist = side.inertia * (side.inverse_inertia * twist);
        angular_to_world += twist - kept_twist;
        let infinite_spin =
            side.velocity.angular - side.inverse_inertia * (side.inertia * side.velocity.angular);
        work_of_world -= infinite_spin.dot(twist);
        if side.mass.is_infinite() {
            linear_to_world += impulse;
            angular_to_world += (lever - side.arm).cross(impulse);
            work_of_world -= side.velocity.linear.dot(impulse);
        }
    }

    let normal = contact.normal;
    let speed = |velocity_a: &Velocity, velocity_b: &Velocity| {
        (velocity_b.at(b.arm) - velocity_a.at(a.arm)).dot(normal)
    };
    let closing = speed(&a.velocity, &b.velocity);
    let separating = speed(&hit.after_a, &hit.after_b);
    let speed_scale: f64 = sides
        .iter()
        .map(|(side, before, after)| {
            let turning = |velocity: &Velocity| {
                let spin = (side.inertia * velocity.angular).length();
                side.arm.length() * (largest(&side.inverse_inertia) * spin + velocity.angular.length())
            };
            before.linear.length() + after.linear.length() + turning(before) + turning(after)
        })
        .sum();

    let per_unit_impulse = (b.respond(normal).at_point - a.respond(-normal).at_point).dot(normal);
    let loss = if per_unit_impulse > 0.0 {
        0.5 * (1.0 - contact.restitution * contact.restitution) * closing * closing / per_unit_impulse
    } else {
        0.0
    };
    let frictionless = contact.static_friction == 0.0 && contact.dynamic_friction == 0.0;
    let total = |pick: fn(&Books) -> f64, of: &[Books; 2]| pick(&of[0]) + pick(&of[1]);
    let energy_before = total(|books| books.energy, &before);
    let energy_after = total(|books| books.energy, &after);
    let energy_expected = energy_before - loss + work_of_world;
    let energy_error = energy_after - energy_expected;
    let scale = |pick: fn(&Books) -> f64| hit.rounding * (total(pick, &before) + total(pick, &after));
    let world_energy = hit.rounding * (impulse_on_b.length() * speed_scale);

    Conditions {
        separating_speed: condition(
            (closing, separating, -contact.restitution * closing),
            (separating + contact.restitution * closing).abs(),
            hit.rounding * speed_scale,
        ),
        linear_momentum: momentum(
            before[0].linear + before[1].linear,
            after[0].linear + after[1].linear,
            linear_to_world,
            scale(|books| books.linear_scale),
        ),
        angular_momentum: momentum(
            before[0].angular + before[1].angular,
            after[0].angular + after[1].angular,
            angular_to_world,
            scale(|books| books.angular_scale) + hit.rounding * lever.length() * impulse_on_b.length(),
        ),
        energy: condition(
            (energy_before, energy_after, energy_expected),
            if frictionless { energy_error.abs() } else { energy_error.max(0.0) },
            2.0 * scale(|books| books.energy_scale) + world_energy,
        ),
        linear_to_world,
        angular_to_world,
        reference_point: about,
    }
}

fn condition((before, after, expected): (f64, f64, f64), error: f64, tolerance: f64) -> Condition<f64> {
    Condition { before, after, expected, error, tolerance, holds: error <= tolerance }
}

fn momentum(before: DVec3, after: DVec3, to_world: DVec3, tolerance: f64) -> Condition<DVec3> {
    let expected = before - to_world;
    let error = (after - expected).length();
    Condition { before, after, expected, error, tolerance, holds: error <= tolerance }
}

/// The largest stretch that a symmetric positive tensor can do is at most the sum of its diagonal.
fn largest(tensor: &crate::math::DMat3) -> f64 {
    tensor.x_axis.x + tensor.y_axis.y + tensor.z_axis.z
}
