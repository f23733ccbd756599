//! Random numbers that are the same everywhere, and forever.

/// SplitMix64 (Steele, Lea, Flood, *Fast Splittable Pseudorandom Number Generators*, OOPSLA 2014).
pub struct Random(u64);

impl Random {
    /// A sequence of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// A number from `low` up to, not including, `high`, out of 2²⁴ of them.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        let unit = (self.bits() >> 40) as f32 / (1_u32 << 24) as f32;
        low + (high - low) * unit
    }

    /// Three numbers between `low` and `high`.
    pub fn triple(&mut self, low: f32, high: f32) -> [f32; 3] {
        [0; 3].map(|_| self.between(low, high))
    }

    /// A unit quaternion, all rotations being equally likely: a point of a ball in four dimensions, scaled to its surface.
    pub fn rotation(&mut self) -> [f32; 4] {
        loop {
            let point = [0; 4].map(|_| self.between(-1.0, 1.0));
            let squared: f32 = point.iter().map(|x| x * x).sum();
            if squared > 0.05 && squared <= 1.0 {
                let length = squared.sqrt();
                return point.map(|x| x / length);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of the published generator for the seed 1234567.
    #[test]
    fn the_generator_is_the_published_one() {
        let mut random = Random::new(1_234_567);
        let expected = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!([0; 3].map(|_| random.bits()), expected);
    }

    #[test]
    fn rotations_have_unit_length() {
        let mut random = Random::new(9);
        for _ in 0..1000 {
            let length: f32 = random.rotation().iter().map(|x| x * x).sum();
            assert!((length - 1.0).abs() < 1e-6);
        }
    }
}
