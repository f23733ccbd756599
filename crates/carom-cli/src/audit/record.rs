//! Whether every first touch that had to be a collision is one: bodies are followed along their courses, and what meets faster than the
//! rest threshold without a record has been missed.

use super::law::{Finding, Law, Place};
use super::motion::Course;
use super::near::Pair;
use super::strike::Strike;
use carom::{BodyId, World};
use std::collections::BTreeMap;

/// A course is followed in strides that go so far into the thinner body at most, as a share of its thickness.
const BITE: f64 = 0.1;

/// How deep, relative to the smaller body, an overlap may be rounding.
const DEPTH: f64 = 1e-5;

/// What decides about a first touch.
pub(super) struct Touching<'a> {
    pub(super) world: &'a World,
    pub(super) substep: f64,
    /// Up to which distance bodies that bounce count as touching at the start of the step, m.
    pub(super) margin: f64,
    /// Start and end of the step, s.
    pub(super) span: (f64, f64),
    /// How far each body's course may be off where contacts hold it, m.
    pub(super) held: &'a BTreeMap<BodyId, f64>,
}

/// Looks for touches that are missing from `strikes`.
pub(super) fn judge(
    touching: &Touching<'_>,
    pairs: &[Pair<'_>],
    strikes: &[Strike],
    findings: &mut Vec<Finding>,
) {
    let mut recorded: BTreeMap<[BodyId; 2], f64> = BTreeMap::new();
    for strike in strikes {
        let first = recorded.entry(strike.ids).or_insert(strike.time);
        *first = first.min(strike.time);
    }
    let mut of_bodies: BTreeMap<[BodyId; 2], Vec<&Pair>> = BTreeMap::new();
    for pair in pairs {
        of_bodies.entry(pair.ids).or_default().push(pair);
    }
    for (ids, pairs) in of_bodies {
        let until = recorded.get(&ids).copied().unwrap_or(touching.span.1);
        let apart = pairs.iter().all(|pair| pair.gap(touching.span.0) > pair.horizon(touching.margin));
        if apart {
            findings.extend(
                pairs
                    .iter()
                    .filter_map(|pair| touching.missed(pair, until))
                    .max_by(|one: &Finding, other| one.error.total_cmp(&other.error)),
            );
        }
    }
}

impl Touching<'_> {
    /// Follows a pair that is apart until it touches or `until` has come.
    fn missed(&self, pair: &Pair<'_>, until: f64) -> Option<Finding> {
        let courses: [&Course; 2] = [pair.course(0), pair.course(1)];
        let paces = [0, 1].map(|side| {
            let (speed, spin) = courses[side].pace();
            speed + if spin > 0.0 { spin * pair.reach(side) } else { 0.0 }
        });
        let limit = paces[0] + paces[1] + f64::MIN_POSITIVE;
        let held: f64 = pair.ids.iter().filter_map(|id| self.held.get(id)).sum();
        let slack = DEPTH * pair.size() + held + self.margin;
        let mut time = self.span.0;
        let mut gap = pair.gap(time);
        let mut deepest = (time, gap);
        while gap - limit * (until - time) <= -slack && time < until && gap > -slack {
            time = (time + (gap.max(BITE * pair.thickness())) / limit).min(until);
            gap = pair.gap(time);
            if gap < deepest.1 {
                deepest = (time, gap);
            }
        }
        let place = Place::Bodies(pair.ids.to_vec(), deepest.0);
        let tolerance = self.rest_threshold(pair);
        let closing = if gap > -slack { 0.0 } else { self.closing_speed(pair, time) };
        Some(Finding { law: Law::Record, place, error: closing, tolerance })
    }

    /// How fast the surfaces close where they meet, before `overlapping`, m/s.
    fn closing_speed(&self, pair: &Pair<'_>, overlapping: f64) -> f64 {
        let (mut apart, mut over) = (self.span.0, overlapping);
        for _ in 0..50 {
            let middle = 0.5 * (apart + over);
            if pair.gap(middle) > 0.0 { apart = middle } else { over = middle }
        }
        let moment = 1e-3 * (self.span.1 - self.span.0);
        let earlier = (apart - moment).max(self.span.0);
        let before = pair.gap(earlier);
        if apart > earlier { (before - pair.gap(apart)) / (apart - earlier) } else { 0.0 }
    }

    fn rest_threshold(&self, pair: &Pair<'_>) -> f64 {
        let gravity = self.world.settings().gravity.length();
        if pair.ids.iter().any(|id| self.held.contains_key(id)) {
            return gravity * self.substep;
        }
        0.5 * (pair.course(0).gravity - pair.course(1).gravity).length() * self.substep + 1e-6
    }
}
