//! Two colliders that are near each other.

mod facing;

use crate::bodies::{Bodies, ColliderRow};
use crate::collide::Gap;
use crate::impacts::time_of_impact::tolerance;
use crate::material::Surface;
use crate::solver::graph::ContactId;
use crate::step::broad_phase::ColliderPair;
use facing::Facing;

/// Two colliders whose boxes overlap.
pub(crate) struct Pair {
    pub colliders: ColliderPair,
    rows: [u32; 2],
    pub sensor: bool,
    /// Whether there is restitution.
    pub bounces: bool,
    /// Whether the pair rests: it has contacts then. The first one's [owner](crate::step::rest) knows the next.
    pub rests: bool,
    pub first_contact: ContactId,
    /// Whether these see to all of its points, so that nobody has to ask when one strikes; and whether that is no longer so, or should
    /// be from now on.
    pub is_pressed: bool,
    pub is_outdated: bool,
    /// A separation that the two had, plus how far their bodies had moved by then (m): they are at least this less
    /// their present [`Pair::path`] apart.
    clearance: f64,
    facing: Facing,
    /// Where [`Pairs`](super::Pairs) keeps what happens to it in this step; 0 as long as nothing does.
    pub(super) present: u32,
    pub(super) is_changed: bool,
    pub(super) is_watched: bool,
}

/// What happens to a pair in the present step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Present {
    /// Counts how often it was asked when it will touch.
    pub stamp: u32,
    /// From when until when it has been asked, s.
    pub asked_from: f64,
    pub asked_until: f64,
    /// Impacts so far.
    pub hits: u32,
    /// The fastest of them, m/s.
    pub fastest: f64,
    /// Whether it is a sensor and what has been in it.
    pub is_sensed: bool,
    /// How far apart they stay until the end of what they have been asked about, and are then (m), as long as their bodies are
    /// on these courses.
    pub apart: [f64; 2],
    pub courses: [u32; 2],
    /// How long to look away after a touch that vanished under a closer look, as a share of the step.
    pub patience: f64,
}

impl Present {
    pub(super) const NOTHING: Present = Present {
        stamp: 0,
        asked_from: 0.0,
        asked_until: -1.0,
        hits: 0,
        fastest: 0.0,
        is_sensed: false,
        apart: [f64::NEG_INFINITY; 2],
        courses: [0; 2],
        patience: 1e-9,
    };

    /// How far apart the two of `pair` stay, and will be at the end, as far as they have been asked, m.
    fn foreseen(&self, bodies: &Bodies, pair: &Pair) -> Option<[f64; 2]> {
        let holds =
            self.apart[0] > f64::NEG_INFINITY && self.courses == pair.rows().map(|row| bodies.courses[row]);
        holds.then_some(self.apart)
    }
}

impl Pair {
    pub(super) fn new(bodies: &Bodies, colliders: ColliderPair) -> Option<Self> {
        let (a, b) = (bodies.collider(colliders.0)?, bodies.collider(colliders.1)?);
        let surface = Surface::between(&a.material, &b.material);
        Some(Self {
            colliders,
            rows: [a.row, b.row].map(|row| row as u32),
            sensor: a.sensor || b.sensor,
            bounces: surface.restitution > 0.0,
            rests: false,
            first_contact: ContactId::NONE,
            is_pressed: false,
            is_outdated: false,
            clearance: clearance_of_centers(bodies, a, b),
            facing: Facing::UNKNOWN,
            present: 0,
            is_changed: false,
            is_watched: false,
        })
    }

    /// Whether it is one of these two.
    pub(super) fn has(&self, collider: u32) -> bool {
        self.colliders.0 == collider || self.colliders.1 == collider
    }

    /// The rows of its bodies.
    #[inline]
    pub fn rows(&self) -> [usize; 2] {
        self.rows.map(|row| row as usize)
    }

    /// What turns, m: how far a turn by one radian can take a point of each collider.
    #[inline]
    pub fn spin_reaches(&self, bodies: &Bodies) -> [f64; 2] {
        [self.colliders.0, self.colliders.1].map(|key| bodies.outline(key).spin_reach)
    }

    /// Separation up to which the surfaces count as touching, m.
    #[inline]
    pub fn tolerance(&self, bodies: &Bodies) -> f64 {
        tolerance(bodies.outline(self.colliders.0), bodies.outline(self.colliders.1))
    }

    /// The slots of its bodies.
    pub fn slots(&self, bodies: &Bodies) -> [u32; 2] {
        let (a, b) = self.colliders;
        [a, b].map(|key| bodies.collider(key).map_or(0, |collider| collider.slot))
    }

