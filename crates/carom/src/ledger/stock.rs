//! What bodies have.

use super::Residual;
use super::flights::heavy_mass;
use crate::bodies::Bodies;
use crate::flight::{Constants, RigidState};
use crate::math::DVec3;
use crate::world::{Energy, Momentum};
use std::ops::AddAssign;

/// What the dynamic bodies have: momentum about the world's origin, and energy. Infinite masses and inertias take no part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stock {
    /// Linear and angular momentum.
    pub momentum: Momentum,
    /// Kinetic and potential energy, J.
    pub energy: Energy,
    /// Energy in springs, J: 0, as there are none yet.
    pub elastic: f64,
}

impl Stock {
    /// What the body of a row has.
    pub(crate) fn of_row(bodies: &Bodies, row: usize, gravity: DVec3) -> Self {
        let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
        Self::of(state, constants, constants.angular_velocity(state), gravity)
    }

    /// What a body has in this state, with the angular velocity (rad/s) that goes with it.
    #[inline]
    pub(super) fn of(
        state: &RigidState,
        constants: &Constants,
        angular_velocity: DVec3,
        gravity: DVec3,
    ) -> Self {
        let mut stock = Stock::default();
        if !constants.is_movable() {
            return stock;
        }
        stock.energy.kinetic = if constants.driven_spin == DVec3::ZERO {
            0.5 * state.angular_momentum.dot(angular_velocity)
        } else {
            constants.spin_energy(state.rotation, state.angular_momentum)
        };
        stock.momentum.angular = state.angular_momentum;
        if constants.inverse_mass > 0.0 {
            let linear = constants.mass() * state.velocity;
            stock.momentum.linear = linear;
            stock.momentum.angular += state.position.cross(linear);
            stock.energy.kinetic += 0.5 * linear.dot(state.velocity);
            stock.energy.potential = -heavy_mass(constants) * gravity.dot(state.position);
        }
        stock
    }

    /// Kinetic, potential and elastic energy, J.
    pub fn total_energy(&self) -> f64 {
        self.energy.kinetic + self.energy.potential + self.elastic
    }

    pub(super) fn is_finite(&self) -> bool {
        self.momentum.linear.is_finite()
            && self.momentum.angular.is_finite()
            && self.total_energy().is_finite()
    }

    /// How much more it is than `before`.
    pub(crate) fn since(&self, before: &Stock) -> Residual {
        let energy = |stock: &Stock| stock.energy;
        Residual {
            linear: self.momentum.linear - before.momentum.linear,
            angular: self.momentum.angular - before.momentum.angular,
            energy: (energy(self).kinetic - energy(before).kinetic)
                + (energy(self).potential - energy(before).potential)
                + (self.elastic - before.elastic),
        }
    }

    /// Its parts without their signs and directions, for a body at this distance (m) from the origin: what rounding is a share of. Vectors
    /// count by the sum of their components, which is 1 to √3 times their length and asks for no root.
    #[inline]
    pub(super) fn sizes(&self, distance: f64) -> [f64; 3] {
        let linear = components(self.momentum.linear);
        let angular = components(self.momentum.angular) + distance * linear;
        [linear, angular, self.energy.kinetic + self.energy.potential.abs() + self.elastic]
    }
}

/// The sum of a vector's components without their signs.
#[inline]
pub(super) fn components(vector: DVec3) -> f64 {
    vector.abs().element_sum()
}

impl AddAssign for Stock {
    fn add_assign(&mut self, other: Self) {
        self.momentum.linear += other.momentum.linear;
        self.momentum.angular += other.momentum.angular;
        self.energy.kinetic += other.energy.kinetic;
        self.energy.potential += other.energy.potential;
        self.elastic += other.elastic;
    }
}
