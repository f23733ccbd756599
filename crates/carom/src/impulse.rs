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

use crate::fault;
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

impl Side {
    /// Step 2 and 3: what the unit impulse along `direction` at the collision point would do to this body.
    ///
    /// ```text
    /// Δv_l = direction/m      Δv_r = I⁻¹(r × direction)      Δv = Δv_l + Δv_r × r
    /// ```
    pub fn respond(&self, direction: DVec3) -> UnitResponse {
        let linear = direction / self.mass;
        let angular = self.inverse_inertia * self.arm.cross(direction);
        UnitResponse { linear, angular, at_point: linear + angular.cross(self.arm) }
    }

    /// The velocity after `impulse` (N·s) has acted at the collision point.
    pub fn after(&self, impulse: DVec3) -> Velocity {
        Velocity {
            linear: self.velocity.linear + impulse / self.mass,
            angular: self.velocity.angular + self.inverse_inertia * self.arm.cross(impulse),
        }
    }

    /// `K`: the matrix that takes an impulse at the collision point to the change of velocity there.
    ///
    /// `K = 1/m + [r]ᵀ I⁻¹ [r]`, column by column the response to an impulse along each axis; symmetric.
    pub(crate) fn inverse_effective_mass(&self) -> DMat3 {
        DMat3::from_cols(
            self.respond(DVec3::X).at_point,
            self.respond(DVec3::Y).at_point,
            self.respond(DVec3::Z).at_point,
        )
    }
}

/// What a unit impulse does to one body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UnitResponse {
    /// Change of linear velocity, Δv_l, 1/kg.
    pub linear: DVec3,
    /// Change of angular velocity, Δv_r, 1/(kg·m).
    pub angular: DVec3,
    /// Change of velocity at the collision point, Δv, 1/kg.
    pub at_point: DVec3,
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

/// A collision taken apart: what the five steps found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// v_c: speed of `b` against `a` along the normal, before, m/s. Negative.
    pub closing_speed: f64,
    /// What the unit impulse −n does to `a`.
    pub response_a: UnitResponse,
    /// What the unit impulse +n does to `b`.
    pub response_b: UnitResponse,
    /// f: how many of these unit impulses it takes; with friction, all of the impulse along the normal. N·s.
    pub fraction: f64,
    /// The tangential impulse on `b`, N·s; `a` gets its opposite.
    pub friction_impulse: DVec3,
    /// Whether friction brought the points to a common tangential velocity.
    pub sticks: bool,
    /// `a` afterwards.
    pub after_a: Velocity,
    /// `b` afterwards.
    pub after_b: Velocity,
    /// v_s: speed of `b` against `a` along the normal, afterwards, m/s.
    pub separating_speed: f64,
}

/// Resolves a collision: the impulse after which the two points part with `v_s = −C_r·v_c`.
///
/// Without friction the impulse is `f·n`, in the lecture's five steps:
///
/// ```text
/// f = −(1 + C_r)·v_c / ((Δv_b − Δv_a)·n)        v_l += f·Δv_l      v_r += f·Δv_r
/// ```
///
/// With friction the impulse also has a part across the normal, which sticks or slides on Coulomb's cone; the normal
/// speeds obey the same rule. Bodies that already part are left
/// alone (a contact pushes, it never pulls), and so are two bodies that nothing can move.
///
/// # Books
/// Momentum: `+j` on `b`, `−j` on `a` at one point, so linear and angular momentum are conserved to rounding.
/// Energy: changes by `−(1 − C_r²)·v_c² / 2K` without friction, where `K = (Δv_b − Δv_a)·n`; zero for C_r = 1, and with
/// friction never more than that.
///
/// # Reference
/// Mirtich, *Impulse-based Dynamic Simulation of Rigid Body Systems* (1996), ch. 3.
///
/// # Example
/// Newton's cradle: equal masses and C_r = 1 trade velocities.
/// ```
/// use carom::impulse::{Contact, Side, Velocity, resolve};
/// use carom::math::{DMat3, DVec3};
/// let ball = |speed: f64, arm: f64| Side {
///     mass: 2.0,
///     inertia: DMat3::IDENTITY * 0.2,
///     inverse_inertia: DMat3::IDENTITY * 5.0,
///     arm: DVec3::X * arm,
///     velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO },
/// };
/// let contact = Contact { normal: DVec3::X, restitution: 1.0, static_friction: 0.0, dynamic_friction: 0.0 };
/// let hit = resolve(&ball(1.0, 0.5), &ball(0.0, -0.5), &contact);
/// assert_eq!(hit.fraction, 2.0); // N·s: all of a's momentum
/// assert_eq!(hit.after_b.linear, DVec3::X);
/// ```
pub fn resolve(a: &Side, b: &Side, contact: &Contact) -> Resolution {
    let normal = contact.normal;
    let closing_speed = speed_along(normal, a, &a.velocity, b, &b.velocity);
    let (response_a, response_b) = (a.respond(-normal), b.respond(normal));
    let per_unit_impulse = (response_b.at_point - response_a.at_point).dot(normal);

    let mut impulse = Impulse { normal: 0.0, tangent: DVec3::ZERO, sticks: false };
    if closing_speed < 0.0 && per_unit_impulse > 0.0 {
        impulse.normal = -(1.0 + fault::restitution(contact.restitution)) * closing_speed / per_unit_impulse;
        if contact.static_friction > 0.0 || contact.dynamic_friction > 0.0 {
            impulse = with_friction(a, b, contact, impulse.normal);
        }
    }

    let total = impulse.normal * normal + impulse.tangent;
    let (after_a, after_b) = (a.after(-total), b.after(total));
    Resolution {
        closing_speed,
        response_a,
        response_b,
        fraction: impulse.normal,
        friction_impulse: impulse.tangent,
        sticks: impulse.sticks,
        after_a,
        after_b,
        separating_speed: speed_along(normal, a, &after_a, b, &after_b),
    }
}

