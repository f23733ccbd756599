//! Passes over all contacts: colour after colour, the bundles of a colour shared out among the threads.
//!
//! The colours' order is the same for everyone, and bundles of one colour have no movable body in common. So a pass comes to the same
//! bits on any number of threads.

use super::{Color, ContactId, FIXED, Graph, KINDS, MOVING};
use crate::solver::bundle::Bundle;
use crate::solver::kernels::{Begin, Measure, Sweep};
use crate::solver::lanes::{LANES, Machine, Row};
use crate::solver::rows::SharedRows;
use crate::step::profile::{self, Phase};

/// Bundles that are worth a thread's while: a sweep over so many takes some microseconds. A colour with less than twice as many
/// stays with the caller.
pub(super) const GRAIN: usize = 8;

/// The same where all that is done with a bundle is to look at it.
pub(super) const GLANCES: usize = 256;

/// A bundle: its colour, and its index there.
pub(super) type Spot = (usize, usize);

/// Which bundles of a colour, and how many.
pub(super) struct Chosen {
    pub is_chosen: Vec<bool>,
    pub count: usize,
}

impl Graph {
    /// Colours in the order in which they are swept.
    pub(super) fn order(&self) -> impl Iterator<Item = usize> + use<> {
        let count = self.colors.len();
        (MOVING..count).step_by(KINDS).chain((FIXED..count).step_by(KINDS))
    }

    /// One colour after the other, each in stretches.
    fn each_color(&mut self, act: impl Fn(Machine, &mut [Bundle]) + Sync) {
        for color in self.order() {
            let machine = self.machine;
            self.pool.chunks(&mut self.colors[color].bundles, GRAIN, |_, bundles| act(machine, bundles));
        }
    }

    /// The contacts of a bundle's lanes.
    pub(super) fn contacts_of(&self, (color, index): Spot) -> &[u32] {
        let contacts = &self.colors[color].contacts;
        &contacts[index * LANES..contacts.len().min((index + 1) * LANES)]
    }

    /// Finds all separations from the bodies' drifts; comes to the contacts whose bodies have strayed too far from each other, or
    /// that have left the reach of theirs.
    pub fn measure(&mut self, drifts: &[Row]) -> Vec<ContactId> {
        let _phase = profile::phase(Phase::Measure);
        let machine = self.machine;
        let mut noted = Vec::new();
        for color in self.order() {
            let Color { bundles, contacts, .. } = &mut self.colors[color];
            let stretches = self
                .pool
                .chunks(bundles, GRAIN, |first, bundles| (first, machine.run(Measure { bundles, drifts })));
            for (first, found) in stretches {
                for index in found.into_iter().map(|index| first + index) {
                    let bundle = &bundles[index];
                    let lanes = contacts[index * LANES..].iter().take(LANES).enumerate();
                    let noteworthy =
                        lanes.filter(|&(lane, _)| bundle.has_strayed(lane) || bundle.has_left(lane));
                    noted.extend(noteworthy.map(|(_, &contact)| ContactId(contact)));
                }
            }
        }
        noted
    }

    /// Starts a substep from the velocities `before`, and lets the impulses of the last one act on the others; margin (m), rate (1/s).
    pub(super) fn resume(&mut self, (before, velocities): (&[Row], &mut [Row]), limits: [f32; 2]) {
        let velocities = SharedRows::new(velocities);
        self.each_color(|machine, bundles| machine.run(Begin { bundles, before, velocities, limits }));
    }

    /// Sweeps once over all bundles, or those `chosen` of each colour; where this has changed a velocity by more than `agreement`, m/s.
    pub(super) fn sweep(
        &mut self,
        velocities: &mut [Row],
        chosen: Option<&[Chosen]>,
        agreement: f32,
    ) -> Vec<Spot> {
        let _phase = profile::phase(Phase::Sweep);
        let velocities = SharedRows::new(velocities);
        let machine = self.machine;
        let mut open = Vec::new();
        for color in self.order() {
            let Color { bundles, .. } = &mut self.colors[color];
            let chosen = chosen.map(|colors| &colors[color]);
            let count = chosen.map_or(bundles.len(), |chosen| chosen.count);
            if count == 0 {
                continue;
            }
            let grain = GRAIN * bundles.len() / count;
            let stretches = self.pool.chunks(bundles, grain, |first, bundles| {
                let chosen = chosen.map(|it| &it.is_chosen[first..first + bundles.len()]);
                (first, machine.run(Sweep { bundles, chosen, velocities, agreement }))
            });
            for (first, found) in stretches {
                open.extend(found.into_iter().map(|index| (color, first + index)));
            }
        }
        open
    }
}
