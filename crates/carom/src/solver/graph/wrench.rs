//! What contacts exert: one impulse and moment for each, equal and opposite on its two bodies.
//!
//! The solver's bodies have arms of their own, in single precision and of the start of the substep. So that these do not make angular
//! momentum out of nothing, whoever gives an impulse to two bodies does it at one place in the world: seen from the *mean
//! centre* between both, as the arms are. An impulse is found in single precision, and given in double: both bodies get the same.

use super::passes::GRAIN;
use super::{Color, ContactId, Graph};
use crate::math::DVec3;
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::contact::{Frame, lever, line, pressed, vector};
use crate::solver::kernels::bring_next;
use crate::solver::lanes::{Kernel, LANES, Lanes, Line, Row, Vector, WRITABLE};

/// What a contact exerts on its second body, and reversed on its first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrench {
    pub contact: ContactId,
    rows: [u32; 2],
    /// The mean centre is this share of the way from the centre of mass of the first body to that of the second.
    share: f32,
    /// In the world: along the normal, impulse (N·s) and its moment about the mean centre (N·m·s); then of friction and twist.
    exerts: [[f32; 3]; PARTS],
}

impl Wrench {
    /// The rows of the two bodies.
    #[inline]
    pub fn rows(&self) -> [usize; 2] {
        self.rows.map(|row| row as usize)
    }

    /// How far the mean centre is on the way from the first body's centre of mass to the second's, 0 to 1.
    pub fn share(&self) -> f64 {
        self.share.into()
    }

    #[inline]
    fn part(&self, part: usize) -> DVec3 {
        DVec3::from(self.exerts[part].map(f64::from))
    }

    /// Impulse along the normal (N·s), and its moment about the mean centre (N·m·s).
    #[inline]
    pub fn normal(&self) -> [DVec3; 2] {
        [self.part(PRESSURE), self.part(PRESSURE_MOMENT)]
    }

    /// The same of friction and twist.
    #[inline]
    pub fn across(&self) -> [DVec3; 2] {
        [self.part(FRICTION), self.part(FRICTION_MOMENT)]
    }

    /// The whole impulse.
    pub fn impulse(&self) -> DVec3 {
        self.part(PRESSURE) + self.part(FRICTION)
    }

    /// The whole moment about the mean centre.
    pub fn moment(&self) -> DVec3 {
        self.part(PRESSURE_MOMENT) + self.part(FRICTION_MOMENT)
    }

    /// The angular impulses about their own `centers` of mass that `[impulse, moment]` gives to both bodies: the moment about the mean
    /// centre, which is at a share of the way d between the centres, and what comes from there. One product `d × P` does for both.
    #[inline]
    pub fn turns(&self, [impulse, moment]: [DVec3; 2], [center_a, center_b]: [DVec3; 2]) -> [DVec3; 2] {
        let lever = (center_b - center_a).cross(impulse);
        let from_a = moment + lever * self.share();
        [-from_a, from_a - lever]
    }
}

/// The vectors of what a contact exerts.
const PRESSURE: usize = 0;
const PRESSURE_MOMENT: usize = 1;
const FRICTION: usize = 2;
const FRICTION_MOMENT: usize = 3;
const PARTS: usize = 4;

/// What the lanes of a bundle exert: each vector's components in the world.
type Sums = [[Line; 3]; PARTS];

/// From the mean centre to where friction acts.
#[inline(always)]
fn mean_arm<L: Lanes>(bundle: &Bundle, part: usize) -> Vector<L> {
    let share = line::<L>(bundle, field::SHARE, part);
    let arm_a = vector::<L>(bundle, field::FRICTION_ARM_A, part);
    let arm_b = vector::<L>(bundle, field::FRICTION_ARM_B, part);
    arm_a.scaled(L::splat(1.0) - share) + arm_b.scaled(share)
}

