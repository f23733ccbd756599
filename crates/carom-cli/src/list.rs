//! `carom scenes` and `carom schema`.

use crate::arguments::ScenesArguments;
use crate::failure::Failure;
use crate::output::Lines;
use carom_scene::builtin_scenes;
use serde::Serialize;
use std::process::ExitCode;

#[derive(Serialize)]
struct Listed<'a> {
    name: &'a str,
    description: &'a str,
}

/// Lists the built-in scenes, one a line.
pub fn scenes(arguments: &ScenesArguments) -> Result<ExitCode, Failure> {
    let scenes: Vec<Listed<'_>> =
        builtin_scenes().iter().map(|&(name, description, _)| Listed { name, description }).collect();
    let mut lines = Lines::stdout();
    if arguments.json {
        lines.json(&scenes)?;
    } else {
        let width = scenes.iter().map(|scene| scene.name.chars().count()).max().unwrap_or(0);
        for Listed { name, description } in &scenes {
            lines.text(&format!("{name:<width$}  {description}"))?;
        }
    }
    lines.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Prints the JSON Schema of scene files.
pub fn schema() -> Result<ExitCode, Failure> {
    let mut lines = Lines::stdout();
    lines.text(&format!("{:#}", carom_scene::schema()))?;
    lines.finish()?;
    Ok(ExitCode::SUCCESS)
}
