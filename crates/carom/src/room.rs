//! Room in the lists that a large world is made of.
//!
//! A `Vec` that is full takes twice the room that it had: in the end up to half of it is empty. What has an entry for each body, pair or
//! contact takes a sixteenth more instead.

/// Lists that take little more room than they need.
pub(crate) trait Room<T> {
    /// Adds an entry at the end.
    fn put(&mut self, entry: T);

    /// Makes the list `count` entries long, if it is shorter, with copies of `value`.
    fn lengthen(&mut self, count: usize, value: T)
    where
        T: Clone;
}

/// A list that is full gets room for this share of its entries, and for so many at least.
const SHARE: usize = 16;
const LEAST: usize = 4;

impl<T> Room<T> for Vec<T> {
    #[inline]
    fn put(&mut self, entry: T) {
        if self.len() == self.capacity() {
            make_room(self, 1);
        }
        self.push(entry);
    }

    #[inline]
    fn lengthen(&mut self, count: usize, value: T)
    where
        T: Clone,
    {
        if count > self.capacity() {
            make_room(self, count - self.len());
        }
        if count > self.len() {
            self.resize(count, value);
        }
    }
}

#[cold]
fn make_room<T>(list: &mut Vec<T>, wanted: usize) {
    list.reserve_exact(wanted.max(list.len() / SHARE).max(LEAST));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_grow_by_a_sixteenth_and_hold_what_was_put_there() {
        let (mut one, mut other) = (Vec::new(), Vec::new());
        for number in 0..10_000_usize {
            one.put(number);
            other.lengthen(number + 1, number);
            let most = number + 1 + (number / SHARE).max(LEAST);
            assert!(
                one.capacity() <= most && other.capacity() <= most,
                "{number}: {} of {most}",
                one.capacity()
            );
        }
        assert!(one.iter().enumerate().all(|(number, &entry)| entry == number) && one == other);
        other.lengthen(5, 0);
        assert_eq!(one, other, "it does not get shorter");
    }
}
