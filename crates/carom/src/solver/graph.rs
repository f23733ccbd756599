//! All contacts of a world, coloured.
//!
//! Two contacts of one *colour* share no body that can be moved, so that the lanes of a bundle, and the bundles of a colour,
//! have nothing to do with each other: the result does not depend on how many are computed at once. Contacts between two
//! bodies that move come first, those with the ground last, so that in doubt nothing is pushed into the ground.
//!
//! Bodies that contacts connect make an *island* (`graph/islands.rs`). What is done until the velocities of an island agree
//! stands in `graph/agree.rs`, where they start from in `graph/warm_start.rs`, how threads share a pass over all contacts in
//! `graph/passes.rs`; what contacts then exert, in `graph/wrench.rs`; and how overlaps come out, in `graph/push_out.rs`.

mod agree;
mod islands;
mod passes;
mod push_out;
mod warm_start;
mod wrench;

pub(crate) use agree::Effort;
pub(crate) use push_out::Limits;
pub(crate) use wrench::{Wrench, Wrenches};

use super::bundle::{Bundle, Lane, NO_CONTACT, field};
use super::lanes::{LANES, Machine};
use crate::math::DVec3;
use crate::room::Room;
use crate::step::pool::Pool;
use islands::Islands;
use std::sync::Arc;

/// Names a contact as long as it lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ContactId(u32);

impl ContactId {
    /// Names none.
    pub const NONE: ContactId = ContactId(u32::MAX);

    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The numbers of a contact; zeros where there is none.
#[derive(Clone, Copy)]
pub(crate) struct Numbers<'a>(Option<(&'a Bundle, usize)>);

impl Numbers<'_> {
    /// One of them.
    pub fn get(self, field: usize) -> f64 {
        self.0.map_or(0.0, |(bundle, lane)| f64::from(bundle.get(lane, field)))
    }

    /// Three of them, from `field` on.
    pub fn vector(self, field: usize) -> DVec3 {
        DVec3::new(self.get(field), self.get(field + 1), self.get(field + 2))
    }
}

/// Where a contact is, if its id is used.
#[derive(Clone, Copy, Debug)]
struct Place {
    color: u32,
    lane: u32,
}

impl Place {
    const NOWHERE: Place = Place { color: u32::MAX, lane: 0 };

    fn new(color: usize, lane: usize) -> Self {
        Self { color: color as u32, lane: lane as u32 }
    }

    /// The colour, and the lane in it.
    fn get(self) -> Option<(usize, usize)> {
        (self.color != u32::MAX).then_some((self.color as usize, self.lane as usize))
    }
}

/// Contacts that share no body that can be moved.
#[derive(Default)]
struct Color {
    bundles: Vec<Bundle>,
    /// The contact of each lane.
    contacts: Vec<u32>,
    /// Whether the body of a row has a contact of this colour, 64 rows to a word.
    taken: Vec<u64>,
}

impl Color {
    fn is_taken(&self, row: u32) -> bool {
        self.taken.get(row as usize / 64).is_some_and(|word| word >> (row % 64) & 1 == 1)
    }

    fn mark(&mut self, row: u32, taken: bool) {
        let word = row as usize / 64;
        if word >= self.taken.len() {
            self.taken.resize(word + 1, 0);
        }
        let bit = 1 << (row % 64);
        self.taken[word] = if taken { self.taken[word] | bit } else { self.taken[word] & !bit };
    }
}

/// Kinds of colours, in turn: of contacts between two bodies that can be moved, and of those with what cannot.
const KINDS: usize = 2;
const MOVING: usize = 0;
const FIXED: usize = 1;

/// All contacts.
#[derive(Default)]
pub(crate) struct Graph {
    /// Even: between bodies that move. Odd: with what does not.
    colors: Vec<Color>,
    places: Vec<Place>,
    free: Vec<u32>,
    islands: Islands,
    machine: Machine,
    pool: Arc<Pool>,
}

impl Graph {
    /// No contacts, to be solved with these instructions by these threads.
    pub fn new(machine: Machine, pool: Arc<Pool>) -> Self {
        Self { machine, pool, ..Self::default() }
    }

    /// The threads that solve it.
    pub fn pool(&self) -> &Pool {
        &self.pool
    }

