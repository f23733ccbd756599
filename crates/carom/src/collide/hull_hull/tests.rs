//! All kernels for hulls against the seam to parry, which looks for the same gap in another way.

use crate::collide::{Manifold, manifolds, parry, separation, separation_along};
use crate::math::{DVec3, Pose, rotation_from_vector};
use crate::report::Feature;
use crate::shape::Shape;

/// Numbers from −1 to 1, the same ones every time (Marsaglia 2003).
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn vector(number: &mut impl FnMut() -> f64) -> DVec3 {
    DVec3::new(number(), number(), number())
}

fn blob(corners: usize, stretch: DVec3) -> Shape {
    let mut number = numbers(corners as u64);
    let points: Vec<DVec3> = (0..corners).map(|_| vector(&mut number).normalize() * 0.5 * stretch).collect();
    Shape::hull(&points).unwrap()
}

fn box_hull(size: DVec3) -> Shape {
    let side = |corner: u32, bit: u32| f64::from(corner >> bit & 1) - 0.5;
    let corner = |k: u32| size * DVec3::new(side(k, 0), side(k, 1), side(k, 2));
    Shape::hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
}

fn prism(corners: u32, radius: f64) -> Shape {
    let ring = (0..corners).flat_map(|k| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(k) / f64::from(corners)).sin_cos();
        [-0.25, 0.25].map(|y| DVec3::new(radius * cosine, y, radius * sine))
    });
    Shape::hull(&ring.collect::<Vec<_>>()).unwrap()
}

fn tetrahedron() -> Shape {
    Shape::hull(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]).unwrap()
}

fn hulls() -> Vec<Shape> {
    vec![
        tetrahedron(),
        box_hull(DVec3::new(0.8, 1.2, 0.5)),
        prism(6, 0.5),
        prism(64, 0.5),
        blob(16, DVec3::ONE),
        blob(60, DVec3::ONE),
        blob(200, DVec3::new(1.0, 0.5, 1.4)),
        blob(20, DVec3::new(1.0, 1e-3, 1.0)),
        blob(12, DVec3::new(1e-3, 1e-3, 1.0)),
    ]
}

fn others() -> Vec<Shape> {
    vec![Shape::sphere(0.4), Shape::capsule(0.7, 0.3), Shape::cuboid(0.9, 0.5, 1.1), Shape::plane()]
}

/// Apart, near touching, overlapping or deep in each other.
fn place(a: &Shape, b: &Shape, number: &mut impl FnMut() -> f64, round: usize) -> (Pose, Pose) {
    let pose_a = Pose::new(vector(number) * 0.3, rotation_from_vector(vector(number) * 3.0));
    let way = vector(number).normalize();
    let mut pose_b =
        Pose::new(pose_a.position + way * number().abs() * 1.5, rotation_from_vector(vector(number) * 3.0));
    let wanted = match round % 4 {
        0 => return (pose_a, pose_b),
        1 => 10_f64.powf(-8.0 + 6.0 * number().abs()),
        2 => -10_f64.powf(-8.0 + 6.0 * number().abs()),
        _ => 0.0,
    };
    for _ in 0..30 {
        let gap = parry::separation(a, &pose_a, b, &pose_b);
        pose_b.position -= way * (gap - wanted).clamp(-1.0, 1.0);
    }
    (pose_a, pose_b)
}

fn one(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64) -> Option<Manifold> {
    let mut out = Vec::new();
    manifolds(a, b, margin, &mut out);
    assert!(out.len() <= 1);
    out.pop()
}

fn least(manifold: &Manifold) -> f64 {
    manifold.points().iter().map(|point| point.separation).fold(f64::INFINITY, f64::min)
}

#[test]
fn gaps_agree_with_the_seam() {
    let mut number = numbers(3);
    let (mut apart, mut meeting, mut better) = (0, 0, 0);
    for a in &hulls() {
        for b in hulls().iter().chain(&others()) {
            for round in 0..60 {
                let (pose_a, pose_b) = place(a, b, &mut number, round);
                let ours = separation(a, &pose_a, b, &pose_b);
                let theirs = parry::separation(a, &pose_a, b, &pose_b);
                let told = || format!("{ours} {theirs} round {round}\n{a:?} {pose_a:?}\n{b:?} {pose_b:?}");
                // Theirs is a gap along some direction, ours along the best: it can't be less.
                assert!(ours >= theirs - 1e-12, "{}", told());
                if theirs > 1e-6 {
                    assert!(ours <= theirs + 1e-9, "{}", told());
                    apart += 1;
                } else {
                    assert!(ours <= theirs + 2e-2, "{}", told());
                    better += i32::from(ours > theirs + 1e-9);
                    meeting += 1;
                }
                let turned = separation(b, &pose_b, a, &pose_a);
                assert!((ours - turned).abs() < 1e-11, "{turned} {}", told());
            }
        }
    }
    assert!(apart > 1500 && meeting > 1500, "{apart} {meeting}");
    assert!(better < meeting / 20, "{better} of {meeting}");
}

