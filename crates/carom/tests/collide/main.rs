//! The narrow phase against an independent oracle, against its own symmetries, and on contacts known by hand.

mod degenerate;
mod features;
mod height_field;
mod oracle;
mod properties;
#[path = "../random/mod.rs"]
mod random;
mod support;
