//! Where the faces of two boxes lie over each other: one face clipped to the outline of the other.

use super::cuboid;
use super::manifold::ContactPoint;
use crate::math::DVec3;
use crate::report::Feature;

/// A box as the box kernels see it: centre and axes in the frame they work in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block {
    /// The middle.
    pub(crate) center: DVec3,
    /// Unit vectors along its edges.
    pub(crate) axes: [DVec3; 3],
    /// Half the edge lengths.
    pub(crate) half: DVec3,
}

impl Block {
    /// The place of a point given along the box's axes.
    pub(crate) fn place(&self, local: DVec3) -> DVec3 {
        self.center + self.turn(local)
    }

    /// A direction given along the box's axes.
    pub(crate) fn turn(&self, local: DVec3) -> DVec3 {
        self.axes[0] * local.x + self.axes[1] * local.y + self.axes[2] * local.z
    }

    /// The components of a direction along the box's axes.
    pub(crate) fn components(&self, direction: DVec3) -> DVec3 {
        DVec3::new(direction.dot(self.axes[0]), direction.dot(self.axes[1]), direction.dot(self.axes[2]))
    }

    /// A point of the working frame, along the box's axes.
    pub(crate) fn local(&self, point: DVec3) -> DVec3 {
        self.components(point - self.center)
    }
}

/// The contacts at the corners of an overlap: eight at most, since each of four clips adds one corner to a face's four.
pub(crate) struct Overlap {
    points: [ContactPoint; 8],
    count: usize,
}

impl Overlap {
    /// Room for one.
    pub(crate) const NONE: Overlap = Overlap { points: [ContactPoint::NONE; 8], count: 0 };

    /// The contacts.
    pub(crate) fn points(&self) -> &[ContactPoint] {
        &self.points[..self.count]
    }

    /// Gives the contacts within `tolerance` of the least separation `least` just that, and drops those further apart
    /// than `margin`.
    pub(crate) fn level_and_keep(&mut self, (least, tolerance): (f64, f64), margin: f64) {
        let mut kept = 0;
        for index in 0..self.count {
            let mut point = self.points[index];
            if point.separation <= least + tolerance {
                point.separation = least;
            }
            if point.separation <= margin {
                self.points[kept] = point;
                kept += 1;
            }
        }
        self.count = kept;
    }

    /// Exchanges `a` and `b`.
    pub(crate) fn flip(&mut self) {
        self.points[..self.count].iter_mut().for_each(|point| *point = point.flipped());
    }
}

/// A side of the polygon that is being clipped.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    /// Of the incident face, between its corners number n and n + 1 (around the face).
    Incident(u8),
    /// Of the reference face, over its border at the negative or positive end of the axis `u` (0) or `v` (1).
    Reference(u8, bool),
}

/// A corner of that polygon.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    /// Its foot on the reference face, along that face's axes u and v from its middle.
    foot: [f64; 2],
    /// From the reference face to it along the normal.
    separation: f64,
    /// Which corner of the incident face it is, around that face, if it is one.
    corner: Option<u8>,
    /// The side that begins here.
    side: Side,
}

/// The polygon: each clip of a convex polygon adds one corner at most.
struct Polygon {
    vertices: [Vertex; 8],
    count: usize,
}

impl Polygon {
    fn vertices(&self) -> &[Vertex] {
        &self.vertices[..self.count]
    }

    fn push(&mut self, vertex: Vertex) {
        // Rounding on a sliver may cut a border twice; its points are there already.
        if self.count < self.vertices.len() {
            self.vertices[self.count] = vertex;
            self.count += 1;
        }
    }
}

