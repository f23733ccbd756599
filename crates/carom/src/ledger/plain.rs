//! What the flights do of bodies that lie still: [`flights`](super::flights) in few words, as there are so many.

use super::flights::heavy_mass;
use super::journal::Journal;
use crate::flight::{Constants, Influence, RigidState, mean_center};
use crate::math::{DQuat, DVec3};

/// A stretch of the path of a body on which contacts and gravity alone act, evenly.
pub(super) struct PlainFlight<'a> {
    pub before: &'a RigidState,
    pub after: &'a RigidState,
    pub constants: &'a Constants,
    pub influence: &'a Influence,
    pub time: f64,
    /// Number of the path.
    pub course: u32,
}

/// Angle (rad) up to which a torque works along the turn from orientation to orientation: its work is off by this share at most. And up to
/// which it does along [`Constants::turn_of_kicks`], which is off by the square of it.
const HARDLY_A_TURN: f64 = 1e-7;
const SLIGHT_TURN: f64 = 1e-5;

/// Whether the flights of a body that contacts lead along an even path are plain unless the user pushes it: its mass and inertia are
/// finite, and nothing damps it.
#[inline]
pub(super) fn is_plain(constants: &Constants) -> bool {
    constants.is_regular() && constants.linear_damping == 0.0 && constants.angular_damping == 0.0
}

impl PlainFlight<'_> {
    /// Notes the way and the turn along which contacts work, if the body turns about all axes alike or but slightly; and books gravity, unless
    /// it has acted where contacts have, who book it then. That is all; tells whether it was.
    #[inline]
    pub fn book(&self, journal: &mut Journal, row: usize) -> bool {
        let Some(turn) = self.turn() else { return false };
        let hold = &mut journal.holds[row];
        hold.way += self.after.position - self.before.position;
        hold.turn += turn;
        hold.keeps_course = self.time == journal.substep && hold.course == self.course;
        if !hold.keeps_course {
            let mean = mean_center(self.before, self.constants, self.influence, self.time);
            journal.falls(row, heavy_mass(self.constants), (mean, self.time));
        }
        true
    }

    /// How far (rad) the body turns, as contacts feel it that twist it; none where a single vector does not tell.
    #[inline]
    fn turn(&self) -> Option<DVec3> {
        let (before, after, constants) = (self.before, self.after, self.constants);
        if constants.is_isotropic() {
            // However it is turned, the mean of its angular velocities is that of the mean of its angular momenta.
            let momentum = 0.5 * (before.angular_momentum + after.angular_momentum);
            return Some(constants.free_spin(before.rotation, momentum) * self.time);
        }
        let turn = small_turn(before.rotation, after.rotation);
        let angle = turn.length_squared();
        if angle <= HARDLY_A_TURN * HARDLY_A_TURN {
            return Some(turn);
        } else if angle > SLIGHT_TURN * SLIGHT_TURN {
            return None;
        }
        let kick = 0.5 * self.time * self.influence.torque;
        let middle = (before.rotation + after.rotation) * 0.5;
        Some(constants.turn_of_kicks(middle, [before.angular_momentum + kick, kick], self.time))
    }
}

/// The turn (rad) from one orientation to another one, but for the cube of it: the vector part of `2·to·from⁻¹`, from the difference of the
/// two, so that nothing is rounded but they.
#[inline]
fn small_turn(from: DQuat, to: DQuat) -> DVec3 {
    let (axis, change) = (from.xyz(), to - from);
    let turned = change.xyz();
    2.0 * (from.w * turned - change.w * axis + axis.cross(turned))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::rotation_from_vector;

    #[test]
    fn a_small_turn_is_found_again() {
        let from = rotation_from_vector(DVec3::new(-0.5, 0.2, 1.1));
        for size in [0.0, 1e-12, 1e-9, 1e-7] {
            let turn = size * DVec3::new(0.6, -0.64, 0.48);
            let to = (rotation_from_vector(turn) * from).normalize();
            let error = (small_turn(from, to) - turn).length();
            assert!(error < 1e-15, "{size}: {error}");
        }
    }
}
