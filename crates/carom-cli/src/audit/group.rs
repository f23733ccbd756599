//! Bodies that rest on each other, taken together: what is inside them cancels, so only those that hold them can have given anything.

use super::cone::{Cone, SHARED_OUT, unexplained};
use super::law::{Finding, Law, Place, ROUNDING, positive};
use super::motion::Course;
use super::near::Pair;
use super::rest::{Given, Resting};
use super::strike::Party;
use carom::math::DVec3;
use carom::{BodyId, Motion};
use std::collections::BTreeMap;

impl Resting<'_> {
    /// Bodies that contacts connect, with those that hold them.
    pub(super) fn groups(&self, given: &BTreeMap<BodyId, Given>, findings: &mut Vec<Finding>) {
        let ids: Vec<BodyId> = given.keys().copied().collect();
        let place = |id: &BodyId| ids.binary_search(id).ok();
        let mut leader: Vec<usize> = (0..ids.len()).collect();
        let mut holds: Vec<(usize, &Pair)> = Vec::new();
        for pair in self.pairs {
            let places = pair.ids.map(|id| place(&id));
            let touching = |pair: &Pair<'_>| {
                let reach = self.reach(pair);
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
        let tolerance = ROUNDING * (scale + gifts);
        let shared_out = if holders.is_empty() { 0.0 } else { SHARED_OUT * got.length() };
        let place = || Place::Bodies(bodies.to_vec(), self.span.1);
        let error = unexplained(got, &self.cones_of_holders(bodies, holders), DVec3::ZERO, tolerance);
        let law = Law::GroupMomentum;
        findings.push(Finding { law, place: place(), error, tolerance: tolerance + shared_out });
        if holders.is_empty() {
            findings.push(self.group_spin(&courses, given, tolerance));
        }
        findings.extend(self.group_energy(&courses, holders, given));
    }

    fn cones_of_holders(&self, bodies: &[BodyId], holders: &[&Pair<'_>]) -> Vec<Cone> {
        let mut cones = Vec::new();
        for pair in holders {
            let id = if bodies.contains(&pair.ids[0]) { pair.ids[0] } else { pair.ids[1] };
            self.add_cones(pair, id, self.span, &mut cones);
        }
        cones
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

fn find(leader: &mut [usize], mut index: usize) -> usize {
    while leader[index] != index {
        leader[index] = leader[leader[index]];
        index = leader[index];
    }
    index
}
