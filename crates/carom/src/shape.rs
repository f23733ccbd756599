//! Shapes: what a collider looks like, its bounds, and what it weighs.
//!
//! Lengths are in metres, volumes in m³. Round shapes lie along y, centred on the middle of their height.

use crate::error::{Invalid, limits};
use crate::height_field::HeightField;
use crate::hull::Hull;
use crate::mass::MassProperties;
use crate::math::{DVec3, Pose};
use crate::mesh::Mesh;
use std::sync::Arc;

/// The form of a collider in its own frame.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A ball around the origin.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// A box around the origin, edges along the axes.
    Cuboid {
        /// Full edge lengths, m.
        size: DVec3,
    },
    /// All points within `radius` of a segment along y.
    Capsule {
        /// Length of the segment (the cylindrical part), m.
        height: f64,
        /// Radius, m.
        radius: f64,
    },
    /// The hull of two balls on the y axis.
    TaperedCapsule {
        /// Distance of the balls' centres, m.
        height: f64,
        /// Radius of the ball at −height/2, m; may be 0.
        radius_bottom: f64,
        /// Radius of the ball at +height/2, m; may be 0.
        radius_top: f64,
    },
    /// A cylinder, cone or frustum: the hull of two discs across the y axis.
    Cylinder {
        /// Distance of the discs, m.
        height: f64,
        /// Radius of the disc at −height/2, m; may be 0.
        radius_bottom: f64,
        /// Radius of the disc at +height/2, m; may be 0 (a cone with its apex at +y).
        radius_top: f64,
    },
    /// The half space y ≤ 0. For bodies that don't move.
    Plane,
    /// A convex polyhedron.
    Hull(Arc<Hull>),
    /// A surface of triangles, solid from both sides.
    Mesh(Arc<Mesh>),
    /// Heights over a grid, solid from both sides. For bodies that don't move.
    HeightField(Arc<HeightField>),
}

impl Shape {
    /// A ball of the given radius (m).
    pub fn sphere(radius: f64) -> Self {
        Shape::Sphere { radius }
    }

    /// A box with the given full edge lengths (m).
    pub fn cuboid(x: f64, y: f64, z: f64) -> Self {
        Shape::Cuboid { size: DVec3::new(x, y, z) }
    }

    /// A capsule along y; `height` is that of the cylindrical part (m).
    pub fn capsule(height: f64, radius: f64) -> Self {
        Shape::Capsule { height, radius }
    }

    /// A cylinder along y (m).
    pub fn cylinder(height: f64, radius: f64) -> Self {
        Shape::Cylinder { height, radius_bottom: radius, radius_top: radius }
    }

    /// A cone along y with its apex at +height/2 (m).
    pub fn cone(height: f64, radius: f64) -> Self {
        Shape::Cylinder { height, radius_bottom: radius, radius_top: 0.0 }
    }

    /// The half space y ≤ 0.
    pub fn plane() -> Self {
        Shape::Plane
    }

    /// The convex hull of `points` (m).
    ///
    /// # Errors
    /// If a point is not finite or the hull has no volume.
    pub fn hull(points: &[DVec3]) -> Result<Self, Invalid> {
        Hull::new(points).map(|hull| Shape::Hull(Arc::new(hull)))
    }

    /// A surface of triangles: each names three of `vertices` (m).
    ///
    /// # Errors
    /// If a vertex is not finite, a triangle names a vertex that is not there, or there is no triangle.
    pub fn mesh(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, Invalid> {
        Mesh::new(vertices, triangles).map(|mesh| Shape::Mesh(Arc::new(mesh)))
    }

    /// Radius (m) with which the surface is round at `point` about the y axis, where its outward normal is `outward`: 0 where it
    /// is flat or has a corner. What rolls on such a surface touches at a point that does not turn with it.
    pub(crate) fn roundness(&self, point: DVec3, outward: DVec3) -> f64 {
        let across = DVec3::new(outward.x, 0.0, outward.z).length();
        match *self {
            Shape::Sphere { radius } | Shape::Capsule { radius, .. } => radius,
            // Along the normal to the axis; the discs' faces and rims are not round.
            Shape::Cylinder { .. } | Shape::TaperedCapsule { .. } if across > 0.3 => {
                DVec3::new(point.x, 0.0, point.z).length() / across
            }
            Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
                if point.y > 0.5 * height {
                    radius_top
                } else {
                    radius_bottom
                }
            }
            _ => 0.0,
        }
    }

