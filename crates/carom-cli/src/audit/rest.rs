//! What contacts that rest may do to bodies: push, within their cones, and nothing else.
//!
//! A stretch of a body's course that is no free flight must have been bent by contacts. By how much is known, so it can be asked whether
//! pushes along the normals of what touched it, within the cones of friction, explain it; and for all bodies that rest on each other
//! together, whether pushes from what can't be moved do.

use super::cone::{Cone, SHARED_OUT, unexplained};
use super::law::{Finding, Law, Place, ROUNDING, positive};
use super::motion::{Course, Deviation, deviation};
use super::near::{Pair, Touch};
use super::strike::{Party, Strike};
use carom::math::DVec3;
use carom::{BodyId, Motion, World};
use std::collections::{BTreeMap, BTreeSet};

/// Up to which gap, as a share of the smaller body, contacts stop what does not bounce.
const HORIZON: f64 = 0.02;

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
struct Given {
    /// N·s, and about its centre N·m·s.
    impulse: DVec3,
    spin: DVec3,
    /// Between flight and course at the end of a stretch, at most, m.
    miss: f64,
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
                    // What gravity does in a substep is given to it as a whole; a collision within one divides it.
                    let divided = from.time > self.span.0 || to.time < self.span.1;
                    let advance =
                        if divided { course.mass * self.substep * course.gravity } else { DVec3::ZERO };
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

    /// Up to which gap a pair may go on resting, m.
    fn horizon(&self, pair: &Pair<'_>) -> f64 {
        if pair.surface().restitution > 0.0 { self.margin } else { self.margin.max(HORIZON * pair.size()) }
    }

