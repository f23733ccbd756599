//! Contacts that press on each other: impulses found row by row until they agree.
//!
//! A contact point asks for a least velocity along its normal and, through friction, for no velocity across it. Each
//! row is the seed's formula with another right-hand side: the impulse that gives this one point what it asks for,
//! `λ += (wanted − v)/K`, kept within what a contact can do (it pushes, and friction stays on Coulomb's cone). Projected
//! Gauss–Seidel over all rows (Jourdan, Alart and Jean 1998; Catto 2005).

use crate::math::{DMat3, DVec3, any_tangent};

/// A body in the solver: mass and velocity, nothing else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    pub inverse_mass: f64,
    pub inverse_inertia: DMat3,
    pub linear: DVec3,
    pub angular: DVec3,
}

impl Mover {
    fn at(&self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }

    fn push(&mut self, arm: DVec3, impulse: DVec3) {
        self.linear += impulse * self.inverse_mass;
        self.angular += self.inverse_inertia * arm.cross(impulse);
    }

    fn response(&self, arm: DVec3, direction: DVec3) -> DVec3 {
        direction * self.inverse_mass + (self.inverse_inertia * arm.cross(direction)).cross(arm)
    }
}

/// One contact point between two movers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactRow {
    /// Indices of the movers.
    pub a: usize,
    pub b: usize,
    pub arm_a: DVec3,
    pub arm_b: DVec3,
    /// From a to b.
    pub normal: DVec3,
    pub static_friction: f64,
    pub dynamic_friction: f64,
    /// The least velocity along the normal that the point may have, m/s.
    pub least_velocity: f64,
    /// Impulse along the normal, N·s.
    pub pressure: f64,
    /// Impulse across it, N·s.
    pub friction: DVec3,
}

/// How far the solver goes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Sweeps over all rows at most.
    pub sweeps: usize,
    /// It is done when no row changes its velocity by more than this in a sweep, m/s.
    pub agreement: f64,
}

/// Finds the impulses of all rows and applies them to the movers. Rows start from the impulses that they hold.
pub(crate) fn solve(movers: &mut [Mover], rows: &mut [ContactRow], effort: Effort) {
    for row in rows.iter() {
        apply(movers, row, row.pressure * row.normal + row.friction);
    }
    for _ in 0..effort.sweeps {
        let mut largest = 0.0_f64;
        for row in rows.iter_mut() {
            largest = largest.max(solve_normal(movers, row));
            largest = largest.max(solve_friction(movers, row));
        }
        if largest <= effort.agreement {
            break;
        }
    }
}

fn apply(movers: &mut [Mover], row: &ContactRow, impulse: DVec3) {
    movers[row.a].push(row.arm_a, -impulse);
    movers[row.b].push(row.arm_b, impulse);
}

fn relative_velocity(movers: &[Mover], row: &ContactRow) -> DVec3 {
    movers[row.b].at(row.arm_b) - movers[row.a].at(row.arm_a)
}

fn response(movers: &[Mover], row: &ContactRow, direction: DVec3) -> DVec3 {
    movers[row.a].response(row.arm_a, direction) + movers[row.b].response(row.arm_b, direction)
}

/// Brings the normal velocity up to what is wanted; returns how much it changed.
fn solve_normal(movers: &mut [Mover], row: &mut ContactRow) -> f64 {
    let per_impulse = response(movers, row, row.normal).dot(row.normal);
    if per_impulse <= 0.0 {
        return 0.0;
    }
    let missing = row.least_velocity - relative_velocity(movers, row).dot(row.normal);
    let pressure = (row.pressure + missing / per_impulse).max(0.0);
    let change = pressure - row.pressure;
    row.pressure = pressure;
    apply(movers, row, change * row.normal);
    (change * per_impulse).abs()
}

/// Takes away the tangential velocity as far as the cone allows; returns how much it changed.
///
/// The correction is along the slip itself, over the largest response in the tangent plane: were it `K⁻¹·slip`, a sliding
/// point would settle on a force that is askew of its slip, which no surface exerts (de Saxcé and Feng 1998).
fn solve_friction(movers: &mut [Mover], row: &mut ContactRow) -> f64 {
    if row.static_friction == 0.0 && row.dynamic_friction == 0.0 {
        return 0.0;
    }
    let velocity = relative_velocity(movers, row);
    let first = any_tangent(row.normal);
    let second = row.normal.cross(first);
    let (along_first, along_second) = (response(movers, row, first), response(movers, row, second));
    let (k11, k12, k22) = (along_first.dot(first), along_first.dot(second), along_second.dot(second));
    let stiffest = 0.5 * (k11 + k22) + (0.25 * (k11 - k22) * (k11 - k22) + k12 * k12).sqrt();
    if stiffest <= 0.0 {
        return 0.0;
    }
    let slip = velocity - velocity.dot(row.normal) * row.normal;
    let change = slip / -stiffest;
    let mut friction = row.friction + change;
    let size = friction.length();
    if size > row.static_friction * row.pressure {
        let allowed = row.dynamic_friction * row.pressure;
        friction *= if size > allowed { allowed / size } else { 1.0 };
    }
    let change = friction - row.friction;
    row.friction = friction;
    apply(movers, row, change);
    change.length() * stiffest
}
