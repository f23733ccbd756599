//! Collision detection: how far apart two shapes are, and where they touch.
//!
//! Both questions take the shapes' poses in one common frame near both of them (the caller moves the origin there, so
//! that nothing is lost far from the world's origin). The normal always points from `a` to `b`.
//!
//! Balls, capsules, cuboids, hulls and planes have kernels of their own, one file for each family of pairs:
//!
//! | | round | cuboid | hull | plane |
//! |---|---|---|---|---|
//! | **round** (ball, capsule) | `round.rs` | `round_box.rs` | `round_hull.rs` | `plane.rs` |
//! | **cuboid** | | `box_box.rs`, `clip.rs` | `hull_hull.rs` | `plane.rs` |
//! | **hull** | | | `hull_hull.rs` | `plane.rs` |
//! | **plane** | | | | never touch |
//!
//! A round shape is a *core* (a point or a segment) and a radius, so its pairs reduce to the closest points of cores
//! (`segment.rs`). Beside a hull a cuboid is a polyhedron like any other (`polytope.rs`): closest points come from
//! `closest.rs`, overlapping sides from `polygon.rs`. All other pairs go through `parry.rs`, and so do hulls whose sides
//! and edges, among slivers, do not close.

mod box_box;
mod clip;
mod closest;
mod cuboid;
mod hull_hull;
mod manifold;
mod parry;
mod plane;
mod polygon;
mod polytope;
mod round;
mod round_box;
mod round_hull;
mod round_side;
mod segment;

pub use manifold::{ContactPoint, Manifold};
pub(crate) use parry::{Wanted, lies_beyond_a_side};

use crate::math::{DVec3, Pose};
use crate::shape::Shape;
use cuboid::Cuboid;
use plane::HalfSpace;
use polytope::{CuboidParts, Polytope};
use round::Round;

/// Lengths below this fraction of the shapes' own size are rounding: no direction is read from them.
const ROUNDING: f64 = 1e-12;

/// A normal this close to a face's (cosine, about 5.7°) may carry several points of that face.
const FLAT: f64 = 0.995;

/// How far apart the shapes are, m: never more than their true distance, zero when they touch, negative when they overlap.
///
/// Positive exactly if the shapes are disjoint. Where one of them is a ball, a capsule, a hull or a plane it is the true
/// distance; for two cuboids the widest gap along fifteen axes, which falls short of the distance only where the
/// closest features are two corners or a corner and an edge. Overlap is the length of the shortest way out of it
/// (for two round shapes: along the line of their cores' closest points). Two planes are infinitely far apart.
///
/// Continuous in the poses, but for one case: two cuboids apart, corner to corner or corner to edge, whose edges turn
/// through parallel. There it may jump between two positive lower bounds; its sign never does.
pub fn separation(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> f64 {
    gap((a, pose_a), (b, pose_b)).separation
}

/// How far apart two shapes are, and along which direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gap {
    /// As [`separation`] has it, m.
    pub separation: f64,
    /// Unit vector from the first to the second, if one is known. Where the two are apart, no point of the first is higher along it than
    /// any of the second less the separation.
    pub normal: Option<DVec3>,
}

impl Gap {
    fn along(separation: f64, normal: DVec3) -> Self {
        Self { separation, normal: Some(normal) }
    }

    fn flipped(self) -> Self {
        Self { normal: self.normal.map(|normal| -normal), ..self }
    }
}

/// The [`separation`], and the direction in which it is that.
pub(crate) fn gap(a: (&Shape, &Pose), b: (&Shape, &Pose)) -> Gap {
    use Placed::{Box, Hull, Plane, Round};
    let (Some(placed_a), Some(placed_b)) = (Placed::new(a.0, a.1), Placed::new(b.0, b.1)) else {
        return Gap { separation: parry::separation(a.0, a.1, b.0, b.1), normal: None };
    };
    match (&placed_a, &placed_b) {
        (Round(a), Round(b)) => round::gap(a, b),
        (Round(round), Box(cuboid)) => round_box::gap(round, cuboid),
        (Box(cuboid), Round(round)) => round_box::gap(round, cuboid).flipped(),
        (Round(round), Plane(plane)) => Gap::along(plane::round_separation(round, plane), -plane.up),
        (Plane(plane), Round(round)) => Gap::along(plane::round_separation(round, plane), plane.up),
        (Box(a), Box(b)) => box_box::gap(a, b),
        (Box(cuboid), Plane(plane)) => Gap::along(plane::box_separation(cuboid, plane), -plane.up),
        (Plane(plane), Box(cuboid)) => Gap::along(plane::box_separation(cuboid, plane), plane.up),
        (Round(round), Hull(hull)) => round_hull::gap(round, hull),
        (Hull(hull), Round(round)) => round_hull::gap(round, hull).flipped(),
        (Box(cuboid), Hull(hull)) => hull_hull::gap(&CuboidParts::new(cuboid).polytope(), hull),
        (Hull(hull), Box(cuboid)) => hull_hull::gap(hull, &CuboidParts::new(cuboid).polytope()),
        (Hull(a), Hull(b)) => hull_hull::gap(a, b),
        (Hull(hull), Plane(plane)) => Gap::along(plane::hull_separation(hull, plane), -plane.up),
        (Plane(plane), Hull(hull)) => Gap::along(plane::hull_separation(hull, plane), plane.up),
        (Plane(_), Plane(_)) => Gap { separation: f64::INFINITY, normal: None },
    }
}

