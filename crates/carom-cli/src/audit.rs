//! An audit of collisions that works from poses, masses, shapes and materials of its own.
//!
//! From the record of a collision it takes only who struck whom, when and where, the poses, and the velocities before
//! and after. Mass, inertia, lever arm, normal, C_r and friction it finds again by itself. Contacts that were struck at
//! one instant and hang together through bodies that move are one *instant*: the laws of momentum and energy hold for
//! it as a whole.

use carom::collide::manifolds;
use carom::impulse::Velocity;
use carom::math::{DMat3, DQuat, DVec3, Pose, rotated_diagonal};
use carom::report::Impact;
use carom::{BodyId, Surface, World};
use std::collections::{BTreeMap, HashMap};

/// Relative rounding of the velocities that the engine stores, in single precision: half a unit in the last place for
/// each of linear and angular velocity before and after, doubled for the arithmetic between.
pub const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// How far the shapes' normal may be from the one that was used, rad: normals of meshes and hulls, and of two edges, come
/// out of single precision.
pub const NORMAL_TOLERANCE: f64 = 1e-4;

/// What is held against collisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    /// v_s = −C_r·v_c; where several contacts were struck at once v_s ≥ −C_r·v_c.
    SeparatingSpeed,
    /// Momentum, linear: whatever the sum changed by came through contacts with what can't move.
    LinearMomentum,
    /// Momentum, angular, about the (first) point of the instant.
    AngularMomentum,
    /// Each body was changed by impulses at its contact points, along the normal where there is no friction.
    LineOfAction,
    /// Energy: what C_r takes is lost, no less, and without friction no more.
    Energy,
    /// The normal is the shapes' own.
    Normal,
}

impl Law {
    /// All of them, in the order of reports.
    pub const ALL: [Law; 6] = [
        Law::SeparatingSpeed,
        Law::LinearMomentum,
        Law::AngularMomentum,
        Law::LineOfAction,
        Law::Energy,
        Law::Normal,
    ];

    /// Its name in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "separating_speed",
            Law::LinearMomentum => "linear_momentum",
            Law::AngularMomentum => "angular_momentum",
            Law::LineOfAction => "line_of_action",
            Law::Energy => "energy",
            Law::Normal => "normal",
        }
    }

    /// The unit of its error.
    pub fn unit(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "m/s",
            Law::LinearMomentum | Law::LineOfAction => "N·s",
            Law::AngularMomentum => "N·m·s",
            Law::Energy => "J",
            Law::Normal => "rad",
        }
    }

    /// How its tolerance comes about; ε is [`ROUNDING`].
    pub fn tolerance_rule(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "ε·Σ(|v| + |r|·(|I⁻¹|·|Iω| + |ω|)), over both bodies, before and after",
            Law::LinearMomentum => "ε·Σ(m|v| + (|x−p|·m|v| + |Iω|)/ℓ), before and after; ℓ the longest |x−p|",
            Law::AngularMomentum => "ε·Σ(ℓ·m|v| + |x−p|·m|v| + |Iω|), before and after, p the point",
            Law::LineOfAction => "as momentum, of that body alone",
            Law::Energy => "ε·Σ(m|v|² + |ω|·|Iω|) + (1−C_r²)·|v_c|·(tolerance of the speed)/K",
            Law::Normal => "1e-4 rad: shapes are compared in single precision",
        }
    }
}

/// One law held against one collision (the first of its instant, where the law is about all of them).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Which law.
    pub law: Law,
    /// Which of the impacts that the audit was given.
    pub impact: usize,
    /// How far off.
    pub error: f64,
    /// How far rounding can put it.
    pub tolerance: f64,
}

impl Finding {
    /// Whether the law was broken. An error that is no number breaks every law.
    pub fn is_violation(&self) -> bool {
        !(self.error <= self.tolerance)
    }

    /// Error over tolerance.
    pub fn ratio(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.tolerance }
    }
}

/// What the audit made of some collisions.
#[derive(Debug, Default)]
pub struct Audit {
    /// Every law that was held against something.
    pub findings: Vec<Finding>,
    /// For how many contacts the shapes gave no normal, so that the record's was believed.
    pub without_normal: u64,
}

/// A body at the instant of a collision.
#[derive(Clone, Copy)]
struct Party {
    /// Infinite for what no impulse can move.
    mass: f64,
    /// Zero on axes of infinite inertia.
    inertia: DMat3,
    inverse_inertia: DMat3,
    /// Of infinite inertia: which of the principal axes, in the world.
    stiff: [bool; 3],
    axes: DMat3,
    /// Centre of mass.
    center: DVec3,
    /// Whether impulses change anything about it.
    moves: bool,
}

