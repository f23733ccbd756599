//! `carom run`, and `carom` alone.

use crate::arguments::{Arguments, Command, RunArguments, parse};
use crate::explain::Collision;
use crate::explain_text::explanation;
use crate::failure::Failure;
use crate::output::{Lines, note};
use crate::simulate::Simulation;
use crate::summary::{Summary, Watcher};
use crate::trace::Trace;
use std::ops::ControlFlow;
use std::process::ExitCode;

/// The scene that `carom` alone shows.
const SHOWN: &str = "off-centre-hit";

/// Simulates a scene, with a summary at the end.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let (mut simulation, mut trace) = prepare(arguments)?;
    let mut watcher = Watcher::new(&simulation.world);
    let outcome = simulation.run(|moment| {
        watcher.look(moment);
        if let Some(trace) = &mut trace {
            trace.step(moment)?;
        }
        Ok(ControlFlow::Continue(()))
    })?;
    trace.map_or(Ok(()), Trace::end)?;

    let summary = Summary::new(&simulation, &outcome, watcher);
    let mut lines = Lines::stdout();
    if arguments.json {
        lines.json(&summary)?
    } else {
        lines.text(&summary.text())?
    };
    lines.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// A simulation and its trace. Nothing is created before everything about the input is known to be good.
pub fn prepare(arguments: &RunArguments) -> Result<(Simulation, Option<Trace>), Failure> {
    for (option, given) in [("--ledger", &arguments.ledger), ("--bake", &arguments.bake)] {
        if given.is_some() {
            return Err(Failure::Input(format!("{option}: not built yet")));
        }
    }
    if let Some(path) = &arguments.trace {
        let same = path
            .canonicalize()
            .is_ok_and(|path| arguments.simulation.scene.canonicalize().is_ok_and(|scene| scene == path));
        if same {
            let path = path.display();
            return Err(Failure::Input(format!("--trace {path}: this is the scene; it would be lost")));
        }
    }
    let mut simulation = Simulation::prepare(&arguments.simulation)?;
    if arguments.json {
        simulation = simulation.without_progress();
    }
    if arguments.every.is_some() && arguments.trace.is_none() && !arguments.simulation.quiet {
        note("--every has no effect without --trace");
    }
    let every = arguments.every.unwrap_or(1);
    let trace = arguments.trace.as_ref().map(|path| Trace::begin(path, &simulation, every)).transpose()?;
    Ok((simulation, trace))
}

/// Shows what the program is for: one collision explained, a summary, and what to try next.
pub fn show() -> Result<ExitCode, Failure> {
    let asked = parse(["carom", "run", SHOWN].map(Into::into))?;
    let Ok(Arguments { command: Some(Command::Run(arguments)) }) = asked else {
        return Err(Failure::Other("the words `run SCENE` are no longer understood".to_owned()));
    };
    let mut simulation = Simulation::prepare(&arguments.simulation)?;
    let mut watcher = Watcher::new(&simulation.world);
    let mut first = None;
    let outcome = simulation.run(|moment| {
        watcher.look(moment);
        if first.is_none() && !moment.impacts.is_empty() {
            first = Some(Collision::of(moment, 0));
        }
        Ok(ControlFlow::Continue(()))
    })?;

    let mut lines = Lines::stdout();
    if let Some(collision) = &first {
        lines.text(&explanation(&simulation.world, collision, &collision.conditions(None)))?;
        lines.text("\n")?;
    }
    lines.text(&Summary::new(&simulation, &outcome, watcher).text())?;
    lines.text("\nNext:")?;
    for (command, what) in [
        ("scenes", "the other built-in scenes"),
        (&format!("explain {SHOWN} --json"), "this collision as numbers"),
        (&format!("check {SHOWN}"), "every collision against the laws"),
        (&format!("run {SHOWN} --trace t.jsonl"), "where everything was, step by step"),
        ("--help", "all the rest"),
    ] {
        lines.text(&format!("  carom {command:<38}{what}"))?;
    }
    lines.finish()?;
    Ok(ExitCode::SUCCESS)
}
