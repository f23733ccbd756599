//! What a user writes down to make a body.

use crate::error::{Invalid, limits};
use crate::filter::Filter;
use crate::mass::{BodyMass, MassProperties};
use crate::material::Material;
use crate::math::{DQuat, DVec3, Pose, Quat, Vec3};
use crate::shape::Shape;

/// How a body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Motion {
    /// Under forces and impulses.
    #[default]
    Dynamic,
    /// Not at all.
    Fixed,
    /// With its velocities, which nothing but the user changes.
    Kinematic,
}

/// Moments of inertia about the principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalInertia {
    /// Moments about the centre of mass, kg·m²; 0 stands for infinite.
    pub diagonal: DVec3,
    /// Turns the principal axes into the body's.
    pub orientation: DQuat,
}

/// A shape on a body, with what it is made of.
#[derive(Clone, Debug)]
pub struct Collider {
    /// The form.
    pub shape: Shape,
    /// Where the shape sits in the body's frame.
    pub pose: Pose,
    /// Density, kg/m³.
    pub density: f64,
    /// Friction and restitution.
    pub material: Material,
    /// Whom it touches.
    pub filter: Filter,
    /// A sensor reports what overlaps it, pushes nothing and weighs nothing.
    pub sensor: bool,
}

impl Collider {
    /// A collider of `shape` at the body's origin: 1000 kg/m³, the default material, touching everything.
    pub fn new(shape: Shape) -> Self {
        Self {
            shape,
            pose: Pose::IDENTITY,
            density: 1000.0,
            material: Material::default(),
            filter: Filter::default(),
            sensor: false,
        }
    }

    /// The same collider at another place of the body (m, body frame).
    pub fn at(mut self, x: f64, y: f64, z: f64) -> Self {
        self.pose.position = DVec3::new(x, y, z);
        self
    }

    fn check(&self) -> Result<(), Invalid> {
        self.shape.check().map_err(|error| error.within("shape"))?;
        check_vector("position", self.pose.position, limits::POSITION, "m")?;
        if !self.pose.rotation.is_finite() || !self.pose.rotation.is_normalized() {
            return Err(Invalid::new("rotation", self.pose.rotation, "a unit quaternion [x, y, z, w]"));
        }
        limits::not_negative("density", self.density, "kg/m³")?;
        limits::not_negative("material.static_friction", self.material.static_friction, "")?;
        limits::not_negative("material.dynamic_friction", self.material.dynamic_friction, "")?;
        limits::within("material.restitution", self.material.restitution, 0.0..=1.0, "")
    }
}

/// A body before it joins a world: what it is, where it is and how it moves.
///
/// ```
/// use carom::prelude::*;
/// let club = Body::dynamic()
///     .named("club")
///     .at(0.0, 1.0, 0.0)
///     .with(Shape::capsule(0.8, 0.02))
///     .collider(Collider::new(Shape::sphere(0.06)).at(0.0, 0.4, 0.0))
///     .restitution(0.8);
/// assert!(club.check().is_ok());
/// ```
#[derive(Clone, Debug)]
pub struct Body {
    /// What reports call it. May be empty.
    pub name: String,
    /// How it moves.
    pub motion: Motion,
    /// Where its origin lies in the world, m. The origin need not be the centre of mass.
    pub position: DVec3,
    /// Turns its frame into the world's; unit length.
    pub rotation: Quat,
    /// Velocity of its centre of mass in the world, m/s.
    pub linear_velocity: Vec3,
    /// Angular velocity in the world, rad/s.
    pub angular_velocity: Vec3,
    /// The part of its linear velocity that it loses, 1/s: v falls as e^(−c·t).
    pub linear_damping: f64,
    /// The part of its angular momentum that it loses, 1/s.
    pub angular_damping: f64,
    /// Gravity acts times this; may be 0 or negative.
    pub gravity_factor: f64,
    /// Mass, kg, in place of the colliders' (which then share it out, by their volumes or, where they have none, by their
    /// surfaces); 0 stands for infinite.
    pub mass: Option<f64>,
    /// Centre of mass in the body's frame, m, in place of the colliders'.
    pub center_of_mass: Option<DVec3>,
    /// Inertia in place of the colliders'.
    pub inertia: Option<PrincipalInertia>,
    /// Its shapes.
    pub colliders: Vec<Collider>,
    /// Yours; the engine only carries it.
    pub user_data: u64,
}

impl Body {
    fn new(motion: Motion) -> Self {
        Self {
            name: String::new(),
            motion,
            position: DVec3::ZERO,
            rotation: Quat::IDENTITY,
            linear_velocity: Vec3::ZERO,
            angular_velocity: Vec3::ZERO,
            linear_damping: 0.0,
            angular_damping: 0.0,
            gravity_factor: 1.0,
            mass: None,
            center_of_mass: None,
            inertia: None,
            colliders: Vec::new(),
            user_data: 0,
        }
    }

    /// A body that moves under forces and impulses.
    pub fn dynamic() -> Self {
        Self::new(Motion::Dynamic)
    }

