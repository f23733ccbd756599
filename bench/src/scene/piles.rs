//! Bodies in jittered columns above a pit, which they fill.
//!
//! With another count than the nominal one the pit keeps its proportions: width and depth both go with the cube root of the
//! count, in whole columns (2,000 boxes: 10 columns and 18.5 m across in place of 13 and 24).

use super::random::Random;
use super::{Body, Bounds, EARTH, Scene, Shape, Size, cuboid, ground, scaled_across};
use std::sync::Arc;

/// Half the width of the pit that belongs to the nominal count, m.
const HALF_PIT: f32 = 12.0;
/// How high its walls are, m.
const WALL_HEIGHT: f32 = 40.0;
/// How thick, halved, m.
const WALL_HALF_THICKNESS: f32 = 2.0;
/// Distance of columns of boxes and mixed bodies, m.
const SPACING: f32 = 1.75;

/// Points on a grid with jitter.
pub struct Columns {
    /// How many columns stand side by side, in both directions.
    pub across: usize,
    /// Their distance, and that of layers, m. The jitter is a twentieth of it.
    pub spacing: f32,
    /// Where the lowest layer lies, m.
    pub bottom: f32,
}

impl Columns {
    /// The first `count` points, layer upon layer.
    pub fn places(&self, count: usize, random: &mut Random) -> Vec<[f32; 3]> {
        let jitter = 0.05 * self.spacing;
        let middle = 0.5 * (self.across - 1) as f32;
        let mut place = |i: usize| {
            let (x, z) = (i % self.across, (i / self.across) % self.across);
            let layer = i / (self.across * self.across);
            [
                (x as f32 - middle) * self.spacing + random.between(-jitter, jitter),
                self.bottom + layer as f32 * self.spacing + random.between(-jitter, jitter),
                (z as f32 - middle) * self.spacing + random.between(-jitter, jitter),
            ]
        };
        (0..count).map(&mut place).collect()
    }
}

/// A floor whose top is at y = 0 and four walls around |x|, |z| < `half`.
pub fn pit(half: f32) -> Vec<Body> {
    let (thickness, height) = (WALL_HALF_THICKNESS, 0.5 * WALL_HEIGHT);
    let long = cuboid([thickness, height, half + 2.0 * thickness]);
    let short = cuboid([half, height, thickness]);
    vec![
        ground(half + 2.0 * thickness),
        Body::fixed([half + thickness, height, 0.0], long.clone()),
        Body::fixed([-half - thickness, height, 0.0], long),
        Body::fixed([0.0, height, half + thickness], short.clone()),
        Body::fixed([0.0, height, -half - thickness], short),
    ]
}

/// A pile to be: how many bodies, from which columns, into which pit.
struct Pile {
    count: usize,
    columns: Columns,
    /// Half the pit's width, m.
    half: f32,
}

impl Pile {
    /// `count` bodies, where `nominal` of them fall into a pit of [`HALF_PIT`] from `columns`.
    fn scaled(count: usize, nominal: usize, columns: Columns) -> Self {
        let across = scaled_across(columns.across, nominal, count).round().max(1.0);
        let proportional = HALF_PIT * across / columns.across as f32;
        // Few columns leave less space at the walls than a body needs that is turned badly.
        let clear = (0.5 * (across - 1.0) + 0.7) * columns.spacing;
        Self { count, columns: Columns { across: across as usize, ..columns }, half: proportional.max(clear) }
    }

    /// The scene: `body` makes the bodies for the places one after the other.
    fn scene(&self, places: Vec<[f32; 3]>, body: impl FnMut((usize, [f32; 3])) -> Body) -> Scene {
        let mut bodies = pit(self.half);
        bodies.extend(places.into_iter().enumerate().map(body));
        let wide = self.half + 0.5;
        let bounds = Bounds { min: [-wide, -0.5, -wide], max: [wide, 1.0e9, wide] };
        Scene { bodies, gravity: EARTH, steps: 600, bounds }
    }
}

/// 4,000 boxes with edges of 0.8 to 1.2 m, turned at random, above a pit 24 m across.
pub fn boxes(size: Size) -> Scene {
    let columns = Columns { across: 13, spacing: SPACING, bottom: 2.0 };
    let pile = Pile::scaled(size.count.unwrap_or(4000), 4000, columns);
    let mut random = Random::new(1);
    let places = pile.columns.places(pile.count, &mut random);
    pile.scene(places, |(_, place)| {
        let shape = cuboid(random.triple(0.4, 0.6));
        Body::dynamic(place, shape).rotated(random.rotation())
    })
}

/// 4,000 spheres, capsules, boxes and hulls in turn, turned at random, above a pit 24 m across.
pub fn mixed(size: Size) -> Scene {
    let columns = Columns { across: 13, spacing: SPACING, bottom: 2.0 };
    let pile = Pile::scaled(size.count.unwrap_or(4000), 4000, columns);
    let mut random = Random::new(2);
    let kinds = Mixture::new(&mut random);
    let places = pile.columns.places(pile.count, &mut random);
    pile.scene(places, |(i, place)| {
        let shape = kinds.shape(i, &mut random);
        Body::dynamic(place, shape).rotated(random.rotation())
    })
}

/// 8,000 spheres with radii of 0.4 to 0.5 m above a pit 24 m across.
pub fn spheres(size: Size) -> Scene {
    let columns = Columns { across: 20, spacing: 1.15, bottom: 1.0 };
    let pile = Pile::scaled(size.count.unwrap_or(8000), 8000, columns);
    let mut random = Random::new(3);
    let places = pile.columns.places(pile.count, &mut random);
    let scene = pile
        .scene(places, |(_, place)| Body::dynamic(place, Shape::Sphere { radius: random.between(0.4, 0.5) }));
    Scene { steps: 400, ..scene }
}

/// Shapes of four kinds, each about a metre across; hulls come from a stock of twelve.
pub struct Mixture {
    hulls: Vec<Arc<[[f32; 3]]>>,
}

impl Mixture {
    /// Draws the stock of hulls.
    pub fn new(random: &mut Random) -> Self {
        Self { hulls: (0..12).map(|_| pebble(random)).collect() }
    }

    /// The shape of body `i`.
    pub fn shape(&self, i: usize, random: &mut Random) -> Shape {
        match i % 4 {
            0 => Shape::Sphere { radius: random.between(0.4, 0.6) },
            1 => Shape::Capsule { half_height: random.between(0.2, 0.4), radius: random.between(0.3, 0.4) },
            2 => cuboid(random.triple(0.4, 0.6)),
            _ => Shape::Hull(self.hulls[(random.bits() % self.hulls.len() as u64) as usize].clone()),
        }
    }
}

/// 16 points of an ellipsoid with half axes of 0.45 to 0.6 m: a golden spiral whose angles are jittered, so that every
/// point is a vertex of the hull.
fn pebble(random: &mut Random) -> Arc<[[f32; 3]]> {
    const POINTS: usize = 16;
    const GOLDEN_ANGLE: f32 = 2.399_963_2;
    let axes = random.triple(0.45, 0.6);
    (0..POINTS)
        .map(|i| {
            let y = 1.0 - (2 * i + 1) as f32 / POINTS as f32;
            let angle = i as f32 * GOLDEN_ANGLE + random.between(-0.2, 0.2);
            let ring = (1.0 - y * y).sqrt();
            [axes[0] * ring * angle.cos(), axes[1] * y, axes[2] * ring * angle.sin()]
        })
        .collect()
}
