//! Rows of numbers that the kernels gather: one for each body that rests on something.
//!
//! World positions are far too large for single precision, so that what is kept here is relative: velocities, and the motion
//! since the body's *anchor*, the pose that it had when its contacts were last looked at closely.

#![allow(unsafe_code, reason = "rows that several threads change at once, each its own")]

use super::lanes::{Row, WRITABLE};
use crate::bodies::{Bodies, WORLD_ROW};
use crate::math::{DVec3, Pose};
use std::cell::UnsafeCell;

/// All bodies' rows; row 0 is the world's.
pub(crate) struct Rows {
    /// Linear and angular velocity (m/s, rad/s), inverse mass, and whether anything can change them.
    pub velocities: Vec<Row>,
    /// Translation (m) and turn `(x, y, z, w)` since the anchor; and the body's [`LEASH`].
    pub drifts: Vec<Row>,
    /// Poses that bodies had when their contacts were last looked at.
    pub anchors: Vec<Pose>,
    /// What contacts gave to it in the last substep in which it had any, laid out like velocities.
    pub given: Vec<Row>,
    /// Where the body has not gone far from, m, and for how long, s.
    haunts: Vec<(DVec3, f64)>,
    /// How many contacts the body has.
    contacts: Vec<u32>,
    /// The bodies that have any, ascending.
    held: Vec<usize>,
    held_is_stale: bool,
}

