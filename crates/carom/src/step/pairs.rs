//! Pairs of colliders near each other, remembered from step to step.
//!
//! A pair knows a distance that it had at some time, and how far its bodies have moved since: until these could have used it
//! up, nobody has to look at the pair again. What lies still costs nothing, nor does what is far apart.
//!
//! ```text
//! pairs.rs        all pairs, and those of each body
//! pairs/pair.rs   one pair
//! pairs/blocks.rs where they are kept
//! pairs/watch.rs  those that are looked at in each substep
//! ```
//!
//! A pair keeps its index as long as it is near. Indices depend on what happened before; whoever walks pairs in an order that
//! results depend on walks them in the order of their colliders' keys, as they stand in the lists here.

mod blocks;
mod pair;
#[cfg(test)]
mod tests;
mod watch;

use crate::bodies::{Bodies, WORLD_ROW};
use crate::room::Room;
use crate::step::broad_phase::{BroadPhase, ColliderPair};
use crate::step::profile::{self, Phase};
use blocks::Blocks;
pub(crate) use pair::Pair;
use pair::Present;
use watch::Watch;

/// A pair in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    colliders: ColliderPair,
    index: u32,
}

/// A pair of a body: the other body's collider, and the pair's index.
#[derive(Clone, Copy, Debug)]
struct Neighbor {
    other: u32,
    index: u32,
}

/// All pairs.
pub(crate) struct Pairs {
    list: Blocks<Option<Pair>>,
    free: Vec<u32>,
    /// The pairs of each body, in order of their colliders' keys.
    of_row: Vec<Vec<Neighbor>>,
    /// Pairs that somebody has got to change since the step began.
    changed: Vec<u32>,
    /// What happens in the present step to pairs to which anything does; the first entry is what happens to the others.
    presents: Vec<Present>,
    watch: Watch,
}

impl Default for Pairs {
    fn default() -> Self {
        Self {
            list: Blocks::default(),
            free: Vec::new(),
            of_row: Vec::new(),
            changed: Vec::new(),
            presents: vec![Present::NOTHING],
            watch: Watch::default(),
        }
    }
}

impl Pairs {
    /// Starts a step: adds the pairs that the broad phase has found, and takes out those that are no longer near; these are
    /// returned if they rest.
    pub fn update(&mut self, bodies: &Bodies, broad_phase: &mut BroadPhase) -> Vec<Pair> {
        let _phase = profile::phase(Phase::Find);
        for index in self.changed.drain(..) {
            if let Some(pair) = &mut self.list[index as usize] {
                pair.begin_step();
            }
        }
        self.presents.truncate(1);
        self.grow(bodies.states.len());
        let mut parted = Vec::new();
        for &key in broad_phase.boxed() {
            let Some(row) = bodies.collider(key).map(|collider| collider.row) else { continue };
            let mut number = 0;
            while let Some(&Neighbor { other, index }) = self.of_row[row].get(number) {
                if broad_phase.are_near(bodies, (key, other)) || !self[index as usize].has(key) {
                    number += 1;
                } else {
                    parted.extend(self.take_out(index).filter(|pair| pair.rests));
                }
            }
        }
        broad_phase.forget_boxed();
        parted.sort_unstable_by_key(|pair| pair.colliders);
        for &colliders in broad_phase.found() {
            self.add(bodies, colliders);
        }
        broad_phase.forget_found();
        parted
    }

    /// Ends a step of `time` seconds: what pairs have foreseen for its end holds from now on.
    pub fn end_step(&mut self, bodies: &Bodies, time: f64) {
        let _phase = profile::phase(Phase::Watch);
        for &index in &self.changed {
            if let Some(pair) = &mut self.list[index as usize] {
                pair.end_step(bodies, &self.presents[pair.present as usize], time);
            }
        }
    }

    fn grow(&mut self, rows: usize) {
        if self.of_row.len() < rows {
            self.of_row.resize_with(rows, Vec::new);
        }
    }

    /// Adds a pair that has come near; its place, if it was not known.
    pub fn add(&mut self, bodies: &Bodies, colliders: ColliderPair) -> Option<usize> {
        let row = |key: u32| bodies.outline(key).row as usize;
        // Of the rows of both bodies, each with the other one's collider.
        let (a, b) = colliders;
        let sides = [(row(a), b), (row(b), a)].into_iter().filter(|&(row, _)| row != WORLD_ROW);
        let (shorter, other) = sides.clone().min_by_key(|&(row, _)| self.of_row[row].len())?;
        let is_it = |it: &Neighbor| it.other == other && self[it.index as usize].colliders == colliders;
        if self.of_row[shorter].iter().any(is_it) {
            return None;
        }
        let pair = Pair::new(bodies, colliders)?;
        let index = self.free.pop().unwrap_or_else(|| {
            self.list.push(None);
            (self.list.len() - 1) as u32
        });
        self.list[index as usize] = Some(pair);
        for (row, other) in sides {
            let comes_before = |it: &Neighbor| self[it.index as usize].colliders < colliders;
            let place = self.of_row[row].partition_point(comes_before);
            self.of_row[row].put(Neighbor { other, index });
            self.of_row[row][place..].rotate_right(1);
        }
        self.watch(index as usize);
        Some(index as usize)
    }

