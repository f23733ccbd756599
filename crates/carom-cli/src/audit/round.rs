//! The laws of collisions: of each contact, and of all that was struck at once.
//!
//! The record says which impulse each contact gave. That is believed no further than it can be held against what became of the
//! bodies: if impulses that push, at points on the surfaces and within their cones, explain every body's change, then the laws of
//! momentum hold, whoever has named them.

use super::law::{Finding, Law, Place, ROUNDING, positive};
use super::strike::{Party, Strike};
use carom::BodyId;
use carom::impulse::Velocity;
use carom::math::DVec3;
use std::collections::BTreeMap;

/// A body of a round.
struct Struck {
    party: Party,
    before: Velocity,
    after: Velocity,
    /// What its contacts gave it: momentum, and angular momentum about its centre.
    linear: DVec3,
    angular: DVec3,
    /// Sum of the sizes of their impulses, N·s.
    pushed: f64,
    longest_arm: f64,
}

impl Struck {
    fn linear_scale(&self) -> f64 {
        self.party.linear(&self.after).length() + self.party.linear(&self.before).length()
    }

    fn spin_scale(&self) -> f64 {
        let spin = |velocity: &Velocity| (self.party.inertia * velocity.angular).length();
        spin(&self.after) + spin(&self.before)
    }

    /// Change of momentum, and of angular momentum about the centre.
    fn change(&self) -> (DVec3, DVec3) {
        let linear = self.party.linear(&self.after) - self.party.linear(&self.before);
        (linear, self.party.inertia * (self.after.angular - self.before.angular))
    }

    /// What of its contacts' impulses it can take: the rest goes into what holds it.
    fn taken(&self) -> (DVec3, DVec3) {
        let linear = if self.party.mass.is_finite() { self.linear } else { DVec3::ZERO };
        (linear, self.party.inertia * (self.party.inverse_inertia * self.angular))
    }
}

/// How much of the rest threshold, or if it is more of the fastest closing speed, may be missing where several contacts push at once: so
/// far rounds of reflections agree. What does not bounce may go on closing up to the threshold itself: it is a contact then.
const LEFT: f64 = 0.1;
const AGREED: f64 = 1e-3;

/// Closing speeds that are the business of contacts, m/s.
#[derive(Clone, Copy)]
pub(super) struct Threshold {
    /// Of two that touch for the first time.
    pub(super) rest: f64,
    /// Of two that rest against each other and are struck on from elsewhere; 0 where they do not.
    pub(super) left: f64,
}

/// Holds the contacts of one round to their laws.
pub(super) fn judge(
    round: &[&Strike],
    threshold: impl Fn(&Strike) -> Threshold,
    findings: &mut Vec<Finding>,
) {
    let bodies = bodies(round);
    let closing = round.iter().map(|strike| positive(-strike.speed(&strike.before)));
    let fastest = closing.fold(0.0, f64::max);
    for strike in round {
        let Threshold { rest, left } = threshold(strike);
        let resting = if strike.surface.restitution == 0.0 { rest } else { LEFT * rest };
        let left = (round.len() > 1).then(|| resting.max(LEFT * left).max(AGREED * fastest));
        findings.push(separating_speed(strike, left));
        findings.push(push(strike));
    }
    momentum(round, &bodies, findings);
    findings.extend(energy(round, &bodies));
}

/// Each body that moves, with all that it got.
fn bodies(round: &[&Strike]) -> BTreeMap<BodyId, Struck> {
    let mut bodies = BTreeMap::new();
    for strike in round {
        for side in (0..2).filter(|&side| strike.parties[side].moves) {
            let body = bodies.entry(strike.ids[side]).or_insert(Struck {
                party: strike.parties[side],
                before: strike.before[side],
                after: strike.after[side],
                linear: DVec3::ZERO,
                angular: DVec3::ZERO,
                pushed: 0.0,
                longest_arm: 0.0,
            });
            let impulse = strike.impulse_on(side);
            body.linear += impulse;
            body.pushed += impulse.length();
            body.angular += strike.arms[side].cross(impulse);
            body.longest_arm = body.longest_arm.max(strike.arms[side].length());
            if (body.before, body.after) != (strike.before[side], strike.after[side]) {
                // Two records that tell a body's motion differently: no number explains both.
                body.after.linear = DVec3::NAN;
            }
        }
    }
    bodies
}

/// Among others, up to `left` (m/s) may be missing.
fn separating_speed(strike: &Strike, left: Option<f64>) -> Finding {
    let wanted = -strike.surface.restitution * strike.speed(&strike.before);
    let lack = wanted - strike.speed(&strike.after);
    Finding {
        law: Law::SeparatingSpeed,
        place: Place::Collision(strike.impact),
        // Struck together with others, a contact may well part faster.
        error: if left.is_some() { positive(lack) } else { lack.abs() },
        tolerance: strike.speed_tolerance() + left.unwrap_or(0.0),
    }
}

/// How far an impulse is outside of the cone.
fn push(strike: &Strike) -> Finding {
    let along = strike.impulse.dot(strike.normal);
    let across = (strike.impulse - along * strike.normal).length();
    let surface = &strike.surface;
    let coefficient = if strike.sticks {
        surface.static_friction.max(surface.dynamic_friction)
    } else {
        surface.dynamic_friction
    };
    let lightest = (0..2).map(|side| strike.momentum_scale(side)).filter(|scale| scale.is_finite());
    Finding {
        law: Law::Push,
        place: Place::Collision(strike.impact),
        error: positive(-along).max(positive(across - coefficient * along.max(0.0))),
        tolerance: ROUNDING * lightest.fold(f64::INFINITY, f64::min)
            + (ROUNDING + 2.0 * strike.normal_error) * along.abs(),
    }
}

