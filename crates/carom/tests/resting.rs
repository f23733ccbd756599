//! What stands, lies, slides and creeps, for many seconds.

use carom::math::{DVec3, rotation_from_vector};
use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;

fn plane() -> Body {
    Body::fixed().with(Shape::plane())
}

/// A box whose top is at height 0.
fn slab() -> Body {
    Body::fixed().collider(Collider::new(Shape::cuboid(20.0, 1.0, 20.0)).at(0.0, -0.5, 0.0))
}

/// A floor of triangles at height 0.
fn grid() -> Body {
    const SIDE: u32 = 9;
    let vertices = (0..SIDE * SIDE)
        .map(|index| DVec3::new(f64::from(index % SIDE) - 4.3, 0.0, f64::from(index / SIDE) - 4.1))
        .collect();
    let triangles = (0..SIDE - 1)
        .flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column))
        .flat_map(|corner| {
            [[corner, corner + SIDE, corner + 1], [corner + 1, corner + SIDE, corner + SIDE + 1]]
        })
        .collect();
    Body::fixed().with(Shape::mesh(vertices, triangles).unwrap())
}

fn run(world: &mut World, seconds: f64) {
    for _ in 0..(seconds / STEP).round() as usize {
        world.step(STEP);
    }
}

fn total_energy(world: &World) -> f64 {
    let energy = world.energy();
    energy.kinetic + energy.potential
}

#[test]
fn a_stack_of_three_stands_for_ten_seconds() {
    for restitution in [0.0, 0.5] {
        let mut world = World::new();
        world.add(slab());
        let boxes = [0.5, 1.5, 2.5].map(|y| {
            world.add(
                Body::dynamic().at(0.0, y, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(restitution),
            )
        });
        run(&mut world, 10.0);
        for (id, y) in boxes.into_iter().zip([0.5, 1.5, 2.5]) {
            let state = &world[id];
            let moved = (state.position() - DVec3::new(0.0, y, 0.0)).length();
            assert!(moved < 2e-3, "C_r {restitution}: the box at {y} has moved by {moved}");
            assert!(state.linear_velocity().length() < 1e-3, "C_r {restitution}: {state:?}");
        }
    }
}

#[test]
fn a_stack_that_falls_into_place_stands() {
    for restitution in [0.0, 0.5] {
        let mut world = World::new();
        world.add(slab());
        let boxes = [0.55, 1.6, 2.65].map(|y| {
            let cube = Body::dynamic().at(0.0, y, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0));
            world.add(cube.restitution(restitution))
        });
        run(&mut world, 5.0);
        let landed = boxes.map(|id| world[id].position());
        run(&mut world, 5.0);
        for ((id, landed), y) in boxes.into_iter().zip(landed).zip([0.5, 1.5, 2.5]) {
            let place = world[id].position();
            assert!((place.y - y).abs() < 2e-3, "C_r {restitution}: {place} instead of {y}");
            assert!((place - landed).length() < 1e-3, "C_r {restitution}: from {landed} to {place}");
            assert!(world[id].linear_velocity().length() < 1e-3, "C_r {restitution}: {:?}", world[id]);
        }
    }
}

