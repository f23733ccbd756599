//! Two polyhedra, of which each is a hull or a cuboid.
//!
//! Apart, their distance is that of their closest points (`closest.rs`). Where they meet, the axis of the widest gap tells
//! the shortest way apart. Such an axis is the normal of a side of `a`, of a side of `b`, or at right angles to an edge of
//! each: the sides of the difference of the two. Which pairs of edges make a side of it is seen on the sphere of all
//! directions, where a side is a point, an edge an arc between two of them, and a corner the region of the directions it
//! is farthest in: two edges make a side where the arc of one crosses the arc, mirrored, of the other. So each edge of `a`
//! is followed along its arc, from one corner of `b` to the next across the edge between them: only pairs that do make
//! a side are ever looked at.
//!
//! Everything happens in `a`'s frame.
//!
//! # Reference
//! Gregorius, *The Separating Axis Test between Convex Polyhedra*, GDC 2013 (arcs on the Gauss map, contacts from axes).

use super::closest::{Closest, closest};
use super::manifold::{ContactPoint, Manifold};
use super::polygon;
use super::polytope::{Farthest, Moved, Polytope};
use super::segment::Segment;
use super::{FLAT, Gap, ROUNDING};
use crate::hull::Plane;
use crate::math::{DVec3, Pose};
use crate::report::Feature;

/// The square of the sine below which two edges are parallel: their cross product would be rounding.
const PARALLEL: f64 = 1e-16;

/// Where a hull's sides are flat only nearly, so much of its size may a corner be off the plane.
const UNEVEN: f64 = 2e-9;

/// Which features an axis comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    SideA(u32),
    SideB(u32),
    /// An edge of each, by their ends.
    Edges([u32; 2], [u32; 2]),
}

/// A direction and how far apart the polyhedra are along it.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// Unit vector from `a` to `b`.
    normal: DVec3,
    gap: f64,
    source: Source,
}

/// Two polyhedra in `a`'s frame.
struct Pair<'a> {
    a: Moved<'a, Polytope<'a>>,
    b: Moved<'a, Polytope<'a>>,
    /// The middle of `b`.
    middle_b: DVec3,
    /// A length that tells what is small for this pair.
    size: f64,
}

/// Points of a polyhedron that bound the gap to it along any direction: it is no wider than any of its points is far.
struct Probes {
    middle: DVec3,
    /// Of a ball around the middle that the polyhedron holds.
    inner_radius: f64,
    /// The point that came closest to the other one so far.
    closest: DVec3,
}

impl Probes {
    fn new(polytope: &Moved<Polytope>, closest: DVec3) -> Self {
        Self {
            middle: polytope.place(polytope.shape.middle),
            inner_radius: polytope.shape.inner_radius,
            closest,
        }
    }

    /// Whether the gap along the normal of a side may be wider than `bound`.
    fn allow(&self, plane: &Plane, bound: f64) -> bool {
        plane.height(self.closest) > bound && plane.height(self.middle) - self.inner_radius > bound
    }

    /// The same for any direction between two sides that meet in an edge. Such a direction is the sum of the two normals
    /// with weights that are together from 1 to 1/cos(θ/2), with θ the angle between them, and so is a point's height over
    /// the edge that of its heights over the sides.
    fn allow_arc(&self, one: &Plane, other: &Plane, bound: f64) -> bool {
        let over = |point: DVec3| {
            let height = one.height(point).max(other.height(point));
            let weight = || (2.0 / (1.0 + one.normal.dot(other.normal))).sqrt();
            if height <= 0.0 { height } else { height * weight() }
        };
        over(self.closest) > bound && over(self.middle) - self.inner_radius > bound
    }
}

/// The distance, or the widest gap along an axis that can separate the two.
pub(crate) fn gap(a: &Polytope, b: &Polytope) -> Gap {
    let pair = Pair::new(a, b);
    let Some(closest) = pair.closest(f64::INFINITY) else {
        return Gap { separation: f64::INFINITY, normal: None };
    };
    let found = (closest.gap, closest.normal);
    let axis = if closest.is_apart { None } else { pair.best_axis(&closest) };
    let wider = axis.filter(|axis| axis.gap > closest.gap).map(|axis| (axis.gap, axis.normal));
    let (separation, normal) = wider.unwrap_or(found);
    Gap::along(separation, a.pose.rotation * normal)
}

