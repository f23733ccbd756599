//! What is noted while a step goes on.

use super::contacts::Exerted;
use super::flights::weight;
use super::{Posts, Residual, Stock};
use crate::bodies::Bodies;
use crate::math::{DQuat, DVec3};

/// The journal of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    pub gravity: DVec3,
    pub posts: Posts,
    /// Row by row: what each body had, what has changed it, where its path leads.
    start: Vec<Stock>,
    /// Sums of what the single bodies had at the start.
    gross: [f64; 3],
    pub tallies: Vec<Tally>,
    pub passages: Vec<Passage>,
    /// What contacts exert in the present substep.
    pub exerted: Option<Exerted>,
    /// A body was lost.
    lost: bool,
}

/// What has changed one body.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub explained: Residual,
    /// Energy that each of the [`ARTEFACTS`] gave, J.
    pub artefacts: [f64; ARTEFACTS.len()],
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
    /// Its orientation when it set out.
    pub rotation: DQuat,
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
    /// Row by row: what no cause explains, and what artefacts have done.
    pub residuals: Vec<Residual>,
    pub artefacts: Vec<[f64; ARTEFACTS.len()]>,
}

fn add_to(sums: &mut [f64; 3], values: [f64; 3]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}

impl Journal {
    /// Begins a step; what all bodies have.
    pub fn open(&mut self, bodies: &Bodies, gravity: DVec3) -> Stock {
        let rows = bodies.states.len();
        self.gravity = gravity;
        self.lost = false;
        self.start.clear();
        self.start.extend((0..rows).map(|row| Stock::of_row(bodies, row, gravity)));
        self.tallies.clear();
        self.tallies.resize(rows, Tally::default());
        self.passages.clear();
        self.passages.resize(rows, Passage::default());
        let mut all = Stock::default();
        self.gross = [0.0; 3];
        for (row, stock) in self.start.iter().enumerate() {
            all += *stock;
            add_to(&mut self.gross, stock.sizes(bodies.states[row].position));
        }
        all
    }

    /// Ends a step that took so long (s).
    pub fn close(&mut self, bodies: &Bodies, step: f64) -> Closing {
        let mut closing = Closing {
            end: Stock::default(),
            posts: std::mem::take(&mut self.posts),
            gross: self.gross,
            lost: self.lost,
            residuals: Vec::with_capacity(self.start.len()),
            artefacts: self.tallies.iter().map(|tally| tally.artefacts).collect(),
        };
        for (row, (start, tally)) in self.start.iter().zip(&self.tallies).enumerate() {
            let end = Stock::of_row(bodies, row, self.gravity);
            closing.end += end;
            let position = bodies.states[row].position;
            let pull = weight(&bodies.constants[row], self.gravity).length() * step;
            add_to(&mut closing.gross, end.sizes(position));
            add_to(&mut closing.gross, [pull, pull * position.length(), 0.0]);
            closing.residuals.push(end.since(start) - tally.explained);
        }
        closing
    }

    /// The body of a row is no more; that of the last row gets its row.
    pub fn swap_remove(&mut self, row: usize) {
        self.lost = true;
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
