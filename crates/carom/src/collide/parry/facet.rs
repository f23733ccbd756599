//! A triangle of a surface against a ball, a capsule, a cuboid or a hull: what moves over a surface asks this many times a step.
//!
//! Apart, the distance is that of the closest points. Where the two meet, the shortest way apart is along the axis of the widest
//! gap, and that is the normal of a side of the difference of the two: the triangle's own, that of a side of the other one, or
//! at right angles to an edge of each (`facet/way_out.rs`). Everything happens in the surface's frame.
//!
//! # Reference
//! Ericson, *Real-Time Collision Detection* (2005), 5.1.5 (the closest point of a triangle), 5.1.10 (a segment and a triangle).

mod form;
mod way_out;

use super::axis::Axis;
use crate::collide::ROUNDING;
use crate::collide::closest::closest;
use crate::collide::polytope::{Farthest, Moved, Polytope};
use crate::collide::segment::Segment;
use crate::math::DVec3;
pub(super) use form::Form;

/// What is beyond something by this share of the sizes is so whatever rounding did.
const BEYOND: f64 = 1e-6;

/// A triangle with an area.
pub(super) struct Facet {
    corners: [DVec3; 3],
    /// Unit length; the corners run anticlockwise around it.
    normal: DVec3,
}

impl Farthest for Facet {
    fn farthest(&self, direction: DVec3) -> (u32, DVec3) {
        let [a, b, c] = self.corners.map(|corner| corner.dot(direction));
        let number = if c > a && c > b { 2 } else { u32::from(b > a) };
        (number, self.point(number))
    }

    fn point(&self, number: u32) -> DVec3 {
        self.corners[number as usize]
    }
}

impl Facet {
    /// Of a direction at right angles to it around which its corners run anticlockwise; `None` where rounding leaves none.
    pub fn new(corners: [DVec3; 3], normal: DVec3) -> Option<Self> {
        (normal != DVec3::ZERO).then_some(Self { corners, normal })
    }

    /// A length like the triangle's own, m.
    fn size(&self) -> f64 {
        let [a, b, c] = self.corners;
        0.5 * (a.max(b).max(c) - a.min(b).min(c)).max_element()
    }

    /// How far `point` is above the triangle's plane, m.
    fn height(&self, point: DVec3) -> f64 {
        (point - self.corners[0]).dot(self.normal)
    }

    /// Whether the foot of `point` on the triangle's plane lies in the triangle.
    fn is_over(&self, point: DVec3) -> bool {
        (0..3).all(|side| {
            let (from, to) = (self.corners[side], self.corners[(side + 1) % 3]);
            (to - from).cross(point - from).dot(self.normal) >= 0.0
        })
    }

    /// The triangle's point closest to `point`.
    fn closest_to(&self, point: DVec3) -> DVec3 {
        if self.is_over(point) {
            return point - self.normal * self.height(point);
        }
        let on_side = |side: usize| {
            let (from, to) = (self.corners[side], self.corners[(side + 1) % 3]);
            let along = to - from;
            let place = from + along * ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (place.distance_squared(point), place)
        };
        let nearer = |one: (f64, DVec3), other: (f64, DVec3)| if other.0 < one.0 { other } else { one };
        nearer(nearer(on_side(0), on_side(1)), on_side(2)).1
    }

    /// The triangle's side between its corners number `side` and the next.
    fn side(&self, side: usize) -> Segment {
        let (from, to) = (self.corners[side], self.corners[(side + 1) % 3]);
        Segment { center: 0.5 * (from + to), half: 0.5 * (to - from) }
    }

    /// Directions along which the gap to something around `middle` is likely to be wide.
    pub fn ways_to(&self, middle: DVec3) -> [Option<DVec3>; 2] {
        [Some(self.normal_towards(middle)), (middle - self.closest_to(middle)).try_normalize()]
    }

