//! Systems of equations with a block of six for each body, few of which are neighbours.

use super::elimination::Elimination;
use super::vector::{
    Block, Vector, ZERO, add_outer, add_product, add_scaled, add_transposed, times, transposed,
};

/// A symmetric positive definite matrix `A` of blocks, then its factor `U` in its place: `A = Uᵀ·U`.
///
/// Only the upper triangle is kept, row after row. Of the factor's blocks on the diagonal it is the inverse.
pub(crate) struct Matrix {
    elimination: Elimination,
    blocks: Vec<Block>,
}

impl Matrix {
    pub fn new(elimination: Elimination) -> Self {
        let blocks = vec![[ZERO; 6]; elimination.columns.len()];
        Self { elimination, blocks }
    }

    /// Makes it the identity.
    pub fn reset(&mut self) {
        self.blocks.fill([ZERO; 6]);
        for &start in &self.elimination.starts[..self.elimination.order.len()] {
            (0..6).for_each(|axis| self.blocks[start][axis][axis] = 1.0);
        }
    }

    /// Adds `Jᵀ·D·J` of two neighbours, or twice the same body where it has only one: each row of `J` with its number of the diagonal
    /// `D`.
    pub fn add<'a>(&mut self, bodies: [usize; 2], rows: impl Iterator<Item = (&'a [Vector; 2], f64)>) {
        let places = bodies.map(|body| self.elimination.places[body]);
        let [first, second] = if places[0] < places[1] { [0, 1] } else { [1, 0] };
        let diagonal = places.map(|place| self.elimination.starts[place]);
        let common = (bodies[0] != bodies[1]).then(|| self.find(places[first], places[second]));
        for (sides, by) in rows {
            for side in 0..2 {
                add_outer(&mut self.blocks[diagonal[side]], (&sides[side], &sides[side]), by);
            }
            if let Some(common) = common {
                add_outer(&mut self.blocks[common], (&sides[first], &sides[second]), by);
            }
        }
    }

    /// The block of a row in a later column.
    fn find(&self, row: usize, column: usize) -> usize {
        let blocks = self.elimination.row(row);
        blocks.start + self.elimination.columns[blocks].partition_point(|&it| it < column)
    }

    /// Factors in place.
    pub fn factor(&mut self) {
        let Elimination { columns, starts, order, .. } = &self.elimination;
        for place in 0..order.len() {
            let row = self.elimination.row(place);
            let (known, open) = self.blocks.split_at_mut(row.end);
            let Some((pivot, later)) = known[row.start..].split_first_mut() else { continue };
            *pivot = inverse_factor(*pivot);
            for block in later.iter_mut() {
                let before = std::mem::replace(block, [ZERO; 6]);
                add_product(block, (pivot, &before), 1.0);
            }
            let reached = &columns[row.start + 1..row.end];
            for (number, (&first, left)) in reached.iter().zip(later.iter()).enumerate() {
                let mut target = starts[first];
                for (&second, right) in reached[number..].iter().zip(&later[number..]) {
                    while columns[target] < second {
                        target += 1;
                    }
                    add_product(&mut open[target - row.end], (left, right), -1.0);
                }
            }
        }
    }

    /// Replaces `values`, one for each body, by the solution.
    pub fn solve(&self, values: &mut [Vector]) {
        let Elimination { columns, order, .. } = &self.elimination;
        let mut ordered: Vec<Vector> = order.iter().map(|&body| values[body]).collect();
        for place in 0..order.len() {
            let row = self.elimination.row(place);
            let mut value = ZERO;
            add_transposed(&mut value, (&self.blocks[row.start], &ordered[place]), 1.0);
            ordered[place] = value;
            for index in row.skip(1) {
                add_transposed(&mut ordered[columns[index]], (&self.blocks[index], &value), -1.0);
            }
        }
        for place in (0..order.len()).rev() {
            let row = self.elimination.row(place);
            let mut value = ordered[place];
            for index in row.clone().skip(1) {
                add_scaled(&mut value, &times(&self.blocks[index], &ordered[columns[index]]), -1.0);
            }
            ordered[place] = times(&self.blocks[row.start], &value);
        }
        order.iter().zip(ordered).for_each(|(&body, value)| values[body] = value);
    }
}

