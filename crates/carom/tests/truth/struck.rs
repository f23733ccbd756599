//! Bodies that rest on something when another one strikes them.

use super::*;
use carom::Combine;
use carom::report::Impact;

/// A ball that neither falls nor rubs, so that only what it strikes with counts.
fn striker(mass: f64, restitution: f64) -> Body {
    let mut collider = Collider::new(Shape::sphere(0.25));
    collider.material = Material {
        static_friction: 0.0,
        dynamic_friction: 0.0,
        restitution,
        friction_combine: Some(Combine::Minimum),
        ..Material::default()
    };
    let mut body = Body::dynamic().collider(collider).mass(mass);
    body.gravity_factor = 0.0;
    body
}

/// A ball strikes the top of a stack of five from the side, coming from that distance before the stack's axis.
///
/// The ball takes the top box along by m_b·(1 + C_r)/(m_b + m)·v; friction with the box below stops it, and all the rest stands. Returns how far the top box went and should go, m.
fn strike_the_top_of_a_stack(distance: f64) -> (f64, f64) {
    const FRICTION: f64 = 0.3;
    let mut world = World::new();
    world.add(slab(FRICTION));
    let boxes: Vec<BodyId> = (0..5)
        .map(|level| world.add(cube().at(0.0, 0.5 + f64::from(level), 0.0).friction(FRICTION)))
        .collect();
    let (mass, speed) = (250.0, 4.0);
    let ball = world.add(striker(mass, 0.5).at(-distance, 4.5, 0.0).moving(speed as f32, 0.0, 0.0));
    run(&mut world, 0.25);
    let before = world.momentum().linear.x;
    judge("momentum before, N·s", before, mass * speed, 1e-3);
    let mut struck = 0;
    for _ in 0..steps(0.3) {
        let hits = world.step(STEP).impacts().iter().filter(|hit| hit.a == ball || hit.b == ball).count();
        if hits > 0 && struck == 0 {
            // The floor can have taken no more than friction gives it in a step.
            judge("momentum after, N·s", world.momentum().linear.x, before, FRICTION * 5000.0 * G * STEP);
        }
        struck += hits;
    }
    assert_eq!(struck, 1, "collisions with the ball");
    let rebound = (mass - 0.5 * 1000.0) / (mass + 1000.0) * speed;
    judge("speed of the ball, m/s", world[ball].linear_velocity().x.into(), rebound, 1e-3);
    run(&mut world, 4.0);
    let start = mass * 1.5 / (mass + 1000.0) * speed;
    let top = world[boxes[4]].position();
    judge("height of the top box, m", top.y, 4.5, 1e-3);
    for (level, &id) in boxes[..4].iter().enumerate() {
        let moved = world[id].position() - DVec3::new(0.0, 0.5 + level as f64, 0.0);
        judge(&format!("way of box {level}, m"), moved.length(), 0.0, 2e-3);
    }
    (top.x, start * start / (2.0 * FRICTION * G))
}

/// Where in a step the ball arrives differs.
const DISTANCES: [f64; 5] = [2.0, 2.02, 2.05, 2.1, 2.15];

#[test]
fn a_stack_whose_top_is_struck_sideways_stands() {
    for distance in DISTANCES {
        println!("from {distance} m");
        strike_the_top_of_a_stack(distance);
    }
}

#[test]
#[ignore = "the substep of the collision goes by with too little friction: the top box goes 2 % too far"]
fn the_top_of_a_stack_that_is_struck_goes_as_far_as_its_speed_takes_it() {
    for distance in DISTANCES {
        let (way, truth) = strike_the_top_of_a_stack(distance);
        judge_share(&format!("from {distance} m: way of the top box, m"), way, truth, 2e-3);
    }
}

#[test]
fn a_box_struck_sideways_on_the_floor_slides_as_far_as_its_speed_takes_it() {
    const FRICTION: f64 = 0.3;
    let mut world = World::new();
    world.add(slab(FRICTION));
    let id = world.add(cube().at(0.0, 0.5, 0.0).friction(FRICTION));
    let (mass, speed) = (500.0, 6.0);
    let ball = world.add(striker(mass, 0.5).at(-2.0, 0.5, 0.0).moving(speed as f32, 0.0, 0.0));
    run(&mut world, 4.0);
    let start = mass * 1.5 / (mass + 1000.0) * speed;
    judge_share("way, m", world[id].position().x, start * start / (2.0 * FRICTION * G), 1e-3);
    judge("height, m", world[id].position().y, 0.5, 1e-4);
    judge("speed of the ball, m/s", world[ball].linear_velocity().x.into(), 0.0, 1e-3);
}

