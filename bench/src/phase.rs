//! What an engine spends the time of its steps on.

use serde::{Deserialize, Serialize};

/// A part of steps, over all steps of a measurement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Phase {
    /// What it does, for people.
    pub name: String,
    /// Wall-clock time of the stepping thread, without the phases that this one called, ms.
    pub ms: f64,
    /// How often it began.
    pub calls: u64,
}

impl Phase {
    /// The phases of several measurements of one engine as if these had been one.
    pub fn sum<'a>(measurements: impl Iterator<Item = &'a [Phase]>) -> Vec<Self> {
        let mut sum: Vec<Self> = Vec::new();
        for phase in measurements.flatten() {
            match sum.iter_mut().find(|it| it.name == phase.name) {
                Some(it) => (it.ms, it.calls) = (it.ms + phase.ms, it.calls + phase.calls),
                None => sum.push(phase.clone()),
            }
        }
        sum
    }
}
