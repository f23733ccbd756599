//! One contact of a collision, with everything but the motion and the impulse found again.

use super::Audit;
use super::law::{Finding, Law, NORMAL_TOLERANCE, Place, ROUNDING};
use carom::collide::{Manifold, manifolds};
use carom::impulse::Velocity;
use carom::math::{DMat3, DQuat, DVec3, Pose, rotated_diagonal};
use carom::report::Impact;
use carom::{BodyId, Surface, World};

/// A body at the instant of a collision.
#[derive(Clone, Copy)]
pub(super) struct Party {
    /// Infinite for what no impulse can move.
    pub(super) mass: f64,
    /// Zero on axes of infinite inertia.
    pub(super) inertia: DMat3,
    pub(super) inverse_inertia: DMat3,
    /// Centre of mass.
    pub(super) center: DVec3,
    /// Whether impulses change anything about it.
    pub(super) moves: bool,
}

impl Party {
    pub(super) fn new(world: &World, id: BodyId, pose: &Pose) -> Option<Self> {
        let mass = world.mass_of(id)?;
        let rotation: DQuat = pose.rotation * mass.principal_rotation;
        let finite = mass.moments.map(|moment| if moment.is_finite() { moment } else { 0.0 });
        let inverse = finite.map(|moment| if moment > 0.0 { 1.0 / moment } else { 0.0 });
        Some(Self {
            mass: mass.mass,
            inertia: rotated_diagonal(rotation, finite),
            inverse_inertia: rotated_diagonal(rotation, inverse),
            center: pose.position,
            moves: mass.mass.is_finite() || inverse != DVec3::ZERO,
        })
    }

    /// Its momentum, zero where infinite.
    pub(super) fn linear(&self, velocity: &Velocity) -> DVec3 {
        if self.mass.is_finite() { self.mass * velocity.linear } else { DVec3::ZERO }
    }

    pub(super) fn energy(&self, velocity: &Velocity) -> f64 {
        0.5 * (self.linear(velocity).dot(velocity.linear)
            + velocity.angular.dot(self.inertia * velocity.angular))
    }

    /// What rounding of the energy is relative to.
    pub(super) fn energy_scale(&self, velocity: &Velocity) -> f64 {
        self.linear(velocity).length() * velocity.linear.length()
            + velocity.angular.length() * (self.inertia * velocity.angular).length()
    }

    /// What rounding of the speed at `arm` is relative to.
    pub(super) fn speed_scale(&self, velocity: &Velocity, arm: DVec3) -> f64 {
        let stretch =
            self.inverse_inertia.x_axis.x + self.inverse_inertia.y_axis.y + self.inverse_inertia.z_axis.z;
        let spin = (self.inertia * velocity.angular).length();
        velocity.linear.length() + arm.length() * (stretch * spin + velocity.angular.length())
    }

    /// The part of its motion at `arm` that no impulse can change.
    pub(super) fn driven(&self, velocity: &Velocity, arm: DVec3) -> DVec3 {
        let linear = if self.mass.is_finite() { DVec3::ZERO } else { velocity.linear };
        let spin = velocity.angular - self.inverse_inertia * (self.inertia * velocity.angular);
        linear + spin.cross(arm)
    }
}

/// One contact of an instant.
pub(super) struct Strike {
    pub(super) impact: usize,
    pub(super) ids: [BodyId; 2],
    pub(super) time: f64,
    pub(super) parties: [Party; 2],
    pub(super) poses: [Pose; 2],
    pub(super) point: DVec3,
    pub(super) arms: [DVec3; 2],
    pub(super) normal: DVec3,
    /// Between that and the one that was used, as far as it is no violation by itself, rad.
    pub(super) normal_error: f64,
    pub(super) surface: Surface,
    pub(super) before: [Velocity; 2],
    pub(super) after: [Velocity; 2],
    /// What b got, N·s, as the record says.
    pub(super) impulse: DVec3,
    pub(super) sticks: bool,
    pub(super) round: u32,
}

impl Strike {
    pub(super) fn frictionless(&self) -> bool {
        self.surface.static_friction == 0.0 && self.surface.dynamic_friction == 0.0
    }

    pub(super) fn speed(&self, velocities: &[Velocity; 2]) -> f64 {
        let [a, b] = [0, 1].map(|side| velocities[side].at(self.arms[side]));
        (b - a).dot(self.normal)
    }

    pub(super) fn speed_tolerance(&self) -> f64 {
        let of = |side: usize| {
            let (party, arm) = (&self.parties[side], self.arms[side]);
            party.speed_scale(&self.before[side], arm) + party.speed_scale(&self.after[side], arm)
        };
        let slip = |velocities: &[Velocity; 2]| {
            (velocities[1].at(self.arms[1]) - velocities[0].at(self.arms[0])).length()
        };
        ROUNDING * (of(0) + of(1)) + self.normal_error * (slip(&self.before) + slip(&self.after))
    }

