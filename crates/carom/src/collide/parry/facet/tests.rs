//! parry finds the same, and so does a look along many directions.

use super::super::axis;
use super::super::clip::{self, Candidates};
use super::super::convex::{Convex, Core};
use super::*;
use crate::math::{DQuat, Pose, rotation_from_vector};
use crate::shape::Shape;
use std::f64::consts::FRAC_PI_4;

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

fn shapes() -> Vec<Shape> {
    let mut number = numbers(5);
    let mut hull = |count: usize| {
        let points: Vec<DVec3> =
            (0..count).map(|_| vector(&mut number).normalize_or(DVec3::Y) * 0.6).collect();
        Shape::hull(&points).unwrap()
    };
    let (small, large) = (hull(6), hull(60));
    vec![Shape::sphere(0.5), Shape::capsule(0.7, 0.3), Shape::cuboid(0.9, 0.5, 1.1), small, large]
}

fn triangle_of(corners: [DVec3; 3]) -> Convex<'static> {
    Convex { core: Core::Triangle { corners, index: 7, vertices: [0, 1, 2] }, radius: 0.0 }
}

/// What the kernels find, and parry's.
fn found(corners: [DVec3; 3], shape: &Shape, pose: &Pose, limit: f64) -> (Option<Axis>, Axis) {
    let (triangle, convex) = (triangle_of(corners), Convex::of(shape).unwrap());
    let [a, b, c] = corners;
    let facet = Facet::new(corners, (b - a).cross(c - a).normalize()).unwrap();
    let own = Form::with(&convex.core, pose, |form| {
        let form = form.unwrap();
        let own = facet.gap_within(form, limit);
        if let Some(axis) = own {
            for enough in [limit, 0.1, 0.0] {
                assert!(facet.gap_at_least(form, enough) <= axis.gap.max(0.0) + 1e-12);
            }
        }
        own
    });
    (own, axis::least_gap(&triangle.core, &convex.core, pose))
}

/// The axis is right by itself: its gap is that along its normal, and its points are no nearer.
fn check(corners: [DVec3; 3], shape: &Shape, pose: &Pose, axis: &Axis) {
    let convex = Convex::of(shape).unwrap();
    let measured = axis::along(&triangle_of(corners).core, &convex.core, pose, axis.normal).gap;
    assert!((axis.normal.length() - 1.0).abs() < 1e-12);
    assert!((measured - axis.gap).abs() < 1e-11, "{shape:?} {pose:?}: {} is {measured}", axis.gap);
    if axis.gap > 1e-9 {
        let between = axis.on_b - axis.on_a;
        assert!(between.distance(axis.normal * axis.gap) < 1e-9, "{shape:?} {pose:?}: {between} {axis:?}");
    }
}

#[test]
fn kernels_agree_with_parry() {
    let mut number = numbers(1);
    let (mut apart, mut over) = (0, 0);
    for round in 0..6000 {
        let corners = [0; 3].map(|_| vector(&mut number) * 1.5);
        let [a, b, c] = corners;
        if (b - a).cross(c - a).length() < 0.05 {
            continue;
        }
        for shape in &shapes() {
            let spread = if round % 2 == 0 { 0.6 } else { 1.8 };
            let pose =
                Pose::new(vector(&mut number) * spread, rotation_from_vector(vector(&mut number) * 3.0));
            let (own, truth) = found(corners, shape, &pose, f64::MAX);
            let own = own.unwrap();
            check(corners, shape, &pose, &own);
            // EPA may stop at some way out; ours is the shortest.
            let difference = own.gap - truth.gap;
            assert!(difference > -1e-10, "{shape:?} {pose:?} {corners:?}: {} {}", own.gap, truth.gap);
            assert!(difference < 1e-9 || truth.gap < 0.0, "{shape:?}: {} {}", own.gap, truth.gap);
            if truth.gap > 0.0 {
                apart += 1
            } else {
                over += 1
            }
            for limit in [0.0, 0.1] {
                let (near, _) = found(corners, shape, &pose, limit);
                let is_near = near.is_some_and(|axis| axis.gap <= limit);
                assert_eq!(is_near, own.gap <= limit, "{} {limit}", own.gap);
            }
        }
    }
    assert!(apart > 4000 && over > 4000, "{apart} {over}");
}

/// Whether anything is left when the sides of a triangle and a shape that face each other are cut to each other.
fn has_contacts(triangle: &Convex, convex: &Convex, pose: &Pose, normal: DVec3) -> bool {
    Candidates::with(f64::MAX, |candidates| {
        clip::contacts(triangle, convex, pose, normal, candidates);
        candidates.least_separation() < f64::INFINITY
    })
}

