//! What a program can do to a world between two steps.

use carom::math::DVec3;
use carom::prelude::*;
use carom::{BodyMut, Invalid, PrincipalInertia, Settings};

const STEP: f64 = 1.0 / 60.0;

type Command = fn(&mut BodyMut<'_>) -> Result<(), Invalid>;

fn floating() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() })
}

/// 3 kg, with moments of 2 kg·m² about all axes.
fn ball() -> Body {
    let mut body = Body::dynamic().mass(3.0).with(Shape::sphere(0.5));
    body.inertia = Some(PrincipalInertia { diagonal: DVec3::splat(2.0), orientation: DQuat::IDENTITY });
    body
}

fn slab() -> Body {
    Body::fixed().collider(Collider::new(Shape::cuboid(20.0, 1.0, 20.0)).at(0.0, -0.5, 0.0))
}

fn run(world: &mut World, seconds: f64) {
    for _ in 0..(seconds / STEP).round() as usize {
        world.step(STEP);
    }
}

fn velocity(world: &World, id: BodyId) -> DVec3 {
    world[id].linear_velocity().as_dvec3()
}

fn spin(world: &World, id: BodyId) -> DVec3 {
    world[id].angular_velocity().as_dvec3()
}

#[track_caller]
fn assert_close(found: DVec3, expected: DVec3) {
    assert!((found - expected).length() < 1e-6 * expected.length().max(1.0), "{found} instead of {expected}");
}

#[test]
fn forces_and_torques_last_one_step() {
    let mut world = floating();
    let id = world.add(ball());
    let force = DVec3::new(6.0, -9.0, 3.0);
    let torque = DVec3::new(0.0, 4.0, -2.0);
    let mut commands = world.body_mut(id).unwrap();
    commands.add_force(force).unwrap();
    commands.add_force(force).unwrap();
    commands.add_torque(torque).unwrap();
    assert_close(velocity(&world, id), DVec3::ZERO);
    world.step(STEP);
    assert_close(velocity(&world, id), 2.0 * force / 3.0 * STEP);
    assert_close(spin(&world, id), torque / 2.0 * STEP);
    assert_close(world[id].position(), 2.0 * force / 3.0 * (0.5 * STEP * STEP));
    world.step(STEP);
    assert_close(velocity(&world, id), 2.0 * force / 3.0 * STEP);
    assert_close(spin(&world, id), torque / 2.0 * STEP);
}

#[test]
fn a_force_at_a_point_turns_too() {
    let mut world = floating();
    let id = world.add(ball().at(1.0, 2.0, 3.0));
    let (force, arm) = (DVec3::new(1.0, 2.0, -4.0), DVec3::new(0.3, -0.2, 0.1));
    world.body_mut(id).unwrap().add_force_at(force, DVec3::new(1.0, 2.0, 3.0) + arm).unwrap();
    world.step(STEP);
    assert_close(velocity(&world, id), force / 3.0 * STEP);
    assert_close(spin(&world, id), arm.cross(force) / 2.0 * STEP);
}

#[test]
fn impulses_act_at_once() {
    let mut world = floating();
    let id = world.add(ball().at(1.0, 2.0, 3.0).moving(1.0, 0.0, 0.0));
    let (impulse, arm) = (DVec3::new(3.0, -1.5, 6.0), DVec3::new(0.3, -0.2, 0.1));
    world.body_mut(id).unwrap().apply_impulse(impulse).unwrap();
    assert_close(velocity(&world, id), DVec3::X + impulse / 3.0);
    assert_close(spin(&world, id), DVec3::ZERO);
    world.body_mut(id).unwrap().apply_impulse_at(impulse, DVec3::new(1.0, 2.0, 3.0) + arm).unwrap();
    assert_close(velocity(&world, id), DVec3::X + 2.0 * impulse / 3.0);
    assert_close(spin(&world, id), arm.cross(impulse) / 2.0);
    world.body_mut(id).unwrap().apply_angular_impulse(DVec3::Y * 5.0).unwrap();
    assert_close(spin(&world, id), arm.cross(impulse) / 2.0 + DVec3::Y * 2.5);
    world.body_mut(id).unwrap().set_linear_velocity(DVec3::Z).unwrap();
    world.body_mut(id).unwrap().set_angular_velocity(DVec3::X * 7.0).unwrap();
    run(&mut world, 1.0);
    assert_close(velocity(&world, id), DVec3::Z);
    assert_close(spin(&world, id), DVec3::X * 7.0);
    assert_close(world[id].position(), DVec3::new(1.0, 2.0, 4.0));
}

