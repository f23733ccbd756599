//! What flies and turns freely, and a top.

use crate::closed::top::Top;
use crate::closed::tumble::flip_time;
use crate::row::{Figure, Goal::Share, Goal::Within, Row};
use crate::scene::{Begins, G, STEP, ball, floating, rotation, spin, steps};
use carom::math::{DQuat, DVec3, rotated_diagonal};
use carom::prelude::*;
use carom::{Collider, PrincipalInertia};
use std::f64::consts::{FRAC_PI_3, TAU};

pub fn rows() -> Vec<Row> {
    let tumbler = tumbler_moments();
    let flip = flip_time([tumbler.x, tumbler.y, tumbler.z], TUMBLE.to_array());
    let precession = TOP.slow_precession(TOP_SPIN, TOP_TILT, G);
    vec![
        Row::new("free-fall", "a ball is thrown and flies for 4 s", "x₀ + v·t + ½·g·t²", free_fall).figure(
            Figure::new("furthest from the parabola", "m", 0.0, Within(1e-4))
                .peers(["0.082", "0.082", "0.33", "0.33"]),
        ),
        Row::new("tumble", "a box turns freely at 10 rad/s for 60 s", "L and E stay; flips after 2K(k)/p", tumble)
            .figure(
                Figure::new("largest change of angular momentum, of it", "", 0.0, Within(1e-6))
                    .peers(["0.08", "0.30", "0.42", "0.19"]),
            )
            .figure(
                Figure::new("largest change of energy, of it", "", 0.0, Within(1e-4))
                    .peers(["+4 %", "−58 %", "+4 %", "+4 %"]),
            )
            .figure(
                Figure::new("mean time between flips", "s", flip, Share(1e-3))
                    .peers(["1.27", "0.670", "2.11", "2.17"]),
            ),
        Row::new(
            "heavy-top",
            "a top spins at 20 rad/s, 60° from upright, with its round tip in a smooth pit; the others hang it on a joint",
            "I₁·cos θ·Ω² − I₃·ω₃·Ω + m·g·l = 0",
            heavy_top,
        )
        .figure(
            Figure::new("rate of precession over 10 s", "rad/s", precession, Share(0.01))
                .peers(["1.47", "1.43", "1.49", "1.49"])
                .missed(FIRST_ORDER),
        )
        .figure(
            Figure::new("largest change of tilt", "rad", 0.0, Within(0.01)).peers(["0.53", "0.62", "1.5", "1.5"]).missed(FIRST_ORDER),
        ),
    ]
}

/// Both errors halve with the substep; the top also loses spin, which no push through a point of its axis can take.
const FIRST_ORDER: &str = "what contacts give to a body that spins is found for the start of a substep: an error of first order in it";

fn free_fall() -> Vec<f64> {
    let velocity = DVec3::new(10.0, 20.0, 3.0);
    let mut world = World::new();
    let id = world.add(ball(0.5).flung(velocity).spun(DVec3::Y * 5.0));
    let mut worst = 0.0_f64;
    for step in 1..=steps(4.0) {
        world.step(STEP);
        let t = step as f64 * STEP;
        let truth = velocity * t - DVec3::Y * (0.5 * G * t * t);
        worst = worst.max(world[id].position().distance(truth));
    }
    vec![worst]
}

const TUMBLER: DVec3 = DVec3::new(1.2, 0.6, 0.2);
/// rad/s
const TUMBLE: DVec3 = DVec3::new(4.0, 7.0, 5.0);

/// Moments of the tumbling box of 1000 kg/m³, kg·m²; rising from x to z.
fn tumbler_moments() -> DVec3 {
    use crate::closed::solids::{Form, Solid};
    Solid { form: Form::Cuboid(TUMBLER), density: 1000.0 }.moments()
}

fn tumble() -> Vec<f64> {
    let moments = tumbler_moments();
    let mut world = floating();
    let id = world.add(Body::dynamic().with(Shape::Cuboid { size: TUMBLER }).spun(TUMBLE));
    let momentum_of = |world: &World| rotated_diagonal(rotation(world, id), moments) * spin(world, id);
    let energy_of = |world: &World| 0.5 * spin(world, id).dot(momentum_of(world));
    let (momentum, energy) = (momentum_of(&world), energy_of(&world));
    let (mut turned, mut gained, mut flips, mut before) = (0.0_f64, 0.0_f64, Vec::new(), TUMBLE.y);
    for step in 0..steps(60.0) {
        world.step(STEP);
        turned = turned.max((momentum_of(&world) - momentum).length() / momentum.length());
        gained = gained.max((energy_of(&world) / energy - 1.0).abs());
        let middle = (rotation(&world, id).conjugate() * spin(&world, id)).y;
        if before * middle < 0.0 {
            flips.push((step as f64 + before / (before - middle)) * STEP);
        }
        before = middle;
    }
    let between = match flips[..] {
        [first, .., last] => (last - first) / (flips.len() - 1) as f64,
        _ => f64::NAN,
    };
    vec![turned, gained, between]
}

/// A disc of 1 m by 1 m by 0.2 m in its weight and inertia; all that touches is the ball at its tip.
const TOP: Top = Top { mass: 200.0, length: 0.5, axial: 100.0 / 3.0, across: 52.0 / 3.0 };
const TOP_SPIN: f64 = 20.0;
const TOP_TILT: f64 = FRAC_PI_3;
const TIP: f64 = 0.05;

/// The tip is a ball that lies on three smooth planes, which push through its centre only: they hold the centre where it is
/// and turn nothing.
fn heavy_top() -> Vec<f64> {
    let rate = TOP.slow_precession(TOP_SPIN, TOP_TILT, G);
    let mut world = World::new();
    for side in 0..3 {
        let around = DQuat::from_rotation_y(f64::from(side) * TAU / 3.0);
        let plane = around * DQuat::from_rotation_z(1.0);
        let place = plane * DVec3::Y * -TIP;
        world.add(Body::fixed().with(Shape::plane()).friction(0.0).turned(plane).placed(place));
    }
    let start = DQuat::from_rotation_z(-TOP_TILT);
    let axis = start * DVec3::Y;
    let whole = DVec3::Y * rate + axis * (TOP_SPIN - rate * TOP_TILT.cos());
    let mut body = Body::dynamic().collider(Collider::new(Shape::sphere(TIP))).friction(0.0).mass(TOP.mass);
    body.center_of_mass = Some(DVec3::Y * TOP.length);
    let diagonal = DVec3::new(TOP.across, TOP.axial, TOP.across);
    body.inertia = Some(PrincipalInertia { diagonal, orientation: DQuat::IDENTITY });
    let velocity = whole.cross(axis * TOP.length);
    let id = world.add(body.turned(start).spun(whole).flung(velocity));

    let azimuth = |axis: DVec3| (-axis.z).atan2(axis.x);
    let (mut round, mut last, mut nodded) = (0.0, azimuth(axis), 0.0_f64);
    let seconds = 10.0;
    for _ in 0..steps(seconds) {
        world.step(STEP);
        let axis = rotation(&world, id) * DVec3::Y;
        let now = azimuth(axis);
        round += (now - last + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
        last = now;
        nodded = nodded.max((axis.y.clamp(-1.0, 1.0).acos() - TOP_TILT).abs());
    }
    vec![round / seconds, nodded]
}
