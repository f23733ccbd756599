//! Nothing tunnels, nothing is slowed: fast bodies strike what is in their way, at their own speed, however thin it is.

#[path = "fast/blades.rs"]
mod blades;
#[path = "fast/bullets.rs"]
mod bullets;
#[path = "random/mod.rs"]
mod random;
#[path = "fast/sensors.rs"]
mod sensors;

use carom::Settings;
use carom::prelude::*;
use random::Random;

const STEP: f64 = 1.0 / 60.0;

fn weightless() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() })
}

fn elastic(body: Body) -> Body {
    body.restitution(1.0).friction(0.0)
}