    /// A gap (m) that the distance from a core is no less than, at the price of a few points; one beyond `limit` will do.
    pub fn gap_at_least(&self, form: &Form, limit: f64) -> f64 {
        match form {
            Form::Point(point) => self.closest_to(*point).distance(*point),
            Form::Segment(core) => {
                let reach = core.half.dot(self.normal).abs();
                let over = self.height(core.center).abs() - reach;
                if over > limit {
                    return over;
                }
                over.max(self.gap_beside(core))
            }
            Form::Solid(solid) => {
                let middle = solid.place(solid.shape.middle);
                let own = self.normal_towards(middle);
                let over = (solid.farthest(-own).1 - self.corners[0]).dot(own);
                if over > limit {
                    return over;
                }
                let way = middle - self.closest_to(middle);
                over.max(self.gap_towards(way, |way| solid.farthest(-way).1.dot(way)))
            }
        }
    }

    /// The gap to a core along the way to its middle.
    fn gap_beside(&self, core: &Segment) -> f64 {
        let way = core.center - self.closest_to(core.center);
        self.gap_towards(way, |way| core.center.dot(way) - core.half.dot(way).abs())
    }

    /// The gap along a way of any length; `lowest` tells how far the other one reaches against it.
    fn gap_towards(&self, way: DVec3, lowest: impl Fn(DVec3) -> f64) -> f64 {
        way.try_normalize().map_or(f64::NEG_INFINITY, |way| lowest(way) - self.farthest(way).1.dot(way))
    }

    /// The triangle's normal, on the side where `point` is.
    fn normal_towards(&self, point: DVec3) -> DVec3 {
        if self.height(point) < 0.0 { -self.normal } else { self.normal }
    }

    /// Whether a core lies beyond one of the triangle's sides, seen along `normal` (unit length), and by more than rounding.
    pub fn is_beside(&self, form: &Form, normal: DVec3) -> bool {
        const EDGE_ON: f64 = 0.05;
        let facing = self.normal.dot(normal);
        let (middle, size) = (form.middle(), self.size() + form.size());
        facing.abs() > EDGE_ON
            && (0..3).any(|side| {
                let (from, to) = (self.corners[side], self.corners[(side + 1) % 3]);
                let outward = (to - from).cross(normal) * facing.signum();
                let is_beyond = |point: DVec3| (point - from).dot(outward) > BEYOND * size * outward.length();
                is_beyond(middle) && is_beyond(form.farthest(-outward))
            })
    }

    /// As [`super::axis::gap_within`].
    pub fn gap_within(&self, form: &Form, limit: f64) -> Option<Axis> {
        match form {
            Form::Point(point) => self.to_point(*point, limit),
            Form::Segment(core) => self.to_segment(core, limit),
            Form::Solid(solid) => self.to_solid(solid, limit),
        }
    }

    fn to_point(&self, point: DVec3, limit: f64) -> Option<Axis> {
        let height = self.height(point).abs();
        if height > limit {
            return None;
        }
        let on_a = self.closest_to(point);
        let offset = point - on_a;
        let distance = offset.length();
        if distance > limit {
            return None;
        }
        let own = self.normal_towards(point);
        Some(if height >= distance - ROUNDING * self.size() {
            Axis { normal: own, gap: height, on_a, on_b: point }
        } else {
            Axis { normal: offset / distance, gap: distance, on_a, on_b: point }
        })
    }

    /// The closest points of triangle and core are an end over the triangle, or on a side, or the core passes through.
    fn to_segment(&self, core: &Segment, limit: f64) -> Option<Axis> {
        let own = self.over(&[core.at(-1.0), core.at(1.0)]);
        if own.gap > limit {
            return None;
        }
        if own.gap >= 0.0 && self.is_over(own.on_b) {
            return Some(own);
        }
        if limit < f64::MAX && self.gap_beside(core) > limit {
            return None;
        }
        let size = self.size() + core.half.abs().max_element();
        let pairs = [0, 1, 2].map(|side| {
            let (on_a, on_b) = self.side(side).closest_to_segment(core);
            (on_a.distance_squared(on_b), on_a, on_b)
        });
        let (squared, on_a, on_b) =
            pairs.into_iter().fold(pairs[0], |best, pair| if pair.0 < best.0 { pair } else { best });
        let distance = squared.sqrt();
        let passes = own.gap < 0.0 && self.is_over(core.at(self.height(core.center) / -self.rise(core)));
        if !passes && distance > limit {
            return None;
        }
        let tolerance = ROUNDING * size;
        let mut best = own;
        if !passes && distance > best.gap + tolerance {
            best = Axis { normal: (on_b - on_a) / distance, gap: distance, on_a, on_b };
        }
        // Beside rounding the points of a narrow gap tell no direction.
        if passes || distance < 1e-3 * size {
            for (side, &(_, on_a, on_b)) in pairs.iter().enumerate() {
                if let Some((normal, gap)) = self.across_side(side, core)
                    && gap > best.gap + if passes { tolerance } else { -tolerance }
                    && gap > own.gap + tolerance
                {
                    best = Axis { normal, gap, on_a, on_b };
                }
            }
        }
        Some(best)
    }

