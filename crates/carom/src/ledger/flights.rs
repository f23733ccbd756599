//! What flights do: gravity, the user's forces, damping, turning.
//!
//! Along a flight of the engine's all of this has closed forms. With `Δx` the way of the centre of mass and `x̄` its mean place,
//! a force F that acts evenly during the time t gives the impulse `F·t`, the angular momentum `x̄ × F·t` and the work `F·Δx`;
//! what gravity does is taken from potential energy. Damping `dv/dt = a − c·v` takes the impulse `m·c·Δx`.
//!
//! The angular momentum gets half of a torque's impulse before the body turns and half after. An impulse J that takes the angular
//! velocity from ω to ω' at one orientation does the work `½J·(ω + ω')`; while the body turns nothing acts, so that what its
//! energy changes by meanwhile is the integrator's.

use super::journal::{Hold, INTEGRATION, Journal, Path};
use super::plain::{PlainFlight, is_plain};
use crate::bodies::Bodies;
use crate::flight::{Constants, Influence, RigidState, mean_center};
use crate::math::{DVec3, decay_fractions};

/// A stretch of a body's path.
struct Flight<'a> {
    before: &'a RigidState,
    after: &'a RigidState,
    constants: &'a Constants,
    influence: &'a Influence,
    time: f64,
    /// The user's force, N, and torque, N·m.
    push: DVec3,
    torque: DVec3,
    /// How forces act on it, and whether gravity and the user's do along this path.
    path: Path,
    acts: bool,
}

/// Books what the body of `row` does within `time` seconds to get from its own state to the one `after`.
pub(crate) fn flown(bodies: &mut Bodies, row: usize, after: &RigidState, time: f64) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    let (before, constants, influence) =
        (&bodies.states[row], &bodies.constants[row], &bodies.influences[row]);
    let Hold { path, is_plain, .. } = journal.holds[row];
    if path == Path::Steady && is_plain {
        let course = bodies.courses[row];
        let flight = PlainFlight { before, after, constants, influence, time, course };
        if flight.book(journal, row) {
            return;
        }
    }
    if !constants.is_movable() {
        return;
    }
    if path == Path::Free && only_falls(constants, influence, journal.gravity) {
        let mean = mean_center(before, constants, influence, time);
        journal.falls(row, heavy_mass(constants), (mean, time));
        let (momentum, arrival) = (before.angular_momentum, after.rotation);
        if !constants.is_isotropic() && momentum != DVec3::ZERO {
            let [start, end] = [before.rotation, arrival].map(|it| constants.spin_energy(it, momentum));
            journal.turned(row, constants, end - start);
        }
        return;
    }
    let (push, torque) = bodies.forces.of(row);
    let flight = Flight {
        before,
        after,
        constants,
        influence,
        time,
        push,
        torque,
        path,
        // What sleeps has no influence although gravity pulls.
        acts: match path {
            Path::Free => *influence != Influence::default() || push != DVec3::ZERO || torque != DVec3::ZERO,
            Path::Steady => true,
            Path::Kicked => false,
        },
    };
    flight.book(journal, row);
}

/// Whether there is something to book where a body only drifts along: contacts that ask for its way, forces that have cancelled
/// out, or gravity, which changes its potential energy.
#[inline]
pub(crate) fn minds_drifting(bodies: &Bodies, row: usize) -> bool {
    let Some(journal) = bodies.journal.as_deref() else { return false };
    journal.gravity != DVec3::ZERO
        || journal.holds[row].path != Path::Free
        || bodies.forces.of(row) != (DVec3::ZERO, DVec3::ZERO)
}

/// Whether gravity is all that acts on a body.
#[inline]
fn only_falls(constants: &Constants, influence: &Influence, gravity: DVec3) -> bool {
    constants.inverse_mass > 0.0
        && constants.linear_damping == 0.0
        && constants.angular_damping == 0.0
        && influence.acceleration == gravity * constants.gravity_factor
        && influence.torque == DVec3::ZERO
}

