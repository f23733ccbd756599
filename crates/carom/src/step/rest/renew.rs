//! Contacts looked at anew: where the bodies have moved, and where a pair has just come to rest.
//!
//! A body's contacts stay as they are while it lies still: what it moves meanwhile is measured from its *anchor*, the pose that
//! it had when they were last renewed. Impulses go over from the old contacts to the new ones, by the features that touch.

use super::{Rest, Span, horizon};
use crate::bodies::{Bodies, ColliderRow};
use crate::collide::Manifold;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::{DMat3, DVec3};
use crate::solver::bundle::field;
use crate::solver::prepare::{Remembered, Side, Terms, lane};
use crate::step::pairs::{Pair, Pairs, Support};

/// Motion of a body, as a share of its smallest collider's reach or in radians, after which its contacts are renewed: at
/// the start of a step, and within one.
pub(super) const DRIFT: f64 = 1e-3;
pub(super) const DRIFT_WITHIN: f64 = 2e-2;

impl Rest {
    /// Looks at a pair closely: new geometry, old impulses. A pair that is out of reach rests no more.
    pub(super) fn renew(&mut self, bodies: &Bodies, pair: &mut Pair, (law, span): (RestLaw, Span)) {
        let (Some(a), Some(b)) = (bodies.collider(pair.colliders.0), bodies.collider(pair.colliders.1))
        else {
            return;
        };
        let margin = law.contact_margin();
        let grain = a.reach.min(b.reach);
        let way = |side: usize| {
            let (linear, angular) = bodies.paces[pair.rows[side]];
            linear + angular * pair.spin_reach[side]
        };
        let ahead = ((way(0) + way(1)) * (law.step - span.from)).min(0.2 * grain);
        let approach = Approach::new(bodies, a, b, law);
        let mut manifolds = Vec::new();
        approach.manifolds(span.from, margin + 0.01 * grain + ahead, &mut manifolds);

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
                    constants.inverse_inertia(center.rotation)
                } else {
                    DMat3::ZERO
                },
                drift: self.rows.drift(collider.row),
                roundness: collider.shape.roundness(local.0, local.1),
            }
        };
        let terms = Terms { surface: pair.surface, margin, horizon: horizon(pair, grain, law) };
        let old = std::mem::take(&mut pair.supports);
        let lanes: Vec<_> = manifolds
            .iter()
            .filter(|manifold| !manifold.points().is_empty())
            .map(|manifold| {
                let normal = manifold.normal;
                let at = manifold.points()[0].point;
                let sides = [side(a, normal, at), side(b, -normal, at)];
                let remembered = self.remembered(&old, manifold);
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
            pair.supports.push(Support::new(contact, manifold));
        }
        for support in old.iter().skip(lanes.len()) {
            self.release(support);
        }
        pair.rests = !pair.supports.is_empty();
    }

    /// The impulses of the contacts that a manifold follows upon: point by point where the same features touch, else in equal
    /// parts.
    fn remembered(&self, old: &[Support], manifold: &Manifold) -> Remembered {
        let mut remembered = Remembered::default();
        let mut matched = false;
        for (entry, point) in remembered.pressure.iter_mut().zip(manifold.points()) {
            let features = (point.feature_a, point.feature_b);
            for support in old {
                if let Some(index) = support.features().iter().position(|&it| it == features) {
                    *entry =
                        f64::from(self.graph.get(support.contact, field::of_point(index, field::IMPULSE)));
                    matched = true;
                    break;
                }
            }
        }
        let alike = old.iter().max_by(|x, y| {
            let likeness = |support: &Support| support.normal.dot(manifold.normal);
            likeness(x).total_cmp(&likeness(y))
        });
        let Some(support) = alike.filter(|support| support.normal.dot(manifold.normal) > 0.9) else {
            return remembered;
        };
        let read = |field: usize| f64::from(self.graph.get(support.contact, field));
        let axis = |field: usize| DVec3::new(read(field), read(field + 1), read(field + 2));
        let (first, normal) = (axis(field::TANGENT), axis(field::NORMAL));
        remembered.friction = first * read(field::FRICTION) + normal.cross(first) * read(field::FRICTION + 1);
        remembered.twist = read(field::TWIST);
        if !matched {
            let count = support.features().len();
            let total: f64 = (0..count).map(|index| read(field::of_point(index, field::IMPULSE))).sum();
            let points = manifold.points().len();
            remembered.pressure[..points].fill(total / points as f64);
        }
        remembered
    }

    /// Renews the contacts of the bodies that have moved further than `limit` from their anchors.
    pub(super) fn renew_moved(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        held: &[usize],
        (law, span, limit): (RestLaw, Span, f64),
    ) {
        let mut has_moved = vec![false; bodies.states.len()];
        for &row in held {
            if self.rows.read_drift(bodies, row, bodies.grains[row]) > limit {
                has_moved[row] = true;
                self.rows.anchor(bodies, row);
            }
        }
        for index in 0..self.resting.len() {
            let pair = &mut pairs[self.resting[index]];
            if pair.rests && pair.rows.into_iter().any(|row| has_moved[row]) {
                self.renew(bodies, pair, (law, span));
            }
        }
        self.resting.retain(|&index| pairs[index].rests);
    }
}
