//! Cores that have kernels of their own beside a triangle.

use super::super::convex::Core;
use crate::collide::cuboid::Cuboid;
use crate::collide::polytope::{CuboidParts, Farthest, Moved, Polytope};
use crate::collide::segment::Segment;
use crate::math::{DVec3, Pose};

/// A core that has kernels of its own, in the surface's frame.
pub(in crate::collide::parry) enum Form<'a> {
    /// A ball's.
    Point(DVec3),
    /// A capsule's.
    Segment(Segment),
    /// A cuboid or a hull.
    Solid(Moved<'a, Polytope<'a>>),
}

impl Form<'_> {
    /// A point well inside.
    pub fn middle(&self) -> DVec3 {
        match self {
            Form::Point(point) => *point,
            Form::Segment(core) => core.center,
            Form::Solid(solid) => solid.place(solid.shape.middle),
        }
    }

    /// A length like the core's own, m.
    pub fn size(&self) -> f64 {
        match self {
            Form::Point(_) => 0.0,
            Form::Segment(core) => core.half.abs().max_element(),
            Form::Solid(solid) => solid.shape.size(),
        }
    }

    /// The point that lies farthest in `direction` (of any length).
    pub fn farthest(&self, direction: DVec3) -> DVec3 {
        match self {
            Form::Point(point) => *point,
            Form::Segment(core) => core.farthest(direction).1,
            Form::Solid(solid) => solid.farthest(direction).1,
        }
    }

    /// Hands `look` the form of a core at a pose; none for a core that has none.
    pub fn with<R>(core: &Core, pose: &Pose, look: impl FnOnce(Option<&Form>) -> R) -> R {
        match *core {
            Core::Point => look(Some(&Form::Point(pose.position))),
            Core::Segment { half } => {
                let half = pose.rotation * DVec3::new(0.0, half, 0.0);
                look(Some(&Form::Segment(Segment { center: pose.position, half })))
            }
            Core::Cuboid { half } => {
                let parts = CuboidParts::new(&Cuboid { half, pose: *pose });
                let polytope = parts.polytope();
                look(Some(&Form::Solid(Moved::new(&polytope, pose))))
            }
            Core::Hull(hull) => match Polytope::of_hull(hull, pose) {
                Some(polytope) => look(Some(&Form::Solid(Moved::new(&polytope, pose)))),
                None => look(None),
            },
            Core::Balls { .. } | Core::Frustum { .. } | Core::Triangle { .. } => look(None),
        }
    }
}