/// The impulse on `b`, split along the normal.
struct Impulse {
    normal: f64,
    tangent: DVec3,
    sticks: bool,
}

/// Speed of `b`'s point against `a`'s along `normal`: negative while they close.
fn speed_along(normal: DVec3, a: &Side, velocity_a: &Velocity, b: &Side, velocity_b: &Velocity) -> f64 {
    (velocity_b.at(b.arm) - velocity_a.at(a.arm)).dot(normal)
}

/// The impulse with Coulomb friction: sticks, or slides on the cone. Never gains energy.
///
/// With `u` the velocity of `b`'s point against `a`'s and `K` the matrix that takes an impulse to its change:
///
/// * *Stick*: the impulse `j = K⁻¹(u⁺ − u)` that ends all slip, `u⁺ = −C_r·(u·n)·n`, if it lies within the cone of static
///   friction.
/// * *Slide*: every impulse that keeps to Newton's rule and pushes against the slip direction `t` lies on the line
///   `j = f·n + s·w`, `w = κn − t`, `κ = (n·Kt)/(n·Kn)`, since `n·Kw = 0`. Friction goes along it until it meets the cone,
///   `s = μ(f + κs)`, or the slip along `t` ends, whichever is first.
///
/// Newton's rule and Coulomb's law together can *create* energy when a body is struck off its centre (Kane and
/// Levinson 1985, Stronge 1990). So neither impulse is taken further than energy allows. Along the line the energy
/// changes by `s·(w·u⁰) + ½s²·(w·Kw)` with `u⁰` the velocity after the impulse `f·n` alone; friction ends where this
/// would become positive. What is left is at least the loss of the same collision without friction,
/// `½(1 − C_r²)·v_c²/(n·Kn)`.
fn with_friction(a: &Side, b: &Side, contact: &Contact, frictionless: f64) -> Impulse {
    let normal = contact.normal;
    let k = a.inverse_effective_mass() + b.inverse_effective_mass();
    let slip_velocity = b.velocity.at(b.arm) - a.velocity.at(a.arm);
    let without = slip_velocity + frictionless * (k * normal);
    let tangential = without - without.dot(normal) * normal;

    let stick = stick_impulse(&k, tangential, normal);
    if let Some(extra) = stick {
        let along = frictionless + extra.dot(normal);
        let tangent = extra - extra.dot(normal) * normal;
        let in_cone = along > 0.0 && tangent.length() <= contact.static_friction * along;
        if in_cone && extra.dot(without) + 0.5 * extra.dot(k * extra) <= 0.0 {
            return Impulse { normal: along, tangent, sticks: true };
        }
    }

    let slip = slip_velocity - slip_velocity.dot(normal) * normal;
    let speeds = slip_velocity.length() + without.length();
    let direction = if slip.length() > 1e-12 * speeds {
        slip.normalize()
    } else if let Some(push) = stick.map(|extra| extra - extra.dot(normal) * normal)
        && push.length() > 0.0
    {
        -push.normalize()
    } else {
        return Impulse { normal: frictionless, tangent: DVec3::ZERO, sticks: false };
    };

    let kappa = normal.dot(k * direction) / normal.dot(k * normal);
    let line = kappa * normal - direction;
    let bend = k * line;
    let mut reach = f64::INFINITY;
    let friction = fault::friction(contact.dynamic_friction);
    let cone = 1.0 - friction * kappa;
    if cone > 0.0 {
        reach = friction * frictionless / cone;
    }
    let slowing = -direction.dot(bend);
    if slowing > 0.0 {
        reach = reach.min(without.dot(direction).max(0.0) / slowing);
    }
    let stiffness = 0.5 * line.dot(bend);
    let allowed = if stiffness > 0.0 { -line.dot(without) / stiffness } else { 0.0 };
    reach = reach.min(allowed).max(0.0);
    Impulse { normal: frictionless + reach * kappa, tangent: -reach * direction, sticks: false }
}

/// The impulse that takes away the tangential velocity and leaves the normal one: `K⁻¹(−tangential)`. None where no
/// impulse can (`K` is singular when a body of infinite mass turns about some axes only).
fn stick_impulse(k: &DMat3, tangential: DVec3, normal: DVec3) -> Option<DVec3> {
    let scale = normal.dot(*k * normal).max(k.x_axis.x).max(k.y_axis.y).max(k.z_axis.z);
    let determinant = k.determinant();
    (determinant > 1e-12 * scale * scale * scale).then(|| k.inverse() * -tangential)
}