const UNTURNED: Row = Row([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);

/// Which number of a drift tells how far (m) a body and another one may move against each other until their contacts are renewed; the
/// larger one counts.
pub(crate) const LEASH: usize = 7;

impl Rows {
    pub fn new() -> Self {
        let mut rows = Self {
            velocities: Vec::new(),
            drifts: Vec::new(),
            anchors: Vec::new(),
            given: Vec::new(),
            haunts: Vec::new(),
            contacts: Vec::new(),
            held: Vec::new(),
            held_is_stale: false,
        };
        rows.grow(1);
        rows
    }

    /// Makes room for `count` rows.
    pub fn grow(&mut self, count: usize) {
        if count > self.contacts.len() {
            self.velocities.resize(count, Row::ZERO);
            self.drifts.resize(count, UNTURNED);
            self.anchors.resize(count, Pose::IDENTITY);
            self.given.resize(count, Row::ZERO);
            self.haunts.resize(count, (DVec3::NAN, 0.0));
            self.contacts.resize(count, 0);
        }
    }

    /// Takes a row out as `Vec::swap_remove` does.
    pub fn swap_remove(&mut self, row: usize) {
        if row < self.contacts.len() {
            self.velocities.swap_remove(row);
            self.drifts.swap_remove(row);
            self.anchors.swap_remove(row);
            self.given.swap_remove(row);
            self.haunts.swap_remove(row);
            self.contacts.swap_remove(row);
            self.held_is_stale = true;
        }
    }

    /// The bodies that have contacts, ascending.
    pub fn held(&mut self) -> &[usize] {
        if self.held_is_stale {
            let rows = self.contacts.iter().enumerate().skip(1);
            self.held = rows.filter(|(_, count)| **count > 0).map(|(row, _)| row).collect();
            self.held_is_stale = false;
        }
        &self.held
    }

    pub fn is_held(&self, row: usize) -> bool {
        self.contacts.get(row).is_some_and(|&count| count > 0)
    }

    /// How many contacts the body of a row has.
    #[cfg(test)]
    pub fn count(&self, row: usize) -> u32 {
        self.contacts.get(row).copied().unwrap_or(0)
    }

    /// Counts one more contact of a body.
    pub fn hold(&mut self, row: usize) {
        if row != WORLD_ROW {
            self.contacts[row] += 1;
            self.held_is_stale |= self.contacts[row] == 1;
        }
    }

    /// Counts one contact less.
    pub fn let_go(&mut self, row: usize) {
        if row != WORLD_ROW {
            self.contacts[row] -= 1;
            self.held_is_stale |= self.contacts[row] == 0;
        }
    }

    /// Reads a body's velocity, with `gain` (m/s, rad/s) added.
    pub fn read_velocity(&mut self, bodies: &Bodies, row: usize, gain: [DVec3; 2]) {
        let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
        let writable = constants.is_movable() && !bodies.is_asleep(row);
        let linear = (state.velocity + gain[0]).as_vec3();
        let angular = (constants.angular_velocity(state) + gain[1]).as_vec3();
        let inverse_mass = if writable { constants.inverse_mass as f32 } else { 0.0 };
        let mut values = [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z, inverse_mass, 0.0];
        values[WRITABLE] = f32::from(writable);
        self.velocities[row] = Row(values);
    }

    /// For how long (s) a body has stayed within `radius` (m) of some place, now that `time` (s) has passed.
    pub fn stay(&mut self, row: usize, place: DVec3, (radius, time): (f64, f64)) -> f64 {
        let (haunt, since) = &mut self.haunts[row];
        if haunt.distance(place) <= radius {
            *since += time;
        } else {
            (*haunt, *since) = (place, 0.0);
        }
        *since
    }

    /// A body is where its contacts are looked at.
    pub fn anchor(&mut self, bodies: &Bodies, row: usize) {
        if row != WORLD_ROW {
            let state = &bodies.states[row];
            self.anchors[row] = Pose::new(state.position, state.rotation);
            self.drifts[row].0[..LEASH].copy_from_slice(&UNTURNED.0[..LEASH]);
        }
    }

    /// Sets how far (m) a body and another one may move against each other.
    pub fn set_leash(&mut self, row: usize, leash: f64) {
        self.drifts[row].0[LEASH] = leash as f32;
    }

    /// Reads how far a body is from its anchor: the distance, m, and the sine of half the angle, both squared.
    pub fn read_drift(&mut self, bodies: &Bodies, row: usize) -> [f64; 2] {
        let (state, anchor) = (&bodies.states[row], &self.anchors[row]);
        let moved = state.position - anchor.position;
        let turn = state.rotation * anchor.rotation.conjugate();
        let (linear, turned) = (moved.as_vec3(), turn.as_quat());
        let leash = self.drifts[row].0[LEASH];
        self.drifts[row] = Row([linear.x, linear.y, linear.z, turned.x, turned.y, turned.z, turned.w, leash]);
        let sine = turn.x * turn.x + turn.y * turn.y + turn.z * turn.z;
        [moved.length_squared(), sine]
    }

    /// The drift of a body, as the kernels see it.
    pub fn drift(&self, row: usize) -> (DVec3, [f64; 4]) {
        let [x, y, z, i, j, k, w, _] = self.drifts[row].0.map(f64::from);
        (DVec3::new(x, y, z), [i, j, k, w])
    }
}

/// Rows that a kernel gathers from.
///
/// # Safety
/// What `at` points to can be read as long as the source is there.
pub(crate) unsafe trait Source: Copy {
    /// The row of this index.
    fn at(self, index: u32) -> *const Row;
}

// SAFETY: it points to a row of the slice.
unsafe impl Source for &[Row] {
    #[inline(always)]
    fn at(self, index: u32) -> *const Row {
        &raw const self[index as usize]
    }
}

/// Rows that several threads read and change at once: those of the bodies of one colour's contacts, for a sweep over its bundles.
///
/// A row that is writable belongs to a body that can be moved, and such a body has at most one contact of a colour: `Graph::insert`
/// sees to it, and `Graph::validate` holds it to that in tests. So one thread at most reads and writes this row, that which has the
/// bundle of this contact. All others, the world's before all, are only read: [`Lanes::scatter`](super::lanes::Lanes::scatter) leaves
/// out what is not [`WRITABLE`].
#[derive(Clone, Copy)]
pub(crate) struct SharedRows<'a>(&'a [Slot]);

#[repr(transparent)]
struct Slot(UnsafeCell<Row>);

// SAFETY: no two threads are at one slot, unless both only read; see `SharedRows`.
unsafe impl Sync for Slot {}

impl<'a> SharedRows<'a> {
    /// Rows that nobody else has for now.
    pub fn new(rows: &'a mut [Row]) -> Self {
        // SAFETY: a slot is a row in memory, and the rows are borrowed for good.
        Self(unsafe { &*(std::ptr::from_mut(rows) as *const [Slot]) })
    }

    /// The row of this index, to be changed if it is writable.
    #[inline(always)]
    pub fn at_mut(self, index: u32) -> *mut Row {
        self.0[index as usize].0.get()
    }
}

// SAFETY: it points to a row of the slice.
unsafe impl Source for SharedRows<'_> {
    #[inline(always)]
    fn at(self, index: u32) -> *const Row {
        self.at_mut(index)
    }
}
