//! What pushes within cones of friction can explain.

use carom::math::DVec3;

/// A cone of impulses: its axis, and the tangent of its half angle.
pub(super) type Cone = (DVec3, f64);

/// So often each cone may take something, and what share of an impulse may then be left over.
const PASSES: usize = 400;
pub(super) const SHARED_OUT: f64 = 1e-3;

/// What of an impulse neither the `advance`, up to once and either way, nor pushes within the cones explain, N·s: each in turn takes
/// what it can of what is left.
pub(super) fn unexplained(impulse: DVec3, cones: &[Cone], advance: DVec3, enough: f64) -> f64 {
    let mut parts = vec![DVec3::ZERO; cones.len()];
    let mut share = 0.0;
    let mut left = impulse;
    for _ in 0..PASSES {
        if advance != DVec3::ZERO {
            let taken = (share + left.dot(advance) / advance.length_squared()).clamp(-1.0, 1.0);
            left += (share - taken) * advance;
            share = taken;
        }
        for (part, cone) in parts.iter_mut().zip(cones) {
            let taken = nearest_in(*cone, *part + left);
            left += *part - taken;
            *part = taken;
        }
        if left.length() <= 0.5 * enough {
            break;
        }
    }
    left.length()
}

/// The point of a cone that is nearest to `point`.
fn nearest_in((axis, slope): Cone, point: DVec3) -> DVec3 {
    let along = point.dot(axis);
    let across = point - along * axis;
    let distance = across.length();
    if along > 0.0 && distance <= slope * along {
        return point;
    }
    if along <= -slope * distance {
        return DVec3::ZERO;
    }
    let height = (along + slope * distance) / (1.0 + slope * slope);
    height * (axis + (slope / distance) * across)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_push_within_a_cone_is_explained_and_a_pull_is_not() {
        let floor = [(DVec3::Y, 0.5)];
        let left = |x: f64, y: f64| unexplained(DVec3::new(x, y, 0.0), &floor, DVec3::ZERO, 0.0);
        assert_eq!(left(0.4, 1.0), 0.0);
        assert_eq!(left(0.0, -2.0), 2.0);
        // Beyond the cone by as much as the way back onto it is long.
        assert!((left(1.0, 1.0) - 0.5 / 1.25_f64.sqrt()).abs() < 1e-12);
        assert_eq!(unexplained(DVec3::Y, &[], DVec3::ZERO, 0.0), 1.0);
    }

    #[test]
    fn cones_share_out_what_none_explains_alone() {
        let corner = [(DVec3::X, 0.0), (DVec3::Y, 0.0)];
        assert!(unexplained(DVec3::new(2.0, 3.0, 0.0), &corner, DVec3::ZERO, 0.0) < 1e-12);
        let oblique = [(DVec3::X, 0.1), (DVec3::new(0.6, 0.8, 0.0), 0.1)];
        assert!(unexplained(DVec3::new(2.0, 1.0, 0.0), &oblique, DVec3::ZERO, 0.0) < 1e-9);
        // And an advance that may have been taken, once either way.
        let left = unexplained(DVec3::new(2.0, -1.0, 0.0), &corner, DVec3::Y * 0.6, 0.0);
        assert!((left - 0.4).abs() < 1e-12, "{left}");
    }

    #[test]
    fn what_the_advance_explains_alone_is_not_shared_out_among_cones() {
        // A ball in a bowl, struck at the end of a substep: 400 passes once left 8e-4 of this.
        let bowl = [
            (DVec3::new(-0.52, 0.81, 0.27).normalize(), 0.67),
            (DVec3::new(-0.7, 0.64, 0.32).normalize(), 0.67),
        ];
        let left = unexplained(DVec3::Y * 0.033, &bowl, DVec3::Y * -0.0535, 0.0);
        assert!(left < 1e-15, "{left}");
    }
}
