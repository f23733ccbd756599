//! The inertia of a body that encloses no volume: an open mesh, a bounded plane.
//!
//! A file may give such a body a mass and nothing else. A surface without an inside is a sheet, so its mass is
//! spread evenly over it. With `s = a + b + c`, a triangle of area A has `∫ x xᵀ = A/12 (aaᵀ + bbᵀ + ccᵀ + ssᵀ)`.

use carom::mass::principal_axes;
use carom::math::{DMat3, DVec3};
use carom::{Body, Motion, PrincipalInertia, Shape};

/// Gives a dynamic body with a mass, but neither a volume nor moments, the inertia of its surfaces, and their centre
/// if it states none. Whether it did.
pub(super) fn spread(body: &mut Body) -> bool {
    let Some(mass) = body.mass.filter(|&mass| mass > 0.0) else { return false };
    if body.motion != Motion::Dynamic || body.inertia.is_some() || body.collider_mass().mass > 0.0 {
        return false;
    }
    let (mut area, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for collider in body.colliders.iter().filter(|collider| !collider.sensor) {
        let Shape::Mesh(mesh) = &collider.shape else { continue };
        for triangle in mesh.triangles() {
            let [a, b, c] = triangle.map(|i| collider.pose.transform_point(mesh.vertices()[i as usize]));
            let part = 0.5 * (b - a).cross(c - a).length();
            let sum = a + b + c;
            area += part;
            first += sum * (part / 3.0);
            second += (outer(a) + outer(b) + outer(c) + outer(sum)) * (part / 12.0);
        }
    }
    if area <= 0.0 {
        return false;
    }
    let center = first / area;
    let covariance = (second * (1.0 / area) - outer(center)) * mass;
    let trace = covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z;
    let (diagonal, orientation) = principal_axes(&(DMat3::from_diagonal(DVec3::splat(trace)) - covariance));
    body.center_of_mass.get_or_insert(center);
    body.inertia = Some(PrincipalInertia { diagonal, orientation });
    true
}

fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}
