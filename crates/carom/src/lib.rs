//! Carom: a 3D rigid-body physics engine. Fast, right, and able to explain every collision it resolves.
//!
//! # The tour
//! * [`impulse`] is the seed: how two bodies bounce, in five steps. [`conditions`] holds any collision to the three laws.
//! * [`Body`], [`Collider`], [`Shape`], [`Material`], [`Filter`] are what you write down; [`World`] takes them and steps.
//! * [`World::step`] returns a [`StepReport`]; each [`Impact`] in it can be taken apart again with [`Impact::resolve`].
//! * [`collide`] tells how far apart two shapes are and where they touch; [`mass`] what they weigh.
//!
//! Inside, `step.rs` is the page to begin with.
//!
//! # Units and signs
//! SI units, radians, right-handed, y up, quaternions `[x, y, z, w]`. Normals point from `a` to `b`; a closing speed is
//! negative. Positions are double precision; what a user reads of velocities and rotations is single precision.
//!
//! # Features
//! `deterministic` switches parry and glam to their scalar paths, for equal bits across targets.
//!
//! `profile` tells where the time of steps goes, phase by phase. Without it no clock is read.

// Tests in here share files with those outside.
#[cfg(test)]
extern crate self as carom;

// What a user writes down.
mod body;
mod filter;
mod material;
mod shape;

// What that weighs and is bounded by.
pub mod height_field;
pub mod hull;
pub mod mass;
pub mod mesh;

// The seed, and the laws.
pub mod conditions;
pub mod impulse;

// The world, and one step of it.
mod bodies;
mod boxes;
mod commands;
mod room;
mod step;
mod world;

// What a step is made of.
pub mod collide;
mod flight;
mod impacts;
mod solver;

// What it tells.
mod error;
mod fault;
pub mod ledger;
pub mod math;
#[cfg(feature = "profile")]
pub use step::profile;
pub mod report;

pub use bodies::{BodyId, BodyState};
pub use body::{Body, Collider, Motion, PrincipalInertia};
pub use commands::BodyMut;
pub use error::{Invalid, limits};
pub use filter::{Accepts, Filter, Groups};
pub use ledger::Ledger;
pub use material::{Combine, Material, Surface};
pub use report::{Impact, Overlap, StepReport};
pub use shape::Shape;
pub use solver::lanes::InstructionSet;
pub use world::{Energy, Momentum, Settings, World};

#[cfg(test)]
#[path = "../tests/random/mod.rs"]
pub(crate) mod random;

/// What most programs need.
pub mod prelude {
    pub use crate::math::{DQuat, DVec3, Quat, Vec3};
    pub use crate::{Body, BodyId, Collider, Material, Motion, Shape, World};
}

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExamples;
