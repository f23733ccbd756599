//! Closed forms against the search, for every kind of pair that has one.

use super::{Outlook, outlook};
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::DVec3;
use crate::solver::tests::Random;
use crate::step::motion::begin_flight;
use crate::{Body, Shape, World};

const STEP: f64 = 0.25;

const LAW: RestLaw = RestLaw { gravity: DVec3::ZERO, substep: 0.25 * STEP, step: STEP };

/// Two bodies at the start of a step without gravity.
fn world_of(bodies: [Body; 2]) -> World {
    let mut world = World::new();
    for body in bodies {
        world.add(body);
    }
    begin_flight(&mut world.bodies, DVec3::ZERO, STEP);
    world.broad_phase.find_pairs(&world.bodies, STEP);
    world.pairs.update(&world.bodies, &mut world.broad_phase);
    world
}

fn approach(world: &World) -> Approach<'_> {
    Approach::of(&world.bodies, (0, 1), LAW).expect("two colliders")
}

fn outlook_of(world: &World) -> Option<Outlook> {
    outlook(&world.bodies, (0, 1), (0.0, STEP), approach(world).tolerance())
}

/// A ball that flies, and what it may meet.
fn anything(random: &mut Random) -> [Body; 2] {
    let ball = |random: &mut Random| {
        let place = random.vector(1.5);
        let velocity = (random.vector(8.0) - 4.0 * place).as_vec3();
        let body = Body::dynamic().with(Shape::sphere([0.05, 0.3, 0.6][random.below(3)]));
        body.at(place.x, place.y, place.z).moving(velocity.x, velocity.y, velocity.z)
    };
    let size = random.vector(1.5).abs() + DVec3::splat(0.05);
    let place = random.vector(0.7);
    let cuboid = |body: Body, random: &mut Random| {
        let body = body.at(place.x, place.y, place.z).with(Shape::cuboid(size.x, size.y, size.z));
        body.rotated(random.rotation().as_quat().normalize())
    };
    let other = match random.below(4) {
        0 | 1 => ball(random),
        2 => cuboid(Body::fixed(), random),
        _ => {
            let speed = random.vector(5.0).as_vec3();
            cuboid(Body::dynamic(), random).moving(speed.x, speed.y, speed.z)
        }
    };
    let pair = [ball(random), other];
    if random.below(2) == 0 { pair } else { [pair[1].clone(), pair[0].clone()] }
}

#[test]
fn closed_forms_and_the_search_find_the_same_touches() {
    let mut random = Random(77);
    let (mut touches, mut passes, mut unclear) = (0, 0, 0);
    for _ in 0..4000 {
        let world = world_of(anything(&mut random));
        let approach = approach(&world);
        let found = approach.next_touch(&world.pairs, approach.gap(0.0), (0.0, STEP), None);
        let Some(outlook) = outlook_of(&world) else {
            unclear += 1;
            continue;
        };
        assert!(outlook.separation <= approach.separation(0.0) + 1e-12, "{outlook:?}");
        match (outlook.touch, found) {
            (Some(time), Some(found)) => {
                touches += 1;
                assert!((time - found).abs() < 1e-9, "{time} s against {found} s");
                assert!(approach.separation(time).abs() <= approach.tolerance(), "{outlook:?}");
            }
            (None, None) => {
                passes += 1;
                let times = (0..=50).map(|k| STEP * f64::from(k) / 50.0);
                let least = times.map(|time| approach.separation(time)).fold(f64::INFINITY, f64::min);
                assert!(outlook.least <= least + 1e-12, "{outlook:?}: {least} m");
                assert!(outlook.end <= approach.separation(STEP) + 1e-12, "{outlook:?}");
            }
            _ => panic!("{outlook:?} against {found:?}"),
        }
    }
    assert!(touches > 300 && passes > 1000 && unclear < 1500, "{touches} {passes} {unclear}");
}

#[test]
fn what_does_not_fly_straight_is_left_to_the_search() {
    let ball = || Body::dynamic().with(Shape::sphere(0.5)).at(0.0, 2.0, 0.0).moving(0.0, -9.0, 0.0);
    let floor = || Body::dynamic().with(Shape::cuboid(4.0, 1.0, 4.0));
    assert!(outlook_of(&world_of([ball(), floor()])).is_some());
    assert_eq!(outlook_of(&world_of([Body { linear_damping: 0.1, ..ball() }, floor()])), None);
    assert_eq!(outlook_of(&world_of([ball(), floor().spinning(0.0, 0.0, 1.0)])), None);
    assert_eq!(outlook_of(&world_of([ball(), Body::dynamic().with(Shape::capsule(1.0, 0.5))])), None);
    let mut pulled = world_of([ball(), floor()]);
    pulled.bodies.influences[1].acceleration = DVec3::X;
    assert_eq!(outlook_of(&pulled), None);
}

#[test]
fn what_overlaps_and_parts_does_not_touch() {
    let ball =
        |x: f64, speed: f32| Body::dynamic().with(Shape::sphere(0.5)).at(x, 0.0, 0.0).moving(speed, 0.0, 0.0);
    let outlook = |speed: f32| outlook_of(&world_of([ball(0.0, 0.0), ball(0.9, speed)]));
    let parting = outlook(2.0).expect("they part");
    assert_eq!(parting.touch, None);
    assert!((parting.separation + 0.1).abs() < 1e-12 && (parting.end - 0.4).abs() < 1e-12, "{parting:?}");
    assert_eq!(outlook(-2.0), None);
}
