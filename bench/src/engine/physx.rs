//! PhysX on the processor, through physx-sys: a scene as `PxSceneDesc` describes it by default.
#![allow(unsafe_code)] // Every call of C++ is unsafe; what each needs is said where it is made.

use super::{Conditions, DT, Engine, Entry};
use crate::quality::Pose;
use crate::scene::{Body, DENSITY, Mesh, Shape};
use glam::DVec3;
use physx_sys as px;
use std::ffi::c_void;
use std::ptr::{from_ref, null, null_mut};
use std::sync::{Arc, OnceLock};

/// PhysX under its name.
pub const ENTRY: Entry = Entry {
    name: "physx",
    version: "PhysX 5.1.3, physx-sys 0.11.5",
    settings: "PxSceneDesc: PGS, 4 position iterations and 1 velocity iteration, patch friction; no damping",
    max_threads: 64,
    tells_phases: false,
    start,
};

/// What a process has one of; it lives as long as the process.
struct Kit(*mut px::PxPhysics);

// SAFETY: PhysX lets any thread make actors and scenes; each scene stays with the thread that made it.
unsafe impl Send for Kit {}
// SAFETY: likewise.
unsafe impl Sync for Kit {}

fn kit() -> *mut px::PxPhysics {
    static KIT: OnceLock<Kit> = OnceLock::new();
    // SAFETY: PhysX wants one foundation for a process, and gets it, once.
    KIT.get_or_init(|| Kit(unsafe { px::physx_create_physics(px::physx_create_foundation()) })).0
}

struct Physx {
    scene: *mut px::PxScene,
    dispatcher: *mut px::PxDefaultCpuDispatcher,
    bodies: Vec<Actor>,
    /// Hulls made so far, with the points they were made from.
    hulls: Vec<(Arc<[[f32; 3]]>, *mut px::PxConvexMesh)>,
    /// Surfaces made so far, with friction and restitution.
    surfaces: Vec<([f32; 2], *mut px::PxMaterial)>,
}

/// A body of the scene.
struct Actor {
    rigid: *mut px::PxRigidActor,
    fixed: bool,
}

fn start(conditions: Conditions) -> Box<dyn Engine> {
    // The thread that asks for a step only waits, unless there is no other.
    let workers = if conditions.threads == 1 { 0 } else { conditions.threads as u32 };
    // SAFETY: the description is PhysX's own with plain fields changed; the dispatcher outlives the scene.
    let (scene, dispatcher) = unsafe {
        let mut description = px::PxSceneDesc_new(px::PxPhysics_getTolerancesScale(kit()));
        let mode = px::PxDefaultCpuDispatcherWaitForWorkMode::WaitForWork;
        let dispatcher = px::phys_PxDefaultCpuDispatcherCreate(workers, null_mut(), mode, 0);
        description.gravity = vector(conditions.gravity);
        description.cpuDispatcher = dispatcher.cast();
        description.filterShader = px::get_default_simulation_filter_shader();
        (px::PxPhysics_createScene_mut(kit(), &description), dispatcher)
    };
    assert!(!scene.is_null(), "the description is sound");
    Box::new(Physx { scene, dispatcher, bodies: Vec::new(), hulls: Vec::new(), surfaces: Vec::new() })
}

fn vector([x, y, z]: [f32; 3]) -> px::PxVec3 {
    px::PxVec3 { x, y, z }
}

fn transform(position: [f32; 3], [x, y, z, w]: [f32; 4]) -> px::PxTransform {
    px::PxTransform { q: px::PxQuat { x, y, z, w }, p: vector(position) }
}

/// Tells PhysX where a list lies; the list has to outlive what it tells.
fn refer<T>(data: &mut px::PxBoundedData, items: &[T]) {
    data.stride = size_of::<T>() as u32;
    data.data = items.as_ptr().cast::<c_void>();
    data.count = items.len() as u32;
}

impl Physx {
    /// The hull of these points, made once for all bodies that share the list.
    fn hull(&mut self, points: &Arc<[[f32; 3]]>) -> *mut px::PxConvexMesh {
        if let Some((_, made)) = self.hulls.iter().find(|(of, _)| Arc::ptr_eq(of, points)) {
            return *made;
        }
        // SAFETY: the points outlive the call, which copies them; nobody asks why it failed.
        let made = unsafe {
            let parameters = px::PxCookingParams_new(px::PxPhysics_getTolerancesScale(kit()));
            let mut description = px::PxConvexMeshDesc_new();
            refer(&mut description.points, points);
            description.flags = px::PxConvexFlags::ComputeConvex;
            let insertion = px::PxPhysics_getPhysicsInsertionCallback_mut(kit());
            px::phys_PxCreateConvexMesh(&parameters, &description, insertion, null_mut())
        };
        assert!(!made.is_null(), "the scene's points span a hull");
        self.hulls.push((points.clone(), made));
        made
    }

    /// The surface with these coefficients, made once: PhysX has room for 65,536.
    fn surface(&mut self, friction: f32, restitution: f32) -> *mut px::PxMaterial {
        let coefficients = [friction, restitution];
        if let Some((_, made)) = self.surfaces.iter().find(|(of, _)| *of == coefficients) {
            return *made;
        }
        // SAFETY: the arguments are plain numbers.
        let made = unsafe { px::PxPhysics_createMaterial_mut(kit(), friction, friction, restitution) };
        self.surfaces.push((coefficients, made));
        made
    }

