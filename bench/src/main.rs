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
//! | `comparison` | every engine beside the fastest peer |
//! | `curve` | cost against size, and its exponent |
//! | `report`, `table` | what is printed |
//! | `publication` | what README.md shows, measured in one run |
//! | `chart` | what is drawn |
//! | `file` | reading and writing |
//! | `machine` | what it ran on; CPU time and memory of this process |

mod arguments;
mod chart;
mod comparison;
mod curve;
mod engine;
mod file;
mod machine;
mod phase;
mod publication;
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
use publication::Publication;
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
    if let Some(folder) = &arguments.publish {
        return publish(&arguments, folder);
    }
    let results = match &arguments.from {
        Some(file) => file::read_json(file)?,
        None => rounds::run(&arguments)?,
    };
    print(&report::text(&results))?;
    if let Some(file) = &arguments.json {
        file::write_json(file, &results)?;
    }
    if let Some(file) = &arguments.svg {
        file::write(file, &chart::svg(&results))?;
    }
    Ok(status(results.failures.is_empty()))
}

/// Measures what README.md shows, or reads it from an earlier publication, and writes it.
fn publish(arguments: &Arguments, folder: &Path) -> Result<ExitCode, String> {
    let publication = match &arguments.from {
        Some(earlier) => Publication::read(earlier)?,
        None => Publication::measure(arguments)?,
    };
    print(&publication.text())?;
    publication.write(folder)?;
    Ok(status(publication.whole()))
}

/// The exit status of a run, in which every measurement gave a result or not.
fn status(whole: bool) -> ExitCode {
    if whole { ExitCode::SUCCESS } else { ExitCode::FAILURE }
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
