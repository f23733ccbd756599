//! The world: bodies, and the law that moves them.

use crate::bodies::{Bodies, BodyId, BodyState, WORLD_ROW};
use crate::body::Body;
use crate::commands::BodyMut;
use crate::error::Invalid;
use crate::ledger::{self, Ledger, Stock};
use crate::mass::BodyMass;
use crate::math::DVec3;
use crate::report::StepReport;
use crate::solver::lanes::{InstructionSet, Machine};
use crate::step::broad_phase::BroadPhase;
use crate::step::events::Agenda;
use crate::step::pairs::Pairs;
use crate::step::pool::Pool;
use crate::step::rest::Rest;
use std::sync::Arc;

/// What holds for the whole world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration of gravity, m/s².
    pub gravity: DVec3,
    /// Into how many substeps a step divides for what rests. The rest threshold is the speed `½ a h` that the
    /// acceleration `a`, which presses two bodies together, takes away in half a substep `h`.
    pub substeps: u32,
    /// Whether the world keeps a [`Ledger`](crate::Ledger) from the start: momentum and energy of every step, by cause.
    pub ledger: bool,
    /// Instructions that the solver computes with: by default the widest that this machine has. They decide how fast it is, and
    /// not a bit of the result. Of what the machine lacks the next narrower one is taken.
    pub instruction_set: InstructionSet,
    /// Threads that share the work of a step, the one that calls [`World::step`] among them: by default that one alone. They decide how
    /// fast it is, and not a bit of the result. The others are started when a step has enough work for them, wait asleep
    /// between steps, and end with the world. At least 1.
    pub threads: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.81, 0.0),
            substeps: 2,
            ledger: false,
            instruction_set: InstructionSet::default(),
            threads: 1,
        }
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
    /// `Σ m v`, N·s.
    pub linear: DVec3,
    /// `Σ x × m v + L` about the world's origin, N·m·s.
    pub angular: DVec3,
}

/// Bodies and the law that moves them.
///
/// ```
/// use carom::prelude::*;
///
/// let mut world = World::new(); // gravity 9.81 m/s² down
/// world.add(Body::fixed().with(Shape::cuboid(100.0, 2.0, 100.0)));
/// let ball = world.add(Body::dynamic().at(0.0, 4.0, 0.0).with(Shape::sphere(0.5)).restitution(0.8));
/// for _ in 0..60 {
///     let report = world.step(1.0 / 60.0);
///     for hit in report.impacts() {
///         println!("{hit}");
///     }
/// }
/// assert!(world[ball].position().y > 1.5);
/// ```
pub struct World {
    pub(crate) settings: Settings,
    pub(crate) bodies: Bodies,
    pub(crate) broad_phase: BroadPhase,
    pub(crate) pairs: Pairs,
    pub(crate) rest: Rest,
    pub(crate) pool: Arc<Pool>,
    pub(crate) agenda: Agenda,
    pub(crate) report: StepReport,
    pub(crate) ledger: Ledger,
    /// Bodies refused since the last step.
    refused: Vec<BodyId>,
    pub(crate) time: f64,
}

impl World {
    /// An empty world with gravity 9.81 m/s² downwards.
    pub fn new() -> Self {
        Self::with_settings(Settings::default())
    }

    /// An empty world.
    pub fn with_settings(settings: Settings) -> Self {
        let mut bodies = Bodies::new();
        ledger::keep(&mut bodies, settings.ledger);
        let instruction_set = settings.instruction_set.or_narrower();
        let threads = settings.threads.max(1);
        let pool = Arc::new(Pool::new(threads as usize));
        Self {
            settings: Settings { instruction_set, threads, ..settings },
            bodies,
            broad_phase: BroadPhase::new(),
            pairs: Pairs::default(),
            rest: Rest::new(Machine::new(instruction_set), Arc::clone(&pool)),
            pool,
            agenda: Agenda::default(),
            report: StepReport::default(),
            ledger: Ledger::default(),
            refused: Vec::new(),
            time: 0.0,
        }
    }

    /// What holds for the whole world.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Adds a body.
    ///
    /// # Errors
    /// Names the first field that no body can have; nothing is added then.
    pub fn try_add(&mut self, body: Body) -> Result<BodyId, Invalid> {
        let (id, verdict) = self.bodies.add(body);
        if let Err(error) = verdict {
            self.bodies.remove(id);
            return Err(error);
        }
        self.enlist(id);
        Ok(id)
    }

    /// Adds a body. One that [`World::try_add`] would refuse is kept in quarantine: it takes no part, and the next
    /// report names it.
    pub fn add(&mut self, body: Body) -> BodyId {
        let (id, verdict) = self.bodies.add(body);
        match verdict {
            Ok(()) => self.enlist(id),
            Err(_) => self.refused.push(id),
        }
        id
    }

    pub(crate) fn enlist(&mut self, id: BodyId) {
        let keys = self.bodies.get(id).map_or_else(Default::default, |record| record.colliders.clone());
        for key in keys {
            self.broad_phase.insert(&self.bodies, key);
        }
    }

