//! What rests: pairs that touch without bouncing, and the forces that hold them.
//!
//! A pair that touches more slowly than the rest threshold is handed over from the impacts to this file, and stays here
//! until it parts. Bodies that such pairs connect settle together, as often in a step as something happens to one
//! of them, each time for what is left of the step:
//!
//! 1. whatever still closes is stopped, by impulses with C_r = 0;
//! 2. the forces are found which let no point close until the end of the step, and which then act evenly, like gravity
//!    does, while the bodies fly on (Baraff 1989).
//!
//! So a body at rest moves along the same exact path as a flying one, and an impact finds it where it truly is.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::Manifold;
use crate::impacts::strike::push;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::{DMat3, DVec3, rotation_from_vector};
use crate::report::Feature;
use crate::solver::contact::{ContactRow, Effort, Mover, solve};
use crate::step::broad_phase::ColliderPair;
use crate::step::motion::{advance, free_influence};
use std::collections::{BTreeMap, BTreeSet};

/// Sweeps of the solver each time that bodies settle.
const SWEEPS: usize = 2000;

/// Velocities of resting points agree when they differ by no more than this share of what gravity does meanwhile.
const AGREEMENT: f64 = 1e-9;

/// A force at a contact point (pressure and friction, N), remembered to start the next search from.
#[derive(Clone, Copy, Debug)]
struct Held {
    features: (Feature, Feature),
    pressure: f64,
    friction: DVec3,
}

/// The pairs that rest, with the forces that hold them.
#[derive(Default)]
pub(crate) struct Resting {
    pairs: BTreeMap<ColliderPair, Vec<Held>>,
}

/// A pair's points, ready for the solver.
struct Support {
    pair: ColliderPair,
    manifolds: Vec<Manifold>,
}

impl Resting {
    pub fn contains(&self, pair: ColliderPair) -> bool {
        self.pairs.contains_key(&pair)
    }

    pub fn insert(&mut self, pair: ColliderPair) {
        self.pairs.entry(pair).or_default();
    }

    pub fn iter(&self) -> impl Iterator<Item = ColliderPair> {
        self.pairs.keys().copied()
    }

    /// Forgets all pairs but those of which `keep` says so.
    pub fn retain(&mut self, mut keep: impl FnMut(ColliderPair) -> bool) {
        self.pairs.retain(|&pair, _| keep(pair));
    }

    /// Forgets all pairs but those among `pairs`.
    pub fn keep_only(&mut self, pairs: &[ColliderPair]) {
        let near: BTreeSet<ColliderPair> = pairs.iter().copied().collect();
        self.retain(|pair| near.contains(&pair));
    }

    /// Lets the bodies of an island settle at `time` until the step's end.
    pub fn settle(&mut self, bodies: &mut Bodies, island: &Island, law: RestLaw, (time, end): (f64, f64)) {
        for &row in &island.rows {
            advance(bodies, row, time);
            bodies.influences[row] = free_influence(bodies, row, law.gravity);
        }
        let margin = law.contact_margin();
        let supports: Vec<Support> =
            island.pairs.iter().map(|&pair| support(bodies, pair, law, (time, margin))).collect();
        for lost in supports.iter().filter(|support| support.manifolds.is_empty()) {
            self.pairs.remove(&lost.pair);
        }
        stop_closing(bodies, island, &supports, law);
        let left = end - time;
        if left > 1e-6 * law.substep {
            self.hold(bodies, island, &supports, (law, left));
        }
    }

