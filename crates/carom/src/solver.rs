//! The solver of what rests.
//!
//! ```text
//! lanes.rs     several numbers in step: the vocabulary of the kernels, and which instructions they become
//! bundle.rs    contacts in the layout they are solved in
//! contact.rs   the arithmetic: contact/measure.rs, begin, contact/sweep.rs
//! kernels.rs   the same for many bundles at once, compiled for each instruction set
//! prepare.rs   a manifold becomes a lane
//! direct.rs    small stiff islands, solved at once
//! graph.rs     all contacts of a world: colours, islands, sweeps until they agree
//! rows.rs      velocities and motions of the bodies, as the kernels read them
//! ```

pub(crate) mod bundle;
pub(crate) mod contact;
pub(crate) mod direct;
pub(crate) mod graph;
pub(crate) mod kernels;
pub(crate) mod lanes;
pub(crate) mod prepare;
pub(crate) mod rows;

#[cfg(test)]
pub(crate) mod tests;
