//! When two colliders touch: the exact instant, in the configuration of that instant.
//!
//! Here is what two colliders are to each other at an instant: separated, touching, closing, at rest. The search for the instant is
//! in `time_of_impact/search.rs`.

mod root;
mod search;
mod straight;

use crate::bodies::{Bodies, ColliderRow, Outline, WORLD_ROW};
use crate::collide::{self, ContactPoint, Gap, Manifold};
use crate::flight::{RigidState, fly_center};
use crate::impacts::foreseen::Foreseen;
use crate::impacts::seams::leave_out_idle;
use crate::impulse::Velocity;
use crate::math::{DVec3, Pose};
use crate::report::Feature;
use crate::shape::Shape;
use crate::step::motion::{free_influence, state_at};
use crate::step::pairs::Pairs;
use std::cell::OnceCell;
pub(crate) use straight::outlook;

/// What decides whether a touch is an impact or a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RestLaw {
    /// Gravity, m/s².
    pub gravity: DVec3,
    /// Length of a substep, and of the step, s.
    pub substep: f64,
    pub step: f64,
}

impl RestLaw {
    /// Gap up to which a resting pair still counts as touching, m: what gravity covers in one substep.
    pub fn contact_margin(&self) -> f64 {
        0.5 * self.gravity.length() * self.substep * self.substep + 1e-6
    }

    /// Overlap of a resting pair that is left as it is, m.
    pub fn overlap_left(&self) -> f64 {
        0.1 * self.contact_margin()
    }

    /// The rest threshold of what gravity alone presses against something that does not move, m/s.
    pub fn rest_speed(&self) -> f64 {
        0.5 * self.gravity.length() * self.substep
    }

    /// Speed (m/s) with which a resting pair may close until it settles again: one that covers the contact margin in a
    /// substep.
    pub fn drift_speed(&self) -> f64 {
        self.contact_margin() / self.substep
    }
}

/// Two colliders during a step.
pub(crate) struct Approach<'a> {
    pub(super) bodies: &'a Bodies,
    pub(super) keys: (u32, u32),
    pub(super) a: &'a ColliderRow,
    pub(super) b: &'a ColliderRow,
    pub(super) law: RestLaw,
    /// All geometry is relative to this point of the world, near both.
    pub(super) origin: DVec3,
    /// Separation up to which the surfaces count as touching, m.
    tolerance: f64,
    /// Once somebody has asked for it.
    noise: OnceCell<f64>,
    foreseen: Foreseen,
}

/// Where and how fast two colliders close.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub normal: DVec3,
    pub contact: ContactPoint,
    /// Negative: they close, m/s.
    pub closing_speed: f64,
    /// The rest threshold along this normal, m/s.
    pub rest_speed: f64,
}

/// The points of a pair that rests which its contacts see to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    /// Gap that they had at most, m, at the time within the step from which on the pair is asked about, s.
    pub horizon: f64,
    pub since: f64,
    /// Speed with which they close at most, m/s.
    pub pressed: f64,
}

impl Kept {
    /// Whether a point is one of them that moves with a `speed` along the normal (m/s) and has this gap (m) at `time`.
    fn holds(&self, gap: f64, speed: f64, time: f64) -> bool {
        -speed <= self.pressed && gap - speed * (time - self.since) <= self.horizon
    }
}

/// Relative accuracy of separations: of our own kernels, and of pairs that go through parry's iterations.
const OWN_ACCURACY: f64 = 1e-9;
const PARRY_ACCURACY: f64 = 1e-6;

impl<'a> Approach<'a> {
    /// The pair of two colliders, by their keys.
    pub fn of(bodies: &'a Bodies, keys: (u32, u32), law: RestLaw) -> Option<Self> {
        let (a, b) = (bodies.collider(keys.0)?, bodies.collider(keys.1)?);
        let origin = bodies.center_pose(if a.row == WORLD_ROW { b } else { a }).position;
        let tolerance = tolerance(bodies.outline(keys.0), bodies.outline(keys.1));
        let (noise, foreseen) = (OnceCell::new(), Foreseen::default());
        Some(Self { bodies, keys, a, b, law, origin, tolerance, noise, foreseen })
    }

