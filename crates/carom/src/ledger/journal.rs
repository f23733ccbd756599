//! What is noted while a step goes on.

use super::contacts::Part;
use super::falls::{Fall, Falls};
use super::look::Look;
use super::{Posts, Residual, Stock};
use crate::bodies::Bodies;
use crate::math::{DQuat, DVec3};
use crate::world::Momentum;

/// The journal of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Journal {
    pub gravity: DVec3,
    pub posts: Posts,
    /// Row by row: what each body should have by the books, which is what it had at the start of the step and what it has got since; and
    /// what it has at the end of a step.
    booked: Vec<Residual>,
    has: Vec<Residual>,
    /// Row by row, the energy that each of the [`ARTEFACTS`] has given in the present step, J.
    artefacts: Vec<[f32; ARTEFACTS.len()]>,
    /// More than an artefact has given to any body in one step so far, J; and whether one may have now.
    pub record: f32,
    pub is_record: bool,
    /// What gravity has pulled down in the present step.
    falls: Falls,
    pub holds: Vec<Hold>,
    /// Length of the present substep, s.
    pub substep: f64,
    /// Row by row, what rest capture, friction and twist give in the present substep, as parts of what contacts do; and what contacts give
    /// along their normals that bounce when struck faster, empty if there are none.
    pub captures: Vec<Part>,
    pub frictions: Vec<Part>,
    pub rebounds: Vec<Part>,
    /// Orientations when they set out of those of which something is infinite.
    pub rotations: Vec<DQuat>,
    /// Sums of what the bodies had at the end of the last step, with and without directions.
    sum: Stock,
    gross: [f64; 3],
    /// Whether bodies still have what they had then: nobody has been at them.
    is_known: bool,
    /// A body was lost.
    lost: bool,
}

/// Posts that are not modelled.
pub(crate) const ARTEFACTS: [&str; 4] =
    ["integration", "position_correction", "loss_rest_capture", "loss_sleep"];
pub(crate) const INTEGRATION: usize = 0;
pub(crate) const CORRECTION: usize = 1;
pub(crate) const CAPTURE: usize = 2;
pub(crate) const SLEEP: usize = 3;

/// What a body does that contacts hold, in the present substep.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hold {
    /// Way (m) and turn (rad) so far, along which a force of contacts and its torque work, if they act evenly.
    pub way: DVec3,
    pub turn: DVec3,
    /// The mass on which gravity pulls, kg.
    pub heavy_mass: f64,
    /// Number of the path that contacts have given it.
    pub course: u32,
    pub path: Path,
    /// Whether its mass and its inertia are finite; and whether besides, contacts and gravity alone act on it.
    pub is_regular: bool,
    pub is_plain: bool,
    /// Whether it has kept to that path, so that gravity has acted where contacts have: then it is booked with them.
    pub keeps_course: bool,
    /// Whether rest capture gives something to it, too.
    pub is_captured: bool,
}

impl Hold {
    /// How the body has moved in the mean if that took so long (s).
    #[inline]
    pub fn motion(&self, time: f64) -> Motion {
        let rate = 1.0 / time;
        Motion { velocity: self.way * rate, spin: self.turn * rate }
    }
}

/// How a body moves in the mean while contacts act on it: m/s, rad/s.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Motion {
    pub velocity: DVec3,
    pub spin: DVec3,
}

/// How forces act on a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Path {
    /// Contacts do not hold it.
    #[default]
    Free,
    /// They do, evenly during the substep.
    Steady,
    /// They do, and all forces have acted at the start of the substep.
    Kicked,
}

/// The end of a step.
pub(crate) struct Closing {
    pub end: Stock,
    pub posts: Posts,
    pub gross: [f64; 3],
    pub lost: bool,
}

impl Journal {
    /// Begins a step; what all bodies have. What they had at the end of the last one is looked up, unless somebody has been at them.
    pub fn open(&mut self, bodies: &Bodies, gravity: DVec3) -> Stock {
        let rows = bodies.states.len();
        self.lost = false;
        if !self.is_known || self.gravity != gravity || self.has.len() != rows {
            self.gravity = gravity;
            let mut look = self.begin_look();
            for row in bodies.rows() {
                let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
                look.at(state, constants, constants.angular_velocity(state));
            }
            self.end_look(look);
        }
        self.is_known = false;
        std::mem::swap(&mut self.booked, &mut self.has);
        self.artefacts.clear();
        self.artefacts.resize(rows, Default::default());
        self.is_record = false;
        self.holds.resize(rows, Hold::default());
        self.captures.resize(rows, Part::default());
        self.frictions.resize(rows, Part::default());
        self.rotations.resize(rows, DQuat::IDENTITY);
        self.sum
    }