#[test]
fn a_teleported_body_keeps_its_velocities_and_meets_others_where_it_is_now() {
    let mut world = World::new();
    world.add(slab().friction(0.0));
    let id = world.add(ball().moving(1.0, 0.0, 0.0).spinning(0.0, 2.0, 0.0).at(0.0, 0.5, 0.0).friction(0.0));
    run(&mut world, 0.5);
    let rotation = DQuat::from_rotation_z(1.0);
    world.body_mut(id).unwrap().teleport(DVec3::new(-5.0, 3.0, 2.0), rotation * 2.0).unwrap();
    assert_eq!(world[id].position(), DVec3::new(-5.0, 3.0, 2.0));
    assert!(world[id].rotation().as_dquat().dot(rotation).abs() > 1.0 - 1e-6);
    assert_close(velocity(&world, id), DVec3::X);
    assert_close(spin(&world, id), DVec3::Y * 2.0);
    // It falls 2.5 m and lands.
    run(&mut world, 0.5);
    assert_close(world[id].position(), DVec3::new(-4.5, 3.0 - 0.5 * 9.81 * 0.25, 2.0));
    run(&mut world, 1.5);
    assert!((world[id].position().y - 0.5).abs() < 1e-4, "{}", world[id].position());
}

#[test]
fn a_fixed_body_can_be_teleported_and_nothing_else() {
    let mut world = World::new();
    let ground = world.add(slab());
    let id = world.add(ball().at(0.0, 0.5, 0.0));
    run(&mut world, 0.5);
    let mut commands = world.body_mut(ground).unwrap();
    commands.apply_impulse(DVec3::Y * 100.0).unwrap();
    commands.apply_angular_impulse(DVec3::Y * 100.0).unwrap();
    commands.add_force_at(DVec3::Y * 100.0, DVec3::X).unwrap();
    commands.add_torque(DVec3::Y * 100.0).unwrap();
    commands.set_linear_velocity(DVec3::X).unwrap();
    commands.set_angular_velocity(DVec3::X).unwrap();
    commands.put_to_sleep();
    commands.wake();
    run(&mut world, 0.5);
    assert_eq!((world[ground].position(), world[ground].linear_velocity()), (DVec3::ZERO, Vec3::ZERO));
    assert!((world[id].position() - DVec3::Y * 0.5).length() < 1e-4, "{}", world[id].position());
    world.body_mut(ground).unwrap().teleport(DVec3::new(0.0, -2.0, 0.0), DQuat::IDENTITY).unwrap();
    run(&mut world, 2.0);
    assert!((world[id].position() - DVec3::Y * -1.5).length() < 1e-4, "{}", world[id].position());
}

#[test]
fn sleep_ends_by_command_and_by_being_struck() {
    let mut world = World::new();
    world.add(slab());
    let sleeper = world.add(ball().at(0.0, 5.0, 0.0).moving(1.0, 1.0, 1.0));
    let other = world.add(ball().at(4.0, 5.0, 0.0));
    for id in [sleeper, other] {
        world.body_mut(id).unwrap().put_to_sleep();
    }
    run(&mut world, 1.0);
    assert!(world[sleeper].is_asleep());
    assert_eq!(world[sleeper].position(), DVec3::Y * 5.0);
    assert_eq!(world[sleeper].linear_velocity(), Vec3::ZERO);
    world.body_mut(other).unwrap().wake();
    assert!(!world[other].is_asleep());
    run(&mut world, 0.5);
    assert!((world[other].position().y - (5.0 - 0.5 * 9.81 * 0.25)).abs() < 1e-9);

    // Every command wakes.
    let commands: [Command; 6] = [
        |it| it.add_force(DVec3::X),
        |it| it.add_torque(DVec3::X),
        |it| it.apply_impulse(DVec3::X),
        |it| it.apply_angular_impulse(DVec3::X),
        |it| it.set_linear_velocity(DVec3::X),
        |it| it.teleport(DVec3::Y * 5.0, DQuat::IDENTITY),
    ];
    for command in commands {
        world.body_mut(other).unwrap().put_to_sleep();
        assert!(world[other].is_asleep());
        command(&mut world.body_mut(other).unwrap()).unwrap();
        assert!(!world[other].is_asleep());
    }
    world.remove(other);

    // A bullet: the first to touch it since.
    world.add(Body::dynamic().mass(1.0).at(-3.0, 5.0, 0.0).moving(30.0, 0.0, 0.0).with(Shape::sphere(0.2)));
    run(&mut world, 0.05);
    assert!(world[sleeper].is_asleep());
    run(&mut world, 0.1);
    assert!(!world[sleeper].is_asleep());
    assert!(world[sleeper].linear_velocity().x > 1.0 && world[sleeper].linear_velocity().y < 0.0);
    run(&mut world, 3.0);
    assert!(world[sleeper].position().y < 1.0, "{:?}", world[sleeper]);
}

