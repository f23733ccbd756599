//! Surfaces of triangles.

mod tree;

use crate::error::{Invalid, limits};
use crate::math::DVec3;
use tree::Tree;

/// A surface of triangles, solid from both sides.
#[derive(Clone, Debug)]
pub struct Mesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// For each side of each triangle, the triangle beyond it: `None` at a border or where more than two meet.
    neighbours: Vec<[Option<u32>; 3]>,
    /// At right angles to each triangle, unit length, its corners anticlockwise around it; zero where rounding leaves none, not
    /// a number where there is no area.
    normals: Vec<DVec3>,
    tree: Tree,
    low: DVec3,
    high: DVec3,
}

impl Mesh {
    /// A surface of triangles: each names three of `vertices` (m). A triangle without area touches nothing.
    ///
    /// # Errors
    /// If a vertex is not finite or beyond the largest length, a triangle names a vertex that is not there, or there is
    /// no triangle with an area.
    pub fn new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, Invalid> {
        check_points("vertices", &vertices)?;
        for (i, triangle) in triangles.iter().enumerate() {
            for (j, &index) in triangle.iter().enumerate() {
                if index as usize >= vertices.len() {
                    let expected = format!("an index below {}, the number of vertices", vertices.len());
                    return Err(Invalid::new(format!("triangles[{i}][{j}]"), index, expected));
                }
            }
        }
        let normal = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|index| vertices[index as usize]);
            let cross = (b - a).cross(c - a);
            if cross == DVec3::ZERO { DVec3::NAN } else { cross.normalize_or_zero() }
        };
        let normals: Vec<DVec3> = triangles.iter().map(normal).collect();
        if normals.iter().all(|normal| normal.is_nan()) {
            let found = format!("{} triangles without area", triangles.len());
            return Err(Invalid::new("triangles", found, "at least one triangle with an area"));
        }
        let bounds = |triangle: u32| {
            let corners = triangles[triangle as usize].map(|index| vertices[index as usize]);
            (triangle, bounds_of(corners))
        };
        let has_area = |&triangle: &u32| !normals[triangle as usize].is_nan();
        let tree = Tree::new((0..triangles.len() as u32).filter(has_area).map(bounds));
        let neighbours = neighbours_of(&vertices, &triangles);
        let used = || triangles.iter().flatten().map(|&index| vertices[index as usize]);
        let low = used().fold(DVec3::INFINITY, DVec3::min);
        let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
        Ok(Self { neighbours, normals, tree, low, high, vertices, triangles })
    }

    /// Its corners, m.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Its triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle, m.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        let [a, b, c] = self.triangles[triangle as usize];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// The direction at right angles to a triangle around which its corners run anticlockwise, unit length; zero where rounding
    /// leaves none.
    #[inline]
    pub(crate) fn normal(&self, triangle: u32) -> DVec3 {
        self.normals[triangle as usize]
    }

    /// The triangles beyond the sides 0→1, 1→2, 2→0 of a triangle.
    pub(crate) fn neighbours(&self, triangle: u32) -> [Option<u32>; 3] {
        self.neighbours[triangle as usize]
    }

    /// The triangles with an area whose boxes meet the box from `low` to `high` (m), in order.
    pub(crate) fn within(&self, low: DVec3, high: DVec3) -> Vec<u32> {
        let mut found = Vec::with_capacity(16);
        self.tree.visit(low, high, |triangle| {
            let (least, most) = bounds_of(self.corners(triangle));
            if least.cmple(high).all() && most.cmpge(low).all() {
                found.push(triangle);
            }
        });
        found.sort_unstable();
        found
    }

    /// The box around its triangles: lowest and highest corner, m.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        (self.low, self.high)
    }
}

/// The box around a triangle: lowest and highest corner, m.
fn bounds_of([a, b, c]: [DVec3; 3]) -> (DVec3, DVec3) {
    (a.min(b).min(c), a.max(b).max(c))
}

/// Refuses points that are not finite or lie further out than the largest length.
pub(crate) fn check_points(field: &str, points: &[DVec3]) -> Result<(), Invalid> {
    let reach = *limits::LENGTH.end();
    for (i, point) in points.iter().enumerate() {
        if !(point.abs().max_element() <= reach && point.is_finite()) {
            for axis in 0..3 {
                limits::within(&format!("{field}[{i}][{axis}]"), point[axis], -reach..=reach, "m")?;
            }
        }
    }
    Ok(())
}

/// Which triangles share a side. Corners are the same where their coordinates are.
fn neighbours_of(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[Option<u32>; 3]> {
    let key = |index: u32| (vertices[index as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (i, triangle) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (from, to) = (key(triangle[side]), key(triangle[(side + 1) % 3]));
            sides.push((from.min(to), from.max(to), i as u32, side));
        }
    }
    sides.sort_unstable();
    let mut neighbours = vec![[None; 3]; triangles.len()];
    for shared in sides.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
        if let [one, other] = shared {
            neighbours[one.2 as usize][one.3] = Some(other.2);
            neighbours[other.2 as usize][other.3] = Some(one.2);
        }
    }
    neighbours
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let vertices = vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
        (vertices, vec![[0, 1, 2], [0, 2, 3]])
    }

    #[test]
    fn a_square_knows_its_inner_side() {
        let (vertices, triangles) = square();
        let mesh = Mesh::new(vertices, triangles).unwrap();
        assert_eq!(mesh.neighbours(0), [None, None, Some(1)]);
        assert_eq!(mesh.neighbours(1), [Some(0), None, None]);
        assert_eq!(mesh.bounds(), (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, 1.0)));
    }

    #[test]
    fn what_no_surface_can_be_is_refused_by_name() {
        let (vertices, triangles) = square();
        let field = |vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>| {
            Mesh::new(vertices, triangles).map(|_| ()).unwrap_err().field
        };
        assert_eq!(field(vertices.clone(), vec![[0, 1, 2], [0, 4, 1]]), "triangles[1][1]");
        assert_eq!(field(vertices.clone(), vec![]), "triangles");
        assert_eq!(field(vertices.clone(), vec![[0, 1, 1], [2, 2, 2]]), "triangles");
        let mut broken = vertices.clone();
        broken[2].y = f64::NAN;
        assert_eq!(field(broken, triangles.clone()), "vertices[2][1]");
        let mut far = vertices;
        far[3].z = 2e6;
        assert_eq!(field(far, triangles), "vertices[3][2]");
    }

    #[test]
    fn a_triangle_without_area_is_let_in_beside_one_with() {
        let (vertices, mut triangles) = square();
        triangles.push([1, 1, 2]);
        assert_eq!(Mesh::new(vertices, triangles).unwrap().triangles().len(), 3);
    }
}
