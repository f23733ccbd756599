//! Seams: contacts that another contact makes idle.
//!
//! A box that slides over flush tiles overlaps each new one by rounding, first at its side: the shortest way out leads back.
//! But the box rests on the tile that it comes from, and the plane of that contact has all of the new tile on its far
//! side as well. So long as the one contact holds, the other has nothing to do:
//!
//! > A contact of a shape with `Y` is idle if the plane of its contact with `Z` has `Y` on its far side too, while the plane of
//! > the contact with `Y` cuts through `Z`.
//!
//! The second half keeps both contacts where both are right, as on a ridge, and the idle one never makes the other one idle in
//! turn. What rises over the plane of `Z`, be it a step or a slope, is struck. Tiles that differ in height by less than the
//! overlap that contacts leave as it is are flush.
//!
//! Where a ramp begins at a seam, a box that comes over the floor meets the ramp's edge, and any normal between those of its end and
//! of its upper side would do. The end is behind the floor. So a contact is left out as well if another side of `Y` faces more
//! the way of the contact with `Z`, and the shape is beyond that side: a moment later that side is the shortest way out.
//!
//! What comes out of the plane of the contact with `Z` faster than the rest threshold is struck all the same.
//!
//! The shape may be that of a body that slides over others, or the ground under a body of several colliders.

use super::time_of_impact::Approach;
use crate::bodies::{ColliderRow, Outline, Record, WORLD_ROW};
use crate::collide::{self, ContactPoint, Manifold, Wanted, lies_beyond_a_side};
use crate::math::{DVec3, Pose};
use crate::shape::Shape;
use crate::step::pairs::Pairs;
use smallvec::SmallVec;
use std::cmp::Ordering;

/// Tiles may be so far apart, as a share of the reach of what slides over them.
const GAP: f64 = 0.01;

/// What tiles differ in height by may be no more than this share of the smaller reach, however much overlap contacts leave.
const STEP: f64 = 1e-3;

/// What cuts through a plane reaches beyond it by this share of the reach.
const ROUNDING: f64 = 1e-7;

/// Normals whose cosine is above this are the same, but for rounding and roundness. Such a contact may hold up what the other
/// does not: it only takes the other's normal, unless it is the same touch again, and then the nearer one counts.
const ALIKE: f64 = 1.0 - 1e-7;

/// Separations that differ by less than this share of the reach are the same.
const LEVEL: f64 = 1e-9;

/// Separations are at most so much smaller than distances, as a share of the reach.
const SLACK: f64 = 1e-6;

/// A side faces more some way than another if its cosine is greater by this.
const MORE: f64 = 0.01;

/// Contacts so near each other, as a share of the reach, are at the same place.
const SAME_PLACE: f64 = 1e-2;

/// A collider that shares one of an approach's two.
struct Beside {
    other: u32,
    /// Whether it is the first of the approach that is shared.
    shares_first: bool,
    /// Of their contacts, once somebody has asked.
    planes: Option<Vec<Plane>>,
}

/// Where another collider touches what is shared.
struct Plane {
    /// From the other to what is shared.
    normal: DVec3,
    /// On the other's surface.
    place: DVec3,
    /// m
    separation: f64,
}

/// Where a manifold's surfaces are nearest.
struct Place {
    point: DVec3,
    /// How much further away than its contacts another collider may be, m.
    room: f64,
}

impl Place {
    fn of(manifold: &Manifold) -> Option<Self> {
        let contact = manifold.points().iter().min_by(nearest)?;
        Some(Self { point: contact.point, room: 1.5 * contact.separation.abs() })
    }
}

/// A ball, relative to the approach's origin.
struct Ball {
    center: DVec3,
    /// m
    radius: f64,
}

/// Takes out of the manifolds of `approach` at a time, found with a margin (m), those that contacts of other pairs make idle.
/// All places are relative to the approach's origin. Returns whether there is anything that could have done so.
pub(super) fn leave_out_idle(
    approach: &Approach,
    pairs: &Pairs,
    (time, margin): (f64, f64),
    manifolds: &mut Vec<Manifold>,
) -> bool {
    if manifolds.is_empty() || is_seamless(approach) {
        return false;
    }
    let seam = Seam { approach, time, margin };
    let mut beside = seam.beside(pairs, manifolds);
    manifolds.retain_mut(|manifold| beside.iter_mut().all(|beside| seam.holds(manifold, beside)));
    !beside.is_empty()
}

/// Whether two balls meet, of bodies that have no other collider: their normal leads from centre to centre, whatever is beside them.
fn is_seamless(approach: &Approach) -> bool {
    [approach.a, approach.b].into_iter().all(|collider| {
        let is_single = |record: &Record| record.colliders.len() == 1;
        matches!(collider.shape, Shape::Sphere { .. })
            && approach.bodies.record(collider.slot).is_some_and(is_single)
    })
}

