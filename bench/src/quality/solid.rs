//! The faces, edges, volume and centre of a scene's shapes, worked out here and nowhere else.

use super::convex::{Convex, Face};
use crate::scene::Shape;
use glam::DVec3;
use std::f64::consts::PI;

/// What a shape is to the judge.
pub struct Solid {
    /// m³
    pub volume: f64,
    /// Centre of mass, m.
    pub center: DVec3,
    /// Distance of the farthest point from it, m.
    pub reach: f64,
    /// `None` for a mesh.
    pub convex: Option<Convex>,
}

impl Solid {
    /// Everything about a shape.
    pub fn of(shape: &Shape) -> Self {
        match shape {
            Shape::Sphere { radius } => Self::round(0.0, f64::from(*radius)),
            Shape::Capsule { half_height, radius } => {
                Self::round(f64::from(*half_height), f64::from(*radius))
            }
            Shape::Cuboid { half } => {
                let half = DVec3::from_array(half.map(f64::from));
                let corner =
                    |i: usize| DVec3::from_array([0, 1, 2].map(|k| if i >> k & 1 == 1 { 1.0 } else { -1.0 }));
                Self::polyhedron((0..8).map(|i| corner(i) * half).collect())
            }
            Shape::Hull(points) => {
                Self::polyhedron(points.iter().map(|point| DVec3::from_array(point.map(f64::from))).collect())
            }
            Shape::Mesh(_) => Self { volume: 0.0, center: DVec3::ZERO, reach: 0.0, convex: None },
        }
    }

    /// A ball rolled along a segment of twice `half_height` on the y axis.
    fn round(half_height: f64, radius: f64) -> Self {
        let vertices = match half_height {
            0.0 => vec![DVec3::ZERO],
            _ => vec![DVec3::new(0.0, -half_height, 0.0), DVec3::new(0.0, half_height, 0.0)],
        };
        let edges = if vertices.len() == 2 { vec![DVec3::Y] } else { Vec::new() };
        Self {
            volume: PI * radius * radius * (2.0 * half_height + 4.0 / 3.0 * radius),
            center: DVec3::ZERO,
            reach: half_height + radius,
            convex: Some(Convex { vertices, faces: Vec::new(), edges, radius }),
        }
    }

    /// The hull of points, each of them a vertex.
    fn polyhedron(vertices: Vec<DVec3>) -> Self {
        let faces = faces(&vertices);
        let (volume, center) = volume_and_center(&vertices, &faces);
        let reach = vertices.iter().map(|vertex| vertex.distance(center)).fold(0.0, f64::max);
        let edges = edge_directions(&vertices, &faces);
        Self { volume, center, reach, convex: Some(Convex { vertices, faces, edges, radius: 0.0 }) }
    }
}

/// The faces of a hull: whatever plane through three points has all others on one side. That is O(n⁴), for the 16
/// points of a pebble less than 10⁴ dot products, and there is nothing to go wrong.
fn faces(vertices: &[DVec3]) -> Vec<Face> {
    let size = vertices.iter().map(|vertex| vertex.length()).fold(0.0, f64::max);
    let tolerance = 1e-9 * size;
    let mut faces: Vec<Face> = Vec::new();
    let n = vertices.len();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let across = (vertices[j] - vertices[i]).cross(vertices[k] - vertices[i]);
                let Some(unit) = across.try_normalize() else { continue };
                for normal in [unit, -unit] {
                    let level = |vertex: &DVec3| normal.dot(*vertex - vertices[i]);
                    if vertices.iter().any(|vertex| level(vertex) > tolerance) {
                        continue;
                    }
                    let corners: Vec<usize> =
                        (0..n).filter(|v| level(&vertices[*v]).abs() <= tolerance).collect();
                    // The first three corners of a face are the first to find it.
                    if corners[..3] == [i, j, k] {
                        faces.push(Face { normal, corners: around(vertices, corners, normal) });
                    }
                }
            }
        }
    }
    faces
}

