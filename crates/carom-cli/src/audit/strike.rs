//! One contact of a collision, with everything but the motion found again.

use super::Audit;
use super::impulses::{Basis, Twist};
use super::law::{Finding, Law, NORMAL_TOLERANCE, ROUNDING};
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
    /// Of infinite inertia: which of the principal axes, in the world.
    pub(super) stiff: [bool; 3],
    pub(super) axes: DMat3,
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
        let stiff = mass.moments.to_array().map(|moment| !moment.is_finite());
        Some(Self {
            mass: mass.mass,
            inertia: rotated_diagonal(rotation, finite),
            inverse_inertia: rotated_diagonal(rotation, inverse),
            stiff,
            axes: DMat3::from_quat(rotation),
            center: pose.position,
            moves: mass.mass.is_finite() || stiff.contains(&false),
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

    /// What holds it, as impulses that may act on it besides its contacts, about `reference`.
    pub(super) fn held_by(&self, reference: DVec3, basis: &mut Basis) {
        for (axis, _) in [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis]
            .into_iter()
            .zip(self.stiff)
            .filter(|(_, stiff)| *stiff)
        {
            basis.add(Twist { linear: DVec3::ZERO, angular: axis });
        }
        if self.mass.is_infinite() {
            basis.add_impulses_at(self.center - reference);
        }
    }
}

/// One contact of an instant.
pub(super) struct Strike {
    pub(super) impact: usize,
    pub(super) ids: [BodyId; 2],
    pub(super) time: f64,
    pub(super) parties: [Party; 2],
    pub(super) point: DVec3,
    pub(super) arms: [DVec3; 2],
    pub(super) normal: DVec3,
    pub(super) surface: Surface,
    pub(super) before: [Velocity; 2],
    pub(super) after: [Velocity; 2],
    pub(super) together: u32,
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
        ROUNDING * (of(0) + of(1))
    }

    /// K: how the unit impulse changes the speed along the normal.
    pub(super) fn speed_per_impulse(&self) -> f64 {
        let of = |side: usize| {
            let (party, twist) = (&self.parties[side], self.arms[side].cross(self.normal));
            1.0 / party.mass + twist.dot(party.inverse_inertia * twist)
        };
        of(0) + of(1)
    }

    /// The impulses that this contact can have given, about `reference`.
    pub(super) fn impulses(&self, reference: DVec3, basis: &mut Basis) {
        let lever = self.point - reference;
        if self.frictionless() {
            basis.add(Twist { linear: self.normal, angular: lever.cross(self.normal) });
        } else {
            basis.add_impulses_at(lever);
        }
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
    let mut found = Vec::new();
    manifolds((&collider_a.shape, &pose_a), (&collider_b.shape, &pose_b), 1e-3 * size, &mut found);
    let normal = nearest_normal(&found, impact.contact.normal, 1e-3 * size);
    match normal {
        Some(normal) => audit.findings.push(Finding {
            law: Law::Normal,
            impact: index,
            error: normal.cross(impact.contact.normal).length().atan2(normal.dot(impact.contact.normal)),
            tolerance: NORMAL_TOLERANCE,
        }),
        None => audit.without_normal += 1,
    }

    Some(Strike {
        impact: index,
        ids: [impact.a, impact.b],
        time: impact.time,
        parties: [Party::new(world, impact.a, &impact.pose_a)?, Party::new(world, impact.b, &impact.pose_b)?],
        point: impact.point,
        arms,
        normal: normal.unwrap_or(impact.contact.normal),
        surface: Surface::between(&collider_a.material, &collider_b.material),
        before: [impact.side_a.velocity, impact.side_b.velocity],
        after: [impact.after_a, impact.after_b],
        together: impact.together,
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
