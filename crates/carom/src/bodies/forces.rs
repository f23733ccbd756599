//! What the user pushes bodies with during the next step.

use crate::math::DVec3;
use std::collections::BTreeMap;

/// Force (N) and torque (N·m, world axes) on a body.
pub(crate) type Push = (DVec3, DVec3);

/// Of each row that is pushed at all: few are, as a rule.
#[derive(Default)]
pub(crate) struct Forces(BTreeMap<usize, Push>);

impl Forces {
    /// What the body of a row is pushed with.
    #[inline]
    pub fn of(&self, row: usize) -> Push {
        self.0.get(&row).copied().unwrap_or_default()
    }

    /// Whether the user pushes the body of a row.
    #[inline]
    pub fn act_on(&self, row: usize) -> bool {
        self.0.contains_key(&row)
    }

    /// Pushes it with this, too.
    pub fn add(&mut self, row: usize, (force, torque): Push) {
        let sum = self.0.entry(row).or_default();
        sum.0 += force;
        sum.1 += torque;
    }

    /// The body of `row` is no more; that of the last row, `last`, gets its row.
    pub fn swap_remove(&mut self, row: usize, last: usize) {
        self.0.remove(&row);
        if let Some(push) = self.0.remove(&last) {
            self.0.insert(row, push);
        }
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_add_up_and_follow_the_body_that_gets_another_row() {
        let mut forces = Forces::default();
        forces.add(3, (DVec3::X, DVec3::ZERO));
        forces.add(7, (DVec3::Y, DVec3::Z));
        forces.add(7, (DVec3::Y, DVec3::Z));
        assert_eq!(forces.of(7), (2.0 * DVec3::Y, 2.0 * DVec3::Z));
        forces.swap_remove(3, 7);
        assert_eq!(forces.of(3), (2.0 * DVec3::Y, 2.0 * DVec3::Z), "the last body has got row 3");
        assert_eq!(forces.of(7), Push::default());
        forces.swap_remove(3, 3);
        assert_eq!(forces.of(3), Push::default());
        forces.add(5, (DVec3::X, DVec3::X));
        forces.clear();
        assert_eq!(forces.of(5), Push::default());
    }
}
