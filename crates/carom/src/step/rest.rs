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
//!
//! ```text
//! rest.rs           which pairs the contacts own, from when until when
//! rest/renew.rs     contacts looked at anew where bodies have moved
//! rest/remember.rs  what pressed goes on pressing
//! rest/crowds.rs    where many bodies rest against each other
//! rest/owner.rs     whose a contact is, and what touches in it
//! rest/hold.rs      impulses
//! rest/give.rs      the paths that they give; rest capture
//! rest/work.rs      what is known of each body meanwhile
//! rest/push_out.rs  overlaps out
//! ```

mod crowds;
mod give;
mod hold;
mod owner;
mod push_out;
mod remember;
mod renew;
#[cfg(test)]
mod validate;
mod work;

use crate::bodies::{Bodies, WORLD_ROW};
use crate::impacts::time_of_impact::{Approach, Kept, RestLaw};
use crate::math::DVec3;
use crate::room::Room;
use crate::solver::bundle::field;
use crate::solver::graph::{ContactId, Graph};
use crate::solver::lanes::Machine;
use crate::solver::rows::Rows;
use crate::step::motion::advance;
use crate::step::pairs::{Pair, Pairs};
use crate::step::pool::Pool;
use crate::step::profile::{self, Phase};
use crowds::Crowds;
use owner::{Manner, Owner};
use smallvec::SmallVec;
use std::sync::Arc;
use work::Work;

/// Contacts, and the bodies that they hold.
pub(crate) struct Rest {
    graph: Graph,
    rows: Rows,
    /// The pairs that rest, in the order in which they came to.
    resting: Vec<usize>,
    crowds: Crowds,
    /// Whose each contact is.
    owners: Vec<Owner>,
    /// What each contact is like: apart, as it is asked for all of them in each substep.
    manners: Vec<Manner>,
    work: Work,
    /// Whether each body's contacts are to be renewed.
    has_moved: Vec<bool>,
}

/// Contacts of a pair: most touch in no more manifolds.
type Few = SmallVec<[ContactId; FEW]>;
const FEW: usize = 4;

/// A stretch of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub from: f64,
    pub until: f64,
}

impl Rest {
    /// Nothing rests yet; what will is solved with the instructions of `machine`, by the threads of `pool`.
    pub fn new(machine: Machine, pool: Arc<Pool>) -> Self {
        Self {
            graph: Graph::new(machine, pool),
            rows: Rows::new(),
            resting: Vec::new(),
            crowds: Crowds::default(),
            owners: Vec::new(),
            manners: Vec::new(),
            work: Work::default(),
            has_moved: Vec::new(),
        }
    }

    /// The threads that contacts are solved with.
    pub fn pool(&self) -> &Pool {
        self.graph.pool()
    }

    /// Starts a step with other pairs; those that have `parted` lose their contacts.
    pub fn begin_step(
        &mut self,
        bodies: &mut Bodies,
        (pairs, parted): (&mut Pairs, Vec<Pair>),
        law: RestLaw,
    ) {
        let _phase = profile::phase(Phase::Crowds);
        self.rows.grow(bodies.states.len());
        parted.iter().for_each(|pair| self.drop_contacts(pair));
        self.resting.retain(|&index| pairs.rests(index));
        self.resting.sort_by_key(|&index| pairs[index].colliders);
        self.crowds.find(bodies, self.resting.iter().map(|&index| pairs[index].rows()));
        for &index in &self.resting {
            if pairs[index].is_pressed != self.crowds.press(bodies, &pairs[index], law) {
                pairs[index].is_outdated = true;
            }
        }
        let mut goes_on = true;
        while goes_on {
            goes_on = false;
            for &index in &self.resting {
                let rows = pairs[index].rows();
                if rows.into_iter().any(|row| stirs(bodies, row)) {
                    goes_on |= rows.into_iter().filter(|&row| bodies.wake(row)).count() > 0;
                }
            }
        }
    }

    /// The contacts of a pair.
    fn contacts(&self, pair: &Pair) -> impl Iterator<Item = ContactId> {
        let used = |contact: ContactId| (contact != ContactId::NONE).then_some(contact);
        let next = move |contact: &ContactId| used(self.owners[contact.index()].next);
        std::iter::successors(used(pair.first_contact), next)
    }

    /// Tells the ledger what contacts have exerted in the last substep.
    pub fn settle(&mut self, bodies: &mut Bodies) {
        self.work.settle(bodies);
    }