/// Adds up what each lane exerts on its second body, about the mean centre.
#[inline(always)]
fn sum_up<L: Lanes>(bundle: &Bundle) -> Sums {
    let mut sums = [[Line::ZERO; 3]; PARTS];
    let zero = L::splat(0.0);
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let (mut pressure, mut moment) = (zero, Vector::new(zero, zero, zero));
        for point in 0..bundle.points.min(POINTS) {
            let impulse = line::<L>(bundle, field::of_point(point, field::IMPULSE), part);
            pressure = pressure + impulse;
            moment = moment + pressed(lever(bundle, (point, part)), impulse);
        }
        let friction = Vector::new(
            line::<L>(bundle, field::FRICTION, part),
            line::<L>(bundle, field::FRICTION + 1, part),
            zero,
        );
        let twist = Vector::new(zero, zero, line(bundle, field::TWIST, part));
        let arm = mean_arm(bundle, part);
        let pressure = Vector::new(zero, zero, pressure);
        let parts = [pressure, arm.cross(pressure) + moment, friction, arm.cross(friction) + twist];
        for number in 0..PARTS {
            let outward = frame.outward(parts[number]);
            outward.x.store(&mut sums[number][0], part);
            outward.y.store(&mut sums[number][1], part);
            outward.z.store(&mut sums[number][2], part);
        }
    }
    sums
}

/// What the contacts of some bundles exert that exert anything on a body of `rows` that can be moved.
pub(super) struct Find<'a> {
    pub bundles: &'a [Bundle],
    /// The contact of each lane.
    pub contacts: &'a [u32],
    pub rows: &'a [Row],
    pub found: &'a mut Vec<Wrench>,
}

impl Kernel for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for (index, (bundle, contacts)) in self.bundles.iter().zip(self.contacts.chunks(LANES)).enumerate() {
            bring_next::<L>(self.bundles, index, field::SWEPT);
            add_wrenches((bundle, &sum_up::<L>(bundle)), contacts, self.rows, self.found);
        }
    }
}

impl Graph {
    /// Finds what all contacts exert that exert anything on a body of `rows` that can be moved.
    pub fn wrenches(&self, rows: &[Row], found: &mut Vec<Wrench>) {
        found.clear();
        found.reserve(self.colors.iter().map(|color| color.contacts.len()).sum());
        for Color { bundles, contacts, .. } in self.order().map(|color| &self.colors[color]) {
            if !self.pool.shares(bundles.len(), GRAIN) {
                self.machine.run(Find { bundles, contacts, rows, found });
                continue;
            }
            let stretches = self.pool.ranges(bundles.len(), GRAIN, |range| {
                let contacts = &contacts[range.start * LANES..contacts.len().min(range.end * LANES)];
                let bundles = &bundles[range];
                let mut found = Vec::with_capacity(contacts.len());
                self.machine.run(Find { bundles, contacts, rows, found: &mut found });
                found
            });
            stretches.into_iter().for_each(|mut stretch| found.append(&mut stretch));
        }
    }
}

/// Adds what a bundle's contacts exert on bodies that can be moved.
fn add_wrenches((bundle, sums): (&Bundle, &Sums), contacts: &[u32], rows: &[Row], found: &mut Vec<Wrench>) {
    for (lane, &contact) in contacts.iter().enumerate() {
        let sides = [bundle.a[lane], bundle.b[lane]];
        // Loops, as what maps arrays may end up as a call for each number.
        let mut exerts = [[0.0; 3]; PARTS];
        for (vector, lines) in exerts.iter_mut().zip(sums) {
            for (value, line) in vector.iter_mut().zip(lines) {
                *value = line.0[lane];
            }
        }
        let does = exerts.as_flattened().iter().any(|&value| value != 0.0);
        if does && sides.iter().any(|&row| rows[row as usize].0[WRITABLE] != 0.0) {
            let share = bundle.get(lane, field::SHARE);
            found.push(Wrench { contact: ContactId(contact), rows: sides, share, exerts });
        }
    }
}
