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

mod matrix;

use super::bundle::{Bundle, POINTS, field};
use super::lanes::Row;
use crate::math::{DMat3, DVec3};
use matrix::{Matrix, Vector, add_scaled, dot};

/// An island may have so many bodies.
pub(crate) const BODIES: usize = 256;

/// Blocks multiplied, about, after which no further set is tried.
const WORK: usize = 1_000_000;

/// A point that is out of reach asks for less than this, m/s.
const NEVER: f64 = -1e20;

/// Rows' stiffness in units of their effective mass.
const STIFFNESS: f64 = 1e5;

/// Rounds of multipliers for one set of rows, and sets of rows that are tried.
const MULTIPLIERS: usize = 3;
const SETS: usize = 12;

/// Sweeps between two sets.
const SWEEPS: usize = 8;

/// How a body answers to impulses: 1/kg, and 1/(kg·m²) in world axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mobility {
    pub inverse_mass: f64,
    pub inverse_inertia: DMat3,
}

/// A body of the island.
struct Mover {
    row: u32,
    velocity: Vector,
    /// `B` with `B·Bᵀ = M⁻¹`: of the mass, and of the inertia.
    roots: (f64, DMat3),
}

impl Mover {
    /// `Bᵀ` times an impulse.
    fn scaled(&self, impulse: &Vector) -> Vector {
        let (linear, angular) = split(impulse);
        join(linear * self.roots.0, self.roots.1.transpose() * angular)
    }

    /// Changes the velocity by `B` times what is scaled.
    fn gain(&mut self, scaled: &Vector, by: f64) {
        let (linear, angular) = split(scaled);
        add_scaled(&mut self.velocity, &join(linear * self.roots.0, self.roots.1 * angular), by);
    }
}

/// What a unit impulse does to a body.
#[derive(Clone, Debug)]
struct Push {
    mover: usize,
    /// `Jᵀ`, and `BᵀJᵀ`.
    unit: Vector,
    scaled: Vector,
}

/// One impulse that is asked for.
#[derive(Clone, Debug)]
struct Unknown {
    /// What a unit of it does to the bodies that it acts on.
    pushes: [Option<Push>; 2],
    /// The velocity that it is to bring about, along itself, less that of a side which nothing moves.
    wanted: f64,
    /// 1 / the response to a unit of it; 0 where there is none.
    mass: f64,
    impulse: f64,
    /// Whether it presses or sticks.
    is_active: bool,
}

impl Unknown {
    fn pushes(&self) -> impl Iterator<Item = &Push> {
        self.pushes.iter().flatten()
    }
}

/// A contact of the island: its unknowns are [`field::ROWS`] in a row, in the order of [`field::IMPULSES`].
struct Contact {
    static_friction: f64,
    dynamic_friction: f64,
    levers: [f64; POINTS],
}

/// An island that is being solved.
#[derive(Default)]
pub(crate) struct Island {
    movers: Vec<Mover>,
    unknowns: Vec<Unknown>,
    contacts: Vec<Contact>,
}

fn split(v: &Vector) -> (DVec3, DVec3) {
    (DVec3::new(v[0], v[1], v[2]), DVec3::new(v[3], v[4], v[5]))
}

