//! Small stiff islands, solved directly.
//!
//! Sweeps carry an impulse one contact further at a time: a tall stack, a heavy body on a light one would need thousands. Where an
//! island is small and sweeps do not agree soon, this file asks for all velocities at once. With `J` the rows that press or
//! stick, `w` what they ask for and `M` the masses, the multipliers' method (Hestenes 1969; Powell 1969) repeats
//!
//! ```text
//! (1 + BᵀJᵀDJB) δu = −BᵀJᵀD(Jv − w)        δv = B δu        δλ = −D(J(v + δv) − w)        M δv = Jᵀ δλ
//! ```
//!
//! where `B·Bᵀ = M⁻¹`, in which what cannot move is simply zero, and each row of `D` is [`STIFFNESS`] times its effective mass:
//! two or three rounds leave nothing. Then impulses that pull are set to zero, those outside Coulomb's cone are put back on
//! it, and the search goes on with the rows that press or stick now, after some sweeps (as in Silcowitz, Niebe and Erleben 2009, *Projected Gauss–Seidel subspace minimization*).
//!
//! The matrix has a block of six for each body and one for each pair in contact; it is factored in an order of least degree,
//! without pivots, as it is positive definite.

mod contact;
mod elimination;
mod matrix;
mod mover;
mod vector;

use super::bundle::{Bundle, field};
use super::lanes::Row;
use contact::Contact;
use elimination::Elimination;
use matrix::Matrix;
use mover::Mover;
use vector::{Vector, ZERO, add_scaled};

pub(crate) use mover::Mobility;

/// An island may have so many bodies.
pub(crate) const BODIES: usize = 256;

/// Blocks multiplied, about, after which no further set is tried.
const WORK: usize = 1_000_000;

/// Rows' stiffness in units of their effective mass.
const STIFFNESS: f64 = 1e5;

/// Rounds of multipliers for one set of rows, and sets of rows that are tried.
const MULTIPLIERS: usize = 3;
const SETS: usize = 12;

/// Sweeps between two sets.
const SWEEPS: usize = 8;

/// An island that is being solved.
#[derive(Default)]
pub(crate) struct Island {
    movers: Vec<Mover>,
    contacts: Vec<Contact>,
    /// What has been changed of each body's velocity, scaled: `u`.
    changes: Vec<Vector>,
}

impl Island {
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
        self.movers.iter().position(|mover| mover.row == row).unwrap_or_else(|| {
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
            let velocity = mover.after(change);
            for axis in 0..6 {
                velocities[mover.row as usize].0[axis] = velocity[axis] as f32;
            }
        }
    }

    /// Solves until no unknown's velocity is further than `exactness` (m/s) from what it asks for; false if it seems that this will
    /// not be. Then what has been found is of no use.
    pub fn solve(&mut self, exactness: f64) -> bool {
        if self.movers.is_empty() {
            return true;
        }
        let clock = std::time::Instant::now();
        let elimination = self.elimination();
        let work = elimination.work();
        let mut matrix = Matrix::new(elimination);
        eprint!("n {} c {} work {work} order {:.0?}", self.movers.len(), self.contacts.len(), clock.elapsed());
        let sets = SETS.min(1 + WORK / work.max(1));
        for set in 0..sets {
            self.activate(set == 0);
            let t0 = clock.elapsed();
            self.assemble(&mut matrix);
            let t1 = clock.elapsed();
            matrix.factor();
            let t2 = clock.elapsed();
            for _ in 0..MULTIPLIERS {
                self.step(&matrix);
            }
            self.project();
            let t3 = clock.elapsed();
            eprint!(" | {:.1e} {:.0?} {:.0?} {:.0?}", self.residual(), t1 - t0, t2 - t1, t3 - t2);
            if self.residual() <= exactness {
                eprintln!(" ok {:.0?}", clock.elapsed());
                return true;
            }
            for _ in 0..SWEEPS {
                self.sweep();
            }
            eprint!(" {:.0?}", clock.elapsed() - t3);
        }
        eprintln!(" FAIL {:.0?}", clock.elapsed());
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
        let mut residual = 0.0_f64;
        for contact in &self.contacts {
            for ((impulse, _), unknown) in contact.answer(&self.changes).into_iter().zip(&contact.unknowns) {
                if unknown.mass > 0.0 {
                    residual = residual.max((impulse - unknown.impulse).abs() / unknown.mass);
                }
            }
        }
        residual
    }

    /// Finds which unknowns press or stick, and lets the others have the impulses that they can exert.
    ///
    /// The `first_time` all that could are taken to: what does not is seen afterwards, while to find from nothing what presses would take
    /// a set for every layer of a stack.
    fn activate(&mut self, first_time: bool) {
        for contact in &mut self.contacts {
            let is_pressed = contact.is_pressed();
            for (number, (impulse, is_active)) in contact.answer(&self.changes).into_iter().enumerate() {
                let is_open = number < super::bundle::POINTS || !is_pressed;
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

    /// One sweep of Gauss–Seidel, which tells the rows that press and stick from those that do not.
    fn sweep(&mut self) {
        self.contacts.iter_mut().for_each(|contact| contact.sweep(&mut self.changes));
    }

    /// Puts impulses back to what contacts can exert.
    fn project(&mut self) {
        self.contacts.iter_mut().for_each(|contact| contact.project(&mut self.changes));
    }
}
