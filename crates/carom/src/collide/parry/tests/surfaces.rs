//! Meshes, and what lies on them.

use super::*;

#[test]
fn a_floor_of_two_triangles_carries_like_a_plane() {
    let floor = floor();
    let mut number = numbers(15);
    let shapes: Vec<Shape> = rare().into_iter().chain(common()).collect();
    for shape in &shapes {
        for round in 0..40 {
            // Every fourth one right over the seam.
            let mut place = pose(&mut number, 1.0);
            if round % 4 == 0 {
                place.position.z = place.position.x;
            }
            let lowest = farthest(shape, &place, DVec3::NEG_Y);
            place.position.y -= lowest.y - [-0.02, -1e-4, 0.0, 1e-4, 0.005][round % 5];
            let height = farthest(shape, &place, DVec3::NEG_Y).y;
            let found = separation(&floor, &Pose::IDENTITY, shape, &place);
            assert!((found - height).abs() < 1e-6, "{shape:?} {place:?} {found} {height}");
            let manifolds = checked_manifolds((&floor, &Pose::IDENTITY), (shape, &place), 0.01);
            assert!(!manifolds.is_empty() && manifolds.len() <= 2, "{shape:?} {place:?}");
            for manifold in &manifolds {
                assert!(manifold.normal.distance(DVec3::Y) < 1e-6, "{shape:?} {}", manifold.normal);
            }
            // Points stand on the other shape's side, which may rise a little from the very lowest point.
            assert!(
                least(&manifolds) >= height - 1e-7 && least(&manifolds) < height + 2e-3,
                "{shape:?} {place:?} {} {height}",
                least(&manifolds)
            );
            let turned = checked_manifolds((shape, &place), (&floor, &Pose::IDENTITY), 0.01);
            assert!(turned.iter().all(|m| m.normal.distance(DVec3::NEG_Y) < 1e-6));
        }
    }
}

#[test]
fn a_ball_on_a_seam_touches_once_and_a_box_at_its_corners() {
    let floor = floor();
    let ball = checked_manifolds((&floor, &Pose::IDENTITY), (&Shape::sphere(0.5), &at(1.0, 0.5, 1.0)), 0.01);
    assert_eq!(ball.iter().map(|m| m.points().len()).sum::<usize>(), 1);
    assert!(ball[0].points()[0].point.distance(DVec3::new(1.0, 0.0, 1.0)) < 1e-9);
    assert_eq!(ball[0].points()[0].feature_b, Feature::Surface);

    for shape in [Shape::cuboid(1.0, 1.0, 1.0), box_hull(DVec3::ONE)] {
        let place = at(0.2, 0.499, 0.0);
        let manifolds = checked_manifolds((&floor, &Pose::IDENTITY), (&shape, &place), 0.01);
        for x in [-0.5, 0.5] {
            for z in [-0.5, 0.5] {
                let corner = DVec3::new(0.2 + x, -0.0005, z);
                let mut points = manifolds.iter().flat_map(|m| m.points());
                assert!(points.any(|p| p.point.distance(corner) < 1e-7), "{corner} {manifolds:?}");
            }
        }
    }
}

#[test]
fn a_mesh_is_solid_from_both_sides_and_ends_at_its_border() {
    let floor = floor();
    let ball = Shape::sphere(0.5);
    let below = at(1.0, -0.45, 0.3);
    let found = checked_manifolds((&floor, &Pose::IDENTITY), (&ball, &below), 0.01);
    assert!(found.len() == 1 && found[0].normal.distance(DVec3::NEG_Y) < 1e-9);
    assert!((least(&found) + 0.05).abs() < 1e-9);
    // Beside the border, as near as its edge.
    let beside = at(5.3, 0.4, 0.0);
    assert!(separation(&floor, &Pose::IDENTITY, &ball, &beside).abs() < 1e-9);
    let found = checked_manifolds((&floor, &Pose::IDENTITY), (&ball, &beside), 0.01);
    assert!(found[0].normal.distance(DVec3::new(0.6, 0.8, 0.0)) < 1e-9);
    // Far off, a lower bound that grows with the distance.
    for height in [2.0, 10.0, 1000.0] {
        let found = separation(&floor, &Pose::IDENTITY, &ball, &at(0.0, height, 0.0));
        assert!(found > 0.1 && found <= height - 0.5, "{found}");
    }
}

