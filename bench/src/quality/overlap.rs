//! Which bodies overlap, and how deep.

use super::convex::Convex;
use super::solid::Solid;
use super::{Poses, quantile};
use crate::scene::Scene;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Depths over all pairs that overlap at all and have a body that moves, m.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Overlap {
    /// How many pairs there are.
    pub pairs: usize,
    /// Mean depth, m.
    pub mean: f64,
    /// What 99 in 100 pairs do not exceed, m.
    pub p99: f64,
    /// The deepest, m.
    pub max: f64,
}

impl Overlap {
    fn of(mut depths: Vec<f64>) -> Self {
        if depths.is_empty() {
            return Self::default();
        }
        let mean = depths.iter().sum::<f64>() / depths.len() as f64;
        let p99 = quantile(&mut depths, 0.99);
        Self { pairs: depths.len(), mean, p99, max: quantile(&mut depths, 1.0) }
    }
}

/// A body where it is.
struct Placed {
    dynamic: bool,
    convex: Convex,
    low: DVec3,
    high: DVec3,
}

/// All pairs, found by a sweep along x.
///
/// A mesh takes no part: it has no inside to be deep in.
pub fn measure(scene: &Scene, poses: &Poses) -> Overlap {
    let mut bodies: Vec<Placed> = scene
        .bodies
        .iter()
        .zip(&poses.0)
        .filter(|(_, pose)| pose.is_finite())
        .filter_map(|(body, pose)| {
            let convex = Solid::of(&body.shape).convex?.placed(pose);
            let (low, high) = convex.bounds();
            Some(Placed { dynamic: !body.fixed, convex, low, high })
        })
        .collect();
    bodies.sort_by(|a, b| a.low.x.total_cmp(&b.low.x));
    let mut depths = Vec::new();
    for (i, a) in bodies.iter().enumerate() {
        for b in bodies[i + 1..].iter().take_while(|b| b.low.x <= a.high.x) {
            let close = a.low.cmple(b.high).all() && b.low.cmple(a.high).all();
            if close && (a.dynamic || b.dynamic) {
                depths.extend(a.convex.overlap(&b.convex));
            }
        }
    }
    Overlap::of(depths)
}

#[cfg(test)]
mod tests {
    use super::super::Judge;
    use super::*;
    use crate::scene::{self, Size};

    /// Five known depths: boxes of a pyramid in the ground, and into each other.
    #[test]
    fn a_sunken_pyramid() {
        let scene = (scene::find("pyramid").unwrap().build)(Size { count: None, base: Some(2) });
        let judge = Judge::new(&scene);
        let mut poses = Poses::of_scene(&scene);
        let before = judge.overlap(&poses);
        assert_eq!((before.pairs, before.max), (0, 0.0));
        poses.0[1].position.y -= 0.01;
        poses.0[2].position.y -= 0.03;
        poses.0[3].position.y -= 0.05;
        let overlap = judge.overlap(&poses);
        // 10 and 30 mm in the ground; the top one 50 mm deeper than it should be: 40 and 20 mm.
        assert_eq!(overlap.pairs, 4);
        assert!((overlap.mean - 0.025).abs() < 1e-9);
        assert!((overlap.p99 - 0.04).abs() < 1e-9);
        assert!((overlap.max - 0.04).abs() < 1e-9);
    }

    /// The sweep finds what a look at every pair finds.
    #[test]
    fn the_sweep_misses_nothing() {
        let scene = (scene::find("pile_mixed").unwrap().build)(Size { count: Some(200), base: None });
        let judge = Judge::new(&scene);
        let mut poses = Poses::of_scene(&scene);
        for pose in &mut poses.0[5..] {
            pose.position *= 0.55;
        }
        let placed: Vec<_> = scene
            .bodies
            .iter()
            .zip(&poses.0)
            .map(|(body, pose)| (!body.fixed, Solid::of(&body.shape).convex.unwrap().placed(pose)))
            .collect();
        let mut count = 0;
        for (i, (a_moves, a)) in placed.iter().enumerate() {
            for (b_moves, b) in &placed[i + 1..] {
                count += usize::from((*a_moves || *b_moves) && a.overlap(b).is_some());
            }
        }
        assert!(count > 100, "{count}");
        assert_eq!(judge.overlap(&poses).pairs, count);
    }
}
