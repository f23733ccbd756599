//! Free motion: what a body does as long as nothing touches it. Exact over any stretch of time, not a sum of small steps.
//!
//! * The centre of mass follows its parabola, with damping an exponential towards its final velocity.
//! * The angular momentum `L` is the state, not the angular velocity: without torque it does not change by a single bit,
//!   and the orientation follows from it.
//!
//! # Rotation
//! With `π = RᵀL` the angular momentum in principal axes and `a` the inverse moments of inertia, the energy
//! `½ Σ aᵢπᵢ²` is split into a symmetric top about axis `k` and what is left of axis `i`:
//!
//! ```text
//! H = [½ aⱼ(πᵢ² + πⱼ²) + ½ aₖπₖ²]  +  ½ (aᵢ − aⱼ) πᵢ²
//! ```
//!
//! Both parts have closed solutions that keep `L`: the top turns about `L` at the rate `aⱼ|L|` and about its own axis at
//! `(aₖ − aⱼ)πₖ`, the rest turns about axis `i`. Composing them symmetrically to fourth order gives a step that is exact
//! for balls and symmetric bodies and errs by about (angle per step)⁵/10⁵ for the others, with an energy that
//! oscillates and does not drift. Since `L` is constant, its turns about `L` commute with the rest and are made once.
//!
//! References: Touma and Wisdom, *Lie-Poisson integrators for rigid body dynamics* (1994); Dullweber, Leimkuhler and McLachlan,
//! *Symplectic splitting methods for rigid body molecular dynamics* (1997); Blanes and Moan, *Practical symplectic
//! partitioned Runge–Kutta methods* (2002), method S6 of order 4.

use crate::fault;
use crate::mass::BodyMass;
use crate::math::{
    DMat3, DQuat, DVec3, after_inner, decay_fraction, decay_fractions, rotated_diagonal,
    rotation_from_vector, sin_cos,
};

/// Where a rigid body is and how it moves: the state that a step advances, in double precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RigidState {
    /// Centre of mass in the world, m.
    pub position: DVec3,
    /// Turns the body's frame into the world's.
    pub rotation: DQuat,
    /// Velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Angular momentum about the centre of mass, world axes, kg·m²/s.
    pub angular_momentum: DVec3,
}

impl RigidState {
    /// At the world's origin, at rest.
    pub const REST: RigidState = RigidState {
        position: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        velocity: DVec3::ZERO,
        angular_momentum: DVec3::ZERO,
    };

    #[inline]
    pub fn is_finite(&self) -> bool {
        // Zero times what is not finite is not a number.
        let vectors = self.position * 0.0 + self.velocity * 0.0 + self.angular_momentum * 0.0;
        let rotation = self.rotation * 0.0;
        vectors == DVec3::ZERO && rotation.length_squared() == 0.0
    }
}

/// What acts on a body evenly during a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Influence {
    /// Acceleration of the centre of mass, m/s².
    pub acceleration: DVec3,
    /// Torque about the centre of mass, world axes, N·m.
    pub torque: DVec3,
}

/// What of a body does not change while it flies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constants {
    /// 1/m, 1/kg; 0 where infinite.
    pub inverse_mass: f64,
    /// Decay of linear velocity, 1/s.
    pub linear_damping: f64,
    /// Decay of angular momentum, 1/s.
    pub angular_damping: f64,
    /// Gravity acts times this.
    pub gravity_factor: f64,
    /// Angular velocity on axes of infinite inertia, in principal axes, rad/s: nothing changes it.
    pub driven_spin: DVec3,
    rotor: Rotor,
}

/// How a body turns: its inertia and the split of its energy.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rotor {
    /// Inverse principal moments, 0 where infinite, 1/(kg·m²).
    inverse_moments: DVec3,
    /// Turns principal axes into the body's.
    principal: DQuat,
    /// The axis of the part that is left over, i, and that of the symmetric top, k.
    rest_axis: usize,
    top_axis: usize,
}

