//! What slides and rolls over seams.

use super::*;

/// A slide over the ground, and how far the mover may be from where a plane would have it.
struct Slide {
    frame: Frame,
    yaw: f64,
    /// Direction of its velocity, rad from x towards z.
    heading: f64,
    speed: f64,
    /// m
    way: f64,
}

fn unevenly_turned() -> Frame {
    Frame::turned(DVec3::new(0.3, 0.5, -0.2))
}

#[test]
fn without_friction_nothing_changes() {
    let mut worst = [0.0_f64; 4];
    for mover in movers() {
        for (floor, slide) in FLOORS.into_iter().flat_map(|floor| slides().map(|slide| (floor, slide))) {
            let mut world = world_over(slide.frame);
            floor.lay(&mut world, slide.frame, coat(0.0, 0.0));
            let heading = DVec3::new(slide.heading.cos(), 0.0, slide.heading.sin());
            let mut body = coated(mover.body(slide.frame, [0.0, 0.0], (slide.yaw, 0.0)), coat(0.0, 0.0));
            body.linear_velocity = (slide.frame.0.rotation * heading * slide.speed).as_vec3();
            let (start, first) = (body.position, body.rotation);
            let before = body.linear_velocity.as_dvec3();
            let id = world.add(body);
            for number in 1..=(slide.way / slide.speed / STEP) as usize {
                world.step(STEP);
                let state = &world[id];
                let off = state.position() - (start + before * (number as f64 * STEP));
                let height = off.dot(slide.frame.up());
                let errors = [
                    (velocity(state) - before).length() / slide.speed,
                    height.abs(),
                    (off - slide.frame.up() * height).length(),
                    turned(state, first),
                ];
                let case =
                    || format!("{} on {floor:?}, yaw {}, heading {}", mover.name, slide.yaw, slide.heading);
                for (index, limit) in [1e-3, 1e-4, 2e-3, 2e-3].into_iter().enumerate() {
                    worst[index] = worst[index].max(errors[index]);
                    assert!(errors[index] < limit, "{}: {errors:?} after step {number}", case());
                }
            }
        }
    }
    println!("velocity (share), height, way (m), turn (rad): worst {worst:?}");
}

fn slides() -> [Slide; 3] {
    [
        Slide { frame: Frame::level(), yaw: 0.0, heading: 0.0, speed: 5.0, way: 20.0 },
        Slide { frame: Frame::level(), yaw: 0.3, heading: 0.3, speed: 3.0, way: 7.0 },
        Slide { frame: unevenly_turned(), yaw: 0.0, heading: 0.2, speed: 4.0, way: 10.0 },
    ]
}

#[test]
fn with_friction_it_stops_after_v_squared_over_two_mu_g() {
    let (friction, speed) = (0.3, 6.0_f64);
    for mover in movers().into_iter().filter(|mover| !["ball", "capsule"].contains(&mover.name)) {
        for floor in FLOORS {
            let frame = Frame::level();
            let mut world = world_over(frame);
            floor.lay(&mut world, frame, coat(friction, 0.0));
            let mut body = coated(mover.body(frame, [0.0, 0.0], (0.2, 0.0)), coat(friction, 0.0));
            body.linear_velocity = Vec3::new(speed as f32, 0.0, 0.0);
            let id = world.add(body);
            for _ in 0..(3.0 / STEP) as usize {
                world.step(STEP);
            }
            let way = world[id].position().x;
            let truth = speed * speed / (2.0 * friction * G);
            // Likewise: short by up to 9 mm of 6.1 m.
            assert!((way / truth - 1.0).abs() < 2e-3, "{} on {floor:?}: {way} of {truth}", mover.name);
            assert!(velocity(&world[id]).length() < 1e-4);
        }
    }
}

#[test]
fn down_a_slope_it_gains_what_gravity_gives() {
    let angle = 0.4_f64;
    let frame = Frame::turned(DVec3::new(0.0, 0.0, -angle));
    for mover in movers() {
        for floor in FLOORS {
            let mut world = World::new();
            floor.lay(&mut world, frame, coat(0.0, 0.0));
            let id = world.add(coated(mover.body(frame, [0.0, 0.0], (0.1, 0.0)), coat(0.0, 0.0)));
            let start = world[id].position();
            let time = 2.0;
            for _ in 0..(time / STEP).round() as usize {
                world.step(STEP);
            }
            let downhill = frame.0.rotation * DVec3::X;
            let off = world[id].position() - (start + downhill * (0.5 * G * angle.sin() * time * time));
            // Contacts that change from substep to substep give velocities at its start: 1.4 cm of 7.6 m.
            assert!(off.length() < 1.6e-2, "{} on {floor:?}: {off}", mover.name);
        }
    }
}

#[test]
fn a_ball_rolls_along_and_across_seams() {
    // Over the middle of tiles, along a seam, and along a line of corners, at angles.
    for (z, heading) in [(0.0, 0.0_f64), (0.31, 0.0), (0.31, 0.01), (0.0, 0.6), (0.13, 1.2)] {
        for floor in FLOORS {
            let frame = Frame::level();
            let mut world = world_over(frame);
            floor.lay(&mut world, frame, coat(0.5, 0.0));
            let direction = DVec3::new(heading.cos(), 0.0, heading.sin());
            let mut body = coated(Body::dynamic().with(Shape::sphere(0.3)).at(0.0, 0.3, z), coat(0.5, 0.0));
            body.linear_velocity = (direction * 3.0).as_vec3();
            body.angular_velocity = (DVec3::Y.cross(direction) * 10.0).as_vec3();
            let before = body.linear_velocity.as_dvec3();
            let spin = body.angular_velocity.as_dvec3();
            let id = world.add(body);
            for number in 1..=60 {
                world.step(STEP);
                let state = &world[id];
                let off = state.position() - (DVec3::new(0.0, 0.3, z) + before * (f64::from(number) * STEP));
                let twist = (state.angular_velocity().as_dvec3() - spin).length();
                let change = (velocity(state) - before).length();
                let case = format!("z {z}, heading {heading} on {floor:?}, step {number}");
                assert!(
                    off.length() < 1e-3 && change < 1e-3 && twist < 5e-3,
                    "{case}: {off} {change} {twist}"
                );
            }
        }
    }
}

#[test]
fn a_spinning_box_goes_on_spinning() {
    for floor in FLOORS {
        let frame = unevenly_turned();
        let mut world = world_over(frame);
        floor.lay(&mut world, frame, coat(0.0, 0.0));
        let mut body = coated(
            frame.place(
                Body::dynamic().with(Shape::cuboid(0.8, 0.3, 0.5)),
                Pose::new(DVec3::Y * 0.15, rotation_from_vector(DVec3::Y * 0.4)),
            ),
            coat(0.0, 0.0),
        );
        body.linear_velocity = (frame.0.rotation * DVec3::new(2.0, 0.0, 0.3)).as_vec3();
        body.angular_velocity = (frame.up() * 3.0).as_vec3();
        let (before, spin) = (body.linear_velocity.as_dvec3(), body.angular_velocity.as_dvec3());
        let id = world.add(body);
        for number in 0..300 {
            world.step(STEP);
            let change = (velocity(&world[id]) - before).length();
            let twist = (world[id].angular_velocity().as_dvec3() - spin).length();
            assert!(change < 2e-3 && twist < 5e-3, "{floor:?}, step {number}: {change} {twist}");
        }
    }
}
