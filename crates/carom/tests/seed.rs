//! The seed's formula against its own three conditions, for collisions that nobody picked.

use carom::conditions::{DOUBLE, Hit, conditions};
use carom::impulse::{Contact, Side, Velocity, resolve};
use carom::math::{DMat3, DQuat, DVec3, rotated_diagonal};
use random::Random;

mod random;

impl Random {
    fn side(&mut self) -> Side {
        let mass = 10.0_f64.powf(self.range(-2.0, 3.0));
        let (x, y, z) = (self.range(0.1, 1.0), self.range(0.1, 1.0), self.range(0.1, 1.0));
        let moments = DVec3::new(y * y + z * z, x * x + z * z, x * x + y * y) * (mass / 12.0);
        let rotation = DQuat::from_xyzw(self.unit(), self.unit(), self.unit(), self.unit() + 0.1).normalize();
        Side {
            mass,
            inertia: rotated_diagonal(rotation, moments),
            inverse_inertia: rotated_diagonal(rotation, moments.recip()),
            arm: self.vector(1.0),
            velocity: Velocity { linear: self.vector(10.0), angular: self.vector(20.0) },
        }
    }

    fn immovable(&mut self) -> Side {
        Side { mass: f64::INFINITY, inertia: DMat3::ZERO, inverse_inertia: DMat3::ZERO, ..self.side() }
    }

    /// A collision whose bodies close; every fourth has an immovable partner, every second friction.
    fn collision(&mut self, number: usize) -> (Side, Side, Contact) {
        loop {
            let mut a = self.side();
            let mut b = self.side();
            match number % 8 {
                3 => a = self.immovable(),
                7 => b = self.immovable(),
                _ => {}
            }
            let normal = self.direction();
            let friction = if number.is_multiple_of(2) { 0.0 } else { self.range(0.0, 1.5) };
            let restitution = [0.0, 1.0, self.unit()][number % 3];
            let contact = Contact {
                normal,
                restitution,
                static_friction: friction * self.range(1.0, 1.5),
                dynamic_friction: friction,
            };
            if (b.velocity.at(b.arm) - a.velocity.at(a.arm)).dot(normal) < -1e-3 {
                return (a, b, contact);
            }
        }
    }
}

#[test]
fn a_hundred_thousand_collisions_hold_the_three_conditions() {
    let mut random = Random(2026);
    let (mut sticking, mut sliding) = (0, 0);
    for number in 0..100_000 {
        let (a, b, contact) = random.collision(number);
        let found = resolve(&a, &b, &contact);
        let point = random.vector(5.0);
        let hit =
            Hit { point, contact, a, b, after_a: found.after_a, after_b: found.after_b, rounding: DOUBLE };
        let about = random.vector(10.0);
        let laws = conditions(&hit, about);
        assert!(laws.hold(), "collision {number}: {laws:#?}");

        // And in the issue's own terms: 1e-12 relative.
        let error = found.separating_speed + contact.restitution * found.closing_speed;
        let speeds = a.velocity.at(a.arm).length() + b.velocity.at(b.arm).length();
        assert!(error.abs() <= 1e-12 * speeds.max(1.0), "collision {number}: v_s is off by {error:e}");
        assert!(found.fraction > 0.0);

        // Energy as seen from the partner that does not move: never more than before.
        let relative = |side: &Side, velocity: &Velocity, other: &Side| {
            let frame = if other.mass.is_infinite() { other.velocity.at(other.arm) } else { DVec3::ZERO };
            let linear = velocity.linear - frame;
            let finite = if side.mass.is_finite() { side.mass * linear.length_squared() } else { 0.0 };
            0.5 * (finite + velocity.angular.dot(side.inertia * velocity.angular))
        };
        let before = relative(&a, &a.velocity, &b) + relative(&b, &b.velocity, &a);
        let after = relative(&a, &found.after_a, &b) + relative(&b, &found.after_b, &a);
        assert!(after <= before * (1.0 + 1e-12), "collision {number} gains {:e}", after / before - 1.0);
        if contact.restitution == 1.0 && contact.dynamic_friction == 0.0 {
            assert!((after / before - 1.0).abs() < 1e-12);
        }

        // Friction keeps to its cone and against the slip that it finds.
        let limit = contact.static_friction.max(contact.dynamic_friction) * found.fraction;
        assert!(found.friction_impulse.length() <= limit * (1.0 + 1e-12));
        assert!(found.friction_impulse.dot(contact.normal).abs() <= 1e-12 * (limit + 1.0));
        if found.sticks {
            sticking += 1;
            let slip = found.after_b.at(b.arm) - found.after_a.at(a.arm);
            let slip = slip - slip.dot(contact.normal) * contact.normal;
            assert!(slip.length() < 1e-9 * speeds.max(1.0), "collision {number} sticks with slip {slip}");
        } else if found.friction_impulse != DVec3::ZERO {
            sliding += 1;
        }
    }
    assert!(sticking > 5_000 && sliding > 5_000, "{sticking} stick, {sliding} slide");
}

