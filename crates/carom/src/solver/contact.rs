//! The arithmetic of contacts that rest: rows of the seed's formula, bundle by bundle.
//!
//! A point asks for a least velocity `least` along its normal. The impulse that gives this one point what it asks for is the
//! seed's, with another right-hand side and kept from pulling:
//!
//! ```text
//! λ ← max(0, λ − (v_n − least)/k)        k = n·(Δv₁ + Δv₂)
//! ```
//!
//! Friction acts once for a contact, at the middle of the points that touch, within Coulomb's cone of their impulses; a
//! twisting impulse about the normal stands for its distribution over them. Going through all rows again and again is projected
//! Gauss–Seidel (Jourdan, Alart and Jean 1998; Catto 2005). In the contact frame, with
//! the points' places seen from where friction acts, a point's row is some 30 operations, once for both bodies.
//!
//! *Books*: each impulse acts on both bodies, reversed on one; linear and angular momentum are kept to rounding.

mod measure;
mod sweep;

pub(crate) use measure::measure;
pub(crate) use sweep::{sweep, sweep_normals};

use super::bundle::{Bundle, POINTS, field};
use super::lanes::{LANES, Lanes, Line, Row, Tensor, Vector};
use super::rows::SharedRows;

/// The contact frame of each lane.
pub(crate) struct Frame<L> {
    first: Vector<L>,
    second: Vector<L>,
    normal: Vector<L>,
}

impl<L: Lanes> Frame<L> {
    #[inline(always)]
    pub fn load(bundle: &Bundle, part: usize) -> Self {
        let first = vector(bundle, field::TANGENT, part);
        let normal = vector(bundle, field::NORMAL, part);
        Self { first, second: normal.cross(first), normal }
    }

    #[inline(always)]
    fn inward(&self, v: Vector<L>) -> Vector<L> {
        Vector::new(v.dot(self.first), v.dot(self.second), v.dot(self.normal))
    }

    #[inline(always)]
    pub fn outward(&self, v: Vector<L>) -> Vector<L> {
        self.first.scaled(v.x) + self.second.scaled(v.y) + self.normal.scaled(v.z)
    }
}

#[inline(always)]
pub(super) fn line<L: Lanes>(bundle: &Bundle, line: usize, part: usize) -> L {
    L::load(&bundle.lines[line], part)
}

#[inline(always)]
pub(super) fn vector<L: Lanes>(bundle: &Bundle, first: usize, part: usize) -> Vector<L> {
    Vector::new(line(bundle, first, part), line(bundle, first + 1, part), line(bundle, first + 2, part))
}

#[inline(always)]
fn tensor<L: Lanes>(bundle: &Bundle, first: usize, part: usize) -> Tensor<L> {
    let [xx, xy, xz] =
        [line(bundle, first, part), line(bundle, first + 1, part), line(bundle, first + 2, part)];
    let [yy, yz, zz] =
        [line(bundle, first + 3, part), line(bundle, first + 4, part), line(bundle, first + 5, part)];
    Tensor([xx, xy, xz, yy, yz, zz])
}

#[inline(always)]
fn store<L: Lanes>(v: Vector<L>, bundle: &mut Bundle, first: usize, part: usize) {
    v.x.store(&mut bundle.lines[first], part);
    v.y.store(&mut bundle.lines[first + 1], part);
    v.z.store(&mut bundle.lines[first + 2], part);
}

#[inline(always)]
fn indices(indices: &[u32; LANES], part: usize, width: usize) -> &[u32] {
    &indices[part * width..(part + 1) * width]
}

/// Both bodies of each lane.
struct Pair<L> {
    a: [L; 8],
    b: [L; 8],
    inverse_inertia_a: Tensor<L>,
    inverse_inertia_b: Tensor<L>,
}

#[inline(always)]
fn linear<L: Lanes>(row: &[L; 8]) -> Vector<L> {
    Vector::new(row[0], row[1], row[2])
}

#[inline(always)]
fn angular<L: Lanes>(row: &[L; 8]) -> Vector<L> {
    Vector::new(row[3], row[4], row[5])
}

impl<L: Lanes> Pair<L> {
    #[inline(always)]
    fn gather(bundle: &Bundle, velocities: SharedRows<'_>, part: usize) -> Self {
        Self {
            a: L::gather(velocities, indices(&bundle.a, part, L::WIDTH)),
            b: L::gather(velocities, indices(&bundle.b, part, L::WIDTH)),
            inverse_inertia_a: tensor(bundle, field::INVERSE_INERTIA_A, part),
            inverse_inertia_b: tensor(bundle, field::INVERSE_INERTIA_B, part),
        }
    }

