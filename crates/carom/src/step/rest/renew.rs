//! Contacts looked at anew: where the bodies have moved, and where a pair has just come to rest.
//!
//! A body's contacts stay as they are while it lies still: what it moves meanwhile is measured from its *anchor*, the pose that
//! it had when they were last renewed. All of them take its inertia as it was then: large impulses that cancel must do so in the
//! angular velocity too. Impulses go over from the old contacts to the new ones (`remember.rs`).

use super::crowds::reach_in_crowd;
use super::owner::{Manner, Owner, Touched};
use super::work::fill;
use super::{FEW, Few, Rest, Span, horizon};
use crate::bodies::{Bodies, ColliderRow};
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::DMat3;
use crate::room::Room;
use crate::solver::bundle::{Lane, NO_CONTACT, field};
use crate::solver::graph::ContactId;
use crate::solver::prepare::{Side, Terms, fill_lane};
use crate::step::pairs::Pairs;
use crate::step::profile::{self, Phase};
use smallvec::SmallVec;

/// Motion of a body, as a share of its smallest collider's reach or in radians, after which its contacts are renewed: of one that lies or
/// moves slowly. What a fast one does within a step may add up before, to the second at most; they are looked at closely again as it
/// comes to rest.
const DRIFT: f64 = 5e-3;
const FAST_DRIFT: f64 = 3e-2;

/// In a crowd what counts is how far bodies move against each other; so far they may move together.
const TOGETHER: f64 = 0.5;

/// So many pairs looked at are worth sharing out.
const LOOKS: usize = 16;

/// So many are looked at before their contacts are put in place: what waits for that has to be kept meanwhile.
const AT_ONCE: usize = 512;

