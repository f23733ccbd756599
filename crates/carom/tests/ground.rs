//! Bodies on a height field in a world: as on a plane, where it is flat.

use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;

fn flat() -> Shape {
    Shape::height_field(&vec![vec![0.0; 21]; 41], [20.0, 20.0]).unwrap()
}

#[test]
fn a_ball_rolls_over_a_flat_height_field_as_over_a_plane() {
    let roll = |ground: Shape| {
        let mut world = World::new();
        world.add(Body::fixed().with(ground));
        let ball = Body::dynamic().at(-6.0, 0.5, -3.3).with(Shape::sphere(0.5)).moving(4.0, 0.0, 2.0);
        let ball = world.add(ball);
        for _ in 0..120 {
            world.step(STEP);
        }
        (world[ball].position(), world[ball].linear_velocity())
    };
    let ((place, velocity), (expected, speed)) = (roll(flat()), roll(Shape::plane()));
    assert!(place.distance(expected) < 1e-5, "{place} {expected}");
    assert!(velocity.distance(speed) < 1e-5, "{velocity} {speed}");
    assert!(place.x - -6.0 > 5.0 && velocity.y.abs() < 1e-6);
}

#[test]
fn a_ball_bounces_off_a_slope_by_the_mirror_law() {
    // 45° up along x, over cells of half a metre.
    let slope: Vec<Vec<f64>> =
        (0..41).map(|_| (0..41).map(|i| 0.5 * f64::from(i) - 10.0).collect()).collect();
    let mut world = World::with_settings(carom::Settings { gravity: DVec3::ZERO, ..Default::default() });
    let ground = Body::fixed().with(Shape::height_field(&slope, [20.0, 20.0]).unwrap());
    world.add(ground.restitution(1.0).friction(0.0));
    let ball = Body::dynamic().at(0.21, 3.0, 0.13).with(Shape::sphere(0.5)).moving(0.0, -4.0, 0.0);
    let ball = world.add(ball.restitution(1.0).friction(0.0));
    for _ in 0..60 {
        world.step(STEP);
    }
    let velocity = world[ball].linear_velocity();
    assert!(velocity.distance(Vec3::new(-4.0, 0.0, 0.0)) < 1e-5, "{velocity}");
}

#[test]
fn only_fixed_bodies_have_height_fields() {
    for body in [Body::dynamic().mass(1.0), Body::kinematic()] {
        let error = World::new().try_add(body.with(flat())).unwrap_err();
        assert_eq!((error.field.as_str(), error.value.as_str()), ("colliders[0].shape", "height field"));
        assert!(error.expected.contains("static"), "{error}");
    }
}
