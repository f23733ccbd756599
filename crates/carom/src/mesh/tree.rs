//! A tree of boxes around the triangles of a mesh, built once.
//!
//! Its nodes hold eight boxes each ([`crate::boxes`]) and are full but for the last on each level: where a node has more triangles
//! than it has room for, they are halved along the axis on which their middles lie furthest apart, and so are the halves.

use crate::boxes::{Boxes, Local, Query, WIDTH};
use crate::math::DVec3;
use glam::Vec3;

/// Triangles by their boxes.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// The last is the root.
    nodes: Vec<Node>,
    origin: DVec3,
}

#[derive(Clone, Debug)]
struct Node {
    boxes: Boxes,
    /// Triangles or nodes.
    children: [u32; WIDTH],
    count: usize,
    holds_triangles: bool,
}

/// A triangle and its box.
type Entry = (u32, Local);

impl Tree {
    /// Of `triangles`, by number, and the box around each: lowest and highest corner, m.
    pub fn new(triangles: impl Iterator<Item = (u32, (DVec3, DVec3))> + Clone) -> Self {
        let whole = triangles.clone().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |whole, (_, bounds)| {
            (whole.0.min(bounds.0), whole.1.max(bounds.1))
        });
        let origin = 0.5 * (whole.0 + whole.1);
        let mut entries: Vec<Entry> =
            triangles.map(|(triangle, bounds)| (triangle, Local::new(bounds, origin))).collect();
        let mut tree = Self { nodes: Vec::new(), origin };
        tree.build(&mut entries);
        tree
    }

    /// Tells the triangles whose boxes meet the box from `low` to `high` (m), and maybe some whose boxes nearly do.
    pub fn visit(&self, low: DVec3, high: DVec3, mut found: impl FnMut(u32)) {
        let query = Query::new(Local::new((low, high), self.origin));
        self.visit_below(self.nodes.len() - 1, &query, &mut found);
    }

    fn visit_below(&self, node: usize, query: &Query, found: &mut impl FnMut(u32)) {
        let node = &self.nodes[node];
        let mut meeting = node.boxes.meeting(query, node.count);
        while meeting != 0 {
            let child = node.children[meeting.trailing_zeros() as usize];
            meeting &= meeting - 1;
            if node.holds_triangles {
                found(child);
            } else {
                self.visit_below(child as usize, query, found);
            }
        }
    }

    /// Adds a node of these triangles, after those below it; tells its number and the box around it.
    fn build(&mut self, entries: &mut [Entry]) -> Entry {
        let mut share = 1;
        while share * WIDTH < entries.len() {
            share *= WIDTH;
        }
        let mut node =
            Node { boxes: Boxes::NOTHING, children: [0; WIDTH], count: 0, holds_triangles: share == 1 };
        self.fill(&mut node, entries, share);
        let whole = node.boxes.whole();
        self.nodes.push(node);
        ((self.nodes.len() - 1) as u32, whole)
    }

    /// Gives a node its children: of `share` triangles each, but for the last.
    fn fill(&mut self, node: &mut Node, entries: &mut [Entry], share: usize) {
        if entries.len() <= share {
            let (child, bounds) = if share == 1 { entries[0] } else { self.build(entries) };
            node.boxes.set(node.count, bounds);
            node.children[node.count] = child;
            node.count += 1;
            return;
        }
        let middle = |entry: &Entry| entry.1.low + entry.1.high;
        let (least, most) =
            entries.iter().map(middle).fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), middle| {
                (least.min(middle), most.max(middle))
            });
        let axis = (most - least).max_position();
        let half = entries.len().div_ceil(share) / 2 * share;
        entries.select_nth_unstable_by(half, |one, other| {
            middle(one)[axis].total_cmp(&middle(other)[axis]).then(one.0.cmp(&other.0))
        });
        let (lower, upper) = entries.split_at_mut(half);
        self.fill(node, lower, share);
        self.fill(node, upper, share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn found(tree: &Tree, low: DVec3, high: DVec3) -> Vec<u32> {
        let mut found = Vec::new();
        tree.visit(low, high, |triangle| found.push(triangle));
        found.sort_unstable();
        found
    }

    #[test]
    fn a_search_finds_what_a_look_at_all_boxes_does() {
        let mut random = Random(7);
        for count in [1, 2, 7, 8, 9, 63, 64, 65, 100, 513, 2000] {
            let boxes: Vec<(DVec3, DVec3)> = (0..count)
                .map(|_| {
                    let (middle, half) = (random.vector(10.0), random.vector(1.0).abs());
                    (middle - half, middle + half)
                })
                .collect();
            let tree = Tree::new((0..).zip(boxes.iter().copied()));
            for _ in 0..200 {
                let (middle, half) = (random.vector(12.0), random.vector(3.0).abs());
                let (low, high) = (middle - half, middle + half);
                let meets = |bounds: &(DVec3, DVec3)| bounds.0.cmple(high).all() && bounds.1.cmpge(low).all();
                let expected: Vec<u32> = (0..count as u32).filter(|&it| meets(&boxes[it as usize])).collect();
                assert_eq!(found(&tree, low, high), expected, "of {count} boxes");
            }
            let everything = found(&tree, DVec3::NEG_INFINITY, DVec3::INFINITY);
            assert_eq!(everything, (0..count as u32).collect::<Vec<_>>());
        }
    }

    #[test]
    fn all_nodes_of_a_level_are_full_but_for_the_last() {
        let place = |k: u32| DVec3::new(f64::from(k * 37 % 512), f64::from(k % 8), 0.0);
        let tree = Tree::new((0..512).map(|k| (k, (place(k), place(k)))));
        assert_eq!(tree.nodes.len(), 64 + 8 + 1);
        assert!(tree.nodes.iter().all(|node| node.count == WIDTH));
    }
}
