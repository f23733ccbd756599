//! Contacts known by hand: normal, points, separations and the features' names.

use crate::support::{at, gap, touch};
use carom::Shape;
use carom::collide::Manifold;
use carom::math::{DQuat, DVec3, Pose};
use carom::report::Feature::{Edge, Face, Surface, Vertex};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn close(a: DVec3, b: [f64; 3]) -> bool {
    a.distance(DVec3::from_array(b)) < 1e-12
}

fn cube() -> Shape {
    Shape::cuboid(1.0, 1.0, 1.0)
}

/// A unit cube that stands on its corner number 0, with that corner at `tip`.
fn on_corner(tip: [f64; 3]) -> (Shape, Pose) {
    let rotation = DQuat::from_rotation_arc(DVec3::splat(-1.0).normalize(), DVec3::NEG_Y);
    let corner = rotation * DVec3::splat(-0.5);
    (cube(), Pose::new(DVec3::from_array(tip) - corner, rotation))
}

fn single(manifold: &Manifold) -> carom::collide::ContactPoint {
    assert_eq!(manifold.points().len(), 1, "{manifold:?}");
    manifold.points()[0]
}

#[test]
fn ball_on_ball() {
    let a = at(Shape::sphere(1.0), [0.0; 3], [0.0; 3]);
    let b = at(Shape::sphere(0.5), [1.4, 0.0, 0.0], [0.0; 3]);
    let manifold = touch(&a, &b, 0.0).unwrap();
    let point = single(&manifold);
    assert_eq!(manifold.normal, DVec3::X);
    assert!(close(point.point, [0.95, 0.0, 0.0]));
    assert!((point.separation + 0.1).abs() < 1e-15);
    assert_eq!((point.feature_a, point.feature_b), (Surface, Surface));
}

#[test]
fn box_corner_on_plane() {
    let plane = at(Shape::plane(), [0.0; 3], [0.0; 3]);
    let cube = on_corner([0.3, -0.01, 0.2]);
    let manifold = touch(&cube, &plane, 0.0).unwrap();
    let point = single(&manifold);
    assert!(close(manifold.normal, [0.0, -1.0, 0.0]));
    assert!(close(point.point, [0.3, -0.005, 0.2]));
    assert!((point.separation + 0.01).abs() < 1e-12);
    assert_eq!((point.feature_a, point.feature_b), (Vertex(0), Surface));
}

#[test]
fn box_level_on_plane() {
    let plane = at(Shape::plane(), [0.0; 3], [0.0; 3]);
    let manifold = touch(&plane, &at(cube(), [0.0, 0.5, 0.0], [0.0; 3]), 0.0).unwrap();
    assert!(close(manifold.normal, [0.0, 1.0, 0.0]));
    let mut corners: Vec<_> = manifold.points().iter().map(|p| p.feature_b).collect();
    corners.sort();
    assert_eq!(corners, [Vertex(0), Vertex(1), Vertex(4), Vertex(5)]);
    assert!(manifold.points().iter().all(|p| p.separation == 0.0 && p.point.y == 0.0));
}

#[test]
fn corner_on_face() {
    let floor = at(Shape::cuboid(4.0, 1.0, 4.0), [0.0, -0.5, 0.0], [0.0; 3]);
    for height in [-0.01, 0.0, 0.01] {
        let cube = on_corner([0.3, height, 0.2]);
        let manifold = touch(&floor, &cube, 0.02).unwrap();
        let point = single(&manifold);
        assert!(close(manifold.normal, [0.0, 1.0, 0.0]));
        assert!(close(point.point, [0.3, 0.5 * height, 0.2]));
        assert!((point.separation - height).abs() < 1e-12);
        assert!((gap(&floor, &cube) - height).abs() < 1e-12);
        assert_eq!((point.feature_a, point.feature_b), (Face(3), Vertex(0)));
        let point = single(&touch(&cube, &floor, 0.02).unwrap());
        assert_eq!((point.feature_a, point.feature_b), (Vertex(0), Face(3)));
    }
}

