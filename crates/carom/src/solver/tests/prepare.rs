//! What a manifold becomes as a lane.

use super::*;

/// A sweep over denormal numbers takes about ten times as long: over a still pyramid it did.
#[test]
fn boxes_that_are_askew_by_rounding_have_no_denormal_numbers() {
    let askew = DQuat::from_xyzw(1e-40, -2e-41, 3e-40, 1.0);
    let movers = [-0.5, 0.5].map(|y| Mover::new(DVec3::Y * y, 1.0, (DVec3::new(0.1, 0.2, 0.3), askew)));
    let points = [at(DVec3::new(0.5, 0.0, 0.5), 0.0), at(DVec3::new(-0.5, 0.0, 0.5), 0.0)];
    let surface = Surface { restitution: 0.0, static_friction: 0.5, dynamic_friction: 0.5 };
    let terms = Terms { surface, margin: MARGIN, horizon: 1.0, is_pressed: false };
    let sides = [side(&movers[0]), side(&movers[1])];
    let lane = lane(DVec3::Y, &points, &sides, &terms);
    let denormal: Vec<usize> = (0..lane.len()).filter(|&line| lane[line].is_subnormal()).collect();
    assert!(denormal.is_empty(), "lines {denormal:?}");
}
