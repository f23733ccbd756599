//! What goes through parry, against geometry written down once more.

mod convex;
mod surfaces;

use super::*;
use crate::collide::{manifolds as all_manifolds, separation as any_separation};
use crate::math::{DQuat, any_tangent, rotation_from_vector};

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

fn pose(number: &mut impl FnMut() -> f64, spread: f64) -> Pose {
    let mut vector = || DVec3::new(number(), number(), number());
    Pose::new(vector() * spread, rotation_from_vector(vector() * 3.0))
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(DVec3::new(x, y, z), DQuat::IDENTITY)
}

fn box_hull(size: DVec3) -> Shape {
    let side = |corner: u32, bit: u32| f64::from(corner >> bit & 1) - 0.5;
    let corner = |k: u32| size * DVec3::new(side(k, 0), side(k, 1), side(k, 2));
    Shape::hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap()
}

fn blob() -> Shape {
    let mut number = numbers(77);
    let points: Vec<DVec3> =
        (0..30).map(|_| DVec3::new(number(), number(), number()).normalize() * 0.6).collect();
    Shape::hull(&points).unwrap()
}

fn tapered(height: f64, radius_bottom: f64, radius_top: f64) -> Shape {
    Shape::TaperedCapsule { height, radius_bottom, radius_top }
}

fn frustum(height: f64, radius_bottom: f64, radius_top: f64) -> Shape {
    Shape::Cylinder { height, radius_bottom, radius_top }
}

fn rare() -> Vec<Shape> {
    vec![
        Shape::cylinder(1.0, 0.4),
        Shape::cone(1.2, 0.5),
        frustum(0.8, 0.3, 0.6),
        tapered(0.8, 0.5, 0.2),
        tapered(0.3, 0.1, 0.6),
        blob(),
        box_hull(DVec3::new(0.8, 1.2, 0.5)),
    ]
}

fn common() -> Vec<Shape> {
    vec![Shape::sphere(0.5), Shape::cuboid(0.9, 0.5, 1.1), Shape::capsule(0.7, 0.3)]
}

