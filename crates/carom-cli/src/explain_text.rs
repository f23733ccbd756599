//! A collision for a reader who has the lecture beside it.

use crate::explain::Collision;
use crate::explain_table::{LETTERS, headline, scalar_condition, vector_condition, velocities};
use crate::simulate::name_of;
use crate::text::{COLUMN, counted, number, point, scalar_row, vector_row};
use carom::World;
use carom::conditions::{Conditions, Strike};
use carom::impulse::{Resolution, Side, Velocity};
use carom::report::{Feature, Impact};
use std::fmt::Write;

/// Everything that the sections below tell about.
struct Story<'a> {
    names: [&'a str; 2],
    world: &'a World,
    collision: &'a Collision,
    impact: &'a Impact,
    resolution: Resolution,
    conditions: &'a Conditions,
}

/// How many other collisions of the instant are named.
const LISTED: usize = 8;

/// The whole story of a collision in `world`.
pub fn explanation(world: &World, collision: &Collision, conditions: &Conditions) -> String {
    let impact = &collision.impact;
    let names = [name_of(world, impact.a), name_of(world, impact.b)];
    let story = Story { names, world, collision, impact, resolution: impact.resolve(), conditions };
    let mut text = story.heading();
    for section in [
        story.inputs(),
        story.steps_one_to_three(),
        story.steps_four_and_five(),
        story.friction(),
        story.outcome(),
        story.three_conditions(),
        story.energy_split(),
    ] {
        text.push('\n');
        text.push_str(&section);
    }
    text
}

