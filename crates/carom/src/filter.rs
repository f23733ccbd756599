//! Who may touch whom.

use std::sync::Arc;

/// A set of groups. Groups are numbered by whoever names them (a scene's loader, a game).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups(Arc<[u32]>);

impl Groups {
    /// The set of the given groups, in any order and with repetitions.
    pub fn new(groups: impl IntoIterator<Item = u32>) -> Self {
        let mut sorted: Vec<u32> = groups.into_iter().collect();
        sorted.sort_unstable();
        sorted.dedup();
        Self(sorted.into())
    }

    /// Whether the two sets have a group in common.
    pub fn intersects(&self, other: &Groups) -> bool {
        let (mut mine, mut theirs) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(a), Some(b)) = (mine.peek(), theirs.peek()) {
            match a.cmp(b) {
                std::cmp::Ordering::Less => mine.next(),
                std::cmp::Ordering::Greater => theirs.next(),
                std::cmp::Ordering::Equal => return true,
            };
        }
        false
    }
}

/// Which groups a collider is willing to touch.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Accepts {
    /// Everything.
    #[default]
    All,
    /// Only what is a member of one of these groups.
    AnyOf(Groups),
    /// Everything but members of these groups.
    NoneOf(Groups),
}

/// Membership and taste of one collider. Two colliders touch if each accepts the other.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// The groups that this collider is a member of.
    pub groups: Groups,
    /// The groups that it accepts.
    pub accepts: Accepts,
}

impl Filter {
    fn accepts(&self, other: &Filter) -> bool {
        match &self.accepts {
            Accepts::All => true,
            Accepts::AnyOf(wanted) => wanted.intersects(&other.groups),
            Accepts::NoneOf(refused) => !refused.intersects(&other.groups),
        }
    }

    /// Whether both sides accept each other.
    pub fn allows(&self, other: &Filter) -> bool {
        self.accepts(other) && other.accepts(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_must_agree() {
        let open = Filter::default();
        let red = Filter { groups: Groups::new([7, 1, 7]), accepts: Accepts::AnyOf(Groups::new([1])) };
        let shy = Filter { groups: Groups::new([1]), accepts: Accepts::NoneOf(Groups::new([7])) };
        assert!(open.allows(&open) && red.allows(&red));
        assert!(!red.allows(&open), "open is in no group that red wants");
        assert!(!red.allows(&shy) && !shy.allows(&red));
        assert!(shy.allows(&open) && open.allows(&shy));
    }
}
