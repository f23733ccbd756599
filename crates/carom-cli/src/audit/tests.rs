//! What the audit finds, and what not.

use super::motion::Knot;
use super::rest::is_divided;
use super::*;
use carom::impulse::Velocity;
use carom::math::{DQuat, DVec3, Pose, Quat};
use carom::{Body, Settings, Shape};

/// A spinning ball that hits a resting one (or an immovable box) off its centre, as a world and the record of it.
fn hit(friction: f64, immovable: bool) -> (World, Impact) {
    let mut world = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
    let target = if immovable {
        Body::fixed().with(Shape::cuboid(1.0, 4.0, 4.0))
    } else {
        Body::dynamic().with(Shape::sphere(0.5))
    };
    world.add(target.friction(friction).restitution(0.5));
    let ball = Body::dynamic().at(-1.5, 0.3, 0.1).with(Shape::sphere(0.5)).moving(3.0, 0.1, 0.0);
    world.add(ball.spinning(1.0, 2.0, 3.0).friction(friction).restitution(0.5));
    for _ in 0..600 {
        let impacts = world.step(1.0 / 60.0).impacts().to_vec();
        if let [impact] = impacts.as_slice() {
            return (world, impact.clone());
        }
    }
    panic!("they missed each other");
}

fn broken(world: &World, impact: &Impact) -> Vec<Law> {
    broken_by(world, std::slice::from_ref(impact))
}

/// Laws that these collisions of one step break.
fn broken_by(world: &World, impacts: &[Impact]) -> Vec<Law> {
    let mut audit = Audit::default();
    let strikes = strikes(world, impacts, &mut audit);
    let threshold = |strike: &Strike| threshold(world, strike, 1.0 / 240.0, &BTreeMap::new());
    collisions(impacts, &strikes, threshold, &mut audit.findings);
    round::parting(&strikes, threshold, &mut audit.findings);
    assert_eq!(audit.without_normal, 0);
    laws_of(&audit)
}

fn laws_of(audit: &Audit) -> Vec<Law> {
    let mut laws: Vec<Law> =
        audit.findings.iter().filter(|finding| finding.is_violation()).map(|finding| finding.law).collect();
    laws.sort_unstable();
    laws.dedup();
    laws
}

#[test]
fn what_the_engine_does_keeps_every_law() {
    for (friction, immovable) in [(0.0, false), (0.0, true), (0.3, false), (0.3, true)] {
        let (world, impact) = hit(friction, immovable);
        assert_eq!(broken(&world, &impact), []);
    }
}

#[test]
fn a_wrong_separating_speed_is_found() {
    let (world, mut impact) = hit(0.0, true);
    impact.after_b.linear *= 1.0 + 1e-4;
    assert!(broken(&world, &impact).contains(&Law::SeparatingSpeed));
}

#[test]
fn momentum_out_of_nothing_is_found() {
    let (world, mut impact) = hit(0.3, false);
    // Across the normal, so that the separating speed stays right.
    impact.after_b.linear += impact.contact.normal.any_orthogonal_vector().normalize() * 1e-3;
    let broken = broken(&world, &impact);
    assert!(broken.contains(&Law::LinearMomentum) && broken.contains(&Law::OwnMomentum), "{broken:?}");
    assert!(!broken.contains(&Law::SeparatingSpeed));
}

#[test]
fn spin_out_of_nothing_is_found_also_beside_what_can_not_move() {
    for immovable in [false, true] {
        let (world, mut impact) = hit(0.3, immovable);
        impact.after_b.angular += impact.contact.normal * 1e-3;
        assert!(broken(&world, &impact).contains(&Law::OwnMomentum));
    }
}

#[test]
fn friction_where_there_is_none_is_found() {
    let (world, mut impact) = hit(0.0, true);
    let push = impact.contact.normal.any_orthogonal_vector().normalize() * 1e-3;
    // With an impulse in the record that explains it.
    impact.friction_impulse += push * 1e3;
    impact.after_b.linear += push * 1e3 / impact.side_b.mass;
    impact.after_b.angular += impact.side_b.inverse_inertia * impact.side_b.arm.cross(push * 1e3);
    assert_eq!(broken(&world, &impact), [Law::Push, Law::Energy]);
}

#[test]
fn energy_out_of_nothing_is_found() {
    let (world, mut impact) = hit(0.3, false);
    impact.after_b.angular *= 3.0;
    assert!(broken(&world, &impact).contains(&Law::Energy));
}

#[test]
fn a_wrong_normal_and_no_number_are_found() {
    let (world, mut impact) = hit(0.0, false);
    impact.contact.normal = (impact.contact.normal + DVec3::Y * 0.01).normalize();
    let found = broken(&world, &impact);
    assert!(found.contains(&Law::Normal) && found.contains(&Law::Push), "{found:?}");
    impact.after_a.linear.x = f64::NAN;
    assert!(broken(&world, &impact).contains(&Law::LinearMomentum));
}

