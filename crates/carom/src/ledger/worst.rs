//! Which step and which body fitted worst.

use super::Books;
use super::journal::{ARTEFACTS, Closing};
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
    /// The largest residual of a step.
    pub(super) fn residual(
        books: &Books,
        closing: &Closing,
        bodies: &Bodies,
        (step, time): (u64, f64),
    ) -> Self {
        let relative = books.relative_residual();
        let kind = largest(relative.into_iter()).map_or(0, |(kind, _)| kind);
        let row = largest(closing.residuals.iter().map(|residual| residual.sizes()[kind]));
        Self {
            post: KINDS[kind],
            step,
            time,
            body: row.and_then(|(row, _)| body_of(bodies, row)),
            amount: books.residual().sizes()[kind],
            relative: relative[kind],
            weight: relative[kind],
        }
    }

    /// The largest artefact of a step.
    pub(super) fn artefact(
        books: &Books,
        closing: &Closing,
        bodies: &Bodies,
        (step, time): (u64, f64),
    ) -> Self {
        let of_body =
            |values: &[f64; ARTEFACTS.len()]| values.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
        let row = largest(closing.artefacts.iter().map(of_body)).map_or(0, |(row, _)| row);
        let values = closing.artefacts.get(row).copied().unwrap_or_default();
        let (post, amount) = largest(values.iter().map(|it| it.abs())).unwrap_or((0, 0.0));
        let relative = amount / (books.throughput[2] + f64::MIN_POSITIVE);
        let body = body_of(bodies, row);
        Self { post: ARTEFACTS[post], step, time, body, amount, relative, weight: amount }
    }

    /// The worse of two, if there is anything.
    pub(super) fn worse(self, other: Option<Worst>) -> Option<Worst> {
        match other {
            Some(other) if other.weight >= self.weight => Some(other),
            other => {
                if self.weight > 0.0 {
                    Some(self)
                } else {
                    other
                }
            }
        }
    }
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
