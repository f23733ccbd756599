//! One round of an instant: who pushes, what they push, and what has become of everyone then.

use super::Instant;
use crate::impacts::reflection::{Blow, Mover, Spot, Start, reflect, velocities_after};
use crate::impacts::strike::{push_and_turn, record, velocity_of};
use crate::impulse::Velocity;
use crate::math::DVec3;

/// Where no contact bounces, speeds are found up to this share of the rest threshold; and up to the second, while it is sought who
/// pushes. What closes fast need not be known better than to the third of its speed.
const NEGLIGIBLE: f64 = 1e-4;
const ROUGH: f64 = 1e-2;
const OF_THE_FASTEST: f64 = 3e-4;

/// So many sweeps are enough to see who pushes; and so many there are at most after that. Where friction slides and sticks by turns
/// they may not agree by then: what still closes has a round of its own.
const GLANCE: usize = 4;
const EFFORT: usize = 100;

impl Instant<'_> {
    /// Finds the impulses of a round in which at least `struck` push; returns which do.
    pub(super) fn reflect(&mut self, mut struck: Vec<usize>) -> (Vec<usize>, Vec<Blow>) {
        let mut earlier: Vec<Blow> = Vec::new();
        let mut share = ROUGH;
        loop {
            let round = Cast::of(self, &struck);
            let negligible = self.negligible(&struck, share);
            let is_glance = negligible > 0.0 && share > NEGLIGIBLE;
            let sweeps = if negligible == 0.0 {
                usize::MAX
            } else if is_glance {
                GLANCE
            } else {
                EFFORT
            };
            let start = Start { blows: &earlier, negligible, sweeps, is_glance };
            let blows = reflect(&round.movers, &round.spots, start);
            let after = velocities_after(&round.movers, &round.spots, &blows);
            let moved = |(&mover, after): (&usize, &Velocity)| {
                (self.movers[mover].velocity != *after).then_some(mover)
            };
            let moved: Vec<usize> = round.of.iter().zip(&after).filter_map(moved).collect();
            moved.iter().for_each(|&mover| self.open(mover));
            let changed = |mover: usize| round.of.binary_search(&mover).ok().map(|local| after[local]);
            self.gather_waiting(changed);
            let velocity = |mover: usize| changed(mover).unwrap_or(self.movers[mover].velocity);
            let mut more = self.places_of(&moved);
            more.retain(|index| {
                let spot = &self.places[*index].spot;
                let closing = -spot.velocity(velocity).dot(spot.contact.normal);
                spot.contact.restitution == 0.0 && !struck.contains(index) && self.strikes(*index, closing)
            });
            if more.is_empty() {
                if negligible == 0.0 || share == NEGLIGIBLE {
                    return (struck, blows);
                }
                share = NEGLIGIBLE;
            }
            struck.append(&mut more);
            earlier = blows;
        }
    }

    /// Up to what speeds need be known in a round in which these push, m/s: where none bounces, to a share of the rest threshold, and not
    /// less than that of what gravity alone presses. Against a wall, to which nothing presses, the threshold is rounding.
    fn negligible(&self, struck: &[usize], share: f64) -> f64 {
        let places = || struck.iter().map(|&index| &self.places[index]);
        if places().any(|place| place.spot.contact.restitution > 0.0) {
            return 0.0;
        }
        let slowest = places().map(|place| place.rest_speed).fold(f64::MAX, f64::min);
        let fastest = places().map(|place| place.closing(&self.movers)).fold(0.0, f64::max);
        (share * slowest.max(self.law.rest_speed())).max(OF_THE_FASTEST * fastest)
    }

    /// Gives the bodies their impulses; returns the movers whose velocities change.
    pub(super) fn carry_out(&mut self, round: u32, struck: &[usize], blows: &[Blow]) -> Vec<usize> {
        let first = self.outcome.impacts.len();
        if first == 0 {
            self.outcome.impacts.reserve_exact(struck.len());
        }
        let mut changed = Vec::new();
        let mut recorded = Vec::new();
        for (&index, blow) in struck.iter().zip(blows) {
            if !blow.acts() {
                continue;
            }
            let place = &mut self.places[index];
            place.is_struck = true;
            let colliders = self.pairs[place.pair].colliders;
            let struck = (self.movers.as_slice(), &place.spot, blow);
            let impact = record(self.bodies, colliders, &place.contact, struck, (self.time, round));
            self.outcome.impacts.extend(impact);
            recorded.push(index);
            let (impulse, across) = (blow.normal * place.spot.contact.normal + blow.tangent, blow.tangent);
            let spot = place.spot;
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let mover = spot.movers[side];
                let row = self.rows[mover];
                if self.bodies.constants[row].is_movable() {
                    let arm = spot.arms[side];
                    let turning = sign * if is_central(arm, spot.contact.normal) { across } else { impulse };
                    push_and_turn(self.bodies, row, arm, [sign * impulse, turning]);
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

/// The angle (rad) by which a line may miss a body's centre for rounding.
const MISS: f64 = 1e-12;

/// Whether a line along `normal` at `arm` from a body's centre leads through it, as it does at the surface of a ball: what pushes
/// along it does not turn the body, not even by rounding.
fn is_central(arm: DVec3, normal: DVec3) -> bool {
    arm.cross(normal).length_squared() <= MISS * MISS * arm.length_squared()
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
