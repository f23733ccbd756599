//! All measurements: round by round, so that what disturbs the machine disturbs every engine, and in each round another
//! engine goes first.

use crate::arguments::Arguments;
use crate::comparison::Comparison;
use crate::curve::Curve;
use crate::engine::{self, DT};
use crate::machine::Machine;
use crate::scene::{self, Size};
use crate::summary::Summary;
use crate::worker::{Job, Measurement};
use indicatif::{ProgressBar, ProgressStyle};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::process::Command;

/// Everything that a run of the program found.
#[derive(Debug, Serialize, Deserialize)]
pub struct Results {
    /// What it ran on.
    pub machine: Machine,
    /// How often everything was measured.
    pub rounds: usize,
    /// Whether rest was watched for, in place of timing.
    pub settle: bool,
    /// One for each scene with each number of threads, at each size.
    pub cases: Vec<Case>,
    /// All engines of each case beside the fastest peer.
    pub comparisons: Vec<Comparison>,
    /// Cost against size, where that was asked for.
    pub curves: Vec<Curve>,
    /// What gave no result, and why.
    pub failures: Vec<String>,
}

/// A scene with a number of threads.
#[derive(Debug, Serialize, Deserialize)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// How many threads stepped each world.
    pub threads: usize,
    /// In the order of [`engine::ENGINES`]; who cannot run with so many threads is not there.
    pub entrants: Vec<Entrant>,
}

/// One engine in one case.
#[derive(Debug, Serialize, Deserialize)]
pub struct Entrant {
    /// The engine's name.
    pub engine: String,
    /// Its name and version for people.
    pub version: String,
    /// Its settings, in words.
    pub settings: String,
    /// What was asked of it.
    pub job: Job,
    /// What its rounds come to; `None` if there is no round.
    pub summary: Option<Summary>,
    /// Round by round. A failed round is missing.
    pub rounds: Vec<Round>,
}

/// One measurement of one engine.
#[derive(Debug, Serialize, Deserialize)]
pub struct Round {
    /// Which round, from 0.
    pub round: usize,
    /// What was measured.
    #[serde(flatten)]
    pub measurement: Measurement,
}

impl Results {
    /// All engines, each once, in their order, with what its first case says of it.
    pub fn engines(&self) -> Vec<&Entrant> {
        let mut engines: Vec<&Entrant> = Vec::new();
        for entrant in self.cases.iter().flat_map(|case| &case.entrants) {
            if !engines.iter().any(|known| known.engine == entrant.engine) {
                engines.push(entrant);
            }
        }
        engines
    }

    /// Their names.
    pub fn engine_names(&self) -> Vec<&str> {
        self.engines().into_iter().map(|entrant| entrant.engine.as_str()).collect()
    }

    /// Drops the times of single steps, which nothing needs that has summaries.
    pub fn forget_steps(&mut self) {
        let entrants = self.cases.iter_mut().flat_map(|case| &mut case.entrants);
        entrants.flat_map(|entrant| &mut entrant.rounds).for_each(|round| round.measurement.step_ms.clear());
    }
}

/// Measures what was asked for.
pub fn run(arguments: &Arguments) -> Result<Results, String> {
    let program = std::env::current_exe().map_err(|error| format!("where this program lies: {error}"))?;
    let mut cases = plan(arguments)?;
    // Rest is a matter of the scene and the engine, not of chance: once is enough.
    let rounds = if arguments.settle.is_some() { 1 } else { arguments.rounds };
    let measurements: usize = cases.iter().map(|case| case.entrants.len() * rounds).sum();
    let progress = progress_bar(measurements as u64);
    let mut failures = Vec::new();
    for round in 0..rounds {
        for case in &mut cases {
            let n = case.entrants.len();
            for i in 0..n {
                let entrant = &mut case.entrants[(i + round) % n];
                let job = &entrant.job;
                let what = describe(round, job);
                progress.set_message(what.clone());
                match measure(&program, job) {
                    Ok(measurement) => entrant.rounds.push(Round { round, measurement }),
                    Err(reason) => failures.push(format!("{what}: {reason}")),
                }
                progress.inc(1);
            }
        }
    }
    progress.finish_and_clear();
    cases.iter_mut().for_each(Case::sum_up);
    let curves = if arguments.grows() { Curve::all(&cases) } else { Vec::new() };
    let comparisons = Comparison::all(&cases);
    let settle = arguments.settle.is_some();
    Ok(Results { machine: Machine::this(), rounds, settle, cases, comparisons, curves, failures })
}

/// A measurement for people.
fn describe(round: usize, job: &Job) -> String {
    let count = job.count.map_or(String::new(), |count| format!(" of {count}"));
    format!("round {}, {}{count} x{}, {}", round + 1, job.scene, job.threads, job.engine)
}

