//! One round of collisions: what was struck at one instant and resolved at once.

use super::{AGREED, Condition, Conditions, Hit};
use crate::impulse::{Contact, Velocity, resolve};
use crate::math::{DMat3, DVec3};

/// A body of a [`Round`], before and after. World axes, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Partner {
    /// Mass, kg. Infinite for what no impulse can move.
    pub mass: f64,
    /// Inertia about the centre of mass, kg·m²; zero on axes of infinite inertia.
    pub inertia: DMat3,
    /// Inverse inertia, 1/(kg·m²); zero on axes of infinite inertia.
    pub inverse_inertia: DMat3,
    /// Velocity before the round.
    pub before: Velocity,
    /// Velocity after it.
    pub after: Velocity,
}

/// A contact that was struck in a [`Round`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strike {
    /// Which of the round's partners are its `a` and its `b`.
    pub partners: [usize; 2],
    /// Where it is, m.
    pub point: DVec3,
    /// From the centres of mass of `a` and `b` to the point, m.
    pub arms: [DVec3; 2],
    /// Normal, C_r and friction.
    pub contact: Contact,
    /// What `b` got here, N·s; `a` got its opposite.
    pub impulse: DVec3,
}

/// Contacts that were struck at one instant and resolved at once, with all bodies that they concern, each of them once.
#[derive(Clone, Debug, PartialEq)]
pub struct Round {
    /// The bodies.
    pub partners: Vec<Partner>,
    /// The contacts.
    pub strikes: Vec<Strike>,
    /// Relative rounding of the velocities: [`STORED`](super::STORED) or [`DOUBLE`](super::DOUBLE).
    pub rounding: f64,
}

/// A collision by itself: the impulse is the formula's.
impl From<&Hit> for Round {
    fn from(hit: &Hit) -> Self {
        let Hit { a, b, contact, .. } = hit;
        let formula = resolve(a, b, contact);
        let partners = [(a, hit.after_a), (b, hit.after_b)].map(|(side, after)| Partner {
            mass: side.mass,
            inertia: side.inertia,
            inverse_inertia: side.inverse_inertia,
            before: side.velocity,
            after,
        });
        let strike = Strike {
            partners: [0, 1],
            point: hit.point,
            arms: [a.arm, b.arm],
            contact: *contact,
            impulse: formula.fraction * contact.normal + formula.friction_impulse,
        };
        Self { partners: partners.to_vec(), strikes: vec![strike], rounding: hit.rounding }
    }
}

/// One body's share in the books.
struct Books {
    linear: DVec3,
    angular: DVec3,
    energy: f64,
    /// The absolute terms that make up each: what rounding is relative to.
    linear_scale: f64,
    angular_scale: f64,
}

impl Partner {
    fn books(&self, velocity: &Velocity, offset: DVec3) -> Books {
        let linear = if self.mass.is_finite() { self.mass * velocity.linear } else { DVec3::ZERO };
        let spin = self.inertia * velocity.angular;
        Books {
            linear,
            angular: offset.cross(linear) + spin,
            energy: 0.5 * (linear.dot(velocity.linear) + spin.dot(velocity.angular)),
            linear_scale: linear.length(),
            angular_scale: offset.length() * linear.length() + spin.length(),
        }
    }

    /// What rounding of the speed at `arm` is relative to.
    fn speed_scale(&self, arm: DVec3) -> f64 {
        let of = |velocity: &Velocity| {
            let spin = (self.inertia * velocity.angular).length();
            let turning = largest(&self.inverse_inertia) * spin + velocity.angular.length();
            velocity.linear.length() + arm.length() * turning
        };
        of(&self.before) + of(&self.after)
    }

    /// Velocity, before the round, that no impulse can change: of the centre, and angular.
    fn driven(&self) -> Velocity {
        let Velocity { linear, angular } = self.before;
        Velocity {
            linear: if self.mass.is_finite() { DVec3::ZERO } else { linear },
            angular: angular - self.inverse_inertia * (self.inertia * angular),
        }
    }
}

/// What went into infinite masses and inertias.
#[derive(Default)]
struct ToWorld {
    linear: DVec3,
    angular: DVec3,
    /// What their motion gave, J.
    work: f64,
    /// What rounding of it is relative to, J.
    work_scale: f64,
}

