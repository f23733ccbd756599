//! The end of a step: tidy up, and tell.

use crate::bodies::{Bodies, WORLD_ROW};
use crate::collide;
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::report::Overlap;
use crate::step::broad_phase::ColliderPair;
use crate::step::rest::{Island, Resting, push_out as push_island_out};
use crate::world::World;
use std::collections::{BTreeMap, BTreeSet};

/// Forgets resting pairs that have parted.
pub(crate) fn part(bodies: &Bodies, resting: &mut Resting, law: RestLaw, time: f64) {
    resting.retain(|pair| {
        let (Some(a), Some(b)) = (bodies.collider(pair.0), bodies.collider(pair.1)) else { return false };
        Approach::new(bodies, a, b, law).separation(time) <= law.contact_margin()
    });
}

/// Pushes resting bodies out of each other, island by island.
pub(crate) fn push_out(bodies: &mut Bodies, resting: &Resting, law: RestLaw, time: f64) {
    for island in islands(bodies, resting) {
        push_island_out(bodies, &island, law, time);
    }
}

/// All resting pairs, grouped by what they connect: each body that can be moved belongs to one island.
fn islands(bodies: &Bodies, resting: &Resting) -> Vec<Island> {
    let mut root: BTreeMap<usize, usize> = BTreeMap::new();
    fn find(root: &mut BTreeMap<usize, usize>, row: usize) -> usize {
        let mut at = row;
        while let Some(&up) = root.get(&at).filter(|&&up| up != at) {
            at = up;
        }
        root.insert(row, at);
        at
    }
    let rows_of = |pair: ColliderPair| -> Vec<usize> {
        let rows = [bodies.collider(pair.0), bodies.collider(pair.1)];
        rows.into_iter().flatten().map(|collider| collider.row).filter(|&row| row != WORLD_ROW).collect()
    };
    let movable = |row: &usize| bodies.constants[*row].is_movable();
    for pair in resting.iter() {
        let rows: Vec<usize> = rows_of(pair).into_iter().filter(movable).collect();
        if let [first, rest @ ..] = rows.as_slice() {
            let first = find(&mut root, *first);
            for &row in rest {
                let other = find(&mut root, row);
                root.insert(first.max(other), first.min(other));
            }
        }
    }
    let mut islands: BTreeMap<usize, Island> = BTreeMap::new();
    for pair in resting.iter() {
        let rows = rows_of(pair);
        let Some(&row) = rows.iter().find(|row| movable(row)) else { continue };
        let island = islands
            .entry(find(&mut root, row))
            .or_insert_with(|| Island { rows: Vec::new(), pairs: Vec::new() });
        island.pairs.push(pair);
        island.rows.extend(rows);
    }
    let mut islands: Vec<Island> = islands.into_values().collect();
    for island in &mut islands {
        island.rows.sort_unstable();
        island.rows.dedup();
    }
    islands
}

/// Takes out of the simulation what is no longer finite, where it was last seen whole.
pub(crate) fn quarantine(world: &mut World) {
    let lost: Vec<u32> = world
        .bodies
        .rows()
        .filter(|&row| !world.bodies.states[row].is_finite())
        .map(|row| world.bodies.slot_of_row[row])
        .collect();
    for slot in lost {
        for key in world.bodies.quarantine(slot) {
            world.forget_collider(key);
        }
        world.report.quarantined.extend(world.bodies.id_of(slot));
    }
}

/// Finds what overlaps a sensor.
pub(crate) fn sense(world: &mut World, pairs: &[ColliderPair]) {
    for &(a, b) in pairs {
        let (Some(a), Some(b)) = (world.bodies.collider(a), world.bodies.collider(b)) else { continue };
        if !a.sensor && !b.sensor {
            continue;
        }
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

/// How many pairs of bodies rest on each other.
pub(crate) fn count_contacts(bodies: &Bodies, resting: &Resting) -> usize {
    let slot = |key| bodies.collider(key).map(|collider| collider.slot);
    let pairs: BTreeSet<_> = resting.iter().map(|(a, b)| (slot(a), slot(b))).collect();
    pairs.len()
}

/// Writes what users read.
pub(crate) fn publish(bodies: &mut Bodies) {
    for row in bodies.rows() {
        bodies.publish(row);
        bodies.forces[row] = Default::default();
    }
}
