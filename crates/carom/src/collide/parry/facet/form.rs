//! Cores that have kernels of their own beside a triangle.

use super::super::convex::Core;
use crate::collide::cuboid::Cuboid;
use crate::collide::polytope::{CuboidParts, Moved, Polytope};
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
