//! What mechanics fixes about bodies that stand, lie, slide, roll and are struck where they lie, at dt 1/60 with default
//! settings. Each goal is the closed form and how near to it the engine must come.

#[path = "truth/carried.rs"]
mod carried;
#[path = "truth/friction.rs"]
mod friction;
#[path = "truth/stacks.rs"]
mod stacks;
#[path = "truth/statics.rs"]
mod statics;
#[path = "truth/struck.rs"]
mod struck;

use carom::math::{DVec3, rotation_from_vector};
use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;
const G: f64 = 9.81;

/// How many steps come nearest to `seconds`.
fn steps(seconds: f64) -> usize {
    (seconds / STEP).round() as usize
}

fn run(world: &mut World, seconds: f64) {
    for _ in 0..steps(seconds) {
        world.step(STEP);
    }
}

/// A slab, 100 m square, whose top is at height 0.
fn slab(friction: f64) -> Body {
    Body::fixed()
        .collider(Collider::new(Shape::cuboid(100.0, 2.0, 100.0)).at(0.0, -1.0, 0.0))
        .friction(friction)
}

fn cube() -> Body {
    Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0))
}

/// How something lies on a slope.
struct Tilt {
    rotation: Quat,
    exact: DQuat,
}

impl Tilt {
    /// That of a slope that falls towards +x, at an angle in radians.
    fn of(angle: f64) -> Self {
        let rotation = rotation_from_vector(DVec3::new(0.0, 0.0, -angle)).as_quat();
        Self { rotation, exact: rotation.as_dquat().normalize() }
    }

    /// The direction downhill.
    fn downhill(&self) -> DVec3 {
        self.exact * DVec3::X
    }

    /// The point at that height above the slope's origin, along its normal.
    fn above(&self, height: f64) -> DVec3 {
        self.exact * DVec3::new(0.0, height, 0.0)
    }

    /// The same body, tilted, with its origin at that height above the slope's.
    fn lay(&self, body: Body, height: f64) -> Body {
        let place = self.above(height);
        body.at(place.x, place.y, place.z).rotated(self.rotation)
    }
}

/// Prints a figure, and fails if it is further from the truth than the goal.
fn judge(what: &str, found: f64, truth: f64, goal: f64) {
    let error = found - truth;
    println!("{what}: {found:.9} for {truth:.9}, off by {error:.1e} of {goal:.1e}");
    assert!(error.abs() <= goal, "{what}: {found} instead of {truth}, off by {error:e}, goal {goal:e}");
}

/// The same with the goal as a share of the truth.
fn judge_share(what: &str, found: f64, truth: f64, goal: f64) {
    judge(what, found, truth, goal * truth.abs());
}