/// A question about manifolds of an approach.
struct Seam<'a> {
    approach: &'a Approach<'a>,
    time: f64,
    margin: f64,
}

impl Seam<'_> {
    /// The other colliders that share one of the approach's with it and come near one of its contacts: each one's neighbours, and the
    /// other colliders of its body that have the same neighbour.
    fn beside(&self, pairs: &Pairs, manifolds: &[Manifold]) -> Vec<Beside> {
        let approach = self.approach;
        let (a, b) = approach.keys;
        let bodies = approach.bodies;
        let rows = [approach.a.row, approach.b.row];
        let places: SmallVec<[Place; 4]> = manifolds.iter().filter_map(Place::of).collect();
        let Some(around) = self.ball_around(&places) else { return Vec::new() };
        let mut found: Vec<Beside> = Vec::new();
        for row in rows.into_iter().filter(|&row| row != WORLD_ROW && bodies.constants[row].is_movable()) {
            for (neighbor, index) in pairs.each_of_row(row) {
                // Whoever is neither of the two is the other one of its pair, or of none that matters.
                if neighbor != a && neighbor != b && self.is_far(neighbor, &around) {
                    continue;
                }
                let pair = &pairs[index];
                let (first, second) = pair.colliders;
                let (shares_first, shares_second) = (first == a || second == a, first == b || second == b);
                if shares_first == shares_second {
                    continue;
                }
                let shared = if shares_first { a } else { b };
                let other = if first == shared { second } else { first };
                let is_far = other != neighbor && self.is_far(other, &around);
                if is_far || !self.comes_near(other, shares_first, &places) {
                    continue;
                }
                let may_touch =
                    || pairs.least_separation(bodies, index, self.time) <= self.margin + approach.flush();
                if !pair.sensor
                    && (pair.rests || may_touch())
                    && !found.iter().any(|beside| beside.other == other)
                {
                    found.push(Beside { other, shares_first, planes: None });
                }
            }
        }
        found
    }

    /// A ball that whatever comes near one of these places comes into, with the share of its own reach that tiles may be apart.
    fn ball_around(&self, places: &[Place]) -> Option<Ball> {
        let (smaller, center) = (self.approach.a.reach.min(self.approach.b.reach), places.first()?.point);
        let far = |place: &Place| place.point.distance(center) + place.room;
        let farthest = places.iter().map(far).fold(0.0, f64::max);
        Some(Ball { center, radius: (1.0 + SLACK) * (farthest + GAP * smaller) })
    }

    /// Whether a collider is outside that ball, however its body has flown since its own time: most are.
    #[inline]
    fn is_far(&self, other: u32, ball: &Ball) -> bool {
        let bodies = self.approach.bodies;
        let &Outline { row, reach, .. } = bodies.outline(other);
        let row = row as usize;
        let flown = bodies.paces[row].0 * (self.time - bodies.clocks[row]).abs();
        let far = (1.0 + GAP + 2.0 * SLACK) * reach + ball.radius + flown;
        let center = bodies.states[row].position - self.approach.origin;
        center.distance_squared(ball.center) > far * far && row != WORLD_ROW
    }

    /// Whether a collider may come so near one of these places that it can make its contact idle.
    fn comes_near(&self, other: u32, shares_first: bool, places: &[Place]) -> bool {
        let Some(other) = self.approach.bodies.collider(other) else { return false };
        let center = self.approach.center_at(other, self.time);
        let own_reach = (1.0 + SLACK) * other.reach;
        let comes_within = |reach: f64, place: &Place| {
            let far = own_reach + GAP * reach + place.room;
            center.distance_squared(place.point) <= far * far
        };
        let most = self.sides(shares_first).0.reach;
        // Most are so far away that it does not matter what is small against them.
        places
            .iter()
            .any(|place| comes_within(most, place) && comes_within(self.reach(other, shares_first), place))
    }

    /// What is small against it is small for the three: the two of the approach, one of which is shared, and the `other` one.
    fn reach(&self, other: &ColliderRow, shares_first: bool) -> f64 {
        let (shared, own) = self.sides(shares_first);
        shared.reach.min(own.reach.max(other.reach))
    }

    /// The collider of the approach that is shared, and the one that is not.
    fn sides(&self, shares_first: bool) -> (&ColliderRow, &ColliderRow) {
        let (a, b) = (self.approach.a, self.approach.b);
        if shares_first { (a, b) } else { (b, a) }
    }

    /// Whether what is `beside` leaves a manifold to do something; where it does, their normals are made the same if they are
    /// alike.
    fn holds(&self, manifold: &mut Manifold, beside: &mut Beside) -> bool {
        let approach = self.approach;
        let (shared, own) = self.sides(beside.shares_first);
        let sign = if beside.shares_first { -1.0 } else { 1.0 };
        let Some(other) = approach.bodies.collider(beside.other) else { return true };
        let Some(contact) = manifold.points().iter().min_by(nearest) else { return true };
        let reach = self.reach(other, beside.shares_first);
        let normal = sign * manifold.normal;
        let place = contact.point - 0.5 * contact.separation * normal;
        if !self.meets_ball(other, place, GAP * reach + contact.separation.max(0.0)) {
            return true;
        }
        let rises = |collider: &ColliderRow, place: DVec3, normal: DVec3, by: f64| {
            self.meets_ball(collider, place + (reach + by) * normal, reach)
        };
        let is_single = manifold.points().len() == 1;
        let planes =
            beside.planes.get_or_insert_with(|| self.planes(beside.other, beside.shares_first)).as_slice();
        for plane in planes {
            let depth = (plane.place - place).dot(plane.normal);
            if depth > approach.flush() - plane.separation.min(0.0)
                || rises(own, place + depth * plane.normal, plane.normal, approach.flush())
                || self.comes_out(own, other, (place, plane))
            {
                continue;
            }
            if normal.dot(plane.normal) <= ALIKE {
                if rises(other, place, normal, ROUNDING * reach) {
                    return false;
                }
            } else if is_single && place.distance(plane.place) < SAME_PLACE * reach {
                let nearer = contact.separation - plane.separation;
                let is_first = (own.slot, own.index) < (other.slot, other.index);
                let level = LEVEL * reach;
                if nearer > level || (nearer >= -level && !is_first) {
                    return false;
                }
            } else {
                manifold.normal = sign * plane.normal;
                return true;
            }
        }
        !self.has_better_side(own, shared, planes, (place, normal))
    }

    /// Whether a collider comes out at a place of the plane of a contact with another one, faster than the rest threshold.
    fn comes_out(&self, own: &ColliderRow, other: &ColliderRow, (place, plane): (DVec3, &Plane)) -> bool {
        let velocity = |collider: &ColliderRow| {
            let (center, velocity) = self.approach.motion(collider, self.time);
            velocity.at(place + self.approach.origin - center)
        };
        own.row != other.row
            && (velocity(own) - velocity(other)).dot(plane.normal) > self.approach.law.rest_speed()
    }

    /// Whether a side of `own` that faces more the way of another collider's contact than `normal` has `shared` beyond it.
    fn has_better_side(
        &self,
        own: &ColliderRow,
        shared: &ColliderRow,
        planes: &[Plane],
        (place, normal): (DVec3, DVec3),
    ) -> bool {
        let pose = |collider: &ColliderRow| self.approach.pose_at(collider, self.time);
        let (own_pose, shared_pose) = (pose(own), pose(shared));
        planes.iter().any(|plane| {
            let room = self.approach.flush() - plane.separation.min(0.0);
            let cosine = normal.dot(plane.normal) + MORE;
            let wanted = Wanted { place, way: plane.normal, cosine, room };
            (plane.place - place).dot(plane.normal).abs() <= room
                && lies_beyond_a_side((&own.shape, &own_pose), (&shared.shape, &shared_pose), wanted)
        })
    }

    /// Whether a collider comes into a ball.
    fn meets_ball(&self, collider: &ColliderRow, center: DVec3, radius: f64) -> bool {
        let body = self.approach.center_at(collider, self.time);
        if body.distance(center) > radius + (1.0 + SLACK) * collider.reach {
            return false;
        }
        let (ball, there) = (Shape::Sphere { radius }, Pose { position: center, ..Pose::IDENTITY });
        let pose = self.approach.pose_at(collider, self.time);
        collide::separation(&ball, &there, &collider.shape, &pose) <= 0.0
    }

    /// The planes of the contacts of another collider with the one that it shares.
    fn planes(&self, other: u32, shares_first: bool) -> Vec<Plane> {
        let (a, b) = self.approach.keys;
        let shared = if shares_first { a } else { b };
        let between = Approach::of(self.approach.bodies, (other, shared), self.approach.law);
        let Some(mut between) = between else { return Vec::new() };
        between.origin = self.approach.origin;
        let mut manifolds = Vec::new();
        between.local_manifolds(self.time, self.margin + self.approach.flush(), &mut manifolds);
        let plane = |manifold: &Manifold| {
            let contact = manifold.points().iter().min_by(nearest)?;
            let place = contact.point - 0.5 * contact.separation * manifold.normal;
            Some(Plane { normal: manifold.normal, place, separation: contact.separation })
        };
        manifolds.iter().filter_map(plane).collect()
    }
}

fn nearest(one: &&ContactPoint, two: &&ContactPoint) -> Ordering {
    one.separation.total_cmp(&two.separation)
}

impl Approach<'_> {
    /// How far one of two flush tiles may be above the other, m.
    fn flush(&self) -> f64 {
        self.law.overlap_left().min(STEP * self.a.reach.min(self.b.reach)) + self.tolerance()
    }
}
