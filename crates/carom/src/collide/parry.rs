//! Every pair that has no kernel of its own: hulls, meshes, height fields, tapered capsules, cylinders and cones, with
//! anything.
//!
//! A convex shape is a *core* and a radius around it (`convex.rs`). parry, in double precision, finds the direction of
//! least gap between two cores: GJK where they are apart, EPA where they overlap (`axis.rs`). The gap along that
//! direction is then taken from the cores' support points, so it never exceeds the true distance, whatever parry's
//! tolerance. Contact points come from clipping the two flat sides that face each other (`clip.rs`), or it is one point where
//! the two come closest (`witness.rs`). A mesh or a height field is a set of triangles (`triangles.rs`), each a core of its own
//! (`surface.rs`); balls, capsules, cuboids and hulls have kernels of their own beside a triangle (`facet.rs`). A plane needs
//! nothing but support points.

mod axis;
mod clip;
mod convex;
mod facet;
mod sides;
mod surface;
mod triangles;
mod witness;

use crate::collide::{ContactPoint, Manifold};
use crate::math::{DVec3, Pose};
use crate::report::Feature;
use crate::shape::Shape;
use axis::Axis;
use clip::Candidates;
use convex::{Convex, Core};
use facet::Form;
pub(crate) use sides::{Wanted, lies_beyond_a_side};
use triangles::Triangles;

/// A shape as this seam sees it.
enum Kind<'a> {
    Convex(Convex<'a>),
    Surface(Triangles<'a>),
    Plane,
}

impl<'a> Kind<'a> {
    fn of(shape: &'a Shape) -> Self {
        match (Convex::of(shape), Triangles::of(shape)) {
            (Some(convex), _) => Kind::Convex(convex),
            (None, Some(surface)) => Kind::Surface(surface),
            (None, None) => Kind::Plane,
        }
    }
}

/// As [`crate::collide::separation`]; continuous, and never more than the true distance.
///
/// From a mesh or a height field it is cut off at a quarter of the other shape's extent or the gap between the boxes
/// around them, whichever is larger. Two planes, and what has no finite pose, are infinitely far apart.
pub(crate) fn separation(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> f64 {
    if !is_finite(pose_a) || !is_finite(pose_b) {
        return f64::INFINITY;
    }
    match (Kind::of(a), Kind::of(b)) {
        (Kind::Convex(a), Kind::Convex(b)) => {
            axis::least_gap(&a.core, &b.core, &pose_a.relative(pose_b)).gap - a.radius - b.radius
        }
        (Kind::Plane, Kind::Convex(b)) => plane_separation(pose_a, &b, pose_b),
        (Kind::Convex(a), Kind::Plane) => plane_separation(pose_b, &a, pose_a),
        (Kind::Plane, Kind::Surface(surface)) => surface::plane_separation(pose_a, surface, pose_b),
        (Kind::Surface(surface), Kind::Plane) => surface::plane_separation(pose_b, surface, pose_a),
        (Kind::Surface(surface), _) => surface::separation(surface, pose_a, b, pose_b),
        (_, Kind::Surface(surface)) => surface::separation(surface, pose_b, a, pose_a),
        (Kind::Plane, Kind::Plane) => f64::INFINITY,
    }
}

/// As [`crate::collide::manifolds`]; one for each triangle of a surface that is struck.
pub(crate) fn manifolds(a: (&Shape, &Pose), b: (&Shape, &Pose), margin: f64, out: &mut Vec<Manifold>) {
    if !is_finite(a.1) || !is_finite(b.1) {
        return;
    }
    let first = out.len();
    let (kind_a, kind_b) = (Kind::of(a.0), Kind::of(b.0));
    // The functions below put the plane or the surface first.
    let mut turned = false;
    match (&kind_a, &kind_b) {
        (Kind::Convex(convex_a), Kind::Convex(convex_b)) => {
            let beside = Beside { convex: convex_b, inner: a.1.relative(b.1), form: None };
            let least = beside.gap_within(&convex_a.core, convex_a.radius, margin);
            out.extend(least.and_then(|least| {
                Candidates::with(margin, |candidates| {
                    convex_manifold((convex_a, a.1), &beside, least, (candidates, None))
                })
            }));
        }
        (Kind::Plane, Kind::Convex(convex)) => out.extend(plane_manifold(a.1, convex, b.1, margin)),
        (Kind::Plane, Kind::Surface(surface)) => {
            out.extend(surface::plane_manifold(a.1, *surface, b.1, margin))
        }
        (Kind::Surface(surface), Kind::Convex(_) | Kind::Surface(_)) => {
            surface::manifolds(*surface, a.1, b, margin, out);
        }
        (Kind::Plane, Kind::Plane) => {}
        (Kind::Convex(convex), Kind::Plane) => {
            turned = true;
            out.extend(plane_manifold(b.1, convex, a.1, margin));
        }
        (Kind::Surface(surface), Kind::Plane) => {
            turned = true;
            out.extend(surface::plane_manifold(b.1, *surface, a.1, margin));
        }
        (Kind::Convex(_), Kind::Surface(surface)) => {
            turned = true;
            surface::manifolds(*surface, b.1, a, margin, out);
        }
    }
    if turned {
        out[first..].iter_mut().for_each(|manifold| *manifold = swapped(manifold));
    }
}

fn is_finite(pose: &Pose) -> bool {
    pose.position.is_finite() && pose.rotation.is_finite()
}

fn swapped(manifold: &Manifold) -> Manifold {
    let mut swapped = Manifold::new(-manifold.normal);
    for point in manifold.points() {
        let (feature_a, feature_b) = (point.feature_b, point.feature_a);
        swapped.push(ContactPoint { feature_a, feature_b, ..*point });
    }
    swapped
}

/// What a surface adds to the question where one of its triangles touches.
struct OnSurface<'a> {
    /// The normal that the surface allows, in the triangle's frame, in place of the one that the two shapes alone
    /// would give. Where it is another, only points where the two sides face each other along it count.
    normal: DVec3,
    /// At right angles to the triangle, in its frame.
    own: DVec3,
    /// What other triangles of the surface have given already: a point on a shared side is not given twice.
    known: &'a [Manifold],
}

/// A convex shape in the frame of another one.
struct Beside<'a> {
    convex: &'a Convex<'a>,
    /// Its pose there.
    inner: Pose,
    /// Of its core, where triangles have kernels of their own for it.
    form: Option<&'a Form<'a>>,
}

