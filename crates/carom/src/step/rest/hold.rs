//! What holds the bodies that rest during a substep, and the paths that this gives them.

use super::renew::{DRIFT, DRIFT_WITHIN};
use super::{Rest, Span};
use crate::bodies::Bodies;
use crate::flight::Influence;
use crate::impacts::time_of_impact::RestLaw;
use crate::math::{DVec3, rotation_from_vector};
use crate::solver::direct::Mobility;
use crate::solver::graph::Effort;
use crate::solver::lanes::Row;
use crate::step::motion::{advance, free_influence, set_pace};
use crate::step::pairs::Pairs;

/// Speeds in units of what gravity does in a substep. Velocities agree when a sweep changes them by no more than the first; where
/// they are solved directly, when nothing is further off than the second.
const AGREEMENT: f64 = 1e-3;
const EXACTNESS: f64 = 1e-5;

/// An island whose bodies move no faster than this against each other is about to rest, and worth the effort of both; in one
/// where they move faster than the second, impulses that act again must not do work.
const QUIET: f64 = 3.0;
const LIVELY: f64 = 20.0;

/// Sweeps that every contact gets in a substep, that an island in motion may take, and contacts times sweeps that one about to
/// rest may.
const SWEEPS: u32 = 2;
const IN_MOTION: u32 = 40;
const BUDGET: u32 = 40_000;

/// Share of an overlap that is pushed out at the end of a step.
const PUSH_OUT: f32 = 0.5;

/// Where the sweeps change a body's velocity by less than this share of what gravity does, the forces on it persist.
const STEADY: f64 = 0.05;

/// What rests on something with friction, goes nowhere and moves no faster than [`CAPTURED`] rest thresholds loses
/// this share of its speed in a second, fading out towards that speed. Rolling has no friction of its own: without it a ball would roll about
/// a pile, or rock in a hollow of it, for ever at a speed that gravity and the substep hardly tell from rest.
const RESISTANCE: f64 = 2.0;
const CAPTURED: f64 = 8.0;

/// A body rests on something if contacts push it by more than this share of what gravity does. It goes nowhere if its velocity
/// changes by no more than the second, so that what starts to roll down a slope does so freely; or if for so long (s) it has stayed
/// where any such start would have taken it away from.
const SUPPORTED: f64 = 0.5;
const DRIVEN: f64 = 0.01;
const LINGERED: f64 = 1.0;

/// What a substep gives to a body that contacts leave alone.
struct Gain {
    /// Velocity (m/s) and angular momentum (N·m·s).
    free: [DVec3; 2],
    /// The velocity that it would end with.
    velocity: Row,
}

impl Rest {
    /// Finds what holds the bodies that rest on something during `span`, and gives them their paths; returns the rows whose
    /// paths are new.
    pub fn hold(&mut self, bodies: &mut Bodies, pairs: &mut Pairs, law: RestLaw, span: Span) -> Vec<usize> {
        let held = self.rows.held().to_vec();
        for &row in &held {
            advance(bodies, row, span.from);
        }
        let mut freed = Vec::new();
        let limit = if span.from == 0.0 { DRIFT } else { DRIFT_WITHIN };
        self.renew_moved(bodies, pairs, &held, (law, span, limit));
        self.graph.measure(&self.rows.drifts);
        self.let_part(pairs);
        for row in held.into_iter().filter(|&row| !self.rows.is_held(row)) {
            if !bodies.is_asleep(row) {
                bodies.influences[row] = free_influence(bodies, row, law.gravity);
                set_pace(bodies, row, law.step);
                freed.push(row);
            }
        }
        let mut rerouted = self.push(bodies, pairs, (law, span));
        rerouted.append(&mut freed);
        rerouted
    }

    /// Solves, and turns the velocities found into paths.
    fn push(&mut self, bodies: &mut Bodies, pairs: &Pairs, (law, span): (RestLaw, Span)) -> Vec<usize> {
        let substep = span.until - span.from;
        let is_rough = self.rough_rows(bodies.states.len(), pairs);
        let held = self.rows.held().to_vec();
        let gains: Vec<Gain> = held.iter().map(|&row| self.gain(bodies, row, (law, substep))).collect();
        let gravity = law.gravity.length() * substep;
        self.graph.begin(&mut self.rows.velocities, [law.contact_margin(), LIVELY * gravity], substep);
        let persisting: Vec<Row> = held.iter().map(|&row| self.rows.velocities[row]).collect();
        self.solve(bodies, gravity);

        for ((&row, gain), warm) in held.iter().zip(gains).zip(persisting) {
            if !bodies.constants[row].is_movable() || bodies.is_asleep(row) {
                continue;
            }
            let after = self.rows.velocities[row];
            let [linear, angular] = difference(&after, &gain.velocity);
            let inertia = bodies.constants[row].inertia(bodies.states[row].rotation);
            let mut change = [gain.free[0] + linear, gain.free[1] + inertia * angular];
            let pull = gain.free[0].length();
            let stays = self.goes_nowhere(bodies, row, (change[0].length(), pull, substep));
            if is_rough[row] && linear.length() > SUPPORTED * pull && stays {
                capture(bodies, row, &mut change, law);
            }
            let sudden = difference(&after, &warm);
            let steady = sudden[0].length().max(sudden[1].length() * bodies.grains[row]) <= STEADY * pull;
            follow(bodies, row, change, (substep, steady));
            set_pace(bodies, row, span.until);
        }
        held
    }

