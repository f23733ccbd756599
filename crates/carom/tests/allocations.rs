//! A step in which everything lies still asks nothing of the allocator.

use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;

#[global_allocator]
static ALLOCATOR: dhat::Alloc = dhat::Alloc;

/// A wall of bricks, and one of each kind of shape beside it, on the ground.
fn scene() -> World {
    let mut world = World::new();
    world.add(Body::fixed().with(Shape::cuboid(100.0, 2.0, 100.0)).at(0.0, -1.0, 0.0));
    for layer in 0..8 {
        for number in 0..8 - layer {
            let x = f64::from(number) + 0.5 * f64::from(layer);
            let brick = Body::dynamic().with(Shape::cuboid(0.95, 1.0, 1.0)).friction(0.6);
            world.add(brick.at(x, 0.5 + f64::from(layer), 0.0));
        }
    }
    let corners = [[0.5, 0.0, 0.5], [-0.5, 0.0, 0.5], [0.5, 0.0, -0.5], [-0.5, 0.0, -0.5], [0.0, 1.0, 0.0]];
    let hull = Shape::hull(&corners.map(DVec3::from_array)).expect("a pyramid");
    let shapes = [Shape::sphere(0.5), Shape::capsule(1.0, 0.3), Shape::cylinder(0.8, 0.4), hull];
    for (number, shape) in shapes.into_iter().enumerate() {
        world.add(Body::dynamic().with(shape).at(2.0 * number as f64, 1.0, 3.0));
    }
    world
}

#[test]
fn a_settled_step_allocates_nothing() {
    let mut world = scene();
    for _ in 0..600 {
        world.step(STEP);
    }
    let _profiler = dhat::Profiler::builder().testing().build();
    for number in 0..60 {
        let contacts = world.step(STEP).contacts();
        assert!(contacts > 40, "{contacts} contacts");
        let stats = dhat::HeapStats::get();
        assert_eq!(stats.total_blocks, 0, "{} B by step {number}", stats.total_bytes);
    }
    // It is counted: room for another body is asked for.
    world.add(Body::dynamic().with(Shape::sphere(0.5)).at(0.0, 20.0, 0.0));
    assert!(dhat::HeapStats::get().total_blocks > 0);
}
