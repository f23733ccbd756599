//! What is noted while a step goes on.

use super::contacts::{Causes, Exerted, Push};
use super::{Posts, Residual, Stock};
use crate::bodies::Bodies;
use crate::math::{DQuat, DVec3};

/// The journal of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    pub gravity: DVec3,
    pub posts: Posts,
    /// Row by row: what each body had, and at the end of a step has; what has changed it, where its path leads.
    start: Vec<Stock>,
    end: Vec<Stock>,
    pub tallies: Vec<Tally>,
    pub passages: Vec<Passage>,
    /// Orientations when they set out of those of which something is infinite.
    pub rotations: Vec<DQuat>,
    /// Sums of what the bodies had at the end of the last step, with and without directions.
    sum: Stock,
    gross: [f64; 3],
    /// Whether bodies still have what they had then: nobody has been at them.
    is_known: bool,
    /// What contacts exert in the present substep.
    pub exerted: Option<Exerted>,
    /// Row by row, by which causes: nothing, where no substep is under way.
    pub causes: Vec<Causes>,
    /// Row by row, what contacts give along their normals that bounce when struck faster; empty if there are none.
    pub rebounds: Vec<Push>,
    /// A body was lost.
    lost: bool,
}

/// What has changed one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub explained: Residual,
    /// Energy that each of the [`ARTEFACTS`] gave, J.
    pub artefacts: [f64; ARTEFACTS.len()],
    /// How long gravity has acted, s, and the integral of where it did, m·s: booked at the end of the step.
    pub fall_time: f64,
    pub fall_place: DVec3,
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
    pub fn get(&mut self, linear: DVec3, angular: DVec3, energy: f64) {
        self.explained.linear += linear;
        self.explained.angular += angular;
        self.explained.energy += energy;
    }

    /// Gravity acts for so long (s) at the mean place `center`.
    pub fn falls(&mut self, center: DVec3, time: f64) {
        self.fall_time += time;
        self.fall_place += center * time;
    }

    /// Energy that it got from one of the [`ARTEFACTS`].
    pub fn get_artefact(&mut self, artefact: usize, energy: f64) {
        self.explained.energy += energy;
        self.artefacts[artefact] += energy;
    }
}

/// What a body does in the present substep.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Passage {
    pub path: Path,
    /// Way (m) and turn (rad) along which a force of contacts and its torque work, if they act evenly.
    pub way: DVec3,
    pub turn: DVec3,
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

fn add_to(sums: &mut [f64; 3], values: [f64; 3]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

impl Journal {
    /// Begins a step; what all bodies have. What they had at the end of the last one is looked up, unless somebody has been at them.
    pub fn open(&mut self, bodies: &Bodies, gravity: DVec3) -> Stock {
        let rows = bodies.states.len();
        self.lost = false;
        if self.is_known && self.gravity == gravity && self.end.len() == rows {
            std::mem::swap(&mut self.start, &mut self.end);
        } else {
            self.gravity = gravity;
            self.start.clear();
            self.start.extend((0..rows).map(|row| Stock::of_row(bodies, row, gravity)));
            (self.sum, self.gross) = (Stock::default(), [0.0; 3]);
            for (stock, state) in self.start.iter().zip(&bodies.states) {
                self.sum += *stock;
                add_to(&mut self.gross, stock.sizes(state.position));
            }
        }
        self.is_known = false;
        self.tallies.clear();
        self.tallies.resize(rows, Tally::default());
        self.passages.resize(rows, Passage::default());
        self.rotations.resize(rows, DQuat::IDENTITY);
        self.causes.resize(rows, Causes::default());
        self.sum
    }

    /// Ends a step that took so long (s).
    pub fn close(&mut self, bodies: &Bodies, step: f64) -> Closing {
        let rows = bodies.states.iter().zip(&bodies.constants);
        self.end.clear();
        self.end.extend(rows.clone().map(|(state, constants)| Stock::of(state, constants, self.gravity)));
        let (mut sum, mut gross, mut pulls) = (Stock::default(), [0.0; 3], [0.0; 3]);
        let fall = self.gravity.length() * step;
        for (stock, (state, constants)) in self.end.iter().zip(rows) {
            sum += *stock;
            let distance = state.position.length();
            add_to(&mut gross, stock.sizes_at(distance));
            if constants.inverse_mass > 0.0 {
                let pull = constants.mass() * constants.gravity_factor.abs() * fall;
                add_to(&mut pulls, [pull, pull * distance, 0.0]);
            }
        }
        let mut closing = Closing {
            end: sum,
            posts: std::mem::take(&mut self.posts),
            gross: std::mem::replace(&mut self.gross, gross),
            lost: self.lost,
        };
        add_to(&mut closing.gross, gross);
        add_to(&mut closing.gross, pulls);
        self.sum = sum;
        self.is_known = true;
        closing
    }

    /// Row by row, what no cause explains of the step that is over.
    pub fn residuals(&self) -> impl Iterator<Item = Residual> {
        let rows = self.start.iter().zip(&self.end).zip(&self.tallies);
        rows.map(|((start, end), tally)| end.since(start) - tally.explained)
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
            self.passages.swap_remove(row);
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
