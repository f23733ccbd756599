//! Flat sides of a shape that another one lies beyond.

use super::axis::along;
use super::convex::{Convex, Core};
use super::surface::triangle_core;
use super::{Kind, is_finite};
use crate::math::{DVec3, Pose};
use crate::shape::Shape;

/// What is asked of a side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted {
    /// Of a surface only the triangles here count.
    pub place: DVec3,
    /// The side faces this way (unit length) with a cosine above `cosine`.
    pub way: DVec3,
    pub cosine: f64,
    /// How far the other shape may reach behind the side, m.
    pub room: f64,
}

/// Whether `a` has a flat side of that kind that `b`, if it is convex, lies beyond.
pub(crate) fn lies_beyond_a_side(a: (&Shape, &Pose), b: (&Shape, &Pose), wanted: Wanted) -> bool {
    let (Some(other), true) = (Convex::of(b.0), is_finite(a.1) && is_finite(b.1)) else { return false };
    let inner = a.1.relative(b.1);
    let way = a.1.rotation.conjugate() * wanted.way;
    let is_beyond = |core: &Core| {
        core.flat_directions().into_iter().any(|side| {
            side.dot(way) > wanted.cosine
                && along(core, &other.core, &inner, side).gap - other.radius >= -wanted.room
        })
    };
    match Kind::of(a.0) {
        Kind::Convex(convex) => convex.radius == 0.0 && is_beyond(&convex.core),
        Kind::Plane => false,
        Kind::Surface(surface) => {
            let place = a.1.inverse_transform_point(wanted.place);
            let slack = DVec3::splat(wanted.room);
            let near = surface.within(place - slack, place + slack);
            near.into_iter().any(|index| is_beyond(&triangle_core(surface, index).core))
        }
    }
}
