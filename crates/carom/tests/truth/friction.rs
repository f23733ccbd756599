//! Coulomb's law: what slides, rolls and holds.

use super::*;
use carom::Surface;

/// A flat box, 1 m square and 0.2 m high.
fn sled(friction: f64) -> Body {
    Body::dynamic().with(Shape::cuboid(1.0, 0.2, 1.0)).friction(friction)
}

/// A slope at that angle with a flat box on it.
fn sled_on_slope(angle: f64, material: Material) -> (World, BodyId, Tilt) {
    let tilt = Tilt::of(angle);
    let mut world = World::new();
    let coat = |mut body: Body| {
        body.colliders.iter_mut().for_each(|collider| collider.material = material);
        body
    };
    world.add(coat(slab(0.0)).rotated(tilt.rotation));
    let id = world.add(coat(tilt.lay(sled(0.0), 0.1)));
    (world, id, tilt)
}

fn coated(friction: f64) -> Material {
    Material { static_friction: friction, dynamic_friction: friction, ..Material::default() }
}

fn speed_along(world: &World, id: BodyId, direction: DVec3) -> f64 {
    world[id].linear_velocity().as_dvec3().dot(direction)
}

#[test]
fn a_box_slides_to_rest_after_v_squared_over_two_mu_g() {
    // Also off the axes: friction opposes the velocity, whatever its direction.
    for (friction, speed, degrees) in [(0.5, 5.0, 0.0_f64), (0.2, 3.0, 0.0), (0.5, 5.0, 30.0)] {
        let mut world = World::new();
        world.add(slab(friction));
        let (sin, cos) = degrees.to_radians().sin_cos();
        let body = sled(friction).at(0.0, 0.1, 0.0).moving((speed * cos) as f32, 0.0, (speed * sin) as f32);
        let id = world.add(body);
        run(&mut world, speed / (friction * G) + 1.0);
        let place = world[id].position();
        let case = format!("μ {friction}, {speed} m/s, {degrees}°");
        let truth = speed * speed / (2.0 * friction * G);
        judge_share(&format!("{case}: way, m"), place.x.hypot(place.z), truth, 1e-3);
        judge(&format!("{case}: direction, rad"), place.z.atan2(place.x), degrees.to_radians(), 1e-4);
        judge("speed at the end, m/s", f64::from(world[id].linear_velocity().length()), 0.0, 1e-5);
    }
}

#[test]
fn a_ball_rolls_down_with_five_sevenths_of_what_it_would_slide_with() {
    let angle = 20.0_f64.to_radians();
    let tilt = Tilt::of(angle);
    let mut world = World::new();
    world.add(slab(1.0).rotated(tilt.rotation));
    let ball = tilt.lay(Body::dynamic().with(Shape::sphere(0.5)).friction(1.0), 0.5);
    let id = world.add(ball);
    run(&mut world, 2.0);
    let acceleration = 5.0 / 7.0 * G * angle.sin();
    let way = (world[id].position() - tilt.above(0.5)).dot(tilt.downhill());
    judge_share("way in 2 s, m", way, 2.0 * acceleration, 1e-3);
    let speed = speed_along(&world, id, tilt.downhill());
    judge_share("speed after 2 s, m/s", speed, 2.0 * acceleration, 1e-3);
    let rim = 0.5 * f64::from(world[id].angular_velocity().length());
    judge_share("speed of the rim, m/s", rim, speed, 1e-3);
}

#[test]
fn a_ball_thrown_flat_begins_to_roll_at_five_sevenths_of_its_speed() {
    // Also with back spin, so much that it comes back: v = 5/7 v₀ − 2/7 r·ω₀.
    for backspin in [0.0_f64, 10.0, 40.0] {
        let (friction, speed, radius) = (0.3, 5.0, 0.5);
        let mut world = World::new();
        world.add(slab(friction));
        let ball = Body::dynamic().with(Shape::sphere(radius)).friction(friction).at(0.0, radius, 0.0);
        let id = world.add(ball.moving(speed as f32, 0.0, 0.0).spinning(0.0, 0.0, backspin as f32));
        let rolling = 5.0 / 7.0 * speed - 2.0 / 7.0 * radius * backspin;
        let until = 2.0 / 7.0 * (speed + radius * backspin) / (friction * G);
        let seconds = (until + 3.0).round();
        run(&mut world, seconds);
        let way = speed * until - 0.5 * friction * G * until * until + rolling * (seconds - until);
        judge("speed, m/s", speed_along(&world, id, DVec3::X), rolling, 1e-3 * speed);
        judge("way, m", world[id].position().x, way, 1e-3 * speed * seconds);
    }
}

#[test]
fn a_slope_below_the_angle_of_friction_holds() {
    // tan 20° = 0.364.
    for friction in [0.5, 0.38] {
        let (mut world, id, tilt) = sled_on_slope(20.0_f64.to_radians(), coated(friction));
        run(&mut world, 10.0);
        let creep = (world[id].position() - tilt.above(0.1)).length();
        judge(&format!("μ {friction}: creep in 10 s, m"), creep, 0.0, 1e-4);
    }
}

