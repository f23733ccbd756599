//! Heights over a grid.

use crate::error::{Invalid, limits};
use crate::math::{DVec3, Pose};
use std::ops::Range;

/// Cells along the side of a block: the height range of a block tells whether any of its cells is worth a look.
const BLOCK: usize = 16;

/// A surface of heights over a rectangle across y, solid from both sides. For bodies that don't move.
///
/// The heights stand on the corners of a grid whose middle is the origin. Each cell is two triangles, cut along the
/// line from its corner at low x and low z to that at high x and high z. No triangle is kept: each is made from its
/// number where it is asked for, and only the cells below what is near are looked at.
///
/// *Numbers*: the height `heights[j][i]` is vertex `j·columns + i`. Cell `(i, j)` has number `k = j·(columns − 1) + i`,
/// and consists of face `2k`, on the side of high z, and face `2k + 1`, on the side of high x. Edges `3f`, `3f + 1`,
/// `3f + 2` of face `f` start from its corners, of which the first is the cell's at low x and low z; they run
/// anticlockwise seen from +y.
///
/// # Example
/// ```
/// use carom::height_field::HeightField;
/// // A ridge along z: 4 m by 2 m, 1 m high.
/// let ridge = HeightField::new(&[vec![0.0, 1.0, 0.0], vec![0.0, 1.0, 0.0]], [4.0, 2.0])?;
/// assert_eq!((ridge.columns(), ridge.rows(), ridge.height(1, 0)), (3, 2, Some(1.0)));
/// # Ok::<(), carom::Invalid>(())
/// ```
#[derive(Clone, Debug)]
pub struct HeightField {
    /// Row after row, m.
    heights: Vec<f64>,
    /// Heights along x and along z.
    counts: [usize; 2],
    /// Extent along x and along z, m.
    size: [f64; 2],
    /// The lowest and the highest point of each block of cells, row after row, m.
    blocks: Vec<(f64, f64)>,
    /// The lowest and the highest point of all, m.
    range: (f64, f64),
}

impl HeightField {
    /// Heights (m) in rows along z, each a list along x, over a rectangle of the full extent `size` (x and z, m).
    ///
    /// # Errors
    /// If there are fewer than two rows or two heights in a row, a row is of another length than the first, a height is
    /// not finite or beyond the largest length, or an extent is out of range.
    pub fn new(heights: &[Vec<f64>], size: [f64; 2]) -> Result<Self, Invalid> {
        let [columns, rows] = [heights.first().map_or(0, Vec::len), heights.len()];
        if rows < 2 {
            let expected = "at least two rows along z, each of at least two heights along x";
            return Err(Invalid::new("heights", counted(rows, "row"), expected));
        }
        if columns < 2 {
            let expected = "at least two heights along x in each row";
            return Err(Invalid::new("heights[0]", counted(columns, "height"), expected));
        }
        let reach = *limits::LENGTH.end();
        for (j, row) in heights.iter().enumerate() {
            if row.len() != columns {
                let expected = format!("{columns} heights, as in the first row");
                return Err(Invalid::new(format!("heights[{j}]"), counted(row.len(), "height"), expected));
            }
            if let Some(i) = row.iter().position(|height| !(-reach..=reach).contains(height)) {
                limits::within(&format!("heights[{j}][{i}]"), row[i], -reach..=reach, "m")?;
            }
        }
        for (axis, extent) in size.into_iter().enumerate() {
            limits::within(&format!("size[{axis}]"), extent, limits::LENGTH, "m")?;
        }
        // Two triangles to a height, and a number for each.
        if rows > (u32::MAX / 2) as usize / columns {
            let found = format!("{columns} by {rows} heights");
            return Err(Invalid::new("heights", found, "at most 2147483647 heights in all"));
        }
        let mut field = Self {
            heights: heights.concat(),
            counts: [columns, rows],
            size,
            blocks: Vec::new(),
            range: (0.0, 0.0),
        };
        field.blocks = field.ranges_of_blocks();
        field.range = range(field.heights.iter().copied());
        Ok(field)
    }

