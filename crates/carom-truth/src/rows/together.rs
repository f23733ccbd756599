//! Bodies that touch when one of them is struck, and those that only seem to.

use crate::balls;
use crate::closed::solids::{Form, Solid};
use crate::closed::together::{elastic, one_onto_two, row_struck};
use crate::random::Random;
use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, ball, floating, largest, run, spin, velocity};
use carom::math::DVec3;
use carom::prelude::*;

const SPEED: f64 = 5.0;
const UNEQUAL: [f64; 3] = [1.0, 1.0, 3.0];

pub fn rows() -> Vec<Row> {
    let off = || Figure::new("worst v off by, of v₀", "", 0.0, Within(1e-5));
    vec![
        Row::new(
            "unequal-masses",
            "1 kg strikes 1 kg that touches 3 kg, C_r = 1: the last must break away",
            "the impacts in the order in which they close: −½, 0, ½",
            unequal_masses,
        )
        .figure(off()),
        Row::new(
            "unequal-gaps",
            "five balls of 1, 5, 2, 0.5 and 3 kg on a line, 1 mm apart, C_r = 1",
            "event-driven balls in double precision",
            unequal_gaps,
        )
        .figure(off()),
        Row::new(
            "ball-cloud",
            "36 unequal balls fly into each other, C_r = 1",
            "event-driven balls in double precision",
            ball_cloud,
        )
        .figure(Figure::new("furthest from its place after 1.5 s", "m", 0.0, Within(1e-3)))
        .figure(Figure::new("impacts seen, of those there are", "", 1.0, Within(0.0))),
        Row::new(
            "one-onto-two",
            "a ball strikes two that touch, in the middle, C_r = 1",
            "Bernoulli: −1/5 and 2√3/5",
            strike_two,
        )
        .figure(off()),
        Row::new("both-ends", "a row of three is struck from both ends, C_r = 1", "symmetry: −v₀", both_ends)
            .figure(off()),
        Row::new(
            "bar-onto-two",
            "a bar falls flat on two balls, C_r = 1",
            "one impact of m and 2·m_b; symmetry",
            bar_onto_two,
        )
        .figure(off()),
        Row::new(
            "parting",
            "touching balls and boxes part, C_r 0 and 1, μ = 0.5",
            "what parts feels nothing",
            parting,
        )
        .figure(Figure::new("largest change of v", "m/s", 0.0, Within(1e-6))),
    ]
}

/// Adds a smooth elastic ball of that mass (kg).
fn add(world: &mut World, ball: &balls::Ball) -> BodyId {
    let body = self::ball(ball.radius).restitution(1.0).mass(ball.mass);
    world.add(body.placed(ball.position).flung(ball.velocity))
}

/// How far the velocities are from `truth`, at worst, over `SPEED`.
fn worst(world: &World, ids: &[BodyId], truth: impl IntoIterator<Item = DVec3>) -> f64 {
    largest(ids.iter().zip(truth).map(|(&id, truth)| (velocity(world, id) - truth).length() / SPEED))
}

/// Balls of those masses on a line along x, the first of which flies at the others.
fn on_a_line(masses: &[f64], gap: f64) -> Vec<balls::Ball> {
    let one = |(k, &mass): (usize, &f64)| {
        let (start, speed) = if k == 0 { (-0.731, SPEED) } else { (k as f64 * (1.0 + gap), 0.0) };
        balls::ball(DVec3::X * start, DVec3::X * speed, 0.5, mass)
    };
    masses.iter().enumerate().map(one).collect()
}

fn unequal_masses() -> Vec<f64> {
    let mut world = floating();
    let ids: Vec<BodyId> = on_a_line(&UNEQUAL, 0.0).iter().map(|ball| add(&mut world, ball)).collect();
    run(&mut world, 1.0);
    vec![worst(&world, &ids, row_struck(&UNEQUAL, SPEED).into_iter().map(|v| DVec3::X * v))]
}

fn unequal_gaps() -> Vec<f64> {
    let mut truth = on_a_line(&[1.0, 5.0, 2.0, 0.5, 3.0], 1e-3);
    let mut world = floating();
    let ids: Vec<BodyId> = truth.iter().map(|ball| add(&mut world, ball)).collect();
    run(&mut world, 1.0);
    balls::fly(&mut truth, 1.0);
    vec![worst(&world, &ids, truth.iter().map(|ball| ball.velocity))]
}

