//! Where two flat sides lie over each other, seen along a normal: the corners that their overlap has.

use super::ROUNDING;
use super::manifold::{ContactPoint, Manifold};
use super::polytope::{Moved, Polytope};
use crate::math::{DVec3, any_tangent};
use crate::report::Feature;

/// So many are kept without asking for memory.
const FEW: usize = 12;

/// A side steeper against the normal than this (cosine) has no heights: a hair across is a mile along.
const STEEP: f64 = 0.01;

/// A list that asks for memory only when it is long.
struct List<T> {
    few: [T; FEW],
    many: Vec<T>,
    count: usize,
}

impl<T: Copy> List<T> {
    fn new(filler: T) -> Self {
        Self { few: [filler; FEW], many: Vec::new(), count: 0 }
    }

    fn push(&mut self, item: T) {
        if self.count == FEW {
            self.many.extend(self.few);
        }
        if self.count < FEW {
            self.few[self.count] = item;
        } else {
            self.many.push(item);
        }
        self.count += 1;
    }

    fn items(&self) -> &[T] {
        if self.many.is_empty() { &self.few[..self.count] } else { &self.many }
    }

    fn items_mut(&mut self) -> &mut [T] {
        if self.many.is_empty() { &mut self.few[..self.count] } else { &mut self.many }
    }
}

/// Contacts that share a normal.
pub(crate) struct Patch {
    contacts: List<ContactPoint>,
}

impl Patch {
    pub(crate) fn new() -> Self {
        Self { contacts: List::new(ContactPoint::NONE) }
    }

    pub(crate) fn push(&mut self, contact: ContactPoint) {
        self.contacts.push(contact);
    }

    /// The contacts.
    pub(crate) fn contacts(&self) -> &[ContactPoint] {
        self.contacts.items()
    }

    /// The smallest separation, m; infinite where there is no contact.
    pub(crate) fn least(&self) -> f64 {
        self.contacts().iter().map(|contact| contact.separation).fold(f64::INFINITY, f64::min)
    }

    /// The best four of the contacts no further apart than `margin`, if there are any. Those within `tolerance` of the
    /// least separation `least` have just that.
    pub(crate) fn reduced(
        mut self,
        normal: DVec3,
        (least, tolerance): (f64, f64),
        margin: f64,
    ) -> Option<Manifold> {
        let contacts = self.contacts.items_mut();
        let mut kept = 0;
        for index in 0..contacts.len() {
            let mut contact = contacts[index];
            if contact.separation <= least + tolerance {
                contact.separation = least;
            }
            if contact.separation <= margin {
                contacts[kept] = contact;
                kept += 1;
            }
        }
        (kept > 0).then(|| Manifold::reduced(normal, &contacts[..kept]))
    }

    /// The best four of `contact` and of these no further apart than `margin`.
    pub(crate) fn with(mut self, contact: ContactPoint, margin: f64, normal: DVec3) -> Manifold {
        self.contacts.push(contact);
        let level = (contact.separation, 0.0);
        self.reduced(normal, level, margin).unwrap_or_else(|| Manifold::single(normal, contact))
    }
}

/// A corner of a side: its place in the plane across the normal, its height along it.
#[derive(Clone, Copy)]
struct Corner {
    x: f64,
    y: f64,
    height: f64,
    number: u32,
    /// The edge from here on: its line has `across · (x, y) = limit`, and the side lies below.
    across: (f64, f64),
    limit: f64,
    edge: u32,
}

/// A side seen along the normal.
struct Outline {
    corners: List<Corner>,
    feature: Feature,
    /// Of the side's plane: height = slope·(x, y) + offset; none if the plane is steep.
    heights: Option<(f64, f64, f64)>,
    /// Half its extent, m.
    size: f64,
}

impl Outline {
    /// `frame` is two directions across the normal and the normal itself; `facing` is 1 where the side looks along the
    /// normal and −1 where it looks against it.
    fn new(polytope: &Moved<Polytope>, side: u32, frame: [DVec3; 3], facing: f64) -> Self {
        let shape = polytope.shape;
        let (ring, edges) = (shape.topology.ring(side), shape.topology.ring_edges(side));
        let filler =
            Corner { x: 0.0, y: 0.0, height: 0.0, number: 0, across: (0.0, 0.0), limit: 0.0, edge: 0 };
        let mut corners = List::new(filler);
        // Into the polytope's frame the three directions go, not each corner out of it.
        let inward = frame.map(|direction| polytope.back * direction);
        let shift = frame.map(|direction| direction.dot(polytope.shift));
        for (&number, &edge) in ring.iter().zip(edges) {
            let corner = shape.corner(number);
            let [x, y, height] = std::array::from_fn(|k| corner.dot(inward[k]) + shift[k]);
            let edge = shape.topology.edge(edge).name;
            corners.push(Corner { x, y, height, number, edge, ..filler });
        }
        let items = corners.items_mut();
        let mut extent: f64 = 0.0;
        for k in 0..items.len() {
            let (here, next) = (items[k], items[(k + 1) % items.len()]);
            let (dx, dy) = (next.x - here.x, next.y - here.y);
            let length = (dx * dx + dy * dy).sqrt();
            let scale = if length > 0.0 { facing / length } else { 0.0 };
            items[k].across = (dy * scale, -dx * scale);
            items[k].limit = items[k].across.0 * here.x + items[k].across.1 * here.y;
            extent = extent.max(length);
        }
        let plane = &shape.planes[side as usize];
        let [x, y, along] = inward.map(|direction| plane.normal.dot(direction));
        let heights = (along * facing > STEEP).then(|| {
            let offset = plane.offset + plane.normal.dot(polytope.back * polytope.shift);
            (-x / along, -y / along, offset / along)
        });
        Self { corners, feature: Feature::Face(side), heights, size: 0.5 * extent }
    }