    /// The body with its form.
    fn rigid(&mut self, body: &Body) -> *mut px::PxRigidActor {
        const UPRIGHT: [f32; 4] = [0.0, 0.0, 0.0, 1.0];
        const H: f32 = std::f32::consts::FRAC_1_SQRT_2;
        let surface = self.surface(body.friction, body.restitution);
        // SAFETY: geometries are plain values; hulls and meshes are counted by whoever refers to them.
        unsafe {
            match &body.shape {
                Shape::Sphere { radius } => actor(body, surface, &px::PxSphereGeometry_new(*radius), UPRIGHT),
                Shape::Cuboid { half: [x, y, z] } => {
                    actor(body, surface, &px::PxBoxGeometry_new(*x, *y, *z), UPRIGHT)
                }
                // PhysX's lie along x.
                Shape::Capsule { half_height, radius } => {
                    let capsule = px::PxCapsuleGeometry_new(*radius, *half_height);
                    actor(body, surface, &capsule, [0.0, 0.0, H, H])
                }
                Shape::Hull(points) => {
                    let (scale, flags) = (px::PxMeshScale_new(), px::PxConvexMeshGeometryFlags::TightBounds);
                    let hull = px::PxConvexMeshGeometry_new(self.hull(points), &scale, flags);
                    actor(body, surface, &hull, UPRIGHT)
                }
                Shape::Mesh(form) => {
                    let (scale, flags) = (px::PxMeshScale_new(), px::PxMeshGeometryFlags::empty());
                    let mesh = px::PxTriangleMeshGeometry_new(mesh(form), &scale, flags);
                    actor(body, surface, &mesh, UPRIGHT)
                }
            }
        }
    }
}

fn mesh(mesh: &Mesh) -> *mut px::PxTriangleMesh {
    // SAFETY: the lists outlive the call, which copies them; nobody asks why it failed.
    let made = unsafe {
        let parameters = px::PxCookingParams_new(px::PxPhysics_getTolerancesScale(kit()));
        let mut description = px::PxTriangleMeshDesc_new();
        refer(&mut description.points, &mesh.vertices);
        refer(&mut description.triangles, &mesh.triangles);
        let insertion = px::PxPhysics_getPhysicsInsertionCallback_mut(kit());
        px::phys_PxCreateTriangleMesh(&parameters, &description, insertion, null_mut())
    };
    assert!(!made.is_null(), "the scene's triangles are sound");
    made
}

/// A body with that surface and that geometry, which lies turned in it.
///
/// # Safety
///
/// `G` is one of PhysX's classes of geometries, all of which begin with a `PxGeometry`.
unsafe fn actor<G>(
    body: &Body,
    surface: *mut px::PxMaterial,
    geometry: &G,
    turned: [f32; 4],
) -> *mut px::PxRigidActor {
    let (pose, offset) = (transform(body.position, body.rotation), transform([0.0; 3], turned));
    let geometry: *const px::PxGeometry = from_ref(geometry).cast();
    // SAFETY: what pointers lead to outlives the calls, which copy it.
    unsafe {
        if body.fixed {
            return px::phys_PxCreateStatic(kit(), &pose, geometry, surface, &offset).cast();
        }
        let made = px::phys_PxCreateDynamic(kit(), &pose, geometry, surface, DENSITY, &offset);
        px::PxRigidBody_setLinearDamping_mut(made.cast(), 0.0);
        px::PxRigidBody_setAngularDamping_mut(made.cast(), 0.0);
        px::PxRigidDynamic_setLinearVelocity_mut(made, &vector(body.velocity), true);
        // What moves at all is not to fall asleep.
        px::PxRigidDynamic_setSleepThreshold_mut(made, 0.0);
        made.cast()
    }
}

impl Engine for Physx {
    fn add(&mut self, body: &Body) {
        let rigid = self.rigid(body);
        assert!(!rigid.is_null(), "the scene's bodies are sound");
        // SAFETY: both are alive, and no step is under way.
        unsafe { px::PxScene_addActor_mut(self.scene, rigid.cast(), null()) };
        self.bodies.push(Actor { rigid, fixed: body.fixed });
    }

    fn step(&mut self) {
        let mut error = 0;
        // SAFETY: the scene is alive; no scratch memory is lent.
        unsafe {
            px::PxScene_simulate_mut(self.scene, DT as f32, null_mut(), null_mut(), 0, true);
            px::PxScene_fetchResults_mut(self.scene, true, &mut error);
        }
        assert_eq!(error, 0, "PhysX could not do the step");
    }

    fn pose(&self, body: usize) -> Pose {
        // SAFETY: bodies live as long as their world.
        let px::PxTransform { p, q } = unsafe { px::PxRigidActor_getGlobalPose(self.bodies[body].rigid) };
        Pose::from_single([p.x, p.y, p.z], [q.x, q.y, q.z, q.w])
    }

    fn velocity(&self, body: usize) -> DVec3 {
        let Actor { rigid, fixed } = &self.bodies[body];
        if *fixed {
            return DVec3::ZERO;
        }
        // SAFETY: bodies live as long as their world, and what is not fixed is a rigid body.
        let px::PxVec3 { x, y, z } = unsafe { px::PxRigidBody_getLinearVelocity(rigid.cast()) };
        DVec3::from_array([x, y, z].map(f64::from))
    }
}

impl Drop for Physx {
    fn drop(&mut self) {
        // SAFETY: bodies go before the scene, the scene before its dispatcher, each once; nothing uses them afterwards.
        unsafe {
            self.bodies.drain(..).for_each(|body| px::PxActor_release_mut(body.rigid.cast()));
            px::PxScene_release_mut(self.scene);
            px::PxDefaultCpuDispatcher_release_mut(self.dispatcher);
            self.hulls.drain(..).for_each(|(_, hull)| px::PxConvexMesh_release_mut(hull));
        }
    }
}
