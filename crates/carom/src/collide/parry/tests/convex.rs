//! Pairs of convex shapes, and these over planes.

use super::*;

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