    /// Closing speeds (m/s) that a blow may leave to contacts: of pairs that rested against each other already, and do not
    /// bounce without loss, if they are stopped before they are deep in each other.
    pub(super) fn left_speeds(&self, strikes: &[Strike]) -> BTreeMap<[BodyId; 2], f64> {
        let struck: BTreeSet<[BodyId; 2]> = strikes.iter().map(|strike| strike.ids).collect();
        let rests = |pair: &&Pair<'_>| {
            struck.contains(&pair.ids)
                && pair.surface().restitution < 1.0
                && pair.gap(self.span.0) <= self.horizon(pair)
        };
        let resting = self.pairs.iter().filter(rests);
        resting.map(|pair| (pair.ids, HORIZON * pair.size() / self.substep)).collect()
    }

    /// Up to which gap contacts of a pair may push within `time`: they may have closed it, or opened it since.
    fn reach(&self, pair: &Pair<'_>, time: f64) -> f64 {
        let paces = [0, 1].map(|side| {
            let (speed, spin) = pair.course(side).pace();
            speed + if spin > 0.0 { spin * pair.reach(side) } else { 0.0 }
        });
        self.horizon(pair)
            + (paces[0] + paces[1]).min(pair.size() / time.max(f64::MIN_POSITIVE)) * time.min(self.substep)
    }

    /// The cones of what may have pushed a body.
    fn cones(&self, near: &[&Pair<'_>], id: BodyId, span: (f64, f64)) -> Vec<Cone> {
        let mut cones = Vec::new();
        for pair in near {
            self.add_cones(pair, id, span, &mut cones);
        }
        cones
    }

    fn add_cones(&self, pair: &Pair<'_>, id: BodyId, span: (f64, f64), cones: &mut Vec<Cone>) {
        let mut touches: Vec<Touch> = Vec::new();
        let reach = self.reach(pair, span.1 - span.0);
        pair.touches(span.0, reach, &mut touches);
        pair.touches(span.1, reach, &mut touches);
        let turned: f64 =
            [0, 1].map(|side| pair.course(side).pace().1).iter().sum::<f64>() * (span.1 - span.0);
        let speed: f64 = [0, 1].map(|side| pair.course(side).pace().0).iter().sum();
        let rolled = speed * (span.1 - span.0) / pair.size();
        let sign = if pair.ids[0] == id { -1.0 } else { 1.0 };
        let wider = (turned + rolled).min(1.0);
        cones.extend(touches.iter().map(|touch| (sign * touch.normal, touch.friction + wider + 1e-4)));
    }

    /// Bodies that contacts connect, with those that hold them.
    fn groups(&self, given: &BTreeMap<BodyId, Given>, findings: &mut Vec<Finding>) {
        let ids: Vec<BodyId> = given.keys().copied().collect();
        let place = |id: &BodyId| ids.binary_search(id).ok();
        let mut leader: Vec<usize> = (0..ids.len()).collect();
        let mut holds: Vec<(usize, &Pair)> = Vec::new();
        for pair in self.pairs {
            let places = pair.ids.map(|id| place(&id));
            let touching = |pair: &Pair<'_>| {
                let reach = self.reach(pair, self.span.1 - self.span.0);
                pair.gap(self.span.0) <= reach || pair.gap(self.span.1) <= reach
            };
            match places {
                [Some(a), Some(b)] if touching(pair) => {
                    let (a, b) = (find(&mut leader, a), find(&mut leader, b));
                    leader[a.max(b)] = a.min(b);
                }
                [Some(held), None] | [None, Some(held)] if touching(pair) => holds.push((held, pair)),
                _ => {}
            }
        }
        let mut groups: BTreeMap<usize, (Vec<BodyId>, Vec<&Pair>)> = BTreeMap::new();
        for (index, &id) in ids.iter().enumerate() {
            groups.entry(find(&mut leader, index)).or_default().0.push(id);
        }
        for (held, pair) in holds {
            groups.entry(find(&mut leader, held)).or_default().1.push(pair);
        }
        for (bodies, holders) in groups.values() {
            self.group(bodies, holders, given, findings);
        }
    }

    fn group(
        &self,
        bodies: &[BodyId],
        holders: &[&Pair<'_>],
        given: &BTreeMap<BodyId, Given>,
        findings: &mut Vec<Finding>,
    ) {
        let courses: Vec<&Course> = bodies.iter().filter_map(|id| self.courses.get(id)).collect();
        if courses.iter().any(|course| course.mass.is_infinite()) {
            return;
        }
        let (mut got, mut gifts, mut scale) = (DVec3::ZERO, 0.0, 0.0);
        for course in &courses {
            let given = &given[&course.id];
            got += given.impulse;
            gifts += given.impulse.length();
            scale += course.mass * (course.pace().0 + course.gravity.length() * (self.span.1 - self.span.0));
        }
        let mut cones = Vec::new();
        for pair in holders {
            let id = if bodies.contains(&pair.ids[0]) { pair.ids[0] } else { pair.ids[1] };
            self.add_cones(pair, id, self.span, &mut cones);
        }
        let tolerance = ROUNDING * (scale + gifts);
        let shared_out = if holders.is_empty() { 0.0 } else { SHARED_OUT * got.length() };
        let place = || Place::Bodies(bodies.to_vec(), self.span.1);
        let error = unexplained(got, &cones, DVec3::ZERO, tolerance);
        let law = Law::GroupMomentum;
        findings.push(Finding { law, place: place(), error, tolerance: tolerance + shared_out });
        if holders.is_empty() {
            findings.push(self.group_spin(&courses, given, tolerance));
        }
        findings.extend(self.group_energy(&courses, holders, given));
    }

    fn group_spin(&self, courses: &[&Course], given: &BTreeMap<BodyId, Given>, tolerance: f64) -> Finding {
        let place = |course: &Course| course.knots[course.knots.len() - 1].pose.position;
        let mass: f64 = courses.iter().map(|course| course.mass).sum();
        let center =
            courses.iter().map(|course| course.mass * place(course)).fold(DVec3::ZERO, |x, y| x + y) / mass;
        let (mut got, mut allowed, mut size) = (DVec3::ZERO, 0.0, 0.0);
        for course in courses {
            let given = &given[&course.id];
            got += (place(course) - center).cross(given.impulse) + given.spin;
            allowed += given.impulse.length() * (given.miss + self.margin)
                + given.miss * course.mass * course.pace().0;
            size = f64::max(size, place(course).distance(center));
        }
        let bodies = courses.iter().map(|course| course.id).collect();
        Finding {
            law: Law::GroupSpin,
            place: Place::Bodies(bodies, self.span.1),
            error: got.length(),
            tolerance: tolerance * (size + 1.0) + allowed,
        }
    }

    /// None where something that moves by itself pushes.
    fn group_energy(
        &self,
        courses: &[&Course],
        holders: &[&Pair<'_>],
        given: &BTreeMap<BodyId, Given>,
    ) -> Option<Finding> {
        let drives = |pair: &&Pair<'_>| {
            [0, 1].into_iter().any(|side| {
                let course = pair.course(side);
                course.motion != Motion::Fixed && !courses.iter().any(|other| other.id == course.id)
            })
        };
        if holders.iter().any(drives) {
            return None;
        }
        let (mut gained, mut scale, mut slack) = (0.0, 0.0, 0.0);
        for course in courses {
            for (from, to) in course.pieces() {
                let [before, after] = [from, to].map(|knot| Party::new(self.world, course.id, &knot.pose));
                let (before, after) = (before?, after?);
                let fallen = course.mass * course.gravity.dot(to.pose.position - from.pose.position);
                gained += after.energy(&to.before) - before.energy(&from.after) - fallen;
                scale += after.energy_scale(&to.before) + before.energy_scale(&from.after) + fallen.abs();
            }
            let given = &given[&course.id];
            let time = self.span.1 - self.span.0;
            let pull = course.gravity.length() + given.impulse.length() / (course.mass * time);
            slack += 0.5 * course.mass * pull * pull * self.substep * time;
            for knot in &course.knots {
                let struck = (knot.after.linear - knot.before.linear).length();
                slack += course.mass * pull * self.substep * struck;
            }
        }
        let member = |id: BodyId| courses.iter().any(|course| course.id == id);
        for pair in self.pairs.iter().filter(|pair| pair.ids.into_iter().any(member)) {
            let overlap = positive(-pair.gap(self.span.0));
            let weight = [0, 1].map(|side| {
                let course = pair.course(side);
                if course.mass.is_finite() { course.mass * course.gravity.length() } else { 0.0 }
            });
            slack += overlap * (weight[0] + weight[1]);
        }
        let bodies = courses.iter().map(|course| course.id).collect();
        Some(Finding {
            law: Law::GroupEnergy,
            place: Place::Bodies(bodies, self.span.1),
            error: positive(gained),
            tolerance: slack + ROUNDING * scale,
        })
    }
}

fn flight(course: &Course, deviation: &Deviation, time: f64, findings: &mut Vec<Finding>) {
    let laws = [Law::Flight, Law::Path, Law::Spin, Law::Turning];
    for (law, (error, tolerance)) in laws.into_iter().zip(deviation.flight) {
        let place = Place::Bodies(vec![course.id], time);
        findings.push(Finding { law, place, error, tolerance });
    }
}

fn find(leader: &mut [usize], mut index: usize) -> usize {
    while leader[index] != index {
        leader[index] = leader[leader[index]];
        index = leader[index];
    }
    index
}