/// The gap along `normal` (unit length, from `a` to `b`), m: never more than the shapes' distance, whatever the normal.
///
/// Where it is wide enough nothing else need be asked: a direction that has kept two shapes apart goes on doing so for a
/// while. Known for hulls and cuboids; −∞, which says nothing, for all other pairs.
pub fn separation_along(a: (&Shape, &Pose), b: (&Shape, &Pose), normal: DVec3) -> f64 {
    use Placed::{Box, Hull};
    match (Placed::new(a.0, a.1), Placed::new(b.0, b.1)) {
        (Some(Hull(a)), Some(Hull(b))) => hull_hull::separation_along(&a, &b, normal),
        (Some(Hull(a)), Some(Box(b))) => {
            hull_hull::separation_along(&a, &CuboidParts::new(&b).polytope(), normal)
        }
        (Some(Box(a)), Some(Hull(b))) => {
            hull_hull::separation_along(&CuboidParts::new(&a).polytope(), &b, normal)
        }
        (Some(Box(a)), Some(Box(b))) => {
            let (parts_a, parts_b) = (CuboidParts::new(&a), CuboidParts::new(&b));
            hull_hull::separation_along(&parts_a.polytope(), &parts_b.polytope(), normal)
        }
        _ => f64::NEG_INFINITY,
    }
}

/// Appends the manifolds of all places where the surfaces are no further apart than `margin` (m).
///
/// A pair of balls, capsules, cuboids, hulls and planes adds one manifold at most. The point of least separation is always
/// among its points, and that separation is [`separation`]'s; only for two cuboids apart and closest at two corners
/// or a corner and an edge may it be more, as that function is a lower bound there.
///
/// Where the geometry leaves the normal open (concentric balls, a ball's centre on a capsule's axis, capsules with
/// overlapping axes) one fixed direction is taken, the same for the same poses.
pub fn manifolds(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64, out: &mut Vec<Manifold>) {
    use Placed::{Box, Hull, Plane, Round};
    let (Some(placed_a), Some(placed_b)) = (Placed::new(a.0, a.1), Placed::new(b.0, b.1)) else {
        return parry::manifolds(a, b, margin, out);
    };
    out.extend(match (&placed_a, &placed_b) {
        (Round(a), Round(b)) => round::manifold(a, b, margin),
        (Round(round), Box(cuboid)) => round_box::manifold(round, cuboid, margin),
        (Box(cuboid), Round(round)) => round_box::manifold(round, cuboid, margin).map(|m| m.flipped()),
        (Round(round), Plane(plane)) => plane::round_manifold(round, plane, margin),
        (Plane(plane), Round(round)) => plane::round_manifold(round, plane, margin).map(|m| m.flipped()),
        (Box(a), Box(b)) => box_box::manifold(a, b, margin),
        (Box(cuboid), Plane(plane)) => plane::box_manifold(cuboid, plane, margin),
        (Plane(plane), Box(cuboid)) => plane::box_manifold(cuboid, plane, margin).map(|m| m.flipped()),
        (Round(round), Hull(hull)) => round_hull::manifold(round, hull, margin),
        (Hull(hull), Round(round)) => round_hull::manifold(round, hull, margin).map(|m| m.flipped()),
        (Box(cuboid), Hull(hull)) => hull_hull::manifold(&CuboidParts::new(cuboid).polytope(), hull, margin),
        (Hull(hull), Box(cuboid)) => hull_hull::manifold(hull, &CuboidParts::new(cuboid).polytope(), margin),
        (Hull(a), Hull(b)) => hull_hull::manifold(a, b, margin),
        (Hull(hull), Plane(plane)) => plane::hull_manifold(hull, plane, margin),
        (Plane(plane), Hull(hull)) => plane::hull_manifold(hull, plane, margin).map(|m| m.flipped()),
        (Plane(_), Plane(_)) => None,
    });
}

/// A shape that has kernels of its own, put in its place.
enum Placed<'a> {
    Round(Round),
    Box(Cuboid),
    Hull(Polytope<'a>),
    Plane(HalfSpace),
}

impl<'a> Placed<'a> {
    /// `None` for the shapes that go through parry.
    fn new(shape: &'a Shape, pose: &Pose) -> Option<Self> {
        match shape {
            Shape::Sphere { radius } => Some(Placed::Round(Round::ball(pose, *radius))),
            Shape::Capsule { height, radius } => Some(Placed::Round(Round::capsule(pose, *height, *radius))),
            Shape::Cuboid { size } => Some(Placed::Box(Cuboid { half: 0.5 * *size, pose: *pose })),
            Shape::Hull(hull) => Polytope::of_hull(hull, pose).map(Placed::Hull),
            Shape::Plane => Some(Placed::Plane(HalfSpace::new(pose))),
            _ => None,
        }
    }
}
