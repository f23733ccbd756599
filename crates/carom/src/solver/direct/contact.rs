//! Contacts of an island, and what they can exert.

use super::mover::{Mover, velocity_of};
use super::vector::{Vector, ZERO, add_scaled, dot, join};
use crate::math::DVec3;
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::lanes::Row;

/// A point that is out of reach asks for less than this, m/s.
const NEVER: f64 = -1e20;

/// Friction's unknowns, along both tangents and about the normal.
const FIRST: usize = POINTS;
const SECOND: usize = POINTS + 1;
const TWIST: usize = POINTS + 2;

/// One impulse that is asked for.
#[derive(Clone, Debug)]
pub(crate) struct Unknown {
    /// How a unit of it changes the two bodies: `BᵀJᵀ`. Zero on a side that nothing moves.
    pub sides: [Vector; 2],
    /// By how much it is to change the velocity along itself.
    pub wanted: f64,
    /// 1 / the response to a unit of it; 0 where there is none.
    pub mass: f64,
    pub impulse: f64,
    /// Whether it presses or sticks.
    pub is_active: bool,
}

/// Two bodies that touch.
pub(crate) struct Contact {
    /// Where one of them is moved by nothing, twice the other.
    pub movers: [usize; 2],
    /// In the order of [`field::IMPULSES`].
    pub unknowns: [Unknown; field::ROWS],
    static_friction: f64,
    dynamic_friction: f64,
    distances: [f64; POINTS],
}

impl Contact {
    /// The contact in a lane, with the numbers of those of its bodies that can be moved.
    pub fn new(
        (bundle, lane): (&Bundle, usize),
        numbers: [Option<usize>; 2],
        movers: &[Mover],
        velocities: &[Row],
    ) -> Self {
        let get = |field: usize| f64::from(bundle.get(lane, field));
        let vector = |field: usize| DVec3::new(get(field), get(field + 1), get(field + 2));
        let (normal, first) = (vector(field::NORMAL), vector(field::TANGENT));
        let second = normal.cross(first);
        let outward = |v: DVec3| first * v.x + second * v.y + normal * v.z;
        let rows = [bundle.a[lane], bundle.b[lane]];

        let unknown = |directions: [Vector; 2], wanted: f64, number: usize| {
            let sides =
                [0, 1].map(|side| numbers[side].map_or(ZERO, |it| movers[it].scaled(&directions[side])));
            let response = dot(&sides[0], &sides[0]) + dot(&sides[1], &sides[1]);
            // Friction's is that of its largest response, so that what slides does not overshoot.
            let largest = if number < POINTS { f64::INFINITY } else { get(field::MASSES[number]) };
            let is_real = get(field::MASSES[number]) > 0.0 && response > 0.0;
            let mass = if is_real { (1.0 / response).min(largest) } else { 0.0 };
            let before =
                [0, 1].map(|side| dot(&directions[side], &velocity_of(&velocities[rows[side] as usize])));
            let wanted = wanted - before[0] - before[1];
            Unknown { sides, wanted, mass, impulse: get(field::IMPULSES[number]), is_active: false }
        };
        let along = |direction: DVec3, [a, b]: [DVec3; 2]| {
            [join(-direction, -a.cross(direction)), join(direction, b.cross(direction))]
        };
        let arms = [outward(vector(field::FRICTION_ARM_A)), outward(vector(field::FRICTION_ARM_B))];
        let unknowns = std::array::from_fn(|number| match number {
            0..POINTS => {
                let at = |line: usize| field::of_point(number, line);
                let lever = outward(DVec3::new(get(at(field::LEVER)), get(at(field::LEVER) + 1), 0.0));
                unknown(along(normal, arms.map(|arm| arm + lever)), get(at(field::LEAST)), number)
            }
            FIRST => unknown(along(first, arms), -get(field::SWING), number),
            SECOND => unknown(along(second, arms), -get(field::SWING + 1), number),
            _ => unknown([join(DVec3::ZERO, -normal), join(DVec3::ZERO, normal)], 0.0, number),
        });
        let [a, b] = numbers;
        Self {
            movers: [a.or(b), b.or(a)].map(Option::unwrap_or_default),
            unknowns,
            static_friction: get(field::STATIC_FRICTION),
            dynamic_friction: get(field::DYNAMIC_FRICTION),
            distances: std::array::from_fn(|point| get(field::of_point(point, field::DISTANCE))),
        }
    }

    /// What an unknown has been given of the velocity along itself, m/s.
    pub fn change(&self, number: usize, changes: &[Vector]) -> f64 {
        let [one, other] = &self.unknowns[number].sides;
        dot(one, &changes[self.movers[0]]) + dot(other, &changes[self.movers[1]])
    }

