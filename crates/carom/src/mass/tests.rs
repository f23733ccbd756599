use super::*;
use crate::body::{Body, Collider, Motion, PrincipalInertia};
use crate::math::{DQuat, rotated_diagonal, rotation_from_vector};
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

fn assert_same(one: &MassProperties, other: &MassProperties, tolerance: f64) {
    let size = (other.inertia.x_axis.x.max(other.inertia.y_axis.y) / other.mass).sqrt();
    assert!((one.mass - other.mass).abs() <= tolerance * other.mass, "{} {}", one.mass, other.mass);
    assert!((one.center - other.center).length() <= tolerance * size, "{} {}", one.center, other.center);
    let difference = one.inertia - other.inertia;
    let largest = difference.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    assert!(largest <= tolerance * other.mass * size * size, "{} {}", one.inertia, other.inertia);
}

/// A solid of revolution summed up disc by disc, midpoint rule.
fn by_discs(low: f64, high: f64, density: f64, radius: impl Fn(f64) -> f64) -> MassProperties {
    const DISCS: usize = 400_000;
    let thickness = (high - low) / DISCS as f64;
    let (mut mass, mut first, mut second, mut own) = (0.0, 0.0, 0.0, 0.0);
    for k in 0..DISCS {
        let y = low + (k as f64 + 0.5) * thickness;
        let rr = radius(y) * radius(y);
        let disc = density * PI * rr * thickness;
        mass += disc;
        first += disc * y;
        second += disc * y * y;
        own += disc * rr / 4.0;
    }
    let center = first / mass;
    let across = own + second - mass * center * center;
    let inertia = DMat3::from_diagonal(DVec3::new(across, 2.0 * own, across));
    MassProperties { mass, center: DVec3::new(0.0, center, 0.0), inertia }
}

#[test]
fn frustums_agree_with_a_sum_of_discs() {
    for (height, bottom, top) in
        [(2.0, 0.5, 0.5), (1.0, 0.7, 0.0), (1.0, 0.0, 0.7), (0.3, 2.0, 1.0), (5.0, 0.1, 0.3)]
    {
        let discs =
            by_discs(-0.5 * height, 0.5 * height, 700.0, |y| bottom + (top - bottom) * (y / height + 0.5));
        assert_same(&MassProperties::frustum(height, bottom, top, 700.0), &discs, 1e-6);
    }
}

#[test]
fn a_cylinder_and_a_cone_have_the_textbook_values() {
    let cylinder = MassProperties::frustum(3.0, 0.5, 0.5, 100.0);
    assert!((cylinder.mass - 75.0 * PI).abs() < 1e-9);
    assert!(cylinder.center.length() < 1e-12);
    assert!((cylinder.inertia.y_axis.y - cylinder.mass * 0.125).abs() < 1e-9);
    assert!((cylinder.inertia.x_axis.x - cylinder.mass * (0.25 / 4.0 + 9.0 / 12.0)).abs() < 1e-9);
    let cone = MassProperties::frustum(2.0, 1.0, 0.0, 3.0);
    assert!((cone.mass - 2.0 * PI).abs() < 1e-12);
    assert!((cone.center.y + 0.5).abs() < 1e-12, "a quarter of the height above the base");
    assert!((cone.inertia.y_axis.y - 0.3 * cone.mass).abs() < 1e-12);
    assert!((cone.inertia.x_axis.x - cone.mass * (3.0 / 20.0 + 3.0 / 80.0 * 4.0)).abs() < 1e-12);
}

#[test]
fn tapered_capsules_agree_with_a_sum_of_discs() {
    for (height, bottom, top) in [
        (2.0, 0.5, 0.5),
        (2.0, 0.7, 0.2),
        (2.0, 0.2, 0.7),
        (1.0, 0.9, 0.0),
        (1.0, 0.0, 0.4),
        (0.5, 1.2, 0.8),
        (1.0, 1.5, 0.5),
        (0.4, 0.2, 1.0),
        (0.6, 1.0, 0.40001),
    ] {
        let half: f64 = 0.5 * height;
        let low = (-half - bottom).min(half - top);
        let high = (-half + bottom).max(half + top);
        // The hull's radius at y: the widest of all balls between the two, their radii changing evenly.
        let discs = by_discs(low, high, 700.0, |y| {
            // ρ²(t) = r(t)² − (y − c(t))² is a parabola in t: highest at its vertex or an end.
            let at = |t: f64| {
                let (center, radius) = (-half + t * height, bottom + t * (top - bottom));
                radius * radius - (y - center) * (y - center)
            };
            let taper = top - bottom;
            let bend = height * height - taper * taper;
            let vertex = if bend > 0.0 { (bottom * taper + (y + half) * height) / bend } else { 0.0 };
            at(0.0).max(at(1.0)).max(at(vertex.clamp(0.0, 1.0))).max(0.0).sqrt()
        });
        assert_same(&MassProperties::tapered_capsule(height, bottom, top, 700.0), &discs, 1e-6);
    }
}

