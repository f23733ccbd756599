//! Two cuboids: the separating axis test, and the contacts along the axis that it finds.
//!
//! Everything happens in `a`'s frame. Sources: Gottschalk, Lin and Manocha, *OBBTree*, SIGGRAPH 1996 (the fifteen
//! axes); Gregorius, *The Separating Axis Test between Convex Polyhedra*, GDC 2013 (contacts from axes).

use super::clip::{Block, Overlap, overlap};
use super::cuboid::{self, Cuboid};
use super::manifold::{ContactPoint, Manifold};
use super::segment::{Segment, outside};
use super::{FLAT, Gap, ROUNDING};
use crate::math::{DMat3, DVec3};
use crate::report::Feature;

/// The square of the sine below which two edges are parallel: their cross product would be rounding.
const PARALLEL: f64 = 1e-16;

/// The square of the sine below which the quick form of an edge pair's gap is checked with the full one.
const NEARLY_PARALLEL: f64 = 1e-6;

/// Which features an axis comes from.
#[derive(Clone, Copy, Debug)]
enum Source {
    /// A face of `a`, across this axis.
    FaceA,
    /// A face of `b`.
    FaceB,
    /// An edge of `a` along the first axis and one of `b` along the second.
    Edges(usize, usize),
}

/// A direction and how far apart the boxes are along it.
#[derive(Clone, Copy, Debug)]
struct Axis {
    /// Unit vector from `a` to `b`.
    normal: DVec3,
    gap: f64,
    source: Source,
}

/// Two boxes in `a`'s frame.
struct Pair {
    a: Block,
    b: Block,
}

/// The widest gap along the fifteen axes.
pub(crate) fn gap(a: &Cuboid, b: &Cuboid) -> Gap {
    let axis = Pair::new(a, b).best_axis();
    Gap::along(axis.gap, a.pose.rotation * axis.normal)
}

/// The contacts along the axis of the widest gap.
///
/// A face's axis gives the overlap of two faces, seen along it. So does an edge pair's if it is almost at a right angle
/// to a face of either box: a box that rests a hair askew on a face or an edge has several points, not one. Any other edge pair gives the one
/// point where the edges come closest. If the boxes are apart and none of this is where they are closest, the contact
/// is between their closest points.
pub(crate) fn manifold(a: &Cuboid, b: &Cuboid, margin: f64) -> Option<Manifold> {
    let pair = Pair::new(a, b);
    let axis = pair.best_axis();
    if axis.gap > margin {
        return None;
    }
    let mut near = Overlap::NONE;
    match axis.source {
        Source::FaceA => overlap(&pair.a, &pair.b, axis.normal, &mut near),
        Source::FaceB => {
            overlap(&pair.b, &pair.a, -axis.normal, &mut near);
            near.flip();
        }
        Source::Edges(..) if pair.is_flat(axis.normal) => {
            overlap(&pair.a, &pair.b, axis.normal, &mut near);
        }
        Source::Edges(along_a, along_b) => {
            if let Some(point) = pair.edge_contact(&axis, along_a, along_b) {
                return Some(Manifold::single(axis.normal, point).placed(&a.pose));
            }
        }
    }
    let tolerance = 10.0 * ROUNDING * pair.size();
    let least = near.points().iter().map(|point| point.separation).fold(f64::INFINITY, f64::min);
    if least > axis.gap + tolerance
        && let Some((normal, point)) = pair.closest_contact(&axis)
        && point.separation < least - tolerance
    {
        let found = || Manifold::single(normal, point).placed(&a.pose);
        return (point.separation <= margin).then(found);
    }
    near.level_and_keep((axis.gap, tolerance), margin);
    (!near.points().is_empty()).then(|| Manifold::reduced(axis.normal, near.points()).placed(&a.pose))
}

impl Pair {
    fn new(a: &Cuboid, b: &Cuboid) -> Self {
        let relative = a.pose.relative(&b.pose);
        let turned = DMat3::from_quat(relative.rotation);
        let axes = [turned.x_axis, turned.y_axis, turned.z_axis];
        Self {
            a: Block { center: DVec3::ZERO, axes: DVec3::AXES, half: a.half },
            b: Block { center: relative.position, axes, half: b.half },
        }
    }

