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
//! Gauss–Seidel (Jourdan, Alart and Jean 1998; Catto 2005). The layout in the contact frame makes one row 30 operations.
//!
//! *Books*: each impulse acts on both bodies, reversed on one; linear and angular momentum are kept to rounding.

use super::bundle::{Bundle, field};
use super::lanes::{LANES, Lanes, Line, Row, Tensor, Vector};

/// The contact frame of each lane.
struct Frame<L> {
    first: Vector<L>,
    second: Vector<L>,
    normal: Vector<L>,
}

impl<L: Lanes> Frame<L> {
    #[inline(always)]
    fn load(bundle: &Bundle, part: usize) -> Self {
        let first = vector(bundle, field::TANGENT, part);
        let normal = vector(bundle, field::NORMAL, part);
        Self { first, second: normal.cross(first), normal }
    }

    #[inline(always)]
    fn inward(&self, v: Vector<L>) -> Vector<L> {
        Vector::new(v.dot(self.first), v.dot(self.second), v.dot(self.normal))
    }

    #[inline(always)]
    fn outward(&self, v: Vector<L>) -> Vector<L> {
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
    Tensor([0, 1, 2, 3, 4, 5].map(|entry| line(bundle, first + entry, part)))
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
    fn gather(bundle: &Bundle, velocities: &[Row], part: usize) -> Self {
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
fn scatter<L: Lanes>(bundle: &Bundle, [a, b]: [[L; 8]; 2], velocities: &mut [Row], part: usize) {
    L::scatter(a, velocities, indices(&bundle.a, part, L::WIDTH));
    L::scatter(b, velocities, indices(&bundle.b, part, L::WIDTH));
}

/// How far the turn `(x, y, z, w)` since the anchor moves a point along the normal, per metre of its arm: `Rᵀn − n`, in the
/// contact frame.
#[inline(always)]
fn drift_of_arm<L: Lanes>(frame: &Frame<L>, row: &[L; 8]) -> Vector<L> {
    let turn = frame.inward(angular(row));
    let (x, y, z, w, two) = (turn.x, turn.y, turn.z, row[6], L::splat(2.0));
    Vector::new(two * (x * z - w * y), two * (y * z + w * x), -two * (x * x + y * y))
}

/// Finds the separation of every point from the bodies' `drifts` since their anchors, and lets both arms end where impulses act
/// now.
#[inline(always)]
pub(crate) fn measure<L: Lanes>(bundle: &mut Bundle, drifts: &[Row]) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let drift_a = L::gather(drifts, indices(&bundle.a, part, L::WIDTH));
        let drift_b = L::gather(drifts, indices(&bundle.b, part, L::WIDTH));
        let apart = (linear(&drift_b) - linear(&drift_a)).dot(frame.normal);
        let (turn_a, turn_b) = (drift_of_arm(&frame, &drift_a), drift_of_arm(&frame, &drift_b));
        let shift = Shift::new(bundle, &frame, [&drift_a, &drift_b], part);
        let (mut gap, mut widest) = (L::splat(f32::MAX), L::splat(f32::MIN));
        for point in 0..bundle.points {
            let at = |line: usize| field::of_point(point, line);
            let renewed = |plane: usize, whole: usize| {
                let get = |index: usize| line::<L>(bundle, at(index), part);
                Vector::new(get(plane), get(plane + 1), get(whole + 2))
            };
            let arm_a = renewed(field::RENEWED_A, field::ARM_A);
            let arm_b = renewed(field::RENEWED_B, field::ARM_B);
            let base = line::<L>(bundle, at(field::BASE), part);
            let separation = base + apart + turn_b.dot(arm_b) - turn_a.dot(arm_a);
            separation.store(&mut bundle.lines[at(field::SEPARATION)], part);
            let shifts = shift.of([arm_a, arm_b]);
            for (field, arm, shift) in [(field::ARM_A, arm_a, shifts[0]), (field::ARM_B, arm_b, shifts[1])] {
                (arm.x + shift.x).store(&mut bundle.lines[at(field)], part);
                (arm.y + shift.y).store(&mut bundle.lines[at(field) + 1], part);
            }
            let real = line::<L>(bundle, at(field::MASS), part);
            gap = L::select_greater(real, L::splat(0.0), [gap.min(separation), gap]);
            widest = L::select_greater(real, L::splat(0.0), [widest.max(separation), widest]);
        }
        shift.friction(bundle, part);
        widest.store(&mut bundle.lines[field::WIDEST], part);
        gap.store(&mut bundle.lines[field::GAP], part);
    }
}

/// How bodies have moved since a contact was renewed, and where this leads the place at which its impulses act: between where the
/// two bodies would carry it, by their shares.
struct Shift<L> {
    /// `b` against `a`.
    moved: Vector<L>,
    /// Turn of each body, rad.
    turn_a: Vector<L>,
    turn_b: Vector<L>,
    share: L,
    /// Where one surface is round, how far the place has gone round it as the other one turned, and the normal with it.
    tilted: Vector<L>,
}

impl<L: Lanes> Shift<L> {
    #[inline(always)]
    fn new(bundle: &Bundle, frame: &Frame<L>, [drift_a, drift_b]: [&[L; 8]; 2], part: usize) -> Self {
        let turn = |drift: &[L; 8]| frame.inward(angular(drift)).scaled(L::splat(2.0) * drift[6]);
        let moved = frame.inward(linear(drift_b) - linear(drift_a));
        let moved = moved - vector(bundle, field::DRIFTED, part);
        let follows = line::<L>(bundle, field::FOLLOWS, part);
        let turn_a = turn(drift_a) - vector(bundle, field::TURNED_A, part);
        let turn_b = turn(drift_b) - vector(bundle, field::TURNED_B, part);
        // Against what has a large radius, as far as the body's own arm: further round, substeps would have to be shorter.
        let arms = [field::RENEWED_FRICTION_A, field::RENEWED_FRICTION_B];
        let [depth_a, depth_b] = arms.map(|arm| line::<L>(bundle, arm + 2, part));
        let radius = |side: usize, depth: L| {
            let radius = line::<L>(bundle, field::ROUNDNESS + side, part);
            radius.min(depth.max(L::splat(0.0))) * follows
        };
        let (round_a, round_b) = (radius(0, L::splat(0.0) - depth_b), radius(1, depth_a));
        Self {
            moved: moved.scaled(follows),
            tilted: Vector::new(
                turn_b.y * round_a - turn_a.y * round_b,
                turn_a.x * round_b - turn_b.x * round_a,
                L::splat(0.0),
            ),
            turn_a,
            turn_b,
            share: line(bundle, field::SHARE, part),
        }
    }