    /// Heights (m) in rows along z, each a list along x, over a rectangle of the full extent `size` (x and z, m), centred.
    /// For bodies that don't move.
    ///
    /// # Errors
    /// If there are fewer than two rows, rows that are shorter than two or not of one length, or a number out of range.
    pub fn height_field(heights: &[Vec<f64>], size: [f64; 2]) -> Result<Self, Invalid> {
        HeightField::new(heights, size).map(|field| Shape::HeightField(Arc::new(field)))
    }

    /// What a shape that only a body at rest can have is called: it has no bounds, or is ground by its nature.
    pub fn only_fixed(&self) -> Option<&'static str> {
        match self {
            Shape::Plane => Some("plane"),
            Shape::HeightField(_) => Some("height field"),
            _ => None,
        }
    }

    /// Checks the lengths: finite, 1e-6 to 1e6 m; at most one radius of a tapered shape 0.
    ///
    /// # Errors
    /// Names the first length that is out of range.
    pub fn check(&self) -> Result<(), Invalid> {
        let length = |field: &str, value: f64| limits::within(field, value, limits::LENGTH, "m");
        let tapered = |height: f64, bottom: f64, top: f64| {
            length("height", height)?;
            for (field, radius, other) in [("radius_bottom", bottom, top), ("radius_top", top, bottom)] {
                if radius != 0.0 || other == 0.0 {
                    length(field, radius)?;
                }
            }
            Ok(())
        };
        match self {
            Shape::Sphere { radius } => length("radius", *radius),
            Shape::Cuboid { size } => {
                (0..3).try_for_each(|axis| length(&format!("size[{axis}]"), size[axis]))
            }
            Shape::Capsule { height, radius } => length("height", *height).and(length("radius", *radius)),
            Shape::TaperedCapsule { height, radius_bottom, radius_top }
            | Shape::Cylinder { height, radius_bottom, radius_top } => {
                tapered(*height, *radius_bottom, *radius_top)
            }
            Shape::Plane | Shape::Hull(_) | Shape::Mesh(_) | Shape::HeightField(_) => Ok(()),
        }
    }

    /// Mass, centre of mass and inertia at the given density (kg/m³). A plane, an open mesh and a height field weigh
    /// nothing.
    pub fn mass_properties(&self, density: f64) -> MassProperties {
        match self {
            Shape::Sphere { radius } => MassProperties::sphere(*radius, density),
            Shape::Cuboid { size } => MassProperties::cuboid(*size, density),
            Shape::Capsule { height, radius } => {
                MassProperties::tapered_capsule(*height, *radius, *radius, density)
            }
            Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
                MassProperties::tapered_capsule(*height, *radius_bottom, *radius_top, density)
            }
            Shape::Cylinder { height, radius_bottom, radius_top } => {
                MassProperties::frustum(*height, *radius_bottom, *radius_top, density)
            }
            Shape::Plane | Shape::HeightField(_) => MassProperties::NONE,
            Shape::Hull(hull) => MassProperties::polyhedron(hull.vertices(), hull.triangles(), density),
            Shape::Mesh(mesh) => MassProperties::polyhedron(mesh.vertices(), mesh.triangles(), density),
        }
    }

    /// The smallest box along the world's axes around the shape at `pose`: lowest and highest corner. Infinite for a plane;
    /// for a height field around the box that stands around it in its own frame.
    pub fn bounds(&self, pose: &Pose) -> (DVec3, DVec3) {
        let center = pose.position;
        let along_y = |half: f64| pose.rotation * DVec3::new(0.0, half, 0.0);
        match self {
            Shape::Sphere { radius } => (center - DVec3::splat(*radius), center + DVec3::splat(*radius)),
            Shape::Cuboid { size } => {
                let half = 0.5 * *size;
                let reach = (pose.rotation * DVec3::X).abs() * half.x
                    + (pose.rotation * DVec3::Y).abs() * half.y
                    + (pose.rotation * DVec3::Z).abs() * half.z;
                (center - reach, center + reach)
            }
            Shape::Capsule { height, radius } => {
                let reach = along_y(0.5 * height).abs() + DVec3::splat(*radius);
                (center - reach, center + reach)
            }
            Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
                let half = along_y(0.5 * height);
                let (bottom, top) = (DVec3::splat(*radius_bottom), DVec3::splat(*radius_top));
                (center + (-half - bottom).min(half - top), center + (-half + bottom).max(half + top))
            }
            Shape::Cylinder { height, radius_bottom, radius_top } => {
                let half = along_y(0.5 * height);
                let axis = pose.rotation * DVec3::Y;
                let disc = (DVec3::ONE - axis * axis).max(DVec3::ZERO).map(f64::sqrt);
                let (bottom, top) = (disc * *radius_bottom, disc * *radius_top);
                (center + (-half - bottom).min(half - top), center + (-half + bottom).max(half + top))
            }
            Shape::Plane => (DVec3::NEG_INFINITY, DVec3::INFINITY),
            Shape::Hull(hull) => {
                let farthest = |axis: DVec3| {
                    pose.transform_point(hull.support(pose.rotation.conjugate() * axis)).dot(axis)
                };
                let ends =
                    |sign: f64| sign * DVec3::from_array(DVec3::AXES.map(|axis| farthest(axis * sign)));
                (ends(-1.0), ends(1.0))
            }
            Shape::Mesh(mesh) => bounds_of_points(mesh.vertices(), pose),
            Shape::HeightField(field) => field.placed_bounds(pose),
        }
    }

    /// The largest distance of any of the shape's points from `origin` (m), both in the shape's frame. Infinite for a plane;
    /// that of the box around it for a height field.
    pub fn reach(&self, origin: DVec3) -> f64 {
        let from = |y: f64| (origin - DVec3::new(0.0, y, 0.0)).length();
        match self {
            Shape::Sphere { radius } => from(0.0) + radius,
            Shape::Cuboid { size } => (origin.abs() + 0.5 * *size).length(),
            Shape::Capsule { height, radius } => from(0.5 * height).max(from(-0.5 * height)) + radius,
            Shape::TaperedCapsule { height, radius_bottom, radius_top } => {
                (from(-0.5 * height) + radius_bottom).max(from(0.5 * height) + radius_top)
            }
            Shape::Cylinder { height, radius_bottom, radius_top } => {
                let across = (origin.x * origin.x + origin.z * origin.z).sqrt();
                let rim = |y: f64, radius: f64| {
                    ((across + radius) * (across + radius) + (origin.y - y) * (origin.y - y)).sqrt()
                };
                rim(-0.5 * height, *radius_bottom).max(rim(0.5 * height, *radius_top))
            }
            Shape::Plane => f64::INFINITY,
            Shape::Hull(hull) => reach_of_points(hull.vertices(), origin),
            Shape::Mesh(mesh) => reach_of_points(mesh.vertices(), origin),
            Shape::HeightField(field) => field.reach(origin),
        }
    }

    /// The smallest width of the shape (m): how far something may move before it could have passed through.
    pub fn thickness(&self) -> f64 {
        match self {
            Shape::Sphere { radius } | Shape::Capsule { radius, .. } => 2.0 * radius,
            Shape::Cuboid { size } => size.min_element(),
            Shape::TaperedCapsule { radius_bottom, radius_top, .. } => 2.0 * radius_bottom.max(*radius_top),
            Shape::Cylinder { height, radius_bottom, radius_top } => {
                height.min(2.0 * radius_bottom.max(*radius_top))
            }
            Shape::Plane => f64::INFINITY,
            Shape::Hull(hull) => {
                let (low, high) = bounds_of_points(hull.vertices(), &Pose::IDENTITY);
                (high - low).min_element()
            }
            Shape::Mesh(_) | Shape::HeightField(_) => 0.0,
        }
    }
}

fn bounds_of_points(points: &[DVec3], pose: &Pose) -> (DVec3, DVec3) {
    points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &point| {
        let point = pose.transform_point(point);
        (low.min(point), high.max(point))
    })
}

fn reach_of_points(points: &[DVec3], origin: DVec3) -> f64 {
    points.iter().map(|point| point.distance_squared(origin)).fold(0.0, f64::max).sqrt()
}
