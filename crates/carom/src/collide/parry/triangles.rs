//! What a mesh and a height field have in common: a set of triangles that can be searched.

use super::facet::Facet;
use crate::height_field::HeightField;
use crate::math::DVec3;
use crate::mesh::Mesh;
use crate::shape::Shape;

/// A surface of numbered triangles, all in its own frame.
#[derive(Clone, Copy)]
pub(super) enum Triangles<'a> {
    Mesh(&'a Mesh),
    HeightField(&'a HeightField),
}

impl<'a> Triangles<'a> {
    /// The triangles of a shape that consists of them.
    pub fn of(shape: &'a Shape) -> Option<Self> {
        match shape {
            Shape::Mesh(mesh) => Some(Triangles::Mesh(mesh)),
            Shape::HeightField(field) => Some(Triangles::HeightField(field)),
            _ => None,
        }
    }

    /// The box around them: lowest and highest corner, m.
    pub fn bounds(self) -> (DVec3, DVec3) {
        match self {
            Triangles::Mesh(mesh) => mesh.bounds(),
            Triangles::HeightField(field) => field.bounds(),
        }
    }

    /// Those with an area whose boxes meet the box from `low` to `high`, in order.
    pub fn within(self, low: DVec3, high: DVec3) -> Vec<u32> {
        match self {
            Triangles::Mesh(mesh) => mesh.within(low, high),
            Triangles::HeightField(field) => field.within(low, high),
        }
    }

    /// The corners of a triangle, m.
    #[inline]
    pub fn corners(self, triangle: u32) -> [DVec3; 3] {
        match self {
            Triangles::Mesh(mesh) => mesh.corners(triangle),
            Triangles::HeightField(field) => field.triangle(triangle).map(|corner| field.vertex(corner)),
        }
    }

    /// The direction at right angles to a triangle around which its corners run anticlockwise, unit length; zero where rounding
    /// leaves none.
    #[inline]
    pub fn normal(self, triangle: u32) -> DVec3 {
        match self {
            Triangles::Mesh(mesh) => mesh.normal(triangle),
            Triangles::HeightField(_) => {
                let [a, b, c] = self.corners(triangle);
                (b - a).cross(c - a).normalize_or_zero()
            }
        }
    }

    /// A triangle for its kernels; none where it has no normal.
    pub fn facet(self, triangle: u32) -> Option<Facet> {
        Facet::new(self.corners(triangle), self.normal(triangle))
    }

    /// The numbers of its corners.
    pub fn corner_numbers(self, triangle: u32) -> [u32; 3] {
        match self {
            Triangles::Mesh(mesh) => mesh.triangles()[triangle as usize],
            Triangles::HeightField(field) => field.triangle(triangle),
        }
    }

    /// The triangles beyond its sides 0→1, 1→2, 2→0: none at a border or where more than two meet.
    pub fn neighbours(self, triangle: u32) -> [Option<u32>; 3] {
        match self {
            Triangles::Mesh(mesh) => mesh.neighbours(triangle),
            Triangles::HeightField(field) => field.neighbours(triangle),
        }
    }

    /// Shows every corner of every triangle, with its number.
    pub fn visit_corners(self, mut visit: impl FnMut(DVec3, u32)) {
        match self {
            Triangles::Mesh(mesh) => {
                let corners = mesh.triangles().iter().flatten();
                corners.for_each(|&vertex| visit(mesh.vertices()[vertex as usize], vertex));
            }
            Triangles::HeightField(field) => {
                (0..field.n_vertices()).for_each(|vertex| visit(field.vertex(vertex), vertex));
            }
        }
    }
}