    /// Finds the forces for the remaining time `left`, and lets them act.
    fn hold(
        &mut self,
        bodies: &mut Bodies,
        island: &Island,
        supports: &[Support],
        (law, left): (RestLaw, f64),
    ) {
        let mut movers = island.movers(bodies);
        for (mover, &row) in movers.iter_mut().zip(&island.rows) {
            let influence = &bodies.influences[row];
            mover.linear += influence.acceleration * left;
            mover.angular += mover.inverse_inertia * influence.torque * left;
        }
        let before = movers.clone();
        // A gap within the margin is left as it is: closing it would ask for a velocity that the next step has to stop, and
        // a stack would rock on that for ever.
        let mut rows = island.contact_rows(bodies, supports, |parting, _| -left * parting);
        for (index, row) in rows.iter_mut() {
            let held = self.held(supports, *index);
            row.pressure = held.map_or(0.0, |held| held.pressure * left);
            let friction = held.map_or(DVec3::ZERO, |held| held.friction * left);
            row.friction = friction - friction.dot(row.normal) * row.normal;
        }
        let mut only_rows: Vec<ContactRow> = rows.iter().map(|(_, row)| *row).collect();
        solve(&mut movers, &mut only_rows, effort(law, left));
        for ((mover, before), &row) in movers.iter().zip(&before).zip(&island.rows) {
            bodies.influences[row].acceleration += (mover.linear - before.linear) / left;
        }
        for row in &only_rows {
            let force = (row.pressure * row.normal + row.friction) / left;
            for (mover, arm, force) in [(row.a, row.arm_a, -force), (row.b, row.arm_b, force)] {
                if let Some(&body) = island.rows.get(mover)
                    && bodies.constants[body].is_movable()
                {
                    bodies.influences[body].torque += arm.cross(force);
                }
            }
        }
        self.remember(supports, &rows, &only_rows, left);
    }

    fn held(&self, supports: &[Support], (support, manifold, point): PointIndex) -> Option<Held> {
        let contact = supports[support].manifolds[manifold].points()[point];
        let features = (contact.feature_a, contact.feature_b);
        self.pairs.get(&supports[support].pair)?.iter().copied().find(|held| held.features == features)
    }

    fn remember(
        &mut self,
        supports: &[Support],
        indices: &[(PointIndex, ContactRow)],
        rows: &[ContactRow],
        left: f64,
    ) {
        for support in supports {
            if let Some(held) = self.pairs.get_mut(&support.pair) {
                held.clear();
            }
        }
        for ((index, _), row) in indices.iter().zip(rows) {
            let contact = supports[index.0].manifolds[index.1].points()[index.2];
            if let Some(held) = self.pairs.get_mut(&supports[index.0].pair) {
                held.push(Held {
                    features: (contact.feature_a, contact.feature_b),
                    pressure: row.pressure / left,
                    friction: row.friction / left,
                });
            }
        }
    }
}

/// Which support, manifold and point a row belongs to.
type PointIndex = (usize, usize, usize);

/// Bodies that settle together.
pub(crate) struct Island {
    /// Their rows, ascending.
    pub rows: Vec<usize>,
    /// The resting pairs among them and with what does not move.
    pub pairs: Vec<ColliderPair>,
}

impl Island {
    /// The bodies as movers, and last the world.
    fn movers(&self, bodies: &Bodies) -> Vec<Mover> {
        let mover = |row: usize| {
            let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
            Mover {
                inverse_mass: constants.inverse_mass,
                inverse_inertia: if constants.is_movable() {
                    constants.inverse_inertia(state.rotation)
                } else {
                    DMat3::ZERO
                },
                linear: state.velocity,
                angular: constants.angular_velocity(state),
            }
        };
        self.rows.iter().copied().chain([WORLD_ROW]).map(mover).collect()
    }

    fn mover_of(&self, row: usize) -> usize {
        self.rows.binary_search(&row).unwrap_or(self.rows.len())
    }

