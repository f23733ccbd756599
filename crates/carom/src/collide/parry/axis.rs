//! The direction along which two cores are farthest apart, or least deep in each other.

use super::convex::Core;
use crate::math::{DVec3, Pose};
use parry3d_f64::math::{Pose3, Rot3};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{self, GJKResult, VoronoiSimplex};

/// A direction from `a` to `b` and the gap along it, with the two points where it opens. All in a's frame.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    /// Unit length, from `a` to `b`.
    pub normal: DVec3,
    /// How far `b`'s lowest point lies above `a`'s highest one, m. Never more than the cores' distance.
    pub gap: f64,
    /// Where `a` is touched.
    pub on_a: DVec3,
    /// Where `b` is touched.
    pub on_b: DVec3,
}

/// The axis of the largest gap: for cores apart it is their distance, for cores that overlap minus the shortest way
/// out (the shortest one near the one that EPA finds). `b_in_a` is b's pose in a's frame.
///
/// The closer the cores, the less their closest points say about the direction. So where the gap is small, or
/// negative, `b` is moved away along the axis until the gap is a hundredth of the smaller core, and the direction is read
/// there. For the direction `m` that this finds, `gap(m) + shift·m·n ≥ gap(n) + shift`, so `gap(m) ≥ gap(n)`: each round
/// widens the gap or leaves it. It is the proximal point method (Rockafellar 1976) on `−gap`.
pub(super) fn least_gap(a: &Core, b: &Core, b_in_a: &Pose) -> Axis {
    const ROUNDS: usize = 6;
    let along = |normal: DVec3| {
        let on_a = a.support(normal);
        let on_b = b_in_a.transform_point(b.support(b_in_a.rotation.conjugate() * -normal));
        Axis { normal, gap: (on_b - on_a).dot(normal), on_a, on_b }
    };
    let pose = |shift: DVec3| Pose3 {
        rotation: Rot3::from_xyzw(b_in_a.rotation.x, b_in_a.rotation.y, b_in_a.rotation.z, b_in_a.rotation.w),
        translation: b_in_a.position + shift,
    };
    let measured = |found: &GJKResult, shift: DVec3| match *found {
        GJKResult::ClosestPoints(on_a, on_b, direction) => {
            // Between the points while they are apart; parry's own where they coincide.
            let candidates = [(on_b - on_a).normalize_or_zero(), direction.normalize_or_zero()];
            let usable = candidates.into_iter().filter(|&normal| normal != DVec3::ZERO);
            let best = usable.map(along).max_by(|one, other| one.gap.total_cmp(&other.gap))?;
            Some(Axis { on_a, on_b: on_b - shift, ..best })
        }
        _ => None,
    };

    let start = contact_support_map_support_map_with_params(
        &pose(DVec3::ZERO),
        a,
        b,
        f64::MAX,
        &mut VoronoiSimplex::new(),
        None,
    );
    let mut best = measured(&start, DVec3::ZERO).unwrap_or_else(|| {
        let apart = (b_in_a.transform_point(b.middle()) - a.middle()).normalize_or(DVec3::Y);
        let mut best = along(apart);
        let of_b = b.flat_directions().into_iter().map(|direction| b_in_a.rotation * -direction);
        for direction in a.flat_directions().into_iter().chain(of_b) {
            if direction != DVec3::ZERO && along(direction).gap > best.gap {
                best = along(direction);
            }
        }
        best
    });

    let (reach_a, reach_b) = (a.reach(), b.reach());
    let size = if reach_a.min(reach_b) > 0.0 { reach_a.min(reach_b) } else { reach_a.max(reach_b) };
    if best.gap >= 1e-3 * size {
        return best;
    }
    for _ in 0..ROUNDS {
        let shift = best.normal * (0.01 * size - best.gap);
        let shifted = pose(shift);
        let mut simplex = VoronoiSimplex::new();
        simplex.reset(gjk::CsoPoint::from_shapes(&shifted, a, b, best.normal));
        let found = gjk::closest_points(&shifted, a, b, f64::MAX, true, &mut simplex);
        let Some(next) = measured(&found, shift) else { break };
        let gain = next.gap - best.gap;
        if gain >= 0.0 {
            best = next;
        }
        if gain <= 1e-13 * size {
            break;
        }
    }
    best
}
