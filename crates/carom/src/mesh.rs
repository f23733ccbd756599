//! Surfaces of triangles.

use crate::error::Invalid;
use crate::math::DVec3;

/// A surface of triangles, solid from both sides.
#[derive(Clone, Debug)]
pub struct Mesh {}

impl Mesh {
    /// A surface of triangles: each names three of `vertices` (m).
    ///
    /// # Errors
    /// If a vertex is not finite, a triangle names a vertex that is not there, or there is no triangle.
    pub fn new(_vertices: Vec<DVec3>, _triangles: Vec<[u32; 3]>) -> Result<Self, Invalid> {
        unimplemented!()
    }

    /// Its corners, m.
    pub fn vertices(&self) -> &[DVec3] {
        unimplemented!()
    }

    /// Its triangles.
    pub fn triangles(&self) -> &[[u32; 3]] {
        unimplemented!()
    }
}
