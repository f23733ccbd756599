//! Mass, centre of mass and inertia: of shapes, of compounds, and as a body uses them.

use crate::math::{DMat3, DVec3, Pose};
use std::f64::consts::PI;

mod body_mass;
mod principal;

pub use body_mass::BodyMass;
pub use principal::principal_axes;

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
        let mass = density * 4.0 / 3.0 * PI * radius * radius * radius;
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

    /// The hull of two balls on the y axis, `height` apart (m): bottom ball at −height/2, top ball at +height/2.
    ///
    /// The cone that touches both balls does so in two circles across the axis. With `s = (r_b − r_t)/height` (the
    /// sine of the cone's half angle) they lie `r·s` above the balls' centres and have the radius `r·√(1 − s²)`.
    /// Below the lower circle the solid is a piece of the bottom ball, above the upper one a piece of the top
    /// ball, between them a frustum. Where one ball holds the other (`|s| ≥ 1`) it is that ball alone.
    pub fn tapered_capsule(height: f64, radius_bottom: f64, radius_top: f64, density: f64) -> Self {
        let half = 0.5 * height;
        if (radius_bottom - radius_top).abs() >= height {
            let (radius, y) =
                if radius_bottom > radius_top { (radius_bottom, -half) } else { (radius_top, half) };
            return Self::sphere(radius, density).moved_along_y(y);
        }
        let sine = (radius_bottom - radius_top) / height;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let (low, high) = (-half + radius_bottom * sine, half + radius_top * sine);
        let cone = Self::frustum(high - low, radius_bottom * cosine, radius_top * cosine, density);
        let bottom = DiscStack::ball_segment(radius_bottom, -radius_bottom, radius_bottom * sine);
        let top = DiscStack::ball_segment(radius_top, radius_top * sine, radius_top);
        Self::sum(
            [
                bottom.mass_properties(density).moved_along_y(-half),
                cone.moved_along_y(0.5 * (low + high)),
                top.mass_properties(density).moved_along_y(half),
            ]
            .into_iter(),
        )
    }

    /// The hull of two discs across the y axis, `height` apart (m): cylinder, cone, frustum. The centre of the height
    /// is the origin; the centre of mass lies off it, towards the wider end.
    pub fn frustum(height: f64, radius_bottom: f64, radius_top: f64, density: f64) -> Self {
        DiscStack::frustum(height, radius_bottom, radius_top)
            .mass_properties(density)
            .moved_along_y(-0.5 * height)
    }

    /// The inside of a closed surface of triangles, anticlockwise from outside.
    ///
    /// Turned inside out (all triangles clockwise) it weighs the same. A surface that is not closed weighs nothing:
    /// one on which some edge is not passed as often one way as the other, corners being the same where their
    /// coordinates are. So does one that encloses less than 10⁻¹² of the box around it.
    ///
    /// ```text
    /// V = Σ det(a, b, c)/6       ∫x dV = Σ V_t (a + b + c)/4       ∫x·xᵀ dV = Σ V_t/20 (a·aᵀ + b·bᵀ + c·cᵀ + s·sᵀ)
    /// ```
    ///
    /// over the tetrahedra from the middle of the box to each triangle `a, b, c`, with `s = a + b + c`.
    ///
    /// # Reference
    /// Mirtich, *Fast and Accurate Computation of Polyhedral Mass Properties* (1996), for the task; Blow and Binstock,
    /// *How to find the inertia tensor (or other mass properties) of a 3D solid body represented by a triangle mesh*
    /// (2004), for the sum over tetrahedra.
    pub fn polyhedron(vertices: &[DVec3], triangles: &[[u32; 3]], density: f64) -> Self {
        let corners = |triangle: &[u32; 3]| -> Option<[DVec3; 3]> {
            let corner = |index: u32| vertices.get(index as usize).copied();
            Some([corner(triangle[0])?, corner(triangle[1])?, corner(triangle[2])?])
        };
        let surface: Vec<[DVec3; 3]> = triangles.iter().filter_map(corners).collect();
        if surface.len() != triangles.len() || !is_closed(&surface) {
            return Self::NONE;
        }
        let points = || surface.iter().flatten();
        let low = points().fold(DVec3::INFINITY, |low, &point| low.min(point));
        let high = points().fold(DVec3::NEG_INFINITY, |high, &point| high.max(point));
        let middle = 0.5 * (low + high);

        let mut volume = 0.0;
        let mut first = DVec3::ZERO;
        let mut second = DMat3::ZERO;
        for &[a, b, c] in &surface {
            let (a, b, c) = (a - middle, b - middle, c - middle);
            let tetrahedron = a.dot(b.cross(c)) / 6.0;
            let sum = a + b + c;
            volume += tetrahedron;
            first += sum * (tetrahedron / 4.0);
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (tetrahedron / 20.0);
        }
        let size = high - low;
        if surface.is_empty() || volume.abs() <= 1e-12 * size.x * size.y * size.z {
            return Self::NONE;
        }
        let center = first / volume;
        let covariance = (second - outer(center) * volume) * volume.signum();
        let trace = covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z;
        let inertia = DMat3::from_diagonal(DVec3::splat(trace)) - covariance;
        Self { mass: density * volume.abs(), center: middle + center, inertia: inertia * density }
    }

    /// A thin sheet: `area_density` (kg/m²) spread evenly over triangles, whether they close or not.
    ///
    /// ```text
    /// A = Σ |(b − a) × (c − a)|/2       ∫x dA = Σ A_t (a + b + c)/3       ∫x·xᵀ dA = Σ A_t/12 (a·aᵀ + b·bᵀ + c·cᵀ + s·sᵀ)
    /// ```
    ///
    /// over the triangles `a, b, c`, with `s = a + b + c`; corners are taken from the middle of the first triangle. Without
    /// any area it is [`NONE`](Self::NONE).
    pub fn sheet(vertices: &[DVec3], triangles: &[[u32; 3]], area_density: f64) -> Self {
        let corner = |index: u32| vertices.get(index as usize).copied();
        let corners = |t: &[u32; 3]| Some([corner(t[0])?, corner(t[1])?, corner(t[2])?]);
        let surface: Vec<[DVec3; 3]> = triangles.iter().filter_map(corners).collect();
        let origin = surface.first().map_or(DVec3::ZERO, |[a, b, c]| (*a + *b + *c) / 3.0);
        let (mut area, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
        for corners in surface {
            let [a, b, c] = corners.map(|corner| corner - origin);
            let triangle = 0.5 * (b - a).cross(c - a).length();
            let sum = a + b + c;
            area += triangle;
            first += sum * (triangle / 3.0);
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (triangle / 12.0);
        }
        if area <= 0.0 {
            return Self::NONE;
        }
        let center = first / area;
        let covariance = second - outer(center) * area;
        let trace = covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z;
        let inertia = DMat3::from_diagonal(DVec3::splat(trace)) - covariance;
        Self { mass: area_density * area, center: origin + center, inertia: inertia * area_density }
    }

    /// The same mass seen from the frame that `pose` leads to: the centre moves, the inertia turns and stays the one
    /// about the centre of mass.
    pub fn transformed(&self, pose: &Pose) -> Self {
        let axes = DMat3::from_quat(pose.rotation);
        Self {
            mass: self.mass,
            center: pose.transform_point(self.center),
            inertia: axes * self.inertia * axes.transpose(),
        }
    }

    /// All of `parts` as one rigid body, all in one frame. What weighs nothing takes no part.
    ///
    /// Each part adds its own inertia and `m (d²·1 − d·dᵀ)` for the distance `d` of its centre from the common one
    /// (Huygens and Steiner).
    pub fn sum(parts: impl Iterator<Item = MassProperties>) -> Self {
        let parts: Vec<MassProperties> = parts.filter(|part| part.mass > 0.0).collect();
        let mass: f64 = parts.iter().map(|part| part.mass).sum();
        // A lone part is itself, to the last bit.
        if let [single] = parts[..] {
            return single;
        }
        if parts.is_empty() {
            return Self::NONE;
        }
        let center = parts.iter().map(|part| part.center * (part.mass / mass)).sum();
        let inertia =
            parts.iter().map(|part| part.inertia + point_inertia(part.mass, part.center - center)).sum();
        Self { mass, center, inertia }
    }

    /// The same distribution made denser or lighter: mass and inertia times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self { mass: self.mass * factor, center: self.center, inertia: self.inertia * factor }
    }

    fn moved_along_y(mut self, y: f64) -> Self {
        self.center.y += y;
        self
    }
}