impl Party {
    fn new(world: &World, id: BodyId, pose: &Pose) -> Option<Self> {
        let mass = world.mass_of(id)?;
        let rotation: DQuat = pose.rotation * mass.principal_rotation;
        let finite = mass.moments.map(|moment| if moment.is_finite() { moment } else { 0.0 });
        let inverse = finite.map(|moment| if moment > 0.0 { 1.0 / moment } else { 0.0 });
        let stiff = mass.moments.to_array().map(|moment| !moment.is_finite());
        Some(Self {
            mass: mass.mass,
            inertia: rotated_diagonal(rotation, finite),
            inverse_inertia: rotated_diagonal(rotation, inverse),
            stiff,
            axes: DMat3::from_quat(rotation),
            center: pose.position,
            moves: mass.mass.is_finite() || stiff.contains(&false),
        })
    }

    /// Its momentum, zero where infinite.
    fn linear(&self, velocity: &Velocity) -> DVec3 {
        if self.mass.is_finite() { self.mass * velocity.linear } else { DVec3::ZERO }
    }

    fn energy(&self, velocity: &Velocity) -> f64 {
        0.5 * (self.linear(velocity).dot(velocity.linear)
            + velocity.angular.dot(self.inertia * velocity.angular))
    }

    /// What rounding of the energy is relative to.
    fn energy_scale(&self, velocity: &Velocity) -> f64 {
        self.linear(velocity).length() * velocity.linear.length()
            + velocity.angular.length() * (self.inertia * velocity.angular).length()
    }

    /// What rounding of the speed at `arm` is relative to.
    fn speed_scale(&self, velocity: &Velocity, arm: DVec3) -> f64 {
        let stretch =
            self.inverse_inertia.x_axis.x + self.inverse_inertia.y_axis.y + self.inverse_inertia.z_axis.z;
        let spin = (self.inertia * velocity.angular).length();
        velocity.linear.length() + arm.length() * (stretch * spin + velocity.angular.length())
    }

    /// The part of its motion at `arm` that no impulse can change.
    fn driven(&self, velocity: &Velocity, arm: DVec3) -> DVec3 {
        let linear = if self.mass.is_finite() { DVec3::ZERO } else { velocity.linear };
        let spin = velocity.angular - self.inverse_inertia * (self.inertia * velocity.angular);
        linear + spin.cross(arm)
    }

    /// What holds it, as impulses that may act on it besides its contacts, about `reference`.
    fn held_by(&self, reference: DVec3, basis: &mut Basis) {
        for (axis, _) in [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis]
            .into_iter()
            .zip(self.stiff)
            .filter(|(_, stiff)| *stiff)
        {
            basis.add(Twist { linear: DVec3::ZERO, angular: axis });
        }
        if self.mass.is_infinite() {
            basis.add_impulses_at(self.center - reference);
        }
    }
}

/// One contact of an instant.
struct Strike {
    impact: usize,
    ids: [BodyId; 2],
    time: f64,
    parties: [Party; 2],
    point: DVec3,
    arms: [DVec3; 2],
    normal: DVec3,
    surface: Surface,
    before: [Velocity; 2],
    after: [Velocity; 2],
    together: u32,
    round: u32,
}

impl Strike {
    fn frictionless(&self) -> bool {
        self.surface.static_friction == 0.0 && self.surface.dynamic_friction == 0.0
    }

    fn speed(&self, velocities: &[Velocity; 2]) -> f64 {
        let [a, b] = [0, 1].map(|side| velocities[side].at(self.arms[side]));
        (b - a).dot(self.normal)
    }

    fn speed_tolerance(&self) -> f64 {
        let of = |side: usize| {
            let (party, arm) = (&self.parties[side], self.arms[side]);
            party.speed_scale(&self.before[side], arm) + party.speed_scale(&self.after[side], arm)
        };
        ROUNDING * (of(0) + of(1))
    }

    /// K: how the unit impulse changes the speed along the normal.
    fn speed_per_impulse(&self) -> f64 {
        let of = |side: usize| {
            let (party, twist) = (&self.parties[side], self.arms[side].cross(self.normal));
            1.0 / party.mass + twist.dot(party.inverse_inertia * twist)
        };
        of(0) + of(1)
    }

    /// The impulses that this contact can have given, about `reference`.
    fn impulses(&self, reference: DVec3, basis: &mut Basis) {
        let lever = self.point - reference;
        if self.frictionless() {
            basis.add(Twist { linear: self.normal, angular: lever.cross(self.normal) });
        } else {
            basis.add_impulses_at(lever);
        }
    }
}

/// Linear momentum, and angular momentum about some reference point: both change by an impulse at once.
#[derive(Clone, Copy)]
struct Twist {
    linear: DVec3,
    angular: DVec3,
}

impl Twist {
    fn dot(&self, other: &Twist) -> f64 {
        self.linear.dot(other.linear) + self.angular.dot(other.angular)
    }

    fn minus(&self, other: &Twist, times: f64) -> Twist {
        Twist { linear: self.linear - times * other.linear, angular: self.angular - times * other.angular }
    }
}

