//! The tables of an explanation.

use crate::text::{COLUMN, number, rough, vector_row};
use carom::conditions::Condition;
use carom::impulse::Velocity;
use carom::math::DVec3;

/// The letters that stand for the two bodies.
pub const LETTERS: [&str; 2] = ["a", "b"];

/// A section's first line, over columns of vectors if asked for.
pub fn headline(title: &str, vectors: bool) -> String {
    if !vectors {
        return format!("{title}\n");
    }
    format!("{title:<28}{:>COLUMN$}{:>COLUMN$}{:>COLUMN$}\n", "x", "y", "z")
}

/// Both bodies' velocities.
pub fn velocities(when: &str, of: [&Velocity; 2]) -> String {
    let mut text = String::new();
    for (velocity, letter) in of.into_iter().zip(LETTERS) {
        text += &vector_row(&format!("velocity {when}"), &format!("v_l,{letter}"), velocity.linear, "m/s");
        text += &vector_row(&format!("spin {when}"), &format!("v_r,{letter}"), velocity.angular, "rad/s");
    }
    text
}

/// A law about a number.
pub fn scalar_condition(law: &str, condition: &Condition<f64>) -> String {
    let values = [condition.before, condition.after, condition.expected].map(number);
    condition_row(&format!("{} {law}", mark(condition.holds)), &values)
        + &judged(condition.error, condition.tolerance)
}

/// A law about a vector, in three lines.
pub fn vector_condition(law: &str, condition: &Condition<DVec3>) -> String {
    let row = |label: &str, axis: usize| {
        let values = [condition.before, condition.after, condition.expected].map(|value| number(value[axis]));
        condition_row(label, &values)
    };
    row(&format!("{} {law}", mark(condition.holds)), 0)
        + &judged(condition.error, condition.tolerance)
        + &row("", 1)
        + "\n"
        + &row("", 2)
        + "\n"
}

fn condition_row(label: &str, [before, after, expected]: &[String; 3]) -> String {
    format!("{label:<17}{before:>COLUMN$}{after:>COLUMN$}{expected:>COLUMN$}")
}

fn judged(error: f64, tolerance: f64) -> String {
    format!("{:>10}{:>12}\n", rough(error), rough(tolerance))
}

fn mark(holds: bool) -> char {
    if holds { '✓' } else { '✗' }
}