/// `U⁻¹` of the upper triangle `U` with `A = Uᵀ·U`.
///
/// Cholesky's steps lead from `A` to `U`, and from the identity to `U⁻ᵀ`.
fn inverse_factor(mut rest: Block) -> Block {
    let mut inverse = [ZERO; 6];
    (0..6).for_each(|axis| inverse[axis][axis] = 1.0);
    for pivot in 0..6 {
        let scale = 1.0 / rest[pivot][pivot].max(f64::MIN_POSITIVE).sqrt();
        let [line, inverse_line] = [rest[pivot], inverse[pivot]].map(|line| line.map(|it| it * scale));
        inverse[pivot] = inverse_line;
        for row in pivot + 1..6 {
            add_scaled(&mut rest[row], &line, -line[row]);
            add_scaled(&mut inverse[row], &inverse_line, -line[row]);
        }
    }
    transposed(&inverse)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::tests::Random;

    /// Solves `A·x = b` by elimination with pivots, all numbers of `A` row by row.
    fn dense(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
        let n = b.len();
        for column in 0..n {
            let pivot = (column..n).max_by(|&i, &j| a[i][column].abs().total_cmp(&a[j][column].abs()));
            let pivot = pivot.unwrap_or(column);
            a.swap(column, pivot);
            b.swap(column, pivot);
            for row in column + 1..n {
                let factor = a[row][column] / a[column][column];
                let (above, below) = a.split_at_mut(row);
                below[0]
                    .iter_mut()
                    .zip(&above[column])
                    .skip(column)
                    .for_each(|(it, top)| *it -= factor * top);
                b[row] -= factor * b[column];
            }
        }
        for row in (0..n).rev() {
            let known: f64 = (row + 1..n).map(|k| a[row][k] * b[k]).sum();
            b[row] = (b[row] - known) / a[row][row];
        }
        b
    }

    #[test]
    fn factors_solve_what_elimination_solves_on_any_graph() {
        let mut random = Random(61);
        for round in 0..60 {
            let count = [1, 2, 3, 7, 20, 64, 65, 70][round % 8];
            let pairs: Vec<[usize; 2]> =
                (0..=random.below(4 * count)).map(|_| [0; 2].map(|_| random.below(count))).collect();
            let neighbors = pairs.iter().copied().filter(|[one, other]| one != other);
            let mut matrix = Matrix::new(Elimination::new(count, neighbors));
            // The second time in the same place: nothing of the first may be left.
            for _ in 0..2 {
                matrix.reset();
                let mut whole = vec![vec![0.0; 6 * count]; 6 * count];
                (0..6 * count).for_each(|axis| whole[axis][axis] += 1.0);
                for &[one, other] in pairs.iter().skip(random.below(3)) {
                    let mut sides = [0; 2].map(|_| [0; 6].map(|_| random.range(-1.0, 1.0)));
                    if other == one {
                        sides[1] = ZERO;
                    }
                    let stiffness = 10.0_f64.powf(random.range(-1.0, 3.0));
                    matrix.add([one, other], std::iter::once((&sides, stiffness)));
                    for (i, left) in [one, other].into_iter().zip(&sides) {
                        for (j, right) in [one, other].into_iter().zip(&sides) {
                            for x in 0..6 {
                                for y in 0..6 {
                                    whole[6 * i + x][6 * j + y] += stiffness * left[x] * right[y];
                                }
                            }
                        }
                    }
                }
                let mut values: Vec<Vector> =
                    (0..count).map(|_| std::array::from_fn(|_| random.range(-1.0, 1.0))).collect();
                let truth = dense(whole, values.concat());
                matrix.factor();
                matrix.solve(&mut values);
                for (value, truth) in values.concat().into_iter().zip(truth) {
                    assert!((value - truth).abs() <= 1e-9, "{value} {truth} among {count}");
                }
            }
        }
    }
}
