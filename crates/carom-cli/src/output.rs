//! Everything that is written, in whole lines.
//!
//! A reader that goes away ends the program quietly ([`Failure::ClosedPipe`]), and whatever ends it, no file is left
//! with half a line: lines are gathered, and several whole ones handed over at once.

use crate::failure::{Failure, one_line};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

/// How many bytes are gathered before they are handed over.
const ENOUGH: usize = 1 << 16;

/// How long a line waits at most while others follow, so that a slow simulation can be watched.
const PATIENCE: Duration = Duration::from_millis(200);

/// A file or the standard output, written in whole lines.
pub struct Lines {
    sink: Box<dyn Write>,
    name: String,
    waiting: Vec<u8>,
    handed_over: Instant,
}

impl Lines {
    /// The standard output.
    pub fn stdout() -> Self {
        Self::new(Box::new(io::stdout()), "the standard output".to_owned())
    }

    /// A new file, in place of one that may be there.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let file = File::create(path).map_err(|error| Failure::output(&name, &error))?;
        Ok(Self::new(Box::new(file), name))
    }

    fn new(sink: Box<dyn Write>, name: String) -> Self {
        Self { sink, name, waiting: Vec::new(), handed_over: Instant::now() }
    }

    /// Writes `text`, which may be several lines, and ends the last.
    pub fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.waiting.extend_from_slice(text.as_bytes());
        self.end_line()
    }

    /// Writes `value` as JSON on a line of its own.
    pub fn json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        let start = self.waiting.len();
        if let Err(error) = serde_json::to_writer(&mut self.waiting, value) {
            self.waiting.truncate(start);
            return Err(Failure::Other(format!("{}: {error}", self.name)));
        }
        self.end_line()
    }

    fn end_line(&mut self) -> Result<(), Failure> {
        if self.waiting.last() != Some(&b'\n') {
            self.waiting.push(b'\n');
        }
        if self.waiting.len() < ENOUGH && self.handed_over.elapsed() < PATIENCE {
            return Ok(());
        }
        self.finish()
    }

    /// Hands over what still waits.
    pub fn finish(&mut self) -> Result<(), Failure> {
        let result = self.sink.write_all(&self.waiting).and_then(|()| self.sink.flush());
        self.waiting.clear();
        self.handed_over = Instant::now();
        result.map_err(|error| Failure::output(&self.name, &error))
    }
}

/// What a failure elsewhere left waiting is still worth having.
impl Drop for Lines {
    fn drop(&mut self) {
        if !self.waiting.is_empty() {
            let _ = self.finish();
        }
    }
}

/// Writes one line to the standard error; if that is closed, nobody wanted to know.
pub fn complain(message: &str) {
    let _ = io::stderr().write_all(format!("{message}\n").as_bytes());
}

/// Tells what is worth knowing but no error.
pub fn note(message: &str) {
    complain(&format!("note: {}", one_line(message)));
}

/// A progress bar on the standard error over `length` of `what`, or, if it is not to be shown, none that can be seen.
pub fn progress_bar(is_shown: bool, length: u64, what: &str) -> ProgressBar {
    if !is_shown {
        return ProgressBar::hidden();
    }
    let target = ProgressDrawTarget::stderr_with_hz(10);
    let bar = ProgressBar::with_draw_target(Some(length), target);
    let template = format!("{{bar:40}} {{percent:>3}} %  {{pos}}/{{len}} {what}  {{eta}} left");
    match ProgressStyle::with_template(&template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// Remembers what arrived, write by write.
    #[derive(Clone, Default)]
    struct Pieces(Rc<RefCell<Vec<Vec<u8>>>>);

    impl Write for Pieces {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.borrow_mut().push(bytes.to_vec());
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn only_whole_lines_are_handed_over() {
        let pieces = Pieces::default();
        let mut lines = Lines::new(Box::new(pieces.clone()), "test".to_owned());
        for k in 0..20_000 {
            lines.json(&[k, k * k]).unwrap();
        }
        drop(lines);
        let pieces = pieces.0.borrow();
        assert!(pieces.len() > 1, "several pieces");
        assert!(pieces.iter().all(|piece| piece.ends_with(b"\n")));
        assert_eq!(pieces.concat().iter().filter(|&&byte| byte == b'\n').count(), 20_000);
    }

    #[test]
    fn single_precision_is_written_as_short_as_it_reads_back() {
        let mut lines = Lines::new(Box::new(io::sink()), "test".to_owned());
        lines.json(&(0.1_f32, 0.1_f64, 16_777_216.0_f32, -0.0_f64, 1e-300)).unwrap();
        assert_eq!(lines.waiting, b"[0.1,0.1,16777216.0,-0.0,1e-300]\n");
        lines.waiting.clear();
    }
}
