//! What slides and rolls.

use crate::closed::friction::{rolling_acceleration, way_to_rest};
use crate::row::{Figure, Goal::Share, Row};
use crate::scene::{Begins, G, ball, run, slab};
use carom::math::{DQuat, DVec3};
use carom::prelude::*;

const SLOPE: f64 = 20.0 * std::f64::consts::PI / 180.0;
/// Coefficient and speed (m/s).
const SLIDES: [(f64, f64); 2] = [(0.5, 5.0), (0.2, 3.0)];

pub fn rows() -> Vec<Row> {
    let mut slide =
        Row::new("slide-to-rest", "a box slides on the level until it stops", "v²/2μg", slide_to_rest);
    for ((friction, speed), peers) in
        SLIDES.into_iter().zip([Some(["0.4 %", "0.4 %", "1.6 %", "1.6 %"]), None])
    {
        let what = format!("way from {speed} m/s, μ = {friction}");
        let figure = Figure::new(what, "m", way_to_rest(speed, friction, G), Share(1e-3));
        slide = slide.figure(Figure { peers, ..figure });
    }
    let acceleration = rolling_acceleration(SLOPE, G);
    vec![
        slide,
        Row::new("rolling-ball", "a ball rolls down a slope of 20° for 2 s", "5/7·g·sin θ", rolling_ball)
            .figure(
                Figure::new("way", "m", 2.0 * acceleration, Share(1e-3))
                    .peers(["0.1 %", "0.1 %", "0", "1 %"]),
            ),
    ]
}

fn slide_to_rest() -> Vec<f64> {
    let way = |(friction, speed): (f64, f64)| {
        let mut world = World::new();
        world.add(slab().friction(friction));
        let sled = Body::dynamic().with(Shape::cuboid(1.0, 0.2, 1.0)).friction(friction).at(0.0, 0.1, 0.0);
        let id = world.add(sled.flung(DVec3::X * speed));
        run(&mut world, speed / (friction * G) + 1.0);
        world[id].position().x
    };
    SLIDES.map(way).to_vec()
}

fn rolling_ball() -> Vec<f64> {
    let tilt = DQuat::from_rotation_z(-SLOPE);
    let mut world = World::new();
    world.add(slab().friction(1.0).turned(tilt));
    let start = tilt * DVec3::Y * 0.5;
    let id = world.add(ball(0.5).friction(1.0).placed(start));
    run(&mut world, 2.0);
    vec![(world[id].position() - start).dot(tilt * DVec3::X)]
}
