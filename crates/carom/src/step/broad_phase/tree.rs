//! A tree of boxes that changes little by little.
//!
//! Nodes hold up to eight boxes ([`crate::boxes`]). The tree grows as a B-tree does: a full node splits in two and hands the twin to its
//! parent, so that all leaves are equally deep. What leaves the box of its node is put in anew, from the root.
//!
//! Reference: Guttman, *R-trees: a dynamic index structure for spatial searching* (1984).

mod node;

use super::bounds::Bounds;
use crate::boxes::{Local, Query, WIDTH};
use crate::math::DVec3;
use crate::room::Room;
use glam::Vec3;
use node::{NONE, Node};

/// A node of leaves that has fewer gives them to others.
const FEWEST: usize = 3;

/// The tree is built anew about another origin when its middle is so many times its size away from its own: single precision is
/// then still finer than 10⁻⁵ of that size.
const ASTRAY: f32 = 64.0;

/// Boxes by keys.
pub(super) struct Tree {
    nodes: Vec<Node>,
    free: Vec<u32>,
    root: u32,
    /// Node and slot of each key.
    places: Vec<(u32, u32)>,
    origin: DVec3,
    to_visit: Vec<u32>,
}

impl Tree {
    pub fn new() -> Self {
        Self {
            nodes: vec![Node::new(true)],
            free: Vec::new(),
            root: 0,
            places: Vec::new(),
            origin: DVec3::ZERO,
            to_visit: Vec::new(),
        }
    }

    /// Gives a key its box, whether it had one or not.
    pub fn set(&mut self, key: u32, bounds: &Bounds) {
        let is_empty = self.nodes[self.root as usize].count == 0;
        let middle = 0.5 * (bounds.low + bounds.high);
        if is_empty && middle.is_finite() {
            self.origin = middle;
        }
        let bounds = self.local(bounds);
        let (node, slot) = self.place(key);
        if node == NONE {
            return self.insert(key, bounds);
        }
        let parent = self.nodes[node as usize].parent;
        let stays = parent == NONE
            || {
                let parent = &self.nodes[parent as usize];
                parent.get(parent.slot_of(node)).contains(&bounds)
            }
            || self.is_among_others((node, slot), &bounds);
        if stays {
            self.nodes[node as usize].set(slot as usize, bounds);
            self.refit(node);
        } else {
            self.remove(key);
            self.insert(key, bounds);
        }
    }

    /// Whether the middle of a box is among the boxes of a node, that of its own slot aside.
    fn is_among_others(&mut self, (node, slot): (u32, u32), bounds: &Local) -> bool {
        let node = &mut self.nodes[node as usize];
        node.set(slot as usize, Local::NOTHING);
        let middle = 0.5 * (bounds.low + bounds.high);
        node.whole().contains(&Local { low: middle, high: middle })
    }

    /// Takes a key out, if it is there.
    pub fn remove(&mut self, key: u32) {
        let (node, slot) = self.place(key);
        if node == NONE {
            return;
        }
        self.places[key as usize] = (NONE, 0);
        self.take_out(node, slot as usize);
        let count = self.nodes[node as usize].count;
        if node != self.root && (1..FEWEST).contains(&count) {
            let mut homeless = [(NONE, Local::NOTHING); FEWEST];
            for entry in homeless.iter_mut().take(count) {
                let last = self.nodes[node as usize].count - 1;
                *entry = (self.nodes[node as usize].children[last], self.nodes[node as usize].get(last));
                self.take_out(node, last);
            }
            self.shrink();
            homeless.iter().take(count).for_each(|&(key, bounds)| self.insert(key, bounds));
        }
        self.shrink();
    }

    /// Tells all keys whose boxes meet `bounds`, and maybe some whose boxes nearly do.
    pub fn visit(&mut self, bounds: &Bounds, mut found: impl FnMut(u32)) {
        let query = Query::new(self.local(bounds));
        self.to_visit.push(self.root);
        while let Some(node) = self.to_visit.pop() {
            let node = &self.nodes[node as usize];
            let mut meeting = node.meeting(&query);
            while meeting != 0 {
                let child = node.children[meeting.trailing_zeros() as usize];
                meeting &= meeting - 1;
                if node.holds_leaves {
                    found(child);
                } else {
                    self.to_visit.push(child);
                }
            }
        }
    }

    /// Follows the scene with its origin; `bounds_of` tells the boxes of keys.
    pub fn follow(&mut self, bounds_of: impl Fn(u32) -> Bounds) {
        let whole = self.nodes[self.root as usize].whole();
        let middle = 0.5 * (whole.low + whole.high);
        let is_astray = middle.abs().max_element() > ASTRAY * (whole.high - whole.low).max_element();
        if !is_astray || !middle.is_finite() {
            return;
        }
        let keys: Vec<u32> = (0..self.places.len() as u32).filter(|&key| self.place(key).0 != NONE).collect();
        let places = std::mem::take(&mut self.places);
        *self = Self { origin: self.origin + middle.as_dvec3(), ..Self::new() };
        self.places = places;
        self.places.fill((NONE, 0));
        for key in keys {
            let bounds = self.local(&bounds_of(key));
            self.insert(key, bounds);
        }
    }

