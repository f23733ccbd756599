//! One measurement, in a process of its own: nobody else's memory, caches or threads are in it.

use crate::engine::{self, DT, Engine};
use crate::machine;
use crate::phase::Phase;
use crate::quality::{Judge, Pose, Poses, Quality, Settling, Watch};
use crate::scene::{self, Scene, Size};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::time::{Duration, Instant};

/// Over the steps of this long before the end speeds are watched.
const WATCHED_STEPS: usize = 60;

/// What is to be measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// The scene's name.
    pub scene: String,
    /// The engine's name.
    pub engine: String,
    /// How many threads step the world.
    pub threads: usize,
    /// Dynamic bodies, where the scene's own number does not do.
    pub count: Option<usize>,
    /// Boxes in a pyramid's lowest course, likewise.
    pub base: Option<usize>,
    /// Coulomb's coefficient, likewise.
    pub friction: Option<f32>,
    /// Steps, likewise.
    pub steps: Option<usize>,
    /// Watch for rest from the first step on.
    pub settle: bool,
    /// Ask what steps spend their time on.
    #[serde(default)]
    pub phases: bool,
    /// Stop when it takes longer than this, s.
    pub limit: f64,
}

/// What was measured.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measurement {
    /// Dynamic bodies.
    pub bodies: usize,
    /// Steps that were asked for; fewer were done if it took too long.
    pub steps: usize,
    /// Wall-clock time of every step, ms.
    pub step_ms: Vec<f64>,
    /// CPU time of all threads over all steps, ms.
    pub cpu_ms: f64,
    /// Wall-clock time to put the scene into the engine's world, ms.
    pub build_ms: f64,
    /// Peak memory of the process before there was a world, MiB.
    pub memory_before: f64,
    /// The same after the last step, MiB.
    pub memory_peak: f64,
    /// How good the result is.
    pub quality: Quality,
    /// When everything came to rest; only where rest was watched for.
    pub settling: Option<Settling>,
    /// What steps spent their time on; nothing where that was not asked or is not told.
    #[serde(default)]
    pub phases: Vec<Phase>,
}

/// Answers a job, and ends the process if a single step takes so long that the limit is never looked at.
pub fn serve(text: &str) -> Result<String, String> {
    let limit = parse(text)?.limit;
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs_f64(1.5 * limit + 30.0));
        eprintln!("one step did not end long after the limit of {limit} s");
        std::process::exit(3);
    });
    answer(text)
}

fn parse(text: &str) -> Result<Job, String> {
    serde_json::from_str(text).map_err(|error| format!("job: {error}"))
}

/// Measures what the job says, in JSON, and answers in JSON.
fn answer(text: &str) -> Result<String, String> {
    serde_json::to_string(&measure(&parse(text)?)?).map_err(|error| format!("answer: {error}"))
}

/// The job's scene.
fn scene_of(job: &Job) -> Result<Scene, String> {
    let entry = scene::find(&job.scene).ok_or_else(|| format!("no scene `{}`", job.scene))?;
    let mut scene = (entry.build)(Size { count: job.count, base: job.base });
    if let Some(friction) = job.friction {
        scene.set_friction(friction);
    }
    scene.steps = job.steps.unwrap_or(scene.steps);
    Ok(scene)
}

fn measure(job: &Job) -> Result<Measurement, String> {
    let scene = scene_of(job)?;
    let entry = engine::find(&job.engine).ok_or_else(|| format!("no engine `{}`", job.engine))?;
    let judge = Judge::new(&scene);
    let memory_before = machine::peak_memory();
    let start = Instant::now();
    let mut world = engine::load(entry, &scene, job.threads);
    let build_ms = milliseconds(start.elapsed());

    let bodies = scene.bodies.len();
    let energy_start = judge.energy(&poses(&*world, bodies), &velocities(&*world, bodies));
    let mut run = Run::new(&scene, job.settle);
    world.phases();
    while run.step_ms.len() < scene.steps && start.elapsed().as_secs_f64() < job.limit {
        run.step(&mut *world, &judge);
    }
    let memory_peak = machine::peak_memory();
    let phases = if job.phases { world.phases() } else { Vec::new() };

    let (end, velocities) = (poses(&*world, bodies), velocities(&*world, bodies));
    let quality = Quality {
        overlap: judge.overlap(&end),
        displacement_max: judge.displacement(&end),
        escaped: judge.escaped(&end),
        motion: run
            .watch
            .filter(|_| run.step_ms.len() == scene.steps)
            .map(|watch| watch.motion(&judge))
            .unwrap_or_default(),
        reported_speed_max: velocities
            .iter()
            .map(|v| v.length())
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max),
        energy_start,
        energy_end: judge.energy(&end, &velocities),
        hash: judge.hash(&end),
    };
    Ok(Measurement {
        bodies: scene.dynamic_count(),
        steps: scene.steps,
        // To a tenth of a microsecond, which the clock does not resolve.
        step_ms: run.step_ms.iter().map(|time| (time * 1e4).round() / 1e4).collect(),
        cpu_ms: run.cpu * 1e3,
        build_ms,
        memory_before,
        memory_peak,
        quality,
        settling: run.settling,
        phases,
    })
}

