//! What rests: pairs that touch without bouncing, and what holds them.
//!
//! A pair that touches more slowly than the rest threshold is handed over from the impacts to this file, and stays here until it
//! parts. In each substep
//!
//! 1. pairs that have come to rest against each other get contacts;
//! 2. bodies that have moved since their contacts were last looked at have them renewed; impulses are kept, by features;
//! 3. impulses are found with which no point closes further than its gap: those of the substep before act again, and
//!    sweeps over all contacts change them until velocities agree ([`graph`](crate::solver::graph));
//! 4. each body gets its path for the substep.
//!
//! Contacts are hard: they need no overlap to press, so that nothing sinks under a load.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::Manifold;
use crate::flight::Influence;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::{DMat3, DVec3, rotation_from_vector};
use crate::solver::bundle::field;
use crate::solver::direct::Mobility;
use crate::solver::graph::{Effort, Graph};
use crate::solver::lanes::Row;
use crate::solver::prepare::{Remembered, Side, Terms, lane};
use crate::solver::rows::Rows;
use crate::step::motion::{advance, free_influence, set_pace};
use crate::step::pairs::{Pair, Pairs, Support};

/// Motion of a body, as a share of its smallest collider's reach or in radians, after which its contacts are renewed: at
/// the start of a step, and within one.
const DRIFT: f64 = 1e-3;
const DRIFT_WITHIN: f64 = 2e-2;

/// Velocities agree when a sweep changes them by no more than this share of what gravity does in a substep; those of small
/// islands, which are solved directly, when nothing is further off than the second.
const AGREEMENT: f64 = 1e-3;
const EXACTNESS: f64 = 1e-5;
const QUIET: f64 = 3.0;

/// Sweeps that every contact gets in a substep, that an island in motion may take, and contacts times sweeps that one about to
/// rest may.
const SWEEPS: u32 = 2;
const IN_MOTION: u32 = 8;
const BUDGET: u32 = 40_000;

/// Share of an overlap that is pushed out at the end of a step, and of the contact margin that is left.
const PUSH_OUT: f32 = 0.5;
const LEFT_IN: f64 = 0.1;

/// Contacts, and the bodies that they hold.
pub(crate) struct Rest {
    graph: Graph,
    rows: Rows,
    /// The pairs that rest, in the order in which they came to.
    resting: Vec<usize>,
}

/// A stretch of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub from: f64,
    pub until: f64,
}

impl Rest {
    pub fn new() -> Self {
        Self { graph: Graph::default(), rows: Rows::new(), resting: Vec::new() }
    }

    /// Starts a step with other pairs; those that have `parted` lose their contacts.
    pub fn begin_step(&mut self, bodies: &mut Bodies, pairs: &Pairs, parted: Vec<Pair>) {
        self.rows.grow(bodies.states.len());
        parted.iter().for_each(|pair| self.drop_contacts(pair));
        self.resting = (0..pairs.len()).filter(|&index| pairs[index].rests).collect();
        for &index in &self.resting {
            let rows = pairs[index].rows;
            if rows.into_iter().any(|row| bodies.constants[row].is_movable() && !bodies.is_asleep(row)) {
                rows.into_iter().for_each(|row| {
                    bodies.wake(row);
                });
            }
        }
    }

    /// Lets go of the contacts of a pair.
    pub fn drop_contacts(&mut self, pair: &Pair) {
        for support in &pair.supports {
            self.release(support);
        }
    }

    fn release(&mut self, support: &Support) {
        for row in self.graph.rows(support.contact) {
            self.rows.let_go(row as usize);
        }
        self.graph.remove(support.contact);
    }

    /// The body of `row` is no more; that of the last row, `last`, gets its row.
    pub fn remove_row(&mut self, row: usize, last: usize) {
        self.rows.grow(last + 1);
        self.rows.swap_remove(row);
        if row != last {
            self.graph.rename_row(last as u32, row as u32);
        }
    }

    /// Whether contacts decide how the body of a row moves.
    pub fn is_held(&self, row: usize) -> bool {
        self.rows.is_held(row)
    }

