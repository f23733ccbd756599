//! How each body has moved through a step: from its state at the start through its collisions to its state at the end.
//!
//! Between two of these *knots* it flies, unless something that rests touches it: then velocities follow from gravity and
//! damping, the centre from its parabola, and the angular momentum stays. The formulas here are the audit's own.

use super::law::ROUNDING;
use super::strike::{Party, Strike};
use carom::impulse::Velocity;
use carom::math::{DQuat, DVec3, Pose};
use carom::{BodyId, Motion, World};
use std::collections::BTreeMap;

/// A body at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    pub(super) time: f64,
    /// Centre of mass, and orientation of the body's frame.
    pub(super) pose: Pose,
    pub(super) before: Velocity,
    pub(super) after: Velocity,
}

/// A body through a step.
pub(super) struct Course {
    pub(super) id: BodyId,
    pub(super) motion: Motion,
    /// Whether an impulse can change how it moves.
    pub(super) is_movable: bool,
    /// Infinite for what is not dynamic, kg.
    pub(super) mass: f64,
    /// Of its centre while it flies, m/s².
    pub(super) gravity: DVec3,
    /// Decay of linear velocity and of angular momentum, 1/s.
    pub(super) damping: [f64; 2],
    /// From the body's origin to its centre of mass, m.
    pub(super) center: f64,
    pub(super) knots: Vec<Knot>,
    /// Whether nothing touched it, stretch by stretch between its knots.
    flies: Vec<bool>,
}

/// Where and how bodies are at the end of a step.
pub(super) type Snapshot = BTreeMap<BodyId, Knot>;

pub(super) fn snapshot(world: &World) -> Snapshot {
    let knot = |id: BodyId| {
        let (state, mass) = (world.body(id)?, world.mass_of(id)?);
        let rotation = state.rotation().as_dquat().normalize();
        let velocity = Velocity {
            linear: state.linear_velocity().as_dvec3(),
            angular: state.angular_velocity().as_dvec3(),
        };
        let pose = Pose::new(state.position() + rotation * mass.center, rotation);
        Some((id, Knot { time: world.time(), pose, before: velocity, after: velocity }))
    };
    world.bodies().filter_map(|(id, _)| knot(id)).collect()
}

/// The courses of all bodies, by their ids.
pub(super) fn courses(
    world: &World,
    (start, end): (&Snapshot, &Snapshot),
    strikes: &[Strike],
) -> BTreeMap<BodyId, Course> {
    let mut courses = BTreeMap::new();
    for (&id, first) in start {
        let (Some(body), Some(mass), Some(last)) = (world.description(id), world.mass_of(id), end.get(&id))
        else {
            continue;
        };
        let is_dynamic = body.motion == Motion::Dynamic;
        let damping = if is_dynamic { [body.linear_damping, body.angular_damping] } else { [0.0; 2] };
        let course = Course {
            id,
            motion: body.motion,
            is_movable: mass.mass.is_finite() || mass.inverse_moments() != DVec3::ZERO,
            mass: mass.mass,
            gravity: if is_dynamic { body.gravity_factor * world.settings().gravity } else { DVec3::ZERO },
            damping,
            center: mass.center.length(),
            knots: vec![*first, *last],
            flies: Vec::new(),
        };
        courses.insert(id, course);
    }
    let mut order: Vec<&Strike> = strikes.iter().collect();
    order.sort_by(|one, other| {
        one.time.total_cmp(&other.time).then((one.round, one.impact).cmp(&(other.round, other.impact)))
    });
    for strike in order {
        for side in 0..2 {
            if let Some(course) = courses.get_mut(&strike.ids[side]) {
                course.insert(strike, side);
            }
        }
    }
    for course in courses.values_mut() {
        let flies = |(from, to)| deviation(world, course, from, to).is_some_and(|it| it.is_free());
        course.flies = course.pieces().map(flies).collect();
    }
    courses
}

