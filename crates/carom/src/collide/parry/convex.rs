//! Convex shapes as cores with a radius: how far they reach, and which side of them faces a direction.

use crate::hull::Hull;
use crate::math::{DVec3, sin_cos};
use crate::report::Feature;
use crate::shape::Shape;
use std::f64::consts::TAU;
use std::sync::LazyLock;

/// All points within `radius` of a core.
pub(super) struct Convex<'a> {
    pub core: Core<'a>,
    /// m; the larger the radius, the less needs parry's slower half (overlap of cores).
    pub radius: f64,
}

/// What is left of a convex shape when its roundness is taken off.
pub(super) enum Core<'a> {
    /// The origin: a ball's centre.
    Point,
    /// Along y: a capsule's axis.
    Segment { half: f64 },
    /// A box around the origin.
    Cuboid { half: DVec3 },
    /// The hull of two balls at −half and +half on y. One of the radii is 0.
    Balls { half: f64, bottom: f64, top: f64 },
    /// The hull of two discs across y at −half and +half.
    Frustum { half: f64, bottom: f64, top: f64 },
    /// A polyhedron.
    Hull(&'a Hull),
    /// A triangle of a surface, with the numbers it and its corners have there.
    Triangle { corners: [DVec3; 3], index: u32, vertices: [u32; 3] },
}

/// Corners of a disc's rim that take part in contacts; the rim's lowest point always does, corner or not.
const RIM: usize = 16;

/// The most corners that a side of a core shows. Hull sides with more are thinned out evenly.
pub(super) const CORNERS: usize = 16;

/// A corner of an outline.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub point: DVec3,
    /// What the corner is.
    pub vertex: Feature,
    /// What leads from it to the next corner.
    pub edge: Feature,
}

/// The side of a core that faces some direction: a point, a segment or a flat polygon, anticlockwise from outside.
pub(super) struct Outline {
    corners: Vec<Corner>,
    /// What its inside is.
    pub face: Feature,
}

impl Default for Outline {
    fn default() -> Self {
        Self::NONE
    }
}

impl Outline {
    pub const NONE: Outline = Outline { corners: Vec::new(), face: Feature::Surface };

    /// Makes it that of some corners, of [`CORNERS`] at most.
    fn be(&mut self, face: Feature, corners: impl IntoIterator<Item = (DVec3, Feature, Feature)>) {
        let corner = |(point, vertex, edge): (DVec3, Feature, Feature)| Corner { point, vertex, edge };
        self.face = face;
        self.corners.clear();
        self.corners.extend(corners.into_iter().take(CORNERS).map(corner));
    }

    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// The corners, to be moved to another frame.
    pub fn corners_mut(&mut self) -> &mut [Corner] {
        &mut self.corners
    }
}

impl<'a> Convex<'a> {
    /// `None` for planes, meshes and height fields.
    pub fn of(shape: &'a Shape) -> Option<Self> {
        Some(match *shape {
            Shape::Sphere { radius } => Self { core: Core::Point, radius },
            Shape::Cuboid { size } => Self { core: Core::Cuboid { half: 0.5 * size }, radius: 0.0 },
            Shape::Capsule { height, radius } => Self { core: Core::Segment { half: 0.5 * height }, radius },
            Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
                let radius = radius_bottom.min(radius_top);
                let (bottom, top) = (radius_bottom - radius, radius_top - radius);
                Self { core: Core::Balls { half: 0.5 * height, bottom, top }, radius }
            }
            Shape::Cylinder { height, radius_bottom, radius_top } => Self {
                core: Core::Frustum { half: 0.5 * height, bottom: radius_bottom, top: radius_top },
                radius: 0.0,
            },
            Shape::Hull(ref hull) => Self { core: Core::Hull(hull), radius: 0.0 },
            Shape::Plane | Shape::Mesh(_) | Shape::HeightField(_) => return None,
        })
    }
}

