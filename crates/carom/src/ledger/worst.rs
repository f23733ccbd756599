//! Which step and which body fitted worst.

use super::Books;
use super::journal::{ARTEFACTS, Journal};
use crate::bodies::{Bodies, BodyId};
use std::fmt;

/// A post that stands out.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// The post, as files call it; of momentum without the axis.
    pub post: &'static str,
    /// Step in the books, counted from 1, and the time at its end, s.
    pub step: u64,
    /// Time at its end, s.
    pub time: f64,
    /// The body that had most of it.
    pub body: Option<BodyId>,
    /// The amount: of a residual, the whole one of the step; of an artefact, what the body got. N·s, N·m·s or J.
    pub amount: f64,
    /// The same over what went through the books of that step.
    pub relative: f64,
    weight: f64,
}

const KINDS: [&str; 3] = ["residual_p", "residual_l", "residual_energy"];

impl Worst {
    /// The largest residual of a step, unless the `present` one is as bad.
    pub(super) fn residual(
        books: &Books,
        (journal, bodies): (&Journal, &Bodies),
        (step, time): (u64, f64),
        present: Option<Worst>,
    ) -> Option<Self> {
        let relative = books.relative_residual();
        let (kind, weight) = largest(relative.into_iter()).unwrap_or((0, 0.0));
        if !outweighs(weight, &present) {
            return present;
        }
        // Whose it is, is asked only now: it takes a look at every body.
        let row = largest(journal.residuals().map(|residual| residual.sizes()[kind]));
        Some(Self {
            post: KINDS[kind],
            step,
            time,
            body: row.and_then(|(row, _)| body_of(bodies, row)),
            amount: books.residual().sizes()[kind],
            relative: weight,
            weight,
        })
    }

    /// The largest artefact of a step, unless the `present` one is as large.
    pub(super) fn artefact(
        books: &Books,
        (journal, bodies): (&Journal, &Bodies),
        (step, time): (u64, f64),
        present: Option<Worst>,
    ) -> Option<Self> {
        let most = if journal.is_record { journal.most_artefact() } else { None };
        let Some((row, post, amount)) = most.filter(|most| outweighs(most.2, &present)) else {
            return present;
        };
        let relative = amount / (books.throughput[2] + f64::MIN_POSITIVE);
        let body = body_of(bodies, row);
        Some(Self { post: ARTEFACTS[post], step, time, body, amount, relative, weight: amount })
    }
}

/// Whether there is something, and more than what was worst so far.
fn outweighs(weight: f64, present: &Option<Worst>) -> bool {
    weight > present.as_ref().map_or(0.0, |worst| worst.weight)
}

fn body_of(bodies: &Bodies, row: usize) -> Option<BodyId> {
    bodies.slot_of_row.get(row).and_then(|&slot| bodies.id_of(slot))
}

/// Which value is the largest; the first of equal ones.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().reduce(|most, next| if next.1 > most.1 { next } else { most })
}

impl fmt::Display for Worst {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let body = self.body.map_or(String::new(), |body| format!(", body {}", body.index()));
        write!(f, "{} {:.1e} in step {} ({:.4} s){body}", self.post, self.amount, self.step, self.time)
    }
}