/// The steps, timed one by one; what is looked at between them is not.
struct Run {
    step_ms: Vec<f64>,
    /// CPU time, s.
    cpu: f64,
    /// The last second begins after this many steps.
    watch_from: usize,
    watch: Option<Watch>,
    settling: Option<Settling>,
}

impl Run {
    fn new(scene: &Scene, settle: bool) -> Self {
        Self {
            step_ms: Vec::with_capacity(scene.steps),
            cpu: 0.0,
            watch_from: scene.steps.saturating_sub(WATCHED_STEPS),
            watch: None,
            settling: settle.then(Settling::new),
        }
    }

    fn step(&mut self, world: &mut dyn Engine, judge: &Judge) {
        let done = self.step_ms.len();
        let bodies = judge.bodies();
        // A new watch where the last second begins: it knows nothing of what was before.
        if done == self.watch_from || (done == 0 && self.settling.is_some()) {
            self.watch = Some(Watch::from(poses(world, bodies)));
        }
        let (cpu, start) = (machine::cpu_time(), Instant::now());
        world.step();
        self.step_ms.push(milliseconds(start.elapsed()));
        self.cpu += machine::cpu_time() - cpu;
        if let Some(watch) = &mut self.watch {
            let fastest = watch.see(judge, poses(world, bodies), DT);
            if let Some(settling) = &mut self.settling {
                settling.see(fastest, (done + 1) as f64 * DT, DT);
            }
        }
    }
}

fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

fn poses(world: &dyn Engine, bodies: usize) -> Poses {
    let poses: Vec<Pose> = (0..bodies).map(|body| world.pose(body)).collect();
    Poses(poses)
}

fn velocities(world: &dyn Engine, bodies: usize) -> Vec<DVec3> {
    (0..bodies).map(|body| world.velocity(body)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(engine: &str) -> Job {
        Job {
            scene: "pyramid".into(),
            engine: engine.into(),
            threads: 1,
            count: None,
            base: Some(3),
            friction: None,
            steps: Some(90),
            settle: true,
            phases: false,
            limit: 60.0,
        }
    }

    #[test]
    fn a_small_pyramid_is_measured_and_rests_in_every_engine() {
        for entry in engine::ENGINES {
            let found = measure(&job(entry.name)).unwrap();
            assert_eq!((found.bodies, found.steps, found.step_ms.len()), (6, 90, 90), "{}", entry.name);
            assert!(found.step_ms.iter().all(|time| *time > 0.0) && found.cpu_ms > 0.0);
            assert!(found.quality.motion.speed_max < 0.1, "{}: {:?}", entry.name, found.quality);
            assert!(found.settling.is_some());
        }
    }

    #[test]
    fn the_last_second_is_watched_and_the_limit_is_kept() {
        let timed = measure(&Job { settle: false, ..job("carom") }).unwrap();
        assert_eq!((timed.quality.motion.steps, timed.settling), (60, None));
        let cut = measure(&Job { limit: 0.0, ..job("carom") }).unwrap();
        assert_eq!((cut.steps, cut.step_ms.len()), (90, 0));
    }

    /// A phase has the time that no phase within it has, so that together they have the time of the steps: as it was
    /// measured from outside, but for what it takes to call `step`.
    #[test]
    #[cfg(feature = "profile")]
    fn phases_come_to_the_time_of_the_steps() {
        for threads in [1, 2] {
            let job = Job { base: Some(12), threads, settle: false, phases: true, ..job("carom") };
            let found = measure(&job).unwrap();
            let told: f64 = found.phases.iter().map(|phase| phase.ms).sum();
            let steps: f64 = found.step_ms.iter().sum();
            assert!(told < steps && told > 0.95 * steps, "{told} of {steps} ms");
            assert_eq!(found.phases[0].calls, 90);
        }
        assert!(measure(&job("carom")).unwrap().phases.is_empty());
    }

    #[test]
    fn jobs_and_measurements_survive_the_way_between_processes() {
        let text = serde_json::to_string(&job("carom")).unwrap();
        let found: Measurement = serde_json::from_str(&answer(&text).unwrap()).unwrap();
        assert_eq!(found.step_ms.len(), 90);
        assert!(answer("{}").is_err());
        assert!(answer(&text.replace("pyramid", "paramid")).is_err());
        assert!(answer(&text.replace("carom", "karom")).is_err());
    }
}