    /// Sum of the inverse masses.
    #[inline(always)]
    fn inverse_mass(&self) -> L {
        self.a[6] + self.b[6]
    }

    /// Gives `b` the impulse, `a` its reverse, each with its own angular impulse (contact frame), and writes both back.
    #[inline(always)]
    fn push(self, frame: &Frame<L>, impulse: Vector<L>, [turn_a, turn_b]: [Vector<L>; 2]) -> [[L; 8]; 2] {
        let impulse = frame.outward(impulse);
        let spin_a = frame.outward(self.inverse_inertia_a.times(turn_a));
        let spin_b = frame.outward(self.inverse_inertia_b.times(turn_b));
        let (a, b) = (self.a, self.b);
        let (linear_a, linear_b) = (linear(&a) - impulse.scaled(a[6]), linear(&b) + impulse.scaled(b[6]));
        let (angular_a, angular_b) = (angular(&a) - spin_a, angular(&b) + spin_b);
        [
            [linear_a.x, linear_a.y, linear_a.z, angular_a.x, angular_a.y, angular_a.z, a[6], a[7]],
            [linear_b.x, linear_b.y, linear_b.z, angular_b.x, angular_b.y, angular_b.z, b[6], b[7]],
        ]
    }
}

#[inline(always)]
fn scatter<L: Lanes>(bundle: &Bundle, [a, b]: [[L; 8]; 2], velocities: SharedRows<'_>, part: usize) {
    L::scatter(a, velocities, indices(&bundle.a, part, L::WIDTH));
    L::scatter(b, velocities, indices(&bundle.b, part, L::WIDTH));
}

/// The parts of both arms that turn with their bodies: they end where the surfaces' centres of curvature are.
#[inline(always)]
fn turning<L: Lanes>(bundle: &Bundle, [a, b]: [Vector<L>; 2], part: usize) -> [Vector<L>; 2] {
    let round_a = line::<L>(bundle, field::ROUNDNESS, part);
    let round_b = line::<L>(bundle, field::ROUNDNESS + 1, part);
    [Vector::new(a.x, a.y, a.z - round_a), Vector::new(b.x, b.y, b.z + round_b)]
}

/// Starts a substep of `1/rate` seconds: what each point asks for, with bodies that nothing has pushed yet.
///
/// A point that touches, up to a gap of `margin`, may part and not close: to close so small a gap would ask for a velocity that the
/// next substep has to stop, and a stack would rock on that for ever. One further away, up to the contact's horizon, may
/// close as far as its gap lets it. What lies beyond is not the contacts' business.
///
/// What friction asks for holds at the end of the substep, when the arms have turned: points swing by `h·ω × (ω × r)`. Without
/// it what is carried round on a turntable would drift outwards. Along the normal nothing is added: where two edges cross,
/// the point that touches is of neither body.
#[inline(always)]
pub(crate) fn begin<L: Lanes>(bundle: &mut Bundle, velocities: &[Row], [margin, rate]: [f32; 2]) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let a = L::gather(velocities, indices(&bundle.a, part, L::WIDTH));
        let b = L::gather(velocities, indices(&bundle.b, part, L::WIDTH));
        let (spin_a, spin_b) = (frame.inward(angular(&a)), frame.inward(angular(&b)));
        let substep = L::splat(1.0 / rate);
        let horizon = line::<L>(bundle, field::HORIZON, part);
        let never = L::splat(-1e30);
        for point in 0..bundle.points.min(POINTS) {
            let at = |line: usize| field::of_point(point, line);
            let separation = line::<L>(bundle, at(field::SEPARATION), part);
            let closing = separation * L::splat(-rate);
            let least = L::select_greater(separation, L::splat(margin), [closing, L::splat(0.0)]);
            let least = L::select_greater(separation, horizon, [never, least]);
            least.store(&mut bundle.lines[at(field::LEAST)], part);
        }
        let arms = [vector(bundle, field::FRICTION_ARM_A, part), vector(bundle, field::FRICTION_ARM_B, part)];
        let [arm_a, arm_b] = turning(bundle, arms, part);
        let swing = (swing(spin_b, arm_b) - swing(spin_a, arm_a)).scaled(substep);
        swing.x.store(&mut bundle.lines[field::SWING], part);
        swing.y.store(&mut bundle.lines[field::SWING + 1], part);
    }
}