fn floor() -> Shape {
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let vertices = vec![corner(-5.0, -5.0), corner(-5.0, 5.0), corner(5.0, 5.0), corner(5.0, -5.0)];
    Shape::mesh(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// The farthest point of a shape, written down once more and independently.
fn farthest(shape: &Shape, pose: &Pose, direction: DVec3) -> DVec3 {
    let local = pose.rotation.conjugate() * direction;
    let unit = local.normalize();
    let rim = DVec3::new(local.x, 0.0, local.z).normalize_or_zero();
    let y = |y: f64| DVec3::new(0.0, y, 0.0);
    let points: Vec<DVec3> = match shape {
        Shape::Sphere { radius } => vec![unit * *radius],
        Shape::Cuboid { size } => vec![local.signum() * 0.5 * *size],
        Shape::Capsule { height, radius } => {
            vec![y(0.5 * height) + unit * *radius, y(-0.5 * height) + unit * *radius]
        }
        Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
            vec![y(0.5 * height) + unit * *radius_top, y(-0.5 * height) + unit * *radius_bottom]
        }
        Shape::Cylinder { height, radius_bottom, radius_top } => {
            vec![y(0.5 * height) + rim * *radius_top, y(-0.5 * height) + rim * *radius_bottom]
        }
        Shape::Hull(hull) => hull.vertices().to_vec(),
        Shape::Plane | Shape::Mesh(_) | Shape::HeightField(_) => unreachable!("no farthest point"),
    };
    let best = points.into_iter().max_by(|one, other| one.dot(local).total_cmp(&other.dot(local)));
    pose.transform_point(best.unwrap())
}

fn gap_along(a: (&Shape, &Pose), b: (&Shape, &Pose), normal: DVec3) -> f64 {
    (farthest(b.0, b.1, -normal) - farthest(a.0, a.1, normal)).dot(normal)
}

/// The largest gap along any direction, by a search that knows nothing of GJK: a net of directions, then ever smaller
/// steps from the best few of them.
fn widest_gap(a: (&Shape, &Pose), b: (&Shape, &Pose)) -> f64 {
    const NET: usize = 1500;
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut net: Vec<(f64, DVec3)> = (0..NET)
        .map(|k| {
            let y = 1.0 - 2.0 * (k as f64 + 0.5) / NET as f64;
            let (sine, cosine) = (golden * k as f64).sin_cos();
            let ring = (1.0 - y * y).sqrt();
            DVec3::new(ring * cosine, y, ring * sine)
        })
        .map(|direction| (gap_along(a, b, direction), direction))
        .collect();
    net.sort_by(|one, other| other.0.total_cmp(&one.0));
    let refined = net[..6].iter().map(|&(mut gap, mut direction)| {
        let mut step = 0.1;
        while step > 1e-9 {
            let across = any_tangent(direction);
            let up = direction.cross(across);
            let tries = (0..12).map(|k| {
                let (sine, cosine) = (f64::from(k) * std::f64::consts::TAU / 12.0).sin_cos();
                (direction + (across * cosine + up * sine) * step).normalize()
            });
            let best = tries.map(|n| (gap_along(a, b, n), n)).max_by(|one, other| one.0.total_cmp(&other.0));
            match best {
                Some((better, n)) if better > gap => (gap, direction) = (better, n),
                _ => step *= 0.6,
            }
        }
        gap
    });
    refined.fold(f64::NEG_INFINITY, f64::max)
}

fn checked_manifolds(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64) -> Vec<Manifold> {
    let mut out = Vec::new();
    manifolds(a, b, margin, &mut out);
    for manifold in &out {
        assert!((manifold.normal.length() - 1.0).abs() < 1e-9);
        assert!((1..=4).contains(&manifold.points().len()));
        assert!(manifold.points().iter().all(|p| p.separation <= margin && p.point.is_finite()));
    }
    out
}

fn least(found: &[Manifold]) -> f64 {
    found.iter().flat_map(|m| m.points()).map(|p| p.separation).fold(f64::INFINITY, f64::min)
}

#[test]
fn size_does_not_matter() {
    for scale in [1e-4, 1.0, 1e4] {
        let (cylinder, cone) = (Shape::cylinder(scale, 0.5 * scale), Shape::cone(scale, 0.5 * scale));
        let tilt = rotation_from_vector(DVec3::new(0.4, 0.0, 0.3));
        for distance in [0.6, 0.9, 1.3] {
            let place = Pose::new(DVec3::new(0.2, distance, -0.1) * scale, tilt);
            let found = separation(&cylinder, &Pose::IDENTITY, &cone, &place) / scale;
            let unit = Pose::new(DVec3::new(0.2, distance, -0.1), tilt);
            let expected =
                separation(&Shape::cylinder(1.0, 0.5), &Pose::IDENTITY, &Shape::cone(1.0, 0.5), &unit);
            assert!((found - expected).abs() < 1e-6, "{scale} {distance}: {found} {expected}");
        }
    }
}

#[test]
fn odd_poses_make_no_trouble() {
    let shapes: Vec<Shape> = rare().into_iter().chain(common()).chain([floor()]).collect();
    let broken = Pose::new(DVec3::new(f64::NAN, 0.0, 0.0), DQuat::IDENTITY);
    for a in &shapes {
        for b in &shapes {
            assert_eq!(separation(a, &broken, b, &Pose::IDENTITY), f64::INFINITY);
            assert!(checked_manifolds((a, &broken), (b, &Pose::IDENTITY), 1.0).is_empty());
            // One right inside the other.
            assert!(separation(a, &Pose::IDENTITY, b, &Pose::IDENTITY) < 1e-9, "{a:?} {b:?}");
            assert!(any_separation(a, &Pose::IDENTITY, b, &Pose::IDENTITY).is_finite());
            let mut out = checked_manifolds((a, &Pose::IDENTITY), (b, &Pose::IDENTITY), 0.01);
            let before = out.len();
            all_manifolds((a, &at(1e9, 0.0, 0.0)), (b, &at(1e9, 0.3, 0.0)), 0.01, &mut out);
            assert!(out.len() >= before);
        }
    }
}