impl Core<'_> {
    /// The point that lies farthest in `direction` (of any length).
    pub fn support(&self, direction: DVec3) -> DVec3 {
        let on_axis = |y: f64| DVec3::new(0.0, y, 0.0);
        let farther = |one: DVec3, other: DVec3| {
            if other.dot(direction) > one.dot(direction) { other } else { one }
        };
        match *self {
            Core::Point => DVec3::ZERO,
            Core::Segment { half } => on_axis(if direction.y < 0.0 { -half } else { half }),
            Core::Cuboid { half } => {
                let side = |axis: usize| if direction[axis] < 0.0 { -half[axis] } else { half[axis] };
                DVec3::new(side(0), side(1), side(2))
            }
            Core::Balls { half, bottom, top } => {
                let unit = direction.normalize_or_zero();
                farther(on_axis(half) + unit * top, on_axis(-half) + unit * bottom)
            }
            Core::Frustum { half, bottom, top } => {
                let out = DVec3::new(direction.x, 0.0, direction.z).normalize_or_zero();
                farther(on_axis(half) + out * top, on_axis(-half) + out * bottom)
            }
            Core::Hull(hull) => hull.support(direction),
            Core::Triangle { corners: [a, b, c], .. } => farther(farther(a, b), c),
        }
    }

    /// A length like the core's own, m: half the largest edge of the box around it. 0 for a point.
    pub fn reach(&self) -> f64 {
        match *self {
            Core::Point => 0.0,
            Core::Segment { half } => half,
            Core::Cuboid { half } => half.max_element(),
            Core::Balls { half, bottom, top } | Core::Frustum { half, bottom, top } => {
                half.max(bottom).max(top)
            }
            Core::Hull(hull) => {
                let (low, high) = hull.bounds();
                0.5 * (high - low).max_element()
            }
            Core::Triangle { corners: [a, b, c], .. } => {
                0.5 * (a.max(b).max(c) - a.min(b).min(c)).max_element()
            }
        }
    }

    /// Whether its support point moves evenly with the direction.
    pub fn is_curved(&self) -> bool {
        matches!(self, Core::Balls { .. } | Core::Frustum { .. })
    }

    /// A point well inside.
    pub fn middle(&self) -> DVec3 {
        match self {
            Core::Hull(hull) => hull.middle(),
            Core::Triangle { corners: [a, b, c], .. } => (*a + *b + *c) / 3.0,
            _ => DVec3::ZERO,
        }
    }

    /// Some directions worth a try when all else fails: those of flat sides.
    pub fn flat_directions(&self) -> Vec<DVec3> {
        match self {
            Core::Hull(hull) => hull.face_normals().collect(),
            Core::Triangle { corners: [a, b, c], .. } => {
                let normal = (*b - *a).cross(*c - *a).normalize_or_zero();
                vec![normal, -normal]
            }
            _ => vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z],
        }
    }

    /// The side that faces the unit vector `direction`.
    pub fn outline(&self, direction: DVec3) -> Outline {
        let mut outline = Outline::default();
        self.outline_into(direction, &mut outline);
        outline
    }

    /// The same, in the room of another one.
    pub fn outline_into(&self, direction: DVec3, outline: &mut Outline) {
        let smooth = Feature::Surface;
        let mut segment = |low: DVec3, high: DVec3| {
            outline.be(smooth, [(low, smooth, smooth), (high, smooth, smooth)]);
        };
        let on_axis = |y: f64| DVec3::new(0.0, y, 0.0);
        match *self {
            Core::Point => outline.be(smooth, [(DVec3::ZERO, smooth, smooth)]),
            Core::Segment { half } => segment(on_axis(-half), on_axis(half)),
            Core::Balls { half, bottom, top } => {
                segment(on_axis(-half) + direction * bottom, on_axis(half) + direction * top)
            }
            Core::Cuboid { half } => cuboid_side(half, direction, outline),
            Core::Frustum { half, bottom, top } => {
                let radial = DVec3::new(direction.x, 0.0, direction.z);
                let (out, height) = (radial.normalize_or_zero(), 2.0 * half);
                // The side's normal: across the slanted line from rim to rim.
                let slant = DVec3::new(height, bottom - top, 0.0).normalize_or_zero();
                let along_side = slant.x * radial.length() + slant.y * direction.y;
                let (up, down) = (direction.y, -direction.y);
                if top > 0.0 && up >= along_side && up >= down {
                    disc(half, top, 1, outline);
                } else if bottom > 0.0 && down >= along_side {
                    disc(-half, bottom, 0, outline);
                } else {
                    segment(on_axis(-half) + out * bottom, on_axis(half) + out * top);
                }
            }
            Core::Hull(hull) => {
                let (face, corners) = hull.face_towards(direction);
                let count = corners.len();
                let kept = count.min(CORNERS);
                let corner = |k: usize| {
                    let (here, next) = (corners[k * count / kept], corners[(k + 1) * count / kept % count]);
                    let edge = Feature::Edge(hull.edge_number(here, next));
                    (hull.vertices()[here as usize], Feature::Vertex(here), edge)
                };
                outline.be(Feature::Face(face), (0..kept).map(corner));
            }
            Core::Triangle { corners, index, vertices } => {
                let corner = |k: usize| {
                    let edge = index.wrapping_mul(3).wrapping_add(k as u32);
                    (corners[k], Feature::Vertex(vertices[k]), Feature::Edge(edge))
                };
                outline.be(Feature::Face(index), (0..3).map(corner));
            }
        }
    }
}