impl Story<'_> {
    fn sides(&self) -> [&Side; 2] {
        [&self.impact.side_a, &self.impact.side_b]
    }

    fn after(&self) -> [&Velocity; 2] {
        [&self.impact.after_a, &self.impact.after_b]
    }

    /// K: what the unit impulse does to the speed along the normal.
    fn speed_per_impulse(&self) -> f64 {
        let change = self.resolution.response_b.at_point - self.resolution.response_a.at_point;
        change.dot(self.impact.contact.normal)
    }

    fn heading(&self) -> String {
        let impact = self.impact;
        let title = format!(
            "COLLISION {}: {} (a) and {} (b) at t = {} s",
            self.collision.index,
            self.names[0],
            self.names[1],
            number(impact.time)
        );
        let mut text = format!("{title}\n{}\n", "=".repeat(title.chars().count()));
        let (a, b) = (feature(impact.feature_a), feature(impact.feature_b));
        let _ = writeln!(text, "{a} of a meets {b} of b at {} m", point(impact.point));
        let _ = writeln!(text, "normal n = {}, from a to b", point(impact.contact.normal));
        text += &self.partners();
        text
    }

    /// What else was struck at this instant.
    fn partners(&self) -> String {
        let impact = self.impact;
        if self.collision.others.is_empty() {
            return String::new();
        }
        let mut text = format!(
            "\nAT THE SAME INSTANT: {}, this one in round {}\n",
            counted(u64::from(impact.together), "contact"),
            impact.round
        );
        for (index, other) in self.collision.others.iter().take(LISTED) {
            let names = [other.a, other.b].map(|id| shortened(name_of(self.world, id), 20));
            let _ = writeln!(
                text,
                "  round {}: collision {index}, {} and {}, f = {} N·s",
                other.round,
                names[0],
                names[1],
                number(other.fraction)
            );
        }
        if self.collision.others.len() > LISTED {
            let _ = writeln!(text, "  and {} more", self.collision.others.len() - LISTED);
        }
        if self.collision.is_among_others() {
            text += "  Contacts of one round are resolved together. The formula below is that of this\n  \
                     contact alone; then follows what all of them together made of it.\n";
        } else {
            text += "  In its round it was alone, so that the formula is all there is to it.\n";
        }
        text
    }

    fn inputs(&self) -> String {
        let contact = &self.impact.contact;
        let mut text = headline("INPUTS", true);
        for (side, letter) in self.sides().into_iter().zip(LETTERS) {
            text += &scalar_row("mass", &format!("m_{letter}"), side.mass, "kg");
        }
        for (side, letter) in self.sides().into_iter().zip(LETTERS) {
            let rows = side.inverse_inertia.transpose();
            text += &vector_row("inverse inertia", &format!("I⁻¹_{letter}"), rows.x_axis, "1/(kg·m²)");
            text += &vector_row("", "", rows.y_axis, "");
            text += &vector_row("", "", rows.z_axis, "");
        }
        for (side, letter) in self.sides().into_iter().zip(LETTERS) {
            text += &vector_row("lever arm", &format!("r_{letter}"), side.arm, "m");
        }
        text += &velocities("before", self.sides().map(|side| &side.velocity));
        text += &scalar_row("restitution", "C_r", contact.restitution, "");
        text += &scalar_row("static friction", "μ_s", contact.static_friction, "");
        text += &scalar_row("dynamic friction", "μ_d", contact.dynamic_friction, "");
        text
    }

    fn steps_one_to_three(&self) -> String {
        let Resolution { response_a, response_b, .. } = &self.resolution;
        let mut text =
            headline("STEP 1  A first, wrong impulse: 1 N·s along n on b, its opposite on a", false);
        text += &headline("STEP 2  What it would change: Δv_l = ±n/m, Δv_r = ±I⁻¹(r × n)", false);
        for (response, letter) in [response_a, response_b].into_iter().zip(LETTERS) {
            text += &vector_row("linear", &format!("Δv_l,{letter}"), response.linear, "1/kg");
            text += &vector_row("angular", &format!("Δv_r,{letter}"), response.angular, "1/(kg·m)");
        }
        text += &headline("STEP 3  What that is at the collision point: Δv = Δv_l + Δv_r × r", false);
        for (response, letter) in [response_a, response_b].into_iter().zip(LETTERS) {
            text += &vector_row("at the point", &format!("Δv_{letter}"), response.at_point, "1/kg");
        }
        text
    }

    fn steps_four_and_five(&self) -> String {
        let restitution = self.impact.contact.restitution;
        let closing = self.resolution.closing_speed;
        let per_impulse = self.speed_per_impulse();
        let wanted = -restitution * closing + 0.0;
        let fraction = if per_impulse > 0.0 { -(1.0 + restitution) * closing / per_impulse } else { 0.0 };
        let mut text =
            headline("STEP 4  All this is linear: some multiple f gives the speed that is wanted", false);
        let _ = writeln!(
            text,
            "  closing     v_c = (v_b − v_a)·n = {} m/s, speed of the points",
            number(closing)
        );
        let _ = writeln!(
            text,
            "  wanted      v_s = −C_r·v_c = −{} · ({}) = {} m/s",
            number(restitution),
            number(closing),
            number(wanted)
        );
        let _ = writeln!(
            text,
            "  so that     v_s = v_c + f·(Δv_b − Δv_a)·n\n              with (Δv_b − Δv_a)·n = {} 1/kg",
            number(per_impulse)
        );
        text += &headline("STEP 5  Solve for f, and apply v_l += f·Δv_l, v_r += f·Δv_r", false);
        let _ = writeln!(text, "  f = −(1 + C_r)·v_c / ((Δv_b − Δv_a)·n)");
        let _ = writeln!(
            text,
            "    = −(1 + {}) · ({}) / {} = {} N·s",
            number(restitution),
            number(closing),
            number(per_impulse),
            number(fraction)
        );
        if self.collision.is_among_others() {
            let _ = writeln!(
                text,
                "TOGETHER  Each contact parts with v_s ≥ −C_r·v_c; f is less where others push\n          \
                 too, more where they push against it\n  f = {} N·s here, out of {} contacts in this round",
                number(self.impact.fraction),
                self.collision.round.strikes.len()
            );
        }
        text
    }

    fn friction(&self) -> String {
        let contact = &self.impact.contact;
        let Impact { friction_impulse, fraction, sticks, .. } = *self.impact;
        if contact.static_friction == 0.0 && contact.dynamic_friction == 0.0 {
            return "FRICTION  none: both coefficients are 0\n".to_owned();
        }
        let strength = friction_impulse.length();
        let verdict = if strength == 0.0 {
            "nothing slides, so it does nothing"
        } else if sticks {
            "it sticks: the points leave without sliding"
        } else {
            "it slides"
        };
        let mut text = headline(&format!("FRICTION  {verdict}"), false);
        if strength > 0.0 {
            text += &vector_row("impulse on b", "j_t", friction_impulse, "N·s");
            let (name, limit) = if sticks {
                ("μ_s", contact.static_friction * fraction)
            } else {
                ("μ_d", contact.dynamic_friction * fraction)
            };
            let _ = writeln!(
                text,
                "  |j_t| = {} N·s of at most {name}·f = {} N·s",
                number(strength),
                number(limit)
            );
        }
        let _ =
            writeln!(text, "  all of the impulse along n, friction counted in: f = {} N·s", number(fraction));
        text
    }

    fn outcome(&self) -> String {
        headline("OUTCOME", true) + &velocities("after", self.after())
    }

    fn three_conditions(&self) -> String {
        let conditions = self.conditions;
        let mut text = format!(
            "{:<17}{:>COLUMN$}{:>COLUMN$}{:>COLUMN$}{:>10}{:>12}\n",
            "THREE CONDITIONS", "before", "after", "expected", "error", "tolerance"
        );
        text += &scalar_condition("speed      m/s", &conditions.separating_speed);
        text += &vector_condition("momentum   N·s", &conditions.linear_momentum);
        text += &vector_condition("ang.mom. N·m·s", &conditions.angular_momentum);
        text += &scalar_condition("energy       J", &conditions.energy);
        if self.collision.is_among_others() {
            let bodies = self.collision.round.partners.len();
            let _ = writeln!(
                text,
                "  The speed that is expected is the least. Momentum and energy are those of\n  \
                 all {bodies} bodies of the round."
            );
        }
        let is_rough =
            |strike: &Strike| strike.contact.static_friction > 0.0 || strike.contact.dynamic_friction > 0.0;
        if self.collision.round.strikes.iter().any(is_rough) {
            text += "  With friction the energy that is expected is an upper bound.\n";
        }
        let _ = writeln!(text, "  Angular momentum is about {} m.", point(conditions.reference_point));
        text += &self.went_to_the_world();
        text
    }

    fn went_to_the_world(&self) -> String {
        let own = self.sides().into_iter().zip(self.names);
        let mut immovable: Vec<&str> = own
            .filter(|(side, _)| side.mass.is_infinite() || has_infinite_inertia(side))
            .map(|(_, name)| name)
            .collect();
        let round = self.collision.others.iter().map(|(_, other)| other);
        for other in round.filter(|other| other.round == self.impact.round) {
            for (side, id) in [(&other.side_a, other.a), (&other.side_b, other.b)] {
                if side.mass.is_infinite() || has_infinite_inertia(side) {
                    immovable.push(name_of(self.world, id));
                }
            }
        }
        immovable.sort_unstable();
        immovable.dedup();
        if immovable.is_empty() {
            return String::new();
        }
        let mut text =
            format!("  What {} took, since nothing moves it:\n", shortened(&immovable.join(" and "), 44));
        text += &vector_row("momentum", "", self.conditions.linear_to_world, "N·s");
        text += &vector_row("angular momentum", "", self.conditions.angular_to_world, "N·m·s");
        text
    }

    fn energy_split(&self) -> String {
        let mut text = format!(
            "{:<26}{:>COLUMN$}{:>COLUMN$}{:>COLUMN$}\n",
            "ENERGY in J", "linear", "rotational", "together"
        );
        let all = self.sides().into_iter().zip(self.after()).zip(self.names);
        for ((side, after), name) in all {
            if side.mass.is_infinite() && side.inverse_inertia == carom::math::DMat3::ZERO {
                let _ = writeln!(text, "  {} has no part in it", shortened(name, 40));
                continue;
            }
            for (when, velocity) in [("before", &side.velocity), ("after", after)] {
                let linear = if side.mass.is_finite() {
                    0.5 * side.mass * velocity.linear.length_squared()
                } else {
                    0.0
                };
                let rotational = 0.5 * velocity.angular.dot(side.inertia * velocity.angular);
                let _ = writeln!(
                    text,
                    "  {:<16}{when:<8}{:>COLUMN$}{:>COLUMN$}{:>COLUMN$}",
                    shortened(name, 15),
                    number(linear),
                    number(rotational),
                    number(linear + rotational)
                );
            }
        }
        let restitution = self.impact.contact.restitution;
        let (closing, per_impulse) = (self.resolution.closing_speed, self.speed_per_impulse());
        if per_impulse > 0.0 && !self.collision.is_among_others() {
            let loss = 0.5 * (1.0 - restitution * restitution) * closing * closing / per_impulse;
            let _ = writeln!(text, "  C_r takes ½·(1 − C_r²)·v_c² / ((Δv_b − Δv_a)·n) = {} J", number(loss));
        }
        text
    }
}

fn feature(feature: Feature) -> String {
    match feature {
        Feature::Surface => "the surface".to_owned(),
        Feature::Vertex(number) => format!("corner {number}"),
        Feature::Edge(number) => format!("edge {number}"),
        Feature::Face(number) => format!("face {number}"),
    }
}

fn has_infinite_inertia(side: &Side) -> bool {
    let inertia = &side.inverse_inertia;
    inertia.determinant() == 0.0
}

/// `text`, cut where it is longer than `width`.
fn shortened(text: &str, width: usize) -> String {
    match text.char_indices().nth(width) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}