    /// A row for each contact point; `least_velocity` gets the centripetal acceleration that parts the point, and the point.
    fn contact_rows(
        &self,
        bodies: &Bodies,
        supports: &[Support],
        least_velocity: impl Fn(f64, &crate::collide::ContactPoint) -> f64,
    ) -> Vec<(PointIndex, ContactRow)> {
        let mut rows = Vec::new();
        for (index, support) in supports.iter().enumerate() {
            let (Some(a), Some(b)) = (bodies.collider(support.pair.0), bodies.collider(support.pair.1))
            else {
                continue;
            };
            let surface = crate::material::Surface::between(&a.material, &b.material);
            let (center_a, center_b) = (bodies.center_pose(a).position, bodies.center_pose(b).position);
            for (which, manifold) in support.manifolds.iter().enumerate() {
                for (point, contact) in manifold.points().iter().enumerate() {
                    let (arm_a, arm_b) = (contact.point - center_a, contact.point - center_b);
                    let corner = |row: usize, arm: DVec3, feature: Feature| {
                        let spin = bodies.constants[row].angular_velocity(&bodies.states[row]);
                        let corner = matches!(feature, Feature::Vertex(_));
                        if corner { spin.cross(spin.cross(arm)).dot(manifold.normal) } else { 0.0 }
                    };
                    let parting =
                        corner(b.row, arm_b, contact.feature_b) - corner(a.row, arm_a, contact.feature_a);
                    rows.push((
                        (index, which, point),
                        ContactRow {
                            a: self.mover_of(a.row),
                            b: self.mover_of(b.row),
                            arm_a,
                            arm_b,
                            normal: manifold.normal,
                            static_friction: surface.static_friction,
                            dynamic_friction: surface.dynamic_friction,
                            least_velocity: least_velocity(parting, contact),
                            pressure: 0.0,
                            friction: DVec3::ZERO,
                        },
                    ));
                }
            }
        }
        rows
    }
}

/// How far to solve for velocities that change within `time` seconds.
fn effort(law: RestLaw, time: f64) -> Effort {
    Effort { sweeps: SWEEPS, agreement: AGREEMENT * law.gravity.length().max(1e-3) * time }
}

fn support(bodies: &Bodies, pair: ColliderPair, law: RestLaw, (time, margin): (f64, f64)) -> Support {
    let mut manifolds = Vec::new();
    if let (Some(a), Some(b)) = (bodies.collider(pair.0), bodies.collider(pair.1)) {
        Approach::new(bodies, a, b, law).manifolds(time, margin, &mut manifolds);
    }
    Support { pair, manifolds }
}

/// Stops whatever closes, by impulses with C_r = 0 and friction.
fn stop_closing(bodies: &mut Bodies, island: &Island, supports: &[Support], law: RestLaw) {
    let mut movers = island.movers(bodies);
    let rows = island.contact_rows(bodies, supports, |_, _| 0.0);
    let mut rows: Vec<ContactRow> = rows.into_iter().map(|(_, row)| row).collect();
    solve(&mut movers, &mut rows, effort(law, law.substep));
    for row in &rows {
        let impulse = row.pressure * row.normal + row.friction;
        for (mover, arm, impulse) in [(row.a, row.arm_a, -impulse), (row.b, row.arm_b, impulse)] {
            if let Some(&body) = island.rows.get(mover) {
                push(bodies, body, arm, impulse);
            }
        }
    }
}

/// Share of an overlap that is pushed out at the end of a step, and how often the rows are gone through.
const PUSH_OUT: f64 = 0.5;
const PUSH_SWEEPS: usize = 20;

/// Pushes resting bodies out of each other where rounding and curved paths have let them overlap; velocities stay.
pub(crate) fn push_out(bodies: &mut Bodies, island: &Island, law: RestLaw, time: f64) {
    let allowed = 0.1 * law.contact_margin();
    let supports: Vec<Support> =
        island.pairs.iter().map(|&pair| support(bodies, pair, law, (time, 0.0))).collect();
    let overlaps = supports
        .iter()
        .flat_map(|support| &support.manifolds)
        .flat_map(Manifold::points)
        .any(|contact| contact.separation < -allowed);
    if !overlaps {
        return;
    }
    let mut movers = island.movers(bodies);
    for mover in &mut movers {
        (mover.linear, mover.angular) = (DVec3::ZERO, DVec3::ZERO);
    }
    let rows = island
        .contact_rows(bodies, &supports, |_, contact| PUSH_OUT * (-contact.separation - allowed).max(0.0));
    let mut rows: Vec<ContactRow> = rows
        .into_iter()
        .map(|(_, row)| ContactRow { static_friction: 0.0, dynamic_friction: 0.0, ..row })
        .collect();
    solve(&mut movers, &mut rows, Effort { sweeps: PUSH_SWEEPS, agreement: 0.1 * allowed });
    for (mover, &row) in movers.iter().zip(&island.rows) {
        let state = &mut bodies.states[row];
        state.position += mover.linear;
        state.rotation = (rotation_from_vector(mover.angular) * state.rotation).normalize();
    }
}
