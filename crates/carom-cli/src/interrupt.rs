//! Ctrl-C: the step in progress ends, its lines are written, then the program does.
//!
//! Without this the system may stop the program in the middle of a write and leave half a line.

use crate::failure::Failure;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Tells whether somebody asked to stop.
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Listens from now on. A second Ctrl-C stops at once.
    pub fn listen() -> Self {
        let signal = Arc::new(AtomicUsize::new(0));
        let asked = Arc::new(AtomicBool::new(false));
        for number in [SIGINT, SIGTERM] {
            // Where a signal can't be listened to, it keeps its meaning.
            let _ = signal_hook::flag::register_conditional_default(number, Arc::clone(&asked));
            let _ = signal_hook::flag::register(number, Arc::clone(&asked));
            let _ = signal_hook::flag::register_usize(number, Arc::clone(&signal), number as usize);
        }
        Self { signal }
    }

    /// An error once somebody asked to stop.
    pub fn check(&self) -> Result<(), Failure> {
        match self.signal.load(Ordering::Relaxed) {
            0 => Ok(()),
            signal => Err(Failure::Interrupted(signal as i32)),
        }
    }
}

/// Ends the program the way `signal` would have, so that whoever started it can see why.
pub fn die_of(signal: i32) {
    let _ = signal_hook::low_level::emulate_default_handler(signal);
}