    /// Lets go of the contacts of a pair.
    pub fn drop_contacts(&mut self, pair: &Pair) {
        let contacts: Few = self.contacts(pair).collect();
        contacts.into_iter().for_each(|contact| self.release(contact));
    }

    fn release(&mut self, contact: ContactId) {
        for row in self.graph.rows(contact) {
            self.rows.let_go(row as usize);
        }
        self.graph.remove(contact);
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
        let _phase = profile::phase(Phase::Adopt);
        let margin = law.contact_margin();
        for number in 0..pairs.count_of_watched() {
            let index = pairs.watched(number);
            let pair = &pairs[index];
            let is_near =
                !pair.rests && !pair.sensor && pairs.least_separation(bodies, index, span.from) <= margin;
            if !is_near || !pair.rows().into_iter().any(|row| stirs(bodies, row)) {
                continue;
            }
            let [least, _] = pair.least_facing(bodies, (span.from, span.from));
            if least > margin {
                pairs[index].measured(bodies, least, span.from);
                continue;
            }
            let Some(approach) = Approach::of(bodies, pair.colliders, law) else { continue };
            let gap = approach.gap(span.from);
            let fly = !pairs[index].rows().into_iter().any(|row| self.rows.is_held(row));
            let rests = gap.separation <= margin && approach.rests(pairs, span.from, fly);
            pairs[index].faced(bodies, gap, span.from);
            if rests {
                self.take(bodies, pairs, index, (law, span));
            }
        }
    }

    /// Gives contacts to a pair at the start of `span`.
    pub fn take(&mut self, bodies: &mut Bodies, pairs: &mut Pairs, index: usize, at: (RestLaw, Span)) {
        let _phase = profile::phase(Phase::Renew);
        for row in pairs[index].rows() {
            bodies.wake(row);
            advance(bodies, row, at.1.from);
            if !self.rows.is_held(row) {
                self.rows.anchor(bodies, row);
            }
            self.rows.read_drift(bodies, row);
        }
        pairs[index].rests = true;
        self.renew(bodies, pairs, index, at);
        if pairs[index].rests {
            self.resting.put(index);
        }
    }

    /// Ends the rest of a pair; the touches to come are to be asked for.
    fn end(&mut self, pairs: &mut Pairs, index: usize) {
        let pair = &mut pairs[index];
        self.drop_contacts(pair);
        pair.rests = false;
        pair.first_contact = ContactId::NONE;
        pairs.watch_over(index);
    }

    /// Hands a pair back to the impacts, if it rests.
    pub fn hand_back(&mut self, pairs: &mut Pairs, index: usize) {
        if pairs[index].rests {
            self.end(pairs, index);
            self.resting.retain(|&other| other != index);
        }
    }

    /// How many pairs of bodies touch.
    pub fn count_touching(&self, bodies: &Bodies, pairs: &Pairs, law: RestLaw) -> usize {
        let (mut alone, mut shared) = (0, Vec::new());
        for contact in self.graph.within(law.contact_margin() as f32) {
            let Owner { pair, is_alone, .. } = self.owners[contact.index()];
            if is_alone {
                alone += 1;
            } else {
                let slots = pairs[pair as usize].slots(bodies);
                shared.push((slots[0].min(slots[1]), slots[0].max(slots[1])));
            }
        }
        shared.sort_unstable();
        shared.dedup();
        alone + shared.len()
    }

    /// Whether all points of a pair that rests are so near that the contacts have them all.
    pub fn is_closed(&self, pair: &Pair) -> bool {
        self.contacts(pair).all(|contact| self.graph.is_closed(contact))
    }

    /// Closing speed (m/s) up to which a point of a pair that rests, struck on from elsewhere, is left to the contacts. They
    /// stop it at the end of the substep, without a bounce. It is 0 where few bodies rest against each other, so that these get
    /// their impulses at the instant; and for what bounces without loss, or bears no load (balls that just touch in a row).
    pub fn left_speed(&self, bodies: &Bodies, pair: &Pair, law: RestLaw) -> f64 {
        let loses = || pair.surface(bodies).restitution < 1.0;
        let is_left = self.crowds.has_either(pair.rows())
            && (!pair.bounces || (loses() && self.bears_load(bodies, pair, law)));
        if is_left { PRESSED * grain(bodies, pair) / law.substep } else { 0.0 }
    }

