//! Impacts: when two bodies touch, and what becomes of them.

mod foreseen;
pub(crate) mod instant;
pub(crate) mod reflection;
pub(crate) mod seams;
pub(crate) mod strike;
pub(crate) mod time_of_impact;