    /// Speed (m/s) below which closing is rounding.
    fn noise(&self) -> f64 {
        let speed = |collider: &ColliderRow| {
            let (state, constants) =
                (&self.bodies.states[collider.row], &self.bodies.constants[collider.row]);
            state.velocity.length() + constants.angular_velocity(state).length() * collider.spin_reach
        };
        *self.noise.get_or_init(|| 1e-9 * (speed(self.a) + speed(self.b)) + 1e-12)
    }

    /// The two.
    pub fn colliders(&self) -> [&'a ColliderRow; 2] {
        [self.a, self.b]
    }

    /// Separation up to which the surfaces count as touching, m.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Where the centre of mass of a collider's body is at `time`, relative to the origin.
    #[inline]
    pub(super) fn center_at(&self, collider: &ColliderRow, time: f64) -> DVec3 {
        let row = collider.row;
        if row != WORLD_ROW && self.bodies.clocks[row] == time {
            return self.bodies.states[row].position - self.origin;
        }
        self.flown_center(collider, time)
    }

    fn flown_center(&self, collider: &ColliderRow, time: f64) -> DVec3 {
        let row = collider.row;
        if row == WORLD_ROW {
            return self.bodies.center_pose(collider).position - self.origin;
        }
        let state = &self.bodies.states[row];
        let flown = time - self.bodies.clocks[row];
        let influence = &self.bodies.influences[row];
        let (position, _) = fly_center(state, &self.bodies.constants[row], influence, flown);
        position - self.origin
    }

    /// Where a collider is at `time`, relative to the origin.
    pub(super) fn pose_at(&self, collider: &ColliderRow, time: f64) -> Pose {
        let center = if collider.row == WORLD_ROW {
            let center = self.bodies.center_pose(collider);
            Pose::new(center.position - self.origin, center.rotation)
        } else if collider.spin_reach == 0.0 {
            Pose::new(self.center_at(collider, time), self.bodies.states[collider.row].rotation)
        } else if time <= self.bodies.clocks[collider.row] {
            let state = &self.bodies.states[collider.row];
            Pose::new(state.position - self.origin, state.rotation)
        } else {
            let state = self.state_at(collider, time);
            Pose::new(state.position - self.origin, state.rotation)
        };
        center.then_local(&collider.local)
    }

    /// The state of a collider's body at `time` within the step.
    fn state_at(&self, collider: &ColliderRow, time: f64) -> RigidState {
        let side = [self.a.row, self.b.row].into_iter().position(|row| row == collider.row);
        match side {
            Some(side) => self.foreseen.get(side, time, || state_at(self.bodies, collider.row, time)),
            None => state_at(self.bodies, collider.row, time),
        }
    }

    /// Distance of the surfaces at `time` within the step, m.
    pub fn separation(&self, time: f64) -> f64 {
        self.gap(time).separation
    }

    /// The same, with the direction in which it is that.
    pub fn gap(&self, time: f64) -> Gap {
        let (pose_a, pose_b) = (self.pose_at(self.a, time), self.pose_at(self.b, time));
        collide::gap((&self.a.shape, &pose_a), (&self.b.shape, &pose_b))
    }

    /// All places where the surfaces are within `margin` of each other at `time`, but for those that contacts of other `pairs`
    /// make idle; positions are in the world.
    pub fn manifolds(&self, pairs: &Pairs, time: f64, margin: f64, out: &mut Vec<Manifold>) {
        self.local_manifolds(time, margin, out);
        leave_out_idle(self, pairs, (time, margin), out);
        out.iter_mut().for_each(|manifold| manifold.shift(self.origin));
    }

    /// All places where the surfaces are within `margin` of each other at `time`; positions are relative to the origin.
    pub(super) fn local_manifolds(&self, time: f64, margin: f64, out: &mut Vec<Manifold>) {
        let (pose_a, pose_b) = (self.pose_at(self.a, time), self.pose_at(self.b, time));
        collide::manifolds((&self.a.shape, &pose_a), (&self.b.shape, &pose_b), margin, out);
    }

