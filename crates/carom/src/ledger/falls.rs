//! What gravity does.

use crate::math::DVec3;
use crate::world::Momentum;
use std::ops::AddAssign;

/// How long gravity has acted on a mass, kg·s, and the integral of where it did, kg·m·s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fall {
    duration: f64,
    place: DVec3,
}

impl Fall {
    /// Gravity acts on `mass` (kg) for so long (s) at the mean place `center`.
    #[inline]
    pub fn new(mass: f64, center: DVec3, time: f64) -> Self {
        let duration = mass * time;
        Self { duration, place: center * duration }
    }

    /// Linear and angular momentum that gravity (m/s²) gives.
    #[inline]
    pub fn momentum(&self, gravity: DVec3) -> Momentum {
        Momentum { linear: gravity * self.duration, angular: self.place.cross(gravity) }
    }
}

impl AddAssign for Fall {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.duration += other.duration;
        self.place += other.place;
    }
}

/// Many falls, summed up batch by batch: sums of sums are rounded less than one long one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Falls {
    sum: Fall,
    batch: Fall,
    count: u32,
}

const BATCH: u32 = 64;

impl Falls {
    #[inline]
    pub fn add(&mut self, fall: Fall) {
        self.batch += fall;
        self.count += 1;
        if self.count == BATCH {
            self.sum += self.batch;
            (self.batch, self.count) = (Fall::default(), 0);
        }
    }

    /// Their sum; it begins anew.
    pub fn take(&mut self) -> Fall {
        let Self { mut sum, batch, .. } = std::mem::take(self);
        sum += batch;
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_falls_are_summed_up_without_losing_any() {
        let fall = Fall::new(2.0, DVec3::new(1.0, 2.0, 3.0), 0.25);
        let mut falls = Falls::default();
        for count in [0, 1, 63, 64, 65, 1000] {
            (0..count).for_each(|_| falls.add(fall));
            let sum = falls.take().momentum(DVec3::NEG_Y);
            let count = f64::from(count);
            assert_eq!(sum.linear, DVec3::NEG_Y * (0.5 * count));
            assert_eq!(sum.angular, DVec3::new(1.5, 0.0, -0.5) * count);
        }
    }
}
