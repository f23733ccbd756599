//! Which of many points span their convex hull.
//!
//! Points in a common plane (most hulls that people draw) leave their hull's triangles to rounding, and a hull that
//! believes its rounding comes out dented. So every point is first moved a little, by a fixed pattern: then no four lie in
//! a plane, the signs are certain, and the triangles found are those of the true points to the size of that move.
//!
//! # Reference
//! Barber, Dobkin and Huhdanpaa, *The Quickhull Algorithm for Convex Hulls* (1996); section 4 compares with moved input.

use crate::math::DVec3;
use std::collections::BTreeMap;

/// The triangles of the hull, anticlockwise from outside, closed, with no point farther outside any of them than
/// `tolerance` (m). `None` if the points are flatter than about ten times that.
pub(super) fn quickhull(points: &[DVec3], tolerance: f64) -> Option<Vec<[usize; 3]>> {
    (1..=8).find_map(|seed| {
        let moved: Vec<DVec3> = points
            .iter()
            .enumerate()
            .map(|(index, &point)| point + noise(index as u64, seed) * (0.1 * tolerance))
            .collect();
        let triangles = Build::simplex(&moved, 10.0 * tolerance)?.grow()?;
        is_hull(points, &triangles, tolerance).then_some(triangles)
    })
}

/// Three numbers from −1 to 1 (Steele, Lea and Flood, *Fast Splittable Pseudorandom Number Generators*, 2014).
fn noise(index: u64, seed: u64) -> DVec3 {
    let number = |axis: u64| {
        let mut z = (index * 3 + axis + (seed << 40)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    DVec3::new(number(0), number(1), number(2))
}

fn is_hull(points: &[DVec3], triangles: &[[usize; 3]], tolerance: f64) -> bool {
    // Slivers have no direction of their own; their neighbours answer for them.
    let holds_all = |&[a, b, c]: &[usize; 3]| {
        let (a, b, c) = (points[a], points[b], points[c]);
        let across = (b - a).cross(c - a);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let normal = across.normalize_or_zero();
        across.length() <= 10.0 * tolerance * longest
            || points.iter().all(|&point| (point - a).dot(normal) <= tolerance)
    };
    triangles.len() >= 4 && triangles.iter().all(holds_all)
}

struct Facet {
    corners: [usize; 3],
    normal: DVec3,
    /// Points outside this facet that no other facet looks after.
    outside: Vec<usize>,
    alive: bool,
}

struct Build<'a> {
    points: &'a [DVec3],
    facets: Vec<Facet>,
    /// The facet on the left of each directed side.
    facet_at: BTreeMap<(usize, usize), usize>,
}

impl<'a> Build<'a> {
    /// Starts from four points far from each other; `None` if these are flatter than `thickness` (m).
    fn simplex(points: &'a [DVec3], thickness: f64) -> Option<Self> {
        let farthest = |from: &dyn Fn(DVec3) -> f64| {
            (0..points.len()).max_by(|&one, &other| from(points[one]).total_cmp(&from(points[other])))
        };
        let a = farthest(&|point| -point.x)?;
        let b = farthest(&|point| point.distance(points[a]))?;
        let along = (points[b] - points[a]).normalize_or_zero();
        let off_line = |point: DVec3| (point - points[a]).cross(along).length();
        let c = farthest(&off_line)?;
        // Off a line by rounding only, no plane can be told.
        if !(off_line(points[c]) > thickness) {
            return None;
        }
        let normal = along.cross(points[c] - points[a]).normalize_or_zero();
        let height = |point: DVec3| (point - points[a]).dot(normal);
        let d = farthest(&|point| height(point).abs())?;
        if !(height(points[d]).abs() > thickness) {
            return None;
        }
        let (b, c) = if height(points[d]) > 0.0 { (c, b) } else { (b, c) };
        let mut build = Self { points, facets: Vec::new(), facet_at: BTreeMap::new() };
        for corners in [[a, b, c], [a, d, b], [b, d, c], [c, d, a]] {
            build.add(corners);
        }
        build.share_out((0..points.len()).filter(|point| ![a, b, c, d].contains(point)).collect(), 0);
        Some(build)
    }

    fn add(&mut self, corners: [usize; 3]) {
        let [a, b, c] = corners.map(|corner| self.points[corner]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for side in 0..3 {
            self.facet_at.insert((corners[side], corners[(side + 1) % 3]), self.facets.len());
        }
        self.facets.push(Facet { corners, normal, outside: Vec::new(), alive: true });
    }

    fn height(&self, facet: usize, point: usize) -> f64 {
        let facet = &self.facets[facet];
        (self.points[point] - self.points[facet.corners[0]]).dot(facet.normal)
    }

    /// Gives each of `orphans` to the facet, from `first` on, that it stands highest above. One that stands above none
    /// lies inside.
    fn share_out(&mut self, orphans: Vec<usize>, first: usize) {
        for point in orphans {
            let highest = (first..self.facets.len())
                .map(|facet| (self.height(facet, point), facet))
                .filter(|&(height, _)| height > 0.0)
                .max_by(|one, other| one.0.total_cmp(&other.0));
            if let Some((_, facet)) = highest {
                self.facets[facet].outside.push(point);
            }
        }
    }

    /// Takes in the farthest point of one facet after the other until nothing is outside. `None` if the surface tears.
    fn grow(mut self) -> Option<Vec<[usize; 3]>> {
        let mut facet = 0;
        while facet < self.facets.len() {
            let outside = &self.facets[facet].outside;
            let height = |point: &usize| self.height(facet, *point);
            let apex = outside.iter().copied().max_by(|one, other| height(one).total_cmp(&height(other)));
            match apex {
                Some(apex) if self.facets[facet].alive => self.take_in(facet, apex)?,
                _ => facet += 1,
            }
        }
        let alive = self.facets.iter().filter(|facet| facet.alive);
        Some(alive.map(|facet| facet.corners).collect())
    }

    /// Replaces all facets that `apex` sees, starting from `seen`, by a cone from `apex` to their border.
    fn take_in(&mut self, seen: usize, apex: usize) -> Option<()> {
        let mut visible = vec![seen];
        let mut border = Vec::new();
        self.facets[seen].alive = false;
        let mut next = 0;
        while next < visible.len() {
            let corners = self.facets[visible[next]].corners;
            next += 1;
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let beyond = *self.facet_at.get(&(to, from))?;
                if !self.facets[beyond].alive {
                    continue;
                }
                if self.height(beyond, apex) > 0.0 {
                    self.facets[beyond].alive = false;
                    visible.push(beyond);
                } else {
                    border.push((from, to));
                }
            }
        }
        let mut orphans = Vec::new();
        for facet in visible {
            orphans.append(&mut self.facets[facet].outside);
            let corners = self.facets[facet].corners;
            for side in 0..3 {
                self.facet_at.remove(&(corners[side], corners[(side + 1) % 3]));
            }
        }
        orphans.retain(|&point| point != apex);
        let first = self.facets.len();
        for (from, to) in border {
            // Were the border no simple loop, a side would come twice.
            if self.facet_at.contains_key(&(to, apex)) || self.facet_at.contains_key(&(apex, from)) {
                return None;
            }
            self.add([from, to, apex]);
        }
        self.share_out(orphans, first);
        Some(())
    }
}
