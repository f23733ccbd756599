//! The end of a step: tidy up, and tell.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide;
use crate::impacts::time_of_impact::RestLaw;
use crate::report::Overlap;
use crate::world::World;

/// Takes out of the simulation what is no longer finite, where it was last seen whole.
pub(crate) fn quarantine(world: &mut World) {
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

/// Finds what overlaps a sensor.
pub(crate) fn sense(world: &mut World) {
    for pair in world.pairs.iter().filter(|pair| pair.sensor) {
        let (a, b) = pair.colliders;
        let (Some(a), Some(b)) = (world.bodies.collider(a), world.bodies.collider(b)) else { continue };
        let origin = world.bodies.center_pose(a).position;
        let pose = |collider| {
            let mut pose = world.bodies.center_pose(collider);
            pose.position -= origin;
            pose.then_local(&collider.local)
        };
        if collide::separation(&a.shape, &pose(a), &b.shape, &pose(b)) > 0.0 {
            continue;
        }
        let (sensor, visitor) = if a.sensor { (a, b) } else { (b, a) };
        let ids = (world.bodies.id_of(sensor.slot), world.bodies.id_of(visitor.slot));
        if let (Some(sensor_body), Some(visitor_body)) = ids {
            world.report.overlaps.push(Overlap {
                sensor: sensor_body,
                sensor_collider: sensor.index,
                visitor: visitor_body,
                visitor_collider: visitor.index,
            });
        }
    }
}

/// How many pairs of bodies touch.
pub(crate) fn count_contacts(world: &World, law: RestLaw) -> usize {
    let slot = |key| world.bodies.collider(key).map(|collider| collider.slot);
    let touching = world.rest.touching(&world.pairs, law);
    let mut pairs: Vec<_> = touching.map(|pair| (slot(pair.colliders.0), slot(pair.colliders.1))).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs.len()
}

/// Writes what users read.
pub(crate) fn publish(bodies: &mut Bodies) {
    for row in bodies.rows() {
        bodies.publish(row);
        bodies.forces[row] = Default::default();
    }
}