    /// How much higher a core's end at s = 1 is than its middle, m; not zero.
    fn rise(&self, core: &Segment) -> f64 {
        let rise = core.half.dot(self.normal);
        if rise == 0.0 { f64::MIN_POSITIVE } else { rise }
    }

    /// The direction from the triangle to a core at right angles to that and one of its sides, and the gap along it.
    fn across_side(&self, side: usize, core: &Segment) -> Option<(DVec3, f64)> {
        let edge = self.side(side);
        let cross = edge.half.cross(core.half);
        let squared = cross.length_squared();
        if squared <= 1e-16 * edge.half.length_squared() * core.half.length_squared() {
            return None;
        }
        // The triangle must lie on one side of it.
        let inward = (self.corners[(side + 2) % 3] - edge.center).dot(cross);
        let normal = cross * (if inward > 0.0 { -1.0 } else { 1.0 } / squared.sqrt());
        Some((normal, (core.center - edge.center).dot(normal)))
    }

    /// The gap along the triangle's normal to some points, on the side on which it is wider.
    fn over(&self, points: &[DVec3]) -> Axis {
        let gap = |own: DVec3| {
            let height = |point: DVec3| (point - self.corners[0]).dot(own);
            let lowest = points.iter().fold((f64::INFINITY, DVec3::ZERO), |lowest, &point| {
                if height(point) < lowest.0 { (height(point), point) } else { lowest }
            });
            Axis { normal: own, gap: lowest.0, on_a: lowest.1 - own * lowest.0, on_b: lowest.1 }
        };
        let (above, below) = (gap(self.normal), gap(-self.normal));
        if below.gap > above.gap { below } else { above }
    }

    fn to_solid(&self, solid: &Moved<Polytope>, limit: f64) -> Option<Axis> {
        let middle = solid.place(solid.shape.middle);
        let normal = self.normal_towards(middle);
        let on_b = solid.farthest(-normal).1;
        let gap = (on_b - self.corners[0]).dot(normal);
        if gap > limit {
            return None;
        }
        let own = Axis { normal, gap, on_a: on_b - normal * gap, on_b };
        if gap > 0.0 && self.is_over(on_b) {
            return Some(own);
        }
        let towards = middle - self.closest_to(middle);
        if limit < f64::MAX && self.gap_towards(towards, |way| solid.farthest(-way).1.dot(way)) > limit {
            return None;
        }
        if gap <= 0.0 {
            // Where the way from its middle to its lowest corner passes through the plane.
            let share = gap / (gap - (middle - self.corners[0]).dot(normal));
            let through = on_b + (middle - on_b) * share;
            if self.is_over(through) {
                return Some(self.way_out(solid, through));
            }
        }
        let size = self.size() + solid.shape.size();
        let towards = if gap > 0.0 { normal } else { towards };
        let found = closest((self, solid), towards, size, limit)?;
        let (on_a, on_b) = found.points(self, solid);
        if !found.is_apart {
            return Some(self.way_out(solid, on_a));
        }
        // The triangle's own direction is known to the last bit.
        let is_own = own.gap >= found.gap - ROUNDING * size;
        Some(if is_own { own } else { Axis { normal: found.normal, gap: found.gap, on_a, on_b } })
    }
}

#[cfg(test)]
mod tests;
