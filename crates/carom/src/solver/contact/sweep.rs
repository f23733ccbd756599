//! Impulses, row by row.

use super::{Frame, Pair, angular, lever, line, linear, pressed, scatter, vector};
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::lanes::{LANES, Lanes, Vector};
use crate::solver::rows::SharedRows;

/// One sweep over a bundle: each point, then the twist, then friction.
#[inline(always)]
pub(crate) fn sweep<L: Lanes>(bundle: &mut Bundle, velocities: SharedRows<'_>) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, velocities, part);
        let mut motion = Motion::new(bundle, (&frame, &pair), part);
        motion.solve_normals(bundle, &pair, part);
        motion.turn_on(&pair);
        motion.solve_twist(bundle, &pair, part);
        motion.solve_friction(bundle, part);
        motion.finish(bundle, (&frame, pair), (velocities, part));
    }
}

/// One sweep over the normals alone: with displacements in place of velocities, it pushes overlaps out.
#[inline(always)]
pub(crate) fn sweep_normals<L: Lanes>(bundle: &mut Bundle, displacements: SharedRows<'_>) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, displacements, part);
        let mut motion = Motion::new(bundle, (&frame, &pair), part);
        motion.solve_normals(bundle, &pair, part);
        motion.finish(bundle, (&frame, pair), (displacements, part));
    }
}

/// How the points of each lane see the motion of its two bodies, `b` against `a`, while their rows are solved one after the other.
///
/// Arms are arms of friction plus levers, the same levers for both bodies. So a point with the lever (x, y) parts at the speed with which
/// the surfaces part where friction acts, and what the bodies' turning against each other adds: `u + ω₁·y − ω₂·x`. An impulse at that
/// point changes (u, ω₁, ω₂) by `K·(1, y, −x)`.
struct Parting<L> {
    speed: L,
    spin: [L; 2],
    /// K: the response of `speed` to a push where friction acts; of `spin` to that, and of `speed` to a moment; of `spin` to a moment.
    push: L,
    mixed: [L; 2],
    turn: [L; 3],
}

impl<L: Lanes> Parting<L> {
    #[inline(always)]
    fn new(motion: &Motion<L>, pair: &Pair<L>) -> Self {
        let Motion { relative, spin_a, spin_b, arm_a, arm_b, .. } = motion;
        let [a_xx, a_xy, _, a_yy, ..] = pair.inverse_inertia_a.0;
        let [b_xx, b_xy, _, b_yy, ..] = pair.inverse_inertia_b.0;
        // What a push along the normal turns: F × n = (y, −x).
        let turned_a = [a_xx * arm_a.y - a_xy * arm_a.x, a_xy * arm_a.y - a_yy * arm_a.x];
        let turned_b = [b_xx * arm_b.y - b_xy * arm_b.x, b_xy * arm_b.y - b_yy * arm_b.x];
        Self {
            speed: relative.z + (spin_b.x * arm_b.y - spin_b.y * arm_b.x)
                - (spin_a.x * arm_a.y - spin_a.y * arm_a.x),
            spin: [spin_b.x - spin_a.x, spin_b.y - spin_a.y],
            push: pair.inverse_mass()
                + (turned_a[0] * arm_a.y - turned_a[1] * arm_a.x)
                + (turned_b[0] * arm_b.y - turned_b[1] * arm_b.x),
            mixed: [turned_a[0] + turned_b[0], turned_a[1] + turned_b[1]],
            turn: [a_xx + b_xx, a_xy + b_xy, a_yy + b_yy],
        }
    }

    /// Gives a point the impulse that it asks for; comes to that impulse, and by how much it has changed.
    #[inline(always)]
    fn solve(&mut self, bundle: &mut Bundle, [x, y]: [L; 2], (point, part): (usize, usize)) -> [L; 2] {
        let at = |line: usize| field::of_point(point, line);
        let ([first, second], [xx, xy, yy]) = (self.mixed, self.turn);
        let response =
            [self.push + (first * y - second * x), first + (xx * y - xy * x), second + (xy * y - yy * x)];
        let velocity = self.speed + (self.spin[0] * y - self.spin[1] * x);
        let mass = line::<L>(bundle, at(field::MASS), part);
        let least = line::<L>(bundle, at(field::LEAST), part);
        let before = line::<L>(bundle, at(field::IMPULSE), part);
        let impulse = (before - mass * (velocity - least)).max(L::splat(0.0));
        impulse.store(&mut bundle.lines[at(field::IMPULSE)], part);
        let change = impulse - before;
        self.speed = self.speed + response[0] * change;
        self.spin = [self.spin[0] + response[1] * change, self.spin[1] + response[2] * change];
        [impulse, change]
    }
}

