//! The direction along which two cores are farthest apart, or least deep in each other.

mod crest;

use super::convex::Core;
use crate::math::{DVec3, Pose};
pub(super) use crest::on_crest;
use parry3d_f64::math::{Pose3, Rot3};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{self, GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

/// A direction from `a` to `b` and the gap along it, with the two points where it opens. All in a's frame.
#[derive(Clone, Copy, Debug)]
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

/// A core measured in a unit near its own size: parry's tolerances are absolute lengths.
struct Scaled<'a> {
    core: &'a Core<'a>,
    per_unit: f64,
}

impl SupportMap for Scaled<'_> {
    fn local_support_point(&self, direction: DVec3) -> DVec3 {
        self.core.support(direction) * self.per_unit
    }
}

/// The axis of the largest gap: for cores apart it is their distance, for cores that overlap minus the shortest way
/// out (the shortest one near the one that EPA finds). `b_in_a` is b's pose in a's frame.
///
/// The closer the cores, the less their closest points say about the direction. So where the gap is small, or
/// negative, `b` is moved away along the axis until the gap is a hundredth of the smaller core, and the direction is read
/// there. For the direction `m` that this finds, `gap(m) + shift·m·n ≥ gap(n) + shift`, so `gap(m) ≥ gap(n)`: each round
/// widens the gap or leaves it. It is the proximal point method (Rockafellar 1976) on `−gap`.
///
/// Between polyhedra the gap is good to rounding, where a core is curved to 10⁻⁸ of the smaller core: so much it may
/// fall short, and jitter from pose to pose.
pub(super) fn least_gap(a: &Core, b: &Core, b_in_a: &Pose) -> Axis {
    gap_within(a, b, b_in_a, f64::MAX)
        .unwrap_or_else(|| best_guess(a, b, b_in_a, &|n| along(a, b, b_in_a, n)))
}

/// As [`least_gap`], but `None` as soon as it is clear that the cores are farther apart than `limit` (m).
pub(super) fn gap_within(a: &Core, b: &Core, b_in_a: &Pose, limit: f64) -> Option<Axis> {
    const ROUNDS: usize = 12;
    const APART: f64 = 0.01;
    let (reach_a, reach_b) = (a.reach(), b.reach());
    let size = if reach_a.min(reach_b) > 0.0 { reach_a.min(reach_b) } else { reach_a.max(reach_b) };
    let unit = if size > 0.0 { size } else { 1.0 };
    let (scaled_a, scaled_b) =
        (Scaled { core: a, per_unit: 1.0 / unit }, Scaled { core: b, per_unit: 1.0 / unit });
    let turn = b_in_a.rotation;
    let pose = |shift: DVec3| Pose3 {
        rotation: Rot3::from_xyzw(turn.x, turn.y, turn.z, turn.w),
        translation: (b_in_a.position + shift) / unit,
    };

    let along = |normal: DVec3| along(a, b, b_in_a, normal);
    let measured = |found: &GJKResult, shift: DVec3| match *found {
        GJKResult::ClosestPoints(on_a, on_b, direction) => {
            // Between the points while they are apart; parry's own where they coincide.
            let candidates = [(on_b - on_a).normalize_or_zero(), direction.normalize_or_zero()];
            let usable = candidates.into_iter().filter(|&normal| normal != DVec3::ZERO);
            let best = usable.map(along).max_by(|one, other| one.gap.total_cmp(&other.gap))?;
            Some(Axis { on_a: on_a * unit, on_b: on_b * unit - shift, ..best })
        }
        _ => None,
    };

    let mut simplex = VoronoiSimplex::new();
    let start = contact_support_map_support_map_with_params(
        &pose(DVec3::ZERO),
        &scaled_a,
        &scaled_b,
        // Rounding must not turn away what is just near enough.
        (limit / unit + 1e-6).min(f64::MAX),
        &mut simplex,
        None,
    );
    // parry says the same where it gives up.
    if let GJKResult::NoIntersection(direction) = start
        && limit < f64::MAX
    {
        let apart = along(direction.normalize_or_zero()).gap > limit;
        return if apart { None } else { gap_within(a, b, b_in_a, f64::MAX) };
    }
    let mut best = measured(&start, DVec3::ZERO).unwrap_or_else(|| best_guess(a, b, b_in_a, &along));
    // Where cores hardly touch EPA may take some way out for the shortest; from there the rounds below do not come back.
    if best.gap < -1e-3 * size {
        let guess = best_guess(a, b, b_in_a, &along);
        best = if guess.gap > best.gap { guess } else { best };
    }
    // No direction has a gap wider than the distance of two points.
    if best.gap >= 1e-3 * size && best.on_a.distance(best.on_b) - best.gap <= 1e-10 * size {
        return Some(best);
    }
    for _ in 0..ROUNDS {
        let shift = best.normal * (APART * size - best.gap.min(0.0));
        let shifted = pose(shift);
        simplex.reset(gjk::CsoPoint::from_shapes(&shifted, &scaled_a, &scaled_b, best.normal));
        let found = gjk::closest_points(&shifted, &scaled_a, &scaled_b, f64::MAX, true, &mut simplex);
        let Some(next) = measured(&found, shift) else { break };
        let gain = next.gap - best.gap;
        if gain >= 0.0 {
            best = next;
        }
        if gain <= 1e-14 * size {
            break;
        }
    }
    Some(if a.is_curved() || b.is_curved() { uphill(best, size, &along) } else { best })
}

/// The gap along `normal` (in a's frame).
pub(super) fn along(a: &Core, b: &Core, b_in_a: &Pose, normal: DVec3) -> Axis {
    let on_a = a.support(normal);
    let on_b = b_in_a.transform_point(b.support(b_in_a.rotation.conjugate() * -normal));
    Axis { normal, gap: (on_b - on_a).dot(normal), on_a, on_b }
}

/// Turns the axis uphill as long as the gap widens. GJK's simplex degenerates on curved cores and stalls some 10⁻⁴ rad
/// short. Where both sides are round the gap is smooth, and its gradient is the part of `on_b − on_a` across the normal; where a
/// rim or an end takes part it may have a crest, on which this stalls: see [`on_crest`].
fn uphill(start: Axis, size: f64, along: &dyn Fn(DVec3) -> Axis) -> Axis {
    const STEPS: usize = 24;
    let across = |axis: &Axis| (axis.on_b - axis.on_a) - axis.normal * axis.gap;
    let mut best = along(start.normal);
    let mut radius = size;
    for _ in 0..STEPS {
        let slope = across(&best);
        if slope.length() <= 1e-10 * size {
            break;
        }
        let next = along((best.normal + slope / radius).normalize_or(best.normal));
        if next.gap > best.gap {
            best = next;
            radius *= 0.7;
        } else {
            radius *= 2.5;
        }
    }
    // Where nothing was gained the points of GJK are the better ones: these here are corners of their sides.
    if best.gap > start.gap { best } else { start }
}

/// The best of some likely directions, for when parry finds none.
fn best_guess(a: &Core, b: &Core, b_in_a: &Pose, along: &dyn Fn(DVec3) -> Axis) -> Axis {
    let apart = (b_in_a.transform_point(b.middle()) - a.middle()).normalize_or(DVec3::Y);
    let of_b = b.flat_directions().into_iter().map(|direction| b_in_a.rotation * -direction);
    let flat = a.flat_directions().into_iter().chain(of_b).filter(|&direction| direction != DVec3::ZERO);
    flat.map(along).fold(along(apart), |best, next| if next.gap > best.gap { next } else { best })
}