    /// The rest threshold along `normal`, m/s: a body that leaves more slowly is pressed back within one substep,
    /// so that gravity and the substep cannot tell its bounce from rest: `½ a h`, with `a` the acceleration of `b` against
    /// `a` that presses the two together: by gravity and forces alone, or with what holds the one that already rests.
    pub fn rest_speed(&self, normal: DVec3) -> f64 {
        let free =
            |collider: &ColliderRow| free_influence(self.bodies, collider.row, self.law.gravity).acceleration;
        let held = |collider: &ColliderRow| self.bodies.influences[collider.row].acceleration;
        let pressing =
            (free(self.a) - free(self.b)).dot(normal).max((held(self.a) - held(self.b)).dot(normal));
        self.noise().max(0.5 * pressing * self.law.substep)
    }

    /// Whether the two rest against each other at `time`: they are so near, and close or part so slowly, that what presses
    /// them together would let them touch no faster than the rest threshold, or already does. Two that overlap do, however fast
    /// they part: contacts only push, and would be missed where something else pushes the two deeper. Two that `fly` past each
    /// other do not, however near they come.
    pub fn rests(&self, pairs: &Pairs, time: f64, fly: bool) -> bool {
        let mut manifolds = Vec::new();
        self.manifolds(pairs, time, self.law.contact_margin(), &mut manifolds);
        let motions = if manifolds.is_empty() { return false } else { self.motions(time) };
        let (mut is_near, noise) = (false, self.noise());
        for manifold in &manifolds {
            let rest_speed = self.rest_speed(manifold.normal);
            let pressing = 2.0 * rest_speed / self.law.substep;
            for contact in manifold.points() {
                let closing = -normal_velocity(&motions, contact.point, manifold.normal);
                let gap = contact.separation.max(0.0);
                let speed_at_touch = (closing * closing + 2.0 * pressing * gap).sqrt();
                if closing > rest_speed || (gap > self.tolerance && speed_at_touch > rest_speed) {
                    return false;
                }
                let passes = fly && gap > self.tolerance && closing.max(rest_speed) <= noise;
                is_near |= contact.separation < -self.law.overlap_left()
                    || (!passes
                        && closing >= -rest_speed
                        && !(closing <= noise && self.parts(contact, manifold.normal)));
            }
        }
        is_near
    }

    /// Whether a point that neither closes nor opens is about to open: a corner swings away faster than the two are pressed
    /// together.
    pub fn parts(&self, contact: &ContactPoint, normal: DVec3) -> bool {
        let acceleration = |collider: &ColliderRow, feature: Feature| {
            let row = collider.row;
            let state = &self.bodies.states[row];
            let spin = self.bodies.constants[row].angular_velocity(state);
            let swing = match feature {
                Feature::Vertex(_) if row != WORLD_ROW => {
                    spin.cross(spin.cross(contact.point - state.position))
                }
                _ => DVec3::ZERO,
            };
            swing + free_influence(self.bodies, row, self.law.gravity).acceleration
        };
        let apart = acceleration(self.b, contact.feature_b) - acceleration(self.a, contact.feature_a);
        apart.dot(normal) > 0.0
    }

    /// Both bodies' centres and velocities at `time`.
    fn motions(&self, time: f64) -> [(DVec3, Velocity); 2] {
        [self.a, self.b].map(|collider| self.motion(collider, time))
    }

    /// A collider's centre of mass and velocity at `time`.
    pub(super) fn motion(&self, collider: &ColliderRow, time: f64) -> (DVec3, Velocity) {
        let state = self.state_at(collider, time);
        let angular = self.bodies.constants[collider.row].angular_velocity(&state);
        (state.position, Velocity { linear: state.velocity, angular })
    }

