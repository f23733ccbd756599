//! The world: bodies, and the law that moves them.

use crate::body::Body;
use crate::bodies::{BodyId, BodyState};
use crate::error::Invalid;
use crate::math::DVec3;
use crate::report::Impact;

/// What holds for the whole world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration of gravity, m/s².
    pub gravity: DVec3,
    /// Into how many parts a step divides for what rests and for the rest threshold.
    pub substeps: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self { gravity: DVec3::new(0.0, -9.81, 0.0), substeps: 4 }
    }
}

/// Kinetic and potential energy, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// `Σ ½ m v² + ½ ω·L` of the dynamic bodies.
    pub kinetic: f64,
    /// `−Σ m γ g·x` from the world's origin, with each body's gravity factor γ.
    pub potential: f64,
}

/// Momentum of the dynamic bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Momentum {
    /// `Σ m v`, kg·m/s.
    pub linear: DVec3,
    /// `Σ x × m v + L` about the world's origin, kg·m²/s.
    pub angular: DVec3,
}

/// Bodies and the law that moves them.
pub struct World {}

impl World {
    /// An empty world with gravity 9.81 m/s² downwards.
    pub fn new() -> Self {
        Self::with_settings(Settings::default())
    }

    /// An empty world.
    pub fn with_settings(_settings: Settings) -> Self {
        unimplemented!()
    }

    /// Adds a body.
    ///
    /// # Errors
    /// Names the first field that no body can have.
    pub fn try_add(&mut self, _body: Body) -> Result<BodyId, Invalid> {
        unimplemented!()
    }

    /// Adds a body. One that [`World::try_add`] would refuse is kept in quarantine: it takes no part, and the next
    /// report names it.
    pub fn add(&mut self, _body: Body) -> BodyId {
        unimplemented!()
    }

    /// Removes a body; whether it was there.
    pub fn remove(&mut self, _id: BodyId) -> bool {
        unimplemented!()
    }

    /// Where the body is and how it moves, if it is there.
    pub fn body(&self, _id: BodyId) -> Option<&BodyState> {
        unimplemented!()
    }

    /// What the body was made from, if it is there.
    pub fn description(&self, _id: BodyId) -> Option<&Body> {
        unimplemented!()
    }

    /// Mass properties as used (mass infinite where it is; inertia in the body's frame), if it is there.
    pub fn mass_of(&self, _id: BodyId) -> Option<&crate::mass::BodyMass> {
        unimplemented!()
    }

    /// All bodies, in the order of their ids.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, &BodyState)> {
        std::iter::empty()
    }

    /// Simulated time since the start, s.
    pub fn time(&self) -> f64 {
        unimplemented!()
    }

    /// The energy of the dynamic bodies.
    pub fn energy(&self) -> Energy {
        unimplemented!()
    }

    /// The momentum of the dynamic bodies.
    pub fn momentum(&self) -> Momentum {
        unimplemented!()
    }

    /// A hash of the whole state: the same for the same bits.
    pub fn state_hash(&self) -> u64 {
        unimplemented!()
    }

    /// Lets `dt` seconds pass.
    pub fn step(&mut self, _dt: f64) -> StepReport<'_> {
        unimplemented!()
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

/// What happened in a step.
pub struct StepReport<'world> {
    world: &'world World,
}

impl StepReport<'_> {
    /// The collisions, ordered by (time, a, b).
    pub fn impacts(&self) -> &[Impact] {
        unimplemented!()
    }

    /// How many pairs of bodies touch at the end of the step.
    pub fn contacts(&self) -> usize {
        unimplemented!()
    }

    /// Bodies taken out of the simulation in this step, since their state was no longer finite or never was valid.
    pub fn quarantined(&self) -> &[BodyId] {
        unimplemented!()
    }
}