/// The mass on which gravity pulls, kg; nothing where it is infinite.
#[inline]
pub(super) fn heavy_mass(constants: &Constants) -> f64 {
    if constants.inverse_mass > 0.0 { constants.mass() * constants.gravity_factor } else { 0.0 }
}

/// Gravity's force on a body, N.
#[inline]
pub(super) fn weight(constants: &Constants, gravity: DVec3) -> DVec3 {
    heavy_mass(constants) * gravity
}

impl Flight<'_> {
    #[inline(never)]
    fn book(&self, journal: &mut Journal, row: usize) {
        if self.constants.inverse_mass > 0.0 {
            self.book_center(journal, row);
        }
        if self.turns() {
            self.book_turning(journal, row);
        }
    }

    fn book_center(&self, journal: &mut Journal, row: usize) {
        let way = self.after.position - self.before.position;
        if self.path == Path::Steady {
            journal.holds[row].way += way;
        }
        if self.acts {
            let mean = mean_center(self.before, self.constants, self.influence, self.time);
            journal.falls(row, heavy_mass(self.constants), (mean, self.time));
            if self.push != DVec3::ZERO {
                let (impulse, work) = (self.push * self.time, self.push.dot(way));
                journal.posts.external.add(impulse, mean.cross(impulse));
                journal.posts.work_external += work;
                journal.gets(row, impulse, mean.cross(impulse), work);
            }
        } else {
            // Gravity has acted before, or does not: only potential energy changes.
            let fallen = -weight(self.constants, journal.gravity).dot(way);
            journal.posts.integration += fallen;
            journal.gets_by_artefact(row, INTEGRATION, fallen);
        }
        if self.constants.linear_damping > 0.0 {
            self.book_drag(journal, row, way);
        }
    }

    /// With `v̄` the mean of the velocities before and after, `½m(v'² − v²) = m·v̄·(v' − v) = m·v̄·(a·t − c·Δx)`, of which `m·a·Δx` is the
    /// work of what accelerates.
    ///
    /// The drag's moment is `−mc∫x × v`, and `(x − x₀) × v = v₀ × a (A² − B·E)` with `E = e^(−ct)`, `A = ∫E`, `B = ∫A`.
    fn book_drag(&self, journal: &mut Journal, row: usize, way: DVec3) {
        let (mass, damping) = (self.constants.mass(), self.constants.linear_damping);
        let (acceleration, time) = (self.influence.acceleration, self.time);
        let velocity = 0.5 * (self.before.velocity + self.after.velocity);
        let drag = -mass * damping * way;
        let loss = mass * (damping * way.dot(velocity) - acceleration.dot(velocity * time - way));
        let sector = self.before.velocity.cross(acceleration) * (sector(damping * time) * time * time * time);
        let moment = self.before.position.cross(drag) - mass * damping * sector;
        journal.posts.external.add(drag, moment);
        journal.posts.loss_damping += loss;
        journal.gets(row, drag, moment, -loss);
    }

    /// Whether turning changes anything, or what acts has to know how far the body turns: bodies that turn about all axes alike keep
    /// their energy to the bit.
    fn turns(&self) -> bool {
        let (constants, momentum) = (self.constants, self.before.angular_momentum);
        let is_twisted = self.torque != DVec3::ZERO || self.influence.torque != DVec3::ZERO;
        if momentum == DVec3::ZERO && !is_twisted {
            return false;
        }
        self.path == Path::Steady
            || is_twisted
            || constants.angular_damping > 0.0
            || !constants.is_isotropic()
    }

    fn book_turning(&self, journal: &mut Journal, row: usize) {
        let (before, after, constants, time) = (self.before, self.after, self.constants, self.time);
        let kick = 0.5 * time * self.influence.torque;
        let momentum = before.angular_momentum + kick;
        let left = if constants.angular_damping > 0.0 {
            let decay = constants.angular_damping * time;
            1.0 - decay * decay_fractions(decay)[0]
        } else {
            1.0
        };
        let departure = &constants.principal_axes(before.rotation);
        let first = constants.spin_about(departure, before.angular_momentum + momentum);
        let start = constants.spin_energy_about(departure, momentum);
        let arrival = &constants.principal_axes(after.rotation);
        let last = constants.spin_about(arrival, momentum * left + after.angular_momentum);
        let energy = constants.spin_energy_about(arrival, momentum);
        if !constants.is_isotropic() {
            journal.turned(row, constants, energy - start);
        }
        if constants.angular_damping > 0.0 {
            let loss = energy * (1.0 - left * left);
            journal.posts.external.angular -= momentum * (1.0 - left);
            journal.posts.loss_damping += loss;
            journal.gets(row, DVec3::ZERO, -momentum * (1.0 - left), -loss);
        }

        let by_user = self.acts && self.torque != DVec3::ZERO;
        let turn = (first + last) * (0.25 * time);
        if self.path == Path::Steady {
            journal.holds[row].turn += turn;
        }
        if by_user {
            let impulse = self.torque * time;
            journal.posts.external.angular += impulse;
            journal.posts.work_external += self.torque.dot(turn);
            journal.gets(row, DVec3::ZERO, impulse, self.torque.dot(turn));
        }
    }
}

