//! What can be wrong with a scene.

use carom::Invalid;
use std::io;
use thiserror::Error;

/// Why a scene could not be had. Prints as one line.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The file could not be read at all.
    #[error("{file}: {source}")]
    Unreadable {
        /// The file as it was asked for.
        file: String,
        /// What the system says.
        source: io::Error,
    },
    /// The text is no JSON.
    #[error("{file}: line {line}, column {column}: {message}")]
    Syntax {
        /// The file as it was asked for.
        file: String,
        /// Line of the text, from 1.
        line: usize,
        /// Byte of that line, from 1.
        column: usize,
        /// What the parser says.
        message: String,
    },
    /// A value that no scene can have.
    #[error("{file}: {}{}; expected {expected}", prefix(.path), cut(.value))]
    Invalid {
        /// The file as it was asked for.
        file: String,
        /// Where in the file: `bodies[3].colliders[0].shape.radius`. Empty for the file as a whole; with name and line of
        /// another file where this one names it.
        path: String,
        /// The value found, as text.
        value: String,
        /// What is allowed, with unit, and where it helps what to do.
        expected: String,
    },
    /// A body that the world refuses. Files are checked before it comes to that; this is for scenes put together
    /// in memory.
    #[error("body {body:?}: {source}")]
    Refused {
        /// The body's name.
        body: String,
        /// What is wrong with it.
        source: Invalid,
    },
}

impl SceneError {
    /// An error about the `value` at `path` of `file`, where `expected` was wanted.
    pub fn invalid(
        file: impl Into<String>,
        path: impl ToString,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        Self::Invalid {
            file: file.into(),
            path: path.to_string(),
            value: value.to_string(),
            expected: expected.into(),
        }
    }
}

fn prefix(path: &str) -> String {
    if path.is_empty() { String::new() } else { format!("{path}: ") }
}

/// How much of a value an error shows, in characters.
pub(crate) const SHOWN: usize = 60;

/// `text`, or its beginning and an ellipsis where it is longer than [`SHOWN`] characters.
pub(crate) fn cut(text: &str) -> String {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
