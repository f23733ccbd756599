//! Results as if they had been measured, for tests of what is made of them.

use crate::comparison::Comparison;
use crate::curve::Curve;
use crate::machine::Machine;
use crate::quality::{Energy, Motion, Overlap, Quality};
use crate::rounds::{Case, Entrant, Results, Round};
use crate::summary::Summary;
use crate::worker::{Job, Measurement};

/// A measurement of one body that was asked for `steps` steps and took so long for each it did.
pub fn measurement(step_ms: &[f64], steps: usize, hash: &str) -> Measurement {
    let quality = Quality {
        overlap: Overlap::default(),
        displacement_max: 0.0,
        escaped: 0,
        motion: Motion::default(),
        reported_speed_max: 0.0,
        energy_start: Energy::default(),
        energy_end: Energy::default(),
        hash: hash.to_string(),
    };
    Measurement {
        bodies: 1,
        steps,
        step_ms: step_ms.to_vec(),
        cpu_ms: 2.0 * step_ms.iter().sum::<f64>(),
        build_ms: 1.0,
        memory_before: 4.0,
        memory_peak: 10.0,
        quality,
        settling: None,
        phases: Vec::new(),
    }
}

/// An engine that took `ms` for one step with so many bodies.
pub fn entrant(engine: &str, bodies: usize, ms: f64) -> Entrant {
    let measurement = Measurement { bodies, ..measurement(&[ms], 1, "a") };
    let rounds = [(0, measurement.clone())];
    let job = Job {
        scene: String::new(),
        engine: engine.to_string(),
        threads: 1,
        count: Some(bodies),
        base: None,
        friction: None,
        steps: None,
        settle: false,
        phases: false,
        limit: 600.0,
    };
    Entrant {
        engine: engine.to_string(),
        version: format!("{engine} <1 & 2>"),
        settings: String::new(),
        job,
        summary: Summary::of(&rounds, &rounds),
        rounds: vec![Round { round: 0, measurement }],
    }
}

/// Two engines, one of which needs n^1.5, and with two threads half as long, at 100, 1,000 and 10,000 bodies.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for threads in [1, 2] {
        for bodies in [100, 1000, 10_000] {
            let n = bodies as f64;
            let entrants = [("carom", 1e-3 * n), ("peer", 1e-4 * n.powf(1.5))]
                .map(|(engine, ms)| entrant(engine, bodies, ms / threads as f64));
            cases.push(Case { scene: "pile".to_string(), threads, entrants: entrants.into() });
        }
    }
    cases
}

/// What a run with these cases found; with their curves if it `grows`.
pub fn results(cases: Vec<Case>, grows: bool) -> Results {
    let curves = if grows { Curve::all(&cases) } else { Vec::new() };
    let comparisons = Comparison::all(&cases);
    let (machine, failures) = (Machine::this(), Vec::new());
    Results { machine, rounds: 1, settle: false, cases, comparisons, curves, failures }
}
