//! The workers, and how they share a stage's units.
//!
//! Every thread has a *share*, the same stretch of units in every stage of the same size, so that what it works on stays in its
//! caches. It claims units from the front of its own share, then from the backs of the others'. A stage is over when all units are
//! done, not when all threads have come: a thread that a busy machine has put aside holds up the unit that it is at, and
//! nobody waits for it otherwise. It finds out that it is late when it next claims: claims carry the stage's number.

#![allow(unsafe_code, reason = "units live on the stack of the thread that steps the world, workers do not")]

use std::any::Any;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicPtr, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

/// A stage has at most so many units.
pub(super) const UNITS: usize = (1 << UNIT_BITS) - 1;
const UNIT_BITS: u32 = 12;

/// Stages are counted modulo this: a worker would have to be away for days for one to come again.
const STAGES: u64 = 1 << (64 - 2 * UNIT_BITS);

/// So many times a thread without work looks for some, about 20 to 50 µs.
const LOOKS: u32 = 1000;

/// So many times more a worker does so before it sleeps, and lets others go first each time, about half a millisecond in all: between
/// two stages of a step it stays awake, as to wake it takes longer than many stages do.
const WAITS: u32 = 1000;

/// What is to be done for each unit.
type Act<'a> = &'a (dyn Fn(usize) + Sync);

/// The units of one thread that nobody has claimed yet, `next..end` of stage number `stage`.
#[derive(Clone, Copy)]
struct Claim {
    stage: u64,
    next: usize,
    end: usize,
}

impl Claim {
    fn pack(self) -> u64 {
        (self.stage << (2 * UNIT_BITS)) | ((self.next as u64) << UNIT_BITS) | self.end as u64
    }

    fn unpack(bits: u64) -> Self {
        let units = |shift: u32| (bits >> shift) as usize & UNITS;
        Self { stage: bits >> (2 * UNIT_BITS), next: units(UNIT_BITS), end: units(0) }
    }
}

/// One thread's part; on cache lines of its own.
#[derive(Default)]
#[repr(align(128))]
struct Share {
    claim: AtomicU64,
    is_parked: AtomicBool,
}

impl Share {
    /// Claims a unit of stage `stage`, the first or the last that is left.
    fn claim(&self, stage: u64, first: bool) -> Option<usize> {
        let mut seen = self.claim.load(Ordering::Relaxed);
        loop {
            let left = Claim::unpack(seen);
            if left.stage != stage || left.next >= left.end {
                return None;
            }
            let (unit, rest) = if first {
                (left.next, Claim { next: left.next + 1, ..left })
            } else {
                (left.end - 1, Claim { end: left.end - 1, ..left })
            };
            match self.claim.compare_exchange_weak(seen, rest.pack(), Ordering::Acquire, Ordering::Relaxed) {
                Ok(_) => return Some(unit),
                Err(now) => seen = now,
            }
        }
    }
}

/// The panic of a unit.
type Panic = (usize, Box<dyn Any + Send>);

/// What the workers and the thread that steps the world have in common.
struct Shared {
    /// Of the newest stage.
    stage: AtomicU64,
    /// To the [`Act`] of the newest stage, which is there as long as `left` is not zero.
    act: AtomicPtr<Act<'static>>,
    /// Units that are not done.
    left: AtomicUsize,
    /// The caller's share first.
    shares: Box<[Share]>,
    panic: Mutex<Option<Panic>>,
    is_busy: AtomicBool,
    ends: AtomicBool,
}

impl Shared {
    /// Claims a unit for thread number `me`: of its own, or else of one after it.
    fn claim(&self, me: usize, stage: u64) -> Option<usize> {
        let (before, from) = self.shares.split_at(me);
        let mut others = from[1..].iter().chain(before);
        from[0].claim(stage, true).or_else(|| others.find_map(|share| share.claim(stage, false)))
    }

    /// Does units of stage `stage` until none is left to claim.
    fn work(&self, me: usize, stage: u64) {
        while let Some(unit) = self.claim(me, stage) {
            // SAFETY: the pointer was stored before the claims of this stage, which is not over: the unit just claimed is not done. Until
            // then the act stays where it is, and no other is stored.
            let act = unsafe { *self.act.load(Ordering::Relaxed) };
            if let Err(payload) = catch_unwind(AssertUnwindSafe(|| act(unit))) {
                let mut panic = self.panic.lock().unwrap_or_else(PoisonError::into_inner);
                if panic.as_ref().is_none_or(|(other, _)| unit < *other) {
                    *panic = Some((unit, payload));
                }
            }
            self.left.fetch_sub(1, Ordering::Release);
        }
    }

    /// A worker's life: stage after stage, until the crew ends.
    fn serve(&self, me: usize) {
        let mut stage = 0;
        while !self.ends.load(Ordering::Relaxed) {
            stage = self.await_stage_after(stage, me);
            self.work(me, stage);
        }
    }

    /// Waits for another stage than `seen`, or the end.
    fn await_stage_after(&self, seen: u64, me: usize) -> u64 {
        let is_over = || self.stage.load(Ordering::SeqCst) != seen || self.ends.load(Ordering::SeqCst);
        for look in 0..LOOKS + WAITS {
            if is_over() {
                return self.stage.load(Ordering::SeqCst);
            }
            if look < LOOKS { std::hint::spin_loop() } else { thread::yield_now() }
        }
        // Whoever starts a stage or ends the crew does so before looking who is parked.
        loop {
            self.shares[me].is_parked.store(true, Ordering::SeqCst);
            if is_over() {
                break;
            }
            thread::park();
        }
        self.shares[me].is_parked.store(false, Ordering::SeqCst);
        self.stage.load(Ordering::SeqCst)
    }
}

