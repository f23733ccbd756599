//! What contacts exert, in double precision: one impulse and moment for each, equal and opposite on its two bodies.
//!
//! The solver's bodies have arms of their own, in single precision and of the start of the substep. So that these do not make angular
//! momentum out of nothing, whoever gives an impulse to two bodies does it at one place in the world: seen from the *mean
//! centre* between both, as the arms are.

use super::passes::GRAIN;
use super::{Color, ContactId, Graph};
use crate::math::DVec3;
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::contact::{line, vector};
use crate::solver::kernels::bring_next;
use crate::solver::lanes::{Kernel, LANES, Lanes, Line, Row, Vector, WRITABLE};

/// What a contact exerts on its second body, and reversed on its first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrench {
    pub contact: ContactId,
    pub rows: [usize; 2],
    /// The mean centre is this share of the way from the centre of mass of the first body to that of the second.
    pub share: f64,
    /// Impulse along the normal (N·s), and its moment about the mean centre (N·m·s).
    pub normal: [DVec3; 2],
    /// The same of friction and twist.
    pub across: [DVec3; 2],
}

impl Wrench {
    /// The whole impulse.
    pub fn impulse(&self) -> DVec3 {
        self.normal[0] + self.across[0]
    }

    /// The whole moment about the mean centre.
    pub fn moment(&self) -> DVec3 {
        self.normal[1] + self.across[1]
    }

    /// From the centre of mass of one side to the mean centre.
    pub fn offset(&self, side: usize, [a, b]: [DVec3; 2]) -> DVec3 {
        if side == 0 { (b - a) * self.share } else { (a - b) * (1.0 - self.share) }
    }

    /// The angular impulse about the body's own centre of mass that `[impulse, moment]` gives to the body of one side, with the
    /// centres of both: what is seen from the mean centre, and the way from there.
    pub fn turn(&self, side: usize, [impulse, moment]: [DVec3; 2], centers: [DVec3; 2]) -> DVec3 {
        let turn = moment + self.offset(side, centers).cross(impulse);
        if side == 0 { -turn } else { turn }
    }
}

/// Lines of what a bundle exerts, in the contact frames: impulse and moment of all normals, of friction and twist.
const PRESSURE: usize = 0;
const PRESSURE_MOMENT: usize = 1;
const FRICTION: usize = 3;
const FRICTION_MOMENT: usize = 5;
const SUMS: usize = 8;

/// From the mean centre to where both arms end.
#[inline(always)]
fn mean<L: Lanes>(bundle: &Bundle, [arm_a, arm_b]: [usize; 2], (share, part): (L, usize)) -> Vector<L> {
    let (arm_a, arm_b) = (vector::<L>(bundle, arm_a, part), vector::<L>(bundle, arm_b, part));
    arm_a.scaled(L::splat(1.0) - share) + arm_b.scaled(share)
}

/// Adds up what each lane exerts on its second body, about the mean centre.
#[inline(always)]
fn sum_up<L: Lanes>(bundle: &Bundle) -> [Line; SUMS] {
    let mut sums = [Line::ZERO; SUMS];
    let zero = L::splat(0.0);
    for part in 0..LANES / L::WIDTH {
        let share = line::<L>(bundle, field::SHARE, part);
        let mut pressure = Vector::new(zero, zero, zero);
        for point in 0..bundle.points.min(POINTS) {
            let at = |line: usize| field::of_point(point, line);
            let impulse = line::<L>(bundle, at(field::IMPULSE), part);
            let arm = mean(bundle, [at(field::ARM_A), at(field::ARM_B)], (share, part));
            pressure = pressure + Vector::new(arm.y * impulse, -(arm.x * impulse), impulse);
        }
        pressure.z.store(&mut sums[PRESSURE], part);
        pressure.x.store(&mut sums[PRESSURE_MOMENT], part);
        pressure.y.store(&mut sums[PRESSURE_MOMENT + 1], part);

        let (x, y) = (line::<L>(bundle, field::FRICTION, part), line::<L>(bundle, field::FRICTION + 1, part));
        let twist = Vector::new(zero, zero, line(bundle, field::TWIST, part));
        let arm = mean(bundle, [field::FRICTION_ARM_A, field::FRICTION_ARM_B], (share, part));
        let moment = arm.cross(Vector::new(x, y, zero)) + twist;
        x.store(&mut sums[FRICTION], part);
        y.store(&mut sums[FRICTION + 1], part);
        moment.x.store(&mut sums[FRICTION_MOMENT], part);
        moment.y.store(&mut sums[FRICTION_MOMENT + 1], part);
        moment.z.store(&mut sums[FRICTION_MOMENT + 2], part);
    }
    sums
}

/// What the contacts of some bundles exert that exert anything on a body of `rows` that can be moved.
struct Find<'a> {
    bundles: &'a [Bundle],
    /// The contact of each lane.
    contacts: &'a [u32],
    rows: &'a [Row],
    found: &'a mut Vec<Wrench>,
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
fn add_wrenches(
    (bundle, sums): (&Bundle, &[Line; SUMS]),
    contacts: &[u32],
    rows: &[Row],
    found: &mut Vec<Wrench>,
) {
    for (lane, &contact) in contacts.iter().enumerate() {
        let sides = [bundle.a[lane] as usize, bundle.b[lane] as usize];
        let sum = sums.map(|line| line.0[lane]);
        let exerts = sum.iter().any(|&value| value != 0.0);
        if exerts && sides.iter().any(|&row| rows[row].0[WRITABLE] != 0.0) {
            found.push(wrench(bundle, lane, (ContactId(contact), sides), &sum.map(f64::from)));
        }
    }
}

fn wrench(
    bundle: &Bundle,
    lane: usize,
    (contact, rows): (ContactId, [usize; 2]),
    sum: &[f64; SUMS],
) -> Wrench {
    let axis = |line: usize| {
        let get = |index: usize| f64::from(bundle.get(lane, line + index));
        DVec3::new(get(0), get(1), get(2))
    };
    let (normal, first) = (axis(field::NORMAL), axis(field::TANGENT));
    let second = normal.cross(first);
    Wrench {
        contact,
        rows,
        share: f64::from(bundle.get(lane, field::SHARE)),
        normal: [normal * sum[PRESSURE], first * sum[PRESSURE_MOMENT] + second * sum[PRESSURE_MOMENT + 1]],
        across: [
            first * sum[FRICTION] + second * sum[FRICTION + 1],
            first * sum[FRICTION_MOMENT]
                + second * sum[FRICTION_MOMENT + 1]
                + normal * sum[FRICTION_MOMENT + 2],
        ],
    }
}