#[test]
fn meshes_meet_planes_and_meshes() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::Y];
    let faces = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let pyramid = Shape::mesh(corners.to_vec(), faces).unwrap();
    for height in [0.3, 0.0, -0.01] {
        let place = at(0.5, height, 0.4);
        assert!((separation(&pyramid, &place, &Shape::Plane, &Pose::IDENTITY) - height).abs() < 1e-12);
        let found = checked_manifolds((&Shape::Plane, &Pose::IDENTITY), (&pyramid, &place), 0.01);
        assert_eq!(found.first().map_or(0, |m| m.points().len()), if height > 0.01 { 0 } else { 3 });
    }
    let floor = floor();
    for height in [0.2, 1e-3] {
        let place = at(0.5, height, 0.4);
        let found = separation(&floor, &Pose::IDENTITY, &pyramid, &place);
        assert!((found - height).abs() < 1e-9, "{found}");
    }
    let found = checked_manifolds((&floor, &Pose::IDENTITY), (&pyramid, &at(0.5, 1e-3, 0.4)), 0.01);
    assert!((least(&found) - 1e-3).abs() < 1e-9 && found[0].normal.distance(DVec3::Y) < 1e-6);
}

/// A ball of many corners, and a ground of hills.
fn ball_over_hills() -> (Shape, crate::mesh::Mesh) {
    let mut number = numbers(31);
    let points: Vec<DVec3> =
        (0..400).map(|_| DVec3::new(number(), number(), number()).normalize() * 0.7).collect();
    let vertices = (0..16 * 16).map(|k| {
        let (x, z) = (f64::from(k % 16) - 7.5, f64::from(k / 16) - 7.5);
        DVec3::new(0.2 * x, 0.1 * number(), 0.2 * z)
    });
    let vertices: Vec<DVec3> = vertices.collect();
    let cells = (0..16 * 15).filter(|k| k % 16 < 15);
    let triangles = cells.flat_map(|k| [[k, k + 16, k + 1], [k + 1, k + 16, k + 17]]).collect();
    (Shape::hull(&points).unwrap(), crate::mesh::Mesh::new(vertices, triangles).unwrap())
}

#[test]
fn what_a_mesh_leaves_unmeasured_changes_nothing() {
    let (ball, mesh) = ball_over_hills();
    let mut number = numbers(32);
    for _ in 0..60 {
        let (pose_a, mut pose_b) = (pose(&mut number, 0.5), pose(&mut number, 0.8));
        pose_b.position += pose_a.rotation * DVec3::Y * (0.7 + 0.3 * number());
        let inner = pose_a.relative(&pose_b);
        let Kind::Convex(convex) = Kind::of(&ball) else { unreachable!() };
        let gaps: Vec<f64> = (0..mesh.triangles().len() as u32)
            .map(|index| {
                let (corners, vertices) = (mesh.corners(index), mesh.triangles()[index as usize]);
                axis::least_gap(&Core::Triangle { corners, index, vertices }, &convex.core, &inner).gap
            })
            .collect();
        let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
        let shape = Shape::Mesh(mesh.clone().into());
        let found = separation(&shape, &pose_a, &ball, &pose_b);
        assert!((found - least).abs() <= 1e-12 || (least > 0.3 && found > 0.3), "{found} {least}");
        for margin in [0.0, 0.02, 0.3] {
            let mut manifolds = Vec::new();
            super::manifolds((&shape, &pose_a), (&ball, &pose_b), margin, &mut manifolds);
            assert_eq!(manifolds.is_empty(), least > margin, "{least} {margin}");
            assert!(manifolds.len() <= gaps.iter().filter(|&&gap| gap <= margin).count());
        }
    }
}

#[test]
fn a_tip_between_ridges_and_valleys_carries_a_ball() {
    // Every triangle of the star has a ridge on one side and a valley on the other.
    let ring = (0..8).map(|k| {
        let (sine, cosine) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
        let (radius, height) = if k % 2 == 0 { (1.0, -0.3) } else { (0.4, -0.6) };
        DVec3::new(radius * sine, height, radius * cosine)
    });
    let vertices: Vec<DVec3> = [DVec3::ZERO].into_iter().chain(ring).collect();
    let star = Shape::mesh(vertices, (0..8).map(|k| [0, 1 + k, 1 + (k + 1) % 8]).collect()).unwrap();
    for depth in [1e-3, 1e-9, 0.0] {
        let ball = at(0.0, 0.2 - depth, 0.0);
        let found = checked_manifolds((&star, &Pose::IDENTITY), (&Shape::sphere(0.2), &ball), 1e-6);
        assert!((least(&found) + depth).abs() < 1e-9, "{depth}: {found:?}");
        assert!(found[0].normal.distance(DVec3::Y) < 1e-6);
    }
}

#[test]
fn a_border_beside_an_obtuse_corner_is_a_border() {
    // The border lies along x; the side that the two triangles share leans over it.
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(-1.0, 0.0, -1.0), DVec3::new(-2.0, 0.0, 0.0)];
    let floor = Shape::mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap();
    let beside = at(0.1, 0.4, 0.3);
    let found = checked_manifolds((&floor, &Pose::IDENTITY), (&Shape::sphere(0.5), &beside), 0.01);
    assert_eq!(found.len(), 1);
    assert!(found[0].normal.distance(DVec3::new(0.0, 0.8, 0.6)) < 1e-9, "{}", found[0].normal);
}