/// The inertia about the origin of a point mass (kg) at `arm` (m).
fn point_inertia(mass: f64, arm: DVec3) -> DMat3 {
    (DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - outer(arm)) * mass
}

/// `v · vᵀ`.
fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// Whether each edge is passed as often one way as the other. Corners are the same where their coordinates are, so
/// that a surface whose faces don't share corners counts as what it looks like.
fn is_closed(surface: &[[DVec3; 3]]) -> bool {
    // Adding zero makes −0 and 0 the same bits.
    let key = |point: DVec3| (point + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut edges = Vec::with_capacity(3 * surface.len());
    for triangle in surface {
        for side in 0..3 {
            let (from, to) = (key(triangle[side]), key(triangle[(side + 1) % 3]));
            if from < to {
                edges.push((from, to, 1_i64));
            } else if to < from {
                edges.push((to, from, -1));
            }
        }
    }
    edges.sort_unstable();
    edges
        .chunk_by(|one, other| (one.0, one.1) == (other.0, other.1))
        .all(|same| same.iter().map(|edge| edge.2).sum::<i64>() == 0)
}

/// A solid of revolution about y as a stack of thin discs of radius `ρ(y)`: all integrals that its inertia is made of.
struct DiscStack {
    /// `∫ πρ² dy`, m³.
    volume: f64,
    /// `∫ πρ² y dy`, m⁴.
    first: f64,
    /// `∫ πρ² y² dy`, m⁵.
    second: f64,
    /// `∫ πρ⁴/4 dy`, m⁵: the discs' own inertia about a diameter; about the axis it is twice that.
    discs: f64,
}

impl DiscStack {
    /// From y = 0 to `height`, the radius going evenly from `bottom` to `top`.
    fn frustum(height: f64, bottom: f64, top: f64) -> Self {
        let (bb, bt, tt) = (bottom * bottom, bottom * top, top * top);
        Self {
            volume: PI * height / 3.0 * (bb + bt + tt),
            first: PI * height * height / 12.0 * (bb + 2.0 * bt + 3.0 * tt),
            second: PI * height * height * height / 30.0 * (bb + 3.0 * bt + 6.0 * tt),
            discs: PI * height / 20.0 * (bb * bb + bb * bt + bb * tt + bt * tt + tt * tt),
        }
    }

    /// The part of a ball around the origin between the heights `low` and `high`: `ρ² = r² − y²`.
    fn ball_segment(radius: f64, low: f64, high: f64) -> Self {
        let rr = radius * radius;
        let between = |integral: &dyn Fn(f64) -> f64| PI * (integral(high) - integral(low));
        Self {
            volume: between(&|y| y * (rr - y * y / 3.0)),
            first: between(&|y| y * y * (rr / 2.0 - y * y / 4.0)),
            second: between(&|y| y * y * y * (rr / 3.0 - y * y / 5.0)),
            discs: 0.25 * between(&|y| y * (rr * rr - y * y * (2.0 / 3.0 * rr - y * y / 5.0))),
        }
    }

    fn mass_properties(&self, density: f64) -> MassProperties {
        if self.volume <= 0.0 {
            return MassProperties::NONE;
        }
        let center = self.first / self.volume;
        let across = self.discs + (self.second - center * self.first).max(0.0);
        let diagonal = DVec3::new(across, 2.0 * self.discs, across);
        MassProperties {
            mass: density * self.volume,
            center: DVec3::new(0.0, center, 0.0),
            inertia: DMat3::from_diagonal(diagonal * density),
        }
    }
}

#[cfg(test)]
mod tests;