    /// What is added to both arms of a place, whose parts that turn were these when the contact was renewed.
    #[inline(always)]
    fn of(&self, [arm_a, arm_b]: [Vector<L>; 2]) -> [Vector<L>; 2] {
        let (carried_a, carried_b) = (self.turn_a.cross(arm_a), self.turn_b.cross(arm_b));
        let rest = L::splat(1.0) - self.share;
        [
            carried_a.scaled(rest) + (carried_b + self.moved).scaled(self.share) + self.tilted,
            carried_b.scaled(self.share) + (carried_a - self.moved).scaled(rest) + self.tilted,
        ]
    }

    #[inline(always)]
    fn friction(&self, bundle: &mut Bundle, part: usize) {
        let arm_a = vector::<L>(bundle, field::RENEWED_FRICTION_A, part);
        let arm_b = vector::<L>(bundle, field::RENEWED_FRICTION_B, part);
        let round = |radius: usize| line::<L>(bundle, field::ROUNDNESS + radius, part);
        let turning_a = Vector::new(arm_a.x, arm_a.y, arm_a.z - round(0));
        let turning_b = Vector::new(arm_b.x, arm_b.y, arm_b.z + round(1));
        let [shift_a, shift_b] = self.of([turning_a, turning_b]);
        store(arm_a + shift_a, bundle, field::FRICTION_ARM_A, part);
        store(arm_b + shift_b, bundle, field::FRICTION_ARM_B, part);
    }
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
        for point in 0..bundle.points {
            let at = |line: usize| field::of_point(point, line);
            let separation = line::<L>(bundle, at(field::SEPARATION), part);
            let closing = separation * L::splat(-rate);
            let least = L::select_greater(separation, L::splat(margin), [closing, L::splat(0.0)]);
            let least = L::select_greater(separation, horizon, [never, least]);
            least.store(&mut bundle.lines[at(field::LEAST)], part);
        }
        let turning = |arm: usize, roundness: L| {
            let arm = vector::<L>(bundle, arm, part);
            Vector::new(arm.x, arm.y, arm.z + roundness)
        };
        let arm_a = turning(field::FRICTION_ARM_A, -line::<L>(bundle, field::ROUNDNESS, part));
        let arm_b = turning(field::FRICTION_ARM_B, line::<L>(bundle, field::ROUNDNESS + 1, part));
        let swing = (swing(spin_b, arm_b) - swing(spin_a, arm_a)).scaled(substep);
        swing.x.store(&mut bundle.lines[field::SWING], part);
        swing.y.store(&mut bundle.lines[field::SWING + 1], part);
    }
}