impl Rotor {
    fn new(mass: &BodyMass) -> Self {
        let a = mass.inverse_moments();
        let gap = |i: usize, j: usize| (a[i] - a[j]).abs();
        let (rest_axis, top_axis) = [(0, 2), (1, 0), (2, 1)]
            .into_iter()
            .min_by(|&(i, k), &(m, n)| gap(i, 3 - i - k).total_cmp(&gap(m, 3 - m - n)))
            .unwrap_or((0, 2));
        Self { inverse_moments: a, principal: mass.principal_rotation, rest_axis, top_axis }
    }

    /// Whether it turns about all axes alike: a ball, a cube.
    #[inline]
    fn is_isotropic(&self) -> bool {
        let inverse = self.inverse_moments;
        inverse.x == inverse.y && inverse.y == inverse.z
    }

    /// The principal axes in the world of a body in this orientation.
    #[inline]
    fn axes(&self, rotation: DQuat) -> DQuat {
        after_inner(rotation, self.principal)
    }

    fn common(&self) -> f64 {
        self.inverse_moments[3 - self.rest_axis - self.top_axis]
    }
}

impl Constants {
    /// The constants of what nothing can move: row 0, the world.
    pub const WORLD: Constants = Constants {
        inverse_mass: 0.0,
        linear_damping: 0.0,
        angular_damping: 0.0,
        gravity_factor: 0.0,
        driven_spin: DVec3::ZERO,
        rotor: Rotor { inverse_moments: DVec3::ZERO, principal: DQuat::IDENTITY, rest_axis: 0, top_axis: 2 },
    };

    /// The constants of a body that turns with `angular_velocity` (rad/s) in the orientation `rotation`.
    pub fn new(mass: &BodyMass, rotation: DQuat, angular_velocity: DVec3) -> Self {
        let mut constants = Self {
            inverse_mass: if mass.mass.is_finite() { 1.0 / mass.mass } else { 0.0 },
            rotor: Rotor::new(mass),
            ..Self::WORLD
        };
        constants.drive(rotation, angular_velocity);
        constants
    }

    /// Takes the part of `angular_velocity` about axes of infinite inertia as the body's driven spin.
    pub fn drive(&mut self, rotation: DQuat, angular_velocity: DVec3) {
        let local = self.rotor.axes(rotation).conjugate() * angular_velocity;
        self.driven_spin = DVec3::select(self.rotor.inverse_moments.cmpeq(DVec3::ZERO), local, DVec3::ZERO);
    }

    /// Whether an impulse can change how the body moves.
    #[inline]
    pub fn is_movable(&self) -> bool {
        self.inverse_mass > 0.0 || self.rotor.inverse_moments != DVec3::ZERO
    }

    /// The inverse inertia tensor in the world, 1/(kg·m²).
    pub fn inverse_inertia(&self, rotation: DQuat) -> DMat3 {
        let inverse_moments = self.rotor.inverse_moments;
        if self.rotor.is_isotropic() {
            return DMat3::from_diagonal(inverse_moments);
        }
        rotated_diagonal(self.rotor.axes(rotation), inverse_moments)
    }

    /// The inertia tensor in the world, kg·m², zero on axes of infinite inertia.
    pub fn inertia(&self, rotation: DQuat) -> DMat3 {
        let moments = self.rotor.inverse_moments.map(|a| if a > 0.0 { 1.0 / a } else { 0.0 });
        if self.rotor.is_isotropic() {
            return DMat3::from_diagonal(moments);
        }
        rotated_diagonal(self.rotor.axes(rotation), moments)
    }

    /// `ω = R I⁻¹Rᵀ L`, with the driven spin where the inertia is infinite; rad/s.
    #[inline]
    pub fn angular_velocity(&self, state: &RigidState) -> DVec3 {
        if self.driven_spin == DVec3::ZERO && self.rotor.is_isotropic() {
            return state.angular_momentum * self.rotor.inverse_moments.x;
        }
        self.anisotropic_velocity(state.rotation, state.angular_momentum)
    }

