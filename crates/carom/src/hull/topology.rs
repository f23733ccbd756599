//! What borders on what on a convex polyhedron: flat sides, edges and corners.

use super::climb::Lists;

/// The sides, edges and corners of a polyhedron by their numbers, without their places.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    /// The corners of all sides, one side after the other, each anticlockwise from outside.
    rings: Vec<u32>,
    /// The edges that lead on from these corners.
    ring_edges: Vec<u32>,
    /// Where each side's ring ends.
    ends: Vec<usize>,
    edges: Vec<Edge>,
    /// The edges around each corner.
    around: Lists,
    is_closed: bool,
}

/// Where two flat sides meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// Its corners.
    pub ends: [u32; 2],
    /// The side whose ring runs from the first corner to the second, and the other one.
    pub sides: [u32; 2],
    /// What contacts call it.
    pub name: u32,
}

impl Edge {
    /// The corner at the other end.
    pub fn beyond(&self, corner: u32) -> u32 {
        self.ends[0] ^ self.ends[1] ^ corner
    }
}

impl Topology {
    /// From the corners of each side, anticlockwise from outside. `name` gives the name of the edge between two corners.
    pub fn new<'a>(
        corners: usize,
        outlines: impl Iterator<Item = &'a [u32]>,
        name: impl Fn(u32, u32) -> u32,
    ) -> Self {
        let (mut rings, mut ends, mut steps) = (Vec::new(), Vec::new(), Vec::new());
        for (side, outline) in outlines.enumerate() {
            for k in 0..outline.len() {
                let (from, to) = (outline[k], outline[(k + 1) % outline.len()]);
                steps.push(((from, to), side as u32, rings.len()));
                rings.push(from);
            }
            ends.push(rings.len());
        }
        steps.sort_unstable();
        let mut is_closed = steps.windows(2).all(|pair| pair[0].0 != pair[1].0);
        let mut edges = Vec::with_capacity(steps.len() / 2);
        let mut ring_edges = vec![0; rings.len()];
        for &((from, to), side, place) in &steps {
            let back = steps.binary_search_by(|step| step.0.cmp(&(to, from))).map(|index| steps[index]);
            let Ok((_, other_side, other_place)) = back else {
                is_closed = false;
                continue;
            };
            if from < to {
                (ring_edges[place], ring_edges[other_place]) = (edges.len() as u32, edges.len() as u32);
                edges.push(Edge { ends: [from, to], sides: [side, other_side], name: name(from, to) });
            }
        }
        let numbered = edges.iter().zip(0_u32..);
        let around = numbered.flat_map(|(edge, number)| edge.ends.map(|corner| (corner, number))).collect();
        let around = Lists::new(corners, around);
        is_closed &= (0..corners as u32).all(|corner| around.of(corner).len() >= 3);
        is_closed &= corners + ends.len() == edges.len() + 2;
        Self { rings, ring_edges, ends, edges, around, is_closed }
    }

    /// Whether each edge has a side on its left and one on its right, three or more edges meet in each corner, and Euler's
    /// formula holds. Among slivers it may not be so.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// The corners of a side, anticlockwise from outside; none if there is no such side.
    pub fn ring(&self, side: u32) -> &[u32] {
        &self.rings[self.places(side)]
    }

    /// The edges of a side, each leading on from the corner of the same place in its ring.
    pub fn ring_edges(&self, side: u32) -> &[u32] {
        &self.ring_edges[self.places(side)]
    }

    /// The edges around a corner.
    pub fn around(&self, corner: u32) -> &[u32] {
        self.around.of(corner)
    }

    /// An edge.
    pub fn edge(&self, number: u32) -> &Edge {
        &self.edges[number as usize]
    }

    /// All edges.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The edge between two corners, if they are neighbours.
    pub fn edge_between(&self, one: u32, other: u32) -> Option<&Edge> {
        self.around(one).iter().map(|&number| self.edge(number)).find(|edge| edge.beyond(one) == other)
    }

    fn places(&self, side: u32) -> std::ops::Range<usize> {
        let side = side as usize;
        let start = if side == 0 { 0 } else { self.ends[side - 1] };
        self.ends.get(side).map_or(0..0, |&end| start..end)
    }
}
