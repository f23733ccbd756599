//! Balls and capsules against a hull. The round shape is `a`; everything here happens in the hull's frame.

use super::closest::closest;
use super::manifold::Manifold;
use super::polytope::Polytope;
use super::round::Round;
use super::round_side::{OverSide, RoundSide};
use super::segment::Segment;
use super::{FLAT, Gap, ROUNDING};
use crate::math::DVec3;
use crate::report::Feature;

/// Where a core is closest to the hull, or how it gets out of it.
struct Nearest {
    /// The core's point.
    on_core: DVec3,
    /// Unit vector from the hull to it.
    outward: DVec3,
    /// From the hull's surface to it; negative inside.
    distance: f64,
    /// What of the hull is closest.
    feature: Feature,
}

/// The core's distance from the hull, less the radius. If the core is inside: by how much it would have to move.
pub(crate) fn gap(round: &Round, hull: &Polytope) -> Gap {
    let nearest = nearest(&local_core(round, hull), hull, f64::INFINITY);
    nearest.map_or(Gap { separation: f64::INFINITY, normal: None }, |nearest| {
        Gap::along(nearest.distance - round.radius, hull.pose.rotation * -nearest.outward)
    })
}

/// Two points where a capsule's side lies along a side of the hull, otherwise one.
pub(crate) fn manifold(round: &Round, hull: &Polytope, margin: f64) -> Option<Manifold> {
    let core = local_core(round, hull);
    let nearest = nearest(&core, hull, margin + round.radius)?;
    if nearest.distance - round.radius > margin {
        return None;
    }
    let side = RoundSide {
        radius: round.radius,
        outward: nearest.outward,
        tolerance: 10.0 * rounding(&core, hull),
        margin,
    };
    let stretch = stretch_over_side(&core, hull, nearest.outward);
    let (on_core, distance, feature) = (nearest.on_core, nearest.distance, nearest.feature);
    let manifold = side.manifold(OverSide { on_core, distance, feature }, stretch);
    Some(manifold.placed(&hull.pose))
}

/// A length, m, that is nothing beside these two.
fn rounding(core: &Segment, hull: &Polytope) -> f64 {
    ROUNDING * (hull.size() + core.half.abs().max_element())
}

/// The core in the hull's frame.
fn local_core(round: &Round, hull: &Polytope) -> Segment {
    Segment {
        center: hull.pose.inverse_transform_point(round.core.center),
        half: hull.pose.rotation.conjugate() * round.core.half,
    }
}

/// The core's closest point to the hull, or the shortest way out if the core meets it. `None` if it is farther than
/// `limit`, or nowhere.
fn nearest(core: &Segment, hull: &Polytope, limit: f64) -> Option<Nearest> {
    if !core.at(1.0).is_finite() {
        return None;
    }
    if core.half == DVec3::ZERO {
        let found = over_highest_side(core.center, hull, limit)?;
        if found.distance <= rounding(core, hull) || is_over(hull, found.feature, core.center) {
            return Some(found);
        }
    }
    let closest = closest((hull, core), core.center - hull.middle, hull.size(), limit)?;
    if !closest.is_apart {
        return Some(way_out(core, hull));
    }
    let (numbers, _, count) = closest.corners();
    let feature = hull.feature_of(&numbers[..count], closest.normal);
    let (on_core, outward, distance) = (closest.points(hull, core).1, closest.normal, closest.gap);
    Some(Nearest { on_core, outward, distance, feature })
}

/// The side whose plane a point is highest above, or least deep below: the first of equal ones. A point in the hull leaves
/// it there.
fn over_highest_side(point: DVec3, hull: &Polytope, limit: f64) -> Option<Nearest> {
    let tolerance = ROUNDING * hull.size();
    let mut best = (f64::NEG_INFINITY, 0);
    for (plane, side) in hull.planes.iter().zip(0..) {
        let height = plane.height(point);
        if height > best.0 + tolerance {
            best = (height, side);
        }
    }
    let (distance, side) = best;
    let outward = hull.planes[side as usize].normal;
    let nearest = Nearest { on_core: point, outward, distance, feature: Feature::Face(side) };
    (distance <= limit).then_some(nearest)
}

