//! All measurements: round by round, so that what disturbs the machine disturbs every engine, and in each round another
//! engine goes first.

use crate::arguments::Arguments;
use crate::engine::{self, DT};
use crate::machine::Machine;
use crate::scene;
use crate::summary::Summary;
use crate::worker::{Job, Measurement};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Everything that a run of the program found.
#[derive(Debug, Serialize)]
pub struct Results {
    /// What it ran on.
    pub machine: Machine,
    /// How often everything was measured.
    pub rounds: usize,
    /// Whether rest was watched for, in place of timing.
    pub settle: bool,
    /// One for each scene with each number of threads.
    pub cases: Vec<Case>,
    /// What gave no result, and why.
    pub failures: Vec<String>,
}

/// A scene with a number of threads.
#[derive(Debug, Serialize)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// How many threads stepped each world.
    pub threads: usize,
    /// In the order of [`engine::ENGINES`]; who cannot run with so many threads is not there.
    pub entrants: Vec<Entrant>,
}

/// One engine in one case.
#[derive(Debug, Serialize)]
pub struct Entrant {
    /// The engine's name.
    pub engine: &'static str,
    /// Its name and version for people.
    pub version: &'static str,
    /// Its settings, in words.
    pub settings: &'static str,
    /// What was asked of it.
    pub job: Job,
    /// What its rounds come to; `None` if there is no round.
    pub summary: Option<Summary>,
    /// Round by round. A failed round is missing.
    pub rounds: Vec<Round>,
}

/// One measurement of one engine.
#[derive(Debug, Serialize)]
pub struct Round {
    /// Which round, from 0.
    pub round: usize,
    /// What was measured.
    #[serde(flatten)]
    pub measurement: Measurement,
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
                let what = format!("round {}, {} x{}, {}", round + 1, job.scene, job.threads, job.engine);
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
    Ok(Results { machine: Machine::this(), rounds, settle: arguments.settle.is_some(), cases, failures })
}

/// Who runs what.
fn plan(arguments: &Arguments) -> Result<Vec<Case>, String> {
    let (scenes, engines) = (arguments.scenes()?, arguments.engines()?);
    let mut cases = Vec::new();
    for scene in &scenes {
        for &threads in &arguments.threads {
            let able = engines.iter().filter(|entry| threads <= entry.max_threads);
            let entrants = able.map(|entry| Entrant::new(entry, job(arguments, scene, entry, threads)));
            cases.push(Case { scene: scene.name.to_string(), threads, entrants: entrants.collect() });
        }
    }
    Ok(cases)
}

fn job(arguments: &Arguments, scene: &scene::Entry, entry: &engine::Entry, threads: usize) -> Job {
    let size = arguments.size();
    let settle = arguments.settle.map(|seconds| (seconds / DT).round().max(1.0) as usize);
    Job {
        scene: scene.name.to_string(),
        engine: entry.name.to_string(),
        threads,
        count: size.count,
        base: size.base,
        friction: arguments.friction,
        steps: settle.or(arguments.steps),
        settle: settle.is_some(),
        limit: arguments.limit,
    }
}

impl Entrant {
    fn new(entry: &engine::Entry, job: Job) -> Self {
        let engine::Entry { name, version, settings, .. } = *entry;
        Self { engine: name, version, settings, job, summary: None, rounds: Vec::new() }
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
                assert!(case.threads <= engine::find(entrant.engine).unwrap().max_threads);
                assert_eq!(
                    (entrant.job.steps, entrant.job.base, entrant.job.settle),
                    (Some(120), Some(4), true)
                );
            }
        }
    }
}
