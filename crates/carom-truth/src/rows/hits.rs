//! Single impacts against the seed's formula, and the formula itself.

use crate::balls;
use crate::closed::solids::{Form, Solid};
use crate::random::Random;
use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, STEP, cube, floating, largest, median_and_worst, slab, spin, steps, velocity};
use carom::impulse::{Contact, Resolution, Side, Velocity, resolve};
use carom::math::{DMat3, DQuat, DVec3, rotated_diagonal};

pub fn rows() -> Vec<Row> {
    let law = "v_s = −C_r·v_c, and f, Δv, Δω from it";
    vec![
        Row::new("sphere-hits", "300 pairs of balls fly into each other, C_r 0, 0.5 and 1", law, sphere_hits)
            .figure(
                Figure::new("change of v off by, of the speed, median", "", 0.0, Within(1e-4))
                    .peers(["0.016", "0.027", "0.016", "0.016"]),
            )
            .figure(
                Figure::new("the same, worst", "", 0.0, Within(1e-3)).peers(["0.14", "0.27", "0.14", "0.9"]),
            )
            .figure(Figure::new("change of ω·r, of the speed, worst", "", 0.0, Within(1e-3))),
        Row::new("corner-hits", "200 spinning cubes land on a corner, C_r 0.5 and 1", law, corner_hits)
            .figure(
                Figure::new("Δω·R off by, of the speed, median", "", 0.0, Within(1e-3))
                    .peers(["0.021", "0.021", "0.048", "0.15"]),
            )
            .figure(Figure::new("the same, worst", "", 0.0, Within(1e-3))),
        Row::new(
            "seed-energy",
            "1,000,000 random impacts with friction through `impulse::resolve`",
            "ΔE ≤ 0",
            seed_energy,
        )
        .figure(Figure::new("largest gain, of the energy", "", 0.0, Within(1e-6)))
        .figure(Figure::new("largest |v_s + C_r·v_c|, of all speeds", "", 0.0, Within(1e-6))),
    ]
}

const STILL: Velocity = Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO };

/// A body with the same moment about all axes, as the seed sees it.
fn round_side(solid: &Solid, arm: DVec3, velocity: Velocity) -> Side {
    let moment = solid.moments().x;
    Side {
        mass: solid.mass(),
        inertia: DMat3::IDENTITY * moment,
        inverse_inertia: DMat3::IDENTITY * (1.0 / moment),
        arm,
        velocity,
    }
}

fn frictionless(normal: DVec3, restitution: f64) -> Contact {
    Contact { normal, restitution, static_friction: 0.0, dynamic_friction: 0.0 }
}

/// As single precision, which a body's description is in.
fn rounded(vector: DVec3) -> DVec3 {
    vector.as_vec3().as_dvec3()
}

fn sphere_hits() -> Vec<f64> {
    let (mut off, mut spun) = (Vec::new(), Vec::new());
    for restitution in [0.0, 0.5, 1.0] {
        let mut random = Random(42);
        for _ in 0..100 {
            let [v, w] = sphere_hit(&mut random, restitution);
            off.push(v);
            spun.push(w);
        }
    }
    let [median, worst] = median_and_worst(off);
    vec![median, worst, largest(spun)]
}

