//! One contact alone is the seed.

use super::*;
use crate::impulse::{self, Contact, Resolution, resolve};
use crate::solver::bundle::field;

/// Two bodies that touch at one point, and what the seed makes of it.
fn pair(random: &mut Random, friction: [f64; 2]) -> Problem {
    let mut problem = Problem::new([Mover::random(random), Mover::random(random)]);
    let bodies = [[1, 2], [0, 2], [1, 0]][random.below(3)];
    let points = vec![(random.vector(1.0), 0.0)];
    problem.touches.push(Touch { bodies, normal: random.direction(), points, friction });
    problem
}

fn by_the_seed(problem: &Problem) -> Resolution {
    let touch = &problem.touches[0];
    let [a, b] = touch.bodies.map(|body| {
        let mover = &problem.movers[body];
        impulse::Side {
            mass: 1.0 / mover.inverse_mass,
            inertia: mover.inertia,
            inverse_inertia: mover.inverse_inertia,
            arm: if body == 0 { DVec3::ZERO } else { touch.points[0].0 - mover.center },
            velocity: mover.velocity,
        }
    });
    let [static_friction, dynamic_friction] = touch.friction;
    resolve(&a, &b, &Contact { normal: touch.normal, restitution: 0.0, static_friction, dynamic_friction })
}

fn assert_as_the_seed(problem: &Problem, hit: &Resolution, tolerance: f64) {
    let (rows, _) = problem.swept(1);
    for (body, after) in problem.touches[0].bodies.into_iter().zip([hit.after_a, hit.after_b]) {
        let got = velocity(&rows[body]);
        let size = after.linear.length() + after.angular.length() + hit.closing_speed.abs();
        let error = (got.linear - after.linear).length() + (got.angular - after.angular).length();
        assert!(error <= tolerance * size, "{error} of {size}: {got:?} is not {after:?}");
    }
}

#[test]
fn one_sweep_over_one_point_is_the_seed_without_bounce() {
    let mut random = Random(1);
    let mut pressed = 0;
    for _ in 0..2000 {
        let problem = pair(&mut random, [0.0; 2]);
        let hit = by_the_seed(&problem);
        assert_as_the_seed(&problem, &hit, 1e-5);
        let (_, bundles) = problem.swept(1);
        let impulse = f64::from(bundles[0].get(0, field::of_point(0, field::IMPULSE)));
        assert!((impulse - hit.fraction).abs() <= 1e-5 * hit.fraction, "{impulse} {}", hit.fraction);
        pressed += u32::from(hit.fraction > 0.0);
    }
    assert!((600..1400).contains(&pressed), "{pressed}");
}

/// A ball that strikes another or the world at the point nearest to it.
fn balls(random: &mut Random, friction: [f64; 2]) -> Problem {
    let normal = random.direction();
    let ball = |random: &mut Random, center: DVec3, radius: f64| {
        let mass = random.range(0.5, 5.0);
        let moment = DVec3::splat(0.4 * mass * radius * radius);
        let mut ball = Mover::new(center, mass, (moment, DQuat::IDENTITY));
        ball.velocity = Mover::random(random).velocity;
        ball
    };
    let (first, second) = (random.range(0.2, 1.0), random.range(0.2, 1.0));
    let movers = [ball(random, -first * normal, first), ball(random, second * normal, second)];
    let mut problem = Problem::new(movers);
    let bodies = [[1, 2], [0, 2]][random.below(2)];
    problem.touches.push(Touch { bodies, normal, points: vec![(DVec3::ZERO, 0.0)], friction });
    problem
}

#[test]
fn balls_stick_as_the_seed_lets_them() {
    let mut random = Random(2);
    let mut stuck = 0;
    for _ in 0..1000 {
        let problem = balls(&mut random, [1e3; 2]);
        let hit = by_the_seed(&problem);
        if hit.sticks {
            assert_as_the_seed(&problem, &hit, 1e-5);
            stuck += 1;
        }
    }
    assert!(stuck > 300, "{stuck}");
}

#[test]
fn balls_slide_on_the_cone_of_the_dynamic_coefficient_against_their_slip() {
    let mut random = Random(3);
    let mut slid = 0;
    for _ in 0..1000 {
        let dynamic = random.range(0.0, 0.2);
        let problem = balls(&mut random, [1.3 * dynamic, dynamic]);
        let hit = by_the_seed(&problem);
        let (rows, bundles) = problem.swept(1);
        let get = |line: usize| f64::from(bundles[0].get(0, line));
        let axis = |line: usize| DVec3::new(get(line), get(line + 1), get(line + 2));
        let (normal, first) = (axis(field::NORMAL), axis(field::TANGENT));
        let friction = first * get(field::FRICTION) + normal.cross(first) * get(field::FRICTION + 1);
        let pressure = get(field::of_point(0, field::IMPULSE));
        let slip = |rows: &[Row]| {
            let touch = &problem.touches[0];
            let [a, b] = touch.bodies.map(|body| {
                let arm = if body == 0 { DVec3::ZERO } else { -problem.movers[body].center };
                velocity(&rows[body]).at(arm)
            });
            (b - a) - touch.normal * touch.normal.dot(b - a)
        };
        if hit.fraction > 0.0 && !hit.sticks {
            let direction = slip(&problem.rows()).normalize();
            let size = dynamic * pressure;
            assert!((friction + size * direction).length() <= 1e-5 * pressure, "{friction} {direction}");
            assert!(slip(&rows).dot(direction) >= -1e-5, "friction has turned the slip round");
            slid += 1;
        }
    }
    assert!(slid > 300, "{slid}");
}
