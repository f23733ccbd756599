//! Box3D, through its C interface: the default world with four substeps, as its manual and samples have it.
#![allow(unsafe_code)] // Every call of C is unsafe; what each needs is said where it is made.

use super::{Conditions, DT, Engine, Entry};
use crate::quality::Pose;
use crate::scene::{Body, DENSITY, Mesh, Shape};
use box3d_sys as c;
use glam::DVec3;
use std::ptr::null_mut;
use std::sync::Arc;

/// Box3D under its name.
pub const ENTRY: Entry = Entry {
    name: "box3d",
    version: "Box3D 0.1, box3d-sys 0.1.16",
    settings: "b3DefaultWorldDef(): contacts of 30 Hz; 4 substeps",
    max_threads: c::B3_MAX_WORKERS as usize,
    tells_phases: false,
    start,
};

/// Substeps of a step: not a setting of the world but an argument that has no default; 4 is what its makers use.
const SUBSTEPS: i32 = 4;

struct Box3d {
    world: c::b3WorldId,
    bodies: Vec<c::b3BodyId>,
    /// Hulls made so far, with the points they were made from.
    hulls: Vec<(Arc<[[f32; 3]]>, *mut c::b3HullData)>,
    /// Meshes that the world refers to.
    meshes: Vec<*mut c::b3MeshData>,
}

fn start(conditions: Conditions) -> Box<dyn Engine> {
    // SAFETY: the definition is Box3D's own, with plain numbers changed.
    let world = unsafe {
        let mut definition = c::b3DefaultWorldDef();
        definition.gravity = vector(conditions.gravity);
        definition.enableSleep = false;
        definition.workerCount = conditions.threads as u32;
        c::b3CreateWorld(&definition)
    };
    Box::new(Box3d { world, bodies: Vec::new(), hulls: Vec::new(), meshes: Vec::new() })
}

fn vector([x, y, z]: [f32; 3]) -> c::b3Vec3 {
    c::b3Vec3 { x, y, z }
}

fn array(v: c::b3Vec3) -> [f32; 3] {
    [v.x, v.y, v.z]
}

impl Box3d {
    /// The hull of these points, made once for all bodies that share the list.
    fn hull(&mut self, points: &Arc<[[f32; 3]]>) -> *mut c::b3HullData {
        if let Some((_, made)) = self.hulls.iter().find(|(of, _)| Arc::ptr_eq(of, points)) {
            return *made;
        }
        let vectors: Vec<c::b3Vec3> = points.iter().map(|point| vector(*point)).collect();
        let count = vectors.len() as i32;
        // SAFETY: `count` vectors lie behind the pointer, and Box3D copies what it keeps.
        let made = unsafe { c::b3CreateHull(vectors.as_ptr(), count, count) };
        assert!(!made.is_null(), "the scene's points span a hull");
        self.hulls.push((points.clone(), made));
        made
    }

    /// The mesh, which lives as long as this world.
    fn mesh(&mut self, mesh: &Mesh) -> *mut c::b3MeshData {
        let mut vertices: Vec<c::b3Vec3> = mesh.vertices.iter().map(|vertex| vector(*vertex)).collect();
        let mut indices: Vec<i32> = mesh.triangles.iter().flatten().map(|index| *index as i32).collect();
        let definition = c::b3MeshDef {
            vertices: vertices.as_mut_ptr(),
            indices: indices.as_mut_ptr(),
            vertexCount: vertices.len() as i32,
            triangleCount: mesh.triangles.len() as i32,
            // Without it bodies catch on the edges between triangles.
            identifyEdges: true,
            ..Default::default()
        };
        // SAFETY: the arrays hold what the counts say and outlive the call, which copies them; no list of degenerate
        // triangles is asked for.
        let made = unsafe { c::b3CreateMesh(&definition, null_mut(), 0) };
        assert!(!made.is_null(), "the scene's triangles are sound");
        self.meshes.push(made);
        made
    }