/// An orthonormal basis of all changes of momentum that some impulses can make (at most six dimensions).
struct Basis {
    /// Angular momentum is measured in this length's units, m.
    length: f64,
    vectors: Vec<Twist>,
}

impl Basis {
    fn new(length: f64) -> Self {
        Self { length, vectors: Vec::new() }
    }

    fn add_impulses_at(&mut self, lever: DVec3) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            self.add(Twist { linear: axis, angular: lever.cross(axis) });
        }
    }

    fn add(&mut self, change: Twist) {
        let scaled = Twist { linear: change.linear, angular: change.angular / self.length };
        let size = scaled.dot(&scaled).sqrt();
        let rest = self.outside(self.outside(scaled));
        let left = rest.dot(&rest).sqrt();
        if self.vectors.len() < 6 && left > 1e-9 * size {
            let unit = 1.0 / left;
            self.vectors.push(Twist { linear: rest.linear * unit, angular: rest.angular * unit });
        }
    }

    /// What no combination of the basis explains (scaled).
    fn outside(&self, scaled: Twist) -> Twist {
        self.vectors.iter().fold(scaled, |rest, vector| rest.minus(vector, rest.dot(vector)))
    }

    /// What no combination of the basis explains of a `change`.
    fn unexplained(&self, change: Twist) -> Twist {
        let scaled = Twist { linear: change.linear, angular: change.angular / self.length };
        let rest = self.outside(scaled);
        Twist { linear: rest.linear, angular: rest.angular * self.length }
    }

    /// How much of a change with its scales of rounding is unexplained: linear, angular, and the tolerance (linear).
    /// None if the basis explains everything, so that nothing is judged.
    fn judge(&self, (change, linear_scale, angular_scale): (Twist, f64, f64)) -> Option<(f64, f64, f64)> {
        let rest = self.unexplained(change);
        let tolerance = ROUNDING * (linear_scale + angular_scale / self.length);
        (self.vectors.len() < 6).then(|| (rest.linear.length(), rest.angular.length(), tolerance))
    }
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

/// The contact that a record tells of, with everything but the motion found again.
fn strike(world: &World, index: usize, impact: &Impact, audit: &mut Audit) -> Option<Strike> {
    let (a, b) = (world.description(impact.a)?, world.description(impact.b)?);
    let collider_a = a.colliders.get(impact.collider_a as usize)?;
    let collider_b = b.colliders.get(impact.collider_b as usize)?;
    let center = |id: BodyId| world.mass_of(id).map(|mass| mass.center);
    // Near the point, so that nothing is lost far from the world's origin.
    let near = |pose: &Pose, center: DVec3| {
        Pose::new(pose.position - impact.point - pose.rotation * center, pose.rotation)
    };
    let pose_a = near(&impact.pose_a, center(impact.a)?).then_local(&collider_a.pose);
    let pose_b = near(&impact.pose_b, center(impact.b)?).then_local(&collider_b.pose);
    let arms = [impact.point - impact.pose_a.position, impact.point - impact.pose_b.position];

    let size = collider_a.shape.reach(DVec3::ZERO).min(collider_b.shape.reach(DVec3::ZERO));
    let mut found = Vec::new();
    manifolds((&collider_a.shape, &pose_a), (&collider_b.shape, &pose_b), 1e-3 * size, &mut found);
    let normal = nearest_normal(&found, impact.contact.normal, 1e-3 * size);
    match normal {
        Some(normal) => audit.findings.push(Finding {
            law: Law::Normal,
            impact: index,
            error: normal.cross(impact.contact.normal).length().atan2(normal.dot(impact.contact.normal)),
            tolerance: NORMAL_TOLERANCE,
        }),
        None => audit.without_normal += 1,
    }

    Some(Strike {
        impact: index,
        ids: [impact.a, impact.b],
        time: impact.time,
        parties: [Party::new(world, impact.a, &impact.pose_a)?, Party::new(world, impact.b, &impact.pose_b)?],
        point: impact.point,
        arms,
        normal: normal.unwrap_or(impact.contact.normal),
        surface: Surface::between(&collider_a.material, &collider_b.material),
        before: [impact.side_a.velocity, impact.side_b.velocity],
        after: [impact.after_a, impact.after_b],
        together: impact.together,
        round: impact.round,
    })
}

/// The normal of the contact point nearest to the origin. Where several are about as near (a corner over the seam of two
/// triangles), the one most like `used`.
fn nearest_normal(found: &[carom::collide::Manifold], used: DVec3, margin: f64) -> Option<DVec3> {
    let points = || {
        found
            .iter()
            .flat_map(|manifold| manifold.points().iter().map(move |at| (at.point.length(), manifold.normal)))
    };
    let nearest = points().map(|(distance, _)| distance).min_by(f64::total_cmp)?;
    points()
        .filter(|(distance, _)| *distance <= nearest + margin)
        .map(|(_, normal)| normal)
        .max_by(|a, b| a.dot(used).total_cmp(&b.dot(used)))
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
    groups
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
