//! All that is struck at one instant, in rounds.
//!
//! A touch may strike bodies that touch others in turn: balls in a row, a cube that lands flat, what stands on the floor. Around the
//! bodies of the first touch everything is gathered that touches at this instant, as far as impulses get. Then, round by
//! round, the contacts that close are reflected together ([`reflection`](super::reflection)), until none closes
//! faster than the rest threshold.
//!
//! Contacts that bounce wait for their round, so that momentum passes through a row of balls and the last one breaks away. Those with
//! C_r = 0 have nothing to wait for: where a round would make them close, they push in the same round. Where many bodies rest
//! against each other, what a blow presses lightly is left to the contacts that hold it
//! ([`Rest::left_speed`](crate::step::rest::Rest::left_speed)).

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::{ContactPoint, Manifold};
use crate::impacts::reflection::{Blow, Mover, Spot, Start, reflect, velocities_after};
use crate::impacts::strike::{mover_at, pose_at, push, record, velocity_of};
use crate::impacts::time_of_impact::{Approach, RestLaw, Touch};
use crate::impulse::{Contact, Velocity};
use crate::math::DVec3;
use crate::report::Impact;
use crate::step::motion::{advance, rouse};
use crate::step::pairs::Pairs;
use crate::step::rest::Rest;
use std::collections::{BTreeMap, BTreeSet};

/// So many rounds are carried out at once; what still closes then goes on in the next substep.
const ROUNDS: u32 = 1024;

/// What will touch within this share of a substep touches at the same instant.
const SIMULTANEOUS: f64 = 1e-3;

/// Where no contact bounces, speeds are found up to this share of the rest threshold.
const NEGLIGIBLE: f64 = 1e-3;

/// A place where two bodies touch at the instant.
struct Place {
    pair: usize,
    spot: Spot,
    contact: ContactPoint,
    /// Closing speed up to which contacts see to it, m/s.
    rest_speed: f64,
    /// Whether it touches, and not just will within the window.
    touches: bool,
    is_struck: bool,
}

impl Place {
    fn closing(&self, movers: &[Mover]) -> f64 {
        -self.spot.velocity(|mover| movers[mover].velocity).dot(self.spot.contact.normal)
    }
}

/// What has come of an instant.
#[derive(Default)]
pub(crate) struct Outcome {
    pub impacts: Vec<Impact>,
    /// The rows whose velocities have changed.
    pub rows: Vec<usize>,
    /// The pairs that were struck, and whether they stay together.
    pub struck: Vec<(usize, bool)>,
    /// The pairs that still close.
    pub unfinished: Vec<usize>,
}

/// The bodies and contacts of an instant.
pub(crate) struct Instant<'a> {
    bodies: &'a mut Bodies,
    pairs: &'a Pairs,
    rest: &'a Rest,
    law: RestLaw,
    /// Within the step, s.
    time: f64,
    /// Separation up to which what flies counts as touching besides rounding, m.
    window: f64,
    movers: Vec<Mover>,
    rows: Vec<usize>,
    mover_of_row: BTreeMap<usize, usize>,
    /// Whether everything that touches a mover has been gathered.
    is_open: Vec<bool>,
    places: Vec<Place>,
    places_of: Vec<Vec<usize>>,
    gathered: BTreeSet<usize>,
    outcome: Outcome,
}

impl<'a> Instant<'a> {
    /// The instant `time` at which the pair `first` touches.
    pub fn new(
        bodies: &'a mut Bodies,
        (pairs, rest): (&'a Pairs, &'a Rest),
        (first, touch): (usize, &Touch),
        (law, time): (RestLaw, f64),
    ) -> Self {
        let mut instant = Self {
            bodies,
            pairs,
            rest,
            law,
            time,
            window: -touch.closing_speed * SIMULTANEOUS * law.substep,
            movers: Vec::new(),
            rows: Vec::new(),
            mover_of_row: BTreeMap::new(),
            is_open: Vec::new(),
            places: Vec::new(),
            places_of: Vec::new(),
            gathered: BTreeSet::new(),
            outcome: Outcome::default(),
        };
        instant.gather(first);
        if !instant.places.iter().any(|place| place.closing(&instant.movers) > place.rest_speed) {
            instant.add(first, &Manifold::single(touch.normal, touch.contact), touch.rest_speed, f64::MAX);
        }
        for row in instant.pairs[first].rows {
            let mover = instant.mover(row);
            instant.open(mover);
        }
        instant
    }

    /// Carries out round after round.
    pub fn resolve(mut self) -> Outcome {
        let mut changed: Vec<usize> = (0..self.movers.len()).collect();
        for round in 0..ROUNDS {
            let struck = self.closing(&changed);
            if struck.is_empty() {
                break;
            }
            let (struck, blows) = self.reflect(struck);
            changed = self.carry_out(round, &struck, &blows);
        }
        self.finish(&changed)
    }

