//! Carom: a 3D rigid-body physics engine. Fast, right, and able to explain every collision it resolves.

pub mod conditions;
pub mod impulse;
pub mod math;

mod bodies;
mod body;
pub mod collide;
mod error;
mod filter;
pub mod hull;
pub mod mass;
mod material;
pub mod mesh;
pub mod report;
mod shape;
mod world;

pub use bodies::{BodyId, BodyState};
pub use body::{Body, Collider, Motion, PrincipalInertia};
pub use error::{Invalid, limits};
pub use filter::{Accepts, Filter, Groups};
pub use material::{Combine, Material, Surface};
pub use shape::Shape;
pub use world::{Energy, Momentum, Settings, StepReport, World};

/// What most programs need.
pub mod prelude {
    pub use crate::math::{DQuat, DVec3, Quat, Vec3};
    pub use crate::{Body, BodyId, Collider, Material, Motion, Shape, World};
}
