//! The ledger: momentum and energy of every step, what entered or left, by cause, and what no cause explains.
//!
//! ```text
//! end − start = what entered, cause by cause + residual
//! ```
//!
//! Each part of the engine that changes a body's state books what it does, from the impulses that it gives and the paths that bodies
//! take, not from what the state has become. So the residual is a check: it is rounding, or the engine does something that it does not
//! know of.
//!
//! *Accounts.* Linear and angular momentum come from [gravity](Posts::gravity), from [outside](Posts::external), from what is
//! [fixed](Posts::fixed) and what is [kinematic](Posts::kinematic). Energy is lost or gained by what is modelled
//! (restitution, friction, contacts, damping; kinematic bodies and forces), and by what is an artefact of the engine:
//! [rest capture](Posts::loss_rest_capture), [sleep](Posts::loss_sleep), [overlaps pushed out](Posts::position_correction),
//! [integration](Posts::integration). These are kept apart.
//!
//! ```text
//! ledger/stock.rs      what a body has
//! ledger/posts.rs      the causes, and their sums
//! ledger/journal.rs    what is noted while a step goes on
//! ledger/look.rs       what all bodies have, looked up
//! ledger/falls.rs      what gravity does
//! ledger/flights.rs    who books what flights do: gravity, forces, damping, turning
//! ledger/plain.rs      the same, where a body lies still
//! ledger/contacts.rs   contacts that rest, rest capture, overlaps
//! ledger/impacts.rs    collisions
//! ledger/worst.rs      which step and which body fitted worst
//! ```

pub(crate) mod contacts;
mod falls;
pub(crate) mod flights;
pub(crate) mod impacts;
pub(crate) mod journal;
pub(crate) mod look;
mod plain;
mod posts;
mod stock;
mod worst;

pub use posts::{Posts, Residual};
pub use stock::Stock;
pub use worst::Worst;

use crate::bodies::Bodies;
use crate::math::DVec3;
use journal::Journal;
use look::Look;
use std::fmt;

/// Start, end and causes of a stretch of time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Books {
    /// What the dynamic bodies had at the end of the step before: at the start, if there was none.
    pub start: Stock,
    /// What they have at the end.
    pub end: Stock,
    /// What entered or left, by cause.
    pub posts: Posts,
    /// Sums of the posts' absolute values, step by step: linear momentum, angular momentum, energy.
    throughput: [f64; 3],
    /// Sums of what the single bodies had before, have now and got from gravity, without directions.
    gross: [f64; 3],
}

impl Books {
    /// What no cause explains. What cannot be told from the rounding of the sums that it is the difference of is 0:
    /// [`Books::PRECISION`] of what the single bodies have.
    pub fn residual(&self) -> Residual {
        let Residual { linear, angular, energy } = self.end.since(&self.start) - self.posts.entered();
        let told = |kind: usize, value: f64| {
            if value.abs() <= Self::PRECISION * self.gross[kind] { 0.0 } else { value }
        };
        let told_vector =
            |kind: usize, v: DVec3| DVec3::from_array(v.to_array().map(|value| told(kind, value)));
        Residual { linear: told_vector(0, linear), angular: told_vector(1, angular), energy: told(2, energy) }
    }

    /// Relative rounding of sums over all bodies in double precision.
    pub const PRECISION: f64 = 1e-14;

    /// Sums of the absolute values of all posts, step by step: linear momentum (N·s), angular momentum (N·m·s), energy (J).
    pub fn throughput(&self) -> [f64; 3] {
        self.throughput
    }

    /// The residuals of linear momentum, angular momentum and energy over the throughput of each.
    ///
    /// What the single bodies have and get from gravity is rounded even where its sum is nothing, so that this part of it counts as throughput:
    /// [`Books::ROUNDING`].
    pub fn relative_residual(&self) -> [f64; 3] {
        let residual = self.residual().sizes();
        [0, 1, 2].map(|kind| {
            let scale = self.throughput[kind] + Self::ROUNDING * self.gross[kind];
            if residual[kind] == 0.0 { 0.0 } else { residual[kind] / scale }
        })
    }

    /// Share of what the bodies have that counts as throughput.
    pub const ROUNDING: f64 = 1e-7;

    /// Relative residual up to which the books are in order: what is above is no rounding.
    pub const TOLERANCE: f64 = 1e-5;
}

/// Momentum and energy of a world, step by step and since the ledger was opened.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    steps: u64,
    last: Books,
    total: Books,
    worst_residual: Option<Worst>,
    worst_artefact: Option<Worst>,
    artefacts: f64,
}

impl Ledger {
    /// Steps in the books; 0 where no ledger is kept.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The books of the last step.
    pub fn last_step(&self) -> &Books {
        &self.last
    }

