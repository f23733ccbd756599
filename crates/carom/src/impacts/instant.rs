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

mod round;

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::{ContactPoint, Manifold};
use crate::impacts::reflection::{Mover, Spot};
use crate::impacts::strike::{center_at, mover_at};
use crate::impacts::time_of_impact::{Approach, RestLaw, Touch};
use crate::impulse::{Contact, Velocity};
use crate::math::DVec3;
use crate::report::Impact;
use crate::step::motion::{advance, rouse};
use crate::step::pairs::Pairs;
use crate::step::rest::Rest;

/// So many rounds are carried out at once; what still closes then goes on in the next substep.
const ROUNDS: u32 = 1024;

/// What will touch within this share of a substep touches at the same instant.
const SIMULTANEOUS: f64 = 1e-3;

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
    /// In order of their rows.
    mover_of_row: Vec<(usize, usize)>,
    /// Whether everything that touches a mover has been gathered.
    is_open: Vec<bool>,
    places: Vec<Place>,
    places_of: Vec<Vec<usize>>,
    /// Pairs, in order.
    gathered: Vec<usize>,
    /// Pairs that need not be gathered unless their bodies get faster.
    waiting: Vec<usize>,
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
            mover_of_row: Vec::new(),
            is_open: Vec::new(),
            places: Vec::new(),
            places_of: Vec::new(),
            gathered: Vec::new(),
            waiting: Vec::new(),
            outcome: Outcome::default(),
        };
        instant.gather(first);
        if !instant.places.iter().any(|place| place.closing(&instant.movers) > place.rest_speed) {
            instant.add(first, &Manifold::single(touch.normal, touch.contact), touch.rest_speed, f64::MAX);
        }
        for row in instant.pairs[first].rows() {
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
        let mut stays: Vec<(usize, bool)> = Vec::new();
        for place in self.places.iter().filter(|place| place.is_struck) {
            let colliders = self.pairs[place.pair].colliders;
            let parts = Approach::of(self.bodies, colliders, self.law)
                .is_none_or(|approach| approach.parts(&place.contact, place.spot.contact.normal));
            let is_slow = -place.closing(&self.movers) <= place.rest_speed;
            stays.push((place.pair, is_slow && !parts));
        }
        // One place that does not stay comes before those that do, and tells for all of its pair.
        stays.sort_unstable();
        stays.dedup_by_key(|&mut (pair, _)| pair);
        self.outcome.struck = stays;
        self.outcome.rows.sort_unstable();
        self.outcome.rows.dedup();
        self.outcome
    }

    /// The mover of a row.
    fn mover(&mut self, row: usize) -> usize {
        let mover = self.movers.len();
        let place = match self.mover_of_row.binary_search_by_key(&row, |&(row, _)| row) {
            Ok(place) => return self.mover_of_row[place].1,
            Err(place) => place,
        };
        self.mover_of_row.insert(place, (row, mover));
        self.movers.push(mover_at(self.bodies, row, self.time));
        self.rows.push(row);
        self.is_open.push(row == WORLD_ROW || !self.bodies.constants[row].is_movable());
        self.places_of.push(Vec::new());
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
            if self.pairs[pair].sensor || self.gathered.binary_search(&pair).is_ok() {
                continue;
            }
            if self.may_strike(pair, |_| None) {
                self.gather(pair);
            } else {
                self.waiting.push(pair);
            }
        }
    }

    /// Gathers the pairs that were too slow to be struck and are no longer where movers' velocities have `changed`.
    fn gather_waiting(&mut self, changed: impl Fn(usize) -> Option<Velocity>) {
        for pair in std::mem::take(&mut self.waiting) {
            if self.may_strike(pair, &changed) {
                self.gather(pair);
            } else {
                self.waiting.push(pair);
            }
        }
    }

    /// Whether any point of a pair can close faster than what is left to contacts. What is no mover keeps to its path.
    fn may_strike(&self, index: usize, changed: impl Fn(usize) -> Option<Velocity>) -> bool {
        let pair = &self.pairs[index];
        let left = if pair.rests { self.rest.left_speed(self.bodies, pair, self.law) } else { 0.0 };
        if left == 0.0 {
            return true;
        }
        let spin_reaches = pair.spin_reaches(self.bodies);
        let speed = |side: usize| {
            let row = pair.rows()[side];
            let (linear, angular) = match self.mover_of_row.binary_search_by_key(&row, |&(row, _)| row) {
                Ok(place) => {
                    let mover = self.mover_of_row[place].1;
                    let Velocity { linear, angular } = changed(mover).unwrap_or(self.movers[mover].velocity);
                    (linear.length(), angular.length())
                }
                Err(_) => self.bodies.paces[row],
            };
            linear + angular * spin_reaches[side]
        };
        speed(0) + speed(1) > left
    }

    /// Gathers the places where a pair touches.
    fn gather(&mut self, index: usize) {
        let pair = &self.pairs[index];
        let margin = if pair.rests { self.law.contact_margin() } else { self.window };
        match self.gathered.binary_search(&index) {
            Ok(_) => return,
            Err(place) => self.gathered.insert(place, index),
        }
        let Some(approach) = Approach::of(self.bodies, pair.colliders, self.law) else { return };
        let touching = if pair.rests { margin } else { approach.tolerance() };
        let margin = margin.max(touching);
        let is_far = || {
            self.pairs.least_separation(self.bodies, index, self.time) > margin
                || pair.least_facing(self.bodies, (self.time, self.time))[0] > margin
        };
        if !pair.rests && is_far() {
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
        let (rows, surface) = (pair.rows(), pair.surface(self.bodies));
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
        let center = |key| Some(center_at(self.bodies, self.bodies.collider(key)?, self.time));
        Some([center(a)?, center(b)?])
    }

    /// The places of some movers, in order.
    fn places_of(&self, movers: &[usize]) -> Vec<usize> {
        if let [mover] = movers {
            return self.places_of[*mover].clone();
        }
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
}
