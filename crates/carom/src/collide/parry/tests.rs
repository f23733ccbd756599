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
fn convex_pairs_have_the_widest_gap_there_is() {
    let mut number = numbers(11);
    let others: Vec<Shape> = rare().into_iter().chain(common()).collect();
    let (mut apart, mut overlapping) = (0, 0);
    for round in 0..3 {
        for a in &rare() {
            for b in &others {
                let (pose_a, pose_b) =
                    (pose(&mut number, 0.3), pose(&mut number, 0.9 + 0.4 * f64::from(round)));
                let found = separation(a, &pose_a, b, &pose_b);
                let expected = widest_gap((a, &pose_a), (b, &pose_b));
                // The search may stop short on ridges of the gap, never beyond it.
                assert!(found >= expected - 1e-6, "{a:?} {pose_a:?} {b:?} {pose_b:?}: {found} {expected}");
                assert!(found <= expected + 2e-3, "{a:?} {pose_a:?} {b:?} {pose_b:?}: {found} {expected}");
                if found > 0.0 {
                    apart += 1
                } else {
                    overlapping += 1
                }

                let turned = separation(b, &pose_b, a, &pose_a);
                assert!((found - turned).abs() < 1e-6, "{a:?} {b:?}: {found} {turned}");

                let manifolds = checked_manifolds((a, &pose_a), (b, &pose_b), 0.05);
                assert_eq!(!manifolds.is_empty(), found <= 0.05, "{a:?} {b:?} {found}");
                if let [manifold] = &manifolds[..] {
                    assert!((least(&manifolds) - found).abs() < 1e-5, "{a:?} {b:?} {found}");
                    let along = gap_along((a, &pose_a), (b, &pose_b), manifold.normal);
                    assert!((along - found).abs() < 1e-8);
                    for point in manifold.points() {
                        assert!(point.separation >= found - 1e-9);
                    }
                }
            }
        }
    }
    assert!(apart > 30 && overlapping > 30, "{apart} {overlapping}");
}

/// What `least_gap` promises, for shapes of about 1 m.
const NOISE: f64 = 1e-8;

#[test]
fn the_sign_changes_where_the_shapes_touch_and_nowhere_else() {
    let mut number = numbers(12);
    let others: Vec<Shape> = rare().into_iter().chain(common()).collect();
    for a in &rare() {
        for b in &others {
            let (pose_a, mut pose_b) = (pose(&mut number, 0.2), pose(&mut number, 0.2));
            let way = DVec3::new(number(), number(), number()).normalize();
            let start = pose_b.position;
            let mut at = |distance: f64| {
                pose_b.position = start + way * distance;
                separation(a, &pose_a, b, &pose_b)
            };
            let (mut low, mut high) = (0.0, 4.0);
            assert!(at(low) < 0.0 && at(high) > 0.0, "{a:?} {b:?}");
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if at(middle) > 0.0 { high = middle } else { low = middle }
            }
            let touch = high;
            assert!(at(touch).abs() < NOISE, "{a:?} {b:?} {}", at(touch));
            // It cannot change faster than the body moves.
            let mut before = at(touch - 2e-3);
            for k in -199..200 {
                let now = at(touch + 1e-5 * f64::from(k));
                if k > -199 {
                    assert!(
                        now - before > -NOISE && now - before < 1e-5 + NOISE,
                        "{a:?} {b:?} {k} {before} {now}"
                    );
                }
                before = now;
            }
            for power in 4..14 {
                let step = 10_f64.powi(-power);
                let (inside, outside) = (at(touch - step), at(touch + step));
                assert!(inside <= NOISE && outside >= -NOISE, "{a:?} {b:?} {step} {inside} {outside}");
                assert!(
                    outside - inside <= 2.0 * step + 2.0 * NOISE,
                    "{a:?} {b:?} {step} {inside} {outside}"
                );
            }
        }
    }
}

