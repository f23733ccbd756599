//! The one loop behind `run`, `check` and `explain`.

use crate::arguments::SimulationArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::output::{note, progress_bar};
use crate::scenes;
use carom::report::Impact;
use carom::{BodyId, World};
use indicatif::ProgressBar;
use std::io::IsTerminal;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Simulated where the arguments say neither steps nor seconds, s.
const DEFAULT_SECONDS: f64 = 10.0;

/// How many threads can run at once here.
fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |cores| u32::try_from(cores.get()).unwrap_or(u32::MAX))
}

/// A scene that is ready to run.
pub struct Simulation {
    /// What the scene is called.
    pub scene: String,
    /// Its world.
    pub world: World,
    /// Its bodies, in the scene's order.
    pub bodies: Vec<BodyId>,
    /// Length of a step, s.
    pub dt: f64,
    /// How many steps there are to do.
    pub n_steps: u64,
    progress: bool,
}

/// The simulation at the end of a step.
pub struct Moment<'a> {
    /// Steps done.
    pub step: u64,
    /// The world after them.
    pub world: &'a World,
    /// The collisions of this step.
    pub impacts: &'a [Impact],
    /// How many collisions there were before this step.
    pub impacts_before: u64,
    /// How many pairs of bodies touch.
    pub contacts: usize,
}

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Steps done.
    pub steps: u64,
    /// Time spent in them, without what the watchers did.
    pub wall_time: Duration,
    /// Collisions.
    pub collisions: u64,
    /// Pairs of bodies that touch at the end.
    pub contacts: usize,
}

impl Simulation {
    /// Loads the scene and applies what the arguments say otherwise. Writes nothing but notes.
    pub fn prepare(arguments: &SimulationArguments) -> Result<Self, Failure> {
        let mut scene = scenes::load(&arguments.scene)?;
        if let Some(substeps) = arguments.substeps {
            scene.settings.substeps = substeps;
        }
        scene.settings.threads = arguments.threads.unwrap_or_else(cores);
        let dt = arguments.dt.unwrap_or(scene.dt);
        let n_steps = arguments.steps.unwrap_or_else(|| {
            // A float too large for the type becomes its largest value.
            (arguments.seconds.unwrap_or(DEFAULT_SECONDS) / dt).round() as u64
        });
        let (name, notes) = (scene.name.clone(), scene.notes.clone());
        let (world, bodies) = scene.into_world().map_err(|error| Failure::Input(error.to_string()))?;
        if !arguments.quiet {
            notes.iter().for_each(|text| note(text));
        }
        let progress = !arguments.quiet && std::io::stderr().is_terminal();
        Ok(Self { scene: name, world, bodies, dt, n_steps, progress })
    }

    /// No progress bar, even on a terminal.
    pub fn without_progress(mut self) -> Self {
        self.progress = false;
        self
    }

    /// What reports call a body.
    pub fn name(&self, id: BodyId) -> &str {
        name_of(&self.world, id)
    }

    /// Steps to the end, or until `watch` breaks off. `watch` sees the end of every step.
    ///
    /// # Errors
    /// Those of `watch`; a wish to stop; a body that is no longer finite (its step is not shown to `watch`).
    pub fn run(
        &mut self,
        mut watch: impl FnMut(&Moment<'_>) -> Result<ControlFlow<()>, Failure>,
    ) -> Result<Outcome, Failure> {
        let bar = progress_bar(self.progress, self.n_steps, "steps");
        let outcome = self.steps(&bar, &mut watch);
        bar.finish_and_clear();
        outcome
    }

    fn steps(
        &mut self,
        bar: &ProgressBar,
        watch: &mut impl FnMut(&Moment<'_>) -> Result<ControlFlow<()>, Failure>,
    ) -> Result<Outcome, Failure> {
        let interrupt = Interrupt::listen();
        let mut outcome = Outcome::default();
        for step in 1..=self.n_steps {
            interrupt.check()?;
            let start = Instant::now();
            let report = self.world.step(self.dt);
            outcome.wall_time += start.elapsed();
            outcome.steps = step;
            outcome.contacts = report.contacts();
            let impacts = report.impacts().to_vec();
            let lost = report.quarantined().to_vec();
            if !lost.is_empty() {
                return Err(self.gone_non_finite(&lost, step));
            }
            let impacts_before = outcome.collisions;
            outcome.collisions += impacts.len() as u64;
            let moment = Moment {
                step,
                world: &self.world,
                impacts: &impacts,
                impacts_before,
                contacts: outcome.contacts,
            };
            if watch(&moment)?.is_break() {
                break;
            }
            bar.inc(1);
        }
        Ok(outcome)
    }

    fn gone_non_finite(&self, lost: &[BodyId], step: u64) -> Failure {
        let names: Vec<String> = lost.iter().map(|&id| format!("`{}`", self.name(id))).collect();
        let time = step as f64 * self.dt;
        Failure::NonFinite(format!(
            "{}: {} no longer finite after step {step} (t = {time} s) and out of the simulation",
            self.scene,
            names.join(", ")
        ))
    }
}

/// What reports call a body of `world`.
pub fn name_of(world: &World, id: BodyId) -> &str {
    world.description(id).map_or("?", |body| &body.name)
}
