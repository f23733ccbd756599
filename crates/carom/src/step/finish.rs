//! The end of a step: tidy up, and tell.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::flight::RigidState;
use crate::ledger::journal::Journal;
use crate::ledger::look::Look;
use crate::report::Overlap;
use crate::world::World;

/// Takes out of the simulation what is no longer finite, where it was last seen whole.
pub(crate) fn quarantine(world: &mut World) {
    if world.bodies.states.iter().all(RigidState::is_finite) {
        return;
    }
    let lost: Vec<u32> = world
        .bodies
        .rows()
        .filter(|&row| !world.bodies.states[row].is_finite())
        .map(|row| world.bodies.slot_of_row[row])
        .collect();
    for slot in lost {
        let row = world.bodies.record(slot).map_or(WORLD_ROW, |record| record.row);
        let colliders = world.bodies.quarantine(slot);
        world.forget(&colliders, row);
        world.report.quarantined.extend(world.bodies.id_of(slot));
    }
}

/// Tells what has been in a sensor.
pub(crate) fn sense(world: &mut World) {
    let bodies = &world.bodies;
    let sensed = world.pairs.sensed().filter_map(|pair| {
        let (a, b) = (bodies.collider(pair.colliders.0)?, bodies.collider(pair.colliders.1)?);
        let (sensor, visitor) = if a.sensor { (a, b) } else { (b, a) };
        Some(Overlap {
            sensor: bodies.id_of(sensor.slot)?,
            sensor_collider: sensor.index,
            visitor: bodies.id_of(visitor.slot)?,
            visitor_collider: visitor.index,
        })
    });
    world.report.overlaps.extend(sensed);
    let order = |it: &Overlap| (it.sensor, it.sensor_collider, it.visitor, it.visitor_collider);
    world.report.overlaps.sort_unstable_by_key(order);
}

/// Writes what users read; and looks at what bodies have on the way, if there is a ledger.
pub(crate) fn publish(bodies: &mut Bodies) -> Option<Look> {
    let mut look = bodies.journal.as_deref_mut().map(Journal::begin_look);
    for row in bodies.rows() {
        let angular_velocity = bodies.publish(row);
        if let Some(look) = &mut look {
            look.at(&bodies.states[row], &bodies.constants[row], angular_velocity);
        }
    }
    bodies.forces.clear();
    look
}
