//! The bodies' motion within a step: each has its own clock, and flies from one touch to the next.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::flight::{Influence, RigidState, fly};
use crate::impacts::time_of_impact::RestLaw;
use crate::math::DVec3;

/// Sets all clocks to the start of a step of `time` seconds, and what gravity and the user's forces do during it.
pub(crate) fn begin_flight(bodies: &mut Bodies, gravity: DVec3, time: f64) {
    for row in bodies.rows() {
        bodies.clocks[row] = 0.0;
        bodies.influences[row] =
            if bodies.is_asleep(row) { Influence::default() } else { free_influence(bodies, row, gravity) };
        set_pace(bodies, row, time);
    }
}

/// Bounds how fast the points of a body move until `end`; to be called whenever its path has changed.
pub(crate) fn set_pace(bodies: &mut Bodies, row: usize, end: f64) {
    let (state, constants, influence) =
        (&bodies.states[row], &bodies.constants[row], &bodies.influences[row]);
    let left = end - bodies.clocks[row];
    let linear = state.velocity.length() + influence.acceleration.length() * left;
    bodies.paces[row] = (linear, constants.spin_limit(state, influence, left));
}

/// Gravity and the user's forces on one body.
pub(crate) fn free_influence(bodies: &Bodies, row: usize, gravity: DVec3) -> Influence {
    let constants = &bodies.constants[row];
    let (force, torque) = bodies.forces[row];
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
    if row == WORLD_ROW || bodies.clocks[row] >= time {
        return;
    }
    bodies.ways[row] = bodies.way(row, time);
    bodies.states[row] = state_at(bodies, row, time);
    bodies.clocks[row] = time;
}

/// Where a body will be at `time` within the step if nothing touches it before.
pub(crate) fn state_at(bodies: &Bodies, row: usize, time: f64) -> RigidState {
    let flown = time - bodies.clocks[row];
    fly(&bodies.states[row], &bodies.constants[row], &bodies.influences[row], flown)
}

/// Lets all bodies fly from where they are to the end of the step.
pub(crate) fn finish_flight(bodies: &mut Bodies, time: f64) {
    for row in bodies.rows() {
        advance(bodies, row, time);
    }
}
