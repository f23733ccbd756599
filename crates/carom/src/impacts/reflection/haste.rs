//! Fewer sweeps in a round of reflections: what a sweep has changed says where the next ones lead.

use super::{Blow, Round, push};

/// So many sweeps are made without haste: mostly they are enough.
const PATIENCE: usize = 4;

/// Conjugate gradients over sweeps: before each sweep the impulses go on in the direction in which they have changed so far, by as
/// much as the changes have become smaller. The sweep then puts right what went too far: no push pulls, and friction keeps to its cone.
/// Where changes become greater, the direction is forgotten.
///
/// Silcowitz, Niebel, Erleben, *A nonsmooth nonlinear conjugate gradient method for interactive contact force problems* (The Visual
/// Computer 26, 2010), here with friction and with changes measured by what they do to velocities.
#[derive(Default)]
pub(super) struct Haste {
    sweeps: usize,
    /// Impulses before the last sweep, and the direction in which they are to go on.
    before: Vec<Blow>,
    direction: Vec<Blow>,
    /// How much the last sweep changed.
    changed: f64,
}

impl Haste {
    /// Takes impulses further before the next sweep; returns whether it has.
    pub fn hurry(&mut self, round: &mut Round<'_>) -> bool {
        self.sweeps += 1;
        if self.sweeps <= PATIENCE {
            return false;
        }
        let is_first = self.before.is_empty();
        let hurries = !is_first && self.go_on(round);
        self.before.clone_from(&round.blows);
        hurries
    }

    fn go_on(&mut self, round: &mut Round<'_>) -> bool {
        let mut changed = 0.0;
        for ((blow, before), row) in round.blows.iter_mut().zip(&mut self.before).zip(&round.rows) {
            before.normal = blow.normal - before.normal;
            before.tangent = blow.tangent - before.tangent;
            changed +=
                row.per_impulse * before.normal.powi(2) + row.yielding * before.tangent.length_squared();
        }
        let changes = &self.before;
        let share = changed / std::mem::replace(&mut self.changed, changed);
        if share > 1.0 || share.is_nan() {
            self.direction.clone_from(changes);
            return false;
        }
        for (index, (direction, change)) in self.direction.iter_mut().zip(changes).enumerate() {
            direction.normal *= share;
            direction.tangent *= share;
            let (blow, spot) = (&mut round.blows[index], &round.spots[index]);
            blow.normal += direction.normal;
            blow.tangent += direction.tangent;
            push(round.movers, &mut round.velocities, spot, direction.impulse(spot));
            direction.normal += change.normal;
            direction.tangent += change.tangent;
        }
        true
    }
}
