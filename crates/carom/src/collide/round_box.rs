//! Balls and capsules against a cuboid. The round shape is `a`; everything here happens in the cuboid's frame.

use super::cuboid::{self, Cuboid};
use super::manifold::Manifold;
use super::round::Round;
use super::round_side::{OverSide, RoundSide};
use super::segment::{Segment, outside};
use super::{FLAT, Gap, ROUNDING};
use crate::math::DVec3;
use crate::report::Feature;

/// Where a core is closest to the box, or how it gets out of it.
struct Nearest {
    /// The core's point.
    on_core: DVec3,
    /// Unit vector from the box to it.
    outward: DVec3,
    /// From the box's surface to it; negative inside.
    distance: f64,
}

/// The core's distance from the box, less the radius. If the core is inside: by how much it would have to move.
pub(crate) fn gap(round: &Round, cuboid: &Cuboid) -> Gap {
    let nearest = nearest(&local_core(round, cuboid), cuboid.half);
    Gap::along(nearest.distance - round.radius, cuboid.pose.rotation * -nearest.outward)
}

/// Two points where a capsule's side lies along a face, otherwise one.
pub(crate) fn manifold(round: &Round, cuboid: &Cuboid, margin: f64) -> Option<Manifold> {
    let core = local_core(round, cuboid);
    let nearest = nearest(&core, cuboid.half);
    if nearest.distance - round.radius > margin {
        return None;
    }
    let side = RoundSide {
        radius: round.radius,
        outward: nearest.outward,
        tolerance: 10.0 * rounding(&core, cuboid.half),
        margin,
    };
    let stretch = stretch_over_face(&core, cuboid.half, nearest.outward);
    let feature = cuboid::feature_towards(nearest.outward);
    let (on_core, distance) = (nearest.on_core, nearest.distance);
    let manifold = side.manifold(OverSide { on_core, distance, feature }, stretch);
    Some(manifold.placed(&cuboid.pose))
}

/// A length, m, that is nothing beside these two.
fn rounding(core: &Segment, half_box: DVec3) -> f64 {
    ROUNDING * (half_box.max_element() + core.half.abs().max_element())
}

/// The core in the cuboid's frame.
fn local_core(round: &Round, cuboid: &Cuboid) -> Segment {
    Segment {
        center: cuboid.pose.inverse_transform_point(round.core.center),
        half: cuboid.pose.rotation.conjugate() * round.core.half,
    }
}

/// The core's closest point to the box, or the shortest way out if the core meets it.
fn nearest(core: &Segment, half_box: DVec3) -> Nearest {
    let is_point = core.half == DVec3::ZERO;
    let on_core = if is_point { core.center } else { core.at(core.closest_to_box(half_box)) };
    let offset = outside(on_core, half_box);
    let distance = offset.length();
    if distance > rounding(core, half_box) {
        return Nearest { on_core, outward: offset / distance, distance };
    }
    way_out(core, half_box)
}

/// The shortest translation that takes a core out of the box it meets.
///
/// Box and segment have six candidate directions: the box's face normals and the cross products of its edges with the
/// segment. The widest signed gap among them is the depth, exactly, since these are the face normals of the Minkowski
/// difference (Ericson 2005, 5.2.1). A point has the three faces only. Ties go to the first of x, y, z, positive side.
fn way_out(core: &Segment, half_box: DVec3) -> Nearest {
    let towards = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
    let mut best = Nearest { on_core: core.center, outward: DVec3::X, distance: f64::NEG_INFINITY };
    for axis in 0..3 {
        let distance = core.center[axis].abs() - core.half[axis].abs() - half_box[axis];
        if distance > best.distance {
            let mut outward = DVec3::ZERO;
            outward[axis] = towards(core.center[axis]);
            let deepest = if core.half[axis] * outward[axis] > 0.0 { -1.0 } else { 1.0 };
            best = Nearest { on_core: core.at(deepest), outward, distance };
        }
    }
    let tolerance = rounding(core, half_box);
    for axis in 0..3 {
        let along = DVec3::AXES[axis];
        let cross = core.half.cross(along);
        let length = cross.length();
        if length <= 1e-8 * core.half.length() {
            continue;
        }
        let outward = cross * (towards(core.center.dot(cross)) / length);
        let distance = core.center.dot(outward) - half_box.dot(outward.abs());
        if distance > best.distance + tolerance {
            let edge = cuboid::edge(axis, cuboid::farthest_corner(outward), half_box);
            best = Nearest { on_core: core.closest_to_segment(&edge).0, outward, distance };
        }
    }
    best
}

/// The two ends of the part of `core` that lies over the face which `outward` leaves almost at a right angle.
///
/// "Over" is meant along `outward`: the core's point p has the foot f = p − g·outward on the face, and g is its distance.
/// Both are linear in the core's parameter, so the part is found by clipping against the face's four sides (Liang
/// and Barsky 1984). With an edge closest, `outward` leans a little, and the foot of the closest point is on that edge.
fn stretch_over_face(core: &Segment, half_box: DVec3, outward: DVec3) -> Option<[OverSide; 2]> {
    let axis = cuboid::main_axis(outward);
    if core.half == DVec3::ZERO || outward[axis].abs() < FLAT {
        return None;
    }
    let distance =
        |point: DVec3| (point[axis] * outward[axis].signum() - half_box[axis]) / outward[axis].abs();
    let foot = |point: DVec3| point - outward * distance(point);
    let (middle, end) = (foot(core.center), foot(core.at(1.0)));
    let along = end - middle;

    let corner = cuboid::farthest_corner(outward);
    let face = Feature::Face(cuboid::facing(outward));
    let (mut low, mut high) = ((-1.0, face), (1.0, face));
    for side_axis in [(axis + 1) % 3, (axis + 2) % 3] {
        let remaining = 3 - axis - side_axis;
        for positive in [false, true] {
            let sign = if positive { 1.0 } else { -1.0 };
            let (room, speed) = (half_box[side_axis] - sign * middle[side_axis], sign * along[side_axis]);
            let border = corner & !(1 << side_axis) | u32::from(positive) << side_axis;
            let edge = Feature::Edge(cuboid::edge_number(remaining, border));
            // The foot is inside while speed·s ≤ room. A core that ends at the border is not cut.
            let s = room / speed;
            if speed > 0.0 && s < high.0 - 1e-9 {
                high = (s, edge);
            } else if speed < 0.0 && s > low.0 + 1e-9 {
                low = (s, edge);
            } else if speed == 0.0 && room < 0.0 {
                return None;
            }
        }
    }
    if high.0 - low.0 <= 1e-6 {
        return None;
    }
    Some([low, high].map(|(s, feature)| OverSide {
        on_core: core.at(s),
        distance: distance(core.at(s)),
        feature,
    }))
}
