//! How good the result is, from poses alone: the same code for every engine, and in double precision.
//!
//! | file | what it does |
//! |---|---|
//! | `convex` | how deep two convex solids overlap, exactly |
//! | `solid` | the faces, edges, volume and centre of a scene's shapes |
//! | `overlap` | which bodies overlap, and how deep |
//! | `motion` | how fast bodies are, from one step to the next |

mod convex;
mod motion;
mod overlap;
mod solid;

pub use motion::{Motion, Settling, Watch};
pub use overlap::Overlap;

use crate::scene::{DENSITY, Scene};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use solid::Solid;

/// Where a body's frame lies in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Of the origin, m.
    pub position: DVec3,
    /// Turns the frame's axes into the world's.
    pub rotation: DQuat,
}

impl Pose {
    /// A pose in single precision, as most engines keep it; the rotation is brought back to unit length.
    pub fn from_single(position: [f32; 3], rotation: [f32; 4]) -> Self {
        let rotation = DQuat::from_array(rotation.map(f64::from)).normalize();
        Self { position: DVec3::from_array(position.map(f64::from)), rotation }
    }

    /// A point of the body's frame in the world.
    fn point(&self, local: DVec3) -> DVec3 {
        self.position + self.rotation * local
    }

    fn is_finite(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite()
    }
}

/// The poses of all bodies of a scene, in its order.
#[derive(Clone, Debug)]
pub struct Poses(pub Vec<Pose>);

impl Poses {
    /// Where the scene begins.
    pub fn of_scene(scene: &Scene) -> Self {
        Self(scene.bodies.iter().map(|body| Pose::from_single(body.position, body.rotation)).collect())
    }
}

/// The figures of one measurement.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Quality {
    /// How deep bodies are in each other after the last step.
    pub overlap: Overlap,
    /// The farthest that any body has come from where it began, m.
    pub displacement_max: f64,
    /// Bodies outside the scene's bounds, or at no finite place.
    pub escaped: usize,
    /// How fast bodies were over the last second.
    pub motion: Motion,
    /// The largest speed that the engine itself reports after the last step, m/s.
    pub reported_speed_max: f64,
    /// Energy before the first step.
    pub energy_start: Energy,
    /// Energy after the last step.
    pub energy_end: Energy,
    /// FNV-1a of all final poses, in hexadecimal: equal for equal bits.
    pub hash: String,
}

/// Energy of the dynamic bodies, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Of the centres of mass, ½ m v², with the velocities that the engine reports. Turning is left out.
    pub kinetic: f64,
    /// −m g·x of the centres of mass, from the world's origin.
    pub potential: f64,
}

/// What is kept of each body while an engine runs: little, so that peak memory is the engine's.
struct Subject {
    dynamic: bool,
    /// Mass, kg, by our own reckoning.
    mass: f64,
    /// Centre of mass, body frame, m.
    center: DVec3,
    /// Farthest point from the centre of mass, m.
    reach: f64,
}

/// Judges poses of one scene.
pub struct Judge<'a> {
    scene: &'a Scene,
    subjects: Vec<Subject>,
    start: Poses,
}

impl<'a> Judge<'a> {
    /// Learns the scene's shapes.
    pub fn new(scene: &'a Scene) -> Self {
        let subjects = scene.bodies.iter().map(|body| {
            let solid = Solid::of(&body.shape);
            Subject {
                dynamic: !body.fixed,
                mass: f64::from(DENSITY) * solid.volume,
                center: solid.center,
                reach: solid.reach,
            }
        });
        Self { scene, subjects: subjects.collect(), start: Poses::of_scene(scene) }
    }

    /// How many bodies the scene has, fixed ones among them.
    pub fn bodies(&self) -> usize {
        self.subjects.len()
    }

    /// How deep bodies are in each other. What nothing moves does not count against itself.
    pub fn overlap(&self, poses: &Poses) -> Overlap {
        overlap::measure(self.scene, poses)
    }

    /// How many dynamic bodies are outside the scene's bounds, or at no finite place.
    pub fn escaped(&self, poses: &Poses) -> usize {
        let [min, max] = [self.scene.bounds.min, self.scene.bounds.max]
            .map(|corner| DVec3::from_array(corner.map(f64::from)));
        let inside = |pose: &Pose| {
            pose.is_finite() && pose.position.cmpge(min).all() && pose.position.cmple(max).all()
        };
        self.dynamic(poses).filter(|(_, pose)| !inside(pose)).count()
    }

