//! Hulls and cuboids as one thing: corners, planes, and what borders on what.

use super::cuboid::{self, Cuboid};
use super::segment::Segment;
use crate::hull::{Hull, Plane, Topology};
use crate::math::{DMat3, DVec3, Pose};
use crate::report::Feature;
use std::sync::LazyLock;

/// A convex polyhedron in its place. All lengths and directions are in its own frame.
#[derive(Clone, Copy)]
pub(crate) struct Polytope<'a> {
    /// Its corners.
    pub(crate) corners: &'a [DVec3],
    /// The planes of its sides.
    pub(crate) planes: &'a [Plane],
    /// What borders on what.
    pub(crate) topology: &'a Topology,
    /// A point well inside.
    pub(crate) middle: DVec3,
    /// Radius (m) of a ball around `middle` that the polytope holds.
    pub(crate) inner_radius: f64,
    /// The box around it: lowest and highest corner.
    pub(crate) bounds: (DVec3, DVec3),
    /// Its frame in the common one.
    pub(crate) pose: Pose,
    /// Climbs to the highest corner; a cuboid's is known by the signs of the direction.
    hull: Option<&'a Hull>,
}

/// A cuboid's corners and planes, for a [`Polytope`] to look at.
pub(crate) struct CuboidParts {
    corners: [DVec3; 8],
    planes: [Plane; 6],
    cuboid: Cuboid,
}

impl CuboidParts {
    pub(crate) fn new(cuboid: &Cuboid) -> Self {
        let half = cuboid.half;
        let plane = |side: usize| {
            let mut normal = DVec3::ZERO;
            normal[side / 2] = if side % 2 == 1 { 1.0 } else { -1.0 };
            Plane { normal, offset: half[side / 2] }
        };
        Self {
            corners: std::array::from_fn(|corner| cuboid::corner(corner as u32, half)),
            planes: std::array::from_fn(plane),
            cuboid: *cuboid,
        }
    }

    pub(crate) fn polytope(&self) -> Polytope<'_> {
        static TOPOLOGY: LazyLock<Topology> = LazyLock::new(|| {
            let outlines: [[u32; 4]; 6] = std::array::from_fn(|side| {
                let mut ring = cuboid::face_corners(side as u32);
                if side % 2 == 0 {
                    ring.reverse();
                }
                ring
            });
            let name =
                |one: u32, other: u32| cuboid::edge_number((one ^ other).trailing_zeros() as usize, one);
            Topology::new(8, outlines.iter().map(|ring| &ring[..]), name)
        });
        let half = self.cuboid.half;
        Polytope {
            corners: &self.corners,
            planes: &self.planes,
            topology: &TOPOLOGY,
            middle: DVec3::ZERO,
            inner_radius: half.min_element(),
            bounds: (-half, half),
            pose: self.cuboid.pose,
            hull: None,
        }
    }
}

impl<'a> Polytope<'a> {
    /// `None` for a hull with slivers whose sides and edges do not close.
    pub(crate) fn of_hull(hull: &'a Hull, pose: &Pose) -> Option<Self> {
        let topology = hull.topology();
        topology.is_closed().then(|| Self {
            corners: hull.vertices(),
            planes: hull.planes(),
            topology,
            middle: hull.middle(),
            inner_radius: hull.inner_radius(),
            bounds: hull.bounds(),
            pose: *pose,
            hull: Some(hull),
        })
    }

    /// The number of the corner that lies farthest in `direction`.
    pub(crate) fn highest(&self, direction: DVec3) -> u32 {
        self.hull.map_or_else(|| cuboid::farthest_corner(direction), |hull| hull.highest(direction))
    }

    /// The side at the farthest corner that looks most in `direction`.
    pub(crate) fn side_towards(&self, direction: DVec3) -> u32 {
        self.hull.map_or_else(|| cuboid::facing(direction), |hull| hull.face_towards(direction).0)
    }

    /// The place of a corner.
    pub(crate) fn corner(&self, number: u32) -> DVec3 {
        self.corners[number as usize]
    }

    /// A length that tells what is small for this shape, m.
    pub(crate) fn size(&self) -> f64 {
        0.5 * (self.bounds.1 - self.bounds.0).max_element()
    }

    /// Between two neighbouring corners.
    pub(crate) fn segment(&self, ends: [u32; 2]) -> Segment {
        let [from, to] = ends.map(|corner| self.corner(corner));
        Segment { center: 0.5 * (from + to), half: 0.5 * (to - from) }
    }

    /// What the corners (one to three of them, some perhaps twice) span: a corner, an edge, or the side towards `outward`.
    pub(crate) fn feature_of(&self, corners: &[u32], outward: DVec3) -> Feature {
        let first = corners[0];
        let mut others = corners.iter().copied().filter(|&corner| corner != first);
        let Some(second) = others.next() else { return Feature::Vertex(first) };
        let edge = self.topology.edge_between(first, second);
        match edge.filter(|_| others.all(|corner| corner == second)) {
            Some(edge) => Feature::Edge(edge.name),
            None => Feature::Face(self.side_towards(outward)),
        }
    }
}

/// What the search for closest points asks of a convex shape.
pub(crate) trait Farthest {
    /// The number and place of the point that lies farthest in `direction`.
    fn farthest(&self, direction: DVec3) -> (u32, DVec3);

    /// The place of the point of that number.
    fn point(&self, number: u32) -> DVec3;
}

impl Farthest for Polytope<'_> {
    fn farthest(&self, direction: DVec3) -> (u32, DVec3) {
        let number = self.highest(direction);
        (number, self.corner(number))
    }

    fn point(&self, number: u32) -> DVec3 {
        self.corner(number)
    }
}

impl Farthest for Segment {
    fn farthest(&self, direction: DVec3) -> (u32, DVec3) {
        let number = u32::from(self.half.dot(direction) > 0.0);
        (number, self.point(number))
    }

    fn point(&self, number: u32) -> DVec3 {
        if number == 1 { self.at(1.0) } else { self.at(-1.0) }
    }
}

/// A shape turned and moved into another frame.
pub(crate) struct Moved<'a, T> {
    pub(crate) shape: &'a T,
    /// From its own directions to those of the frame, and back.
    pub(crate) turn: DMat3,
    pub(crate) back: DMat3,
    pub(crate) shift: DVec3,
}

impl<'a, T> Moved<'a, T> {
    pub(crate) fn new(shape: &'a T, pose: &Pose) -> Self {
        let turn = DMat3::from_quat(pose.rotation);
        Self { shape, turn, back: turn.transpose(), shift: pose.position }
    }

    /// The place in the frame of one of the shape's points.
    pub(crate) fn place(&self, local: DVec3) -> DVec3 {
        self.turn * local + self.shift
    }
}

impl<T: Farthest> Farthest for Moved<'_, T> {
    fn farthest(&self, direction: DVec3) -> (u32, DVec3) {
        let (number, point) = self.shape.farthest(self.back * direction);
        (number, self.place(point))
    }

    fn point(&self, number: u32) -> DVec3 {
        self.place(self.shape.point(number))
    }
}
