//! Racks of balls, struck by a cue ball along their axis.

use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, ball, floating, largest, run, slab, velocity};
use carom::math::DVec3;
use carom::prelude::*;

const SPEED: f64 = 10.0;

/// A triangle of touching balls of 1 m.
#[derive(Clone, Copy)]
struct Rack {
    rows: usize,
    /// On a smooth table, with gravity.
    on_table: bool,
}

pub fn rows() -> Vec<Row> {
    let small = Rack { rows: 5, on_table: false };
    let mut first = small.row("rack-15");
    first.figures[0].peers = Some(["0.05", "0.05", "0.025", "0.02"]);
    first.figures[1].peers = Some(["0.61", "0.64", "0.95", "0.75"]);
    vec![
        first,
        Rack { on_table: true, ..small }.row("rack-15-table"),
        Rack { rows: 20, ..small }.row("rack-210"),
    ]
}

impl Rack {
    fn row(self, name: &str) -> Row {
        let count = self.rows * (self.rows + 1) / 2;
        let table = if self.on_table { " on a smooth table" } else { "" };
        let what = format!("a ball strikes a rack of {count} that touch{table}, C_r = 1");
        Row::new(name, what, "mirror symmetry; E and p stay", move || self.measure())
            .figure(Figure::new("largest asymmetry of v, of v₀", "", 0.0, Within(1e-5)))
            .figure(Figure::new("energy, of that at the start", "", 1.0, Within(1e-5)))
            .figure(Figure::new("momentum along and across, off by", "", 0.0, Within(1e-5)))
    }

    /// Places of the balls with, for each, which of them is its mirror image in z.
    fn places(self) -> Vec<(DVec3, usize)> {
        let in_row = |row: usize| {
            let first = row * (row + 1) / 2;
            let place = move |k: usize| {
                let z = k as f64 - 0.5 * row as f64;
                (DVec3::new(row as f64 * 0.75_f64.sqrt(), 0.5, z), first + row - k)
            };
            (0..=row).map(place)
        };
        (0..self.rows).flat_map(in_row).collect()
    }

    fn measure(self) -> Vec<f64> {
        let mut world = if self.on_table { World::new() } else { floating() };
        if self.on_table {
            world.add(slab().friction(0.0).restitution(1.0));
        }
        let places = self.places();
        let smooth = || ball(0.5).restitution(1.0);
        let cue = world.add(smooth().at(-3.137, 0.5, 0.0).flung(DVec3::X * SPEED));
        let ids: Vec<BodyId> = places.iter().map(|&(place, _)| world.add(smooth().placed(place))).collect();
        run(&mut world, 1.0);

        let cue = velocity(&world, cue) / SPEED;
        let velocities: Vec<DVec3> = ids.iter().map(|&id| velocity(&world, id) / SPEED).collect();
        let mirrored = |v: DVec3| DVec3::new(v.x, v.y, -v.z);
        let pairs = velocities.iter().zip(&places);
        let asymmetry = pairs.map(|(&v, &(_, image))| (v - mirrored(velocities[image])).length());
        let asymmetry = largest(asymmetry.chain([cue.z.abs()]));
        let all = || velocities.iter().copied().chain([cue]);
        let energy: f64 = all().map(DVec3::length_squared).sum();
        let momentum: DVec3 = all().sum();
        vec![asymmetry, energy, (momentum - DVec3::X).length()]
    }
}
