//! Carom, as everybody gets it.

use super::{Conditions, DT, Engine, Entry};
use crate::quality::Pose;
use crate::scene::{Body, DENSITY, Shape};
use carom::math::{DVec3, Quat};
use carom::{BodyId, Settings, World};

/// Carom under its name.
pub const ENTRY: Entry = Entry {
    name: "carom",
    version: "carom, this checkout",
    settings: "Settings::default(): 2 substeps",
    max_threads: u32::MAX as usize,
    tells_phases: cfg!(feature = "profile"),
    start,
};

/// The same, with its books kept: what the ledger costs.
pub const WITH_LEDGER: Entry = Entry {
    name: "carom+ledger",
    version: "carom, this checkout",
    settings: "Settings::default() and ledger: true",
    start: |conditions| {
        let mut world = world(conditions);
        world.keep_ledger(true);
        Box::new(Carom { world, bodies: Vec::new() })
    },
    ..ENTRY
};

struct Carom {
    world: World,
    bodies: Vec<BodyId>,
}

fn start(conditions: Conditions) -> Box<dyn Engine> {
    Box::new(Carom { world: world(conditions), bodies: Vec::new() })
}

fn world(conditions: Conditions) -> World {
    let (gravity, threads) = (wide(conditions.gravity), conditions.threads as u32);
    World::with_settings(Settings { gravity, threads, ..Settings::default() })
}

fn wide(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

fn shape(shape: &Shape) -> carom::Shape {
    match shape {
        Shape::Sphere { radius } => carom::Shape::sphere(f64::from(*radius)),
        Shape::Cuboid { half } => {
            let [x, y, z] = half.map(|half| 2.0 * f64::from(half));
            carom::Shape::cuboid(x, y, z)
        }
        Shape::Capsule { half_height, radius } => {
            carom::Shape::capsule(2.0 * f64::from(*half_height), f64::from(*radius))
        }
        Shape::Hull(points) => {
            let points: Vec<DVec3> = points.iter().map(|point| wide(*point)).collect();
            carom::Shape::hull(&points).expect("the scene's points span a hull")
        }
        Shape::Mesh(mesh) => {
            let vertices = mesh.vertices.iter().map(|vertex| wide(*vertex)).collect();
            carom::Shape::mesh(vertices, mesh.triangles.clone()).expect("the scene's triangles are sound")
        }
    }
}

impl Engine for Carom {
    fn add(&mut self, body: &Body) {
        let [x, y, z] = body.position.map(f64::from);
        let [vx, vy, vz] = body.velocity;
        let mut collider = carom::Collider::new(shape(&body.shape));
        collider.density = f64::from(DENSITY);
        let written = if body.fixed { carom::Body::fixed() } else { carom::Body::dynamic() }
            .at(x, y, z)
            .rotated(Quat::from_array(body.rotation))
            .moving(vx, vy, vz)
            .collider(collider)
            .friction(f64::from(body.friction))
            .restitution(f64::from(body.restitution));
        self.bodies.push(self.world.add(written));
    }

    fn step(&mut self) {
        self.world.step(DT);
    }

    fn pose(&self, body: usize) -> Pose {
        let state = &self.world[self.bodies[body]];
        Pose { position: state.position(), rotation: state.rotation().as_dquat().normalize() }
    }

    fn velocity(&self, body: usize) -> DVec3 {
        self.world[self.bodies[body]].linear_velocity().as_dvec3()
    }

    #[cfg(feature = "profile")]
    fn phases(&mut self) -> Vec<crate::phase::Phase> {
        let told = |spent: carom::profile::Spent| crate::phase::Phase {
            name: name(spent.phase).to_string(),
            ms: spent.time.as_secs_f64() * 1e3,
            calls: spent.calls,
        };
        carom::profile::take().into_iter().map(told).collect()
    }
}

/// A phase for people.
#[cfg(feature = "profile")]
fn name(phase: carom::profile::Phase) -> &'static str {
    use carom::profile::Phase;
    match phase {
        Phase::Other => "other",
        Phase::Find => "find: broad phase",
        Phase::Crowds => "find: crowds",
        Phase::Watch => "find: pairs to watch",
        Phase::Adopt => "contacts: come to rest",
        Phase::Renew => "contacts: made, renewed",
        Phase::Measure => "contacts: measured",
        Phase::Solve => "solve: islands, choice",
        Phase::Sweep => "solve: sweeps",
        Phase::Direct => "solve: directly",
        Phase::Give => "give: impulses to paths",
        Phase::Ask => "happen: time of impact",
        Phase::Strike => "happen: touches, strikes",
        Phase::Fly => "fly: advance",
        Phase::PushOut => "finish: push out",
        Phase::Finish => "finish: publish, report",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine;
    use crate::quality::{Judge, Poses};
    use crate::scene::{self, Size};

    #[test]
    fn the_world_gets_as_many_threads_as_were_asked_for() {
        for threads in [1, 2, 3] {
            let world = world(Conditions { gravity: [0.0; 3], threads, bodies: 0 });
            assert_eq!(world.settings().threads as usize, threads);
        }
    }

    /// However many threads step it, a pile ends with the same bits.
    #[test]
    fn threads_change_no_bit() {
        let scene = (scene::find("pile_mixed").unwrap().build)(Size { count: Some(40), base: None });
        let hashes = [1, 2].map(|threads| {
            let mut world = engine::load(&ENTRY, &scene, threads);
            (0..60).for_each(|_| world.step());
            let end = Poses((0..scene.bodies.len()).map(|body| world.pose(body)).collect());
            Judge::new(&scene).hash(&end)
        });
        assert_eq!(hashes[0], hashes[1]);
    }
}
