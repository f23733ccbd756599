//! Mass, centre of mass and inertia: of shapes, of compounds, and as a body uses them.

use crate::math::{DMat3, DQuat, DVec3, Pose};

/// What a rigid distribution of mass does to motion, in some frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub center: DVec3,
    /// Inertia about the centre of mass, kg·m², products of inertia included.
    pub inertia: DMat3,
}

impl MassProperties {
    /// Nothing at all.
    pub const NONE: MassProperties = MassProperties { mass: 0.0, center: DVec3::ZERO, inertia: DMat3::ZERO };

    /// A solid ball around the origin: `I = 2/5 m r²`.
    pub fn sphere(radius: f64, density: f64) -> Self {
        let mass = density * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let inertia = DMat3::from_diagonal(DVec3::splat(0.4 * mass * radius * radius));
        Self { mass, center: DVec3::ZERO, inertia }
    }

    /// A solid box around the origin with full edge lengths `size`: `I_x = m (y² + z²)/12`.
    pub fn cuboid(size: DVec3, density: f64) -> Self {
        let mass = density * size.x * size.y * size.z;
        let squares = size * size;
        let diagonal = DVec3::new(squares.y + squares.z, squares.x + squares.z, squares.x + squares.y);
        Self { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(diagonal * (mass / 12.0)) }
    }
}

impl MassProperties {
    /// The hull of two balls on the y axis, `height` apart.
    pub fn tapered_capsule(_height: f64, _radius_bottom: f64, _radius_top: f64, _density: f64) -> Self {
        unimplemented!()
    }

    /// The hull of two discs across the y axis, `height` apart: cylinder, cone, frustum.
    pub fn frustum(_height: f64, _radius_bottom: f64, _radius_top: f64, _density: f64) -> Self {
        unimplemented!()
    }

    /// The inside of a closed surface of triangles, anticlockwise from outside. Nothing if it encloses no volume.
    pub fn polyhedron(_vertices: &[DVec3], _triangles: &[[u32; 3]], _density: f64) -> Self {
        unimplemented!()
    }

    /// The same mass seen from the frame that `pose` leads to.
    pub fn transformed(&self, _pose: &Pose) -> Self {
        unimplemented!()
    }

    /// All of `parts` as one rigid body, all in one frame.
    pub fn sum(_parts: impl Iterator<Item = MassProperties>) -> Self {
        unimplemented!()
    }
}

/// Mass and inertia as a body uses them: inverse values, zero where infinite; inertia by its principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMass {
    /// Mass, kg; infinite if nothing can move the body.
    pub mass: f64,
    /// Centre of mass in the body's frame, m.
    pub center: DVec3,
    /// Principal moments of inertia about the centre of mass, kg·m²; infinite where nothing can turn it.
    pub moments: DVec3,
    /// Turns the principal axes into the body's.
    pub principal_rotation: DQuat,
}

impl BodyMass {
    /// What nothing can move: infinite mass and inertia.
    pub const INFINITE: BodyMass = BodyMass {
        mass: f64::INFINITY,
        center: DVec3::ZERO,
        moments: DVec3::INFINITY,
        principal_rotation: DQuat::IDENTITY,
    };

    /// Inverse principal moments, 1/(kg·m²): 0 where infinite.
    pub fn inverse_moments(&self) -> DVec3 {
        self.moments.map(|moment| if moment.is_finite() { 1.0 / moment } else { 0.0 })
    }

    /// The mass of a dynamic body: its colliders', with what the body says of its own in place of theirs.
    ///
    /// # Errors
    /// If mass or inertia come out as none that a body can have.
    pub fn of(_body: &crate::body::Body) -> Result<Self, crate::error::Invalid> {
        unimplemented!()
    }
}
