//! A ball that is dropped and bounces: a geometric series.

/// The height (m) of its n-th apex, dropped from `height`: `h·C_r^(2n)`.
pub fn apex(height: f64, restitution: f64, n: i32) -> f64 {
    height * restitution.powi(2 * n)
}

/// The last moment (s) at which a ball that is dropped from `height` is as high as `level` (m), gravity `g` (m/s²).
///
/// Sums the flights, of 2v/g each with v falling by C_r from one to the next, as long as they reach the level.
pub fn last_moment_at(level: f64, height: f64, restitution: f64, g: f64) -> f64 {
    let mut speed = (2.0 * g * height).sqrt();
    let mut landing = speed / g;
    let mut last = (2.0 * (height - level) / g).sqrt();
    loop {
        speed *= restitution;
        let above = speed * speed - 2.0 * g * level;
        if above <= 0.0 {
            return last;
        }
        last = landing + (speed + above.sqrt()) / g;
        landing += 2.0 * speed / g;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_that_of_a_flight_in_small_steps() {
        let (height, restitution, g, dt, level) = (2.0, 0.8, 9.81, 2e-7, 0.005);
        let (mut y, mut v, mut t, mut top, mut last) = (height, 0.0_f64, 0.0, 0.0_f64, 0.0);
        let mut apexes = Vec::new();
        while t < 6.0 {
            y += v * dt - 0.5 * g * dt * dt;
            v -= g * dt;
            t += dt;
            if y < 0.0 {
                apexes.push(top);
                (y, v, top) = (-y * restitution, -v * restitution, 0.0);
            }
            top = top.max(y);
            if y > level {
                last = t;
            }
        }
        for n in 1..8 {
            let found = apexes[n as usize];
            assert!((found / apex(height, restitution, n) - 1.0).abs() < 1e-4, "{n}: {found}");
        }
        let closed = last_moment_at(level, height, restitution, g);
        assert!((last - closed).abs() < 1e-4, "{last} {closed}");
    }

    #[test]
    fn a_ball_that_is_watched_closely_rests_when_the_series_ends() {
        let (height, restitution, g) = (2.0_f64, 0.8, 9.81);
        let end = (2.0 * height / g).sqrt() * (1.0 + restitution) / (1.0 - restitution);
        assert!((last_moment_at(1e-12, height, restitution, g) - end).abs() < 1e-5);
    }
}
