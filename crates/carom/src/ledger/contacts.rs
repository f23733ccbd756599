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
    /// Row by row, where the centres of mass are when the impulses act, or in the mean.
    pub centers: Vec<DVec3>,
    /// What rest capture gives: row, impulse, angular impulse.
    pub captures: Vec<(usize, [DVec3; 2])>,
    /// Length of the substep, s.
    pub time: f64,
}

/// One of the two bodies of a contact, as the contact's mean centre sees it.
#[derive(Clone, Copy)]
struct Part {
    kind: Kind,
    /// Way (m) of the mean centre as a point of the body, and turn (rad) of the body, along which impulses work.
    way: DVec3,
    turn: DVec3,
}

/// Which account an impulse goes to.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// That of a body whose mass and inertia are finite.
    Free,
    /// That of one of which something is infinite, in part.
    Odd,
    Fixed,
    Kinematic,
}

/// Books what contacts have exerted in the substep that is over.
pub(crate) fn settle(bodies: &mut Bodies) {
    let Some(mut journal) = bodies.journal.take() else { return };
    if let Some(exerted) = journal.exerted.take() {
        for (wrench, &bounces) in exerted.wrenches.iter().zip(&exerted.bounces) {
            journal.book_wrench(bodies, (wrench, bounces), &exerted);
        }
        for &(row, push) in &exerted.captures {
            journal.book_capture(bodies, (row, push), &exerted);
        }
    }
    // Whoever is held in the next substep will be told so.
    journal.passages.fill(Passage::default());
    bodies.journal = Some(journal);
}

impl Journal {
    fn book_wrench(&mut self, bodies: &Bodies, (wrench, bounces): (&Wrench, bool), exerted: &Exerted) {
        let centers = wrench.rows.map(|row| exerted.centers[row]);
        let parts = [0, 1].map(|side| self.part(bodies, wrench, (side, centers), exerted.time));
        let (way, turn) = (parts[1].way - parts[0].way, parts[1].turn - parts[0].turn);
        let rate = 1.0 / exerted.time;
        let work = |push: [DVec3; 2]| (push[0].dot(way) + push[1].dot(turn)) * rate;
        self.posts.loss_friction -= work(wrench.across);
        if bounces {
            self.posts.loss_rest_capture -= work(wrench.normal);
        } else {
            self.posts.loss_contact -= work(wrench.normal);
        }

        let [impulse, moment] = [wrench.impulse(), wrench.moment()];
        let about_origin = wrench.center(centers).cross(impulse) + moment;
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            let (part, row) = (parts[side], wrench.rows[side]);
            let work = sign * rate * (impulse.dot(part.way) + moment.dot(part.turn));
            match part.kind {
                Kind::Free => self.tallies[row].get(sign * impulse, sign * about_origin, work),
                Kind::Fixed => self.posts.fixed.add(-sign * impulse, -sign * about_origin),
                Kind::Kinematic => {
                    self.posts.kinematic.add(-sign * impulse, -sign * about_origin);
                    self.posts.work_kinematic -= work;
                }
                Kind::Odd => {
                    let turn = wrench.turn(side, [impulse, moment], centers);
                    let got = [sign * impulse, turn, centers[side]];
                    self.give_odd(bodies, row, got, (work, exerted.time));
                }
            }
            if bounces {
                let [impulse, moment] = wrench.normal;
                let gained = sign * rate * (impulse.dot(part.way) + moment.dot(part.turn));
                self.tallies[row].artefacts[CAPTURE] += gained;
            }
        }
    }

    /// How the body of one side moves while a contact's impulses act.
    fn part(
        &self,
        bodies: &Bodies,
        wrench: &Wrench,
        (side, centers): (usize, [DVec3; 2]),
        time: f64,
    ) -> Part {
        let row = wrench.rows[side];
        let (constants, passage) = (&bodies.constants[row], &self.passages[row]);
        let (kind, mut way, mut turn) = if passage.path != Path::Free {
            let kind = if constants.is_regular() { Kind::Free } else { Kind::Odd };
            (kind, passage.way, passage.turn)
        } else if row == WORLD_ROW || constants.is_movable() {
            // The ground, and what sleeps.
            return Part { kind: Kind::Fixed, way: DVec3::ZERO, turn: DVec3::ZERO };
        } else {
            (Kind::Kinematic, bodies.states[row].velocity * time, DVec3::ZERO)
        };
        if kind != Kind::Free {
            let rotation = if kind == Kind::Odd { passage.rotation } else { bodies.states[row].rotation };
            turn += constants.driven_velocity(rotation) * time;
            if constants.inverse_mass == 0.0 {
                way = bodies.states[row].velocity * time;
            }
        }
        Part { kind, way: way + turn.cross(wrench.offset(side, centers)), turn }
    }

    /// A body of which something is infinite gets an impulse at its centre and an angular impulse that do this `work`: what it does
    /// not take goes to the account of what is driven.
    fn give_odd(
        &mut self,
        bodies: &Bodies,
        row: usize,
        [impulse, turn, center]: [DVec3; 3],
        (work, time): (f64, f64),
    ) {
        let (constants, passage) = (&bodies.constants[row], self.passages[row]);
        let taken = constants.turning_part(passage.rotation, turn);
        let mut linear = impulse;
        let mut kept = taken.dot(passage.turn) / time;
        if constants.inverse_mass > 0.0 {
            kept += impulse.dot(passage.way) / time;
        } else {
            self.posts.kinematic.add(-impulse, -center.cross(impulse));
            linear = DVec3::ZERO;
        }
        self.posts.work_kinematic -= work - kept;
        self.posts.kinematic.angular += taken - turn;
        self.tallies[row].get(linear, center.cross(linear) + taken, kept);
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
        let passage = self.passages[row];
        let work = (impulse.dot(passage.way) + turn.dot(passage.turn)) / at.time;
        let moment = at.centers[row].cross(impulse) + turn;
        self.posts.fixed.add(impulse, moment);
        self.posts.loss_rest_capture -= work;
        self.tallies[row].get(impulse, moment, 0.0);
        self.tallies[row].get_artefact(CAPTURE, work);
    }
}

/// What the bodies of these rows have, if there is a ledger.
pub(crate) fn stocks(bodies: &Bodies, rows: &[usize]) -> Vec<Stock> {
    let Some(journal) = &bodies.journal else { return Vec::new() };
    rows.iter().map(|&row| Stock::of_row(bodies, row, journal.gravity)).collect()
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

/// Books the energy that pushing overlaps out has given to bodies that had these stocks.
pub(crate) fn pushed_out(bodies: &mut Bodies, rows: &[usize], before: &[Stock]) {
    let Some(mut journal) = bodies.journal.take() else { return };
    for (&row, before) in rows.iter().zip(before) {
        let change = Stock::of_row(bodies, row, journal.gravity).since(before);
        journal.posts.position_correction += change.energy;
        journal.tallies[row].get(change.linear, change.angular, 0.0);
        journal.tallies[row].get_artefact(CORRECTION, change.energy);
    }
    bodies.journal = Some(journal);
}