#[test]
fn a_box_stays_on_a_gentle_slope_and_slides_down_a_steep_one() {
    let slope = |degrees: f64, friction: f64| {
        let mut world = World::new();
        let tilt = rotation_from_vector(DVec3::new(0.0, 0.0, -degrees.to_radians()));
        world.add(plane().rotated(tilt.as_quat()).friction(friction));
        let tilt = tilt.as_quat().as_dquat().normalize();
        let start = tilt * DVec3::new(0.0, 0.25, 0.0);
        let body = Body::dynamic()
            .at(start.x, start.y, start.z)
            .rotated(tilt.as_quat())
            .with(Shape::cuboid(1.0, 0.5, 1.0))
            .friction(friction);
        let id = world.add(body);
        (world, id, start, tilt * DVec3::X)
    };
    let (mut world, id, start, _) = slope(15.0, 0.6);
    run(&mut world, 10.0);
    let creep = (world[id].position() - start).length();
    println!("creep {creep:.1e} m");
    assert!(creep < 1e-4, "{creep}");

    let (mut world, id, start, downhill) = slope(30.0, 0.2);
    run(&mut world, 2.0);
    let angle = 30.0_f64.to_radians();
    let expected = 9.81 * (angle.sin() - 0.2 * angle.cos());
    let way = (world[id].position() - start).dot(downhill);
    let speed = world[id].linear_velocity().as_dvec3().dot(downhill);
    println!("way {:.1e}, speed {:.1e}", way / (2.0 * expected) - 1.0, speed / (2.0 * expected) - 1.0);
    assert!((way / (2.0 * expected) - 1.0).abs() < 1e-3, "{way} instead of {}", 2.0 * expected);
    assert!((speed / (2.0 * expected) - 1.0).abs() < 1e-3, "{speed}");
}

#[test]
fn a_ball_lies_still_in_a_corner_of_two_planes() {
    let mut world = World::new();
    for angle in [0.6, -0.8] {
        let tilt = rotation_from_vector(DVec3::new(0.0, 0.0, angle)).as_quat();
        world.add(plane().rotated(tilt).friction(0.3));
    }
    let normals = [0.6_f64, -0.8].map(|angle| DVec3::new(-angle.sin(), angle.cos(), 0.0));
    // The point at distance 0.5 from both: c·n₁ = c·n₂ = 0.5.
    let [n, m] = normals;
    let determinant = n.x * m.y - n.y * m.x;
    let place = DVec3::new(0.5 * (m.y - n.y) / determinant, 0.5 * (n.x - m.x) / determinant, 0.0);
    let ball = world.add(
        Body::dynamic()
            .at(place.x, place.y + 0.1, 0.0)
            .with(Shape::sphere(0.5))
            .restitution(0.3)
            .friction(0.3),
    );
    run(&mut world, 10.0);
    let state = &world[ball];
    assert!((state.position() - place).length() < 1e-3, "{} instead of {place}", state.position());
    assert!(state.linear_velocity().length() < 1e-3, "{state:?}");
}

#[test]
fn a_capsule_lies_still() {
    let mut world = World::new();
    world.add(slab());
    let lying = Quat::from_rotation_z(std::f32::consts::FRAC_PI_2);
    let id = world.add(Body::dynamic().at(0.0, 0.3, 0.0).rotated(lying).with(Shape::capsule(1.0, 0.3)));
    run(&mut world, 10.0);
    let state = &world[id];
    assert!((state.position() - DVec3::new(0.0, 0.3, 0.0)).length() < 1e-3, "{state:?}");
    assert!(state.linear_velocity().length() < 1e-3 && state.angular_velocity().length() < 1e-3, "{state:?}");
}

#[test]
fn all_shapes_stay_on_a_box_and_on_triangles() {
    let block = [(-0.4, 0.0), (0.4, 0.0), (0.0, 0.5)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let prism: Vec<DVec3> = block.iter().flat_map(|&it| [it - 0.3 * DVec3::Y, it + 0.3 * DVec3::Y]).collect();
    let tetrahedron = {
        let vertices = vec![
            DVec3::new(-0.5, -0.25, -0.3),
            DVec3::new(0.5, -0.25, -0.3),
            DVec3::new(0.0, -0.25, 0.6),
            DVec3::new(0.0, 0.75, 0.0),
        ];
        Shape::mesh(vertices, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]).unwrap()
    };
    let shapes = [
        ("ball", Shape::sphere(0.3), 0.3),
        ("box", Shape::cuboid(0.8, 0.4, 0.6), 0.2),
        ("capsule", Shape::capsule(0.6, 0.2), 0.5),
        ("cylinder", Shape::cylinder(0.5, 0.3), 0.25),
        ("cone", Shape::cone(0.8, 0.4), 0.4),
        ("hull", Shape::hull(&prism).unwrap(), 0.3),
        ("mesh", tetrahedron, 0.25),
    ];
    for (ground, floor) in [("slab", slab()), ("grid", grid())] {
        for (name, shape, height) in &shapes {
            let mut world = World::new();
            world.add(floor.clone());
            let id = world.add(Body::dynamic().at(0.0, height + 0.02, 0.0).with(shape.clone()));
            for _ in 0..300 {
                world.step(STEP);
                let y = world[id].position().y;
                // A capsule on its end may fall over.
                let lowest = if *name == "capsule" { 0.2 } else { *height };
                assert!(y > lowest - 2e-3, "{name} on {ground}: {y} at {} s", world.time());
            }
            let state = &world[id];
            if *name != "capsule" {
                let off = (state.position().y - height).abs();
                assert!(off < 2e-3, "{name} on {ground}: {off} m from where it should be, {state:?}");
            }
        }
    }
}