    /// Heights along x.
    pub fn columns(&self) -> usize {
        self.counts[0]
    }

    /// Heights along z.
    pub fn rows(&self) -> usize {
        self.counts[1]
    }

    /// Full extent along x and along z, m.
    pub fn size(&self) -> [f64; 2] {
        self.size
    }

    /// The height (m) in a column, counted along x, and a row, counted along z; none where there is no such place.
    pub fn height(&self, column: usize, row: usize) -> Option<f64> {
        let inside = column < self.columns() && row < self.rows();
        inside.then(|| self.heights[row * self.columns() + column])
    }

    /// The box around it: lowest and highest corner, m.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let ([x, z], (low, high)) = (self.size.map(|extent| 0.5 * extent), self.range);
        (DVec3::new(-x, low, -z), DVec3::new(x, high, z))
    }

    /// The box along the outer axes around the box around it, at `pose`: it does not take a look at every height.
    pub(crate) fn placed_bounds(&self, pose: &Pose) -> (DVec3, DVec3) {
        let (low, high) = self.bounds();
        let (center, half) = (pose.transform_point(0.5 * (low + high)), 0.5 * (high - low));
        let reach = (pose.rotation * DVec3::X).abs() * half.x
            + (pose.rotation * DVec3::Y).abs() * half.y
            + (pose.rotation * DVec3::Z).abs() * half.z;
        (center - reach, center + reach)
    }

    /// The distance (m) from `origin` to the farthest corner of the box around it.
    pub(crate) fn reach(&self, origin: DVec3) -> f64 {
        let (low, high) = self.bounds();
        (origin - low).abs().max((origin - high).abs()).length()
    }

    /// A vertex by its number.
    pub(crate) fn vertex(&self, number: u32) -> DVec3 {
        let number = number as usize;
        let (column, row) = (number % self.columns(), number / self.columns());
        DVec3::new(self.coordinate(0, column), self.heights[number], self.coordinate(1, row))
    }

    /// How many vertices there are.
    pub(crate) fn n_vertices(&self) -> u32 {
        self.heights.len() as u32
    }

    /// The numbers of a triangle's corners, anticlockwise from above.
    pub(crate) fn triangle(&self, number: u32) -> [u32; 3] {
        let (column, row) = self.cell(number / 2);
        let low = (row * self.columns() + column) as u32;
        let high = low + self.columns() as u32;
        if number.is_multiple_of(2) { [low, high, high + 1] } else { [low, high + 1, low + 1] }
    }

    /// The triangles beyond the sides 0→1, 1→2, 2→0 of a triangle.
    pub(crate) fn neighbours(&self, number: u32) -> [Option<u32>; 3] {
        let (column, row) = self.cell(number / 2);
        let along = 2 * self.cells(0) as u32;
        if number.is_multiple_of(2) {
            let before = (column > 0).then(|| number - 1);
            let above = (row + 1 < self.cells(1)).then(|| number + along + 1);
            [before, above, Some(number + 1)]
        } else {
            let after = (column + 1 < self.cells(0)).then(|| number + 1);
            let below = (row > 0).then(|| number - along - 1);
            [Some(number - 1), after, below]
        }
    }

    /// The triangles whose boxes meet the box from `low` to `high`, in order.
    pub(crate) fn within(&self, low: DVec3, high: DVec3) -> Vec<u32> {
        let (columns, rows) = (self.cells_between(0, low.x, high.x), self.cells_between(1, low.z, high.z));
        let meets = |range: (f64, f64)| range.0 <= high.y && range.1 >= low.y;
        let mut found = Vec::new();
        for block_row in blocks_of(&rows) {
            for block_column in blocks_of(&columns) {
                let block = block_row * self.cells(0).div_ceil(BLOCK) + block_column;
                if !meets(self.blocks[block]) {
                    continue;
                }
                for row in part(&rows, block_row) {
                    for column in part(&columns, block_column) {
                        let first = 2 * (row * self.cells(0) + column) as u32;
                        let height = |corner: u32| self.heights[corner as usize];
                        found.extend([first, first + 1].into_iter().filter(|&triangle| {
                            meets(range(self.triangle(triangle).into_iter().map(height)))
                        }));
                    }
                }
            }
        }
        found.sort_unstable();
        found
    }

    /// Cells along an axis: 0 for x, 1 for z.
    fn cells(&self, axis: usize) -> usize {
        self.counts[axis] - 1
    }

    /// Column and row of a cell.
    fn cell(&self, number: u32) -> (usize, usize) {
        (number as usize % self.cells(0), number as usize / self.cells(0))
    }

    /// Where the heights of a column or row stand, m.
    fn coordinate(&self, axis: usize, index: usize) -> f64 {
        let cells = self.cells(axis) as f64;
        ((2 * index) as f64 - cells) / (2.0 * cells) * self.size[axis]
    }

    /// The columns or rows of cells that have something in common with the stretch from `low` to `high` (m).
    fn cells_between(&self, axis: usize, low: f64, high: f64) -> Range<usize> {
        let cells = self.cells(axis);
        // Rounding may miss by a cell, so one more on either side is measured. The casts stop at 0 and at the largest.
        let cell = |x: f64| ((x / self.size[axis] + 0.5) * cells as f64) as usize;
        let mut first = cell(low).saturating_sub(1).min(cells);
        let mut end = cell(high).saturating_add(2).min(cells);
        while first < end && self.coordinate(axis, first + 1) < low {
            first += 1;
        }
        while first < end && self.coordinate(axis, end - 1) > high {
            end -= 1;
        }
        first..end
    }

    fn ranges_of_blocks(&self) -> Vec<(f64, f64)> {
        let all = |axis: usize| 0..self.cells(axis);
        let of_block = |block_column: usize, block_row: usize| {
            let (columns, rows) = (part(&all(0), block_column), part(&all(1), block_row));
            // A cell's far corners belong to it as well.
            let heights = |row: usize| {
                let start = row * self.columns();
                self.heights[start + columns.start..=start + columns.end].iter().copied()
            };
            range((rows.start..=rows.end).flat_map(heights))
        };
        let (along_x, along_z) = (blocks_of(&all(0)), blocks_of(&all(1)));
        along_z.flat_map(|row| along_x.clone().map(move |column| of_block(column, row))).collect()
    }
}

