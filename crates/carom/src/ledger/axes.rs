//! Where bodies' principal axes point.

use crate::flight::Constants;
use crate::math::{DMat3, DQuat, DVec3};

/// The principal axes of a body at the orientation at which they were last asked for, and the energy of turning: where a flight ends,
/// the next one begins, and the end of the step is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    rotation: DQuat,
    in_world: DMat3,
    /// The angular momentum (N·m·s) that turned the body about these axes when it was last asked for its energy, J.
    momentum: DVec3,
    energy: f64,
}

impl Axes {
    /// Of a body that nobody has asked about.
    pub const UNKNOWN: Self = Self {
        rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0),
        in_world: DMat3::ZERO,
        momentum: DVec3::ZERO,
        energy: 0.0,
    };

    /// The axes of the body in this orientation.
    #[inline]
    pub fn at(&mut self, constants: &Constants, rotation: DQuat) -> &DMat3 {
        if self.rotation != rotation {
            *self = Self { rotation, in_world: constants.principal_axes(rotation), ..Self::UNKNOWN };
        }
        &self.in_world
    }

    /// The angular velocity that an angular momentum gives to the body in this orientation, without the driven spin, rad/s.
    #[inline]
    pub fn spin(&mut self, constants: &Constants, rotation: DQuat, momentum: DVec3) -> DVec3 {
        if constants.is_isotropic() || momentum == DVec3::ZERO {
            return constants.free_spin(rotation, momentum);
        }
        constants.spin_about(self.at(constants, rotation), momentum)
    }

    /// The energy (J) with which an angular momentum turns the body in this orientation.
    #[inline]
    pub fn spin_energy(&mut self, constants: &Constants, rotation: DQuat, momentum: DVec3) -> f64 {
        if constants.is_isotropic() {
            return 0.5 * momentum.dot(constants.free_spin(rotation, momentum));
        }
        if momentum != self.momentum || (rotation != self.rotation && momentum != DVec3::ZERO) {
            self.energy = constants.spin_energy(self.at(constants, rotation), momentum);
            self.momentum = momentum;
        }
        self.energy
    }
}