fn ball_cloud() -> Vec<f64> {
    let mut random = Random(17);
    let mut truth = Vec::new();
    for number in 0..36 {
        let cell = DVec3::new(f64::from(number % 4), f64::from(number / 4 % 3), f64::from(number / 12));
        let place = (cell - DVec3::new(1.5, 1.0, 1.0)) * 1.2 + 0.1 * random.in_cube();
        let velocity = (random.in_cube() - place).as_vec3().as_dvec3();
        truth.push(balls::ball(place, velocity, random.range(0.3, 0.5), random.range(100.0, 1000.0)));
    }
    let mut world = floating();
    let ids: Vec<BodyId> = truth.iter().map(|ball| add(&mut world, ball)).collect();
    let mut seen = 0;
    for _ in 0..crate::scene::steps(1.5) {
        seen += world.step(crate::scene::STEP).impacts().len();
    }
    let impacts = balls::fly(&mut truth, 1.5);
    let off = ids.iter().zip(&truth).map(|(&id, ball)| world[id].position().distance(ball.position));
    vec![largest(off), seen as f64 / impacts as f64]
}

fn strike_two() -> Vec<f64> {
    let mut world = floating();
    let still = |z: f64| balls::ball(DVec3::Z * z, DVec3::ZERO, 0.5, 500.0);
    let striker = balls::ball(DVec3::X * -3.313, DVec3::X * SPEED, 0.5, 500.0);
    let ids = [striker, still(0.5), still(-0.5)].map(|ball| add(&mut world, &ball));
    run(&mut world, 1.2);
    let [back, forth] = one_onto_two();
    let along = |z: f64| DVec3::new(0.75_f64.sqrt(), 0.0, z) * forth * SPEED;
    vec![worst(&world, &ids, [DVec3::X * back * SPEED, along(0.5), along(-0.5)])]
}

fn both_ends() -> Vec<f64> {
    let mut world = floating();
    let one = |x: f64, speed: f64| balls::ball(DVec3::X * x, DVec3::X * speed, 0.5, 500.0);
    let balls = [one(-4.1, SPEED), one(-1.0, 0.0), one(0.0, 0.0), one(1.0, 0.0), one(4.1, -SPEED)];
    let ids = balls.map(|ball| add(&mut world, &ball));
    run(&mut world, 1.0);
    vec![worst(&world, &ids, [-SPEED, 0.0, 0.0, 0.0, SPEED].map(|v| DVec3::X * v))]
}

fn bar_onto_two() -> Vec<f64> {
    let size = DVec3::new(2.0, 0.5, 0.5);
    let bar = Solid { form: Form::Cuboid(size), density: 1000.0 };
    let ball = Solid { form: Form::Ball(0.5), density: 1000.0 };
    let smooth = |solid: &Solid| solid.body().restitution(1.0).friction(0.0);
    let mut world = floating();
    let ids = [
        world.add(smooth(&bar).at(0.0, 2.137, 0.0).flung(DVec3::Y * -SPEED)),
        world.add(smooth(&ball).at(-0.8, 0.0, 0.0)),
        world.add(smooth(&ball).at(0.8, 0.0, 0.0)),
    ];
    run(&mut world, 0.6);
    let [after, of_balls] = elastic([bar.mass(), 2.0 * ball.mass()], [-SPEED, 0.0]);
    let off = worst(&world, &ids, [after, of_balls, of_balls].map(|v| DVec3::Y * v));
    vec![largest([off, spin(&world, ids[0]).length() * 0.5 * size.length() / SPEED])]
}

fn parting() -> Vec<f64> {
    let mut changes = Vec::new();
    for restitution in [0.0, 1.0] {
        let mut world = floating();
        let surface = |body: Body| body.restitution(restitution).friction(0.5);
        let round = || surface(ball(0.5));
        let cube = || surface(crate::scene::cube());
        let bodies = [
            round().at(-0.5, 0.0, 0.0).flung(DVec3::new(-1.0, 0.3, 0.0)).spun(DVec3::Z * 4.0),
            round().at(0.5, 0.0, 0.0).flung(DVec3::new(1.0, -0.2, 0.1)).spun(DVec3::Y * 2.0),
            cube().at(0.0, 5.0, 0.0),
            cube().at(0.0, 6.0, 0.0).flung(DVec3::Y),
        ];
        let starts = bodies.map(|body| (body.linear_velocity.as_dvec3(), world.add(body)));
        run(&mut world, 0.5);
        changes.extend(starts.map(|(before, id)| (velocity(&world, id) - before).length()));
    }
    vec![largest(changes)]
}
