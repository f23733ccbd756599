//! The way along a crest of the gap, to its summit.

use super::{Axis, along};
use crate::collide::parry::convex::Core;
use crate::math::{DVec3, Pose, any_tangent};

/// How far (rad) the best axis may be from where the way uphill ended at a crest, and how well it is found.
const CREST: f64 = 4e-4;
const FINE: f64 = 3e-9;

/// Looks at most along a line: where the guesses are no good, bisections.
const STEPS: usize = 18;

/// The axis of the widest gap near `start`, where curved cores touch at one point: the gap may have a crest there, with a kink
/// across it. The search goes along the crest, and at each of its places for the crest itself. The slopes of both sides, so weighted that
/// nothing of them leads across, give the slope along the crest.
pub(in crate::collide::parry) fn on_crest(a: &Core, b: &Core, b_in_a: &Pose, start: Axis) -> Axis {
    if !a.is_curved() && !b.is_curved() {
        return start;
    }
    let along = |normal: DVec3| along(a, b, b_in_a, normal);
    let slope_of = |axis: &Axis| (axis.on_b - axis.on_a) - axis.normal * axis.gap;
    let slope = slope_of(&along(start.normal));
    let across = slope.normalize_or(any_tangent(start.normal));
    let onward = start.normal.cross(across);
    let crest_at = |angle: f64| {
        let [low, high] = enclose(&|beside: f64| {
            let axis = along((start.normal + onward * angle + across * beside).normalize());
            (axis, slope_of(&axis).dot(across))
        });
        let [left, right] = [low, high].map(|probe| slope_of(&probe.axis).dot(onward));
        let drop = low.rise - high.rise;
        let rise = if drop > 0.0 { (right * low.rise - left * high.rise) / drop } else { left };
        (wider(low.axis, high.axis), rise)
    };
    let [low, high] = enclose(&crest_at);
    wider(start, wider(low.axis, high.axis))
}

fn wider(one: Axis, other: Axis) -> Axis {
    if other.gap > one.gap { other } else { one }
}

/// A look at one place of a line.
#[derive(Clone, Copy)]
struct Probe {
    place: f64,
    axis: Axis,
    /// How the gap grows with the place.
    rise: f64,
}

/// Two places close together with the widest gap of a line between them; at an end of the line, that end twice.
///
/// Kelley's cutting planes (1960): the gap is concave, and widest where the tangents of both sides meet if it has a kink there. If it
/// has none, the secant of the slopes finds the place; the two guesses take turns. Each goes a little beyond what it
/// finds, away from the nearer side, so that both sides close in.
fn enclose(look: &dyn Fn(f64) -> (Axis, f64)) -> [Probe; 2] {
    let probe = |place: f64| {
        let (axis, rise) = look(place);
        Probe { place, axis, rise }
    };
    let (mut low, mut high) = (probe(-CREST), probe(CREST));
    if low.rise <= 0.0 {
        return [low, low];
    }
    if high.rise >= 0.0 {
        return [high, high];
    }
    for step in 0..STEPS {
        let width = high.place - low.place;
        if width <= FINE {
            break;
        }
        let drop = low.rise - high.rise;
        let guess = if step % 2 == 0 {
            (high.axis.gap - low.axis.gap - high.rise * width) / drop
        } else {
            width * low.rise / drop
        };
        let onward = if guess < 0.5 * width { 0.4 * FINE } else { -0.4 * FINE };
        let beyond = (guess + onward).clamp(0.2 * FINE, width - 0.2 * FINE);
        let found = probe(low.place + beyond);
        if found.rise > 0.0 { low = found } else { high = found }
    }
    [low, high]
}
