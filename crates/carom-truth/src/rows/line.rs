//! Newton's cradles: equal balls on a line.

use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, ball, floating, run, slab, velocity};
use carom::math::DVec3;
use carom::prelude::*;

/// m/s
const SPEED: f64 = 2.0;
/// Between the strikers and the others at the start, m.
const RUN_UP: f64 = 0.6432;

/// Some equal balls of 1 m on a line, the first of which strike the others.
#[derive(Clone, Copy)]
struct Cradle {
    balls: usize,
    strikers: usize,
    /// Between neighbours, m.
    gap: f64,
    /// On a smooth table, with gravity.
    on_table: bool,
}

pub fn rows() -> Vec<Row> {
    let five = |strikers| Cradle { balls: 5, strikers, gap: 0.0, on_table: false };
    let hundred = Cradle { balls: 100, ..five(1) };
    let mut rows = Vec::new();
    for strikers in [1, 2, 3] {
        let cradle = five(strikers);
        let mut row = cradle.row(&format!("cradle-{strikers}"));
        if strikers == 1 {
            row.figures[0].peers = Some(["0.52", "0.63", "0.60", "0.79"]);
            row.figures[1].peers = Some(["0.61", "0.65", "0.98", "0.20"]);
        }
        rows.push(row);
        rows.push(Cradle { gap: 1e-3, ..cradle }.row(&format!("cradle-{strikers}-gaps")));
        rows.push(Cradle { on_table: true, ..cradle }.row(&format!("cradle-{strikers}-table")));
    }
    rows.push(hundred.row("cradle-100"));
    rows.push(Cradle { gap: 1e-3, ..hundred }.row("cradle-100-gaps"));
    rows.push(Cradle { on_table: true, ..hundred }.row("cradle-100-table"));
    rows
}

impl Cradle {
    fn row(self, name: &str) -> Row {
        let Self { balls, strikers, .. } = self;
        let gaps = if self.gap > 0.0 { "with gaps of 1 mm" } else { "touching" };
        let table = if self.on_table { ", on a smooth table" } else { "" };
        let what = format!("Newton's cradle, {strikers} of {balls} strike, {gaps}{table}");
        Row::new(name, what, "as many leave as came, as fast", move || self.measure())
            .figure(Figure::new("worst v off by, of v₀", "", 0.0, Within(1e-5)))
            .figure(Figure::new("energy, of that at the start", "", 1.0, Within(1e-5)))
    }

    fn measure(self) -> Vec<f64> {
        let mut world = if self.on_table { World::new() } else { floating() };
        if self.on_table {
            world.add(slab().friction(0.0).restitution(1.0));
        }
        let ids: Vec<BodyId> = (0..self.balls)
            .map(|k| {
                let strikes = k < self.strikers;
                let x = k as f64 * (1.0 + self.gap) - if strikes { RUN_UP } else { 0.0 };
                let speed = if strikes { SPEED } else { 0.0 };
                world.add(ball(0.5).restitution(1.0).at(x, 0.5, 0.0).flung(DVec3::X * speed))
            })
            .collect();
        run(&mut world, 1.0);
        let velocities: Vec<DVec3> = ids.iter().map(|&id| velocity(&world, id)).collect();
        let stay = self.balls - self.strikers;
        let off = velocities.iter().enumerate().map(|(k, &velocity)| {
            let truth = if k < stay { DVec3::ZERO } else { DVec3::X * SPEED };
            (velocity - truth).length() / SPEED
        });
        let energy: f64 = velocities.iter().map(|velocity| velocity.length_squared()).sum();
        vec![off.fold(0.0, f64::max), energy / (self.strikers as f64 * SPEED * SPEED)]
    }
}
