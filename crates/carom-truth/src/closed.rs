//! Closed forms. Each is tested against an integration that shares nothing with it.

pub mod bounce;
pub mod friction;
pub mod solids;
pub mod together;
pub mod top;
pub mod tumble;