#[test]
fn contacts_tell_the_gap_along_their_normal() {
    let mut number = numbers(4);
    for a in &hulls() {
        for b in hulls().iter().chain(&others()) {
            for round in 0..60 {
                let (pose_a, pose_b) = place(a, b, &mut number, round);
                let gap = separation(a, &pose_a, b, &pose_b);
                let told = |found: &Option<Manifold>| {
                    format!("{gap} {found:?} round {round}\n{a:?} {pose_a:?}\n{b:?} {pose_b:?}")
                };
                let found = one((a, &pose_a), (b, &pose_b), 0.02);
                assert_eq!(found.is_some(), gap <= 0.02, "{}", told(&found));
                let Some(manifold) = found else { continue };
                assert!((manifold.normal.length() - 1.0).abs() < 1e-12);
                assert!((least(&manifold) - gap).abs() < 1e-11, "{}", told(&found));
                assert!(manifold.points().iter().all(|p| p.separation <= 0.02 && p.point.is_finite()));
                let along = separation_along((a, &pose_a), (b, &pose_b), manifold.normal);
                assert!(along == f64::NEG_INFINITY || (along - gap).abs() < 1e-8, "{along} {}", told(&found));
                // A contact lies half its separation away from either surface.
                for point in manifold.points() {
                    let probe = Pose::new(point.point, Pose::IDENTITY.rotation);
                    let tiny = Shape::sphere(1e-6);
                    for (shape, pose) in [(a, &pose_a), (b, &pose_b)] {
                        let depth = separation(shape, pose, &tiny, &probe) + 1e-6;
                        assert!(depth <= 0.5 * point.separation.abs() + 1e-5, "{depth} {}", told(&found));
                    }
                }
                let back = one((b, &pose_b), (a, &pose_a), 0.02);
                let turned = back.map(Manifold::flipped);
                let turned = turned.expect("the same in turn");
                assert!((least(&turned) - gap).abs() < 1e-11, "{}", told(&back));
            }
        }
    }
}

#[test]
fn hulls_that_are_boxes_are_cuboids() {
    let mut number = numbers(5);
    let sizes = [DVec3::new(0.8, 1.2, 0.5), DVec3::ONE];
    for round in 0..4000 {
        let (size_a, size_b) = (sizes[round % 2], sizes[round / 2 % 2]);
        let cuboid = |size: DVec3| Shape::cuboid(size.x, size.y, size.z);
        let (pose_a, pose_b) = place(&cuboid(size_a), &cuboid(size_b), &mut number, round);
        let boxes = separation(&cuboid(size_a), &pose_a, &cuboid(size_b), &pose_b);
        let boxes_touch = one((&cuboid(size_a), &pose_a), (&cuboid(size_b), &pose_b), 0.01);
        for (a, b) in [
            (box_hull(size_a), box_hull(size_b)),
            (box_hull(size_a), cuboid(size_b)),
            (cuboid(size_a), box_hull(size_b)),
        ] {
            let hulls = separation(&a, &pose_a, &b, &pose_b);
            if boxes <= 0.0 {
                assert!((boxes - hulls).abs() < 1e-13, "{boxes} {hulls}");
            } else {
                assert!(hulls >= boxes - 1e-13, "{boxes} {hulls}");
            }
            let hulls_touch = one((&a, &pose_a), (&b, &pose_b), 0.01);
            let (Some(boxes_touch), Some(hulls_touch)) = (boxes_touch, hulls_touch) else {
                assert_eq!(boxes_touch.is_some(), hulls_touch.is_some(), "{boxes} {hulls}");
                continue;
            };
            assert!((least(&boxes_touch) - least(&hulls_touch)).abs() < 1e-12);
            assert!(
                boxes_touch.normal.distance(hulls_touch.normal) < 1e-9,
                "{boxes_touch:?} {hulls_touch:?}"
            );
            let near = |p: DVec3| hulls_touch.points().iter().any(|q| q.point.distance(p) < 1e-9);
            assert!(boxes_touch.points().iter().all(|p| near(p.point)), "{boxes_touch:?} {hulls_touch:?}");
            assert_eq!(boxes_touch.points().len(), hulls_touch.points().len());
        }
    }
}

