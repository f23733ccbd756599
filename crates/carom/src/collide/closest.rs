//! The closest points of two convex shapes that are apart.
//!
//! The points `b − a` of all pairs of points make a convex shape too, the *difference*, and its point closest to the
//! origin is the shortest way from `a` to `b`. The search (GJK) keeps a simplex of one to three corners of the
//! difference, takes the simplex's point closest to the origin, looks how far the difference reaches beyond it towards the
//! origin, and lets that corner join. The reach is a certificate: along any direction the gap never exceeds the distance.
//! What is returned is always such a gap, measured on the shapes, whatever rounding did to the simplex.
//!
//! # Reference
//! Gilbert, Johnson and Keerthi, *A Fast Procedure for Computing the Distance Between Complex Objects in Three-Dimensional
//! Space* (1988). The regions of a triangle: Ericson, *Real-Time Collision Detection* (2005), 5.1.5.

use super::polytope::Farthest;
use crate::math::DVec3;

/// A corner of the difference, and the corners of `a` and `b` that it comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner {
    difference: DVec3,
    numbers: (u32, u32),
}

/// One to three corners, and the weights that make of them the point closest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex {
    corners: [Corner; 3],
    weights: [f64; 3],
    count: usize,
}

/// Where two shapes are closest, and how far apart they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// Unit vector from `a` to `b`.
    pub(crate) normal: DVec3,
    /// The gap along it, m, and never more than the shapes' distance: just that, but for rounding, where they are apart.
    pub(crate) gap: f64,
    /// Whether they are apart by more than rounding. Where they meet, the normal and the points are a guess.
    pub(crate) is_apart: bool,
    pub(crate) simplex: Simplex,
}

impl Closest {
    /// The closest points of these same shapes, `a`'s first.
    pub(crate) fn points(&self, a: &impl Farthest, b: &impl Farthest) -> (DVec3, DVec3) {
        let Simplex { corners, weights, count } = self.simplex;
        (0..count).fold((DVec3::ZERO, DVec3::ZERO), |(on_a, on_b), k| {
            let (number_a, number_b) = corners[k].numbers;
            (on_a + a.point(number_a) * weights[k], on_b + b.point(number_b) * weights[k])
        })
    }

    /// The numbers of the corners that span the closest features, as many of `a` as of `b`; some may come twice.
    pub(crate) fn corners(&self) -> ([u32; 3], [u32; 3], usize) {
        let numbers = self.simplex.corners.map(|corner| corner.numbers);
        (numbers.map(|pair| pair.0), numbers.map(|pair| pair.1), self.simplex.count)
    }
}

/// Where `a` and `b` are closest, if they are no farther apart than `limit` and have finite places. `towards` is a guess of
/// the direction from `a` to `b`; `size` is a length against which rounding is measured.
pub(crate) fn closest(
    (a, b): (&impl Farthest, &impl Farthest),
    towards: DVec3,
    size: f64,
    limit: f64,
) -> Option<Closest> {
    const ROUNDS: usize = 64;
    let support = |direction: DVec3| {
        let ((number_a, on_a), (number_b, on_b)) = (a.farthest(direction), b.farthest(-direction));
        Corner { difference: on_b - on_a, numbers: (number_a, number_b) }
    };
    let first = support(towards);
    let mut simplex = Simplex { corners: [first; 3], weights: [1.0, 0.0, 0.0], count: 1 };
    let mut offset = first.difference;
    let mut best = (f64::NEG_INFINITY, towards);
    for _ in 0..ROUNDS {
        let distance = offset.length();
        if !distance.is_finite() {
            return None;
        }
        if distance <= 1e-15 * size {
            break;
        }
        let normal = offset / distance;
        let next = support(normal);
        let gap = next.difference.dot(normal);
        if gap > best.0 {
            best = (gap, normal);
        }
        if gap > limit {
            return None;
        }
        let known = || simplex.corners[..simplex.count].iter().any(|corner| corner.numbers == next.numbers);
        if distance - gap <= 1e-15 * (size + distance) || known() {
            break;
        }
        let before = simplex;
        let Some(closer) = simplex.join(next) else {
            let (gap, normal) = best;
            return Some(Closest { normal, gap, is_apart: false, simplex });
        };
        if closer.length_squared() >= offset.length_squared() {
            simplex = before;
            break;
        }
        offset = closer;
    }
    let distance = offset.length();
    if distance - best.0 > 1e-15 * (size + distance) {
        let normal = simplex.normal(offset);
        let gap = support(normal).difference.dot(normal);
        if gap > best.0 {
            best = (gap, normal);
        }
    }
    let (gap, normal) = best;
    (gap <= limit).then_some(Closest { normal, gap, is_apart: gap > 1e-15 * size, simplex })
}