    fn anisotropic_velocity(&self, rotation: DQuat, momentum: DVec3) -> DVec3 {
        let axes = self.rotor.axes(rotation);
        axes * ((axes.conjugate() * momentum) * self.rotor.inverse_moments + self.driven_spin)
    }

    /// Whether mass and inertia are all finite.
    #[inline]
    pub fn is_regular(&self) -> bool {
        self.inverse_mass > 0.0 && self.rotor.inverse_moments.cmpgt(DVec3::ZERO).all()
    }

    /// Mass, kg; infinite where nothing pushes the body along.
    pub fn mass(&self) -> f64 {
        1.0 / self.inverse_mass
    }

    /// How fast an angular momentum turns the body, rad/s: `|I⁻¹Rᵀ L|`, without the driven spin.
    #[inline]
    pub fn free_spin_speed(&self, rotation: DQuat, momentum: DVec3) -> f64 {
        if self.rotor.is_isotropic() {
            return momentum.length() * self.rotor.inverse_moments.x;
        }
        let local = self.rotor.axes(rotation).conjugate() * momentum;
        (local * self.rotor.inverse_moments).length()
    }

    /// `ω = R I⁻¹Rᵀ L` of an angular momentum, without the driven spin, rad/s.
    #[inline]
    pub fn free_spin(&self, rotation: DQuat, momentum: DVec3) -> DVec3 {
        if self.rotor.is_isotropic() || momentum == DVec3::ZERO {
            return momentum * self.rotor.inverse_moments.x;
        }
        self.anisotropic_spin(rotation, momentum)
    }

    #[inline(never)]
    fn anisotropic_spin(&self, rotation: DQuat, momentum: DVec3) -> DVec3 {
        self.spin_about(&self.principal_axes(rotation), momentum)
    }

    /// The same where the principal axes in the world are known.
    #[inline]
    pub fn spin_about(&self, axes: &DMat3, momentum: DVec3) -> DVec3 {
        *axes * (axes.mul_transpose_vec3(momentum) * self.rotor.inverse_moments)
    }

    /// How far (rad) the body turns in `time` (s) where its angular momentum gets `kick` before it turns, which makes it `momentum`, and
    /// `kick` again when it has turned: over this turn a torque does the work of both kicks.
    ///
    /// With `S` the inverse inertia in the mean orientation and `φ = tSL` that is the mean of the angular velocities during both, half a
    /// turn before and after, `t·SL + ¼t·(φ × Sk − S(φ × k))`, but for the square of the turn.
    #[inline]
    pub fn turn_of_kicks(&self, rotation: DQuat, [momentum, kick]: [DVec3; 2], time: f64) -> DVec3 {
        let inverse = self.rotor.inverse_moments;
        let axes = self.principal_axes(rotation);
        let (momentum, kick) = (axes.mul_transpose_vec3(momentum), axes.mul_transpose_vec3(kick));
        let turn = time * (inverse * momentum);
        let change = turn.cross(inverse * kick) - inverse * turn.cross(kick);
        axes * (turn + 0.25 * time * change)
    }

    /// The energy (J) with which an angular momentum turns the body in this orientation, without the driven spin.
    #[inline]
    pub fn spin_energy(&self, rotation: DQuat, momentum: DVec3) -> f64 {
        if self.rotor.is_isotropic() {
            return 0.5 * momentum.dot(momentum * self.rotor.inverse_moments.x);
        }
        self.spin_energy_about(&self.principal_axes(rotation), momentum)
    }

    /// The same where the principal axes in the world are known: `½ Σ aᵢπᵢ²`.
    #[inline]
    pub fn spin_energy_about(&self, axes: &DMat3, momentum: DVec3) -> f64 {
        let local = axes.mul_transpose_vec3(momentum);
        0.5 * (local * local).dot(self.rotor.inverse_moments)
    }