    fn finish(mut self, changed: &[usize]) -> Outcome {
        for index in self.closing(changed) {
            self.outcome.unfinished.push(self.places[index].pair);
        }
        let mut stays: BTreeMap<usize, bool> = BTreeMap::new();
        for place in self.places.iter().filter(|place| place.is_struck) {
            let colliders = self.pairs[place.pair].colliders;
            let parts = Approach::of(self.bodies, colliders, self.law)
                .is_none_or(|approach| approach.parts(&place.contact, place.spot.contact.normal));
            let is_slow = -place.closing(&self.movers) <= place.rest_speed;
            *stays.entry(place.pair).or_insert(true) &= is_slow && !parts;
        }
        self.outcome.struck = stays.into_iter().collect();
        self.outcome.rows.sort_unstable();
        self.outcome.rows.dedup();
        self.outcome
    }

    /// The mover of a row.
    fn mover(&mut self, row: usize) -> usize {
        let next = self.movers.len();
        let mover = *self.mover_of_row.entry(row).or_insert(next);
        if mover == next {
            self.movers.push(mover_at(self.bodies, row, self.time));
            self.rows.push(row);
            self.is_open.push(row == WORLD_ROW || !self.bodies.constants[row].is_movable());
            self.places_of.push(Vec::new());
        }
        mover
    }

    /// Gathers everything that touches a mover.
    fn open(&mut self, mover: usize) {
        if std::mem::replace(&mut self.is_open[mover], true) {
            return;
        }
        let row = self.rows[mover];
        rouse(self.bodies, row, self.law, self.time);
        advance(self.bodies, row, self.time);
        for number in 0..self.pairs.count_of_row(row) {
            let pair = self.pairs.of_row(row, number);
            if !self.pairs[pair].sensor {
                self.gather(pair);
            }
        }
    }

    /// Gathers the places where a pair touches.
    fn gather(&mut self, index: usize) {
        let pair = &self.pairs[index];
        let margin = if pair.rests { self.law.contact_margin() } else { self.window };
        if !self.gathered.insert(index) {
            return;
        }
        let Some(approach) = Approach::of(self.bodies, pair.colliders, self.law) else { return };
        let touching = if pair.rests { margin } else { approach.tolerance() };
        let margin = margin.max(touching);
        if !pair.rests && pair.least_separation(self.bodies, self.time) > margin {
            return;
        }
        let mut manifolds = Vec::new();
        approach.manifolds(self.pairs, self.time, margin, &mut manifolds);
        let left = if pair.rests { self.rest.left_speed(self.bodies, pair, self.law) } else { 0.0 };
        let rest_speeds: Vec<f64> =
            manifolds.iter().map(|manifold| approach.rest_speed(manifold.normal).max(left)).collect();
        for (manifold, rest_speed) in manifolds.iter().zip(rest_speeds) {
            self.add(index, manifold, rest_speed, touching);
        }
    }

    /// Adds the places of a manifold; up to a separation of `touching` they touch.
    fn add(&mut self, index: usize, manifold: &Manifold, rest_speed: f64, touching: f64) {
        let pair = &self.pairs[index];
        let (rows, surface) = (pair.rows, pair.surface);
        let Some(centers) = self.centers(index) else { return };
        let movers = rows.map(|row| self.mover(row));
        for contact in manifold.points() {
            let spot = Spot {
                movers,
                arms: centers.map(|center| contact.point - center),
                contact: Contact {
                    normal: manifold.normal,
                    restitution: surface.restitution,
                    static_friction: surface.static_friction,
                    dynamic_friction: surface.dynamic_friction,
                },
                pulls: false,
            };
            movers.into_iter().for_each(|mover| self.places_of[mover].push(self.places.len()));
            let touches = contact.separation <= touching;
            let contact = *contact;
            self.places.push(Place { pair: index, spot, contact, rest_speed, touches, is_struck: false });
        }
    }

    fn centers(&self, index: usize) -> Option<[DVec3; 2]> {
        let (a, b) = self.pairs[index].colliders;
        let center = |key| Some(pose_at(self.bodies, self.bodies.collider(key)?, self.time).position);
        Some([center(a)?, center(b)?])
    }

    /// The places of some movers, in order.
    fn places_of(&self, movers: &[usize]) -> Vec<usize> {
        let mut places: Vec<usize> =
            movers.iter().flat_map(|&mover| &self.places_of[mover]).copied().collect();
        places.sort_unstable();
        places.dedup();
        places
    }

    /// Those that close faster than the rest threshold.
    fn closing(&self, changed: &[usize]) -> Vec<usize> {
        let mut places = self.places_of(changed);
        places.retain(|&index| self.strikes(index, self.places[index].closing(&self.movers)));
        places
    }

