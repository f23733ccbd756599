//! What is fast must not pass through, nor be slowed by what it does not touch.

use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, STEP, ball, floating, largest, run, velocity};
use carom::math::DVec3;
use carom::prelude::*;

const RADIUS: f64 = 0.05;
/// Half the thickness of the wall, m.
const WALL: f64 = 0.005;
/// Tries, spread over the way of one step.
const TRIES: u32 = 50;

pub fn rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for speed in [100.0, 500.0, 2000.0] {
        let what = format!("50 balls of 5 cm and 50 that do not bounce fly at {speed} m/s at a wall of 1 cm");
        let mut passed = Figure::new("passed, of 50 that bounce", "", 0.0, Within(0.0));
        if speed == 500.0 {
            passed = passed.peers(["0, slowed", "50", "50", "50"]);
        }
        rows.push(
            Row::new(format!("bullet-wall-{speed}"), what, "−C_r·v", move || bullets_at_wall(speed))
                .figure(passed)
                .figure(Figure::new("passed, of 50 that do not", "", 0.0, Within(0.0)))
                .figure(Figure::new("worst change of speed before, of it", "", 0.0, Within(1e-6)))
                .figure(Figure::new("worst v + C_r·v₀ after, of v₀", "", 0.0, Within(1e-6))),
        );
    }
    for speed in [100.0, 500.0, 2000.0] {
        let what = format!("50 pairs of balls of 5 cm fly at each other, each at {speed} m/s, C_r = 1");
        let mut passed = Figure::new("passed, of 50", "", 0.0, Within(0.0));
        if speed == 100.0 {
            passed = passed.peers(["49", "49", "49", "47"]);
        }
        rows.push(
            Row::new(format!("bullet-head-on-{speed}"), what, "−v", move || head_on(speed))
                .figure(passed)
                .figure(Figure::new("worst v off by, of it", "", 0.0, Within(1e-6))),
        );
    }
    rows.push(
        Row::new("near-miss", "a ball passes another 2 mm clear", "nothing happens", near_miss).figure(
            Figure::new("change of v, of it", "", 0.0, Within(0.0)).peers(["0.16", "0", "0.009", "0.01"]),
        ),
    );
    rows
}

fn bullets_at_wall(speed: f64) -> Vec<f64> {
    let (mut passed, mut before, mut after) = ([0.0; 2], 0.0, 0.0);
    for (restitution, passed) in [1.0, 0.0].into_iter().zip(&mut passed) {
        for number in 0..TRIES {
            let mut world = floating();
            let wall = Body::fixed().with(Shape::cuboid(2.0 * WALL, 4.0, 4.0));
            world.add(wall.restitution(restitution).friction(0.0));
            let start = -3.0 - speed * STEP * f64::from(number) / f64::from(TRIES);
            let bullet = ball(RADIUS).restitution(restitution).at(start, 0.1, 0.2);
            let id = world.add(bullet.flung(DVec3::X * speed));
            let touch = (-start - RADIUS - WALL) / speed;
            while world.time() + STEP < touch {
                world.step(STEP);
                before = largest([before, (velocity(&world, id).x / speed - 1.0).abs()]);
            }
            run(&mut world, 4.0 * STEP);
            if world[id].position().x > 0.0 {
                *passed += 1.0;
            }
            after = largest([after, (velocity(&world, id).x / speed + restitution).abs()]);
        }
    }
    vec![passed[0], passed[1], before, after]
}

fn head_on(speed: f64) -> Vec<f64> {
    let (mut passed, mut off) = (0.0, 0.0);
    for number in 0..TRIES {
        let mut world = floating();
        let start = 3.0 + speed * STEP * f64::from(number) / f64::from(TRIES);
        let [a, b] = [-1.0, 1.0].map(|side| {
            let bullet = ball(RADIUS).restitution(1.0).at(side * start, 0.0, 0.0);
            world.add(bullet.flung(DVec3::X * -side * speed))
        });
        run(&mut world, 2.0 * start / speed + 10.0 * STEP);
        if world[a].position().x > world[b].position().x {
            passed += 1.0;
        }
        off = largest([
            off,
            (velocity(&world, a).x / speed + 1.0).abs(),
            (velocity(&world, b).x / speed - 1.0).abs(),
        ]);
    }
    vec![passed, off]
}

fn near_miss() -> Vec<f64> {
    let speed = 5.0;
    let mut world = floating();
    let still = world.add(ball(0.5).restitution(1.0));
    let passing = world.add(ball(0.5).restitution(1.0).at(-3.0, 1.002, 0.0).flung(DVec3::X * speed));
    run(&mut world, 1.5);
    let changes = [velocity(&world, still), velocity(&world, passing) - DVec3::X * speed];
    vec![largest(changes.map(|change| change.length() / speed))]
}
