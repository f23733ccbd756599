//! Round shapes, cuboids and hulls on a half space. The plane is `b`, so the normal points down into it.

use super::ROUNDING;
use super::cuboid::{self, Cuboid};
use super::manifold::{ContactPoint, Manifold};
use super::polygon::Patch;
use super::polytope::Polytope;
use super::round::Round;
use crate::math::{DVec3, Pose};
use crate::report::Feature;

/// All points that are not above a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    /// A point of the plane.
    point: DVec3,
    /// Unit vector out of the half space.
    pub(crate) up: DVec3,
}

impl HalfSpace {
    /// The half space y ≤ 0 of the frame at `pose`.
    pub(crate) fn new(pose: &Pose) -> Self {
        Self { point: pose.position, up: pose.rotation * DVec3::Y }
    }

    /// How high `point` is above the plane, m.
    fn height(&self, point: DVec3) -> f64 {
        (point - self.point).dot(self.up)
    }

    /// The length that heights near `point` are rounded against.
    fn span(&self, point: DVec3) -> f64 {
        (point - self.point).abs().max_element()
    }

    /// The contact of `lowest`, a point of `a`'s surface, with the plane straight below it. All points that are as low as
    /// the lowest, but for rounding, are given its height, `least`.
    fn contact(&self, lowest: DVec3, (least, size): (f64, f64), feature_a: Feature) -> ContactPoint {
        let height = self.height(lowest);
        let separation = if height <= least + 10.0 * ROUNDING * size { least } else { height };
        let point = lowest - self.up * (0.5 * height);
        ContactPoint { point, separation, feature_a, feature_b: Feature::Surface }
    }
}

/// The height of the core's lower end, less the radius.
pub(crate) fn round_separation(round: &Round, plane: &HalfSpace) -> f64 {
    plane.height(round.core.center) - plane.up.dot(round.core.half).abs() - round.radius
}

/// A ball's lowest point, or those below a capsule's two ends.
pub(crate) fn round_manifold(round: &Round, plane: &HalfSpace, margin: f64) -> Option<Manifold> {
    let least = round_separation(round, plane);
    if least > margin {
        return None;
    }
    let mut manifold = Manifold::new(-plane.up);
    let level = (least, round.size() + plane.span(round.core.center));
    let ends: &[f64] = if round.is_ball() { &[0.0] } else { &[-1.0, 1.0] };
    for &end in ends {
        let contact = plane.contact(round.core.at(end) - plane.up * round.radius, level, Feature::Surface);
        if contact.separation <= margin {
            manifold.push(contact);
        }
    }
    Some(manifold)
}

/// The height of the lowest corner: the centre's, less the half lengths' shares of it.
pub(crate) fn box_separation(cuboid: &Cuboid, plane: &HalfSpace) -> f64 {
    let up = cuboid.pose.rotation.conjugate() * plane.up;
    plane.height(cuboid.pose.position) - cuboid.half.dot(up.abs())
}

/// The corners of the face that looks down most; the lowest corner is one of them.
pub(crate) fn box_manifold(cuboid: &Cuboid, plane: &HalfSpace, margin: f64) -> Option<Manifold> {
    let least = box_separation(cuboid, plane);
    if least > margin {
        return None;
    }
    let up = cuboid.pose.rotation.conjugate() * plane.up;
    let mut manifold = Manifold::new(-plane.up);
    let level = (least, cuboid.half.max_element() + plane.span(cuboid.pose.position));
    for corner in cuboid::face_corners(cuboid::facing(-up)) {
        let lowest = cuboid.pose.transform_point(cuboid::corner(corner, cuboid.half));
        let contact = plane.contact(lowest, level, Feature::Vertex(corner));
        if contact.separation <= margin {
            manifold.push(contact);
        }
    }
    Some(manifold)
}

/// The height of the lowest corner.
pub(crate) fn hull_separation(hull: &Polytope, plane: &HalfSpace) -> f64 {
    let down = hull.pose.rotation.conjugate() * -plane.up;
    plane.height(hull.pose.transform_point(hull.corner(hull.highest(down))))
}

/// The best four corners of the side that looks down most; the lowest corner is one of them.
pub(crate) fn hull_manifold(hull: &Polytope, plane: &HalfSpace, margin: f64) -> Option<Manifold> {
    let down = hull.pose.rotation.conjugate() * -plane.up;
    let lowest = hull.highest(down);
    let place = |corner: u32| hull.pose.transform_point(hull.corner(corner));
    let least = plane.height(place(lowest));
    if least > margin {
        return None;
    }
    let level = (least, hull.size() + plane.span(hull.pose.position));
    let mut patch = Patch::new();
    let ring = hull.topology.ring(hull.side_towards(down));
    // Rounding may have found the side next to the one with the lowest corner.
    let missing = (!ring.contains(&lowest)).then_some(lowest);
    for corner in ring.iter().copied().chain(missing) {
        patch.push(plane.contact(place(corner), level, Feature::Vertex(corner)));
    }
    patch.reduced(-plane.up, (least, 0.0), margin)
}
