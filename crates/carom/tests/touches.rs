//! Touches that last although nothing bounces.

use carom::math::{DVec3, rotation_from_vector};
use carom::prelude::*;

/// A corner that slides along a wall while its box turns closes again a moment after each touch, at the speed of rounding: gravity
/// does not press it there, so that the rest threshold was none, and it was struck up to 32 times a step.
#[test]
fn what_stays_in_touch_without_a_bounce_is_not_struck_again_and_again() {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::plane()));
    for (x, z) in [(-2.5, 0.0), (2.5, 0.0), (0.0, -2.5), (0.0, 2.5)] {
        let size = if x == 0.0 { (4.0, 1.0) } else { (1.0, 6.0) };
        world.add(Body::fixed().at(x, 5.0, z).with(Shape::cuboid(size.0, 10.0, size.1)));
    }
    for number in 0..60 {
        let (layer, place) = (number / 9, number % 9);
        let turn = rotation_from_vector(DVec3::new(0.7, 1.1, 0.4) * f64::from(number)).as_quat();
        let at =
            [f64::from(place % 3 - 1) * 1.3, 1.0 + 1.3 * f64::from(layer), f64::from(place / 3 - 1) * 1.3];
        let body = Body::dynamic().at(at[0], at[1], at[2]).rotated(turn);
        world.add(body.with(Shape::cuboid(0.7, 0.8, 0.9)).friction(0.5).restitution(0.0));
    }
    let (mut struck, mut slow) = (0, 0);
    for _ in 0..150 {
        for impact in world.step(1.0 / 60.0).impacts() {
            struck += 1;
            slow += u32::from(impact.resolve().closing_speed.abs() < 1e-6);
        }
    }
    assert!(20 * slow < struck, "{slow} of {struck} impacts at the speed of rounding");
}