#[test]
fn what_rests_on_a_removed_body_falls() {
    let mut world = World::new();
    world.add(slab());
    let low = world.add(Body::dynamic().at(0.0, 0.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)));
    let high = world.add(Body::dynamic().at(0.0, 1.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)));
    run(&mut world, 1.0);
    assert!((world[high].position().y - 1.5).abs() < 1e-4);
    assert!(world.remove(low));
    assert!(!world.remove(low));
    run(&mut world, 0.25);
    let fallen = 1.5 - 0.5 * 9.81 * 0.0625;
    assert!((world[high].position().y - fallen).abs() < 1e-4, "{} {fallen}", world[high].position().y);
    run(&mut world, 1.0);
    assert!((world[high].position().y - 0.5).abs() < 1e-4, "{}", world[high].position().y);
}

#[test]
fn what_rests_on_a_removed_floor_falls() {
    for floor in
        [slab(), Body::fixed().with(Shape::plane()), Body::kinematic().with(Shape::cuboid(9.0, 0.0001, 9.0))]
    {
        let mut world = World::new();
        let ground = world.add(floor);
        let id = world.add(Body::dynamic().at(0.0, 0.51, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)));
        run(&mut world, 1.0);
        assert!(world.remove(ground));
        run(&mut world, 1.0);
        let y = world[id].position().y;
        assert!((y - (0.5 - 0.5 * 9.81)).abs() < 1e-3, "{y}");
    }
}

#[test]
fn kinematic_bodies_keep_their_velocity_and_push_others() {
    let mut world = World::new();
    world.add(slab().friction(0.0));
    let ram = Body::kinematic().at(-3.0, 0.5, 0.0).moving(2.0, 0.0, 0.0).with(Shape::cuboid(1.0, 0.8, 4.0));
    let ram = world.add(ram.friction(0.0));
    let pushed = world.add(ball().at(0.0, 0.5, 0.0).friction(0.0));
    for step in 1..=180 {
        world.step(STEP);
        assert_eq!(world[ram].linear_velocity(), Vec3::X * 2.0);
        let expected = -3.0 + 2.0 * STEP * f64::from(step);
        assert!((world[ram].position().x - expected).abs() < 1e-9, "{}", world[ram].position());
        assert!(world[pushed].position().x - world[ram].position().x > 1.0 - 1e-3);
    }
    assert!((world[pushed].linear_velocity() - Vec3::X * 2.0).length() < 1e-3, "{:?}", world[pushed]);
    assert!((world[pushed].position().x - 4.0).abs() < 1e-3, "{}", world[pushed].position());

    // With C_r = 1 a ball leaves a moving racket twice as fast as the racket, and the racket does not notice.
    let mut world = floating();
    let racket = Body::kinematic().moving(5.0, 0.0, 0.0).spinning(1.0, 0.0, 0.0);
    let racket = world.add(racket.with(Shape::cuboid(0.1, 2.0, 2.0)).restitution(1.0).friction(0.0));
    let id = world.add(ball().at(1.0, 0.0, 0.0).restitution(1.0).friction(0.0));
    world.body_mut(racket).unwrap().apply_impulse(DVec3::Y * 1e3).unwrap();
    world.body_mut(racket).unwrap().add_force(DVec3::Y * 1e3).unwrap();
    run(&mut world, 0.5);
    assert_close(velocity(&world, id), DVec3::X * 10.0);
    assert_close(velocity(&world, racket), DVec3::X * 5.0);
    assert_close(spin(&world, racket), DVec3::X);
    world.body_mut(racket).unwrap().set_linear_velocity(DVec3::Z).unwrap();
    world.body_mut(racket).unwrap().set_angular_velocity(DVec3::Z).unwrap();
    run(&mut world, 0.5);
    assert_close(velocity(&world, racket), DVec3::Z);
    assert_close(spin(&world, racket), DVec3::Z);
    assert_close(world[racket].position(), DVec3::new(2.5, 0.0, 0.5));
}

