//! What contacts that rest do, rest capture, and overlaps pushed out.
//!
//! An impulse P at a place with the moment M about a body's centre does the work `P·v̄ + M·ω̄`: exactly, if v̄ and ω̄ are the means of
//! the velocities before and after where it acts at once, and over the path where it acts evenly.

use super::journal::{CAPTURE, CORRECTION, Journal, Passage, Path};
use super::stock::Stock;
use crate::bodies::{Bodies, WORLD_ROW};
use crate::math::DVec3;
use crate::solver::graph::Wrench;

/// What contacts exert during a substep.
#[derive(Clone, Debug)]
pub(crate) struct Exerted {
    pub wrenches: Vec<Wrench>,
    /// Whether each of them bounces when it is struck faster.
    pub bounces: Vec<bool>,
    /// Row by row, what they give together: impulse, and angular impulse about the centre of mass.
    pub impulses: Vec<DVec3>,
    pub turns: Vec<DVec3>,
    /// Row by row, where the centres of mass are when the impulses act, or in the mean.
    pub centers: Vec<DVec3>,
    /// What rest capture gives: row, impulse, angular impulse.
    pub captures: Vec<(usize, [DVec3; 2])>,
    /// Length of the substep, s.
    pub time: f64,
}

/// Books what contacts have exerted in the substep that is over.
pub(crate) fn settle(bodies: &mut Bodies) {
    let Some(mut journal) = bodies.journal.take() else { return };
    if let Some(exerted) = journal.exerted.take() {
        // Before the passages of what is driven become those along which contacts worked.
        for &(row, push) in &exerted.captures {
            journal.book_capture(bodies, (row, push), &exerted);
        }
        for row in 0..exerted.impulses.len() {
            journal.book_push(bodies, row, &exerted);
        }
        journal.book_works(&exerted);
    }
    // Whoever is held in the next substep will be told so.
    let Journal { led, passages, .. } = &mut *journal;
    led.drain(..).for_each(|row| passages[row] = Passage::default());
    bodies.journal = Some(journal);
}

impl Journal {
    /// Books what all contacts together have given to the body of a row. What does not fly on a passage of its own gets one: that
    /// along which the impulses worked.
    #[inline]
    fn book_push(&mut self, bodies: &Bodies, row: usize, exerted: &Exerted) {
        let (impulse, turn, center) = (exerted.impulses[row], exerted.turns[row], exerted.centers[row]);
        let (constants, passage) = (&bodies.constants[row], &self.passages[row]);
        if passage.path != Path::Free && constants.is_regular() {
            let work = (impulse.dot(passage.way) + turn.dot(passage.turn)) * (1.0 / exerted.time);
            self.tallies[row].get(impulse, center.cross(impulse) + turn, work);
        } else if passage.path != Path::Free || (row != WORLD_ROW && !constants.is_movable()) {
            self.book_driven(bodies, row, exerted);
        } else if impulse != DVec3::ZERO || turn != DVec3::ZERO {
            // The ground, and what sleeps.
            self.posts.fixed.add(-impulse, -(center.cross(impulse) + turn));
        }
    }

    /// The same of what is kinematic, or has an infinite mass or inertia: what it does not take goes to the account of what is driven.
    fn book_driven(&mut self, bodies: &Bodies, row: usize, exerted: &Exerted) {
        let (impulse, turn, center) = (exerted.impulses[row], exerted.turns[row], exerted.centers[row]);
        let (state, constants, passage) = (&bodies.states[row], &bodies.constants[row], self.passages[row]);
        let is_led = passage.path != Path::Free;
        let rotation = if is_led { self.rotations[row] } else { state.rotation };
        let mut driven = passage;
        driven.turn += constants.driven_velocity(rotation) * exerted.time;
        if constants.inverse_mass == 0.0 {
            driven.way = state.velocity * exerted.time;
        }
        self.lead(row, driven);
        let work = (impulse.dot(driven.way) + turn.dot(driven.turn)) / exerted.time;
        if !is_led {
            self.posts.kinematic.add(-impulse, -(center.cross(impulse) + turn));
            self.posts.work_kinematic -= work;
            return;
        }
        let taken = constants.turning_part(rotation, turn);
        let (mut linear, mut kept) = (impulse, taken.dot(passage.turn) / exerted.time);
        if constants.inverse_mass > 0.0 {
            kept += impulse.dot(passage.way) / exerted.time;
        } else {
            self.posts.kinematic.add(-impulse, -center.cross(impulse));
            linear = DVec3::ZERO;
        }
        self.posts.work_kinematic -= work - kept;
        self.posts.kinematic.angular += taken - turn;
        self.tallies[row].get(linear, center.cross(linear) + taken, kept);
    }