    /// The least gap at `time` of the points that close faster than they may, m: as [`Self::touch`], but up to a `margin`.
    fn gap_of_closing(&self, time: f64, margin: f64, kept: Option<Kept>) -> f64 {
        let mut manifolds = Vec::new();
        self.local_manifolds(time, margin, &mut manifolds);
        let motions = if manifolds.is_empty() { return f64::INFINITY } else { self.motions(time) };
        let mut least = f64::INFINITY;
        for manifold in &manifolds {
            let limit = self.closing_limit(manifold.normal, kept);
            for contact in manifold.points() {
                let speed = normal_velocity(&motions, contact.point + self.origin, manifold.normal);
                if speed < -limit && !kept.is_some_and(|kept| kept.holds(contact.separation, speed, time)) {
                    least = least.min(contact.separation);
                }
            }
        }
        least
    }

    /// Closing speed that is none yet, m/s: rounding, or for a pair that rests, the rest threshold and its drift.
    fn closing_limit(&self, normal: DVec3, kept: Option<Kept>) -> f64 {
        if kept.is_some() { self.rest_speed(normal).max(self.law.drift_speed()) } else { self.noise() }
    }

    /// The touch that closes fastest at `time`, if any closes faster than rounding (or, for a pair that rests, than the
    /// rest threshold and its drift, and is not `kept` by its contacts).
    fn touch(&self, pairs: &Pairs, time: f64, kept: Option<Kept>) -> Option<Touch> {
        self.fastest_touch(pairs, (time, kept), 1.0)
    }

    /// The same at an instant that [`Self::next_touch`] has found, where the closing speed may just be at its limit.
    pub fn confirmed_touch(&self, pairs: &Pairs, time: f64, kept: Option<Kept>) -> Option<Touch> {
        self.fastest_touch(pairs, (time, kept), 0.5)
    }

    fn fastest_touch(
        &self,
        pairs: &Pairs,
        (time, kept): (f64, Option<Kept>),
        share_of_limit: f64,
    ) -> Option<Touch> {
        let mut manifolds = Vec::new();
        self.local_manifolds(time, self.tolerance, &mut manifolds);
        let motions = if manifolds.is_empty() { return None } else { self.motions(time) };
        let fastest = |manifolds: &[Manifold]| {
            let mut fastest: Option<Touch> = None;
            for manifold in manifolds {
                let rest_speed = self.rest_speed(manifold.normal);
                let limit = share_of_limit * self.closing_limit(manifold.normal, kept);
                for contact in manifold.points() {
                    let contact = ContactPoint { point: contact.point + self.origin, ..*contact };
                    let closing_speed = normal_velocity(&motions, contact.point, manifold.normal);
                    if closing_speed < fastest.map_or(-limit, |touch| touch.closing_speed)
                        && !kept.is_some_and(|kept| kept.holds(contact.separation, closing_speed, time))
                    {
                        let normal = manifold.normal;
                        fastest = Some(Touch { normal, contact, closing_speed, rest_speed });
                    }
                }
            }
            fastest
        };
        // Mostly nothing closes, and nobody needs to know what is idle.
        let touch = fastest(&manifolds)?;
        let may_be_idle = leave_out_idle(self, pairs, (time, self.tolerance), &mut manifolds);
        if may_be_idle { fastest(&manifolds) } else { Some(touch) }
    }
}

/// Whether our own kernels tell how far a shape is from others that are so.
pub(crate) fn is_exact(shape: &Shape) -> bool {
    matches!(
        shape,
        Shape::Sphere { .. } | Shape::Cuboid { .. } | Shape::Capsule { .. } | Shape::Plane | Shape::Hull(_)
    )
}

/// Separation up to which the surfaces of two colliders count as touching, m.
#[inline]
pub(crate) fn tolerance(a: &Outline, b: &Outline) -> f64 {
    let accuracy = if a.is_exact && b.is_exact { OWN_ACCURACY } else { PARRY_ACCURACY };
    accuracy * a.reach.min(b.reach)
}

/// How fast `b` leaves `a` at a point, along the normal, m/s. The world's row does not move, wherever its centre may be.
fn normal_velocity(motions: &[(DVec3, Velocity); 2], point: DVec3, normal: DVec3) -> f64 {
    let [a, b] = motions.map(|(center, velocity)| velocity.at(point - center));
    (b - a).dot(normal)
}
