//! The program `carom`: what was asked, who does it, and the exit status.
//!
//! | file | what it does |
//! |---|---|
//! | `arguments` | the command line |
//! | `scenes`, `nearest` | finding the scene, guessing what was meant |
//! | `simulate`, `interrupt` | the one loop behind `run`, `check` and `explain`; Ctrl-C |
//! | `run`, `summary` | `carom run` |
//! | `records`, `trace`, `ledger` | what it writes step by step |
//! | `explain`, `explain_text`, `explain_json` | `carom explain` |
//! | `check`, `audit` | `carom check`, and the laws it knows |
//! | `truth`, `truth_table` | `carom truth`: what mechanics fixes, and how near the engine comes |
//! | `list` | `carom scenes`, `carom schema` |
//! | `output`, `text`, `failure` | whole lines, numbers for people, why something went wrong |

mod arguments;
mod audit;
mod check;
mod explain;
mod explain_json;
mod explain_table;
mod explain_text;
mod failure;
mod interrupt;
mod ledger;
mod list;
mod nearest;
mod output;
mod records;
mod run;
mod scenes;
mod simulate;
mod summary;
mod text;
mod trace;
mod truth;
mod truth_table;

use arguments::Command;
use failure::{Failure, one_line};
use output::{Lines, complain};
use std::panic::{PanicHookInfo, catch_unwind, set_hook};
use std::process::ExitCode;

fn main() -> ExitCode {
    set_hook(Box::new(|info| complain(&mistake(info))));
    match catch_unwind(dispatch) {
        Ok(Ok(status)) => status,
        Ok(Err(failure)) => end_with(&failure),
        Err(_) => ExitCode::from(3),
    }
}

fn dispatch() -> Result<ExitCode, Failure> {
    let arguments = match arguments::parse(std::env::args_os())? {
        Ok(arguments) => arguments,
        Err(help) => {
            let mut lines = Lines::stdout();
            lines.text(&help)?;
            lines.finish()?;
            return Ok(ExitCode::SUCCESS);
        }
    };
    match arguments.command {
        None => run::show(),
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        Some(Command::Explain(arguments)) => explain::explain(&arguments),
        Some(Command::Truth(arguments)) => truth::truth(&arguments),
        Some(Command::Scenes(arguments)) => list::scenes(&arguments),
        Some(Command::Schema) => list::schema(),
        Some(Command::View(_)) => Err(Failure::Input("view: not built yet".to_owned())),
    }
}

fn end_with(failure: &Failure) -> ExitCode {
    let message = failure.to_string();
    if !message.is_empty() {
        complain(&message);
    }
    if let Failure::Interrupted(signal) = failure {
        interrupt::die_of(*signal);
    }
    ExitCode::from(failure.status())
}

/// A panic on one line: a mistake of ours, never the user's.
fn mistake(info: &PanicHookInfo<'_>) -> String {
    let payload = info.payload();
    let text = payload.downcast_ref::<&str>().copied();
    let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("unknown");
    let place = info.location().map(|at| format!(" ({}:{})", at.file(), at.line())).unwrap_or_default();
    format!("carom: a mistake in the program: {}{place}; please report it", one_line(text))
}
