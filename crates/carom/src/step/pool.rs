//! Work for several threads.
//!
//! A phase of a step is a plain function over a range of numbers. Here it is cut into *units*, which the thread that steps the
//! world and its workers share out among each other; what comes of them is put together in their order. So the number of threads,
//! and who does what, decide how long it takes and nothing else.
//!
//! ```text
//! Pool::map       each item of a slice                a pure function of it
//! Pool::ranges    stretches of numbers from 0 on      the same for many at once
//! Pool::chunks    stretches of a slice                may change them
//! pool/crew.rs    the workers: how units are claimed, when a stage is over
//! ```
//!
//! What is too small to pay is done by the caller alone, and so is all of it with one thread: no worker is started before there is
//! something to do for it. A unit that asks for the pool again gets it as if it had one thread.

#![allow(unsafe_code, reason = "parts of a slice, each for one thread")]

mod crew;

use crew::Crew;
use smallvec::{SmallVec, smallvec};
use std::ops::Range;
use std::sync::{Mutex, OnceLock, PoisonError};

/// What comes of stretches: of one, where nothing is shared out.
type Results<R> = SmallVec<[R; 1]>;

/// The threads that step a world.
pub(crate) struct Pool {
    threads: usize,
    crew: OnceLock<Crew>,
}

impl Default for Pool {
    fn default() -> Self {
        Self::new(1)
    }
}

impl Pool {
    /// So many threads, the caller's among them.
    pub fn new(threads: usize) -> Self {
        Self { threads, crew: OnceLock::new() }
    }

    /// Whether there has been enough to do for workers.
    #[cfg(test)]
    pub fn has_workers(&self) -> bool {
        self.crew.get().is_some()
    }

    /// Whether `count` items are shared out, if a unit has at least `grain` of them: if not, the caller may as well go through them.
    pub fn shares(&self, count: usize, grain: usize) -> bool {
        self.threads > 1 && count / grain.max(1) > 1
    }

    /// Each item's result, in their order; a unit has at least `grain` items, worth some microseconds. Deterministic if `map` is a
    /// function of the item alone.
    pub fn map<T: Sync, R: Send>(&self, items: &[T], grain: usize, map: impl Fn(&T) -> R + Sync) -> Vec<R> {
        let mut results = Vec::new();
        self.map_into(items, grain, map, &mut results);
        results
    }

    /// The same, in place of what `results` has been.
    pub fn map_into<T: Sync, R: Send>(
        &self,
        items: &[T],
        grain: usize,
        map: impl Fn(&T) -> R + Sync,
        results: &mut Vec<R>,
    ) {
        results.clear();
        if self.shares(items.len(), grain) {
            let of = |range: Range<usize>| items[range].iter().map(&map).collect::<Vec<R>>();
            self.ranges(items.len(), grain, of).into_iter().for_each(|mut part| results.append(&mut part));
        } else {
            results.extend(items.iter().map(map));
        }
    }

    /// What `act` gives for stretches of `0..count`, in their order; each has at least `grain` numbers, unless there are fewer.
    /// Where they begin and end is up to the pool: what they come to must not depend on it.
    pub fn ranges<R: Send>(
        &self,
        count: usize,
        grain: usize,
        act: impl Fn(Range<usize>) -> R + Sync,
    ) -> Results<R> {
        let units = (count / grain.max(1)).min(crew::UNITS);
        if !self.shares(count, grain) {
            return (count > 0).then(|| act(0..count)).into_iter().collect();
        }
        let results: Vec<Mutex<Option<R>>> = (0..units).map(|_| Mutex::new(None)).collect();
        let unit = |unit: usize| {
            let result = act(unit * count / units..(unit + 1) * count / units);
            *results[unit].lock().unwrap_or_else(PoisonError::into_inner) = Some(result);
        };
        let crew = self.crew.get_or_init(|| Crew::new(self.threads - 1));
        if !crew.run(units, &unit) {
            return smallvec![act(0..count)];
        }
        let result = |slot: Mutex<Option<R>>| slot.into_inner().unwrap_or_else(PoisonError::into_inner);
        results.into_iter().filter_map(result).collect()
    }

    /// As [`Pool::ranges`], for stretches of `items` that may be changed; `act` also gets the index of the first item.
    pub fn chunks<T: Send, R: Send>(
        &self,
        items: &mut [T],
        grain: usize,
        act: impl Fn(usize, &mut [T]) -> R + Sync,
    ) -> Results<R> {
        let shared = crew::Disjoint::new(items);
        self.ranges(shared.len(), grain, |range| {
            let first = range.start;
            // SAFETY: the stretches that `ranges` gives out are within `0..len`, and each number is in one of them.
            act(first, unsafe { shared.take(range) })
        })
    }
}

#[cfg(test)]
mod tests;