    /// A length that tells what is small for this pair.
    fn size(&self) -> f64 {
        self.a.half.max_element() + self.b.half.max_element()
    }

    /// The distance of the boxes' supporting planes across the unit vector `normal`: never more than the boxes'
    /// distance, whatever the direction.
    fn gap(&self, normal: DVec3) -> f64 {
        self.b.center.dot(normal)
            - self.a.half.dot(normal.abs())
            - self.b.half.dot(self.b.components(normal).abs())
    }

    /// The axis of the widest gap among the fifteen that can separate two boxes.
    ///
    /// These are the face normals of the Minkowski difference, so the widest gap is positive exactly if the boxes are
    /// disjoint, and the shortest way apart if they are not. Where axes tie but for rounding, faces of `a` go before
    /// faces of `b`, and both before edges.
    fn best_axis(&self) -> Axis {
        let (half_a, half_b, axes, center) = (self.a.half, self.b.half, self.b.axes, self.b.center);
        let away = |normal: DVec3| if self.b.center.dot(normal) < 0.0 { -normal } else { normal };
        let tolerance = ROUNDING * self.size();

        let reach_b = axes[0].abs() * half_b.x + axes[1].abs() * half_b.y + axes[2].abs() * half_b.z;
        let gaps = center.abs() - half_a - reach_b;
        let mut best = Axis { normal: DVec3::X, gap: f64::NEG_INFINITY, source: Source::FaceA };
        for k in 0..3 {
            if gaps[k] > best.gap + tolerance {
                best = Axis { normal: away(DVec3::AXES[k]), gap: gaps[k], source: Source::FaceA };
            }
        }
        for k in 0..3 {
            let gap = center.dot(axes[k]).abs() - half_b[k] - half_a.dot(axes[k].abs());
            if gap > best.gap + tolerance {
                best = Axis { normal: away(axes[k]), gap, source: Source::FaceB };
            }
        }
        // As plain numbers: columns[j][i] is the cosine of the angle between a's axis i and b's axis j.
        let columns = axes.map(|axis| axis.to_array());
        let (half_a, half_b, center) = (half_a.to_array(), half_b.to_array(), center.to_array());
        for j in 0..3 {
            let (next, last) = (columns[(j + 1) % 3], columns[(j + 2) % 3]);
            let (half_next, half_last) = (half_b[(j + 1) % 3], half_b[(j + 2) % 3]);
            let axis = columns[j];
            for i in 0..3 {
                // The cross product of the edges has two components: −axis[v] along u and axis[u] along v. Its length is
                // the sine of their angle; until it is divided by that, so is the gap.
                let (u, v) = ((i + 1) % 3, (i + 2) % 3);
                let sine_squared = axis[u] * axis[u] + axis[v] * axis[v];
                let apart = (center[v] * axis[u] - center[u] * axis[v]).abs();
                let reach_a = half_a[u] * axis[v].abs() + half_a[v] * axis[u].abs();
                let reach_b = half_next * last[i].abs() + half_last * next[i].abs();
                let scaled = apart - reach_a - reach_b;
                // A sine is at most 1: a gap below zero only falls when it is divided by it.
                let bound = best.gap + tolerance;
                let hopeless = if scaled <= 0.0 {
                    scaled <= bound
                } else {
                    bound > 0.0 && scaled * scaled <= bound * bound * sine_squared
                };
                if hopeless || sine_squared <= PARALLEL {
                    continue;
                }
                let sine = sine_squared.sqrt();
                let normal = away(DVec3::AXES[i].cross(axes[j]) / sine);
                let gap = if sine_squared < NEARLY_PARALLEL { self.gap(normal) } else { scaled / sine };
                if gap > bound {
                    best = Axis { normal, gap, source: Source::Edges(i, j) };
                }
            }
        }
        best
    }

    /// Whether a box has a face almost at a right angle to `normal`.
    fn is_flat(&self, normal: DVec3) -> bool {
        [&self.a, &self.b].iter().any(|block| block.components(normal).abs().max_element() >= FLAT)
    }

