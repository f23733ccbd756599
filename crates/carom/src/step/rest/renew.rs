//! Contacts looked at anew: where the bodies have moved, and where a pair has just come to rest.
//!
//! A body's contacts stay as they are while it lies still: what it moves meanwhile is measured from its *anchor*, the pose that
//! it had when they were last renewed. All of them take its inertia as it was then: large impulses that cancel must do so in the
//! angular velocity too. Impulses go over from the old contacts to the new ones (`remember.rs`).

use super::remember::remembered;
use super::{Rest, Span, horizon};
use crate::bodies::{Bodies, ColliderRow};
use crate::collide::Manifold;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::{DMat3, DVec3};
use crate::solver::bundle::Lane;
use crate::solver::prepare::{Remembered, Side, Terms, lane};
use crate::step::pairs::{Pairs, Support};

/// Motion of a body, as a share of its smallest collider's reach or in radians, after which its contacts are renewed.
const DRIFT: f64 = 5e-3;

/// So many pairs looked at are worth sharing out.
const LOOKS: usize = 16;

/// What a pair's contacts are to be: each manifold, and its numbers.
type View = Vec<(Manifold, Lane)>;

impl Rest {
    /// Looks at a pair closely: new geometry, old impulses. A pair that is out of reach rests no more.
    pub(super) fn renew(&mut self, bodies: &Bodies, pairs: &mut Pairs, index: usize, at: (RestLaw, Span)) {
        if let Some(view) = self.look(bodies, pairs, index, at) {
            self.adopt_view(bodies, pairs, index, &view);
        }
    }

    /// The contacts of a pair as they are now, with what the old ones exert.
    fn look(
        &self,
        bodies: &Bodies,
        pairs: &Pairs,
        index: usize,
        (law, span): (RestLaw, Span),
    ) -> Option<View> {
        let pair = &pairs[index];
        let approach = Approach::of(bodies, pair.colliders, law)?;
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
        manifolds.retain(|manifold| !manifold.points().is_empty());

        let terms = Terms { surface: pair.surface, margin, horizon: horizon(pair, grain, law) };
        let centers = [a, b].map(|collider| bodies.center_pose(collider).position);
        let past: Vec<_> = pair.supports.iter().map(|support| self.past(support, centers)).collect();
        let remembered = remembered(&past, &manifolds, margin);
        let lane = |(manifold, remembered): (Manifold, Remembered)| {
            let (normal, at) = (manifold.normal, manifold.points()[0].point);
            let sides = [self.side(bodies, a, (normal, at)), self.side(bodies, b, (-normal, at))];
            let lane = lane(normal, manifold.points(), &sides, &terms, &remembered);
            (manifold, lane)
        };
        Some(manifolds.into_iter().zip(remembered).map(lane).collect())
    }

    /// A body as a contact sees it that touches one of its colliders at a point, where this normal points outward.
    fn side(&self, bodies: &Bodies, collider: &ColliderRow, (outward, point): (DVec3, DVec3)) -> Side {
        let constants = &bodies.constants[collider.row];
        let center = bodies.center_pose(collider);
        let pose = center.then_local(&collider.local);
        let local = (pose.inverse_transform_point(point), pose.rotation.conjugate() * outward);
        Side {
            center: center.position,
            inverse_mass: constants.inverse_mass,
            inverse_inertia: if constants.is_movable() {
                constants.inverse_inertia(self.rows.anchors[collider.row].rotation)
            } else {
                DMat3::ZERO
            },
            drift: self.rows.drift(collider.row),
            roundness: collider.shape.roundness(local.0, local.1),
        }
    }

    /// Puts the contacts of a pair in the place of its old ones.
    fn adopt_view(&mut self, bodies: &Bodies, pairs: &mut Pairs, index: usize, view: &View) {
        let pair = &mut pairs[index];
        let old = std::mem::take(&mut pair.supports);
        let rows = pair.rows.map(|row| row as u32);
        let movable = pair.rows.map(|row| bodies.constants[row].is_movable());
        for (number, (manifold, lane)) in view.iter().enumerate() {
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
        for support in old.iter().skip(view.len()) {
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
        let stale =
            |&index: &usize| pairs[index].rests && pairs[index].rows.into_iter().any(|row| has_moved[row]);
        let stale: Vec<usize> = self.resting.iter().copied().filter(stale).collect();
        let views =
            self.graph.pool().map(&stale, LOOKS, |&index| self.look(bodies, pairs, index, (law, span)));
        for (index, view) in stale.into_iter().zip(views) {
            if let Some(view) = view {
                self.adopt_view(bodies, pairs, index, &view);
            }
        }
        self.resting.retain(|&index| pairs[index].rests);
    }
}
