//! Floors of flush tiles, whose seams are not there for what moves on them.

use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, STEP, ball, steps};
use carom::math::DVec3;
use carom::prelude::*;

const SPEED: f64 = 4.0;
const SECONDS: f64 = 5.0;
const TILES: u32 = 44;
/// Length of a tile along the way and its width, m.
const TILE: [f64; 2] = [0.5, 4.0];

/// What the floor is made of.
#[derive(Clone, Copy)]
enum Floor {
    Bodies,
    Compound,
    Mesh,
    HeightField,
}

pub fn rows() -> Vec<Row> {
    let way = SPEED * SECONDS;
    let row = |name: &str, made_of: &str, floor: Floor| {
        let what = format!("bodies cross 40 flush tiles, {made_of}, at 4 m/s for 5 s");
        Row::new(name, what, "v·t", move || measure(floor))
            .figure(Figure::new("way of a smooth box", "m", way, Within(1e-3)))
            .figure(Figure::new("way of a smooth ball", "m", way, Within(1e-3)))
            .figure(Figure::new("way of a ball that rolls, μ = 0.5", "m", way, Within(1e-3)))
            .figure(Figure::new("highest hop", "m", 0.0, Within(1e-3)))
    };
    let mut bodies = row("tiles-bodies", "boxes", Floor::Bodies);
    bodies.figures[0].peers = Some(["0.65", "2.3", "6.5", "1.25"]);
    vec![
        bodies,
        row("tiles-compound", "boxes of one body", Floor::Compound),
        row("tiles-mesh", "triangles of a mesh", Floor::Mesh),
        row("tiles-height-field", "cells of a height field", Floor::HeightField),
    ]
}

impl Floor {
    /// Tiles along x from −0.75 m on, their tops at height 0.
    fn add(self, world: &mut World, friction: f64) {
        let [length, width] = TILE;
        let start = -1.5 * length;
        let end = start + f64::from(TILES) * length;
        let tiles = (0..TILES).map(|k| {
            let middle = start + (f64::from(k) + 0.5) * length;
            Collider::new(Shape::cuboid(length, 1.0, width)).at(middle, -0.5, 0.0)
        });
        let shape = match self {
            Floor::Bodies => {
                for tile in tiles {
                    world.add(Body::fixed().collider(tile).friction(friction));
                }
                return;
            }
            Floor::Compound => {
                world.add(tiles.fold(Body::fixed(), Body::collider).friction(friction));
                return;
            }
            Floor::Mesh => {
                let corner = |k: u32| {
                    let x = start + f64::from(k / 2) * length;
                    DVec3::new(x, 0.0, [-0.5, 0.5][(k % 2) as usize] * width)
                };
                let vertices = (0..2 * (TILES + 1)).map(corner).collect();
                let cut = |k: u32| [[2 * k, 2 * k + 1, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 2]];
                Shape::mesh(vertices, (0..TILES).flat_map(cut).collect())
            }
            Floor::HeightField => {
                let row = vec![0.0; TILES as usize + 1];
                Shape::height_field(&[row.clone(), row], [end - start, width])
            }
        };
        // A height field is centred.
        let middle = if matches!(self, Floor::HeightField) { 0.5 * (start + end) } else { 0.0 };
        let shape = shape.expect("the numbers are finite and the triangles have areas");
        world.add(Body::fixed().collider(Collider::new(shape).at(middle, 0.0, 0.0)).friction(friction));
    }
}

fn measure(floor: Floor) -> Vec<f64> {
    const HEIGHT: f64 = 0.3;
    let slider = || Body::dynamic().with(Shape::cuboid(0.8, 2.0 * HEIGHT, 0.8)).friction(0.0);
    let rolling = DVec3::Z * (-SPEED / HEIGHT);
    let mut highest = 0.0_f64;
    let mut ways: Vec<f64> =
        [(slider(), 0.0), (ball(HEIGHT), 0.0), (ball(HEIGHT).friction(0.5).spun(rolling), 0.5)]
            .into_iter()
            .map(|(body, friction)| {
                let mut world = World::new();
                floor.add(&mut world, friction);
                let id = world.add(body.at(0.0, HEIGHT, 0.0).flung(DVec3::X * SPEED));
                for _ in 0..steps(SECONDS) {
                    world.step(STEP);
                    highest = highest.max((world[id].position().y - HEIGHT).abs());
                }
                world[id].position().x
            })
            .collect();
    ways.push(highest);
    ways
}