/// The blocks that cells lie in, along one axis.
fn blocks_of(cells: &Range<usize>) -> Range<usize> {
    cells.start / BLOCK..cells.end.div_ceil(BLOCK)
}

/// Those of `cells` that lie in a block, along one axis.
fn part(cells: &Range<usize>, block: usize) -> Range<usize> {
    cells.start.max(block * BLOCK)..cells.end.min((block + 1) * BLOCK)
}

/// The lowest and the highest.
fn range(heights: impl Iterator<Item = f64>) -> (f64, f64) {
    heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)))
}

/// `1 row`, `3 rows`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 4 columns, 3 rows, cells of 1 m by 2 m.
    fn hills() -> HeightField {
        let row = |j: i32| (0..4).map(|i| f64::from(10 * j + i)).collect();
        HeightField::new(&[row(0), row(1), row(2)], [3.0, 4.0]).unwrap()
    }

    fn corners(field: &HeightField, triangle: u32) -> [DVec3; 3] {
        field.triangle(triangle).map(|corner| field.vertex(corner))
    }

    #[test]
    fn cells_are_cut_from_their_low_to_their_high_corner() {
        let field = hills();
        // Cell (1, 0): x from −0.5 to 0.5, z from −2 to 0.
        let (low, high) = (DVec3::new(-0.5, 1.0, -2.0), DVec3::new(0.5, 12.0, 0.0));
        assert_eq!(corners(&field, 2), [low, DVec3::new(-0.5, 11.0, 0.0), high]);
        assert_eq!(corners(&field, 3), [low, high, DVec3::new(0.5, 2.0, -2.0)]);
        assert_eq!(field.bounds(), (DVec3::new(-1.5, 0.0, -2.0), DVec3::new(1.5, 23.0, 2.0)));
        for triangle in 0..12 {
            let [a, b, c] = corners(&field, triangle);
            assert!((b - a).cross(c - a).y > 0.0, "{triangle} faces up");
        }
    }

    #[test]
    fn neighbours_share_the_side_that_they_are_named_for() {
        let field = hills();
        let mut borders = 0;
        for triangle in 0..12 {
            for (side, neighbour) in field.neighbours(triangle).into_iter().enumerate() {
                let corners = field.triangle(triangle);
                let ends = [corners[side], corners[(side + 1) % 3]];
                let Some(neighbour) = neighbour else {
                    borders += 1;
                    continue;
                };
                let theirs = field.triangle(neighbour);
                let back =
                    field.neighbours(neighbour).iter().position(|&back| back == Some(triangle)).unwrap();
                assert_eq!([theirs[(back + 1) % 3], theirs[back]], ends, "{triangle} {side}");
            }
        }
        assert_eq!(borders, 2 * 3 + 2 * 2);
    }

    #[test]
    fn the_search_finds_what_a_look_at_all_triangles_finds() {
        let mut state = 1_u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let heights: Vec<Vec<f64>> = (0..40).map(|_| (0..55).map(|_| number()).collect()).collect();
        let field = HeightField::new(&heights, [5.4, 7.8]).unwrap();
        for round in 0..400 {
            let mut point = || DVec3::new(number() * 7.0 - 3.5, number() * 1.4 - 0.2, number() * 9.0 - 4.5);
            let (one, other) = (point(), point());
            let (mut low, mut high) = (one.min(other), one.max(other));
            if round % 3 == 0 {
                // Right on the lines of the grid.
                low = field.vertex(round);
                high = field.vertex(round + 60).max(low);
                low = low.min(high);
            }
            let meets = |triangle: &u32| {
                let corners = corners(&field, *triangle);
                let (least, most) = (
                    corners.into_iter().fold(DVec3::INFINITY, DVec3::min),
                    corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max),
                );
                least.cmple(high).all() && most.cmpge(low).all()
            };
            let expected: Vec<u32> = (0..2 * 54 * 39).filter(meets).collect();
            assert_eq!(field.within(low, high), expected, "{low} {high}");
        }
        let everything = field.within(DVec3::splat(-1e300), DVec3::splat(1e300));
        assert_eq!(everything.len(), 2 * 54 * 39);
        assert!(field.within(DVec3::splat(4.0), DVec3::splat(1e300)).is_empty());
        assert!(field.within(DVec3::splat(-1e300), DVec3::splat(-4.0)).is_empty());
    }

    #[test]
    fn what_is_no_grid_is_refused_by_name() {
        let refused = |heights: &[Vec<f64>], size: [f64; 2]| {
            let error = HeightField::new(heights, size).map(|_| ()).unwrap_err();
            assert!(!error.expected.is_empty());
            (error.field, error.value)
        };
        let told = |field: &str, value: &str| (field.to_owned(), value.to_owned());
        let (flat, size) = (vec![0.0, 0.0], [1.0, 1.0]);
        assert_eq!(refused(&[], size), told("heights", "0 rows"));
        assert_eq!(refused(&[vec![0.0; 9]], size), told("heights", "1 row"));
        assert_eq!(refused(&[vec![0.0], vec![0.0]], size), told("heights[0]", "1 height"));
        assert_eq!(refused(&[flat.clone(), vec![0.0; 3]], size), told("heights[1]", "3 heights"));
        assert_eq!(refused(&[flat.clone(), vec![0.0, f64::NAN]], size), told("heights[1][1]", "NaN"));
        assert_eq!(refused(&[vec![-2e6, 0.0], flat.clone()], size), told("heights[0][0]", "-2000000"));
        let flat = [flat.clone(), flat];
        assert_eq!(refused(&flat, [0.0, 1.0]), told("size[0]", "0"));
        assert_eq!(refused(&flat, [1.0, f64::INFINITY]), told("size[1]", "inf"));
    }
}