    /// Books the work of each contact, cause by cause.
    ///
    /// The mean centre at the share s of the way d between the centres moves against itself, as a point of the one body and of the
    /// other, by `Δx_b − Δx_a − ((1 − s)·φ_b + s·φ_a) × d`, with the ways Δx of the centres and the turns φ.
    fn book_works(&mut self, exerted: &Exerted) {
        let rate = 1.0 / exerted.time;
        let [mut friction, mut contact, mut capture] = [0.0; 3];
        for (wrench, &bounces) in exerted.wrenches.iter().zip(&exerted.bounces) {
            let [a, b] = wrench.rows.map(|row| &self.passages[row]);
            let [center_a, center_b] = wrench.rows.map(|row| exerted.centers[row]);
            let turn = b.turn - a.turn;
            let mean_turn = b.turn - turn * wrench.share;
            let way = (b.way - a.way) - mean_turn.cross(center_b - center_a);
            let work = |push: [DVec3; 2]| push[0].dot(way) + push[1].dot(turn);
            friction += work(wrench.across);
            let normal = work(wrench.normal);
            if bounces {
                capture += normal;
                self.book_bounce(wrench, exerted);
            } else {
                contact += normal;
            }
        }
        self.posts.loss_friction -= friction * rate;
        self.posts.loss_contact -= contact * rate;
        self.posts.loss_rest_capture -= capture * rate;
    }

    /// Notes what a contact that would bounce does to its two bodies.
    fn book_bounce(&mut self, wrench: &Wrench, exerted: &Exerted) {
        let centers = wrench.rows.map(|row| exerted.centers[row]);
        let [impulse, moment] = wrench.normal;
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let row = wrench.rows[side];
            let passage = &self.passages[row];
            let way = passage.way + passage.turn.cross(wrench.offset(side, centers));
            let work = sign * (impulse.dot(way) + moment.dot(passage.turn)) / exerted.time;
            self.tallies[row].artefacts[CAPTURE] += work;
        }
    }

    fn book_capture(
        &mut self,
        bodies: &Bodies,
        (row, [mut impulse, turn]): (usize, [DVec3; 2]),
        at: &Exerted,
    ) {
        if bodies.constants[row].inverse_mass == 0.0 {
            impulse = DVec3::ZERO;
        }
        let (passage, tally) = (&self.passages[row], &mut self.tallies[row]);
        let work = (impulse.dot(passage.way) + turn.dot(passage.turn)) * (1.0 / at.time);
        let moment = at.centers[row].cross(impulse) + turn;
        self.posts.fixed.add(impulse, moment);
        self.posts.loss_rest_capture -= work;
        tally.get(impulse, moment, work);
        tally.artefacts[CAPTURE] += work;
    }
}

/// What the body of a row has, if there is a ledger.
pub(crate) fn stock(bodies: &Bodies, row: usize) -> Option<Stock> {
    bodies.journal.as_ref().map(|journal| Stock::of_row(bodies, row, journal.gravity))
}

/// Books what one contact does to angular momentum by pushing an overlap out (displacement times mass, kg·m): bodies that move have
/// their lines of motion moved, by what does not move, or by each other's overlap, as if from outside.
pub(crate) fn shifted(bodies: &mut Bodies, wrench: &Wrench, inverse_masses: [f64; 2]) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    let posts = &mut journal.posts;
    let shift = |side: usize| wrench.normal[0].cross(bodies.states[wrench.rows[side]].velocity);
    let mut account = |other: usize, shift: DVec3| {
        let row = wrench.rows[other];
        let is_fixed = row == WORLD_ROW || bodies.constants[row].inverse_mass > 0.0;
        let account = if is_fixed { &mut posts.fixed } else { &mut posts.kinematic };
        account.angular += shift;
    };
    match inverse_masses.map(|inverse_mass| inverse_mass > 0.0) {
        [true, true] => posts.external.angular += shift(1) - shift(0),
        [true, false] => account(1, -shift(0)),
        [false, true] => account(0, shift(1)),
        [false, false] => (),
    }
}

/// Books the energy that pushing overlaps out has given to a body that had `before`.
pub(crate) fn pushed_out(bodies: &mut Bodies, row: usize, before: &Stock) {
    let Some(mut journal) = bodies.journal.take() else { return };
    let change = Stock::of_row(bodies, row, journal.gravity).since(before);
    journal.posts.position_correction += change.energy;
    journal.tallies[row].get(change.linear, change.angular, 0.0);
    journal.tallies[row].get_artefact(CORRECTION, change.energy);
    bodies.journal = Some(journal);
}
