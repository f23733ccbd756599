//! Islands solved at once, against many sweeps and against Coulomb's and Signorini's conditions.

use super::*;
use crate::solver::bundle::{POINTS, field};

/// What gravity does in a substep, m/s.
const GAIN: f64 = 9.81 / 240.0;

fn falling(mut problem: Problem) -> Problem {
    for mover in problem.movers.iter_mut().filter(|mover| mover.inverse_mass > 0.0) {
        mover.velocity.linear.y -= GAIN;
    }
    problem
}

/// Corners of a rectangle in the plane across y.
fn rectangle(middle: DVec3, half: [f64; 2]) -> [DVec3; 4] {
    let [x, z] = half;
    [(-x, -z), (-x, z), (x, z), (x, -z)].map(|(x, z)| middle + DVec3::new(x, 0.0, z))
}

fn cube(x: f64, y: f64, mass: f64) -> Mover {
    Mover::cuboid(DVec3::new(x, y, 0.0), DVec3::ONE, (mass, DQuat::IDENTITY))
}

/// Cubes on top of each other, each of them `ratio` times as heavy as the one below.
fn stack(count: usize, ratio: f64, friction: f64) -> Problem {
    let cubes = (0..count).map(|number| cube(0.0, 0.5 + number as f64, ratio.powi(number as i32)));
    let mut problem = Problem::new(cubes);
    for number in 0..count {
        let corners = rectangle(DVec3::Y * number as f64, [0.5, 0.5]);
        problem.touch([number, number + 1], (DVec3::Y, &corners), friction);
    }
    falling(problem)
}

/// A plank that lies on two cubes, with another cube on it off the middle.
fn plank() -> Problem {
    let plank = Mover::cuboid(DVec3::new(0.0, 1.1, 0.0), DVec3::new(5.0, 0.2, 1.0), (3.0, DQuat::IDENTITY));
    let mut problem = Problem::new([cube(-2.0, 0.5, 1.0), cube(2.0, 0.5, 2.0), plank, cube(1.0, 1.7, 4.0)]);
    for (number, x) in [(1, -2.0), (2, 2.0)] {
        let corners = |y: f64| rectangle(DVec3::new(x, y, 0.0), [0.5, 0.5]);
        problem.touch([0, number], (DVec3::Y, &corners(0.0)), 0.5);
        problem.touch([number, 3], (DVec3::Y, &corners(1.0)), 0.5);
    }
    problem.touch([3, 4], (DVec3::Y, &rectangle(DVec3::new(1.0, 1.2, 0.0), [0.5, 0.5])), 0.5);
    falling(problem)
}

/// A low box on a slope of `angle` (rad), with the `velocity` along and across it.
fn slope(angle: f64, friction: [f64; 2], velocity: DVec3) -> Problem {
    let tilt = DQuat::from_rotation_z(angle);
    let center = tilt * DVec3::Y * 0.1;
    let mut mover = Mover::cuboid(center, DVec3::new(1.0, 0.2, 1.0), (2.0, tilt));
    mover.velocity.linear = tilt * velocity;
    let mut problem = Problem::new([mover]);
    let corners = rectangle(DVec3::ZERO, [0.5, 0.5]).map(|corner| tilt * corner);
    problem.touch([0, 1], (tilt * DVec3::Y, &corners), 0.0);
    problem.touches[0].friction = friction;
    falling(problem)
}

/// Two planks that lean on each other and stand on the ground.
fn leaning(friction: f64) -> Problem {
    let lean = |sign: f64| {
        let axes = DQuat::from_rotation_z(-sign * 0.5);
        let half = axes * DVec3::Y;
        let center = DVec3::new(-sign * half.x.abs(), half.y, 0.0);
        Mover::cuboid(center, DVec3::new(0.01, 2.0, 1.0), (1.0, axes))
    };
    let (left, right) = (lean(1.0), lean(-1.0));
    let mut problem = Problem::new([left, right]);
    let line = |x: f64, y: f64| [DVec3::new(x, y, -0.5), DVec3::new(x, y, 0.5)];
    let (x, y) = (2.0 * left.center.x, 2.0 * left.center.y);
    problem.touch([0, 1], (DVec3::Y, &line(x, 0.0)), friction);
    problem.touch([0, 2], (DVec3::Y, &line(-x, 0.0)), friction);
    problem.touch([1, 2], (DVec3::X, &line(0.0, y)), friction);
    falling(problem)
}

/// Solved at once: velocities, and the impulses of each contact.
fn solved(problem: &Problem, exactness: f64) -> (Vec<Row>, Vec<[f64; field::ROWS]>, bool) {
    // As in the graph: after two sweeps.
    let (mut rows, bundles) = problem.swept(2);
    let mut island = problem.island(&bundles, &rows);
    let agrees = island.solve(exactness);
    island.write(&mut rows);
    let impulses = (0..bundles.len()).map(|contact| island.impulses(contact).map(f64::from)).collect();
    (rows, impulses, agrees)
}

