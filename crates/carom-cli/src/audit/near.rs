//! Which colliders came near each other in a step, by bounds of their own.

use super::motion::Course;
use carom::collide::{Manifold, manifolds, separation};
use carom::math::{DVec3, Pose};
use carom::{BodyId, Collider, Surface, World};
use std::collections::BTreeMap;

/// Up to which gap, as a share of the smaller body, contacts stop what does not bounce.
pub(super) const HORIZON: f64 = 0.02;

/// Two colliders of different bodies, of which one can be moved at least.
pub(super) struct Pair<'a> {
    pub(super) ids: [BodyId; 2],
    colliders: [&'a Collider; 2],
    courses: [&'a Course; 2],
    /// From each body's origin to its centre of mass.
    centers: [DVec3; 2],
}

/// A place where contacts may have pushed.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    /// From a to b.
    pub(super) normal: DVec3,
    pub(super) friction: f64,
}

struct Extent<'a> {
    low: DVec3,
    high: DVec3,
    course: &'a Course,
    collider: &'a Collider,
    center: DVec3,
}

/// Pairs that were within `margin` (m) of each other, or may have been, at some time of the step.
pub(super) fn pairs<'a>(
    world: &'a World,
    courses: &'a BTreeMap<BodyId, Course>,
    margin: f64,
) -> Vec<Pair<'a>> {
    let mut extents: Vec<Extent> =
        courses.values().flat_map(|course| extents(world, course, margin)).collect();
    extents.sort_by(|one, other| one.low.x.total_cmp(&other.low.x));
    let mut pairs = Vec::new();
    let mut open: Vec<&Extent> = Vec::new();
    for extent in &extents {
        open.retain(|other| other.high.x >= extent.low.x);
        for other in &open {
            let meet = other.low.cmple(extent.high).all() && extent.low.cmple(other.high).all();
            if meet && other.may_touch(extent) {
                let swap = other.course.id > extent.course.id;
                let [a, b] = if swap { [extent, *other] } else { [*other, extent] };
                pairs.push(Pair {
                    ids: [a.course.id, b.course.id],
                    colliders: [a.collider, b.collider],
                    courses: [a.course, b.course],
                    centers: [a.center, b.center],
                });
            }
        }
        open.push(extent);
    }
    pairs
}

fn extents<'a>(world: &'a World, course: &'a Course, margin: f64) -> Vec<Extent<'a>> {
    let (Some(body), Some(mass)) = (world.description(course.id), world.mass_of(course.id)) else {
        return Vec::new();
    };
    let (_, spin) = course.pace();
    let solid = body.colliders.iter().filter(|collider| !collider.sensor);
    solid
        .map(|collider| {
            let local = Pose::new(collider.pose.position - mass.center, collider.pose.rotation);
            let mut bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let mut time: f64 = 0.0;
            for knot in &course.knots {
                let (low, high) = collider.shape.bounds(&knot.pose.then_local(&local));
                bounds = (bounds.0.min(low), bounds.1.max(high));
                time = time.max(knot.time - course.knots[0].time);
            }
            let reach = collider.shape.reach(local.inverse_transform_point(DVec3::ZERO));
            // What bends between two knots: turning, and falling.
            let turning = if spin > 0.0 { (spin * time).min(2.0) * reach } else { 0.0 };
            let slack = DVec3::splat(margin + turning + 0.125 * course.gravity.length() * time * time);
            Extent { low: bounds.0 - slack, high: bounds.1 + slack, course, collider, center: mass.center }
        })
        .collect()
}

impl Extent<'_> {
    fn may_touch(&self, other: &Extent<'_>) -> bool {
        self.course.id != other.course.id
            && (self.course.is_movable || other.course.is_movable)
            && self.collider.filter.allows(&other.collider.filter)
    }
}

impl Pair<'_> {
    pub(super) fn course(&self, side: usize) -> &Course {
        self.courses[side]
    }

    /// The smaller one's reach, m.
    pub(super) fn size(&self) -> f64 {
        let reach = |side: usize| self.colliders[side].shape.reach(DVec3::ZERO);
        reach(0).min(reach(1))
    }

    pub(super) fn thickness(&self) -> f64 {
        let of = |side: usize| {
            let thickness = self.colliders[side].shape.thickness();
            if thickness > 0.0 { thickness } else { self.size() }
        };
        of(0).min(of(1)).min(2.0 * self.size())
    }

    pub(super) fn surface(&self) -> Surface {
        Surface::between(&self.colliders[0].material, &self.colliders[1].material)
    }

    /// Up to which gap it may rest, m; `margin` for what bounces.
    pub(super) fn horizon(&self, margin: f64) -> f64 {
        if self.surface().restitution > 0.0 { margin } else { margin.max(HORIZON * self.size()) }
    }

    /// Farthest point of a side's collider from the centre of mass, m.
    pub(super) fn reach(&self, side: usize) -> f64 {
        let collider = self.colliders[side];
        let local = Pose::new(collider.pose.position - self.centers[side], collider.pose.rotation);
        collider.shape.reach(local.inverse_transform_point(DVec3::ZERO))
    }

    fn poses(&self, time: f64) -> ([Pose; 2], DVec3) {
        let centers = [0, 1].map(|side| self.courses[side].pose_at(time));
        let origin = centers[if self.courses[0].is_movable { 0 } else { 1 }].position;
        let poses = [0, 1].map(|side| {
            let collider = self.colliders[side];
            let local = Pose::new(collider.pose.position - self.centers[side], collider.pose.rotation);
            Pose::new(centers[side].position - origin, centers[side].rotation).then_local(&local)
        });
        (poses, origin)
    }

    /// Distance of the surfaces at `time`, m.
    pub(super) fn gap(&self, time: f64) -> f64 {
        let ([pose_a, pose_b], _) = self.poses(time);
        separation(&self.colliders[0].shape, &pose_a, &self.colliders[1].shape, &pose_b)
    }

    /// Where the surfaces are within `reach` of each other at `time`.
    pub(super) fn touches(&self, time: f64, reach: f64, out: &mut Vec<Touch>) {
        let ([pose_a, pose_b], _) = self.poses(time);
        let mut found: Vec<Manifold> = Vec::new();
        let [a, b] = self.colliders;
        manifolds((&a.shape, &pose_a), (&b.shape, &pose_b), reach, &mut found);
        let surface = self.surface();
        let friction = surface.static_friction.max(surface.dynamic_friction);
        out.extend(found.iter().map(|manifold| Touch { normal: manifold.normal, friction }));
    }
}
