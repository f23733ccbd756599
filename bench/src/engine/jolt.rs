//! Jolt, through oxijolt: a default `PhysicsWorld`, with room for the scene's bodies.

use super::{Conditions, DT, Engine, Entry};
use crate::quality::Pose;
use crate::scene::{Body, Mesh, Shape};
use glam::DVec3;
use oxijolt::{BodyId, BodyRef, BodySettings, PhysicsWorld, Quat, RVec3, Vec3, WorldSettings};
use std::rc::Rc;
use std::sync::Arc;

/// Jolt under its name.
pub const ENTRY: Entry = Entry {
    name: "jolt",
    version: "Jolt 5.6.0, oxijolt 1.5.0",
    settings: "WorldSettings::default(): 10 velocity and 2 position iterations, 1 collision step; no damping",
    max_threads: WorldSettings::MAX_CONCURRENCY as usize,
    tells_phases: false,
    start,
};

/// Room for at least so many bodies: what Jolt has by itself.
const BODIES: u32 = 10_240;

/// Room for so many contacts for each body: more than boxes in a pile have, each of which meets about ten others.
const CONTACTS_PER_BODY: u32 = 16;

/// Pairs whose boxes meet, for each of those contacts.
const PAIRS_PER_CONTACT: u32 = 4;

/// Scratch memory for each of those contacts (bytes): Jolt takes it for as many as there is room for, but writes only to
/// what it needs.
const SCRATCH_PER_CONTACT: u32 = 1024;

struct Jolt {
    world: PhysicsWorld,
    bodies: Vec<BodyId>,
    /// Hulls made so far.
    hulls: Vec<Hull>,
}

/// A hull that bodies share.
struct Hull {
    /// The points that it was made from.
    points: Arc<[[f32; 3]]>,
    shape: Rc<oxijolt::Shape>,
}

fn start(conditions: Conditions) -> Box<dyn Engine> {
    let bodies = (conditions.bodies as u32).max(BODIES);
    let contacts = (CONTACTS_PER_BODY * bodies).min(WorldSettings::MAX_CONTACT_CONSTRAINTS);
    let settings = WorldSettings::default()
        .gravity(vector(conditions.gravity))
        .max_bodies(bodies)
        .max_contact_constraints(contacts)
        .max_body_pairs(PAIRS_PER_CONTACT * contacts)
        .temp_allocator_size(SCRATCH_PER_CONTACT * contacts);
    // The thread that asks for a step works, too.
    let settings = match conditions.threads {
        1 => settings.single_threaded(),
        threads => settings.worker_threads(threads as u32 - 1),
    };
    let world = PhysicsWorld::new(settings).expect("the settings are sound");
    Box::new(Jolt { world, bodies: Vec::new(), hulls: Vec::new() })
}

fn vector([x, y, z]: [f32; 3]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The mesh, whose edges between triangles that lie nearly in a plane are inactive by default: nothing catches on them.
fn mesh(mesh: &Mesh) -> oxijolt::Shape {
    let vertices: Vec<Vec3> = mesh.vertices.iter().map(|vertex| vector(*vertex)).collect();
    let (shape, dropped) =
        oxijolt::Shape::new_mesh(&vertices, &mesh.triangles).expect("the scene's triangles are sound");
    assert!(dropped.is_empty(), "the scene's triangles are large enough");
    shape
}

impl Jolt {
    /// The hull of these points, made once for all bodies that share the list.
    fn hull(&mut self, points: &Arc<[[f32; 3]]>) -> Rc<oxijolt::Shape> {
        if let Some(made) = self.hulls.iter().find(|hull| Arc::ptr_eq(&hull.points, points)) {
            return made.shape.clone();
        }
        let vectors: Vec<Vec3> = points.iter().map(|point| vector(*point)).collect();
        let shape = oxijolt::Shape::new_convex_hull(&vectors).expect("the scene's points span a hull");
        let shape = Rc::new(shape);
        self.hulls.push(Hull { points: points.clone(), shape: shape.clone() });
        shape
    }

    /// The form, of Jolt's own density, which is that of the scenes, and with its own rounding of edges: they lose up to
    /// 0.05 m for contacts, faces stay where they are.
    fn shape(&mut self, form: &Shape) -> Rc<oxijolt::Shape> {
        let made = match form {
            Shape::Sphere { radius } => oxijolt::Shape::new_sphere(*radius),
            Shape::Cuboid { half } => oxijolt::Shape::new_box(vector(*half)),
            Shape::Capsule { half_height, radius } => oxijolt::Shape::new_capsule(*half_height, *radius),
            Shape::Hull(points) => return self.hull(points),
            Shape::Mesh(form) => return Rc::new(mesh(form)),
        };
        Rc::new(made.expect("the scene's forms are sound"))
    }

    fn body(&self, body: usize) -> BodyRef<'_> {
        self.world.body(self.bodies[body]).expect("bodies live as long as their world")
    }
}

