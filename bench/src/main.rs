//! The program `bench`: Carom and its peers on the same scenes, speed as ratios and quality beside it.
//!
//! | file | what it does |
//! |---|---|
//! | `arguments` | the command line |
//! | `scene` | what is simulated, the same for every engine |
//! | `engine` | every engine behind one small trait |
//! | `worker` | one measurement, in a process of its own |
//! | `phase` | what an engine spends the time of its steps on |
//! | `quality` | figures from poses alone, the same code for every engine |
//! | `rounds` | all measurements, interleaved |
//! | `summary` | what the rounds of one engine come to |
//! | `curve` | cost against size, and its exponent |
//! | `report`, `table` | what is printed |
//! | `chart` | what is drawn |
//! | `machine` | what it ran on; CPU time and memory of this process |

mod arguments;
mod chart;
mod curve;
mod engine;
mod machine;
mod phase;
mod quality;
mod report;
mod rounds;
#[cfg(test)]
mod sample;
mod scene;
mod summary;
mod table;
mod worker;

use arguments::Arguments;
use clap::Parser;
use rounds::Results;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    match run() {
        Ok(status) => status,
        Err(message) => {
            eprintln!("bench: {message}");
            ExitCode::from(2)
        }
    }
}

/// Does what was asked; the status is 1 if a measurement gave no result.
fn run() -> Result<ExitCode, String> {
    let arguments = Arguments::parse();
    if let Some(job) = &arguments.worker {
        print(&worker::serve(job)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    let results = match &arguments.from {
        Some(file) => read(file)?,
        None => rounds::run(&arguments)?,
    };
    print(&report::text(&results))?;
    if let Some(file) = &arguments.json {
        let json = serde_json::to_string_pretty(&results).map_err(|error| error.to_string())?;
        write(file, &(json + "\n"))?;
    }
    if let Some(file) = &arguments.svg {
        write(file, &chart::svg(&results))?;
    }
    Ok(if results.failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What an earlier run wrote.
fn read(file: &Path) -> Result<Results, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))
}

fn write(file: &Path, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{}: {error}", file.display()))
}

/// Writes to standard output; a reader who has seen enough is no error.
fn print(text: &str) -> Result<(), String> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(format!("standard output: {error}"))
        }
        _ => Ok(()),
    }
}
