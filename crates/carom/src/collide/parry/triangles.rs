//! What a mesh and a height field have in common: a set of triangles that can be searched.

use super::facet::Facet;
use crate::height_field::HeightField;
use crate::math::DVec3;
use crate::mesh::Mesh;
use crate::shape::Shape;

/// A surface of numbered triangles, all in its own frame.
pub(super) trait Triangles {
    /// The box around them: lowest and highest corner, m.
    fn bounds(&self) -> (DVec3, DVec3);

    /// Those with an area whose boxes meet the box from `low` to `high`, in order.
    fn within(&self, low: DVec3, high: DVec3) -> Vec<u32>;

    /// The corners of a triangle, m.
    fn corners(&self, triangle: u32) -> [DVec3; 3];

    /// The direction at right angles to a triangle around which its corners run anticlockwise, unit length; zero where rounding
    /// leaves none.
    fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// A triangle for its kernels; none where it has no normal.
    fn facet(&self, triangle: u32) -> Option<Facet> {
        Facet::new(self.corners(triangle), self.normal(triangle))
    }

    /// The numbers of its corners.
    fn corner_numbers(&self, triangle: u32) -> [u32; 3];

    /// The triangles beyond its sides 0→1, 1→2, 2→0: none at a border or where more than two meet.
    fn neighbours(&self, triangle: u32) -> [Option<u32>; 3];

    /// Shows every corner of every triangle, with its number.
    fn visit_corners(&self, visit: &mut dyn FnMut(DVec3, u32));
}

/// The triangles of a shape that consists of them.
pub(super) fn triangles_of(shape: &Shape) -> Option<&dyn Triangles> {
    match shape {
        Shape::Mesh(mesh) => Some(&**mesh),
        Shape::HeightField(field) => Some(&**field),
        _ => None,
    }
}

impl Triangles for Mesh {
    fn bounds(&self) -> (DVec3, DVec3) {
        self.bounds()
    }

    fn within(&self, low: DVec3, high: DVec3) -> Vec<u32> {
        self.within(low, high)
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.corners(triangle)
    }

    fn normal(&self, triangle: u32) -> DVec3 {
        self.normal(triangle)
    }

    fn corner_numbers(&self, triangle: u32) -> [u32; 3] {
        self.triangles()[triangle as usize]
    }

    fn neighbours(&self, triangle: u32) -> [Option<u32>; 3] {
        self.neighbours(triangle)
    }

    fn visit_corners(&self, visit: &mut dyn FnMut(DVec3, u32)) {
        self.triangles().iter().flatten().for_each(|&vertex| visit(self.vertices()[vertex as usize], vertex));
    }
}

impl Triangles for HeightField {
    fn bounds(&self) -> (DVec3, DVec3) {
        self.bounds()
    }

    fn within(&self, low: DVec3, high: DVec3) -> Vec<u32> {
        self.within(low, high)
    }

    fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangle(triangle).map(|corner| self.vertex(corner))
    }

    fn corner_numbers(&self, triangle: u32) -> [u32; 3] {
        self.triangle(triangle)
    }

    fn neighbours(&self, triangle: u32) -> [Option<u32>; 3] {
        self.neighbours(triangle)
    }

    fn visit_corners(&self, visit: &mut dyn FnMut(DVec3, u32)) {
        (0..self.n_vertices()).for_each(|vertex| visit(self.vertex(vertex), vertex));
    }
}
