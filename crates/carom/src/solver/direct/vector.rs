//! Vectors and blocks of six: what a body's three directions and three axes have in common.

use crate::math::DVec3;

pub(crate) type Vector = [f64; 6];
pub(crate) type Block = [Vector; 6];

pub(crate) const ZERO: Vector = [0.0; 6];

/// Summed as what two lanes hold: no long chain of additions, in the same order on every machine.
pub(crate) fn dot(a: &Vector, b: &Vector) -> f64 {
    let products: Vector = std::array::from_fn(|axis| a[axis] * b[axis]);
    sum(&products)
}

pub(crate) fn sum(v: &Vector) -> f64 {
    (v[0] + v[2] + v[4]) + (v[1] + v[3] + v[5])
}

pub(crate) fn add_scaled(to: &mut Vector, v: &Vector, by: f64) {
    (0..6).for_each(|axis| to[axis] += by * v[axis]);
}

/// Adds `by·left·rightᵀ`.
pub(crate) fn add_outer(to: &mut Block, (left, right): (&Vector, &Vector), by: f64) {
    (0..6).for_each(|row| add_scaled(&mut to[row], right, by * left[row]));
}

/// Adds `by·leftᵀ·right`.
pub(crate) fn add_product(to: &mut Block, (left, right): (&Block, &Block), by: f64) {
    for row in 0..6 {
        let mut line = to[row];
        (0..6).for_each(|k| add_scaled(&mut line, &right[k], by * left[k][row]));
        to[row] = line;
    }
}

/// Adds `by·blockᵀ·v`.
pub(crate) fn add_transposed(to: &mut Vector, (block, v): (&Block, &Vector), by: f64) {
    (0..6).for_each(|k| add_scaled(to, &block[k], by * v[k]));
}

/// `block·v`.
pub(crate) fn times(block: &Block, v: &Vector) -> Vector {
    std::array::from_fn(|row| dot(&block[row], v))
}

pub(crate) fn transposed(block: &Block) -> Block {
    std::array::from_fn(|row| std::array::from_fn(|column| block[column][row]))
}

pub(crate) fn split(v: &Vector) -> (DVec3, DVec3) {
    (DVec3::new(v[0], v[1], v[2]), DVec3::new(v[3], v[4], v[5]))
}

pub(crate) fn join(linear: DVec3, angular: DVec3) -> Vector {
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}
