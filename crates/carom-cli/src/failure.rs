//! Why a command could not do what it was asked, and the exit status that says so.

use std::fmt;
use std::io;

/// What ends a command before its time.
#[derive(Debug)]
pub enum Failure {
    /// The input or the arguments are no good. Nothing was written.
    Input(String),
    /// A body has gone non-finite.
    NonFinite(String),
    /// Anything else: an output that can't be written.
    Other(String),
    /// Whoever read the output has gone. That is their right and no error.
    ClosedPipe,
    /// The user (or the system) asked to stop, with this signal.
    Interrupted(i32),
}

impl Failure {
    /// An output named `what` that could not be written.
    pub fn output(what: &str, error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::ClosedPipe,
            _ => Failure::Other(format!("{what}: cannot be written: {error}")),
        }
    }

    /// The exit status, as the documentation promises it.
    pub fn status(&self) -> u8 {
        match self {
            Failure::ClosedPipe => 0,
            Failure::Input(_) => 2,
            Failure::NonFinite(_) | Failure::Other(_) | Failure::Interrupted(_) => 3,
        }
    }
}

/// One line, whatever the message holds.
impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Input(message) | Failure::NonFinite(message) | Failure::Other(message) => {
                write!(f, "carom: {}", one_line(message))
            }
            Failure::ClosedPipe => Ok(()),
            Failure::Interrupted(_) => write!(f, "carom: interrupted; what was written so far is whole"),
        }
    }
}

/// `text` with line breaks as spaces and other control characters (a terminal might obey them) spelled out.
pub fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for c in text.trim_end().chars() {
        match c {
            '\n' | '\r' | '\t' => line.push(' '),
            c if c.is_control() => line.extend(c.escape_unicode()),
            c => line.push(c),
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_one_line_without_control_characters() {
        let failure = Failure::Input("a\nb\u{1b}[31m\n".to_owned());
        assert_eq!(failure.to_string(), "carom: a b\\u{1b}[31m");
    }

    #[test]
    fn a_closed_pipe_is_no_failure() {
        let closed = Failure::output("stdout", &io::Error::from(io::ErrorKind::BrokenPipe));
        assert_eq!(closed.status(), 0);
        let full = Failure::output("stdout", &io::Error::from(io::ErrorKind::StorageFull));
        assert_eq!(full.status(), 3);
    }
}
