//! Overlaps are pushed out at the end of a step; velocities stay.

use super::Rest;
use super::work::{Work, copy, fill};
use crate::bodies::Bodies;
use crate::impacts::time_of_impact::RestLaw;
use crate::ledger::contacts::{pushed_out, shifted};
use crate::math::{DVec3, rotation_from_vector};
use crate::solver::graph::Limits;
use crate::solver::lanes::{Row, WRITABLE};
use crate::step::profile::{self, Phase};

/// Share of an overlap that is pushed out at the end of a step.
const PUSH_OUT: f32 = 0.5;

/// What is pushed out is pushed until less than this share of the overlap that may stay is left: else what lies would come near that limit
/// and never below, and all contacts of a pile be swept for nanometres in each step.
const LEFT: f64 = 0.75;

impl Rest {
    /// Pushes overlaps out. What a contact does to one of two bodies that move, it does to the other one in the opposite direction:
    /// their common centre of mass stays. Bodies that pass each other get their lines of motion moved apart, which changes their angular
    /// momentum about any point; to give that to their spins would be a blow that nobody has struck.
    pub fn push_out(&mut self, bodies: &mut Bodies, law: RestLaw) {
        let _phase = profile::phase(Phase::PushOut);
        let mut work = std::mem::take(&mut self.work);
        copy(&mut work.rows, self.rows.held());
        // In the room that substeps have velocities in, and laid out like these; m, rad.
        let mut displacements = std::mem::take(&mut work.unpushed);
        fill(&mut displacements, bodies.states.len(), Row::ZERO);
        for &row in &work.rows {
            self.rows.read_drift(bodies, row);
            let moves = bodies.constants[row].is_movable() && !bodies.is_asleep(row);
            let inverse_mass = if moves { bodies.constants[row].inverse_mass as f32 } else { 0.0 };
            let mut still = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, inverse_mass, 0.0];
            still[WRITABLE] = f32::from(moves);
            displacements[row] = Row(still);
        }
        self.graph.measure(&self.rows.drifts);
        let allowed = law.overlap_left();
        let limits = Limits { allowed: allowed as f32, left: (LEFT * allowed) as f32, share: PUSH_OUT };
        self.graph.push_out(&mut displacements, limits, &mut work.wrenches);
        if !work.wrenches.list().is_empty() {
            displace(bodies, &mut work, &displacements);
        }
        work.unpushed = displacements;
        self.work = work;
    }
}

/// Moves the bodies by what has been found.
fn displace(bodies: &mut Bodies, work: &mut Work, displacements: &[Row]) {
    // In the room that substeps have impulses in; m.
    let moves = &mut work.impulses;
    fill(moves, bodies.states.len(), DVec3::ZERO);
    for wrench in work.wrenches.list() {
        let push = wrench.impulse();
        let inverse_mass = |row: usize| {
            let moves = displacements[row].0[WRITABLE] != 0.0;
            if moves { bodies.constants[row].inverse_mass } else { 0.0 }
        };
        let inverse_masses = wrench.rows().map(inverse_mass);
        let [inverse_a, inverse_b] = inverse_masses;
        moves[wrench.rows()[0]] -= push * inverse_a;
        moves[wrench.rows()[1]] += push * inverse_b;
        shifted(bodies, wrench, inverse_masses);
    }
    for &row in &work.rows {
        let angular = displacements[row].0;
        let angular = DVec3::new(angular[3].into(), angular[4].into(), angular[5].into());
        if moves[row] != DVec3::ZERO || angular != DVec3::ZERO {
            let before = bodies.states[row];
            let state = &mut bodies.states[row];
            state.position += moves[row];
            state.rotation = (rotation_from_vector(angular) * state.rotation).normalize();
            bodies.ways[row].0 += moves[row].length();
            bodies.ways[row].1 += angular.length();
            pushed_out(bodies, row, &before);
        }
    }
}