    /// The contact of the two edges that `axis` comes from, if they cross, seen along it.
    fn edge_contact(&self, axis: &Axis, along_a: usize, along_b: usize) -> Option<ContactPoint> {
        let end_a = cuboid::farthest_corner(axis.normal);
        let end_b = cuboid::farthest_corner(-self.b.components(axis.normal));
        let edge_a = cuboid::edge(along_a, end_a, self.a.half);
        let local_b = cuboid::edge(along_b, end_b, self.b.half);
        let edge_b = Segment { center: self.b.place(local_b.center), half: self.b.turn(local_b.half) };
        let (on_a, on_b) = edge_a.closest_to_segment(&edge_b);
        let beside = on_b - on_a - axis.normal * axis.gap;
        // Edges that overlap do cross: the shortest way out of an overlap leads through the crossing.
        (axis.gap <= 0.0 || beside.length() <= 1e-9 * self.size()).then(|| ContactPoint {
            point: 0.5 * (on_a + on_b),
            separation: axis.gap,
            feature_a: Feature::Edge(cuboid::edge_number(along_a, end_a)),
            feature_b: Feature::Edge(cuboid::edge_number(along_b, end_b)),
        })
    }

    /// The contact at the closest points of two boxes that are apart, and its normal: each edge of each box against
    /// the other box, since one of the closest points is always on an edge. Slow, and needed only where the closest
    /// features are two corners or a corner and an edge.
    ///
    /// Where the boxes touch, so that their closest points tell no direction, `axis` does.
    fn closest_contact(&self, axis: &Axis) -> Option<(DVec3, ContactPoint)> {
        let (from_a, from_b) = (closest_edge(&self.a, &self.b), closest_edge(&self.b, &self.a));
        let found = if from_a.distance <= from_b.distance { from_a } else { from_b.flipped() };
        let sized = found.distance > 1e-9 * self.size();
        let (normal, separation) =
            if sized { (found.normal, found.distance) } else { (axis.normal, axis.gap) };
        let point = ContactPoint {
            point: 0.5 * (found.on_a + found.on_b),
            separation,
            feature_a: found.feature_a,
            feature_b: found.feature_b,
        };
        (axis.gap > -1e-9 * self.size()).then_some((normal, point))
    }
}

/// The closest points of two boxes.
struct Closest {
    distance: f64,
    /// Unit vector from `a` to `b`; zero where they touch.
    normal: DVec3,
    on_a: DVec3,
    on_b: DVec3,
    feature_a: Feature,
    feature_b: Feature,
}

impl Closest {
    fn flipped(self) -> Self {
        Self {
            distance: self.distance,
            normal: -self.normal,
            on_a: self.on_b,
            on_b: self.on_a,
            feature_a: self.feature_b,
            feature_b: self.feature_a,
        }
    }
}

/// The closest points of `a`'s edges and the box `b`.
fn closest_edge(a: &Block, b: &Block) -> Closest {
    let mut best = Closest {
        distance: f64::INFINITY,
        normal: DVec3::ZERO,
        on_a: DVec3::ZERO,
        on_b: DVec3::ZERO,
        feature_a: Feature::Surface,
        feature_b: Feature::Surface,
    };
    for axis in 0..3 {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        for bits in 0..4_u32 {
            let start = (bits & 1) << next | (bits >> 1) << last;
            let own = cuboid::edge(axis, start, a.half);
            let edge = Segment { center: b.local(a.place(own.center)), half: b.components(a.turn(own.half)) };
            let s = edge.closest_to_box(b.half);
            let local = edge.at(s);
            let offset = outside(local, b.half);
            let distance = offset.length();
            if distance < best.distance {
                let corner = if s > 0.0 { start | 1 << axis } else { start };
                let at_end = 1.0 - s.abs() <= 1e-9;
                let outward = offset.normalize_or_zero();
                best = Closest {
                    distance,
                    normal: -b.turn(outward),
                    on_a: b.place(local),
                    on_b: b.place(local - offset),
                    feature_a: if at_end {
                        Feature::Vertex(corner)
                    } else {
                        Feature::Edge(cuboid::edge_number(axis, start))
                    },
                    feature_b: cuboid::feature_towards(outward),
                };
            }
        }
    }
    best
}
