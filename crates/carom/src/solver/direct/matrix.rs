//! Systems of equations with a block of six for each body, few of which are neighbours.

use super::BODIES;

pub(crate) type Vector = [f64; 6];
type Block = [[f64; 6]; 6];

/// Bodies of an island, a bit each.
type Set = [u64; BODIES / 64];

pub(crate) fn dot(a: &Vector, b: &Vector) -> f64 {
    (0..6).map(|axis| a[axis] * b[axis]).sum()
}

pub(crate) fn add_scaled(to: &mut Vector, v: &Vector, by: f64) {
    (0..6).for_each(|axis| to[axis] += by * v[axis]);
}

/// A symmetric positive definite matrix of blocks, and its factors `L·Lᵀ`.
pub(crate) struct Matrix {
    count: usize,
    /// Place of each block of the lower triangle in `blocks`, row after row; or [`ABSENT`].
    places: Vec<u32>,
    blocks: Vec<Block>,
    /// Bodies in the order in which they are eliminated, and the neighbours that each then still has.
    order: Vec<usize>,
    later: Vec<Vec<usize>>,
    neighbors: Vec<Set>,
}

const ABSENT: u32 = u32::MAX;

impl Matrix {
    pub fn new(count: usize) -> Self {
        Self {
            count,
            places: vec![ABSENT; count * count],
            blocks: Vec::new(),
            order: Vec::new(),
            later: Vec::new(),
            neighbors: vec![[0; BODIES / 64]; count],
        }
    }

    pub fn clear(&mut self) {
        self.places.fill(ABSENT);
        self.neighbors.fill([0; BODIES / 64]);
        self.blocks.clear();
        self.order.clear();
        self.later.clear();
    }

    /// The block of rows `row` and columns `column`.
    fn block(&mut self, row: usize, column: usize) -> &mut Block {
        let place = &mut self.places[row * self.count + column];
        if *place == ABSENT {
            *place = self.blocks.len() as u32;
            self.blocks.push([[0.0; 6]; 6]);
            if row != column {
                self.neighbors[row][column / 64] |= 1 << (column % 64);
            }
        }
        let place = *place as usize;
        &mut self.blocks[place]
    }

    fn at(&self, row: usize, column: usize) -> &Block {
        &self.blocks[self.places[row * self.count + column] as usize]
    }

    /// Adds the identity to a body's block.
    pub fn add_identity(&mut self, index: usize) {
        let block = self.block(index, index);
        (0..6).for_each(|axis| block[axis][axis] += 1.0);
    }

    /// Adds `stiffness` times the product of two bodies' vectors to the block that they have in common.
    pub fn add_product(
        &mut self,
        (row, column): (usize, usize),
        (left, right): (&Vector, &Vector),
        stiffness: f64,
    ) {
        let block = self.block(row, column);
        for i in 0..6 {
            for j in 0..6 {
                block[i][j] += stiffness * left[i] * right[j];
            }
        }
    }

    /// Factors in place: the block of a body becomes `L`, those of its later neighbours `B·L⁻ᵀ`.
    ///
    /// Returns about twice the number of blocks that were multiplied.
    pub fn factor(&mut self) -> usize {
        let mut work = 0;
        let mut left: Set = std::array::from_fn(|word| {
            let count = self.count.saturating_sub(64 * word).min(64);
            if count == 64 { u64::MAX } else { (1 << count) - 1 }
        });
        let both = |one: &Set, other: &Set| -> Set { std::array::from_fn(|word| one[word] & other[word]) };
        let degree = |neighbors: &[Set], left: &Set, body: usize| -> u32 {
            both(&neighbors[body], left).iter().map(|word| word.count_ones()).sum()
        };
        let mut degrees: Vec<u32> =
            (0..self.count).map(|body| degree(&self.neighbors, &left, body)).collect();
        while let Some(pivot) = bits(left).min_by_key(|&body| degrees[body]) {
            left[pivot / 64] &= !(1 << (pivot % 64));
            let later: Vec<usize> = bits(both(&self.neighbors[pivot], &left)).collect();
            cholesky(self.block(pivot, pivot));
            let factor = *self.at(pivot, pivot);
            for &row in &later {
                let block = self.block(row, pivot);
                block.iter_mut().for_each(|line| forward(&factor, line));
            }
            for (number, &row) in later.iter().enumerate() {
                for &column in &later[..=number] {
                    let (one, other) = (*self.at(row, pivot), *self.at(column, pivot));
                    let target = self.block(row, column);
                    for i in 0..6 {
                        for j in 0..6 {
                            target[i][j] -= dot(&one[i], &other[j]);
                        }
                    }
                    if row != column {
                        let transposed = std::array::from_fn(|i| std::array::from_fn(|j| target[j][i]));
                        *self.block(column, row) = transposed;
                    }
                }
            }
            later.iter().for_each(|&body| degrees[body] = degree(&self.neighbors, &left, body));
            work += later.len() * later.len();
            self.order.push(pivot);
            self.later.push(later);
        }
        work
    }