/// The gap along `normal` (unit length, in the common frame, from `a` to `b`): never more than the distance.
pub(crate) fn separation_along(a: &Polytope, b: &Polytope, normal: DVec3) -> f64 {
    let highest = a.corner(a.highest(a.pose.rotation.conjugate() * normal));
    let lowest = b.corner(b.highest(b.pose.rotation.conjugate() * -normal));
    (b.pose.transform_point(lowest) - a.pose.transform_point(highest)).dot(normal)
}

/// The contacts along the axis of the widest gap, or between the closest points where these are closer than the gap
/// along any axis tells.
pub(crate) fn manifold(a: &Polytope, b: &Polytope, margin: f64) -> Option<Manifold> {
    let pair = Pair::new(a, b);
    let closest = pair.closest(margin)?;
    Some(pair.contacts(&closest, margin)?.placed(&a.pose))
}

impl<'a> Pair<'a> {
    fn new(a: &'a Polytope<'a>, b: &'a Polytope<'a>) -> Self {
        let moved_b = Moved::new(b, &a.pose.relative(&b.pose));
        let middle_b = moved_b.place(b.middle);
        Self { a: Moved::new(a, &Pose::IDENTITY), b: moved_b, middle_b, size: a.size() + b.size() }
    }

    fn closest(&self, limit: f64) -> Option<Closest> {
        let towards = self.middle_b - self.a.shape.middle;
        let found = closest((self.a.shape, &self.b), towards, self.size, limit)?;
        Some(if found.is_apart { found } else { self.less_deep(found) })
    }

    /// For two that meet, a direction along which they are less deep in each other, so that few axes need a look: that
    /// in which `b`, moved out along the one known, is closest. With `m` that direction, n the one known and s the way,
    /// `gap(m) + s·m·n ≥ gap(n) + s`, so `gap(m) ≥ gap(n)`.
    fn less_deep(&self, found: Closest) -> Closest {
        let shift = found.normal * (0.02 * self.size - found.gap);
        let moved = Moved { shift: self.b.shift + shift, ..self.b };
        let Some(next) = closest((self.a.shape, &moved), found.normal, self.size, f64::INFINITY) else {
            return found;
        };
        let gap = self.gap(next.normal);
        if gap > found.gap { Closest { gap, is_apart: false, ..next } } else { found }
    }

    /// The gap along the unit vector `normal`: never more than the distance, whatever the direction.
    fn gap(&self, normal: DVec3) -> f64 {
        (self.b.farthest(-normal).1 - self.a.shape.farthest(normal).1).dot(normal)
    }

    /// The axis of the widest gap that is not less than `closest`'s. Where axes tie but for rounding, sides of `a` go before
    /// sides of `b`, and both before edges. None where two polyhedra apart are closest at corners: then no axis has a gap as
    /// wide as their distance.
    fn best_axis(&self, closest: &Closest) -> Option<Axis> {
        let (a, b) = (self.a.shape, self.b.shape);
        let tolerance = ROUNDING * self.size;
        let floor = closest.gap - 4.0 * tolerance;
        let mut best: Option<Axis> = None;
        let bound = |best: &Option<Axis>| best.map_or(floor, |axis| axis.gap + tolerance);
        let (on_a, on_b) = closest.points(a, &self.b);
        let probes = Probes::new(&self.b, on_b);
        for (plane, side) in a.planes.iter().zip(0..) {
            if probes.allow(plane, bound(&best)) {
                let gap = plane.height(self.b.farthest(-plane.normal).1);
                if gap > bound(&best) {
                    best = Some(Axis { normal: plane.normal, gap, source: Source::SideA(side) });
                }
            }
        }
        let a_in_b =
            Moved { shape: a, turn: self.b.back, back: self.b.turn, shift: self.b.back * -self.b.shift };
        let probes_a = Probes::new(&a_in_b, a_in_b.place(on_a));
        for (plane, side) in b.planes.iter().zip(0..) {
            if probes_a.allow(plane, bound(&best)) {
                let gap = plane.height(a_in_b.farthest(-plane.normal).1);
                if gap > bound(&best) {
                    best =
                        Some(Axis { normal: self.b.turn * -plane.normal, gap, source: Source::SideB(side) });
                }
            }
        }
        for (plane, side) in a.planes.iter().zip(0..) {
            // An arc that is not ruled out has a side that the point is so high above.
            if plane.height(probes.closest) > bound(&best).min(0.0) {
                self.follow_edges(side, &probes, &mut best, floor);
            }
        }
        best
    }

