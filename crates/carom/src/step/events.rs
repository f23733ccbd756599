//! The touches of a step, one after the other in time.
//!
//! Every pair of colliders that could touch is asked when it will; the earliest touch is carried out at its instant,
//! which sends both bodies onto new paths and makes their pairs be asked again. What touches more slowly than the rest
//! threshold is handed to [`rest`](super::rest). Bodies keep clocks of their own: only those that a touch concerns are
//! advanced to it. What flies freely has one path for the whole step; what contacts hold gets a new one in each substep.
//!
//! Who owns a touch: a pair that rests belongs to the contacts. It comes back here only where one of its points strikes: a
//! corner that comes from further away than contacts reach, faster than the rest threshold; or a point that a collision has
//! set in motion, if it bounces or would go further than contacts can be left to deal with.
//!
//! Order: by time, then by bodies and colliders; so the same scene gives the same bits.

mod agenda;

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide::Gap;
use crate::impacts::instant::Instant;
use crate::impacts::time_of_impact::{Approach, RestLaw, Touch, outlook};
use crate::report::Impact;
use crate::step::broad_phase::{BroadPhase, order};
use crate::step::motion::{advance, rouse, set_pace};
use crate::step::pairs::{Pair, Pairs};
use crate::step::profile::{self, Phase};
use crate::step::rest::{Rest, Span};
pub(crate) use agenda::Agenda;
use agenda::{Answer, Event};
use std::cmp::Reverse;

/// So many impacts of one pair in one step are taken one by one. If it is then down to this fraction of its fastest, the
/// pair is a ball that rattles itself to rest, and rests. Where nothing bounces one impact is enough: what closes again, as slowly
/// as that, has stayed in touch, as a corner does that turns against the wall along which it falls.
const RATTLE_HITS: u32 = 32;
const RATTLE_SPEED: f64 = 0.01;

/// So many touches of one body in one step are taken one by one; a body with more is wedged, and its touches rest.
const WEDGED_TOUCHES: u32 = 1024;

/// So many pairs asked are worth sharing out.
const QUESTIONS: usize = 32;

/// So many are asked before their answers are noted: in a large world answers would take more room than the pairs.
const AT_ONCE: usize = 4096;

/// The touches of one step.
pub(crate) struct Events<'a> {
    bodies: &'a mut Bodies,
    broad_phase: &'a mut BroadPhase,
    pairs: &'a mut Pairs,
    rest: &'a mut Rest,
    law: RestLaw,
    agenda: &'a mut Agenda,
    impacts: Vec<Impact>,
    /// Rounds so far, of all instants.
    rounds: u32,
}

impl<'a> Events<'a> {
    /// Gets ready for a step in which `pairs` are near each other.
    pub fn new(
        bodies: &'a mut Bodies,
        broad_phase: &'a mut BroadPhase,
        (pairs, rest): (&'a mut Pairs, &'a mut Rest),
        agenda: &'a mut Agenda,
        law: RestLaw,
    ) -> Self {
        agenda.clear(bodies.states.len());
        pairs.begin_watch(bodies, (law.step, law.contact_margin()));
        let impacts = Vec::with_capacity(agenda.impacts);
        Self { bodies, broad_phase, pairs, rest, law, agenda, impacts, rounds: 0 }
    }

    /// Lets a substep pass: contacts hold what rests, then touch comes after touch.
    pub fn substep(&mut self, span: Span) {
        self.pairs.watch_again(self.bodies, self.agenda.rerouted.drain(..), self.law.step);
        self.rest.adopt(self.bodies, self.pairs, self.law, span);
        let mut renewed = std::mem::take(&mut self.agenda.renewed);
        self.rest.hold(self.bodies, self.pairs, (self.law, span), &mut renewed);
        self.claim_anew(&renewed, span.from);
        renewed.iter().for_each(|&row| self.agenda.is_renewed[row] = true);
        self.pairs.watch_again(self.bodies, renewed.iter().copied(), self.law.step);
        self.ask_due(span);
        renewed.drain(..).for_each(|row| self.agenda.is_renewed[row] = false);
        self.agenda.renewed = renewed;
        while let Some(Reverse(event)) = self.agenda.queue.peek().copied() {
            if event.time > span.until {
                break;
            }
            self.agenda.queue.pop();
            if self.pairs.now(event.pair).stamp == event.stamp {
                self.touch(event.pair, Span { from: event.time, ..span });
            }
        }
    }

    /// Asks the pairs that nobody has asked for this long, or whose bodies have got new paths since.
    fn ask_due(&mut self, span: Span) {
        let _phase = profile::phase(Phase::Ask);
        let mut due = std::mem::take(&mut self.agenda.due);
        for number in 0..self.pairs.count_of_watched() {
            let index = self.pairs.watched(number);
            let pair = &self.pairs[index];
            let is_renewed = pair.rows().into_iter().any(|row| self.agenda.is_renewed[row]);
            let now = self.pairs.now(index);
            let is_due = (is_renewed || now.asked_until < span.until) && !now.is_sensed;
            if !is_due {
                continue;
            }
            if pair.rests && (pair.is_pressed || self.rest.is_closed(pair)) {
                if now.asked_until > span.from {
                    self.pairs.now_mut(index).asked_until = span.from;
                }
            } else if !self.keeps_away(index, span) {
                due.push(index);
            }
        }
        self.ask_all(due, span);
    }

