//! Seams are no obstacles: what slides, rolls or falls onto flush tiles moves as on one plane. Real edges still collide,
//! and what passes by is left alone.

#[path = "ghosts/drops.rs"]
mod drops;
#[path = "ghosts/edges.rs"]
mod edges;
#[path = "ghosts/floors.rs"]
mod floors;
#[path = "ghosts/misses.rs"]
mod misses;
#[path = "ghosts/slides.rs"]
mod slides;

use carom::math::{Pose, rotation_from_vector};
use carom::prelude::*;
use carom::{BodyState, Settings};
use floors::{FLOORS, Floor, Frame};

const STEP: f64 = 1.0 / 60.0;
const G: f64 = 9.81;

/// What moves over the ground, and how high its middle is then, m.
struct Mover {
    name: &'static str,
    shape: Shape,
    height: f64,
    /// Turned so (rad), it lies.
    lies: DVec3,
}

fn movers() -> Vec<Mover> {
    let prism: Vec<DVec3> = (0..14)
        .map(|k| {
            let angle = f64::from(k / 2) * std::f64::consts::TAU / 7.0;
            DVec3::new(0.4 * angle.cos(), if k % 2 == 0 { -0.15 } else { 0.15 }, 0.4 * angle.sin())
        })
        .collect();
    let mover = |name, shape, height| Mover { name, shape, height, lies: DVec3::ZERO };
    vec![
        mover("box", Shape::cuboid(0.8, 0.3, 0.5), 0.15),
        mover("small box", Shape::cuboid(0.2, 0.2, 0.2), 0.1),
        mover("long box", Shape::cuboid(3.0, 0.2, 0.3), 0.1),
        mover("ball", Shape::sphere(0.3), 0.3),
        Mover {
            lies: DVec3::X * std::f64::consts::FRAC_PI_2,
            ..mover("capsule", Shape::capsule(0.6, 0.2), 0.2)
        },
        mover("hull", Shape::hull(&prism).unwrap(), 0.15),
        mover("cylinder", Shape::cylinder(0.3, 0.4), 0.15),
    ]
}

impl Mover {
    /// The mover on the ground of `frame`, its frame turned about the upward axis, with its middle over `place` (x, z) and
    /// its lowest point at that height.
    fn body(&self, frame: Frame, place: [f64; 2], (yaw, above): (f64, f64)) -> Body {
        let rotation = rotation_from_vector(DVec3::Y * yaw) * rotation_from_vector(self.lies);
        let at = DVec3::new(place[0], self.height + above, place[1]);
        frame.place(Body::dynamic().with(self.shape.clone()), Pose::new(at, rotation))
    }
}

fn coat(friction: f64, restitution: f64) -> Material {
    Material { static_friction: friction, dynamic_friction: friction, restitution, ..Material::default() }
}

fn coated(mut body: Body, material: Material) -> Body {
    body.colliders.iter_mut().for_each(|collider| collider.material = material);
    body
}

/// A world whose gravity pulls straight down onto the ground of `frame`.
fn world_over(frame: Frame) -> World {
    World::with_settings(Settings { gravity: frame.up() * -G, ..Settings::default() })
}

/// How far (rad) a body has turned from `first`.
fn turned(state: &BodyState, first: Quat) -> f64 {
    let turn = state.rotation().as_dquat() * first.as_dquat().normalize().conjugate();
    2.0 * turn.xyz().length().min(1.0).asin()
}

fn velocity(state: &BodyState) -> DVec3 {
    state.linear_velocity().as_dvec3()
}
