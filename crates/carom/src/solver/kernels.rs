//! The arithmetic of [`contact`](super::contact) for the bundles of a colour: one call for all of them, which a
//! [`Machine`](super::lanes::Machine) makes with its widest instructions.

use super::bundle::{Bundle, field};
use super::contact::{begin, measure, resume, sweep, sweep_normals, work};
use super::lanes::{Kernel, LANES, Lanes, Line, Row};
use super::rows::SharedRows;

/// Has the first lines, `read` of them, of the bundle after number `index` brought near while that one is worked on: in a large world
/// bundles are far more than a cache holds, and what is done with one takes less time than to fetch it.
#[inline(always)]
pub(super) fn bring_next<L: Lanes>(bundles: &[Bundle], index: usize, read: usize) {
    if let Some(next) = bundles.get(index + 1) {
        L::bring_near(&next.lines[..read]);
    }
}

/// [`measure`]; comes to the indices of the bundles with a contact that somebody has to look at.
pub(crate) struct Measure<'a> {
    pub bundles: &'a mut [Bundle],
    pub drifts: &'a [Row],
}

impl Kernel for Measure<'_> {
    type Output = Vec<usize>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<usize> {
        let mut noted = Vec::new();
        for index in 0..self.bundles.len() {
            bring_next::<L>(self.bundles, index, field::COUNT);
            let bundle = &mut self.bundles[index];
            measure::<L>(bundle, self.drifts);
            let mut is_noted = false;
            for lane in 0..LANES {
                is_noted |= bundle.has_strayed(lane) | bundle.has_left(lane);
            }
            if is_noted {
                noted.push(index);
            }
        }
        noted
    }
}

/// [`begin`], and [`resume`] with the impulses of the substep before.
pub(crate) struct Begin<'a> {
    pub bundles: &'a mut [Bundle],
    /// Velocities of bodies that nothing has pushed yet.
    pub before: &'a [Row],
    pub velocities: SharedRows<'a>,
    /// Margin (m) and rate (1/s).
    pub limits: [f32; 2],
}

impl Kernel for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for index in 0..self.bundles.len() {
            bring_next::<L>(self.bundles, index, field::COUNT);
            begin::<L>(&mut self.bundles[index], self.before, self.limits);
            resume::<L>(&self.bundles[index], self.velocities);
        }
    }
}

/// [`work`] of a bundle.
pub(crate) struct Work<'a> {
    pub bundle: &'a Bundle,
    pub before: &'a [Row],
    pub after: &'a [Row],
}

impl Kernel for Work<'_> {
    type Output = Line;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Line {
        work::<L>(self.bundle, self.before, self.after)
    }
}

/// [`sweep`]; comes to the indices of the bundles in which a velocity has changed by more than `agreement`, m/s.
pub(crate) struct Sweep<'a> {
    pub bundles: &'a mut [Bundle],
    /// Which of the bundles, if not all.
    pub chosen: Option<&'a [bool]>,
    pub velocities: SharedRows<'a>,
    pub agreement: f32,
}

impl Kernel for Sweep<'_> {
    type Output = Vec<usize>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<usize> {
        let mut open = Vec::new();
        for index in 0..self.bundles.len() {
            if let Some(chosen) = self.chosen
                && !chosen[index]
            {
                continue;
            }
            bring_next::<L>(self.bundles, index, field::SWEPT);
            sweep::<L>(&mut self.bundles[index], self.velocities);
            let mut is_open = false;
            for residual in self.bundles[index].lines[field::RESIDUAL].0 {
                is_open |= residual > self.agreement;
            }
            if is_open {
                open.push(index);
            }
        }
        open
    }
}

/// [`sweep_normals`].
pub(crate) struct SweepNormals<'a> {
    pub bundles: &'a mut [Bundle],
    /// Which of the bundles.
    pub chosen: &'a [bool],
    pub displacements: SharedRows<'a>,
}

impl Kernel for SweepNormals<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for index in (0..self.bundles.len()).filter(|&index| self.chosen[index]) {
            bring_next::<L>(self.bundles, index, field::SWEPT);
            sweep_normals::<L>(&mut self.bundles[index], self.displacements);
        }
    }
}
