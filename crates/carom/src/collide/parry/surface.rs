//! Meshes: every triangle near the other shape is a convex core of its own.

use super::clip::Candidates;
use super::convex::{Convex, Core};
use super::{axis, convex_manifold};
use crate::collide::{ContactPoint, Manifold};
use crate::math::{DVec3, Pose};
use crate::mesh::Mesh;
use crate::report::Feature;
use crate::shape::Shape;
use parry3d_f64::bounding_volume::Aabb;

fn triangle_core(mesh: &Mesh, index: u32) -> Convex<'static> {
    let corners = mesh.corners(index);
    let vertices = mesh.triangles()[index as usize];
    Convex { core: Core::Triangle { corners, index, vertices }, radius: 0.0 }
}

fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a) != DVec3::ZERO
}

/// The triangles whose boxes come within `margin` of the box from `low` to `high` (mesh frame), by number.
fn nearby(mesh: &Mesh, low: DVec3, high: DVec3, margin: f64) -> Vec<u32> {
    let grown = DVec3::splat(margin.max(0.0));
    let search = Aabb::new(low - grown, high + grown);
    let mut found: Vec<u32> = mesh
        .tree()
        .intersect_aabb(&search)
        .filter(|&index| (index as usize) < mesh.triangles().len() && has_area(mesh.corners(index)))
        .collect();
    found.sort_unstable();
    found
}

/// The least separation of any triangle from `other`, which is no plane.
pub(super) fn separation(mesh: &Mesh, pose: &Pose, other: &Shape, other_pose: &Pose) -> f64 {
    let inner = pose.relative(other_pose);
    let (low, high) = other.bounds(&inner);
    let (mesh_low, mesh_high) = mesh.bounds();
    let boxes_apart = (mesh_low - high).max(low - mesh_high).max(DVec3::ZERO).length();
    // What is not found by the search is farther off than this.
    let horizon = (0.25 * (high - low).max_element()).max(boxes_apart);
    let mut least = horizon;
    for index in nearby(mesh, low, high, horizon) {
        let triangle = triangle_core(mesh, index);
        let gap = match (Convex::of(other), other) {
            (Some(convex), _) => axis::least_gap(&triangle.core, &convex.core, &inner).gap - convex.radius,
            (None, Shape::Mesh(other)) => {
                let (low, high) = triangle_bounds(mesh, index, &other_pose.relative(pose));
                nearby(other, low, high, horizon).into_iter().fold(horizon, |least, other_index| {
                    let other_triangle = triangle_core(other, other_index);
                    least.min(axis::least_gap(&triangle.core, &other_triangle.core, &inner).gap)
                })
            }
            (None, _) => f64::INFINITY,
        };
        least = least.min(gap);
    }
    least
}

/// One manifold for each triangle that is struck; the mesh goes first.
pub(super) fn manifolds(
    mesh: &Mesh,
    pose: &Pose,
    other: (&Shape, &Pose),
    margin: f64,
    out: &mut Vec<Manifold>,
) {
    let first = out.len();
    let inner = pose.relative(other.1);
    let (low, high) = other.0.bounds(&inner);
    for index in nearby(mesh, low, high, margin) {
        let triangle = triangle_core(mesh, index);
        match (Convex::of(other.0), other.0) {
            (Some(convex), _) => {
                let middle = inner.transform_point(convex.core.middle());
                let correct = |normal: DVec3| surface_normal(mesh, index, normal, middle);
                let found = convex_manifold((&triangle, pose), (&convex, other.1), margin, Some(&correct));
                add_new_points(found, first, low.distance(high), out);
            }
            (None, Shape::Mesh(other_mesh)) => {
                let (low, high) = triangle_bounds(mesh, index, &other.1.relative(pose));
                for other_index in nearby(other_mesh, low, high, margin) {
                    let other_triangle = triangle_core(other_mesh, other_index);
                    let found = convex_manifold((&triangle, pose), (&other_triangle, other.1), margin, None);
                    add_new_points(found, first, low.distance(high), out);
                }
            }
            (None, _) => {}
        }
    }
}