#[test]
fn user_data_and_descriptions_stay_with_their_body() {
    let mut world = World::new();
    let mut body = ball().named("one");
    body.user_data = 42;
    let one = world.add(body);
    let two = world.add(ball().named("two"));
    world.body_mut(two).unwrap().set_user_data(u64::MAX);
    run(&mut world, 0.1);
    world.remove(one);
    assert_eq!(world.description(two).unwrap().user_data, u64::MAX);
    assert_eq!(world.description(two).unwrap().name, "two");
    assert!(world.description(one).is_none());
    assert_eq!(world.mass_of(two).unwrap().mass, 3.0);
}

#[test]
fn an_invalid_body_goes_into_quarantine_and_the_others_go_on() {
    let mut world = World::new();
    let well = world.add(ball().at(0.0, 10.0, 0.0));
    let mut ill = ball();
    ill.position.x = f64::NAN;
    let ill = world.add(ill);
    let negative = world.add(Body::dynamic().with(Shape::sphere(-1.0)));
    let flat = world.add(Body::dynamic().with(Shape::plane()));
    assert_eq!(world.step(STEP).quarantined(), [ill, negative, flat]);
    assert!(world.step(STEP).quarantined().is_empty());
    run(&mut world, 1.0 - 2.0 * STEP);
    assert!((world[well].position().y - (10.0 - 0.5 * 9.81)).abs() < 1e-9);
    for id in [ill, negative, flat] {
        let mut commands = world.body_mut(id).unwrap();
        assert!(!commands.is_active());
        commands.add_force(DVec3::X).unwrap();
        commands.apply_impulse(DVec3::X).unwrap();
        commands.apply_angular_impulse(DVec3::X).unwrap();
        commands.set_linear_velocity(DVec3::X).unwrap();
        commands.teleport(DVec3::X, DQuat::IDENTITY).unwrap();
        commands.put_to_sleep();
        commands.wake();
        world.step(STEP);
    }
    assert!(world.body_mut(well).unwrap().is_active());
    assert!(world.energy().kinetic.is_finite() && world.momentum().linear.is_finite());
    assert!(world.remove(ill));
    world.step(STEP);
}

#[test]
fn commands_that_overflow_quarantine_their_body_only() {
    let mut world = World::new();
    world.add(slab());
    let well = world.add(ball().at(3.0, 0.5, 0.0));
    let ill = world.add(ball().at(0.0, 0.5, 0.0));
    run(&mut world, 0.5);
    for _ in 0..4 {
        world.body_mut(ill).unwrap().apply_impulse(DVec3::X * f64::MAX).unwrap();
    }
    let mut named = Vec::new();
    for _ in 0..60 {
        named.extend_from_slice(world.step(STEP).quarantined());
    }
    assert_eq!(named, [ill]);
    assert!((world[well].position() - DVec3::new(3.0, 0.5, 0.0)).length() < 1e-3, "{:?}", world[well]);
}

