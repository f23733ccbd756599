//! Impulses that go over from the contacts of a pair to those that follow upon them.
//!
//! Which points a manifold has may change from one moment to the next though hardly anything has moved: another edge
//! wins by a hair, another four of eight points are kept. What pressed goes on pressing all the same: the new
//! points start with impulses that push and turn both bodies as the old ones did.

use super::owner::{Features, Touched};
use super::{FEW, Rest};
use crate::collide::Manifold;
use crate::math::{DMat3, DVec3, any_tangent};
use crate::solver::bundle::{POINTS, field};
use crate::solver::graph::{ContactId, Numbers};
use crate::solver::prepare::{Remembered, middle};
use smallvec::SmallVec;

/// A manifold follows upon one whose normal makes an angle with its own that has at least this cosine.
const ALIKE: f64 = 0.9;

/// Regularises the search for impulses where the points lie in a line or are one.
const ROUNDING: f64 = 1e-6;

/// Heirs that are no further apart than this (m) turn nothing.
const NO_REACH: f64 = 1e-12;

/// What the contacts of a pair exerted, each with the number of the manifold that follows upon it.
pub(super) struct Legacy<'a> {
    past: SmallVec<[(Past<'a>, Option<usize>); FEW]>,
    /// Where the bodies' centres are.
    centers: [DVec3; 2],
}

/// What a contact exerted.
struct Past<'a> {
    numbers: Numbers<'a>,
    /// What touched at each point.
    features: &'a [Features],
}

impl Rest {
    /// What contacts leave to the manifolds that follow upon them, with what touches in these; the centres of the bodies are at
    /// `centers`.
    pub(super) fn legacy(
        &self,
        contacts: &[ContactId],
        centers: [DVec3; 2],
        manifolds: &[Manifold],
        touched: &[Touched],
    ) -> Legacy<'_> {
        let past = contacts.iter().map(|&contact| {
            let features = self.owners[contact.index()].touched.features();
            let past = Past { numbers: self.graph.numbers(contact), features };
            let follower = past.follower(manifolds, touched);
            (past, follower)
        });
        Legacy { past: past.collect(), centers }
    }
}

impl Legacy<'_> {
    /// The impulses that a manifold starts from: those that push and turn as those upon which it follows did, as well as its points
    /// can. Points of the same features have the same; what has pressed at points that are no more goes to the others.
    pub fn left_to(&self, number: usize, manifold: &Manifold, touched: &Touched, margin: f64) -> Remembered {
        let past =
            || self.past.iter().filter(|(_, follower)| *follower == Some(number)).map(|(past, _)| past);
        let points = manifold.points();
        let mut remembered = Remembered::default();
        if past().next().is_none() || points.is_empty() {
            return remembered;
        }
        let normal = manifold.normal;
        let middle = middle(points, margin);
        let mut lost: SmallVec<[(DVec3, f64); POINTS]> = SmallVec::new();
        for old in past() {
            for (index, features) in old.features.iter().enumerate() {
                let pressure = old.pressure(index);
                match touched.features().iter().position(|it| it == features) {
                    Some(heir) => remembered.pressure[heir] += pressure,
                    None => lost.push((old.place(index, self.centers) - middle, pressure)),
                }
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
            inherit(&lost, &heirs, normal, &mut remembered.pressure);
        }
        for old in past() {
            let friction = old.friction();
            let friction = friction - normal * friction.dot(normal);
            remembered.friction += friction;
            remembered.twist += old.twist() + normal.dot((old.middle(self.centers) - middle).cross(friction));
        }
        remembered
    }
}

impl Past<'_> {
    /// Of the manifolds whose normals are alike the one with most of its points, and of those the one whose normal is most so.
    fn follower(&self, manifolds: &[Manifold], touched: &[Touched]) -> Option<usize> {
        let normal = self.numbers.vector(field::NORMAL);
        let mut best: Option<(usize, usize, f64)> = None;
        for (number, (manifold, touched)) in manifolds.iter().zip(touched).enumerate() {
            let alike = normal.dot(manifold.normal);
            if alike > ALIKE {
                let shared = touched.features().iter().filter(|it| self.features.contains(it)).count();
                let is_better = |&(_, most, closest): &(usize, usize, f64)| {
                    shared.cmp(&most).then(alike.total_cmp(&closest)).is_ge()
                };
                if best.as_ref().is_none_or(is_better) {
                    best = Some((number, shared, alike));
                }
            }
        }
        best.map(|(number, ..)| number)
    }

    /// A vector of the contact's frame in the world.
    fn outward(&self, v: DVec3) -> DVec3 {
        let (normal, first) = (self.numbers.vector(field::NORMAL), self.numbers.vector(field::TANGENT));
        first * v.x + normal.cross(first) * v.y + normal * v.z
    }

    /// Where it pressed at a point, but for how far that is along the normal from where friction acted.
    fn place(&self, point: usize, centers: [DVec3; 2]) -> DVec3 {
        let line = field::of_point(point, field::LEVER);
        let [first, second] = [line, line + 1].map(|field| self.numbers.get(field));
        self.middle(centers) + self.outward(DVec3::new(first, second, 0.0))
    }

    /// How it pressed there, N·s.
    fn pressure(&self, point: usize) -> f64 {
        self.numbers.get(field::of_point(point, field::IMPULSE))
    }

    /// Where friction acted, by both arms. Both bodies may have moved a little since: half way.
    fn middle(&self, centers: [DVec3; 2]) -> DVec3 {
        let arms = [field::FRICTION_ARM_A, field::FRICTION_ARM_B];
        let [a, b] = arms.map(|arm| self.outward(self.numbers.vector(arm)));
        0.5 * (centers[0] + a + centers[1] + b)
    }

    /// What it was, N·s.
    fn friction(&self) -> DVec3 {
        let [first, second] = [field::FRICTION, field::FRICTION + 1].map(|field| self.numbers.get(field));
        self.outward(DVec3::new(first, second, 0.0))
    }

    /// N·m·s
    fn twist(&self) -> f64 {
        self.numbers.get(field::TWIST)
    }
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
