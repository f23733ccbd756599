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
    const NONE: ContactPoint = ContactPoint {
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
    /// Keeps the deepest; then the one farthest from it; then on each side of the line through these two the one
    /// that spans the largest triangle with them (Gregorius, *Robust Contact Creation for Physics Simulations*,
    /// GDC 2015). Candidates that differ by rounding count as equal, and the first of equals is taken, so that
    /// noise does not change the choice.
    pub(crate) fn reduced(normal: DVec3, candidates: &[ContactPoint]) -> Self {
        let mut manifold = Self::new(normal);
        if candidates.len() <= 4 {
            candidates.iter().for_each(|&candidate| manifold.push(candidate));
            return manifold;
        }
        let origin = candidates[0].point;
        let extent = candidates.iter().map(|c| c.point.distance(origin)).fold(0.0, f64::max);
        let (length, area) = (ROUNDING * extent, ROUNDING * extent * extent);

        let deepest = candidates[first_of_largest(candidates, length, |c| -c.separation)];
        manifold.push(deepest);
        let distance_squared = |c: &ContactPoint| c.point.distance_squared(deepest.point);
        let farthest = candidates[first_of_largest(candidates, area, distance_squared)];
        if distance_squared(&farthest) <= area {
            return manifold;
        }
        manifold.push(farthest);
        let across = normal.cross(farthest.point - deepest.point);
        for side in [across, -across] {
            let spanned = |c: &ContactPoint| side.dot(c.point - deepest.point);
            let widest = candidates[first_of_largest(candidates, area, spanned)];
            if spanned(&widest) > area {
                manifold.push(widest);
            }
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

/// The index of the candidate with the largest value: of those within `tolerance` of each other, the first.
fn first_of_largest(
    candidates: &[ContactPoint],
    tolerance: f64,
    value: impl Fn(&ContactPoint) -> f64,
) -> usize {
    let largest = candidates.iter().map(&value).fold(f64::NEG_INFINITY, f64::max);
    candidates.iter().position(|c| value(c) >= largest - tolerance).unwrap_or(0)
}
