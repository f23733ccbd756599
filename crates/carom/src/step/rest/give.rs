//! What contacts exert is given to the bodies that they hold, and the paths that this gives them.
//!
//! Each contact's impulse goes to both of its bodies, equal and opposite, at one place: so linear and angular momentum
//! are kept to the rounding of double precision, whatever the solver's arms are. A body's own arm ends at its mean place on the
//! path that it gets. Where a collision takes it off that path, the force goes on acting at the place where it was: see
//! [`Plan`].

use super::hold::{gain, is_free};
use super::work::{Change, Work};
use super::{Rest, Span};
use crate::bodies::{Bodies, WORLD_ROW};
use crate::flight::{Influence, mean_center};
use crate::impacts::time_of_impact::RestLaw;
use crate::ledger::contacts::captured;
use crate::ledger::flights::set_out;
use crate::math::DVec3;
use crate::step::motion::{Plan, set_pace};

/// What rests on something with friction, goes nowhere and moves no faster than [`CAPTURED`] rest thresholds loses
/// this share of its speed in a second, fading out towards that speed. Rolling has no friction of its own: without it a ball would roll about
/// a pile, or rock in a hollow of it, for ever at a speed that gravity and the substep hardly tell from rest.
const RESISTANCE: f64 = 2.0;
const CAPTURED: f64 = 8.0;

/// A body rests on something with friction if contacts, and those with friction by themselves, push it by more than this share of what
/// gravity does. It goes nowhere if its velocity changes by no more than the second, so that what starts to roll down a slope does so
/// freely; or if for so long (s) it has stayed where any such start would have taken it away from.
const SUPPORTED: f64 = 0.5;
const DRIVEN: f64 = 0.01;
const LINGERED: f64 = 1.0;

/// A body that contacts hold and impulses move, in one substep.
struct Held {
    row: usize,
    /// Velocity (m/s) and angular momentum (N·m·s) that gravity and the user's forces give it.
    gain: [DVec3; 2],
    /// Whether the forces on it persist.
    steady: bool,
    /// How much contacts with friction push it, N·s.
    rough: f64,
}

impl Held {
    fn of(bodies: &Bodies, work: &Work, row: usize, at: (RestLaw, f64)) -> Self {
        Self {
            row,
            gain: gain(bodies, row, at),
            steady: work.is_steady[row] || !work.is_pushed[row],
            rough: work.rough_pushes[row],
        }
    }
}

impl Rest {
    /// Gives the impulses of the contacts to the bodies that they hold.
    pub(super) fn give(&mut self, bodies: &mut Bodies, work: &mut Work, (law, span): (RestLaw, Span)) {
        let substep = span.until - span.from;
        work.centers[WORLD_ROW] = bodies.states[WORLD_ROW].position;
        for &row in &work.rows {
            work.centers[row] = bodies.states[row].position;
            if is_free(bodies, row) {
                let body = Held::of(bodies, work, row, (law, substep));
                let change = self.push_center(bodies, &body, work.impulses[row], (law, substep));
                work.centers[row] = mean_place(bodies, &body, change.velocity, substep);
                work.changes[row] = change;
            }
        }
        self.turn(bodies, work);
        for &row in &work.rows {
            if !is_free(bodies, row) {
                continue;
            }
            let (body, change) = (Held::of(bodies, work, row, (law, substep)), work.changes[row]);
            let rotation = bodies.states[row].rotation;
            let mut momentum = body.gain[1] + bodies.constants[row].turning_part(rotation, work.turns[row]);
            let capture = change.captured.map(|velocity| {
                [velocity * bodies.constants[row].mass(), capture_spin(bodies, row, momentum, law)]
            });
            if let Some([_, turn]) = capture {
                momentum += turn;
            }
            follow(bodies, &body, [change.velocity, momentum], span);
            if let Some([impulse, turn]) = capture {
                work.impulses[row] += impulse;
                work.turns[row] += turn;
                captured(bodies, row, [impulse, turn], work.centers[row]);
            }
        }
        work.unsettled = substep;
    }

