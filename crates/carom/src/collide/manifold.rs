//! What a kernel hands back: a normal and the points that share it.

use super::ROUNDING;
use crate::math::{DVec3, Pose};
use crate::report::Feature;

/// One point of touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Midway between the two surfaces.
    pub point: DVec3,
    /// Distance of the surfaces along the normal, m; negative where they overlap.
    pub separation: f64,
    /// What of `a` touches.
    pub feature_a: Feature,
    /// What of `b` touches.
    pub feature_b: Feature,
}

impl ContactPoint {
    /// Fills the places that hold no point.
    pub(crate) const NONE: ContactPoint = ContactPoint {
        point: DVec3::ZERO,
        separation: 0.0,
        feature_a: Feature::Surface,
        feature_b: Feature::Surface,
    };

    /// The same point seen from `b`.
    pub(crate) fn flipped(self) -> Self {
        Self { feature_a: self.feature_b, feature_b: self.feature_a, ..self }
    }
}

/// Up to four points that share a normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Manifold {
    /// Unit vector from `a` to `b`.
    pub normal: DVec3,
    points: [ContactPoint; 4],
    count: usize,
}

impl Manifold {
    /// The points.
    pub fn points(&self) -> &[ContactPoint] {
        &self.points[..self.count]
    }

    /// Moves the points.
    pub(crate) fn shift(&mut self, by: DVec3) {
        self.points[..self.count].iter_mut().for_each(|point| point.point += by);
    }

    /// A manifold without points. `normal` is unit length and points from `a` to `b`.
    pub(crate) fn new(normal: DVec3) -> Self {
        Self { normal, points: [ContactPoint::NONE; 4], count: 0 }
    }

    /// A manifold of one point.
    pub(crate) fn single(normal: DVec3, point: ContactPoint) -> Self {
        let mut manifold = Self::new(normal);
        manifold.push(point);
        manifold
    }

    /// Adds a point; there must be room for it.
    pub(crate) fn push(&mut self, point: ContactPoint) {
        self.points[self.count] = point;
        self.count += 1;
    }

    /// The manifold of the best four of `candidates`, in their order if there are no more than four.
    ///
    /// Keeps the deepest; then the one farthest from it; then the one that spans the largest triangle with these two;
    /// then the one that adds the largest triangle to this one (Gregorius, *Robust Contact Creation for Physics
    /// Simulations*, GDC 2015). Candidates that differ by rounding count as equal: the deepest of equals is taken, and
    /// of those the first, so that noise does not change the choice.
    pub(crate) fn reduced(normal: DVec3, candidates: &[ContactPoint]) -> Self {
        let mut manifold = Self::new(normal);
        if candidates.len() <= 4 {
            candidates.iter().for_each(|&candidate| manifold.push(candidate));
            return manifold;
        }
        let origin = candidates[0].point;
        let extent = candidates.iter().map(|c| c.point.distance(origin)).fold(0.0, f64::max);
        let (length, area) = (ROUNDING * extent, ROUNDING * extent * extent);
        // Twice the area of a triangle seen along the normal, positive if its corners run anticlockwise.
        let spanned = |a: DVec3, b: DVec3, c: DVec3| normal.dot((b - a).cross(c - a));

        let deepest = deepest_of_largest(candidates, (length, length), |c| -c.separation);
        let a = deepest.point;
        let farthest = deepest_of_largest(candidates, (area, length), |c| c.point.distance_squared(a));
        let b = farthest.point;
        manifold.push(deepest);
        if b.distance_squared(a) <= area {
            return manifold;
        }
        manifold.push(farthest);
        let widest = deepest_of_largest(candidates, (area, length), |c| spanned(a, b, c.point).abs());
        if spanned(a, b, widest.point).abs() <= area {
            return manifold;
        }
        manifold.push(widest);
        let [a, b, c] =
            if spanned(a, b, widest.point) > 0.0 { [a, b, widest.point] } else { [b, a, widest.point] };
        let added =
            |p: &ContactPoint| spanned(b, a, p.point).max(spanned(c, b, p.point)).max(spanned(a, c, p.point));
        let last = deepest_of_largest(candidates, (area, length), added);
        if added(&last) > area {
            manifold.push(last);
        }
        manifold
    }

    /// The same manifold with `a` and `b` exchanged.
    pub(crate) fn flipped(mut self) -> Self {
        self.normal = -self.normal;
        for point in &mut self.points[..self.count] {
            *point = point.flipped();
        }
        self
    }

    /// The same manifold, taken from `pose`'s local frame to the outer one.
    pub(crate) fn placed(mut self, pose: &Pose) -> Self {
        self.normal = pose.rotation * self.normal;
        for point in &mut self.points[..self.count] {
            point.point = pose.transform_point(point.point);
        }
        self
    }
}

/// Of those whose value is less than `tolerance` below the largest, the first that is deepest to within `length` (m).
fn deepest_of_largest(
    candidates: &[ContactPoint],
    (tolerance, length): (f64, f64),
    value: impl Fn(&ContactPoint) -> f64,
) -> ContactPoint {
    // Most are few, and each value is asked for more than once.
    let mut known = [0.0; 16];
    known.iter_mut().zip(candidates).for_each(|(known, candidate)| *known = value(candidate));
    let value = |k: usize| if k < known.len() { known[k] } else { value(&candidates[k]) };
    let largest = (0..candidates.len()).map(value).fold(f64::NEG_INFINITY, f64::max);
    let equal = || (0..candidates.len()).filter(|&k| value(k) >= largest - tolerance).map(|k| &candidates[k]);
    let least = equal().map(|c| c.separation).fold(f64::INFINITY, f64::min);
    *equal().find(|c| c.separation <= least + length).unwrap_or(&candidates[0])
}
