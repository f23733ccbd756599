//! An audit of collisions that works from poses, masses, shapes and materials of its own.
//!
//! From the record of a collision it takes only who struck whom, when and where, the poses, and the velocities before
//! and after. Mass, inertia, lever arm, normal, C_r and friction it finds again by itself. Contacts that were struck at
//! one instant and hang together through bodies that move are one *instant*: the laws of momentum and energy hold for
//! it as a whole.

mod impulses;
mod law;
mod strike;

pub use law::{Finding, Law};

use carom::impulse::Velocity;
use carom::math::DVec3;
use carom::report::Impact;
use carom::{BodyId, World};
use impulses::{Basis, Twist};
use law::ROUNDING;
use std::collections::{BTreeMap, HashMap};
use strike::{Party, Strike, strike};

/// What the audit made of some collisions.
#[derive(Debug, Default)]
pub struct Audit {
    /// Every law that was held against something.
    pub findings: Vec<Finding>,
    /// For how many contacts the shapes gave no normal, so that the record's was believed.
    pub without_normal: u64,
}

/// A body over all rounds of an instant.
struct Course {
    party: Party,
    before: Velocity,
    after: Velocity,
}

impl Course {
    /// Change of momentum about `reference`, and what its rounding is relative to: linear and angular.
    fn change(&self, reference: DVec3) -> (Twist, f64, f64) {
        let party = &self.party;
        let offset = party.center - reference;
        let linear = party.linear(&self.after) - party.linear(&self.before);
        let spin = party.inertia * (self.after.angular - self.before.angular);
        let linear_scale = party.linear(&self.after).length() + party.linear(&self.before).length();
        let spin_scale =
            (party.inertia * self.after.angular).length() + (party.inertia * self.before.angular).length();
        let change = Twist { linear, angular: offset.cross(linear) + spin };
        (change, linear_scale, offset.length() * linear_scale + spin_scale)
    }
}

/// Holds the collisions of one step to the laws.
pub fn audit(world: &World, impacts: &[Impact]) -> Audit {
    let mut audit = Audit::default();
    let mut strikes = Vec::with_capacity(impacts.len());
    for (index, impact) in impacts.iter().enumerate() {
        strikes.extend(strike(world, index, impact, &mut audit));
    }
    for strike in &strikes {
        audit.findings.push(separating_speed(strike));
    }
    for instant in instants(&strikes) {
        momentum(&instant, &mut audit.findings);
        audit.findings.extend(energy(&instant));
    }
    audit
}

/// The strikes that happened at one time and hang together through bodies that move, each group in order of rounds.
fn instants(strikes: &[Strike]) -> Vec<Vec<&Strike>> {
    // Disjoint sets of strikes, by the first strike that each body takes part in.
    let mut leader: Vec<usize> = (0..strikes.len()).collect();
    let mut first_of: HashMap<(u64, BodyId), usize> = HashMap::new();
    for (index, strike) in strikes.iter().enumerate() {
        for side in (0..2).filter(|&side| strike.parties[side].moves) {
            let first = *first_of.entry((strike.time.to_bits(), strike.ids[side])).or_insert(index);
            let (one, other) = (find(&mut leader, first), find(&mut leader, index));
            leader[one.max(other)] = one.min(other);
        }
    }
    let mut groups: Vec<Vec<&Strike>> = strikes.iter().map(|_| Vec::new()).collect();
    for (index, strike) in strikes.iter().enumerate() {
        groups[find(&mut leader, index)].push(strike);
    }
    groups.retain(|group| !group.is_empty());
    for group in &mut groups {
        group.sort_by_key(|strike| (strike.round, strike.impact));
    }
    let alone = |group: Vec<_>| group.into_iter().map(|strike| vec![strike]).collect();
    groups
        .into_iter()
        .flat_map(|group| if is_continuous(&group) { vec![group] } else { alone(group) })
        .collect()
}

/// Whether each body comes to each round as it left the one before. It does not where contacts that rest have pushed it in
/// between; then each strike of the instant is judged alone.
fn is_continuous(instant: &[&Strike]) -> bool {
    let mut left: HashMap<BodyId, Velocity> = HashMap::new();
    instant.iter().all(|strike| {
        (0..2).filter(|&side| strike.parties[side].moves).all(|side| {
            let before = left.insert(strike.ids[side], strike.after[side]);
            before.is_none_or(|velocity| velocity == strike.before[side])
        })
    })
}

fn find(leader: &mut [usize], mut index: usize) -> usize {
    while leader[index] != index {
        leader[index] = leader[leader[index]];
        index = leader[index];
    }
    index
}

