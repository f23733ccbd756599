//! Kinematic bodies that carry others: a turntable, a conveyor belt.

use super::*;

const FRICTION: f64 = 0.4;

/// A low box on a turning disc, 1 m from its axis, that needs `share` of the friction it has to go round. Returns how far it is
/// after five seconds from its place on the disc, m.
fn way_on_turntable(share: f64) -> f64 {
    let radius: f64 = 1.0;
    let spin = (share * FRICTION * G / radius).sqrt();
    let mut world = World::new();
    let disc = Collider::new(Shape::cylinder(0.2, 3.0)).at(0.0, -0.1, 0.0);
    let disc = world.add(Body::kinematic().collider(disc).friction(FRICTION).spinning(0.0, spin as f32, 0.0));
    let brick = Body::dynamic().with(Shape::cuboid(0.2, 0.1, 0.2)).friction(FRICTION).at(radius, 0.05, 0.0);
    let velocity = DVec3::new(0.0, spin, 0.0).cross(DVec3::new(radius, 0.0, 0.0)).as_vec3();
    let brick = brick.moving(velocity.x, velocity.y, velocity.z).spinning(0.0, spin as f32, 0.0);
    let id = world.add(brick);
    run(&mut world, 5.0);
    let place = world[disc].rotation().as_dquat().normalize() * DVec3::new(radius, 0.05, 0.0);
    (world[id].position() - place).length()
}

#[test]
#[ignore = "the box slips by 1.2 cm in 5 s at half of the limit, by 1.6 cm at 0.97 of it, where 1 mm is the goal"]
fn a_box_on_a_turntable_is_carried_while_friction_can_hold_it() {
    for share in [0.5, 0.97] {
        judge(&format!("{share} of the limit: way in 5 s, m"), way_on_turntable(share), 0.0, 1e-3);
    }
}

#[test]
fn a_box_on_a_turntable_slips_off_where_friction_can_not_hold_it() {
    let way = way_on_turntable(1.03);
    assert!(way > 0.5, "it has moved by {way} m only");
}

/// A belt along x: a slab that moves with that speed; it is so long that nothing runs off it.
fn belt(speed: f32) -> Body {
    let slab = Collider::new(Shape::cuboid(100.0, 0.2, 2.0)).at(0.0, -0.1, 0.0);
    Body::kinematic().collider(slab).friction(FRICTION).moving(speed, 0.0, 0.0)
}

#[test]
fn a_conveyor_brings_a_box_to_its_speed() {
    let (speed, seconds) = (2.0, 3.0);
    let mut world = World::new();
    world.add(belt(speed as f32));
    let id =
        world.add(Body::dynamic().with(Shape::cuboid(0.4, 0.1, 0.4)).friction(FRICTION).at(0.0, 0.05, 0.0));
    // It lags behind by v²/2μg while it gets up to speed, for v/μg.
    let until = speed / (FRICTION * G);
    let half = steps(0.5 * until) as f64 * STEP;
    run(&mut world, half);
    judge_share("speed on the way, m/s", world[id].linear_velocity().x.into(), FRICTION * G * half, 1e-3);
    run(&mut world, seconds - half);
    judge("speed of the box, m/s", world[id].linear_velocity().x.into(), speed, 1e-5);
    let way = speed * seconds - speed * speed / (2.0 * FRICTION * G);
    judge_share("way of the box, m", world[id].position().x, way, 1e-3);
}

#[test]
fn a_ball_that_lands_on_a_moving_belt_rolls_against_it() {
    // Friction acts at the belt's surface, about a point of which the angular momentum stays: v = 2/7 of the belt's.
    for restitution in [0.0, 0.5] {
        let (speed, radius) = (3.0_f64, 0.3);
        let mut world = World::new();
        world.add(belt(speed as f32));
        let ball = Body::dynamic().with(Shape::sphere(radius)).friction(FRICTION).restitution(restitution);
        let id = world.add(ball.at(0.0, radius + 0.5, 0.0));
        run(&mut world, 5.0);
        let state = &world[id];
        judge_share("speed, m/s", state.linear_velocity().x.into(), 2.0 / 7.0 * speed, 1e-3);
        let rim = f64::from(state.linear_velocity().x) + f64::from(state.angular_velocity().z) * radius;
        judge_share("speed of the lowest point, m/s", rim, speed, 1e-3);
        judge("height, m", state.position().y, radius, 1e-4);
    }
}
