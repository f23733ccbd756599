//! The search for the instant of a touch.
//!
//! Both bodies fly on known paths, so their separation is a function of time, continuous and with a known bound on its
//! rate. The search marches from one instant to the next that is safe (*conservative advancement*, Mirtich 1996, ch. 2) or
//! a small fraction of the thinner body further, whichever is later; a change of sign is then closed in on to rounding.

use super::root::root;
use super::{Approach, Kept};
use crate::bodies::{ColliderRow, WORLD_ROW};
use crate::collide::Gap;
use crate::fault;
use crate::flight::fly_center;
use crate::math::DVec3;
use crate::step::pairs::Pairs;

/// A pair's own part of the march: a step may go so far into the thinner body, as a fraction of its thickness.
const BITE: f64 = 0.02;

/// The two at an instant on their paths.
#[derive(Clone, Copy)]
struct Look {
    /// Within the step, s.
    time: f64,
    /// m
    separation: f64,
    /// A bound on how fast the surfaces approach from then on, m/s.
    limit: f64,
}

impl Look {
    /// Whether the surfaces cannot meet between this look and a later one.
    fn is_safe_until(&self, later: &Look) -> bool {
        (later.time - self.time) * self.limit <= self.separation
    }
}

/// How fast two colliders approach until some time.
struct Pace {
    /// Within the step, s.
    until: f64,
    /// A bound whichever way they face each other, and what of it is their bodies' turning, m/s.
    limit: f64,
    turning: f64,
    /// What a step of the march goes on at least, s.
    least: f64,
}