#[test]
fn edge_on_edge_at_right_angles() {
    // a's upper edge along z and b's lower edge along x, crossing over the origin.
    let tilt = 0.5 * 2_f64.sqrt();
    let a = at(cube(), [0.0, -tilt, 0.1], [0.0, 0.0, FRAC_PI_4]);
    for height in [-0.01, 0.0, 0.01] {
        let b = at(cube(), [-0.2, tilt + height, 0.0], [FRAC_PI_4, 0.0, 0.0]);
        let manifold = touch(&a, &b, 0.05).unwrap();
        let point = single(&manifold);
        assert!(close(manifold.normal, [0.0, 1.0, 0.0]), "{manifold:?}");
        assert!(close(point.point, [0.0, 0.5 * height, 0.0]));
        assert!((point.separation - height).abs() < 1e-12);
        assert!((gap(&a, &b) - height).abs() < 1e-12);
        // Along z at +x, +y; along x at −y, +z.
        assert_eq!((point.feature_a, point.feature_b), (Edge(8 + 1 + 2), Edge(2)));
    }
}

#[test]
fn an_edge_askew_on_a_side_touches_at_both_its_crossings() {
    // b's lower edge lies along x on a's upper side, a hair askew, and overlaps it: the shortest way out is at a right angle to this edge and
    // one of the side's. A single point there would let b turn into a over the other.
    let tilt = 0.5 * 2_f64.sqrt();
    let corners = |half: [f64; 3]| {
        let sign = |bit: usize, axis: usize| if bit >> axis & 1 == 1 { half[axis] } else { -half[axis] };
        (0..8).map(|bit| DVec3::new(sign(bit, 0), sign(bit, 1), sign(bit, 2))).collect::<Vec<_>>()
    };
    let shapes = |half: [f64; 3]| {
        let [x, y, z] = half.map(|half| 2.0 * half);
        [Shape::cuboid(x, y, z), Shape::hull(&corners(half)).unwrap()]
    };
    for (a, b) in shapes([0.4, 0.5, 0.4]).into_iter().zip(shapes([0.7, 0.5, 0.5])) {
        let lower = at(a, [0.0, -0.5, 0.0], [0.0; 3]);
        for askew in [-0.02, -0.005, 0.0, 0.005, 0.02] {
            let upper = Pose::new(
                DVec3::new(0.0, tilt - 0.02, 0.0),
                DQuat::from_rotation_z(askew) * DQuat::from_rotation_x(FRAC_PI_4),
            );
            let manifold = touch(&lower, &(b.clone(), upper), 0.05).unwrap();
            let mut ends: Vec<f64> = manifold.points().iter().map(|point| point.point.x).collect();
            ends.sort_by(f64::total_cmp);
            assert!(ends.first().is_some_and(|&x| x < -0.35), "askew {askew}: {manifold:?}");
            assert!(ends.last().is_some_and(|&x| x > 0.35), "askew {askew}: {manifold:?}");
        }
    }
}

#[test]
fn capsule_on_face() {
    let floor = at(Shape::cuboid(4.0, 1.0, 4.0), [0.0, -0.5, 0.0], [0.0; 3]);
    let capsule = at(Shape::capsule(2.0, 0.25), [0.5, 0.24, 0.0], [0.0, 0.0, FRAC_PI_2]);
    let manifold = touch(&capsule, &floor, 0.0).unwrap();
    assert!(close(manifold.normal, [0.0, -1.0, 0.0]));
    assert_eq!(manifold.points().len(), 2);
    for (point, x) in manifold.points().iter().zip([1.5, -0.5]) {
        assert!(close(point.point, [x, -0.005, 0.0]), "{point:?}");
        assert!((point.separation + 0.01).abs() < 1e-12);
        assert_eq!((point.feature_a, point.feature_b), (Surface, Face(3)));
    }
}

