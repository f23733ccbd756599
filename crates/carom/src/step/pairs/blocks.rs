//! A list that grows block by block.
//!
//! Nothing in it is ever moved to make room: a `Vec` of the same length holds up to twice the room, and three times as it grows.

use std::ops::{Index, IndexMut};

/// Entries of a block.
const BLOCK: usize = 128;

/// All blocks but the last are full.
pub(super) struct Blocks<T>(Vec<Vec<T>>);

impl<T> Default for Blocks<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> Blocks<T> {
    pub fn len(&self) -> usize {
        self.0.last().map_or(0, |last| (self.0.len() - 1) * BLOCK + last.len())
    }

    pub fn push(&mut self, entry: T) {
        if self.0.last().is_none_or(|last| last.len() == BLOCK) {
            self.0.push(Vec::with_capacity(BLOCK));
        }
        if let Some(last) = self.0.last_mut() {
            last.push(entry);
        }
    }

    #[cfg(test)]
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.0.iter().flatten()
    }
}

impl<T> Index<usize> for Blocks<T> {
    type Output = T;

    #[inline]
    fn index(&self, index: usize) -> &T {
        &self.0[index / BLOCK][index % BLOCK]
    }
}

impl<T> IndexMut<usize> for Blocks<T> {
    #[inline]
    fn index_mut(&mut self, index: usize) -> &mut T {
        &mut self.0[index / BLOCK][index % BLOCK]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_where_they_were_put() {
        let mut blocks = Blocks::default();
        assert_eq!(blocks.len(), 0);
        for number in 0..3 * BLOCK + 5 {
            blocks.push(number);
            assert_eq!(blocks.len(), number + 1);
        }
        blocks[BLOCK] = 7;
        let expected = |index: usize| if index == BLOCK { 7 } else { index };
        assert!((0..blocks.len()).all(|index| blocks[index] == expected(index)));
        assert!(blocks.iter().copied().eq((0..blocks.len()).map(expected)));
    }
}
