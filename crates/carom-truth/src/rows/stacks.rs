//! What stands, and does not sink.

use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{STEP, cube, slab, steps};
use carom::prelude::*;

const FRICTION: f64 = 0.5;

pub fn rows() -> Vec<Row> {
    let settled = |goal| Figure::new("sink of the top, settled", "m", 0.0, Within(goal));
    let peak = |goal| Figure::new("largest sink of the top", "m", 0.0, Within(goal));
    let stack = Row::new("stack-20", "20 cubes of 1 m stand on each other for 10 s", "nothing moves", || {
        stand(20, 1.0, 10.0)
    });
    let heavy = |ratio: u32| {
        let what = format!("a cube {ratio} times as heavy stands on another for 5 s");
        Row::new(format!("heavy-{ratio}"), what, "nothing moves", move || stand(2, f64::from(ratio), 5.0))
    };
    vec![
        stack.figure(settled(1e-3).peers(["0.106", "0.106", "falls", "falls"])).figure(peak(2e-3)),
        heavy(100).figure(settled(1e-3).peers(["0.035", "0.035", "0.057", "falls"])).figure(peak(1e-3)),
        heavy(1000).figure(settled(5e-3).peers(["falls", "0.43", "falls", "falls"])).figure(peak(5e-3)),
    ]
}

/// How far the uppermost of `count` cubes, `ratio` times as heavy as the others, has sunk in the end and at most, m.
fn stand(count: u32, ratio: f64, seconds: f64) -> Vec<f64> {
    let mut world = World::new();
    world.add(slab().friction(FRICTION));
    let place = |world: &mut World, level: u32, ratio: f64| {
        let cube = cube().friction(FRICTION).mass(1000.0 * ratio);
        world.add(cube.at(0.0, 0.5 + f64::from(level), 0.0))
    };
    for level in 0..count - 1 {
        place(&mut world, level, 1.0);
    }
    let top = place(&mut world, count - 1, ratio);
    let start = world[top].position();
    let (mut settled, mut peak) = (f64::NAN, 0.0_f64);
    for _ in 0..steps(seconds) {
        world.step(STEP);
        settled = start.y - world[top].position().y;
        peak = peak.max(settled.abs());
    }
    vec![settled, peak]
}
