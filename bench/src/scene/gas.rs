//! Spheres that lose nothing, in a closed box.

use super::piles::Columns;
use super::random::Random;
use super::{Body, Bounds, Scene, Shape, Size, cuboid, scaled_across};

/// Half the width of the nominal box, m.
const HALF_BOX: f32 = 10.0;
/// Half the thickness of its walls, m.
const WALL: f32 = 2.0;

/// Columns side by side in it.
const ACROSS: usize = 13;

/// The same body, without friction and with C_r = 1.
fn lossless(body: Body) -> Body {
    Body { friction: 0.0, restitution: 1.0, ..body }
}

/// 2,000 spheres of 0.3 m, each velocity component up to 5 m/s, in a box 20 m across. With another count the box keeps the
/// gas about as dense.
pub fn elastic(size: Size) -> Scene {
    let count = size.count.unwrap_or(2000);
    let across = scaled_across(ACROSS, 2000, count).ceil().max(3.0);
    let half = HALF_BOX * across / ACROSS as f32;
    let mut bodies = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let (mut position, mut edges) = ([0.0; 3], [half + 2.0 * WALL; 3]);
            position[axis] = side * (half + WALL);
            edges[axis] = WALL;
            bodies.push(lossless(Body::fixed(position, cuboid(edges))));
        }
    }
    let mut random = Random::new(6);
    let columns = Columns { across: across as usize, spacing: 1.45, bottom: 0.0 };
    for mut place in columns.places(count, &mut random) {
        place[1] -= 0.8 * half;
        let velocity = random.triple(-5.0, 5.0);
        let sphere = Body::dynamic(place, Shape::Sphere { radius: 0.3 });
        bodies.push(lossless(Body { velocity, ..sphere }));
    }
    let bounds = Bounds { min: [-half - 0.1; 3], max: [half + 0.1; 3] };
    Scene { bodies, gravity: [0.0; 3], steps: 600, bounds }
}
