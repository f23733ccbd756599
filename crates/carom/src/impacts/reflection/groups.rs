//! Spots that have to do with each other.

use super::{Mover, Spot};

/// The spots that bodies connect which can be moved, in their order.
pub(super) fn connected(movers: &[Mover], spots: &[Spot]) -> Vec<Vec<usize>> {
    let mut group_of: Vec<Option<usize>> = vec![None; movers.len()];
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, spot) in spots.iter().enumerate() {
        let movable = || spot.movers.into_iter().filter(|&mover| movers[mover].is_movable());
        let mut known: Vec<usize> = movable().filter_map(|mover| group_of[mover]).collect();
        known.sort_unstable();
        known.dedup();
        let group = known.first().copied().unwrap_or_else(|| {
            groups.push(Vec::new());
            groups.len() - 1
        });
        groups[group].push(index);
        movable().for_each(|mover| group_of[mover] = Some(group));
        for other in known.into_iter().skip(1) {
            let joining = std::mem::take(&mut groups[other]);
            groups[group].extend(joining);
            groups[group].sort_unstable();
            group_of.iter_mut().filter(|of| **of == Some(other)).for_each(|of| *of = Some(group));
        }
    }
    groups.retain(|group| !group.is_empty());
    groups
}
