//! Impacts against closed forms: what bounces, how high, and what it keeps.

use carom::math::{DVec3, rotation_from_vector};
use carom::prelude::*;

fn floor() -> Body {
    Body::fixed().named("floor").with(Shape::plane())
}

#[test]
fn a_ball_with_full_restitution_returns_to_two_metres_after_a_hundred_bounces() {
    for (name, ground) in
        [("plane", floor()), ("box", Body::fixed().at(0.0, -0.5, 0.0).with(Shape::cuboid(20.0, 1.0, 20.0)))]
    {
        let mut world = World::new();
        world.add(ground.friction(0.0));
        let ball = world
            .add(Body::dynamic().at(0.3, 2.5, 0.2).with(Shape::sphere(0.5)).restitution(1.0).friction(0.0));
        let (mut bounces, mut apex, mut apexes) = (0, 0.0_f64, Vec::new());
        while bounces < 101 {
            let hits = world.step(1.0 / 60.0).impacts().len();
            if hits > 0 {
                apexes.push(apex);
                (bounces, apex) = (bounces + hits, 0.0);
            }
            let state = &world[ball];
            let speed = f64::from(state.linear_velocity().y);
            apex = apex.max(state.position().y - 0.5 + speed * speed / (2.0 * 9.81));
        }
        for apex in &apexes {
            assert!((apex - 2.0).abs() < 1e-3, "{name}: {apex}");
        }
    }
}

#[test]
fn a_box_that_tumbles_over_a_plane_keeps_its_energy() {
    let mut world = World::new();
    world.add(floor().friction(0.0));
    let body = Body::dynamic()
        .at(0.0, 2.0, 0.0)
        .spinning(1.0, 2.0, 0.5)
        .rotated(Quat::from_xyzw(0.3, 0.1, 0.2, 0.8).normalize())
        .with(Shape::cuboid(1.0, 0.8, 0.6))
        .restitution(1.0)
        .friction(0.0);
    world.add(body);
    let start = world.energy();
    let start = start.kinetic + start.potential;
    let mut impacts = 0;
    while impacts < 100 {
        impacts += world.step(1.0 / 60.0).impacts().len();
        let now = world.energy();
        let change = (now.kinetic + now.potential) / start - 1.0;
        assert!(change.abs() < 1e-6, "{change} after {impacts} impacts at {} s", world.time());
        assert!(world.time() < 200.0, "only {impacts} impacts");
    }
}

#[test]
fn a_ball_comes_to_rest_when_its_geometric_series_ends() {
    for restitution in [0.8_f64, 0.5] {
        let mut world = World::new();
        world.add(floor());
        let ball =
            world.add(Body::dynamic().at(0.0, 2.5, 0.0).with(Shape::sphere(0.5)).restitution(restitution));
        let expected = (2.0 * 2.0 / 9.81_f64).sqrt() * (1.0 + restitution) / (1.0 - restitution);
        let mut last = 0.0;
        for _ in 0..600 {
            if let Some(hit) = world.step(1.0 / 60.0).impacts().last() {
                last = hit.time;
            }
        }
        assert!((last / expected - 1.0).abs() < 0.01, "{last} instead of {expected}");
        let state = &world[ball];
        assert!((state.position().y - 0.5).abs() < 1e-4, "{}", state.position().y);
        assert!(state.linear_velocity().length() < 1e-6, "{}", state.linear_velocity());
        assert_eq!(world.step(1.0 / 60.0).contacts(), 1);
    }
}

#[test]
fn a_cube_set_down_stays_where_it_is() {
    for restitution in [0.0, 0.5, 1.0] {
        let mut world = World::new();
        world.add(floor());
        let cube = world.add(
            Body::dynamic().at(0.0, 0.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(restitution),
        );
        for _ in 0..300 {
            let collisions = world.step(1.0 / 60.0).impacts().len();
            assert_eq!(collisions, 0, "at {} s", world.time());
        }
        assert!((world[cube].position() - DVec3::new(0.0, 0.5, 0.0)).length() < 1e-4);
    }
}

#[test]
fn a_box_on_its_corner_falls_and_comes_to_rest_on_a_face() {
    let mut world = World::new();
    world.add(floor());
    let tilt = rotation_from_vector(DVec3::new(0.6, 0.2, 0.7)).as_quat();
    let cube = world.add(
        Body::dynamic().at(0.0, 2.0, 0.0).rotated(tilt).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(0.4),
    );
    for _ in 0..600 {
        world.step(1.0 / 60.0);
    }
    let state = &world[cube];
    assert!((state.position().y - 0.5).abs() < 1e-3, "{}", state.position().y);
    assert!(state.linear_velocity().length() < 1e-4 && state.angular_velocity().length() < 1e-4, "{state:?}");
}

#[test]
fn sliding_and_rolling_follow_coulomb() {
    // A box on a plane stops after v²/2μg; a ball on a slope accelerates with 5/7 g sin θ.
    let mut world = World::new();
    world.add(floor().friction(0.4));
    let sled = world.add(
        Body::dynamic()
            .at(0.0, 0.25, 0.0)
            .moving(4.0, 0.0, 0.0)
            .with(Shape::cuboid(1.0, 0.5, 1.0))
            .friction(0.4),
    );
    for _ in 0..180 {
        world.step(1.0 / 60.0);
    }
    let expected = 16.0 / (2.0 * 0.4 * 9.81);
    assert!(
        (world[sled].position().x / expected - 1.0).abs() < 1e-3,
        "{} {expected}",
        world[sled].position().x
    );

    let angle = 0.3_f64;
    let mut world = World::new();
    let tilt = rotation_from_vector(DVec3::new(0.0, 0.0, -angle));
    world.add(floor().rotated(tilt.as_quat()).friction(0.6));
    let start = tilt * DVec3::new(0.0, 0.5, 0.0);
    let ball =
        world.add(Body::dynamic().at(start.x, start.y, start.z).with(Shape::sphere(0.5)).friction(0.6));
    for _ in 0..120 {
        world.step(1.0 / 60.0);
    }
    let rolled = (world[ball].position() - start).dot(tilt * DVec3::X);
    let expected = 0.5 * 5.0 / 7.0 * 9.81 * angle.sin() * 4.0;
    assert!((rolled / expected - 1.0).abs() < 1e-3, "{rolled} {expected}");
}
