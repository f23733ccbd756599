//! The clock: one for each thread, since each world is stepped by one.

use super::Phase;
use std::cell::RefCell;
use std::time::{Duration, Instant};

/// What a phase has taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spent {
    /// Which phase.
    pub phase: Phase,
    /// Its own time, without the phases that it called.
    pub time: Duration,
    /// How often it began.
    pub calls: u64,
}

/// What every phase has taken in the steps of this thread, of all its worlds, since this was asked before. The times come to
/// those of the steps, from the beginning of each to its end.
pub fn take() -> Vec<Spent> {
    CLOCK.with_borrow_mut(|clock| std::mem::replace(&mut clock.spent, NOTHING)).into()
}

thread_local! {
    static CLOCK: RefCell<Clock> = const { RefCell::new(Clock { running: None, spent: NOTHING }) };
}

const PHASES: [Phase; 16] = [
    Phase::Other,
    Phase::Find,
    Phase::Crowds,
    Phase::Watch,
    Phase::Adopt,
    Phase::Renew,
    Phase::Measure,
    Phase::Solve,
    Phase::Sweep,
    Phase::Direct,
    Phase::Give,
    Phase::Ask,
    Phase::Strike,
    Phase::Fly,
    Phase::PushOut,
    Phase::Finish,
];

/// Each phase at the index that it has as a number.
const NOTHING: [Spent; PHASES.len()] = {
    let mut spent = [Spent { phase: Phase::Other, time: Duration::ZERO, calls: 0 }; PHASES.len()];
    let mut index = 0;
    while index < PHASES.len() {
        assert!(PHASES[index] as usize == index);
        spent[index].phase = PHASES[index];
        index += 1;
    }
    spent
};

struct Clock {
    /// The innermost phase that has begun, and since when time has been its own.
    running: Option<(Phase, Instant)>,
    spent: [Spent; PHASES.len()],
}

impl Clock {
    /// Books the time since the last turn to the phase that it belongs to; from now on it belongs to another one.
    fn turn_to(&mut self, phase: Option<Phase>) -> Option<Phase> {
        let now = Instant::now();
        let (before, since) = std::mem::replace(&mut self.running, phase.map(|phase| (phase, now)))?;
        self.spent[before as usize].time += now - since;
        Some(before)
    }
}

/// A phase that goes on as long as this lives.
pub(crate) struct Running {
    /// The phase that called it.
    outer: Option<Phase>,
}

impl Drop for Running {
    fn drop(&mut self) {
        CLOCK.with_borrow_mut(|clock| clock.turn_to(self.outer));
    }
}

/// Begins a phase, which ends with the value returned.
pub(crate) fn phase(phase: Phase) -> Running {
    CLOCK.with_borrow_mut(|clock| {
        clock.spent[phase as usize].calls += 1;
        Running { outer: clock.turn_to(Some(phase)) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the calls alone: what the clock reads is up to the machine.
    #[test]
    fn phases_nest_and_each_has_its_own_calls() {
        take();
        {
            let _step = phase(Phase::Other);
            (0..3).for_each(|_| drop(phase(Phase::Find)));
            let _outer = phase(Phase::Solve);
            drop(phase(Phase::Sweep));
        }
        let spent = take();
        let calls = |phase: Phase| spent[phase as usize].calls;
        let phases = [Phase::Other, Phase::Find, Phase::Solve, Phase::Sweep, Phase::Fly];
        assert_eq!(phases.map(calls), [1, 3, 1, 1, 0]);
        assert!(spent.iter().all(|it| it.calls > 0 || it.time.is_zero()));
        assert!(take().iter().all(|it| it.calls == 0));
        assert!(CLOCK.with_borrow(|clock| clock.running.is_none()));
    }
}
