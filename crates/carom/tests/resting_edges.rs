//! What rests when the world around it changes: supports that leave, sleepers, bodies that are lost.

mod random;

use carom::prelude::*;
use random::Random;

const STEP: f64 = 1.0 / 60.0;
const GRAVITY: f64 = 9.81;

fn ground() -> Body {
    Body::fixed().at(0.0, -1.0, 0.0).with(Shape::cuboid(100.0, 2.0, 100.0))
}

fn cube(y: f64) -> Body {
    Body::dynamic().at(0.0, y, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0))
}

fn run(world: &mut World, steps: u32) {
    for _ in 0..steps {
        world.step(STEP);
    }
}

#[test]
fn bodies_that_touch_at_several_places_count_as_one_contact() {
    let mut world = World::new();
    world.add(ground());
    let legs = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];
    let top = Body::dynamic().at(0.0, 1.1, 0.0).with(Shape::cuboid(2.4, 0.2, 2.4));
    let table = legs.into_iter().fold(top, |table, (x, z)| {
        table.collider(Collider::new(Shape::cuboid(0.2, 1.0, 0.2)).at(x, -0.6, z))
    });
    world.add(table);
    world.add(cube(1.7));
    // A sheet of two triangles, with a cube over both of them.
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let sheet = corners.map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
    let sheet = Shape::mesh(sheet, vec![[0, 2, 1], [0, 3, 2]]).unwrap();
    world.add(Body::fixed().at(10.0, 1.0, 0.0).with(sheet));
    world.add(cube(1.5).at(10.0, 1.5, 0.0));
    run(&mut world, 30);
    assert_eq!(world.step(STEP).contacts(), 3);
}

#[test]
fn a_body_that_is_lost_leaves_the_count_of_contacts_right() {
    let mut world = World::new();
    world.add(ground());
    let mut row = |x: f64| {
        let mut body = cube(0.5).mass(1e-3);
        body.position.x = x;
        world.add(body)
    };
    let lost = row(0.0);
    (1..6).for_each(|number| _ = row(3.0 * f64::from(number)));
    run(&mut world, 10);
    world.body_mut(lost).unwrap().add_force(DVec3::splat(1e308)).unwrap();
    let report = world.step(STEP);
    assert_eq!((report.quarantined(), report.contacts()), (&[lost][..], 5));
}

#[test]
fn a_body_whose_support_is_snatched_away_falls_freely() {
    for leaving in [5.0, 50.0, 500.0, 5000.0] {
        let mut world = World::new();
        let table = Body::kinematic().at(0.0, -0.5, 0.0).with(Shape::cuboid(4.0, 1.0, 4.0)).friction(0.0);
        let table = world.add(table);
        let body = world.add(cube(0.5).friction(0.0));
        run(&mut world, 30);
        world.body_mut(table).unwrap().set_linear_velocity(DVec3::Y * -leaving).unwrap();
        let high = world[body].position().y;
        for number in 1..=5 {
            world.step(STEP);
            let time = f64::from(number) * STEP;
            let (fallen, speed) = (high - world[body].position().y, -world[body].linear_velocity().y);
            assert!((f64::from(speed) - GRAVITY * time).abs() < 1e-3, "{speed} m/s, {time} s, {leaving} m/s");
            assert!(
                (fallen - 0.5 * GRAVITY * time * time).abs() < 1e-3,
                "{fallen} m, {time} s, {leaving} m/s"
            );
        }
    }
}

#[test]
fn a_body_from_under_which_a_table_is_pulled_falls_from_the_next_substep_on() {
    let mut world = World::new();
    let table = Body::kinematic().at(0.0, -0.5, 0.0).with(Shape::cuboid(4.0, 1.0, 4.0)).friction(0.0);
    let table = world.add(table);
    let body = world.add(Body::dynamic().at(0.0, 0.5, 0.0).with(Shape::sphere(0.5)).friction(0.0));
    run(&mut world, 30);
    world.body_mut(table).unwrap().set_linear_velocity(DVec3::X * 800.0).unwrap();
    run(&mut world, 2);
    let speed = -world[body].linear_velocity().y;
    assert!(f64::from(speed) > 1.4 * GRAVITY * STEP, "{speed} m/s");
}

#[test]
fn a_rising_platform_lifts_what_sleeps_on_it() {
    let mut world = World::new();
    let platform = world.add(Body::kinematic().at(0.0, -0.5, 0.0).with(Shape::cuboid(4.0, 1.0, 4.0)));
    let body = world.add(cube(0.5));
    run(&mut world, 30);
    world.body_mut(body).unwrap().put_to_sleep();
    run(&mut world, 3);
    assert!(world[body].is_asleep());
    world.body_mut(platform).unwrap().set_linear_velocity(DVec3::Y).unwrap();
    run(&mut world, 30);
    let above = world[body].position().y - world[platform].position().y;
    assert!((above - 1.0).abs() < 1e-2, "{above}");
}

#[test]
fn a_body_that_is_put_to_sleep_where_it_lies_sleeps_on() {
    let mut world = World::new();
    world.add(ground());
    let body = world.add(cube(0.5));
    world.body_mut(body).unwrap().put_to_sleep();
    run(&mut world, 3);
    assert!(world[body].is_asleep());
}

#[test]
fn waking_goes_through_a_stack_at_once() {
    let mut world = World::new();
    world.add(ground());
    let ids: Vec<BodyId> = (0..4).map(|number| world.add(cube(0.5 + f64::from(number)))).collect();
    run(&mut world, 60);
    ids.iter().for_each(|&id| world.body_mut(id).unwrap().put_to_sleep());
    run(&mut world, 1);
    assert!(ids.iter().all(|&id| world[id].is_asleep()));
    world.body_mut(ids[3]).unwrap().wake();
    run(&mut world, 1);
    assert!(
        ids.iter().all(|&id| !world[id].is_asleep()),
        "{:?}",
        ids.iter().map(|&id| world[id]).collect::<Vec<_>>()
    );
}

