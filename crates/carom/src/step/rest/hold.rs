//! What holds the bodies that rest during a substep.

use super::work::{Work, copy};
use super::{Rest, Span};
use crate::bodies::Bodies;
use crate::flight::Influence;
use crate::impacts::time_of_impact::RestLaw;
use crate::math::DVec3;
use crate::solver::direct::Mobility;
use crate::solver::graph::Effort;
use crate::solver::lanes::Row;
use crate::solver::rows::Rows;
use crate::step::motion::{advance_all, free_influence, set_pace};
use crate::step::pairs::Pairs;
use crate::step::profile::{self, Phase};

/// Speeds in units of what gravity does in a substep. Velocities agree when a sweep changes them by no more than the first; where
/// they are solved directly, when nothing is further off than the second.
const AGREEMENT: f64 = 1e-3;
const EXACTNESS: f64 = 5e-6;

/// An island whose bodies move no faster than this against each other is about to rest, and worth the effort of both;
/// where the two of a contact move faster than the second, impulses that act again must not do work.
const QUIET: f64 = 3.0;
const LIVELY: f64 = 20.0;

/// Sweeps that every contact gets in a substep, that an island in motion may take, and contacts times sweeps that one about to
/// rest may.
const SWEEPS: u32 = 2;
const IN_MOTION: u32 = 12;
const BUDGET: u32 = 40_000;

/// Where the sweeps change a body's velocity by less than this share of what gravity does, or contacts give it what they gave in the
/// substep before, be they others or not, the forces on it persist: in an island all of them or none, since what acts all the time on
/// one body cannot act at the start on the other.
const STEADY: f64 = 0.05;

impl Rest {
    /// Finds what holds the bodies that rest on something during `span`, and gives them their paths; tells the rows whose paths are new.
    pub fn hold(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        (law, span): (RestLaw, Span),
        rerouted: &mut Vec<usize>,
    ) {
        let mut work = std::mem::take(&mut self.work);
        copy(&mut work.rows, self.rows.held());
        advance_all(bodies, work.rows.iter().copied(), span.from, self.graph.pool());
        work.settle(bodies);
        if !work.rows.is_empty() {
            self.renew_moved(bodies, pairs, &work.rows, (law, span));
            self.free(bodies, law, &mut work);
            copy(&mut work.rows, self.rows.held());
            self.push(bodies, (law, span), &mut work);
            rerouted.extend_from_slice(&work.rows);
            rerouted.append(&mut work.freed);
        }
        self.work = work;
    }

    /// Lets those of the rows fly that no contact holds any more.
    fn free(&self, bodies: &mut Bodies, law: RestLaw, work: &mut Work) {
        for &row in work.rows.iter().filter(|&&row| !self.rows.is_held(row)) {
            if !bodies.is_asleep(row) {
                bodies.influences[row] = free_influence(bodies, row, law.gravity);
                set_pace(bodies, row, law.step);
                work.freed.push(row);
            }
        }
    }

    /// Solves, and gives the impulses found to the bodies.
    fn push(&mut self, bodies: &mut Bodies, (law, span): (RestLaw, Span), work: &mut Work) {
        let _phase = profile::phase(Phase::Give);
        let substep = span.until - span.from;
        work.begin(bodies.states.len());
        for &row in &work.rows {
            let [velocity, momentum] = gain(bodies, row, (law, substep));
            let spin = bodies.constants[row].free_spin(bodies.states[row].rotation, momentum);
            self.rows.read_velocity(bodies, row, [velocity, spin]);
        }
        let gravity = law.gravity.length() * substep;
        let limits = [law.contact_margin(), LIVELY * gravity];
        let velocities = &mut self.rows.velocities;
        work.unpushed.clone_from(velocities);
        self.graph.begin(&work.unpushed, velocities, limits, substep);
        work.persisting.clone_from(velocities);
        self.solve(bodies, gravity);

        for &row in &work.rows {
            let before = [&work.unpushed[row], &work.persisting[row]];
            let sudden = self.sudden_change(row, before, bodies.grains[row]);
            let [gain, _] = gain(bodies, row, (law, substep));
            let little = STEADY * STEADY * gain.length_squared();
            work.is_steady[row] = sudden <= little || !is_free(bodies, row);
        }
        self.graph.in_whole_islands(&mut work.is_steady);
        work.wrenches.begin(bodies.journal.is_some());
        self.graph.wrenches(&self.rows.velocities, &mut work.wrenches);
        self.add_up(work);
        self.give(bodies, work, (law, span));
    }

