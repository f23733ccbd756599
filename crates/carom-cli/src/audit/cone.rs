//! What pushes within cones of friction can explain.

use carom::math::DVec3;

/// A cone of impulses: its axis, and the tangent of its half angle.
pub(super) type Cone = (DVec3, f64);

/// So often each cone may take something, and what share of an impulse may then be left over.
const PASSES: usize = 20;
pub(super) const SHARED_OUT: f64 = 1e-3;

/// So many rays are tried where that is not enough, and shares of the advance.
const RAYS: usize = 60;
const SHARES: usize = 40;

/// What of an impulse neither the `advance`, up to once and either way, nor pushes within the cones explain, N·s.
///
/// Mostly it is enough that each in turn takes what it can of what is left. Cones that nearly face each other would go on like that for
/// ever: then it is [`beyond`] that tells.
pub(super) fn unexplained(impulse: DVec3, cones: &[Cone], advance: DVec3, enough: f64) -> f64 {
    let left = not_taken(impulse, cones, advance, enough);
    if left <= 0.5 * enough {
        return left;
    }
    let after = |share: f64| beyond(impulse - share * advance, cones);
    if advance == DVec3::ZERO {
        return left.min(after(0.0));
    }
    // A distance from something convex has one valley.
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..SHARES {
        let (one, other) = (low + 0.4 * (high - low), high - 0.4 * (high - low));
        if after(one) < after(other) { high = other } else { low = one }
    }
    left.min(after(0.5 * (low + high)))
}

/// How far an impulse is from all that pushes within the cones add up to, N·s.
///
/// What is nearest lies between three rays at most. To those of the best point so far comes the ray that explains most of what is left,
/// until none explains any of it (Wolfe, *Finding the nearest point in a polytope*, 1976, for cones).
fn beyond(impulse: DVec3, cones: &[Cone]) -> f64 {
    let mut rays: Vec<DVec3> = Vec::new();
    let mut left = impulse;
    for _ in 0..RAYS {
        let towards = cones.iter().map(|&cone| ray_towards(cone, left));
        let Some(ray) = towards.max_by(|a, b| a.dot(left).total_cmp(&b.dot(left))) else { break };
        if ray.dot(left) <= 1e-12 * impulse.length() {
            break;
        }
        rays.push(ray);
        (rays, left) = nearest_between(&rays, impulse, left);
    }
    left.length()
}

/// The ray of a cone, of unit length, that leads farthest along `direction`.
fn ray_towards((axis, slope): Cone, direction: DVec3) -> DVec3 {
    let along = direction.dot(axis);
    let across = direction - along * axis;
    if along > 0.0 && across.length() <= slope * along {
        return direction.normalize();
    }
    (axis + slope * across.normalize_or_zero()).normalize()
}

/// Those of a few rays between which the nearest point to `impulse` lies, and what is left of it there; `left` if nothing is nearer than
/// that.
fn nearest_between(rays: &[DVec3], impulse: DVec3, left: DVec3) -> (Vec<DVec3>, DVec3) {
    let mut best = (rays.to_vec(), left);
    for chosen in 1_u32..1 << rays.len() {
        let some: Vec<DVec3> = (0..rays.len()).filter(|k| chosen >> k & 1 == 1).map(|k| rays[k]).collect();
        let Some(point) = within(&some, impulse) else { continue };
        if (impulse - point).length() < best.1.length() {
            best = (some, impulse - point);
        }
    }
    best
}

/// The nearest point to `impulse` on the span of up to three rays, if all of them push there.
fn within(rays: &[DVec3], impulse: DVec3) -> Option<DVec3> {
    match *rays {
        [one] => (impulse.dot(one) > 0.0).then(|| impulse.dot(one) * one),
        [one, two] => {
            let (cosine, a, b) = (one.dot(two), impulse.dot(one), impulse.dot(two));
            let [x, y] = [a - cosine * b, b - cosine * a].map(|share| share / (1.0 - cosine * cosine));
            (x > 0.0 && y > 0.0 && x.is_finite() && y.is_finite()).then(|| x * one + y * two)
        }
        [one, two, three] => {
            let volume = one.dot(two.cross(three));
            let shares = [two.cross(three), three.cross(one), one.cross(two)];
            let shares = shares.map(|normal| normal.dot(impulse) / volume);
            shares.iter().all(|share| *share > 0.0 && share.is_finite()).then_some(impulse)
        }
        _ => None,
    }
}

/// What is left of an impulse after each in turn has taken what it can.
fn not_taken(impulse: DVec3, cones: &[Cone], advance: DVec3, enough: f64) -> f64 {
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

    /// Four hundred passes left nine tenths of the first.
    #[test]
    fn cones_that_nearly_face_each_other_explain_what_lies_between_them() {
        let facing = [(DVec3::X, 0.0), (DVec3::new(-1.0, 0.01, 0.0).normalize(), 0.0)];
        assert!(unexplained(DVec3::Y, &facing, DVec3::ZERO, 0.0) < 1e-9);
        assert!((unexplained(-DVec3::Y, &facing, DVec3::ZERO, 0.0) - 1.0).abs() < 1e-12);
        let wedge = [(DVec3::X, 0.5), (DVec3::new(-1.0, 0.1, 0.2).normalize(), 0.3)];
        assert!(unexplained(DVec3::new(0.1, 0.7, 0.3), &wedge, DVec3::ZERO, 0.0) < 1e-9);
        // With an advance that takes the part that no cone does.
        let left = unexplained(DVec3::new(0.0, 1.0, 0.4), &facing, DVec3::Z * 0.3, 0.0);
        assert!((left - 0.1).abs() < 1e-9, "{left}");
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