/// Each body that moves, over all rounds of an instant, in order of its id.
fn courses(instant: &[&Strike]) -> BTreeMap<BodyId, Course> {
    let mut courses: BTreeMap<BodyId, Course> = BTreeMap::new();
    for strike in instant {
        for side in (0..2).filter(|&side| strike.parties[side].moves) {
            let (party, before, after) = (strike.parties[side], strike.before[side], strike.after[side]);
            let course = courses.entry(strike.ids[side]).or_insert(Course { party, before, after });
            course.after = after;
        }
    }
    courses
}

fn separating_speed(strike: &Strike) -> Finding {
    let wanted = -strike.surface.restitution * strike.speed(&strike.before);
    let lack = wanted - strike.speed(&strike.after);
    Finding {
        law: Law::SeparatingSpeed,
        impact: strike.impact,
        // Struck together with others, a contact may well part faster.
        error: if strike.together > 1 { positive(lack) } else { lack.abs() },
        tolerance: strike.speed_tolerance(),
    }
}

/// `value` if it is positive or no number at all, else 0.
fn positive(value: f64) -> f64 {
    if value <= 0.0 { 0.0 } else { value }
}

/// Linear and angular momentum of all that was struck, and of each body by itself.
fn momentum(instant: &[&Strike], findings: &mut Vec<Finding>) {
    let courses = courses(instant);
    let Some(first) = instant.first() else { return };
    let reference = first.point;
    let offsets = courses.values().map(|course| course.party.center.distance(reference));
    let levers = instant.iter().map(|strike| strike.point.distance(reference));
    let length = offsets.chain(levers).fold(0.0, f64::max);
    let length = if length > 0.0 { length } else { 1.0 };

    // Contacts within the group cancel; what passes to the immovable does not.
    let mut to_world = Basis::new(length);
    for strike in instant.iter().filter(|strike| strike.parties.iter().any(|party| !party.moves)) {
        strike.impulses(reference, &mut to_world);
    }
    let mut sum = (Twist { linear: DVec3::ZERO, angular: DVec3::ZERO }, 0.0, 0.0);
    for (&id, course) in &courses {
        let change = course.change(reference);
        sum.0 = sum.0.minus(&change.0, -1.0);
        sum.1 += change.1;
        sum.2 += change.2;
        course.party.held_by(reference, &mut to_world);

        let mut own = Basis::new(length);
        course.party.held_by(reference, &mut own);
        for strike in instant.iter().filter(|strike| strike.ids.contains(&id)) {
            strike.impulses(reference, &mut own);
        }
        if let Some((linear, angular, tolerance)) = own.judge(change) {
            findings.push(Finding {
                law: Law::LineOfAction,
                impact: first.impact,
                error: linear + angular / length,
                tolerance,
            });
        }
    }
    if let Some((linear, angular, tolerance)) = to_world.judge(sum) {
        let impact = first.impact;
        findings.push(Finding { law: Law::LinearMomentum, impact, error: linear, tolerance });
        let tolerance = tolerance * length;
        findings.push(Finding { law: Law::AngularMomentum, impact, error: angular, tolerance });
    }
}

/// Energy of all that was struck. None where something that is driven took part in several contacts: how much it gave
/// in which can't be told.
fn energy(instant: &[&Strike]) -> Option<Finding> {
    let courses = courses(instant);
    let first = instant.first()?;
    let mut change = 0.0;
    let mut scale = 0.0;
    for Course { party, before, after } in courses.values() {
        change += party.energy(after) - party.energy(before);
        scale += party.energy_scale(after) + party.energy_scale(before);
    }
    let mut tolerance = ROUNDING * scale;
    let driven = |strike: &Strike| {
        let [a, b] = [0, 1].map(|side| strike.parties[side].driven(&strike.before[side], strike.arms[side]));
        a - b
    };
    let impact = first.impact;
    if instant.len() > 1 {
        let at_rest = instant.iter().all(|strike| driven(strike) == DVec3::ZERO);
        let error = positive(change);
        return at_rest.then_some(Finding { law: Law::Energy, impact, error, tolerance });
    }

    let drive = driven(first);
    if drive != DVec3::ZERO {
        let (impulse, rounding) = impulse_on_b(first)?;
        change -= impulse.dot(drive);
        tolerance += rounding * drive.length();
    }
    let per_impulse = first.speed_per_impulse();
    if per_impulse > 0.0 {
        let lost = 1.0 - first.surface.restitution * first.surface.restitution;
        let closing = first.speed(&first.before);
        change += 0.5 * lost * closing * closing / per_impulse;
        tolerance += lost * closing.abs() * first.speed_tolerance() / per_impulse;
    }
    let exact = first.frictionless() && first.together == 1;
    let error = if exact { change.abs() } else { positive(change) };
    Some(Finding { law: Law::Energy, impact, error, tolerance })
}