#[test]
fn cutting_leaves_nothing_of_what_is_beside() {
    let mut number = numbers(3);
    let (mut beside, mut empty, mut over) = (0, 0, 0);
    for _ in 0..4000 {
        let corners = [0; 3].map(|_| vector(&mut number) * 1.5);
        let [a, b, c] = corners;
        let across = (b - a).cross(c - a);
        if across.length() < 0.05 {
            continue;
        }
        let facet = Facet::new(corners, across.normalize()).unwrap();
        let triangle = triangle_of(corners);
        for shape in &shapes() {
            let convex = Convex::of(shape).unwrap();
            let pose = Pose::new(vector(&mut number) * 2.0, rotation_from_vector(vector(&mut number) * 3.0));
            let normal = vector(&mut number).normalize();
            let is_beside = Form::with(&convex.core, &pose, |form| facet.is_beside(form.unwrap(), normal));
            let has_contacts = has_contacts(&triangle, &convex, &pose, normal);
            assert!(!(is_beside && has_contacts), "{shape:?} {pose:?} {corners:?} {normal}");
            beside += u32::from(is_beside);
            empty += u32::from(!has_contacts);
            over += u32::from(has_contacts);
        }
    }
    assert!(over > 2000 && 2 * beside > empty, "{beside} of {empty} are told; {over} are over the triangle");
}

#[test]
fn the_way_out_is_the_widest_gap_of_all() {
    let mut number = numbers(2);
    for _ in 0..300 {
        let corners = [0; 3].map(|_| vector(&mut number));
        let [a, b, c] = corners;
        if (b - a).cross(c - a).length() < 0.05 {
            continue;
        }
        for shape in &shapes()[1..] {
            let pose = Pose::new(vector(&mut number) * 0.4, rotation_from_vector(vector(&mut number) * 3.0));
            let own = found(corners, shape, &pose, f64::MAX).0.unwrap();
            let (triangle, convex) = (triangle_of(corners), Convex::of(shape).unwrap());
            for _ in 0..400 {
                let near = (own.normal + vector(&mut number) * 0.1).normalize();
                for way in [near, vector(&mut number).normalize()] {
                    let gap = axis::along(&triangle.core, &convex.core, &pose, way).gap;
                    assert!(gap <= own.gap + 1e-12, "{shape:?} {pose:?}: {gap} {}", own.gap);
                }
            }
        }
    }
}

#[test]
fn what_lies_on_a_triangle_has_its_normal_to_the_last_bit() {
    let corners = [DVec3::new(-4.0, 0.0, -3.0), DVec3::new(0.0, 0.0, 5.0), DVec3::new(4.0, 0.0, -3.0)];
    let heights = [0.5, 0.3, 0.25];
    for (shape, height) in shapes().iter().zip(heights) {
        for depth in [0.1, 1e-3, 1e-7, 1e-10, 0.0, -1e-10, -1e-7, -1e-3] {
            for lying in [false, true] {
                let turn = if lying {
                    DQuat::from_xyzw(0.0, 0.0, 0.5_f64.sqrt(), 0.5_f64.sqrt())
                } else {
                    DQuat::IDENTITY
                };
                let lies = matches!(shape, Shape::Capsule { .. });
                if lies != lying {
                    continue;
                }
                for side in [1.0, -1.0] {
                    let pose = Pose::new(DVec3::new(0.1, side * (height - depth), 0.2), turn);
                    let radius = Convex::of(shape).unwrap().radius;
                    let axis = found(corners, shape, &pose, f64::MAX).0.unwrap();
                    assert!(axis.normal.distance(DVec3::Y * side) < 1e-15, "{shape:?} {depth}: {axis:?}");
                    assert!((axis.gap - radius + depth).abs() < 1e-15, "{shape:?} {depth}: {axis:?}");
                }
            }
        }
    }
}

#[test]
fn no_touch_is_too_narrow_for_its_direction() {
    // Edge on edge, a hair apart or in each other: the direction is at right angles to both.
    let corners = [DVec3::new(-2.0, 0.0, 0.0), DVec3::new(0.0, -1.0, -3.0), DVec3::new(2.0, 0.0, 0.0)];
    let turn = rotation_from_vector(DVec3::new(0.0, 0.0, FRAC_PI_4));
    let across = rotation_from_vector(DVec3::new(0.0, 0.4, 0.0));
    let reach = 0.5 * 2.0_f64.sqrt();
    for depth in [1e-4, 1e-7, 1e-10, 1e-13, 0.0, -1e-13, -1e-10, -1e-7, -1e-4] {
        for (shape, place) in [(Shape::cuboid(1.0, 1.0, 2.0), reach), (Shape::capsule(2.0, 0.3), 0.0)] {
            let lying =
                if place == 0.0 { DQuat::from_xyzw(0.5_f64.sqrt(), 0.0, 0.0, 0.5_f64.sqrt()) } else { turn };
            let pose = Pose::new(DVec3::new(0.0, place - depth, 0.0), across * lying);
            let axis = found(corners, &shape, &pose, f64::MAX).0.unwrap();
            assert!(axis.normal.distance(DVec3::Y) < 1e-7, "{shape:?} {depth}: {axis:?}");
            assert!((axis.gap + depth).abs() < 1e-14, "{shape:?} {depth}: {axis:?}");
        }
    }
}
