//! The search against a dense row of looks.

use super::BITE;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::DVec3;
use crate::solver::tests::Random;
use crate::step::motion::begin_flight;
use crate::{Body, Shape, World};

const STEP: f64 = 0.1;
const LOOKS: u32 = 2000;

fn shape(random: &mut Random) -> Shape {
    let size = |random: &mut Random| random.range(0.1, 1.0);
    match random.below(4) {
        0 => Shape::cuboid(size(random), size(random), size(random)),
        1 => Shape::capsule(size(random), 0.5 * size(random)),
        2 => {
            let corners: Vec<DVec3> = (0..8).map(|_| random.vector(0.7)).collect();
            Shape::hull(&corners).unwrap_or(Shape::sphere(0.4))
        }
        _ => Shape::sphere(0.5 * size(random)),
    }
}

/// A body that comes towards the origin or passes it, turns, and may be slowed by what is around it.
fn flying(random: &mut Random) -> Body {
    let place = random.vector(1.2);
    let velocity = (random.vector(8.0) - 6.0 * place).as_vec3();
    let spin = random.vector(15.0).as_vec3();
    let body = Body::dynamic().with(shape(random)).at(place.x, place.y, place.z);
    let body = body.moving(velocity.x, velocity.y, velocity.z).spinning(spin.x, spin.y, spin.z);
    let damping = if random.below(2) == 0 { 0.0 } else { random.range(0.0, 10.0) };
    Body { linear_damping: damping, ..body.rotated(random.rotation().as_quat().normalize()) }
}

#[test]
fn nothing_comes_into_anything_before_the_touch_that_is_found() {
    let mut random = Random(78);
    let (mut touches, mut passes) = (0, 0);
    for number in 0..600 {
        let gravity = random.vector(40.0);
        let law = RestLaw { gravity, substep: 0.5 * STEP, step: STEP };
        let mut world = World::new();
        for _ in 0..2 {
            world.add(flying(&mut random));
        }
        begin_flight(&mut world.bodies, gravity, STEP);
        world.broad_phase.find_pairs(&world.bodies, STEP);
        world.pairs.update(&world.bodies, &mut world.broad_phase);
        // Else both would fall alike.
        world.bodies.influences[1].acceleration += random.vector(400.0);
        let approach = Approach::of(&world.bodies, (0, 1), law).expect("two colliders");
        if approach.separation(0.0) <= 0.0 {
            continue;
        }
        let found = approach.next_touch(&world.pairs, approach.gap(0.0), (0.0, STEP), None);
        let until = found.unwrap_or(STEP);
        let deepest = (0..=LOOKS)
            .map(|look| until * f64::from(look) / f64::from(LOOKS))
            .map(|time| approach.separation(time))
            .fold(f64::INFINITY, f64::min);
        // A graze may be passed over: by how much is what a step of the march goes on at least.
        assert!(deepest > -BITE * approach.thinner(), "{number}: {deepest} m until {until} s");
        match found {
            Some(time) => {
                touches += 1;
                assert!(approach.separation(time).abs() <= approach.tolerance(), "{number}: at {time} s");
            }
            None => passes += 1,
        }
    }
    assert!(touches > 100 && passes > 100, "{touches} {passes}");
}
