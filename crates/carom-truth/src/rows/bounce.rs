//! What bounces, and how high.

use crate::closed::bounce::{apex, last_moment_at};
use crate::closed::friction::superball;
use crate::row::{Figure, Goal::Share, Goal::Within, Row};
use crate::scene::{Begins, G, STEP, ball, cube, floating, rotation, slab, spin, steps, velocity};
use carom::math::DVec3;
use carom::prelude::*;

const DROP: f64 = 2.0;
const RADIUS: f64 = 0.5;
/// A ball lower than this has come to rest, m.
const LOW: f64 = 0.005;
const SUPERBALL: DVec3 = DVec3::new(4.0, -5.0, 0.0);

pub fn rows() -> Vec<Row> {
    let [along, away, turning] = superball(SUPERBALL.x, -SUPERBALL.y, (1.0, 0.05), RADIUS);
    vec![
        Row::new("ball-bounce", "a ball falls 2 m, C_r = 1, 100 times", "apex n is h·C_r^(2n)", ball_bounce)
            .figure(
                Figure::new("apex 100", "m", apex(DROP, 1.0, 100), Within(1e-3))
                    .peers(["0.43", "1.92", "2.00", "died"]),
            )
            .figure(Figure::new("the apex that is furthest off", "m", DROP, Within(1e-3))),
        Row::new("ball-to-rest", "a ball falls 2 m, C_r = 0.8", "geometric series of flights", ball_to_rest)
            .figure(
                Figure::new("last time 5 mm high", "s", last_moment_at(LOW, DROP, 0.8, G), Share(0.01))
                    .peers(["4.77", "4.83", "5.08", "5.23"]),
            ),
        Row::new("cube-flat", "a cube falls 2 m flat, C_r = 1, 20 times", "h·C_r^(2n); no torque", cube_flat)
            .figure(
                Figure::new("apex 20", "m", apex(DROP, 1.0, 20), Within(1e-2))
                    .peers(["0.27", "0.92", "2.00", "4.6"]),
            )
            .figure(
                Figure::new("largest tilt", "rad", 0.0, Within(1e-3)).peers(["3.1", "3.0", "0", "0.001"]),
            ),
        Row::new(
            "superball",
            "a ball without spin meets a floor at 4 m/s along it and 5 m/s towards it, C_r = 1, μ = 0.05",
            "j_t = min(2/7·slip, μ(1 + C_r)·v_n)·m",
            strike_floor,
        )
        .figure(Figure::new("v_x", "m/s", along, Within(1e-3)).peers(["3.75", "3.75", "3.50", "3.50"]))
        .figure(Figure::new("v_y", "m/s", away, Within(1e-3)))
        .figure(Figure::new("ω", "rad/s", turning, Within(1e-3))),
    ]
}

/// The heights of the apexes of a fall, seen by steps: each vertex of the parabola through three heights.
fn apexes(heights: &[f64]) -> Vec<f64> {
    let tops = heights.windows(3).filter(|w| w[0] < w[1] && w[1] >= w[2]);
    tops.map(|w| w[1] - (w[2] - w[0]).powi(2) / (8.0 * (w[0] - 2.0 * w[1] + w[2]))).collect()
}

fn ball_bounce() -> Vec<f64> {
    let mut world = World::new();
    world.add(slab().friction(0.0).restitution(1.0));
    let id = world.add(ball(RADIUS).restitution(1.0).at(0.0, DROP + RADIUS, 0.0));
    // 100 bounces and half a flight more.
    let seconds = 201.5 * (2.0 * DROP / G).sqrt();
    let heights: Vec<f64> = (0..steps(seconds))
        .map(|_| {
            world.step(STEP);
            world[id].position().y - RADIUS
        })
        .collect();
    let apexes = apexes(&heights);
    let worst = apexes.iter().copied().max_by(|a, b| (a - DROP).abs().total_cmp(&(b - DROP).abs()));
    vec![apexes.get(99).copied().unwrap_or(0.0), worst.unwrap_or(0.0)]
}

fn ball_to_rest() -> Vec<f64> {
    let mut world = World::new();
    world.add(slab().friction(0.0).restitution(0.8));
    let id = world.add(ball(RADIUS).restitution(0.8).at(0.0, DROP + RADIUS, 0.0));
    let (mut last, mut before) = (f64::NAN, DROP);
    for step in 0..steps(8.0) {
        world.step(STEP);
        let height = world[id].position().y - RADIUS;
        if before > LOW && height <= LOW {
            last = (step as f64 + (before - LOW) / (before - height)) * STEP;
        }
        before = height;
    }
    vec![last]
}

fn cube_flat() -> Vec<f64> {
    let mut world = World::new();
    world.add(slab().friction(0.0).restitution(1.0));
    let id = world.add(cube().restitution(1.0).friction(0.0).at(0.0, DROP + 0.5, 0.0));
    let seconds = 41.5 * (2.0 * DROP / G).sqrt();
    let (mut heights, mut tilt) = (Vec::new(), 0.0_f64);
    for _ in 0..steps(seconds) {
        world.step(STEP);
        heights.push(world[id].position().y - 0.5);
        tilt = tilt.max((rotation(&world, id) * DVec3::Y).angle_between(DVec3::Y));
    }
    vec![apexes(&heights).get(19).copied().unwrap_or(0.0), tilt]
}

fn strike_floor() -> Vec<f64> {
    let mut world = floating();
    world.add(slab().friction(0.05).restitution(1.0));
    let body = ball(RADIUS).friction(0.05).restitution(1.0).at(0.0, RADIUS + 1.234, 0.0);
    let id = world.add(body.flung(SUPERBALL));
    for _ in 0..steps(0.6) {
        world.step(STEP);
    }
    // A ball that rolls towards +x turns about −z.
    vec![velocity(&world, id).x, velocity(&world, id).y, -spin(&world, id).z]
}