/// Whether the foot of `point` on the plane of a side lies in that side: then it is the hull's closest point.
fn is_over(hull: &Polytope, side: Feature, point: DVec3) -> bool {
    let Feature::Face(side) = side else { return false };
    let normal = hull.planes[side as usize].normal;
    let ring = hull.topology.ring(side);
    (0..ring.len()).all(|k| {
        let (from, to) = (hull.corner(ring[k]), hull.corner(ring[(k + 1) % ring.len()]));
        (to - from).cross(normal).dot(point - from) <= 0.0
    })
}

/// The shortest translation that takes a core out of the hull it meets.
///
/// The candidate directions are the sides' normals and those at right angles to the core and to an edge, if they lie
/// between the normals of the two sides that meet there: the face normals of the Minkowski difference. Where they tie but
/// for rounding, sides go before edges.
fn way_out(core: &Segment, hull: &Polytope) -> Nearest {
    let tolerance = rounding(core, hull);
    let mut best = Nearest {
        on_core: core.center,
        outward: DVec3::X,
        distance: f64::NEG_INFINITY,
        feature: Feature::Surface,
    };
    for (plane, side) in hull.planes.iter().zip(0..) {
        let reach = plane.normal.dot(core.half);
        let distance = plane.height(core.center) - reach.abs();
        if distance > best.distance + tolerance {
            let on_core = core.at(if reach > 0.0 { -1.0 } else { 1.0 });
            best = Nearest { on_core, outward: plane.normal, distance, feature: Feature::Face(side) };
        }
    }
    for edge in hull.topology.edges() {
        let [first, second] = edge.sides.map(|side| hull.planes[side as usize].normal);
        if (first.dot(core.half) > 0.0) == (second.dot(core.half) > 0.0) {
            continue;
        }
        let segment = hull.segment(edge.ends);
        let cross = core.half.cross(segment.half);
        let length = cross.length();
        if length <= 1e-8 * core.half.length() * segment.half.length() {
            continue;
        }
        let sign = if cross.dot(first + second) < 0.0 { -1.0 } else { 1.0 };
        let outward = cross * (sign / length);
        let distance = (core.center - segment.center).dot(outward);
        if distance > best.distance + tolerance {
            // Rounding may have led beside the two normals: there other corners reach farther.
            let reach = hull.corner(hull.highest(outward)).dot(outward);
            let distance = distance.min(core.center.dot(outward) - reach);
            if distance > best.distance + tolerance {
                let on_core = core.closest_to_segment(&segment).0;
                best = Nearest { on_core, outward, distance, feature: Feature::Edge(edge.name) };
            }
        }
    }
    best
}

/// The two ends of the part of `core` that lies over the side which `outward` leaves almost at a right angle.
///
/// "Over" is meant along `outward`: the core's point p has the foot f = p − g·outward on the side, and g is its distance.
/// Both are linear in the core's parameter, so the part is found by clipping against the side's edges (Cyrus and Beck
/// 1978).
fn stretch_over_side(core: &Segment, hull: &Polytope, outward: DVec3) -> Option<[OverSide; 2]> {
    if core.half == DVec3::ZERO {
        return None;
    }
    let side = hull.side_towards(outward);
    let plane = &hull.planes[side as usize];
    let slant = plane.normal.dot(outward);
    if slant < FLAT {
        return None;
    }
    let distance = |point: DVec3| plane.height(point) / slant;
    let foot = |point: DVec3| point - outward * distance(point);
    let (middle, end) = (foot(core.center), foot(core.at(1.0)));
    let along = end - middle;

    let face = Feature::Face(side);
    let (mut low, mut high) = ((-1.0, face), (1.0, face));
    let (ring, edges) = (hull.topology.ring(side), hull.topology.ring_edges(side));
    for k in 0..ring.len() {
        let (from, to) = (hull.corner(ring[k]), hull.corner(ring[(k + 1) % ring.len()]));
        let across = (to - from).cross(plane.normal);
        let (room, speed) = (across.dot(from - middle), across.dot(along));
        let edge = Feature::Edge(hull.topology.edge(edges[k]).name);
        let breadth = across.length();
        if speed.abs() <= 1e-12 * breadth * along.length() {
            if room < -rounding(core, hull) * breadth {
                return None;
            }
            continue;
        }
        // The foot is inside while speed·s ≤ room. A core that ends at the border is not cut.
        let s = room / speed;
        if speed > 0.0 && s < high.0 - 1e-9 {
            high = (s, edge);
        } else if speed < 0.0 && s > low.0 + 1e-9 {
            low = (s, edge);
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
