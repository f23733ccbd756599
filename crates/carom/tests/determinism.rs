//! The same scene gives the same bits, and everywhere the same motion.

use carom::math::DVec3;
use carom::prelude::*;
use carom::{Impact, Settings};
use random::Random;

mod random;

const STEP: f64 = 1.0 / 60.0;

/// Thirty bodies of three shapes that fall on a floor together.
fn busy() -> World {
    let mut random = Random(30);
    let mut world = World::new();
    world.add(Body::fixed().at(0.0, -0.5, 0.0).with(Shape::cuboid(12.0, 1.0, 12.0)).restitution(0.2));
    for number in 0..30 {
        let shape = match number % 3 {
            0 => Shape::sphere(random.range(0.2, 0.5)),
            1 => Shape::cuboid(random.range(0.3, 0.9), random.range(0.3, 0.9), random.range(0.3, 0.9)),
            _ => Shape::capsule(random.range(0.2, 0.8), random.range(0.15, 0.3)),
        };
        let (x, z) = (random.range(-1.2, 1.2), random.range(-1.2, 1.2));
        let (v, w) = (random.vector(2.0).as_vec3(), random.vector(4.0).as_vec3());
        let body = Body::dynamic()
            .at(x, 1.5 + 0.9 * f64::from(number / 3), z)
            .rotated(random.rotation().as_quat().normalize())
            .moving(v.x, v.y, v.z)
            .spinning(w.x, w.y, w.z)
            .with(shape)
            .restitution(random.range(0.0, 0.8))
            .friction(random.range(0.0, 0.8));
        world.add(body);
    }
    world
}

#[test]
fn two_runs_give_the_same_bits() {
    let (mut one, mut other) = (busy(), busy());
    let (mut hits, mut hashes) = (0, Vec::new());
    for step in 0..200 {
        let told = format!("{:?}", one.step(STEP));
        assert_eq!(told, format!("{:?}", other.step(STEP)), "in step {step}");
        assert_eq!(one.state_hash(), other.state_hash(), "after step {step}");
        hits += told.matches("Impact {").count();
        hashes.push(one.state_hash());
    }
    assert!(hits > 100, "{hits}");
    hashes.dedup();
    assert!(hashes.len() > 100, "the hash follows the state");
    for (id, state) in one.bodies() {
        assert!(state.position().is_finite() && state.position().y > -20.0, "{id:?}: {state:?}");
    }
}

/// Scenes in which touches come one at a time.
fn scenes() -> Vec<(&'static str, World, Vec<Body>, f64)> {
    let floor = || Body::fixed().with(Shape::plane());
    let bouncing = Body::dynamic()
        .at(0.3, 2.5, 0.2)
        .moving(1.0, 0.0, 0.5)
        .spinning(3.0, 0.0, 5.0)
        .with(Shape::sphere(0.5))
        .restitution(0.9);
    let tumbling = Body::dynamic()
        .at(0.0, 2.0, 0.0)
        .moving(0.5, 0.0, 0.0)
        .spinning(1.0, 2.0, 0.5)
        .rotated(Quat::from_xyzw(0.3, 0.1, 0.2, 0.8).normalize())
        .with(Shape::cuboid(1.0, 0.8, 0.6))
        .restitution(0.9);
    let ball = |x: f64, speed: f32| {
        Body::dynamic().at(x, 0.1 * x, 0.0).moving(speed, 0.0, 0.0).with(Shape::sphere(0.5)).restitution(0.8)
    };
    let floating = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
    vec![
        ("bouncing ball", World::new(), vec![floor(), bouncing], 3.0),
        ("tumbling box", World::new(), vec![floor(), tumbling], 2.0),
        ("two balls", floating, vec![ball(-2.0, 2.0), ball(2.0, -1.0).spinning(0.0, 4.0, 1.0)], 3.0),
    ]
}

#[test]
fn a_thousand_kilometres_away_everything_moves_alike() {
    let far = DVec3::new(1e6, 0.0, -1e6);
    for ((name, mut here, bodies, time), (_, mut there, _, _)) in scenes().into_iter().zip(scenes()) {
        let ids: Vec<(BodyId, BodyId)> = bodies
            .into_iter()
            .map(|body| {
                let near = here.add(body.clone());
                (near, there.add(Body { position: body.position + far, ..body }))
            })
            .collect();
        let (mut worst, mut hits) = (0.0_f64, [0, 0]);
        for _ in 0..(time / STEP) as usize {
            let instants = |impacts: &[Impact]| impacts.iter().map(|it| it.time).collect::<Vec<f64>>();
            let times = [instants(here.step(STEP).impacts()), instants(there.step(STEP).impacts())];
            hits = [hits[0] + times[0].len(), hits[1] + times[1].len()];
            assert_eq!(hits[0], hits[1], "{name} at {} s: {times:?}", here.time());
            for &(near, distant) in &ids {
                let (near, distant) = (&here[near], &there[distant]);
                let off = (near.linear_velocity() - distant.linear_velocity()).length()
                    / near.linear_velocity().length().max(1.0);
                let spun = (near.angular_velocity() - distant.angular_velocity()).length()
                    / near.angular_velocity().length().max(1.0);
                worst = worst.max(f64::from(off.max(spun)));
                let shift = (distant.position() - near.position() - far).length();
                assert!(shift < 1e-5, "{name} at {} s: {shift}", here.time());
            }
        }
        println!("{name}: {} hits, velocities within {worst:.1e}", hits[0]);
        assert!(hits[0] > 0 && worst < 1e-5, "{name}: {worst:e} after {} hits", hits[0]);
    }
}

#[test]
fn ids_are_not_given_twice() {
    let mut world = busy();
    let mut given: Vec<BodyId> = world.bodies().map(|(id, _)| id).collect();
    let mut random = Random(1);
    for round in 0..100 {
        let live: Vec<BodyId> = world.bodies().map(|(id, _)| id).collect();
        let gone = live[1 + (random.unit() * (live.len() - 1) as f64) as usize];
        assert!(world.remove(gone));
        let new =
            world.add(Body::dynamic().at(0.0, 3.0 + f64::from(round % 7), 0.0).with(Shape::sphere(0.3)));
        assert!(!given.contains(&new), "{new:?}");
        given.push(new);
        world.step(STEP);
    }
    assert_eq!(world.bodies().count(), 31);
}

#[test]
fn removing_and_adding_is_deterministic_too() {
    let run = || {
        let mut world = busy();
        for step in 0..60 {
            world.step(STEP);
            if step % 5 == 0 {
                let id = world.bodies().nth(1 + step % 30).map(|(id, _)| id).unwrap();
                world.remove(id);
                world.add(Body::dynamic().at(0.2, 4.0, 0.1).with(Shape::cuboid(0.5, 0.5, 0.5)));
            }
        }
        world.state_hash()
    };
    assert_eq!(run(), run());
}