/// The impulse on b, from the body whose change tells it best, and its rounding.
fn impulse_on_b(strike: &Strike) -> Option<(DVec3, f64)> {
    let told_by = |side: usize| {
        let party = &strike.parties[side];
        let (before, after) = (party.linear(&strike.before[side]), party.linear(&strike.after[side]));
        let impulse = if side == 1 { after - before } else { before - after };
        party.mass.is_finite().then(|| (impulse, ROUNDING * (before.length() + after.length())))
    };
    [told_by(0), told_by(1)].into_iter().flatten().min_by(|one, other| one.1.total_cmp(&other.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom::{Body, Settings, Shape};

    /// A spinning ball that hits a resting one (or an immovable box) off its centre, as a world and the record of it.
    fn hit(friction: f64, immovable: bool) -> (World, Impact) {
        let mut world = World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() });
        let target = if immovable {
            Body::fixed().with(Shape::cuboid(1.0, 4.0, 4.0))
        } else {
            Body::dynamic().with(Shape::sphere(0.5))
        };
        world.add(target.friction(friction).restitution(0.5));
        let ball = Body::dynamic().at(-1.5, 0.3, 0.1).with(Shape::sphere(0.5)).moving(3.0, 0.1, 0.0);
        world.add(ball.spinning(1.0, 2.0, 3.0).friction(friction).restitution(0.5));
        for _ in 0..600 {
            let impacts = world.step(1.0 / 60.0).impacts().to_vec();
            if let [impact] = impacts.as_slice() {
                return (world, impact.clone());
            }
        }
        panic!("they missed each other");
    }

    fn broken(world: &World, impact: &Impact) -> Vec<Law> {
        let audit = audit(world, std::slice::from_ref(impact));
        assert_eq!(audit.without_normal, 0);
        let mut laws: Vec<Law> = audit
            .findings
            .iter()
            .filter(|finding| finding.is_violation())
            .map(|finding| finding.law)
            .collect();
        laws.sort_unstable();
        laws.dedup();
        laws
    }

    #[test]
    fn what_the_engine_does_keeps_every_law() {
        for (friction, immovable) in [(0.0, false), (0.0, true), (0.3, false), (0.3, true)] {
            let (world, impact) = hit(friction, immovable);
            assert_eq!(broken(&world, &impact), []);
        }
    }

    #[test]
    fn a_wrong_separating_speed_is_found() {
        let (world, mut impact) = hit(0.0, true);
        impact.after_b.linear *= 1.0 + 1e-4;
        assert!(broken(&world, &impact).contains(&Law::SeparatingSpeed));
    }

    #[test]
    fn momentum_out_of_nothing_is_found() {
        let (world, mut impact) = hit(0.3, false);
        // Across the normal, so that the separating speed stays right.
        impact.after_b.linear += impact.contact.normal.any_orthogonal_vector().normalize() * 1e-3;
        let broken = broken(&world, &impact);
        assert!(broken.contains(&Law::LinearMomentum) && broken.contains(&Law::LineOfAction), "{broken:?}");
        assert!(!broken.contains(&Law::SeparatingSpeed));
    }

    #[test]
    fn spin_out_of_nothing_is_found_also_beside_what_can_not_move() {
        for immovable in [false, true] {
            let (world, mut impact) = hit(0.3, immovable);
            impact.after_b.angular += impact.contact.normal * 1e-3;
            assert!(broken(&world, &impact).contains(&Law::AngularMomentum));
        }
    }

    #[test]
    fn friction_where_there_is_none_is_found() {
        let (world, mut impact) = hit(0.0, true);
        let push = impact.contact.normal.any_orthogonal_vector().normalize() * 1e-3;
        impact.after_b.linear += push / impact.side_b.mass;
        impact.after_b.angular += impact.side_b.inverse_inertia * impact.side_b.arm.cross(push * 1e3);
        assert!(broken(&world, &impact).contains(&Law::LineOfAction));
    }

    #[test]
    fn energy_out_of_nothing_is_found() {
        let (world, mut impact) = hit(0.3, false);
        impact.after_b.angular *= 3.0;
        assert!(broken(&world, &impact).contains(&Law::Energy));
    }

    #[test]
    fn a_wrong_normal_and_no_number_are_found() {
        let (world, mut impact) = hit(0.0, false);
        impact.contact.normal = (impact.contact.normal + DVec3::Y * 0.01).normalize();
        assert_eq!(broken(&world, &impact), [Law::Normal], "the rest is held against the shapes' own normal");
        impact.after_a.linear.x = f64::NAN;
        assert!(broken(&world, &impact).contains(&Law::LinearMomentum));
    }
}