/// What a pair's contacts are to be.
struct View {
    /// What touches in each, and its numbers.
    contacts: Vec<(Touched, Lane)>,
    manner: Manner,
    /// Whether they see to all of its points.
    is_pressed: bool,
}

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
        let is_pressed = self.crowds.press(bodies, pair, law);
        let reach = if is_pressed {
            margin + reach_in_crowd(bodies, pair, law.step - span.from)
        } else {
            let spin_reaches = pair.spin_reaches(bodies);
            let way = |side: usize| {
                let (linear, angular) = bodies.paces[pair.rows()[side]];
                linear + angular * spin_reaches[side]
            };
            let ahead = ((way(0) + way(1)) * law.substep).min(0.2 * grain);
            margin + 0.01 * grain + ahead
        };
        let mut manifolds = Vec::new();
        approach.manifolds(pairs, span.from, reach, &mut manifolds);
        manifolds.retain(|manifold| !manifold.points().is_empty());

        let terms =
            Terms { surface: pair.surface(bodies), margin, horizon: horizon(pair, grain, law), is_pressed };
        let centers = [bodies.center_pose(a).position, bodies.center_pose(b).position];
        let old: Few = self.contacts(pair).collect();
        let touched: SmallVec<[Touched; FEW]> = manifolds.iter().map(Touched::of).collect();
        let legacy = self.legacy(&old, centers, &manifolds, &touched);
        let mut sides = [self.side(bodies, a), self.side(bodies, b)];
        let pose = |collider: &ColliderRow| bodies.center_pose(collider).then_local(&collider.local);
        let poses = [pose(a), pose(b)];
        // Filled where they stand: they are too large to be handed on.
        let mut contacts = vec![(Touched::NOTHING, NO_CONTACT); manifolds.len()];
        for (number, ((contact, lane), manifold)) in contacts.iter_mut().zip(&manifolds).enumerate() {
            let (normal, points) = (manifold.normal, manifold.points());
            for (side, (collider, outward)) in [(a, normal), (b, -normal)].into_iter().enumerate() {
                let pose = &poses[side];
                let place = pose.inverse_transform_point(points[0].point);
                sides[side].roundness = collider.shape.roundness(place, pose.rotation.conjugate() * outward);
            }
            *contact = touched[number];
            let remembered = legacy.left_to(number, manifold, contact, margin);
            fill_lane(lane, (normal, points), &sides, &terms, &remembered);
        }
        let manner = Manner { bounces: pair.bounces, rubs: terms.surface.static_friction > 0.0 };
        Some(View { contacts, manner, is_pressed })
    }

    /// A body as contacts see it that touch one of its colliders where that is not round.
    fn side(&self, bodies: &Bodies, collider: &ColliderRow) -> Side {
        let constants = &bodies.constants[collider.row];
        Side {
            center: bodies.center_pose(collider).position,
            inverse_mass: constants.inverse_mass,
            inverse_inertia: if constants.is_movable() {
                constants.inverse_inertia(self.rows.anchors[collider.row].rotation)
            } else {
                DMat3::ZERO
            },
            drift: self.rows.drift(collider.row),
            roundness: 0.0,
        }
    }

    /// Puts the contacts of a pair in the place of its old ones.
    fn adopt_view(&mut self, bodies: &Bodies, pairs: &mut Pairs, index: usize, view: &View) {
        let pair = &mut pairs[index];
        let rows = pair.rows().map(|row| row as u32);
        let movable = pair.rows().map(|row| bodies.constants[row].is_movable());
        (pair.is_pressed, pair.is_outdated) = (view.is_pressed, false);
        let owner = Owner::of(bodies, pair, index, view.contacts.len());
        let mut old = std::mem::replace(&mut pair.first_contact, ContactId::NONE);
        let mut last = ContactId::NONE;
        for (touched, lane) in &view.contacts {
            let contact = if old == ContactId::NONE {
                pair.rows().into_iter().for_each(|row| self.rows.hold(row));
                self.graph.insert(rows, movable, lane)
            } else {
                self.graph.write(old, lane);
                let next = self.owners[old.index()].next;
                std::mem::replace(&mut old, next)
            };
            let count = self.owners.len().max(contact.index() + 1);
            self.owners.lengthen(count, Owner::NOBODY);
            self.owners[contact.index()] = Owner { touched: *touched, ..owner };
            self.manners.lengthen(count, Manner::default());
            self.manners[contact.index()] = view.manner;
            if last == ContactId::NONE {
                pair.first_contact = contact;
            } else {
                self.owners[last.index()].next = contact;
            }
            last = contact;
        }
        while old != ContactId::NONE {
            let next = self.owners[old.index()].next;
            self.release(std::mem::replace(&mut old, next));
        }
        pair.rests = pair.first_contact != ContactId::NONE;
        pairs.watch_over(index);
    }

    /// Renews the contacts of the bodies that have moved too far from their anchors; then measures all, and renews those whose bodies
    /// have moved too far against each other.
    pub(super) fn renew_moved(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        held: &[usize],
        at: (RestLaw, Span),
    ) {
        let _phase = profile::phase(Phase::Renew);
        let mut has_moved = std::mem::take(&mut self.has_moved);
        fill(&mut has_moved, bodies.states.len(), false);
        for &row in held {
            let [way, turn] = self.rows.read_drift(bodies, row);
            let [most, most_turn] = self.limits(bodies, row, at.0);
            if way > most * most || turn > most_turn * most_turn {
                has_moved[row] = true;
                self.rows.anchor(bodies, row);
            }
        }
        let stale = |&index: &usize| {
            let pair = &pairs[index];
            pair.rests && (pair.is_outdated || pair.rows().into_iter().any(|row| has_moved[row]))
        };
        let stale: Vec<usize> = self.resting.iter().copied().filter(stale).collect();
        self.has_moved = has_moved;
        self.renew_all(bodies, pairs, stale, at);
        let noted = self.graph.measure(&self.rows.drifts);
        let mut noted: Vec<usize> =
            noted.into_iter().map(|contact| self.owners[contact.index()].pair as usize).collect();
        noted.sort_by_key(|&index| pairs[index].colliders);
        noted.dedup();
        let has_left = |contact: ContactId| self.graph.has_left(contact);
        let (gone, mut strayed): (Vec<usize>, Vec<usize>) =
            noted.into_iter().partition(|&index| self.contacts(&pairs[index]).all(has_left));
        // One contact of several may have left for good, as a side of a mesh does.
        let has_strayed = |contact: ContactId| self.graph.get(contact, field::STRAY) > 0.0;
        strayed.retain(|&index| self.contacts(&pairs[index]).any(has_strayed));
        gone.into_iter().for_each(|index| self.end(pairs, index));
        self.renew_all(bodies, pairs, strayed, at);
        self.resting.retain(|&index| pairs[index].rests);
    }

    /// How far a body may be from its anchor, m, and the sine of half the angle; sets its leash.
    fn limits(&mut self, bodies: &Bodies, row: usize, law: RestLaw) -> [f64; 2] {
        let grain = bodies.grains[row];
        let (speed, spin) = bodies.paces[row];
        let most = |share: f64| share.clamp(DRIFT, FAST_DRIFT);
        if self.crowds.has(row) {
            self.rows.set_leash(row, most(speed * law.step / grain) * grain);
            return [TOGETHER * grain, most(0.5 * spin * law.step)];
        }
        self.rows.set_leash(row, if bodies.constants[row].is_movable() { f64::INFINITY } else { 0.0 });
        // What is so far from where it is thought to be has its velocity wrong by no more than the rest threshold.
        let unnoticed = law.rest_speed() / (spin * grain).max(f64::MIN_POSITIVE);
        [most(unnoticed.min(speed * law.step / grain)) * grain, most(0.5 * unnoticed)]
    }

    /// Renews the contacts of all these pairs.
    fn renew_all(&mut self, bodies: &Bodies, pairs: &mut Pairs, stale: Vec<usize>, at: (RestLaw, Span)) {
        for stale in stale.chunks(AT_ONCE) {
            let views = self.graph.pool().map(stale, LOOKS, |&index| self.look(bodies, pairs, index, at));
            for (&index, view) in stale.iter().zip(views) {
                if let Some(view) = view {
                    self.adopt_view(bodies, pairs, index, &view);
                }
            }
        }
    }
}
