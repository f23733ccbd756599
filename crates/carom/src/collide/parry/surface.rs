//! Meshes and height fields: every triangle near the other shape is a convex core of its own.

mod normal;

use super::axis::Axis;
use super::clip::Candidates;
use super::convex::{Convex, Core};
use super::facet::{Facet, Form};
use super::triangles::Triangles;
use super::{Beside, OnSurface, axis, convex_manifold, is_another};
use crate::collide::{ContactPoint, Manifold};
use crate::math::{DVec3, Pose};
use crate::report::Feature;
use crate::shape::Shape;
use normal::surface_normal;

pub(super) fn triangle_core(surface: Triangles, index: u32) -> Convex<'static> {
    let (corners, vertices) = (surface.corners(index), surface.corner_numbers(index));
    Convex { core: Core::Triangle { corners, index, vertices }, radius: 0.0 }
}

/// The triangles whose boxes come within `margin` of the box from `low` to `high` (the surface's frame), by number.
fn nearby(surface: Triangles, low: DVec3, high: DVec3, margin: f64) -> Vec<u32> {
    let grown = DVec3::splat(margin.max(0.0));
    surface.within(low - grown, high + grown)
}

/// A triangle of a surface.
struct Tile<'a> {
    surface: Triangles<'a>,
    index: u32,
    /// None where it has no normal.
    facet: Option<Facet>,
}

impl<'a> Tile<'a> {
    fn new(surface: Triangles<'a>, index: u32) -> Self {
        Self { surface, index, facet: surface.facet(index) }
    }
}

/// A gap (m) between a triangle and a convex shape that their distance is no less than: the widest along a few
/// directions, at the price of a few support points; one beyond `limit` will do.
fn gap_at_least(tile: &Tile, beside: &Beside, limit: f64) -> f64 {
    let Some(facet) = &tile.facet else { return f64::NEG_INFINITY };
    let gap = match beside.form {
        Some(form) => facet.gap_at_least(form, limit + beside.convex.radius),
        None => {
            let triangle = triangle_core(tile.surface, tile.index);
            let middle = beside.inner.transform_point(beside.convex.core.middle());
            let gap = |way: DVec3| axis::along(&triangle.core, &beside.convex.core, &beside.inner, way).gap;
            facet.ways_to(middle).into_iter().flatten().map(gap).fold(f64::NEG_INFINITY, f64::max)
        }
    };
    gap - beside.convex.radius
}

/// The axis of the largest gap between a triangle and the core of a convex shape, if that shape comes within `margin`.
fn gap_within(tile: &Tile, beside: &Beside, margin: f64) -> Option<Axis> {
    let radius = beside.convex.radius;
    match beside.form.zip(tile.facet.as_ref()) {
        Some((form, facet)) => {
            facet.gap_within(form, radius + margin).filter(|axis| axis.gap - radius <= margin)
        }
        None => {
            // Rounding must not turn away what is just near enough.
            let slack = 1e-9 * (beside.convex.core.reach() + radius);
            let is_far = margin < f64::MAX && gap_at_least(tile, beside, margin + slack) > margin + slack;
            let found = || beside.gap_within(&triangle_core(tile.surface, tile.index).core, 0.0, margin);
            if is_far { None } else { found() }
        }
    }
}

/// Whether no point of a convex shape is over or under a triangle, seen along `normal`, as far as that is told at the price of a few
/// support points.
fn is_beside(tile: &Tile, beside: &Beside, normal: DVec3) -> bool {
    beside.form.zip(tile.facet.as_ref()).is_some_and(|(form, facet)| facet.is_beside(form, normal))
}

