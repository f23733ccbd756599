//! The solver of what rests.

pub(crate) mod contact;
