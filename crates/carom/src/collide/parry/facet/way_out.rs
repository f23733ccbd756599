//! The shortest way out of a triangle for a cuboid or a hull that meets it.

use super::super::axis::Axis;
use super::Facet;
use crate::collide::ROUNDING;
use crate::collide::polytope::{Farthest, Moved, Polytope};
use crate::hull::Plane;
use crate::math::DVec3;

/// The square of the sine below which two edges are parallel: their cross product would be rounding.
const PARALLEL: f64 = 1e-16;

/// A side or an edge of the solid, or the triangle's own side: what the widest gap so far comes from.
#[derive(Clone, Copy)]
enum Source {
    Own,
    Side,
    /// The side of the triangle, and the ends of the solid's edge.
    Edges(usize, [u32; 2]),
}

impl Facet {
    /// The axis of the widest gap to a solid. `within` is a point of the triangle, best one in the solid: no gap is wider than the
    /// way from there, so that few edges need a look. Where axes tie but for rounding, the triangle's own goes before
    /// the solid's sides, and both before edges.
    pub(super) fn way_out(&self, solid: &Moved<Polytope>, within: DVec3) -> Axis {
        let shape = solid.shape;
        let local = |point: DVec3| solid.back * (point - solid.shift);
        let corners = self.corners.map(local);
        let within = local(within);
        let tolerance = ROUNDING * (self.size() + shape.size());
        let over = |normal: DVec3| (solid.farthest(-normal).1 - self.corners[0]).dot(normal);
        let (above, below) = (over(self.normal), over(-self.normal));
        let own = if below > above { (below, -self.normal) } else { (above, self.normal) };
        // The normals of sides and edges look out of the solid, against the way out.
        let mut best = (own.0, solid.back * -own.1, Source::Own);
        for plane in shape.planes {
            if plane.height(within) > best.0 + tolerance {
                let gap =
                    corners.map(|corner| plane.height(corner)).into_iter().fold(f64::INFINITY, f64::min);
                if gap > best.0 + tolerance {
                    best = (gap, plane.normal, Source::Side);
                }
            }
        }
        for edge in shape.topology.edges() {
            let [one, other] = edge.sides.map(|side| &shape.planes[side as usize]);
            if height_over(one, other, within) <= best.0 + tolerance {
                continue;
            }
            let place = shape.corner(edge.ends[0]);
            let along = shape.corner(edge.ends[1]) - place;
            for side in 0..3 {
                let from = corners[side];
                let side_along = corners[(side + 1) % 3] - from;
                if (one.normal.dot(side_along) > 0.0) == (other.normal.dot(side_along) > 0.0) {
                    continue;
                }
                let cross = side_along.cross(along);
                let cross = if cross.dot(one.normal + other.normal) < 0.0 { -cross } else { cross };
                let squared = cross.length_squared();
                // The rest of the triangle must lie farther out.
                if (corners[(side + 2) % 3] - from).dot(cross) < 0.0
                    || squared <= PARALLEL * side_along.length_squared() * along.length_squared()
                {
                    continue;
                }
                let outward = cross / squared.sqrt();
                if (from - place).dot(outward) > best.0 + tolerance {
                    // Rounding may have led beside the two sides: there other corners reach farther.
                    let lowest = corners.map(|corner| corner.dot(outward));
                    let lowest = lowest[0].min(lowest[1]).min(lowest[2]);
                    let gap = lowest - shape.corner(shape.highest(outward)).dot(outward);
                    if gap > best.0 + tolerance {
                        best = (gap, outward, Source::Edges(side, edge.ends));
                    }
                }
            }
        }
        self.axis_of(solid, own.1, best)
    }

    /// The axis of a gap, an outward normal in the solid's frame, and what these come from.
    fn axis_of(
        &self,
        solid: &Moved<Polytope>,
        own: DVec3,
        (gap, outward, source): (f64, DVec3, Source),
    ) -> Axis {
        let normal = match source {
            Source::Own => own,
            _ => solid.turn * -outward,
        };
        let (on_a, on_b) = match source {
            Source::Own => {
                let on_b = solid.farthest(-normal).1;
                (on_b - normal * gap, on_b)
            }
            Source::Side => {
                let on_a = self.farthest(normal).1;
                (on_a, on_a + normal * gap)
            }
            Source::Edges(side, ends) => {
                let mut edge = solid.shape.segment(ends);
                (edge.center, edge.half) = (solid.place(edge.center), solid.turn * edge.half);
                self.side(side).closest_to_segment(&edge)
            }
        };
        Axis { normal, gap, on_a, on_b }
    }
}

/// How far a point is at most above the arc of directions between two sides that meet in an edge: such a direction is the sum of the
/// two normals with weights that are together from 1 to 1/cos(θ/2), with θ the angle between them.
fn height_over(one: &Plane, other: &Plane, point: DVec3) -> f64 {
    let height = one.height(point).max(other.height(point));
    if height <= 0.0 { height } else { height * (2.0 / (1.0 + one.normal.dot(other.normal))).sqrt() }
}