    /// The principal axes in the world.
    #[inline]
    pub fn principal_axes(&self, rotation: DQuat) -> DMat3 {
        DMat3::from_quat(self.rotor.axes(rotation))
    }

    /// Whether the body turns about all axes alike, so that turning does not change its angular velocity.
    #[inline]
    pub fn is_isotropic(&self) -> bool {
        self.rotor.is_isotropic()
    }

    /// The driven spin in the world, rad/s.
    pub fn driven_velocity(&self, rotation: DQuat) -> DVec3 {
        self.rotor.axes(rotation) * self.driven_spin
    }

    /// What of an angular impulse (world axes) turns the body: nothing about axes of infinite inertia.
    #[inline]
    pub fn turning_part(&self, rotation: DQuat, impulse: DVec3) -> DVec3 {
        let finite = self.rotor.inverse_moments.cmpgt(DVec3::ZERO);
        if finite.all() {
            return impulse;
        }
        let axes = self.rotor.axes(rotation);
        axes * DVec3::select(finite, axes.conjugate() * impulse, DVec3::ZERO)
    }

    /// Whether a body with this angular momentum turns.
    #[inline]
    fn spins(&self, momentum: DVec3) -> bool {
        momentum != DVec3::ZERO || self.driven_spin != DVec3::ZERO
    }

    /// Whether the body only drifts along: nothing but its position changes.
    #[inline]
    pub fn drifts(&self, state: &RigidState, influence: &Influence) -> bool {
        !self.spins(state.angular_momentum)
            && *influence == Influence::default()
            && self.linear_damping == 0.0
    }

    /// A speed of turning (rad/s) that the body does not exceed within `time` seconds.
    ///
    /// While it turns freely `ω ≤ a_max·|L|`, and `ω² ≤ 2E·a_max` (from `2E = ω·Iω`), which is never more; a torque adds `a_max·|T|` a
    /// second.
    #[inline]
    pub fn spin_limit(&self, state: &RigidState, influence: &Influence, time: f64) -> f64 {
        if !self.spins(state.angular_momentum) && influence.torque == DVec3::ZERO {
            return 0.0;
        }
        self.spin_limit_of_turning(state, influence, time)
    }

    #[inline(never)]
    fn spin_limit_of_turning(&self, state: &RigidState, influence: &Influence, time: f64) -> f64 {
        let (largest, momentum) = (self.rotor.inverse_moments.max_element(), state.angular_momentum);
        let mut free = largest * momentum.length();
        // However slowly it turns: how closely contacts are looked at goes by this, and with the coarser limit wedges came to rest over
        // what they did not touch.
        if !self.rotor.is_isotropic() {
            let local = self.rotor.axes(state.rotation).conjugate() * momentum;
            free = free.min((largest * (local * local).dot(self.rotor.inverse_moments)).sqrt());
        }
        free + self.driven_spin.length() + largest * influence.torque.length() * time
    }
}

/// The state after `time` seconds of flight.
#[inline]
pub(crate) fn fly(state: &RigidState, constants: &Constants, influence: &Influence, time: f64) -> RigidState {
    if time <= 0.0 {
        return *state;
    }
    let (position, velocity) = fly_center(state, constants, influence, time);
    let kick = 0.5 * time * influence.torque;
    let momentum = fault::spin(state.angular_momentum) + kick;
    let decay = decay_fraction(constants.angular_damping * time);
    let turning_time = time * decay;
    let rotation = if constants.spins(momentum) {
        turn(state.rotation, momentum, constants, turning_time)
    } else {
        state.rotation
    };
    let left = 1.0 - constants.angular_damping * turning_time;
    RigidState { position, rotation, velocity, angular_momentum: momentum * left + kick }
}

