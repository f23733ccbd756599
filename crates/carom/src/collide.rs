//! Collision detection: how far apart two shapes are, and where they touch.
//!
//! Both questions take the shapes' poses in one common frame near both of them (the caller moves the origin there, so
//! that nothing is lost far from the world's origin). The normal always points from `a` to `b`.

mod parry;

use crate::math::{DVec3, Pose};
use crate::report::Feature;
use crate::shape::Shape;

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

    /// A manifold without points. `normal` is unit length and points from `a` to `b`.
    pub(crate) fn new(normal: DVec3) -> Self {
        let (feature_a, feature_b) = (Feature::Surface, Feature::Surface);
        let none = ContactPoint { point: DVec3::ZERO, separation: 0.0, feature_a, feature_b };
        Self { normal, points: [none; 4], count: 0 }
    }

    /// Adds a point; there must be room for it.
    pub(crate) fn push(&mut self, point: ContactPoint) {
        self.points[self.count] = point;
        self.count += 1;
    }
}

/// How far apart the shapes are, m: never more than their true distance, zero when they touch, negative when they overlap.
pub fn separation(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> f64 {
    parry::separation(a, pose_a, b, pose_b)
}

/// Appends the manifolds of all places where the surfaces are no further apart than `margin` (m).
pub fn manifolds(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64, out: &mut Vec<Manifold>) {
    parry::manifolds(a, b, margin, out);
}
