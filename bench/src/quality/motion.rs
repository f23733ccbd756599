//! How fast bodies are: from where they are after one step and after the next, whatever the engine says of velocities.
//!
//! A body's *speed* is that of its centre of mass. Its *surface speed* bounds the speed of all its points: that of the
//! centre, plus that of turning times the farthest point's distance from it.

use super::{Judge, Poses, quantile};
use serde::{Deserialize, Serialize};

/// What is slower than this is at rest, m/s.
pub const REST: f64 = 1e-3;

/// Speeds over some time: of each body its largest, and over the bodies the figures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// How many steps were watched.
    pub steps: usize,
    /// The largest speed of any body, m/s.
    pub speed_max: f64,
    /// What 99 in 100 bodies did not exceed, m/s.
    pub speed_p99: f64,
    /// The largest surface speed of any body, m/s.
    pub surface_speed_max: f64,
    /// How many bodies had a speed of more than 1 mm/s.
    pub moving: usize,
}

/// The largest speed and surface speed of each body.
#[derive(Clone, Copy, Default)]
struct Fastest {
    speed: f64,
    surface: f64,
}

/// Watches poses, step by step.
pub struct Watch {
    last: Poses,
    fastest: Vec<Fastest>,
    steps: usize,
}

impl Watch {
    /// Watches from these poses on.
    pub fn from(poses: Poses) -> Self {
        let fastest = vec![Fastest::default(); poses.0.len()];
        Self { last: poses, fastest, steps: 0 }
    }

    /// Takes in where bodies are `dt` seconds later; tells the largest speed and surface speed of this step, m/s.
    pub fn see(&mut self, judge: &Judge, poses: Poses, dt: f64) -> (f64, f64) {
        let mut largest = Fastest::default();
        for (i, subject) in judge.subjects.iter().enumerate().filter(|(_, subject)| subject.dynamic) {
            let (before, after) = (&self.last.0[i], &poses.0[i]);
            if !before.is_finite() || !after.is_finite() {
                continue;
            }
            let moved = before.point(subject.center).distance(after.point(subject.center));
            let half_sine = (before.rotation.conjugate() * after.rotation).xyz().length();
            let turned = 2.0 * half_sine.min(1.0).asin();
            let now = Fastest { speed: moved / dt, surface: (moved + turned * subject.reach) / dt };
            for fastest in [&mut self.fastest[i], &mut largest] {
                fastest.speed = fastest.speed.max(now.speed);
                fastest.surface = fastest.surface.max(now.surface);
            }
        }
        self.last = poses;
        self.steps += 1;
        (largest.speed, largest.surface)
    }

    /// What has been seen.
    pub fn motion(&self, judge: &Judge) -> Motion {
        let bodies = || judge.subjects.iter().zip(&self.fastest).filter(|(subject, _)| subject.dynamic);
        let mut speeds: Vec<f64> = bodies().map(|(_, fastest)| fastest.speed).collect();
        Motion {
            steps: self.steps,
            speed_max: speeds.iter().copied().fold(0.0, f64::max),
            moving: speeds.iter().filter(|speed| **speed > REST).count(),
            speed_p99: quantile(&mut speeds, 0.99),
            surface_speed_max: bodies().map(|(_, fastest)| fastest.surface).fold(0.0, f64::max),
        }
    }
}

/// When everything came to rest: the time (s) after which nothing was ever faster than 1 mm/s; `None` if something was in
/// the last step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    /// By the speed of centres.
    pub centers: Option<f64>,
    /// By surface speed.
    pub surfaces: Option<f64>,
}

impl Settling {
    /// Nothing has moved yet.
    pub fn new() -> Self {
        Self { centers: Some(0.0), surfaces: Some(0.0) }
    }

    /// Takes in the largest speed and surface speed (m/s) of the step that ended at `time` (s). A step that is too fast
    /// takes back what was said before; the first slow one after it starts the rest at its beginning.
    pub fn see(&mut self, (speed, surface): (f64, f64), time: f64, dt: f64) {
        for (rest, fastest) in [(&mut self.centers, speed), (&mut self.surfaces, surface)] {
            *rest = if fastest > REST { None } else { rest.or(Some(time - dt)) };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{self, Size};
    use glam::{DQuat, DVec3};

    #[test]
    fn speeds_of_a_slide_and_a_turn() {
        let scene = (scene::find("pyramid").unwrap().build)(Size { count: None, base: Some(2) });
        let judge = Judge::new(&scene);
        let start = Poses::of_scene(&scene);
        let mut watch = Watch::from(start.clone());
        let mut poses = start.clone();
        poses.0[1].position.x += 0.02;
        poses.0[2].rotation = DQuat::from_axis_angle(DVec3::Y, -0.01);
        let (speed, surface) = watch.see(&judge, poses.clone(), 0.5);
        assert!((speed - 0.04).abs() < 1e-12);
        assert!((surface - 0.04).abs() < 1e-12);
        // The turn alone, once more.
        poses.0[2].rotation = DQuat::from_axis_angle(DVec3::Y, -0.02);
        let (speed, surface) = watch.see(&judge, poses, 0.5);
        assert_eq!(speed, 0.0);
        assert!((surface - 0.02 * 0.75_f64.sqrt()).abs() < 1e-9);
        let motion = watch.motion(&judge);
        assert_eq!((motion.steps, motion.moving), (2, 1));
        assert!((motion.speed_max - 0.04).abs() < 1e-12);
    }

    #[test]
    fn rest_begins_after_the_last_fast_step() {
        let mut settling = Settling::new();
        settling.see((1.0, 1.0), 1.0, 1.0);
        assert_eq!(settling.centers, None);
        settling.see((1e-4, 1.0), 2.0, 1.0);
        settling.see((1e-4, 1e-4), 3.0, 1.0);
        assert_eq!(settling, Settling { centers: Some(1.0), surfaces: Some(2.0) });
        settling.see((2e-3, 2e-3), 4.0, 1.0);
        settling.see((0.0, 0.0), 5.0, 1.0);
        assert_eq!(settling, Settling { centers: Some(4.0), surfaces: Some(4.0) });
    }
}
