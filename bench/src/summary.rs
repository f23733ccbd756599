//! What the rounds of one engine come to.

use crate::quality::quantile;
use crate::worker::Measurement;
use serde::{Deserialize, Serialize};

/// Times are ms a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Summary {
    /// The least of the rounds' means: what disturbs a machine only ever makes a round slower.
    pub least: f64,
    /// Over all steps of all rounds.
    pub mean: f64,
    /// Likewise.
    pub median: f64,
    /// What 99 in 100 steps of all rounds did not exceed.
    pub p99: f64,
    /// CPU time of all threads, the least of the rounds' means.
    pub cpu: f64,
    /// Peak memory of the process, MiB, the largest of the rounds'.
    pub memory_peak: f64,
    /// The part of it that came with the engine's world, MiB.
    pub memory_own: f64,
    /// How much longer it takes than the engine it is compared with; `None` if either did not do all steps.
    pub ratio: Option<Ratio>,
    /// Whether all rounds ended with the same bits.
    pub repeats: bool,
    /// Steps done in the shortest round, and asked for.
    pub steps: (usize, usize),
}

/// A ratio of times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ratio {
    /// Of the least means of all rounds.
    pub least: f64,
    /// The smallest of the ratios of two means from the same round.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl Summary {
    /// Whether every round did all the steps that were asked for.
    pub fn whole(&self) -> bool {
        self.steps.0 == self.steps.1
    }

    /// Sums up rounds, given with their numbers, against those of a `reference`; `None` if not a step was done.
    pub fn of(rounds: &[(usize, Measurement)], reference: &[(usize, Measurement)]) -> Option<Self> {
        let measured = || rounds.iter().map(|(_, measurement)| measurement);
        let mut times: Vec<f64> = measured().flat_map(|m| m.step_ms.iter().copied()).collect();
        if measured().any(|m| m.step_ms.is_empty()) || times.is_empty() {
            return None;
        }
        let largest = |value: fn(&Measurement) -> f64| measured().map(value).fold(0.0, f64::max);
        let least = |value: fn(&Measurement) -> f64| measured().map(value).fold(f64::INFINITY, f64::min);
        let hash = |m: &Measurement| m.quality.hash.clone();
        Some(Self {
            least: least(mean),
            mean: times.iter().sum::<f64>() / times.len() as f64,
            median: quantile(&mut times, 0.5),
            p99: quantile(&mut times, 0.99),
            cpu: least(|m| m.cpu_ms / m.step_ms.len() as f64),
            memory_peak: largest(|m| m.memory_peak),
            memory_own: largest(|m| m.memory_peak - m.memory_before),
            ratio: Ratio::of(rounds, reference),
            repeats: measured().map(hash).all(|found| found == hash(&rounds[0].1)),
            steps: (measured().map(|m| m.step_ms.len()).min()?, rounds[0].1.steps),
        })
    }
}

impl Ratio {
    fn of(rounds: &[(usize, Measurement)], reference: &[(usize, Measurement)]) -> Option<Self> {
        let whole = |(_, m): &(usize, Measurement)| m.step_ms.len() == m.steps;
        if !rounds.iter().chain(reference).all(whole) {
            return None;
        }
        let least = |of: &[(usize, Measurement)]| of.iter().map(|(_, m)| mean(m)).reduce(f64::min);
        let same_round = |round: usize| reference.iter().find(|(number, _)| *number == round);
        let ratios = || rounds.iter().filter_map(|(n, m)| Some(mean(m) / mean(&same_round(*n)?.1)));
        Some(Self {
            least: least(rounds)? / least(reference)?,
            low: ratios().reduce(f64::min)?,
            high: ratios().reduce(f64::max)?,
        })
    }
}

/// The mean time of a round's steps, ms.
fn mean(measurement: &Measurement) -> f64 {
    measurement.step_ms.iter().sum::<f64>() / measurement.step_ms.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::measurement;

    #[test]
    fn means_ratios_and_their_spread() {
        let reference = [(0, measurement(&[1.0, 3.0], 2, "a")), (1, measurement(&[1.0, 1.0], 2, "a"))];
        let rounds = [(0, measurement(&[4.0, 4.0], 2, "b")), (1, measurement(&[3.0, 3.0], 2, "c"))];
        let own = Summary::of(&reference, &reference).unwrap();
        assert_eq!((own.least, own.mean, own.median, own.p99, own.cpu), (1.0, 1.5, 1.0, 3.0, 2.0));
        assert_eq!(own.ratio, Some(Ratio { least: 1.0, low: 1.0, high: 1.0 }));
        assert!(own.repeats);
        let other = Summary::of(&rounds, &reference).unwrap();
        assert_eq!(other.ratio, Some(Ratio { least: 3.0, low: 2.0, high: 3.0 }));
        assert!(!other.repeats);
        assert_eq!((other.memory_peak, other.memory_own), (10.0, 6.0));
    }

    #[test]
    fn a_run_that_was_cut_short_has_no_ratio() {
        let whole = [(0, measurement(&[1.0, 1.0], 2, "a"))];
        let cut = [(0, measurement(&[1.0], 2, "a"))];
        let summary = Summary::of(&cut, &whole).unwrap();
        assert_eq!((summary.ratio, summary.steps), (None, (1, 2)));
        assert_eq!(Summary::of(&whole, &cut).unwrap().ratio, None);
        assert!(Summary::of(&[], &whole).is_none());
    }
}
