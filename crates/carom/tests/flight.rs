//! Free flight against closed forms and independent integration.

use carom::math::{DQuat, DVec3};
use carom::prelude::*;
use carom::{PrincipalInertia, Settings};

fn floating() -> World {
    World::with_settings(Settings { gravity: DVec3::ZERO, ..Settings::default() })
}

#[test]
fn a_fall_of_four_seconds_ends_where_galilei_says() {
    let mut world = World::new();
    let ball = world.add(Body::dynamic().at(0.0, 100.0, 0.0).moving(3.0, 1.0, 0.0).with(Shape::sphere(0.5)));
    for _ in 0..240 {
        world.step(1.0 / 60.0);
    }
    let expected = DVec3::new(12.0, 100.0 + 4.0 - 0.5 * 9.81 * 16.0, 0.0);
    assert!((world[ball].position() - expected).length() < 1e-9, "{}", world[ball].position());
    assert!((f64::from(world[ball].linear_velocity().y) - (1.0 - 9.81 * 4.0)).abs() < 1e-5);
}

#[test]
fn a_damped_fall_follows_its_exponential() {
    let mut world = World::new();
    let mut body = Body::dynamic().moving(3.0, 0.0, 0.0).spinning(0.0, 4.0, 0.0).with(Shape::sphere(0.5));
    (body.linear_damping, body.angular_damping) = (0.7, 0.3);
    let ball = world.add(body);
    for _ in 0..120 {
        world.step(1.0 / 60.0);
    }
    let (c, t, g): (f64, f64, f64) = (0.7, 2.0, -9.81);
    let gone = 1.0 - (-c * t).exp();
    let expected = DVec3::new(3.0 / c * gone, g / c * (t - gone / c), 0.0);
    assert!((world[ball].position() - expected).length() < 1e-9, "{}", world[ball].position());
    let spin = f64::from(world[ball].angular_velocity().y);
    assert!((spin - 4.0 * (-0.3_f64 * 2.0).exp()).abs() < 1e-6, "{spin}");
}

/// Euler's equations in body axes and the quaternion's kinematics, by RK4 with a small step: nothing in common with the
/// engine's way.
fn integrate(moments: DVec3, mut rotation: DQuat, spin: DVec3, time: f64) -> (DQuat, DVec3) {
    let mut local = rotation.conjugate() * spin;
    let rate = |q: DQuat, w: DVec3| {
        let torque = -w.cross(moments * w);
        (q * DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * 0.5, torque / moments)
    };
    let steps = (time / 1e-4).round() as usize;
    let h = time / steps as f64;
    for _ in 0..steps {
        let (q, w) = (rotation, local);
        let (q1, w1) = rate(q, w);
        let (q2, w2) = rate(q + q1 * (0.5 * h), w + w1 * (0.5 * h));
        let (q3, w3) = rate(q + q2 * (0.5 * h), w + w2 * (0.5 * h));
        let (q4, w4) = rate(q + q3 * h, w + w3 * h);
        rotation = (q + (q1 + q2 * 2.0 + q3 * 2.0 + q4) * (h / 6.0)).normalize();
        local = w + (w1 + w2 * 2.0 + w3 * 2.0 + w4) * (h / 6.0);
    }
    (rotation, rotation * local)
}

fn tumbler(moments: DVec3, spin: DVec3) -> Body {
    let mut body = Body::dynamic().mass(1.0).with(Shape::cuboid(0.6, 0.3, 0.2));
    body.inertia = Some(PrincipalInertia { diagonal: moments, orientation: DQuat::IDENTITY });
    body.angular_velocity = spin.as_vec3();
    body
}

#[test]
fn a_tumbling_body_follows_eulers_equations() {
    for (moments, spin) in [
        (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.1, 10.0, 0.1)),
        (DVec3::new(0.9, 0.4, 1.2), DVec3::new(3.0, -5.0, 8.0)),
        (DVec3::new(2.0, 2.0, 1.0), DVec3::new(1.0, 2.0, 9.0)),
        (DVec3::new(1.0, 1.0, 1.0), DVec3::new(4.0, 4.0, 4.0)),
    ] {
        let mut world = floating();
        let id = world.add(tumbler(moments, spin));
        for _ in 0..120 {
            world.step(1.0 / 60.0);
        }
        let (rotation, turning) = integrate(moments, DQuat::IDENTITY, spin.as_vec3().as_dvec3(), 2.0);
        let found = world[id].rotation().as_dquat();
        assert!(found.dot(rotation).abs() > 1.0 - 1e-10, "{moments}: {found} {rotation}");
        let difference = world[id].angular_velocity().as_dvec3() - turning;
        assert!(difference.length() < 2e-5 * spin.length(), "{moments}: {difference}");
    }
}

