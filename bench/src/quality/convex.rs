//! How deep two convex solids overlap: the least distance by which one must be moved so that they only touch.
//!
//! Every solid is a *core* (a point, a segment or a polyhedron) with a ball of some radius rolled over it. If the cores
//! are a distance `d` apart, the solids overlap by `r_a + r_b − d`. If the cores intersect, they do by
//! `r_a + r_b + depth`, where the depth of two polyhedra is the least over finitely many directions: the normals of both
//! and the cross products of their edges (the faces of the Minkowski difference). Nothing iterates and nothing has a
//! tolerance that shows: a direction that is left out or rounded can only make the result larger, by as much as it is off.
//!
//! # Reference
//! Gottschalk, *Separating Axis Theorem*, TR96-024, UNC Chapel Hill (1996); Cameron and Culley, *Determining the Minimum
//! Translational Distance between Two Convex Polyhedra*, ICRA 1986.

use super::Pose;
use glam::DVec3;

/// A flat side of a polyhedron.
#[derive(Clone, Debug)]
pub struct Face {
    /// Unit vector outwards.
    pub normal: DVec3,
    /// Indices of its corners, counter-clockwise seen from outside.
    pub corners: Vec<usize>,
}

/// A core with a radius.
#[derive(Clone, Debug)]
pub struct Convex {
    /// Corners of the core, m: one is a point, two are a segment, more a polyhedron.
    pub vertices: Vec<DVec3>,
    /// Sides of a polyhedron; none of a point or a segment.
    pub faces: Vec<Face>,
    /// Unit vectors along all edges, parallel ones once.
    pub edges: Vec<DVec3>,
    /// What is rolled over the core, m.
    pub radius: f64,
}

/// The part of a line that a core covers when it is projected.
struct Shadow {
    low: f64,
    high: f64,
}

impl Convex {
    /// The same solid where the body is.
    pub fn placed(&self, pose: &Pose) -> Self {
        let turn = |vector: &DVec3| pose.rotation * *vector;
        Self {
            vertices: self.vertices.iter().map(|vertex| pose.point(*vertex)).collect(),
            faces: self
                .faces
                .iter()
                .map(|face| Face { normal: turn(&face.normal), corners: face.corners.clone() })
                .collect(),
            edges: self.edges.iter().map(turn).collect(),
            radius: self.radius,
        }
    }

    /// The lowest and highest coordinates of the solid, m.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let low = self.vertices.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.vertices.iter().copied().reduce(DVec3::max).unwrap_or_default();
        (low - self.radius, high + self.radius)
    }

    /// How deep two solids overlap, m; `None` where they do not.
    pub fn overlap(&self, other: &Convex) -> Option<f64> {
        let radii = self.radius + other.radius;
        let depth = match (self.is_solid(), other.is_solid()) {
            (false, false) => -self.segment().distance(&other.segment()),
            (true, false) => match self.core_depth(other, radii)? {
                apart if apart < 0.0 => -self.distance_to_segment(&other.segment()),
                depth => depth,
            },
            (false, true) => return other.overlap(self),
            (true, true) => self.core_depth(other, radii)?,
        };
        let overlap = radii + depth;
        (overlap > 0.0).then_some(overlap)
    }

    fn is_solid(&self) -> bool {
        !self.faces.is_empty()
    }

    /// A point or a segment as a segment.
    fn segment(&self) -> Segment {
        Segment { start: self.vertices[0], end: self.vertices[self.vertices.len() - 1] }
    }

    fn shadow(&self, direction: DVec3) -> Shadow {
        let mut shadow = Shadow { low: f64::INFINITY, high: f64::NEG_INFINITY };
        for vertex in &self.vertices {
            let place = direction.dot(*vertex);
            shadow.low = shadow.low.min(place);
            shadow.high = shadow.high.max(place);
        }
        shadow
    }

    /// The depth of two cores, one of them a polyhedron: exact where they intersect, negative (and no more than the sign
    /// is right) where they are apart, `None` where they are farther apart than `reach`.
    fn core_depth(&self, other: &Convex, reach: f64) -> Option<f64> {
        let normals = self.faces.iter().chain(&other.faces).map(|face| face.normal);
        let crosses =
            self.edges.iter().flat_map(|a| other.edges.iter().filter_map(|b| a.cross(*b).try_normalize()));
        let mut least = f64::INFINITY;
        for direction in normals.chain(crosses) {
            let (a, b) = (self.shadow(direction), other.shadow(direction));
            let depth = (a.high - b.low).min(b.high - a.low);
            if depth <= -reach {
                return None;
            }
            least = least.min(depth);
        }
        Some(least)
    }

    /// How far a segment is from this polyhedron, which it does not meet: one end of the shortest connection is an end of
    /// the segment above a face, or the other lies on an edge.
    fn distance_to_segment(&self, segment: &Segment) -> f64 {
        let mut least = f64::INFINITY;
        for face in &self.faces {
            for (start, end) in self.sides(face) {
                least = least.min(segment.distance(&Segment { start, end }));
            }
            for point in [segment.start, segment.end] {
                let above = self.sides(face).all(|(start, end)| {
                    face.normal.cross(end - start).dot(point - start) >= 0.0 // Inwards of this side.
                });
                if above {
                    least = least.min((point - self.vertices[face.corners[0]]).dot(face.normal).abs());
                }
            }
        }
        least
    }

    /// The sides of a face, each from corner to corner.
    fn sides(&self, face: &Face) -> impl Iterator<Item = (DVec3, DVec3)> {
        let next = face.corners.iter().cycle().skip(1);
        face.corners.iter().zip(next).map(|(a, b)| (self.vertices[*a], self.vertices[*b]))
    }
}