    /// Whether a place is struck if it closes with `closing`. One that was struck before at this instant and has lost speed in it
    /// rattles: gravity makes an end of that, whichever way the normal points.
    fn strikes(&self, index: usize, closing: f64) -> bool {
        let place = &self.places[index];
        let is_near = place.touches
            || place.is_struck
            || place.contact.separation <= SIMULTANEOUS * self.law.substep * closing;
        let rattles = place.is_struck && place.spot.contact.restitution < 1.0;
        let slowest = if rattles { place.rest_speed.max(self.law.rest_speed()) } else { place.rest_speed };
        is_near && closing > slowest
    }

    /// Finds the impulses of a round in which at least `struck` push; returns which do.
    fn reflect(&mut self, mut struck: Vec<usize>) -> (Vec<usize>, Vec<Blow>) {
        let mut earlier: Vec<Blow> = Vec::new();
        loop {
            let round = Cast::of(self, &struck);
            let bounces = struck.iter().any(|&index| self.places[index].spot.contact.restitution > 0.0);
            let least = struck.iter().map(|&index| self.places[index].rest_speed).fold(f64::MAX, f64::min);
            let negligible = if bounces { 0.0 } else { NEGLIGIBLE * least };
            let blows = reflect(&round.movers, &round.spots, Start { blows: &earlier, negligible });
            let after = velocities_after(&round.movers, &round.spots, &blows);
            let moved = |(&mover, after): (&usize, &Velocity)| {
                (self.movers[mover].velocity != *after).then_some(mover)
            };
            let moved: Vec<usize> = round.of.iter().zip(&after).filter_map(moved).collect();
            moved.iter().for_each(|&mover| self.open(mover));
            let velocity = |mover: usize| match round.of.binary_search(&mover) {
                Ok(local) => after[local],
                Err(_) => self.movers[mover].velocity,
            };
            let mut more = self.places_of(&moved);
            more.retain(|index| {
                let spot = &self.places[*index].spot;
                let closing = -spot.velocity(velocity).dot(spot.contact.normal);
                spot.contact.restitution == 0.0 && !struck.contains(index) && self.strikes(*index, closing)
            });
            if more.is_empty() {
                return (struck, blows);
            }
            struck.append(&mut more);
            earlier = blows;
        }
    }

    /// Gives the bodies their impulses; returns the movers whose velocities change.
    fn carry_out(&mut self, round: u32, struck: &[usize], blows: &[Blow]) -> Vec<usize> {
        let first = self.outcome.impacts.len();
        let mut changed = Vec::new();
        let mut recorded = Vec::new();
        for (&index, blow) in struck.iter().zip(blows) {
            if blow.normal == 0.0 && blow.tangent == DVec3::ZERO {
                continue;
            }
            let place = &mut self.places[index];
            place.is_struck = true;
            let colliders = self.pairs[place.pair].colliders;
            let struck = (self.movers.as_slice(), &place.spot, blow);
            let impact = record(self.bodies, colliders, &place.contact, struck, (self.time, round));
            self.outcome.impacts.extend(impact);
            recorded.push(index);
            let impulse = blow.normal * place.spot.contact.normal + blow.tangent;
            for (side, impulse) in [(0, -impulse), (1, impulse)] {
                let mover = place.spot.movers[side];
                let row = self.rows[mover];
                if self.bodies.constants[row].is_movable() {
                    push(self.bodies, row, place.spot.arms[side], impulse);
                    changed.push(mover);
                }
            }
        }
        changed.sort_unstable();
        changed.dedup();
        for &mover in &changed {
            self.movers[mover].velocity = velocity_of(self.bodies, self.rows[mover]);
            self.outcome.rows.push(self.rows[mover]);
        }
        for (impact, index) in self.outcome.impacts[first..].iter_mut().zip(recorded) {
            let [a, b] = self.places[index].spot.movers;
            (impact.after_a, impact.after_b) = (self.movers[a].velocity, self.movers[b].velocity);
        }
        changed
    }
}

/// The bodies and places of one round.
struct Cast {
    /// Which movers of the instant, in ascending order.
    of: Vec<usize>,
    movers: Vec<Mover>,
    spots: Vec<Spot>,
}

impl Cast {
    fn of(instant: &Instant<'_>, struck: &[usize]) -> Self {
        let spot = |&index: &usize| instant.places[index].spot;
        let mut of: Vec<usize> = struck.iter().flat_map(|index| spot(index).movers).collect();
        of.sort_unstable();
        of.dedup();
        let local = |mover: usize| of.partition_point(|&other| other < mover);
        let spots =
            struck.iter().map(spot).map(|spot| Spot { movers: spot.movers.map(local), ..spot }).collect();
        let movers = of.iter().map(|&mover| instant.movers[mover]).collect();
        Self { of, movers, spots }
    }
}