/// The least separation of any triangle from `other`, which is no plane.
pub(super) fn separation(surface: Triangles, pose: &Pose, other: &Shape, other_pose: &Pose) -> f64 {
    let inner = pose.relative(other_pose);
    let (low, high) = other.bounds(&inner);
    let (surface_low, surface_high) = surface.bounds();
    let boxes_apart = (surface_low - high).max(low - surface_high).max(DVec3::ZERO).length();
    let extent = (high - low).max_element();
    // What is not found by a search is farther off than its horizon. Mostly the other is close, and a short look will do.
    let mut farthest = boxes_apart;
    for horizon in [extent / 32.0, extent / 4.0] {
        if boxes_apart >= horizon {
            continue;
        }
        farthest = separation_within((surface, pose), (other, other_pose), (low, high), horizon);
        if farthest < horizon {
            break;
        }
    }
    farthest
}

/// The least separation of the triangles of `surface` from `other`, which lies between `low` and `high` in the surface's
/// frame, if it is below `horizon` (m); else that.
fn separation_within(
    (surface, pose): (Triangles, &Pose),
    (other, other_pose): (&Shape, &Pose),
    (low, high): (DVec3, DVec3),
    horizon: f64,
) -> f64 {
    let near = nearby(surface, low, high, horizon);
    let inner = pose.relative(other_pose);
    match (Convex::of(other), Triangles::of(other)) {
        (Some(convex), _) => Form::with(&convex.core, &inner, |form| {
            least_separation(surface, near, &Beside { convex: &convex, inner, form }, horizon)
        }),
        (None, Some(other)) => {
            let turned = other_pose.relative(pose);
            near.into_iter().fold(horizon, |least, index| {
                let triangle = triangle_core(surface, index);
                let (low, high) = triangle_bounds(surface, index, &turned);
                let found = nearby(other, low, high, least.min(horizon));
                least_separation(
                    other,
                    found,
                    &Beside { convex: &triangle, inner: turned, form: None },
                    least,
                )
            })
        }
        (None, None) => horizon,
    }
}

/// The least separation of the triangles `near` from a convex shape, if it is below `least`. What is sure to be no
/// closer than something else is not measured: likely ones go first.
fn least_separation(surface: Triangles, near: Vec<u32>, beside: &Beside, least: f64) -> f64 {
    // Of those that overlap the shortest way out is known only once it is measured.
    let limit = least.max(0.0);
    let bound = |index: u32| gap_at_least(&Tile::new(surface, index), beside, limit);
    let mut queue: Vec<(f64, u32)> =
        near.into_iter().map(|index| (bound(index), index)).filter(|&(bound, _)| bound <= limit).collect();
    queue.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
    let (mut least, radius) = (least, beside.convex.radius);
    for (bound, index) in queue {
        if bound > least.max(0.0) {
            break;
        }
        if let Some(axis) = gap_within(&Tile::new(surface, index), beside, least.max(0.0)) {
            least = least.min(axis.gap - radius);
        }
    }
    least
}

/// One manifold for each triangle that is struck; the surface goes first.
pub(super) fn manifolds(
    surface: Triangles,
    pose: &Pose,
    other: (&Shape, &Pose),
    margin: f64,
    out: &mut Vec<Manifold>,
) {
    let (low, high) = other.0.bounds(&pose.relative(other.1));
    let near = nearby(surface, low, high, margin);
    match (Convex::of(other.0), Triangles::of(other.0)) {
        (Some(convex), _) => {
            let inner = pose.relative(other.1);
            Form::with(&convex.core, &inner, |form| {
                let beside = Beside { convex: &convex, inner, form };
                Candidates::with(margin, |candidates| {
                    convex_manifolds((surface, pose), &beside, &near, candidates, out);
                });
            });
        }
        (None, Some(other_surface)) => {
            Candidates::with(margin, |candidates| {
                surface_manifolds((surface, pose), (other_surface, other.1), &near, candidates, out);
            });
        }
        (None, None) => {}
    }
}