    /// The books of all steps since the ledger was opened.
    pub fn total(&self) -> &Books {
        &self.total
    }

    /// How much energy (J) artefacts of the engine have moved so far, step by step and without signs.
    pub fn artefacts(&self) -> f64 {
        self.artefacts
    }

    /// The step that fitted worst, measured by [`Books::relative_residual`].
    pub fn worst_residual(&self) -> Option<&Worst> {
        self.worst_residual.as_ref()
    }

    /// The largest energy that an artefact of the engine has taken from a body, or given to it, in one step.
    pub fn worst_artefact(&self) -> Option<&Worst> {
        self.worst_artefact.as_ref()
    }

    /// Begins the books of a step, with what users have done since the last one.
    pub(crate) fn open(&mut self, bodies: &mut Bodies, gravity: DVec3) {
        let Some(mut journal) = bodies.journal.take() else { return };
        journal.record = self.worst_artefact.as_ref().map_or(0.0, |worst| worst.amount as f32);
        let start = journal.open(bodies, gravity);
        self.last.start = if self.steps == 0 { start } else { self.last.end };
        let done = start.since(&self.last.start) - journal.posts.entered();
        journal.posts.enters_from_outside(&done);
        bodies.journal = Some(journal);
    }

    /// Ends the books of a step of `step` seconds at `time` (s), after a look at what all bodies have then.
    pub(crate) fn close(&mut self, bodies: &mut Bodies, look: Option<Look>, (step, time): (f64, f64)) {
        let Some(look) = look else { return };
        let Some(mut journal) = bodies.journal.take() else { return };
        let closing = journal.close(look, step);
        let mut books = Books { end: closing.end, posts: closing.posts, gross: closing.gross, ..self.last };
        if closing.lost {
            // Nothing is known of what has become of a body that is no longer finite.
            books.posts.drop_what_is_not_finite();
            if !books.start.is_finite() {
                books.start = books.end;
            }
            books.posts.enters_from_outside(&books.residual());
        }
        books.throughput = books.posts.throughput();
        self.steps += 1;
        self.last = books;
        self.add(&books);
        let at = (self.steps, time);
        let rows = (&*journal, &*bodies);
        self.worst_residual = Worst::residual(&books, rows, at, self.worst_residual.take());
        self.worst_artefact = Worst::artefact(&books, rows, at, self.worst_artefact.take());
        bodies.journal = Some(journal);
    }

    fn add(&mut self, books: &Books) {
        self.artefacts += books.posts.artefacts();
        if self.steps == 1 {
            self.total = *books;
            return;
        }
        self.total.end = books.end;
        self.total.posts += books.posts;
        for kind in 0..3 {
            self.total.throughput[kind] += books.throughput[kind];
            self.total.gross[kind] = self.total.gross[kind].max(books.gross[kind]);
        }
    }
}

/// Opens a ledger, or closes it for good.
pub(crate) fn keep(bodies: &mut Bodies, on: bool) {
    if on != bodies.journal.is_some() {
        bodies.journal = on.then(Box::<Journal>::default);
    }
}

/// Cause by cause, those of which there was something.
impl fmt::Display for Books {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (start, end) = (self.start.total_energy(), self.end.total_energy());
        writeln!(f, "energy {start:.6e} J became {end:.6e} J")?;
        for (cause, value) in self.posts.energies().into_iter().filter(|(_, value)| *value != 0.0) {
            writeln!(f, "  {cause:<20}{value:>14.6e} J")?;
        }
        let vector = |v: DVec3| format!("({:.6e}, {:.6e}, {:.6e})", v.x, v.y, v.z);
        let (start, end) = (self.start.momentum.linear, self.end.momentum.linear);
        writeln!(f, "momentum {} N·s became {} N·s", vector(start), vector(end))?;
        for (cause, momentum) in self.posts.momenta() {
            if momentum.linear != DVec3::ZERO || momentum.angular != DVec3::ZERO {
                let (linear, angular) = (vector(momentum.linear), vector(momentum.angular));
                writeln!(f, "  {cause:<20}{linear} N·s, angular {angular} N·m·s")?;
            }
        }
        let residual = self.residual();
        let (linear, angular) = (vector(residual.linear), vector(residual.angular));
        write!(f, "unexplained: {:.1e} J, {linear} N·s, angular {angular} N·m·s", residual.energy)
    }
}

/// The totals, and what fitted worst.
impl fmt::Display for Ledger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.steps == 0 {
            return write!(f, "no steps in the books");
        }
        write!(f, "{}", self.total)?;
        for (what, worst) in [("worst fit", &self.worst_residual), ("largest artefact", &self.worst_artefact)]
        {
            if let Some(worst) = worst {
                write!(f, "\n{what}: {worst}")?;
            }
        }
        Ok(())
    }
}
