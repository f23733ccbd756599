//! The causes, and their sums.

use crate::math::DVec3;
use crate::world::Momentum;
use std::ops::{AddAssign, Sub};

/// What entered or left, by cause. Angular momentum is about the world's origin; energies in J.
///
/// Momentum is positive as it enters. Losses are positive when energy leaves, all other energies when it enters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Posts {
    /// From gravity.
    pub gravity: Momentum,
    /// From the user's forces, and from what was done to bodies between steps: velocities set, bodies moved, added and
    /// removed. Damping, a drag of the surroundings, takes its momentum to here. Overlaps of two bodies that move are pushed out
    /// as if from outside: that changes no linear momentum, and the angular momentum by what moves times its displacement. A body
    /// that is lost (no longer finite) leaves through here.
    pub external: Momentum,
    /// From what is fixed (`static` in files), and from bodies asleep, which stand like it. What rest capture and sleep take
    /// goes to here: through its supports into the ground.
    pub fixed: Momentum,
    /// From kinematic bodies, infinite masses, and axes of infinite inertia.
    pub kinematic: Momentum,
    /// Lost along the normals of collisions: those of C_r = 1 lose nothing.
    pub loss_restitution: f64,
    /// Lost across the normal, in collisions and in contacts: sliding and twisting.
    pub loss_friction: f64,
    /// Lost along the normals of contacts of C_r = 0: what comes more slowly than the rest threshold stays.
    pub loss_contact: f64,
    /// An artefact: lost in contacts of C_r > 0, whose last bounces are too slow to be resolved; and what rest capture takes from
    /// supported bodies that go nowhere.
    pub loss_rest_capture: f64,
    /// Lost to linear and angular damping.
    pub loss_damping: f64,
    /// Lost in joints: 0, as there are none yet.
    pub loss_joint: f64,
    /// An artefact: what bodies had when they were put to sleep.
    pub loss_sleep: f64,
    /// Work of motors: 0, as there are none yet.
    pub work_motor: f64,
    /// Work of the user's forces; the energy that was given and taken between steps.
    pub work_external: f64,
    /// Work of kinematic bodies, infinite masses and driven axes.
    pub work_kinematic: f64,
    /// An artefact: what pushing overlaps out has added.
    pub position_correction: f64,
    /// An artefact: what integration has added. Bodies that contacts hold get their velocity at the start of a substep where
    /// forces do not persist; bodies without symmetry turn to within 1e-12 of their energy, or what the flight module says.
    pub integration: f64,
}

/// What no cause explains; or what bodies have, or any change of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Residual {
    /// N·s
    pub linear: DVec3,
    /// About the world's origin, N·m·s.
    pub angular: DVec3,
    /// J
    pub energy: f64,
}

impl Residual {
    /// Without directions and signs.
    pub(super) fn sizes(&self) -> [f64; 3] {
        [self.linear.length(), self.angular.length(), self.energy.abs()]
    }
}

impl AddAssign for Residual {
    fn add_assign(&mut self, other: Self) {
        self.linear += other.linear;
        self.angular += other.angular;
        self.energy += other.energy;
    }
}

impl Sub for Residual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            linear: self.linear - other.linear,
            angular: self.angular - other.angular,
            energy: self.energy - other.energy,
        }
    }
}

impl Momentum {
    /// Adds an impulse and its moment about the origin.
    pub(crate) fn add(&mut self, linear: DVec3, angular: DVec3) {
        self.linear += linear;
        self.angular += angular;
    }
}

impl Posts {
    /// The accounts of momentum, with their names in files.
    pub fn momenta(&self) -> [(&'static str, Momentum); 4] {
        [
            ("gravity", self.gravity),
            ("external", self.external),
            ("static", self.fixed),
            ("kinematic", self.kinematic),
        ]
    }

    /// The posts of energy (J), with their names in files: what begins with `loss` leaves.
    pub fn energies(&self) -> [(&'static str, f64); 12] {
        [
            ("loss_restitution", self.loss_restitution),
            ("loss_friction", self.loss_friction),
            ("loss_contact", self.loss_contact),
            ("loss_rest_capture", self.loss_rest_capture),
            ("loss_damping", self.loss_damping),
            ("loss_joint", self.loss_joint),
            ("loss_sleep", self.loss_sleep),
            ("work_motor", self.work_motor),
            ("work_external", self.work_external),
            ("work_kinematic", self.work_kinematic),
            ("position_correction", self.position_correction),
            ("integration", self.integration),
        ]
    }

    /// How much energy (J) artefacts of the engine have moved, without signs.
    pub fn artefacts(&self) -> f64 {
        self.loss_rest_capture.abs()
            + self.loss_sleep.abs()
            + self.position_correction.abs()
            + self.integration.abs()
    }

    /// All that entered.
    pub(super) fn entered(&self) -> Residual {
        let sum = |of: fn(&Momentum) -> DVec3| self.momenta().iter().map(|(_, momentum)| of(momentum)).sum();
        let signed = |(name, value): (&str, f64)| if name.starts_with("loss") { -value } else { value };
        Residual {
            linear: sum(|momentum| momentum.linear),
            angular: sum(|momentum| momentum.angular),
            energy: self.energies().into_iter().map(signed).sum(),
        }
    }

    /// Sums of absolute values: linear and angular momentum, energy.
    pub(super) fn throughput(&self) -> [f64; 3] {
        let size = |v: DVec3| v.abs().element_sum();
        let momenta = self.momenta();
        [
            momenta.iter().map(|(_, momentum)| size(momentum.linear)).sum(),
            momenta.iter().map(|(_, momentum)| size(momentum.angular)).sum(),
            self.energies().into_iter().map(|(_, value)| value.abs()).sum(),
        ]
    }

    /// A change that was made from outside.
    pub(super) fn enters_from_outside(&mut self, change: &Residual) {
        self.external.add(change.linear, change.angular);
        self.work_external += change.energy;
    }

    pub(super) fn drop_what_is_not_finite(&mut self) {
        for momentum in [&mut self.gravity, &mut self.external, &mut self.fixed, &mut self.kinematic] {
            for vector in [&mut momentum.linear, &mut momentum.angular] {
                if !vector.is_finite() {
                    *vector = DVec3::ZERO;
                }
            }
        }
        self.energies_mut().into_iter().filter(|value| !value.is_finite()).for_each(|value| *value = 0.0);
    }

    fn energies_mut(&mut self) -> [&mut f64; 12] {
        [
            &mut self.loss_restitution,
            &mut self.loss_friction,
            &mut self.loss_contact,
            &mut self.loss_rest_capture,
            &mut self.loss_damping,
            &mut self.loss_joint,
            &mut self.loss_sleep,
            &mut self.work_motor,
            &mut self.work_external,
            &mut self.work_kinematic,
            &mut self.position_correction,
            &mut self.integration,
        ]
    }
}

impl AddAssign for Posts {
    fn add_assign(&mut self, other: Self) {
        self.gravity.add(other.gravity.linear, other.gravity.angular);
        self.external.add(other.external.linear, other.external.angular);
        self.fixed.add(other.fixed.linear, other.fixed.angular);
        self.kinematic.add(other.kinematic.linear, other.kinematic.angular);
        for (value, (_, other)) in self.energies_mut().into_iter().zip(other.energies()) {
            *value += other;
        }
    }
}
