//! How a body was to fly on when its fat boxes were made: as long as it does so nearly, it stays in them.

use crate::bodies::Bodies;
use crate::math::DVec3;

/// A straight way for some time, and how far the body may be off it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forecast {
    /// Centre of mass (m) and its velocity (m/s) at the start.
    position: DVec3,
    velocity: DVec3,
    /// Since the world began, s.
    start: f64,
    /// The boxes reach so far ahead, s; there the forecast ends, for a body that waits as well.
    duration: f64,
    /// m
    stray: f64,
    /// Up to which [way](Bodies::way) it may turn, rad.
    turn: f64,
    /// How far ahead the next boxes are to reach, steps.
    steps_ahead: f64,
}

impl Forecast {
    /// Of a body whose boxes nobody has made.
    pub const NONE: Forecast = Forecast {
        position: DVec3::ZERO,
        velocity: DVec3::ZERO,
        start: 0.0,
        duration: 0.0,
        stray: -1.0,
        turn: -1.0,
        steps_ahead: 0.0,
    };

    /// A body goes on as it does now for a `duration` (s) from its own time on, in a step that began at `time`.
    pub fn new(bodies: &Bodies, row: usize, (time, duration): (f64, f64), steps_ahead: f64) -> Self {
        let state = &bodies.states[row];
        Self {
            position: state.position,
            velocity: state.velocity,
            start: time + bodies.clocks[row],
            duration,
            stray: f64::INFINITY,
            turn: f64::INFINITY,
            steps_ahead,
        }
    }

    /// How far ahead the next boxes are to reach, steps.
    pub fn steps_ahead(&self) -> f64 {
        self.steps_ahead
    }

    /// Lets the next boxes reach further ahead by this factor, within limits.
    pub fn look_ahead(&mut self, factor: f64, [least, most]: [f64; 2]) {
        self.steps_ahead = (factor * self.steps_ahead).clamp(least, most);
    }

    /// How far it leads, m.
    pub fn way(&self) -> DVec3 {
        self.velocity * self.duration
    }

    /// Allows no more than leaves `room` (m) to a collider; `turned` is the angle (rad) that the body's way has come to, and
    /// `spin_reach` how far a turn takes its points, m.
    pub fn allow(&mut self, room: f64, (turned, spin_reach): (f64, f64)) {
        self.stray = self.stray.min(0.5 * room);
        if spin_reach > 0.0 {
            self.turn = self.turn.min(turned + 0.5 * room / spin_reach);
        }
    }

    /// Whether the body still follows it, on its path from its own time to the end of the step of `step` seconds that began
    /// at `time`.
    #[inline]
    pub fn holds(&self, bodies: &Bodies, row: usize, (time, step): (f64, f64)) -> bool {
        let (state, influence) = (&bodies.states[row], &bodies.influences[row]);
        let (clock, damping) = (bodies.clocks[row], bodies.constants[row].linear_damping);
        let foreseen =
            |until: f64| self.position + self.velocity * (until - self.start).clamp(0.0, self.duration);
        let is_near = |position: DVec3, until: f64, stray: f64| {
            stray >= 0.0 && position.distance_squared(foreseen(until)) <= stray * stray
        };
        let (_, turned) = bodies.way(row, step);
        if turned > self.turn {
            return false;
        }
        let is_straight = damping == 0.0 && influence.acceleration == DVec3::ZERO;
        let ends_before = time + step <= self.start + self.duration;
        if is_straight && ends_before && state.velocity == self.velocity {
            return is_near(state.position, time + clock, self.stray);
        }
        // The path bends by acceleration and damping.
        let left = step - clock;
        let drag = damping * state.velocity.length();
        let stray = self.stray - 0.5 * left * left * (influence.acceleration.length() + drag);
        is_near(state.position, time + clock, stray)
            && is_near(state.position + state.velocity * left, time + step, stray)
    }
}
