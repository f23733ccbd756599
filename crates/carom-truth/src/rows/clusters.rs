//! Crowds of boxes, balls and capsules in free space: what they must keep.

use crate::books::{Audit, Books, Weighed};
use crate::closed::solids::{Form, Solid};
use crate::random::Random;
use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, STEP, floating};
use carom::World;
use carom::math::DVec3;

/// The far point that angular momentum is about, m.
const FAR: DVec3 = DVec3::new(100.0, 200.0, -50.0);

pub fn rows() -> Vec<Row> {
    let mut rows = vec![
        Row::new(
            "gas-mixed",
            "100 balls, boxes and capsules fly into each other for 10 s, C_r = 1, no friction",
            "p, L and E stay",
            || {
                let (audit, _) = gas();
                vec![audit.angular, audit.energy, f64::from(audit.rises)]
            },
        )
        .figure(
            Figure::new("change of L about (100, 200, −50) m, of Σ|L|", "", 0.0, Within(1e-5))
                .peers(["3e-3", "2e-3", "4e-4", "4e-4"]),
        )
        .figure(
            Figure::new("change of energy, of it", "", 0.0, Within(1e-4))
                .peers(["−0.5 %", "−2 %", "−1.4 %", "−3 %"]),
        )
        .figure(
            Figure::new("steps with a rise above 1e-6", "", 0.0, Within(0.0))
                .peers(["35", "29", "13", "229"]),
        ),
    ];
    for restitution in [0.0, 0.5, 1.0] {
        for friction in [0.0, 0.5] {
            rows.push(cluster_row(restitution, friction));
        }
    }
    rows
}

fn cluster_row(restitution: f64, friction: f64) -> Row {
    let what = format!(
        "three random clusters of 60 boxes and balls, 300 steps, C_r = {restitution}, μ = {friction}"
    );
    let elastic = restitution == 1.0 && friction == 0.0;
    let law = if elastic { "p, L and E stay" } else { "p and L stay; E never rises" };
    let row = Row::new(format!("cluster-{restitution}-{friction}"), what, law, move || {
        let audits = [1, 2, 3].map(|seed| cluster(seed, restitution, friction).0);
        let worst = |of: fn(&Audit) -> f64| audits.iter().map(of).fold(0.0, f64::max);
        let mut figures = vec![worst(|a| a.linear), worst(|a| a.angular), worst(|a| a.rise)];
        if elastic {
            figures.push(worst(|a| a.energy.abs()));
        }
        figures
    })
    .figure(Figure::new("change of p, of Σ|p|", "", 0.0, Within(1e-6)))
    .figure(Figure::new("change of L about (100, 200, −50) m, of Σ|L|", "", 0.0, Within(1e-5)))
    .figure(Figure::new("largest rise of energy in a step, of it", "", 0.0, Within(1e-6)));
    if elastic { row.figure(Figure::new("change of energy, of it", "", 0.0, Within(1e-4))) } else { row }
}

/// Bodies in free space, and what they are made of.
struct Crowd {
    world: World,
    members: Vec<Weighed>,
    random: Random,
    restitution: f64,
    friction: f64,
}

impl Crowd {
    fn new(seed: u64, restitution: f64, friction: f64) -> Self {
        Self { world: floating(), members: Vec::new(), random: Random(seed), restitution, friction }
    }

    /// Adds a body of any density, turned and spinning in any way.
    fn throw(&mut self, form: Form, place: DVec3, velocity: DVec3) {
        let random = &mut self.random;
        let solid = Solid { form, density: random.range(500.0, 2000.0) };
        let body = solid.body().restitution(self.restitution).friction(self.friction);
        let body = body.turned(random.rotation()).spun(random.direction() * 3.0);
        let body = body.placed(place).flung(velocity);
        self.members.push(Weighed::add(&mut self.world, &solid, body));
    }

    /// Keeps the books for that many steps; also how many impacts there were.
    fn watch(mut self, steps: usize) -> (Audit, usize) {
        let mut audit = Audit::new(Books::of(&self.world, &self.members, FAR));
        let mut impacts = 0;
        for _ in 0..steps {
            impacts += self.world.step(STEP).impacts().len();
            audit.look(&Books::of(&self.world, &self.members, FAR));
        }
        (audit, impacts)
    }
}

fn gas() -> (Audit, usize) {
    let mut crowd = Crowd::new(99, 1.0, 0.0);
    for number in 0..100_u32 {
        let (i, j, k) = (number / 20, number / 4 % 5, number % 4);
        let random = &mut crowd.random;
        let cell = DVec3::new(f64::from(i) - 2.0, f64::from(j) - 2.0, f64::from(k) - 1.5);
        let place = cell * 2.0 + random.in_cube() * 0.2;
        let velocity = place * -0.7 + random.direction() * 1.5;
        let form = match (i + j + k) % 3 {
            0 => Form::Ball(random.range(0.3, 0.5)),
            1 => Form::Cuboid(random.edges(0.4, 0.9)),
            _ => Form::Capsule { height: 0.6, radius: 0.25 },
        };
        crowd.throw(form, place, velocity);
    }
    crowd.watch(600)
}

/// Boxes and balls, so near each other that most strike several others, thrown at their common middle.
fn cluster(seed: u64, restitution: f64, friction: f64) -> (Audit, usize) {
    let mut crowd = Crowd::new(seed, restitution, friction);
    for number in 0..60_u32 {
        let random = &mut crowd.random;
        let cell = [number % 4, number / 4 % 4, number / 16].map(|k| f64::from(k) - 1.5);
        let place = DVec3::from_array(cell) * 1.1 + random.in_cube() * 0.02;
        let velocity = place * -1.5 + random.direction();
        let form = if number % 2 == 0 {
            Form::Ball(random.range(0.2, 0.5))
        } else {
            Form::Cuboid(random.edges(0.2, 0.6))
        };
        crowd.throw(form, place, velocity);
    }
    crowd.watch(300)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_something_to_keep_books_of() {
        assert!(gas().1 > 200, "{}", gas().1);
        for restitution in [0.0, 0.5, 1.0] {
            let (audit, impacts) = cluster(1, restitution, 0.5);
            assert!(impacts > 200, "C_r = {restitution}: {impacts}");
            assert!(restitution == 1.0 || audit.energy < -0.2, "C_r = {restitution}: {audit:?}");
        }
    }
}
