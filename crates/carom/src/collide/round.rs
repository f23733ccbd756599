//! Balls and capsules against each other: the closest points of two cores, less the radii.

use super::manifold::{ContactPoint, Manifold};
use super::segment::Segment;
use super::{Gap, ROUNDING};
use crate::math::{DVec3, Pose, any_tangent};
use crate::report::Feature;

/// The sine below which two capsules lie side by side and touch at two points.
const PARALLEL: f64 = 1e-4;

/// A ball or a capsule: all points within `radius` of its core.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Round {
    /// The core; a ball's has no length.
    pub(crate) core: Segment,
    /// Radius, m.
    pub(crate) radius: f64,
}

impl Round {
    /// A ball in its place.
    pub(crate) fn ball(pose: &Pose, radius: f64) -> Self {
        Self { core: Segment { center: pose.position, half: DVec3::ZERO }, radius }
    }

    /// A capsule in its place.
    pub(crate) fn capsule(pose: &Pose, height: f64, radius: f64) -> Self {
        let half = pose.rotation * DVec3::new(0.0, 0.5 * height, 0.0);
        Self { core: Segment { center: pose.position, half }, radius }
    }

    /// Whether the core is a point.
    pub(crate) fn is_ball(&self) -> bool {
        self.core.half == DVec3::ZERO
    }

    /// A length that tells what is small for this shape, m.
    pub(crate) fn size(&self) -> f64 {
        self.core.half.length() + self.radius
    }
}

/// The cores' distance, less both radii.
pub(crate) fn gap(a: &Round, b: &Round) -> Gap {
    let (on_a, on_b) = closest(a, b);
    let (offset, distance) = (on_b - on_a, on_a.distance(on_b));
    let is_apart = distance > ROUNDING * (a.size() + b.size());
    Gap { separation: distance - (a.radius + b.radius), normal: is_apart.then(|| offset / distance) }
}

/// One point on the line of the cores' closest points; two where capsules lie side by side.
pub(crate) fn manifold(a: &Round, b: &Round, margin: f64) -> Option<Manifold> {
    let (on_a, on_b) = closest(a, b);
    let offset = on_b - on_a;
    let distance = offset.length();
    if distance - (a.radius + b.radius) > margin {
        return None;
    }
    let normal = if distance > ROUNDING * (a.size() + b.size()) {
        offset / distance
    } else {
        normal_of_crossing(a, b, offset)
    };
    let mut manifold = Manifold::new(normal);
    for pair in side_by_side(a, b).into_iter().flatten() {
        let point = contact(a, b, pair, normal);
        if point.separation <= margin {
            manifold.push(point);
        }
    }
    if manifold.points().is_empty() {
        let separation = distance - (a.radius + b.radius);
        manifold.push(ContactPoint { separation, ..contact(a, b, (on_a, on_b), normal) });
    }
    Some(manifold)
}

/// The cores' closest points, `a`'s first.
fn closest(a: &Round, b: &Round) -> (DVec3, DVec3) {
    match (a.is_ball(), b.is_ball()) {
        (true, true) => (a.core.center, b.core.center),
        (true, false) => (a.core.center, b.core.closest_to_point(a.core.center)),
        (false, true) => (a.core.closest_to_point(b.core.center), b.core.center),
        (false, false) => a.core.closest_to_segment(&b.core),
    }
}

/// The contact of two points of the cores: the surfaces lie `radius` along the normal from each.
fn contact(a: &Round, b: &Round, (on_a, on_b): (DVec3, DVec3), normal: DVec3) -> ContactPoint {
    ContactPoint {
        point: 0.5 * (on_a + on_b) + normal * (0.5 * (a.radius - b.radius)),
        separation: (on_b - on_a).dot(normal) - (a.radius + b.radius),
        feature_a: Feature::Surface,
        feature_b: Feature::Surface,
    }
}

/// The shortest way apart for cores that cross: at right angles to both; if that leaves a choice, some fixed one.
fn normal_of_crossing(a: &Round, b: &Round, offset: DVec3) -> DVec3 {
    let (half_a, half_b) = (a.core.half, b.core.half);
    let across = half_a.cross(half_b);
    if across.length() > ROUNDING * half_a.length() * half_b.length() {
        return across.normalize() * if offset.dot(across) < 0.0 { -1.0 } else { 1.0 };
    }
    let (axis, sign) =
        if a.is_ball() { (half_b, 1.0) } else { (half_a, if b.is_ball() { -1.0 } else { 1.0 }) };
    axis.try_normalize().map_or(DVec3::Y, any_tangent) * sign
}

/// For two parallel capsules that lie alongside: the pairs of core points where their common stretch begins and ends.
///
/// Where the capsules are parallel only nearly, the gap changes linearly along the stretch, so its least is at an end.
fn side_by_side(a: &Round, b: &Round) -> Option<[(DVec3, DVec3); 2]> {
    let (length_a, length_b) = (a.core.half.length(), b.core.half.length());
    if a.is_ball() || b.is_ball() || a.core.half.cross(b.core.half).length() > PARALLEL * length_a * length_b
    {
        return None;
    }
    // Positions along a's axis, from its centre.
    let axis = a.core.half / length_a;
    let center = (b.core.center - a.core.center).dot(axis);
    let half = b.core.half.dot(axis);
    let low = (-length_a).max(center - half.abs());
    let high = length_a.min(center + half.abs());
    if high - low <= 1e-6 * length_a.min(length_b) {
        return None;
    }
    Some([low, high].map(|x| (a.core.center + axis * x, b.core.at((x - center) / half))))
}
