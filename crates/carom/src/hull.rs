//! Convex polyhedra.

use crate::error::{Invalid, limits};
use crate::math::DVec3;
use crate::mesh::check_points;
use climb::{Climb, Scan};
use quickhull::quickhull;
pub(crate) use topology::Topology;

mod climb;
mod quickhull;
mod topology;

/// Points this close to a plane, as a fraction of the hull's extent, lie in it.
const FLATNESS: f64 = 1e-10;

/// A convex polyhedron.
#[derive(Clone, Debug)]
pub struct Hull {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The planes of its flat sides: triangles in one plane taken together.
    planes: Vec<Plane>,
    topology: Topology,
    /// The flat side that each triangle belongs to; none for a triangle without area.
    face_of: Vec<Option<u32>>,
    scan: Scan,
    /// The way up; without it corners and faces are searched one by one.
    climb: Option<Climb>,
    /// Whether the climb leads to every flat side. Among slivers it may not.
    finds_faces: bool,
    /// The box around the corners: lowest and highest corner, m.
    bounds: (DVec3, DVec3),
    /// The mean of the corners, m.
    middle: DVec3,
    /// Radius (m) of a ball around `middle` inside all planes.
    inner_radius: f64,
}

/// The plane of a flat side: the polyhedron lies where `normal · point ≤ offset`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    /// Outward, unit length.
    pub normal: DVec3,
    /// That of the outermost corner, m.
    pub offset: f64,
}

impl Plane {
    /// How far `point` is outside, m.
    pub fn height(&self, point: DVec3) -> f64 {
        point.dot(self.normal) - self.offset
    }
}

impl Hull {
    /// The convex hull of `points` (m): its corners are some of the points, to the last bit.
    ///
    /// # Errors
    /// If a point is not finite or beyond the largest length, or the hull has no volume: fewer than four points, all of
    /// them (to 10⁻⁹ of their extent) in a plane, or none further than 10⁻⁶ m from the others.
    pub fn new(points: &[DVec3]) -> Result<Self, Invalid> {
        check_points("points", points)?;
        let mut distinct: Vec<DVec3> = points.iter().map(|&point| point + DVec3::ZERO).collect();
        distinct.sort_unstable_by(|one, other| {
            one.x.total_cmp(&other.x).then(one.y.total_cmp(&other.y)).then(one.z.total_cmp(&other.z))
        });
        distinct.dedup();
        let flat = || {
            let found = format!("{} points ({} distinct) in a plane", points.len(), distinct.len());
            let expected = "at least four points that do not lie in one plane, more than 1e-6 m apart";
            Invalid::new("points", found, expected)
        };
        let low = distinct.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = distinct.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = (high - low).max_element();
        if distinct.len() < 4 || extent < *limits::LENGTH.start() {
            return Err(flat());
        }
        let tolerance = FLATNESS * extent;
        let hull = Self::spanned(&distinct, tolerance).ok_or_else(flat)?;
        // Points within a face or an edge may have come along. Without them the hull is the same.
        let mut sides_at = vec![0; hull.vertices.len()];
        for side in 0..hull.planes.len() as u32 {
            hull.topology.ring(side).iter().for_each(|&corner| sides_at[corner as usize] += 1);
        }
        let corners = hull.vertices.iter().zip(&sides_at).filter(|&(_, &sides)| sides > 2);
        let true_corners: Vec<DVec3> = corners.map(|(&vertex, _)| vertex).collect();
        let lean = (true_corners.len() < hull.vertices.len())
            .then(|| Self::spanned(&true_corners, tolerance))
            .flatten()
            .filter(|lean| lean.holds(&distinct, 10.0 * tolerance));
        Ok(lean.unwrap_or(hull).measured())
    }

    /// Fills in what is known once the corners and faces are.
    fn measured(mut self) -> Self {
        let vertices = &self.vertices;
        let low = vertices.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = vertices.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        self.bounds = (low, high);
        self.middle = vertices.iter().sum::<DVec3>() / vertices.len().max(1) as f64;
        let outlines = (0..self.planes.len() as u32).map(|side| self.topology.ring(side));
        let sides = self.triangles.iter().zip(&self.face_of);
        let sides = sides.filter_map(|(&triangle, &face)| Some((triangle, face?)));
        self.scan = Scan::new(vertices);
        self.climb =
            Climb::new((vertices, &self.scan), &self.triangles, outlines, sides, self.face_normals());
        self.finds_faces = self.planes.iter().all(|plane| {
            let found = self.face_towards(plane.normal).0 as usize;
            self.planes[found].normal.distance(plane.normal) <= 1e-9
        });
        for side in 0..self.planes.len() {
            let normal = self.planes[side].normal;
            self.planes[side].offset = self.support(normal).dot(normal);
        }
        let depths = self.planes.iter().map(|plane| -plane.height(self.middle));
        self.inner_radius = depths.fold(f64::INFINITY, f64::min).max(0.0);
        self
    }

