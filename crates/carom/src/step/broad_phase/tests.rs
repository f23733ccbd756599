//! The tree against a search of all boxes.

use super::bounds::Bounds;
use super::tree::Tree;
use crate::math::DVec3;
use proptest::prelude::*;

/// What happens to one of the boxes.
#[derive(Clone, Copy, Debug)]
enum Change {
    Set(Bounds),
    Remove,
    /// The tree may choose another origin.
    Follow,
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-size..size).prop_map(DVec3::from_array)
}

/// Boxes of 1e-3 to 1e4 m about `origin`.
fn bounds(origin: DVec3) -> impl Strategy<Value = Bounds> {
    (vector(20.0), prop::array::uniform3(-3.0..1.0_f64), -1.0..3.0_f64).prop_map(
        move |(place, edges, scale)| {
            let half = DVec3::from_array(edges.map(|edge| 10_f64.powf(edge + scale.max(0.0))));
            let middle = origin + place;
            Bounds { low: middle - half, high: middle + half }
        },
    )
}

fn changes() -> impl Strategy<Value = Vec<(u32, Change)>> {
    let origin = prop_oneof![Just(DVec3::ZERO), Just(DVec3::new(1e6, -3e5, 2e6)), Just(DVec3::splat(1e9))];
    origin.prop_flat_map(|origin| {
        let change = prop_oneof![
            12 => bounds(origin).prop_map(Change::Set),
            3 => Just(Change::Remove),
            1 => Just(Change::Follow),
            1 => bounds(DVec3::ZERO).prop_map(Change::Set),
            1 => Just(Change::Set(Bounds::EVERYTHING)),
        ];
        prop::collection::vec((0..90_u32, change), 1..400)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_tree_finds_what_a_search_of_all_boxes_finds(changes in changes()) {
        let mut tree = Tree::new();
        let mut boxes = vec![Bounds::NOTHING; 90];
        for (key, change) in changes {
            match change {
                Change::Set(bounds) => {
                    boxes[key as usize] = bounds;
                    tree.set(key, &bounds);
                }
                Change::Remove => {
                    boxes[key as usize] = Bounds::NOTHING;
                    tree.remove(key);
                }
                Change::Follow => tree.follow(|key| boxes[key as usize]),
            }
            let query = if boxes[key as usize] == Bounds::NOTHING { Bounds::EVERYTHING } else { boxes[key as usize] };
            let mut found = Vec::new();
            tree.visit(&query, |other| found.push(other));
            found.sort_unstable();
            prop_assert!(found.is_sorted_by(|a, b| a < b), "found twice: {found:?}");
            prop_assert!(found.iter().all(|&it| boxes[it as usize] != Bounds::NOTHING), "found what is gone");
            found.retain(|&it| boxes[it as usize].intersects(&query));
            let all: Vec<u32> = (0..90)
                .filter(|&it| boxes[it as usize] != Bounds::NOTHING && boxes[it as usize].intersects(&query))
                .collect();
            prop_assert_eq!(found, all);
        }
    }
}

#[test]
fn what_drifts_away_together_leaves_a_tree_that_still_sorts_out() {
    let place = |key: u32, step: u32| {
        let grid = DVec3::new(f64::from(key % 10), f64::from(key / 10 % 10), f64::from(key / 100));
        let middle = 2.0 * grid + 1e4 * f64::from(step) * DVec3::X;
        Bounds { low: middle - DVec3::splat(0.5), high: middle + DVec3::splat(0.5) }
    };
    let mut tree = Tree::new();
    for step in 0..30 {
        (0..1000).for_each(|key| tree.set(key, &place(key, step)));
        tree.follow(|key| place(key, step));
    }
    for key in 0..1000 {
        let mut found = Vec::new();
        tree.visit(&place(key, 29), |other| found.push(other));
        // Single precision 300 km from the first place would take neighbours 2 m apart for one.
        assert_eq!(found, [key]);
    }
}