/// The manifolds of the triangles `near` with a convex shape.
///
/// Where their corrections leave nothing of a touch (on a tip between ridges and valleys, or deep in a border), the triangle
/// that is deepest in has it along its own shortest way out.
fn convex_manifolds(
    (surface, pose): (Triangles, &Pose),
    beside: &Beside,
    near: &[u32],
    candidates: &mut Candidates,
    out: &mut Vec<Manifold>,
) {
    let first = out.len();
    let convex = beside.convex;
    let middle = beside.inner.transform_point(convex.core.middle());
    let mut touched: Option<(Axis, u32)> = None;
    let margin = candidates.margin();
    for &index in near {
        let tile = Tile::new(surface, index);
        let Some(axis) = gap_within(&tile, beside, margin) else { continue };
        if touched.is_none_or(|(least, _)| axis.gap < least.gap) {
            touched = Some((axis, index));
        }
        let normal = surface_normal(surface, index, axis.normal, middle);
        if is_another(normal, axis.normal) && is_beside(&tile, beside, normal) {
            continue;
        }
        let triangle = triangle_core(surface, index);
        let around = OnSurface { normal, own: surface.normal(index), known: &out[first..] };
        let found = convex_manifold((&triangle, pose), beside, axis, (candidates, Some(&around)));
        out.extend(found);
    }
    if out.len() > first {
        return;
    }
    if let Some((axis, deepest)) = touched {
        let triangle = triangle_core(surface, deepest);
        out.extend(convex_manifold((&triangle, pose), beside, axis, (candidates, None)));
    }
}

/// The manifolds of the triangles `near` with those of another surface, each by its own shortest way out.
fn surface_manifolds(
    (surface, pose): (Triangles, &Pose),
    (other, other_pose): (Triangles, &Pose),
    near: &[u32],
    candidates: &mut Candidates,
    out: &mut Vec<Manifold>,
) {
    let first = out.len();
    let turned = other_pose.relative(pose);
    let margin = candidates.margin();
    for &index in near {
        let triangle = triangle_core(surface, index);
        let (low, high) = triangle_bounds(surface, index, &turned);
        for other_index in nearby(other, low, high, margin) {
            let other_triangle = triangle_core(other, other_index);
            let own = surface.normal(index);
            let beside = Beside { convex: &other_triangle, inner: pose.relative(other_pose), form: None };
            let Some(axis) = beside.gap_within(&triangle.core, 0.0, margin) else { continue };
            let around = OnSurface { normal: axis.normal, own, known: &out[first..] };
            let found = convex_manifold((&triangle, pose), &beside, axis, (candidates, Some(&around)));
            out.extend(found);
        }
    }
}

fn triangle_bounds(surface: Triangles, index: u32, pose: &Pose) -> (DVec3, DVec3) {
    let corners = surface.corners(index).map(|corner| pose.transform_point(corner));
    (corners[0].min(corners[1]).min(corners[2]), corners[0].max(corners[1]).max(corners[2]))
}

/// Height (m) of the lowest corner above the plane.
pub(super) fn plane_separation(plane: &Pose, surface: Triangles, pose: &Pose) -> f64 {
    let up = plane.rotation * DVec3::Y;
    let mut lowest = f64::INFINITY;
    surface.visit_corners(|corner, _| {
        lowest = lowest.min((pose.transform_point(corner) - plane.position).dot(up));
    });
    lowest
}

/// The plane goes first: the normal is the plane's own.
pub(super) fn plane_manifold(plane: &Pose, surface: Triangles, pose: &Pose, margin: f64) -> Option<Manifold> {
    let up = plane.rotation * DVec3::Y;
    Candidates::with(margin, |candidates| {
        surface.visit_corners(|corner, vertex| {
            let corner = pose.transform_point(corner);
            let separation = (corner - plane.position).dot(up);
            let point = corner - up * (0.5 * separation);
            let (feature_a, feature_b) = (Feature::Surface, Feature::Vertex(vertex));
            candidates.push(ContactPoint { point, separation, feature_a, feature_b });
        });
        candidates.reduced(up)
    })
}
