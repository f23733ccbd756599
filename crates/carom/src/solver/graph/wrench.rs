//! What contacts exert: one impulse and moment for each, equal and opposite on its two bodies.
//!
//! The solver's bodies have arms of their own, in single precision and of the start of the substep. So that these do not make angular
//! momentum out of nothing, whoever gives an impulse to two bodies does it at one place in the world: seen from the *mean
//! centre* between both, as the arms are. An impulse is found in single precision, and given in double: both bodies get the same.

use super::passes::GRAIN;
use super::{Color, ContactId, Graph};
use crate::math::{DVec3, Vec3A};
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
    exerts: Exerts,
}

/// In the world: an impulse (N·s) and its moment about the mean centre (N·m·s).
type Exerts = [[f32; 3]; 2];

/// What contacts exert, and how much of it friction and twist do where anybody asks for that.
#[derive(Default)]
pub(crate) struct Wrenches {
    list: Vec<Wrench>,
    /// Whether anybody asks; nothing if not, but the room stays.
    apart: bool,
    across: Vec<[Vec3A; 2]>,
}

impl Wrenches {
    /// None yet, of all that contacts exert; where `apart`, friction and twist are known by themselves, too.
    pub fn begin(&mut self, apart: bool) {
        self.apart = apart;
        self.list.clear();
        self.across.clear();
    }

    /// One for each contact that exerts anything.
    pub fn list(&self) -> &[Wrench] {
        &self.list
    }

    /// Impulse (N·s) of friction at each of them and, with twist, its moment about the mean centre (N·m·s); empty if nobody asked.
    pub fn across(&self) -> &[[Vec3A; 2]] {
        &self.across
    }

    fn append(&mut self, mut other: Self) {
        self.list.append(&mut other.list);
        self.across.append(&mut other.across);
    }

    /// Makes room for those of so many more contacts.
    fn reserve(&mut self, contacts: usize) {
        self.list.reserve(contacts);
        self.across.reserve(if self.apart { contacts } else { 0 });
    }
}

fn wide(vector: [f32; 3]) -> DVec3 {
    DVec3::from(vector.map(f64::from))
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

    /// Impulse and moment, less a part of them.
    pub fn without(&self, [impulse, moment]: [Vec3A; 2]) -> [Vec3A; 2] {
        let [all, all_moment] = self.exerts.map(Vec3A::from);
        [all - impulse, all_moment - moment]
    }

    /// The impulse (N·s).
    #[inline]
    pub fn impulse(&self) -> DVec3 {
        wide(self.exerts[0])
    }

    /// Its moment about the mean centre (N·m·s).
    #[inline]
    pub fn moment(&self) -> DVec3 {
        wide(self.exerts[1])
    }

    /// The angular impulses about their own centres of mass that it gives to both bodies: the moment about the mean centre, which is at a
    /// share of the way `between` the centres, and what comes from there. One product `d × P` does for both.
    #[inline]
    pub fn turns(&self, between: DVec3) -> [DVec3; 2] {
        let lever = between.cross(self.impulse());
        let from_a = self.moment() + lever * self.share();
        [-from_a, from_a - lever]
    }

    /// The same of a part of it, `[impulse, moment]`, in single precision.
    #[inline]
    pub fn turns_of(&self, [impulse, moment]: [Vec3A; 2], between: Vec3A) -> [Vec3A; 2] {
        let lever = between.cross(impulse);
        let from_a = moment + lever * self.share;
        [-from_a, from_a - lever]
    }
}

/// Which of a contact's impulses are meant.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    Normal,
    All,
}

/// What the lanes of a bundle exert: each vector's components in the world.
type Sums = [[Line; 3]; 2];

/// From the mean centre to where friction acts.
#[inline(always)]
fn mean_arm<L: Lanes>(bundle: &Bundle, part: usize) -> Vector<L> {
    let share = line::<L>(bundle, field::SHARE, part);
    let arm_a = vector::<L>(bundle, field::FRICTION_ARM_A, part);
    let arm_b = vector::<L>(bundle, field::FRICTION_ARM_B, part);
    arm_a.scaled(L::splat(1.0) - share) + arm_b.scaled(share)
}