/// A flat box that slides down a slope of 20°, for each of two coefficients of friction: that coefficient, how it should
/// accelerate, its speed after half a second, and its way and speed after two seconds.
fn slides() -> [(f64, f64, f64, [f64; 2]); 2] {
    let angle = 20.0_f64.to_radians();
    [0.2, 0.35].map(|friction| {
        let (mut world, id, tilt) = sled_on_slope(angle, coated(friction));
        run(&mut world, 0.5);
        let early = speed_along(&world, id, tilt.downhill());
        run(&mut world, 1.5);
        let way = (world[id].position() - tilt.above(0.1)).dot(tilt.downhill());
        let late = speed_along(&world, id, tilt.downhill());
        (friction, G * (angle.sin() - friction * angle.cos()), early, [way, late])
    })
}

#[test]
fn a_slope_above_the_angle_of_friction_lets_slide_with_the_right_acceleration() {
    for (friction, acceleration, early, [_, late]) in slides() {
        judge_share(&format!("μ {friction}: acceleration, m/s²"), (late - early) / 1.5, acceleration, 1e-3);
    }
}

#[test]
fn what_begins_to_slide_has_the_right_way_from_the_start() {
    for (friction, acceleration, _, [way, late]) in slides() {
        judge_share(&format!("μ {friction}: way in 2 s, m"), way, 2.0 * acceleration, 1e-3);
        judge_share(&format!("μ {friction}: speed after 2 s, m/s"), late, 2.0 * acceleration, 1e-3);
    }
}

/// Sticks up to a slope of 38.7°, slides from 21.8° on once it moves.
fn sticky() -> Material {
    Material { static_friction: 0.8, dynamic_friction: 0.4, ..Material::default() }
}

#[test]
fn static_friction_holds_what_dynamic_friction_would_not() {
    assert_eq!(Surface::between(&sticky(), &sticky()).static_friction, 0.8);
    let angle = 0.8_f64.atan() - 1.0_f64.to_radians();
    let (mut world, id, tilt) = sled_on_slope(angle, sticky());
    run(&mut world, 10.0);
    judge("creep in 10 s, m", (world[id].position() - tilt.above(0.1)).length(), 0.0, 1e-4);
}

#[test]
#[ignore = "it holds for a substep while friction is sought, and is 2.3 cm behind after 2 s: 0.35 % of the way, where 0.1 % is the goal"]
fn beyond_static_friction_a_box_slides_with_dynamic_friction() {
    let angle = 0.8_f64.atan() + 1.0_f64.to_radians();
    let (mut world, id, tilt) = sled_on_slope(angle, sticky());
    run(&mut world, 2.0);
    let acceleration = G * (angle.sin() - 0.4 * angle.cos());
    let way = (world[id].position() - tilt.above(0.1)).dot(tilt.downhill());
    judge_share("way in 2 s, m", way, 2.0 * acceleration, 1e-3);
}

#[test]
fn what_moves_is_slowed_by_dynamic_friction_only() {
    // On this slope the box would stay if it lay still.
    let angle = 0.6_f64.atan();
    let (mut world, id, tilt) = sled_on_slope(angle, sticky());
    world.body_mut(id).unwrap().set_linear_velocity(tilt.downhill()).unwrap();
    run(&mut world, 2.0);
    let way = (world[id].position() - tilt.above(0.1)).dot(tilt.downhill());
    let acceleration = G * (angle.sin() - 0.4 * angle.cos());
    judge_share("way in 2 s, m", way, 2.0 + 2.0 * acceleration, 1e-3);
}

#[test]
fn a_superball_that_slides_loses_mu_times_what_it_bounces_with() {
    // Friction gives at most μ times the normal impulse: Δv_x = μ·(1 + C_r)·v_y, as long as the ball does not come to roll.
    let settings = carom::Settings { gravity: DVec3::ZERO, ..Default::default() };
    let mut world = World::with_settings(settings);
    world.add(slab(0.05).restitution(1.0));
    let ball = Body::dynamic().with(Shape::sphere(0.5)).friction(0.05).restitution(1.0);
    let id = world.add(ball.at(0.0, 1.734, 0.0).moving(4.0, -5.0, 0.0));
    run(&mut world, 0.6);
    let velocity = world[id].linear_velocity().as_dvec3();
    judge("v_x, m/s", velocity.x, 4.0 - 0.05 * 2.0 * 5.0, 1e-3);
    judge("v_y, m/s", velocity.y, 5.0, 1e-3);
    // I = 2/5 m r²: the spin is 5/2 of the change of speed over r.
    judge("spin, rad/s", f64::from(world[id].angular_velocity().z), -2.5 * 0.5 / 0.5, 1e-3);
}
