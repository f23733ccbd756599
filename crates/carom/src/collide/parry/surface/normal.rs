//! Which normals a surface allows.

use super::super::triangles::Triangles;
use crate::math::DVec3;

/// The normal that the surface allows a contact on this triangle: `normal`, the triangle's own, the neighbour's, or one
/// between them.
///
/// Over the side that a triangle shares with a neighbour, the shortest way out of the triangle may lead sideways, into
/// the neighbour: a box sliding over a floor of triangles would trip on their seams. Where the neighbour goes on flat
/// or rises, nothing of the normal may lead over that side; where it falls away, the neighbour's own normal is the
/// steepest. At a border all are true. All in the surface's frame; `middle` lies inside the other shape.
pub(super) fn surface_normal(surface: Triangles, index: u32, normal: DVec3, middle: DVec3) -> DVec3 {
    const FLAT: f64 = 1e-6;
    const ROUNDING: f64 = 1e-12;
    let corners = surface.corners(index);
    let anticlockwise = surface.normal(index);
    let above = normal.dot(anticlockwise);
    let above = if above.abs() > 1e-3 { above } else { (middle - corners[0]).dot(anticlockwise) };
    let own = if above < 0.0 { -anticlockwise } else { anticlockwise };
    let sideways = normal - own * normal.dot(own);
    if sideways.length() <= FLAT {
        return if sideways.length() <= ROUNDING { own } else { normal };
    }
    let neighbours = surface.neighbours(index);
    let (mut left, mut steepest) = (normal, None);
    for (side, outward, share) in sides_crossed(corners, anticlockwise, sideways) {
        let Some(neighbour) = neighbours[side].filter(|_| share > FLAT) else { continue };
        let (from, to) = (corners[side], corners[(side + 1) % 3]);
        let along = (to - from).normalize_or_zero();
        let beyond = surface.corners(neighbour).map(|corner| {
            let reach = corner - from;
            reach - along * reach.dot(along)
        });
        let longest =
            beyond.into_iter().max_by(|one, other| one.length_squared().total_cmp(&other.length_squared()));
        let onward = longest.unwrap_or(DVec3::ZERO).normalize_or_zero();
        if onward.dot(own) >= -FLAT {
            left -= outward * share;
            continue;
        }
        // The neighbour's normal on this side, on the far side of the ridge from our own.
        let across = along.cross(onward).normalize_or_zero();
        let theirs = if across.dot(outward) < 0.0 { -across } else { across };
        if steepest.is_none_or(|steepest: DVec3| steepest.dot(own) < theirs.dot(own)) {
            steepest = Some(theirs);
        }
    }
    if left != normal {
        let remains = left - own * left.dot(own);
        left = if remains.length() <= FLAT { own } else { left.normalize_or(own) };
    }
    steepest.filter(|steepest| left.dot(own) < steepest.dot(own)).unwrap_or(left)
}

/// The two sides of a triangle that meet at its corner farthest `sideways` (a vector in its plane), each with its outward
/// normal in the plane and with how much of that `sideways` takes: it is the sum of the two, and no share is negative.
fn sides_crossed(corners: [DVec3; 3], anticlockwise: DVec3, sideways: DVec3) -> [(usize, DVec3, f64); 2] {
    let height = |corner: usize| corners[corner].dot(sideways);
    let farthest = (1..3).fold(0, |best, corner| if height(corner) > height(best) { corner } else { best });
    let (before, after) = ((farthest + 2) % 3, farthest);
    let sides = [before, after].map(|side| {
        let along = (corners[(side + 1) % 3] - corners[side]).normalize_or_zero();
        (side, along, along.cross(anticlockwise))
    });
    // The other side's direction has no part in its own normal, so it tells the first one's share.
    let share = |one: usize, other: usize| {
        let ((side, _, outward), (_, along, _)) = (sides[one], sides[other]);
        let turn = outward.dot(along);
        (side, outward, if turn == 0.0 { 0.0 } else { sideways.dot(along) / turn })
    };
    [share(0, 1), share(1, 0)]
}
