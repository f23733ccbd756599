//! In which order bodies are eliminated, and which blocks that fills.

use super::BODIES;

/// Bodies of an island, a bit each.
type Set = [u64; BODIES / 64];

/// The blocks of the upper triangle of a factored matrix, whose rows and columns are bodies in the order of their elimination.
pub(crate) struct Elimination {
    /// The body eliminated in each place, and the place of each body.
    pub order: Vec<usize>,
    pub places: Vec<usize>,
    /// The first block of each row, which is that of the diagonal; then the number of all blocks.
    pub starts: Vec<usize>,
    /// The column of each block, row after row, ascending in each.
    pub columns: Vec<usize>,
}

impl Elimination {
    /// Eliminates the body with the fewest neighbours first (Tinney and Walker 1967), the first of several.
    pub fn new(count: usize, pairs: impl Iterator<Item = [usize; 2]>) -> Self {
        let mut neighbors = vec![[0; BODIES / 64]; count];
        for [one, other] in pairs {
            insert(&mut neighbors[one], other);
            insert(&mut neighbors[other], one);
        }
        let mut degrees: Vec<Option<u32>> = neighbors.iter().map(|it| Some(size(it))).collect();
        let mut order = Vec::with_capacity(count);
        while let Some((_, pivot)) =
            degrees.iter().enumerate().filter_map(|(body, degree)| degree.map(|it| (it, body))).min()
        {
            degrees[pivot] = None;
            order.push(pivot);
            let later = neighbors[pivot];
            for body in bits(later) {
                let of_body = &mut neighbors[body];
                (0..later.len()).for_each(|word| of_body[word] |= later[word]);
                remove(of_body, pivot);
                remove(of_body, body);
                degrees[body] = Some(size(of_body));
            }
        }
        let mut places = vec![0; count];
        order.iter().enumerate().for_each(|(place, &body)| places[body] = place);
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for (place, &body) in order.iter().enumerate() {
            columns.push(place);
            columns.extend(bits(neighbors[body]).map(|later| places[later]));
            columns[starts[place]..].sort_unstable();
            starts.push(columns.len());
        }
        Self { order, places, starts, columns }
    }

    /// The blocks of a row: of the diagonal, and those after it.
    pub fn row(&self, place: usize) -> std::ops::Range<usize> {
        self.starts[place]..self.starts[place + 1]
    }

    /// About twice the number of blocks that are multiplied.
    pub fn work(&self) -> usize {
        (0..self.order.len()).map(|place| (self.row(place).len() - 1).pow(2)).sum()
    }
}

fn insert(set: &mut Set, body: usize) {
    set[body / 64] |= 1 << (body % 64);
}

fn remove(set: &mut Set, body: usize) {
    set[body / 64] &= !(1 << (body % 64));
}

fn size(set: &Set) -> u32 {
    set.iter().map(|word| word.count_ones()).sum()
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
