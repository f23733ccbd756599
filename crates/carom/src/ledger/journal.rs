//! What is noted while a step goes on.

use super::contacts::{Part, Push};
use super::flights::heavy_mass;
use super::stock::components;
use super::{Posts, Residual, Stock};
use crate::bodies::Bodies;
use crate::math::{DQuat, DVec3};
use crate::world::Momentum;
use std::ops::AddAssign;

/// The journal of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    pub gravity: DVec3,
    pub posts: Posts,
    /// Row by row: what each body had, and at the end of a step has; what has changed it, what contacts do to it.
    start: Vec<Stock>,
    end: Vec<Stock>,
    pub tallies: Vec<Tally>,
    pub falls: Vec<Fall>,
    pub holds: Vec<Hold>,
    /// Where contacts lead what they hold, from when it sets out; and what rest capture gives to whom it captures.
    pub passages: Vec<Passage>,
    pub captures: Vec<Push>,
    /// Orientations when they set out of those of which something is infinite.
    pub rotations: Vec<DQuat>,
    /// Of the step that is over, the row whose body got most energy from an artefact, and how much, J.
    most: (usize, f64),
    /// Sums of what the bodies had at the end of the last step, with and without directions.
    sum: Stock,
    gross: [f64; 3],
    /// Whether bodies still have what they had then: nobody has been at them.
    is_known: bool,
    /// Row by row, what friction and twist give in the present substep, as a part of what contacts do.
    pub frictions: Vec<Part>,
    /// Row by row, what contacts give along their normals in the present substep that bounce when struck faster; empty if there are none.
    pub rebounds: Vec<Part>,
    /// A body was lost.
    lost: bool,
}

/// What has changed one body in the present step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    explained: Residual,
    /// Energy that each of the [`ARTEFACTS`] gave, J.
    pub artefacts: [f64; ARTEFACTS.len()],
}

/// How long gravity has acted on a body, s, and the integral of where it did, m·s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fall {
    time: f64,
    place: DVec3,
}

impl Fall {
    /// Gravity acts for so long (s) at the mean place `center`.
    #[inline]
    pub fn add(&mut self, center: DVec3, time: f64) {
        self.time += time;
        self.place += center * time;
    }

    /// Times the mass (kg) on which gravity pulls.
    fn of_mass(&self, mass: f64) -> Self {
        Self { time: mass * self.time, place: mass * self.place }
    }

    /// Linear and angular momentum that gravity (m/s²) gives to a body of 1 kg.
    fn momentum(&self, gravity: DVec3) -> Momentum {
        Momentum { linear: gravity * self.time, angular: self.place.cross(gravity) }
    }
}

impl AddAssign for Fall {
    fn add_assign(&mut self, other: Self) {
        self.time += other.time;
        self.place += other.place;
    }
}

/// Posts that are not modelled.
pub(crate) const ARTEFACTS: [&str; 4] =
    ["integration", "position_correction", "loss_rest_capture", "loss_sleep"];
pub(crate) const INTEGRATION: usize = 0;
pub(crate) const CORRECTION: usize = 1;
pub(crate) const CAPTURE: usize = 2;
pub(crate) const SLEEP: usize = 3;

impl Tally {
    /// Linear and angular momentum (about the origin), and energy, that the body got.
    #[inline]
    pub fn get(&mut self, linear: DVec3, angular: DVec3, energy: f64) {
        self.explained.linear += linear;
        self.explained.angular += angular;
        self.explained.energy += energy;
    }

    /// The most energy that any of the [`ARTEFACTS`] gave or took, J.
    #[inline]
    fn artefact(&self) -> f64 {
        self.artefacts.iter().fold(0.0, |most, energy| most.max(energy.abs()))
    }

    /// Energy that it got from one of the [`ARTEFACTS`].
    #[inline]
    pub fn get_artefact(&mut self, artefact: usize, energy: f64) {
        self.explained.energy += energy;
        self.artefacts[artefact] += energy;
    }
}

/// What a body does that contacts hold, in the present substep.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hold {
    pub path: Path,
    /// Whether its mass and its inertia are finite; and whether besides, contacts and gravity alone act on it.
    pub is_regular: bool,
    pub is_plain: bool,
    /// Whether rest capture gives something to it, too.
    pub is_captured: bool,
}

/// Way (m) and turn (rad) along which a force of contacts and its torque work, if they act evenly.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Passage {
    pub way: DVec3,
    pub turn: DVec3,
}

impl Passage {
    /// How a body moved in the mean that took so long (s) for it.
    #[inline]
    pub fn motion(&self, time: f64) -> Motion {
        let rate = 1.0 / time;
        Motion { velocity: self.way * rate, spin: self.turn * rate }
    }
}

/// How a body moves in the mean while contacts act on it: m/s, rad/s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    pub velocity: DVec3,
    pub spin: DVec3,
}

/// How forces act on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Path {
    /// Contacts do not hold it.
    #[default]
    Free,
    /// They do, evenly during the substep.
    Steady,
    /// They do, and all forces have acted at the start of the substep.
    Kicked,
}

/// The end of a step.
pub(crate) struct Closing {
    pub end: Stock,
    pub posts: Posts,
    pub gross: [f64; 3],
    pub lost: bool,
}

/// So many bodies' falls are added up at a time.
const BATCH: usize = 64;