/// Position and velocity of the centre of mass after `time` seconds: of `dv/dt = a − c·v`,
///
/// ```text
/// v(t) = v₀·e^(−ct) + a·tφ      x(t) = x₀ + v₀·tφ + a·t²ψ      φ = (1 − e^(−ct))/ct      ψ = (1 − φ)/ct → ½
/// ```
#[inline]
pub(crate) fn fly_center(
    state: &RigidState,
    constants: &Constants,
    influence: &Influence,
    time: f64,
) -> (DVec3, DVec3) {
    if time == 0.0 {
        return (state.position, state.velocity);
    }
    let decay = constants.linear_damping * time;
    let [fraction, second, _] = decay_fractions(decay);
    let (v, a) = (state.velocity, fault::gravity(influence.acceleration));
    let position = state.position + v * (time * fraction) + a * (time * time * second);
    (position, v * (1.0 - decay * fraction) + a * (time * fraction))
}

/// Where the centre of mass is in the mean over a flight of `time` seconds:
///
/// ```text
/// x₀ + v₀·tψ + a·t²χ      χ = (½ − ψ)/ct → 1/6
/// ```
#[inline]
pub(crate) fn mean_center(
    state: &RigidState,
    constants: &Constants,
    influence: &Influence,
    time: f64,
) -> DVec3 {
    let decay = constants.linear_damping * time;
    let [_, second, third] = decay_fractions(decay);
    state.position + state.velocity * (time * second) + influence.acceleration * (time * time * third)
}

/// Angle (rad) of the asymmetric part of the turn up to which one composed step is taken.
const TURN_PER_STEP: f64 = 0.5;

/// Angle (rad) up to which the axis of the turn need not be followed as it wanders: what lies in a pile. Off by the square of it at most.
const SLIGHT_TURN: f64 = 1e-6;

/// Angle (rad) of the asymmetric part up to which three stages are as good as thirteen: off by 4e-8 rad.
const SMALL_TURN: f64 = 1e-2;

/// So many composed steps are made at most; a body that needs more spins 10⁴ times faster than a frame can show.
const TURN_STEPS: f64 = 1024.0;

/// The orientation after turning for `time` seconds with the constant angular momentum `momentum`.
fn turn(rotation: DQuat, momentum: DVec3, constants: &Constants, time: f64) -> DQuat {
    let rotor = &constants.rotor;
    if constants.driven_spin == DVec3::ZERO && rotor.is_isotropic() {
        return (rotation_from_vector(momentum * (rotor.common() * time)) * rotation).normalize();
    }
    let most = rotor.inverse_moments.max_element() * momentum.length() + constants.driven_spin.length();
    if most * time <= SLIGHT_TURN {
        let [x, y, z] = (constants.anisotropic_velocity(rotation, momentum) * (0.5 * time)).to_array();
        return (DQuat::from_xyzw(x, y, z, 1.0) * rotation).normalize();
    }
    let driven = rotation_from_vector(constants.driven_spin * (0.5 * time));
    let axes = after_inner(rotor.axes(rotation), driven);

    let common = rotor.common();
    let mut local = axes.conjugate() * momentum;
    let rest = rotor.inverse_moments[rotor.rest_axis] - common;
    let top = rotor.inverse_moments[rotor.top_axis] - common;
    let mut spin = DQuat::IDENTITY;
    let about = |spin: &DQuat| {
        let about_momentum = rotation_from_vector(momentum * (common * time));
        let turned = after_inner(about_momentum * axes * *spin, driven);
        after_inner(turned, rotor.principal.conjugate()).normalize()
    };
    if rest == 0.0 && top == 0.0 {
        return about(&spin);
    } else if rest == 0.0 {
        turn_about(&mut spin, &mut local, rotor.top_axis, top * time);
    } else {
        let angle = (rest.abs() + top.abs()) * momentum.length() * time;
        let (first, second) = ((rotor.rest_axis, rest * time), (rotor.top_axis, top * time));
        if angle <= SMALL_TURN {
            // Strang's three stages err by angle³/24.
            turn_about(&mut spin, &mut local, first.0, 0.5 * first.1);
            turn_about(&mut spin, &mut local, second.0, second.1);
            turn_about(&mut spin, &mut local, first.0, 0.5 * first.1);
            return about(&spin);
        }
        let steps = (angle / TURN_PER_STEP).ceil().clamp(1.0, TURN_STEPS);
        for _ in 0..steps as usize {
            for stage in 0..13 {
                let share = COMPOSITION[if stage < 7 { stage } else { 12 - stage }];
                let (axis, rate) = if stage % 2 == 0 { first } else { second };
                turn_about(&mut spin, &mut local, axis, rate * share / steps);
            }
        }
    }
    about(&spin)
}