#[test]
fn a_hull_of_a_box_is_a_box() {
    let size = DVec3::new(2.0, 1.0, 3.0);
    let hull = box_hull(size);
    let mut number = numbers(13);
    for _ in 0..300 {
        let pose_hull = pose(&mut number, 0.1);
        let center = DVec3::new(number(), number(), number()) * 3.0;
        let ball = Pose::new(pose_hull.transform_point(center), DQuat::IDENTITY);
        // Ball and box: closest point by clamping; inside, the nearest face.
        let outside = (center.abs() - 0.5 * size).max(DVec3::ZERO).length();
        let inside = (center.abs() - 0.5 * size).max_element().min(0.0);
        let expected = outside + inside - 0.4;
        let found = separation(&hull, &pose_hull, &Shape::sphere(0.4), &ball);
        assert!((found - expected).abs() < 1e-9, "{center} {found} {expected}");
    }
    // Face to face, resting, with a known overlap.
    for overlap in [0.1, 1e-3, 1e-6, 0.0, -1e-6, -1e-3] {
        let top = at(0.1, 1.0 - overlap, -0.2);
        let turn = Pose::new(DVec3::ZERO, rotation_from_vector(DVec3::new(0.3, 0.2, 0.1)));
        let (below, above) = (turn, turn.then_local(&top));
        for other in [box_hull(size), Shape::cuboid(2.0, 1.0, 3.0)] {
            let found = separation(&hull, &below, &other, &above);
            assert!((found + overlap).abs() < 1e-9, "{overlap} {found}");
            let manifolds = checked_manifolds((&hull, &below), (&other, &above), 0.01);
            assert_eq!(manifolds.len(), 1);
            assert_eq!(manifolds[0].points().len(), 4);
            assert!(manifolds[0].normal.distance(turn.rotation * DVec3::Y) < 1e-7);
            for point in manifolds[0].points() {
                assert!((point.separation + overlap).abs() < 1e-7);
                let local = turn.inverse_transform_point(point.point);
                assert!((local.y - 0.5 + 0.5 * overlap).abs() < 1e-7);
                // The common rectangle: x from −0.9 to 1, z from −1.5 to 1.3.
                assert!((local.x - 1.0).abs() < 1e-7 || (local.x + 0.9).abs() < 1e-7, "{local}");
                assert!((local.z - 1.3).abs() < 1e-7 || (local.z + 1.5).abs() < 1e-7, "{local}");
                assert!(point.feature_a != Feature::Surface && point.feature_b != Feature::Surface);
            }
        }
    }
}

#[test]
fn a_cylinder_over_a_plane_stands_lies_and_leans() {
    let (height, radius) = (2.0, 0.5);
    let cylinder = Shape::cylinder(height, radius);
    for k in 0..=90 {
        let lean = f64::from(k).to_radians();
        let turn = rotation_from_vector(DVec3::new(0.0, 0.7, 0.0)) * rotation_from_vector(DVec3::Z * lean);
        let pose = Pose::new(DVec3::new(5.0, 3.0, -2.0), turn);
        let expected = 3.0 - 0.5 * height * lean.cos() - radius * lean.sin();
        let found = separation(&Shape::Plane, &Pose::IDENTITY, &cylinder, &pose);
        assert!((found - expected).abs() < 1e-12, "{k}: {found} {expected}");
        let plane = (&Shape::Plane, &Pose::IDENTITY);
        let manifolds = checked_manifolds(plane, (&cylinder, &pose), expected + 1e-4);
        assert_eq!(manifolds.len(), 1);
        assert_eq!(manifolds[0].normal, DVec3::Y);
        assert!((least(&manifolds) - expected).abs() < 1e-6);
        let points = manifolds[0].points().len();
        assert_eq!(
            points,
            if k == 0 {
                4
            } else if k == 90 {
                2
            } else {
                1
            },
            "{k}"
        );
        let turned = checked_manifolds((&cylinder, &pose), plane, expected + 1e-4);
        assert_eq!(turned[0].normal, DVec3::NEG_Y);
        assert_eq!(turned[0].points()[0].feature_b, manifolds[0].points()[0].feature_a);
        assert_eq!(turned[0].points()[0].point, manifolds[0].points()[0].point);
    }
}

#[test]
fn planes_agree_with_the_farthest_points() {
    let mut number = numbers(14);
    for shape in rare().iter().chain(&common()) {
        for _ in 0..50 {
            let (plane, place) = (pose(&mut number, 1.0), pose(&mut number, 1.5));
            let up = plane.rotation * DVec3::Y;
            let expected = (farthest(shape, &place, -up) - plane.position).dot(up);
            let found = separation(shape, &place, &Shape::Plane, &plane);
            assert!((found - expected).abs() < 1e-12, "{shape:?}");
            let manifolds = checked_manifolds((shape, &place), (&Shape::Plane, &plane), 0.02);
            assert_eq!(manifolds.len(), usize::from(expected <= 0.02));
            if !manifolds.is_empty() {
                assert!((least(&manifolds) - expected).abs() < 1e-5);
            }
        }
    }
    assert_eq!(separation(&Shape::Plane, &Pose::IDENTITY, &Shape::Plane, &Pose::IDENTITY), f64::INFINITY);
}