    /// Gives a body its shape.
    fn attach(&mut self, body: c::b3BodyId, form: &Shape, definition: &c::b3ShapeDef) {
        // What all calls need: `body` has just been made in this world; shapes and definitions are read during the call;
        // hulls are copied, and meshes are destroyed after the world.
        match form {
            Shape::Sphere { radius } => {
                let sphere = c::b3Sphere { center: vector([0.0; 3]), radius: *radius };
                // SAFETY: see above.
                unsafe { c::b3CreateSphereShape(body, definition, &sphere) };
            }
            Shape::Capsule { half_height, radius } => {
                let [center1, center2] = [-half_height, *half_height].map(|y| vector([0.0, y, 0.0]));
                let capsule = c::b3Capsule { center1, center2, radius: *radius };
                // SAFETY: see above.
                unsafe { c::b3CreateCapsuleShape(body, definition, &capsule) };
            }
            Shape::Cuboid { half: [x, y, z] } => {
                // SAFETY: see above; a box begins with the hull's header, and its corners and faces follow.
                unsafe {
                    let hull = c::b3MakeBoxHull(*x, *y, *z);
                    c::b3CreateHullShape(body, definition, (&raw const hull).cast());
                }
            }
            Shape::Hull(points) => {
                let hull = self.hull(points);
                // SAFETY: see above.
                unsafe { c::b3CreateHullShape(body, definition, hull) };
            }
            Shape::Mesh(mesh) => {
                let mesh = self.mesh(mesh);
                // SAFETY: see above.
                unsafe { c::b3CreateMeshShape(body, definition, mesh, vector([1.0; 3])) };
            }
        }
    }
}

impl Engine for Box3d {
    fn add(&mut self, body: &Body) {
        let [x, y, z, w] = body.rotation;
        // SAFETY: the definitions are Box3D's own with plain numbers changed, and the world is alive.
        let (id, surface) = unsafe {
            let mut definition = c::b3DefaultBodyDef();
            definition.type_ =
                if body.fixed { c::b3BodyType_b3_staticBody } else { c::b3BodyType_b3_dynamicBody };
            definition.position = vector(body.position);
            definition.rotation = c::b3Quat { v: vector([x, y, z]), s: w };
            definition.linearVelocity = vector(body.velocity);
            let mut surface = c::b3DefaultShapeDef();
            surface.density = DENSITY;
            surface.baseMaterial.friction = body.friction;
            surface.baseMaterial.restitution = body.restitution;
            (c::b3CreateBody(self.world, &definition), surface)
        };
        self.attach(id, &body.shape, &surface);
        self.bodies.push(id);
    }

    fn step(&mut self) {
        // SAFETY: the world is alive, and nobody else uses it.
        unsafe { c::b3World_Step(self.world, DT as f32, SUBSTEPS) }
    }

    fn pose(&self, body: usize) -> Pose {
        // SAFETY: bodies live as long as their world.
        let (position, rotation) =
            unsafe { (c::b3Body_GetPosition(self.bodies[body]), c::b3Body_GetRotation(self.bodies[body])) };
        let [x, y, z] = array(rotation.v);
        Pose::from_single(array(position), [x, y, z, rotation.s])
    }

    fn velocity(&self, body: usize) -> DVec3 {
        // SAFETY: bodies live as long as their world.
        let velocity = unsafe { c::b3Body_GetLinearVelocity(self.bodies[body]) };
        DVec3::from_array(array(velocity).map(f64::from))
    }
}

impl Drop for Box3d {
    fn drop(&mut self) {
        // SAFETY: the world goes first, so nothing refers to a hull or a mesh when it is freed, once.
        unsafe {
            c::b3DestroyWorld(self.world);
            self.hulls.drain(..).for_each(|(_, hull)| c::b3DestroyHull(hull));
            self.meshes.drain(..).for_each(|mesh| c::b3DestroyMesh(mesh));
        }
    }
}