#[test]
fn features_stay_while_a_hull_creeps() {
    let floor = box_hull(DVec3::new(4.0, 1.0, 4.0));
    for top in [box_hull(DVec3::ONE), prism(6, 0.5), prism(64, 0.5)] {
        let height = if let Shape::Hull(hull) = &top { hull.bounds().1.y } else { 0.0 };
        let mut first: Option<Vec<(Feature, Feature)>> = None;
        let mut number = numbers(6);
        for step in 0..300 {
            let creep = f64::from(step) * 1e-5;
            let noise = vector(&mut number) * 1e-13;
            let turn = rotation_from_vector(DVec3::new(0.0, creep, 0.0) + noise);
            let pose = Pose::new(DVec3::new(0.3 + creep, 0.5 + height - 1e-7, 0.2) + noise, turn);
            let manifold = one((&floor, &Pose::IDENTITY), (&top, &pose), 0.01).unwrap();
            assert_eq!(manifold.points().len(), 4);
            assert!(manifold.normal.distance(DVec3::Y) < 1e-6);
            let features: Vec<_> =
                manifold.points().iter().map(|point| (point.feature_a, point.feature_b)).collect();
            assert!(features.iter().all(|(a, b)| matches!((a, b), (Feature::Face(_), Feature::Vertex(_)))));
            assert_eq!(&features, first.get_or_insert_with(|| features.clone()), "step {step}");
        }
    }
}

#[test]
fn a_ball_rolls_over_side_edge_and_corner_of_a_hull() {
    let cube = box_hull(DVec3::ONE);
    let ball = Shape::sphere(0.3);
    let (s, t) = (0.5_f64.sqrt(), (1.0_f64 / 3.0).sqrt());
    for (direction, place, kind) in [
        ([0.0, 1.0, 0.0], [0.1, 0.5, -0.2], 0),
        ([s, s, 0.0], [0.5, 0.5, 0.1], 1),
        ([0.0, -s, s], [0.2, -0.5, 0.5], 1),
        ([t, -t, t], [0.5, -0.5, 0.5], 2),
    ] {
        for lift in [-0.01, 0.0, 0.01] {
            let (direction, place) = (DVec3::from_array(direction), DVec3::from_array(place));
            let pose = Pose::new(place + direction * (0.3 + lift), Pose::IDENTITY.rotation);
            let manifold = one((&ball, &pose), (&cube, &Pose::IDENTITY), 0.02).unwrap();
            let [point] = manifold.points() else { panic!("{manifold:?}") };
            assert!(manifold.normal.distance(-direction) < 1e-12, "{manifold:?}");
            assert!(point.point.distance(place + direction * (0.5 * lift)) < 1e-12);
            assert!((point.separation - lift).abs() < 1e-12);
            let found = match point.feature_b {
                Feature::Face(_) => 0,
                Feature::Edge(_) => 1,
                Feature::Vertex(_) => 2,
                Feature::Surface => 3,
            };
            assert_eq!(found, kind);
        }
    }
}

#[test]
fn a_capsule_on_a_hull_lies_on_two_points() {
    let floor = box_hull(DVec3::new(4.0, 1.0, 4.0));
    let capsule = Shape::capsule(2.0, 0.25);
    let lying = |x: f64, y: f64| {
        Pose::new(DVec3::new(x, y, 0.0), rotation_from_vector(DVec3::Z * std::f64::consts::FRAC_PI_2))
    };
    let under = Pose::new(DVec3::new(0.0, -0.5, 0.0), Pose::IDENTITY.rotation);
    for (x, ends) in [(0.5, [1.5, -0.5]), (1.5, [2.0, 0.5])] {
        let manifold = one((&capsule, &lying(x, 0.24)), (&floor, &under), 0.0).unwrap();
        assert!(manifold.normal.distance(DVec3::NEG_Y) < 1e-12);
        let places: Vec<f64> = manifold.points().iter().map(|point| point.point.x).collect();
        assert!((places[0] - ends[0]).abs() < 1e-9 && (places[1] - ends[1]).abs() < 1e-9, "{places:?}");
        assert!(manifold.points().iter().all(|point| (point.separation + 0.01).abs() < 1e-12));
    }
    // Deep inside the way out is up.
    let through = one((&capsule, &lying(0.0, -0.2)), (&floor, &under), 0.0).unwrap();
    assert!(through.normal.distance(DVec3::NEG_Y) < 1e-12 && (least(&through) + 0.45).abs() < 1e-12);
}

#[test]
fn broken_poses_are_nowhere() {
    let broken = Pose::new(DVec3::new(f64::NAN, 0.0, 0.0), Pose::IDENTITY.rotation);
    let hull = blob(16, DVec3::ONE);
    for other in hulls().iter().chain(&others()).filter(|shape| !matches!(shape, Shape::Plane)) {
        assert_eq!(separation(&hull, &broken, other, &Pose::IDENTITY), f64::INFINITY, "{other:?}");
        assert!(one((&hull, &broken), (other, &Pose::IDENTITY), 1.0).is_none());
    }
}
