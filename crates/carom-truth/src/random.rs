//! Chance that is the same every time.

use carom::math::{DQuat, DVec3};

/// Splitmix64 (Steele, Lea and Flood 2014).
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// From `low` to below `high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Each coordinate between −1 and 1.
    pub fn in_cube(&mut self) -> DVec3 {
        self.edges(-1.0, 1.0)
    }

    /// Three numbers, each from `low` to below `high`.
    pub fn edges(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.range(low, high), self.range(low, high), self.range(low, high))
    }

    /// Any direction, all alike.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let vector = self.in_cube();
            if (0.01..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }

    /// Any rotation, all alike.
    pub fn rotation(&mut self) -> DQuat {
        loop {
            let vector = self.in_cube();
            let turn = DQuat::from_xyzw(vector.x, vector.y, vector.z, self.range(-1.0, 1.0));
            if (0.01..1.0).contains(&turn.length_squared()) {
                return turn.normalize();
            }
        }
    }
}