fn floor() -> Shape {
    let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    let vertices = vec![corner(-5.0, -5.0), corner(-5.0, 5.0), corner(5.0, 5.0), corner(5.0, -5.0)];
    Shape::mesh(vertices, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

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

#[test]
fn the_contact_of_a_cylinder_lies_where_both_touch() {
    // Beside a box that hardly reaches up to it: not halfway up the cylinder's side.
    let (block, cylinder) = (Shape::cuboid(0.7, 0.4, 0.9), Shape::cylinder(0.3, 0.4));
    for (raised, overlap) in [(-1e-8, 1e-9), (-1e-7, 0.0), (-1e-3, 1e-7), (-0.1, -1e-3)] {
        for turn in [0.0, 0.3, 1.0] {
            let place = Pose::new(
                DVec3::new(0.75 - overlap, 0.35 + raised, 0.1),
                rotation_from_vector(DVec3::Y * turn),
            );
            let found = checked_manifolds((&block, &Pose::IDENTITY), (&cylinder, &place), 0.01);
            assert_eq!(found.len(), 1, "{raised} {overlap}");
            for point in found[0].points() {
                let beyond = (point.point.abs() - DVec3::new(0.35, 0.2, 0.45)).max_element();
                let above = point.point.y - place.position.y + 0.15;
                assert!(beyond < 1e-3 && above > -1e-6, "{raised} {overlap}: {}", point.point);
            }
        }
    }
}

#[test]
fn a_corner_that_hardly_overlaps_takes_the_shortest_way_out() {
    // A box whose corner has come over a tile's by 1.2 cm one way and by 1e-10 m the other.
    let corners = [[0.0, 0.0], [0.7, 0.0], [0.7, 0.9], [0.0, 0.9]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let block = Shape::cuboid(0.8, 0.3, 0.5);
    for triangles in [vec![[0, 2, 1], [0, 3, 2]], vec![[1, 3, 2], [1, 0, 3]]] {
        let tile = Shape::mesh(corners.to_vec(), triangles).unwrap();
        for (over, height) in [(1e-10, -1e-8), (1e-7, -1e-7), (1e-10, -4e-6), (1e-9, 0.0)] {
            let place = at(0.0119 - 0.4, 0.15 + height, over - 0.25);
            let found = separation(&tile, &Pose::IDENTITY, &block, &place);
            assert!(found > -1e-6, "{over} {height}: {found}");
            let manifolds = checked_manifolds((&tile, &Pose::IDENTITY), (&block, &place), 1e-6);
            assert!(least(&manifolds) > -1e-4, "{over} {height}: {manifolds:?}");
        }
    }
}

#[test]
fn curved_pairs_find_their_normal() {
    let mut number = numbers(31);
    let curved =
        [Shape::cylinder(1.0, 0.4), Shape::cone(1.2, 0.5), frustum(0.8, 0.3, 0.6), tapered(0.8, 0.5, 0.2)];
    let others: Vec<Shape> = curved.iter().cloned().chain(common()).chain([blob()]).collect();
    let mut touching = 0;
    for (a, b) in curved.iter().flat_map(|a| others.iter().map(move |b| (a, b))) {
        for _ in 0..50 {
            let mut place = pose(&mut number, 1.0);
            let gap = |place: &Pose| separation(a, &Pose::IDENTITY, b, place);
            for _ in 0..40 {
                let way = place.position.normalize();
                place.position -= way * 0.95 * gap(&place);
            }
            let found = checked_manifolds((a, &Pose::IDENTITY), (b, &place), 1e-6);
            let Some(found) = found.first().filter(|_| gap(&place).abs() < 1e-9) else { continue };
            touching += 1;
            let along = |normal: DVec3| {
                (farthest(b, &place, -normal) - farthest(a, &Pose::IDENTITY, normal)).dot(normal)
            };
            let best = widest_near(found.normal, &along);
            let off = best.distance(found.normal);
            assert!(
                off < 6e-5,
                "{a:?} {b:?} {place:?}: off by {off} rad, {:e} m",
                along(best) - along(found.normal)
            );
        }
    }
    assert!(touching > 1000, "{touching}");
}

/// The direction of the widest gap near another, from a search in eight directions around it.
fn widest_near(normal: DVec3, along: &dyn Fn(DVec3) -> f64) -> DVec3 {
    let (mut best, mut angle) = (normal, 1e-3);
    while angle > 1e-9 {
        let first = any_tangent(best);
        let second = best.cross(first);
        let turned = |k: u32| {
            let (sine, cosine) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            (best + (first * cosine + second * sine) * angle).normalize()
        };
        let wider = |one: DVec3, other: DVec3| if along(other) > along(one) + 1e-16 { other } else { one };
        let next = (0..8).map(turned).fold(best, wider);
        if next == best {
            angle *= 0.5;
        }
        best = next;
    }
    best
}