#[test]
fn a_ball_that_holds_the_other_stands_alone() {
    let alone = MassProperties::sphere(1.5, 10.0);
    let capsule = MassProperties::tapered_capsule(0.5, 0.3, 1.5, 10.0);
    assert_eq!((capsule.mass, capsule.inertia), (alone.mass, alone.inertia));
    assert_eq!(capsule.center, DVec3::new(0.0, 0.25, 0.0));
}

const BOX: [[u32; 3]; 12] = [
    [0, 4, 6],
    [0, 6, 2],
    [1, 3, 7],
    [1, 7, 5],
    [0, 1, 5],
    [0, 5, 4],
    [2, 6, 7],
    [2, 7, 3],
    [0, 2, 3],
    [0, 3, 1],
    [4, 5, 7],
    [4, 7, 6],
];

/// Corner numbers have bit 0, 1, 2 set where x, y, z is positive.
fn box_corners(size: DVec3, pose: &Pose) -> Vec<DVec3> {
    let side = |corner: u32, bit: u32| f64::from(corner >> bit & 1) - 0.5;
    (0..8)
        .map(|corner| size * DVec3::new(side(corner, 0), side(corner, 1), side(corner, 2)))
        .map(|corner| pose.transform_point(corner))
        .collect()
}

#[test]
fn a_box_of_triangles_weighs_what_a_box_weighs_wherever_it_is() {
    let size = DVec3::new(1.0, 2.0, 0.5);
    for position in [DVec3::ZERO, DVec3::new(3.0, -2.0, 1.0), DVec3::new(900.0, 500.0, -700.0)] {
        let pose = Pose::new(position, rotation_from_vector(DVec3::new(0.3, 1.1, -0.4)));
        let cuboid = MassProperties::cuboid(size, 800.0).transformed(&pose);
        let corners = box_corners(size, &pose);
        assert_same(&MassProperties::polyhedron(&corners, &BOX, 800.0), &cuboid, 1e-10);
        let inside_out = BOX.map(|[a, b, c]| [a, c, b]);
        assert_same(&MassProperties::polyhedron(&corners, &inside_out, 800.0), &cuboid, 1e-10);
        // Faces that don't share corners, as files often have them.
        let loose: Vec<DVec3> = BOX.iter().flatten().map(|&index| corners[index as usize]).collect();
        let faces: Vec<[u32; 3]> = (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        assert_same(&MassProperties::polyhedron(&loose, &faces, 800.0), &cuboid, 1e-10);
    }
}

#[test]
fn a_tetrahedron_has_the_textbook_values() {
    // Corner at the origin, legs 1 along the axes: V = 1/6, I_xx = V (3/80 + 3/80) about the centre, I_xy = +V/80.
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let found = MassProperties::polyhedron(&corners, &faces, 6.0);
    assert!((found.mass - 1.0).abs() < 1e-14);
    assert!((found.center - DVec3::splat(0.25)).length() < 1e-14);
    let (own, product) = (6.0 / 80.0, 1.0 / 80.0);
    let expected = DMat3::from_cols(
        DVec3::new(own, product, product),
        DVec3::new(product, own, product),
        DVec3::new(product, product, own),
    );
    assert!(found.inertia.abs_diff_eq(expected, 1e-14), "{}", found.inertia);
}

#[test]
fn what_is_open_flat_or_torn_weighs_nothing() {
    let corners = box_corners(DVec3::ONE, &Pose::IDENTITY);
    assert_eq!(MassProperties::polyhedron(&corners, &BOX[..11], 1.0), MassProperties::NONE);
    // A tube open at both ends: its area vectors cancel, its edges do not.
    assert_eq!(MassProperties::polyhedron(&corners, &BOX[..8], 1.0), MassProperties::NONE);
    let mut torn = BOX;
    torn[3].swap(0, 1);
    assert_eq!(MassProperties::polyhedron(&corners, &torn, 1.0), MassProperties::NONE);
    let flat = box_corners(DVec3::new(1.0, 0.0, 1.0), &Pose::IDENTITY);
    assert_eq!(MassProperties::polyhedron(&flat, &BOX, 1.0), MassProperties::NONE);
    assert_eq!(MassProperties::polyhedron(&corners, &[], 1.0), MassProperties::NONE);
    assert_eq!(MassProperties::polyhedron(&corners, &[[0, 1, 99]], 1.0), MassProperties::NONE);
}

#[test]
fn the_sum_of_the_halves_is_the_whole() {
    let turn = rotation_from_vector(DVec3::new(-0.8, 0.2, 0.5));
    let outer = Pose::new(DVec3::new(4.0, 5.0, -6.0), turn);
    let half = |y: f64| {
        let pose = outer.then_local(&Pose::new(DVec3::new(0.0, y, 0.0), DQuat::IDENTITY));
        MassProperties::cuboid(DVec3::new(1.0, 1.5, 2.0), 300.0).transformed(&pose)
    };
    let whole = MassProperties::cuboid(DVec3::new(1.0, 3.0, 2.0), 300.0).transformed(&outer);
    let parts = [half(0.75), MassProperties::NONE, half(-0.75)];
    assert_same(&MassProperties::sum(parts.into_iter()), &whole, 1e-13);
    assert_eq!(MassProperties::sum([MassProperties::NONE; 3].into_iter()), MassProperties::NONE);
}

#[test]
fn principal_axes_give_the_tensor_back() {
    let mut number = numbers(5);
    for round in 0..1000 {
        let turn = rotation_from_vector(DVec3::new(number(), number(), number()) * 3.0);
        let scale = 10_f64.powi(round % 13 - 6);
        let (a, b, c) = (1.1 + number(), 1.1 + number(), 1.1 + number());
        let moments = scale
            * match round % 5 {
                0 => DVec3::splat(a),
                1 => DVec3::new(a, a, b),
                2 => DVec3::new(a, b, b),
                3 => DVec3::new(a, a * (1.0 + 1e-9 * b), c * 1e-6),
                _ => DVec3::new(a, b, c),
            };
        let tensor = rotated_diagonal(turn, moments);
        let (found, rotation) = principal_axes(&tensor);
        assert!(rotation.is_normalized() && found.min_element() > 0.0);
        let axes = DMat3::from_quat(rotation);
        assert!((axes.determinant() - 1.0).abs() < 1e-14);
        let back = rotated_diagonal(rotation, found);
        assert!(back.abs_diff_eq(tensor, 2e-14 * moments.max_element()), "round {round}");
    }
}

#[test]
fn a_diagonal_tensor_keeps_its_order() {
    for moments in [DVec3::new(3.0, 1.0, 2.0), DVec3::splat(4.0), DVec3::new(1e-9, 1.0, 1.0)] {
        let noise = DMat3::from_cols_array(&[0.0, 1e-16, 0.0, 1e-16, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(principal_axes(&DMat3::from_diagonal(moments)), (moments, DQuat::IDENTITY));
        if moments.x > 1e-3 {
            assert_eq!(principal_axes(&(DMat3::from_diagonal(moments) + noise)).1, DQuat::IDENTITY);
        }
    }
}

fn club() -> Body {
    Body::dynamic()
        .with(Shape::capsule(0.8, 0.02))
        .collider(Collider::new(Shape::sphere(0.06)).at(0.0, 0.4, 0.1))
}

#[test]
fn a_body_weighs_its_solid_colliders() {
    let mut body = club();
    let mut sensor = Collider::new(Shape::sphere(5.0));
    sensor.sensor = true;
    body.colliders.push(sensor);
    let expected = club().collider_mass();
    let found = BodyMass::of(&body).unwrap();
    assert_eq!((found.mass, found.center), (expected.mass, expected.center));
    let back = rotated_diagonal(found.principal_rotation, found.moments);
    assert!(back.abs_diff_eq(expected.inertia, 1e-14 * found.moments.max_element()));
    assert!((found.inverse_mass() * found.mass - 1.0).abs() < 1e-15);
}

#[test]
fn a_given_mass_scales_and_a_given_centre_moves() {
    let free = BodyMass::of(&club()).unwrap();
    let mut body = club().mass(3.0 * free.mass);
    body.center_of_mass = Some(DVec3::new(0.0, -0.1, 0.0));
    let found = BodyMass::of(&body).unwrap();
    assert_eq!((found.mass, found.center), (3.0 * free.mass, DVec3::new(0.0, -0.1, 0.0)));
    assert!((found.moments - 3.0 * free.moments).length() < 1e-12 * found.moments.length());
    assert!(found.principal_rotation.abs_diff_eq(free.principal_rotation, 1e-12));
}

#[test]
fn zero_stands_for_infinite() {
    let heavy = BodyMass::of(&club().mass(0.0)).unwrap();
    assert!(heavy.is_infinite() && heavy.is_infinitely_hard_to_turn());
    assert_eq!((heavy.inverse_mass(), heavy.inverse_moments()), (0.0, DVec3::ZERO));
    assert_eq!(heavy.center, club().collider_mass().center);

    let orientation = rotation_from_vector(DVec3::new(0.1, 0.2, 0.3));
    let mut pinned = club().mass(0.0);
    pinned.inertia = Some(PrincipalInertia { diagonal: DVec3::new(0.0, 2.0, 0.0), orientation });
    let found = BodyMass::of(&pinned).unwrap();
    assert!(found.is_infinite() && !found.is_infinitely_hard_to_turn());
    assert_eq!(found.inverse_moments(), DVec3::new(0.0, 0.5, 0.0));
    assert_eq!(found.principal_rotation, orientation);
}

#[test]
fn a_body_may_have_mass_and_inertia_without_shapes() {
    let mut body = Body::dynamic().mass(2.0);
    let diagonal = DVec3::new(1.0, 2.0, 3.0);
    body.inertia = Some(PrincipalInertia { diagonal, orientation: DQuat::IDENTITY });
    let found = BodyMass::of(&body).unwrap();
    assert_eq!((found.mass, found.center, found.moments), (2.0, DVec3::ZERO, diagonal));
}

#[test]
fn what_does_not_move_is_infinite() {
    assert_eq!(BodyMass::of(&Body::fixed().with(Shape::plane())).unwrap(), BodyMass::INFINITE);
    let mut lift = Body::kinematic().collider(Collider::new(Shape::sphere(1.0)).at(1.0, 2.0, 3.0));
    let found = BodyMass::of(&lift).unwrap();
    assert_eq!(found, BodyMass { center: DVec3::new(1.0, 2.0, 3.0), ..BodyMass::INFINITE });
    lift.center_of_mass = Some(DVec3::X);
    assert_eq!(BodyMass::of(&lift).unwrap().center, DVec3::X);
    assert_eq!(BodyMass::of(&Body::kinematic()).unwrap(), BodyMass::INFINITE);
}

#[test]
fn what_no_body_can_have_is_refused_with_advice() {
    let refused = |body: &Body| BodyMass::of(body).unwrap_err();
    for mass in [-1.0, 1e-10, 1e16, f64::NAN, f64::INFINITY] {
        let error = refused(&club().mass(mass));
        assert_eq!(error.field, "mass");
        assert!(error.expected.contains("0 for infinite"), "{error}");
    }
    let mut light = club();
    light.colliders.iter_mut().for_each(|collider| collider.density = 1e-9);
    assert!(refused(&light).value.ends_with("from the colliders"));
    let mut heavy = Body::dynamic().with(Shape::sphere(1e5));
    heavy.colliders[0].density = 1e9;
    assert_eq!(refused(&heavy).field, "mass");

    let nothing = refused(&Body::dynamic());
    assert!(nothing.expected.contains("`mass` together with `inertia_diagonal`"), "{nothing}");
    assert!(refused(&Body::dynamic().mass(2.0)).expected.contains("inertia_diagonal"));
    let mut weightless = Body::dynamic().with(plate(2.0, 4.0)).mass(1.0);
    assert!(refused(&Body { mass: None, ..weightless.clone() }).value.contains("0 kg"));
    weightless.colliders[0].density = 0.0;
    assert!(refused(&weightless).expected.contains("inertia_diagonal"));

    let with = |x: f64, y: f64, z: f64, orientation: DQuat| {
        let mut body = club();
        body.inertia = Some(PrincipalInertia { diagonal: DVec3::new(x, y, z), orientation });
        body
    };
    let upright = DQuat::IDENTITY;
    assert_eq!(refused(&with(1.0, -2.0, 2.0, upright)).field, "inertia_diagonal[1]");
    assert_eq!(refused(&with(1.0, 2.0, f64::NAN, upright)).field, "inertia_diagonal[2]");
    assert_eq!(refused(&with(f64::INFINITY, 2.0, 2.0, upright)).field, "inertia_diagonal[0]");
    assert_eq!(refused(&with(1.0, 2.0, 3.00001, upright)).field, "inertia_diagonal");
    assert!(BodyMass::of(&with(1.0, 2.0, 3.0, upright)).is_ok());
    assert!(BodyMass::of(&with(1.0, 2.0, 3.000_001, upright)).is_ok());
    assert!(BodyMass::of(&with(0.0, 1.0, 9.0, upright)).is_ok(), "infinite about x");
    assert_eq!(refused(&with(1.0, 1.0, 1.0, upright * 1.1)).field, "inertia_orientation");
    assert_eq!(refused(&with(1.0, 1.0, 1.0, upright * f64::NAN)).field, "inertia_orientation");

    let mut off = club();
    off.center_of_mass = Some(DVec3::new(0.0, f64::NAN, 0.0));
    assert_eq!(refused(&off).field, "center_of_mass[1]");
}

/// A rectangle across y.
fn plate(x: f64, z: f64) -> Shape {
    let corner = |sign_x: f64, sign_z: f64| DVec3::new(0.5 * x * sign_x, 0.0, 0.5 * z * sign_z);
    let corners = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    Shape::mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

#[test]
fn a_sheet_has_the_textbook_values() {
    let Shape::Mesh(mesh) = plate(2.0, 4.0) else { unreachable!() };
    let found = MassProperties::sheet(mesh.vertices(), mesh.triangles(), 1.5);
    // m z²/12, the sum of both, m x²/12.
    let inertia = DMat3::from_diagonal(DVec3::new(16.0, 20.0, 4.0));
    assert_same(&found, &MassProperties { mass: 12.0, center: DVec3::ZERO, inertia }, 1e-14);
    // A box of sheet metal is six plates.
    let size = DVec3::new(1.0, 2.0, 3.0);
    let far = Pose::new(DVec3::new(1e5, -2e5, 3e5), DQuat::IDENTITY);
    let shell = MassProperties::sheet(&box_corners(size, &far), &BOX, 2.0);
    let [x, y, z] = size.to_array();
    let sides = (0..6).map(|side| {
        let (axis, sign) = (side % 3, if side < 3 { 0.5 } else { -0.5 });
        let flat = DVec3::from_array([0, 1, 2].map(|other| if other == axis { 0.0 } else { size[other] }));
        let area = [y * z, x * z, x * y][axis];
        let squares = flat * flat * (2.0 * area / 12.0);
        let diagonal = DVec3::splat(squares.element_sum()) - squares;
        let center = DVec3::AXES[axis] * (sign * size[axis]) + far.position;
        MassProperties { mass: 2.0 * area, center, inertia: DMat3::from_diagonal(diagonal) }
    });
    assert_same(&shell, &MassProperties::sum(sides), 1e-9);
    assert_eq!(MassProperties::sheet(&[DVec3::X; 3], &[[0, 1, 2]], 1.0), MassProperties::NONE);
    assert_eq!(MassProperties::sheet(&[DVec3::X; 3], &[[0, 1, 9]], 1.0), MassProperties::NONE);
}

#[test]
fn a_mass_without_a_volume_is_spread_over_the_surfaces() {
    let place = Pose::new(DVec3::new(3.0, 1.0, -2.0), rotation_from_vector(DVec3::Z * 0.4));
    let mut body =
        Body::dynamic().collider(Collider { pose: place, ..Collider::new(plate(2.0, 4.0)) }).mass(12.0);
    let found = BodyMass::of(&body).unwrap();
    assert!((found.center - place.position).length() < 1e-12 && found.mass == 12.0);
    let mut moments = found.moments.to_array();
    moments.sort_by(f64::total_cmp);
    assert!((DVec3::from_array(moments) - DVec3::new(4.0, 16.0, 20.0)).length() < 1e-9, "{moments:?}");

    // The densities share it out, as they do for solids.
    body.colliders.push(Collider { density: 3000.0, ..Collider::new(plate(2.0, 4.0)) });
    let found = BodyMass::of(&body).unwrap();
    assert!((found.center - place.position / 4.0).length() < 1e-12, "{}", found.center);
    // What the body says of its own goes before.
    body.center_of_mass = Some(DVec3::Y);
    assert_eq!(BodyMass::of(&body).unwrap().center, DVec3::Y);
    // One solid among them takes all of it.
    body.center_of_mass = None;
    body.colliders.push(Collider::new(Shape::sphere(0.5)));
    assert_eq!(BodyMass::of(&body).unwrap().center, DVec3::ZERO);
    // A body that nothing pushes has no mass to spread.
    let kinematic = Body { motion: Motion::Kinematic, colliders: body.colliders[..1].to_vec(), ..body };
    assert_eq!(BodyMass::of(&kinematic).unwrap().center, DVec3::ZERO);
}