/// Who runs what.
fn plan(arguments: &Arguments) -> Result<Vec<Case>, String> {
    let (scenes, engines) = (arguments.scenes()?, arguments.engines()?);
    let mut cases = Vec::new();
    for scene in &scenes {
        for &threads in &arguments.threads {
            for size in arguments.sizes() {
                let job = job(arguments, scene, size, threads);
                let able = engines.iter().filter(|entry| threads <= entry.max_threads);
                let entrants = able.map(|entry| Entrant::new(entry, &job)).collect();
                cases.push(Case { scene: scene.name.to_string(), threads, entrants });
            }
        }
    }
    Ok(cases)
}

/// What is asked of every engine; who, is still open.
fn job(arguments: &Arguments, scene: &scene::Entry, size: Size, threads: usize) -> Job {
    let settle = arguments.settle.map(|seconds| (seconds / DT).round().max(1.0) as usize);
    let alike = size.count.filter(|_| arguments.grows()).map(|count| scene.steps_with(count));
    Job {
        scene: scene.name.to_string(),
        engine: String::new(),
        threads,
        count: size.count,
        base: size.base,
        friction: arguments.friction,
        steps: settle.or(arguments.steps).or(alike),
        settle: settle.is_some(),
        phases: arguments.phases,
        limit: arguments.limit,
    }
}

impl Entrant {
    fn new(entry: &engine::Entry, job: &Job) -> Self {
        let [engine, version, settings] = [entry.name, entry.version, entry.settings].map(String::from);
        let job = Job { engine: engine.clone(), ..job.clone() };
        Self { engine, version, settings, job, summary: None, rounds: Vec::new() }
    }

    /// The first measurement that there is: quality and counts are taken from it.
    pub fn first(&self) -> Option<&Measurement> {
        self.rounds.first().map(|round| &round.measurement)
    }
}

impl Case {
    /// Works out every entrant's summary; the first is what the others are compared with.
    fn sum_up(&mut self) {
        let reference: Vec<(usize, Measurement)> =
            self.entrants.first().into_iter().flat_map(|first| &first.rounds).map(Round::numbered).collect();
        for entrant in &mut self.entrants {
            let rounds: Vec<(usize, Measurement)> = entrant.rounds.iter().map(Round::numbered).collect();
            entrant.summary = Summary::of(&rounds, &reference);
        }
    }
}

impl Round {
    fn numbered(&self) -> (usize, Measurement) {
        (self.round, self.measurement.clone())
    }
}

/// Runs this program once more, as a worker.
fn measure(program: &Path, job: &Job) -> Result<Measurement, String> {
    let text = serde_json::to_string(job).map_err(|error| error.to_string())?;
    let program: PathBuf = program.into();
    let done = Command::new(program).arg("--worker").arg(text).output().map_err(|error| error.to_string())?;
    if !done.status.success() {
        let said = String::from_utf8_lossy(&done.stderr);
        let reason = said.lines().filter(|line| !line.trim().is_empty() && !line.starts_with("note:"));
        return Err(format!("{} ({})", reason.collect::<Vec<_>>().join(" "), done.status));
    }
    serde_json::from_slice(&done.stdout).map_err(|error| format!("answer: {error}"))
}

/// A bar on standard error, if that is a terminal.
fn progress_bar(length: u64) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) =
        ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} (about {eta} left)  {msg}")
    {
        bar.set_style(style);
    }
    bar.enable_steady_tick(std::time::Duration::from_secs(1));
    bar
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn every_case_has_every_engine_that_can_run_it() {
        let line = "bench --scene pyramid,pile_mixed --threads 1,2 --base 4 --settle 2";
        let arguments = Arguments::try_parse_from(line.split_whitespace()).unwrap();
        let cases = plan(&arguments).unwrap();
        assert_eq!(cases.len(), 4);
        assert_eq!(cases[0].entrants.len(), engine::ENGINES.len());
        for case in &cases {
            for entrant in &case.entrants {
                assert!(case.threads <= engine::find(&entrant.engine).unwrap().max_threads);
                assert_eq!(
                    (entrant.job.steps, entrant.job.base, entrant.job.settle),
                    (Some(120), Some(4), true)
                );
            }
        }
    }

    #[test]
    fn every_size_has_a_case_with_as_many_steps_as_show_the_same() {
        let line = "bench --scene pile_boxes,packed_boxes --sizes 100,800 --threads 1,2";
        let arguments = Arguments::try_parse_from(line.split_whitespace()).unwrap();
        let cases = plan(&arguments).unwrap();
        let asked = |case: &Case| (case.threads, case.entrants[0].job.count, case.entrants[0].job.steps);
        let pile = scene::find("pile_boxes").unwrap();
        assert_eq!(cases.len(), 8);
        assert_eq!(asked(&cases[0]), (1, Some(100), Some(pile.steps_with(100))));
        assert_eq!(asked(&cases[3]), (2, Some(800), Some(pile.steps_with(800))));
        assert_eq!(asked(&cases[5]), (1, Some(800), Some(60)));
    }
}
