//! When balls touch what they fly straight towards, in closed form.
//!
//! Two bodies with the same acceleration move straight as seen from each other, so that a ball's distance from another ball is the
//! root of a quadratic function of time, and that from a side of what does not turn a linear one. Most pairs turn out to pass each other; for these
//! there is nothing else to do. What is too close to call (a graze, an edge, what touches already) is left to the search.

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::fault;
use crate::flight::fly_center;
use crate::math::{DVec3, Pose};
use crate::shape::Shape;
use crate::step::broad_phase::ColliderPair;

/// What becomes of two colliders until some time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outlook {
    /// Lower bounds of their separation now, of the least until then, and of that at the end, m.
    pub separation: f64,
    pub least: f64,
    pub end: f64,
    /// How long it takes them to touch, s, if they do.
    pub touch: Option<f64>,
}

impl Outlook {
    fn apart(separation: f64, least: f64, end: f64) -> Option<Self> {
        Some(Self { separation, least, end, touch: None })
    }

    fn touch(separation: f64, time: f64) -> Option<Self> {
        Some(Self { separation, least: f64::NEG_INFINITY, end: f64::NEG_INFINITY, touch: Some(time) })
    }
}

/// A ball's way, straight as seen from what it may touch, from now on.
struct Ball {
    /// m and m/s, relative to the centre of the other.
    center: DVec3,
    velocity: DVec3,
    /// m
    radius: f64,
    /// How long to look ahead, s.
    time: f64,
    /// Separations no further than this from zero (m) are too close to call.
    close: f64,
}

/// What becomes of two colliders `from` some time until another within the step (s), if that can be told at once; `tolerance` is the
/// separation (m) up to which their surfaces count as touching.
pub(crate) fn outlook(
    bodies: &Bodies,
    colliders: ColliderPair,
    (from, until): (f64, f64),
    tolerance: f64,
) -> Option<Outlook> {
    let (a, b) = (bodies.collider(colliders.0)?, bodies.collider(colliders.1)?);
    let (ball, other) = if is_ball(a) { (a, b) } else { (b, a) };
    let Shape::Sphere { radius } = ball.shape else { return None };
    let row = other.row;
    let is_straight = is_ball(ball)
        && bodies.influences[ball.row].acceleration == bodies.influences[row].acceleration
        && bodies.constants[ball.row].linear_damping == 0.0
        && bodies.constants[row].linear_damping == 0.0;
    if !is_straight || fault::lost_collision((a.slot, b.slot)) {
        return None;
    }
    let (ball, there) = (motion(bodies, ball, from), motion(bodies, other, from));
    let mut way = Ball {
        center: ball.0 - there.0,
        velocity: ball.1 - there.1,
        radius,
        time: until - from,
        close: CLOSE * tolerance,
    };
    match other.shape {
        Shape::Sphere { radius } if is_ball(other) => {
            way.radius += radius;
            way.meets_ball()
        }
        Shape::Cuboid { size } if bodies.paces[row].1 == 0.0 => {
            let pose = Pose::new(DVec3::ZERO, bodies.center_pose(other).rotation).then_local(&other.local);
            way.center = pose.inverse_transform_point(way.center);
            way.velocity = pose.rotation.conjugate() * way.velocity;
            way.meets_box(0.5 * size)
        }
        _ => None,
    }
}

/// Separations that are no more tolerances than this away from zero are left to the search.
const CLOSE: f64 = 4.0;

/// Whether a collider is a ball around its body's centre of mass.
fn is_ball(collider: &ColliderRow) -> bool {
    matches!(collider.shape, Shape::Sphere { .. }) && collider.spin_reach == 0.0
}

/// Position (m) and velocity (m/s) of the centre of mass of a collider's body at `time`.
fn motion(bodies: &Bodies, collider: &ColliderRow, time: f64) -> (DVec3, DVec3) {
    let row = collider.row;
    if row == WORLD_ROW {
        return (bodies.center_pose(collider).position, DVec3::ZERO);
    }
    let flown = time - bodies.clocks[row];
    fly_center(&bodies.states[row], &bodies.constants[row], &bodies.influences[row], flown)
}

impl Ball {
    /// Another ball, whose radius has been added to this one's.
    ///
    /// `|c + v·t| = r` at the lesser root of `v²t² + 2(c·v)t + (c² − r²)`.
    fn meets_ball(&self) -> Option<Outlook> {
        let &Ball { center, velocity, radius, time, close } = self;
        let distance = center.length();
        let separation = distance - radius;
        let closing = -center.dot(velocity);
        let end = (center + velocity * time).length() - radius;
        if closing <= 0.0 {
            return Outlook::apart(separation, separation, end);
        }
        let squared = velocity.length_squared();
        let nearest = (closing / squared).min(time);
        let least = (center + velocity * nearest).length() - radius;
        if separation <= close || least.abs() <= close {
            return None;
        }
        if least > 0.0 {
            return Outlook::apart(separation, least, end);
        }
        let product = separation * (distance + radius);
        let depth = (closing * closing - squared * product).max(0.0).sqrt();
        Outlook::touch(separation, product / (closing + depth))
    }

    /// A box of these half edges; centre and velocity are in its axes.
    fn meets_box(&self, half: DVec3) -> Option<Outlook> {
        let &Ball { center, velocity, radius, time, close } = self;
        let gaps = center.abs() - half - DVec3::splat(radius);
        let rates = velocity * center.signum();
        let separation = gaps.max_element();
        // A gap along any axis keeps the two apart.
        let gaps_at_end = gaps + rates * time;
        let least = gaps.min(gaps_at_end).max_element();
        if least > close {
            return Outlook::apart(separation, least, gaps_at_end.max_element());
        }
        // The last gap to close is the side that is met, if the ball is over it by then.
        let wait = |axis: usize| if gaps[axis] > close { gaps[axis] / -rates[axis] } else { 0.0 };
        let rank = |&axis: &usize| (wait(axis), gaps[axis]);
        let side =
            [0, 1, 2].into_iter().reduce(|one, two| if rank(&two) > rank(&one) { two } else { one })?;
        let there = center + velocity * wait(side);
        if (0..3).any(|axis| axis != side && there[axis].abs() > half[axis]) {
            return None;
        }
        if rates[side] >= 0.0 {
            return Outlook::apart(separation, separation, separation);
        }
        if gaps[side] <= close || gaps_at_end[side] >= -close {
            return None;
        }
        Outlook::touch(separation, wait(side))
    }
}

#[cfg(test)]
mod tests;
