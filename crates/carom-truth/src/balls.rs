//! Balls in free space from one elastic impact to the next, in double precision: the reference for what has no closed form.

use carom::math::DVec3;

/// A smooth ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre, m.
    pub position: DVec3,
    /// m/s
    pub velocity: DVec3,
    /// m
    pub radius: f64,
    /// kg
    pub mass: f64,
}

/// A ball from its parts: centre (m), velocity (m/s), radius (m), mass (kg).
pub fn ball(position: DVec3, velocity: DVec3, radius: f64, mass: f64) -> Ball {
    Ball { position, velocity, radius, mass }
}

/// When (s, from now) two balls that move evenly touch; none if they miss each other or part.
///
/// The smaller root of `|x + v·t|² = R²`, written so that nothing cancels.
pub fn time_of_touch(a: &Ball, b: &Ball) -> Option<f64> {
    let (x, v) = (b.position - a.position, b.velocity - a.velocity);
    let reach = a.radius + b.radius;
    let closing = x.dot(v);
    let gap = x.length_squared() - reach * reach;
    let root = closing * closing - v.length_squared() * gap;
    (closing < 0.0 && root >= 0.0).then(|| (gap / (root.sqrt() - closing)).max(0.0))
}

/// Lets `time` (s) pass: even flight from impact to impact, each elastic and without friction. Returns how many there were.
///
/// Impacts of one instant come one after the other; scenes in which that matters have no single answer.
pub fn fly(balls: &mut [Ball], time: f64) -> usize {
    let (mut left, mut impacts) = (time, 0);
    loop {
        let mut next: Option<(f64, usize, usize)> = None;
        for i in 0..balls.len() {
            for j in i + 1..balls.len() {
                let touch = time_of_touch(&balls[i], &balls[j]);
                if let Some(t) = touch
                    && t <= next.map_or(left, |(earliest, ..)| earliest)
                {
                    next = Some((t, i, j));
                }
            }
        }
        let flight = next.map_or(left, |(t, ..)| t);
        balls.iter_mut().for_each(|ball| ball.position += ball.velocity * flight);
        left -= flight;
        let Some((_, i, j)) = next else { return impacts };
        let (a, b) = (balls[i], balls[j]);
        let normal = (b.position - a.position).normalize();
        let closing = (b.velocity - a.velocity).dot(normal);
        let impulse = -2.0 * closing / (1.0 / a.mass + 1.0 / b.mass);
        balls[i].velocity -= impulse / a.mass * normal;
        balls[j].velocity += impulse / b.mass * normal;
        impacts += 1;
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::random::Random;

    /// Lets `time` pass with stiff springs between balls that overlap, in small symplectic steps.
    pub(crate) fn springs(balls: &mut [Ball], stiffness: f64, time: f64) {
        let dt = 0.01 / stiffness.sqrt();
        for _ in 0..(time / dt) as usize {
            for i in 0..balls.len() {
                for j in i + 1..balls.len() {
                    let apart = balls[j].position - balls[i].position;
                    let depth = balls[i].radius + balls[j].radius - apart.length();
                    if depth > 0.0 {
                        let push = stiffness * depth * dt * apart.normalize();
                        let (a, b) = (balls[i].mass, balls[j].mass);
                        balls[i].velocity -= push / a;
                        balls[j].velocity += push / b;
                    }
                }
            }
            balls.iter_mut().for_each(|ball| ball.position += ball.velocity * dt);
        }
    }

    #[test]
    fn impacts_are_what_stiff_springs_do() {
        let start = [
            ball(DVec3::new(-1.2, 0.1, 0.0), DVec3::new(2.0, 0.0, 0.1), 0.5, 1.0),
            ball(DVec3::ZERO, DVec3::ZERO, 0.4, 2.0),
            ball(DVec3::new(1.0, 0.2, 0.1), DVec3::new(0.0, -0.1, 0.0), 0.3, 0.5),
        ];
        let (mut exact, mut soft) = (start, start);
        assert!(fly(&mut exact, 1.0) >= 2);
        springs(&mut soft, 1e6, 1.0);
        for (exact, soft) in exact.iter().zip(&soft) {
            assert!((exact.velocity - soft.velocity).length() < 2e-2, "{exact:?} {soft:?}");
            assert!((exact.position - soft.position).length() < 2e-2, "{exact:?} {soft:?}");
        }
    }

    #[test]
    fn a_cloud_keeps_momentum_and_energy_and_never_overlaps() {
        let mut random = Random(3);
        let mut balls: Vec<Ball> = (0..27)
            .map(|k| {
                let place = DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9));
                ball(place - 1.0, 1.0 - place + random.in_cube(), 0.45, random.range(1.0, 5.0))
            })
            .collect();
        let books = |balls: &[Ball]| {
            let momentum: DVec3 = balls.iter().map(|ball| ball.mass * ball.velocity).sum();
            let energy: f64 = balls.iter().map(|ball| 0.5 * ball.mass * ball.velocity.length_squared()).sum();
            (momentum, energy)
        };
        let (momentum, energy) = books(&balls);
        let mut impacts = 0;
        for _ in 0..100 {
            impacts += fly(&mut balls, 0.01);
            for (i, a) in balls.iter().enumerate() {
                for b in &balls[i + 1..] {
                    assert!(a.position.distance(b.position) > a.radius + b.radius - 1e-9);
                }
            }
        }
        assert!(impacts > 30, "{impacts}");
        let now = books(&balls);
        assert!((now.0 - momentum).length() < 1e-10 && (now.1 / energy - 1.0).abs() < 1e-12);
    }
}
