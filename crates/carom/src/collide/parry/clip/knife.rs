//! The knife: an outline that others are cut to.

use super::super::convex::{CORNERS, Corner};
use super::FEW;
use crate::math::DVec3;
use crate::report::Feature;

/// What the side of an outline being cut is: one of its own, or a cut along one of the other's.
#[derive(Clone, Copy)]
pub(super) enum Side {
    Own(Feature),
    Cut { edge: Feature, from: Feature },
}

/// A corner of the outline being cut: its place in the plane across the normal, its height along it.
#[derive(Clone, Copy)]
pub(super) struct Cut {
    pub x: f64,
    pub y: f64,
    pub height: f64,
    pub own: Feature,
    pub other: Feature,
    pub onward: Side,
}

/// The outline being cut, and room for a cut.
pub(super) struct Room {
    pub shape: Vec<Cut>,
    /// What a cut leaves of it.
    left: Vec<Cut>,
    /// How deep inside the side that cuts its corners lie, m.
    depths: Vec<f64>,
}

impl Default for Room {
    fn default() -> Self {
        Self::NONE
    }
}

impl Room {
    pub const NONE: Room = Room { shape: Vec::new(), left: Vec::new(), depths: Vec::new() };

    /// For another outline.
    pub fn clear(&mut self) {
        self.shape.clear();
        self.left.clear();
        self.shape.reserve(FEW);
        self.left.reserve(FEW);
    }
}

/// The outline that cuts: its sides in the plane across the normal, its own plane in space.
pub(super) struct Knife {
    places: [(f64, f64, f64); CORNERS],
    count: usize,
    /// 1 if the sides run anticlockwise seen against the normal, else −1.
    turn: f64,
    /// height = slope·(x, y) + offset.
    slope: (f64, f64),
    offset: f64,
    /// Points this far outside, m, count as inside.
    tolerance: f64,
}

impl Knife {
    /// `None` if there is no area, or it is seen edge on (the heights would be all rounding).
    pub fn new(corners: &[Corner], flat: impl Fn(&Corner) -> (f64, f64, f64)) -> Option<Self> {
        if corners.len() < 3 {
            return None;
        }
        let count = corners.len();
        let mut points = [(0.0, 0.0, 0.0); CORNERS];
        points.iter_mut().zip(corners).for_each(|(point, corner)| *point = flat(corner));
        let origin = points[0];
        let from_origin = |k: usize| {
            let (x, y, height) = points[k];
            DVec3::new(x - origin.0, y - origin.1, height - origin.2)
        };
        // Twice the area, as a vector (Newell).
        let area: DVec3 = (1..count - 1).map(|k| from_origin(k).cross(from_origin(k + 1))).sum();
        if area.z.abs() <= 0.05 * area.length() {
            return None;
        }
        let slope = (-area.x / area.z, -area.y / area.z);
        let offset = origin.2 - slope.0 * origin.0 - slope.1 * origin.1;
        let extent = (1..count).map(|k| from_origin(k).length_squared()).fold(0.0, f64::max).sqrt();
        Some(Self { places: points, count, turn: area.z.signum(), slope, offset, tolerance: 1e-9 * extent })
    }

    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.slope.0 * x + self.slope.1 * y + self.offset
    }

    /// Cuts an outline, the inside of which is `face`, to the knife, whose corners these are.
    pub fn cut_all(&self, room: &mut Room, corners: &[Corner], face: Feature) {
        for k in 0..corners.len() {
            if self.cut(room, k, corners, face) {
                std::mem::swap(&mut room.shape, &mut room.left);
            }
        }
    }

    /// Leaves what of the outline lies inside the knife's side `k`; false if that is all of it.
    fn cut(&self, room: &mut Room, k: usize, corners: &[Corner], face: Feature) -> bool {
        let Room { shape, left, depths } = room;
        let (from, to) = (self.places[k], self.places[(k + 1) % self.count]);
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = (dx * dx + dy * dy).sqrt();
        if length == 0.0 {
            return false;
        }
        let inside = |cut: &Cut| self.turn * (dx * (cut.y - from.1) - dy * (cut.x - from.0)) / length;
        let keeps = |depth: f64| depth >= -self.tolerance;
        depths.clear();
        depths.extend(shape.iter().map(inside));
        if depths.iter().all(|&depth| keeps(depth)) {
            return false;
        }
        left.clear();
        for (i, here) in shape.iter().enumerate() {
            let onto = if i + 1 < shape.len() { i + 1 } else { 0 };
            let (next, depth_here, depth_next) = (&shape[onto], depths[i], depths[onto]);
            if keeps(depth_here) {
                left.push(*here);
            }
            if keeps(depth_here) == keeps(depth_next) {
                continue;
            }
            let part = (depth_here / (depth_here - depth_next)).clamp(0.0, 1.0);
            let between = |one: f64, other: f64| one + part * (other - one);
            let (own, other) = match here.onward {
                Side::Own(edge) => (edge, corners[k].edge),
                // Two cuts meet where the knife has a corner.
                Side::Cut { edge, from } if edge == corners[k].edge => (face, from),
                Side::Cut { .. } => (face, corners[k].vertex),
            };
            // Going out, the way goes on along the knife; coming in, along what it came by.
            let onward = if keeps(depth_here) {
                Side::Cut { edge: corners[k].edge, from: corners[k].vertex }
            } else {
                here.onward
            };
            left.push(Cut {
                x: between(here.x, next.x),
                y: between(here.y, next.y),
                height: between(here.height, next.height),
                own,
                other,
                onward,
            });
        }
        true
    }
}
