//! What can be wrong with what a user writes down.

use thiserror::Error;

/// A value that no body, shape or world can have. Says which value, what it was, and what would do.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{field}: {value}; expected {expected}")]
pub struct Invalid {
    /// Path of the field below the thing that was built, such as `colliders[0].shape.radius`.
    pub field: String,
    /// The value found, as text.
    pub value: String,
    /// What is allowed, with unit, and where it helps what to do.
    pub expected: String,
}

impl Invalid {
    /// An error about `field`, which holds `value`, where `expected` was wanted.
    pub fn new(field: impl Into<String>, value: impl ToString, expected: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.to_string(), expected: expected.into() }
    }

    /// The same error seen from further out: `prefix` goes before the field.
    pub fn within(mut self, prefix: &str) -> Self {
        self.field =
            if self.field.is_empty() { prefix.to_owned() } else { format!("{prefix}.{}", self.field) };
        self
    }
}

/// The ranges that hold for everything a user writes down. Wide enough for a grain of dust on a planet; within
/// them no product that the engine forms overflows or loses its meaning.
pub mod limits {
    use super::Invalid;
    use std::ops::RangeInclusive;

    /// Lengths of shapes, m.
    pub const LENGTH: RangeInclusive<f64> = 1e-6..=1e6;
    /// Each coordinate of a position, m, either sign.
    pub const POSITION: f64 = 1e9;
    /// Each component of a linear (m/s) or angular (rad/s) velocity, either sign.
    pub const SPEED: f64 = 1e6;
    /// Masses, kg.
    pub const MASS: RangeInclusive<f64> = 1e-9..=1e15;
    /// Principal moments of inertia, kg·m², that a user gives: the lightest speck's and the heaviest body's at most.
    pub const INERTIA: RangeInclusive<f64> = 1e-24..=1e34;

    /// Refuses a `value` outside `range` or not finite.
    pub fn within(field: &str, value: f64, range: RangeInclusive<f64>, unit: &str) -> Result<(), Invalid> {
        if range.contains(&value) {
            return Ok(());
        }
        let (low, high) = (range.start(), range.end());
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        Err(Invalid::new(field, value, format!("a number from {low:e} to {high:e}{unit}")))
    }

    /// Refuses a negative or non-finite `value`.
    pub fn not_negative(field: &str, value: f64, unit: &str) -> Result<(), Invalid> {
        if value >= 0.0 && value.is_finite() {
            return Ok(());
        }
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        Err(Invalid::new(field, value, format!("a finite number, 0{unit} or more")))
    }
}
