//! Bodies of an island, and how they answer to impulses.

use super::vector::{Vector, join, split};
use crate::math::{DMat3, DVec3};
use crate::solver::lanes::Row;

/// How a body answers to impulses: 1/kg, and 1/(kg·m²) in world axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mobility {
    pub inverse_mass: f64,
    pub inverse_inertia: DMat3,
}

/// A body of the island.
pub(crate) struct Mover {
    pub row: u32,
    /// Before anything is solved.
    pub velocity: Vector,
    /// `B` with `B·Bᵀ = M⁻¹`: of the mass, and of the inertia.
    roots: (f64, DMat3),
}

impl Mover {
    pub fn new(row: u32, velocity: &Row, mobility: Mobility) -> Self {
        let roots = (mobility.inverse_mass.sqrt(), root(&mobility.inverse_inertia));
        Self { row, velocity: velocity_of(velocity), roots }
    }

    /// `Bᵀ` times an impulse.
    pub fn scaled(&self, impulse: &Vector) -> Vector {
        let (linear, angular) = split(impulse);
        join(linear * self.roots.0, self.roots.1.transpose() * angular)
    }

    /// Its velocity after a change, which is scaled: plus `B` times it.
    pub fn after(&self, change: &Vector) -> Vector {
        let (linear, angular) = split(change);
        let change = join(linear * self.roots.0, self.roots.1 * angular);
        std::array::from_fn(|axis| self.velocity[axis] + change[axis])
    }
}

pub(crate) fn velocity_of(row: &Row) -> Vector {
    std::array::from_fn(|axis| f64::from(row.0[axis]))
}

/// `B` with `B·Bᵀ = A`, for a positive semidefinite `A`: Cholesky's factor, without the columns that are nothing but rounding.
fn root(a: &DMat3) -> DMat3 {
    const ROUNDING: f64 = 1e-12;
    let least = ROUNDING * (a.x_axis.x + a.y_axis.y + a.z_axis.z);
    let mut rest = *a;
    let mut columns = [DVec3::ZERO; 3];
    for (axis, column) in columns.iter_mut().enumerate() {
        let pivot = rest.col(axis)[axis];
        if pivot > least {
            *column = rest.col(axis) / pivot.sqrt();
            let [x, y, z] = column.to_array();
            rest -= DMat3::from_cols(*column * x, *column * y, *column * z);
        }
    }
    DMat3::from_cols_array_2d(&columns.map(|column| column.to_array()))
}
