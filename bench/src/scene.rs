//! What is simulated: described once, in single precision, and handed to every engine alike.
//!
//! SI units, y up, quaternions `[x, y, z, w]`. Numbers are single precision because that is what most engines keep: nobody
//! rounds another scene than the others.

mod catalogue;
mod gas;
mod packed;
mod piles;
mod pyramids;
mod random;
mod terrain;

pub use catalogue::{DEFAULT_SCENES, Entry, Growth, SCENES, SIZES_SCENES, find};

use std::sync::Arc;

/// Gravity where there is any, m/s².
const EARTH: [f32; 3] = [0.0, -9.81, 0.0];

/// Coulomb's coefficient where a scene does not say otherwise.
pub const FRICTION: f32 = 0.5;

/// What every body is made of, kg/m³.
pub const DENSITY: f32 = 1000.0;

/// A form, centred on its own origin.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// m
        radius: f32,
    },
    /// A box with its edges along the axes.
    Cuboid {
        /// Half of each edge, m.
        half: [f32; 3],
    },
    /// All points within `radius` of a segment along y.
    Capsule {
        /// Half the segment's length, m.
        half_height: f32,
        /// m
        radius: f32,
    },
    /// The convex hull of these points (m), each of them a vertex. Bodies that share a hull share the list.
    Hull(Arc<[[f32; 3]]>),
    /// A surface of triangles. For fixed bodies.
    Mesh(Arc<Mesh>),
}

/// A surface: every triangle is wound counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// m
    pub vertices: Vec<[f32; 3]>,
    /// Indices of vertices.
    pub triangles: Vec<[u32; 3]>,
}

/// A body before it joins an engine's world.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Fixed bodies stay where they are; all others are dynamic.
    pub fixed: bool,
    /// Of its origin, m.
    pub position: [f32; 3],
    /// Turns its frame into the world's.
    pub rotation: [f32; 4],
    /// Of its centre of mass, m/s.
    pub velocity: [f32; 3],
    /// Its form; it weighs [`DENSITY`].
    pub shape: Shape,
    /// Coulomb's coefficient.
    pub friction: f32,
    /// Parting speed over closing speed.
    pub restitution: f32,
}

impl Body {
    /// A dynamic body at rest, upright, that does not bounce.
    fn dynamic(position: [f32; 3], shape: Shape) -> Self {
        let rotation = [0.0, 0.0, 0.0, 1.0];
        Self {
            fixed: false,
            position,
            rotation,
            velocity: [0.0; 3],
            shape,
            friction: FRICTION,
            restitution: 0.0,
        }
    }

    /// A body that nothing moves.
    fn fixed(position: [f32; 3], shape: Shape) -> Self {
        Self { fixed: true, ..Self::dynamic(position, shape) }
    }

    /// The same body, turned.
    fn rotated(self, rotation: [f32; 4]) -> Self {
        Self { rotation, ..self }
    }
}

/// A region of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Its lowest corner, m.
    pub min: [f32; 3],
    /// Its highest corner, m.
    pub max: [f32; 3],
}

/// Everything that an engine is told, and for how long it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// All bodies, in the order in which engines get them.
    pub bodies: Vec<Body>,
    /// m/s²
    pub gravity: [f32; 3],
    /// How many steps of 1/60 s belong to the scene.
    pub steps: usize,
    /// A dynamic body whose origin leaves these has escaped.
    pub bounds: Bounds,
}

impl Scene {
    /// Gives every surface that rubs this friction; what is frictionless stays so.
    pub fn set_friction(&mut self, friction: f32) {
        self.bodies.iter_mut().filter(|body| body.friction > 0.0).for_each(|body| body.friction = friction);
    }

    /// Where the highest dynamic body starts, m above y = 0.
    pub fn height(&self) -> f64 {
        let dynamic = self.bodies.iter().filter(|body| !body.fixed);
        dynamic.map(|body| f64::from(body.position[1])).fold(0.0, f64::max)
    }

    /// How many bodies move.
    pub fn dynamic_count(&self) -> usize {
        self.bodies.iter().filter(|body| !body.fixed).count()
    }
}

/// How large a scene is to be; what is not given is as the scene has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// Dynamic bodies of piles, terrain and gas.
    pub count: Option<usize>,
    /// Boxes in a pyramid's lowest course.
    pub base: Option<usize>,
}

/// Half of a box's edges as a shape.
fn cuboid(half: [f32; 3]) -> Shape {
    Shape::Cuboid { half }
}

/// A square of ground, its top at y = 0.
fn ground(half: f32) -> Body {
    Body::fixed([0.0, -1.0, 0.0], cuboid([half, 1.0, half]))
}

/// Everything above a square of ground, however high.
fn above_ground(half: f32) -> Bounds {
    Bounds { min: [-half, -0.5, -half], max: [half, 1.0e9, half] }
}

/// How many columns side by side keep the proportions of `across` columns with `nominal` bodies when there are `count`.
fn scaled_across(across: usize, nominal: usize, count: usize) -> f32 {
    (across as f64 * (count as f64 / nominal as f64).cbrt()) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FNV-1a over everything that an engine is told.
    fn fingerprint(scene: &Scene) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut eat = |value: f32| {
            for byte in value.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        for body in &scene.bodies {
            body.position.into_iter().chain(body.rotation).chain(body.velocity).for_each(&mut eat);
            eat(body.friction);
            eat(body.restitution);
            match &body.shape {
                Shape::Sphere { radius } => eat(*radius),
                Shape::Cuboid { half } => half.iter().copied().for_each(&mut eat),
                Shape::Capsule { half_height, radius } => {
                    [*half_height, *radius].into_iter().for_each(&mut eat)
                }
                Shape::Hull(points) => points.iter().flatten().copied().for_each(&mut eat),
                Shape::Mesh(mesh) => mesh.vertices.iter().flatten().copied().for_each(&mut eat),
            }
        }
        hash
    }

    #[test]
    fn a_scene_is_the_same_every_time() {
        for entry in SCENES {
            let size = Size { count: Some(50), base: Some(6) };
            assert_eq!((entry.build)(size), (entry.build)(size), "{}", entry.name);
        }
    }

    /// Figures of different days compare only if the scene has not changed by a bit. No transcendental function is behind
    /// these two, so they are the same on every platform.
    #[test]
    fn scenes_of_record_have_not_changed() {
        assert_eq!(fingerprint(&(find("pyramid").unwrap().build)(Size::default())), PYRAMID);
        assert_eq!(fingerprint(&(find("pile_boxes").unwrap().build)(Size::default())), PILE_BOXES);
    }

    const PYRAMID: u64 = 0xcb1c_0757_30a4_c14c;
    const PILE_BOXES: u64 = 0x5742_a404_01b1_82eb;

    #[test]
    fn what_is_frictionless_stays_so() {
        let mut gas = (find("elastic_gas").unwrap().build)(Size { count: Some(2), base: None });
        gas.set_friction(0.7);
        assert!(gas.bodies.iter().all(|body| body.friction == 0.0));
        let mut pile = (find("pile_boxes").unwrap().build)(Size { count: Some(2), base: None });
        pile.set_friction(0.7);
        assert!(pile.bodies.iter().all(|body| body.friction == 0.7));
    }
}