/// Holds velocities and impulses to the laws of contact and friction.
///
/// `tolerance` is a speed, m/s; impulses are held to it times the mass that they move.
fn assert_lawful(problem: &Problem, rows: &[Row], impulses: &[[f64; field::ROWS]], tolerance: f64) {
    for (touch, (bundle, impulses)) in problem.touches.iter().zip(problem.bundles().iter().zip(impulses)) {
        let get = |line: usize| f64::from(bundle.get(0, line));
        let [a, b] = touch.bodies.map(|body| velocity(&rows[body]));
        let arm = |body: usize, point: DVec3| point - problem.movers[touch.bodies[body]].center;
        let (mut pressure, mut moment) = (0.0, 0.0);
        for (number, (point, _)) in touch.points.iter().enumerate() {
            let parting = (b.at(arm(1, *point)) - a.at(arm(0, *point))).dot(touch.normal);
            let (impulse, mass) = (impulses[number], get(field::of_point(number, field::MASS)));
            assert!(impulse >= 0.0, "point {number} pulls: {impulse}");
            assert!(parting >= -tolerance, "point {number} closes: {parting}");
            let push = impulse / mass;
            assert!(
                push.min(parting.abs()) <= tolerance,
                "point {number} parts at {parting} and pushes {push}"
            );
            pressure += impulse;
            moment += impulse * get(field::of_point(number, field::DISTANCE));
        }
        let axis = |line: usize| DVec3::new(get(line), get(line + 1), get(line + 2));
        let (first, normal) = (axis(field::TANGENT), axis(field::NORMAL));
        let outward = |v: DVec3| first * v.x + normal.cross(first) * v.y + normal * v.z;
        let arms = [field::FRICTION_ARM_A, field::FRICTION_ARM_B].map(|line| outward(axis(line)));
        let slip = b.at(arms[1]) - a.at(arms[0]);
        let slip = slip - normal * slip.dot(normal);
        let friction = outward(DVec3::new(impulses[POINTS], impulses[POINTS + 1], 0.0));
        let [still, sliding] = touch.friction;
        let slack = tolerance * get(field::FRICTION_MASS);
        assert!(friction.length() <= still * pressure + slack, "{} of {pressure}", friction.length());
        if slip.length() > 5.0 * tolerance {
            let ideal = -sliding * pressure * slip.normalize();
            let error = (friction - ideal).length();
            assert!(
                error <= 0.02 * sliding * pressure + slack,
                "slip {slip}, friction {friction}, not {ideal}"
            );
        }
        let (twist, spin) = (impulses[POINTS + 2], (b.angular - a.angular).dot(normal));
        let slack = tolerance * get(field::TWIST_MASS);
        assert!(twist.abs() <= still * moment + slack, "{twist} of {moment}");
        if spin.abs() > 5.0 * tolerance && get(field::TWIST_MASS) > 0.0 {
            let ideal = -sliding * moment * spin.signum();
            assert!((twist - ideal).abs() <= 0.02 * sliding * moment + slack, "{twist} not {ideal}");
        }
    }
}

/// Holds a problem's direct solution to the laws, and to what many sweeps come to.
fn check(problem: &Problem, sweeps: usize) -> Vec<Row> {
    let exactness = 1e-5 * GAIN;
    let (rows, impulses, agrees) = solved(problem, exactness);
    assert!(agrees, "no agreement");
    assert_lawful(problem, &rows, &impulses, 1e-3 * GAIN);
    let (truth, _) = problem.swept(sweeps);
    let error = difference(&rows, &truth);
    let size =
        truth.iter().flat_map(|row| row.0[..6].to_vec()).fold(GAIN as f32, |most, it| most.max(it.abs()));
    assert!(error <= 2e-3 * f64::from(size), "{error} of {size}:\n{rows:?}\n{truth:?}");
    rows
}

fn assert_still(rows: &[Row]) {
    let nothing = vec![Row::ZERO; rows.len()];
    assert!(difference(rows, &nothing) <= 1e-4 * GAIN, "{rows:?}");
}

#[test]
fn stacks_stand() {
    assert_still(&check(&stack(3, 1.0, 0.5), 3000));
    assert_still(&check(&stack(3, 10.0, 0.5), 30000));
    assert_still(&check(&stack(3, 0.1, 0.0), 3000));
    assert_still(&solved(&stack(10, 1.0, 0.5), 1e-5 * GAIN).0);
}

#[test]
fn a_plank_lies_on_two_supports() {
    assert_still(&check(&plank(), 5000));
}

#[test]
fn a_box_lies_on_a_slope_that_is_not_too_steep() {
    assert_still(&check(&slope(0.3, [0.5, 0.4], DVec3::ZERO), 2000));
}

#[test]
fn a_box_slides_down_a_steep_slope() {
    let rows = check(&slope(0.7, [0.3, 0.2], DVec3::ZERO), 2000);
    let along = velocity(&rows[1]).linear.length();
    let expected = GAIN * (0.7_f64.sin() - 0.2 * 0.7_f64.cos());
    assert!((along - expected).abs() <= 1e-3 * GAIN, "{along} not {expected}");
}

