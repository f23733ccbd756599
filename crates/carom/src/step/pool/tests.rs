//! The pool against plain loops.

use super::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar};
use std::time::Duration;

const THREADS: [usize; 4] = [1, 2, 3, 8];

#[test]
fn results_come_in_order_whatever_the_number_of_threads() {
    for threads in THREADS {
        let pool = Pool::new(threads);
        for count in [0, 1, 2, 31, 1000, 100_000] {
            for grain in [0, 1, 7, 1000] {
                let items: Vec<usize> = (0..count).collect();
                let squares: Vec<usize> = items.iter().map(|it| it * it).collect();
                assert_eq!(pool.map(&items, grain, |it| it * it), squares, "{threads}, {count}, {grain}");

                let mut changed = items.clone();
                let firsts = pool.chunks(&mut changed, grain, |first, part| {
                    assert_eq!(part[0], first);
                    part.iter_mut().for_each(|it| *it *= *it);
                    first
                });
                assert_eq!(changed, squares, "{threads}, {count}, {grain}");
                assert!(firsts.is_sorted());
            }
        }
    }
}

#[test]
fn ranges_cover_each_number_once_and_are_no_smaller_than_asked() {
    for threads in THREADS {
        let pool = Pool::new(threads);
        for (count, grain) in [(10, 3), (5, 5), (9, 5), (10, 5), (1_000_000, 1), (3, 10)] {
            let mut next = 0;
            for range in pool.ranges(count, grain, |range| range) {
                assert_eq!(range.start, next);
                assert!(range.len() >= grain.min(count), "{range:?} of {count} by {grain}");
                next = range.end;
            }
            assert_eq!(next, count);
        }
    }
}

#[test]
fn many_short_stages() {
    let pool = Pool::new(4);
    let done = AtomicUsize::new(0);
    for stage in 0..20_000 {
        let units = 2 + stage % 7;
        let before = done.load(Ordering::Relaxed);
        pool.ranges(units, 1, |range| done.fetch_add(range.len(), Ordering::Relaxed));
        assert_eq!(done.load(Ordering::Relaxed), before + units, "stage {stage} was over too early");
    }
}

#[test]
fn who_is_held_up_in_one_unit_holds_up_nothing_else() {
    let pool = Pool::new(2);
    const UNITS: usize = 100;
    let (done, changed) = (Mutex::new(0), Condvar::new());
    let finished = pool.ranges(UNITS, 1, |range| {
        let mut others = done.lock().unwrap();
        if range.start > 0 {
            *others += 1;
            changed.notify_all();
            return true;
        }
        // The first unit waits for all others; whoever does not do this one has to do them.
        let limit = Duration::from_secs(60);
        let waited = changed.wait_timeout_while(others, limit, |others| *others < UNITS - 1);
        !waited.unwrap().1.timed_out()
    });
    assert_eq!(finished[..], [true; UNITS]);
}

#[test]
fn a_panic_comes_back_and_the_pool_goes_on() {
    for threads in THREADS {
        let pool = Pool::new(threads);
        for _ in 0..50 {
            let act = |range: Range<usize>| {
                if range.clone().any(|number| number == 30 || number == 60) {
                    std::panic::resume_unwind(Box::new(range.start));
                }
            };
            let outcome = catch_unwind(AssertUnwindSafe(|| pool.ranges(100, 1, act)));
            let first = *outcome.unwrap_err().downcast::<usize>().unwrap();
            assert_eq!(first, if threads == 1 { 0 } else { 30 }, "the first of the units that did");
            assert_eq!(pool.map(&[1, 2, 3, 4], 1, |it| it + 1), [2, 3, 4, 5]);
        }
    }
}

#[test]
fn a_unit_that_uses_the_pool_has_it_to_itself() {
    for threads in THREADS {
        let pool = Pool::new(threads);
        let rows: Vec<usize> = (0..50).collect();
        let sums = pool.map(&rows, 1, |row| {
            let columns: Vec<usize> = (0..40).collect();
            pool.map(&columns, 1, |column| row * column).into_iter().sum::<usize>()
        });
        let expected: Vec<usize> = rows.iter().map(|row| row * 39 * 40 / 2).collect();
        assert_eq!(sums, expected);
    }
}

#[test]
fn no_thread_is_started_for_what_is_too_small_and_none_outlives_the_world() {
    let pool = Pool::new(4);
    assert_eq!(pool.map(&[1, 2, 3], 2, |it| it + 1), [2, 3, 4]);
    assert!(!pool.has_workers());

    let world = crate::World::with_settings(crate::Settings { threads: 4, ..crate::Settings::default() });
    let pool = Arc::downgrade(&world.pool);
    pool.upgrade().unwrap().ranges(4, 1, |_| ());
    assert!(world.pool.has_workers());
    drop(world);
    assert_eq!(pool.strong_count(), 0);
}

/// A world, pool and all, may go to another thread; else this does not compile.
const _: fn() = || {
    fn may_go<T: Send + Sync>() {}
    may_go::<crate::World>();
};