impl Engine for Jolt {
    fn add(&mut self, body: &Body) {
        let shape = self.shape(&body.shape);
        let ([x, y, z], [i, j, k, w]) = (body.position, body.rotation);
        let settings = if body.fixed { BodySettings::new_static() } else { BodySettings::new_dynamic() }
            .position(RVec3::new(x, y, z))
            .rotation(Quat::from_xyzw(i, j, k, w))
            .linear_velocity(vector(body.velocity))
            .friction(body.friction)
            .restitution(body.restitution)
            // Bodies lose 5 % of their velocity a second if nobody says otherwise; scenes are in a vacuum.
            .linear_damping(0.0)
            .angular_damping(0.0)
            .allow_sleeping(false);
        let id = self.world.create_body(&shape, &settings).expect("the scene's bodies are sound");
        self.bodies.push(id);
    }

    /// A tree to which bodies were added one by one is slow to search: 10,000 boxes made the first two steps four times as
    /// long as the others.
    fn ready(&mut self) {
        self.world.optimize_broad_phase();
    }

    fn step(&mut self) {
        let report = self.world.step(DT as f32).expect("the step's length is sound");
        assert!(report.is_complete(), "Jolt left out contacts for want of room: {report:?}");
    }

    fn pose(&self, body: usize) -> Pose {
        let body = self.body(body);
        let (position, rotation) = (body.position(), body.rotation());
        Pose::from_single(
            [position.x, position.y, position.z],
            [rotation.x, rotation.y, rotation.z, rotation.w],
        )
    }

    fn velocity(&self, body: usize) -> DVec3 {
        let Vec3 { x, y, z } = self.body(body).linear_velocity();
        DVec3::from_array([x, y, z].map(f64::from))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine;
    use crate::scene::{self, DENSITY, Size};

    /// One thread is a job system of its own; it does the same work.
    #[test]
    fn threads_change_no_bit() {
        let scene = (scene::find("pile_mixed").unwrap().build)(Size { count: Some(40), base: None });
        let ends = [1, 2].map(|threads| {
            let mut world = engine::load(&ENTRY, &scene, threads);
            (0..60).for_each(|_| world.step());
            (0..scene.bodies.len()).map(|body| world.velocity(body)).collect::<Vec<_>>()
        });
        assert_eq!(ends[0], ends[1]);
    }

    #[test]
    fn a_box_weighs_what_it_should() {
        let shape = oxijolt::Shape::new_box(Vec3::new(0.5, 1.0, 2.0)).unwrap();
        let mut world = PhysicsWorld::new(WorldSettings::default()).unwrap();
        let body = world.create_body(&shape, &BodySettings::new_dynamic()).unwrap();
        let mass = world.body(body).unwrap().mass().unwrap();
        assert!((mass / (8.0 * DENSITY) - 1.0).abs() < 1e-6, "{mass} kg");
    }
}
