//! An audit of collisions and steps that works from poses, masses, shapes and materials of its own.
//!
//! From the record of a collision it takes who struck whom, when and where, the poses, the velocities before and after, and the
//! impulse; mass, inertia, lever arm, normal, C_r and friction it finds again by itself. The record is not believed either: each
//! body is followed from the step's start through its collisions to the step's end, and must have flown in between, unless something
//! touched it that could push it so.
//!
//! ```text
//! strike.rs   one contact of a collision          round.rs    all that was struck at once
//! motion.rs   a body's course through a step      rest.rs     what contacts that rest did to it
//! near.rs     who came near whom                  record.rs   touches that are missing from the record
//! law.rs      the laws                            cone.rs     what pushes can explain
//!                                                 group.rs    bodies that rest on each other, together
//! ```

mod cone;
mod group;
mod law;
mod motion;
mod near;
mod record;
mod rest;
mod round;
mod strike;
#[cfg(test)]
mod tests;

pub use law::{Finding, Law, Place};

use carom::report::{Impact, rounds};
use carom::{BodyId, World};
use motion::{Snapshot, courses, snapshot};
use record::Touching;
use rest::Resting;
use round::Threshold;
use std::collections::BTreeMap;
use strike::{Strike, strike};

/// What the audit made of a step.
#[derive(Debug, Default)]
pub struct Audit {
    /// Every law that was held against something.
    pub findings: Vec<Finding>,
    /// For how many contacts the shapes gave no normal, so that the record's was believed.
    pub without_normal: u64,
}

/// Follows a world from step to step.
pub struct Auditor {
    last: Snapshot,
    time: f64,
}

impl Auditor {
    /// Begins with the present state of `world`.
    pub fn new(world: &World) -> Self {
        Self { last: snapshot(world), time: world.time() }
    }

    /// Holds the step that `world` has just made to the laws; `impacts` are its collisions.
    pub fn step(&mut self, world: &World, impacts: &[Impact]) -> Audit {
        let mut audit = Audit::default();
        let now = snapshot(world);
        let span = (self.time, world.time());
        let substep = (span.1 - span.0) / f64::from(world.settings().substeps.max(1));
        let strikes = strikes(world, impacts, &mut audit);

        let margin = 0.5 * world.settings().gravity.length() * substep * substep + 1e-6;
        let courses = courses(world, (&self.last, &now), &strikes);
        let pairs = near::pairs(world, &courses, margin);
        let resting = Resting { world, courses: &courses, pairs: &pairs, margin, substep, span };
        let held = resting.judge(&mut audit.findings);
        let touching = Touching { world, substep, margin, span, held: &held };
        record::judge(&touching, &pairs, &strikes, &mut audit.findings);
        let [left, left_afterwards] =
            [false, true].map(|afterwards| resting.left_speeds(&strikes, afterwards));
        let struck = |strike: &Strike| threshold(world, strike, substep, &left);
        collisions(impacts, &strikes, struck, &mut audit.findings);
        let afterwards = |strike: &Strike| threshold(world, strike, substep, &left_afterwards);
        round::parting(&strikes, afterwards, &mut audit.findings);

        self.time = world.time();
        self.last = now;
        audit
    }
}

fn strikes(world: &World, impacts: &[Impact], audit: &mut Audit) -> Vec<Strike> {
    let found = impacts.iter().enumerate().filter_map(|(index, impact)| strike(world, index, impact, audit));
    found.collect()
}

/// Holds the rounds of collisions to their laws.
fn collisions(
    impacts: &[Impact],
    strikes: &[Strike],
    threshold: impl Fn(&Strike) -> Threshold,
    findings: &mut Vec<Finding>,
) {
    let of_impact = |impact: usize| {
        let place = strikes.binary_search_by_key(&impact, |strike| strike.impact).ok();
        place.map(|place| &strikes[place])
    };
    for round in rounds(impacts) {
        let round: Vec<&Strike> = round.into_iter().filter_map(of_impact).collect();
        round::judge(&round, &threshold, findings);
    }
}

/// ½·g·h with the larger gravity factor of the two, and what is left to the contacts of the two bodies.
fn threshold(world: &World, strike: &Strike, substep: f64, left: &BTreeMap<[BodyId; 2], f64>) -> Threshold {
    let factor = |id: BodyId| world.description(id).map_or(0.0, |body| body.gravity_factor.abs());
    let pull = world.settings().gravity.length() * factor(strike.ids[0]).max(factor(strike.ids[1]));
    Threshold { rest: 0.5 * pull * substep, left: left.get(&strike.ids).copied().unwrap_or(0.0) }
}
