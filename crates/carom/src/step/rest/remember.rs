//! Impulses that go over from the contacts of a pair to those that follow upon them.
//!
//! Which points a manifold has may change from one moment to the next though hardly anything has moved: another edge
//! wins by a hair, another four of eight points are kept. What pressed goes on pressing all the same: the new
//! points start with impulses that push and turn both bodies as the old ones did.

use super::Rest;
use super::owner::keys;
use crate::collide::{ContactPoint, Manifold};
use crate::math::{DMat3, DVec3, any_tangent};
use crate::solver::bundle::{POINTS, field};
use crate::solver::graph::ContactId;
use crate::solver::prepare::{Remembered, middle};
use smallvec::SmallVec;

/// A manifold follows upon one whose normal makes an angle with its own that has at least this cosine.
const ALIKE: f64 = 0.9;

/// Regularises the search for impulses where the points lie in a line or are one.
const ROUNDING: f64 = 1e-6;

/// Heirs that are no further apart than this (m) turn nothing.
const NO_REACH: f64 = 1e-12;

/// What a manifold exerted.
pub(super) struct Past {
    normal: DVec3,
    points: [PastPoint; POINTS],
    count: usize,
    /// Where friction acted, and what it was, N·s.
    middle: DVec3,
    friction: DVec3,
    /// N·m·s
    twist: f64,
}

#[derive(Clone, Copy)]
struct PastPoint {
    /// Keys of what touched.
    features: [u32; 2],
    place: DVec3,
    /// N·s
    pressure: f64,
}

impl Rest {
    /// What a contact exerts on bodies whose centres are at `centers`.
    pub(super) fn past(&self, contact: ContactId, centers: [DVec3; 2]) -> Past {
        let numbers = self.graph.numbers(contact);
        let read = |field: usize| f64::from(numbers(field));
        let vector = |field: usize| DVec3::new(read(field), read(field + 1), read(field + 2));
        let (normal, first) = (vector(field::NORMAL), vector(field::TANGENT));
        let second = normal.cross(first);
        let outward = |v: DVec3| first * v.x + second * v.y + normal * v.z;
        // Both bodies may have moved a little since: half way.
        let place = |arm_a: usize, arm_b: usize| {
            0.5 * (centers[0] + outward(vector(arm_a)) + centers[1] + outward(vector(arm_b)))
        };
        let mut points = [PastPoint::NONE; POINTS];
        let touched = self.owners[contact.index()].touched.features();
        for (index, (point, &features)) in points.iter_mut().zip(touched).enumerate() {
            let at = |line: usize| field::of_point(index, line);
            let place = place(at(field::ARM_A), at(field::ARM_B));
            *point = PastPoint { features, place, pressure: read(at(field::IMPULSE)) };
        }
        Past {
            normal,
            points,
            count: touched.len(),
            middle: place(field::FRICTION_ARM_A, field::FRICTION_ARM_B),
            friction: outward(DVec3::new(read(field::FRICTION), read(field::FRICTION + 1), 0.0)),
            twist: read(field::TWIST),
        }
    }
}

/// The impulses that `manifolds` start from when they follow upon those of the `past`.
pub(super) fn remembered(past: &[Past], manifolds: &[Manifold], margin: f64) -> SmallVec<[Remembered; 2]> {
    let follower = |old: &Past| {
        let shared = |manifold: &Manifold| {
            manifold.points().iter().filter(|point| old.points().iter().any(|it| it.is_of(point))).count()
        };
        let alike = |manifold: &Manifold| old.normal.dot(manifold.normal);
        let rank = |manifold: &Manifold| (shared(manifold), alike(manifold));
        (0..manifolds.len()).filter(|&number| alike(&manifolds[number]) > ALIKE).max_by(|&one, &other| {
            let (one, other) = (rank(&manifolds[one]), rank(&manifolds[other]));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        })
    };
    let followers: SmallVec<[Option<usize>; 4]> = past.iter().map(follower).collect();
    let followed_by = |number: usize| {
        let follows = move |&(_, &follower): &(&Past, &Option<usize>)| follower == Some(number);
        past.iter().zip(&followers).filter(follows).map(|(old, _)| old)
    };
    manifolds
        .iter()
        .enumerate()
        .map(|(number, manifold)| follow(followed_by(number), manifold, margin))
        .collect()
}

impl Past {
    /// Where it pressed.
    fn points(&self) -> &[PastPoint] {
        &self.points[..self.count]
    }
}

impl PastPoint {
    /// Fills the places that hold no point.
    const NONE: PastPoint = PastPoint { features: [0; 2], place: DVec3::ZERO, pressure: 0.0 };

    /// Whether it was the same features that touched.
    fn is_of(&self, point: &ContactPoint) -> bool {
        self.features == keys(point)
    }
}