/// A cube that lands flat on a floor, and the record of it: four contacts at once.
fn landing(friction: f64, restitution: f64) -> (World, Vec<Impact>) {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::cuboid(10.0, 2.0, 10.0)).friction(friction));
    let cube = Body::dynamic().at(0.0, 1.7, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).moving(0.5, -1.0, 0.2);
    world.add(cube.friction(friction).restitution(restitution));
    for _ in 0..60 {
        let impacts = world.step(1.0 / 60.0).impacts().to_vec();
        if !impacts.is_empty() {
            return (world, impacts);
        }
    }
    panic!("it did not land");
}

#[test]
fn what_is_struck_at_once_keeps_the_laws_together() {
    for (friction, restitution) in [(0.0, 1.0), (0.0, 0.4), (0.5, 0.4), (0.0, 0.0)] {
        let (world, impacts) = landing(friction, restitution);
        assert_eq!(impacts.len(), 4);
        assert_eq!(broken_by(&world, &impacts), []);
    }
}

#[test]
fn a_bounce_of_several_that_is_off_is_found_though_each_alone_might_be_right() {
    let (world, mut impacts) = landing(0.0, 0.4);
    for impact in &mut impacts {
        // As with a C_r of 0.5, momentum and all.
        let faster = 1.5 / 1.4;
        impact.fraction *= faster;
        let change = impact.after_b.linear - impact.side_b.velocity.linear;
        impact.after_b.linear = impact.side_b.velocity.linear + faster * change;
    }
    assert_eq!(broken_by(&world, &impacts), [Law::Energy]);
}

#[test]
fn a_corner_that_gets_nothing_and_one_that_pulls_are_found() {
    let (world, mut impacts) = landing(0.0, 0.4);
    impacts[2].fraction = 0.0;
    assert!(broken_by(&world, &impacts).contains(&Law::OwnMomentum));
    let (world, mut impacts) = landing(0.0, 0.4);
    let shift = 2.0 * impacts[0].fraction;
    // The same impulse and torque on the whole: corners of a square, in turn.
    let sign = |impact: &Impact| (impact.side_b.arm.x * impact.side_b.arm.z).signum();
    impacts.iter_mut().for_each(|impact| impact.fraction += shift * sign(impact));
    let broken = broken_by(&world, &impacts);
    assert!(broken.contains(&Law::Push) && !broken.contains(&Law::OwnMomentum), "{broken:?}");
}

#[test]
fn balls_that_meet_a_third_from_both_sides_are_judged_together() {
    let mut world = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
    for (x, speed) in [(-2.0, 1.0), (0.0, 0.0), (2.0, -1.0)] {
        let ball = Body::dynamic().at(x, 0.0, 0.0).with(Shape::sphere(0.5)).moving(speed, 0.0, 0.0);
        world.add(ball.friction(0.0).restitution(1.0));
    }
    let mut impacts = Vec::new();
    while impacts.is_empty() {
        impacts = world.step(1.0 / 60.0).impacts().to_vec();
    }
    assert_eq!(impacts.iter().map(|impact| (impact.round, impact.together)).collect::<Vec<_>>(), [(0, 2); 2]);
    assert_eq!(broken_by(&world, &impacts), []);
    // As if the second contact came after the first: momentum and energy are right, but the middle one has two stories.
    let mut sequence = impacts.clone();
    sequence[1].side_a.velocity.linear.x = 1.0;
    assert!(broken_by(&world, &sequence).contains(&Law::OwnMomentum));
    // As if only the first had happened: then the other goes on closing.
    assert!(broken_by(&world, &impacts[..1]).contains(&Law::OwnMomentum));
}

/// A world that is looked at step by step.
fn followed(world: &mut World, steps: usize, mut meddle: impl FnMut(&mut World, usize)) -> Vec<Law> {
    let mut auditor = Auditor::new(world);
    let mut laws = Vec::new();
    for number in 0..steps {
        let impacts = world.step(1.0 / 60.0).impacts().to_vec();
        meddle(world, number);
        laws.extend(laws_of(&auditor.step(world, &impacts)));
    }
    laws.sort_unstable();
    laws.dedup();
    laws
}

fn falling() -> (World, BodyId) {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::cuboid(10.0, 0.2, 10.0)));
    let rod = Body::dynamic().at(0.0, 3.0, 0.0).with(Shape::capsule(0.6, 0.1)).spinning(1.0, 2.0, 3.0);
    let rod = world.add(rod.restitution(0.5));
    (world, rod)
}

#[test]
fn a_body_that_nobody_meddles_with_keeps_every_law_to_its_rest() {
    let (mut world, _) = falling();
    assert_eq!(followed(&mut world, 400, |_, _| ()), []);
}

