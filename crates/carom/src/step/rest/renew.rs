//! Contacts looked at anew: where the bodies have moved, and where a pair has just come to rest.
//!
//! A body's contacts stay as they are while it lies still: what it moves meanwhile is measured from its *anchor*, the pose that
//! it had when they were last renewed. All of them take its inertia as it was then: large impulses that cancel must do so in the
//! angular velocity too. Impulses go over from the old contacts to the new ones (`remember.rs`).

use super::remember::remembered;
use super::{Rest, Span, horizon};
use crate::bodies::{Bodies, ColliderRow};
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::{DMat3, DVec3};
use crate::solver::prepare::{Side, Terms, lane};
use crate::step::pairs::{Pairs, Support};

/// Motion of a body, as a share of its smallest collider's reach or in radians, after which its contacts are renewed.
const DRIFT: f64 = 5e-3;

impl Rest {
    /// Looks at a pair closely: new geometry, old impulses. A pair that is out of reach rests no more.
    pub(super) fn renew(
        &mut self,
        bodies: &Bodies,
        pairs: &mut Pairs,
        index: usize,
        (law, span): (RestLaw, Span),
    ) {
        let pair = &pairs[index];
        let Some(approach) = Approach::of(bodies, pair.colliders, law) else { return };
        let [a, b] = approach.colliders();
        let margin = law.contact_margin();
        let grain = a.reach.min(b.reach);
        let way = |side: usize| {
            let (linear, angular) = bodies.paces[pair.rows[side]];
            linear + angular * pair.spin_reach[side]
        };
        let ahead = ((way(0) + way(1)) * (law.step - span.from)).min(0.2 * grain);
        let mut manifolds = Vec::new();
        approach.manifolds(pairs, span.from, margin + 0.01 * grain + ahead, &mut manifolds);
        let pair = &mut pairs[index];

        let side = |collider: &ColliderRow, outward: DVec3, point: DVec3| {
            let constants = &bodies.constants[collider.row];
            let center = bodies.center_pose(collider);
            let pose = center.then_local(&collider.local);
            let local = (pose.inverse_transform_point(point), pose.rotation.conjugate() * outward);
            let movable = constants.is_movable();
            Side {
                center: center.position,
                inverse_mass: constants.inverse_mass,
                inverse_inertia: if movable {
                    constants.inverse_inertia(self.rows.anchors[collider.row].rotation)
                } else {
                    DMat3::ZERO
                },
                drift: self.rows.drift(collider.row),
                roundness: collider.shape.roundness(local.0, local.1),
            }
        };
        let terms = Terms { surface: pair.surface, margin, horizon: horizon(pair, grain, law) };
        let old = std::mem::take(&mut pair.supports);
        manifolds.retain(|manifold| !manifold.points().is_empty());
        let centers = [a, b].map(|collider| bodies.center_pose(collider).position);
        let past: Vec<_> = old.iter().map(|support| self.past(support, centers)).collect();
        let lanes: Vec<_> = manifolds
            .iter()
            .zip(remembered(&past, &manifolds, margin))
            .map(|(manifold, remembered)| {
                let normal = manifold.normal;
                let at = manifold.points()[0].point;
                let sides = [side(a, normal, at), side(b, -normal, at)];
                (manifold, lane(normal, manifold.points(), &sides, &terms, &remembered))
            })
            .collect();
        let rows = pair.rows.map(|row| row as u32);
        let movable = pair.rows.map(|row| bodies.constants[row].is_movable());
        for (number, (manifold, lane)) in lanes.iter().enumerate() {
            let contact = match old.get(number) {
                Some(support) => {
                    self.graph.write(support.contact, lane);
                    support.contact
                }
                None => {
                    pair.rows.into_iter().for_each(|row| self.rows.hold(row));
                    self.graph.insert(rows, movable, lane)
                }
            };
            self.bounces.resize(self.bounces.len().max(contact.index() + 1), false);
            self.bounces[contact.index()] = pair.surface.restitution > 0.0;
            pair.supports.push(Support::new(contact, manifold));
        }
        for support in old.iter().skip(lanes.len()) {
            self.release(support);
        }
        pair.rests = !pair.supports.is_empty();
    }

    /// Renews the contacts of the bodies that have moved too far from their anchors.
    pub(super) fn renew_moved(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        held: &[usize],
        (law, span): (RestLaw, Span),
    ) {
        let mut has_moved = vec![false; bodies.states.len()];
        for &row in held {
            if self.rows.read_drift(bodies, row, bodies.grains[row]) > DRIFT {
                has_moved[row] = true;
                self.rows.anchor(bodies, row);
            }
        }
        for index in 0..self.resting.len() {
            let number = self.resting[index];
            let pair = &pairs[number];
            if pair.rests && pair.rows.into_iter().any(|row| has_moved[row]) {
                self.renew(bodies, pairs, number, (law, span));
            }
        }
        self.resting.retain(|&index| pairs[index].rests);
    }
}
