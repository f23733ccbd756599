//! Boxes that rest from the start, packed into a pit: what a pile of boxes is once it has come to rest, at any size.
//!
//! Layer lies upon layer, each of its own height, and every other layer is a little to the side, so that most boxes rest
//! on four. All faces that carry are level and meet exactly.

use super::piles::pit;
use super::random::Random;
use super::{Body, Bounds, EARTH, Scene, Size, cuboid};

/// Distance of neighbours in a layer, m: more than the widest box, so that none meet.
const SPACING: f32 = 1.0625;
/// How far layers lie to the one side and to the other, m. Twice that is less than half of the narrowest box, so that each
/// box's centre is above the box below it, at the walls too.
const SHIFT: f32 = 0.15;
/// Half of a box's narrowest and widest edge along x and z, m.
const HALF_WIDTHS: [f32; 2] = [0.42, 0.5];
/// How many layers of boxes are twice as wide as deep: 4,000 lie 20 × 20 in ten layers.
const WIDTH_OVER_DEPTH: f64 = 2.0;

/// 4,000 boxes in ten layers. With another count the pit keeps its proportions.
pub fn boxes(size: Size) -> Scene {
    let count = size.count.unwrap_or(4000);
    let across = (WIDTH_OVER_DEPTH * count as f64).cbrt().round().max(1.0) as usize;
    let half = 0.5 * across as f32 * SPACING + SHIFT;
    let mut bodies = pit(half);
    let mut random = Random::new(7);
    let middle = 0.5 * (across - 1) as f32;
    let mut top = 0.0;
    for layer in 0..count.div_ceil(across * across) {
        // A whole number of 128ths, so that sums of heights are exact and nothing begins in anything.
        let half_height = (52 + random.bits() % 25) as f32 / 128.0;
        let shift = if layer % 2 == 0 { -SHIFT } else { SHIFT };
        let left = count - layer * across * across;
        for i in 0..left.min(across * across) {
            let [x, z] = [i % across, i / across].map(|i| (i as f32 - middle) * SPACING + shift);
            let [width, depth] = [0; 2].map(|_| random.between(HALF_WIDTHS[0], HALF_WIDTHS[1]));
            bodies.push(Body::dynamic([x, top + half_height, z], cuboid([width, half_height, depth])));
        }
        top += 2.0 * half_height;
    }
    let wide = half + 0.5;
    let bounds = Bounds { min: [-wide, -0.5, -wide], max: [wide, 1.0e9, wide] };
    Scene { bodies, gravity: EARTH, steps: 60, bounds }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{self, ENGINES};
    use crate::quality::{Judge, Poses};

    #[test]
    fn nothing_overlaps_at_the_start_not_even_by_rounding() {
        for count in [1, 30, 2000] {
            let scene = boxes(Size { count: Some(count), base: None });
            let overlap = Judge::new(&scene).overlap(&Poses::of_scene(&scene));
            assert_eq!(overlap.pairs, 0, "{count}: {overlap:?}");
        }
    }

    #[test]
    fn everything_stays_where_it_is() {
        let scene = boxes(Size { count: Some(150), base: None });
        let judge = Judge::new(&scene);
        for entry in ENGINES {
            let mut world = engine::load(entry, &scene, 1);
            (0..scene.steps).for_each(|_| world.step());
            let end = Poses((0..scene.bodies.len()).map(|body| world.pose(body)).collect());
            assert!(judge.displacement(&end) < 0.01, "{}: {} m", entry.name, judge.displacement(&end));
        }
    }
}
