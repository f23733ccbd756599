//! Where two sides face each other: one outline cut to the other, and the best four of the points this leaves.

mod knife;

use super::convex::{Convex, Corner, Outline};
use crate::collide::{ContactPoint, Manifold};
use crate::math::{DVec3, Pose, any_tangent};
use crate::report::Feature;
use knife::{Cut, Knife, Room, Side};
use std::cell::Cell;

/// Most outlines that are cut have no more corners.
const FEW: usize = 8;

thread_local! {
    /// What the last look of this thread needed has room for the next one.
    static SPARE: Cell<Candidates> = const { Cell::new(Candidates::NONE) };
}

/// Points that may go into a manifold: those within a margin.
pub(super) struct Candidates {
    points: Vec<ContactPoint>,
    margin: f64,
    /// The smallest separation so far, m; infinite where there was no point.
    least: f64,
    /// The two sides that face each other.
    sides: [Outline; 2],
    room: Room,
}

impl Default for Candidates {
    fn default() -> Self {
        Self::NONE
    }
}

impl Candidates {
    const NONE: Candidates = Candidates {
        points: Vec::new(),
        margin: 0.0,
        least: f64::INFINITY,
        sides: [Outline::NONE, Outline::NONE],
        room: Room::NONE,
    };

    /// Hands `look` room for the points of manifolds within a margin (m).
    pub fn with<R>(margin: f64, look: impl FnOnce(&mut Candidates) -> R) -> R {
        let mut candidates = SPARE.take();
        candidates.clear();
        candidates.margin = margin;
        let found = look(&mut candidates);
        SPARE.set(candidates);
        found
    }

    /// m
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Room for the points of another manifold within the same margin.
    pub fn clear(&mut self) {
        self.points.clear();
        self.points.reserve(FEW);
        self.least = f64::INFINITY;
    }

    pub fn push(&mut self, point: ContactPoint) {
        if point.separation <= self.margin && point.point.is_finite() {
            self.least = self.least.min(point.separation);
            self.points.push(point);
        }
    }

    /// Takes away the points closer than `distance` (m) to `place`.
    pub fn remove_at(&mut self, place: DVec3, distance: f64) {
        self.points.retain(|point| point.point.distance(place) > distance);
    }

    /// The smallest separation of all that were offered, m; infinite where there was no point.
    pub fn least_separation(&self) -> f64 {
        self.least
    }

    /// The best four: the deepest, the one farthest from it, and on each side of the line between them the one that
    /// spans the most area. `None` if there is no point. Equal ones: the first.
    pub fn reduced(&self, normal: DVec3) -> Option<Manifold> {
        let first_best = |value: &dyn Fn(&ContactPoint) -> f64, least: f64| {
            let mut best: Option<(&ContactPoint, f64)> = None;
            for point in &self.points {
                let score = value(point);
                if score > best.map_or(least, |(_, score)| score) {
                    best = Some((point, score));
                }
            }
            best.map(|(point, _)| *point)
        };
        let deepest = first_best(&|point| -point.separation, f64::NEG_INFINITY)?;
        let origin = deepest.point;
        let extent = self.points.iter().map(|point| point.point.distance(origin)).fold(0.0, f64::max);
        let mut manifold = Manifold::new(normal);
        manifold.push(deepest);
        let tiny = 1e-9 * (extent + origin.abs().max_element());
        if let Some(farthest) = first_best(&|point| point.point.distance(origin), tiny) {
            manifold.push(farthest);
            let across = normal.cross(farthest.point - origin);
            for side in [across, -across] {
                let spanned = |point: &ContactPoint| side.dot(point.point - origin);
                if let Some(widest) = first_best(&spanned, 1e-6 * extent * extent) {
                    manifold.push(widest);
                }
            }
        }
        Some(manifold)
    }
}

/// Cuts the side of `a` that faces along `normal` to the side of `b` that faces against it (Sutherland and Hodgman,
/// *Reentrant Polygon Clipping*, 1974) and offers the corners of what is left, in a's frame. Offers nothing where
/// the sides pass each other edge on or meet in single points; the axis' own points stand in there.
pub(super) fn contacts(a: &Convex, b: &Convex, b_in_a: &Pose, normal: DVec3, out: &mut Candidates) {
    let mut sides = std::mem::take(&mut out.sides);
    let mut room = std::mem::take(&mut out.room);
    a.core.outline_into(normal, &mut sides[0]);
    b.core.outline_into(b_in_a.rotation.conjugate() * -normal, &mut sides[1]);
    sides[1].corners_mut().iter_mut().for_each(|corner| corner.point = b_in_a.transform_point(corner.point));
    contacts_of_sides((a.radius, &sides[0]), (b.radius, &sides[1]), normal, &mut room, out);
    (out.sides, out.room) = (sides, room);
}