    /// Which bodies touch something with friction.
    fn rough_rows(&self, rows: usize, pairs: &Pairs) -> Vec<bool> {
        let mut is_rough = vec![false; rows];
        for &index in &self.resting {
            let pair = &pairs[index];
            pair.rows.into_iter().for_each(|row| is_rough[row] |= pair.surface.static_friction > 0.0);
        }
        is_rough
    }

    /// Reads the velocity that a body would have at the end of the substep if no contact pushed.
    fn gain(&mut self, bodies: &Bodies, row: usize, (law, substep): (RestLaw, f64)) -> Gain {
        let free = if bodies.is_asleep(row) {
            Influence::default()
        } else {
            free_influence(bodies, row, law.gravity)
        };
        let inverse_inertia = bodies.constants[row].inverse_inertia(bodies.states[row].rotation);
        let [velocity, momentum] = [free.acceleration * substep, free.torque * substep];
        self.rows.read_velocity(bodies, row, [velocity, inverse_inertia * momentum]);
        Gain { free: [velocity, momentum], velocity: self.rows.velocities[row] }
    }

    /// Finds impulses with which all velocities agree; `gravity` is what it does in a substep, m/s.
    fn solve(&mut self, bodies: &Bodies, gravity: f64) {
        let effort = Effort {
            agreement: (AGREEMENT * gravity).max(1e-7) as f32,
            exactness: (EXACTNESS * gravity).max(1e-7) as f32,
            quiet: (QUIET * gravity) as f32,
            sweeps: SWEEPS,
            in_motion: IN_MOTION,
            budget: BUDGET,
        };
        self.graph.solve(&mut self.rows.velocities, effort, |row| {
            let (state, constants) = (&bodies.states[row as usize], &bodies.constants[row as usize]);
            (constants.is_movable() && !bodies.is_asleep(row as usize)).then(|| Mobility {
                inverse_mass: constants.inverse_mass,
                inverse_inertia: constants.inverse_inertia(state.rotation),
            })
        });
    }

    /// Whether a body whose velocity changes by `change` (m/s) in a substep, in which what pulls it would change it by `pull`,
    /// goes nowhere.
    fn goes_nowhere(
        &mut self,
        bodies: &Bodies,
        row: usize,
        (change, pull, substep): (f64, f64, f64),
    ) -> bool {
        let haunt = 0.5 * DRIVEN * pull / substep * LINGERED * LINGERED;
        let lingers = self.rows.stay(row, bodies.states[row].position, (haunt, substep)) >= LINGERED;
        lingers || change < DRIVEN * pull
    }

    /// Pushes overlaps out, at the end of a step; velocities stay.
    pub fn push_out(&mut self, bodies: &mut Bodies, law: RestLaw) {
        let held = self.rows.held().to_vec();
        for &row in &held {
            self.rows.read_drift(bodies, row, 1.0);
            let velocity = self.rows.velocities[row].0;
            let still = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, velocity[6], velocity[7]];
            self.rows.displacements[row] = Row(still);
        }
        self.graph.measure(&self.rows.drifts);
        let allowed = law.overlap_left() as f32;
        if !self.graph.push_out(&mut self.rows.displacements, PUSH_OUT, allowed) {
            return;
        }
        for &row in &held {
            let [linear, angular] = difference(&self.rows.displacements[row], &Row::ZERO);
            if linear != DVec3::ZERO || angular != DVec3::ZERO {
                let state = &mut bodies.states[row];
                state.position += linear;
                state.rotation = (rotation_from_vector(angular) * state.rotation).normalize();
                bodies.ways[row].0 += linear.length();
                bodies.ways[row].1 += angular.length();
            }
        }
    }
}

fn difference(after: &Row, before: &Row) -> [DVec3; 2] {
    let change = |index: usize| f64::from(after.0[index] - before.0[index]);
    [DVec3::new(change(0), change(1), change(2)), DVec3::new(change(3), change(4), change(5))]
}

/// Rest capture: takes a little of what a supported body has near the rest threshold. Vanishes without gravity.
fn capture(bodies: &Bodies, row: usize, change: &mut [DVec3; 2], law: RestLaw) {
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    let (velocity, momentum) = (state.velocity + change[0], state.angular_momentum + change[1]);
    let spin = constants.inverse_inertia(state.rotation) * momentum;
    let share = |speed: f64| {
        let slowness = 1.0 - speed / (CAPTURED * law.rest_speed());
        RESISTANCE * law.substep * slowness.max(0.0)
    };
    change[0] -= share(velocity.length()) * velocity;
    change[1] -= share(spin.length() * bodies.grains[row]) * momentum;
}

/// Sets a body on its path for a substep in which its velocity and angular momentum get `change`d: a parabola where the forces
/// persist, so that what slides or rolls gets the distance right; else with the new velocity from the start, as what meets
/// an obstacle must not go on into it for half a substep.
fn follow(bodies: &mut Bodies, row: usize, change: [DVec3; 2], (substep, steady): (f64, bool)) {
    let state = &mut bodies.states[row];
    bodies.influences[row] = if steady {
        Influence { acceleration: change[0] / substep, torque: change[1] / substep }
    } else {
        state.velocity += change[0];
        state.angular_momentum += change[1];
        Influence::default()
    };
}