impl Approach<'_> {
    /// How fast the surfaces approach between `from` and `until`.
    fn pace(&self, from: f64, until: f64) -> Pace {
        let turning = |collider: &ColliderRow| {
            if collider.spin_reach == 0.0 || collider.row == WORLD_ROW {
                return 0.0;
            }
            let (state, row) = (&self.bodies.states[collider.row], collider.row);
            let whole = until - self.bodies.clocks[row];
            let spin = self.bodies.constants[row].spin_limit(state, &self.bodies.influences[row], whole);
            spin * collider.spin_reach
        };
        let turning = turning(self.a) + turning(self.b);
        let (velocity, acceleration, braking) = self.relative_motion(from, until);
        let limit = velocity.length()
            + (acceleration.length() + braking) * (until - from)
            + turning
            + f64::MIN_POSITIVE;
        Pace { until, limit, turning, least: BITE * self.thinner() / limit }
    }

    /// Velocity (m/s) and acceleration (m/s²) of the centre of mass of `b` against that of `a` at `time`, and at what rate (m/s²) damping
    /// changes the velocity at most until some time.
    fn relative_motion(&self, time: f64, until: f64) -> (DVec3, DVec3, f64) {
        let center = |collider: &ColliderRow| {
            let (state, row) = (&self.bodies.states[collider.row], collider.row);
            let (constants, influence) = (&self.bodies.constants[row], &self.bodies.influences[row]);
            let (_, velocity) = fly_center(state, constants, influence, time - self.bodies.clocks[row]);
            let fastest = velocity.length() + influence.acceleration.length() * (until - time);
            (velocity, influence.acceleration, constants.linear_damping * fastest)
        };
        let (velocity_a, acceleration_a, braking_a) = center(self.a);
        let (velocity_b, acceleration_b, braking_b) = center(self.b);
        (velocity_b - velocity_a, acceleration_b - acceleration_a, braking_a + braking_b)
    }

    fn look(&self, time: f64, pace: &Pace) -> Look {
        self.look_at(self.gap(time), time, pace)
    }

    /// The two with this gap at `time`. Convex shapes that are apart along a direction close along it no faster than their centres do
    /// and their bodies turn; what moves along with the other body, or past it, hardly does.
    fn look_at(&self, gap: Gap, time: f64, pace: &Pace) -> Look {
        let separation = gap.separation;
        let Some(normal) = gap.normal.filter(|_| separation > 0.0) else {
            return Look { time, separation, limit: pace.limit };
        };
        let (velocity, acceleration, braking) = self.relative_motion(time, pace.until);
        let faster = (braking - acceleration.dot(normal).min(0.0)) * (pace.until - time);
        let closing = faster + pace.turning - velocity.dot(normal);
        Look { time, separation, limit: closing.clamp(f64::MIN_POSITIVE, pace.limit) }
    }

    /// The first instant at which the two touch and close, after a time at which they had this gap, until another; for a pair that
    /// rests, close faster than the rest threshold where its contacts have not `kept` the point.
    pub fn next_touch(
        &self,
        pairs: &Pairs,
        gap: Gap,
        (from, until): (f64, f64),
        kept: Option<Kept>,
    ) -> Option<f64> {
        if fault::lost_collision((self.a.slot, self.b.slot)) {
            return None;
        }
        let pace = self.pace(from, until);
        let mut now = self.look_at(gap, from, &pace);
        let mut before: Option<Look> = None;
        loop {
            let touching = now.separation <= self.tolerance;
            if touching && self.touch(pairs, now.time, kept).is_some() {
                return Some(match before {
                    Some(earlier) => self.first_closing(pairs, (earlier.time, now.time), pace.limit, kept),
                    None => now.time,
                });
            }
            if self.stay_apart(&now, &pace, self.tolerance) {
                return None;
            }
            let next = self.march(&now, &pace);
            let crossing = if touching {
                None
            } else if next.separation <= 0.0 {
                Some(self.root(&now, &next))
            } else {
                before.and_then(|before| self.dip([&before, &now, &next], &pace))
            };
            if let Some(instant) = crossing
                && self.touch(pairs, instant, kept).is_some()
            {
                return Some(instant);
            }
            before = Some(now);
            now = next;
        }
    }

    /// The first instant at which the two touch or overlap, after a time at which they had this gap, until another.
    pub fn first_overlap(&self, gap: Gap, (from, until): (f64, f64)) -> Option<f64> {
        let pace = self.pace(from, until);
        let mut now = self.look_at(gap, from, &pace);
        let mut before: Option<Look> = None;
        loop {
            if now.separation <= 0.0 {
                return Some(before.map_or(now.time, |earlier| self.root(&earlier, &now)));
            }
            if self.stay_apart(&now, &pace, 0.0) {
                return None;
            }
            let next = self.march(&now, &pace);
            if next.separation > 0.0
                && let Some(instant) = before.and_then(|before| self.dip([&before, &now, &next], &pace))
            {
                return Some(instant);
            }
            before = Some(now);
            now = next;
        }
    }

    /// Whether nothing is left to look for: the two stay more than `tolerance` (m) apart, or the time is over.
    fn stay_apart(&self, now: &Look, pace: &Pace, tolerance: f64) -> bool {
        now.time >= pace.until || now.separation - now.limit * (pace.until - now.time) > tolerance
    }

    /// The next look: as far ahead as is safe, or a little further.
    fn march(&self, now: &Look, pace: &Pace) -> Look {
        let ahead = pace.least.max(now.separation / now.limit);
        self.look((now.time + ahead).min(pace.until), pace)
    }

    fn thinner(&self) -> f64 {
        let reach = self.a.reach.min(self.b.reach);
        let solid = |collider: &ColliderRow| {
            let thickness = collider.shape.thickness();
            if thickness > 0.0 { thickness } else { reach }
        };
        solid(self.a).min(solid(self.b)).min(2.0 * reach)
    }

    /// The instant between `apart` (separation above 0) and `over` (0 or below) at which the separation vanishes.
    fn root(&self, apart: &Look, over: &Look) -> f64 {
        let ends = [apart, over].map(|look| (look.time, look.separation));
        root(|time| self.separation(time), ends, 0.01 * self.tolerance)
    }

    /// Where the separation vanishes between three instants of which the middle one is lowest, if a step was longer than
    /// was safe and it does vanish: a graze.
    fn dip(&self, [before, now, after]: [&Look; 3], pace: &Pace) -> Option<f64> {
        if now.separation >= before.separation
            || now.separation > after.separation
            || (before.is_safe_until(now) && now.is_safe_until(after))
        {
            return None;
        }
        let (mut low, mut high) = (before.time, after.time);
        for _ in 0..24 {
            let third = 0.382 * (high - low);
            let (left, right) = (self.look(low + third, pace), self.look(high - third, pace));
            let lowest = if left.separation < right.separation { left } else { right };
            if lowest.separation <= 0.0 {
                return Some(self.root(if lowest.time > now.time { now } else { before }, &lowest));
            }
            if left.separation < right.separation { high = right.time } else { low = left.time }
        }
        None
    }

    /// The first instant after `open`, where nothing closes, at which something does, as at `closing`; as exact as
    /// separations are.
    ///
    /// Where a corner comes down beside what touches already, false position on its gap (as in [`Self::root`]); bisection where a point
    /// that touches comes to close: as long as nothing closes at `open`, nobody asks for the gap of what does at `closing`.
    fn first_closing(
        &self,
        pairs: &Pairs,
        (mut open, mut closing): (f64, f64),
        limit: f64,
        kept: Option<Kept>,
    ) -> f64 {
        let margin = (closing - open) * limit + self.tolerance;
        let gap = |time: f64| self.gap_of_closing(time, margin, kept);
        let mut open_gap = gap(open);
        let (mut closing_gap, mut weight) = (None, 1.0);
        for iteration in 0.. {
            if (closing - open) * limit <= self.tolerance {
                break;
            }
            let fraction = if iteration % 4 == 3 || !open_gap.is_finite() {
                0.5
            } else {
                let closing_gap = weight * *closing_gap.get_or_insert_with(|| gap(closing));
                if closing_gap < 0.0 { open_gap / (open_gap - closing_gap) } else { 0.5 }
            };
            let middle = open + fraction * (closing - open);
            if middle <= open || middle >= closing {
                break;
            }
            if self.touch(pairs, middle, kept).is_some() {
                (closing, closing_gap, weight) = (middle, None, 1.0);
                if open_gap.is_finite() && closing_gap.insert(gap(middle)).abs() <= self.tolerance {
                    break;
                }
                open_gap *= 0.5;
            } else {
                (open, open_gap) = (middle, gap(middle));
                weight *= 0.5;
            }
        }
        closing
    }
}

#[cfg(test)]
mod tests;
