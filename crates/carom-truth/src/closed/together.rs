//! What several bodies that are struck at one instant do, where symmetry or the order of the impacts decides it.

/// A ball that strikes two like balls, which touch, in the middle between them, C_r = 1 (Bernoulli): its speed afterwards
/// and theirs, over its speed before.
///
/// The impulses J on both are equal and along the lines of centres, at 30° to the striker's way, so that
/// `v = 1 − 2J cos 30°`, `v₂ = J`, and from the energy `J = 2 cos 30°/(1 + 2 cos² 30°)`: −1/5 and 2√3/5.
pub fn one_onto_two() -> [f64; 2] {
    let cosine = 0.75_f64.sqrt();
    let impulse = 2.0 * cosine / (1.0 + 2.0 * cosine * cosine);
    [1.0 - 2.0 * impulse * cosine, impulse]
}

/// Elastic impact on a line: what the velocities (m/s) of two bodies become.
pub fn elastic([a, b]: [f64; 2], [v, u]: [f64; 2]) -> [f64; 2] {
    let common = (a * v + b * u) / (a + b);
    [2.0 * common - v, 2.0 * common - u]
}

/// A row of touching balls on a line, struck from the left by the first: velocities (m/s) after the last of the elastic
/// impacts, which come one after the other since only the first pair closes at the start.
pub fn row_struck(masses: &[f64], speed: f64) -> Vec<f64> {
    let mut velocities = vec![0.0; masses.len()];
    velocities[0] = speed;
    while let Some(k) = (1..masses.len()).find(|&k| velocities[k - 1] - velocities[k] > 1e-12 * speed) {
        [velocities[k - 1], velocities[k]] =
            elastic([masses[k - 1], masses[k]], [velocities[k - 1], velocities[k]]);
    }
    velocities
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::balls::tests::springs;
    use crate::balls::{Ball, ball};
    use carom::math::DVec3;

    #[test]
    fn one_onto_two_is_what_stiff_springs_do() {
        let height = 0.75_f64.sqrt();
        let mut balls = [
            ball(DVec3::new(-height - 0.01, 0.0, 0.0), DVec3::X, 0.5, 1.0),
            ball(DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, 0.5, 1.0),
            ball(DVec3::new(0.0, 0.0, -0.5), DVec3::ZERO, 0.5, 1.0),
        ];
        springs(&mut balls, 1e7, 0.1);
        let [striker, struck] = one_onto_two();
        assert!((balls[0].velocity.x - striker).abs() < 2e-3, "{:?}", balls[0]);
        for ball in &balls[1..] {
            assert!((ball.velocity.length() - struck).abs() < 2e-3, "{ball:?}");
        }
    }

    #[test]
    fn a_row_with_gaps_ends_as_the_row_that_touches() {
        let masses = [1.0, 1.0, 3.0];
        let mut balls: Vec<Ball> =
            (0..3).map(|k| ball(DVec3::X * (1.0 + 1e-6) * k as f64, DVec3::ZERO, 0.5, masses[k])).collect();
        balls[0].position.x -= 0.1;
        balls[0].velocity.x = 2.0;
        crate::balls::fly(&mut balls, 1.0);
        let closed = row_struck(&masses, 2.0);
        assert!((closed[0] + 1.0).abs() < 1e-12 && closed[1].abs() < 1e-12, "{closed:?}");
        for (ball, speed) in balls.iter().zip(closed) {
            assert!((ball.velocity.x - speed).abs() < 1e-12, "{ball:?} {speed}");
        }
    }
}