#[test]
fn capsule_that_reaches_beyond_a_face() {
    let floor = at(Shape::cuboid(4.0, 1.0, 4.0), [0.0, -0.5, 0.0], [0.0; 3]);
    let capsule = at(Shape::capsule(2.0, 0.25), [1.5, 0.25, 0.0], [0.0, 0.0, FRAC_PI_2]);
    let manifold = touch(&floor, &capsule, 1e-9).unwrap();
    assert_eq!(manifold.points().len(), 2);
    assert!(close(manifold.points()[0].point, [2.0, 0.0, 0.0]));
    assert!(close(manifold.points()[1].point, [0.5, 0.0, 0.0]));
    // The edge along z at +x, +y.
    assert_eq!(manifold.points()[0].feature_a, Edge(8 + 1 + 2));
    assert_eq!(manifold.points()[1].feature_a, Face(3));
}

#[test]
fn capsule_over_the_edge_of_a_box_hangs_down_a_little() {
    // Its side touches the box's edge; the other end is a hair above the face.
    let floor = at(Shape::cuboid(4.0, 1.0, 4.0), [0.0, -0.5, 0.0], [0.0; 3]);
    let capsule = at(Shape::capsule(2.0, 0.25), [2.1, 0.25, 0.0], [0.0, 0.0, FRAC_PI_2 - 0.01]);
    let manifold = touch(&capsule, &floor, 0.05).unwrap();
    assert_eq!(manifold.points().len(), 2, "{manifold:?}");
    let least = manifold.points().iter().map(|p| p.separation).fold(f64::INFINITY, f64::min);
    assert!((least - gap(&capsule, &floor)).abs() < 1e-12);
}

#[test]
fn capsule_standing_and_lying_on_a_plane() {
    let plane = at(Shape::plane(), [0.0; 3], [0.0; 3]);
    let standing = at(Shape::capsule(1.0, 0.25), [0.0, 0.75, 0.0], [0.0; 3]);
    let point = single(&touch(&standing, &plane, 0.01).unwrap());
    assert!(close(point.point, [0.0; 3]));
    let lying = at(Shape::capsule(1.0, 0.25), [0.0, 0.25, 0.0], [FRAC_PI_2, 0.0, 0.0]);
    let manifold = touch(&lying, &plane, 0.01).unwrap();
    assert_eq!(manifold.points().len(), 2);
    assert!(close(manifold.points()[0].point, [0.0, 0.0, -0.5]));
    assert!(close(manifold.points()[1].point, [0.0, 0.0, 0.5]));
}

#[test]
fn capsules_side_by_side_and_crossed() {
    let a = at(Shape::capsule(2.0, 0.5), [0.0; 3], [0.0; 3]);
    let b = at(Shape::capsule(2.0, 0.25), [0.7, 0.5, 0.0], [0.0; 3]);
    let manifold = touch(&a, &b, 0.0).unwrap();
    assert_eq!(manifold.normal, DVec3::X);
    assert_eq!(manifold.points().len(), 2);
    assert!(close(manifold.points()[0].point, [0.475, -0.5, 0.0]), "{manifold:?}");
    assert!(close(manifold.points()[1].point, [0.475, 1.0, 0.0]));
    let crossed = at(Shape::capsule(2.0, 0.25), [0.7, 0.5, 0.0], [FRAC_PI_2, 0.0, 0.0]);
    let point = single(&touch(&a, &crossed, 0.0).unwrap());
    assert!(close(point.point, [0.475, 0.5, 0.0]));
    let end_to_end = at(Shape::capsule(2.0, 0.25), [0.0, 2.7, 0.0], [0.0; 3]);
    let manifold = touch(&a, &end_to_end, 0.0).unwrap();
    assert_eq!(manifold.normal, DVec3::Y);
    assert!((single(&manifold).separation + 0.05).abs() < 1e-12);
}