impl Course {
    /// Adds a collision, unless another contact of the same round has told it already.
    fn insert(&mut self, strike: &Strike, side: usize) {
        let knot = Knot {
            time: strike.time,
            pose: strike.poses[side],
            before: strike.before[side],
            after: strike.after[side],
        };
        let place = self.knots.len() - 1;
        let same = |other: &Knot| {
            other.time == knot.time && (other.before, other.after) == (knot.before, knot.after)
        };
        if !same(&self.knots[place - 1]) {
            self.knots.insert(place, knot);
        }
    }

    /// The stretches between its knots.
    pub(super) fn pieces(&self) -> impl Iterator<Item = (&Knot, &Knot)> {
        self.knots.iter().zip(&self.knots[1..])
    }

    /// Position and velocity of the centre after `time` of free flight.
    pub(super) fn flown(&self, from: &Knot, time: f64) -> (DVec3, DVec3) {
        let decay = self.damping[0] * time;
        let left = (-decay).exp();
        // (1 − e^(−x))/x and (x − 1 + e^(−x))/x², by their series where they would cancel.
        let (first, second) = if decay < 1e-3 {
            (1.0 - decay / 2.0 + decay * decay / 6.0, 0.5 - decay / 6.0 + decay * decay / 24.0)
        } else {
            ((1.0 - left) / decay, (decay - 1.0 + left) / (decay * decay))
        };
        let (v, a) = (from.after.linear, self.gravity);
        (from.pose.position + v * (time * first) + a * (time * time * second), v * left + a * (time * first))
    }

    /// What is left of an angular momentum after `time`.
    pub(super) fn spin_left(&self, time: f64) -> f64 {
        (-self.damping[1] * time).exp()
    }

    /// Where the body is at `time`: the flight from the knot before, bent so that it meets the one after.
    pub(super) fn pose_at(&self, time: f64) -> Pose {
        let after = self.knots.partition_point(|knot| knot.time <= time).clamp(1, self.knots.len() - 1);
        let (from, to) = (&self.knots[after - 1], &self.knots[after]);
        let (whole, part) = (to.time - from.time, time - from.time);
        if whole <= 0.0 || part <= 0.0 {
            return from.pose;
        }
        let share = (part / whole).min(1.0);
        let miss = to.pose.position - self.flown(from, whole).0;
        let position = self.flown(from, part).0 + share * miss;
        let turn = if self.flies[after - 1] { turned(from, to, share) } else { share * turn(from, to) };
        let turned = DQuat::from_scaled_axis(turn);
        Pose::new(position, (turned * from.pose.rotation).normalize())
    }

    /// How fast its centre moves at most, m/s, and its turning, rad/s.
    pub(super) fn pace(&self) -> (f64, f64) {
        self.pieces().fold((0.0, 0.0), |(speed, spin), (from, to)| {
            let whole = to.time - from.time;
            let miss = (to.pose.position - self.flown(from, whole).0).length();
            let (missed, turned) =
                if whole > 0.0 { (miss / whole, turn(from, to).length() / whole) } else { (0.0, 0.0) };
            let here = from.after.linear.length().max(to.before.linear.length());
            (f64::max(speed, here + self.gravity.length() * whole + missed), f64::max(spin, turned))
        })
    }
}

/// The turn from one knot to the next (rad), of all that lead there the one nearest to what the angular velocities say.
fn turn(from: &Knot, to: &Knot) -> DVec3 {
    let rotation = to.pose.rotation * from.pose.rotation.conjugate();
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    let shortest = rotation.to_scaled_axis();
    let guess = 0.5 * (from.after.angular + to.before.angular) * (to.time - from.time);
    let axis = if shortest == DVec3::ZERO { guess.normalize_or_zero() } else { shortest.normalize() };
    let full = std::f64::consts::TAU;
    shortest + axis * (((guess - shortest).dot(axis) / full).round() * full)
}

/// A turn (rad) beyond which it is not told from both ends' angular velocities how it comes about.
const FAR: f64 = 2.5;