/// A straight line between two points, which may be one and the same.
#[derive(Clone, Copy, Debug)]
struct Segment {
    start: DVec3,
    end: DVec3,
}

impl Segment {
    /// The least distance of two segments: that of the lines if its ends lie within both, else that of an end.
    fn distance(&self, other: &Segment) -> f64 {
        let ends = [
            self.distance_to(other.start),
            self.distance_to(other.end),
            other.distance_to(self.start),
            other.distance_to(self.end),
        ];
        let least = ends.into_iter().fold(f64::INFINITY, f64::min);
        let (u, v, w) = (self.end - self.start, other.end - other.start, self.start - other.start);
        let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
        let determinant = uu * vv - uv * uv;
        // Of parallel segments an end is as near as anything.
        if determinant <= 1e-14 * uu * vv {
            return least;
        }
        let s = (uv * v.dot(w) - vv * u.dot(w)) / determinant;
        let t = (uu * v.dot(w) - uv * u.dot(w)) / determinant;
        let within = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
        if within { least.min((w + s * u - t * v).length()) } else { least }
    }

    fn distance_to(&self, point: DVec3) -> f64 {
        let along = self.end - self.start;
        let squared = along.length_squared();
        let part =
            if squared > 0.0 { ((point - self.start).dot(along) / squared).clamp(0.0, 1.0) } else { 0.0 };
        point.distance(self.start + part * along)
    }
}

