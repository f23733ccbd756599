//! Scenes of chance: nothing is unexplained in any step.

use super::random::Random;
use super::*;
use carom::PrincipalInertia;
use carom::math::{DQuat, Quat};

fn shape(random: &mut Random) -> Shape {
    let size = |random: &mut Random| random.range(0.4, 1.2);
    let (x, y, z) = (size(random), size(random), size(random));
    match random.below(6) {
        0 => Shape::sphere(0.5 * x),
        1 => Shape::capsule(x, 0.4 * y),
        2 => Shape::cylinder(x, 0.5 * y),
        3 => Shape::cone(x, 0.5 * y),
        _ => Shape::cuboid(x, y, z),
    }
}

fn body(random: &mut Random, place: DVec3) -> Body {
    let (velocity, spin) = (random.vector(2.0), random.vector(4.0));
    let mut body = Body::dynamic()
        .with(shape(random))
        .rotated(random.rotation().as_quat())
        .at(place.x, place.y, place.z)
        .moving(velocity.x as f32, velocity.y as f32, velocity.z as f32)
        .spinning(spin.x as f32, spin.y as f32, spin.z as f32)
        .restitution([0.0, 0.0, 0.5, 1.0][random.below(4)])
        .friction([0.0, 0.3, 0.8][random.below(3)]);
    if random.below(4) == 0 {
        (body.linear_damping, body.angular_damping) = (random.range(0.0, 2.0), random.range(0.0, 2.0));
    }
    body.gravity_factor = [1.0, 1.0, 1.0, 0.5, -0.1][random.below(5)];
    body
}

fn scatter(
    world: &mut World,
    random: &mut Random,
    (count, middle, width): (usize, DVec3, f64),
) -> Vec<BodyId> {
    (0..count)
        .map(|number| {
            let jitter = random.vector(width);
            let place = middle + DVec3::new(jitter.x, 1.0 + 0.7 * number as f64, jitter.z);
            world.add(body(random, place))
        })
        .collect()
}

#[test]
fn heaps_far_from_the_origin_balance() {
    for seed in 0..4 {
        let mut random = Random(seed);
        let mut world = world();
        let middle = DVec3::new(300.0, -20.0, 70.0);
        let floor = Body::fixed().with(Shape::cuboid(40.0, 2.0, 40.0));
        world.add(floor.at(middle.x, middle.y - 1.0, middle.z).restitution(0.3));
        scatter(&mut world, &mut random, (25, middle, 1.5));
        run(&mut world, 240);
    }
}

#[test]
fn heaps_on_what_moves_balance() {
    for seed in 10..13 {
        let mut random = Random(seed);
        let mut world = world();
        let turntable = Body::kinematic().with(Shape::cylinder(1.0, 6.0)).at(0.0, -0.5, 0.0);
        world.add(turntable.spinning(0.0, 1.5, 0.0).moving(0.3, 0.1, 0.0));
        world.add(ground().restitution(0.2));
        scatter(&mut world, &mut random, (20, DVec3::ZERO, 2.0));
        run(&mut world, 240);
        assert!(posts(&world).kinematic.linear != DVec3::ZERO);
    }
}

#[test]
fn surfaces_of_triangles_and_heights_balance() {
    let mut random = Random(21);
    let heights: Vec<Vec<f64>> = (0..17).map(|_| (0..17).map(|_| random.range(0.0, 0.6)).collect()).collect();
    let field = Shape::height_field(&heights, [16.0, 16.0]).unwrap();
    let corners = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)];
    let mut vertices: Vec<DVec3> = corners.map(|(x, z)| DVec3::new(x, 1.5, z)).into();
    vertices.push(DVec3::ZERO);
    let bowl = Shape::mesh(vertices, vec![[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0]]).unwrap();
    for shape in [field, bowl] {
        let mut world = world();
        world.add(Body::fixed().with(shape));
        scatter(&mut world, &mut random, (15, DVec3::Y, 2.0));
        run(&mut world, 150);
    }
}

