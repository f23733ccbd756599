//! Small stiff islands, solved directly.
//!
//! Sweeps carry an impulse one contact further at a time: a tall stack, a heavy body on a light one would need thousands. Where an
//! island is small and sweeps do not agree soon, this file asks for all velocities at once. With `J` the rows that press or
//! stick, `w` what they ask for and `M` the masses, the multipliers' method (Hestenes 1969; Powell 1969) repeats
//!
//! ```text
//! (M + JᵀDJ) δv = −JᵀD(Jv − w)        δλ = −D(J(v + δv) − w)        M δv = Jᵀ δλ
//! ```
//!
//! where each row of `D` is [`STIFFNESS`] times its effective mass: two or three rounds leave nothing. Then impulses that pull are
//! set to zero, those outside Coulomb's cone are put back on it, and the search goes on with the rows that press or stick
//! now, after some sweeps (as in Silcowitz, Niebe and Erleben 2009, *Projected Gauss–Seidel subspace minimization*).
//!
//! The matrix has a block of six for each body and one for each pair in contact; it is factored in an order of least degree,
//! without pivots, as it is positive definite.

use super::bundle::{Bundle, POINTS, field};
use super::lanes::Row;
use crate::math::{DMat3, DVec3};

/// An island may have so many bodies.
pub(crate) const BODIES: usize = 256;

/// Bodies of an island, a bit each.
type Set = [u64; BODIES / 64];

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

type Vector = [f64; 6];
type Block = [[f64; 6]; 6];

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
    mobility: Mobility,
}

impl Mover {
    /// The velocity that an impulse (linear, angular) gives it.
    fn response(&self, impulse: &Vector) -> Vector {
        let (linear, angular) = split(impulse);
        join(linear * self.mobility.inverse_mass, self.mobility.inverse_inertia * angular)
    }
}

/// One impulse that is asked for.
#[derive(Clone, Debug)]
struct Unknown {
    /// The bodies that it acts on, and with what a unit of it pushes them.
    touches: [Option<(usize, Vector)>; 2],
    /// The velocity that it is to bring about, along itself.
    wanted: f64,
    /// 1 / the response to a unit of it; 0 where there is none.
    mass: f64,
    impulse: f64,
    /// Whether it presses or sticks.
    is_active: bool,
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

fn dot(a: &Vector, b: &Vector) -> f64 {
    (0..6).map(|axis| a[axis] * b[axis]).sum()
}

fn add_scaled(to: &mut Vector, v: &Vector, by: f64) {
    (0..6).for_each(|axis| to[axis] += by * v[axis]);
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
            let touches = [0, 1].map(|side| numbers[side].map(|mover| (mover, directions[side])));
            let response: f64 = touches
                .iter()
                .flatten()
                .map(|(mover, unit)| dot(unit, &self.movers[*mover].response(unit)))
                .sum();
            let mass = if get(field::MASSES[number]) > 0.0 && response > 0.0 { 1.0 / response } else { 0.0 };
            let impulse = get(field::IMPULSES[number]);
            self.unknowns.push(Unknown { touches, wanted, mass, impulse, is_active: false });
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
        unknown(along(first, arms), 0.0, POINTS);
        unknown(along(second, arms), 0.0, POINTS + 1);
        unknown([join(DVec3::ZERO, -normal), join(DVec3::ZERO, normal)], 0.0, POINTS + 2);
        self.contacts.push(Contact {
            static_friction: get(field::STATIC_FRICTION),
            dynamic_friction: get(field::DYNAMIC_FRICTION),
            levers: std::array::from_fn(|point| get(field::of_point(point, field::LEVER))),
        });
    }