    fn spanned(points: &[DVec3], tolerance: f64) -> Option<Self> {
        let found = quickhull(points, tolerance)?;
        let mut used: Vec<usize> = found.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let renumbered = |index: usize| used.partition_point(|&other| other < index) as u32;
        let triangles: Vec<[u32; 3]> = found.iter().map(|triangle| triangle.map(renumbered)).collect();
        let vertices: Vec<DVec3> = used.iter().map(|&index| points[index]).collect();
        let sides = Sides::of(&vertices, &triangles, 10.0 * tolerance);
        let count = vertices.len() as u32;
        let topology =
            Topology::new(vertices.len(), sides.outlines.iter().map(Vec::as_slice), |one, other| {
                edge_number(count, one, other)
            });
        Some(Self {
            vertices,
            triangles,
            planes: sides.planes,
            topology,
            face_of: sides.face_of,
            scan: Scan::new(&[]),
            climb: None,
            finds_faces: true,
            bounds: (DVec3::ZERO, DVec3::ZERO),
            middle: DVec3::ZERO,
            inner_radius: 0.0,
        })
    }

    fn holds(&self, points: &[DVec3], tolerance: f64) -> bool {
        self.planes.iter().all(|plane| points.iter().all(|&point| plane.height(point) <= tolerance))
    }

    /// Its corners, m.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// Its surface as triangles, anticlockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corner that lies farthest in `direction` (of any length): its number.
    pub(crate) fn highest(&self, direction: DVec3) -> u32 {
        match &self.climb {
            Some(climb) => climb.highest(&self.vertices, direction),
            None => self.scan.highest(direction),
        }
    }

    /// The point that lies farthest in `direction` (of any length).
    pub(crate) fn support(&self, direction: DVec3) -> DVec3 {
        self.vertices.get(self.highest(direction) as usize).copied().unwrap_or(DVec3::ZERO)
    }

    /// The box around its corners: lowest and highest corner, m.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        self.bounds
    }

    /// The mean of its corners, m.
    pub(crate) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// The flat side at the farthest corner whose outward normal is closest to `direction`: its number and its corners,
    /// anticlockwise from outside.
    pub(crate) fn face_towards(&self, direction: DVec3) -> (u32, &[u32]) {
        let closest = |best: (u32, f64), face: u32| {
            let along = self.planes[face as usize].normal.dot(direction);
            if along > best.1 { (face, along) } else { best }
        };
        let none = (0, f64::NEG_INFINITY);
        let Some(climb) = self.climb.as_ref().filter(|_| self.finds_faces) else {
            let best = (0..self.planes.len() as u32).fold(none, closest);
            return (best.0, self.topology.ring(best.0));
        };
        let top = climb.highest(&self.vertices, direction);
        let mut best = climb.faces_at(top).iter().copied().fold(none, closest);
        // Where rounding decides which corner is the farthest, the closest side may be the next one over.
        loop {
            let here = best.0;
            for &corner in self.topology.ring(here) {
                best = climb.faces_at(corner).iter().copied().fold(best, closest);
            }
            if best.0 == here {
                break;
            }
        }
        (best.0, self.topology.ring(best.0))
    }

    /// A number of its own for the side between two corners, the same from both ends.
    pub(crate) fn edge_number(&self, one: u32, other: u32) -> u32 {
        edge_number(self.vertices.len() as u32, one, other)
    }

    /// The planes of its flat sides.
    pub(crate) fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// What borders on what.
    pub(crate) fn topology(&self) -> &Topology {
        &self.topology
    }

    /// The radius (m) of a ball around [`Self::middle`] that the hull holds.
    pub(crate) fn inner_radius(&self) -> f64 {
        self.inner_radius
    }

    /// The outward normals of its flat sides, unit length.
    pub(crate) fn face_normals(&self) -> impl Iterator<Item = DVec3> {
        self.planes.iter().map(|plane| plane.normal)
    }
}

fn edge_number(corners: u32, one: u32, other: u32) -> u32 {
    one.min(other).wrapping_mul(corners).wrapping_add(one.max(other))
}

