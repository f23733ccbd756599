//! What contacts that rest may do to bodies: push, within their cones, and nothing else.
//!
//! A stretch of a body's course that is no free flight must have been bent by contacts. By how much is known, so it can be asked whether
//! pushes along the normals of what touched it, within the cones of friction, explain it; and for all bodies that rest on each other
//! together, whether pushes from what can't be moved do: `group.rs`.

use super::cone::{Cone, SHARED_OUT, unexplained};
use super::law::{Finding, Law, Place, ROUNDING};
use super::motion::{Course, Deviation, Knot, deviation};
use super::near::{HORIZON, Pair, Touch};
use super::strike::Strike;
use carom::math::DVec3;
use carom::{BodyId, Motion, World};
use std::collections::{BTreeMap, BTreeSet};

/// A step as seen by what rests in it.
pub(super) struct Resting<'a> {
    pub(super) world: &'a World,
    pub(super) courses: &'a BTreeMap<BodyId, Course>,
    pub(super) pairs: &'a [Pair<'a>],
    /// ½·g·h² + 1e-6: the gap up to which what bounces rests, m.
    pub(super) margin: f64,
    pub(super) substep: f64,
    /// Start and end of the step, s.
    pub(super) span: (f64, f64),
}

/// What contacts gave to a body in a step.
#[derive(Default)]
pub(super) struct Given {
    /// N·s, and about its centre N·m·s.
    pub(super) impulse: DVec3,
    pub(super) spin: DVec3,
    /// Between flight and course at the end of a stretch, at most, m.
    pub(super) miss: f64,
    /// How far the course may be off between its knots, m.
    course_error: f64,
}

impl<'a> Resting<'a> {
    /// Judges every body; returns those that contacts hold, with how far (m) their courses may be off.
    pub(super) fn judge(&self, findings: &mut Vec<Finding>) -> BTreeMap<BodyId, f64> {
        let mut pairs_of: BTreeMap<BodyId, Vec<&Pair>> = BTreeMap::new();
        for pair in self.pairs {
            pair.ids.into_iter().for_each(|id| pairs_of.entry(id).or_default().push(pair));
        }
        let mut given: BTreeMap<BodyId, Given> = BTreeMap::new();
        for course in self.courses.values().filter(|course| course.motion != Motion::Fixed) {
            let near = pairs_of.get(&course.id).map_or(&[][..], Vec::as_slice);
            for (from, to) in course.pieces() {
                let Some(deviation) = deviation(self.world, course, from, to) else { continue };
                let span = (from.time, to.time);
                let cones = if deviation.is_free() || !course.is_movable {
                    Vec::new()
                } else {
                    self.cones(near, course.id, span)
                };
                if cones.is_empty() {
                    flight(course, &deviation, to.time, findings);
                    continue;
                }
                let impulse = course.mass * deviation.velocity;
                if course.mass.is_finite() {
                    let tolerance = ROUNDING * course.mass * deviation.speeds + SHARED_OUT * impulse.length();
                    let advance = if is_divided(self.span, from, to) {
                        course.mass * self.substep * course.gravity
                    } else {
                        DVec3::ZERO
                    };
                    let error = unexplained(impulse, &cones, advance, tolerance);
                    let place = Place::Bodies(vec![course.id], to.time);
                    findings.push(Finding { law: Law::Support, place, error, tolerance });
                }
                let entry = given.entry(course.id).or_default();
                entry.impulse += if course.mass.is_finite() { impulse } else { DVec3::ZERO };
                entry.spin += deviation.spin;
                entry.miss = entry.miss.max(deviation.flight[1].0);
                entry.course_error += deviation.flight[1].0 + deviation.velocity.length() * (span.1 - span.0);
            }
        }
        self.groups(&given, findings);
        given.into_iter().map(|(id, given)| (id, given.course_error)).collect()
    }

    /// Closing speeds (m/s) that a blow may leave to contacts: of pairs that rest against each other, and do not
    /// bounce without loss, if they are stopped before they are deep in each other. When they are struck, these are pairs that rested
    /// already; `afterwards` also what does not bounce, which rests as soon as it is struck.
    pub(super) fn left_speeds(&self, strikes: &[Strike], afterwards: bool) -> BTreeMap<[BodyId; 2], f64> {
        let struck: BTreeSet<[BodyId; 2]> = strikes.iter().map(|strike| strike.ids).collect();
        let rests = |pair: &&Pair<'_>| {
            let restitution = pair.surface().restitution;
            struck.contains(&pair.ids)
                && restitution < 1.0
                && ((afterwards && restitution == 0.0) || pair.gap(self.span.0) <= pair.horizon(self.margin))
        };
        let resting = self.pairs.iter().filter(rests);
        resting.map(|pair| (pair.ids, HORIZON * pair.size() / self.substep)).collect()
    }

    /// Up to which gap contacts of a pair may push: in a substep they may close it, or open it.
    pub(super) fn reach(&self, pair: &Pair<'_>) -> f64 {
        let paces = [0, 1].map(|side| {
            let (speed, spin) = pair.course(side).pace();
            speed + if spin > 0.0 { spin * pair.reach(side) } else { 0.0 }
        });
        pair.horizon(self.margin) + ((paces[0] + paces[1]) * self.substep).min(pair.size())
    }

    /// The cones of what may have pushed a body.
    fn cones(&self, near: &[&Pair<'_>], id: BodyId, span: (f64, f64)) -> Vec<Cone> {
        let mut cones = Vec::new();
        for pair in near {
            self.add_cones(pair, id, span, &mut cones);
        }
        cones
    }

    pub(super) fn add_cones(&self, pair: &Pair<'_>, id: BodyId, span: (f64, f64), cones: &mut Vec<Cone>) {
        let mut touches: Vec<Touch> = Vec::new();
        let reach = self.reach(pair);
        // Contacts are looked at between substeps: what rolls over an edge then touches what it does not touch before or after.
        let start = ((span.0 - self.span.0) / self.substep).floor() as u32;
        let between = (start + 1..).map(|number| self.span.0 + f64::from(number) * self.substep);
        let between = between.take_while(|&time| time < span.1 - 1e-9).filter(|&time| time > span.0);
        for time in [span.0, span.1].into_iter().chain(between) {
            pair.touches(time, reach, &mut touches);
        }
        // What contacts give for a substep, they may give at its start.
        let time = (span.1 - span.0).max(self.substep);
        let turned: f64 = [0, 1].map(|side| pair.course(side).pace().1).iter().sum::<f64>() * time;
        let speed: f64 = [0, 1].map(|side| pair.course(side).pace().0).iter().sum();
        let rolled = speed * time / pair.size();
        let sign = if pair.ids[0] == id { -1.0 } else { 1.0 };
        let wider = (turned + rolled).min(1.0);
        cones.extend(touches.iter().map(|touch| (sign * touch.normal, touch.friction + wider + 1e-4)));
    }
}

/// Whether a collision divides a substep at an end of this stretch of a step: at its very start as well. What gravity and contacts do in a
/// substep is given to a body as a whole, so that some of it may be on the other side.
pub(super) fn is_divided(span: (f64, f64), from: &Knot, to: &Knot) -> bool {
    from.time > span.0 || to.time < span.1 || from.before != from.after
}

fn flight(course: &Course, deviation: &Deviation, time: f64, findings: &mut Vec<Finding>) {
    let laws = [Law::Flight, Law::Path, Law::Spin, Law::Turning];
    for (law, (error, tolerance)) in laws.into_iter().zip(deviation.flight) {
        let place = Place::Bodies(vec![course.id], time);
        findings.push(Finding { law, place, error, tolerance });
    }
}