    /// Adds a contact between the bodies of two rows; `movable` tells which of them an impulse can move.
    pub fn insert(&mut self, rows: [u32; 2], movable: [bool; 2], lane: &Lane) -> ContactId {
        let kind = if movable == [true, true] { MOVING } else { FIXED };
        let is_open = |color: &Color| (0..2).all(|side| !movable[side] || !color.is_taken(rows[side]));
        let mut color = kind;
        while self.colors.get(color).is_some_and(|it| !is_open(it)) {
            color += KINDS;
        }
        while self.colors.len() <= color {
            self.colors.push(Color::default());
        }
        let id = self.free.pop().unwrap_or_else(|| {
            self.places.put(Place::NOWHERE);
            (self.places.len() - 1) as u32
        });
        let target = &mut self.colors[color];
        let number = target.contacts.len();
        for side in (0..2).filter(|&side| movable[side]) {
            target.mark(rows[side], true);
        }
        target.contacts.put(id);
        if number.is_multiple_of(LANES) {
            target.bundles.put(Bundle::EMPTY);
        }
        target.bundles[number / LANES].write(number % LANES, rows, lane);
        self.places[id as usize] = Place::new(color, number);
        self.islands.is_stale = true;
        ContactId(id)
    }

    /// The colour and the lane of a contact.
    fn place(&self, id: ContactId) -> Option<(usize, usize)> {
        self.places.get(id.index()).copied().and_then(Place::get)
    }

    /// Its bundle, and the lane in that.
    fn bundle(&self, id: ContactId) -> Option<(&Bundle, usize)> {
        self.place(id).map(|(color, lane)| (&self.colors[color].bundles[lane / LANES], lane % LANES))
    }

    /// Gives a contact other numbers.
    pub fn write(&mut self, id: ContactId, lane: &Lane) {
        if let Some((color, number)) = self.place(id) {
            let bundle = &mut self.colors[color].bundles[number / LANES];
            let (rows, _) = bundle.read(number % LANES);
            bundle.write(number % LANES, rows, lane);
        }
    }

    /// A contact's numbers.
    pub fn numbers(&self, id: ContactId) -> Numbers<'_> {
        Numbers(self.bundle(id))
    }

    /// One of a contact's numbers.
    pub fn get(&self, id: ContactId, field: usize) -> f32 {
        self.bundle(id).map_or(0.0, |(bundle, lane)| bundle.get(lane, field))
    }

    /// Whether all points of a contact are within its horizon.
    pub fn is_closed(&self, id: ContactId) -> bool {
        self.bundle(id).is_none_or(|(bundle, lane)| bundle.is_closed(lane))
    }

    /// Whether all points of a contact are out of its reach.
    pub fn has_left(&self, id: ContactId) -> bool {
        self.bundle(id).is_some_and(|(bundle, lane)| bundle.has_left(lane))
    }

    /// The contacts with a gap of no more than `margin` (m).
    pub fn within(&self, margin: f32) -> impl Iterator<Item = ContactId> {
        self.colors.iter().flat_map(move |Color { bundles, contacts, .. }| {
            let gaps = bundles.iter().flat_map(|bundle| &bundle.lines[field::GAP].0);
            let near = contacts.iter().zip(gaps).filter(move |(_, gap)| **gap <= margin);
            near.map(|(&contact, _)| ContactId(contact))
        })
    }

    /// The rows of a contact's bodies.
    pub fn rows(&self, id: ContactId) -> [u32; 2] {
        self.bundle(id).map_or([0; 2], |(bundle, lane)| [bundle.a[lane], bundle.b[lane]])
    }

    /// Removes a contact; the last of its colour takes its lane.
    pub fn remove(&mut self, id: ContactId) {
        let Some((color, lane)) = self.place(id) else { return };
        let color = &mut self.colors[color];
        let last = color.contacts.len() - 1;
        let (rows, _) = color.bundles[lane / LANES].read(lane % LANES);
        rows.into_iter().for_each(|row| color.mark(row, false));
        if last != lane {
            let (rows, moved) = color.bundles[last / LANES].read(last % LANES);
            color.bundles[lane / LANES].write(lane % LANES, rows, &moved);
            let contact = color.contacts[last];
            color.contacts[lane] = contact;
            self.places[contact as usize].lane = lane as u32;
        }
        color.contacts.pop();
        if last.is_multiple_of(LANES) {
            color.bundles.pop();
        } else {
            color.bundles[last / LANES].write(last % LANES, [0; 2], &NO_CONTACT);
        }
        self.places[id.index()] = Place::NOWHERE;
        self.free.push(id.0);
        self.islands.is_stale = true;
    }

    /// The body of row `from` has moved to row `to`.
    pub fn rename_row(&mut self, from: u32, to: u32) {
        for color in &mut self.colors {
            for bundle in &mut color.bundles {
                for row in bundle.a.iter_mut().chain(&mut bundle.b).filter(|row| **row == from) {
                    *row = to;
                }
            }
            let taken = color.is_taken(from);
            color.mark(from, false);
            color.mark(to, taken);
        }
        self.islands.rename_row(from as usize, to as usize);
        self.islands.is_stale = true;
    }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod validate;