impl Journal {
    /// Books the energy (J) that a body without symmetry has got by turning, while nothing twisted it.
    #[inline]
    fn turned(&mut self, row: usize, constants: &Constants, energy: f64) {
        if constants.driven_spin == DVec3::ZERO {
            self.posts.integration += energy;
            self.gets_by_artefact(row, INTEGRATION, energy);
        } else {
            self.posts.work_kinematic += energy;
            self.gets(row, DVec3::ZERO, DVec3::ZERO, energy);
        }
    }
}

/// `(A² − B·E)` integrated over a flight with the decay x = ct, over t³: `(2ψ − φ²)/x − φψ → 1/6`.
fn sector(x: f64) -> f64 {
    if x < 1e-2 {
        return 1.0 / 6.0 - x * (1.0 / 12.0 - x * (1.0 / 40.0 - x / 180.0));
    }
    let [first, second, _] = decay_fractions(x);
    (2.0 * second - first * first) / x - first * second
}

/// Books what the body of `row`, which had the state `before`, got at the start of a substep of `time` seconds: nothing if its path
/// is `steady`, else all that gravity and the user's forces give. What contacts give is booked when the substep is over.
pub(crate) fn set_out(bodies: &mut Bodies, row: usize, before: &RigidState, (time, steady): (f64, bool)) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    let (after, constants) = (&bodies.states[row], &bodies.constants[row]);
    let is_regular = constants.is_regular();
    if !is_regular {
        journal.rotations[row] = before.rotation;
    }
    journal.substep = time;
    let hold = &mut journal.holds[row];
    *hold = Hold { path: Path::Steady, course: bodies.courses[row], is_regular, ..Hold::default() };
    if steady {
        hold.is_plain = is_plain(constants) && !bodies.forces.act_on(row);
        hold.heavy_mass = heavy_mass(constants);
        return;
    }
    let way = (before.velocity + after.velocity) * (0.5 * time);
    let momentum = 0.5 * (before.angular_momentum + after.angular_momentum);
    let turn = constants.free_spin(before.rotation, momentum) * time;
    (hold.path, hold.way, hold.turn) = (Path::Kicked, way, turn);

    let (mut push, torque) = bodies.forces.of(row);
    if constants.inverse_mass == 0.0 {
        push = DVec3::ZERO;
    }
    let pull = weight(constants, journal.gravity);
    journal.falls(row, heavy_mass(constants), (before.position, time));
    journal.posts.integration += pull.dot(way);
    journal.gets_by_artefact(row, INTEGRATION, pull.dot(way));
    if push != DVec3::ZERO || torque != DVec3::ZERO {
        let impulse = push * time;
        let moment = before.position.cross(impulse) + torque * time;
        let work = push.dot(way) + torque.dot(turn);
        journal.posts.external.add(impulse, moment);
        journal.posts.work_external += work;
        journal.gets(row, impulse, moment, work);
    }
}
