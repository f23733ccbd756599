//! Every engine behind one small trait.
//!
//! A new engine is a file in `engine/` with its [`Entry`], a cargo feature, and a line in [`ENGINES`].

#[cfg(feature = "box3d")]
mod box3d;
mod carom;
#[cfg(feature = "jolt")]
mod jolt;
#[cfg(feature = "physx")]
mod physx;
#[cfg(feature = "rapier")]
mod rapier;

use crate::phase::Phase;
use crate::quality::Pose;
use crate::scene::{Body, Scene};
use glam::DVec3;

/// The length of every step, s.
pub const DT: f64 = 1.0 / 60.0;

/// A world of some engine, with its own default settings except that nothing may fall asleep.
pub trait Engine {
    /// Adds a body; bodies are numbered from 0 in the order in which they come.
    fn add(&mut self, body: &Body);

    /// All bodies are there: the place for what an engine's makers advise to do before the first step.
    fn ready(&mut self) {}

    /// Lets [`DT`] pass. Nothing else is timed.
    fn step(&mut self);

    /// Where the body's origin is and how it is turned.
    fn pose(&self, body: usize) -> Pose;

    /// The velocity of the body's centre of mass as the engine reports it, m/s.
    fn velocity(&self, body: usize) -> DVec3;

    /// What this thread's steps have spent their time on since this was asked before, in the order of a step; nothing
    /// from an engine that does not tell.
    fn phases(&mut self) -> Vec<Phase> {
        Vec::new()
    }
}

/// What a world has to know before the first body.
#[derive(Clone, Copy, Debug)]
pub struct Conditions {
    /// m/s²
    pub gravity: [f32; 3],
    /// How many threads step it, the calling one among them.
    pub threads: usize,
    /// How many bodies are to come; some engines have room for so many and no more.
    #[cfg_attr(not(feature = "jolt"), allow(dead_code, reason = "of these engines only Jolt asks"))]
    pub bodies: usize,
}

/// An engine that can be asked for by name.
pub struct Entry {
    /// What the command line calls it.
    pub name: &'static str,
    /// Name and version for people.
    pub version: &'static str,
    /// The settings that decide between speed and quality, in words.
    pub settings: &'static str,
    /// With how many threads it can run at most.
    pub max_threads: usize,
    /// Whether it tells what it spends its time on.
    pub tells_phases: bool,
    /// An empty world.
    pub start: fn(Conditions) -> Box<dyn Engine>,
}

/// All engines that are compiled in. Carom comes first: it is what the others are compared with.
pub const ENGINES: &[Entry] = &[
    carom::ENTRY,
    carom::WITH_LEDGER,
    #[cfg(feature = "rapier")]
    rapier::ENTRY,
    #[cfg(feature = "box3d")]
    box3d::ENTRY,
    #[cfg(feature = "jolt")]
    jolt::ENTRY,
    #[cfg(feature = "physx")]
    physx::ENTRY,
];

/// The engine of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    ENGINES.iter().find(|entry| entry.name == name)
}

/// Whether an engine of that name is one to measure Carom by, and not Carom itself with other settings.
pub fn is_peer(name: &str) -> bool {
    name.split('+').next() != Some("carom")
}

/// A world of this engine with the scene in it.
pub fn load(entry: &Entry, scene: &Scene, threads: usize) -> Box<dyn Engine> {
    let bodies = scene.bodies.len();
    let mut world = (entry.start)(Conditions { gravity: scene.gravity, threads, bodies });
    scene.bodies.iter().for_each(|body| world.add(body));
    world.ready();
    world
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quality::{Judge, Poses};
    use crate::scene::{self, Size};

    fn poses(world: &dyn Engine, scene: &Scene) -> Poses {
        Poses((0..scene.bodies.len()).map(|body| world.pose(body)).collect())
    }

    #[test]
    fn carom_is_no_peer_of_its_own() {
        let peers = ENGINES.iter().filter(|entry| is_peer(entry.name)).count();
        assert_eq!(peers, ENGINES.len() - 2);
    }

    /// Whatever the engine, it begins where the scene says, to single precision.
    #[test]
    fn every_engine_begins_where_the_scene_says() {
        for entry in ENGINES {
            for described in scene::SCENES {
                let scene = (described.build)(Size { count: Some(40), base: Some(4) });
                let world = load(entry, &scene, 1);
                let (found, wanted) = (poses(&*world, &scene), Poses::of_scene(&scene));
                for (i, (found, wanted)) in found.0.iter().zip(&wanted.0).enumerate() {
                    let name = format!("{} {} body {i}", entry.name, described.name);
                    assert!(found.position.distance(wanted.position) < 1e-5, "{name}");
                    assert!((found.rotation.dot(wanted.rotation).abs() - 1.0).abs() < 1e-6, "{name}");
                    let velocity = scene.bodies[i].velocity.map(f64::from);
                    assert!(world.velocity(i).distance(DVec3::from_array(velocity)) < 1e-5, "{name}");
                }
            }
        }
    }

    /// A small pyramid stands in every engine, and nothing sinks: shapes, friction and gravity have arrived.
    #[test]
    fn a_small_pyramid_stands_in_every_engine() {
        let scene = (scene::find("pyramid").unwrap().build)(Size { count: None, base: Some(4) });
        let judge = Judge::new(&scene);
        for entry in ENGINES {
            for threads in [1, 2].into_iter().filter(|threads| *threads <= entry.max_threads) {
                let mut world = load(entry, &scene, threads);
                for _ in 0..60 {
                    world.step();
                }
                let end = poses(&*world, &scene);
                assert!(judge.displacement(&end) < 0.02, "{}", entry.name);
                assert!(judge.overlap(&end).max < 0.01, "{}", entry.name);
                assert_eq!(judge.escaped(&end), 0, "{}", entry.name);
            }
        }
    }

    /// Bodies of all kinds fall by ½ g t² before anything meets: no engine got another gravity, step or damping.
    #[test]
    fn everything_falls_alike() {
        let scene = (scene::find("pile_mixed").unwrap().build)(Size { count: Some(4), base: None });
        for entry in ENGINES {
            let mut world = load(entry, &scene, 1);
            for _ in 0..15 {
                world.step();
            }
            let fallen = 0.5 * 9.81 * 0.25_f64.powi(2);
            for (i, (start, end)) in
                Poses::of_scene(&scene).0.iter().zip(poses(&*world, &scene).0).enumerate()
            {
                if !scene.bodies[i].fixed {
                    let found = start.position.y - end.position.y;
                    // Semi-implicit steps fall a little farther: a quarter of a second of 4 substeps by 5 mm, of one by 20.
                    assert!((found - fallen).abs() < 0.03, "{} body {i}: {found} m", entry.name);
                }
            }
        }
    }
}
