//! The bodies' motion within a step: each has its own clock, and flies from one touch to the next.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::flight::{Influence, RigidState, fly, fly_center, mean_center};
use crate::impacts::time_of_impact::RestLaw;
use crate::ledger::contacts::kept_to_plan;
use crate::ledger::flights::{flown, minds_drifting};
use crate::math::DVec3;
use crate::step::pool::Pool;
use crate::step::profile::{self, Phase};

/// Sets all clocks to the start of a step of `time` seconds, and what gravity and the user's forces do during it.
pub(crate) fn begin_flight(bodies: &mut Bodies, gravity: DVec3, time: f64) {
    for row in bodies.rows() {
        bodies.clocks[row] = 0.0;
        bodies.plans[row] = None;
        bodies.influences[row] =
            if bodies.is_asleep(row) { Influence::default() } else { free_influence(bodies, row, gravity) };
        set_pace(bodies, row, time);
    }
}

/// Bounds how fast the points of a body move until `end`; to be called whenever its path has changed.
#[inline]
pub(crate) fn set_pace(bodies: &mut Bodies, row: usize, end: f64) {
    let (state, constants, influence) =
        (&bodies.states[row], &bodies.constants[row], &bodies.influences[row]);
    let left = end - bodies.clocks[row];
    let linear = state.velocity.length() + influence.acceleration.length() * left;
    bodies.paces[row] = (linear, constants.spin_limit(state, influence, left));
    bodies.courses[row] = bodies.courses[row].wrapping_add(1);
}

/// Gravity and the user's forces on one body.
#[inline]
pub(crate) fn free_influence(bodies: &Bodies, row: usize, gravity: DVec3) -> Influence {
    let constants = &bodies.constants[row];
    let (force, torque) = bodies.forces.of(row);
    let torque = if constants.is_movable() { torque } else { DVec3::ZERO };
    Influence { acceleration: gravity * constants.gravity_factor + force * constants.inverse_mass, torque }
}

/// Wakes the body of a row at `time` within the step if it sleeps, and gives gravity back to it.
pub(crate) fn rouse(bodies: &mut Bodies, row: usize, law: RestLaw, time: f64) {
    if bodies.wake(row) {
        bodies.ways[row] = bodies.way(row, time);
        bodies.clocks[row] = time;
        bodies.influences[row] = free_influence(bodies, row, law.gravity);
        set_pace(bodies, row, law.step);
    }
}

/// Advances one body along its flight to `time` within the step.
pub(crate) fn advance(bodies: &mut Bodies, row: usize, time: f64) {
    if is_behind(bodies, row, time) && !drift(bodies, row, time) {
        arrive(bodies, row, &state_at(bodies, row, time), time);
    }
}

/// Advances a body that is behind if it does nothing but go straight on; else false, and it stays where it is.
fn drift(bodies: &mut Bodies, row: usize, time: f64) -> bool {
    let drifts = bodies.constants[row].drifts(&bodies.states[row], &bodies.influences[row]);
    if !drifts || bodies.plans[row].is_some() || minds_drifting(bodies, row) {
        return false;
    }
    bodies.ways[row] = bodies.way(row, time);
    let flown = time - bodies.clocks[row];
    let state = &mut bodies.states[row];
    state.position += state.velocity * flown;
    bodies.clocks[row] = time;
    true
}

/// The same for many; those that take some computing are shared out among the threads of `pool`.
pub(crate) fn advance_all(
    bodies: &mut Bodies,
    rows: impl ExactSizeIterator<Item = usize>,
    time: f64,
    pool: &Pool,
) {
    let _phase = profile::phase(Phase::Fly);
    if !pool.shares(rows.len(), FLIGHTS) {
        return rows.for_each(|row| advance(bodies, row, time));
    }
    let rows: Vec<usize> =
        rows.filter(|&row| is_behind(bodies, row, time) && !drift(bodies, row, time)).collect();
    let states = pool.map(&rows, FLIGHTS, |&row| state_at(bodies, row, time));
    for (row, state) in rows.into_iter().zip(states) {
        arrive(bodies, row, &state, time);
    }
}

