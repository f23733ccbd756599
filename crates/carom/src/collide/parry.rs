//! Every pair that has no kernel of its own, through parry3d.

use crate::collide::Manifold;
use crate::math::Pose;
use crate::shape::Shape;

/// As [`crate::collide::separation`].
pub(crate) fn separation(_a: &Shape, _pose_a: &Pose, _b: &Shape, _pose_b: &Pose) -> f64 {
    unimplemented!()
}

/// As [`crate::collide::manifolds`].
pub(crate) fn manifolds(_a: (&Shape, &Pose), _b: (&Shape, &Pose), _margin: f64, _out: &mut Vec<Manifold>) {
    unimplemented!()
}
