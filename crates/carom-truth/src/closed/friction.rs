//! Coulomb's law: what slides, rolls and is spun by an impact.

/// The way (m) after which something that slides at `speed` (m/s) on the level stops: `v²/2μg`.
pub fn way_to_rest(speed: f64, friction: f64, g: f64) -> f64 {
    speed * speed / (2.0 * friction * g)
}

/// Acceleration (m/s²) of a ball that rolls down a slope of `angle` (rad): `5/7·g·sin θ`.
pub fn rolling_acceleration(angle: f64, g: f64) -> f64 {
    5.0 / 7.0 * g * angle.sin()
}

/// A ball of radius `radius` that meets a wall: its speeds after the impact, along the wall, away from it, and its spin
/// (rad/s, positive where it turns as a ball does that rolls along), from `along` and `towards` (m/s) and no spin.
///
/// Friction takes the tangential impulse `j_t/m = min(2/7·slip, μ·(1 + C_r)·v_n)` (Routh 1860).
pub fn superball(along: f64, towards: f64, (restitution, friction): (f64, f64), radius: f64) -> [f64; 3] {
    let per_mass = (2.0 / 7.0 * along.abs()).min(friction * (1.0 + restitution) * towards);
    let change = per_mass * along.signum();
    [along - change, restitution * towards, change / (0.4 * radius)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_slides_stops_where_small_steps_say() {
        let (mut x, mut v, dt) = (0.0, 5.0, 1e-6);
        while v > 0.0 {
            x += v * dt;
            v -= 0.5 * 9.81 * dt;
        }
        assert!((x - way_to_rest(5.0, 0.5, 9.81)).abs() < 1e-4);
    }

    /// Friction as a stiff damper between the ball and the slope, which keeps the slip small.
    #[test]
    fn a_ball_rolls_as_friction_against_slip_makes_it() {
        let (angle, g, radius, dt) = (0.35_f64, 9.81, 0.5, 1e-6);
        let (mut v, mut w) = (0.0, 0.0);
        for _ in 0..1_000_000 {
            let friction = -2e4 * (v - radius * w);
            v += (g * angle.sin() + friction) * dt;
            w -= friction / (0.4 * radius) * dt;
        }
        assert!((v / rolling_acceleration(angle, g) - 1.0).abs() < 1e-3, "{v}");
    }

    /// The normal impulse comes in small parts, each with the friction that Coulomb's law allows it.
    #[test]
    fn a_superball_is_what_many_small_impulses_make_it() {
        let radius = 0.5;
        for (friction, restitution) in [(0.05, 1.0), (0.2, 0.6), (1.0, 1.0), (0.1, 0.0)] {
            let (mut v, mut w) = (4.0, 0.0);
            let parts = 100_000;
            for _ in 0..parts {
                let normal = (1.0 + restitution) * 5.0 / f64::from(parts);
                let slip: f64 = v - radius * w;
                let tangential = (friction * normal).min(2.0 / 7.0 * slip);
                v -= tangential;
                w += tangential / (0.4 * radius);
            }
            let [along, away, spin] = superball(4.0, 5.0, (restitution, friction), radius);
            assert!((along - v).abs() < 1e-6 && (spin - w).abs() < 1e-6, "{along} {v} {spin} {w}");
            assert_eq!(away, 5.0 * restitution);
        }
    }
}
