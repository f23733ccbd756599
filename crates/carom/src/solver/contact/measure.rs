//! Where contacts are: separations and arms, from how far their bodies have gone.

use super::{Frame, angular, indices, line, linear, store, turning, vector};
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::lanes::{LANES, Lanes, Row, Vector};
use crate::solver::rows::LEASH;

/// How far the turn `(x, y, z, w)` since the anchor moves a point along the normal, per metre of its arm: `Rᵀn − n`, in the
/// contact frame.
#[inline(always)]
fn drift_of_arm<L: Lanes>(frame: &Frame<L>, row: &[L; 8]) -> Vector<L> {
    let turn = frame.inward(angular(row));
    let (x, y, z, w, two) = (turn.x, turn.y, turn.z, row[6], L::splat(2.0));
    Vector::new(two * (x * z - w * y), two * (y * z + w * x), -two * (x * x + y * y))
}

/// Finds the separation of every point from the bodies' `drifts` since their anchors, how far they have strayed from each other,
/// and lets both arms end where impulses act now.
#[inline(always)]
pub(crate) fn measure<L: Lanes>(bundle: &mut Bundle, drifts: &[Row]) {
    for part in 0..LANES / L::WIDTH {
        let frame = Frame::<L>::load(bundle, part);
        let drift_a = L::gather(drifts, indices(&bundle.a, part, L::WIDTH));
        let drift_b = L::gather(drifts, indices(&bundle.b, part, L::WIDTH));
        let apart = (linear(&drift_b) - linear(&drift_a)).dot(frame.normal);
        let (turn_a, turn_b) = (drift_of_arm(&frame, &drift_a), drift_of_arm(&frame, &drift_b));
        let shift = Shift::new(bundle, &frame, [&drift_a, &drift_b], part);
        let mut gap = L::splat(f32::MAX);
        let [arm_a, arm_b] = shift.arms;
        let apart = apart + (turn_b.dot(arm_b) - turn_a.dot(arm_a));
        let (tilt, turn) = (turn_b - turn_a, shift.mean_turn());
        for point in 0..bundle.points.min(POINTS) {
            let at = |line: usize| field::of_point(point, line);
            let lever = vector::<L>(bundle, at(field::RENEWED_LEVER), part);
            let separation = line::<L>(bundle, at(field::BASE), part) + apart + tilt.dot(lever);
            separation.store(&mut bundle.lines[at(field::SEPARATION)], part);
            let carried = turn.cross(lever);
            (lever.x + carried.x).store(&mut bundle.lines[at(field::LEVER)], part);
            (lever.y + carried.y).store(&mut bundle.lines[at(field::LEVER) + 1], part);
            let real = line::<L>(bundle, at(field::MASS), part);
            gap = L::select_greater(real, L::splat(0.0), [gap.min(separation), gap]);
        }
        shift.friction(bundle, part);
        (shift.way - drift_a[LEASH].max(drift_b[LEASH])).store(&mut bundle.lines[field::STRAY], part);
        gap.store(&mut bundle.lines[field::GAP], part);
    }
}

/// Twice the vector of a body's turn, contact frame.
#[inline(always)]
fn twice_turn<L: Lanes>(frame: &Frame<L>, drift: &[L; 8]) -> Vector<L> {
    frame.inward(angular(drift)).scaled(L::splat(2.0) * drift[6])
}

/// How bodies have moved since a contact was renewed, and where this leads the place at which its impulses act: between where the
/// two bodies would carry it, by their shares.
struct Shift<L> {
    /// `b` against `a`.
    moved: Vector<L>,
    /// How far that is.
    way: L,
    /// Turn of each body, rad.
    turn_a: Vector<L>,
    turn_b: Vector<L>,
    share: L,
    /// The parts of the arms of friction that turn with their bodies, when the contact was renewed.
    arms: [Vector<L>; 2],
    /// Where one surface is round, how far the place has gone round it as the other one turned, and the normal with it.
    tilted: Vector<L>,
}

impl<L: Lanes> Shift<L> {
    #[inline(always)]
    fn new(bundle: &Bundle, frame: &Frame<L>, [drift_a, drift_b]: [&[L; 8]; 2], part: usize) -> Self {
        let moved = frame.inward(linear(drift_b) - linear(drift_a));
        let moved = moved - vector(bundle, field::DRIFTED, part);
        let turn_a = twice_turn(frame, drift_a) - vector(bundle, field::TURNED_A, part);
        let turn_b = twice_turn(frame, drift_b) - vector(bundle, field::TURNED_B, part);
        // Against what has a large radius, as far as the body's own arm: further round, substeps would have to be shorter.
        let zero = L::splat(0.0);
        let arms = [
            vector::<L>(bundle, field::RENEWED_FRICTION_A, part),
            vector(bundle, field::RENEWED_FRICTION_B, part),
        ];
        let (depth_a, depth_b) = (arms[0].z, arms[1].z);
        let (radius_a, radius_b) =
            (line::<L>(bundle, field::ROUNDNESS, part), line::<L>(bundle, field::ROUNDNESS + 1, part));
        // Where both surfaces are round, it is the normal that turns as one rolls over the other.
        let follows = L::select_greater(radius_a.min(radius_b), zero, [zero, L::splat(1.0)]);
        let round_a = radius_a.min((zero - depth_b).max(zero)) * follows;
        let round_b = radius_b.min(depth_a.max(zero)) * follows;
        Self {
            moved: moved.scaled(follows),
            way: moved.dot(moved).sqrt(),
            tilted: Vector::new(
                turn_b.y * round_a - turn_a.y * round_b,
                turn_a.x * round_b - turn_b.x * round_a,
                zero,
            ),
            turn_a,
            turn_b,
            share: line(bundle, field::SHARE, part),
            arms: turning(bundle, arms, part),
        }
    }

    /// How far the place turns that both bodies would carry along, rad.
    #[inline(always)]
    fn mean_turn(&self) -> Vector<L> {
        self.turn_a.scaled(L::splat(1.0) - self.share) + self.turn_b.scaled(self.share)
    }

    /// Lets both arms of friction end where it acts now.
    #[inline(always)]
    fn friction(&self, bundle: &mut Bundle, part: usize) {
        let (carried_a, carried_b) = (self.turn_a.cross(self.arms[0]), self.turn_b.cross(self.arms[1]));
        let rest = L::splat(1.0) - self.share;
        let shift_a = carried_a.scaled(rest) + (carried_b + self.moved).scaled(self.share) + self.tilted;
        let shift_b = carried_b.scaled(self.share) + (carried_a - self.moved).scaled(rest) + self.tilted;
        let arm_a = vector::<L>(bundle, field::RENEWED_FRICTION_A, part);
        let arm_b = vector::<L>(bundle, field::RENEWED_FRICTION_B, part);
        store(arm_a + shift_a, bundle, field::FRICTION_ARM_A, part);
        store(arm_b + shift_b, bundle, field::FRICTION_ARM_B, part);
    }
}
