//! Height fields against meshes of the same triangles, and balls and boxes on flat ones.

use crate::support::Random;
use carom::Shape;
use carom::collide::{Manifold, manifolds, separation};
use carom::math::{DQuat, DVec3, Pose};

const COLUMNS: usize = 13;
const ROWS: usize = 10;
const SIZE: [f64; 2] = [4.8, 4.5];

fn rows(mut height: impl FnMut(usize, usize) -> f64) -> Vec<Vec<f64>> {
    (0..ROWS).map(|j| (0..COLUMNS).map(|i| height(i, j)).collect()).collect()
}

/// The triangles of a height field as a scene file's description has them, in the order of the numbers of its faces, or
/// backwards.
fn mesh(heights: &[Vec<f64>], backwards: bool) -> Shape {
    let along = |index: usize, count: usize, size: f64| {
        let cells = count as f64 - 1.0;
        (2.0 * index as f64 - cells) / (2.0 * cells) * size
    };
    let mut vertices = Vec::new();
    for (j, row) in heights.iter().enumerate() {
        for (i, &height) in row.iter().enumerate() {
            vertices.push(DVec3::new(along(i, COLUMNS, SIZE[0]), height, along(j, ROWS, SIZE[1])));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..ROWS - 1 {
        for i in 0..COLUMNS - 1 {
            let corner = |i: usize, j: usize| (j * COLUMNS + i) as u32;
            let (low, high) = (corner(i, j), corner(i + 1, j + 1));
            triangles.push([low, corner(i, j + 1), high]);
            triangles.push([low, high, corner(i + 1, j)]);
        }
    }
    if backwards {
        triangles.reverse();
    }
    Shape::mesh(vertices, triangles).unwrap()
}

fn shapes() -> Vec<Shape> {
    let side = |corner: u32, bit: u32| f64::from(corner >> bit & 1) - 0.5;
    let wedge = |k: u32| DVec3::new(side(k, 0), side(k, 1) * 0.6, side(k, 2) * (1.0 + side(k, 1)));
    vec![
        Shape::sphere(0.4),
        Shape::cuboid(0.8, 0.4, 0.6),
        Shape::capsule(0.6, 0.2),
        Shape::hull(&(0..8).map(wedge).collect::<Vec<_>>()).unwrap(),
        Shape::cylinder(0.7, 0.3),
        Shape::cone(0.8, 0.4),
        Shape::TaperedCapsule { height: 0.5, radius_bottom: 0.3, radius_top: 0.1 },
        Shape::mesh(vec![DVec3::ZERO, DVec3::X, DVec3::Z, DVec3::Y], vec![[0, 1, 2], [0, 3, 1]]).unwrap(),
    ]
}

fn touches(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64) -> Vec<Manifold> {
    let mut out = Vec::new();
    manifolds(a, b, margin, &mut out);
    out
}

fn deepest(found: &[Manifold]) -> Option<(f64, DVec3)> {
    let all = found.iter().flat_map(|m| m.points().iter().map(|point| (point.separation, m.normal)));
    all.min_by(|one, other| one.0.total_cmp(&other.0))
}

/// A pose for something above, in or below the surface; in every third round it stands straight, right on a line or a
/// corner of the grid.
fn place(random: &mut Random, round: usize) -> Pose {
    let mut position = DVec3::new(random.range(-2.8, 2.8), random.range(-0.7, 0.9), random.range(-2.6, 2.6));
    let mut rotation = random.rotation();
    if round.is_multiple_of(3) {
        position.x = (position.x / 0.4).round() * 0.4;
        rotation = DQuat::IDENTITY;
    }
    if round.is_multiple_of(6) {
        position.z = (position.z / 0.5).round() * 0.5 + 0.25;
        position.y = if round.is_multiple_of(12) { 0.2 } else { position.y };
    }
    Pose::new(position, rotation)
}

#[test]
fn a_height_field_is_the_mesh_of_its_triangles_to_the_last_bit() {
    let mut random = Random(71);
    for smooth in [true, false] {
        let heights = if smooth {
            rows(|i, j| 0.3 * (0.7 * i as f64).sin() * (0.9 * j as f64).cos())
        } else {
            rows(|i, j| if (i + j) % 4 == 0 { random.range(-0.3, 0.3) } else { 0.0 })
        };
        let field = Shape::height_field(&heights, SIZE).unwrap();
        let (same, backwards) = (mesh(&heights, false), mesh(&heights, true));
        for shape in &shapes() {
            let (mut apart, mut touching) = (0, 0);
            for round in 0..60 {
                let pose = place(&mut random, round);
                let ground = if round % 2 == 0 {
                    Pose::IDENTITY
                } else {
                    Pose::new(random.direction() * 0.3, random.rotation())
                };
                let pose = ground.then_local(&pose);
                let found = separation(&field, &ground, shape, &pose);
                assert_eq!(found, separation(&same, &ground, shape, &pose), "{shape:?} {pose:?}");
                // Of two surfaces the first one's triangles go first, and rounding differs.
                let is_mesh = matches!(shape, Shape::Mesh(_));
                let turned = separation(shape, &pose, &field, &ground);
                assert!(found == turned || is_mesh, "{shape:?} {pose:?}: {found} {turned}");
                let other = separation(&backwards, &ground, shape, &pose);
                assert!((found - other).abs() < 1e-9, "{shape:?} {pose:?}: {found} {other}");

                let of_field = touches((&field, &ground), (shape, &pose), 0.02);
                assert_eq!(of_field, touches((&same, &ground), (shape, &pose), 0.02), "{shape:?} {pose:?}");
                assert_eq!(of_field.is_empty(), found > 0.02, "{shape:?} {pose:?} {found}");
                let turned = touches((shape, &pose), (&field, &ground), 0.02);
                assert!(turned.len() == of_field.len() || is_mesh);
                for (one, other) in of_field.iter().zip(&turned).filter(|_| !is_mesh) {
                    assert_eq!(one.normal, -other.normal);
                    assert_eq!(one.points()[0].feature_a, other.points()[0].feature_b);
                }
                let of_other = touches((&backwards, &ground), (shape, &pose), 0.02);
                match (deepest(&of_field), deepest(&of_other)) {
                    (Some((depth, _)), Some((other, _))) => {
                        touching += 1;
                        assert!((depth - other).abs() < 1e-6, "{shape:?} {pose:?}: {depth} {other}");
                    }
                    (None, None) => apart += 1,
                    other => panic!("{shape:?} {pose:?} {other:?}"),
                }
            }
            assert!(apart > 5 && touching > 5, "{shape:?} {apart} {touching}");
        }
    }
}

#[test]
fn a_ball_that_rolls_over_flat_cells_feels_no_edges() {
    for height in [0.0, 0.3, -1.7] {
        let field = Shape::height_field(&rows(|_, _| height), SIZE).unwrap();
        let ball = Shape::sphere(0.3);
        // Along x, along z, along the cut, along no line; through corners and beside them.
        for way in [DVec3::X, DVec3::Z, DVec3::new(0.8, 0.0, 1.0), DVec3::new(1.0, 0.0, 0.37)] {
            for offset in [0.0, 0.1, 0.2, 0.25] {
                for k in -150_i32..150 {
                    let depth = [1e-3, 1e-6, 0.0, -1e-6][k.unsigned_abs() as usize % 4];
                    let across = DVec3::new(-way.z, 0.0, way.x) * offset;
                    let middle = way * (f64::from(k) * 0.01) + across + DVec3::Y * (height + 0.3 - depth);
                    let pose = Pose::new(middle, DQuat::IDENTITY);
                    let found = separation(&field, &Pose::IDENTITY, &ball, &pose);
                    assert!((found + depth).abs() < 1e-12, "{middle}: {found} {depth}");
                    let touches = touches((&field, &Pose::IDENTITY), (&ball, &pose), 1e-4);
                    assert_eq!(touches.len(), 1, "{middle}: one place, also on a line: {touches:?}");
                    // Straight up; its length may be off by the last bit.
                    let normal = touches[0].normal;
                    assert!(
                        normal.x == 0.0 && normal.z == 0.0 && normal.y > 1.0 - 1e-15,
                        "{middle} {normal}"
                    );
                    let [point] = touches[0].points() else { panic!("{touches:?}") };
                    assert!((point.separation + depth).abs() < 1e-12, "{middle}");
                    let expected = middle.with_y(height - 0.5 * depth);
                    assert!(point.point.distance(expected) < 1e-9, "{middle}: {point:?}");
                }
            }
        }
    }
}

#[test]
fn what_slides_over_flat_cells_is_carried_straight_up() {
    let field = Shape::height_field(&rows(|_, _| 0.0), SIZE).unwrap();
    let mut random = Random(73);
    // The last one is a mesh, whose own sides have borders.
    let shapes = shapes();
    for shape in &shapes[..shapes.len() - 1] {
        for _ in 0..100 {
            let mut pose = Pose::new(DVec3::ZERO, random.rotation());
            let depth = [0.02, 1e-4, 0.0][random.bits() as usize % 3];
            pose.position = DVec3::new(random.range(-1.2, 1.2), 0.0, random.range(-1.2, 1.2));
            pose.position.y = -shape.bounds(&pose).0.y - depth;
            let found = separation(&field, &Pose::IDENTITY, shape, &pose);
            // Deep in a triangle the shortest way out of it may lead sideways.
            assert!(found < 1e-9 && found > -depth - 1e-9, "{shape:?} {pose:?}: {found} {depth}");
            let touches = touches((&field, &Pose::IDENTITY), (shape, &pose), 1e-3);
            // A rim's points stand at its corners, which may be a little higher than its lowest point.
            let least = deepest(&touches).unwrap().0;
            assert!((-depth - 1e-9..=8e-3 - depth).contains(&least), "{shape:?} {pose:?}: {least} {depth}");
            for manifold in &touches {
                assert!(manifold.normal.distance(DVec3::Y) < 1e-6, "{shape:?} {pose:?}: {}", manifold.normal);
            }
        }
    }
}

#[test]
fn a_height_field_is_solid_from_below_and_ends_at_its_border() {
    let field = Shape::height_field(&rows(|_, _| 0.0), SIZE).unwrap();
    let ball = Shape::sphere(0.3);
    let at = |x: f64, y: f64, z: f64| Pose::new(DVec3::new(x, y, z), DQuat::IDENTITY);
    let below = touches((&field, &Pose::IDENTITY), (&ball, &at(0.1, -0.25, 0.2)), 0.0);
    assert!(below.len() == 1 && below[0].normal.distance(DVec3::NEG_Y) < 1e-15);
    assert!((deepest(&below).unwrap().0 + 0.05).abs() < 1e-12);
    // Beside the border by 0.18 m, as near as the border itself.
    let beside = at(2.4 + 0.18, 0.24, 0.33);
    assert!(separation(&field, &Pose::IDENTITY, &ball, &beside).abs() < 1e-12);
    let touch = touches((&field, &Pose::IDENTITY), (&ball, &beside), 1e-3);
    assert!(touch[0].normal.distance(DVec3::new(0.6, 0.8, 0.0)) < 1e-9, "{touch:?}");
    // Far off, a bound that never exceeds the distance.
    for height in [1.0, 10.0, 1e6] {
        let found = separation(&field, &Pose::IDENTITY, &ball, &at(0.0, height, 0.0));
        assert!(found > 0.1 && found <= height - 0.3, "{height} {found}");
    }
}

#[test]
fn a_height_field_over_a_plane_is_as_high_as_its_lowest_corner() {
    let field = Shape::height_field(&rows(|i, j| 0.1 * (i * j) as f64 - 0.4), SIZE).unwrap();
    let plane = Pose::new(DVec3::Y * -1.0, DQuat::IDENTITY);
    let found = separation(&field, &Pose::IDENTITY, &Shape::plane(), &plane);
    assert!((found - 0.6).abs() < 1e-15, "{found}");
    assert_eq!(separation(&Shape::plane(), &plane, &field, &Pose::IDENTITY), found);
}

#[test]
fn bounds_and_reach_hold_all_of_it() {
    let mut random = Random(74);
    let heights = rows(|i, j| 0.2 * ((i * 7 + j * 5) % 11) as f64);
    let (field, mesh) = (Shape::height_field(&heights, SIZE).unwrap(), mesh(&heights, false));
    for _ in 0..50 {
        let pose = Pose::new(random.direction() * 3.0, random.rotation());
        let ((low, high), (least, most)) = (field.bounds(&pose), mesh.bounds(&pose));
        assert!((low - least).max_element() < 1e-12 && (most - high).max_element() < 1e-12);
        let origin = random.direction() * 4.0;
        assert!(field.reach(origin) >= mesh.reach(origin));
    }
    assert_eq!(field.bounds(&Pose::IDENTITY), mesh.bounds(&Pose::IDENTITY));
}