    /// K: how the unit impulse changes the speed along the normal.
    pub(super) fn speed_per_impulse(&self) -> f64 {
        let of = |side: usize| {
            let (party, twist) = (&self.parties[side], self.arms[side].cross(self.normal));
            1.0 / party.mass + twist.dot(party.inverse_inertia * twist)
        };
        of(0) + of(1)
    }

    /// What the body of `side` got here, N·s.
    pub(super) fn impulse_on(&self, side: usize) -> DVec3 {
        if side == 1 { self.impulse } else { -self.impulse }
    }

    /// What rounding of its momentum is relative to; infinite for an infinite mass.
    pub(super) fn momentum_scale(&self, side: usize) -> f64 {
        let party = &self.parties[side];
        if party.mass.is_infinite() {
            return f64::INFINITY;
        }
        party.linear(&self.before[side]).length() + party.linear(&self.after[side]).length()
    }

    /// The longer one of its lever arms on bodies that move, m.
    pub(super) fn longest_arm(&self) -> f64 {
        let arm = |side: usize| if self.parties[side].moves { self.arms[side].length() } else { 0.0 };
        arm(0).max(arm(1))
    }
}

/// The contact that a record tells of, with everything but the motion found again.
pub(super) fn strike(world: &World, index: usize, impact: &Impact, audit: &mut Audit) -> Option<Strike> {
    let (a, b) = (world.description(impact.a)?, world.description(impact.b)?);
    let collider_a = a.colliders.get(impact.collider_a as usize)?;
    let collider_b = b.colliders.get(impact.collider_b as usize)?;
    let center = |id: BodyId| world.mass_of(id).map(|mass| mass.center);
    // Near the point, so that nothing is lost far from the world's origin.
    let near = |pose: &Pose, center: DVec3| {
        Pose::new(pose.position - impact.point - pose.rotation * center, pose.rotation)
    };
    let pose_a = near(&impact.pose_a, center(impact.a)?).then_local(&collider_a.pose);
    let pose_b = near(&impact.pose_b, center(impact.b)?).then_local(&collider_b.pose);
    let arms = [impact.point - impact.pose_a.position, impact.point - impact.pose_b.position];

    let size = collider_a.shape.reach(DVec3::ZERO).min(collider_b.shape.reach(DVec3::ZERO));
    // What rests may strike from as far as contacts reach.
    let margin = 1e-3 * size + 2.0 * impact.separation.abs();
    let mut found = Vec::new();
    manifolds((&collider_a.shape, &pose_a), (&collider_b.shape, &pose_b), margin, &mut found);
    let normal = nearest_normal(&found, impact.contact.normal, margin);
    let normal_error =
        normal.map(|own| own.cross(impact.contact.normal).length().atan2(own.dot(impact.contact.normal)));
    match normal_error {
        Some(error) => audit.findings.push(Finding {
            law: Law::Normal,
            place: Place::Collision(index),
            error,
            tolerance: NORMAL_TOLERANCE,
        }),
        None => audit.without_normal += 1,
    }

    Some(Strike {
        impact: index,
        ids: [impact.a, impact.b],
        time: impact.time,
        parties: [Party::new(world, impact.a, &impact.pose_a)?, Party::new(world, impact.b, &impact.pose_b)?],
        poses: [impact.pose_a, impact.pose_b],
        point: impact.point,
        arms,
        normal: normal.unwrap_or(impact.contact.normal),
        normal_error: normal_error.map_or(0.0, |error| error.min(NORMAL_TOLERANCE)),
        surface: Surface::between(&collider_a.material, &collider_b.material),
        before: [impact.side_a.velocity, impact.side_b.velocity],
        after: [impact.after_a, impact.after_b],
        impulse: impact.impulse(),
        sticks: impact.sticks,
        round: impact.round,
    })
}

/// The normal of the contact point nearest to the origin. Where several are about as near (a corner over the seam of two
/// triangles), the one most like `used`.
fn nearest_normal(found: &[Manifold], used: DVec3, margin: f64) -> Option<DVec3> {
    let points = || {
        found
            .iter()
            .flat_map(|manifold| manifold.points().iter().map(move |at| (at.point.length(), manifold.normal)))
    };
    let nearest = points().map(|(distance, _)| distance).min_by(f64::total_cmp)?;
    points()
        .filter(|(distance, _)| *distance <= nearest + margin)
        .map(|(_, normal)| normal)
        .max_by(|a, b| a.dot(used).total_cmp(&b.dot(used)))
}