    fn height(&self, x: f64, y: f64) -> Option<f64> {
        self.heights.map(|(slope_x, slope_y, offset)| slope_x * x + slope_y * y + offset)
    }
}

/// The contacts at the corners of the overlap of side `side_a` of `a` and `side_b` of `b`, seen along `normal`: unit
/// length, from `a` to `b`, and need not be either side's own. These are the corners of each side that lie over the
/// other, and the crossings of their edges (each edge of `b` clipped to `a`: Cyrus and Beck 1978).
///
/// A corner within rounding of the other side's edge is over it, and no crossing is made beside it.
pub(crate) fn overlap(
    (a, side_a): (&Moved<Polytope>, u32),
    (b, side_b): (&Moved<Polytope>, u32),
    normal: DVec3,
) -> Patch {
    let across = any_tangent(normal);
    let frame = [across, normal.cross(across), normal];
    let (outline_a, outline_b) = (Outline::new(a, side_a, frame, 1.0), Outline::new(b, side_b, frame, -1.0));
    let tolerance = 100.0 * ROUNDING * outline_a.size.min(outline_b.size);
    let mut patch = Patch::new();
    let mut add = |x: f64, y: f64, (low, high): (f64, f64), (feature_a, feature_b): (Feature, Feature)| {
        let point = frame[0] * x + frame[1] * y + normal * (0.5 * (low + high));
        let new =
            |contact: &ContactPoint| contact.point.distance_squared(point) > 4.0 * tolerance * tolerance;
        // Where a corner lies on a corner both would be given.
        if patch.contacts().iter().all(new) {
            patch.push(ContactPoint { point, separation: high - low, feature_a, feature_b });
        }
    };
    let (corners_a, corners_b) = (outline_a.corners.items(), outline_b.corners.items());

    for k in 0..corners_b.len() {
        let (from, to) = (corners_b[k], corners_b[(k + 1) % corners_b.len()]);
        // Between these shares of the way it is over the side of a, with the edges where it comes and goes.
        let (mut enters, mut leaves) = ((0.0, None), (1.0, None));
        let mut misses = false;
        for side in corners_a {
            let beyond = |corner: &Corner| side.across.0 * corner.x + side.across.1 * corner.y - side.limit;
            let (here, there) = (beyond(&from), beyond(&to));
            if here > tolerance {
                misses |= there >= -tolerance;
                let share = here / (here - there);
                if share > enters.0 {
                    enters = (share, Some(side.edge));
                }
            } else if there > tolerance && here >= -tolerance {
                leaves = (0.0, None);
            } else if there > tolerance {
                let share = here / (here - there);
                if share < leaves.0 {
                    leaves = (share, Some(side.edge));
                }
            }
        }
        if misses {
            continue;
        }
        if enters.1.is_none()
            && let Some(low) = outline_a.height(from.x, from.y)
        {
            add(from.x, from.y, (low, from.height), (outline_a.feature, Feature::Vertex(from.number)));
        }
        for (share, edge) in [enters, leaves] {
            if let Some(edge) = edge
                && enters.0 < leaves.0
            {
                let between = |from: f64, to: f64| from + (to - from) * share;
                let (x, y) = (between(from.x, to.x), between(from.y, to.y));
                if let Some(low) = outline_a.height(x, y) {
                    let features = (Feature::Edge(edge), Feature::Edge(from.edge));
                    add(x, y, (low, between(from.height, to.height)), features);
                }
            }
        }
    }
    for corner in corners_a {
        let over = |side: &Corner| side.across.0 * corner.x + side.across.1 * corner.y - side.limit;
        if let Some(high) = outline_b.height(corner.x, corner.y)
            && corners_b.iter().all(|side| over(side) <= tolerance)
        {
            let features = (Feature::Vertex(corner.number), outline_b.feature);
            add(corner.x, corner.y, (corner.height, high), features);
        }
    }
    patch
}