    fn number(&mut self, row: u32, mobility: Mobility, velocities: &[Row]) -> usize {
        self.movers.iter().position(|mover| mover.row == row).unwrap_or_else(|| {
            let values = velocities[row as usize].0.map(f64::from);
            let velocity = std::array::from_fn(|axis| values[axis]);
            self.movers.push(Mover { row, velocity, mobility });
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

    /// Solves until no unknown's velocity is further than `exactness` (m/s) from what it asks for; returns how far it got.
    pub fn solve(&mut self, exactness: f64) -> f64 {
        let mut matrix = Matrix::new(self.movers.len());
        let mut work = 0;
        for set in 0..SETS {
            if work > WORK {
                break;
            }
            let residual = self.activate(set == 0);
            if set > 0 && residual <= exactness {
                return residual;
            }
            self.assemble(&mut matrix);
            work += matrix.factor();
            for _ in 0..MULTIPLIERS {
                self.step(&matrix);
            }
            self.project();
            for _ in 0..SWEEPS {
                self.sweep();
            }
        }
        self.activate(false)
    }

    /// The velocity of a contact along an unknown.
    fn velocity(&self, unknown: &Unknown) -> f64 {
        unknown.touches.iter().flatten().map(|(mover, unit)| dot(unit, &self.movers[*mover].velocity)).sum()
    }

    /// Gives an unknown another impulse.
    fn set(&mut self, index: usize, impulse: f64) {
        let unknown = &mut self.unknowns[index];
        let change = impulse - unknown.impulse;
        unknown.impulse = impulse;
        if change != 0.0 {
            for (mover, unit) in unknown.touches.into_iter().flatten() {
                let response = self.movers[mover].response(&unit);
                add_scaled(&mut self.movers[mover].velocity, &response, change);
            }
        }
    }

    /// Finds which unknowns press or stick; returns how far the worst is from what it asks for, m/s.
    ///
    /// The `first_time` all that could are taken to: what does not is seen afterwards, while to find from nothing what presses would take
    /// a set for every layer of a stack.
    fn activate(&mut self, first_time: bool) -> f64 {
        let mut residual = 0.0_f64;
        for contact in 0..self.contacts.len() {
            let first = contact * field::ROWS;
            let lacks: [f64; field::ROWS] = std::array::from_fn(|number| {
                let unknown = &self.unknowns[first + number];
                unknown.wanted - self.velocity(unknown)
            });
            for (unknown, lack) in self.unknowns[first..first + POINTS].iter_mut().zip(lacks) {
                let presses = unknown.impulse + unknown.mass * lack > 0.0;
                let could = first_time && unknown.wanted > NEVER;
                unknown.is_active = unknown.mass > 0.0 && (presses || could);
                if unknown.is_active {
                    residual = residual.max(lack.abs());
                }
            }
            let (friction, twist) = self.limits(contact);
            for (numbers, most) in [(POINTS..POINTS + 2, friction[0]), (POINTS + 2..POINTS + 3, twist[0])] {
                let wanted = |number: usize| {
                    let unknown = &self.unknowns[first + number];
                    unknown.impulse + unknown.mass * lacks[number]
                };
                let square: f64 = numbers.clone().map(|number| wanted(number) * wanted(number)).sum();
                let could = first_time && most == 0.0 && self.contacts[contact].static_friction > 0.0;
                let sticks = could || (most > 0.0 && square <= most * most);
                for number in numbers {
                    let unknown = &mut self.unknowns[first + number];
                    unknown.is_active = sticks && unknown.mass > 0.0;
                    if unknown.is_active {
                        residual = residual.max(lacks[number].abs());
                    }
                }
            }
        }
        residual
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
        for (index, mover) in self.movers.iter().enumerate() {
            matrix.add_mass(index, &mover.mobility);
        }
        for unknown in self.unknowns.iter().filter(|unknown| unknown.is_active) {
            let stiffness = STIFFNESS * unknown.mass;
            for (mover, unit) in unknown.touches.iter().flatten() {
                for (other, other_unit) in unknown.touches.iter().flatten() {
                    matrix.add_product((*mover, *other), (unit, other_unit), stiffness);
                }
            }
        }
    }

    /// One round of multipliers.
    fn step(&mut self, matrix: &Matrix) {
        let mut change = vec![[0.0; 6]; self.movers.len()];
        for unknown in self.unknowns.iter().filter(|unknown| unknown.is_active) {
            let push = STIFFNESS * unknown.mass * (unknown.wanted - self.velocity(unknown));
            for (mover, unit) in unknown.touches.iter().flatten() {
                add_scaled(&mut change[*mover], unit, push);
            }
        }
        matrix.solve(&mut change);
        for index in 0..self.unknowns.len() {
            let unknown = &self.unknowns[index];
            if unknown.is_active {
                let touches = unknown.touches.iter().flatten();
                let gained: f64 = touches.map(|(mover, unit)| dot(unit, &change[*mover])).sum();
                let lack = unknown.wanted - self.velocity(unknown) - gained;
                self.unknowns[index].impulse += STIFFNESS * unknown.mass * lack;
            }
        }
        for (mover, change) in self.movers.iter_mut().zip(&change) {
            add_scaled(&mut mover.velocity, change, 1.0);
        }
    }

    /// One sweep of Gauss–Seidel, which tells the rows that press and stick from those that do not.
    fn sweep(&mut self) {
        for contact in 0..self.contacts.len() {
            let first = contact * field::ROWS;
            for index in first..first + field::ROWS {
                let unknown = &self.unknowns[index];
                let lack = unknown.wanted - self.velocity(unknown);
                self.set(index, unknown.impulse + unknown.mass * lack);
                if index < first + POINTS {
                    self.set(index, self.unknowns[index].impulse.max(0.0));
                }
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

/// A symmetric positive definite matrix of blocks, and its factors `L·Lᵀ`.
struct Matrix {
    count: usize,
    /// Place of each block of the lower triangle in `blocks`, row after row; or [`ABSENT`].
    places: Vec<u32>,
    blocks: Vec<Block>,
    /// Bodies in the order in which they are eliminated, and the neighbours that each then still has.
    order: Vec<usize>,
    later: Vec<Vec<usize>>,
    neighbors: Vec<Set>,
}

const ABSENT: u32 = u32::MAX;

impl Matrix {
    fn new(count: usize) -> Self {
        Self {
            count,
            places: vec![ABSENT; count * count],
            blocks: Vec::new(),
            order: Vec::new(),
            later: Vec::new(),
            neighbors: vec![[0; BODIES / 64]; count],
        }
    }

    fn clear(&mut self) {
        self.places.fill(ABSENT);
        self.neighbors.fill([0; BODIES / 64]);
        self.blocks.clear();
        self.order.clear();
        self.later.clear();
    }

    /// The block of rows `row` and columns `column`.
    fn block(&mut self, row: usize, column: usize) -> &mut Block {
        let place = &mut self.places[row * self.count + column];
        if *place == ABSENT {
            *place = self.blocks.len() as u32;
            self.blocks.push([[0.0; 6]; 6]);
            if row != column {
                self.neighbors[row][column / 64] |= 1 << (column % 64);
            }
        }
        let place = *place as usize;
        &mut self.blocks[place]
    }

    fn at(&self, row: usize, column: usize) -> &Block {
        &self.blocks[self.places[row * self.count + column] as usize]
    }

    fn add_mass(&mut self, index: usize, mobility: &Mobility) {
        // What cannot be moved on an axis has no mass there that a number could hold: a stiffness far above all others.
        const IMMENSE: f64 = 1e18;
        let block = self.block(index, index);
        let mass = if mobility.inverse_mass > 0.0 { 1.0 / mobility.inverse_mass } else { IMMENSE };
        (0..3).for_each(|axis| block[axis][axis] += mass);
        let inertia = pseudo_inverse(&mobility.inverse_inertia, IMMENSE);
        for row in 0..3 {
            for column in 0..3 {
                block[3 + row][3 + column] += inertia.col(column)[row];
            }
        }
    }

    fn add_product(
        &mut self,
        (row, column): (usize, usize),
        (left, right): (&Vector, &Vector),
        stiffness: f64,
    ) {
        let block = self.block(row, column);
        for i in 0..6 {
            for j in 0..6 {
                block[i][j] += stiffness * left[i] * right[j];
            }
        }
    }

    /// Factors in place: the block of a body becomes `L`, those of its later neighbours `B·L⁻ᵀ`.
    ///
    /// Returns about twice the number of blocks that were multiplied.
    fn factor(&mut self) -> usize {
        let mut work = 0;
        let mut left: Set = std::array::from_fn(|word| {
            let count = self.count.saturating_sub(64 * word).min(64);
            if count == 64 { u64::MAX } else { (1 << count) - 1 }
        });
        let both = |one: &Set, other: &Set| -> Set { std::array::from_fn(|word| one[word] & other[word]) };
        let degree = |neighbors: &[Set], left: &Set, body: usize| -> u32 {
            both(&neighbors[body], left).iter().map(|word| word.count_ones()).sum()
        };
        let mut degrees: Vec<u32> =
            (0..self.count).map(|body| degree(&self.neighbors, &left, body)).collect();
        while let Some(pivot) = bits(left).min_by_key(|&body| degrees[body]) {
            left[pivot / 64] &= !(1 << (pivot % 64));
            let later: Vec<usize> = bits(both(&self.neighbors[pivot], &left)).collect();
            cholesky(self.block(pivot, pivot));
            let factor = *self.at(pivot, pivot);
            for &row in &later {
                let block = self.block(row, pivot);
                block.iter_mut().for_each(|line| forward(&factor, line));
            }
            for (number, &row) in later.iter().enumerate() {
                for &column in &later[..=number] {
                    let (one, other) = (*self.at(row, pivot), *self.at(column, pivot));
                    let target = self.block(row, column);
                    for i in 0..6 {
                        for j in 0..6 {
                            target[i][j] -= dot(&one[i], &other[j]);
                        }
                    }
                    if row != column {
                        let transposed = std::array::from_fn(|i| std::array::from_fn(|j| target[j][i]));
                        *self.block(column, row) = transposed;
                    }
                }
            }
            later.iter().for_each(|&body| degrees[body] = degree(&self.neighbors, &left, body));
            work += later.len() * later.len();
            self.order.push(pivot);
            self.later.push(later);
        }
        work
    }

    /// Replaces `values` by the solution.
    fn solve(&self, values: &mut [Vector]) {
        for (&pivot, later) in self.order.iter().zip(&self.later) {
            forward(self.at(pivot, pivot), &mut values[pivot]);
            let known = values[pivot];
            for &row in later {
                let block = self.at(row, pivot);
                (0..6).for_each(|axis| values[row][axis] -= dot(&block[axis], &known));
            }
        }
        for (&pivot, later) in self.order.iter().zip(&self.later).rev() {
            let mut value = values[pivot];
            for &row in later {
                let block = self.at(row, pivot);
                (0..6).for_each(|axis| add_scaled(&mut value, &block[axis], -values[row][axis]));
            }
            backward(self.at(pivot, pivot), &mut value);
            values[pivot] = value;
        }
    }
}

/// The bits that are set, from the lowest.
fn bits(set: Set) -> impl Iterator<Item = usize> {
    set.into_iter().enumerate().flat_map(|(word, mut mask)| {
        std::iter::from_fn(move || {
            (mask != 0).then(|| {
                let bit = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                64 * word + bit
            })
        })
    })
}

/// The inertia; where nothing turns the body it is `immense`.
fn pseudo_inverse(inverse: &DMat3, immense: f64) -> DMat3 {
    let least = (inverse.x_axis.x + inverse.y_axis.y + inverse.z_axis.z) / immense + 1.0 / immense;
    (*inverse + DMat3::from_diagonal(DVec3::splat(least))).inverse()
}

/// `A = L·Lᵀ` in place; the upper triangle is left as it was.
fn cholesky(block: &mut Block) {
    for column in 0..6 {
        for row in column..6 {
            let known: f64 = (0..column).map(|k| block[row][k] * block[column][k]).sum();
            let rest = block[row][column] - known;
            block[row][column] =
                if row == column { rest.max(f64::MIN_POSITIVE).sqrt() } else { rest / block[column][column] };
        }
    }
}

/// Solves `L·x = v` in place.
fn forward(factor: &Block, v: &mut Vector) {
    for row in 0..6 {
        let known: f64 = (0..row).map(|k| factor[row][k] * v[k]).sum();
        v[row] = (v[row] - known) / factor[row][row];
    }
}

/// Solves `Lᵀ·x = v` in place.
fn backward(factor: &Block, v: &mut Vector) {
    for row in (0..6).rev() {
        let known: f64 = (row + 1..6).map(|k| factor[k][row] * v[k]).sum();
        v[row] = (v[row] - known) / factor[row][row];
    }
}
