//! The arithmetic of [`contact`](super::contact) for the bundles of a colour: one call for all of them, which a
//! [`Machine`](super::lanes::Machine) makes with its widest instructions.

use super::bundle::Bundle;
use super::contact::{begin, measure, resume, sweep, sweep_normals, work};
use super::lanes::{Kernel, Lanes, Line, Row};

/// [`measure`].
pub(crate) struct Measure<'a> {
    pub bundles: &'a mut [Bundle],
    pub drifts: &'a [Row],
}

impl Kernel for Measure<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for bundle in self.bundles {
            measure::<L>(bundle, self.drifts);
        }
    }
}

/// [`begin`].
pub(crate) struct Begin<'a> {
    pub bundles: &'a mut [Bundle],
    pub velocities: &'a [Row],
    /// Margin (m) and rate (1/s).
    pub limits: [f32; 2],
}

impl Kernel for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for bundle in self.bundles {
            begin::<L>(bundle, self.velocities, self.limits);
        }
    }
}

/// [`resume`].
pub(crate) struct Resume<'a> {
    pub bundles: &'a [Bundle],
    pub velocities: &'a mut [Row],
}

impl Kernel for Resume<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for bundle in self.bundles {
            resume::<L>(bundle, self.velocities);
        }
    }
}

/// [`work`], bundle by bundle.
pub(crate) struct Work<'a> {
    pub bundles: &'a [Bundle],
    pub before: &'a [Row],
    pub after: &'a [Row],
}

impl Kernel for Work<'_> {
    type Output = Vec<Line>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<Line> {
        let mut works = Vec::with_capacity(self.bundles.len());
        for bundle in self.bundles {
            works.push(work::<L>(bundle, self.before, self.after));
        }
        works
    }
}

/// [`sweep`] over all.
pub(crate) struct Sweep<'a> {
    pub bundles: &'a mut [Bundle],
    pub velocities: &'a mut [Row],
}

impl Kernel for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for bundle in self.bundles {
            sweep::<L>(bundle, self.velocities);
        }
    }
}

/// [`sweep`] over those `chosen`, by their indices.
pub(crate) struct SweepSome<'a> {
    pub bundles: &'a mut [Bundle],
    pub chosen: &'a [usize],
    pub velocities: &'a mut [Row],
}

impl Kernel for SweepSome<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for &index in self.chosen {
            sweep::<L>(&mut self.bundles[index], self.velocities);
        }
    }
}

/// [`sweep_normals`].
pub(crate) struct SweepNormals<'a> {
    pub bundles: &'a mut [Bundle],
    pub displacements: &'a mut [Row],
}

impl Kernel for SweepNormals<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        for bundle in self.bundles {
            sweep_normals::<L>(bundle, self.displacements);
        }
    }
}