#[test]
fn a_sensor_reports_who_is_inside_and_pushes_nobody() {
    let mut world = World::new();
    let mut gate = Collider::new(Shape::cuboid(1.0, 1.0, 1.0));
    gate.sensor = true;
    let sensor = world.add(Body::fixed().collider(gate));
    let ball = world.add(Body::dynamic().at(0.1, 5.0, 0.0).with(Shape::sphere(0.25)));
    let mut inside = 0;
    for _ in 0..120 {
        let before = world[ball].position().y;
        let report = world.step(STEP).clone();
        assert!(report.impacts().is_empty() && report.contacts() == 0);
        // It falls: at some time of the step it was in the gate.
        let overlaps = before >= -0.75 && world[ball].position().y <= 0.75;
        assert_eq!(report.overlaps().len(), usize::from(overlaps), "at {} s", world.time());
        for overlap in report.overlaps() {
            assert_eq!((overlap.sensor, overlap.visitor), (sensor, ball));
            assert_eq!((overlap.sensor_collider, overlap.visitor_collider), (0, 0));
            inside += 1;
        }
    }
    assert!(inside > 5, "{inside}");
    assert!((world[ball].position().y - (5.0 - 0.5 * 9.81 * 4.0)).abs() < 1e-9);
}

#[test]
fn a_flat_cube_that_keeps_all_its_speed_keeps_its_energy() {
    let mut world = World::new();
    world.add(plane().friction(0.0));
    let cube = world.add(
        Body::dynamic().at(0.0, 1.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(1.0).friction(0.0),
    );
    let start = total_energy(&world);
    let mut instants: Vec<f64> = Vec::new();
    while instants.len() < 20 && world.time() < 60.0 {
        instants.extend(world.step(STEP).impacts().iter().map(|impact| impact.time));
        instants.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let change = total_energy(&world) / start - 1.0;
        assert!(change.abs() < 1e-6, "{change:e} at {} s", world.time());
        let state = &world[cube];
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| f64::from((state.rotation() * axis).y).abs());
        let lowest = state.position().y - 0.5 * axes.iter().sum::<f64>();
        assert!(lowest > -1e-6, "{lowest} at {} s", world.time());
    }
    assert!(instants.len() >= 20, "only {}", instants.len());
}

#[test]
fn a_ball_between_two_close_walls_keeps_its_energy() {
    let mut world = World::with_settings(carom::Settings { gravity: DVec3::ZERO, ..Default::default() });
    for x in [-0.76, 0.76] {
        world.add(Body::fixed().at(x, 0.0, 0.0).with(Shape::cuboid(0.5, 10.0, 10.0)).friction(0.0));
    }
    let ball = world
        .add(Body::dynamic().moving(3.0, 0.1, 0.0).with(Shape::sphere(0.5)).restitution(1.0).friction(0.0));
    let start = total_energy(&world);
    let mut hits = 0;
    for _ in 0..300 {
        hits += world.step(STEP).impacts().len();
        let change = total_energy(&world) / start - 1.0;
        assert!(change.abs() < 1e-6, "{change:e} after {hits} hits");
        assert!(world[ball].position().x.abs() < 0.01 + 1e-6, "{}", world[ball].position());
    }
    // 2 cm between them, 15 m to go.
    assert!((700..=760).contains(&hits), "{hits}");
}