#[test]
fn box_on_box_with_an_offset() {
    let lower = at(cube(), [0.0; 3], [0.0; 3]);
    for lift in [-1e-3, 0.0, 1e-3] {
        let upper = at(cube(), [0.25, 1.0 + lift, 0.0], [0.0; 3]);
        let manifold = touch(&lower, &upper, 0.01).unwrap();
        assert_eq!(manifold.normal, DVec3::Y);
        assert_eq!(manifold.points().len(), 4);
        let mut places: Vec<_> = manifold.points().iter().map(|p| (p.point.x, p.point.z)).collect();
        places.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(places, [(-0.25, -0.5), (-0.25, 0.5), (0.5, -0.5), (0.5, 0.5)]);
        for point in manifold.points() {
            assert!((point.separation - lift).abs() < 1e-15);
            assert!((point.point.y - 0.5 - 0.5 * lift).abs() < 1e-15);
            // The upper box's corners stand on the face; at the other end edges cross.
            match (point.feature_a, point.feature_b) {
                (Face(3), Vertex(corner)) => assert!(point.point.x < 0.0 && (corner == 0 || corner == 4)),
                (Edge(_), Edge(_)) => assert!(point.point.x > 0.0),
                other => panic!("{other:?}"),
            }
        }
    }
}

#[test]
fn equal_boxes_stacked_flush_keep_their_corners() {
    let lower = at(cube(), [0.0; 3], [0.0; 3]);
    for noise in [0.0, 1e-16, -1e-15, 1e-13] {
        let upper = at(cube(), [noise, 1.0 + noise, -noise], [0.0, noise, 0.0]);
        let manifold = touch(&lower, &upper, 0.01).unwrap();
        let mut corners: Vec<_> = manifold.points().iter().map(|p| p.feature_b).collect();
        corners.sort();
        assert_eq!(corners, [Vertex(0), Vertex(1), Vertex(4), Vertex(5)], "{noise}: {manifold:?}");
    }
}

