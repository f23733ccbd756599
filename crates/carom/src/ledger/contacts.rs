//! What contacts that rest do, rest capture, and overlaps pushed out.
//!
//! An impulse P at a place with the moment M about a body's centre does the work `P·v̄ + M·ω̄`: exactly, if v̄ and ω̄ are the means of
//! the velocities before and after where it acts at once, and over the path where it acts evenly.

use super::flights::weight;
use super::journal::{CAPTURE, CORRECTION, INTEGRATION, Journal, Motion, Path};
use crate::bodies::{Bodies, WORLD_ROW};
use crate::flight::RigidState;
use crate::math::{DVec3, Vec3A};
use crate::solver::graph::Wrench;
use std::ops::AddAssign;

/// What contacts have exerted during a substep, row by row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exerted<'a> {
    /// What they gave together, with what rest capture gave: impulse, and angular impulse about the centre of mass.
    pub impulses: &'a [DVec3],
    pub turns: &'a [DVec3],
    /// Where the centres of mass were when the impulses acted, or in the mean.
    pub centers: &'a [DVec3],
    /// Length of the substep, s.
    pub time: f64,
}

/// What a body gets: an impulse, N·s, and an angular impulse about its centre of mass, N·m·s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Push {
    impulse: DVec3,
    turn: DVec3,
}

impl Push {
    /// The work (J) that it does on a body that moves like this in the mean.
    #[inline]
    fn work(&self, motion: &Motion) -> f64 {
        self.impulse.dot(motion.velocity) + self.turn.dot(motion.spin)
    }

    /// Angular momentum about the origin that a body gets whose centre of mass is there, N·m·s.
    #[inline]
    fn moment(&self, center: DVec3) -> DVec3 {
        center.cross(self.impulse) + self.turn
    }
}

/// What a body gets by one cause of several: it is told apart from the whole only where works are booked cause by cause, and that is as exact
/// as the impulses that contacts are solved for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Part {
    impulse: Vec3A,
    turn: Vec3A,
}

impl Part {
    #[inline]
    fn add(&mut self, impulse: Vec3A, turn: Vec3A) {
        self.impulse += impulse;
        self.turn += turn;
    }

    /// The work (J) that it does on a body that moves like this in the mean.
    #[inline]
    fn work(&self, velocity: Vec3A, spin: Vec3A) -> f64 {
        (self.impulse * velocity + self.turn * spin).element_sum().into()
    }
}

/// Work (J) that contacts do on bodies, by cause: friction and twist, rest capture, and what is left.
#[derive(Clone, Copy, Debug, Default)]
struct Works {
    friction: f64,
    capture: f64,
    contact: f64,
}

impl AddAssign for Works {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.friction += other.friction;
        self.capture += other.capture;
        self.contact += other.contact;
    }
}

/// Adds what a contact between bodies whose centres of mass are so far apart gives to both by one of its causes (impulse, moment).
#[inline(always)]
fn add_sides(parts: &mut [Part], wrench: &Wrench, cause: [Vec3A; 2], between: Vec3A) {
    let ([a, b], [turn_a, turn_b]) = (wrench.rows(), wrench.turns_of(cause, between));
    parts[a].add(-cause[0], turn_a);
    parts[b].add(cause[0], turn_b);
}

/// Books what contacts have exerted in the substep that is over.
pub(crate) fn settle(bodies: &mut Bodies, exerted: &Exerted) {
    let Some(mut journal) = bodies.journal.take() else { return };
    let mut works = Works::default();
    for row in 0..exerted.impulses.len() {
        let push = Push { impulse: exerted.impulses[row], turn: exerted.turns[row] };
        let is_led = journal.holds[row].path != Path::Free;
        if is_led || push != Push::default() || journal.frictions[row] != Part::default() {
            works += journal.book_row(bodies, row, (push, exerted.centers[row], exerted.time));
        }
        journal.frictions[row] = Part::default();
    }
    journal.rebounds.clear();
    journal.posts.loss_friction -= works.friction;
    journal.posts.loss_rest_capture -= works.capture;
    journal.posts.loss_contact -= works.contact;
    bodies.journal = Some(journal);
}

