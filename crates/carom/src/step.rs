//! One step, on one page.
//!
//! ```text
//! begin      clocks to zero; gravity and forces become each body's influence
//! find       which colliders could touch while their bodies fly              step/broad_phase.rs, pairs.rs
//! substep    twice, unless the settings say otherwise
//!     hold       what rests: contacts found, impulses solved, paths given    step/rest.rs → solver/
//!     happen     touch after touch in time                                   step/events.rs
//!                    when do they touch?         impacts/time_of_impact.rs
//!                    five steps at that instant  impacts/strike.rs → impulse.rs
//! fly        everyone from the last touch to the end of the step             flight.rs
//! finish     overlaps out, states published, the report                      step/finish.rs
//!            the ledger, where one is kept                                   ledger.rs
//! ```
//!
//! How long each of these takes, [`profile`] tells whoever asks for it.

pub(crate) mod broad_phase;
pub(crate) mod events;
pub(crate) mod finish;
pub(crate) mod motion;
pub(crate) mod pairs;
pub(crate) mod pool;
pub mod profile;
pub(crate) mod rest;

use crate::impacts::time_of_impact::RestLaw;
use crate::ledger::impacts as collisions;
use crate::world::World;
use events::Events;
use profile::Phase;
use rest::Span;

/// Lets `time` seconds pass in the world.
pub(crate) fn step(world: &mut World, time: f64) {
    let _step = profile::phase(Phase::Other);
    let substeps = world.settings.substeps.max(1);
    let law = RestLaw { gravity: world.settings.gravity, substep: time / f64::from(substeps), step: time };
    let start = world.time;
    world.report = Default::default();
    world.ledger.open(&mut world.bodies, law.gravity);

    motion::begin_flight(&mut world.bodies, law.gravity, time);
    world.broad_phase.find_pairs(&world.bodies, time);
    let parted = world.pairs.update(&world.bodies, &mut world.broad_phase);
    world.rest.begin_step(&mut world.bodies, (&mut world.pairs, parted), law);

    let nearby = (&mut world.pairs, &mut world.rest);
    let mut events = Events::new(&mut world.bodies, &mut world.broad_phase, nearby, &mut world.agenda, law);
    for number in 0..substeps {
        let at = |number: u32| time * f64::from(number) / f64::from(substeps);
        events.substep(Span { from: at(number), until: at(number + 1) });
    }
    let impacts = events.finish();
    motion::finish_flight(&mut world.bodies, time, &world.pool);

    let _finish = profile::phase(Phase::Finish);
    world.rest.settle(&mut world.bodies);
    collisions::book(&mut world.bodies, &impacts);

    world.rest.push_out(&mut world.bodies, law);
    finish::quarantine(world);
    finish::sense(world);
    let look = finish::publish(&mut world.bodies);
    world.report.contacts = world.rest.count_touching(&world.bodies, &world.pairs, law);

    world.time = start + time;
    world.ledger.close(&mut world.bodies, look, (time, world.time));
    world.report.record(impacts, start);
}
