//! Where directions vanish and sizes differ by a million: never NaN, the normal always unit.

use crate::support::{Kind, Random, at, gap, kinds, touch};
use carom::Shape;
use carom::math::{DQuat, DVec3, Pose, rotation_from_vector};
use std::f64::consts::FRAC_PI_2;

/// Asserts that the answers are finite and agree; for shapes that overlap also that there is one.
fn check(a: &(Shape, Pose), b: &(Shape, Pose)) {
    let separation = gap(a, b);
    assert!(separation.is_finite(), "{a:?} {b:?}");
    for margin in [0.0, 1e-3, 1.0] {
        let Some(manifold) = touch(a, b, margin) else {
            // The separation of two cuboids apart is a lower bound.
            assert!(
                separation > margin
                    || matches!((&a.0, &b.0), (Shape::Cuboid { .. }, Shape::Cuboid { .. }))
                        && separation > 0.0,
                "{separation} {margin} {a:?} {b:?}"
            );
            continue;
        };
        assert!((manifold.normal.length() - 1.0).abs() < 1e-9, "{manifold:?}");
        assert!(!manifold.points().is_empty());
        for point in manifold.points() {
            assert!(point.point.is_finite() && point.separation <= margin, "{point:?} {a:?} {b:?}");
        }
    }
}

fn sized(kind: Kind, size: f64) -> Shape {
    match kind {
        Kind::Sphere => Shape::sphere(size),
        Kind::Capsule => Shape::capsule(size, 0.25 * size),
        Kind::Cuboid => Shape::cuboid(size, size, size),
        Kind::Plane => Shape::plane(),
        // A prism with six sides: as many parallel faces and edges as there can be.
        Kind::Hull => {
            let ring = [(1.0, 0.0), (0.5, 0.75), (-0.5, 0.75), (-1.0, 0.0), (-0.5, -0.75), (0.5, -0.75)];
            let points = ring.map(|(x, z)| [-0.5, 0.5].map(|y| 0.5 * size * DVec3::new(x, 2.0 * y, z)));
            Shape::hull(points.as_flattened()).unwrap()
        }
    }
}

#[test]
fn coincident_frames() {
    let turns =
        [DVec3::ZERO, DVec3::X * FRAC_PI_2, DVec3::new(0.0, 0.0, FRAC_PI_2), DVec3::new(0.3, 0.1, -0.2)];
    for (a, b) in kinds() {
        for turn in turns {
            for size in [1.0, 1e-3, 1e3] {
                let pose = Pose::new(DVec3::new(0.1, 0.2, 0.3), rotation_from_vector(turn));
                let straight = Pose::new(pose.position, DQuat::IDENTITY);
                check(&(sized(a, 1.0), pose), &(sized(b, size), pose));
                check(&(sized(a, 1.0), pose), &(sized(b, size), straight));
            }
        }
    }
}

#[test]
fn lattice_of_exact_offsets_and_quarter_turns() {
    let steps = [-1.0, -0.5, 0.0, 0.5, 1.0];
    let turns = [DVec3::ZERO, DVec3::X * FRAC_PI_2, DVec3::Z * FRAC_PI_2, DVec3::Y * (0.5 * FRAC_PI_2)];
    for (a, b) in kinds() {
        for x in steps {
            for y in steps {
                for z in steps {
                    for turn in turns {
                        let pose = Pose::new(DVec3::new(x, y, z), rotation_from_vector(turn));
                        check(&(sized(a, 1.0), Pose::IDENTITY), &(sized(b, 1.0), pose));
                    }
                }
            }
        }
    }
}

#[test]
fn nearly_parallel_and_nearly_level() {
    let mut random = Random(21);
    for kinds in kinds() {
        for _ in 0..1500 {
            let noise = 10_f64.powf(random.range(-18.0, -3.0));
            let place = DVec3::new(
                [0.0, 0.3, 1.0][(random.bits() % 3) as usize],
                [0.0, 0.75, 1.0][(random.bits() % 3) as usize],
                [0.0, -0.4, 1.0][(random.bits() % 3) as usize],
            );
            let turn = rotation_from_vector(random.direction() * noise);
            let pose = Pose::new(place + random.direction() * noise, turn);
            check(&(sized(kinds.0, 1.0), Pose::IDENTITY), &(sized(kinds.1, 1.0), pose));
        }
    }
}

#[test]
fn a_grain_and_a_hill() {
    let mut random = Random(22);
    for kinds in kinds() {
        for _ in 0..500 {
            let (small, large) = (sized(kinds.0, 1e-3), sized(kinds.1, 1e3));
            let large = (large, Pose::new(DVec3::ZERO, random.rotation()));
            let mut small = (small, Pose::new(random.direction() * 600.0, random.rotation()));
            let Some(manifold) = touch(&small, &large, f64::INFINITY) else { panic!("{small:?} {large:?}") };
            let nearest = manifold.points().iter().map(|p| p.separation).fold(f64::INFINITY, f64::min);
            small.1.position += manifold.normal * nearest;
            assert!(gap(&small, &large).abs() < 1e-9, "{} {small:?} {large:?}", gap(&small, &large));
            check(&small, &large);
            check(&large, &small);
        }
    }
}

#[test]
fn fallback_normals_are_fixed() {
    let ball = || at(Shape::sphere(1.0), [0.0; 3], [0.0; 3]);
    let upright = || at(Shape::capsule(2.0, 0.5), [0.0; 3], [0.0; 3]);
    let lying = at(Shape::capsule(2.0, 0.5), [0.0; 3], [0.0, 0.0, FRAC_PI_2]);
    assert_eq!(touch(&ball(), &ball(), 0.0).unwrap().normal, DVec3::Y);
    assert_eq!(gap(&ball(), &ball()), -2.0);
    let on_axis = touch(&ball(), &upright(), 0.0).unwrap();
    assert!(on_axis.normal.y.abs() < 1e-15);
    assert_eq!(on_axis.normal, -touch(&upright(), &ball(), 0.0).unwrap().normal);
    let crossing = touch(&upright(), &lying, 0.0).unwrap();
    assert!((crossing.normal.z.abs() - 1.0).abs() < 1e-15);
    assert_eq!(crossing.normal, -touch(&lying, &upright(), 0.0).unwrap().normal);
}

#[test]
fn planes_never_touch() {
    let plane = at(Shape::plane(), [0.0; 3], [0.0; 3]);
    let other = at(Shape::plane(), [0.0; 3], [1.0, 0.0, 0.0]);
    assert_eq!(gap(&plane, &other), f64::INFINITY);
    assert!(touch(&plane, &other, 1.0).is_none());
}