/// The face of a box that faces `direction`, numbered as [`Feature`] says; the edge along an axis is 4 times the
/// axis, plus 1 and 2 where it lies on the positive side of the first and second of the other axes.
fn cuboid_side(half: DVec3, direction: DVec3, outline: &mut Outline) {
    let size = direction.abs();
    let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
    let positive = direction[axis] > 0.0;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let base = u32::from(positive) << axis;
    let mut ring = [base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v];
    if !positive {
        ring.reverse();
    }
    let bit = |corner: u32, axis: usize| corner >> axis & 1;
    let face = Feature::Face(2 * axis as u32 + u32::from(positive));
    let corner = |k: usize| {
        let (here, next) = (ring[k], ring[(k + 1) % 4]);
        let along = (here ^ next).trailing_zeros() as usize % 3;
        let (first, second) = [(1, 2), (0, 2), (0, 1)][along];
        let edge = 4 * along as u32 + bit(here, first) + 2 * bit(here, second);
        let side = |axis: usize| if bit(here, axis) == 1 { half[axis] } else { -half[axis] };
        (DVec3::new(side(0), side(1), side(2)), Feature::Vertex(here), Feature::Edge(edge))
    };
    outline.be(face, (0..4).map(corner));
}

/// A disc across y as a polygon of [`RIM`] corners that stand still in the shape's frame, so that they are the same ones
/// from step to step. Numbered from 0 below (`number` 0) and from [`RIM`] above (`number` 1).
fn disc(y: f64, radius: f64, number: u32, outline: &mut Outline) {
    static TURNS: LazyLock<[(f64, f64); RIM]> =
        LazyLock::new(|| std::array::from_fn(|k| sin_cos(k as f64 * (TAU / RIM as f64))));
    let corner = |k: usize| {
        // Anticlockwise from outside: from z to x seen from above, the other way from below.
        let (sine, cosine) = TURNS[if number == 1 { k } else { RIM - 1 - k }];
        let name = number * RIM as u32 + k as u32;
        let point = DVec3::new(radius * sine, y, radius * cosine);
        (point, Feature::Vertex(name), Feature::Edge(name))
    };
    outline.be(Feature::Face(number), (0..RIM).map(corner));
}
