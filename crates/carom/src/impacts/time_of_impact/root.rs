//! Where a function of time vanishes.

/// The time between two, at which `value` is above 0 and not above 0, at which it vanishes: where it is no larger than `tolerance`,
/// or as near as times can be told apart, and then not above 0.
///
/// Inverse quadratic interpolation through the last three times where these promise well, bisection where not; the first time, false
/// position. Chandrupatla, *A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without using
/// derivatives* (Advances in Engineering Software 28, 1997).
pub(super) fn root(value: impl Fn(f64) -> f64, [apart, over]: [(f64, f64); 2], tolerance: f64) -> f64 {
    // The last time, and the one across the zero from it.
    let (mut last, mut across) = (over, apart);
    let mut share = over.1 / (over.1 - apart.1);
    for _ in 0..MOST {
        let between = across.0 - last.0;
        if between.abs() <= f64::EPSILON * last.0.max(across.0) {
            break;
        }
        let time = last.0 + share.clamp(0.0, 1.0) * between;
        let now = (time, value(time));
        if now.1.abs() <= tolerance {
            return now.0;
        }
        let before = if (now.1 > 0.0) == (last.1 > 0.0) {
            std::mem::replace(&mut last, now)
        } else {
            let before = std::mem::replace(&mut across, last);
            last = now;
            before
        };
        share = interpolated(last, across, before).unwrap_or(0.5);
    }
    if last.1 > 0.0 { across.0 } else { last.0 }
}

/// Values asked for at most: no more than bisection needs.
const MOST: usize = 80;

/// Where between `last` and `across` the parabola through these and the time `before` vanishes, if it runs one way between them.
fn interpolated(last: (f64, f64), across: (f64, f64), before: (f64, f64)) -> Option<f64> {
    let time = (last.0 - across.0) / (before.0 - across.0);
    let value = (last.1 - across.1) / (before.1 - across.1);
    let runs_one_way = value * value < time && (1.0 - value) * (1.0 - value) < 1.0 - time;
    runs_one_way.then(|| {
        last.1 / (across.1 - last.1) * before.1 / (across.1 - before.1)
            + (before.0 - last.0) / (across.0 - last.0) * last.1 / (before.1 - last.1) * across.1
                / (before.1 - across.1)
    })
}

#[cfg(test)]
mod tests {
    use super::root;
    use std::cell::Cell;

    /// The root of `f` between two times, and how many values that took.
    fn find(f: impl Fn(f64) -> f64, [from, until]: [f64; 2]) -> (f64, usize) {
        let asked = Cell::new(0);
        let value = |time: f64| {
            asked.set(asked.get() + 1);
            f(time)
        };
        (root(value, [(from, f(from)), (until, f(until))], 1e-12), asked.get())
    }

    #[test]
    fn what_nearly_falls_straight_is_found_in_few_steps() {
        for curvature in [0.0, 1e-3, 0.1, -0.1, 0.5, -0.5] {
            let fall = |t: f64| 0.3 - t - curvature * t * t;
            let (time, asked) = find(fall, [0.0, 1.0]);
            assert!(fall(time).abs() <= 1e-12 && asked <= 6, "{curvature}: {time} after {asked}");
        }
    }

    #[test]
    fn kinks_steps_and_flat_ends_are_found() {
        let functions: [fn(f64) -> f64; 5] = [
            |t| (0.2 - t).max(0.01 * (0.4 - t)),
            |t| if t < 0.7 { 1.0 } else { -1e-3 },
            |t| (0.9 - t).powi(5),
            |t| 1e-3 - t.powi(9),
            |t| (0.5_f64 - t).signum() * (0.5 - t).abs().sqrt(),
        ];
        for (number, f) in functions.into_iter().enumerate() {
            let (time, asked) = find(f, [0.0, 1.0]);
            let around = f(time - 1e-9) >= 0.0 && f(time + 1e-9) <= 0.0;
            assert!(f(time).abs() <= 1e-12 || (around && f(time) <= 0.0), "{number}: {time} {}", f(time));
            assert!(asked <= 64, "{number}: {asked}");
        }
    }
}