    /// Replaces `values` by the solution.
    pub fn solve(&self, values: &mut [Vector]) {
        for (&pivot, later) in self.order.iter().zip(&self.later) {
            forward(self.at(pivot, pivot), &mut values[pivot]);
            let known = values[pivot];
            for &row in later {
                let block = self.at(row, pivot);
                (0..6).for_each(|axis| values[row][axis] -= dot(&block[axis], &known));
            }
        }
        for (&pivot, later) in self.order.iter().zip(&self.later).rev() {
            let mut value = values[pivot];
            for &row in later {
                let block = self.at(row, pivot);
                (0..6).for_each(|axis| add_scaled(&mut value, &block[axis], -values[row][axis]));
            }
            backward(self.at(pivot, pivot), &mut value);
            values[pivot] = value;
        }
    }
}

/// The bits that are set, from the lowest.
fn bits(set: Set) -> impl Iterator<Item = usize> {
    set.into_iter().enumerate().flat_map(|(word, mut mask)| {
        std::iter::from_fn(move || {
            (mask != 0).then(|| {
                let bit = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                64 * word + bit
            })
        })
    })
}

/// `A = L·Lᵀ` in place; the upper triangle is left as it was.
fn cholesky(block: &mut Block) {
    for column in 0..6 {
        for row in column..6 {
            let known: f64 = (0..column).map(|k| block[row][k] * block[column][k]).sum();
            let rest = block[row][column] - known;
            block[row][column] =
                if row == column { rest.max(f64::MIN_POSITIVE).sqrt() } else { rest / block[column][column] };
        }
    }
}

/// Solves `L·x = v` in place.
fn forward(factor: &Block, v: &mut Vector) {
    for row in 0..6 {
        let known: f64 = (0..row).map(|k| factor[row][k] * v[k]).sum();
        v[row] = (v[row] - known) / factor[row][row];
    }
}

/// Solves `Lᵀ·x = v` in place.
fn backward(factor: &Block, v: &mut Vector) {
    for row in (0..6).rev() {
        let known: f64 = (row + 1..6).map(|k| factor[k][row] * v[k]).sum();
        v[row] = (v[row] - known) / factor[row][row];
    }
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
        let mut matrix = Matrix::new(0);
        for round in 0..60 {
            let count = [1, 2, 3, 7, 20, 64, 65, 70][round % 8];
            if round % 3 != 1 || matrix.count != count {
                matrix = Matrix::new(count);
            }
            // The second time in the same place: nothing of the first may be left.
            for _ in 0..2 {
                matrix.clear();
                let mut whole = vec![vec![0.0; 6 * count]; 6 * count];
                for body in 0..count {
                    matrix.add_identity(body);
                    (6 * body..6 * body + 6).for_each(|axis| whole[axis][axis] += 1.0);
                }
                for _ in 0..random.below(4 * count) + 1 {
                    let vector = |random: &mut Random| std::array::from_fn(|_| random.range(-1.0, 1.0));
                    let (one, other) = (random.below(count), random.below(count));
                    let mut pushes = vec![(one, vector(&mut random))];
                    if other != one {
                        pushes.push((other, vector(&mut random)));
                    }
                    let stiffness = 10.0_f64.powf(random.range(-1.0, 3.0));
                    for (i, left) in &pushes {
                        for (j, right) in &pushes {
                            matrix.add_product((*i, *j), (left, right), stiffness);
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