/// The turn of what flies until a `share` of the time between two knots has passed, rad: the cubic that has the angular velocities
/// of both as well.
///
/// With `r` the vector of the turn so far, `ω = J(r)·ṙ`, and (Chirikjian, *Stochastic Models, Information Theory, and Lie Groups* 2,
/// 2012, 10.86)
///
/// ```text
/// J⁻¹(r)·ω = ω − ½ r × ω + c·r × (r × ω)      c = 1/|r|² − (1 + cos|r|)/(2|r| sin|r|) → 1/12
/// ```
fn turned(from: &Knot, to: &Knot, share: f64) -> DVec3 {
    let (whole, turn) = (to.time - from.time, turn(from, to));
    let size = turn.length();
    if size > FAR {
        return share * turn;
    }
    let c = if size < 1e-2 {
        1.0 / 12.0
    } else {
        1.0 / (size * size) - (1.0 + size.cos()) / (2.0 * size * size.sin())
    };
    let cross = turn.cross(to.before.angular);
    let (first, last) = (from.after.angular, to.before.angular - 0.5 * cross + c * turn.cross(cross));
    let (left, square) = (1.0 - share, share * share);
    square * (3.0 - 2.0 * share) * turn + whole * share * left * (left * first - share * last)
}

/// How far a stretch is from free flight.
pub(super) struct Deviation {
    /// Of velocity, m/s, and of angular momentum, N·m·s, as vectors.
    pub(super) velocity: DVec3,
    pub(super) spin: DVec3,
    /// What rounding of velocities is relative to, m/s: those of the centre, and of turning.
    pub(super) speeds: f64,
    /// Error and tolerance of velocity, centre, angular momentum and energy of turning.
    pub(super) flight: [(f64, f64); 4],
}

impl Deviation {
    pub(super) fn is_free(&self) -> bool {
        self.flight.iter().all(|(error, tolerance)| error <= tolerance)
    }
}

pub(super) fn deviation(world: &World, course: &Course, from: &Knot, to: &Knot) -> Option<Deviation> {
    let time = to.time - from.time;
    let (center, linear) = course.flown(from, time);
    let velocity = to.before.linear - linear;
    let miss = (to.pose.position - center).length();
    let speeds = from.after.linear.length() + to.before.linear.length();
    let pull = course.gravity.length() * time;
    let places = from.pose.position.length() + to.pose.position.length();

    let parties = [from, to].map(|knot| Party::new(world, course.id, &knot.pose));
    let [Some(first), Some(last)] = parties else { return None };
    let (spin, energy, scale) = if course.motion == Motion::Kinematic {
        (DVec3::ZERO, 0.0, [0.0; 2])
    } else {
        let left = course.spin_left(time);
        let [before, after] = [(&first, &from.after), (&last, &to.before)]
            .map(|(party, velocity)| party.inertia * velocity.angular);
        let turning = |momentum: DVec3, velocity: &Velocity| 0.5 * momentum.dot(velocity.angular);
        let largest = first.inertia.x_axis.x + first.inertia.y_axis.y + first.inertia.z_axis.z;
        let (slow, fast) = (from.after.angular.length(), to.before.angular.length());
        (
            after - left * before,
            turning(after, &to.before) - left * left * turning(before, &from.after),
            [largest * (slow + fast), largest * (slow * slow + fast * fast)],
        )
    };
    let turned = to.before.angular.length().max(from.after.angular.length()) * time;
    let turning_scale = if turned > 1e-2 { 4.0 } else { 1.0 };
    let gyration = if course.mass.is_finite() {
        ((first.inertia.x_axis.x + first.inertia.y_axis.y + first.inertia.z_axis.z) / course.mass).sqrt()
    } else {
        0.0
    };
    let spins = from.after.angular.length() + to.before.angular.length();
    Some(Deviation {
        velocity,
        spin,
        speeds: speeds + pull + gyration * spins,
        flight: [
            (velocity.length(), ROUNDING * (speeds + pull)),
            (miss, ROUNDING * (speeds + pull) * time + 2e-7 * course.center + 1e-15 * places),
            (spin.length(), ROUNDING * scale[0]),
            (energy.abs(), ROUNDING * turning_scale * scale[1]),
        ],
    })
}