    /// Gives contacts to the pairs that have come to rest against each other by `time`.
    pub fn adopt(&mut self, bodies: &mut Bodies, pairs: &mut Pairs, law: RestLaw, span: Span) {
        let margin = law.contact_margin();
        for index in 0..pairs.len() {
            let pair = &pairs[index];
            if pair.rests || pair.sensor || pair.least_separation(bodies, span.from) > margin {
                continue;
            }
            let Some(approach) = Approach::of(bodies, pair.colliders, law) else { continue };
            let separation = approach.separation(span.from);
            let rests = separation <= margin && approach.rests(span.from);
            pairs[index].measured(bodies, separation, span.from);
            if rests {
                self.take(bodies, pairs, index, (law, span));
            }
        }
    }

    /// Gives contacts to a pair at the start of `span`.
    pub fn take(&mut self, bodies: &mut Bodies, pairs: &mut Pairs, index: usize, at: (RestLaw, Span)) {
        for row in pairs[index].rows {
            bodies.wake(row);
            advance(bodies, row, at.1.from);
            if !self.rows.is_held(row) {
                self.rows.anchor(bodies, row);
            }
            self.rows.read_drift(bodies, row, 1.0);
        }
        pairs[index].rests = true;
        self.renew(bodies, &mut pairs[index], at);
        if pairs[index].rests {
            self.resting.push(index);
        }
    }

    /// Looks at a pair closely: new geometry, old impulses. A pair that is out of reach rests no more.
    fn renew(&mut self, bodies: &Bodies, pair: &mut Pair, (law, span): (RestLaw, Span)) {
        let (Some(a), Some(b)) = (bodies.collider(pair.colliders.0), bodies.collider(pair.colliders.1))
        else {
            return;
        };
        let margin = law.contact_margin();
        let grain = a.reach.min(b.reach);
        let way = |side: usize| {
            let (linear, angular) = bodies.paces[pair.rows[side]];
            linear + angular * pair.spin_reach[side]
        };
        let ahead = ((way(0) + way(1)) * (law.step - span.from)).min(0.2 * grain);
        let approach = Approach::new(bodies, a, b, law);
        let mut manifolds = Vec::new();
        approach.manifolds(span.from, margin + 0.01 * grain + ahead, &mut manifolds);

        let side = |collider: &crate::bodies::ColliderRow, outward: DVec3, point: DVec3| {
            let constants = &bodies.constants[collider.row];
            let center = bodies.center_pose(collider);
            let pose = center.then_local(&collider.local);
            let local = (pose.inverse_transform_point(point), pose.rotation.conjugate() * outward);
            let movable = constants.is_movable();
            Side {
                center: center.position,
                inverse_mass: constants.inverse_mass,
                inverse_inertia: if movable {
                    constants.inverse_inertia(center.rotation)
                } else {
                    DMat3::ZERO
                },
                drift: self.rows.drift(collider.row),
                roundness: collider.shape.roundness(local.0, local.1),
            }
        };
        let terms = Terms { surface: pair.surface, margin, horizon: horizon(pair, grain, law) };
        let old = std::mem::take(&mut pair.supports);
        let lanes: Vec<_> = manifolds
            .iter()
            .filter(|manifold| !manifold.points().is_empty())
            .map(|manifold| {
                let normal = manifold.normal;
                let at = manifold.points()[0].point;
                let sides = [side(a, normal, at), side(b, -normal, at)];
                let remembered = self.remembered(&old, manifold);
                (manifold, lane(normal, manifold.points(), &sides, &terms, &remembered))
            })
            .collect();
        let rows = pair.rows.map(|row| row as u32);
        let movable = pair.rows.map(|row| bodies.constants[row].is_movable());
        for (number, (manifold, lane)) in lanes.iter().enumerate() {
            let contact = match old.get(number) {
                Some(support) => {
                    self.graph.write(support.contact, lane);
                    support.contact
                }
                None => {
                    pair.rows.into_iter().for_each(|row| self.rows.hold(row));
                    self.graph.insert(rows, movable, lane)
                }
            };
            pair.supports.push(Support::new(contact, manifold));
        }
        for support in old.iter().skip(lanes.len()) {
            self.release(support);
        }
        pair.rests = !pair.supports.is_empty();
    }