/// The flat sides that triangles make together.
struct Sides {
    planes: Vec<Plane>,
    /// Their corners, anticlockwise from outside.
    outlines: Vec<Vec<u32>>,
    /// The side that each triangle belongs to.
    face_of: Vec<Option<u32>>,
}

impl Sides {
    /// Joins triangles that hang together and whose corners lie within `tolerance` (m) of a common plane. The largest
    /// triangles set the planes, so that slivers, whose normals are rounding, join a neighbour instead of making a side of
    /// their own.
    fn of(vertices: &[DVec3], triangles: &[[u32; 3]], tolerance: f64) -> Self {
        let corners = |triangle: [u32; 3]| triangle.map(|index| vertices[index as usize]);
        let cross = |triangle: [u32; 3]| {
            let [a, b, c] = corners(triangle);
            (b - a).cross(c - a)
        };
        let mut order: Vec<usize> = (0..triangles.len()).collect();
        let areas: Vec<f64> = triangles.iter().map(|&triangle| cross(triangle).length()).collect();
        order.sort_unstable_by(|&one, &other| areas[other].total_cmp(&areas[one]).then(one.cmp(&other)));
        let steps = |triangle: usize| {
            let [a, b, c] = triangles[triangle];
            [(a, b), (b, c), (c, a)]
        };
        let mut left_of: Vec<((u32, u32), usize)> =
            (0..triangles.len()).flat_map(|triangle| steps(triangle).map(|step| (step, triangle))).collect();
        left_of.sort_unstable();

        let mut sides =
            Self { planes: Vec::new(), outlines: Vec::new(), face_of: vec![None; triangles.len()] };
        for &seed in &order {
            let normal = cross(triangles[seed]).normalize_or_zero();
            if sides.face_of[seed].is_some() || normal == DVec3::ZERO {
                continue;
            }
            let [origin, ..] = corners(triangles[seed]);
            let face = Some(sides.planes.len() as u32);
            sides.face_of[seed] = face;
            let mut members = vec![seed];
            let mut next = 0;
            while next < members.len() {
                for (from, to) in steps(members[next]) {
                    let Ok(found) = left_of.binary_search_by(|other| other.0.cmp(&(to, from))) else {
                        continue;
                    };
                    let beyond = left_of[found].1;
                    let triangle = triangles[beyond];
                    let in_plane = corners(triangle)
                        .iter()
                        .all(|&point| (point - origin).dot(normal).abs() <= tolerance);
                    // Both sides of a plate thinner than the tolerance lie in the plane; only one looks this way.
                    if sides.face_of[beyond].is_none() && in_plane && cross(triangle).dot(normal) >= 0.0 {
                        sides.face_of[beyond] = face;
                        members.push(beyond);
                    }
                }
                next += 1;
            }
            let border: Vec<(u32, u32)> = members.into_iter().flat_map(steps).collect();
            sides.outlines.push(outline_of(&border).unwrap_or_else(|| triangles[seed].to_vec()));
            sides.planes.push(Plane { normal, offset: origin.dot(normal) });
        }
        sides
    }
}

