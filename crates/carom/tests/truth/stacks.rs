//! Stacks and heavy loads: nothing may sink.

use super::*;

/// How far the top of a pile sinks below its height at the start, m: the most in `seconds`, and at their end.
struct Sink {
    peak: f64,
    settled: f64,
    /// The most that any of the boxes has moved sideways, m.
    sideways: f64,
}

fn sink(world: &mut World, boxes: &[BodyId], seconds: f64) -> Sink {
    let top = *boxes.last().unwrap();
    let starts: Vec<DVec3> = boxes.iter().map(|&id| world[id].position()).collect();
    let height = starts.last().unwrap().y;
    let mut found = Sink { peak: 0.0, settled: 0.0, sideways: 0.0 };
    for _ in 0..steps(seconds) {
        world.step(STEP);
        found.settled = height - world[top].position().y;
        found.peak = found.peak.max(found.settled.abs());
        for (&id, start) in boxes.iter().zip(&starts) {
            let way = world[id].position() - *start;
            found.sideways = found.sideways.max(way.x.hypot(way.z));
        }
    }
    found
}

/// Twenty unit boxes on each other at x, for ten seconds.
fn stack_of_twenty(x: f64) -> Sink {
    let mut world = World::new();
    world.add(slab(0.5).at(x, 0.0, 0.0));
    let boxes: Vec<BodyId> =
        (0..20).map(|level| world.add(cube().at(x, 0.5 + f64::from(level), 0.0).friction(0.5))).collect();
    sink(&mut world, &boxes, 10.0)
}

/// A box `ratio` times as heavy on one of 1000 kg, for five seconds.
fn heavy_on_light(ratio: f64) -> Sink {
    let mut world = World::new();
    world.add(slab(0.5));
    let light = world.add(cube().at(0.0, 0.5, 0.0).friction(0.5));
    let heavy = world.add(cube().at(0.0, 1.5, 0.0).friction(0.5).mass(1000.0 * ratio));
    sink(&mut world, &[light, heavy], 5.0)
}

#[test]
fn a_stack_of_twenty_does_not_sink() {
    let found = stack_of_twenty(0.0);
    judge("settled sink of the top, m", found.settled, 0.0, 1e-3);
    judge("largest sink of the top, m", found.peak, 0.0, 2e-3);
    judge("sideways, m", found.sideways, 0.0, 1e-3);
}

#[test]
fn a_stack_of_twenty_does_not_sink_a_thousand_kilometres_away() {
    let (here, there) = (stack_of_twenty(0.0), stack_of_twenty(1e6));
    judge("settled sink of the top, m", there.settled, 0.0, 1e-3);
    judge("largest sink of the top, m", there.peak, 0.0, 2e-3);
    judge("sideways, m", there.sideways, 0.0, 1e-3);
    judge("settled sink there and here, m", there.settled, here.settled, 1e-6);
    judge("largest sink there and here, m", there.peak, here.peak, 1e-6);
}

#[test]
fn a_hundred_times_the_mass_on_top_does_not_sink() {
    let found = heavy_on_light(100.0);
    judge("largest sink of the heavy box, m", found.peak, 0.0, 1e-3);
    judge("sideways, m", found.sideways, 0.0, 1e-3);
}

#[test]
fn a_thousand_times_the_mass_on_top_does_not_sink() {
    let found = heavy_on_light(1000.0);
    judge("largest sink of the heavy box, m", found.peak, 0.0, 5e-3);
    judge("sideways, m", found.sideways, 0.0, 5e-3);
}

/// Harmonic overhang: the mass above each of four boxes has its centre at `share` of the way to the box's edge.
fn overhanging_tower(share: f64) -> (World, Vec<(BodyId, DVec3)>) {
    const LEVELS: u32 = 4;
    let mut world = World::new();
    let table = Collider::new(Shape::cuboid(10.0, 2.0, 10.0)).at(-5.0, -1.0, 0.0);
    world.add(Body::fixed().collider(table).friction(0.8));
    let mut x = -0.5;
    let boxes = (0..LEVELS).map(|level| {
        x += share * 0.5 / f64::from(LEVELS - level);
        let place = DVec3::new(x, 0.5 + f64::from(level), 0.0);
        (world.add(cube().at(place.x, place.y, place.z).friction(0.8)), place)
    });
    let boxes = boxes.collect();
    (world, boxes)
}

#[test]
fn a_tower_that_hangs_over_just_within_the_limit_stands() {
    let (mut world, boxes) = overhanging_tower(0.99);
    run(&mut world, 5.0);
    let moved = boxes.iter().map(|&(id, place)| (world[id].position() - place).length());
    judge("largest way in 5 s, m", moved.fold(0.0, f64::max), 0.0, 1e-3);
}

#[test]
fn a_tower_that_hangs_over_beyond_the_limit_falls() {
    let (mut world, boxes) = overhanging_tower(1.01);
    let start = world.energy();
    for _ in 0..steps(5.0) {
        world.step(STEP);
        let now = world.energy();
        let gain = now.kinetic + now.potential - start.kinetic - start.potential;
        assert!(gain < 0.01 * start.potential, "{gain} J more than at the start, at {} s", world.time());
    }
    let (top, place) = boxes[3];
    assert!(world[top].position().y < place.y - 1.0, "{}", world[top].position());
}

#[test]
fn three_boxes_dropped_together_come_to_rest_standing() {
    let mut world = World::new();
    world.add(slab(0.6));
    let heights = [0.5, 1.5, 2.5];
    let boxes = heights.map(|y| world.add(cube().at(0.0, y + 0.1, 0.0).restitution(0.5)));
    run(&mut world, 5.0);
    for (id, y) in boxes.into_iter().zip(heights) {
        let state = &world[id];
        let place = state.position();
        judge("height, m", place.y, y, 1e-3);
        judge("sideways, m", place.x.hypot(place.z), 0.0, 1e-3);
        judge("speed, m/s", f64::from(state.linear_velocity().length()), 0.0, 1e-3);
        judge("spin, rad/s", f64::from(state.angular_velocity().length()), 0.0, 1e-3);
    }
}