#[test]
fn try_add_names_the_field() {
    let mut world = World::new();
    let with = |change: fn(&mut Body)| {
        let mut body = ball();
        change(&mut body);
        body
    };
    let cases: [(&str, Body); 16] = [
        ("position[1]", with(|it| it.position.y = f64::INFINITY)),
        ("position[2]", with(|it| it.position.z = 1e10)),
        ("rotation", with(|it| it.rotation = Quat::from_xyzw(0.0, 0.0, 0.0, 2.0))),
        ("rotation", with(|it| it.rotation.x = f32::NAN)),
        ("linear_velocity[0]", with(|it| it.linear_velocity.x = f32::NAN)),
        ("angular_velocity[2]", with(|it| it.angular_velocity.z = 1e7)),
        ("linear_damping", with(|it| it.linear_damping = -1.0)),
        ("angular_damping", with(|it| it.angular_damping = f64::NAN)),
        ("gravity_factor", with(|it| it.gravity_factor = f64::INFINITY)),
        ("colliders[0].shape.radius", with(|it| it.colliders[0].shape = Shape::sphere(0.0))),
        ("colliders[0].density", with(|it| it.colliders[0].density = -1.0)),
        ("colliders[0].position[0]", with(|it| it.colliders[0].pose.position.x = f64::NAN)),
        ("colliders[0].material.restitution", with(|it| it.colliders[0].material.restitution = 1.5)),
        ("colliders[0].material.static_friction", with(|it| it.colliders[0].material.static_friction = -0.1)),
        ("colliders[0].shape", with(|it| it.colliders[0].shape = Shape::plane())),
        ("mass", with(|it| it.mass = Some(-3.0))),
    ];
    for (field, body) in cases {
        let error = world.try_add(body).unwrap_err();
        assert_eq!(error.field, field, "{error}");
        assert!(error.to_string().contains("expected"), "{error}");
    }
    assert_eq!(world.bodies().count(), 0);
    assert!(world.step(STEP).quarantined().is_empty());
    assert!(world.try_add(ball()).is_ok());
}

#[test]
fn a_step_of_no_time_does_nothing() {
    let mut world = World::new();
    world.add(slab());
    let id = world.add(ball().at(0.0, 3.0, 0.0).moving(1.0, 0.0, 0.0));
    run(&mut world, 0.2);
    let (hash, time, state) = (world.state_hash(), world.time(), world[id]);
    for dt in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let report = world.step(dt);
        assert!(report.impacts().is_empty() && report.quarantined().is_empty());
        assert_eq!((world.state_hash(), world.time(), world[id]), (hash, time, state));
    }
    world.step(f64::MIN_POSITIVE);
    assert_eq!(world[id].position(), state.position());
    run(&mut world, 2.0);
    assert!((world[id].position().y - 0.5).abs() < 1e-3);
}

#[test]
fn an_id_of_a_removed_body_names_nobody() {
    let mut world = World::new();
    let old = world.add(ball());
    assert!(world.remove(old));
    let new = world.add(ball().at(5.0, 0.0, 0.0));
    assert_ne!(old, new);
    assert!(world.body(old).is_none() && world.body_mut(old).is_none());
    assert!(world.description(old).is_none() && world.mass_of(old).is_none());
    assert!(!world.remove(old));
    assert!(world.body(new).is_some());
    // Neither does one of another world.
    assert!(World::new().body(new).is_none());
    assert!(!World::new().remove(new));
}

#[test]
fn commands_that_are_not_finite_are_refused_and_change_nothing() {
    let mut world = World::new();
    let id = world.add(ball().at(0.0, 3.0, 0.0).moving(1.0, 0.0, 0.0));
    world.body_mut(id).unwrap().put_to_sleep();
    let (hash, state) = (world.state_hash(), world[id]);
    for bad in [DVec3::new(f64::NAN, 0.0, 0.0), DVec3::new(0.0, f64::INFINITY, 0.0)] {
        let mut it = world.body_mut(id).unwrap();
        let fields = [
            it.add_force(bad),
            it.add_force_at(bad, DVec3::ZERO),
            it.add_force_at(DVec3::X, bad),
            it.add_torque(bad),
            it.apply_impulse_at(bad, DVec3::ZERO),
            it.apply_impulse_at(DVec3::X, bad),
            it.apply_impulse(bad),
            it.apply_angular_impulse(bad),
            it.set_linear_velocity(bad),
            it.set_angular_velocity(bad),
            it.teleport(bad, DQuat::IDENTITY),
            it.teleport(DVec3::X, DQuat::from_xyzw(bad.x, bad.y, bad.z, 1.0)),
            it.teleport(DVec3::X, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        ]
        .map(|verdict| verdict.unwrap_err().field);
        let expected = [
            "force",
            "force",
            "point",
            "torque",
            "impulse",
            "point",
            "impulse",
            "impulse",
            "linear_velocity",
            "angular_velocity",
            "position",
            "rotation",
            "rotation",
        ];
        assert_eq!(fields, expected);
        assert_eq!((world.state_hash(), world[id]), (hash, state));
    }
    assert!(world[id].is_asleep(), "what is refused wakes nobody");
}