    /// The impulses of the contacts that a manifold follows upon: point by point where the same features touch, else in equal
    /// parts.
    fn remembered(&self, old: &[Support], manifold: &Manifold) -> Remembered {
        let mut remembered = Remembered::default();
        let mut matched = false;
        for (entry, point) in remembered.pressure.iter_mut().zip(manifold.points()) {
            let features = (point.feature_a, point.feature_b);
            for support in old {
                if let Some(index) = support.features().iter().position(|&it| it == features) {
                    *entry =
                        f64::from(self.graph.get(support.contact, field::of_point(index, field::IMPULSE)));
                    matched = true;
                    break;
                }
            }
        }
        let alike = old.iter().max_by(|x, y| {
            let likeness = |support: &Support| support.normal.dot(manifold.normal);
            likeness(x).total_cmp(&likeness(y))
        });
        let Some(support) = alike.filter(|support| support.normal.dot(manifold.normal) > 0.9) else {
            return remembered;
        };
        let read = |field: usize| f64::from(self.graph.get(support.contact, field));
        let axis = |field: usize| DVec3::new(read(field), read(field + 1), read(field + 2));
        let (first, normal) = (axis(field::TANGENT), axis(field::NORMAL));
        remembered.friction = first * read(field::FRICTION) + normal.cross(first) * read(field::FRICTION + 1);
        remembered.twist = read(field::TWIST);
        if !matched {
            let count = support.features().len();
            let total: f64 = (0..count).map(|index| read(field::of_point(index, field::IMPULSE))).sum();
            let points = manifold.points().len();
            remembered.pressure[..points].fill(total / points as f64);
        }
        remembered
    }

    /// Finds what holds the bodies that rest on something during `span`, and gives them their paths; returns the rows of these
    /// bodies.
    pub fn hold(&mut self, bodies: &mut Bodies, pairs: &mut Pairs, law: RestLaw, span: Span) -> Vec<usize> {
        let held = self.rows.held().to_vec();
        for &row in &held {
            advance(bodies, row, span.from);
        }
        let limit = if span.from == 0.0 { DRIFT } else { DRIFT_WITHIN };
        self.renew_moved(bodies, pairs, &held, (law, span, limit));
        self.graph.measure(&self.rows.drifts);
        self.let_part(pairs, law);
        self.push(bodies, law, span)
    }

    /// Renews the contacts of the bodies that have moved further than `limit` from their anchors.
    fn renew_moved(
        &mut self,
        bodies: &mut Bodies,
        pairs: &mut Pairs,
        held: &[usize],
        (law, span, limit): (RestLaw, Span, f64),
    ) {
        let mut has_moved = vec![false; bodies.states.len()];
        for &row in held {
            if self.rows.read_drift(bodies, row, bodies.grains[row]) > limit {
                has_moved[row] = true;
                self.rows.anchor(bodies, row);
            }
        }
        for index in 0..self.resting.len() {
            let pair = &mut pairs[self.resting[index]];
            if pair.rests && pair.rows.into_iter().any(|row| has_moved[row]) {
                self.renew(bodies, pair, (law, span));
            }
        }
        self.resting.retain(|&index| pairs[index].rests);
    }

    /// Lets go of pairs whose every point is further apart than the contact margin.
    fn let_part(&mut self, pairs: &mut Pairs, law: RestLaw) {
        let margin = law.contact_margin() as f32;
        let resting = std::mem::take(&mut self.resting);
        for &index in &resting {
            let gap = |support: &Support| self.graph.get(support.contact, field::GAP);
            let pair = &mut pairs[index];
            if pair.supports.iter().all(|support| gap(support) > margin) {
                self.drop_contacts(pair);
                pair.rests = false;
                pair.supports.clear();
            }
        }
        self.resting = resting;
        self.resting.retain(|&index| pairs[index].rests);
    }