/// The impulses that push and turn as those of the `past` did, as well as the points of `manifold` can: those of the same
/// features; what has pressed at points that are no more goes to the others.
fn follow<'a>(past: impl Iterator<Item = &'a Past> + Clone, manifold: &Manifold, margin: f64) -> Remembered {
    let points = manifold.points();
    let mut remembered = Remembered::default();
    if past.clone().next().is_none() || points.is_empty() {
        return remembered;
    }
    let normal = manifold.normal;
    let middle = middle(points, margin);
    let mut lost: SmallVec<[(DVec3, f64); POINTS]> = SmallVec::new();
    for old in past.clone().flat_map(Past::points) {
        match points.iter().position(|point| old.is_of(point)) {
            Some(index) => remembered.pressure[index] += old.pressure,
            None => lost.push((old.place, old.pressure)),
        }
    }
    if lost.iter().any(|&(_, pressure)| pressure > 0.0) {
        let touching = points.iter().filter(|point| point.separation <= margin).count();
        let limit = if touching > 0 { margin } else { f64::INFINITY };
        let heirs: SmallVec<[(usize, DVec3); POINTS]> = points
            .iter()
            .enumerate()
            .filter(|(_, point)| point.separation <= limit)
            .map(|(index, point)| (index, point.point - middle))
            .collect();
        lost.iter_mut().for_each(|(place, _)| *place -= middle);
        inherit(&lost, &heirs, normal, &mut remembered.pressure);
    }
    for old in past {
        let friction = old.friction - normal * old.friction.dot(normal);
        remembered.friction += friction;
        remembered.twist += old.twist + normal.dot((old.middle - middle).cross(friction));
    }
    remembered
}

/// Adds to the pressures of the heirs what pushes and turns as what was lost did: the smallest change that does so, as far as points
/// can without pulling; none of the push is lost.
fn inherit(lost: &[(DVec3, f64)], heirs: &[(usize, DVec3)], normal: DVec3, pressure: &mut [f64; POINTS]) {
    let reach = heirs.iter().map(|(_, arm)| arm.length()).fold(0.0, f64::max);
    let scale = if reach > NO_REACH { 1.0 / reach } else { 0.0 };
    let first = any_tangent(normal);
    let second = normal.cross(first);
    // Push, and turn about both tangents, of a unit impulse. What pressed further out than any heir can, counts as if no further.
    let wrench = |arm: DVec3| {
        let arm = (arm * scale).clamp_length_max(1.0);
        DVec3::new(1.0, arm.dot(first), arm.dot(second))
    };
    let lost: DVec3 = lost.iter().map(|&(arm, pressure)| pressure * wrench(arm)).sum();
    let mut response = DMat3::from_diagonal(DVec3::splat(ROUNDING));
    for &(_, arm) in heirs {
        let unit = wrench(arm);
        response += DMat3::from_cols(unit * unit.x, unit * unit.y, unit * unit.z);
    }
    let change = response.inverse() * lost;
    let before: f64 = pressure.iter().sum();
    for &(index, arm) in heirs {
        pressure[index] = (pressure[index] + change.dot(wrench(arm))).max(0.0);
    }
    let after: f64 = pressure.iter().sum();
    if after > 0.0 {
        pressure.iter_mut().for_each(|pressure| *pressure *= (before + lost.x) / after);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [(usize, DVec3); 4] = [
        (0, DVec3::new(0.5, 0.0, 0.5)),
        (1, DVec3::new(-0.5, 0.0, 0.5)),
        (2, DVec3::new(-0.5, 0.0, -0.5)),
        (3, DVec3::new(0.5, 0.0, -0.5)),
    ];

    fn heirs_of(lost: &[(DVec3, f64)], heirs: &[(usize, DVec3)]) -> [f64; POINTS] {
        let mut pressure = [0.0; POINTS];
        inherit(lost, heirs, DVec3::Y, &mut pressure);
        pressure
    }

    #[test]
    fn what_pressed_in_the_middle_goes_to_all_alike() {
        let pressure = heirs_of(&[(DVec3::ZERO, 8.0)], &SQUARE);
        assert!(pressure.iter().all(|it| (it - 2.0).abs() < 1e-5), "{pressure:?}");
    }

    #[test]
    fn push_and_turn_are_kept() {
        let lost = [(DVec3::new(0.2, 0.0, 0.1), 3.0), (DVec3::new(-0.1, 0.0, 0.3), 1.0)];
        let pressure = heirs_of(&lost, &SQUARE);
        let turn = |arm: DVec3, pressure: f64| arm.cross(DVec3::Y * pressure);
        let wanted: DVec3 = lost.iter().map(|&(arm, pressure)| turn(arm, pressure)).sum();
        let found: DVec3 = SQUARE.iter().map(|&(index, arm)| turn(arm, pressure[index])).sum();
        assert!((wanted - found).length() < 1e-5, "{wanted} became {found}");
        assert!((pressure.iter().sum::<f64>() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_pulls_and_nothing_is_lost_where_turns_cannot_be_kept() {
        let pressure = heirs_of(&[(DVec3::new(3.0, 0.0, 0.2), 5.0)], &SQUARE);
        assert!(pressure.iter().all(|&it| it >= 0.0), "{pressure:?}");
        assert!((pressure.iter().sum::<f64>() - 5.0).abs() < 1e-12);
        let one = heirs_of(&[(DVec3::new(0.3, 0.0, 0.2), 5.0)], &[(0, DVec3::ZERO)]);
        assert_eq!(one[1..], [0.0; 3]);
        assert!((one[0] - 5.0).abs() < 1e-12);
    }
}