#[test]
fn a_box_resting_a_hair_askew_keeps_four_points() {
    let lower = at(cube(), [0.0; 3], [0.0; 3]);
    for size in [1e-9, 1e-7, 1e-5, 1e-3, 1e-2] {
        for (x, z) in [(1.0, 0.3), (-0.2, 1.0), (0.7, 0.7)] {
            for (dx, dz) in [(0.0, 0.0), (0.3, 0.2), (-0.25, 0.0)] {
                let upper = at(cube(), [dx, 1.0, dz], [size * x, 0.4 * size, size * z]);
                let manifold = touch(&lower, &upper, 0.03).unwrap();
                assert_eq!(manifold.points().len(), 4, "{size} {manifold:?}");
                let least = manifold.points().iter().map(|p| p.separation).fold(f64::INFINITY, f64::min);
                assert!((least - gap(&lower, &upper)).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn box_on_box_turned_by_an_eighth() {
    let lower = at(cube(), [0.0; 3], [0.0; 3]);
    let upper = at(cube(), [0.0, 0.999, 0.0], [0.0, FRAC_PI_4, 0.0]);
    let manifold = touch(&lower, &upper, 0.0).unwrap();
    assert_eq!(manifold.points().len(), 4);
    // Every other corner of a regular octagon: a square of side 0.765.
    for (i, p) in manifold.points().iter().enumerate() {
        assert!(manifold.points()[..i].iter().all(|q| q.point.distance(p.point) > 0.7), "{manifold:?}");
    }
    let spread = manifold.points().iter().fold(DVec3::ZERO, |sum, p| sum + p.point) / 4.0;
    assert!(spread.distance(DVec3::new(0.0, 0.4995, 0.0)) < 0.1, "{manifold:?}");
    for point in manifold.points() {
        assert!(matches!((point.feature_a, point.feature_b), (Edge(_), Edge(_))), "{point:?}");
    }
    // Leaning a little: the deepest of the eight corners is kept.
    let rotation = at(cube(), [0.0; 3], [0.013, 0.0, 0.007]).1.rotation * upper.1.rotation;
    let leaning = (cube(), Pose::new(upper.1.position, rotation));
    let manifold = touch(&lower, &leaning, 0.1).unwrap();
    assert_eq!(manifold.points().len(), 4);
    let least = manifold.points().iter().map(|p| p.separation).fold(f64::INFINITY, f64::min);
    assert!((least - gap(&lower, &leaning)).abs() < 1e-12);
}

#[test]
fn small_box_under_a_large_one_is_named_by_its_own_corners() {
    let small = at(cube(), [0.0; 3], [0.0; 3]);
    let large = at(Shape::cuboid(4.0, 1.0, 4.0), [0.0, 1.0, 0.0], [0.0; 3]);
    for point in touch(&small, &large, 0.0).unwrap().points() {
        assert!(matches!(point.feature_a, Vertex(2 | 3 | 6 | 7)), "{point:?}");
        assert_eq!(point.feature_b, Face(2));
    }
}

#[test]
fn boxes_apart_corner_to_corner() {
    let a = at(cube(), [0.0; 3], [0.0; 3]);
    let b = at(cube(), [1.01, 1.02, 1.02], [0.0; 3]);
    let manifold = touch(&a, &b, 0.1).unwrap();
    let point = single(&manifold);
    assert!((point.separation - 0.03).abs() < 1e-12);
    assert!(close(manifold.normal, [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]));
    assert_eq!((point.feature_a, point.feature_b), (Vertex(7), Vertex(0)));
    assert!(touch(&a, &b, 0.029).is_none());
    assert!(gap(&a, &b) > 0.0 && gap(&a, &b) <= 0.03);
}

#[test]
fn ball_on_face_edge_and_corner_of_a_box() {
    let cube = at(cube(), [0.0; 3], [0.0; 3]);
    let s = 0.5_f64.sqrt();
    let t = (1.0_f64 / 3.0).sqrt();
    for (direction, place, feature) in [
        ([0.0, 1.0, 0.0], [0.1, 0.5, -0.2], Face(3)),
        ([-1.0, 0.0, 0.0], [-0.5, 0.1, 0.0], Face(0)),
        ([s, s, 0.0], [0.5, 0.5, 0.1], Edge(8 + 3)),
        ([0.0, -s, s], [0.2, -0.5, 0.5], Edge(2)),
        ([s, 0.0, s], [0.5, 0.0, 0.5], Edge(7)),
        ([t, -t, t], [0.5, -0.5, 0.5], Vertex(5)),
    ] {
        for lift in [-0.01, 0.0, 0.01] {
            let (direction, place) = (DVec3::from_array(direction), DVec3::from_array(place));
            let ball = (Shape::sphere(0.3), Pose::new(place + direction * (0.3 + lift), DQuat::IDENTITY));
            let manifold = touch(&ball, &cube, 0.02).unwrap();
            let point = single(&manifold);
            assert!(manifold.normal.distance(-direction) < 1e-12);
            assert!(point.point.distance(place + direction * (0.5 * lift)) < 1e-12);
            assert!((point.separation - lift).abs() < 1e-12);
            assert_eq!((point.feature_a, point.feature_b), (Surface, feature));
        }
    }
}

#[test]
fn ball_inside_a_box_leaves_by_the_nearest_face() {
    let cube = at(cube(), [0.0; 3], [0.0; 3]);
    let ball = at(Shape::sphere(0.1), [0.1, 0.0, -0.3], [0.0; 3]);
    let manifold = touch(&ball, &cube, 0.0).unwrap();
    assert_eq!(manifold.normal, DVec3::Z);
    let point = single(&manifold);
    assert!((point.separation + 0.3).abs() < 1e-12);
    assert_eq!(point.feature_b, Face(4));
    assert!(close(point.point, [0.1, 0.0, -0.35]));
}

#[test]
fn a_capsule_through_a_box_leaves_sideways() {
    let cube = at(cube(), [0.0; 3], [0.0; 3]);
    let capsule = at(Shape::capsule(4.0, 0.1), [0.3, 0.0, 0.0], [0.0; 3]);
    let manifold = touch(&capsule, &cube, 0.0).unwrap();
    assert_eq!(manifold.normal, DVec3::NEG_X);
    assert_eq!(manifold.points().len(), 2);
    assert!((gap(&capsule, &cube) + 0.3).abs() < 1e-12);
    for point in manifold.points() {
        assert!((point.separation + 0.3).abs() < 1e-12 && (point.point.y.abs() - 0.5).abs() < 1e-12);
    }
}