/// Persistent workers.
pub(super) struct Crew {
    shared: Arc<Shared>,
    workers: Vec<JoinHandle<()>>,
}

impl Crew {
    /// So many workers, or fewer if the system has no more.
    pub fn new(workers: usize) -> Self {
        let shared = Arc::new(Shared {
            stage: AtomicU64::new(0),
            act: AtomicPtr::default(),
            left: AtomicUsize::new(0),
            shares: (0..=workers).map(|_| Share::default()).collect(),
            panic: Mutex::new(None),
            is_busy: AtomicBool::new(false),
            ends: AtomicBool::new(false),
        });
        let start = |number: usize| {
            let shared = Arc::clone(&shared);
            thread::Builder::new().name(format!("carom {number}")).spawn(move || shared.serve(number)).ok()
        };
        let workers = (1..=workers).map_while(start).collect();
        Self { shared, workers }
    }

    /// Calls `act` for each unit of `0..units`, on any thread; false if a stage is going on already, and nothing has been done.
    ///
    /// # Panics
    /// If units have; with the payload of the first of them, when all units are done.
    pub fn run(&self, units: usize, act: Act<'_>) -> bool {
        let shared = &*self.shared;
        if shared.is_busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_err() {
            return false;
        }
        let stage = (shared.stage.load(Ordering::Relaxed) + 1) % STAGES;
        let hands = (1 + self.workers.len()).min(units);
        shared.act.store(std::ptr::from_ref(&act).cast::<Act<'static>>().cast_mut(), Ordering::Relaxed);
        shared.left.store(units, Ordering::Relaxed);
        for (number, share) in shared.shares.iter().enumerate() {
            let from = |number: usize| number.min(hands) * units / hands;
            let claim = Claim { stage, next: from(number), end: from(number + 1) };
            share.claim.store(claim.pack(), Ordering::Release);
        }
        shared.stage.store(stage, Ordering::SeqCst);
        (1..hands).for_each(|number| self.wake(number));
        shared.work(0, stage);
        let mut looks = 0;
        while shared.left.load(Ordering::Acquire) > 0 {
            looks += 1;
            if looks < LOOKS { std::hint::spin_loop() } else { thread::yield_now() }
        }
        let panic = shared.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        shared.is_busy.store(false, Ordering::Release);
        if let Some((_, payload)) = panic {
            resume_unwind(payload);
        }
        true
    }

    /// Wakes a worker, if it sleeps.
    fn wake(&self, number: usize) {
        if self.shared.shares[number].is_parked.swap(false, Ordering::SeqCst) {
            self.workers[number - 1].thread().unpark();
        }
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::SeqCst);
        for worker in self.workers.drain(..) {
            worker.thread().unpark();
            // A worker catches what units panic with, and has nothing of its own to panic.
            let _ = worker.join();
        }
    }
}

/// A slice of which several threads get different parts.
pub(super) struct Disjoint<'a, T> {
    first: *mut T,
    count: usize,
    _of: std::marker::PhantomData<&'a mut [T]>,
}

// SAFETY: it hands out items to change, each once, so that they may have to go to another thread, and no further.
unsafe impl<T: Send> Sync for Disjoint<'_, T> {}

impl<'a, T> Disjoint<'a, T> {
    pub fn new(items: &'a mut [T]) -> Self {
        Self { first: items.as_mut_ptr(), count: items.len(), _of: std::marker::PhantomData }
    }

    pub fn len(&self) -> usize {
        self.count
    }

    /// The items of a range.
    ///
    /// # Safety
    /// It is within the slice, and no item of it is taken twice.
    pub unsafe fn take(&self, range: Range<usize>) -> &'a mut [T] {
        debug_assert!(range.end <= self.count);
        // SAFETY: the caller keeps to the slice, and takes nothing twice.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(range.start), range.len()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_come_from_both_ends_once_each_and_in_their_stage_only() {
        let share = Share::default();
        share.claim.store(Claim { stage: STAGES - 1, next: 5, end: UNITS }.pack(), Ordering::Relaxed);
        assert_eq!(share.claim(STAGES - 2, true), None, "who is late gets nothing");
        assert_eq!(share.claim(0, true), None);
        let (mut low, mut high) = (5, UNITS);
        while low < high {
            if (low + high) % 3 > 0 {
                assert_eq!(share.claim(STAGES - 1, true), Some(low));
                low += 1;
            } else {
                high -= 1;
                assert_eq!(share.claim(STAGES - 1, false), Some(high));
            }
        }
        assert_eq!(share.claim(STAGES - 1, true), None);
        assert_eq!(share.claim(STAGES - 1, false), None);
    }

    #[test]
    fn a_crew_that_is_dropped_has_ended() {
        for runs in [0, 1, 100] {
            let crew = Crew::new(3);
            for _ in 0..runs {
                assert!(crew.run(8, &|_| ()));
            }
            let shared = Arc::downgrade(&crew.shared);
            drop(crew);
            assert_eq!(shared.strong_count(), 0, "each worker has let go of it");
        }
    }
}
