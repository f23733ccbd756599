//! What must hold for any two shapes.

use crate::support::{Kind, Random, gap, kinds, least, touch};
use carom::Shape;
use carom::collide::{ContactPoint, Manifold};
use carom::math::{DVec3, Pose};
use proptest::prelude::*;

/// Whether two sets of points are the same but for order and `tolerance`.
fn same_points(
    a: &Manifold,
    b: &Manifold,
    tolerance: f64,
    move_b: impl Fn(&ContactPoint) -> ContactPoint,
) -> bool {
    let alike = |p: &ContactPoint, q: &ContactPoint| {
        p.point.distance(q.point) < tolerance
            && (p.separation - q.separation).abs() < tolerance
            && (p.feature_a, p.feature_b) == (q.feature_a, q.feature_b)
    };
    let moved: Vec<_> = b.points().iter().map(move_b).collect();
    a.points().len() == moved.len() && a.points().iter().all(|p| moved.iter().any(|q| alike(p, q)))
}

#[test]
fn swapping_the_shapes_only_flips_the_normal() {
    let mut random = Random(11);
    for kinds in kinds() {
        for _ in 0..3000 {
            let (a, b) = random.pair(kinds);
            assert!((gap(&a, &b) - gap(&b, &a)).abs() < 1e-9, "{a:?} {b:?}");
            let (Some(forth), Some(back)) = (touch(&a, &b, 0.05), touch(&b, &a, 0.05)) else {
                assert!(touch(&a, &b, 0.05).is_none() && touch(&b, &a, 0.05).is_none());
                continue;
            };
            assert!((forth.normal + back.normal).length() < 1e-9, "{forth:?} {back:?} {a:?} {b:?}");
            let flip =
                |p: &ContactPoint| ContactPoint { feature_a: p.feature_b, feature_b: p.feature_a, ..*p };
            assert!(same_points(&forth, &back, 1e-8, flip), "{forth:?} {back:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn moving_both_shapes_moves_the_contacts_along() {
    let mut random = Random(12);
    for kinds in kinds() {
        for _ in 0..3000 {
            let (a, b) = random.pair(kinds);
            let motion = Pose::new(random.direction() * 3.0, random.rotation());
            let moved = |s: &(Shape, Pose)| (s.0.clone(), motion.then_local(&s.1));
            let (far_a, far_b) = (moved(&a), moved(&b));
            assert!((gap(&a, &b) - gap(&far_a, &far_b)).abs() < 1e-9, "{a:?} {b:?}");
            let (Some(here), Some(there)) = (touch(&a, &b, 0.05), touch(&far_a, &far_b, 0.05)) else {
                assert!(touch(&a, &b, 0.05).is_none() && touch(&far_a, &far_b, 0.05).is_none());
                continue;
            };
            assert!((motion.rotation * here.normal - there.normal).length() < 1e-8, "{here:?} {there:?}");
            let back =
                |p: &ContactPoint| ContactPoint { point: motion.inverse_transform_point(p.point), ..*p };
            assert!(same_points(&here, &there, 1e-8, back), "{here:?} {there:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn moving_along_the_normal_by_the_separation_makes_them_touch() {
    let mut random = Random(13);
    for kinds in kinds() {
        for _ in 0..3000 {
            let (a, mut b) = random.pair(kinds);
            let Some(manifold) = touch(&a, &b, 0.2) else { continue };
            b.1.position -= manifold.normal * least(&manifold);
            let rest = gap(&a, &b);
            // Cuboids apart may be closest in two corners, where the bound falls short of the distance.
            let limit = if kinds == (Kind::Cuboid, Kind::Cuboid) { 1e-7 } else { 1e-8 };
            assert!(rest.abs() < limit, "{kinds:?}: {rest} {manifold:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn points_are_within_the_margin_and_the_normal_is_unit() {
    let mut random = Random(14);
    for kinds in kinds() {
        for _ in 0..3000 {
            let (a, b) = random.pair(kinds);
            for margin in [0.0, 0.02, 0.3] {
                let Some(manifold) = touch(&a, &b, margin) else { continue };
                assert!((manifold.normal.length() - 1.0).abs() < 1e-12);
                assert!((1..=4).contains(&manifold.points().len()));
                assert!(manifold.points().iter().all(|p| p.separation <= margin && p.point.is_finite()));
            }
            if gap(&a, &b) <= 0.0 {
                assert!(touch(&a, &b, 0.0).is_some(), "{a:?} {b:?}");
            }
        }
    }
}

fn vector(limit: f64) -> impl Strategy<Value = DVec3> {
    [-limit..limit, -limit..limit, -limit..limit].prop_map(DVec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        failure_persistence: None,
        rng_seed: prop::test_runner::RngSeed::Fixed(7),
        ..ProptestConfig::default()
    })]

    /// A point moves no faster than its body, so the separation can't either: what a march in time relies on.
    #[test]
    fn separation_changes_no_faster_than_the_shapes_move(
        seed in any::<u64>(), shift in vector(1.0), size in -9.0..-1.0_f64,
    ) {
        let mut random = Random(seed);
        for kinds in kinds() {
            let (a, mut b) = random.pair(kinds);
            let before = gap(&a, &b);
            let shift = shift * 10_f64.powf(size);
            b.1.position += shift;
            let change = (gap(&a, &b) - before).abs();
            prop_assert!(change <= shift.length() * (1.0 + 1e-9) + 1e-11, "{:?} {} {}", kinds, change, shift.length());
        }
    }

    /// The same for turning, where both sides of the step overlap or touch.
    #[test]
    fn separation_is_continuous_in_rotation(seed in any::<u64>(), turn in vector(1.0), size in -9.0..-2.0_f64) {
        let mut random = Random(seed);
        for kinds in kinds() {
            let (a, mut b) = random.pair(kinds);
            let before = gap(&a, &b);
            let turn = turn * 10_f64.powf(size);
            b.1.rotation = carom::math::rotation_from_vector(turn) * b.1.rotation;
            // The farthest point of either shape from the centre of rotation that can be closest.
            let reach = if kinds.1 == Kind::Plane { a.1.position.distance(b.1.position) + a.0.reach(DVec3::ZERO) }
                else { b.0.reach(DVec3::ZERO) };
            let change = (gap(&a, &b) - before).abs();
            if kinds != (Kind::Cuboid, Kind::Cuboid) || before <= 0.0 {
                prop_assert!(change <= 2.0 * turn.length() * reach + 1e-10, "{:?} {} {}", kinds, change, turn.length());
            }
        }
    }
}
