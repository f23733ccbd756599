//! The ledger: each cause against its closed form, and nothing unexplained in scenes of chance.

#[path = "ledger/balance.rs"]
mod balance;
#[path = "ledger/causes.rs"]
mod causes;
#[path = "ledger/outside.rs"]
mod outside;
#[path = "random/mod.rs"]
mod random;

use carom::Settings;
use carom::ledger::Posts;
use carom::math::DVec3;
use carom::prelude::*;

const STEP: f64 = 1.0 / 60.0;
const G: f64 = 9.81;

/// A world that keeps a ledger.
fn world() -> World {
    World::with_settings(Settings { ledger: true, ..Settings::default() })
}

fn weightless() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ledger: true, ..Settings::default() })
}

/// Steps, and holds every one of them to the books.
fn run(world: &mut World, steps: usize) {
    for _ in 0..steps {
        world.step(STEP);
        let worst = world.ledger().last_step().relative_residual().into_iter().fold(0.0, f64::max);
        assert!(
            worst < 1e-7,
            "{worst} of the posts unexplained:\n{}\nlast step: {}",
            world.ledger(),
            world.ledger().last_step()
        );
    }
}

/// The books of all steps so far.
fn posts(world: &World) -> Posts {
    world.ledger().total().posts
}

/// A ball of 1 kg and 0.5 m, without friction.
fn ball() -> Body {
    Body::dynamic().with(Shape::sphere(0.5)).mass(1.0).friction(0.0)
}

/// A cube of 2 kg and 1 m.
fn cube() -> Body {
    Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0)).mass(2.0)
}

/// Its top is at height 0.
fn ground() -> Body {
    Body::fixed().collider(Collider::new(Shape::cuboid(200.0, 2.0, 200.0)).at(0.0, -1.0, 0.0))
}

#[track_caller]
fn assert_near(found: f64, truth: f64, tolerance: f64) {
    assert!((found - truth).abs() <= tolerance, "{found} is not {truth} to within {tolerance}");
}