    /// Whether nobody has asked a pair in this step, and nobody need: whichever way its bodies go, they have not enough left to meet.
    fn keeps_away(&self, index: usize, span: Span) -> bool {
        let pair = &self.pairs[index];
        !pair.rests
            && !self.pairs.has_present(index)
            && self.pairs.least_separation(self.bodies, index, self.end_of_path(pair, span))
                > pair.tolerance(self.bodies)
    }

    /// Until when the paths of a pair's bodies are known, s: what contacts hold gets a new one in each substep.
    fn end_of_path(&self, pair: &Pair, span: Span) -> f64 {
        let is_held = pair.rows().into_iter().any(|row| self.rest.is_held(row));
        if is_held { span.until } else { self.law.step }
    }

    /// Asks all these pairs when they will touch, from the start of `span` on.
    fn ask_all(&mut self, mut due: Vec<usize>, span: Span) {
        let mut answers = std::mem::take(&mut self.agenda.answers);
        for due in due.chunks(AT_ONCE) {
            self.rest.pool().map_into(due, QUESTIONS, |&index| self.answer(index, span), &mut answers);
            for (&index, answer) in due.iter().zip(answers.drain(..)) {
                self.note(index, answer, span);
            }
        }
        due.clear();
        (self.agenda.due, self.agenda.answers) = (due, answers);
    }

    /// All that has happened, each impact with its time within the step.
    pub fn finish(self) -> Vec<Impact> {
        self.pairs.end_step(self.bodies, self.law.step);
        self.agenda.impacts = self.impacts.len();
        self.impacts
    }

    /// Asks a pair when it will touch, from the start of `span` on.
    fn ask(&mut self, index: usize, span: Span) {
        let answer = self.answer(index, span);
        self.note(index, answer, span);
    }

    /// What a pair answers to that.
    fn answer(&self, index: usize, span: Span) -> Answer {
        let pair = &self.pairs[index];
        let until = self.end_of_path(pair, span);
        let tolerance = pair.tolerance(self.bodies);
        let mut answer = Answer { until, gap: None, apart: [f64::NEG_INFINITY; 2], instant: None };
        let may_touch = if pair.rests {
            !self.rest.presses(self.bodies, pair, self.law)
                && self.rest.is_driven(self.bodies, pair, self.law, span)
        } else {
            self.pairs.least_separation(self.bodies, index, until) <= tolerance
        };
        if !may_touch {
            return answer;
        }
        if !pair.rests
            && !pair.sensor
            && let Some(outlook) = outlook(self.bodies, pair.colliders, (span.from, until), tolerance)
        {
            let instant = outlook.touch.map(|wait| span.from + wait);
            let apart = [outlook.least, outlook.end];
            let gap = Gap { separation: outlook.separation, normal: None };
            return Answer { until, gap: Some(gap), apart, instant };
        }
        let [apart, least] = pair.least_facing(self.bodies, (span.from, until));
        if !pair.rests && least > tolerance {
            answer.gap = Some(Gap { separation: apart, normal: None });
            return answer;
        }
        let Some(approach) = Approach::of(self.bodies, pair.colliders, self.law) else { return answer };
        if pair.rests {
            let kept = self.rest.kept(self.bodies, pair, (self.law, span.from));
            let gap = approach.gap(span.from);
            answer.instant = approach.next_touch(self.pairs, gap, (span.from, until), Some(kept));
            return answer;
        }
        let gap = approach.gap(span.from);
        answer.gap = Some(gap);
        if pair.least_after(self.bodies, (gap, span.from), until) > approach.tolerance() {
            return answer;
        }
        answer.instant = if pair.sensor {
            approach.first_overlap(gap, (span.from, until))
        } else {
            approach.next_touch(self.pairs, gap, (span.from, until), None)
        };
        answer
    }

    /// Notes what a pair has answered.
    fn note(&mut self, index: usize, Answer { until, gap, apart, instant }: Answer, span: Span) {
        let rows = self.pairs[index].rows();
        let now = self.pairs.now_mut(index);
        now.apart = apart;
        if apart[0] > f64::NEG_INFINITY {
            // Nobody asks on which courses they are of whom nothing is known.
            now.courses = rows.map(|row| self.bodies.courses[row]);
        }
        now.stamp += 1;
        (now.asked_from, now.asked_until) = (span.from, until);
        let stamp = now.stamp;
        if let Some(gap) = gap {
            self.pairs[index].faced(self.bodies, gap, span.from);
        }
        if let Some(time) = instant {
            let key = order(self.bodies, self.pairs[index].colliders);
            self.agenda.queue.push(Reverse(Event { time, key, pair: index, stamp }));
        }
    }