/// How far the velocities of one pair are from the formula's, and how much the spins changed, over the speed.
fn sphere_hit(random: &mut Random, restitution: f64) -> [f64; 2] {
    let radii = [random.range(0.2, 0.6), random.range(0.2, 0.6)];
    let solids = radii.map(|radius| Solid { form: Form::Ball(radius), density: random.range(300.0, 3000.0) });
    let speed = random.range(2.0, 10.0);
    let way = random.direction();
    let aside = random.direction().reject_from(way).normalize();
    let miss = random.range(0.0, 0.9) * (radii[0] + radii[1]);
    let places = [DVec3::ZERO, way * (random.range(1.5, 2.5) + radii[0] + radii[1]) + aside * miss];
    let drift = random.direction() * random.range(0.0, 2.0);
    let velocities = [rounded(drift), rounded(drift - way * speed)];
    let spins = [(); 2].map(|()| rounded(random.direction() * 3.0));

    let flying = [0, 1].map(|k| balls::ball(places[k], velocities[k], radii[k], solids[k].mass()));
    let Some(time) = balls::time_of_touch(&flying[0], &flying[1]) else { return [f64::NAN; 2] };
    let normal = (places[1] - places[0] + (velocities[1] - velocities[0]) * time).normalize();
    let before = [0, 1].map(|k| Velocity { linear: velocities[k], angular: spins[k] });
    let hit = resolve(
        &round_side(&solids[0], normal * radii[0], before[0]),
        &round_side(&solids[1], normal * -radii[1], before[1]),
        &frictionless(normal, restitution),
    );

    let mut world = floating();
    let ids = [0, 1].map(|k| {
        let body = solids[k].body().restitution(restitution).friction(0.0);
        world.add(body.placed(places[k]).flung(velocities[k]).spun(spins[k]))
    });
    for _ in 0..steps(time + 0.25) {
        world.step(STEP);
    }
    let truth = [hit.after_a.linear, hit.after_b.linear];
    let off = [0, 1].map(|k| (velocity(&world, ids[k]) - truth[k]).length() / speed);
    let turned = [0, 1].map(|k| (spin(&world, ids[k]) - spins[k]).length() * radii[k] / speed);
    [largest(off), largest(turned)]
}

/// A cube in free flight: it turns evenly, its moments being equal.
#[derive(Clone, Copy)]
struct FlyingCube {
    place: DVec3,
    rotation: DQuat,
    velocity: DVec3,
    spin: DVec3,
}

impl FlyingCube {
    fn after(&self, time: f64) -> Self {
        let rotation = DQuat::from_scaled_axis(self.spin * time) * self.rotation;
        Self { place: self.place + self.velocity * time, rotation: rotation.normalize(), ..*self }
    }

    /// Its corners, the lowest first.
    fn corners(&self) -> [DVec3; 8] {
        let half = |bits: u32, bit: u32| if bits >> bit & 1 == 1 { 0.5 } else { -0.5 };
        let mut corners = [0, 1, 2, 3, 4, 5, 6, 7]
            .map(|k| self.place + self.rotation * DVec3::new(half(k, 0), half(k, 1), half(k, 2)));
        corners.sort_by(|a, b| a.y.total_cmp(&b.y));
        corners
    }

    /// When its lowest corner first comes down to height 0 within `limit`, by small steps and bisection.
    fn time_of_touch(&self, limit: f64) -> Option<f64> {
        let height = |time: f64| self.after(time).corners()[0].y;
        const LOOK: f64 = 1e-3;
        let mut above = (0..).map(|k| f64::from(k) * LOOK).take_while(|&t| t < limit);
        let mut low = above.find(|&t| height(t) > 0.0 && height(t + LOOK) <= 0.0)?;
        let mut high = low + LOOK;
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if height(middle) > 0.0 { &mut low } else { &mut high }) = middle;
        }
        Some(high)
    }
}

fn corner_hits() -> Vec<f64> {
    let mut off = Vec::new();
    for restitution in [0.5, 1.0] {
        let mut random = Random(5);
        let mut count = 0;
        while count < 100 {
            if let Some(error) = corner_hit(&mut random, restitution) {
                off.push(error);
                count += 1;
            }
        }
    }
    median_and_worst(off).to_vec()
}