    /// What it lacks.
    pub fn lack(&self, number: usize, changes: &[Vector]) -> f64 {
        self.unknowns[number].wanted - self.change(number, changes)
    }

    /// Gives an unknown another impulse.
    pub fn set(&mut self, number: usize, impulse: f64, changes: &mut [Vector]) {
        let unknown = &mut self.unknowns[number];
        let change = impulse - unknown.impulse;
        if change != 0.0 {
            unknown.impulse = impulse;
            for (mover, side) in self.movers.into_iter().zip(&unknown.sides) {
                add_scaled(&mut changes[mover], side, change);
            }
        }
    }

    /// The impulses that it would exert, were each of its unknowns alone: what it has and what it lacks, as far as it may push; and
    /// which of them press or stick.
    pub fn answer(&self, changes: &[Vector]) -> [(f64, bool); field::ROWS] {
        let mut answer = std::array::from_fn(|number| {
            let unknown = &self.unknowns[number];
            (unknown.impulse + unknown.mass * self.lack(number, changes), unknown.mass > 0.0)
        });
        for (impulse, presses) in &mut answer[..POINTS] {
            *presses &= *impulse > 0.0;
            *impulse = impulse.max(0.0);
        }
        let (friction, twist) = self.limits();
        for (numbers, [most, sliding]) in [(FIRST..TWIST, friction), (TWIST..field::ROWS, twist)] {
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

    /// Whether an unknown could press or stick: all but points that are out of reach, and friction that is given no chance.
    pub fn could_act(&self, number: usize) -> bool {
        let unknown = &self.unknowns[number];
        unknown.mass > 0.0
            && if number < POINTS { unknown.wanted > NEVER } else { self.static_friction > 0.0 }
    }

    /// What friction and twist may be, sticking and sliding.
    fn limits(&self) -> ([f64; 2], [f64; 2]) {
        let points = &self.unknowns[..POINTS];
        let pressure: f64 = points.iter().map(|unknown| unknown.impulse).sum();
        let moment: f64 =
            points.iter().zip(self.distances).map(|(unknown, distance)| unknown.impulse * distance).sum();
        let both = |load: f64| [self.static_friction * load, self.dynamic_friction * load];
        (both(pressure), both(moment))
    }

    /// Whether it presses at all.
    pub fn is_pressed(&self) -> bool {
        self.unknowns[..POINTS].iter().any(|unknown| unknown.impulse > 0.0)
    }

    /// Gives each unknown in turn what it lacks, as far as it may push: a step of Gauss and Seidel's. Returns by how much that has
    /// changed the velocity of one, m/s.
    pub fn sweep(&mut self, changes: &mut [Vector]) -> f64 {
        let before = self.impulses();
        for number in 0..field::ROWS {
            let Unknown { impulse, mass, .. } = self.unknowns[number];
            if mass == 0.0 {
                continue;
            }
            let impulse = impulse + mass * self.lack(number, changes);
            // At once: what a point out of reach asks for would leave nothing of the velocity but its rounding.
            self.set(number, if number < POINTS { impulse.max(0.0) } else { impulse }, changes);
        }
        self.project_friction(changes);
        self.distance(before)
    }

    pub fn impulses(&self) -> [f64; field::ROWS] {
        std::array::from_fn(|number| self.unknowns[number].impulse)
    }

    /// How far the velocity of one of its unknowns is from what these impulses would make it, each for itself, m/s.
    pub fn distance(&self, impulses: [f64; field::ROWS]) -> f64 {
        let real = self.unknowns.iter().zip(impulses).filter(|(unknown, _)| unknown.mass > 0.0);
        real.map(|(unknown, impulse)| (impulse - unknown.impulse).abs() / unknown.mass).fold(0.0, f64::max)
    }

    /// Puts impulses back to what it can exert.
    pub fn project(&mut self, changes: &mut [Vector]) {
        for point in 0..POINTS {
            self.set(point, self.unknowns[point].impulse.max(0.0), changes);
        }
        self.project_friction(changes);
    }

    fn project_friction(&mut self, changes: &mut [Vector]) {
        let (friction, twist) = self.limits();
        let [x, y, turn] = [FIRST, SECOND, TWIST].map(|number| self.unknowns[number].impulse);
        let size = (x * x + y * y).sqrt();
        if size > friction[0] {
            let share = (friction[1] / size).min(1.0);
            self.set(FIRST, share * x, changes);
            self.set(SECOND, share * y, changes);
        }
        if turn.abs() > twist[0] {
            self.set(TWIST, turn.clamp(-twist[1], twist[1]), changes);
        }
    }
}
