//! The corner of a convex polyhedron that lies farthest in a direction, without a look at all of them.
//!
//! On a convex surface a corner that none of its neighbours overtops is the highest of all. So the search starts at the
//! corner that is highest along a direction nearby, taken from a table, and climbs from neighbour to neighbour. The
//! table is a net of squares over the six sides of a cube, about as many as there are corners, so a few steps do.

use crate::math::DVec3;

/// Hulls with no more corners than this are searched one by one.
const FEW: usize = 32;

/// The largest face whose corners are all neighbours of each other. Points nearly in a plane leave its triangles to
/// rounding; a step across the whole face passes over any dent in them.
const WIDE: usize = 16;

/// Neighbours of corners, and where to start.
#[derive(Clone, Debug)]
pub(super) struct Climb {
    /// The squares along an edge of the cube.
    squares: usize,
    /// The highest corner along the middle of each square.
    starts: Vec<u32>,
    neighbours: Lists,
    /// The flat sides around each corner.
    faces: Lists,
}

/// A list of numbers for each number.
#[derive(Clone, Debug)]
pub(super) struct Lists {
    ends: Vec<u32>,
    members: Vec<u32>,
}

impl Lists {
    pub fn new(count: usize, mut pairs: Vec<(u32, u32)>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let ends =
            (0..count).map(|list| pairs.partition_point(|pair| pair.0 as usize <= list) as u32).collect();
        Self { ends, members: pairs.into_iter().map(|pair| pair.1).collect() }
    }

    pub fn of(&self, list: u32) -> &[u32] {
        let list = list as usize;
        let start = if list == 0 { 0 } else { self.ends[list - 1] };
        &self.members[start as usize..self.ends[list] as usize]
    }
}

/// All corners in groups of four, each group's x, y and z together: heights of four are then as quick as one.
#[derive(Clone, Debug)]
pub(super) struct Scan {
    /// The last group is filled up with its first corner.
    groups: Vec<[[f64; 4]; 3]>,
}

impl Scan {
    pub fn new(vertices: &[DVec3]) -> Self {
        let group = |four: &[DVec3]| {
            let lanes: [DVec3; 4] = std::array::from_fn(|lane| *four.get(lane).unwrap_or(&four[0]));
            std::array::from_fn(|axis| lanes.map(|vertex| vertex[axis]))
        };
        Self { groups: vertices.chunks(4).map(group).collect() }
    }

    /// The highest of all corners, the first of equal ones.
    ///
    /// First how high it is, then which one is so high: two plain loops, which the compiler turns into wide ones.
    pub fn highest(&self, direction: DVec3) -> u32 {
        let heights = |[x, y, z]: &[[f64; 4]; 3]| -> [f64; 4] {
            std::array::from_fn(|lane| x[lane] * direction.x + y[lane] * direction.y + z[lane] * direction.z)
        };
        let mut tops = [f64::NEG_INFINITY; 4];
        for group in &self.groups {
            let heights = heights(group);
            for lane in 0..4 {
                tops[lane] = if heights[lane] > tops[lane] { heights[lane] } else { tops[lane] };
            }
        }
        let top = tops.into_iter().fold(f64::NEG_INFINITY, f64::max);
        for (number, group) in self.groups.iter().enumerate() {
            let heights = heights(group);
            if let Some(lane) = heights.iter().position(|&height| height == top) {
                return (4 * number + lane) as u32;
            }
        }
        0
    }
}

impl Climb {
    /// `None` where it is not worth it: there are few corners, or the surface has dents that a climb ends in.
    ///
    /// `outlines` are the corners of the flat sides, `faces` the triangles that these consist of, `normals` their
    /// directions.
    pub fn new<'a>(
        (vertices, scan): (&[DVec3], &Scan),
        triangles: &[[u32; 3]],
        outlines: impl Iterator<Item = &'a [u32]>,
        faces: impl Iterator<Item = ([u32; 3], u32)>,
        normals: impl Iterator<Item = DVec3>,
    ) -> Option<Self> {
        if vertices.len() <= FEW {
            return None;
        }
        let all_of = |corners: &[u32], pairs: &mut Vec<(u32, u32)>| {
            for &one in corners {
                pairs.extend(corners.iter().filter(|&&other| other != one).map(|&other| (one, other)));
            }
        };
        let (mut steps, mut sides) = (Vec::new(), Vec::new());
        triangles.iter().for_each(|triangle| all_of(triangle, &mut steps));
        faces.for_each(|(triangle, face)| sides.extend(triangle.map(|corner| (corner, face))));
        outlines.filter(|outline| outline.len() <= WIDE).for_each(|outline| all_of(outline, &mut steps));
        let squares = ((vertices.len() as f64 / 6.0).sqrt() as usize).clamp(2, 16);
        let mut climb = Self {
            squares,
            starts: Vec::with_capacity(6 * squares * squares),
            neighbours: Lists::new(vertices.len(), steps),
            faces: Lists::new(vertices.len(), sides),
        };
        let mut start = scan.highest(climb.middle(0));
        for square in 0..6 * squares * squares {
            start = climb.up_from(start, vertices, climb.middle(square));
            climb.starts.push(start);
        }
        let middles = (0..climb.starts.len()).map(|square| climb.middle(square));
        let low = vertices.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let extent = (vertices.iter().copied().fold(low, DVec3::max) - low).max_element();
        let reaches_top = |direction: DVec3| {
            let [found, top] = [climb.highest(vertices, direction), scan.highest(direction)]
                .map(|index| vertices[index as usize].dot(direction));
            top - found <= 1e-13 * extent * direction.length()
        };
        let good = middles.chain(normals).all(reaches_top);
        good.then_some(climb)
    }

    /// The highest corner along `direction`; of equal ones, always the same for the same direction.
    pub fn highest(&self, vertices: &[DVec3], direction: DVec3) -> u32 {
        self.up_from(self.starts[self.square(direction)], vertices, direction)
    }

    /// The flat sides around a corner.
    pub fn faces_at(&self, vertex: u32) -> &[u32] {
        self.faces.of(vertex)
    }

    fn up_from(&self, start: u32, vertices: &[DVec3], direction: DVec3) -> u32 {
        let mut best = (start, vertices[start as usize].dot(direction));
        loop {
            let here = best.0;
            for &next in self.neighbours.of(here) {
                let height = vertices[next as usize].dot(direction);
                if height > best.1 {
                    best = (next, height);
                }
            }
            if best.0 == here {
                return here;
            }
        }
    }

    /// The square that `direction` passes through: side of the cube, row, column.
    fn square(&self, direction: DVec3) -> usize {
        let size = direction.abs();
        let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
        let side = 2 * axis + usize::from(direction[axis] > 0.0);
        // Without a direction this is 0/0, and the cast makes it 0.
        let place = |other: usize| {
            let part = 0.5 + 0.5 * direction[(axis + other) % 3] / size[axis];
            ((part * self.squares as f64) as usize).min(self.squares - 1)
        };
        (side * self.squares + place(1)) * self.squares + place(2)
    }

    /// The direction through the middle of a square.
    fn middle(&self, square: usize) -> DVec3 {
        let (row, column) = (square / self.squares % self.squares, square % self.squares);
        let side = square / self.squares / self.squares;
        let place = |index: usize| (2.0 * index as f64 + 1.0) / self.squares as f64 - 1.0;
        let mut direction = DVec3::ZERO;
        direction[side / 2] = if side % 2 == 1 { 1.0 } else { -1.0 };
        direction[(side / 2 + 1) % 3] = place(row);
        direction[(side / 2 + 2) % 3] = place(column);
        direction
    }
}