/// Puts the corners of a face in order, counter-clockwise seen against its normal.
fn around(vertices: &[DVec3], mut corners: Vec<usize>, normal: DVec3) -> Vec<usize> {
    let middle = corners.iter().map(|corner| vertices[*corner]).sum::<DVec3>() / corners.len() as f64;
    let right = normal.any_orthonormal_vector();
    let up = normal.cross(right);
    let angle = |corner: &usize| {
        let arm = vertices[*corner] - middle;
        arm.dot(up).atan2(arm.dot(right))
    };
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    corners
}

/// Volume and centre of mass: the sum over tetrahedra from the origin to the faces.
fn volume_and_center(vertices: &[DVec3], faces: &[Face]) -> (f64, DVec3) {
    let (mut volume, mut moment) = (0.0, DVec3::ZERO);
    for face in faces {
        let first = vertices[face.corners[0]];
        for pair in face.corners[1..].windows(2) {
            let (second, third) = (vertices[pair[0]], vertices[pair[1]]);
            let part = first.dot(second.cross(third)) / 6.0;
            volume += part;
            moment += part * (first + second + third) / 4.0;
        }
    }
    (volume, moment / volume)
}

/// Unit vectors along the edges; of parallel ones the first.
fn edge_directions(vertices: &[DVec3], faces: &[Face]) -> Vec<DVec3> {
    let mut directions: Vec<DVec3> = Vec::new();
    for face in faces {
        for (i, &corner) in face.corners.iter().enumerate() {
            let next = face.corners[(i + 1) % face.corners.len()];
            let direction = (vertices[next] - vertices[corner]).normalize();
            if directions.iter().all(|known| known.cross(direction).length_squared() > 1e-18) {
                directions.push(direction);
            }
        }
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_six_faces_three_directions_and_its_volume() {
        let solid = Solid::of(&Shape::Cuboid { half: [0.5, 1.0, 1.5] });
        let convex = solid.convex.unwrap();
        assert_eq!((convex.vertices.len(), convex.faces.len(), convex.edges.len()), (8, 6, 3));
        assert!(convex.faces.iter().all(|face| face.corners.len() == 4));
        assert!((solid.volume - 6.0).abs() < 1e-12);
        assert!(solid.center.length() < 1e-12);
        assert!((solid.reach - 3.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_tetrahedron_off_the_origin() {
        let points = [[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0], [1.0, 1.0, 2.0]];
        let solid = Solid::of(&Shape::Hull(points.into()));
        assert!((solid.volume - 1.0 / 6.0).abs() < 1e-12);
        assert!((solid.center - DVec3::splat(1.25)).length() < 1e-12);
        assert_eq!(solid.convex.unwrap().edges.len(), 6);
    }

    #[test]
    fn round_shapes() {
        let ball = Solid::of(&Shape::Sphere { radius: 1.0 });
        assert!((ball.volume - 4.0 / 3.0 * PI).abs() < 1e-12);
        let pill = Solid::of(&Shape::Capsule { half_height: 1.0, radius: 1.0 });
        assert!((pill.volume - (2.0 + 4.0 / 3.0) * PI).abs() < 1e-12);
        assert_eq!(pill.reach, 2.0);
    }

    /// Euler's formula, V − E + F = 2, on every hull of the mixed pile: no face is missing and none is there twice.
    #[test]
    fn the_hulls_close() {
        let scene = (crate::scene::find("pile_mixed").unwrap().build)(crate::scene::Size {
            count: Some(200),
            base: None,
        });
        let hulls = scene.bodies.iter().filter(|body| matches!(body.shape, Shape::Hull(_)));
        assert_eq!(hulls.clone().count(), 50);
        for body in hulls {
            let convex = Solid::of(&body.shape).convex.unwrap();
            let sides: usize = convex.faces.iter().map(|face| face.corners.len()).sum();
            assert_eq!(convex.vertices.len() + convex.faces.len(), sides / 2 + 2);
            assert_eq!(sides % 2, 0);
        }
    }
}