impl Round {
    /// Holds all bodies of the round to the conditions of momentum and energy, and contact `strike` to that of its speed. Angular
    /// momentum is about the point `about`.
    ///
    /// A contact that is alone parts with `v_s = −C_r·v_c`; one of several with no less. Without friction the energy
    /// falls by `½ Σ f·(1 − C_r)·|v_c|` over the contacts, which for one contact is `½ (1 − C_r²)·v_c²/K`. With friction
    /// one contact loses no less than that, several lose no less than nothing.
    ///
    /// What an infinite partner takes follows from the impulse `j`: `j` itself, `(p − O) × j` less what its finite parts keep,
    /// and the work that its motion does, `j·v` at the point.
    ///
    /// # Panics
    /// If there is no contact `strike`, or one names a partner that the round does not have.
    ///
    /// # Example
    /// Two balls meet a resting third one from both sides at once, and it stays where it is.
    /// ```
    /// use carom::conditions::{DOUBLE, Partner, Round, Strike};
    /// use carom::impulse::{Contact, Velocity};
    /// use carom::math::{DMat3, DVec3};
    /// let ball = |before: f64| Partner {
    ///     mass: 2.0,
    ///     inertia: DMat3::IDENTITY * 0.2,
    ///     inverse_inertia: DMat3::IDENTITY * 5.0,
    ///     before: Velocity { linear: DVec3::X * before, angular: DVec3::ZERO },
    ///     after: Velocity { linear: DVec3::X * -before, angular: DVec3::ZERO },
    /// };
    /// let contact = Contact { normal: DVec3::X, restitution: 1.0, static_friction: 0.0, dynamic_friction: 0.0 };
    /// let strike = |a: usize, x: f64| Strike {
    ///     partners: [a, a + 1],
    ///     point: DVec3::X * x,
    ///     arms: [DVec3::X * 0.5, DVec3::X * -0.5],
    ///     contact,
    ///     impulse: DVec3::X * 4.0,
    /// };
    /// let partners = vec![ball(1.0), ball(0.0), ball(-1.0)];
    /// let round = Round { partners, strikes: vec![strike(0, 0.5), strike(1, 1.5)], rounding: DOUBLE };
    /// let laws = round.conditions(0, DVec3::ZERO);
    /// assert!(laws.hold());
    /// assert_eq!((laws.separating_speed.after, laws.energy.after), (1.0, 2.0));
    /// ```
    pub fn conditions(&self, strike: usize, about: DVec3) -> Conditions {
        let offsets = self.offsets(about);
        let books = |of: fn(&Partner) -> &Velocity| -> Vec<Books> {
            let partners = self.partners.iter().zip(&offsets);
            partners.map(|(partner, &offset)| partner.books(of(partner), offset)).collect()
        };
        let (before, after) = (books(|partner| &partner.before), books(|partner| &partner.after));
        let vectors =
            |pick: fn(&Books) -> DVec3, of: &[Books]| of.iter().map(pick).fold(DVec3::ZERO, |x, y| x + y);
        let sum = |pick: fn(&Books) -> f64, of: &[Books]| of.iter().map(pick).fold(0.0, |x, y| x + y);
        let scale = |pick: fn(&Books) -> f64| self.rounding * (sum(pick, &before) + sum(pick, &after));
        let to_world = self.to_world(about);

        let (energy_before, energy_after) =
            (sum(|books| books.energy, &before), sum(|books| books.energy, &after));
        let energy_expected = energy_before - self.loss() + to_world.work;
        let energy_error = energy_after - energy_expected;
        let levers: f64 = self
            .strikes
            .iter()
            .map(|strike| (strike.point - about).length() * strike.impulse.length())
            .fold(0.0, |x, y| x + y);
        Conditions {
            separating_speed: self.separating_speed(strike),
            linear_momentum: momentum(
                vectors(|books| books.linear, &before),
                vectors(|books| books.linear, &after),
                to_world.linear,
                scale(|books| books.linear_scale),
            ),
            angular_momentum: momentum(
                vectors(|books| books.angular, &before),
                vectors(|books| books.angular, &after),
                to_world.angular,
                scale(|books| books.angular_scale) + self.rounding * levers,
            ),
            energy: condition(
                (energy_before, energy_after, energy_expected),
                if self.is_smooth() { energy_error.abs() } else { energy_error.max(0.0) },
                2.0 * scale(|books| books.energy) + self.rounding * to_world.work_scale,
            ),
            linear_to_world: to_world.linear,
            angular_to_world: to_world.angular,
            reference_point: about,
        }
    }

