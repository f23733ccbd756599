//! What can be asked on the command line.

use crate::failure::Failure;
use carom::math::DVec3;
use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand};
use std::ffi::OsString;
use std::path::PathBuf;

/// Simulates rigid bodies, and explains every collision.
///
/// Without a command: simulates the built-in scene `off-centre-hit` and explains its first collision.
#[derive(Debug, Parser)]
#[command(name = "carom", version, disable_help_subcommand = true)]
#[command(after_help = "\
SCENE is a file (*.json, *.gltf, *.glb) or the name of a built-in scene.
Exit status: 0 done; 1 `check` found a violation or `truth` a goal that was missed; 2 bad input or arguments; 3 anything else that failed.")]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Simulate a scene and print a summary.
    Run(RunArguments),
    /// Simulate a scene and hold every collision to the conservation laws.
    Check(RunArguments),
    /// Show the five steps of a collision with its numbers, and the three conditions.
    Explain(ExplainArguments),
    /// Measure how near the engine comes to what mechanics fixes.
    Truth(TruthArguments),
    /// List the built-in scenes.
    Scenes(ScenesArguments),
    /// Print the JSON Schema of scene files.
    Schema,
    /// Serve the studio on the loopback interface (not built yet).
    View(ViewArguments),
}

/// What is simulated, and how finely.
#[derive(Debug, Args)]
pub struct SimulationArguments {
    /// A scene file, or the name of a built-in scene.
    pub scene: PathBuf,
    /// How many steps to simulate.
    #[arg(long, value_name = "N", conflicts_with = "seconds")]
    pub steps: Option<u64>,
    /// How much time to simulate, s; seconds / dt steps, rounded [default: 10].
    #[arg(long, value_name = "T", value_parser = seconds, allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// Length of a step in place of the scene's, s, 1e-6 to 1.
    #[arg(long, value_name = "S", value_parser = step_length, allow_negative_numbers = true)]
    pub dt: Option<f64>,
    /// Substeps of a step in place of the scene's, 1 to 1000.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub substeps: Option<u32>,
    /// How many threads to use; any number gives the same, to the last bit [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub threads: Option<u32>,
    /// No progress bar and no notes on stderr.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `run` and `check`.
#[derive(Debug, Args)]
pub struct RunArguments {
    #[command(flatten)]
    pub simulation: SimulationArguments,
    /// Write positions, velocities, energy and momentum to this file, a step a line (JSON Lines).
    #[arg(long, value_name = "FILE.jsonl")]
    pub trace: Option<PathBuf>,
    /// Trace every K-th step only; the first and the last are always there [default: 1].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(1..))]
    pub every: Option<u64>,
    /// Write momentum and energy of every step to this file, with what changed them, by cause (CSV).
    #[arg(long, value_name = "FILE.csv")]
    pub ledger: Option<PathBuf>,
    /// Write the motion as an animated glTF file (not built yet).
    #[arg(long, value_name = "FILE.glb")]
    pub bake: Option<PathBuf>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct ExplainArguments {
    #[command(flatten)]
    pub simulation: SimulationArguments,
    /// Which collision of the scene, counted from 0 [default: the first].
    #[arg(long, value_name = "K")]
    pub collision: Option<u64>,
    /// The first collision between these two bodies, in either order.
    #[arg(long, num_args = 2, value_names = ["A", "B"], conflicts_with = "collision")]
    pub between: Option<Vec<String>>,
    /// The point about which angular momentum is taken, m [default: the point of collision].
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub about: Option<DVec3>,
    /// Print one JSON object on a line instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `truth`.
#[derive(Debug, Args)]
pub struct TruthArguments {
    /// Which rows to measure [default: all].
    #[arg(value_name = "ROW")]
    pub rows: Vec<String>,
    /// Print one JSON object a row instead of text.
    #[arg(long, conflicts_with = "markdown")]
    pub json: bool,
    /// Print a Markdown table instead of text.
    #[arg(long)]
    pub markdown: bool,
    /// No progress bar.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `scenes`.
#[derive(Debug, Args)]
pub struct ScenesArguments {
    /// Print one JSON list instead of text.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `view`.
#[derive(Debug, Args)]
pub struct ViewArguments {
    /// A scene file, or the name of a built-in scene.
    pub scene: Option<PathBuf>,
    /// The port to listen on.
    #[arg(long, value_name = "P")]
    pub port: Option<u16>,
    /// Don't open a browser.
    #[arg(long)]
    pub no_open: bool,
}

/// What was asked for; or, as text for the standard output, what `--help` and `--version` want.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Result<Arguments, String>, Failure> {
    match Arguments::try_parse_from(arguments) {
        Ok(arguments) => Ok(Ok(arguments)),
        Err(error) if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => {
            Ok(Err(error.to_string()))
        }
        Err(error) => Err(Failure::Input(on_one_line(&error.to_string()))),
    }
}

/// clap's report without its headline and usage.
fn on_one_line(report: &str) -> String {
    let told = report.lines().map(str::trim).filter(|line| !line.is_empty());
    let told: Vec<&str> =
        told.take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more")).collect();
    let told = told.join(" ").replace(" tip: ", "; ");
    format!("{}; see `carom --help`", told.strip_prefix("error: ").unwrap_or(&told))
}

fn seconds(text: &str) -> Result<f64, String> {
    number(text, |value| (0.0..=1e9).contains(&value), "a number of seconds, 0 to 1e9")
}

fn step_length(text: &str) -> Result<f64, String> {
    number(text, |value| (1e-6..=1.0).contains(&value), "a number of seconds, 1e-6 to 1")
}

fn number(text: &str, fits: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|&value| fits(value)).ok_or_else(|| format!("expected {expected}"))
}

fn point(text: &str) -> Result<DVec3, String> {
    let expected = || "expected three finite numbers X,Y,Z, each at most 1e9 m from 0".to_owned();
    let coordinates: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let coordinates: [f64; 3] = coordinates.and_then(|list| list.try_into().ok()).ok_or_else(expected)?;
    let near = coordinates.iter().all(|coordinate| coordinate.abs() <= 1e9);
    if near { Ok(DVec3::from_array(coordinates)) } else { Err(expected()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn parsed(line: &str) -> Result<Arguments, Failure> {
        parse(line.split_whitespace().map(OsString::from)).map(|parsed| parsed.expect("no help asked for"))
    }

    #[test]
    fn the_definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn bad_arguments_are_refused_on_one_line() {
        for line in [
            "carom fly",
            "carom run",
            "carom run a b",
            "carom run a --steps",
            "carom run a --steps -1",
            "carom run a --steps 1.5",
            "carom run a --steps 1 --seconds 1",
            "carom run a --seconds -1",
            "carom run a --seconds nan",
            "carom run a --seconds inf",
            "carom run a --dt 0",
            "carom run a --dt -0.1",
            "carom run a --dt NaN",
            "carom run a --substeps 0",
            "carom run a --threads 0",
            "carom run a --every 0",
            "carom run a --stesp 3",
            "carom explain a --collision -1",
            "carom explain a --collision 1 --between b c",
            "carom explain a --between b",
            "carom explain a --about 1,2",
            "carom explain a --about 1,2,inf",
            "carom explain a --about 1,2,3,4",
        ] {
            let Err(Failure::Input(message)) = parsed(line) else { panic!("{line}: accepted") };
            assert!(!message.contains('\n') && !message.contains("Usage"), "{line}: {message}");
        }
    }

    #[test]
    fn points_may_be_negative() {
        let Ok(Arguments { command: Some(Command::Explain(explain)) }) =
            parsed("carom explain a --about -1,2.5,-3e2")
        else {
            panic!("refused")
        };
        assert_eq!(explain.about, Some(DVec3::new(-1.0, 2.5, -300.0)));
    }

    #[test]
    fn a_slip_of_the_finger_gets_a_hint() {
        let Err(Failure::Input(message)) = parsed("carom run a --stesp 3") else { panic!("accepted") };
        assert!(message.contains("--steps"), "{message}");
    }
}