/// Lets the impulses of the substep before act again.
#[inline(always)]
pub(crate) fn resume<L: Lanes>(bundle: &Bundle, velocities: &mut [Row]) {
    for part in 0..LANES / L::WIDTH {
        let impulses = field::IMPULSES.map(|impulse| line(bundle, impulse, part));
        apply::<L>(bundle, velocities, &impulses, part);
    }
}

/// Centripetal acceleration `ω × (ω × r)`.
#[inline(always)]
fn swing<L: Lanes>(spin: Vector<L>, arm: Vector<L>) -> Vector<L> {
    spin.scaled(spin.dot(arm)) - arm.scaled(spin.dot(spin))
}

/// The work (J) that the impulses of each lane do on bodies that get from the velocities `before` to those `after`.
#[inline(always)]
pub(crate) fn work<L: Lanes>(bundle: &Bundle, before: &[Row], after: &[Row]) -> Line {
    let mut work = Line::ZERO;
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let mean = |indices: &[u32]| {
            let (before, after) = (L::gather(before, indices), L::gather(after, indices));
            let (linear, angular) = (linear(&before) + linear(&after), angular(&before) + angular(&after));
            (frame.inward(linear).scaled(L::splat(0.5)), frame.inward(angular).scaled(L::splat(0.5)))
        };
        let (velocity_a, spin_a) = mean(indices(&bundle.a, part, L::WIDTH));
        let (velocity_b, spin_b) = mean(indices(&bundle.b, part, L::WIDTH));
        let at = |arm_a: usize, arm_b: usize| {
            let turning =
                spin_b.cross(vector(bundle, arm_b, part)) - spin_a.cross(vector(bundle, arm_a, part));
            velocity_b - velocity_a + turning
        };
        let slip = at(field::FRICTION_ARM_A, field::FRICTION_ARM_B);
        let mut sum = line::<L>(bundle, field::FRICTION, part) * slip.x
            + line::<L>(bundle, field::FRICTION + 1, part) * slip.y
            + line::<L>(bundle, field::TWIST, part) * (spin_b.z - spin_a.z);
        for point in 0..bundle.points {
            let of = |line: usize| field::of_point(point, line);
            let parting = at(of(field::ARM_A), of(field::ARM_B)).z;
            sum = sum + line::<L>(bundle, of(field::IMPULSE), part) * parting;
        }
        sum.store(&mut work, part);
    }
    work
}

/// Lets impulses, in the order of [`field::IMPULSES`], act on both bodies.
#[inline(always)]
fn apply<L: Lanes>(bundle: &Bundle, velocities: &mut [Row], impulses: &[L; field::ROWS], part: usize) {
    let [first, second, third, fourth, x, y, twist] = *impulses;
    let zero = L::splat(0.0);
    let across = Vector::new(x, y, zero);
    let twist = Vector::new(zero, zero, twist);
    let mut turn_a = vector(bundle, field::FRICTION_ARM_A, part).cross(across) + twist;
    let mut turn_b = vector(bundle, field::FRICTION_ARM_B, part).cross(across) + twist;
    let pressures = [first, second, third, fourth];
    for (point, pressure) in pressures.into_iter().enumerate().take(bundle.points) {
        let along = Vector::new(zero, zero, pressure);
        turn_a = turn_a + vector(bundle, field::of_point(point, field::ARM_A), part).cross(along);
        turn_b = turn_b + vector(bundle, field::of_point(point, field::ARM_B), part).cross(along);
    }
    let impulse = Vector::new(x, y, (first + second) + (third + fourth));
    let frame = Frame::<L>::load(bundle, part);
    let pushed = Pair::gather(bundle, velocities, part).push(&frame, impulse, [turn_a, turn_b]);
    scatter(bundle, pushed, velocities, part);
}