    /// Solves, and turns the velocities found into paths.
    fn push(&mut self, bodies: &mut Bodies, law: RestLaw, span: Span) -> Vec<usize> {
        let substep = span.until - span.from;
        let held = self.rows.held().to_vec();
        let mut gains = Vec::with_capacity(held.len());
        for &row in &held {
            let free = if bodies.is_asleep(row) {
                Influence::default()
            } else {
                free_influence(bodies, row, law.gravity)
            };
            let inverse_inertia = bodies.constants[row].inverse_inertia(bodies.states[row].rotation);
            let gain = [free.acceleration * substep, inverse_inertia * free.torque * substep];
            self.rows.read_velocity(bodies, row, gain);
            gains.push((gain, free.torque * substep, self.rows.velocities[row]));
        }
        self.graph.begin(&mut self.rows.velocities, law.contact_margin(), substep);
        let persisting: Vec<Row> = held.iter().map(|&row| self.rows.velocities[row]).collect();
        let agreement = (AGREEMENT * law.gravity.length() * substep).max(1e-7) as f32;
        let exactness = (EXACTNESS * law.gravity.length() * substep).max(1e-7) as f32;
        let quiet = (QUIET * law.gravity.length() * substep) as f32;
        let effort =
            Effort { agreement, exactness, quiet, sweeps: SWEEPS, in_motion: IN_MOTION, budget: BUDGET };
        self.graph.solve(&mut self.rows.velocities, effort, |row| {
            let (state, constants) = (&bodies.states[row as usize], &bodies.constants[row as usize]);
            constants.is_movable().then(|| Mobility {
                inverse_mass: constants.inverse_mass,
                inverse_inertia: constants.inverse_inertia(state.rotation),
            })
        });

        for ((&row, (gain, turn, before)), warm) in held.iter().zip(gains).zip(persisting) {
            if !bodies.constants[row].is_movable() || bodies.is_asleep(row) {
                continue;
            }
            let after = self.rows.velocities[row];
            let [linear, angular] = difference(&after, &before);
            let inertia = bodies.constants[row].inertia(bodies.states[row].rotation);
            let mut change = [gain[0] + linear, turn + inertia * angular];
            if linear.length() > SUPPORTED * gain[0].length() {
                capture(bodies, row, &mut change, law);
            }
            let sudden = difference(&after, &warm);
            let steady =
                sudden[0].length().max(sudden[1].length() * bodies.grains[row]) <= STEADY * gain[0].length();
            follow(bodies, row, change, (substep, steady));
            set_pace(bodies, row, span.until);
        }
        held
    }

    /// Pushes overlaps out, at the end of a step; velocities stay.
    pub fn push_out(&mut self, bodies: &mut Bodies, law: RestLaw) {
        let held = self.rows.held().to_vec();
        for &row in &held {
            self.rows.read_drift(bodies, row, 1.0);
            let velocity = self.rows.velocities[row].0;
            let still = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, velocity[6], velocity[7]];
            self.rows.displacements[row] = Row(still);
        }
        self.graph.measure(&self.rows.drifts);
        let allowed = (LEFT_IN * law.contact_margin()) as f32;
        if !self.graph.push_out(&mut self.rows.displacements, PUSH_OUT, allowed) {
            return;
        }
        for &row in &held {
            let [linear, angular] = difference(&self.rows.displacements[row], &Row::ZERO);
            if linear != DVec3::ZERO || angular != DVec3::ZERO {
                let state = &mut bodies.states[row];
                state.position += linear;
                state.rotation = (rotation_from_vector(angular) * state.rotation).normalize();
                bodies.ways[row].0 += linear.length();
                bodies.ways[row].1 += angular.length();
            }
        }
    }

    /// The pairs that touch.
    pub fn touching<'a>(&'a self, pairs: &'a Pairs, law: RestLaw) -> impl Iterator<Item = &'a Pair> {
        let margin = law.contact_margin() as f32;
        let touches = move |support: &Support| self.graph.get(support.contact, field::GAP) <= margin;
        self.resting.iter().map(|&index| &pairs[index]).filter(move |pair| pair.supports.iter().any(touches))
    }

    /// Whether all points of a pair that rests are so near that the contacts have them all.
    pub fn is_closed(&self, pair: &Pair) -> bool {
        pair.supports.iter().all(|support| {
            let get = |field: usize| self.graph.get(support.contact, field);
            get(field::WIDEST) <= get(field::HORIZON)
        })
    }

    /// Whether a point of a pair that rests will strike in the time left of a substep: one that comes from further away than
    /// contacts reach, or one that a collision has set in motion.
    pub fn is_driven(&self, bodies: &Bodies, pair: &Pair, law: RestLaw, span: Span) -> bool {
        let left = span.until - span.from;
        let grain = bodies.grains[pair.rows[0]].min(bodies.grains[pair.rows[1]]);
        let horizon = horizon(pair, grain, law);
        let pressed = if pair.surface.restitution > 0.0 { 0.0 } else { PRESSED * grain / law.substep };
        let motion = pair.rows.map(|row| {
            let state = &bodies.states[row];
            (state.velocity, bodies.constants[row].angular_velocity(state))
        });
        pair.supports.iter().any(|support| {
            let get = |field: usize| f64::from(self.graph.get(support.contact, field));
            let axis = |field: usize| DVec3::new(get(field), get(field + 1), get(field + 2));
            let (normal, first) = (axis(field::NORMAL), axis(field::TANGENT));
            let second = normal.cross(first);
            let inward = |v: DVec3| DVec3::new(v.dot(first), v.dot(second), v.dot(normal));
            let relative = (motion[1].0 - motion[0].0).dot(normal);
            let (spin_a, spin_b) = (inward(motion[0].1), inward(motion[1].1));
            (0..support.features().len()).any(|point| {
                let at = |line: usize| field::of_point(point, line);
                let (arm_a, arm_b) = (axis(at(field::ARM_A)), axis(at(field::ARM_B)));
                let speed = relative + (spin_b.x * arm_b.y - spin_b.y * arm_b.x)
                    - (spin_a.x * arm_a.y - spin_a.y * arm_a.x);
                let gap = get(at(field::SEPARATION));
                let slowest = if gap > horizon { law.drift_speed() } else { law.drift_speed().max(pressed) };
                speed < -slowest && gap + speed * left < 0.0
            })
        })
    }
}

