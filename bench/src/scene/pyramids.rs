//! Walls of unit boxes, each course half a box in: the stack that every solver is shown with.

use super::{Body, EARTH, Scene, Size, above_ground, cuboid, ground};

/// Boxes in the lowest course of the one wall.
const BASE: usize = 40;
/// The same of the many.
const MANY_BASE: usize = 10;
/// Many are this squared.
const MANY_ACROSS: usize = 14;

/// Adds a wall whose middle stands at (x, z).
fn wall(bodies: &mut Vec<Body>, base: usize, [x, z]: [f32; 2]) {
    for course in 0..base {
        for place in 0..base - course {
            let along = x + place as f32 + 0.5 * course as f32 - 0.5 * (base - 1) as f32;
            bodies.push(Body::dynamic([along, 0.5 + course as f32, z], cuboid([0.5; 3])));
        }
    }
}

/// One wall: 40 in the lowest course, 820 in all.
pub fn one(size: Size) -> Scene {
    let base = size.base.unwrap_or(BASE);
    let half = 60.0_f32.max(base as f32);
    let mut bodies = vec![ground(half)];
    wall(&mut bodies, base, [0.0, 0.0]);
    Scene { bodies, gravity: EARTH, steps: 300, bounds: above_ground(half) }
}

/// 14 × 14 walls that never meet, 10 in the lowest course of each: 10,780 boxes.
pub fn many(size: Size) -> Scene {
    let base = size.base.unwrap_or(MANY_BASE);
    let apart = [12.0_f32.max(base as f32 + 2.0), 4.0];
    let half = 120.0_f32.max(0.5 * apart[0] * (MANY_ACROSS + 2) as f32);
    let mut bodies = vec![ground(half)];
    let middle = 0.5 * (MANY_ACROSS - 1) as f32;
    for i in 0..MANY_ACROSS {
        for j in 0..MANY_ACROSS {
            wall(&mut bodies, base, [(i as f32 - middle) * apart[0], (j as f32 - middle) * apart[1]]);
        }
    }
    Scene { bodies, gravity: EARTH, steps: 100, bounds: above_ground(half) }
}