/// One sweep over a bundle: each point, then the twist, then friction.
#[inline(always)]
pub(crate) fn sweep<L: Lanes>(bundle: &mut Bundle, velocities: &mut [Row]) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, velocities, part);
        let mut motion = Motion::new(&frame, &pair);
        for point in 0..bundle.points {
            motion.solve_normal(bundle, &pair, (point, part));
        }
        motion.finish_normals(&pair);
        motion.solve_twist(bundle, &pair, part);
        motion.solve_friction(bundle, part);
        (motion.residual * pair.inverse_mass()).store(&mut bundle.lines[field::RESIDUAL], part);
        let pushed = pair.push(&frame, motion.impulse, [motion.turn_a, motion.turn_b]);
        scatter(bundle, pushed, velocities, part);
    }
}

/// One sweep over the normals alone: with displacements in place of velocities, it pushes overlaps out.
#[inline(always)]
pub(crate) fn sweep_normals<L: Lanes>(bundle: &mut Bundle, displacements: &mut [Row]) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, displacements, part);
        let mut motion = Motion::new(&frame, &pair);
        for point in 0..bundle.points {
            motion.solve_normal(bundle, &pair, (point, part));
        }
        let pushed = pair.push(&frame, motion.impulse, [motion.turn_a, motion.turn_b]);
        scatter(bundle, pushed, displacements, part);
    }
}

/// How the two bodies of each lane move while their rows are solved (contact frame), and what has been given to them.
struct Motion<L> {
    /// Linear velocity of `b` against `a`.
    relative: Vector<L>,
    spin_a: Vector<L>,
    spin_b: Vector<L>,
    /// The impulses of this sweep, and their moments about each centre.
    impulse: Vector<L>,
    turn_a: Vector<L>,
    turn_b: Vector<L>,
    /// Sum of all points' impulses, and of these times their levers.
    pressure: L,
    moment: L,
    /// The largest change of an impulse.
    residual: L,
}

impl<L: Lanes> Motion<L> {
    #[inline(always)]
    fn new(frame: &Frame<L>, pair: &Pair<L>) -> Self {
        let zero = L::splat(0.0);
        let none = Vector::new(zero, zero, zero);
        Self {
            relative: frame.inward(linear(&pair.b) - linear(&pair.a)),
            spin_a: frame.inward(angular(&pair.a)),
            spin_b: frame.inward(angular(&pair.b)),
            impulse: none,
            turn_a: none,
            turn_b: none,
            pressure: zero,
            moment: zero,
            residual: zero,
        }
    }

    #[inline(always)]
    fn note(&mut self, change: L) {
        self.residual = self.residual.max(change).max(-change);
    }

    #[inline(always)]
    fn solve_normal(&mut self, bundle: &mut Bundle, pair: &Pair<L>, (point, part): (usize, usize)) {
        let at = |line: usize| field::of_point(point, line);
        let (a_x, a_y) =
            (line::<L>(bundle, at(field::ARM_A), part), line::<L>(bundle, at(field::ARM_A + 1), part));
        let (b_x, b_y) =
            (line::<L>(bundle, at(field::ARM_B), part), line::<L>(bundle, at(field::ARM_B + 1), part));
        let velocity = self.relative.z + (self.spin_b.x * b_y - self.spin_b.y * b_x)
            - (self.spin_a.x * a_y - self.spin_a.y * a_x);
        let mass = line::<L>(bundle, at(field::MASS), part);
        let least = line::<L>(bundle, at(field::LEAST), part);
        let before = line::<L>(bundle, at(field::IMPULSE), part);
        let impulse = (before - mass * (velocity - least)).max(L::splat(0.0));
        impulse.store(&mut bundle.lines[at(field::IMPULSE)], part);

        let change = impulse - before;
        self.note(change);
        self.pressure = self.pressure + impulse;
        self.moment = self.moment + impulse * line::<L>(bundle, at(field::LEVER), part);
        self.impulse.z = self.impulse.z + change;
        self.relative.z = self.relative.z + pair.inverse_mass() * change;
        let (x, y) = (a_y * change, -(a_x * change));
        let [xx, xy, _, yy, ..] = pair.inverse_inertia_a.0;
        self.turn_a.x = self.turn_a.x + x;
        self.turn_a.y = self.turn_a.y + y;
        self.spin_a.x = self.spin_a.x - (xx * x + xy * y);
        self.spin_a.y = self.spin_a.y - (xy * x + yy * y);
        let (x, y) = (b_y * change, -(b_x * change));
        let [xx, xy, _, yy, ..] = pair.inverse_inertia_b.0;
        self.turn_b.x = self.turn_b.x + x;
        self.turn_b.y = self.turn_b.y + y;
        self.spin_b.x = self.spin_b.x + (xx * x + xy * y);
        self.spin_b.y = self.spin_b.y + (xy * x + yy * y);
    }

