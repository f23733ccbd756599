//! Carom: a 3D rigid-body physics engine. Fast, right, and able to explain every collision it resolves.

pub mod conditions;
pub mod impulse;
pub mod math;

mod bodies;
mod body;
pub mod collide;
mod error;
mod filter;
mod flight;
pub mod hull;
mod impacts;
pub mod mass;
mod material;
pub mod mesh;
pub mod report;
mod shape;
mod solver;
mod step;
mod world;

pub use bodies::{BodyId, BodyState};
pub use body::{Body, Collider, Motion, PrincipalInertia};
pub use error::{Invalid, limits};
pub use filter::{Accepts, Filter, Groups};
pub use material::{Combine, Material, Surface};
pub use report::{Impact, Overlap, StepReport};
pub use shape::Shape;
pub use world::{BodyMut, Energy, Momentum, Settings, World};

/// What most programs need.
pub mod prelude {
    pub use crate::math::{DQuat, DVec3, Quat, Vec3};
    pub use crate::{Body, BodyId, Collider, Material, Motion, Shape, World};
}

#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct ReadmeExamples;