    /// The farthest that any body is from where the scene began, m.
    pub fn displacement(&self, poses: &Poses) -> f64 {
        let moved = self.subjects.iter().zip(&self.start.0).zip(&poses.0);
        moved
            .filter(|((subject, _), pose)| subject.dynamic && pose.is_finite())
            .map(|((_, start), pose)| start.position.distance(pose.position))
            .fold(0.0, f64::max)
    }

    /// The energy in these poses with these velocities (m/s, of the centres of mass).
    pub fn energy(&self, poses: &Poses, velocities: &[DVec3]) -> Energy {
        let gravity = DVec3::from_array(self.scene.gravity.map(f64::from));
        let mut energy = Energy::default();
        let bodies = self.subjects.iter().zip(&poses.0).zip(velocities);
        for ((subject, pose), velocity) in
            bodies.filter(|((subject, pose), _)| subject.dynamic && pose.is_finite())
        {
            energy.kinetic += 0.5 * subject.mass * velocity.length_squared();
            energy.potential -= subject.mass * gravity.dot(pose.point(subject.center));
        }
        energy
    }

    /// A fingerprint of the poses: equal for equal bits.
    pub fn hash(&self, poses: &Poses) -> String {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for (_, pose) in self.dynamic(poses) {
            for value in pose.position.to_array().into_iter().chain(pose.rotation.to_array()) {
                for byte in value.to_bits().to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
                }
            }
        }
        format!("{hash:016x}")
    }

    fn dynamic<'b>(&'b self, poses: &'b Poses) -> impl Iterator<Item = (&'b Subject, &'b Pose)> {
        self.subjects.iter().zip(&poses.0).filter(|(subject, _)| subject.dynamic)
    }
}

/// The value that the part `fraction` of all values does not exceed; 0 of none. Sorts them.
pub fn quantile(values: &mut [f64], fraction: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (fraction * values.len().saturating_sub(1) as f64).round() as usize;
    values.get(index).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{self, Size};

    #[test]
    fn quantiles_are_values_of_the_sample() {
        let mut values: Vec<f64> = (0..101).rev().map(f64::from).collect();
        assert_eq!(quantile(&mut values, 0.0), 0.0);
        assert_eq!(quantile(&mut values, 0.5), 50.0);
        assert_eq!(quantile(&mut values, 0.99), 99.0);
        assert_eq!(quantile(&mut values, 1.0), 100.0);
        assert_eq!(quantile(&mut [], 0.5), 0.0);
    }

    /// A pyramid of three boxes: one stays, one is raised by a metre, one is lost.
    #[test]
    fn displacement_escapes_and_energy_of_three_boxes() {
        let scene = (scene::find("pyramid").unwrap().build)(Size { count: None, base: Some(2) });
        let judge = Judge::new(&scene);
        let mut poses = Poses::of_scene(&scene);
        let still = vec![DVec3::ZERO; poses.0.len()];
        let before = judge.energy(&poses, &still);
        assert_eq!(before.kinetic, 0.0);
        assert!((before.potential - 1000.0 * f64::from(9.81_f32) * 2.5).abs() < 1e-6);
        assert_eq!((judge.displacement(&poses), judge.escaped(&poses)), (0.0, 0));

        poses.0[3].position.y += 1.0;
        let mut velocities = still;
        velocities[3].x = 2.0;
        let after = judge.energy(&poses, &velocities);
        assert!((after.kinetic - 2000.0).abs() < 1e-9);
        assert!((after.potential - before.potential - 1000.0 * f64::from(9.81_f32)).abs() < 1e-6);
        assert_eq!(judge.displacement(&poses), 1.0);

        let hash = judge.hash(&poses);
        poses.0[1].position.y = f64::NAN;
        assert_eq!(judge.escaped(&poses), 1);
        assert_eq!(judge.displacement(&poses), 1.0);
        poses.0[2].position.y = -3.0;
        assert_eq!(judge.escaped(&poses), 2);
        assert_ne!(judge.hash(&poses), hash);
    }
}