#[test]
fn a_box_that_slides_across_a_slope_is_braked_against_its_slip() {
    let mut random = Random(51);
    for _ in 0..100 {
        let speed = random.range(0.0, 3.0) * GAIN;
        let heading = random.range(0.0, std::f64::consts::TAU);
        let velocity = DVec3::new(speed * heading.cos(), 0.0, speed * heading.sin());
        let dynamic = random.range(0.05, 0.3);
        check(&slope(random.range(0.3, 0.8), [random.range(1.0, 1.5) * dynamic, dynamic], velocity), 2000);
    }
}

#[test]
fn planks_that_lean_on_each_other_stand_or_slide() {
    assert_still(&check(&leaning(0.9), 20000));
    check(&leaning(0.1), 20000);
    check(&leaning(0.0), 20000);
}

#[test]
fn impulses_at_redundant_points_add_up_to_the_weight() {
    // Four corners carry one cube; a second contact of the same two bodies adds four more.
    let mut problem = stack(1, 1.0, 0.5);
    problem.touch([0, 1], (DVec3::Y, &rectangle(DVec3::ZERO, [0.25, 0.25])), 0.5);
    assert_still(&check(&problem, 3000));
    let (_, impulses, _) = solved(&problem, 1e-5 * GAIN);
    let total: f64 = impulses.iter().flat_map(|contact| &contact[..POINTS]).sum();
    assert!((total - GAIN).abs() <= 1e-5 * GAIN, "{total}");
}

#[test]
fn a_stack_of_256_stands() {
    const HIGH: usize = 256;
    let problem = stack(HIGH, 1.0, 0.5);
    let (rows, impulses, agrees) = solved(&problem, 1e-5 * GAIN);
    assert!(agrees);
    assert_still(&rows);
    for (number, contact) in impulses.iter().enumerate() {
        let (load, above) = (contact[..POINTS].iter().sum::<f64>(), (HIGH - number) as f64);
        assert!((load - above * GAIN).abs() <= 1e-4 * load, "{load} under {above} cubes");
    }
}

#[test]
fn bodies_that_some_axes_hold_move_about_the_others_only() {
    let mut random = Random(52);
    let mut agreed = 0;
    for round in 0..100 {
        let count = 1 + random.below(4);
        let mut problem = Problem::random(&mut random, count);
        for mover in problem.movers.iter_mut().skip(1) {
            let held = |random: &mut Random| if random.below(2) == 0 { 0.0 } else { random.range(0.1, 1.0) };
            let moments = DVec3::new(held(&mut random), held(&mut random), held(&mut random));
            let mass = if random.below(4) == 0 { 0.0 } else { random.range(0.5, 5.0) };
            let axes = if round % 2 == 0 { DQuat::IDENTITY } else { random.rotation() };
            let velocity = mover.velocity;
            *mover = Mover::new(mover.center, mass, (moments, axes));
            mover.velocity.linear = if mass > 0.0 { velocity.linear } else { DVec3::ZERO };
            mover.velocity.angular = mover.inverse_inertia * (mover.inertia * velocity.angular);
        }
        for touch in &mut problem.touches {
            touch.friction = [0.0; 2];
        }
        let movable = |body: usize| problem.movers[body].is_movable();
        let touches = problem.touches.iter().filter(|touch| touch.bodies.into_iter().any(movable));
        problem = Problem { touches: touches.cloned().collect(), movers: problem.movers.clone() };
        let (truth, _) = problem.swept(10000);
        let (rows, impulses, agrees) = solved(&problem, 1e-5);
        assert!(problem.energy(&rows) <= problem.energy(&problem.rows()) * (1.0 + 1e-6), "round {round}");
        if agrees {
            agreed += 1;
            assert_lawful(&problem, &rows, &impulses, 1e-3);
            let error = difference(&rows, &truth);
            assert!(error <= 5e-3, "round {round}: {error}\n{rows:?}\n{truth:?}");
        }
        for (mover, (row, before)) in problem.movers.iter().zip(rows.iter().zip(problem.rows())) {
            let change = velocity(row).angular - velocity(&before).angular;
            let held = change - mover.inverse_inertia * (mover.inertia * change);
            assert!(held.length() <= 1e-4, "round {round}: turned by {held} about axes that are held");
        }
    }
    assert!(agreed > 80, "{agreed}");
}

#[test]
fn random_islands_end_lawful_or_say_so() {
    let mut random = Random(53);
    let mut agreed = 0;
    for _ in 0..200 {
        let count = 1 + random.below(6);
        let problem = Problem::random(&mut random, count);
        let (rows, impulses, agrees) = solved(&problem, 1e-5);
        assert!(rows.iter().flat_map(|row| row.0).all(f32::is_finite));
        if agrees {
            agreed += 1;
            assert!(problem.energy(&rows) <= problem.energy(&problem.rows()) * (1.0 + 1e-6));
            assert_lawful(&problem, &rows, &impulses, 1e-3);
        }
    }
    assert!(agreed > 20, "{agreed}");
}