/// The closed line that is left of `sides` when those passed both ways are gone; `None` if it is not one line.
fn outline_of(sides: &[(u32, u32)]) -> Option<Vec<u32>> {
    let mut sorted = sides.to_vec();
    sorted.sort_unstable();
    let mut border = sorted.clone();
    border.retain(|&(from, to)| sorted.binary_search(&(to, from)).is_err());
    if border.windows(2).any(|pair| pair[0].0 == pair[1].0) {
        return None;
    }
    let (start, mut next) = *border.first()?;
    let mut outline = vec![start];
    while next != start {
        outline.push(next);
        if outline.len() > border.len() {
            return None;
        }
        let onward = border.binary_search_by(|side| side.0.cmp(&next)).ok()?;
        next = border[onward].1;
    }
    (outline.len() == border.len()).then_some(outline)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mass::MassProperties;
    use crate::math::{DQuat, rotation_from_vector};
    use std::collections::BTreeSet;

    /// Numbers from 0 to 1, the same ones every time (Marsaglia 2003).
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    fn cube_cloud(turn: DQuat) -> Vec<DVec3> {
        let mut number = numbers(1);
        let mut points: Vec<DVec3> = (0..300)
            .map(|_| turn * (DVec3::new(number(), number(), number()) * 1.9 - DVec3::splat(0.95)))
            .collect();
        for corner in 0..8 {
            let side = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            points.insert(37 * corner, turn * DVec3::new(side(0), side(1), side(2)));
        }
        points
    }

    fn assert_closed_and_convex(hull: &Hull, points: &[DVec3], tolerance: f64) {
        let sides: Vec<(u32, u32)> =
            hull.triangles().iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).collect();
        let distinct: BTreeSet<(u32, u32)> = sides.iter().copied().collect();
        assert_eq!(distinct.len(), sides.len(), "a side passed twice the same way");
        assert!(sides.iter().all(|&(a, b)| distinct.contains(&(b, a))), "an open side");
        assert_eq!(hull.vertices().len() + hull.triangles().len(), sides.len() / 2 + 2, "Euler");
        for normal in hull.face_normals() {
            let highest = |points: &[DVec3]| points.iter().map(|p| p.dot(normal)).fold(f64::MIN, f64::max);
            assert!(highest(points) - highest(hull.vertices()) <= tolerance);
            let (_, corners) = hull.face_towards(normal);
            assert!(corners.len() >= 3);
            for &corner in corners {
                let height = hull.vertices()[corner as usize].dot(normal);
                assert!((height - highest(hull.vertices())).abs() <= tolerance, "{height}");
            }
        }
    }

    #[test]
    fn a_cloud_in_a_cube_becomes_the_cube() {
        for turn in [DQuat::IDENTITY, rotation_from_vector(DVec3::new(0.4, -1.1, 0.7))] {
            let points = cube_cloud(turn);
            let hull = Hull::new(&points).unwrap();
            assert_eq!((hull.vertices().len(), hull.triangles().len(), hull.planes.len()), (8, 12, 6));
            assert_closed_and_convex(&hull, &points, 1e-12);
            assert!((0..6).all(|side| hull.topology.ring(side).len() == 4) && hull.topology.is_closed());
            assert!(hull.vertices().iter().all(|vertex| points.contains(vertex)), "to the last bit");
            let mass = MassProperties::polyhedron(hull.vertices(), hull.triangles(), 700.0);
            let cube = MassProperties::cuboid(DVec3::splat(2.0), 700.0);
            assert!((mass.mass - cube.mass).abs() < 1e-9 * cube.mass);
            assert!(mass.center.length() < 1e-12);
            assert!(mass.inertia.abs_diff_eq(cube.inertia, 1e-9 * cube.inertia.x_axis.x));
        }
    }

    #[test]
    fn hulls_of_many_clouds_are_closed_and_hold_their_points() {
        let mut number = numbers(2);
        for round in 0..240 {
            let count = 8 + (number() * 150.0) as usize;
            let scale = 10_f64.powi(round % 9 - 4);
            let turn = rotation_from_vector(DVec3::new(number(), number(), number()) * 3.0);
            let points: Vec<DVec3> = (0..count)
                .map(|_| {
                    let p = DVec3::new(number(), number(), number());
                    let p = match round % 4 {
                        0 => p,
                        1 => (p * 4.0).floor(),
                        2 => (p - DVec3::splat(0.5)).normalize(),
                        _ => p * DVec3::new(1.0, 1e-3, 1.0),
                    };
                    turn * p * scale
                })
                .collect();
            let hull = Hull::new(&points).unwrap();
            for normal in hull.face_normals() {
                let highest = |p: &[DVec3]| p.iter().map(|p| p.dot(normal)).fold(f64::MIN, f64::max);
                assert!(highest(&points) - highest(hull.vertices()) <= 1e-9 * scale, "round {round}");
            }
            assert!(MassProperties::polyhedron(hull.vertices(), hull.triangles(), 1.0).mass > 0.0, "{round}");
        }
    }

    /// Clouds whose hulls have many corners: round, flat-sided, long and thin, nearly flat all over.
    fn many_cornered() -> Vec<Vec<DVec3>> {
        let mut number = numbers(5);
        let mut clouds = Vec::new();
        let stretches =
            [DVec3::ONE, DVec3::new(1.0, 1e-3, 1.0), DVec3::new(1.0, 1e-4, 1e-4), DVec3::new(9.0, 1.0, 0.3)];
        for round in 0..24 {
            let turn = rotation_from_vector(DVec3::new(number(), number(), number()) * 3.0);
            let stretch = stretches[round % 4];
            let count = 60 + (number() * 500.0) as usize;
            let ball = (0..count).map(|_| {
                let p = DVec3::new(number(), number(), number()) - DVec3::splat(0.5);
                turn * (p.normalize() * stretch)
            });
            clouds.push(ball.collect());
            // A prism: two sides with as many corners as there are others.
            let around = (0..count / 2).flat_map(|k| {
                let (sine, cosine) = (std::f64::consts::TAU * k as f64 / (count / 2) as f64).sin_cos();
                [-0.5, 0.5].map(|y| turn * (DVec3::new(sine, y, cosine) * stretch))
            });
            clouds.push(around.collect());
            // A cube cut fine, turned and rounded off; its sides bulge, dent or stay flat within rounding.
            let bulge = [0.0, 1e-12, 1e-10, 1e-8, 1e-4, 0.1][round / 4];
            let mut grid = Vec::new();
            for cell in 0..9_u32.pow(3) {
                let place = |k: u32| f64::from(cell / 9_u32.pow(k) % 9) / 4.0 - 1.0;
                let p = DVec3::new(place(0), place(1), place(2));
                if p.abs().max_element() == 1.0 {
                    let noise = DVec3::new(number(), number(), number()) * bulge * 0.1;
                    grid.push(turn * ((p * (1.0 - bulge * p.length_squared()) + noise) * stretch));
                }
            }
            clouds.push(grid);
        }
        clouds
    }

    #[test]
    fn the_climb_ends_at_the_highest_corner() {
        let mut number = numbers(6);
        let mut climbed = 0;
        for points in many_cornered() {
            let Ok(hull) = Hull::new(&points) else { continue };
            climbed += u32::from(hull.climb.is_some());
            let (low, high) = hull.bounds();
            let extent = (high - low).max_element();
            let random = (0..300).map(|_| DVec3::new(number(), number(), number()) - DVec3::splat(0.5));
            // Along the axes of the sides and of the edges, and hardly off them, many corners are nearly as high.
            let normals = hull.face_normals().flat_map(|n| [n, n + DVec3::splat(1e-9), n - DVec3::X * 1e-6]);
            let edges = hull.triangles().iter().map(|t| {
                let [a, b] = [t[0], t[1]].map(|index| hull.vertices()[index as usize]);
                (b - a).normalize_or_zero()
            });
            let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
            for direction in random.chain(normals).chain(edges).chain(axes).take(4000) {
                let height = |index: u32| hull.vertices()[index as usize].dot(direction);
                let (found, top) = (hull.highest(direction), hull.scan.highest(direction));
                assert!(
                    found == top || height(top) - height(found) <= 1e-12 * extent * direction.length(),
                    "{} of {} along {direction}",
                    height(top) - height(found),
                    hull.vertices().len(),
                );
            }
        }
        assert!(climbed >= 48, "only {climbed} of 72 are climbed at all");
    }

    #[test]
    fn the_side_that_faces_a_direction_is_at_the_highest_corner() {
        let mut number = numbers(7);
        for points in many_cornered() {
            let Ok(hull) = Hull::new(&points) else { continue };
            for _ in 0..200 {
                let direction = DVec3::new(number(), number(), number()) - DVec3::splat(0.5);
                let top = hull.highest(direction);
                let sides = hull.planes.iter().zip(0..);
                let here = sides.filter(|&(_, side)| hull.topology.ring(side).contains(&top));
                let best = here.map(|(plane, _)| plane.normal.dot(direction));
                let (found, _) = hull.face_towards(direction);
                let along = hull.planes[found as usize].normal.dot(direction);
                assert!(along >= best.fold(f64::NEG_INFINITY, f64::max));
            }
            for normal in hull.face_normals() {
                let (face, _) = hull.face_towards(normal);
                assert!(hull.planes[face as usize].normal.dot(normal) > 1.0 - 1e-9);
            }
        }
    }

    #[test]
    fn what_has_no_volume_is_refused() {
        let field = |points: &[DVec3]| Hull::new(points).map(|_| ()).unwrap_err().field;
        assert_eq!(field(&[]), "points");
        assert_eq!(field(&[DVec3::X, DVec3::Y, DVec3::Z]), "points");
        assert_eq!(field(&[DVec3::X; 20]), "points");
        let line: Vec<DVec3> = (0..9).map(|i| DVec3::new(1.0, 2.0, 3.0) * f64::from(i)).collect();
        assert_eq!(field(&line), "points");
        let turn = rotation_from_vector(DVec3::new(0.4, -1.1, 0.7));
        let plane: Vec<DVec3> =
            (0..25).map(|i| turn * DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5))).collect();
        assert_eq!(field(&plane), "points");
        let speck: Vec<DVec3> = cube_cloud(DQuat::IDENTITY).iter().map(|&point| point * 1e-8).collect();
        assert_eq!(field(&speck), "points");
        let mut broken = cube_cloud(DQuat::IDENTITY);
        broken[5].z = f64::INFINITY;
        assert_eq!(field(&broken), "points[5][2]");
        broken[5].z = -3e6;
        assert_eq!(field(&broken), "points[5][2]");
    }
}