/// Flights that are worth a thread's while.
const FLIGHTS: usize = 512;

fn is_behind(bodies: &Bodies, row: usize, time: f64) -> bool {
    row != WORLD_ROW && bodies.clocks[row] < time
}

/// A body has got to `state` at `time`.
#[inline]
fn arrive(bodies: &mut Bodies, row: usize, state: &RigidState, time: f64) {
    bodies.ways[row] = bodies.way(row, time);
    if bodies.journal.is_none() && bodies.plans[row].is_none() {
        bodies.states[row] = *state;
    } else {
        flown(bodies, row, state, time - bodies.clocks[row]);
        let before = std::mem::replace(&mut bodies.states[row], *state);
        keep_to_plan(bodies, row, &before, time);
    }
    bodies.clocks[row] = time;
}

/// What contacts exert evenly during a substep, at places that hold for the path on which the body was then. A collision may
/// take it off this path; the force goes on acting where it was, as it does on the other body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    /// N
    force: DVec3,
    /// Where and how fast the body was at the start of its path, and its time within the step, s.
    position: DVec3,
    velocity: DVec3,
    from: f64,
    until: f64,
    /// How far off its path it has been so far, times how long, m·s.
    stray: DVec3,
}

impl Plan {
    /// A force on a body that is now in this state; none if nothing pushes it along.
    pub fn of(force: DVec3, state: &RigidState, (from, until): (f64, f64)) -> Option<Self> {
        let (position, velocity) = (state.position, state.velocity);
        let pushes = force.is_finite() && force != DVec3::ZERO;
        pushes.then_some(Self { force, position, velocity, from, until, stray: DVec3::ZERO })
    }
}

/// A path ends at the end of its substep, which may round differently from that of its step.
const ROUNDING: f64 = 1e-9;

/// Notes how far a body that has got from the state `before` to its own by `time` was off its path meanwhile. At the end of that path, its
/// angular momentum gets what the force did by acting at a place that had moved against the body.
fn keep_to_plan(bodies: &mut Bodies, row: usize, before: &RigidState, time: f64) {
    let Some(plan) = &mut bodies.plans[row] else { return };
    let (clock, constants, influence) = (bodies.clocks[row], &bodies.constants[row], &bodies.influences[row]);
    if clock > plan.from || before.velocity != plan.velocity {
        let start = RigidState { position: plan.position, velocity: plan.velocity, ..*before };
        let (position, velocity) = fly_center(&start, constants, influence, clock - plan.from);
        let planned = RigidState { position, velocity, ..*before };
        let flown = time - clock;
        let mean = |state: &RigidState| mean_center(state, constants, influence, flown);
        plan.stray += (mean(before) - mean(&planned)) * flown;
    }
    if plan.until - time <= ROUNDING * (plan.until - plan.from) {
        let wanted = plan.force.cross(plan.stray);
        let turn = constants.turning_part(bodies.states[row].rotation, wanted);
        bodies.states[row].angular_momentum += turn;
        bodies.plans[row] = None;
        kept_to_plan(bodies, row, [turn, wanted]);
    }
}

/// Where a body will be at `time` within the step if nothing touches it before.
#[inline]
pub(crate) fn state_at(bodies: &Bodies, row: usize, time: f64) -> RigidState {
    let flown = time - bodies.clocks[row];
    fly(&bodies.states[row], &bodies.constants[row], &bodies.influences[row], flown)
}

/// Lets all bodies fly from where they are to the end of the step.
pub(crate) fn finish_flight(bodies: &mut Bodies, time: f64, pool: &Pool) {
    let rows = bodies.rows();
    advance_all(bodies, rows, time, pool);
}