/// Adds up what each lane exerts on its second body, about the mean centre; and where `apart`, what friction and twist do of that.
#[inline(always)]
fn sum_up<L: Lanes>(bundle: &Bundle, which: Which, apart: bool) -> [Sums; 2] {
    let [mut whole, mut across] = [[[Line::ZERO; 3]; 2]; 2];
    let zero = L::splat(0.0);
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let arm = mean_arm::<L>(bundle, part);
        let (mut impulse, mut moment) = (Vector::new(zero, zero, zero), Vector::new(zero, zero, zero));
        if which == Which::All {
            impulse.x = line(bundle, field::FRICTION, part);
            impulse.y = line(bundle, field::FRICTION + 1, part);
            moment.z = line(bundle, field::TWIST, part);
        }
        if apart {
            store(&frame, [impulse, arm.cross(impulse) + moment], &mut across, part);
        }
        for point in 0..bundle.points.min(POINTS) {
            let pressure = line::<L>(bundle, field::of_point(point, field::IMPULSE), part);
            impulse.z = impulse.z + pressure;
            moment = moment + pressed(lever(bundle, (point, part)), pressure);
        }
        store(&frame, [impulse, arm.cross(impulse) + moment], &mut whole, part);
    }
    [whole, across]
}

/// Stores vectors of the contact frame as those of the world that they are.
#[inline(always)]
fn store<L: Lanes>(frame: &Frame<L>, vectors: [Vector<L>; 2], sums: &mut Sums, part: usize) {
    for (vector, sum) in vectors.into_iter().zip(sums) {
        let outward = frame.outward(vector);
        outward.x.store(&mut sum[0], part);
        outward.y.store(&mut sum[1], part);
        outward.z.store(&mut sum[2], part);
    }
}

/// What the contacts of some bundles exert that exert anything on a body of `rows` that can be moved.
pub(super) struct Find<'a> {
    pub bundles: &'a [Bundle],
    /// The contact of each lane.
    pub contacts: &'a [u32],
    pub rows: &'a [Row],
    pub found: &'a mut Wrenches,
    pub which: Which,
}

impl Kernel for Find<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { bundles, rows, found, .. } = self;
        for (index, (bundle, contacts)) in bundles.iter().zip(self.contacts.chunks(LANES)).enumerate() {
            bring_next::<L>(bundles, index, field::SWEPT);
            let [whole, across] = sum_up::<L>(bundle, self.which, found.apart);
            for (lane, &contact) in contacts.iter().enumerate() {
                let sides = [bundle.a[lane], bundle.b[lane]];
                let exerts = exerted(&whole, lane);
                let does = exerts.as_flattened().iter().any(|&value| value != 0.0);
                if does && sides.iter().any(|&row| rows[row as usize].0[WRITABLE] != 0.0) {
                    let share = bundle.get(lane, field::SHARE);
                    found.list.push(Wrench { contact: ContactId(contact), rows: sides, share, exerts });
                    if found.apart {
                        found.across.push(exerted(&across, lane).map(Vec3A::from));
                    }
                }
            }
        }
    }
}

/// What one lane exerts.
#[inline(always)]
fn exerted(sums: &Sums, lane: usize) -> Exerts {
    // Loops, as what maps arrays may end up as a call for each number.
    let mut exerts = Exerts::default();
    for (vector, lines) in exerts.iter_mut().zip(sums) {
        for (value, line) in vector.iter_mut().zip(lines) {
            *value = line.0[lane];
        }
    }
    exerts
}

impl Graph {
    /// Finds what all contacts exert that exert anything on a body of `rows` that can be moved.
    pub fn wrenches(&self, rows: &[Row], found: &mut Wrenches) {
        found.reserve(self.colors.iter().map(|color| color.contacts.len()).sum());
        let (which, apart) = (Which::All, found.apart);
        for Color { bundles, contacts, .. } in self.order().map(|color| &self.colors[color]) {
            if !self.pool.shares(bundles.len(), GRAIN) {
                self.machine.run(Find { bundles, contacts, rows, found, which });
                continue;
            }
            let stretches = self.pool.ranges(bundles.len(), GRAIN, |range| {
                let contacts = &contacts[range.start * LANES..contacts.len().min(range.end * LANES)];
                let bundles = &bundles[range];
                let mut found = Wrenches { apart, ..Wrenches::default() };
                found.reserve(contacts.len());
                self.machine.run(Find { bundles, contacts, rows, found: &mut found, which });
                found
            });
            stretches.into_iter().for_each(|stretch| found.append(stretch));
        }
    }
}