#[test]
fn a_box_struck_from_above_on_the_floor_stays() {
    // The floor holds the box from below, so the ball comes back as from a wall.
    let mut world = World::new();
    world.add(slab(0.6));
    let id = world.add(cube().at(0.0, 0.5, 0.0));
    let ball = world.add(striker(100.0, 0.5).at(0.0, 2.0, 0.0).moving(0.0, -4.0, 0.0));
    let energy = 0.5 * 100.0 * 16.0;
    for _ in 0..steps(1.0) {
        world.step(STEP);
        judge("way of the box, m", (world[id].position() - DVec3::new(0.0, 0.5, 0.0)).length(), 0.0, 1e-3);
        let kinetic = world.energy().kinetic;
        assert!(kinetic <= energy * (1.0 + 1e-9), "{kinetic} J of {energy} J");
    }
    let back = f64::from(world[ball].linear_velocity().y);
    assert!(back > 0.0 && back <= 2.0 + 1e-6, "{back} m/s");
    judge("speed of the box, m/s", world[id].linear_velocity().length().into(), 0.0, 1e-3);
}

/// A plank, 4 m long, lies on a block and is struck by a ball that does not bounce, at 1.5 m from the middle; how it turns and
/// the ball moves right after that, before gravity has changed it, and how they should.
///
/// Block and ball push at one instant, so the plank turns about the block's edge, about which the angular momentum stays:
/// m_b·v·d = (I + m_b·d²)·ω.
fn struck_see_saw(half_block: f64) -> [(f64, f64); 2] {
    let (length, thickness, arm) = (4.0_f64, 0.1_f64, 1.5);
    let (plank_mass, ball_mass, speed) = (100.0, 20.0, 3.0);
    let mut world = World::new();
    let block = Shape::cuboid(2.0 * half_block, 2.0, 1.0);
    world.add(Body::fixed().at(0.0, -1.0, 0.0).with(block).friction(1.0));
    let plank = Body::dynamic().with(Shape::cuboid(length, thickness, 0.5)).mass(plank_mass).friction(1.0);
    let plank = world.add(plank.at(0.0, 0.5 * thickness, 0.0));
    let ball = striker(ball_mass, 0.0).at(arm, thickness + 0.8, 0.0).moving(0.0, -speed as f32, 0.0);
    let ball = world.add(ball);
    let mut impacts = Vec::new();
    while impacts.is_empty() {
        impacts = world.step(STEP).impacts().to_vec();
        assert!(world.time() < 1.0, "no collision");
    }
    let after = |body: BodyId| {
        let of_body = |hit: &Impact| {
            let at = (hit.time, hit.round);
            if hit.a == body { Some((at, hit.after_a)) } else { (hit.b == body).then_some((at, hit.after_b)) }
        };
        let first = impacts.iter().filter_map(of_body).filter(|(at, _)| at.0 == impacts[0].time);
        first.max_by_key(|(at, _)| at.1).map(|(_, velocity)| velocity).unwrap()
    };
    let d = arm - half_block;
    let inertia = plank_mass * (length * length + thickness * thickness) / 12.0
        + plank_mass * (half_block * half_block + 0.25 * thickness * thickness);
    let truth = ball_mass * speed * d / (inertia + ball_mass * d * d);
    [(-after(plank).angular.z, truth), (-after(ball).linear.y, truth * d)]
}

#[test]
fn a_see_saw_struck_at_its_end_turns_about_its_edge() {
    let [spin, speed] = struck_see_saw(0.01);
    judge_share("spin of the plank, rad/s", spin.0, spin.1, 0.01);
    judge_share("speed of the ball, m/s", speed.0, speed.1, 0.01);
}

#[test]
fn a_see_saw_on_a_wide_block_turns_about_the_edge_that_carries_it() {
    let [spin, speed] = struck_see_saw(0.2);
    judge_share("spin of the plank, rad/s", spin.0, spin.1, 0.01);
    judge_share("speed of the ball, m/s", speed.0, speed.1, 0.01);
}