    fn touch(&mut self, index: usize, span: Span) {
        let _phase = profile::phase(Phase::Strike);
        let (colliders, rows) = (self.pairs[index].colliders, self.pairs[index].rows());
        let time = span.from;
        if self.pairs[index].sensor {
            self.pairs.now_mut(index).is_sensed = true;
            return;
        }
        for row in rows {
            rouse(self.bodies, row, self.law, time);
            advance(self.bodies, row, time);
            self.agenda.rerouted.push(row);
            self.agenda.touches_of_row[row] += u32::from(row != WORLD_ROW);
        }
        let rests = self.pairs[index].rests;
        let kept = rests.then(|| {
            let pair = &self.pairs[index];
            self.rest.kept(self.bodies, pair, (self.law, self.pairs.now(index).asked_from))
        });
        let Some(approach) = Approach::of(self.bodies, colliders, self.law) else { return };
        let Some(touch) = approach.confirmed_touch(self.pairs, time, kept) else {
            // It vanished under a closer look: look again a moment later, the next time twice that.
            let now = self.pairs.now_mut(index);
            now.patience *= 2.0;
            let later = time + now.patience * self.law.step;
            if later < span.until {
                self.ask(index, Span { from: later, ..span });
            } else {
                self.pairs.now_mut(index).asked_until = span.until;
            }
            return;
        };
        if !self.comes_to_rest(index, &touch) {
            self.strike(index, &touch, span);
        } else if !rests {
            self.rest.take(self.bodies, self.pairs, index, (self.law, span));
        }
    }

    /// Carries out a collision, with all that is struck at the same instant.
    fn strike(&mut self, index: usize, touch: &Touch, span: Span) {
        let at = (self.law, span.from);
        let outcome = Instant::new(self.bodies, (self.pairs, self.rest), (index, touch), at).resolve();
        let rounds = outcome.impacts.iter().map(|impact| impact.round + 1).max().unwrap_or(0);
        self.impacts.extend(
            outcome.impacts.into_iter().map(|impact| Impact { round: self.rounds + impact.round, ..impact }),
        );
        self.rounds += rounds;
        let mut struck = outcome.struck;
        struck.sort_unstable_by_key(|&(pair, _)| self.pairs[pair].colliders);
        for (pair, stays) in struck {
            self.pairs.now_mut(pair).hits += 1;
            if stays && !self.pairs[pair].rests {
                self.rest.take(self.bodies, self.pairs, pair, (self.law, span));
            }
        }
        for &row in &outcome.rows {
            let until = if self.rest.is_held(row) { span.until } else { self.law.step };
            set_pace(self.bodies, row, until);
        }
        self.reroute(outcome.rows, span);
        for pair in outcome.unfinished {
            self.rest.hand_back(self.pairs, pair);
            let now = self.pairs.now_mut(pair);
            now.stamp += 1;
            now.asked_until = span.until;
        }
    }

    /// Whether a touch is to be a contact, not an impact.
    fn comes_to_rest(&mut self, index: usize, touch: &Touch) -> bool {
        let closing = -touch.closing_speed;
        let now = self.pairs.now_mut(index);
        now.fastest = now.fastest.max(closing);
        let (hits, fastest) = (now.hits, now.fastest);
        let pair = &self.pairs[index];
        let rattles = if pair.bounces {
            hits >= RATTLE_HITS && closing < RATTLE_SPEED * fastest
        } else {
            hits > 0 && closing < RATTLE_SPEED * fastest.max(self.law.rest_speed())
        };
        let wedged = pair.rows().iter().any(|&row| self.agenda.touches_of_row[row] >= WEDGED_TOUCHES);
        closing <= touch.rest_speed || rattles || wedged
    }

    /// Bodies have got new paths at the start of `span`: find whom they could touch now, and ask all their pairs again.
    fn reroute(&mut self, mut rows: Vec<usize>, span: Span) {
        let _phase = profile::phase(Phase::Ask);
        rows.retain(|&row| row != WORLD_ROW);
        self.agenda.rerouted.extend(&rows);
        self.claim_anew(&rows, span.from);
        let mut due = std::mem::take(&mut self.agenda.due);
        for row in rows {
            let pairs = (0..self.pairs.count_of_row(row)).map(|number| self.pairs.of_row(row, number));
            due.extend(
                pairs.filter(|&index| !self.pairs.now(index).is_sensed && !self.keeps_away(index, span)),
            );
        }
        due.sort_unstable();
        due.dedup();
        self.ask_all(due, span);
    }

    /// Looks for new neighbours of those bodies whose paths could lead out of their boxes.
    fn claim_anew(&mut self, rows: &[usize], time: f64) {
        let _phase = profile::phase(Phase::Find);
        for &row in rows {
            self.broad_phase.move_within_step(self.bodies, row);
            for &colliders in self.broad_phase.found() {
                if let Some(new) = self.pairs.add(self.bodies, colliders) {
                    // To be asked by whoever asks all pairs of this body.
                    self.pairs.now_mut(new).asked_until = time;
                }
            }
        }
    }
}
