//! Files, with errors that name them.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// What an earlier run wrote.
pub fn read_json<T: DeserializeOwned>(file: &Path) -> Result<T, String> {
    let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
    serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))
}

/// Writes a value for programs, and for people who look closely.
pub fn write_json<T: Serialize>(file: &Path, value: &T) -> Result<(), String> {
    let json = serde_json::to_string_pretty(value).map_err(|error| error.to_string())?;
    write(file, &(json + "\n"))
}

/// Writes a text.
pub fn write(file: &Path, text: &str) -> Result<(), String> {
    std::fs::write(file, text).map_err(|error| format!("{}: {error}", file.display()))
}