    fn take_out(&mut self, index: u32) -> Option<Pair> {
        let pair = self.list[index as usize].as_ref()?;
        for row in pair.rows().into_iter().filter(|&row| row != WORLD_ROW) {
            self.of_row[row].retain(|it| it.index != index);
        }
        self.free.push(index);
        self.list[index as usize].take()
    }

    /// No index reaches this.
    #[cfg(test)]
    pub fn bound(&self) -> usize {
        self.list.len()
    }

    /// All pairs, in no order.
    #[cfg(test)]
    pub fn iter(&self) -> impl Iterator<Item = &Pair> {
        self.list.iter().flatten()
    }

    /// The sensors' pairs that have overlapped in the present step, in no order.
    pub fn sensed(&self) -> impl Iterator<Item = &Pair> {
        let changed = self.changed.iter().filter_map(|&index| self.list[index as usize].as_ref());
        changed.filter(|pair| self.presents[pair.present as usize].is_sensed)
    }

    /// Whether anything has happened to a pair in the present step.
    #[inline]
    pub fn has_present(&self, index: usize) -> bool {
        self[index].present != 0
    }

    /// What happens to a pair in the present step.
    #[inline]
    pub fn now(&self, index: usize) -> &Present {
        &self.presents[self[index].present as usize]
    }

    /// The same, to note what does.
    #[inline]
    pub fn now_mut(&mut self, index: usize) -> &mut Present {
        let next = self.presents.len();
        let pair = &mut self[index];
        let mut place = pair.present as usize;
        if place == 0 {
            place = next;
            pair.present = next as u32;
            self.presents.put(Present::NOTHING);
        }
        &mut self.presents[place]
    }

    /// A lower bound of the separation of a pair at `time`, m.
    #[inline]
    pub fn least_separation(&self, bodies: &Bodies, index: usize, time: f64) -> f64 {
        self[index].least_separation(bodies, self.now(index), time)
    }

    /// Whether there is a pair of this index, and rests.
    pub fn rests(&self, index: usize) -> bool {
        self.list[index].as_ref().is_some_and(|pair| pair.rests)
    }

    /// How many pairs the body of a row is in.
    pub fn count_of_row(&self, row: usize) -> usize {
        self.of_row[row].len()
    }

    /// One of them.
    pub fn of_row(&self, row: usize, number: usize) -> usize {
        self.of_row[row][number].index as usize
    }

    /// All pairs of the body of a row: the other bodies' colliders, and the pairs' indices.
    pub fn each_of_row(&self, row: usize) -> impl Iterator<Item = (u32, usize)> {
        self.of_row[row].iter().map(|it| (it.other, it.index as usize))
    }

    /// Takes out the pairs of a collider of the body of a row.
    pub fn remove(&mut self, collider: u32, row: usize) -> Vec<Pair> {
        let has = |index: u32| self.list[index as usize].as_ref().is_some_and(|pair| pair.has(collider));
        let indices: Vec<u32> = if row == WORLD_ROW {
            (0..self.list.len() as u32).filter(|&index| has(index)).collect()
        } else {
            let indices = self.of_row.get(row).into_iter().flatten().map(|it| it.index);
            indices.filter(|&index| has(index)).collect()
        };
        indices.into_iter().filter_map(|index| self.take_out(index)).collect()
    }

    /// The body of `row` is no more, nor are its pairs; that of the last row, `last`, gets its row.
    pub fn remove_row(&mut self, row: usize, last: usize) {
        self.grow(last + 1);
        self.of_row.swap_remove(row);
        self.watch.remove_row(row, last);
        for it in self.of_row.get(row).into_iter().flatten() {
            if let Some(pair) = &mut self.list[it.index as usize] {
                pair.move_row(last, row);
            }
        }
    }
}

impl std::ops::Index<usize> for Pairs {
    type Output = Pair;

    #[inline]
    fn index(&self, index: usize) -> &Pair {
        self.list[index].as_ref().expect("a pair's index is used as long as there is the pair")
    }
}

impl std::ops::IndexMut<usize> for Pairs {
    #[inline]
    fn index_mut(&mut self, index: usize) -> &mut Pair {
        let pair = self.list[index].as_mut().expect("a pair's index is used as long as there is the pair");
        if !std::mem::replace(&mut pair.is_changed, true) {
            self.changed.put(index as u32);
        }
        pair
    }
}
