//! Closest points of segments, points and boxes: the cores of round shapes against everything.

use crate::math::DVec3;

/// The square of the sine below which two directions are parallel: there the direction of their cross product is
/// rounding, and the ends of the segments give the same distance.
const PARALLEL: f64 = 1e-16;

/// All points `center + s·half` with −1 ≤ s ≤ 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// The middle.
    pub(crate) center: DVec3,
    /// From the middle to the end at s = 1.
    pub(crate) half: DVec3,
}

impl Segment {
    /// The point at `s`.
    pub(crate) fn at(&self, s: f64) -> DVec3 {
        self.center + self.half * s
    }

    /// The point closest to `point`: its projection on the line, clamped (Ericson, *Real-Time Collision Detection*,
    /// 2005, 5.1.2).
    pub(crate) fn closest_to_point(&self, point: DVec3) -> DVec3 {
        let s = (point - self.center).dot(self.half) / self.half.length_squared();
        self.at(s.clamp(-1.0, 1.0))
    }

    /// The closest points of two segments, `self`'s first.
    ///
    /// With n = `half_a × half_b` and r from `a`'s centre to `b`'s, the lines come closest at
    ///
    /// ```text
    /// s = (r × half_b)·n / n²        t = (r × half_a)·n / n²
    /// ```
    ///
    /// If both lie on the segments that is the answer; otherwise one of the four ends is part of it. This differs from
    /// Ericson 2005, 5.1.9, whose determinant `a²b² − (a·b)²` loses half the digits where the lines are nearly
    /// parallel, and keeps the distance continuous there.
    pub(crate) fn closest_to_segment(&self, other: &Segment) -> (DVec3, DVec3) {
        let normal = self.half.cross(other.half);
        let squared = normal.length_squared();
        if squared > PARALLEL * self.half.length_squared() * other.half.length_squared() {
            let offset = other.center - self.center;
            let s = offset.cross(other.half).dot(normal) / squared;
            let t = offset.cross(self.half).dot(normal) / squared;
            if s.abs() <= 1.0 && t.abs() <= 1.0 {
                return (self.at(s), other.at(t));
            }
        }
        let mut best = (DVec3::ZERO, DVec3::ZERO);
        let mut least = f64::INFINITY;
        for end in [-1.0, 1.0] {
            let (on_self, on_other) = (self.at(end), other.at(end));
            for pair in
                [(on_self, other.closest_to_point(on_self)), (self.closest_to_point(on_other), on_other)]
            {
                let squared = pair.0.distance_squared(pair.1);
                if squared < least {
                    (least, best) = (squared, pair);
                }
            }
        }
        best
    }

    /// The `s` of the point closest to the box |x| ≤ `half_box`.
    ///
    /// With e(s) the offset of the segment's point from the box, the slope of the squared distance is `2·e·half`:
    /// it never falls with s, since the distance to a convex set is convex, and it is linear between the six places
    /// where the line crosses the planes of the box's faces. So its zero is bracketed by those places in any order
    /// and then found exactly.
    pub(crate) fn closest_to_box(&self, half_box: DVec3) -> f64 {
        let slope = |s: f64| outside(self.at(s), half_box).dot(self.half);
        let (mut low, mut high) = (-1.0, 1.0);
        let mut slope_low = slope(low);
        if slope_low >= 0.0 {
            return low;
        }
        let mut slope_high = slope(high);
        if slope_high <= 0.0 {
            return high;
        }
        for axis in 0..3 {
            for face in [-half_box[axis], half_box[axis]] {
                // Infinite or NaN where the segment runs along the face: then neither comparison holds.
                let s = (face - self.center[axis]) / self.half[axis];
                if s > low && s < high {
                    let slope = slope(s);
                    if slope < 0.0 {
                        (low, slope_low) = (s, slope);
                    } else {
                        (high, slope_high) = (s, slope);
                    }
                }
            }
        }
        low + (high - low) * (slope_low / (slope_low - slope_high))
    }
}

/// The offset of `point` from the closest point of the box |x| ≤ `half_box`; zero inside (Ericson 2005, 5.1.3).
pub(crate) fn outside(point: DVec3, half_box: DVec3) -> DVec3 {
    point - point.clamp(-half_box, half_box)
}