/// How far the spin after one landing is from the formula's; none where more than one corner would be at play.
fn corner_hit(random: &mut Random, restitution: f64) -> Option<f64> {
    let described = random.rotation().as_quat().normalize();
    let spin_before = rounded(random.direction() * random.range(0.0, 3.0));
    let speed = random.range(2.0, 8.0);
    let velocity_before = rounded(DVec3::new(random.range(-1.0, 1.0), -speed, random.range(-1.0, 1.0)));
    let start = FlyingCube {
        place: DVec3::Y * random.range(1.6, 2.6),
        rotation: described.as_dquat().normalize(),
        velocity: velocity_before,
        spin: spin_before,
    };
    let time = start.time_of_touch(3.0)?;
    let landing = start.after(time);
    let corners = landing.corners();
    if corners[1].y - corners[0].y < 0.15 {
        return None;
    }
    let solid = Solid { form: Form::Cuboid(DVec3::ONE), density: 1000.0 };
    let before = Velocity { linear: velocity_before, angular: spin_before };
    let floor = Side {
        mass: f64::INFINITY,
        inertia: DMat3::ZERO,
        inverse_inertia: DMat3::ZERO,
        arm: DVec3::ZERO,
        velocity: STILL,
    };
    let hit = resolve(
        &floor,
        &round_side(&solid, corners[0] - landing.place, before),
        &frictionless(DVec3::Y, restitution),
    );
    let left = FlyingCube { velocity: hit.after_b.linear, spin: hit.after_b.angular, ..landing };
    if left.after(1e-6).time_of_touch(0.15).is_some() {
        return None;
    }

    let mut world = floating();
    world.add(slab().friction(0.0).restitution(restitution));
    let body = cube().restitution(restitution).friction(0.0).placed(start.place).rotated(described);
    let id = world.add(body.flung(velocity_before).spun(spin_before));
    for _ in 0..steps(time + 0.05) {
        world.step(STEP);
    }
    Some((spin(&world, id) - hit.after_b.angular).length() * solid.reach() / speed)
}

/// Random bodies, arms, velocities, restitutions and frictions; an eighth of them against what nothing moves.
fn seed_energy() -> Vec<f64> {
    let mut random = Random(1);
    let (mut gain, mut off) = (0.0_f64, 0.0_f64);
    let mut done = 0;
    while done < 1_000_000 {
        let immovable = random.unit() < 0.125;
        let a = random_side(&mut random, immovable);
        let b = random_side(&mut random, false);
        let dynamic_friction = random.range(0.0, 1.5);
        let contact = Contact {
            normal: random.direction(),
            restitution: random.unit(),
            static_friction: dynamic_friction * random.range(1.0, 1.5),
            dynamic_friction,
        };
        let hit = resolve(&a, &b, &contact);
        if hit.closing_speed >= 0.0 {
            continue;
        }
        done += 1;
        let before = kinetic(&a, &a.velocity) + kinetic(&b, &b.velocity);
        let after = kinetic(&a, &hit.after_a) + kinetic(&b, &hit.after_b);
        gain = largest([gain, after / before - 1.0]);
        off = largest([off, newton_off(&a, &b, &contact, &hit)]);
    }
    vec![gain, off]
}

fn random_side(random: &mut Random, immovable: bool) -> Side {
    let arm = random.in_cube();
    if immovable {
        let nothing = DMat3::ZERO;
        return Side {
            mass: f64::INFINITY,
            inertia: nothing,
            inverse_inertia: nothing,
            arm,
            velocity: STILL,
        };
    }
    // A box of any proportions, so that the moments are such as a body can have.
    let size = random.edges(0.1, 2.0);
    let solid = Solid { form: Form::Cuboid(size), density: 10_f64.powf(random.range(1.0, 4.0)) };
    let turn = random.rotation();
    let moments = solid.moments();
    Side {
        mass: solid.mass(),
        inertia: rotated_diagonal(turn, moments),
        inverse_inertia: rotated_diagonal(turn, DVec3::ONE / moments),
        arm: turn * (0.5 * size * arm),
        velocity: Velocity { linear: random.in_cube() * 5.0, angular: random.in_cube() * 10.0 },
    }
}

fn kinetic(side: &Side, velocity: &Velocity) -> f64 {
    let linear = if side.mass.is_finite() { side.mass * velocity.linear.length_squared() } else { 0.0 };
    0.5 * linear + 0.5 * velocity.angular.dot(side.inertia * velocity.angular)
}

/// |v_s + C_r·v_c| over the speeds that make it up.
fn newton_off(a: &Side, b: &Side, contact: &Contact, hit: &Resolution) -> f64 {
    let of_points = |at: &Velocity, side: &Side| at.linear.length() + at.angular.length() * side.arm.length();
    let speeds = of_points(&a.velocity, a)
        + of_points(&b.velocity, b)
        + of_points(&hit.after_a, a)
        + of_points(&hit.after_b, b);
    let separating = (hit.after_b.at(b.arm) - hit.after_a.at(a.arm)).dot(contact.normal);
    let closing = (b.velocity.at(b.arm) - a.velocity.at(a.arm)).dot(contact.normal);
    (separating + contact.restitution * closing).abs() / speeds
}