/// Coulomb and Routh: a ball on a plane slides, or its slip ends, with 2/7 of the slip's mass.
#[test]
fn a_ball_with_spin_follows_routh() {
    let mut random = Random(7);
    for _ in 0..1000 {
        let (radius, mass) = (random.range(0.1, 1.0), random.range(0.5, 5.0));
        let inertia = DMat3::IDENTITY * (0.4 * mass * radius * radius);
        let mut ball = random.side();
        ball = Side { mass, inertia, inverse_inertia: inertia.inverse(), arm: DVec3::Y * -radius, ..ball };
        ball.velocity.linear.y = -random.range(0.5, 8.0);
        let mut plane = random.immovable();
        plane.velocity = Velocity::default();
        let (restitution, friction) = (random.unit(), random.range(0.01, 0.8));
        let contact =
            Contact { normal: DVec3::Y, restitution, static_friction: friction, dynamic_friction: friction };
        let found = resolve(&plane, &ball, &contact);
        let slip = ball.velocity.at(ball.arm) * DVec3::new(1.0, 0.0, 1.0);
        let push = (1.0 + restitution) * -ball.velocity.linear.y;
        let drag = slip.normalize() * -(2.0 / 7.0 * slip.length()).min(friction * push);
        let expected = ball.velocity.linear + DVec3::Y * push + drag;
        assert!((found.after_b.linear - expected).length() < 1e-12, "{} {expected}", found.after_b.linear);
        let turned = ball.velocity.angular + ball.arm.cross(drag) / (0.4 * radius * radius);
        assert!((found.after_b.angular - turned).length() < 1e-10 / radius);
    }
}

/// The rigid limit: a stiff spring at the point of contact, integrated in time, with nothing of the formula in it.
#[test]
fn a_stiff_spring_at_the_contact_gives_the_same_impulse() {
    let mut random = Random(11);
    for number in [0, 2, 4, 6, 8] {
        let (a, b, contact) = random.collision(number);
        let contact = Contact { restitution: 1.0, static_friction: 0.0, dynamic_friction: 0.0, ..contact };
        let (mut after_a, mut after_b) = (a.velocity, b.velocity);
        let per_impulse =
            (b.respond(contact.normal).at_point - a.respond(-contact.normal).at_point).dot(contact.normal);
        let (stiffness, step) = (1e6 / per_impulse, 1e-7);
        let mut gap = 0.0;
        loop {
            let impulse = -stiffness * gap * step * contact.normal;
            let push =
                |side: &Side, velocity: Velocity, impulse: DVec3| Side { velocity, ..*side }.after(impulse);
            if gap < 0.0 {
                (after_a, after_b) = (push(&a, after_a, -impulse), push(&b, after_b, impulse));
            }
            gap += (after_b.at(b.arm) - after_a.at(a.arm)).dot(contact.normal) * step;
            if gap > 0.0 {
                break;
            }
        }
        let found = resolve(&a, &b, &contact);
        assert!((found.after_a.linear - after_a.linear).length() < 1e-3);
        assert!((found.after_b.angular - after_b.angular).length() < 1e-2);
    }
}

/// A wrong lever arm, a wrong C_r, a lost impulse: the conditions see each.
#[test]
fn the_conditions_see_planted_faults() {
    let mut random = Random(5);
    for number in 0..1000 {
        let (a, b, contact) = random.collision(number);
        let right = resolve(&a, &b, &contact);
        let impulse = right.fraction * contact.normal + right.friction_impulse;
        let hit =
            |after_a, after_b| Hit { point: DVec3::ZERO, contact, a, b, after_a, after_b, rounding: DOUBLE };
        let about = DVec3::new(1.0, 2.0, 3.0);
        let strong = Contact { restitution: contact.restitution * 0.99 + 0.01, ..contact };
        let wrong = resolve(&a, &b, &strong);
        if contact.restitution < 0.99 {
            assert!(!conditions(&hit(wrong.after_a, wrong.after_b), about).separating_speed.holds);
        }
        if b.mass.is_finite() {
            let turned = Velocity {
                linear: right.after_b.linear,
                angular: b.velocity.angular - b.inverse_inertia * b.arm.cross(impulse),
            };
            assert!(!conditions(&hit(right.after_a, turned), about).angular_momentum.holds);
            assert!(!conditions(&hit(right.after_a, b.velocity), about).linear_momentum.holds);
        }
    }
}
