//! All engines of a case beside the fastest peer: the ratios that tables and charts show.

use crate::engine::is_peer;
use crate::rounds::{Case, Entrant};
use serde::{Deserialize, Serialize};

/// One scene with one number of threads.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Comparison {
    /// The scene's name.
    pub scene: String,
    /// How many threads stepped each world.
    pub threads: usize,
    /// Dynamic bodies.
    pub bodies: usize,
    /// Steps that were asked for.
    pub steps: usize,
    /// Whom all are compared with: the fastest peer or, where no peer did all steps, the fastest of all.
    pub reference: Option<String>,
    /// In the order of the case; whoever has no result is missing.
    pub shares: Vec<Share>,
}

/// One engine of a comparison.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Share {
    /// The engine's name.
    pub engine: String,
    /// The least of the rounds' mean times of a step, ms.
    pub ms: f64,
    /// How much longer that is than the reference's; `None` if it did not do all steps.
    pub ratio: Option<f64>,
}

impl Comparison {
    /// A comparison for each case that has a result, in their order.
    pub fn all(cases: &[Case]) -> Vec<Self> {
        cases.iter().filter_map(Self::of).collect()
    }

    fn of(case: &Case) -> Option<Self> {
        let first = case.entrants.iter().find_map(Entrant::first)?;
        let reference = reference(case);
        let shares = case.entrants.iter().filter_map(|entrant| {
            let summary = entrant.summary.as_ref()?;
            let ratio = reference.map(|(_, ms)| summary.least / ms).filter(|_| summary.whole());
            Some(Share { engine: entrant.engine.clone(), ms: summary.least, ratio })
        });
        Some(Self {
            scene: case.scene.clone(),
            threads: case.threads,
            bodies: first.bodies,
            steps: first.steps,
            reference: reference.map(|(engine, _)| engine.to_string()),
            shares: shares.collect(),
        })
    }

    /// That engine's share, if it has a result.
    pub fn share(&self, engine: &str) -> Option<&Share> {
        self.shares.iter().find(|share| share.engine == engine)
    }
}

/// The name of the engine to compare with, and its time.
fn reference(case: &Case) -> Option<(&str, f64)> {
    let times = || {
        case.entrants.iter().filter_map(|entrant| {
            let summary = entrant.summary.as_ref().filter(|summary| summary.whole())?;
            Some((entrant.engine.as_str(), summary.least))
        })
    };
    let fastest_peer = times().filter(|(engine, _)| is_peer(engine)).min_by(|a, b| a.1.total_cmp(&b.1));
    fastest_peer.or_else(|| times().min_by(|a, b| a.1.total_cmp(&b.1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::entrant;

    fn case(times: &[(&str, f64)]) -> Case {
        let entrants = times.iter().map(|(engine, ms)| entrant(engine, 9, *ms)).collect();
        Case { scene: "pile".to_string(), threads: 1, entrants }
    }

    fn ratios(case: &Case) -> Vec<Option<f64>> {
        Comparison::of(case).unwrap().shares.iter().map(|share| share.ratio).collect()
    }

    #[test]
    fn all_are_held_against_the_fastest_peer() {
        let case = case(&[("carom", 1.0), ("carom+ledger", 3.0), ("slow", 8.0), ("quick", 2.0)]);
        assert_eq!(ratios(&case), [Some(0.5), Some(1.5), Some(4.0), Some(1.0)]);
        let comparison = Comparison::of(&case).unwrap();
        assert_eq!(comparison.reference.as_deref(), Some("quick"));
        assert_eq!((comparison.bodies, comparison.share("slow").unwrap().ms), (9, 8.0));
    }

    #[test]
    fn who_was_stopped_or_failed_is_no_measure() {
        let mut case = case(&[("carom", 1.0), ("stopped", 0.5), ("failed", 1.0), ("peer", 4.0)]);
        case.entrants[1].summary.as_mut().unwrap().steps = (1, 2);
        case.entrants[2].summary = None;
        assert_eq!(ratios(&case), [Some(0.25), None, Some(1.0)]);
        assert!(Comparison::of(&case).unwrap().share("failed").is_none());
    }

    #[test]
    fn without_a_peer_the_fastest_of_all_is_the_measure() {
        assert_eq!(ratios(&case(&[("carom", 2.0), ("carom+ledger", 3.0)])), [Some(1.0), Some(1.5)]);
        assert!(Comparison::all(&[case(&[])]).is_empty());
    }
}