/// The row: 10 rad/s for 60 s, close to the middle axis.
#[test]
fn a_box_that_tumbles_for_a_minute_keeps_momentum_energy_and_rhythm() {
    let mut world = floating();
    let id = world.add(Body::dynamic().with(Shape::cuboid(0.6, 0.2, 0.4)).spinning(0.0, 0.01, 10.0));
    // Moments of this box: x least, z middle, y greatest.
    let mass = *world.mass_of(id).unwrap();
    let (low, middle, high) = (mass.moments.x, mass.moments.z, mass.moments.y);
    assert!(low < middle && middle < high, "{:?}", mass.moments);
    let (energy, momentum) = (world.energy().kinetic, world.momentum().angular);
    let mut crossings = Vec::new();
    let mut before = 10.0;
    for step in 1..=3600 {
        world.step(1.0 / 60.0);
        let state = &world[id];
        let local = state.rotation().as_dquat().conjugate() * state.angular_velocity().as_dvec3();
        if before * local.z < 0.0 {
            let fraction = before / (before - local.z);
            crossings.push((f64::from(step) - 1.0 + fraction) / 60.0);
        }
        before = local.z;
        let change = (world.momentum().angular - momentum).length() / momentum.length();
        assert!(change < 1e-6, "angular momentum: {change}");
        let change = (world.energy().kinetic / energy - 1.0).abs();
        assert!(change < 1e-4, "energy: {change} at step {step}");
    }
    let flips = crossings.len() - 1;
    let rhythm = (crossings[flips] - crossings[0]) / flips as f64;
    let spin = DVec3::new(0.0, 0.01, 10.0).as_vec3().as_dvec3();
    let expected = half_period([low, middle, high], [spin.x, spin.z, spin.y]);
    assert!((rhythm / expected - 1.0).abs() < 1e-3, "{rhythm} instead of {expected}");
}

/// Time between two flips of a free body, moments ascending: half a period of Jacobi's functions, 2K(k)/p.
fn half_period(i: [f64; 3], w: [f64; 3]) -> f64 {
    let da = i[1] * (i[1] - i[0]) * w[1] * w[1] + i[2] * (i[2] - i[0]) * w[2] * w[2];
    let dc = i[0] * (i[2] - i[0]) * w[0] * w[0] + i[1] * (i[2] - i[1]) * w[1] * w[1];
    let db = i[0] * (i[0] - i[1]) * w[0] * w[0] + i[2] * (i[2] - i[1]) * w[2] * w[2];
    let product = i[0] * i[1] * i[2];
    let (p, complement) = if db > 0.0 {
        let s = (i[2] - i[1]) * da;
        ((s / product).sqrt(), ((i[2] - i[0]) * db / s).sqrt())
    } else {
        let s = (i[1] - i[0]) * dc;
        ((s / product).sqrt(), (-(i[2] - i[0]) * db / s).sqrt())
    };
    let (mut a, mut b) = (1.0_f64, complement);
    for _ in 0..40 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::PI / a / p
}

#[test]
fn infinite_inertia_keeps_its_spin_and_infinite_mass_its_speed() {
    let mut world = floating();
    let mut body =
        Body::dynamic().mass(0.0).moving(1.0, 0.0, 0.0).spinning(0.5, 2.0, 0.0).with(Shape::sphere(0.5));
    body.inertia = Some(PrincipalInertia { diagonal: DVec3::ZERO, orientation: DQuat::IDENTITY });
    let id = world.add(body);
    for _ in 0..60 {
        world.step(1.0 / 60.0);
    }
    assert!((world[id].angular_velocity() - Vec3::new(0.5, 2.0, 0.0)).length() < 1e-6);
    assert!((world[id].position() - DVec3::X).length() < 1e-9);
}