    /// The spin about the normal, which the rows of the normals leave alone until here.
    #[inline(always)]
    fn finish_normals(&mut self, pair: &Pair<L>) {
        let [_, _, xz, _, yz, _] = pair.inverse_inertia_a.0;
        self.spin_a.z = self.spin_a.z - (xz * self.turn_a.x + yz * self.turn_a.y);
        let [_, _, xz, _, yz, _] = pair.inverse_inertia_b.0;
        self.spin_b.z = self.spin_b.z + (xz * self.turn_b.x + yz * self.turn_b.y);
    }

    #[inline(always)]
    fn solve_twist(&mut self, bundle: &mut Bundle, pair: &Pair<L>, part: usize) {
        let before = line::<L>(bundle, field::TWIST, part);
        let wanted = before - line::<L>(bundle, field::TWIST_MASS, part) * (self.spin_b.z - self.spin_a.z);
        let most = line::<L>(bundle, field::STATIC_FRICTION, part) * self.moment;
        let sliding = line::<L>(bundle, field::DYNAMIC_FRICTION, part) * self.moment;
        let kept = wanted.min(sliding).max(-sliding);
        let twist = L::select_greater(wanted.max(-wanted), most, [kept, wanted]);
        twist.store(&mut bundle.lines[field::TWIST], part);
        let change = twist - before;
        self.turn_a.z = self.turn_a.z + change;
        self.turn_b.z = self.turn_b.z + change;
        let [_, _, xz, _, yz, zz] = pair.inverse_inertia_a.0;
        self.spin_a = self.spin_a - Vector::new(xz, yz, zz).scaled(change);
        let [_, _, xz, _, yz, zz] = pair.inverse_inertia_b.0;
        self.spin_b = self.spin_b + Vector::new(xz, yz, zz).scaled(change);
    }

    /// Takes the slip away as far as the cone allows.
    ///
    /// The correction is along the slip itself, over the largest response in the tangent plane: were it `K⁻¹·slip`, a sliding
    /// contact would settle on a force that is askew of its slip, which no surface exerts (de Saxcé and Feng 1998).
    #[inline(always)]
    fn solve_friction(&mut self, bundle: &mut Bundle, part: usize) {
        let arm_a = vector::<L>(bundle, field::FRICTION_ARM_A, part);
        let arm_b = vector::<L>(bundle, field::FRICTION_ARM_B, part);
        let slip = self.relative + self.spin_b.cross(arm_b) - self.spin_a.cross(arm_a);
        let mass = line::<L>(bundle, field::FRICTION_MASS, part);
        let before = [line::<L>(bundle, field::FRICTION, part), line::<L>(bundle, field::FRICTION + 1, part)];
        let swing = [line::<L>(bundle, field::SWING, part), line::<L>(bundle, field::SWING + 1, part)];
        let (x, y) = (before[0] - mass * (slip.x + swing[0]), before[1] - mass * (slip.y + swing[1]));
        let size = (x * x + y * y).sqrt();
        let most = line::<L>(bundle, field::STATIC_FRICTION, part) * self.pressure;
        let sliding = line::<L>(bundle, field::DYNAMIC_FRICTION, part) * self.pressure;
        let (one, tiny) = (L::splat(1.0), L::splat(f32::MIN_POSITIVE));
        let kept = (sliding / (size + tiny)).min(one);
        let share = L::select_greater(size, most, [kept, one]);
        let (x, y) = (x * share, y * share);
        x.store(&mut bundle.lines[field::FRICTION], part);
        y.store(&mut bundle.lines[field::FRICTION + 1], part);
        let change = Vector::new(x - before[0], y - before[1], L::splat(0.0));
        self.note(change.x);
        self.note(change.y);
        self.impulse.x = change.x;
        self.impulse.y = change.y;
        self.turn_a = self.turn_a + arm_a.cross(change);
        self.turn_b = self.turn_b + arm_b.cross(change);
    }
}
