//! Which pairs are looked at in each substep.
//!
//! Each body gets a limit of how far its [way](Bodies::way) may lead. Only pairs that could meet within their bodies'
//! limits are watched; the others are looked at again when one of their bodies exceeds its limit and gets another.

use super::{Entry, Pairs};
use crate::bodies::{Bodies, WORLD_ROW};
use crate::step::broad_phase::ROOM;
use crate::step::profile::{self, Phase};

/// A limit allows for a turn of this angle (rad) and for a path of this share of the body's size, or for what the body's
/// speed takes it to in so many steps more.
const SHARE: f64 = 0.02;
const STEPS: f64 = 1.0;

/// Limits, and the pairs that could meet within them.
#[derive(Default)]
pub(super) struct Watch {
    /// Of each row, m and rad.
    limits: Vec<(f64, f64)>,
    /// In order of their colliders' keys.
    list: Vec<Entry>,
    joining: Vec<Entry>,
    /// Separation (m) up to which contacts hold what rests.
    margin: f64,
    /// How many of the changed pairs have been seen to.
    seen: usize,
}

impl Watch {
    pub fn remove_row(&mut self, row: usize, last: usize) {
        self.limits.resize(last + 1, NO_LIMIT);
        self.limits.swap_remove(row);
    }

    #[cfg(test)]
    pub fn has(&self, entry: Entry) -> bool {
        self.list.contains(&entry) || self.joining.contains(&entry)
    }

    #[cfg(test)]
    pub fn margin(&self) -> f64 {
        self.margin
    }
}

/// Of a row that has had none yet.
const NO_LIMIT: (f64, f64) = (f64::NEG_INFINITY, f64::NEG_INFINITY);

impl Pairs {
    /// Starts a step of `time` seconds in which contacts hold what is up to `margin` (m) apart.
    pub fn begin_watch(&mut self, bodies: &Bodies, (time, margin): (f64, f64)) {
        let _phase = profile::phase(Phase::Watch);
        let watch = &mut self.watch;
        watch.limits.resize(bodies.states.len(), NO_LIMIT);
        watch.limits[WORLD_ROW] = (0.0, 0.0);
        if margin > watch.margin {
            watch.limits[WORLD_ROW + 1..].fill(NO_LIMIT);
        }
        watch.margin = margin;
        watch.seen = 0;
        self.watch_again(bodies, bodies.rows(), time);
        let (list, limits) = (&mut self.list, &self.watch.limits);
        self.watch.list.retain(|entry| {
            let there = list[entry.index as usize].as_mut();
            let Some(pair) = there.filter(|it| it.colliders == entry.colliders && it.is_watched) else {
                return false;
            };
            pair.is_watched = pair.needs_watching(bodies, pair.rows().map(|row| limits[row]), margin);
            pair.is_watched
        });
    }

    /// Sees to it that all pairs are watched that could meet before `time`, given that only the paths of these rows are new.
    pub fn watch_again(&mut self, bodies: &Bodies, rows: impl Iterator<Item = usize>, time: f64) {
        let _phase = profile::phase(Phase::Watch);
        for row in rows {
            let way = bodies.way(row, time);
            let limit = &mut self.watch.limits[row];
            if way.0 <= limit.0 && way.1 <= limit.1 {
                continue;
            }
            let (linear, angular) = bodies.paces[row];
            let size = bodies.grains[row];
            let ahead = STEPS * time;
            *limit = (way.0 + (SHARE * size).max(ahead * linear), way.1 + SHARE.max(ahead * angular));
            for number in 0..self.of_row[row].len() {
                let index = self.of_row(row, number);
                let pair = &self[index];
                let limits = pair.rows().map(|row| self.watch.limits[row]);
                if pair.needs_watching(bodies, limits, self.watch.margin) {
                    self.watch(index);
                }
            }
        }
        // Whoever was asked out of turn may be due again.
        while let Some(&index) = self.changed.get(self.watch.seen) {
            self.watch.seen += 1;
            if self.list[index as usize].is_some() {
                self.watch_over(index as usize);
            }
        }
        self.join();
    }

    /// Has a pair looked at in every substep, unless its contacts see to it.
    pub fn watch_over(&mut self, index: usize) {
        let pair = &self[index];
        if !(pair.rests && pair.is_pressed) {
            self.watch(index);
        }
    }

    pub(super) fn watch(&mut self, index: usize) {
        let Some(pair) = &mut self.list[index] else { return };
        if !std::mem::replace(&mut pair.is_watched, true) {
            self.watch.joining.push(Entry { colliders: pair.colliders, index: index as u32 });
        }
    }

    /// Takes those that join into the list.
    fn join(&mut self) {
        let watch = &mut self.watch;
        if watch.joining.is_empty() {
            return;
        }
        watch.joining.sort_unstable();
        merge(&mut watch.list, &mut watch.joining);
        watch.joining.shrink_to(ROOM);
        // A pair that was taken out and came back before anybody looked is in it twice.
        watch.list.dedup();
    }

    /// How many pairs are watched.
    pub fn count_of_watched(&self) -> usize {
        self.watch.list.len()
    }

    /// One of them, in order of their colliders' keys.
    pub fn watched(&self, number: usize) -> usize {
        self.watch.list[number].index as usize
    }
}

/// Puts entries in order into a list in order, from the end on: what comes before all of them is not touched.
pub(super) fn merge(list: &mut Vec<Entry>, joining: &mut Vec<Entry>) {
    let mut read = list.len();
    list.extend_from_slice(joining);
    let mut write = list.len();
    while let Some(&entry) = joining.last() {
        write -= 1;
        if read > 0 && list[read - 1] > entry {
            read -= 1;
            list[write] = list[read];
        } else {
            list[write] = entry;
            joining.pop();
        }
    }
}