impl Simplex {
    /// The direction of `offset`, the simplex's point closest to the origin, from the simplex's own directions: rounding
    /// is small beside these, not beside an offset that almost vanishes.
    fn normal(&self, offset: DVec3) -> DVec3 {
        let [a, b, c] = self.corners.map(|corner| corner.difference);
        let along = b - a;
        let across = match self.count {
            2 => offset - along * (offset.dot(along) / along.length_squared()),
            3 => {
                let across = along.cross(c - a);
                let well_shaped =
                    across.length_squared() > 1e-16 * along.length_squared() * (c - a).length_squared();
                let sign = if across.dot(a) < 0.0 { -1.0 } else { 1.0 };
                if well_shaped { across * sign } else { offset }
            }
            _ => offset,
        };
        across.try_normalize().unwrap_or_else(|| offset.normalize_or(DVec3::X))
    }

    /// Makes it that of the fewest corners, of these and `next`, that holds the point of all four closest to the origin; tells that
    /// point. `None`, and nothing changes, if the origin is inside.
    fn join(&mut self, next: Corner) -> Option<DVec3> {
        let [a, b, c] = self.corners;
        let all = [next, a, b, c];
        let places = all.map(|corner| corner.difference);
        let part = match self.count {
            1 => segment(&places, [0, 1]),
            2 => triangle(&places, [0, 1, 2]),
            _ => tetrahedron(&places)?,
        };
        let corners = part.corners.map(|number| all[usize::from(number)]);
        *self = Self { corners, weights: part.weights, count: part.count };
        Some(part.closest)
    }
}

/// One to three of some corners, by number, with the weights that make of them the point closest to the origin.
#[derive(Clone, Copy)]
struct Part {
    corners: [u8; 3],
    weights: [f64; 3],
    count: usize,
    closest: DVec3,
}

impl Part {
    fn single(places: &[DVec3; 4], a: u8) -> Self {
        Self { corners: [a; 3], weights: [1.0, 0.0, 0.0], count: 1, closest: places[usize::from(a)] }
    }

    /// The one that comes closer to the origin; the first of equals.
    fn or_closer(best: Option<Self>, other: Self) -> Option<Self> {
        let is_better =
            best.is_none_or(|best| other.closest.length_squared() < best.closest.length_squared());
        if is_better { Some(other) } else { best }
    }
}

fn segment(places: &[DVec3; 4], [a, b]: [u8; 2]) -> Part {
    let [from, to] = [a, b].map(|number| places[usize::from(number)]);
    let along = to - from;
    let (reach, whole) = (-from.dot(along), along.length_squared());
    if reach <= 0.0 {
        return Part::single(places, a);
    } else if reach >= whole {
        return Part::single(places, b);
    }
    let share = reach / whole;
    let weights = [1.0 - share, share, 0.0];
    Part { corners: [a, b, b], weights, count: 2, closest: from + along * share }
}

fn triangle(places: &[DVec3; 4], corners: [u8; 3]) -> Part {
    let [a, b, c] = corners;
    let [pa, pb, pc] = corners.map(|number| places[usize::from(number)]);
    let normal = (pb - pa).cross(pc - pa);
    // Twice the area of the triangle that the origin's foot makes with each side, times twice the triangle's own.
    let areas = [pb.cross(pc).dot(normal), pc.cross(pa).dot(normal), pa.cross(pb).dot(normal)];
    let whole = normal.length_squared();
    let sliver = whole <= 1e-28 * (pb - pa).length_squared() * (pc - pa).length_squared();
    if !sliver && areas.iter().all(|&area| area > 0.0) {
        let sum = areas[0] + areas[1] + areas[2];
        let closest = normal * (pa.dot(normal) / whole);
        return Part { corners, weights: areas.map(|area| area / sum), count: 3, closest };
    }
    let mut best = None;
    for (area, side) in areas.into_iter().zip([[b, c], [c, a], [a, b]]) {
        if area <= 0.0 || sliver {
            best = Part::or_closer(best, segment(places, side));
        }
    }
    best.unwrap_or_else(|| Part::single(places, a))
}

fn tetrahedron(places: &[DVec3; 4]) -> Option<Part> {
    // The origin is not beyond the old side: the first corner lies farther towards it.
    let origin = places[0];
    let [a, b, c] = [1, 2, 3].map(|number: usize| places[number] - origin);
    let mut best = None;
    for (sides, [one, two, opposite]) in [([1, 2], [a, b, c]), ([2, 3], [b, c, a]), ([3, 1], [c, a, b])] {
        let normal = one.cross(two);
        let inner = opposite.dot(normal);
        let outer = -origin.dot(normal);
        // Where the four lie in a plane, each side may be the one.
        if inner * outer <= 0.0 || inner.abs() <= 1e-14 * (opposite.length() * normal.length()) {
            best = Part::or_closer(best, triangle(places, [0, sides[0], sides[1]]));
        }
    }
    best
}