/// Books what rest capture gives to the body of a row in this substep, whose centre of mass is there in the mean: impulse, angular
/// impulse. What work that does is told when the substep is over.
#[inline]
pub(crate) fn captured(bodies: &mut Bodies, row: usize, [impulse, turn]: [DVec3; 2], center: DVec3) {
    if let Some(journal) = bodies.journal.as_deref_mut() {
        journal.posts.fixed.add(impulse, center.cross(impulse) + turn);
        journal.holds[row].is_captured = true;
        journal.captures[row] = Part { impulse: impulse.as_vec3a(), turn: turn.as_vec3a() };
    }
}

impl Journal {
    /// Notes by which cause a contact exerts what it does, `across` its normal by friction and twist, on two bodies whose centres of mass are
    /// so far apart (m), while whoever gives it to them has it at hand: causes add up body by body as the whole does, so that no contact
    /// has to be gone through again.
    #[inline]
    pub fn note_causes(&mut self, (wrench, across): (&Wrench, [Vec3A; 2]), between: DVec3, bounces: bool) {
        let between = between.as_vec3a();
        add_sides(&mut self.frictions, wrench, across, between);
        if bounces {
            self.rebounds.resize(self.holds.len(), Part::default());
            add_sides(&mut self.rebounds, wrench, wrench.without(across), between);
        }
    }

    /// Books what contacts and rest capture have given to the body of a row, and gravity, where it has acted along with them.
    #[inline]
    fn book_row(&mut self, bodies: &Bodies, row: usize, (push, center, time): (Push, DVec3, f64)) -> Works {
        let hold = &mut self.holds[row];
        // Whoever is held in the next substep will be told so.
        let is_led = std::mem::take(&mut hold.path) != Path::Free;
        if !is_led && (row == WORLD_ROW || bodies.constants[row].is_movable()) {
            // The ground, and what sleeps: nothing moves along there, so that there is no work.
            self.posts.fixed.add(-push.impulse, -push.moment(center));
            return Works::default();
        }
        let hold = *hold;
        let led = is_led.then(|| hold.motion(time));
        let (motion, work) = if let Some(motion) = led.filter(|_| hold.is_regular) {
            let (mut given, work) = (push, push.work(&motion));
            if hold.keeps_course {
                given.impulse += self.pulls(hold.heavy_mass, (center, time));
            }
            self.gets(row, given.impulse, given.moment(center), work);
            (motion, work)
        } else {
            self.book_driven(bodies, (row, led), (push, center))
        };
        self.works(row, work, (&motion, hold.is_captured))
    }

    /// Books what contacts give to what is kinematic, or has an infinite mass or inertia: what it does not take goes to the account of
    /// what is driven. `led` is how the body moves on a path that contacts have set it on; returns how it moves with what drives it, and the
    /// work that this is, J.
    fn book_driven(
        &mut self,
        bodies: &Bodies,
        (row, led): (usize, Option<Motion>),
        (push, center): (Push, DVec3),
    ) -> (Motion, f64) {
        let Push { impulse, turn } = push;
        let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
        let rotation = if led.is_some() { self.rotations[row] } else { state.rotation };
        let mut driven = led.unwrap_or_default();
        driven.spin += constants.driven_velocity(rotation);
        if constants.inverse_mass == 0.0 {
            driven.velocity = state.velocity;
        }
        let work = push.work(&driven);
        let Some(motion) = led else {
            self.posts.kinematic.add(-impulse, -push.moment(center));
            self.posts.work_kinematic -= work;
            return (driven, work);
        };
        let taken = constants.turning_part(rotation, turn);
        let (mut linear, mut kept) = (impulse, taken.dot(motion.spin));
        if constants.inverse_mass > 0.0 {
            kept += impulse.dot(motion.velocity);
        } else {
            self.posts.kinematic.add(-impulse, -center.cross(impulse));
            linear = DVec3::ZERO;
        }
        self.posts.work_kinematic -= work - kept;
        self.posts.kinematic.angular += taken - turn;
        self.gets(row, linear, center.cross(linear) + taken, kept);
        (driven, work)
    }

