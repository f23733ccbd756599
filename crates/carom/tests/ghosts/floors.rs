//! The same flat ground, put together in several ways.

use super::*;
use carom::height_field::HeightField;
use std::sync::Arc;

/// How the ground is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Floor {
    /// One slab.
    Slab,
    /// Fixed bodies of a box each.
    Bodies,
    /// Boxes of one fixed body.
    Colliders,
    /// Tiles that are hulls, a body each.
    Hulls,
    /// Two triangles to a tile, with diagonals in both directions.
    Mesh,
    /// A height field whose heights are all the same.
    Field,
    /// Meshes of a tile each, a body each.
    Meshes,
}

pub const FLOORS: [Floor; 7] =
    [Floor::Slab, Floor::Bodies, Floor::Colliders, Floor::Hulls, Floor::Mesh, Floor::Field, Floor::Meshes];

/// Extent of a tile along x and z, m; no binary fraction.
pub const TILE: [f64; 2] = [0.7, 0.9];

/// Tiles along x and z.
const COUNT: [i32; 2] = [40, 16];

/// A frame of the ground: its top is the plane y = 0 there.
#[derive(Clone, Copy)]
pub struct Frame(pub Pose);

impl Frame {
    pub fn level() -> Self {
        Self(Pose::IDENTITY)
    }

    /// A frame of no special place, turned by that vector (rad).
    pub fn turned(by: DVec3) -> Self {
        let rotation = rotation_from_vector(by).as_quat().as_dquat().normalize();
        Self(Pose::new(DVec3::new(13.37, -4.21, 7.77), rotation))
    }

    pub fn place(&self, body: Body, local: Pose) -> Body {
        let pose = self.0.then_local(&local);
        let at = pose.position;
        body.at(at.x, at.y, at.z).rotated(pose.rotation.as_quat())
    }

    pub fn up(&self) -> DVec3 {
        self.0.rotation * DVec3::Y
    }
}

fn tiles() -> impl Iterator<Item = (i32, i32)> {
    (0..COUNT[0]).flat_map(|i| (0..COUNT[1]).map(move |j| (i - 4, j - COUNT[1] / 2)))
}

/// Low corner of a tile, of which no seam is at 0.
fn corner(i: i32, j: i32) -> DVec3 {
    DVec3::new(f64::from(i) * TILE[0] + 0.13, 0.0, f64::from(j) * TILE[1] + 0.31)
}

const DEPTH: f64 = 0.4;

fn block() -> Shape {
    Shape::cuboid(TILE[0], DEPTH, TILE[1])
}

fn hull() -> Shape {
    let corners: Vec<DVec3> = (0..8)
        .map(|bits| {
            let sign = |bit: u32| if bits & bit == 0 { -0.5 } else { 0.5 };
            DVec3::new(sign(1) * TILE[0], sign(2) * DEPTH, sign(4) * TILE[1])
        })
        .collect();
    Shape::hull(&corners).unwrap()
}

fn sheet(i: i32, j: i32) -> [[DVec3; 3]; 2] {
    let at = |i: i32, j: i32| corner(i, j);
    let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
    if (i + j) % 2 == 0 { [[a, c, b], [a, d, c]] } else { [[b, d, c], [b, a, d]] }
}

fn mesh(triangles: impl Iterator<Item = [DVec3; 3]>) -> Shape {
    let (mut vertices, mut faces) = (Vec::<DVec3>::new(), Vec::new());
    for triangle in triangles {
        let face = triangle.map(|corner| {
            let known = vertices.iter().position(|&vertex| vertex == corner);
            known.unwrap_or_else(|| {
                vertices.push(corner);
                vertices.len() - 1
            }) as u32
        });
        faces.push(face);
    }
    Shape::mesh(vertices, faces).unwrap()
}

impl Floor {
    /// Adds it to the world.
    pub fn lay(self, world: &mut World, frame: Frame, material: Material) {
        let middle = |i: i32, j: i32| corner(i, j) + 0.5 * DVec3::new(TILE[0], -DEPTH, TILE[1]);
        let whole = Pose::IDENTITY;
        let one = |shape: Shape| {
            let mut body = Body::fixed().with(shape);
            body.colliders.iter_mut().for_each(|collider| collider.material = material);
            body
        };
        let at = |place: DVec3| Pose::new(place, whole.rotation);
        match self {
            Floor::Slab => {
                world.add(frame.place(one(Shape::cuboid(100.0, 2.0, 100.0)), at(-DVec3::Y)));
            }
            Floor::Bodies => tiles().for_each(|(i, j)| {
                world.add(frame.place(one(block()), at(middle(i, j))));
            }),
            Floor::Hulls => tiles().for_each(|(i, j)| {
                world.add(frame.place(one(hull()), at(middle(i, j))));
            }),
            Floor::Colliders => {
                let mut body = Body::fixed();
                for (i, j) in tiles() {
                    let place = middle(i, j);
                    let mut collider = Collider::new(block()).at(place.x, place.y, place.z);
                    collider.material = material;
                    body = body.collider(collider);
                }
                world.add(frame.place(body, whole));
            }
            Floor::Mesh => {
                let shape = mesh(tiles().flat_map(|(i, j)| sheet(i, j)));
                world.add(frame.place(one(shape), whole));
            }
            Floor::Meshes => tiles().for_each(|(i, j)| {
                let shape = mesh(sheet(i, j).into_iter());
                world.add(frame.place(one(shape), whole));
            }),
            Floor::Field => {
                let [columns, rows] = COUNT.map(|count| count as usize + 1);
                let size = [f64::from(COUNT[0]) * TILE[0], f64::from(COUNT[1]) * TILE[1]];
                let field = HeightField::new(&vec![vec![0.0; columns]; rows], size).unwrap();
                let low = corner(-4, -COUNT[1] / 2);
                let place = low + DVec3::new(0.5 * size[0], 0.0, 0.5 * size[1]);
                world.add(frame.place(one(Shape::HeightField(Arc::new(field))), at(place)));
            }
        }
    }
}