/// How the two bodies of each lane move while their rows are solved (contact frame), and what has been given to them.
struct Motion<L> {
    /// Linear velocity of `b` against `a`.
    relative: Vector<L>,
    spin_a: Vector<L>,
    spin_b: Vector<L>,
    /// Arms of friction.
    arm_a: Vector<L>,
    arm_b: Vector<L>,
    /// The impulses of this sweep, and their moment about where friction acts.
    impulse: Vector<L>,
    moment: Vector<L>,
    /// Sum of all points' impulses, and of these times their distances from where friction acts.
    pressure: L,
    grip: L,
    /// The largest change of an impulse.
    residual: L,
}

impl<L: Lanes> Motion<L> {
    #[inline(always)]
    fn new(bundle: &Bundle, (frame, pair): (&Frame<L>, &Pair<L>), part: usize) -> Self {
        let zero = L::splat(0.0);
        let none = Vector::new(zero, zero, zero);
        Self {
            relative: frame.inward(linear(&pair.b) - linear(&pair.a)),
            spin_a: frame.inward(angular(&pair.a)),
            spin_b: frame.inward(angular(&pair.b)),
            arm_a: vector(bundle, field::FRICTION_ARM_A, part),
            arm_b: vector(bundle, field::FRICTION_ARM_B, part),
            impulse: none,
            moment: none,
            pressure: zero,
            grip: zero,
            residual: zero,
        }
    }

    #[inline(always)]
    fn note(&mut self, change: L) {
        self.residual = self.residual.max(change).max(-change);
    }

    #[inline(always)]
    fn solve_normals(&mut self, bundle: &mut Bundle, pair: &Pair<L>, part: usize) {
        let mut parting = Parting::new(self, pair);
        for point in 0..bundle.points.min(POINTS) {
            let lever = lever::<L>(bundle, (point, part));
            let [impulse, change] = parting.solve(bundle, lever, (point, part));
            self.note(change);
            self.pressure = self.pressure + impulse;
            let distance = line::<L>(bundle, field::of_point(point, field::DISTANCE), part);
            self.grip = self.grip + impulse * distance;
            self.impulse.z = self.impulse.z + change;
            self.moment = self.moment + pressed(lever, change);
        }
    }

    /// What has been given to each body, about its own centre.
    #[inline(always)]
    fn turns(&self) -> [Vector<L>; 2] {
        [self.arm_a.cross(self.impulse) + self.moment, self.arm_b.cross(self.impulse) + self.moment]
    }

    /// Lets the bodies turn by what the rows of the normals have given to them.
    #[inline(always)]
    fn turn_on(&mut self, pair: &Pair<L>) {
        let turn = pressed([self.arm_a.x, self.arm_a.y], self.impulse.z) + self.moment;
        self.spin_a = self.spin_a - pair.inverse_inertia_a.times_across([turn.x, turn.y]);
        let turn = pressed([self.arm_b.x, self.arm_b.y], self.impulse.z) + self.moment;
        self.spin_b = self.spin_b + pair.inverse_inertia_b.times_across([turn.x, turn.y]);
    }

    /// Gives the bodies what has been found, and notes how far that has changed a velocity.
    #[inline(always)]
    fn finish(
        self,
        bundle: &mut Bundle,
        (frame, pair): (&Frame<L>, Pair<L>),
        (velocities, part): (SharedRows<'_>, usize),
    ) {
        (self.residual * pair.inverse_mass()).store(&mut bundle.lines[field::RESIDUAL], part);
        let pushed = pair.push(frame, self.impulse, self.turns());
        scatter(bundle, pushed, velocities, part);
    }

    #[inline(always)]
    fn solve_twist(&mut self, bundle: &mut Bundle, pair: &Pair<L>, part: usize) {
        let before = line::<L>(bundle, field::TWIST, part);
        let wanted = before - line::<L>(bundle, field::TWIST_MASS, part) * (self.spin_b.z - self.spin_a.z);
        let most = line::<L>(bundle, field::STATIC_FRICTION, part) * self.grip;
        let sliding = line::<L>(bundle, field::DYNAMIC_FRICTION, part) * self.grip;
        let kept = wanted.min(sliding).max(-sliding);
        let twist = L::select_greater(wanted.max(-wanted), most, [kept, wanted]);
        twist.store(&mut bundle.lines[field::TWIST], part);
        let change = twist - before;
        self.moment.z = change;
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
        let slip = self.relative + self.spin_b.cross(self.arm_b) - self.spin_a.cross(self.arm_a);
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
        (self.impulse.x, self.impulse.y) = (x - before[0], y - before[1]);
        self.note(self.impulse.x);
        self.note(self.impulse.y);
    }
}
