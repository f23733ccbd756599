//! Small stiff islands, solved directly.
//!
//! Sweeps carry an impulse one contact further at a time: a tall stack, a heavy body on a light one would need thousands. Where an
//! island is small and sweeps do not agree soon, this module asks for all velocities at once. With `J` the rows that press or
//! stick, `w` by how much they want to change the velocities along themselves, `M` the masses, and velocities `B u` where
//! `B·Bᵀ = M⁻¹`, in which what cannot move is simply zero, the multipliers' method (Hestenes 1969; Powell 1969) repeats
//!
//! ```text
//! (1 + GᵀDG) δu = −GᵀD(Gu − w)        δλ = −D(G(u + δu) − w)        G = JB
//! ```
//!
//! where each row of `D` is [`STIFFNESS`] times its effective mass: two or three rounds leave nothing, if the rows are the right
//! ones. After [`MULTIPLIERS`] rounds impulses that pull are set to zero, those outside Coulomb's cone are put back on it, and some sweeps
//! follow (as in Silcowitz, Niebe and Erleben 2009, *Projected Gauss–Seidel subspace minimization*). As long as that helps, the
//! rows stay as they are, although some are wrong: what they do wrong is near them, and sweeps undo it, while another set of rows
//! is another matrix. When it helps no more, the search goes on with the rows that press or stick now.
//!
//! The matrix (`direct/matrix.rs`) has a block of six for each body and one for each pair in contact; it is factored in an order of
//! least degree (`direct/elimination.rs`), without pivots, as it is positive definite.

mod contact;
mod elimination;
mod matrix;
mod mover;
mod vector;

use super::bundle::{Bundle, POINTS, field};
use super::lanes::Row;
use contact::Contact;
use elimination::Elimination;
use matrix::Matrix;
use mover::Mover;
use std::collections::BTreeMap;
use vector::{Vector, ZERO, add_scaled};

pub(crate) use mover::Mobility;

/// An island may have so many bodies.
pub(crate) const BODIES: usize = 1024;

/// Blocks multiplied, about, after which no further set is tried; and in one set, at most: ten milliseconds. A pyramid of 820 boxes takes
/// 280,000, a thousand boxes packed into a pit 950,000.
const WORK: usize = 1_000_000;
const LARGEST: usize = 400_000;

/// Rows' stiffness in units of their effective mass.
const STIFFNESS: f64 = 1e5;

/// Rounds of multipliers between two looks at what contacts can exert: one would leave little at each contact of a tall stack, but
/// much from its bottom to its top.
const MULTIPLIERS: usize = 3;

/// Sets of rows that are tried.
const SETS: usize = 12;

/// Sweeps after these rounds.
const SWEEPS: usize = 3;

/// A look helps if the last sweep after it changes no velocity by more than this share of what it was.
const HELPS: f64 = 0.4;

/// Velocities that change by more than this, in units of the exactness, have run away: more rows press than bodies can obey, as
/// in piles, and no other set will do.
const RUNAWAY: f64 = 1e10;

/// An island that is being solved.
#[derive(Default)]
pub(crate) struct Island {
    movers: Vec<Mover>,
    /// The number of each row's mover.
    numbers: BTreeMap<u32, usize>,
    contacts: Vec<Contact>,
    /// What has been changed of each body's velocity, scaled: `u`.
    changes: Vec<Vector>,
}

impl Island {
    /// No contacts yet, and room for so many.
    pub fn with_room(contacts: usize) -> Self {
        Self { contacts: Vec::with_capacity(contacts), ..Self::default() }
    }

    /// Adds the contact in a lane. `mobility` tells how the body of a row answers to impulses, if it does.
    pub fn add(
        &mut self,
        bundle: &Bundle,
        lane: usize,
        velocities: &[Row],
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) {
        let rows = [bundle.a[lane], bundle.b[lane]];
        let numbers = rows.map(|row| mobility(row).map(|it| self.number(row, it, velocities)));
        self.contacts.push(Contact::new((bundle, lane), numbers, &self.movers, velocities));
    }

    fn number(&mut self, row: u32, mobility: Mobility, velocities: &[Row]) -> usize {
        *self.numbers.entry(row).or_insert_with(|| {
            self.movers.push(Mover::new(row, &velocities[row as usize], mobility));
            self.changes.push(ZERO);
            self.movers.len() - 1
        })
    }

    /// The impulses of contact number `contact`, in the order of [`field::IMPULSES`].
    pub fn impulses(&self, contact: usize) -> [f32; field::ROWS] {
        std::array::from_fn(|number| self.contacts[contact].unknowns[number].impulse as f32)
    }