impl Beside<'_> {
    /// The axis of the largest gap to another core, if it and a radius around it come within `margin` of the shape.
    fn gap_within(&self, core: &Core, radius: f64, margin: f64) -> Option<Axis> {
        let radii = radius + self.convex.radius;
        let found = axis::gap_within(core, &self.convex.core, &self.inner, radii + margin)?;
        (found.gap - radii <= margin).then_some(found)
    }
}

/// Whether a direction (unit length) is another than one found with rounding.
fn is_another(one: DVec3, other: DVec3) -> bool {
    one.distance(other) > 1e-9
}

/// The manifold of two convex shapes, whose least gap is known, of the points within the margin of `candidates`, which offers
/// room.
fn convex_manifold(
    a: (&Convex, &Pose),
    beside: &Beside,
    mut least: Axis,
    (candidates, surface): (&mut Candidates, Option<&OnSurface>),
) -> Option<Manifold> {
    let (convex_a, convex_b, inner) = (a.0, beside.convex, &beside.inner);
    let radii = convex_a.radius + convex_b.radius;
    let normal = surface.map_or(least.normal, |surface| surface.normal);
    let corrected = is_another(normal, least.normal);
    least.normal = normal;
    candidates.clear();
    clip::contacts(convex_a, convex_b, inner, normal, candidates);
    let size = convex_a.core.reach().min(convex_b.core.reach()).max(radii);
    // A triangle seen edge-on does not tell on which side of it the other shape is, and what the surface allows may then lead all
    // through that shape. Such a way is none; another triangle has the contact.
    // Nor is one that leads sideways over a border: the normal is then no triangle's own.
    if corrected {
        let is_own = surface.is_some_and(|surface| surface.own.dot(normal).abs() > 1.0 - 1e-9);
        let detour = if is_own { 0.1 } else { 1e-3 };
        if candidates.least_separation() < least.gap - radii - detour * size {
            return None;
        }
    }
    if !corrected && candidates.least_separation() > least.gap - radii + 1e-6 * size {
        least = axis::on_crest(&convex_a.core, &convex_b.core, inner, least);
        candidates.push(witness::witness(convex_a, convex_b, inner, &least));
    }
    let normal = least.normal;
    let outer_normal = a.1.rotation * normal;
    for known in surface.map_or(&[][..], |surface| surface.known) {
        if known.normal.dot(outer_normal) > 0.9999 {
            for point in known.points() {
                candidates.remove_at(a.1.inverse_transform_point(point.point), 1e-6 * size);
            }
        }
    }
    let manifold = candidates.reduced(normal)?;
    let mut placed = Manifold::new(outer_normal);
    for point in manifold.points() {
        placed.push(ContactPoint { point: a.1.transform_point(point.point), ..*point });
    }
    Some(placed)
}

/// Height (m) of the lowest point of `convex` above the plane.
fn plane_separation(plane: &Pose, convex: &Convex, pose: &Pose) -> f64 {
    let up = plane.rotation * DVec3::Y;
    let lowest = convex.core.support(pose.rotation.conjugate() * -up);
    (pose.transform_point(lowest) - plane.position).dot(up) - convex.radius
}

/// The plane goes first: the normal is the plane's own.
fn plane_manifold(plane: &Pose, convex: &Convex, pose: &Pose, margin: f64) -> Option<Manifold> {
    let up = plane.rotation * DVec3::Y;
    let down = pose.rotation.conjugate() * -up;
    let lowest = plane_separation(plane, convex, pose);
    Candidates::with(margin, |candidates| {
        let add = |candidates: &mut Candidates, local: DVec3, feature_b: Feature| {
            let center = pose.transform_point(local);
            let height = (center - plane.position).dot(up);
            let separation = height - convex.radius;
            let point = center - up * (convex.radius + 0.5 * separation);
            candidates.push(ContactPoint { point, separation, feature_a: Feature::Surface, feature_b });
        };
        for corner in convex.core.outline(down).corners() {
            add(candidates, corner.point, corner.vertex);
        }
        if candidates.least_separation() > lowest + 1e-6 * convex.core.reach() {
            let center = pose.transform_point(convex.core.support(down));
            let point = center - up * (convex.radius + 0.5 * lowest);
            let (feature_a, feature_b) = (Feature::Surface, Feature::Surface);
            candidates.push(ContactPoint { point, separation: lowest, feature_a, feature_b });
        }
        candidates.reduced(up)
    })
}

#[cfg(test)]
mod tests;