/// Lets the impulses of the substep before act again.
#[inline(always)]
pub(crate) fn resume<L: Lanes>(bundle: &Bundle, velocities: SharedRows<'_>) {
    for part in 0..LANES / L::WIDTH {
        let mut impulses = [L::splat(0.0); field::ROWS];
        for (row, impulse) in impulses.iter_mut().enumerate() {
            *impulse = line(bundle, field::IMPULSES[row], part);
        }
        apply::<L>(bundle, velocities, &impulses, part);
    }
}

/// Centripetal acceleration `ω × (ω × r)`.
#[inline(always)]
fn swing<L: Lanes>(spin: Vector<L>, arm: Vector<L>) -> Vector<L> {
    spin.scaled(spin.dot(arm)) - arm.scaled(spin.dot(spin))
}

/// Means of the velocities before and after, linear and angular, contact frame.
#[inline(always)]
fn mean<L: Lanes>(frame: &Frame<L>, [before, after]: [&[Row]; 2], indices: &[u32]) -> (Vector<L>, Vector<L>) {
    let (before, after) = (L::gather(before, indices), L::gather(after, indices));
    let (linear, angular) = (linear(&before) + linear(&after), angular(&before) + angular(&after));
    (frame.inward(linear).scaled(L::splat(0.5)), frame.inward(angular).scaled(L::splat(0.5)))
}

/// The work (J) that the impulses of each lane do on bodies that get from the velocities `before` to those `after`.
#[inline(always)]
pub(crate) fn work<L: Lanes>(bundle: &Bundle, before: &[Row], after: &[Row]) -> Line {
    let mut work = Line::ZERO;
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let (velocity_a, spin_a) = mean(&frame, [before, after], indices(&bundle.a, part, L::WIDTH));
        let (velocity_b, spin_b) = mean(&frame, [before, after], indices(&bundle.b, part, L::WIDTH));
        let relative = velocity_b - velocity_a;
        let arms = [vector(bundle, field::FRICTION_ARM_A, part), vector(bundle, field::FRICTION_ARM_B, part)];
        let slip = relative + (spin_b.cross(arms[1]) - spin_a.cross(arms[0]));
        let spin = spin_b - spin_a;
        let mut sum = line::<L>(bundle, field::FRICTION, part) * slip.x
            + line::<L>(bundle, field::FRICTION + 1, part) * slip.y
            + line::<L>(bundle, field::TWIST, part) * spin.z;
        for point in 0..bundle.points.min(POINTS) {
            let [x, y] = lever::<L>(bundle, (point, part));
            let parting = slip.z + (spin.x * y - spin.y * x);
            sum = sum + line::<L>(bundle, field::of_point(point, field::IMPULSE), part) * parting;
        }
        sum.store(&mut work, part);
    }
    work
}

/// Lets impulses, in the order of [`field::IMPULSES`], act on both bodies.
#[inline(always)]
fn apply<L: Lanes>(bundle: &Bundle, velocities: SharedRows<'_>, impulses: &[L; field::ROWS], part: usize) {
    let [first, second, third, fourth, x, y, twist] = *impulses;
    let mut moment = Vector::new(L::splat(0.0), L::splat(0.0), twist);
    for (point, pressure) in [first, second, third, fourth].into_iter().enumerate().take(bundle.points) {
        moment = moment + pressed(lever(bundle, (point, part)), pressure);
    }
    let impulse = Vector::new(x, y, (first + second) + (third + fourth));
    let frame = Frame::<L>::load(bundle, part);
    let arm_a = vector(bundle, field::FRICTION_ARM_A, part);
    let arm_b = vector(bundle, field::FRICTION_ARM_B, part);
    let turns = [arm_a.cross(impulse) + moment, arm_b.cross(impulse) + moment];
    let pushed = Pair::gather(bundle, velocities, part).push(&frame, impulse, turns);
    scatter(bundle, pushed, velocities, part);
}

/// Where a point is, seen from where friction acts, along t₁ and t₂.
#[inline(always)]
pub(super) fn lever<L: Lanes>(bundle: &Bundle, (point, part): (usize, usize)) -> [L; 2] {
    let first = field::of_point(point, field::LEVER);
    [line(bundle, first, part), line(bundle, first + 1, part)]
}

/// The moment about where friction acts, of an impulse along the normal at such a lever.
#[inline(always)]
pub(super) fn pressed<L: Lanes>([x, y]: [L; 2], impulse: L) -> Vector<L> {
    Vector::new(y * impulse, -(x * impulse), L::splat(0.0))
}