    /// What the materials of its colliders make together.
    pub fn surface(&self, bodies: &Bodies) -> Surface {
        let material = |key: u32| bodies.collider(key).map(|it| it.material).unwrap_or_default();
        Surface::between(&material(self.colliders.0), &material(self.colliders.1))
    }

    /// The body of row `last` has got another row.
    pub(super) fn move_row(&mut self, last: usize, row: usize) {
        self.rows.iter_mut().filter(|it| **it as usize == last).for_each(|it| *it = row as u32);
    }

    /// Forgets what has happened to it in the step before.
    pub(super) fn begin_step(&mut self) {
        self.present = 0;
        self.is_changed = false;
    }

    /// How far the two bodies' points have moved until `time` within the step, m, since a time of no matter.
    #[inline]
    fn path(&self, bodies: &Bodies, time: f64) -> f64 {
        let spin_reaches = self.spin_reaches(bodies);
        let of = |side: usize| {
            let (linear, angular) = bodies.way(self.rows[side] as usize, time);
            linear + angular * spin_reaches[side]
        };
        of(0) + of(1)
    }

    /// A lower bound of the separation at `time`, m, given what happens to it now.
    #[inline]
    pub(super) fn least_separation(&self, bodies: &Bodies, now: &Present, time: f64) -> f64 {
        match now.foreseen(bodies, self) {
            Some([least, _]) if time <= now.asked_until => least,
            _ => self.clearance - self.path(bodies, time),
        }
    }

    /// The same at one time within the step, and from then until another, while the bodies keep to their paths. It takes more to tell, and
    /// tells more: what moves along with the other body, or past it, comes no nearer.
    pub fn least_facing(&self, bodies: &Bodies, span: (f64, f64)) -> [f64; 2] {
        self.facing.least(self, bodies, span)
    }

    /// Ends a step of `time` seconds, with all bodies on their last courses.
    pub(super) fn end_step(&mut self, bodies: &Bodies, now: &Present, time: f64) {
        if now.asked_until == time
            && let Some([_, end]) = now.foreseen(bodies, self)
        {
            self.measured(bodies, end, time);
        }
    }

    /// Whether the two could come within `margin` of each other, or touch, before their bodies' ways exceed `limits`
    /// (m, rad).
    #[inline]
    fn could_meet(&self, bodies: &Bodies, limits: [(f64, f64); 2], margin: f64) -> bool {
        let spin_reaches = self.spin_reaches(bodies);
        let path = |side: usize| limits[side].0 + limits[side].1 * spin_reaches[side];
        let left = self.clearance - (path(0) + path(1));
        left <= margin.max(self.tolerance(bodies)) || left.is_nan()
    }

    /// Whether somebody has to look at it in every substep, while its bodies' ways are within their `limits`.
    pub(super) fn needs_watching(&self, bodies: &Bodies, limits: [(f64, f64); 2], margin: f64) -> bool {
        if self.rests { !self.is_pressed } else { self.could_meet(bodies, limits, margin) }
    }

    /// A lower bound of the separation until `time`, m, if the two have this gap at an earlier time.
    pub fn least_after(&self, bodies: &Bodies, (gap, earlier): (Gap, f64), time: f64) -> f64 {
        let [_, facing] = Facing::of(self, bodies, (gap, earlier)).least(self, bodies, (earlier, time));
        facing.max(gap.separation + self.path(bodies, earlier) - self.path(bodies, time))
    }

    /// The two are `separation` apart at `time`.
    pub fn measured(&mut self, bodies: &Bodies, separation: f64, time: f64) {
        self.clearance = separation + self.path(bodies, time);
    }

    /// The same, with the direction if that is new.
    pub fn faced(&mut self, bodies: &Bodies, gap: Gap, time: f64) {
        self.measured(bodies, gap.separation, time);
        if gap.normal.is_some() {
            self.facing = Facing::of(self, bodies, (gap, time));
        }
    }
}

/// The clearance of two colliders that nobody has looked at: how far apart their bodies' centres are, less what reaches out from them.
fn clearance_of_centers(bodies: &Bodies, a: &ColliderRow, b: &ColliderRow) -> f64 {
    let way = |collider: &ColliderRow| {
        // Each body is at its own time.
        let (linear, angular) = bodies.ways[collider.row];
        linear + angular * collider.spin_reach
    };
    let distance = bodies.center_pose(a).position.distance(bodies.center_pose(b).position);
    let least = distance * (1.0 - ROUNDING) - (a.reach + b.reach) + (way(a) + way(b));
    if least.is_nan() { f64::NEG_INFINITY } else { least }
}

/// Relative, of a distance.
const ROUNDING: f64 = 1e-12;