fn join(linear: DVec3, angular: DVec3) -> Vector {
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

fn velocity_of(row: &Row) -> Vector {
    std::array::from_fn(|axis| f64::from(row.0[axis]))
}

/// `B` with `B·Bᵀ = A`, for a positive semidefinite `A`: Cholesky's factor, without the columns that are nothing but rounding.
fn root(a: &DMat3) -> DMat3 {
    const ROUNDING: f64 = 1e-12;
    let least = ROUNDING * (a.x_axis.x + a.y_axis.y + a.z_axis.z);
    let mut rest = *a;
    let mut columns = [DVec3::ZERO; 3];
    for (axis, column) in columns.iter_mut().enumerate() {
        let pivot = rest.col(axis)[axis];
        if pivot > least {
            *column = rest.col(axis) / pivot.sqrt();
            let [x, y, z] = column.to_array();
            rest -= DMat3::from_cols(*column * x, *column * y, *column * z);
        }
    }
    DMat3::from_cols_array_2d(&columns.map(|column| column.to_array()))
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
        let get = |field: usize| f64::from(bundle.get(lane, field));
        let vector = |field: usize| DVec3::new(get(field), get(field + 1), get(field + 2));
        let (normal, first) = (vector(field::NORMAL), vector(field::TANGENT));
        let second = normal.cross(first);
        let outward = |v: DVec3| first * v.x + second * v.y + normal * v.z;
        let rows = [bundle.a[lane], bundle.b[lane]];
        let numbers = rows.map(|row| mobility(row).map(|it| self.number(row, it, velocities)));

        let mut unknown = |directions: [Vector; 2], wanted: f64, number: usize| {
            let pushes = [0, 1].map(|side| {
                let unit = directions[side];
                numbers[side].map(|mover| Push { mover, unit, scaled: self.movers[mover].scaled(&unit) })
            });
            let response: f64 = pushes.iter().flatten().map(|push| dot(&push.scaled, &push.scaled)).sum();
            // Friction's is that of its largest response, so that what slides does not overshoot.
            let largest = if number < POINTS { f64::INFINITY } else { get(field::MASSES[number]) };
            let is_real = get(field::MASSES[number]) > 0.0 && response > 0.0;
            let mass = if is_real { (1.0 / response).min(largest) } else { 0.0 };
            let impulse = get(field::IMPULSES[number]);
            let held = [0, 1].map(|side| match numbers[side] {
                Some(_) => 0.0,
                None => dot(&directions[side], &velocity_of(&velocities[rows[side] as usize])),
            });
            let wanted = wanted - held[0] - held[1];
            self.unknowns.push(Unknown { pushes, wanted, mass, impulse, is_active: false });
        };
        let along = |direction: DVec3, arms: [DVec3; 2]| {
            [join(-direction, -arms[0].cross(direction)), join(direction, arms[1].cross(direction))]
        };
        for point in 0..POINTS {
            let at = |line: usize| field::of_point(point, line);
            let arms = [outward(vector(at(field::ARM_A))), outward(vector(at(field::ARM_B)))];
            unknown(along(normal, arms), get(at(field::LEAST)), point);
        }
        let arms = [outward(vector(field::FRICTION_ARM_A)), outward(vector(field::FRICTION_ARM_B))];
        unknown(along(first, arms), -get(field::SWING), POINTS);
        unknown(along(second, arms), -get(field::SWING + 1), POINTS + 1);
        unknown([join(DVec3::ZERO, -normal), join(DVec3::ZERO, normal)], 0.0, POINTS + 2);
        self.contacts.push(Contact {
            static_friction: get(field::STATIC_FRICTION),
            dynamic_friction: get(field::DYNAMIC_FRICTION),
            levers: std::array::from_fn(|point| get(field::of_point(point, field::LEVER))),
        });
    }

    fn number(&mut self, row: u32, mobility: Mobility, velocities: &[Row]) -> usize {
        self.movers.iter().position(|mover| mover.row == row).unwrap_or_else(|| {
            let velocity = velocity_of(&velocities[row as usize]);
            let roots = (mobility.inverse_mass.sqrt(), root(&mobility.inverse_inertia));
            self.movers.push(Mover { row, velocity, roots });
            self.movers.len() - 1
        })
    }

    /// The impulses of contact number `contact`, in the order of [`field::IMPULSES`].
    pub fn impulses(&self, contact: usize) -> [f32; field::ROWS] {
        std::array::from_fn(|number| self.unknowns[contact * field::ROWS + number].impulse as f32)
    }

    /// Writes the velocities found.
    pub fn write(&self, velocities: &mut [Row]) {
        for mover in &self.movers {
            for axis in 0..6 {
                velocities[mover.row as usize].0[axis] = mover.velocity[axis] as f32;
            }
        }
    }

    /// Solves until no unknown's velocity is further than `exactness` (m/s) from what it asks for; false if it seems that this will
    /// not be. Then what has been found is of no use.
    pub fn solve(&mut self, exactness: f64) -> bool {
        let mut matrix = Matrix::new(self.movers.len());
        let mut work = 0;
        for set in 0..SETS {
            if work > WORK {
                break;
            }
            self.activate(set == 0);
            self.assemble(&mut matrix);
            work += matrix.factor();
            for _ in 0..MULTIPLIERS {
                self.step(&matrix);
            }
            self.project();
            if self.residual() <= exactness {
                return true;
            }
            for _ in 0..SWEEPS {
                self.sweep();
            }
        }
        false
    }

    /// The velocity of a contact along an unknown.
    fn velocity(&self, unknown: &Unknown) -> f64 {
        unknown.pushes().map(|push| dot(&push.unit, &self.movers[push.mover].velocity)).sum()
    }

    /// Gives an unknown another impulse.
    fn set(&mut self, index: usize, impulse: f64) {
        let unknown = &mut self.unknowns[index];
        let change = impulse - unknown.impulse;
        unknown.impulse = impulse;
        if change != 0.0 {
            for push in unknown.pushes() {
                self.movers[push.mover].gain(&push.scaled, change);
            }
        }
    }

    /// The impulses that contact number `contact` would exert, were each of its unknowns alone: what it has and what it lacks, as far as
    /// it may push; and which of them press or stick.
    fn answer(&self, contact: usize) -> [(f64, bool); field::ROWS] {
        let first = contact * field::ROWS;
        let mut answer = std::array::from_fn(|number| {
            let unknown = &self.unknowns[first + number];
            let wanted = unknown.impulse + unknown.mass * (unknown.wanted - self.velocity(unknown));
            (wanted, unknown.mass > 0.0)
        });
        for (impulse, presses) in &mut answer[..POINTS] {
            *presses &= *impulse > 0.0;
            *impulse = impulse.max(0.0);
        }
        let (friction, twist) = self.limits(contact);
        for (numbers, [most, sliding]) in [(POINTS..POINTS + 2, friction), (POINTS + 2..POINTS + 3, twist)] {
            let size =
                answer[numbers.clone()].iter().map(|(impulse, _)| impulse * impulse).sum::<f64>().sqrt();
            let slides = size > most || most == 0.0;
            let share = if slides && size > sliding { sliding / size } else { 1.0 };
            for (impulse, sticks) in &mut answer[numbers] {
                *sticks &= !slides;
                *impulse *= share;
            }
        }
        answer
    }

    /// How far the worst unknown is from what it asks for, m/s.
    fn residual(&self) -> f64 {
        let mut residual = 0.0_f64;
        for (answers, unknowns) in
            (0..self.contacts.len()).map(|it| self.answer(it)).zip(self.unknowns.chunks(field::ROWS))
        {
            for ((impulse, _), unknown) in answers.into_iter().zip(unknowns).filter(|it| it.1.mass > 0.0) {
                residual = residual.max((impulse - unknown.impulse).abs() / unknown.mass);
            }
        }
        residual
    }

    /// Finds which unknowns press or stick, and lets the others have the impulses that they can exert.
    ///
    /// The `first_time` all that could are taken to: what does not is seen afterwards, while to find from nothing what presses would take
    /// a set for every layer of a stack.
    fn activate(&mut self, first_time: bool) {
        for contact in 0..self.contacts.len() {
            let (friction, _) = self.limits(contact);
            let is_rough = self.contacts[contact].static_friction > 0.0;
            for (number, (impulse, is_active)) in self.answer(contact).into_iter().enumerate() {
                let index = contact * field::ROWS + number;
                let unknown = &mut self.unknowns[index];
                let could =
                    if number < POINTS { unknown.wanted > NEVER } else { is_rough && friction[0] == 0.0 };
                unknown.is_active = is_active || (first_time && could && unknown.mass > 0.0);
                if !unknown.is_active {
                    self.set(index, impulse);
                }
            }
        }
    }

    /// What friction and twist may be, sticking and sliding.
    fn limits(&self, contact: usize) -> ([f64; 2], [f64; 2]) {
        let Contact { static_friction, dynamic_friction, levers } = &self.contacts[contact];
        let points = &self.unknowns[contact * field::ROWS..][..POINTS];
        let pressure: f64 = points.iter().map(|unknown| unknown.impulse).sum();
        let moment: f64 = points.iter().zip(levers).map(|(unknown, lever)| unknown.impulse * lever).sum();
        let both = |load: f64| [static_friction * load, dynamic_friction * load];
        (both(pressure), both(moment))
    }

    fn assemble(&self, matrix: &mut Matrix) {
        matrix.clear();
        (0..self.movers.len()).for_each(|index| matrix.add_identity(index));
        for unknown in self.unknowns.iter().filter(|unknown| unknown.is_active) {
            for one in unknown.pushes() {
                for other in unknown.pushes() {
                    let blocks = (one.mover, other.mover);
                    matrix.add_product(blocks, (&one.scaled, &other.scaled), STIFFNESS * unknown.mass);
                }
            }
        }
    }

    /// One round of multipliers.
    fn step(&mut self, matrix: &Matrix) {
        let mut change = vec![[0.0; 6]; self.movers.len()];
        for unknown in self.unknowns.iter().filter(|unknown| unknown.is_active) {
            let lack = unknown.wanted - self.velocity(unknown);
            for push in unknown.pushes() {
                add_scaled(&mut change[push.mover], &push.scaled, STIFFNESS * unknown.mass * lack);
            }
        }
        matrix.solve(&mut change);
        for index in 0..self.unknowns.len() {
            let unknown = &self.unknowns[index];
            if unknown.is_active {
                let gained: f64 = unknown.pushes().map(|push| dot(&push.scaled, &change[push.mover])).sum();
                let lack = unknown.wanted - self.velocity(unknown) - gained;
                self.unknowns[index].impulse += STIFFNESS * unknown.mass * lack;
            }
        }
        for (mover, change) in self.movers.iter_mut().zip(&change) {
            mover.gain(change, 1.0);
        }
    }

    /// One sweep of Gauss–Seidel, which tells the rows that press and stick from those that do not.
    fn sweep(&mut self) {
        for contact in 0..self.contacts.len() {
            let first = contact * field::ROWS;
            for index in first..first + field::ROWS {
                let unknown = &self.unknowns[index];
                let lack = unknown.wanted - self.velocity(unknown);
                let impulse = unknown.impulse + unknown.mass * lack;
                // At once: what a point out of reach asks for would leave nothing of the velocity but its rounding.
                self.set(index, if index < first + POINTS { impulse.max(0.0) } else { impulse });
            }
            self.project_friction(contact);
        }
    }

    /// Puts impulses back to what contacts can exert.
    fn project(&mut self) {
        for contact in 0..self.contacts.len() {
            let first = contact * field::ROWS;
            for point in first..first + POINTS {
                self.set(point, self.unknowns[point].impulse.max(0.0));
            }
            self.project_friction(contact);
        }
    }

    fn project_friction(&mut self, contact: usize) {
        let first = contact * field::ROWS;
        let (friction, twist) = self.limits(contact);
        let (x, y) = (self.unknowns[first + POINTS].impulse, self.unknowns[first + POINTS + 1].impulse);
        let size = (x * x + y * y).sqrt();
        if size > friction[0] {
            let share = (friction[1] / size).min(1.0);
            self.set(first + POINTS, share * x);
            self.set(first + POINTS + 1, share * y);
        }
        let turn = self.unknowns[first + POINTS + 2].impulse;
        if turn.abs() > twist[0] {
            self.set(first + POINTS + 2, turn.clamp(-twist[1], twist[1]));
        }
    }
}