fn triangle_bounds(mesh: &Mesh, index: u32, pose: &Pose) -> (DVec3, DVec3) {
    let corners = mesh.corners(index).map(|corner| pose.transform_point(corner));
    (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]))
}

/// Appends `found` without the points that a neighbouring triangle has given already (on a side that both share).
fn add_new_points(found: Option<Manifold>, first: usize, size: f64, out: &mut Vec<Manifold>) {
    let Some(found) = found else { return };
    let mut fresh = Manifold::new(found.normal);
    for point in found.points() {
        let known = out[first..].iter().any(|earlier| {
            earlier.normal.dot(found.normal) > 0.9999
                && earlier.points().iter().any(|other| other.point.distance(point.point) <= 1e-6 * size)
        });
        if !known {
            fresh.push(*point);
        }
    }
    if !fresh.points().is_empty() {
        out.push(fresh);
    }
}

/// The normal that the surface allows a contact on this triangle: `normal`, the triangle's own, or the neighbour's.
///
/// Over the side that a triangle shares with a neighbour, the shortest way out of the triangle may lead sideways, into
/// the neighbour: a box sliding over a floor of triangles would trip on their seams. Where the neighbour goes on flat
/// or rises, only the triangle's own normal is true; where it falls away, normals between the two. At a border all are.
/// All in the mesh's frame; `middle` lies inside the other shape.
fn surface_normal(mesh: &Mesh, index: u32, normal: DVec3, middle: DVec3) -> DVec3 {
    const FLAT: f64 = 1e-6;
    let corners = mesh.corners(index);
    let anticlockwise = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
    let above = normal.dot(anticlockwise);
    let above = if above.abs() > 1e-3 { above } else { (middle - corners[0]).dot(anticlockwise) };
    let own = if above < 0.0 { -anticlockwise } else { anticlockwise };
    let sideways = normal - own * normal.dot(own);
    if sideways.length() <= FLAT {
        return normal;
    }
    let neighbours = mesh.neighbours(index);
    let mut allowed = normal;
    for side in 0..3 {
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let along = (to - from).normalize_or_zero();
        let outward = along.cross(anticlockwise);
        if sideways.dot(outward) <= FLAT {
            continue;
        }
        let Some(neighbour) = neighbours[side] else { continue };
        let beyond = mesh.corners(neighbour).map(|corner| {
            let reach = corner - from;
            reach - along * reach.dot(along)
        });
        let longest =
            beyond.into_iter().max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()));
        let onward = longest.unwrap_or(DVec3::ZERO).normalize_or_zero();
        if onward.dot(own) >= -FLAT {
            return own;
        }
        // The neighbour's normal on this side, on the far side of the ridge from our own.
        let across = along.cross(onward).normalize_or_zero();
        let theirs = if across.dot(outward) < 0.0 { -across } else { across };
        if allowed.dot(own) < theirs.dot(own) {
            allowed = theirs;
        }
    }
    allowed
}

/// Height (m) of the lowest corner above the plane.
pub(super) fn plane_separation(plane: &Pose, mesh: &Mesh, pose: &Pose) -> f64 {
    let up = plane.rotation * DVec3::Y;
    let height =
        |index: &u32| (pose.transform_point(mesh.vertices()[*index as usize]) - plane.position).dot(up);
    mesh.triangles().iter().flatten().map(height).fold(f64::INFINITY, f64::min)
}

/// The plane goes first: the normal is the plane's own.
pub(super) fn plane_manifold(plane: &Pose, mesh: &Mesh, pose: &Pose, margin: f64) -> Option<Manifold> {
    let up = plane.rotation * DVec3::Y;
    let mut candidates = Candidates::new(margin);
    for &vertex in mesh.triangles().iter().flatten() {
        let corner = pose.transform_point(mesh.vertices()[vertex as usize]);
        let separation = (corner - plane.position).dot(up);
        let point = corner - up * (0.5 * separation);
        let (feature_a, feature_b) = (Feature::Surface, Feature::Vertex(vertex));
        candidates.push(ContactPoint { point, separation, feature_a, feature_b });
    }
    candidates.reduced(up)
}