#[test]
fn what_changes_in_flight_without_a_cause_is_found() {
    let meddled = |meddle: fn(&mut World, BodyId)| {
        let (mut world, rod) = falling();
        followed(&mut world, 10, |world, number| {
            if number == 5 {
                meddle(world, rod);
            }
        })
    };
    let speed = meddled(|world, rod| {
        let velocity = 1.001 * world[rod].linear_velocity().as_dvec3();
        world.body_mut(rod).expect("it is there").set_linear_velocity(velocity).expect("good values");
    });
    assert_eq!(speed, [Law::Flight]);
    let place = meddled(|world, rod| {
        let (position, rotation) =
            (world[rod].position() + DVec3::X * 1e-4, world[rod].rotation().as_dquat());
        world.body_mut(rod).expect("it is there").teleport(position, rotation).expect("good values");
    });
    assert_eq!(place, [Law::Path]);
    let spin = meddled(|world, rod| {
        let spin = 0.999 * world[rod].angular_velocity().as_dvec3();
        world.body_mut(rod).expect("it is there").set_angular_velocity(spin).expect("good values");
    });
    assert_eq!(spin, [Law::Spin, Law::Turning]);
}

#[test]
fn a_collision_that_is_kept_secret_is_found() {
    let (mut world, _) = falling();
    let mut auditor = Auditor::new(&world);
    loop {
        let has_hit = !world.step(1.0 / 60.0).impacts().is_empty();
        let broken = laws_of(&auditor.step(&world, &[]));
        assert_eq!(has_hit, !broken.is_empty(), "{broken:?}");
        if has_hit {
            break;
        }
    }
}

#[test]
fn what_passes_through_a_wall_is_found() {
    let mut world = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
    world.add(Body::fixed().with(Shape::cuboid(0.1, 4.0, 4.0)));
    let ball = world.add(Body::dynamic().at(-0.5, 0.0, 0.0).with(Shape::sphere(0.1)).moving(60.0, 0.0, 0.0));
    let mut auditor = Auditor::new(&world);
    world.step(1.0 / 60.0);
    // Where it would be had it flown on.
    let mut ball = world.body_mut(ball).expect("it is there");
    ball.teleport(DVec3::new(0.5, 0.0, 0.0), DQuat::IDENTITY).expect("good values");
    ball.set_linear_velocity(DVec3::new(60.0, 0.0, 0.0)).expect("good values");
    assert_eq!(laws_of(&auditor.step(&world, &[])), [Law::Record]);
}

#[test]
fn what_rests_is_pushed_and_not_pulled_and_within_the_cone() {
    let resting = |velocity: [f64; 3]| {
        let mut world = World::new();
        world.add(Body::fixed().with(Shape::plane()).friction(0.3));
        let cube =
            world.add(Body::dynamic().at(0.0, 0.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).friction(0.3));
        followed(&mut world, 30, |world, number| {
            if number == 20 {
                let mut cube = world.body_mut(cube).expect("it is there");
                cube.set_linear_velocity(DVec3::from_array(velocity)).expect("good values");
            }
        })
    };
    assert_eq!(resting([0.0; 3]), []);
    assert!(resting([0.0, -0.3, 0.0]).contains(&Law::GroupMomentum));
    assert!(resting([0.1, 0.0, 0.0]).contains(&Law::Support));
}

/// A cone that was struck at the very start of a step, when contacts had given it gravity for the substep, was said to have been held up
/// by nothing.
#[test]
fn a_collision_at_the_start_of_a_step_divides_a_substep() {
    let knot = |time: f64, [before, after]: [f64; 2]| {
        let moving = |speed: f64| Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO };
        Knot { time, pose: Pose::IDENTITY, before: moving(before), after: moving(after) }
    };
    let (start, end) = (knot(1.0, [2.0, 2.0]), knot(1.5, [2.0, 2.0]));
    assert!(!is_divided((1.0, 1.5), &start, &end));
    assert!(is_divided((1.0, 1.5), &knot(1.0, [2.0, -1.0]), &end));
    assert!(is_divided((0.5, 1.5), &start, &end) && is_divided((1.0, 2.0), &start, &end));
}

/// The audit took the shortest turn from one step's end to the next at an even rate, and had this capsule 5 mm off its path: in a wall
/// that it had not yet touched.
#[test]
fn a_body_that_tumbles_fast_is_followed_through_a_step() {
    let world = || {
        let mut world = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
        let capsule = Body::dynamic().with(Shape::capsule(0.271, 0.1084)).spinning(23.5, -47.0, 25.8);
        let capsule = world.add(capsule.rotated(Quat::from_xyzw(0.2, 0.4, 0.4, 0.8)));
        (world, capsule)
    };
    let (mut whole, capsule) = world();
    let start = snapshot(&whole);
    whole.step(0.02);
    let course = &courses(&whole, (&start, &snapshot(&whole)), &[])[&capsule];
    for time in [0.004, 0.01, 0.0132, 0.018] {
        let (mut part, capsule) = world();
        part.step(time);
        let tip = |rotation: DQuat| rotation * DVec3::new(0.0, 0.2439, 0.0);
        let there = tip(part[capsule].rotation().as_dquat());
        let off = tip(course.pose_at(time).rotation).distance(there);
        assert!(off < 1e-4, "{off} m off after {time} s");
    }
}
