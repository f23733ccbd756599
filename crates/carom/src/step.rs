//! One step, on one page.
//!
//! ```text
//! begin      clocks to zero; gravity and forces become each body's influence
//! find       which colliders could touch while their bodies fly          step/broad_phase.rs
//! happen     touch after touch in time: impacts by the seed, the rest settles
//!                 when do they touch?        impacts/time_of_impact.rs
//!                 five steps at that instant impacts/strike.rs → impulse.rs
//!                 what holds resting bodies  step/rest.rs → solver/contact.rs
//! fly        everyone from the last touch to the end of the step         flight.rs
//! finish     overlaps out, pairs that parted forgotten, states published, the report
//! ```

pub(crate) mod broad_phase;
pub(crate) mod events;
pub(crate) mod finish;
pub(crate) mod motion;
pub(crate) mod rest;

use crate::impacts::time_of_impact::RestLaw;
use crate::world::World;
use events::Events;

/// Lets `time` seconds pass in the world.
pub(crate) fn step(world: &mut World, time: f64) {
    let law = RestLaw {
        gravity: world.settings.gravity,
        substep: time / f64::from(world.settings.substeps.max(1)),
    };
    let start = world.time;
    world.report = Default::default();

    motion::begin_flight(&mut world.bodies, law.gravity);
    let pairs = world.broad_phase.find_pairs(&world.bodies, time);
    world.resting.keep_only(&pairs);
    let events = Events::new(&mut world.bodies, &world.broad_phase, &mut world.resting, law, time);
    let impacts = events.run(&pairs);
    motion::finish_flight(&mut world.bodies, time);

    finish::part(&world.bodies, &mut world.resting, law, time);
    finish::push_out(&mut world.bodies, &world.resting, law, time);
    finish::quarantine(world);
    finish::sense(world, &pairs);
    finish::publish(&mut world.bodies);
    world.report.contacts = finish::count_contacts(&world.bodies, &world.resting);

    world.time = start + time;
    world.report.record(impacts, start);
}