/// Nothing but the bodies themselves: momentum comes from nowhere, angular momentum from overlaps that are pushed out.
#[test]
fn a_cluster_without_gravity_keeps_its_momentum() {
    for seed in 30..33 {
        let mut random = Random(seed);
        let mut world = weightless();
        for number in 0..24 {
            let place =
                DVec3::new(f64::from(number % 3), f64::from(number / 9), f64::from(number / 3 % 3)) * 1.6;
            let mut body = body(&mut random, place);
            (body.linear_damping, body.angular_damping) = (0.0, 0.0);
            let inward = (DVec3::ONE * 1.6 - place) * 2.0;
            world.add(body.moving(inward.x as f32 + 5.0, inward.y as f32, inward.z as f32));
        }
        run(&mut world, 240);
        let books = world.ledger().total();
        let size = books.start.momentum.linear.length();
        assert_eq!(books.throughput()[0], 0.0);
        assert!((books.end.momentum.linear - books.start.momentum.linear).length() < 1e-12 * size, "{books}");
        let turned = books.end.momentum.angular - books.start.momentum.angular;
        assert_eq!(books.throughput()[1] > 0.0, posts(&world).external.angular != DVec3::ZERO);
        assert!((turned - posts(&world).external.angular).length() < 1e-10 * size, "{books}");
        assert!(turned.length() < 1e-4 * size, "{books}");
    }
}

/// A big push at a heap that lies: contacts that persist are struck within the substep.
#[test]
fn heaps_that_are_struck_where_they_lie_balance() {
    let mut random = Random(40);
    let mut world = world();
    world.add(ground());
    for number in 0..4 {
        for row in 0..4 {
            world.add(cube().at(1.02 * f64::from(number), 0.5 + f64::from(row), 0.0));
        }
    }
    run(&mut world, 60);
    for _ in 0..6 {
        let at = DVec3::new(-4.0, random.range(0.3, 3.5), random.range(-0.4, 0.4));
        world.add(ball().mass(6.0).at(at.x, at.y, at.z).moving(12.0, 0.0, 0.0).restitution(0.4));
        run(&mut world, 40);
    }
}

#[test]
fn forces_and_torques_on_a_heap_balance() {
    let mut random = Random(50);
    let mut world = world();
    world.add(ground());
    let bodies = scatter(&mut world, &mut random, (12, DVec3::ZERO, 1.5));
    for _ in 0..200 {
        for &id in &bodies {
            let mut body = world.body_mut(id).unwrap();
            body.add_force(random.vector(2000.0)).unwrap();
            body.add_torque(random.vector(300.0)).unwrap();
        }
        run(&mut world, 1);
    }
}

/// Infinite masses, infinite inertias, some axes of them driven: what they take has an account of its own.
#[test]
fn what_nothing_moves_has_an_account_of_its_own() {
    let mut random = Random(60);
    let infinite = [
        (Some(0.0), DVec3::new(300.0, 200.0, 400.0)),
        (Some(500.0), DVec3::ZERO),
        (Some(500.0), DVec3::new(0.0, 60.0, 0.0)),
        (Some(500.0), DVec3::new(50.0, 60.0, 0.0)),
        (Some(0.0), DVec3::ZERO),
    ];
    for (mass, diagonal) in infinite {
        let mut world = world();
        world.add(ground().friction(0.4));
        let mut odd =
            Body::dynamic().with(Shape::cuboid(2.0, 0.5, 2.0)).at(0.0, 3.0, 0.0).spinning(0.3, 0.5, 0.2);
        odd.mass = mass;
        odd.inertia = Some(PrincipalInertia { diagonal, orientation: DQuat::IDENTITY });
        if mass == Some(0.0) {
            odd.gravity_factor = 0.0;
        }
        world.add(odd);
        scatter(&mut world, &mut random, (10, DVec3::Y * 4.0, 0.8));
        run(&mut world, 120);
    }
}

#[test]
fn compounds_on_a_slope_balance() {
    let mut world = world();
    world.add(ground().rotated(Quat::from_rotation_z(0.3)).friction(0.2));
    for number in 0..8 {
        let dumbbell = Body::dynamic()
            .collider(Collider::new(Shape::sphere(0.4)).at(0.8, 0.0, 0.0))
            .collider(Collider::new(Shape::cuboid(0.5, 0.6, 0.7)).at(-0.6, 0.0, 0.0));
        let at = f64::from(number);
        world.add(dumbbell.at(0.3 * at, 1.5 + 1.2 * at, 0.1 * at).spinning(0.0, 1.0, 2.0).friction(0.4));
    }
    run(&mut world, 240);
}