    fn local(&self, bounds: &Bounds) -> Local {
        Local::new((bounds.low, bounds.high), self.origin)
    }

    fn place(&self, key: u32) -> (u32, u32) {
        self.places.get(key as usize).copied().unwrap_or((NONE, 0))
    }

    fn insert(&mut self, key: u32, bounds: Local) {
        self.places.lengthen(key as usize + 1, (NONE, 0));
        let mut at = self.root;
        while !self.nodes[at as usize].holds_leaves {
            let node = &self.nodes[at as usize];
            at = node.children[node.roomiest(&bounds)];
        }
        self.add(at, key, bounds);
    }

    fn add(&mut self, node: u32, child: u32, bounds: Local) {
        let count = self.nodes[node as usize].count;
        if count == WIDTH {
            return self.split(node, child, bounds);
        }
        self.nodes[node as usize].count += 1;
        self.put(node, count, (child, bounds));
        self.refit(node);
    }

    fn put(&mut self, node: u32, slot: usize, (child, bounds): (u32, Local)) {
        let place = &mut self.nodes[node as usize];
        place.set(slot, bounds);
        place.children[slot] = child;
        if place.holds_leaves {
            self.places[child as usize] = (node, slot as u32);
        } else {
            self.nodes[child as usize].parent = node;
        }
    }

    /// Adds a child to a full node: along the axis on which they lie furthest apart, the upper half goes to a twin.
    fn split(&mut self, node: u32, child: u32, bounds: Local) {
        let full = &self.nodes[node as usize];
        let mut children: [(u32, Local); WIDTH + 1] = std::array::from_fn(|slot| match slot {
            WIDTH => (child, bounds),
            slot => (full.children[slot], full.get(slot)),
        });
        let middle = |(_, bounds): &(u32, Local)| bounds.low + bounds.high;
        let (least, most) =
            children.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(least, most), it| {
                (least.min(middle(it)), most.max(middle(it)))
            });
        let axis = (most - least).max_position();
        children.sort_unstable_by(|a, b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.0.cmp(&b.0)));
        let (lower, upper) = children.split_at(WIDTH / 2);

        let (parent, holds_leaves) = (full.parent, full.holds_leaves);
        let twin = self.new_node(holds_leaves);
        for (node, half) in [(node, lower), (twin, upper)] {
            let mut emptied = Node::new(holds_leaves);
            (emptied.count, emptied.parent) = (half.len(), parent);
            self.nodes[node as usize] = emptied;
            half.iter().enumerate().for_each(|(slot, &entry)| self.put(node, slot, entry));
        }
        let boxes = [node, twin].map(|node| self.nodes[node as usize].whole());
        if parent == NONE {
            self.root = self.new_node(false);
            self.add(self.root, node, boxes[0]);
            self.add(self.root, twin, boxes[1]);
        } else {
            self.refit(node);
            self.add(parent, twin, boxes[1]);
        }
    }

    fn new_node(&mut self, holds_leaves: bool) -> u32 {
        let node = self.free.pop().unwrap_or_else(|| {
            self.nodes.put(Node::new(holds_leaves));
            (self.nodes.len() - 1) as u32
        });
        self.nodes[node as usize] = Node::new(holds_leaves);
        node
    }

    /// Brings the boxes of all nodes above into line with a node's children.
    fn refit(&mut self, mut node: u32) {
        loop {
            let (parent, whole) = (self.nodes[node as usize].parent, self.nodes[node as usize].whole());
            if parent == NONE {
                return;
            }
            let above = &mut self.nodes[parent as usize];
            let slot = above.slot_of(node);
            if above.get(slot) == whole {
                return;
            }
            above.set(slot, whole);
            node = parent;
        }
    }

    /// Takes a child out of a node, and the node out of its parent if that was the last one.
    fn take_out(&mut self, node: u32, slot: usize) {
        let place = &mut self.nodes[node as usize];
        place.count -= 1;
        let last = place.count;
        let moved = (place.children[last], place.get(last));
        place.set(last, Local::NOTHING);
        place.children[last] = NONE;
        if slot != last {
            self.put(node, slot, moved);
        }
        let parent = self.nodes[node as usize].parent;
        if last > 0 || parent == NONE {
            self.refit(node);
        } else {
            let slot = self.nodes[parent as usize].slot_of(node);
            self.take_out(parent, slot);
            self.free.push(node);
        }
    }

    /// Makes an only child of the root the root.
    fn shrink(&mut self) {
        loop {
            let root = &mut self.nodes[self.root as usize];
            match (root.holds_leaves, root.count) {
                (false, 0) => root.holds_leaves = true,
                (false, 1) => {
                    self.free.push(self.root);
                    self.root = root.children[0];
                    self.nodes[self.root as usize].parent = NONE;
                }
                _ => return,
            }
        }
    }
}
