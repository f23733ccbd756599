//! Bodies dropped on a surface of triangles.

use super::piles::{Columns, Mixture};
use super::random::Random;
use super::{Body, Bounds, EARTH, Mesh, Scene, Shape, Size};
use std::sync::Arc;

/// Quads of one metre along each side of the surface.
const QUADS: i32 = 128;

/// How high the hills are at (x, z), m.
fn height(x: f32, z: f32) -> f32 {
    2.0 * (x * 0.25).sin() * (z * 0.25).cos() + 0.5 * (x * 0.7 + z * 0.4).sin()
}

/// The hills as a mesh, two triangles to a quad.
fn surface() -> Mesh {
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    let index = |i: i32, j: i32| (j * (QUADS + 1) + i) as u32;
    for j in 0..=QUADS {
        for i in 0..=QUADS {
            let (x, z) = ((i - QUADS / 2) as f32, (j - QUADS / 2) as f32);
            vertices.push([x, height(x, z), z]);
            if i < QUADS && j < QUADS {
                triangles.push([index(i, j), index(i, j + 1), index(i + 1, j)]);
                triangles.push([index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)]);
            }
        }
    }
    Mesh { vertices, triangles }
}

/// 2,000 spheres, capsules, boxes and hulls in 32 × 32 columns above hills. Another count changes the layers only.
pub fn hills(size: Size) -> Scene {
    let count = size.count.unwrap_or(2000);
    let mut random = Random::new(4);
    let kinds = Mixture::new(&mut random);
    let mut bodies = vec![Body::fixed([0.0; 3], Shape::Mesh(Arc::new(surface())))];
    let columns = Columns { across: 32, spacing: 1.75, bottom: 4.5 };
    for (i, place) in columns.places(count, &mut random).into_iter().enumerate() {
        let shape = kinds.shape(i, &mut random);
        bodies.push(Body::dynamic(place, shape).rotated(random.rotation()));
    }
    let half = (QUADS / 2) as f32;
    let bounds = Bounds { min: [-half, -4.0, -half], max: [half, 1.0e9, half] };
    Scene { bodies, gravity: EARTH, steps: 400, bounds }
}