#[test]
fn a_box_pushed_along_the_floor_by_a_turning_wall_does_not_stop_the_clock() {
    let mut world = World::new();
    world.add(slab());
    let wall = Body::kinematic().at(8.0, 0.5, 0.0).moving(-1.0, 0.0, 0.0).spinning(0.0, 1.0, 0.0);
    let wall = world.add(wall.with(Shape::cuboid(1.0, 1.0, 8.0)));
    let pushed = Body::dynamic().at(0.0, 2.0, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(0.6);
    let pushed = world.add(pushed);
    run(&mut world, 10.0);
    assert!(
        (world[wall].position() - DVec3::new(-2.0, 0.5, 0.0)).length() < 1e-6,
        "{}",
        world[wall].position()
    );
    let place = world[pushed].position();
    assert!(place.is_finite() && (place.y > 0.4 || place.x.abs().max(place.z.abs()) > 10.0), "{place}");
}

#[test]
fn five_cubes_on_top_of_each_other_come_to_rest() {
    let mut world = World::new();
    world.add(Body::fixed().at(0.0, -0.5, 0.0).with(Shape::cuboid(20.0, 1.0, 20.0)));
    let cubes = [0.5, 1.5, 2.5, 3.5, 4.5]
        .map(|y| world.add(Body::dynamic().at(0.0, y, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0))));
    let mut hits = 0;
    for step in 0..900 {
        let struck = world.step(1.0 / 60.0).impacts().len();
        hits += if step < 600 { 0 } else { struck };
    }
    for (cube, y) in cubes.into_iter().zip([0.5, 1.5, 2.5, 3.5, 4.5]) {
        let state = &world[cube];
        assert!(state.linear_velocity().length() < 1e-3, "the cube at {y} m: {state:?}");
        assert!((state.position().y - y).abs() < 1e-3 && state.position().x.abs() < 1e-3, "{state:?}");
    }
    assert_eq!(hits, 0, "in the last five seconds");
}

/// It swayed by millimetres a second as long as only islands of up to 256 bodies were solved directly.
#[test]
fn a_pyramid_of_820_boxes_stands_still_within_half_a_second() {
    let mut world = World::new();
    world.add(plane());
    let cube = |course: u32, place: u32| {
        let x = f64::from(place) + 0.5 * f64::from(course) - 20.0;
        Body::dynamic().at(x, 0.5 + f64::from(course), 0.0).with(Shape::cuboid(1.0, 1.0, 1.0))
    };
    let courses = (0..40).flat_map(|course| (0..40 - course).map(move |place| (course, place)));
    let cubes: Vec<BodyId> = courses.map(|(course, place)| world.add(cube(course, place))).collect();
    let starts: Vec<DVec3> = cubes.iter().map(|&id| world[id].position()).collect();
    run(&mut world, 0.5);
    for (&id, start) in cubes.iter().zip(starts) {
        let (state, moved) = (&world[id], world[id].position().distance(start));
        assert!(state.linear_velocity().length() < 1e-5, "{state:?}");
        assert!(moved < 1e-4, "the box at {start} has moved by {moved} m");
    }
}

/// Rest capture took what lies on ice for lying on something with friction if it touched anything rough.
#[test]
fn what_slides_on_ice_along_a_rough_wall_keeps_its_speed() {
    let mut world = World::new();
    world.add(slab().friction(0.0));
    world.add(Body::fixed().with(Shape::cuboid(1.0, 2.0, 9.0)).at(-1.0, 1.0, 0.0).friction(1.0));
    let cube = Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0)).friction(0.0);
    let cube = world.add(cube.at(0.0, 0.5, -2.0).moving(0.0, 0.0, 0.05));
    run(&mut world, 5.0);
    let velocity = world[cube].linear_velocity();
    assert!((f64::from(velocity.z) - 0.05).abs() < 1e-6, "it goes on at {velocity} m/s");
}