    /// Removes a body; whether it was there.
    pub fn remove(&mut self, id: BodyId) -> bool {
        let Some(record) = self.bodies.remove(id) else { return false };
        self.forget(&record.colliders, record.row);
        true
    }

    /// Takes what is left of a body that has lost its colliders and its row.
    pub(crate) fn forget(&mut self, colliders: &[u32], row: usize) {
        self.forget_colliders(colliders, row);
        if row != WORLD_ROW {
            let last = self.bodies.states.len();
            self.rest.remove_row(row, last);
            self.pairs.remove_row(row, last);
            self.broad_phase.remove_row(row, last);
        }
    }

    /// Takes the colliders of the body of a row from their neighbours.
    pub(crate) fn forget_colliders(&mut self, keys: &[u32], row: usize) {
        for &key in keys {
            self.broad_phase.remove(key);
            for pair in self.pairs.remove(key, row) {
                self.rest.drop_contacts(&pair);
            }
        }
    }

    /// Where the body is and how it moves, if it is there.
    pub fn body(&self, id: BodyId) -> Option<&BodyState> {
        self.bodies.get(id).map(|record| &record.state)
    }

    /// Access to change how the body moves, if it is there.
    pub fn body_mut(&mut self, id: BodyId) -> Option<BodyMut<'_>> {
        self.bodies.get(id)?;
        Some(BodyMut::new(self, id))
    }

    /// What the body was made from, if it is there.
    pub fn description(&self, id: BodyId) -> Option<&Body> {
        self.bodies.description(id)
    }

    /// Mass properties as used (infinite where nothing moves it), if it is there.
    pub fn mass_of(&self, id: BodyId) -> Option<&BodyMass> {
        self.bodies.get(id).map(|record| &record.mass)
    }

    /// All bodies, in the order of their ids.
    pub fn bodies(&self) -> impl Iterator<Item = (BodyId, &BodyState)> {
        self.bodies.iter().map(|(id, record)| (id, &record.state))
    }

    /// Simulated time since the start, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// What the dynamic bodies have.
    fn stock(&self) -> Stock {
        let mut stock = Stock::default();
        for row in self.bodies.rows() {
            stock += Stock::of_row(&self.bodies, row, self.settings.gravity);
        }
        stock
    }

    /// The energy of the dynamic bodies. Infinite masses and inertias take no part.
    pub fn energy(&self) -> Energy {
        self.stock().energy
    }

    /// The momentum of the dynamic bodies. Infinite masses take no part.
    pub fn momentum(&self) -> Momentum {
        self.stock().momentum
    }

    /// Momentum and energy of the steps so far, by cause; empty unless the settings ask for it or [`World::keep_ledger`] has.
    ///
    /// ```
    /// use carom::prelude::*;
    /// use carom::Settings;
    ///
    /// let mut world = World::with_settings(Settings { ledger: true, ..Settings::default() });
    /// world.add(Body::fixed().with(Shape::Plane).restitution(0.5));
    /// world.add(Body::dynamic().at(0.0, 1.5, 0.0).with(Shape::sphere(0.5)).mass(2.0));
    /// while world.ledger().total().posts.loss_restitution == 0.0 {
    ///     world.step(1.0 / 60.0);
    /// }
    /// // Falls 1 m, and keeps a quarter of the energy.
    /// let lost = world.ledger().total().posts.loss_restitution;
    /// assert!((lost - 0.75 * 2.0 * 9.81).abs() < 1e-9);
    /// assert!(world.ledger().total().relative_residual().iter().all(|it| *it < 1e-12));
    /// println!("{}", world.ledger());
    /// ```
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Opens a new ledger, or closes the one there is and forgets it.
    pub fn keep_ledger(&mut self, on: bool) {
        self.settings.ledger = on;
        self.ledger = Ledger::default();
        ledger::keep(&mut self.bodies, on);
    }

    /// A hash (FNV-1a, 64 bits) of the state of all bodies that move: the same for the same bits.
    pub fn state_hash(&self) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut eat = |value: f64| {
            for byte in value.to_bits().to_le_bytes() {
                hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        for (id, record) in self.bodies.iter().filter(|(_, record)| record.row != WORLD_ROW) {
            let state = &self.bodies.states[record.row];
            eat(id.index() as f64);
            state.position.to_array().into_iter().for_each(&mut eat);
            state.rotation.to_array().into_iter().for_each(&mut eat);
            state.velocity.to_array().into_iter().for_each(&mut eat);
            state.angular_momentum.to_array().into_iter().for_each(&mut eat);
        }
        hash
    }

    /// Lets `dt` seconds pass. Does nothing if `dt` is not a positive finite number.
    pub fn step(&mut self, dt: f64) -> &StepReport {
        if dt > 0.0 && dt.is_finite() {
            crate::step::step(self, dt);
        } else {
            self.report = StepReport::default();
        }
        self.report.quarantined.append(&mut self.refused);
        &self.report
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl std::ops::Index<BodyId> for World {
    type Output = BodyState;

    /// Where the body is and how it moves.
    ///
    /// # Panics
    /// If the body has been removed; [`World::body`] asks first.
    fn index(&self, id: BodyId) -> &BodyState {
        self.body(id).expect("the body is in this world; World::body tells whether it still is")
    }
}