    /// Begins a look at what all bodies have.
    pub fn begin_look(&mut self) -> Look {
        Look::new(std::mem::take(&mut self.has), self.gravity)
    }

    /// Ends it. Returns what rounding is a share of in a step of one second.
    fn end_look(&mut self, look: Look) -> [f64; 3] {
        let Look { has, sum, gross, pulls, .. } = look;
        (self.has, self.sum, self.gross) = (has, sum, gross);
        pulls
    }

    /// Ends a step that took so long (s), after a look at all bodies.
    pub fn close(&mut self, look: Look, step: f64) -> Closing {
        let before = self.gross;
        let pulls = self.end_look(look);
        let Momentum { linear, angular } = self.falls.take().momentum(self.gravity);
        self.posts.gravity.add(linear, angular);
        let gross = std::array::from_fn(|kind| before[kind] + self.gross[kind] + pulls[kind] * step);
        self.is_known = true;
        Closing { end: self.sum, posts: std::mem::take(&mut self.posts), gross, lost: self.lost }
    }

    /// A body gets momentum, linear and angular (about the origin), and energy.
    #[inline]
    pub fn gets(&mut self, row: usize, linear: DVec3, angular: DVec3, energy: f64) {
        let booked = &mut self.booked[row];
        booked.linear += linear;
        booked.angular += angular;
        booked.energy += energy;
    }

    /// A body gets energy from one of the [`ARTEFACTS`].
    #[inline]
    pub fn gets_by_artefact(&mut self, row: usize, artefact: usize, energy: f64) {
        self.booked[row].energy += energy;
        self.note_artefact(row, artefact, energy);
    }

    /// Notes energy that a body gets from one of the [`ARTEFACTS`], and that is booked with what it gets from elsewhere.
    #[inline]
    pub fn note_artefact(&mut self, row: usize, artefact: usize, energy: f64) {
        let given = &mut self.artefacts[row][artefact];
        *given += energy as f32;
        self.is_record |= given.abs() > self.record;
    }

    /// Gravity acts for so long (s) at the mean place `center` on a body on whose mass (kg) it pulls.
    #[inline]
    pub fn falls(&mut self, row: usize, heavy_mass: f64, (center, time): (DVec3, f64)) {
        let impulse = self.pulls(heavy_mass, (center, time));
        self.gets(row, impulse, center.cross(impulse), 0.0);
    }

    /// The impulse (N·s) that gravity gives it meanwhile, which is still to be booked as the body's.
    #[inline]
    pub fn pulls(&mut self, heavy_mass: f64, (center, time): (DVec3, f64)) -> DVec3 {
        self.falls.add(Fall::new(heavy_mass, center, time));
        self.gravity * (heavy_mass * time)
    }

    /// The row whose body got most energy from an artefact in the step that is over; which one and how much, J.
    pub fn most_artefact(&self) -> Option<(usize, usize, f64)> {
        let given = self.artefacts.iter().enumerate();
        let given = given.flat_map(|(row, kinds)| (0..kinds.len()).map(move |kind| (row, kind, kinds[kind])));
        let most = given.reduce(|most, next| if next.2.abs() > most.2.abs() { next } else { most });
        most.map(|(row, kind, energy)| (row, kind, f64::from(energy).abs()))
    }

    /// Row by row, what no cause explains of the step that is over.
    pub fn residuals(&self) -> impl Iterator<Item = Residual> {
        self.has.iter().zip(&self.booked).map(|(&has, &booked)| has - booked)
    }

    /// Somebody changes bodies between steps.
    pub fn forget(&mut self) {
        self.is_known = false;
    }

    /// The body of a row is no more; that of the last row gets its row.
    pub fn swap_remove(&mut self, row: usize) {
        self.lost = true;
        self.is_known = false;
        if row < self.booked.len() {
            self.booked.swap_remove(row);
            self.artefacts.swap_remove(row);
            self.holds.swap_remove(row);
        }
    }

    /// A body that had this is put to sleep: its momentum goes into the ground.
    pub fn falls_asleep(&mut self, row: usize, had: &Stock) {
        let (momentum, kinetic) = (had.momentum, had.energy.kinetic);
        self.posts.fixed.add(-momentum.linear, -momentum.angular);
        self.posts.loss_sleep += kinetic;
        if row < self.booked.len() {
            self.gets(row, -momentum.linear, -momentum.angular, 0.0);
            self.gets_by_artefact(row, SLEEP, -kinetic);
        }
    }
}
