//! Convex polyhedra.

use crate::error::Invalid;
use crate::math::DVec3;

/// A convex polyhedron.
#[derive(Clone, Debug)]
pub struct Hull {}

impl Hull {
    /// The convex hull of `points` (m).
    ///
    /// # Errors
    /// If a point is not finite or the hull has no volume.
    pub fn new(_points: &[DVec3]) -> Result<Self, Invalid> {
        unimplemented!()
    }

    /// Its corners, m.
    pub fn vertices(&self) -> &[DVec3] {
        unimplemented!()
    }

    /// Its surface as triangles, anticlockwise from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        unimplemented!()
    }
}