fn contacts_of_sides(
    (radius_a, side_a): (f64, &Outline),
    (radius_b, side_b): (f64, &Outline),
    normal: DVec3,
    room: &mut Room,
    out: &mut Candidates,
) {
    let (across, up) = {
        let across = any_tangent(normal);
        (across, normal.cross(across))
    };
    let mut offer = |x: f64, y: f64, heights: (f64, f64), features: (Feature, Feature)| {
        let (low, high) = (heights.0 + radius_a, heights.1 - radius_b);
        let point = across * x + up * y + normal * (0.5 * (low + high));
        let (feature_a, feature_b) = features;
        out.push(ContactPoint { point, separation: high - low, feature_a, feature_b });
    };
    let flat = |corner: &Corner| (corner.point.dot(across), corner.point.dot(up), corner.point.dot(normal));
    let (corners_a, corners_b) = (side_a.corners(), side_b.corners());

    if let (2, 2) = (corners_a.len(), corners_b.len()) {
        let ([a0, a1], [b0, b1]) =
            ([flat(&corners_a[0]), flat(&corners_a[1])], [flat(&corners_b[0]), flat(&corners_b[1])]);
        return parallel_segments([a0, a1], [b0, b1], &mut |x, y, heights| {
            offer(x, y, heights, (corners_a[0].edge, corners_b[0].edge));
        });
    }
    // The knife must have an area; the other may be a segment or a point.
    let b_cuts = corners_b.len() > 2;
    let (subject, knife) = if b_cuts { (side_a, side_b) } else { (side_b, side_a) };
    let Some(plane) = Knife::new(knife.corners(), flat) else { return };
    room.clear();
    for corner in subject.corners() {
        let (x, y, height) = flat(corner);
        let onward = Side::Own(corner.edge);
        room.shape.push(Cut { x, y, height, own: corner.vertex, other: knife.face, onward });
    }
    plane.cut_all(room, knife.corners(), subject.face);
    for cut in &room.shape {
        let height = plane.height(cut.x, cut.y);
        if b_cuts {
            offer(cut.x, cut.y, (cut.height, height), (cut.own, cut.other));
        } else {
            offer(cut.x, cut.y, (height, cut.height), (cut.other, cut.own));
        }
    }
}

/// Offers the two ends of what two segments, nearly parallel across the normal, have in common; nothing for others.
fn parallel_segments(
    a: [(f64, f64, f64); 2],
    b: [(f64, f64, f64); 2],
    offer: &mut dyn FnMut(f64, f64, (f64, f64)),
) {
    const PARALLEL: f64 = 0.05;
    let (ax, ay) = (a[1].0 - a[0].0, a[1].1 - a[0].1);
    let (bx, by) = (b[1].0 - b[0].0, b[1].1 - b[0].1);
    let (aa, bb) = (ax * ax + ay * ay, bx * bx + by * by);
    let sine = ax * by - ay * bx;
    if aa == 0.0 || bb == 0.0 || sine * sine > PARALLEL * PARALLEL * aa * bb {
        return;
    }
    let along = |point: (f64, f64, f64)| ((point.0 - a[0].0) * ax + (point.1 - a[0].1) * ay) / aa;
    let (b0, b1) = (along(b[0]), along(b[1]));
    let (low, high) = (b0.min(b1).max(0.0), b0.max(b1).min(1.0));
    if low > high {
        return;
    }
    for part in [low, high] {
        let on_b = ((part - b0) / (b1 - b0)).clamp(0.0, 1.0);
        let between = |one: f64, other: f64, part: f64| one + part * (other - one);
        let x = between(a[0].0, a[1].0, part);
        let y = between(a[0].1, a[1].1, part);
        offer(x, y, (between(a[0].2, a[1].2, part), between(b[0].2, b[1].2, on_b)));
    }
}