    /// Looks for a wider gap at right angles to the edges on the border of a side of `a` and edges of `b`.
    fn follow_edges(&self, side: u32, probes: &Probes, best: &mut Option<Axis>, floor: f64) {
        let (a, b) = (self.a.shape, self.b.shape);
        let plane = &a.planes[side as usize];
        let height = plane.height(probes.closest);
        let mut start = None;
        for &number in a.topology.ring_edges(side) {
            let edge = a.topology.edge(number);
            let other_side = edge.sides[0] ^ edge.sides[1] ^ side;
            let other = &a.planes[other_side as usize];
            let beyond = other.height(probes.closest);
            // Each edge once: from the side that the point is higher above.
            if beyond > height || (beyond == height && other_side < side) {
                continue;
            }
            let bound = best.map_or(floor, |axis| axis.gap + ROUNDING * self.size);
            // The features that the axis comes from meet when it has been gone along.
            let reach = bound.abs() + 1e-9 * self.size;
            if probes.allow_arc(plane, other, bound) && self.is_near(edge.ends, reach) {
                let (first, second) = (self.b.back * -plane.normal, self.b.back * -other.normal);
                let start = *start.get_or_insert_with(|| b.highest(first));
                self.follow_arc(edge.ends, (start, first, second), best, bound);
            }
        }
    }

    /// Whether an edge of `a` comes within `reach` of the box around `b`.
    fn is_near(&self, ends: [u32; 2], reach: f64) -> bool {
        let [from, to] = ends.map(|end| self.b.back * (self.a.shape.corner(end) - self.b.shift));
        let (low, high) = self.b.shape.bounds;
        let (lowest, highest) = (from.min(to), from.max(to));
        (lowest - DVec3::splat(reach)).cmple(high).all() && (highest + DVec3::splat(reach)).cmpge(low).all()
    }

    /// Goes from corner to corner of `b` while the direction (in b's frame) turns from `first`, along which `start` is the
    /// highest, to `second`. On the way n(t) = (1 − t)·first + t·second the corners' heights are linear in t: the next
    /// corner is the neighbour that overtops this one first.
    fn follow_arc(
        &self,
        edge_a: [u32; 2],
        (start, first, second): (u32, DVec3, DVec3),
        best: &mut Option<Axis>,
        mut bound: f64,
    ) {
        let (a, b) = (self.a.shape, self.b.shape);
        let tolerance = ROUNDING * self.size;
        let [from_a, to_a] = edge_a.map(|end| a.corner(end));
        let along_a = self.b.back * (to_a - from_a);
        let from_a = self.b.back * (from_a - self.b.shift);
        let mut here = start;
        for _ in 0..b.corners.len() {
            let place = b.corner(here);
            let mut next: Option<(u32, f64)> = None;
            for &number in b.topology.around(here) {
                let other = b.topology.edge(number).beyond(here);
                let step = b.corner(other) - place;
                let gain = second.dot(step);
                if gain > 0.0 {
                    let loss = -first.dot(step);
                    let at = loss / (loss + gain);
                    if next.is_none_or(|(_, earliest)| at < earliest) {
                        next = Some((other, at));
                    }
                }
            }
            let Some((other, _)) = next else { return };
            let along_b = b.corner(other) - place;
            let cross = along_a.cross(along_b);
            // In b's frame first and second look from b to a.
            let cross = if cross.dot(first + second) > 0.0 { -cross } else { cross };
            let scaled = cross.dot(place - from_a);
            let squared = cross.length_squared();
            let edge_b = [here, other];
            here = other;
            let parallel = squared <= PARALLEL * along_a.length_squared() * along_b.length_squared();
            let narrow = if scaled <= 0.0 {
                bound >= 0.0 || scaled * scaled >= bound * bound * squared
            } else {
                bound > 0.0 && scaled * scaled <= bound * bound * squared
            };
            if parallel || narrow {
                continue;
            }
            let length = squared.sqrt();
            let normal = self.b.turn * (cross / length);
            // Rounding may have led to edges that make no side: then others reach farther.
            let gap = (scaled / length).min(self.gap(normal));
            if gap > bound {
                *best = Some(Axis { normal, gap, source: Source::Edges(edge_a, edge_b) });
                bound = gap + tolerance;
            }
        }
    }