fn add_to(sums: &mut [f64; 3], values: [f64; 3]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

impl Journal {
    /// Begins a step; what all bodies have. What they had at the end of the last one is looked up, unless somebody has been at them.
    pub fn open(&mut self, bodies: &Bodies, gravity: DVec3) -> Stock {
        let rows = bodies.states.len();
        self.lost = false;
        self.tallies.clear();
        self.tallies.resize(rows, Tally::default());
        self.falls.clear();
        self.falls.resize(rows, Fall::default());
        if self.is_known && self.gravity == gravity && self.end.len() == rows {
            std::mem::swap(&mut self.start, &mut self.end);
        } else {
            self.gravity = gravity;
            self.look(bodies);
            std::mem::swap(&mut self.start, &mut self.end);
        }
        self.is_known = false;
        self.holds.resize(rows, Hold::default());
        self.passages.resize(rows, Passage::default());
        self.captures.resize(rows, Push::default());
        self.frictions.resize(rows, Part::default());
        self.rotations.resize(rows, DQuat::IDENTITY);
        self.sum
    }

    /// Ends a step that took so long (s).
    pub fn close(&mut self, bodies: &Bodies, step: f64) -> Closing {
        let before = self.gross;
        let (fall, pulls) = self.look(bodies);
        let Momentum { linear, angular } = fall.momentum(self.gravity);
        self.posts.gravity.add(linear, angular);
        let mut closing =
            Closing { end: self.sum, posts: std::mem::take(&mut self.posts), gross: before, lost: self.lost };
        add_to(&mut closing.gross, self.gross);
        add_to(&mut closing.gross, pulls.map(|pull| pull * step));
        self.is_known = true;
        closing
    }

    /// Looks at what all bodies have now, and at what has become of them. Returns how gravity has acted on all their masses, and how it
    /// pulls at them without directions: N, N·m, and nothing.
    fn look(&mut self, bodies: &Bodies) -> (Fall, [f64; 3]) {
        let (gravity, pull) = (self.gravity, self.gravity.length());
        let (mut all, mut sum, mut gross, mut pulls) =
            (Fall::default(), Stock::default(), [0.0; 3], [0.0; 3]);
        self.most = (0, 0.0);
        self.end.clear();
        self.end.reserve(bodies.states.len());
        let bodies = bodies.states.chunks(BATCH).zip(bodies.constants.chunks(BATCH));
        let noted = self.tallies.chunks(BATCH).zip(self.falls.chunks(BATCH));
        for ((states, constants), (tallies, falls)) in bodies.zip(noted) {
            // Sums of sums are rounded less than one long one.
            let mut batch = Fall::default();
            let bodies = states.iter().zip(constants);
            for ((state, constants), (tally, fall)) in bodies.zip(tallies.iter().zip(falls)) {
                let (stock, mass) = (Stock::of(state, constants, gravity), heavy_mass(constants));
                batch += fall.of_mass(mass);
                sum += stock;
                let distance = components(state.position);
                add_to(&mut gross, stock.sizes(distance));
                let pull = mass.abs() * pull;
                add_to(&mut pulls, [pull, pull * distance, 0.0]);
                let artefact = tally.artefact();
                if artefact > self.most.1 {
                    self.most = (self.end.len(), artefact);
                }
                self.end.push(stock);
            }
            all += batch;
        }
        (self.sum, self.gross) = (sum, gross);
        (all, pulls)
    }

    /// The row whose body got most energy from an artefact in the step that is over, and what it got.
    pub fn most_artefact(&self) -> Option<(usize, &Tally)> {
        let (row, amount) = self.most;
        let tally = self.tallies.get(row).filter(|_| amount > 0.0);
        tally.map(|tally| (row, tally))
    }

    /// Row by row, what no cause explains of the step that is over.
    pub fn residuals(&self, bodies: &Bodies) -> impl Iterator<Item = Residual> {
        let rows = self.start.iter().zip(&self.end).zip(&self.tallies);
        let falls = bodies.constants.iter().zip(&self.falls);
        rows.zip(falls).map(|(((start, end), tally), (constants, fall))| {
            let Momentum { linear, angular } = fall.of_mass(heavy_mass(constants)).momentum(self.gravity);
            end.since(start) - tally.explained - Residual { linear, angular, energy: 0.0 }
        })
    }

    /// Somebody changes bodies between steps.
    pub fn forget(&mut self) {
        self.is_known = false;
    }

    /// The body of a row is no more; that of the last row gets its row.
    pub fn swap_remove(&mut self, row: usize) {
        self.lost = true;
        self.is_known = false;
        if row < self.start.len() {
            self.start.swap_remove(row);
            self.tallies.swap_remove(row);
            self.falls.swap_remove(row);
            self.holds.swap_remove(row);
        }
    }

    /// A body that had this is put to sleep: its momentum goes into the ground.
    pub fn falls_asleep(&mut self, row: usize, had: &Stock) {
        let (momentum, kinetic) = (had.momentum, had.energy.kinetic);
        self.posts.fixed.add(-momentum.linear, -momentum.angular);
        self.posts.loss_sleep += kinetic;
        if let Some(tally) = self.tallies.get_mut(row) {
            tally.get(-momentum.linear, -momentum.angular, 0.0);
            tally.get_artefact(SLEEP, -kinetic);
        }
    }
}
