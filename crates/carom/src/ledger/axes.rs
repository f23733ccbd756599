//! Where bodies' principal axes point.

use crate::flight::{Constants, RigidState};
use crate::math::{DMat3, DQuat, DVec3};

/// The principal axes of a body at the orientation at which they were last asked for: where a flight ends, the next one begins,
/// and the end of the step is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    rotation: DQuat,
    in_world: DMat3,
}

impl Axes {
    /// Of a body that nobody has asked about.
    pub const UNKNOWN: Self = Self { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), in_world: DMat3::ZERO };

    /// The axes of the body in this orientation.
    #[inline]
    pub fn at(&mut self, constants: &Constants, rotation: DQuat) -> DMat3 {
        if self.rotation != rotation {
            *self = Self { rotation, in_world: constants.principal_axes(rotation) };
        }
        self.in_world
    }

    /// The angular velocity of the body in this state, without the driven spin, rad/s.
    #[inline]
    pub fn spin(&mut self, constants: &Constants, state: &RigidState) -> DVec3 {
        if constants.is_isotropic() || state.angular_momentum == DVec3::ZERO {
            return constants.free_spin(state.rotation, state.angular_momentum);
        }
        constants.spin_about(&self.at(constants, state.rotation), state.angular_momentum)
    }
}
