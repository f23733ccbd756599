//! Where the time of a step goes, phase by phase. Without the feature `profile` all of this is compiled to nothing, and no
//! clock is read.
//!
//! A phase begins where its function does: `let _phase = profile::phase(Phase::Solve);`, and ends with it. It must be the
//! stepping thread's: what goes on in the units of a [`Pool`](super::pool::Pool) belongs to the phase that shares them out.

#[cfg(feature = "profile")]
mod clock;

#[cfg(feature = "profile")]
pub(crate) use clock::phase;
#[cfg(feature = "profile")]
pub use clock::{Spent, take};

/// What a step spends its time on. The time of a phase is its own: without the phases that it calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// All of a step that is in no other phase.
    Other,
    /// The broad phase: boxes, and pairs of them that are new or no more.
    Find,
    /// Who rests against whom, before the first substep.
    Crowds,
    /// Which pairs could touch soon.
    Watch,
    /// Pairs that may have come to rest are looked at.
    Adopt,
    /// Contacts are made and looked at anew.
    Renew,
    /// The gaps of contacts after their bodies have moved.
    Measure,
    /// Impulses of contacts, but for sweeps and direct solutions: islands, and what to sweep on.
    Solve,
    /// Sweeps over contacts.
    Sweep,
    /// Direct solutions of small islands.
    Direct,
    /// What rests gets the velocities to solve for, and its impulses and paths.
    Give,
    /// Pairs are asked when they will touch.
    Ask,
    /// Touches: each is confirmed, and resolved if it is a collision.
    Strike,
    /// Bodies move along their paths.
    Fly,
    /// Overlaps are pushed out.
    PushOut,
    /// States published, the report, the ledger.
    Finish,
}

/// A phase that does not count.
#[cfg(not(feature = "profile"))]
pub(crate) struct Uncounted;

/// Begins a phase, which would end with the value returned.
#[cfg(not(feature = "profile"))]
#[inline(always)]
pub(crate) fn phase(_: Phase) -> Uncounted {
    Uncounted
}