/// The overlap of two faces, one of each box, seen along `normal`: unit length, from `reference` to `incident`.
///
/// The reference face is the one that looks most along the normal, the incident face the one that looks most against
/// it. The incident face is clipped against the four planes through the reference face's edges that hold the normal
/// (Sutherland and Hodgman 1974; Gregorius, *The Separating Axis Test between Convex Polyhedra*, GDC 2013). Distances
/// are taken along the normal, which need not be the reference face's own: then a crossing of two edges, seen along
/// the normal, is still a corner of the polygon and has the edges' own distance.
///
/// In the contacts `a` is the reference and `b` the incident box.
pub(crate) fn overlap(reference: &Block, incident: &Block, normal: DVec3, overlap: &mut Overlap) {
    let upward = reference.components(normal);
    let face = cuboid::facing(upward);
    let axis = face as usize / 2;
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let incident_corners = cuboid::face_corners(cuboid::facing(-incident.components(normal)));

    // As `incident.place` and `reference.local` have it, without what all corners share.
    let edges: [DVec3; 3] = std::array::from_fn(|k| incident.axes[k] * incident.half[k]);
    let [across_u, across_v, along] = [u, v, axis].map(|k| (reference.axes[k], upward[k]));
    let (sign, steepness, height) = (along.1.signum(), along.1.abs(), reference.half[axis]);
    let vertex = |number: u8| {
        let corner = incident_corners[usize::from(number)];
        let side = |k: usize| if corner >> k & 1 == 1 { edges[k] } else { -edges[k] };
        let from_center = incident.center + (side(0) + side(1) + side(2)) - reference.center;
        let separation = (from_center.dot(along.0) * sign - height) / steepness;
        let foot = [across_u, across_v].map(|(way, rise)| from_center.dot(way) - rise * separation);
        Vertex { foot, separation, corner: Some(number), side: Side::Incident(number) }
    };
    let [first, second, third, fourth] = [0, 1, 2, 3].map(vertex);
    let vertices = [first, second, third, fourth, first, first, first, first];
    let (mut one, mut other) = (Polygon { vertices, count: 4 }, Polygon { vertices, count: 0 });
    let (mut polygon, mut clipped) = (&mut one, &mut other);
    let tolerance = 1e-10 * reference.half.max_element().min(incident.half.max_element());
    for (direction, limit) in [(0, reference.half[u]), (1, reference.half[v])] {
        for positive in [false, true] {
            if clip(polygon, (direction, positive), (limit, tolerance), clipped) {
                std::mem::swap(&mut polygon, &mut clipped);
            }
        }
    }

    overlap.count = polygon.count;
    let mut before = polygon.vertices().last().map_or(Side::Incident(0), |vertex| vertex.side);
    for (vertex, point) in polygon.vertices().iter().zip(&mut overlap.points) {
        let mut foot = DVec3::ZERO;
        (foot[u], foot[v]) = (vertex.foot[0], vertex.foot[1]);
        foot[axis] = height * sign;
        let (feature_a, feature_b) = features(vertex, before, (face, foot), &incident_corners);
        *point = ContactPoint {
            point: reference.place(foot) + normal * (0.5 * vertex.separation),
            separation: vertex.separation,
            feature_a,
            feature_b,
        };
        before = vertex.side;
    }
}

/// The part of the polygon with ± foot[direction] ≤ `limit`, if it is not the whole. A corner within `tolerance` of the border is on it:
/// it stays as it is, and no second one is made beside it.
fn clip(
    polygon: &Polygon,
    (direction, positive): (usize, bool),
    (limit, tolerance): (f64, f64),
    clipped: &mut Polygon,
) -> bool {
    let sign = if positive { 1.0 } else { -1.0 };
    let mut beyond = [0.0; 8];
    let mut is_cut = false;
    for (beyond, vertex) in beyond.iter_mut().zip(polygon.vertices()) {
        *beyond = vertex.foot[direction] * sign - limit;
        is_cut |= *beyond > tolerance || beyond.is_nan();
    }
    if !is_cut {
        return false;
    }
    clipped.count = 0;
    let border = Side::Reference(direction as u8, positive);
    for (index, here) in polygon.vertices().iter().enumerate() {
        let next = if index + 1 < polygon.count { index + 1 } else { 0 };
        let (beyond_here, beyond_next) = (beyond[index], beyond[next]);
        let next = &polygon.vertices[next];
        let crossing = |side: Side| {
            let share = beyond_here / (beyond_here - beyond_next);
            let between = |from: f64, to: f64| from + (to - from) * share;
            let mut foot = [between(here.foot[0], next.foot[0]), between(here.foot[1], next.foot[1])];
            foot[direction] = if positive { limit } else { -limit };
            Vertex { foot, separation: between(here.separation, next.separation), corner: None, side }
        };
        if beyond_here <= tolerance {
            let leaves = beyond_next > tolerance;
            let inside = beyond_here < -tolerance;
            clipped.push(Vertex { side: if leaves && !inside { border } else { here.side }, ..*here });
            if leaves && inside {
                clipped.push(crossing(border));
            }
        } else if beyond_next < -tolerance {
            clipped.push(crossing(here.side));
        }
    }
    true
}

/// What touches at a corner of the polygon, from the sides that meet there: `before` ends and `vertex.side` begins.
/// The reference's feature comes first. `face` and `foot` (along the reference box's axes) tell which corner or edge.
fn features(
    vertex: &Vertex,
    before: Side,
    (face, foot): (u32, DVec3),
    incident_corners: &[u32; 4],
) -> (Feature, Feature) {
    let incident_corner = |n: u8| incident_corners[usize::from(n % 4)];
    let incident_edge = |n: u8| cuboid::edge_between(incident_corner(n), incident_corner(n + 1));
    let reference_edge = |direction: u8| {
        // The border across u runs along v, and the other way round.
        let along = (face as usize / 2 + 2 - usize::from(direction)) % 3;
        Feature::Edge(cuboid::edge_number(along, cuboid::farthest_corner(foot)))
    };
    match (vertex.corner, before, vertex.side) {
        (Some(corner), _, _) => (Feature::Face(face), Feature::Vertex(incident_corner(corner))),
        (None, Side::Incident(n), Side::Reference(direction, _))
        | (None, Side::Reference(direction, _), Side::Incident(n)) => {
            (reference_edge(direction), incident_edge(n))
        }
        // Two borders: a corner of the reference face, over the middle of the incident one.
        _ => {
            let [first, _, _, _] = *incident_corners;
            let common = incident_corners.iter().fold(7, |bits, &c| bits & !(first ^ c));
            let axis = common.trailing_zeros();
            let incident_face = 2 * axis + (first >> axis & 1);
            (Feature::Vertex(cuboid::farthest_corner(foot)), Feature::Face(incident_face))
        }
    }
}
