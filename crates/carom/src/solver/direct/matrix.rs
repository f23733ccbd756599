//! Systems of equations with a block of six for each body, few of which are neighbours.

pub(crate) type Vector = [f64; 6];
type Block = [[f64; 6]; 6];

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
    neighbors: Vec<u64>,
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
            neighbors: vec![0; count],
        }
    }

    pub fn clear(&mut self) {
        self.places.fill(ABSENT);
        self.neighbors.fill(0);
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
                self.neighbors[row] |= 1 << column;
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
    pub fn factor(&mut self) {
        let mut left: u64 = if self.count == 64 { u64::MAX } else { (1 << self.count) - 1 };
        while left != 0 {
            let degree = |body: &usize| (self.neighbors[*body] & left).count_ones();
            let Some(pivot) = bits(left).min_by_key(degree) else { return };
            left &= !(1 << pivot);
            let later: Vec<usize> = bits(self.neighbors[pivot] & left).collect();
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
            self.order.push(pivot);
            self.later.push(later);
        }
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
fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (mask != 0).then(|| {
            let bit = mask.trailing_zeros() as usize;
            mask &= mask - 1;
            bit
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
