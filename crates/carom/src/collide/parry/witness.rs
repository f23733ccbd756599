//! The one point of a contact that clipping has none for: where the features that lie farthest along the axis meet.

use super::axis::Axis;
use super::convex::{CORNERS, Convex, Corner};
use crate::collide::ContactPoint;
use crate::collide::segment::Segment;
use crate::math::{DVec3, Pose};
use crate::report::Feature;

/// Corners that lie so little below the farthest one, as a share of the shapes' size, lie as far.
const LEVEL: f64 = 1e-6;

/// So often the place is looked for on one feature and then on the other; mostly the second time changes nothing.
const ROUNDS: usize = 8;

/// The contact point of the axis. In a's frame.
///
/// Where GJK or EPA saw the cores closest is a good guess only, and none if the axis was refined: then the points are any that
/// lie farthest. The place is the one on both features closest to it, seen along the axis.
pub(super) fn witness(a: &Convex, b: &Convex, b_in_a: &Pose, axis: &Axis) -> ContactPoint {
    let separation = axis.gap - a.radius - b.radius;
    let size = a.core.reach().max(b.core.reach());
    let unmoved = Pose::IDENTITY;
    let far_a = Farthest::of(a, &unmoved, axis.normal, LEVEL * size);
    let far_b = Farthest::of(b, b_in_a, -axis.normal, LEVEL * size);
    // The height is taken from the gap, which is exact.
    let flat = |point: DVec3| point - axis.normal * point.dot(axis.normal);
    let middle = flat(meeting(&far_a, &far_b, 0.5 * (axis.on_a + axis.on_b), axis.normal));
    let high_a = a.core.support(axis.normal).dot(axis.normal) + a.radius;
    let point = middle + axis.normal * (high_a + 0.5 * separation);
    ContactPoint { point, separation, feature_a: far_a.feature, feature_b: far_b.feature }
}

/// The place on both features, seen along `normal`, closest to a guess.
fn meeting(a: &Farthest, b: &Farthest, guess: DVec3, normal: DVec3) -> DVec3 {
    if let (&[a0, a1], &[b0, b1]) = (a.corners(), b.corners()) {
        let flat = |point: DVec3| point - normal * point.dot(normal);
        let segment = |from: DVec3, to: DVec3| Segment {
            center: 0.5 * (flat(from) + flat(to)),
            half: 0.5 * (flat(to) - flat(from)),
        };
        let (on_a, on_b) = segment(a0, a1).closest_to_segment(&segment(b0, b1));
        return 0.5 * (on_a + on_b);
    }
    let mut place = guess;
    for _ in 0..ROUNDS {
        let on_a = a.closest(place, normal);
        let on_b = b.closest(on_a, normal);
        let gain = on_b.distance_squared(place);
        place = on_b;
        if gain == 0.0 {
            break;
        }
    }
    place
}

/// What of a shape's core lies farthest in a direction: a corner, an edge or a side.
struct Farthest {
    corners: [DVec3; CORNERS],
    count: usize,
    feature: Feature,
}

impl Farthest {
    fn of(shape: &Convex, pose: &Pose, direction: DVec3, tolerance: f64) -> Self {
        let local = pose.rotation.conjugate() * direction;
        let support = shape.core.support(local);
        let highest = support.dot(local);
        let outline = shape.core.outline(local);
        let corners = outline.corners();
        let touches = |corner: &Corner| highest - corner.point.dot(local) <= tolerance;
        let mut found = Self { corners: [DVec3::ZERO; CORNERS], count: 0, feature: Feature::Surface };
        for corner in corners.iter().filter(|corner| touches(corner)) {
            found.corners[found.count] = pose.transform_point(corner.point);
            found.count += 1;
        }
        found.feature = match found.count {
            0 => Feature::Surface,
            1 => corners.iter().find(|corner| touches(corner)).map_or(Feature::Surface, |it| it.vertex),
            2 => (0..corners.len())
                .find(|&k| touches(&corners[k]) && touches(&corners[(k + 1) % corners.len()]))
                .map_or(Feature::Surface, |k| corners[k].edge),
            _ => outline.face,
        };
        // A rim has no corners where it is lowest.
        if found.count == 0 || (found.count == 1 && shape.core.is_curved()) {
            (found.corners[0], found.count) = (pose.transform_point(support), 1);
        }
        found
    }

    fn corners(&self) -> &[DVec3] {
        &self.corners[..self.count]
    }

    /// Its place closest to `point`, seen along `normal`.
    fn closest(&self, point: DVec3, normal: DVec3) -> DVec3 {
        let flat = |point: DVec3| point - normal * point.dot(normal);
        let (corners, point) = (self.corners(), flat(point));
        let side = |k: usize| {
            let (from, to) = (flat(corners[k]), flat(corners[(k + 1) % corners.len()]));
            Segment { center: 0.5 * (from + to), half: 0.5 * (to - from) }
        };
        if corners.len() == 1 {
            return flat(corners[0]);
        }
        let left_of = |k: usize| {
            let side = side(k);
            side.half.cross(point - side.center).dot(normal)
        };
        let turns = |sign: f64| (0..corners.len()).all(|k| sign * left_of(k) >= 0.0);
        if corners.len() > 2 && (turns(1.0) || turns(-1.0)) {
            return point;
        }
        let places = (0..corners.len()).map(|k| side(k).closest_to_point(point));
        let nearer =
            |one: &DVec3, two: &DVec3| one.distance_squared(point).total_cmp(&two.distance_squared(point));
        places.filter(|place| place.is_finite()).min_by(nearer).unwrap_or(point)
    }
}