    /// Whether contacts see to all points of a pair, if it rests.
    pub fn presses(&self, bodies: &Bodies, pair: &Pair, law: RestLaw) -> bool {
        self.crowds.press(bodies, pair, law)
    }

    /// Whether contacts have pushed a pair with more than a trace of a body's weight.
    fn bears_load(&self, bodies: &Bodies, pair: &Pair, law: RestLaw) -> bool {
        let movable = pair.rows().map(|row| bodies.constants[row].inverse_mass).into_iter();
        let weight = law.gravity.length() * law.substep / movable.fold(f64::MIN_POSITIVE, f64::max);
        let pushed = self.contacts(pair).flat_map(|contact| {
            let points = 0..self.owners[contact.index()].touched.count();
            points.map(move |point| self.graph.get(contact, field::of_point(point, field::IMPULSE)))
        });
        pushed.map(f64::from).sum::<f64>() > TRACE * weight
    }

    /// Which points of a pair that rests its contacts see to, if it is asked `since` some time within the step.
    pub fn kept(&self, bodies: &Bodies, pair: &Pair, (law, since): (RestLaw, f64)) -> Kept {
        let grain = grain(bodies, pair);
        let pressed = if pair.bounces { 0.0 } else { PRESSED * grain / law.substep };
        Kept { horizon: horizon(pair, grain, law), since, pressed }
    }

    /// Whether a point of a pair that rests will strike in the time left of a substep: one that comes from further away than
    /// contacts reach, or one that a collision has set in motion.
    pub fn is_driven(&self, bodies: &Bodies, pair: &Pair, law: RestLaw, span: Span) -> bool {
        let left = span.until - span.from;
        let Kept { horizon, pressed, .. } = self.kept(bodies, pair, (law, span.from));
        let motion = pair.rows().map(|row| {
            let state = &bodies.states[row];
            (state.velocity, bodies.constants[row].angular_velocity(state))
        });
        self.contacts(pair).any(|contact| {
            let numbers = self.graph.numbers(contact);
            let (normal, first) = (numbers.vector(field::NORMAL), numbers.vector(field::TANGENT));
            let second = normal.cross(first);
            let inward = |v: DVec3| DVec3::new(v.dot(first), v.dot(second), v.dot(normal));
            let relative = (motion[1].0 - motion[0].0).dot(normal);
            let (spin_a, spin_b) = (inward(motion[0].1), inward(motion[1].1));
            let arms = [field::FRICTION_ARM_A, field::FRICTION_ARM_B].map(|arm| numbers.vector(arm));
            let relative = relative + (spin_b.cross(arms[1]) - spin_a.cross(arms[0])).z;
            let spin = spin_b - spin_a;
            (0..self.owners[contact.index()].touched.count()).any(|point| {
                let at = |line: usize| field::of_point(point, line);
                let [x, y] = [0, 1].map(|axis| numbers.get(at(field::LEVER) + axis));
                let speed = relative + (spin.x * y - spin.y * x);
                let gap = numbers.get(at(field::SEPARATION));
                let slowest = if gap > horizon { law.drift_speed() } else { law.drift_speed().max(pressed) };
                speed < -slowest && gap + speed * left < 0.0
            })
        })
    }
}

/// A resting pair that loses its speed in a collision is left to the contacts if it would go no further into the other body
/// within a substep than this share of the smaller reach.
const PRESSED: f64 = 0.02;

/// A pair whose contacts push with less than this share of the lighter body's weight bears no load.
const TRACE: f64 = 0.01;

fn grain(bodies: &Bodies, pair: &Pair) -> f64 {
    bodies.grains[pair.rows()[0]].min(bodies.grains[pair.rows()[1]])
}

/// Gap (m) up to which the contacts of a resting pair see to a point: what does not bounce and comes no faster than contacts can
/// be left to deal with is stopped by them, at the end of the substep in which it touches. Faster points, and all that bounce,
/// strike at their own instant.
fn horizon(pair: &Pair, grain: f64, law: RestLaw) -> f64 {
    if pair.bounces { law.contact_margin() } else { law.contact_margin().max(PRESSED * grain) }
}

/// Whether a body keeps its neighbours awake: it is awake itself, and moves or can be moved.
fn stirs(bodies: &Bodies, row: usize) -> bool {
    if row == WORLD_ROW || bodies.is_asleep(row) {
        return false;
    }
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    constants.is_movable()
        || state.velocity != DVec3::ZERO
        || constants.angular_velocity(state) != DVec3::ZERO
}
