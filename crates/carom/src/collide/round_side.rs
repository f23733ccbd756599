//! How a round shape touches a flat side of a box or a hull: at one point, or at the two ends of the stretch of its core that lies
//! over that side. Everything is in the frame of the box or hull.

use super::manifold::{ContactPoint, Manifold};
use crate::math::DVec3;
use crate::report::Feature;

/// A point of a core above a side.
pub(crate) struct OverSide {
    pub on_core: DVec3,
    /// From the side to the core along the normal, m.
    pub distance: f64,
    /// The side, or the edge or corner of it that is closest.
    pub feature: Feature,
}

/// The round shape's part of the question.
pub(crate) struct RoundSide {
    pub radius: f64,
    /// Unit vector from the side to the core.
    pub outward: DVec3,
    /// Distances that differ by less are the same, m.
    pub tolerance: f64,
    pub margin: f64,
}

impl RoundSide {
    /// The manifold, the round shape first, of a core whose closest point is `nearest` and of which `stretch` lies over the side.
    pub(crate) fn manifold(&self, nearest: OverSide, stretch: Option<[OverSide; 2]>) -> Manifold {
        let mut manifold = Manifold::new(-self.outward);
        // Where the closest point is a corner beside the side, the stretch misses it.
        let is_nearest = |end: &OverSide| end.distance <= nearest.distance + self.tolerance;
        if let Some(ends) = stretch.filter(|ends| ends.iter().any(is_nearest)) {
            for end in ends {
                let distance = if is_nearest(&end) { nearest.distance } else { end.distance };
                if distance - self.radius <= self.margin {
                    manifold.push(self.contact(&OverSide { distance, ..end }));
                }
            }
        } else {
            manifold.push(self.contact(&nearest));
        }
        manifold
    }

    fn contact(&self, over: &OverSide) -> ContactPoint {
        ContactPoint {
            point: over.on_core - self.outward * (0.5 * (over.distance + self.radius)),
            separation: over.distance - self.radius,
            feature_a: Feature::Surface,
            feature_b: over.feature,
        }
    }
}
