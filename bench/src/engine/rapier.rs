//! Rapier: a default `PhysicsWorld`, built with the feature `parallel`.

use super::{Conditions, DT, Engine, Entry};
use crate::quality::Pose;
use crate::scene::{Body, DENSITY, Shape};
use glam::DVec3;
use rapier3d::math::{Pose as RapierPose, Rotation, Vector};
use rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, SharedShape, TriMeshFlags,
};
use std::sync::Arc;

/// Rapier under its name.
pub const ENTRY: Entry = Entry {
    name: "rapier",
    version: "rapier3d 0.36.1, feature parallel",
    settings: "IntegrationParameters::default(): 4 solver iterations, contacts of 30 Hz (60 Hz against fixed bodies)",
    max_threads: usize::MAX,
    tells_phases: false,
    start,
};

struct Rapier {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    /// Hulls made so far, with the points they were made from.
    hulls: Vec<(Arc<[[f32; 3]]>, SharedShape)>,
}

fn start(conditions: Conditions) -> Box<dyn Engine> {
    let gravity = Vector::from_array(conditions.gravity);
    let mut world = PhysicsWorld { gravity, ..PhysicsWorld::default() };
    world.integration_parameters.dt = DT as f32;
    world.configure_thread_pool(conditions.threads).expect("threads can be started");
    Box::new(Rapier { world, bodies: Vec::new(), hulls: Vec::new() })
}

impl Rapier {
    /// The hull of these points, made once for all bodies that share the list.
    fn hull(&mut self, points: &Arc<[[f32; 3]]>) -> SharedShape {
        if let Some((_, made)) = self.hulls.iter().find(|(of, _)| Arc::ptr_eq(of, points)) {
            return made.clone();
        }
        let vectors: Vec<Vector> = points.iter().map(|point| Vector::from_array(*point)).collect();
        let made = SharedShape::convex_hull(&vectors).expect("the scene's points span a hull");
        self.hulls.push((points.clone(), made.clone()));
        made
    }

    fn collider(&mut self, shape: &Shape) -> ColliderBuilder {
        match shape {
            Shape::Sphere { radius } => ColliderBuilder::ball(*radius),
            Shape::Cuboid { half: [x, y, z] } => ColliderBuilder::cuboid(*x, *y, *z),
            Shape::Capsule { half_height, radius } => ColliderBuilder::capsule_y(*half_height, *radius),
            Shape::Hull(points) => ColliderBuilder::new(self.hull(points)),
            Shape::Mesh(mesh) => {
                let vertices = mesh.vertices.iter().map(|vertex| Vector::from_array(*vertex)).collect();
                // Without the flag bodies catch on the edges between triangles.
                let flags = TriMeshFlags::FIX_INTERNAL_EDGES;
                ColliderBuilder::trimesh_with_flags(vertices, mesh.triangles.clone(), flags)
                    .expect("the scene's triangles are sound")
            }
        }
    }
}

impl Engine for Rapier {
    fn add(&mut self, body: &Body) {
        let [x, y, z, w] = body.rotation;
        let pose = RapierPose::from_parts(Vector::from_array(body.position), Rotation::from_xyzw(x, y, z, w));
        let builder = if body.fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
        let builder = builder.pose(pose).linvel(Vector::from_array(body.velocity)).can_sleep(false);
        let collider =
            self.collider(&body.shape).density(DENSITY).friction(body.friction).restitution(body.restitution);
        let (handle, _) = self.world.insert(builder, collider);
        self.bodies.push(handle);
    }

    fn step(&mut self) {
        self.world.step();
    }

    fn pose(&self, body: usize) -> Pose {
        let pose = self.world.bodies[self.bodies[body]].position();
        Pose::from_single(pose.translation.to_array(), pose.rotation.to_array())
    }

    fn velocity(&self, body: usize) -> DVec3 {
        DVec3::from_array(self.world.bodies[self.bodies[body]].linvel().to_array().map(f64::from))
    }
}