    /// Writes the velocities found.
    pub fn write(&self, velocities: &mut [Row]) {
        for (mover, change) in self.movers.iter().zip(&self.changes) {
            let velocity = mover.after(change).map(|value| value as f32);
            velocities[mover.row as usize].0[..6].copy_from_slice(&velocity);
        }
    }

    /// Solves until no unknown's velocity is further than `exactness` (m/s) from what it asks for; false if it seems that this will
    /// not be. Then what has been found is of no use.
    pub fn solve(&mut self, exactness: f64) -> bool {
        if self.movers.is_empty() {
            return true;
        }
        let elimination = self.elimination();
        let work = elimination.work();
        if work > LARGEST {
            return false;
        }
        let sets = SETS.min(1 + WORK / work.max(1));
        let mut matrix = Matrix::new(elimination);
        let mut before = f64::INFINITY;
        for set in 0..sets {
            self.activate(set == 0);
            self.assemble(&mut matrix);
            matrix.factor();
            loop {
                (0..MULTIPLIERS).for_each(|_| self.step(&matrix));
                self.project();
                // Not after the sweeps: they smooth what is left, which then seems little everywhere.
                if self.residual() <= exactness {
                    return true;
                }
                let change = (0..SWEEPS).fold(0.0, |_, _| self.sweep());
                if change > RUNAWAY * exactness {
                    return false;
                }
                let helps = change < HELPS * before;
                before = change;
                if !helps {
                    break;
                }
            }
        }
        false
    }

    /// In which order bodies are eliminated, whichever rows act.
    fn elimination(&self) -> Elimination {
        let acts = |contact: &&Contact| (0..field::ROWS).any(|number| contact.could_act(number));
        let pairs = self.contacts.iter().filter(acts).map(|contact| contact.movers);
        Elimination::new(self.movers.len(), pairs.filter(|[one, other]| one != other))
    }

    /// How far the worst unknown is from what it asks for, m/s.
    fn residual(&self) -> f64 {
        let of_contact =
            |contact: &Contact| contact.distance(contact.answer(&self.changes).map(|(impulse, _)| impulse));
        self.contacts.iter().map(of_contact).fold(0.0, f64::max)
    }

    /// Finds which unknowns press or stick, and lets the others have the impulses that they can exert.
    ///
    /// The `first_time` all that could are taken to: what does not is seen afterwards, while to find from nothing what presses would take
    /// a set for every layer of a stack.
    fn activate(&mut self, first_time: bool) {
        for contact in &mut self.contacts {
            let is_pressed = contact.is_pressed();
            for (number, (impulse, is_active)) in contact.answer(&self.changes).into_iter().enumerate() {
                let is_open = number < POINTS || !is_pressed;
                let is_active = is_active || (first_time && is_open && contact.could_act(number));
                contact.unknowns[number].is_active = is_active;
                if !is_active {
                    contact.set(number, impulse, &mut self.changes);
                }
            }
        }
    }

    fn assemble(&self, matrix: &mut Matrix) {
        matrix.reset();
        for Contact { movers, unknowns, .. } in &self.contacts {
            let active = unknowns.iter().filter(|unknown| unknown.is_active);
            if active.clone().next().is_some() {
                matrix.add(*movers, active.map(|unknown| (&unknown.sides, STIFFNESS * unknown.mass)));
            }
        }
    }

    /// One round of multipliers.
    fn step(&mut self, matrix: &Matrix) {
        let mut gains = vec![ZERO; self.movers.len()];
        for contact in &self.contacts {
            for (number, unknown) in contact.unknowns.iter().enumerate().filter(|it| it.1.is_active) {
                let push = STIFFNESS * unknown.mass * contact.lack(number, &self.changes);
                for (mover, side) in contact.movers.into_iter().zip(&unknown.sides) {
                    add_scaled(&mut gains[mover], side, push);
                }
            }
        }
        matrix.solve(&mut gains);
        for (change, gain) in self.changes.iter_mut().zip(&gains) {
            add_scaled(change, gain, 1.0);
        }
        for contact in &mut self.contacts {
            for number in 0..field::ROWS {
                if contact.unknowns[number].is_active {
                    let lack = contact.lack(number, &self.changes);
                    let unknown = &mut contact.unknowns[number];
                    unknown.impulse += STIFFNESS * unknown.mass * lack;
                }
            }
        }
    }

    /// One sweep of Gauss–Seidel, which tells the rows that press and stick from those that do not; the largest change of a velocity,
    /// m/s.
    fn sweep(&mut self) -> f64 {
        self.contacts.iter_mut().map(|contact| contact.sweep(&mut self.changes)).fold(0.0, f64::max)
    }

    /// Puts impulses back to what contacts can exert.
    fn project(&mut self) {
        self.contacts.iter_mut().for_each(|contact| contact.project(&mut self.changes));
    }
}