    /// Adds up how the contacts turn each body.
    fn turn(&self, bodies: &mut Bodies, work: &mut Work) {
        let mut across = work.wrenches.across().iter();
        for wrench in work.wrenches.list() {
            let [a, b] = wrench.rows();
            let between = work.centers[b] - work.centers[a];
            let [turn_a, turn_b] = wrench.turns(between);
            work.turns[a] += turn_a;
            work.turns[b] += turn_b;
            if let (Some(journal), Some(&across)) = (&mut bodies.journal, across.next()) {
                journal.note_causes((wrench, across), between, self.manners[wrench.contact.index()].bounces);
            }
        }
    }

    /// How the velocity of a body changes that contacts give this impulse.
    fn push_center(
        &mut self,
        bodies: &Bodies,
        body: &Held,
        impulse: DVec3,
        (law, substep): (RestLaw, f64),
    ) -> Change {
        let inverse_mass = bodies.constants[body.row].inverse_mass;
        let push = impulse * inverse_mass;
        let mut change = Change { velocity: body.gain[0] + push, ..Change::default() };
        let pull = body.gain[0].length();
        let stays = self.goes_nowhere(bodies, body.row, (change.velocity.length(), pull, substep));
        let is_carried = push.length().min(body.rough * inverse_mass) > SUPPORTED * pull;
        if is_carried && stays {
            let velocity = bodies.states[body.row].velocity + change.velocity;
            let captured = -captured_share(velocity.length(), law) * velocity;
            change.velocity += captured;
            change.captured = Some(captured);
        }
        change
    }

    /// Whether a body whose velocity changes by `change` (m/s) in a substep, in which what pulls it would change it by `pull`,
    /// goes nowhere.
    fn goes_nowhere(
        &mut self,
        bodies: &Bodies,
        row: usize,
        (change, pull, substep): (f64, f64, f64),
    ) -> bool {
        let haunt = 0.5 * DRIVEN * pull / substep * LINGERED * LINGERED;
        let lingers = self.rows.stay(row, bodies.states[row].position, (haunt, substep)) >= LINGERED;
        lingers || change < DRIVEN * pull
    }
}

/// Rest capture: the share of its speed that a body loses in a substep. Vanishes without gravity.
fn captured_share(speed: f64, law: RestLaw) -> f64 {
    let slowness = 1.0 - speed / (CAPTURED * law.rest_speed());
    RESISTANCE * law.substep * slowness.max(0.0)
}

/// Rest capture of the spin of a body whose angular momentum changes by this much; the angular momentum that it gives, N·m·s.
fn capture_spin(bodies: &Bodies, row: usize, change: DVec3, law: RestLaw) -> DVec3 {
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    let momentum = state.angular_momentum + change;
    let spin = constants.free_spin_speed(state.rotation, momentum);
    let turn = -captured_share(spin * bodies.grains[row], law) * momentum;
    constants.turning_part(state.rotation, turn)
}

/// Where a body's centre is in the mean while the impulses act that give it `change` (m/s).
fn mean_place(bodies: &Bodies, body: &Held, change: DVec3, substep: f64) -> DVec3 {
    let (state, constants) = (&bodies.states[body.row], &bodies.constants[body.row]);
    if body.steady {
        let influence = Influence { acceleration: change / substep, torque: DVec3::ZERO };
        mean_center(state, constants, &influence, substep)
    } else {
        state.position
    }
}

/// Sets a body on its path for a substep in which its velocity (m/s) and angular momentum (N·m·s) change so: a parabola where the forces
/// persist, so that what slides or rolls gets the distance right; else with the new velocity from the start, as what meets
/// an obstacle must not go on into it for half a substep.
fn follow(bodies: &mut Bodies, body: &Held, [velocity, momentum]: [DVec3; 2], span: Span) {
    let (row, substep) = (body.row, span.until - span.from);
    let before = bodies.states[row];
    let state = &mut bodies.states[row];
    if body.steady {
        let force = (velocity - body.gain[0]) / (substep * bodies.constants[row].inverse_mass);
        bodies.plans[row] = Plan::of(force, state, (span.from, span.until));
        bodies.influences[row] = Influence { acceleration: velocity / substep, torque: momentum / substep };
    } else {
        state.velocity += velocity;
        state.angular_momentum += momentum;
        bodies.plans[row] = None;
        bodies.influences[row] = Influence::default();
    }
    set_pace(bodies, row, span.until);
    set_out(bodies, row, &before, (substep, body.steady));
}
