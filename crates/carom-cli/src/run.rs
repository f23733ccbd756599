//! `carom run`, and `carom` alone.

use crate::arguments::{Arguments, Command, RunArguments, parse};
use crate::explain::Collision;
use crate::explain_text::explanation;
use crate::failure::Failure;
use crate::output::{Lines, note};
use crate::records::Records;
use crate::simulate::Simulation;
use crate::summary::{Summary, Watcher};
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

/// The scene that `carom` alone shows.
const SHOWN: &str = "off-centre-hit";

/// Simulates a scene, with a summary at the end.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let (mut simulation, mut records) = prepare(arguments)?;
    simulation.world.keep_ledger(true);
    let mut watcher = Watcher::new(&simulation.world);
    let outcome = simulation.run(|moment| {
        watcher.look(moment);
        if let Some(records) = &mut records {
            records.step(moment)?;
        }
        Ok(ControlFlow::Continue(()))
    })?;
    records.map_or(Ok(()), Records::end)?;

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

/// A simulation and what it writes step by step. Nothing is created before everything about the input is known to be good.
pub fn prepare(arguments: &RunArguments) -> Result<(Simulation, Option<Records>), Failure> {
    if arguments.bake.is_some() {
        return Err(Failure::Input("--bake: not built yet".to_owned()));
    }
    let outputs = [("--trace", &arguments.trace), ("--ledger", &arguments.ledger)];
    for (option, path) in outputs.into_iter().filter_map(|(option, path)| Some((option, path.as_ref()?))) {
        if is_same_file(path, &arguments.simulation.scene) {
            let path = path.display();
            return Err(Failure::Input(format!("{option} {path}: this is the scene; it would be lost")));
        }
    }
    if let (Some(trace), Some(ledger)) = (&arguments.trace, &arguments.ledger)
        && (trace == ledger || is_same_file(trace, ledger))
    {
        let path = trace.display();
        return Err(Failure::Input(format!("--trace and --ledger {path}: expected two different files")));
    }
    let mut simulation = Simulation::prepare(&arguments.simulation)?;
    if arguments.json {
        simulation = simulation.without_progress();
    }
    if arguments.every.is_some() && arguments.trace.is_none() && !arguments.simulation.quiet {
        note("--every has no effect without --trace");
    }
    let records = Records::begin(arguments, &mut simulation)?;
    Ok((simulation, records))
}

/// Whether two paths lead to one file that is there.
fn is_same_file(one: &Path, other: &Path) -> bool {
    one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
}

/// Shows what the program is for: one collision explained, a summary, and what to try next.
pub fn show() -> Result<ExitCode, Failure> {
    let asked = parse(["carom", "run", SHOWN].map(Into::into))?;
    let Ok(Arguments { command: Some(Command::Run(arguments)) }) = asked else {
        return Err(Failure::Other("the words `run SCENE` are no longer understood".to_owned()));
    };
    let mut simulation = Simulation::prepare(&arguments.simulation)?;
    simulation.world.keep_ledger(true);
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