    /// A side's axis gives the overlap of two sides, seen along it. So does an edge pair's if it is almost at a right angle
    /// to a side of either: what rests a hair askew on a side or an edge has several points, not one. Any other edge pair gives the one point where
    /// the edges come closest. Where the closest points are closer than all of this, the contact is between them.
    fn contacts(&self, closest: &Closest, margin: f64) -> Option<Manifold> {
        let Some(axis) = self.best_axis(closest) else {
            return closest.is_apart.then(|| self.at_corners(closest));
        };
        if axis.gap > margin {
            return None;
        }
        let (side_a, side_b) = self.sides(&axis);
        if let Source::Edges(edge_a, edge_b) = axis.source {
            let normal_a = self.a.shape.planes[side_a as usize].normal;
            let normal_b = self.b.turn * self.b.shape.planes[side_b as usize].normal;
            if normal_a.dot(axis.normal) < FLAT && -normal_b.dot(axis.normal) < FLAT {
                return Some(Manifold::single(axis.normal, self.crossing(&axis, edge_a, edge_b)));
            }
        }
        let patch = polygon::overlap((&self.a, side_a), (&self.b, side_b), axis.normal);
        let tolerance = UNEVEN * self.size;
        if patch.least() <= axis.gap + tolerance {
            return patch.reduced(axis.normal, (axis.gap, tolerance), margin);
        }
        Some(if closest.is_apart {
            self.at_corners(closest)
        } else {
            patch.with(self.deepest(&axis), margin, axis.normal)
        })
    }

    /// The sides that face each other along the axis.
    fn sides(&self, axis: &Axis) -> (u32, u32) {
        let side_a = match axis.source {
            Source::SideA(side) => side,
            _ => self.a.shape.side_towards(axis.normal),
        };
        let side_b = match axis.source {
            Source::SideB(side) => side,
            _ => self.b.shape.side_towards(self.b.back * -axis.normal),
        };
        (side_a, side_b)
    }

    /// The contact of two edges that cross, seen along the axis.
    fn crossing(&self, axis: &Axis, ends_a: [u32; 2], ends_b: [u32; 2]) -> ContactPoint {
        let (edge_a, local_b) = (self.a.shape.segment(ends_a), self.b.shape.segment(ends_b));
        let edge_b = Segment { center: self.b.place(local_b.center), half: self.b.turn * local_b.half };
        let (on_a, on_b) = edge_a.closest_to_segment(&edge_b);
        let feature_a = self.a.shape.feature_of(&ends_a, axis.normal);
        let feature_b = self.b.shape.feature_of(&ends_b, self.b.back * -axis.normal);
        let point = 0.5 * (on_a + on_b);
        ContactPoint { point, separation: axis.gap, feature_a, feature_b }
    }

    /// The contact of the closest points of two polyhedra apart.
    fn at_corners(&self, closest: &Closest) -> Manifold {
        let (numbers_a, numbers_b, count) = closest.corners();
        let (on_a, on_b) = closest.points(self.a.shape, &self.b);
        let feature_a = self.a.shape.feature_of(&numbers_a[..count], closest.normal);
        let feature_b = self.b.shape.feature_of(&numbers_b[..count], self.b.back * -closest.normal);
        let (point, separation) = (0.5 * (on_a + on_b), closest.gap);
        let contact = ContactPoint { point, separation, feature_a, feature_b };
        Manifold::single(closest.normal, contact)
    }

    /// The deepest point of an overlap: the crossing of the edges that the axis comes from, or the corner farthest into
    /// the side. For where the sides that face each other do not have it: the edges may belong to others.
    fn deepest(&self, axis: &Axis) -> ContactPoint {
        let half_way = axis.normal * (0.5 * axis.gap);
        let (point, feature_a, feature_b) = match axis.source {
            Source::Edges(edge_a, edge_b) => return self.crossing(axis, edge_a, edge_b),
            Source::SideA(side) => {
                let (corner, place) = self.b.farthest(-axis.normal);
                (place - half_way, Feature::Face(side), Feature::Vertex(corner))
            }
            Source::SideB(side) => {
                let (corner, place) = self.a.shape.farthest(axis.normal);
                (place + half_way, Feature::Vertex(corner), Feature::Face(side))
            }
        };
        ContactPoint { point, separation: axis.gap, feature_a, feature_b }
    }
}

#[cfg(test)]
mod tests;
