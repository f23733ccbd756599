//! The two elastic tests of SimBenchmark (Hwangbo, Kang and others 2018), with steps of their own.

use crate::closed::solids::{Form, Solid};
use crate::random::Random;
use crate::row::{Figure, Goal::Within, Row};
use crate::scene::{Begins, G, slab, spin, velocity};
use carom::math::DVec3;
use carom::prelude::*;

const RADIUS: f64 = 0.1;
const MASS: f64 = 10.0;
/// Lengths of a step, s.
const FINE: f64 = 1e-3;
const COARSE: f64 = 1e-2;

pub fn rows() -> Vec<Row> {
    let error = |dt: f64, raisim: f64| {
        let what = format!("mean (E − E₀)², dt {dt}; RaiSim {raisim}");
        Figure::new(what, "J²", 0.0, Within(raisim))
    };
    vec![
        Row::new("simbench-bouncing", "49 balls fall 4.9 m and bounce for 20 s, C_r = 1", "E stays", || {
            [FINE, COARSE].map(bouncing).to_vec()
        })
        .figure(error(FINE, 0.0186).peers(["6.6e4", "1.9e4", "184", "75260"]))
        .figure(error(COARSE, 186.0).peers(["4360", "4401", "18810", "7.4e6"])),
        Row::new(
            "simbench-elastic-666",
            "216 balls fall in a cube and bounce for 10 s, C_r = 1",
            "E stays",
            || [FINE, COARSE].map(elastic_666).to_vec(),
        )
        .figure(error(FINE, 8.4).peers(["2.5e6", "1.9e8", "2.5e6", "1.8e8"]))
        .figure(error(COARSE, 5.2e6).peers(["5.7e8", "5.6e6", "2.2e8", "7e8"])),
    ]
}

fn elastic_ball() -> Solid {
    let form = Form::Ball(RADIUS);
    let volume = Solid { form, density: 1.0 }.mass();
    Solid { form, density: MASS / volume }
}

/// Balls of 10 kg over a smooth elastic floor.
fn drop_balls(places: impl Iterator<Item = DVec3>) -> (World, Vec<BodyId>) {
    let mut world = World::new();
    world.add(slab().friction(0.0).restitution(1.0));
    let body = || elastic_ball().body().restitution(1.0).friction(0.0);
    let ids = places.map(|place| world.add(body().placed(place))).collect();
    (world, ids)
}

fn energy(world: &World, ids: &[BodyId]) -> f64 {
    let moment = elastic_ball().moments().x;
    let one = |&id: &BodyId| {
        let speed = velocity(world, id).length_squared();
        let turning = spin(world, id).length_squared();
        0.5 * MASS * speed + 0.5 * moment * turning + MASS * G * world[id].position().y
    };
    ids.iter().map(one).sum()
}

/// Mean over the steps of the square of what the energy is off, J².
fn mean_square(world: &mut World, ids: &[BodyId], (seconds, dt): (f64, f64)) -> f64 {
    let start = energy(world, ids);
    let steps = (seconds / dt).round() as usize;
    let mut sum = 0.0;
    for _ in 0..steps {
        world.step(dt);
        sum += (energy(world, ids) - start).powi(2);
    }
    sum / steps as f64
}

fn bouncing(dt: f64) -> f64 {
    let places = (0..49_u32).map(|k| DVec3::new(f64::from(k / 7), 0.0, f64::from(k % 7)) * 2.0);
    let (mut world, ids) = drop_balls(places.map(|place| place + DVec3::new(-6.0, 5.0, -6.0)));
    mean_square(&mut world, &ids, (20.0, dt))
}

fn elastic_666(dt: f64) -> f64 {
    let mut random = Random(42);
    let places = (0..216_u32).map(|number| {
        let (i, j, k) = (number / 36, number / 6 % 6, number % 6);
        let cell = DVec3::new(f64::from(i), f64::from(k), f64::from(j)) * 0.21;
        let shaken = DVec3::new(random.unit(), random.unit(), random.unit()) * 1e-3;
        cell + shaken + DVec3::new(-0.5, 1.101, -0.5)
    });
    let (mut world, ids) = drop_balls(places);
    mean_square(&mut world, &ids, (10.0, dt))
}