#[test]
fn what_slides_slowly_without_friction_slides_on() {
    let mut world = World::new();
    world.add(ground().friction(0.0));
    let body = world.add(cube(0.5).friction(0.0).moving(0.05, 0.0, 0.0));
    run(&mut world, 120);
    let speed = world[body].linear_velocity().x;
    assert!((speed - 0.05).abs() < 1e-4, "{speed} m/s");
}

#[test]
fn what_slides_with_its_platform_is_not_braked() {
    let mut world = World::new();
    let platform = Body::kinematic().at(0.0, -0.5, 0.0).with(Shape::cuboid(20.0, 1.0, 4.0)).friction(0.0);
    world.add(platform.moving(0.1, 0.0, 0.0));
    let body = world.add(cube(0.5).friction(0.0).moving(0.1, 0.0, 0.0));
    run(&mut world, 120);
    let speed = world[body].linear_velocity().x;
    assert!((speed - 0.1).abs() < 1e-4, "{speed} m/s");
}

/// The impulses of one substep act again in the next: in a heap whose contacts come and go they once fed on each other, until it
/// flew apart with 3e7 J.
#[test]
fn a_heap_of_bricks_gains_no_energy() {
    let mut world = World::new();
    world.add(ground());
    for number in 0..60 {
        let turn = f64::from(number);
        let brick =
            Body::dynamic().with(Shape::cuboid(1.0, 0.4, 0.6)).rotated(Quat::from_rotation_y(turn as f32));
        world.add(brick.at((0.7 * turn).sin(), 0.5 + 0.6 * turn, (1.3 * turn).cos()));
    }
    let mut last = f64::INFINITY;
    for step in 0..300 {
        world.step(STEP);
        let energy = world.energy().kinetic + world.energy().potential;
        assert!(energy <= last + 20.0, "{last} J became {energy} J in step {step}");
        last = energy;
    }
}

/// Contacts alone keep what is pushed out of one body from being pushed into another. A cone in a pile went 7 mm into a wall in this way.
#[test]
#[ignore = "the box is pushed 8 mm into the wall; to leave where they are those that have no room lets deep overlaps of piles last"]
fn what_overlaps_is_not_pushed_into_what_it_does_not_touch() {
    const GAP: f64 = 2e-3;
    const LEFT: f64 = 4e-5;
    let mut world = World::new();
    world.add(ground());
    let boxes = [0.0, 0.96].map(|x| {
        let mut body = cube(0.5);
        body.position.x = x;
        world.add(body)
    });
    world.add(Body::fixed().at(1.96 + GAP, 0.5, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)));
    for step in 0..60 {
        world.step(STEP);
        let [_, x] = boxes.map(|id| world[id].position().x);
        assert!(x <= 0.96 + GAP + LEFT, "{} m in the wall after step {step}", x - 0.96 - GAP);
    }
    let [a, b] = boxes.map(|id| world[id].position().x);
    assert!(b - a >= 1.0 - LEFT, "the boxes still overlap by {} m", 1.0 - (b - a));
}

#[test]
fn a_box_that_overlaps_a_wall_is_pushed_out_though_it_parts_slowly() {
    let mut world = World::new();
    world.add(ground().friction(0.0));
    world.add(Body::fixed().at(-1.0, 1.0, 0.0).with(Shape::cuboid(1.0, 4.0, 4.0)).friction(0.0));
    let mut body = cube(0.5).friction(0.0).moving(1e-6, 0.0, 0.0);
    body.position.x = -1e-3;
    let body = world.add(body);
    run(&mut world, 60);
    let overlap = -world[body].position().x;
    assert!(overlap < 4e-5, "{overlap} m of overlap are left after a second");
}

/// Piles like this one went on shaking: their solver overshot, and their boxes sank into each other and into the walls.
#[test]
fn a_pile_of_boxes_comes_to_rest_and_stays() {
    let mut world = World::new();
    let mut random = Random(5);
    world.add(ground());
    for (x, z, width, depth) in
        [(4.0, 0.0, 2.0, 10.0), (-4.0, 0.0, 2.0, 10.0), (0.0, 4.0, 6.0, 2.0), (0.0, -4.0, 6.0, 2.0)]
    {
        world.add(Body::fixed().at(x, 10.0, z).with(Shape::cuboid(width, 40.0, depth)).friction(0.5));
    }
    let boxes: Vec<BodyId> = (0..90)
        .map(|number| {
            let place = [number % 3, number / 9, number / 3 % 3].map(|it| 1.75 * f64::from(it));
            let jitter = random.vector(0.08);
            let size = DVec3::ONE + random.vector(0.2);
            let body = Body::dynamic()
                .at(place[0] - 1.75 + jitter.x, 1.0 + place[1] + jitter.y, place[2] - 1.75 + jitter.z)
                .rotated(random.rotation().as_quat())
                .with(Shape::cuboid(size.x, size.y, size.z));
            world.add(body.friction(0.5))
        })
        .collect();
    // The last box falls from the heap after nine seconds.
    run(&mut world, 900);
    for _ in 0..60 {
        world.step(STEP);
        let fastest = boxes.iter().map(|&id| world[id].linear_velocity().length()).fold(0.0, f32::max);
        assert!(fastest < 1e-4, "{fastest} m/s at {} s", world.time());
    }
}