/// A resting pair that loses its speed in a collision is left to the contacts if it would go no further into the other body
/// within a substep than this share of the smaller reach.
const PRESSED: f64 = 0.02;

/// Gap (m) up to which the contacts of a resting pair see to a point: what does not bounce and comes no faster than contacts can
/// be left to deal with is stopped by them, at the end of the substep in which it touches. Faster points, and all that bounce,
/// strike at their own instant.
fn horizon(pair: &Pair, grain: f64, law: RestLaw) -> f64 {
    if pair.surface.restitution > 0.0 {
        law.contact_margin()
    } else {
        law.contact_margin().max(PRESSED * grain)
    }
}

/// Where the sweeps change a body's velocity by less than this share of what gravity does, the forces on it persist.
const STEADY: f64 = 0.05;

fn difference(after: &Row, before: &Row) -> [DVec3; 2] {
    let change = |index: usize| f64::from(after.0[index] - before.0[index]);
    [DVec3::new(change(0), change(1), change(2)), DVec3::new(change(3), change(4), change(5))]
}

/// What rests on something and moves no faster than [`CAPTURED`] rest thresholds loses this share of its speed in a second,
/// fading out towards that speed. Rolling has no friction of its own: without it a ball would roll about a pile for ever at a
/// speed that gravity and the substep hardly tell from rest.
const RESISTANCE: f64 = 2.0;
const CAPTURED: f64 = 4.0;

/// A body rests on something if contacts push it by more than this share of what gravity does.
const SUPPORTED: f64 = 0.5;

/// Rest capture: takes a little of what a supported body has near the rest threshold. Vanishes without gravity.
fn capture(bodies: &Bodies, row: usize, change: &mut [DVec3; 2], law: RestLaw) {
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    let (velocity, momentum) = (state.velocity + change[0], state.angular_momentum + change[1]);
    let spin = constants.inverse_inertia(state.rotation) * momentum;
    let speed = velocity.length().max(spin.length() * bodies.grains[row]);
    let slowness = 1.0 - speed / (CAPTURED * law.rest_speed());
    if slowness > 0.0 {
        let share = RESISTANCE * law.substep * slowness;
        change[0] -= share * velocity;
        change[1] -= share * momentum;
    }
}

/// Sets a body on its path for a substep in which its velocity and angular momentum get `change`d: a parabola where the forces
/// persist, so that what slides or rolls gets the distance right; else with the new velocity from the start, as what meets
/// an obstacle must not go on into it for half a substep.
fn follow(bodies: &mut Bodies, row: usize, change: [DVec3; 2], (substep, steady): (f64, bool)) {
    let state = &mut bodies.states[row];
    bodies.influences[row] = if steady {
        Influence { acceleration: change[0] / substep, torque: change[1] / substep }
    } else {
        state.velocity += change[0];
        state.angular_momentum += change[1];
        Influence::default()
    };
    debug_assert!(row != WORLD_ROW);
}
