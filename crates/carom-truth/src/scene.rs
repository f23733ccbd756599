//! What the rows build their scenes with.

use carom::math::{DQuat, DVec3};
use carom::{Body, BodyId, Collider, Settings, Shape, World};

/// Length of a step where a row does not say otherwise, s.
pub const STEP: f64 = 1.0 / 60.0;

/// Acceleration of gravity, m/s².
pub const G: f64 = 9.81;

/// A world without gravity.
pub fn floating() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() })
}

/// How many steps come nearest to `seconds`.
pub fn steps(seconds: f64) -> usize {
    (seconds / STEP).round() as usize
}

/// Lets that many seconds pass.
pub fn run(world: &mut World, seconds: f64) {
    for _ in 0..steps(seconds) {
        world.step(STEP);
    }
}

/// A slab, 400 m square, whose top is at height 0.
pub fn slab() -> Body {
    Body::fixed().collider(Collider::new(Shape::cuboid(400.0, 2.0, 400.0)).at(0.0, -1.0, 0.0))
}

/// A ball of 1000 kg/m³ without friction.
pub fn ball(radius: f64) -> Body {
    Body::dynamic().with(Shape::sphere(radius)).friction(0.0)
}

/// A cube of 1 m and 1000 kg.
pub fn cube() -> Body {
    Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0))
}

/// Where a body begins and how it moves, in vectors.
pub trait Begins {
    /// Places its origin, m.
    fn placed(self, place: DVec3) -> Self;
    /// Sets the velocity of its centre of mass, m/s.
    fn flung(self, velocity: DVec3) -> Self;
    /// Sets its angular velocity, rad/s.
    fn spun(self, spin: DVec3) -> Self;
    /// Turns it.
    fn turned(self, rotation: DQuat) -> Self;
}

impl Begins for Body {
    fn placed(self, place: DVec3) -> Self {
        self.at(place.x, place.y, place.z)
    }

    fn flung(self, velocity: DVec3) -> Self {
        let [x, y, z] = velocity.as_vec3().to_array();
        self.moving(x, y, z)
    }

    fn spun(self, spin: DVec3) -> Self {
        let [x, y, z] = spin.as_vec3().to_array();
        self.spinning(x, y, z)
    }

    fn turned(self, rotation: DQuat) -> Self {
        self.rotated(rotation.as_quat().normalize())
    }
}

/// Velocity of a body's centre of mass, m/s.
pub fn velocity(world: &World, id: BodyId) -> DVec3 {
    world[id].linear_velocity().as_dvec3()
}

/// Angular velocity of a body, rad/s.
pub fn spin(world: &World, id: BodyId) -> DVec3 {
    world[id].angular_velocity().as_dvec3()
}

/// What turns a body's frame into the world's.
pub fn rotation(world: &World, id: BodyId) -> DQuat {
    world[id].rotation().as_dquat().normalize()
}

/// The middle and the largest of some numbers; NaN counts as the largest.
pub fn median_and_worst(mut numbers: Vec<f64>) -> [f64; 2] {
    numbers.sort_by(f64::total_cmp);
    [numbers[numbers.len() / 2], numbers[numbers.len() - 1]]
}

/// The largest; NaN if one is.
pub fn largest(numbers: impl IntoIterator<Item = f64>) -> f64 {
    numbers.into_iter().fold(0.0, |most, number| if number > most || number.is_nan() { number } else { most })
}