    /// Centres of mass from `about`.
    fn offsets(&self, about: DVec3) -> Vec<DVec3> {
        let mut offsets = vec![DVec3::ZERO; self.partners.len()];
        for strike in self.strikes.iter().rev() {
            for (partner, arm) in strike.partners.into_iter().zip(strike.arms) {
                offsets[partner] = strike.point - about - arm;
            }
        }
        offsets
    }

    fn is_smooth(&self) -> bool {
        let contacts = self.strikes.iter().map(|strike| &strike.contact);
        contacts.fold(true, |smooth, contact| {
            smooth && contact.static_friction == 0.0 && contact.dynamic_friction == 0.0
        })
    }

    /// Speed of `b`'s point against `a`'s along the normal, before or after, m/s.
    fn speed(&self, strike: &Strike, of: fn(&Partner) -> &Velocity) -> f64 {
        let [a, b] = [0, 1].map(|side| of(&self.partners[strike.partners[side]]).at(strike.arms[side]));
        (b - a).dot(strike.contact.normal)
    }

    fn separating_speed(&self, index: usize) -> Condition<f64> {
        let strike = &self.strikes[index];
        let closing = self.speed(strike, |partner| &partner.before);
        let separating = self.speed(strike, |partner| &partner.after);
        let expected = -strike.contact.restitution * closing;
        let mut tolerance = self.rounding * self.speed_scale(strike);
        let mut error = (separating - expected).abs();
        if self.strikes.len() > 1 {
            error = (expected - separating).max(0.0);
            let closings =
                self.strikes.iter().map(|strike| self.speed(strike, |partner| &partner.before).abs());
            tolerance += AGREED * closings.fold(0.0, f64::max);
        }
        condition((closing, separating, expected), error, tolerance)
    }

    fn speed_scale(&self, strike: &Strike) -> f64 {
        let of = |side: usize| self.partners[strike.partners[side]].speed_scale(strike.arms[side]);
        of(0) + of(1)
    }

    /// What C_r takes away, at least, J.
    fn loss(&self) -> f64 {
        let closing = |strike: &Strike| self.speed(strike, |partner| &partner.before);
        if let [strike] = self.strikes.as_slice() {
            let normal = strike.contact.normal;
            let per_unit: f64 = [0, 1]
                .map(|side| {
                    let partner = &self.partners[strike.partners[side]];
                    let twist = strike.arms[side].cross(normal);
                    1.0 / partner.mass + twist.dot(partner.inverse_inertia * twist)
                })
                .iter()
                .sum();
            let taken = 0.5 * (1.0 - strike.contact.restitution * strike.contact.restitution);
            let closing = closing(strike);
            return if per_unit > 0.0 { taken * closing * closing / per_unit } else { 0.0 };
        }
        if !self.is_smooth() {
            return 0.0;
        }
        let of = |strike: &Strike| {
            let fraction = strike.impulse.dot(strike.contact.normal);
            -0.5 * fraction * (1.0 - strike.contact.restitution) * closing(strike)
        };
        self.strikes.iter().map(of).sum()
    }

    fn to_world(&self, about: DVec3) -> ToWorld {
        let mut taken = ToWorld::default();
        for strike in &self.strikes {
            for (side, impulse) in [(0, -strike.impulse), (1, strike.impulse)] {
                let (partner, arm) = (&self.partners[strike.partners[side]], strike.arms[side]);
                let twist = arm.cross(impulse);
                let driven = partner.driven();
                taken.angular += twist - partner.inertia * (partner.inverse_inertia * twist);
                taken.work -= driven.angular.dot(twist);
                if partner.mass.is_infinite() {
                    taken.linear += impulse;
                    taken.angular += (strike.point - about - arm).cross(impulse);
                    taken.work -= driven.linear.dot(impulse);
                }
            }
            taken.work_scale += strike.impulse.length() * self.speed_scale(strike);
        }
        taken
    }
}

fn condition((before, after, expected): (f64, f64, f64), error: f64, tolerance: f64) -> Condition<f64> {
    Condition { before, after, expected, error, tolerance, holds: error <= tolerance }
}

fn momentum(before: DVec3, after: DVec3, to_world: DVec3, tolerance: f64) -> Condition<DVec3> {
    let expected = before - to_world;
    let error = (after - expected).length();
    Condition { before, after, expected, error, tolerance, holds: error <= tolerance }
}

/// The largest stretch that a symmetric positive tensor can do is at most the sum of its diagonal.
fn largest(tensor: &DMat3) -> f64 {
    tensor.x_axis.x + tensor.y_axis.y + tensor.z_axis.z
}