    /// What of the `work` (J) that contacts and rest capture do on the body of a row, which moves like this in the mean, each cause does.
    #[inline]
    fn works(&mut self, row: usize, work: f64, (motion, is_captured): (&Motion, bool)) -> Works {
        let (velocity, spin) = (motion.velocity.as_vec3a(), motion.spin.as_vec3a());
        let friction = self.frictions[row].work(velocity, spin);
        let mut capture = 0.0;
        if is_captured {
            capture += self.captures[row].work(velocity, spin);
        }
        if let Some(rebound) = self.rebounds.get(row) {
            capture += rebound.work(velocity, spin);
        }
        if capture != 0.0 {
            self.note_artefact(row, CAPTURE, capture);
        }
        Works { friction, capture, contact: work - friction - capture }
    }
}

/// Books the angular momentum that a body got so that a force of contacts acts at its old place, and what was wanted.
pub(crate) fn kept_to_plan(bodies: &mut Bodies, row: usize, [turn, wanted]: [DVec3; 2]) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    if turn == DVec3::ZERO && wanted == DVec3::ZERO {
        return;
    }
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    let spin = constants.free_spin(state.rotation, state.angular_momentum - 0.5 * turn);
    journal.posts.integration += turn.dot(spin);
    journal.gets_by_artefact(row, INTEGRATION, turn.dot(spin));
    // Axes of infinite inertia do not take theirs.
    journal.posts.kinematic.angular += turn - wanted;
    journal.gets(row, DVec3::ZERO, turn - wanted, 0.0);
}

/// Books what one contact does to angular momentum by pushing an overlap out (displacement times mass, kg·m): bodies that move have
/// their lines of motion moved, by what does not move, or by each other's overlap, as if from outside.
pub(crate) fn shifted(bodies: &mut Bodies, wrench: &Wrench, inverse_masses: [f64; 2]) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    let posts = &mut journal.posts;
    let shift = |side: usize| wrench.impulse().cross(bodies.states[wrench.rows()[side]].velocity);
    let mut account = |other: usize, shift: DVec3| {
        let row = wrench.rows()[other];
        let is_fixed = row == WORLD_ROW || bodies.constants[row].inverse_mass > 0.0;
        let account = if is_fixed { &mut posts.fixed } else { &mut posts.kinematic };
        account.angular += shift;
    };
    match inverse_masses.map(|inverse_mass| inverse_mass > 0.0) {
        [true, true] => posts.external.angular += shift(1) - shift(0),
        [true, false] => account(1, -shift(0)),
        [false, true] => account(0, shift(1)),
        [false, false] => (),
    }
}

/// Books what pushing overlaps out has given to a body that had the state `before`: the energy, and the angular momentum of its
/// moved line of motion.
pub(crate) fn pushed_out(bodies: &mut Bodies, row: usize, before: &RigidState) {
    let Some(journal) = bodies.journal.as_deref_mut() else { return };
    let (after, constants) = (&bodies.states[row], &bodies.constants[row]);
    let [start, end] = [before, after].map(|it| constants.spin_energy(it.rotation, after.angular_momentum));
    let mut energy = end - start;
    if constants.inverse_mass > 0.0 {
        let way = after.position - before.position;
        energy -= weight(constants, journal.gravity).dot(way);
        journal.gets(row, DVec3::ZERO, way.cross(constants.mass() * after.velocity), 0.0);
    }
    journal.posts.position_correction += energy;
    journal.gets_by_artefact(row, CORRECTION, energy);
}
