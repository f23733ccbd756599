//! What stands by friction and by where its weight is.

use super::*;

/// Half the thickness and half the length of a plank, m.
const PLANK: [f64; 2] = [0.02, 1.0];
const FRICTION: f64 = 0.5;

/// The least angle from the floor, in radians, at which a plank that leans on a wall stands.
///
/// At the limit floor and wall give all they can: with N on the floor, friction μN towards the wall, which answers with R = μN
/// and μR upwards, so that N·(1 + μ²) = W. About the lower end, with the length L between the two contacts and the weight half a
/// thickness c behind that line, W·(½L·cos α − c·sin α) = R·L·(sin α + μ·cos α).
fn least_angle() -> f64 {
    let [c, length] = [PLANK[0], 2.0 * PLANK[1]];
    let mu = FRICTION;
    (length * (1.0 - mu * mu) / (2.0 * (mu * length + c * (1.0 + mu * mu)))).atan()
}

/// How far a plank that leans on a wall at that angle is from where it started, after five seconds, m.
fn leaning_plank(angle: f64) -> f64 {
    let [thin, long] = PLANK;
    let tilt = Tilt::of(std::f64::consts::FRAC_PI_2 - angle);
    let low = tilt.exact * DVec3::new(thin, -long, 0.0);
    let right = tilt.exact * DVec3::new(thin, long, 0.0);
    let start = DVec3::new(-right.x, -low.y, 0.0);
    let mut world = World::new();
    world.add(slab(FRICTION));
    world.add(Body::fixed().at(1.0, 5.0, 0.0).with(Shape::cuboid(2.0, 10.0, 10.0)).friction(FRICTION));
    let plank = Body::dynamic().with(Shape::cuboid(2.0 * thin, 2.0 * long, 0.8)).friction(FRICTION);
    let id = world.add(plank.at(start.x, start.y, start.z).rotated(tilt.rotation));
    run(&mut world, 5.0);
    (world[id].position() - start).length()
}

#[test]
fn a_plank_on_a_wall_stands_just_above_the_least_angle() {
    let creep = leaning_plank(least_angle() + 1.0_f64.to_radians());
    judge("creep in 5 s, m", creep, 0.0, 1e-3);
}

#[test]
fn a_plank_on_a_wall_slides_just_below_the_least_angle() {
    let way = leaning_plank(least_angle() - 1.0_f64.to_radians());
    assert!(way > 0.3, "it has moved by {way} m only");
}

/// A tall box, twice as high as wide, on a slope: how far it has tilted against the slope after five seconds, rad.
fn tilt_on_slope(angle: f64) -> f64 {
    let tilt = Tilt::of(angle);
    let mut world = World::new();
    world.add(slab(1.0).rotated(tilt.rotation));
    let tower = Body::dynamic().with(Shape::cuboid(0.5, 1.0, 0.5)).friction(1.0);
    let id = world.add(tilt.lay(tower, 0.5));
    run(&mut world, 5.0);
    (world[id].rotation() * Vec3::Y).angle_between(tilt.rotation * Vec3::Y).into()
}

#[test]
fn a_tall_box_on_a_slope_stands_while_its_weight_is_above_its_base() {
    judge("tilt after 5 s, rad", tilt_on_slope(0.5_f64.atan() - 0.5_f64.to_radians()), 0.0, 1e-3);
}

#[test]
fn a_tall_box_on_a_slope_tips_when_its_weight_is_beyond_its_base() {
    let tilt = tilt_on_slope(0.5_f64.atan() + 0.5_f64.to_radians());
    assert!(tilt > 0.5, "{tilt} rad");
}

#[test]
fn a_box_over_an_edge_falls_only_with_its_centre_beyond_it() {
    for offset in [-0.01, 0.01] {
        let mut world = World::new();
        let table = Collider::new(Shape::cuboid(10.0, 2.0, 10.0)).at(-5.0, -1.0, 0.0);
        world.add(Body::fixed().collider(table).friction(0.8));
        let id = world.add(cube().at(offset, 0.5, 0.0).friction(0.8));
        run(&mut world, 5.0);
        let place = world[id].position();
        if offset < 0.0 {
            judge("way in 5 s, m", (place - DVec3::new(offset, 0.5, 0.0)).length(), 0.0, 1e-3);
        } else {
            assert!(place.y < 0.0, "{place}");
        }
    }
}

#[test]
#[ignore = "a box that tips over an edge sinks 1 mm into it"]
fn a_box_that_tips_over_an_edge_keeps_its_energy() {
    let mut world = World::new();
    let table = Collider::new(Shape::cuboid(10.0, 2.0, 10.0)).at(-5.0, -1.0, 0.0);
    world.add(Body::fixed().collider(table).friction(2.0));
    let id = world.add(cube().at(0.05, 0.5, 0.0).friction(2.0));
    let start = world.energy().potential;
    let tilt = |world: &World| (world[id].rotation() * Vec3::Y).angle_between(Vec3::Y).to_degrees();
    while tilt(&world) < 28.0 {
        world.step(STEP);
        let edge = world[id].position() + world[id].rotation().as_dquat() * DVec3::new(-0.05, -0.5, 0.0);
        assert!(edge.length() < 1e-3, "{edge} at {} s", world.time());
    }
    judge_share("kinetic energy, J", world.energy().kinetic, start - world.energy().potential, 0.01);
}

#[test]
fn two_balls_carry_a_third_by_friction_alone() {
    // At each of the contacts the force is 15° off the normal: tan 15° = 0.268.
    let radius = 0.5;
    for (friction, stands) in [(0.3, true), (0.25, false)] {
        let mut world = World::new();
        world.add(slab(friction));
        let top = radius + 3.0_f64.sqrt() * radius;
        let places = [[-radius, radius], [radius, radius], [0.0, top]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let balls = places.map(|place| {
            let ball = Body::dynamic().with(Shape::sphere(radius)).friction(friction);
            world.add(ball.at(place.x, place.y, place.z))
        });
        run(&mut world, 3.0);
        let moved = balls.iter().zip(&places).map(|(&id, &place)| (world[id].position() - place).length());
        let most = moved.fold(0.0, f64::max);
        if stands {
            judge("largest way in 3 s, m", most, 0.0, 1e-3);
        } else {
            assert!(world[balls[2]].position().y < radius + 0.1, "{}", world[balls[2]].position());
        }
    }
}
