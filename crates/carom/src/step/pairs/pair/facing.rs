//! Two convex shapes that face each other across a plane.

use super::Pair;
use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::Gap;
use crate::flight::fly_center;
use crate::math::DVec3;

/// A direction along which two shapes were apart, which the world keeps while their bodies move.
///
/// With `n` the direction, `x` the centres of mass, `θ` how far each body turns and `ρ` how far a turn by one radian takes a point of
/// its shape at most, the two shapes are at least so far apart along `n`:
///
/// ```text
/// s ≥ s₀ + n·Δ(x_b − x_a) − ρ_a·θ_a − ρ_b·θ_b
/// ```
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    /// Unit vector from the first shape to the second.
    normal: DVec3,
    /// `s₀` without the centres, and with how far the bodies had turned by then, m.
    level: f64,
}

/// Of the coordinates that a distance is the difference of, relative.
const ROUNDING: f64 = 1e-15;

impl Facing {
    pub const UNKNOWN: Facing = Facing { normal: DVec3::X, level: f64::NEG_INFINITY };

    /// What a pair whose shapes have this gap at a time is known by.
    pub fn of(pair: &Pair, bodies: &Bodies, (gap, time): (Gap, f64)) -> Self {
        let Some(normal) = gap.normal.filter(|_| gap.separation > 0.0) else { return Self::UNKNOWN };
        let centers = Centers::of(pair, bodies, (normal, time));
        let level = gap.separation - centers.apart - centers.rounding + turned(pair, bodies, time);
        if level.is_nan() { Self::UNKNOWN } else { Self { normal, level } }
    }

    /// Lower bounds of the separation at a time within the step, and from then until another, m.
    pub fn least(&self, pair: &Pair, bodies: &Bodies, (from, until): (f64, f64)) -> [f64; 2] {
        if self.level == f64::NEG_INFINITY {
            return [f64::NEG_INFINITY; 2];
        }
        let time = until - from;
        let centers = Centers::of(pair, bodies, (self.normal, from));
        let nearer = (centers.speed * time + 0.5 * centers.acceleration.min(0.0) * time * time).min(0.0);
        let apart = self.level + centers.apart - centers.rounding;
        let least = apart + nearer - 0.5 * centers.braking * time * time;
        [apart - turned(pair, bodies, from), least - turned(pair, bodies, until)]
    }
}

/// How far points of the two have turned with their bodies by a time within the step, m, since a time of no matter.
fn turned(pair: &Pair, bodies: &Bodies, time: f64) -> f64 {
    let spin_reaches = pair.spin_reaches(bodies);
    let of = |side: usize| bodies.way(pair.rows()[side], time).1 * spin_reaches[side];
    of(0) + of(1)
}

/// How two centres of mass move against each other along a direction.
#[derive(Default)]
struct Centers {
    /// m
    apart: f64,
    /// What of that may be none, m.
    rounding: f64,
    /// m/s
    speed: f64,
    /// m/s²
    acceleration: f64,
    /// What damping adds to it at most, m/s².
    braking: f64,
}

impl Centers {
    fn of(pair: &Pair, bodies: &Bodies, (normal, time): (DVec3, f64)) -> Self {
        let mut centers = Self::default();
        for (row, sign) in pair.rows().into_iter().zip([-1.0, 1.0]).filter(|&(row, _)| row != WORLD_ROW) {
            let (constants, influence) = (&bodies.constants[row], &bodies.influences[row]);
            let flown = time - bodies.clocks[row];
            let (position, velocity) = fly_center(&bodies.states[row], constants, influence, flown);
            centers.apart += sign * position.dot(normal);
            centers.rounding += ROUNDING * position.abs().element_sum();
            centers.speed += sign * velocity.dot(normal);
            centers.acceleration += sign * influence.acceleration.dot(normal);
            centers.braking += constants.linear_damping * bodies.paces[row].0;
        }
        centers
    }
}