#[cfg(test)]
mod tests {
    use super::super::solid::Solid;
    use super::*;
    use crate::scene::Shape;
    use glam::DQuat;
    use std::f64::consts::FRAC_PI_4;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        Pose { position: DVec3::new(x, y, z), rotation: DQuat::IDENTITY }
    }

    fn overlap(a: &Shape, pose_a: Pose, b: &Shape, pose_b: Pose) -> f64 {
        let placed = |shape: &Shape, pose| Solid::of(shape).convex.expect("convex").placed(&pose);
        let (a, b) = (placed(a, pose_a), placed(b, pose_b));
        let (ab, ba) = (a.overlap(&b).unwrap_or(0.0), b.overlap(&a).unwrap_or(0.0));
        assert!((ab - ba).abs() < 1e-12, "the order does not matter: {ab} {ba}");
        ab
    }

    #[track_caller]
    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-7, "{found} is not {expected}");
    }

    const BALL: Shape = Shape::Sphere { radius: 0.5 };
    const CUBE: Shape = Shape::Cuboid { half: [0.5; 3] };
    const PILL: Shape = Shape::Capsule { half_height: 1.0, radius: 0.25 };

    #[test]
    fn balls() {
        near(overlap(&BALL, at(0.0, 0.0, 0.0), &BALL, at(0.0, 0.9, 0.0)), 0.1);
        near(overlap(&BALL, at(0.0, 0.0, 0.0), &BALL, at(0.6, 0.0, 0.6)), 1.0 - 0.72_f64.sqrt());
        near(overlap(&BALL, at(0.0, 0.0, 0.0), &BALL, at(0.0, 0.0, 0.0)), 1.0);
        near(overlap(&BALL, at(0.0, 0.0, 0.0), &BALL, at(1.0, 0.1, 0.0)), 0.0);
    }

    #[test]
    fn boxes_face_to_face_edge_to_edge_and_apart() {
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &CUBE, at(0.3, 0.95, 0.2)), 0.05);
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &CUBE, at(0.3, 1.05, 0.2)), 0.0);
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &CUBE, at(0.0, 0.0, 0.0)), 1.0);
        // Edge across edge: one turned by 45° about x, the other about z, one above the other.
        let a = Pose { rotation: DQuat::from_rotation_x(FRAC_PI_4), ..at(0.0, 0.0, 0.0) };
        let b = Pose { rotation: DQuat::from_rotation_z(FRAC_PI_4), ..at(0.0, 2.0_f64.sqrt() - 0.02, 0.0) };
        near(overlap(&CUBE, a, &CUBE, b), 0.02);
        // A corner in a face.
        let tip = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Y);
        let corner = Pose { rotation: tip, ..at(0.1, 0.5 + 0.75_f64.sqrt() - 0.03, 0.1) };
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &CUBE, corner), 0.03);
    }

    #[test]
    fn ball_and_box_outside_at_an_edge_and_deep_inside() {
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &BALL, at(0.1, 0.97, 0.1)), 0.03);
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &BALL, at(0.7, 0.7, 0.1)), 0.5 - 0.08_f64.sqrt());
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &BALL, at(0.0, 0.4, 0.1)), 0.5 + 0.1);
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &BALL, at(0.9, 0.9, 0.5)), 0.0);
    }

    #[test]
    fn capsules_crossing_parallel_end_on_and_through_a_box() {
        let lying = Pose { rotation: DQuat::from_rotation_z(2.0 * FRAC_PI_4), ..at(0.0, 0.0, 0.45) };
        near(overlap(&PILL, at(0.0, 0.0, 0.0), &PILL, lying), 0.05);
        near(overlap(&PILL, at(0.0, 0.0, 0.0), &PILL, at(0.4, 1.5, 0.0)), 0.1);
        near(overlap(&PILL, at(0.0, 0.0, 0.0), &PILL, at(0.0, 2.4, 0.0)), 0.1);
        near(overlap(&PILL, at(0.0, 0.0, 0.0), &CUBE, at(0.0, 1.7, 0.0)), 0.05);
        // Across a box's edge: the segment is near neither a face's inside nor a corner.
        let across = Pose { rotation: DQuat::from_rotation_x(-FRAC_PI_4), ..at(0.0, 0.6, 0.6) };
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &PILL, across), 0.25 - 0.02_f64.sqrt());
        // In at the edge and past the middle: out sideways, by half the box and the radius.
        let into = Pose { rotation: DQuat::from_rotation_x(FRAC_PI_4), ..at(0.0, 0.6, 0.6) };
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &PILL, into), 0.5 + 0.25);
        // Right through the middle: out to the side, by half the box and the radius.
        near(overlap(&CUBE, at(0.0, 0.0, 0.0), &PILL, at(0.1, 0.0, 0.0)), 0.4 + 0.25);
    }

    /// Random pairs of all kinds near touching against parry's query, an implementation with nothing in common.
    #[test]
    fn parry_agrees() {
        use parry3d_f64::query::contact;
        use parry3d_f64::shape::SharedShape;
        let scene = (crate::scene::find("pile_mixed").unwrap().build)(crate::scene::Size {
            count: Some(40),
            base: None,
        });
        let theirs = |shape: &Shape| match shape {
            Shape::Sphere { radius } => SharedShape::ball(f64::from(*radius)),
            Shape::Cuboid { half } => SharedShape::cuboid(half[0].into(), half[1].into(), half[2].into()),
            Shape::Capsule { half_height, radius } => {
                SharedShape::capsule_y(f64::from(*half_height), f64::from(*radius))
            }
            Shape::Hull(points) => {
                let points: Vec<DVec3> = points.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
                SharedShape::convex_hull(&points).expect("a hull")
            }
            Shape::Mesh(_) => unreachable!("no dynamic body is a mesh"),
        };
        let bodies: Vec<_> = scene.bodies.iter().filter(|body| !body.fixed).collect();
        let mut met = 0;
        for (i, a) in bodies.iter().enumerate() {
            for (j, b) in bodies.iter().enumerate().skip(i + 1) {
                // Brought together along a line, from apart to deep.
                let turn = |rotation: [f32; 4]| Pose::from_single([0.0; 3], rotation).rotation;
                let away = (turn(a.rotation) * turn(b.rotation)) * DVec3::X;
                let gap = 0.6 + 0.05 * ((i * 7 + j * 3) % 10) as f64;
                let pose_a = Pose { position: DVec3::ZERO, rotation: turn(a.rotation) };
                let pose_b = Pose { position: gap * away, rotation: turn(b.rotation) };
                let ours = overlap(&a.shape, pose_a, &b.shape, pose_b);
                let place = |pose: Pose| parry3d_f64::math::Pose::from_parts(pose.position, pose.rotation);
                let (shape_a, shape_b) = (theirs(&a.shape), theirs(&b.shape));
                let found = contact(&place(pose_a), &*shape_a, &place(pose_b), &*shape_b, 0.0);
                let depth = found.ok().flatten().map_or(0.0, |contact| -contact.dist).max(0.0);
                met += usize::from(ours > 0.0);
                // Parry finds penetration of capsules by a walk that stops within 1e-4 or so; all else is to rounding.
                let walked = [a, b].iter().any(|body| matches!(body.shape, Shape::Capsule { .. }));
                let tolerance = if walked { 1e-4 } else { 1e-12 };
                assert!(
                    (ours - depth).abs() < tolerance,
                    "{:?} {:?}: {ours}, parry {depth}",
                    a.shape,
                    b.shape
                );
            }
        }
        assert!(met > 300, "{met} pairs met");
    }
}
