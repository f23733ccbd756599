//! Impulses, row by row.

use super::{Frame, Pair, angular, line, linear, scatter, vector};
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::lanes::{LANES, Lanes, Vector};
use crate::solver::rows::SharedRows;

/// One sweep over a bundle: each point, then the twist, then friction.
#[inline(always)]
pub(crate) fn sweep<L: Lanes>(bundle: &mut Bundle, velocities: SharedRows<'_>) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, velocities, part);
        let mut motion = Motion::new(&frame, &pair);
        for point in 0..bundle.points.min(POINTS) {
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
pub(crate) fn sweep_normals<L: Lanes>(bundle: &mut Bundle, displacements: SharedRows<'_>) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let pair = Pair::gather(bundle, displacements, part);
        let mut motion = Motion::new(&frame, &pair);
        for point in 0..bundle.points.min(POINTS) {
            motion.solve_normal(bundle, &pair, (point, part));
        }
        (motion.residual * pair.inverse_mass()).store(&mut bundle.lines[field::RESIDUAL], part);
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