    /// How far a body of this grain (m) is from being pushed as in the substep before, squared, m²/s²: by the same contacts, or by others in
    /// their place. It had these velocities with no contact pushing, and with those that go on.
    fn sudden_change(&mut self, row: usize, [unpushed, persisting]: [&Row; 2], grain: f64) -> f64 {
        let size = |[linear, angular]: [DVec3; 2]| {
            linear.length_squared().max(angular.length_squared() * grain * grain)
        };
        let after = self.rows.velocities[row];
        let given = Row(std::array::from_fn(|k| if k < 6 { after.0[k] - unpushed.0[k] } else { 0.0 }));
        let before = std::mem::replace(&mut self.rows.given[row], given);
        size(difference(&after, persisting)).min(size(difference(&given, &before)))
    }

    /// Adds up what contacts push each body with, and how much of it by those with friction.
    fn add_up(&self, work: &mut Work) {
        for wrench in work.wrenches.list() {
            let ([a, b], impulse) = (wrench.rows(), wrench.impulse());
            work.impulses[a] -= impulse;
            work.impulses[b] += impulse;
            let rough = if self.manners[wrench.contact.index()].rubs { impulse.length() } else { 0.0 };
            for row in [a, b] {
                work.is_pushed[row] = true;
                work.rough_pushes[row] += rough;
            }
        }
    }

    /// Finds impulses with which all velocities agree; `gravity` is what it does in a substep, m/s.
    fn solve(&mut self, bodies: &Bodies, gravity: f64) {
        let _phase = profile::phase(Phase::Solve);
        let effort = Effort {
            agreement: (AGREEMENT * gravity).max(1e-7) as f32,
            exactness: (EXACTNESS * gravity).max(1e-7) as f32,
            quiet: (QUIET * gravity) as f32,
            sweeps: SWEEPS,
            in_motion: IN_MOTION,
            budget: BUDGET,
        };
        // All solvers see the inertia that the contacts were renewed with.
        let Rows { velocities, anchors, .. } = &mut self.rows;
        self.graph.solve(velocities, effort, |row| {
            let constants = &bodies.constants[row as usize];
            (constants.is_movable() && !bodies.is_asleep(row as usize)).then(|| Mobility {
                inverse_mass: constants.inverse_mass,
                inverse_inertia: constants.inverse_inertia(anchors[row as usize].rotation),
            })
        });
    }
}

/// Velocity (m/s) and angular momentum (N·m·s) that gravity and the user's forces give to a body in a substep. Told anew whenever it is
/// asked for: that takes no longer than to keep it for each body.
#[inline(always)]
pub(super) fn gain(bodies: &Bodies, row: usize, (law, substep): (RestLaw, f64)) -> [DVec3; 2] {
    let free =
        if bodies.is_asleep(row) { Influence::default() } else { free_influence(bodies, row, law.gravity) };
    [free.acceleration * substep, free.torque * substep]
}

/// Whether impulses change how the body of a row moves.
pub(super) fn is_free(bodies: &Bodies, row: usize) -> bool {
    bodies.constants[row].is_movable() && !bodies.is_asleep(row)
}

/// The velocities of a row after the sweeps against those before, m/s and rad/s.
fn difference(after: &Row, before: &Row) -> [DVec3; 2] {
    let change = |index: usize| f64::from(after.0[index] - before.0[index]);
    [DVec3::new(change(0), change(1), change(2)), DVec3::new(change(3), change(4), change(5))]
}
