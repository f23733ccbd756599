//! A cuboid's corners, edges and faces, and their numbers.
//!
//! - **Corner** c: bit 0, 1, 2 of c is set where x, y, z is positive.
//! - **Face** f = 2·axis + (1 on the positive side): −x, +x, −y, +y, −z, +z.
//! - **Edge** e = 4·axis + p + 2·q, along `axis`; of the other two axes, in the order x, y, z, p is 1 on the positive
//!   side of the first and q on that of the second. Edges 0 to 3 run along x, 4 to 7 along y, 8 to 11 along z; edge 7,
//!   for one, along y at +x, +z.
//!
//! The features of a cuboid are its own, whole: no diagonal splits a face.

use super::segment::Segment;
use crate::math::{DVec3, Pose};
use crate::report::Feature;

/// A cuboid in its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cuboid {
    /// Half the edge lengths, m.
    pub(crate) half: DVec3,
    /// Its frame in the common one.
    pub(crate) pose: Pose,
}

/// Components of a unit vector below this are rounding.
const ALIGNED: f64 = 1e-9;

/// The place of corner `corner`.
pub(crate) fn corner(corner: u32, half: DVec3) -> DVec3 {
    let side = |axis: usize| if corner >> axis & 1 == 1 { half[axis] } else { -half[axis] };
    DVec3::new(side(0), side(1), side(2))
}

/// The corner that lies farthest along `direction`.
pub(crate) fn farthest_corner(direction: DVec3) -> u32 {
    (0..3).map(|axis| u32::from(direction[axis] > 0.0) << axis).sum()
}

/// The axis to which `direction` is closest.
pub(crate) fn main_axis(direction: DVec3) -> usize {
    let along = direction.abs();
    if along.x >= along.y && along.x >= along.z {
        0
    } else if along.y >= along.z {
        1
    } else {
        2
    }
}

/// The face that looks most along `direction`.
pub(crate) fn facing(direction: DVec3) -> u32 {
    let axis = main_axis(direction);
    2 * axis as u32 + u32::from(direction[axis] > 0.0)
}

/// The corners of a face, in order around it.
pub(crate) fn face_corners(face: u32) -> [u32; 4] {
    let axis = face / 2;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let base = (face & 1) << axis;
    [base, base | 1 << u, base | 1 << u | 1 << v, base | 1 << v]
}

/// The number of the edge along `axis` that ends in `corner`.
pub(crate) fn edge_number(axis: usize, corner: u32) -> u32 {
    let (first, second) = [(1, 2), (0, 2), (0, 1)][axis];
    4 * axis as u32 + (corner >> first & 1) + 2 * (corner >> second & 1)
}

/// The place of the edge along `axis` that ends in `corner`; s = 1 is its positive end.
pub(crate) fn edge(axis: usize, end: u32, half: DVec3) -> Segment {
    let mut center = corner(end, half);
    let mut along = DVec3::ZERO;
    center[axis] = 0.0;
    along[axis] = half[axis];
    Segment { center, half: along }
}

/// The edge between two neighbouring corners.
pub(crate) fn edge_between(corner: u32, next: u32) -> Feature {
    Feature::Edge(edge_number((corner ^ next).trailing_zeros() as usize, corner))
}

/// The feature whose closest outer points lie along `outward`: a face has one such direction, an edge a fan of
/// them at right angles to it, a corner all the rest.
pub(crate) fn feature_towards(outward: DVec3) -> Feature {
    let tilted = |axis: usize| outward[axis].abs() > ALIGNED;
    let corner = farthest_corner(outward);
    match (tilted(0), tilted(1), tilted(2)) {
        (true, true, true) => Feature::Vertex(corner),
        (false, true, true) => Feature::Edge(edge_number(0, corner)),
        (true, false, true) => Feature::Edge(edge_number(1, corner)),
        (true, true, false) => Feature::Edge(edge_number(2, corner)),
        _ => Feature::Face(facing(outward)),
    }
}