fn momentum(round: &[&Strike], bodies: &BTreeMap<BodyId, Struck>, findings: &mut Vec<Finding>) {
    let Some(first) = round.first() else { return };
    let place = || Place::Collision(first.impact);
    // Impulses between bodies that move cancel; what passes to the immovable and into what holds a body does not.
    let mut to_world = (DVec3::ZERO, DVec3::ZERO);
    for strike in round {
        for side in (0..2).filter(|&side| !strike.parties[side].moves) {
            let impulse = strike.impulse_on(side);
            to_world.0 += impulse;
            to_world.1 += (strike.point - first.point).cross(impulse);
        }
    }
    let mut sum = (DVec3::ZERO, DVec3::ZERO);
    let mut scale = (0.0, 0.0);
    for body in bodies.values() {
        let offset = body.party.center - first.point;
        let (change, taken) = (body.change(), body.taken());
        let held = (body.linear - taken.0, body.angular - taken.1);
        to_world.0 += held.0;
        to_world.1 += offset.cross(held.0) + held.1;
        sum.0 += change.0;
        sum.1 += offset.cross(change.0) + change.1;
        scale.0 += body.linear_scale();
        scale.1 += offset.length() * body.linear_scale() + body.spin_scale();

        let length = if body.longest_arm > 0.0 { body.longest_arm } else { 1.0 };
        findings.push(Finding {
            law: Law::OwnMomentum,
            place: place(),
            error: (change.0 - taken.0).length() + (change.1 - taken.1).length() / length,
            tolerance: ROUNDING * (body.linear_scale() + body.pushed + body.spin_scale() / length),
        });
    }
    let impulses: f64 = round.iter().map(|strike| strike.impulse.length()).sum();
    let levers: f64 = round
        .iter()
        .map(|strike| strike.impulse.length() * (strike.point.distance(first.point) + strike.longest_arm()))
        .sum();
    for (law, error, tolerance) in [
        (Law::LinearMomentum, (sum.0 + to_world.0).length(), scale.0 + impulses),
        (Law::AngularMomentum, (sum.1 + to_world.1).length(), scale.1 + levers),
    ] {
        findings.push(Finding { law, place: place(), error, tolerance: ROUNDING * tolerance });
    }
}

/// Energy of all that was struck at once. With `f` the impulses along the normals, it falls by `½ Σ f·(1 − C_r)·|v_c|`, which for
/// a single contact is `½ (1 − C_r²)·v_c²/K`; with friction a single one loses no less, several lose no less than nothing.
fn energy(round: &[&Strike], bodies: &BTreeMap<BodyId, Struck>) -> Option<Finding> {
    let first = round.first()?;
    let smooth = round.iter().all(|strike| strike.frictionless());
    let (mut gained, mut scale) = (0.0, 0.0);
    for Struck { party, before, after, .. } in bodies.values() {
        gained += party.energy(after) - party.energy(before);
        scale += party.energy_scale(after) + party.energy_scale(before);
    }
    let mut tolerance = ROUNDING * scale;
    for strike in round {
        let [a, b] = [0, 1].map(|side| strike.parties[side].driven(&strike.before[side], strike.arms[side]));
        gained += strike.impulse.dot(b - a);
        tolerance += ROUNDING * strike.impulse.length() * (a.length() + b.length());
        let closing = strike.speed(&strike.before);
        let fraction = if round.len() > 1 {
            if smooth { strike.impulse.dot(strike.normal) } else { 0.0 }
        } else {
            let per_impulse = strike.speed_per_impulse();
            if per_impulse > 0.0 { -(1.0 + strike.surface.restitution) * closing / per_impulse } else { 0.0 }
        };
        let lost = 1.0 - strike.surface.restitution;
        gained -= 0.5 * fraction * lost * closing;
        tolerance += lost * fraction.abs() * strike.speed_tolerance();
    }
    Some(Finding {
        law: Law::Energy,
        place: Place::Collision(first.impact),
        error: if smooth { gained.abs() } else { positive(gained) },
        tolerance,
    })
}

/// After the last round of an instant nothing that was struck may go on closing, faster than the rest threshold.
pub(super) fn parting(
    strikes: &[Strike],
    threshold: impl Fn(&Strike) -> Threshold,
    findings: &mut Vec<Finding>,
) {
    let mut last: BTreeMap<(u64, BodyId), (u32, Velocity)> = BTreeMap::new();
    for strike in strikes {
        for side in 0..2 {
            let latest = (strike.round, strike.after[side]);
            let entry = last.entry((strike.time.to_bits(), strike.ids[side])).or_insert(latest);
            if entry.0 < strike.round {
                *entry = latest;
            }
        }
    }
    for strike in strikes {
        let after = [0, 1].map(|side| {
            last.get(&(strike.time.to_bits(), strike.ids[side])).map_or(strike.after[side], |entry| entry.1)
        });
        let Threshold { rest, left } = threshold(strike);
        findings.push(Finding {
            law: Law::Parting,
            place: Place::Collision(strike.impact),
            error: positive(-strike.speed(&after)),
            tolerance: strike.speed_tolerance() + rest.max(left),
        });
    }
}
