//! The search for the instant of a touch.
//!
//! Both bodies fly on known paths, so their separation is a function of time, continuous and with a known bound on its
//! rate. The search marches from one instant to the next that is safe (*conservative advancement*, Mirtich 1996, ch. 2) or
//! a small fraction of the thinner body further, whichever is later; a change of sign is then closed in on to rounding.

use super::{Approach, Kept};
use crate::bodies::{ColliderRow, WORLD_ROW};
use crate::fault;
use crate::flight::fly_center;
use crate::step::pairs::Pairs;

/// A pair's own part of the march: a step may go so far into the thinner body, as a fraction of its thickness.
const BITE: f64 = 0.02;

impl Approach<'_> {
    /// A bound on how fast the surfaces approach between `from` and `until`, m/s.
    fn speed_limit(&self, from: f64, until: f64) -> f64 {
        let time = until - from;
        let center = |collider: &ColliderRow| {
            let (state, row) = (&self.bodies.states[collider.row], collider.row);
            let (constants, influence) = (&self.bodies.constants[row], &self.bodies.influences[row]);
            let (_, velocity) = fly_center(state, constants, influence, from - self.bodies.clocks[row]);
            (velocity, influence.acceleration, constants.linear_damping * velocity.length())
        };
        let turning = |collider: &ColliderRow| {
            if collider.spin_reach == 0.0 || collider.row == WORLD_ROW {
                return 0.0;
            }
            let (state, row) = (&self.bodies.states[collider.row], collider.row);
            let whole = until - self.bodies.clocks[row];
            let spin = self.bodies.constants[row].spin_limit(state, &self.bodies.influences[row], whole);
            spin * collider.spin_reach
        };
        let (velocity_a, acceleration_a, braking_a) = center(self.a);
        let (velocity_b, acceleration_b, braking_b) = center(self.b);
        (velocity_b - velocity_a).length()
            + ((acceleration_b - acceleration_a).length() + braking_a + braking_b) * time
            + turning(self.a)
            + turning(self.b)
            + f64::MIN_POSITIVE
    }

    /// The first instant from `from` until `until` at which the two touch and close; for a pair that rests, close
    /// faster than the rest threshold where its contacts have not `kept` the point.
    pub fn next_touch(&self, pairs: &Pairs, from: f64, until: f64, kept: Option<Kept>) -> Option<f64> {
        if fault::lost_collision((self.a.slot, self.b.slot)) {
            return None;
        }
        let limit = self.speed_limit(from, until);
        let least = BITE * self.thinner() / limit;
        let mut now = (from, self.separation(from));
        let mut before: Option<(f64, f64)> = None;
        loop {
            let (time, separation) = now;
            let touching = separation <= self.tolerance;
            if touching && self.touch(pairs, time, kept).is_some() {
                return Some(match before {
                    Some((earlier, _)) => self.first_closing(pairs, (earlier, time), limit, kept),
                    None => time,
                });
            }
            if time >= until || separation - limit * (until - time) > self.tolerance {
                return None;
            }
            let next_time = (time + least.max(separation / limit)).min(until);
            let next = (next_time, self.separation(next_time));
            let crossing = if touching {
                None
            } else if next.1 <= 0.0 {
                Some(self.root(now, next))
            } else {
                before.and_then(|before| self.dip([before, now, next], limit))
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

    /// The first instant from `from` until `until` at which the two touch or overlap.
    pub fn first_overlap(&self, from: f64, until: f64) -> Option<f64> {
        let limit = self.speed_limit(from, until);
        let least = BITE * self.thinner() / limit;
        let mut now = (from, self.separation(from));
        let mut before: Option<(f64, f64)> = None;
        loop {
            let (time, separation) = now;
            if separation <= 0.0 {
                return Some(before.map_or(time, |earlier| self.root(earlier, now)));
            }
            if time >= until || separation - limit * (until - time) > 0.0 {
                return None;
            }
            let next_time = (time + least.max(separation / limit)).min(until);
            let next = (next_time, self.separation(next_time));
            if next.1 > 0.0
                && let Some(instant) = before.and_then(|before| self.dip([before, now, next], limit))
            {
                return Some(instant);
            }
            before = Some(now);
            now = next;
        }
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
    ///
    /// False position with the Illinois rule (Dowell and Jarratt 1971), a bisection every fourth time.
    fn root(&self, apart: (f64, f64), over: (f64, f64)) -> f64 {
        let (mut low, mut low_value) = apart;
        let (mut high, mut high_value) = over;
        for iteration in 0..80 {
            if high - low <= f64::EPSILON * high {
                break;
            }
            let fraction = if iteration % 4 == 3 { 0.5 } else { low_value / (low_value - high_value) };
            let middle = low + fraction.clamp(0.0, 1.0) * (high - low);
            let value = self.separation(middle);
            if value.abs() <= 0.01 * self.tolerance {
                return middle;
            }
            if value > 0.0 {
                (low, low_value) = (middle, value);
                high_value *= 0.5;
            } else {
                (high, high_value) = (middle, value);
                low_value *= 0.5;
            }
        }
        high
    }

    /// Where the separation vanishes between three instants of which the middle one is lowest, if a step was longer than
    /// was safe and it does vanish: a graze.
    fn dip(&self, [before, now, after]: [(f64, f64); 3], limit: f64) -> Option<f64> {
        let safe = |from: (f64, f64), to: (f64, f64)| (to.0 - from.0) * limit <= from.1;
        if now.1 >= before.1 || now.1 > after.1 || (safe(before, now) && safe(now, after)) {
            return None;
        }
        let (mut low, mut high) = (before.0, after.0);
        for _ in 0..24 {
            let third = 0.382 * (high - low);
            let (left, right) = (low + third, high - third);
            let (at_left, at_right) = (self.separation(left), self.separation(right));
            let lowest = if at_left < at_right { (left, at_left) } else { (right, at_right) };
            if lowest.1 <= 0.0 {
                return Some(self.root(if lowest.0 > now.0 { now } else { before }, lowest));
            }
            if at_left < at_right { high = right } else { low = left }
        }
        None
    }

    /// The first instant after `open`, where nothing closes, at which something does, as at `closing`; as exact as
    /// separations are.
    ///
    /// Where a corner comes down beside what touches already, false position on its gap (as in [`Self::root`]); bisection where a point
    /// that touches comes to close.
    fn first_closing(
        &self,
        pairs: &Pairs,
        (mut open, mut closing): (f64, f64),
        limit: f64,
        kept: Option<Kept>,
    ) -> f64 {
        let margin = (closing - open) * limit + self.tolerance;
        let gap = |time: f64| self.gap_of_closing(time, margin, kept);
        let (mut open_gap, mut closing_gap) = (gap(open), gap(closing));
        for iteration in 0.. {
            if (closing - open) * limit <= self.tolerance {
                break;
            }
            let is_bracketed = open_gap.is_finite() && closing_gap < 0.0;
            let fraction =
                if iteration % 4 == 3 || !is_bracketed { 0.5 } else { open_gap / (open_gap - closing_gap) };
            let middle = open + fraction * (closing - open);
            if middle <= open || middle >= closing {
                break;
            }
            if self.touch(pairs, middle, kept).is_some() {
                (closing, closing_gap) = (middle, gap(middle));
                if closing_gap.abs() <= self.tolerance && open_gap.is_finite() {
                    break;
                }
                open_gap *= 0.5;
            } else {
                (open, open_gap) = (middle, gap(middle));
                closing_gap *= 0.5;
            }
        }
        closing
    }
}
