//! Thin things that turn fast.

use super::*;

fn blades() -> Vec<(&'static str, Shape)> {
    let (long, wide, thin) = (0.5, 0.05, 0.005);
    let corners: Vec<DVec3> = (0..8)
        .map(|bits| {
            let sign = |bit: u32| if bits & bit == 0 { -1.0 } else { 1.0 };
            DVec3::new(long * sign(1), thin * sign(2), wide * sign(4))
        })
        .collect();
    vec![
        ("box", Shape::cuboid(2.0 * long, 2.0 * thin, 2.0 * wide)),
        ("hull", Shape::hull(&corners).unwrap()),
        ("capsule", Shape::capsule(2.0 * long, thin)),
    ]
}

/// How far a point is from the middle of a blade along its axis, and off it.
fn local(state: &carom::BodyState, point: DVec3) -> DVec3 {
    state.rotation().as_dquat().normalize().conjugate() * (point - state.position())
}

#[test]
fn a_turning_blade_strikes_a_ball_that_flies_through_its_circle() {
    let mut random = Random(3);
    for (name, blade) in blades() {
        // Against the way in which the ball goes around: within the circle the two turn by more than half a turn, and meet.
        let axis = DVec3::NEG_Z;
        for spin in [20.0, 200.0] {
            for _ in 0..20 {
                let mut world = weightless();
                let mut body = Body::kinematic().with(blade.clone());
                body.angular_velocity = (axis * spin).as_vec3();
                world.add(elastic(body));
                let side = random.range(0.1, 0.4);
                let ball =
                    Body::dynamic().with(Shape::sphere(0.01)).at(side, -1.0, 0.0).moving(0.0, 4.0, 0.0);
                let ball = world.add(elastic(ball));
                let mut hits = 0;
                for _ in 0..60 {
                    hits += world.step(STEP).impacts().len();
                }
                assert!(
                    hits >= 1,
                    "{name} at {spin} rad/s let a ball {side} m from its axis pass: {:?}",
                    world[ball]
                );
            }
        }
    }
}

#[test]
fn blades_never_end_up_within_each_other() {
    let mut random = Random(4);
    let mut hits = 0;
    for (name, blade) in blades() {
        for (other_name, other) in blades() {
            let mut world = weightless();
            let spinning = |shape: &Shape, x: f64, random: &mut Random| {
                let mut body = Body::dynamic().with(shape.clone()).at(x, 0.0, 0.0);
                body.rotation = random.rotation().as_quat();
                body.angular_velocity = (random.direction() * random.range(50.0, 200.0)).as_vec3();
                body.linear_velocity = Vec3::new(-3.0 * x.signum() as f32, 0.0, 0.0);
                elastic(body)
            };
            let a = world.add(spinning(&blade, -0.75, &mut random));
            let b = world.add(spinning(&other, 0.75, &mut random));
            let before = world.energy().kinetic;
            for number in 0..60 {
                hits += world.step(STEP).impacts().len();
                let pose = |id: BodyId| {
                    let state = &world[id];
                    carom::math::Pose::new(state.position(), state.rotation().as_dquat().normalize())
                };
                let gap = carom::collide::separation(&blade, &pose(a), &other, &pose(b));
                assert!(gap > -2e-6, "{name} and {other_name} overlap by {gap} m after step {number}");
            }
            let kept = world.energy().kinetic / before - 1.0;
            assert!(kept.abs() < 1e-4, "{name} and {other_name}: energy changed by {kept:e}");
        }
    }
    assert!(hits > 8, "only {hits} hits");
    println!("{hits} hits");
}

#[test]
fn a_fan_keeps_balls_out() {
    // A blade that turns at 200 rad/s sweeps its disc thirty times a second: a slow ball dropped onto it cannot pass.
    for (name, blade) in blades() {
        let mut world = weightless();
        let mut body = Body::kinematic().with(blade.clone());
        let about = if name == "capsule" { DVec3::X } else { DVec3::Y };
        body.angular_velocity = (about * 200.0).as_vec3();
        let fan = world.add(elastic(body));
        let start = if name == "capsule" { DVec3::new(0.3, 0.2, 0.1) } else { DVec3::new(0.2, 0.3, 0.1) };
        let ball = Body::dynamic().with(Shape::sphere(0.05)).at(start.x, start.y, start.z);
        let mut ball = ball.restitution(0.0).friction(0.0);
        ball.linear_velocity = (about * -1.0).as_vec3();
        let ball = world.add(ball);
        let mut least = f64::INFINITY;
        for _ in 0..60 {
            world.step(STEP);
            least = least.min(local(&world[fan], world[ball].position()).dot(about));
        }
        assert!(least > 0.0, "{name}: the ball fell through, down to {least}");
    }
}