    /// A body that stays where it is; the scene file calls it `static`.
    pub fn fixed() -> Self {
        Self::new(Motion::Fixed)
    }

    /// A body that moves with its velocities and feels nothing.
    pub fn kinematic() -> Self {
        Self::new(Motion::Kinematic)
    }

    /// Gives it a name for reports.
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Places its origin (m, world).
    pub fn at(mut self, x: f64, y: f64, z: f64) -> Self {
        self.position = DVec3::new(x, y, z);
        self
    }

    /// Turns it: `rotation` takes its axes to the world's and must have unit length.
    pub fn rotated(mut self, rotation: Quat) -> Self {
        self.rotation = rotation;
        self
    }

    /// Sets the velocity of its centre of mass (m/s, world).
    pub fn moving(mut self, x: f32, y: f32, z: f32) -> Self {
        self.linear_velocity = Vec3::new(x, y, z);
        self
    }

    /// Sets its angular velocity (rad/s, world).
    pub fn spinning(mut self, x: f32, y: f32, z: f32) -> Self {
        self.angular_velocity = Vec3::new(x, y, z);
        self
    }

    /// Adds a collider of `shape` at the body's origin.
    pub fn with(self, shape: Shape) -> Self {
        self.collider(Collider::new(shape))
    }

    /// Adds a collider.
    pub fn collider(mut self, collider: Collider) -> Self {
        if self.colliders.is_empty() {
            // Most bodies have one.
            self.colliders.reserve_exact(1);
        }
        self.colliders.push(collider);
        self
    }

    /// Sets the restitution of all colliders added so far.
    pub fn restitution(mut self, restitution: f64) -> Self {
        self.colliders.iter_mut().for_each(|collider| collider.material.restitution = restitution);
        self
    }

    /// Sets both friction coefficients of all colliders added so far.
    pub fn friction(mut self, friction: f64) -> Self {
        for collider in &mut self.colliders {
            collider.material.static_friction = friction;
            collider.material.dynamic_friction = friction;
        }
        self
    }

    /// Sets the mass (kg; 0 = infinite); the colliders' densities only share it out.
    pub fn mass(mut self, mass: f64) -> Self {
        self.mass = Some(mass);
        self
    }

    /// Checks everything that [`World::try_add`](crate::World::try_add) asks for.
    ///
    /// # Errors
    /// Names the first field that no body can have, with its value and what was expected.
    pub fn check(&self) -> Result<(), Invalid> {
        check_vector("position", self.position, limits::POSITION, "m")?;
        if !self.rotation.is_finite() || !self.rotation.is_normalized() {
            return Err(Invalid::new("rotation", self.rotation, "a unit quaternion [x, y, z, w]"));
        }
        check_vector("linear_velocity", self.linear_velocity.as_dvec3(), limits::SPEED, "m/s")?;
        check_vector("angular_velocity", self.angular_velocity.as_dvec3(), limits::SPEED, "rad/s")?;
        limits::not_negative("linear_damping", self.linear_damping, "1/s")?;
        limits::not_negative("angular_damping", self.angular_damping, "1/s")?;
        if !self.gravity_factor.is_finite() {
            return Err(Invalid::new("gravity_factor", self.gravity_factor, "a finite number"));
        }
        for (index, collider) in self.colliders.iter().enumerate() {
            collider.check().map_err(|error| error.within(&format!("colliders[{index}]")))?;
            if self.motion != Motion::Fixed
                && let Some(name) = collider.shape.only_fixed()
            {
                let field = format!("colliders[{index}].shape");
                return Err(Invalid::new(field, name, "another shape, or a static body"));
            }
        }
        if self.motion == Motion::Dynamic { BodyMass::of(self).map(|_| ()) } else { Ok(()) }
    }

    /// The colliders' mass, centre and inertia in the body's frame; sensors weigh nothing.
    pub fn collider_mass(&self) -> MassProperties {
        let solid = self.colliders.iter().filter(|collider| !collider.sensor);
        MassProperties::sum(
            solid
                .map(|collider| collider.shape.mass_properties(collider.density).transformed(&collider.pose)),
        )
    }

    /// The meshes as sheets of one thickness (1 m, so that densities are per area), centre and inertia in the body's frame;
    /// sensors weigh nothing. What shares out the body's mass where no collider encloses a volume.
    pub(crate) fn sheet_mass(&self) -> MassProperties {
        let solid = self.colliders.iter().filter(|collider| !collider.sensor);
        MassProperties::sum(solid.filter_map(|collider| match &collider.shape {
            Shape::Mesh(mesh) => {
                let sheet = MassProperties::sheet(mesh.vertices(), mesh.triangles(), collider.density);
                Some(sheet.transformed(&collider.pose))
            }
            _ => None,
        }))
    }
}

fn check_vector(field: &str, value: DVec3, limit: f64, unit: &str) -> Result<(), Invalid> {
    for axis in 0..3 {
        limits::within(&format!("{field}[{axis}]"), value[axis], -limit..=limit, unit)?;
    }
    Ok(())
}
