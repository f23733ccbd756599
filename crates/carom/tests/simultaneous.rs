//! Contacts that are struck at one instant, in a world: in rows, flat, on a table, where something rests or sleeps.

use carom::Settings;
use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;

fn weightless() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() })
}

fn smooth(body: Body) -> Body {
    body.friction(0.0).restitution(1.0)
}

fn marble(x: f64) -> Body {
    smooth(Body::dynamic().at(x, 0.5, 0.0).with(Shape::sphere(0.5)))
}

/// Adds a row of balls that touch, and one that comes from the left with 2 m/s; the row in order, the comer first.
fn add_row(world: &mut World, count: usize) -> Vec<BodyId> {
    let comer = world.add(marble(-2.0).moving(2.0, 0.0, 0.0));
    std::iter::once(comer).chain((0..count).map(|index| world.add(marble(index as f64)))).collect()
}

fn judge_row(world: &World, row: &[BodyId]) {
    for (index, &id) in row.iter().enumerate() {
        let wanted = if index + 1 == row.len() { Vec3::X * 2.0 } else { Vec3::ZERO };
        let velocity = world[id].linear_velocity();
        assert!((velocity - wanted).length() < 1e-5, "ball {index} of {}: {velocity}", row.len());
    }
}

#[test]
fn the_last_of_a_row_goes_and_all_others_stop() {
    let mut world = weightless();
    let row = add_row(&mut world, 20);
    for _ in 0..60 {
        world.step(STEP);
    }
    judge_row(&world, &row);
}

#[test]
fn the_last_of_a_row_on_a_table_goes_and_all_others_stop() {
    let mut world = World::new();
    world.add(smooth(Body::fixed().at(0.0, -1.0, 0.0).with(Shape::cuboid(100.0, 2.0, 100.0))));
    let row = add_row(&mut world, 8);
    for _ in 0..60 {
        world.step(STEP);
    }
    judge_row(&world, &row);
}

#[test]
fn a_wave_that_takes_more_rounds_than_an_instant_has_goes_on() {
    let mut world = weightless();
    let row = add_row(&mut world, 1500);
    let mut rounds = 0;
    for _ in 0..60 {
        let report = world.step(STEP);
        rounds = report.impacts().iter().map(|impact| impact.round + 1).max().unwrap_or(0).max(rounds);
        let mass = world.mass_of(row[0]).unwrap().mass;
        let (momentum, energy) =
            (world.momentum().linear.x / (2.0 * mass), world.energy().kinetic / (2.0 * mass));
        assert!((momentum - 1.0).abs() < 1e-6 && (energy - 1.0).abs() < 1e-6, "{momentum}, {energy}");
    }
    assert!(rounds < 1500, "all in {rounds} rounds of one instant: nothing is left to go on with");
    judge_row(&world, &row);
}

#[test]
fn a_row_that_sleeps_is_woken_as_far_as_the_wave_gets() {
    let mut world = weightless();
    let row = add_row(&mut world, 5);
    row[1..].iter().for_each(|&id| world.body_mut(id).unwrap().put_to_sleep());
    for _ in 0..60 {
        world.step(STEP);
    }
    judge_row(&world, &row);
    assert!(row.iter().all(|&id| !world[id].is_asleep()));
}

#[test]
fn rounds_and_contacts_of_an_instant_are_counted() {
    let mut world = weightless();
    let row = add_row(&mut world, 3);
    let mut seen = Vec::new();
    for _ in 0..60 {
        let report = world.step(STEP);
        seen.extend(
            report.impacts().iter().map(|impact| (impact.a, impact.b, impact.round, impact.together)),
        );
    }
    let expected = [(row[0], row[1], 0, 3), (row[1], row[2], 1, 3), (row[2], row[3], 2, 3)];
    assert_eq!(seen, expected);
}

#[test]
fn a_cube_that_is_struck_flat_does_not_turn() {
    let mut world = World::new();
    world.add(Body::fixed().at(0.0, -0.5, 0.0).with(Shape::cuboid(40.0, 1.0, 40.0)).friction(0.0));
    let ram = Body::kinematic().at(-3.0, 0.5, 0.0).moving(2.0, 0.0, 0.0).with(Shape::cuboid(1.0, 0.8, 4.0));
    world.add(ram.friction(0.0));
    let cube = Body::dynamic().at(0.0, 0.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).friction(0.0);
    let cube = world.add(cube);
    for _ in 0..180 {
        world.step(STEP);
    }
    assert!((world[cube].linear_velocity() - Vec3::X * 2.0).length() < 1e-3, "{:?}", world[cube]);
    assert!((world[cube].position().x - 4.0).abs() < 1e-3, "{}", world[cube].position());
    assert!(world[cube].angular_velocity().length() < 1e-3, "{:?}", world[cube]);
}

#[test]
fn a_cube_that_lands_flat_stays_above_its_place() {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::plane()));
    let cube = Body::dynamic().at(0.0, 0.55, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(0.8);
    let cube = world.add(cube);
    for _ in 0..300 {
        world.step(STEP);
        let place = world[cube].position();
        assert!(place.x.hypot(place.z) < 1e-3, "{place} at {} s", world.time());
    }
}

#[test]
fn a_stack_takes_a_blow_at_once_down_to_the_floor() {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::plane()));
    let boxes: Vec<BodyId> = (0..6)
        .map(|level| {
            world.add(Body::dynamic().at(0.0, 0.5 + f64::from(level), 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)))
        })
        .collect();
    world.add(Body::dynamic().at(0.0, 8.0, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)));
    let mut hits = 0;
    for _ in 0..90 {
        hits += world.step(STEP).impacts().len();
        for (level, &id) in boxes.iter().enumerate() {
            let sunk = 0.5 + level as f64 - world[id].position().y;
            assert!(sunk.abs() < 1e-4, "box {level} has sunk by {sunk} m at {} s", world.time());
        }
    }
    assert!(hits >= 7, "{hits} contacts struck: the blow got no further than the top");
}

#[test]
fn smooth_balls_never_turn_not_even_by_rounding() {
    let mut world = weightless();
    for side in [-1.0, 1.0] {
        for (x, y, z) in [(5.0, 0.0, 0.0), (0.0, 5.0, 0.0), (0.0, 0.0, 5.0)] {
            let wall = Body::fixed().at(side * x, side * y, side * z).with(Shape::cuboid(6.0, 6.0, 6.0));
            world.add(smooth(wall));
        }
    }
    let mut balls = Vec::new();
    for number in 0..8_u8 {
        let place = |bit: u8| if number & bit == 0 { -0.9 } else { 0.8 };
        let speed = |bit: u8| if number & bit == 0 { 3.1 } else { -2.3 } + 0.17 * f32::from(number);
        let ball = Body::dynamic().at(place(1), place(2), place(4)).with(Shape::sphere(0.5));
        balls.push(world.add(smooth(ball).moving(speed(2), speed(4), speed(1))));
    }
    let mut impacts = 0;
    for _ in 0..120 {
        impacts += world.step(STEP).impacts().len();
    }
    assert!(impacts > 50, "{impacts}");
    for id in balls {
        assert_eq!(world[id].angular_velocity(), Vec3::ZERO);
        assert_eq!(world[id].rotation(), Quat::IDENTITY);
    }
}
