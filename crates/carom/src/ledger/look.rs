//! A look at what all bodies have.

use super::flights::heavy_mass;
use super::stock::components;
use super::{Residual, Stock};
use crate::flight::{Constants, RigidState};
use crate::math::DVec3;

/// What has been seen so far, row by row from that of the world on, which has nothing.
pub(crate) struct Look {
    gravity: DVec3,
    pull: f64,
    pub(super) has: Vec<Residual>,
    /// Sums of what they have, with and without directions.
    pub(super) sum: Stock,
    pub(super) gross: [f64; 3],
    /// How gravity pulls at them, without directions: N, N·m, and nothing.
    pub(super) pulls: [f64; 3],
}

impl Look {
    /// Begins one, in the room of an older one's.
    pub(super) fn new(mut has: Vec<Residual>, gravity: DVec3) -> Self {
        has.clear();
        has.push(Residual::default());
        let (sum, gross, pulls) = Default::default();
        Self { gravity, pull: gravity.length(), has, sum, gross, pulls }
    }

    /// Looks at the body of the next row, which has this angular velocity (rad/s).
    #[inline]
    pub fn at(&mut self, state: &RigidState, constants: &Constants, angular_velocity: DVec3) {
        let stock = Stock::of(state, constants, angular_velocity, self.gravity);
        self.sum += stock;
        let distance = components(state.position);
        add_to(&mut self.gross, stock.sizes(distance));
        let pull = heavy_mass(constants).abs() * self.pull;
        add_to(&mut self.pulls, [pull, pull * distance, 0.0]);
        let (linear, angular) = (stock.momentum.linear, stock.momentum.angular);
        self.has.push(Residual { linear, angular, energy: stock.total_energy() });
    }
}

#[inline]
fn add_to(sums: &mut [f64; 3], values: [f64; 3]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}