/// Shares of the step for the stages of Blanes and Moan's S6, left half and middle; even stages are the rest, odd the top.
const COMPOSITION: [f64; 7] = {
    let (a1, a2, a3) = (0.079_203_696_431_195_7, 0.353_172_906_049_774, -0.042_065_080_357_719_5);
    let (b1, b2) = (0.209_515_106_613_362, -0.143_851_773_179_818);
    [a1, b1, a2, b2, a3, 0.5 - (b1 + b2), 1.0 - 2.0 * (a1 + a2 + a3)]
};

/// Turns the body about its principal `axis` at the rate `rate_per_momentum·π` while π stays fixed in the world.
fn turn_about(spin: &mut DQuat, local: &mut DVec3, axis: usize, rate_per_momentum: f64) {
    let angle = rate_per_momentum * local[axis];
    let (sine, cosine) = sin_cos(0.5 * angle);
    let mut turn = [0.0, 0.0, 0.0, cosine];
    turn[axis] = sine;
    let turn = DQuat::from_array(turn);
    *spin *= turn;
    let (s, c) = (2.0 * sine * cosine, cosine * cosine - sine * sine);
    let (m, n) = ((axis + 1) % 3, (axis + 2) % 3);
    let (x, y) = (local[m], local[n]);
    local[m] = c * x + s * y;
    local[n] = c * y - s * x;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_turn_keeps_its_rotation_to_the_bit() {
        let mass = BodyMass { mass: 2.0, moments: DVec3::new(1.0, 2.0, 3.0), ..BodyMass::INFINITE };
        let rotation = rotation_from_vector(DVec3::new(0.3, -1.2, 0.8));
        let constants = Constants::new(&mass, rotation, DVec3::ZERO);
        let start = RigidState { rotation, velocity: DVec3::new(1.0, 2.0, 3.0), ..RigidState::REST };
        let influence = Influence::default();
        assert!(constants.drifts(&start, &influence));
        let end = fly(&start, &constants, &influence, 0.7);
        assert_eq!(end, RigidState { position: start.velocity * 0.7, ..start });
        assert_eq!(constants.spin_limit(&start, &influence, 0.7), 0.0);
    }

    #[test]
    fn what_turns_about_all_axes_alike_does_as_the_general_body_does() {
        let moments = DVec3::splat(0.4);
        let axes = rotation_from_vector(DVec3::new(0.1, 0.7, -0.4));
        let rotation = rotation_from_vector(DVec3::new(-0.5, 0.2, 1.1));
        let ball = BodyMass { mass: 2.0, moments, principal_rotation: axes, ..BodyMass::INFINITE };
        let nearly = BodyMass { moments: moments + DVec3::new(0.0, 1e-13, 2e-13), ..ball };
        let [ball, nearly] = [ball, nearly].map(|mass| Constants::new(&mass, rotation, DVec3::ZERO));
        let start = RigidState { rotation, angular_momentum: DVec3::new(1.0, -2.0, 0.5), ..RigidState::REST };
        let [one, other] = [&ball, &nearly].map(|it| fly(&start, it, &Influence::default(), 0.3).rotation);
        assert!((one - other).length() < 1e-11, "{one} against {other}");
        let [one, other] = [&ball, &nearly].map(|it| it.angular_velocity(&start));
        assert!((one - other).length() < 1e-11, "{one} against {other}");
        let [one, other] = [&ball, &nearly].map(|it| it.inertia(rotation) * DVec3::ONE);
        assert!((one - other).length() < 1e-11, "{one} against {other}");
    }

    #[test]
    fn a_slight_turn_is_what_the_composition_makes_of_it() {
        let mass = BodyMass { mass: 1.0, moments: DVec3::new(1.0, 2.0, 3.0), ..BodyMass::INFINITE };
        let rotation = rotation_from_vector(DVec3::new(-0.5, 0.2, 1.1));
        let mut constants = Constants::new(&mass, rotation, DVec3::ZERO);
        let momentum = DVec3::new(0.2, -0.4, 0.3);
        for spin in [DVec3::ZERO, DVec3::new(0.1, 0.0, -0.2)] {
            constants.driven_spin = spin;
            let slight = |time: f64| (turn(rotation, momentum, &constants, time) - rotation) / time;
            // Just above the limit and just below it: as fast, about the same axis.
            let [above, below] = [slight(3e-6), slight(1e-6)];
            assert!((above - below).length() < 3e-6 * above.length(), "{above} against {below}");
            assert!((turn(rotation, momentum, &constants, 0.5e-6).length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn two_kicks_work_over_the_mean_of_the_turns_that_they_would_make() {
        let mass = BodyMass { mass: 1.0, moments: DVec3::new(1.0, 2.0, 3.0), ..BodyMass::INFINITE };
        let constants = Constants::new(&mass, DQuat::IDENTITY, DVec3::ZERO);
        let start = RigidState {
            rotation: rotation_from_vector(DVec3::new(-0.5, 0.2, 1.1)),
            angular_momentum: DVec3::new(0.2, -0.4, 0.3),
            ..RigidState::REST
        };
        let (time, torque) = (1e-5, 0.5e5 * DVec3::new(0.7, 0.3, 0.4));
        let end = fly(&start, &constants, &Influence { torque, ..Influence::default() }, time);
        let kick = 0.5 * time * torque;
        let spin = |rotation, momentum| constants.free_spin(rotation, momentum);
        let [first, last] = [(&start, 0.5 * kick), (&end, -0.5 * kick)]
            .map(|(state, more)| spin(state.rotation, state.angular_momentum + more));
        let middle = (start.rotation + end.rotation) * 0.5;
        let turn = constants.turn_of_kicks(middle, [start.angular_momentum + kick, kick], time);
        let error = (turn / time - 0.5 * (first + last)).length();
        assert!(error < 1e-10 * first.length(), "{error}");
    }

    #[test]
    fn the_composition_is_of_fourth_order_and_keeps_the_energy() {
        let mass = BodyMass { mass: 1.0, moments: DVec3::new(1.0, 2.0, 3.0), ..BodyMass::INFINITE };
        let constants = Constants::new(&mass, DQuat::IDENTITY, DVec3::ZERO);
        let start = RigidState { angular_momentum: DVec3::new(0.2, 0.5, 0.3), ..RigidState::REST };
        let energy = |state: &RigidState| constants.angular_velocity(state).dot(state.angular_momentum);
        let after = |steps: usize| {
            let mut state = start;
            for _ in 0..steps {
                state = fly(&state, &constants, &Influence::default(), 8.0 / steps as f64);
            }
            state
        };
        // Any finer, and the three stages for small turns would take over.
        let truth = after(256);
        let error = |steps| (after(steps).rotation - truth.rotation).length();
        let (coarse, fine) = (error(16), error(32));
        assert!(coarse < 1e-4 && (13.0..20.0).contains(&(coarse / fine)), "{coarse} {fine}");
        assert!((energy(&truth) / energy(&start) - 1.0).abs() < 1e-12);
    }
}
