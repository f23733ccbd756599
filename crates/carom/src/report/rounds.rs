//! Which collisions were resolved at once.

use super::Impact;
use crate::bodies::BodyId;
use crate::conditions::{Partner, Round, STORED, Strike};
use crate::impulse::{Side, Velocity};
use crate::math::DMat3;
use std::collections::{BTreeMap, BTreeSet};

/// The instants of `impacts`, all of them of one step: what struck at one time and hangs together through bodies that impulses
/// move, each as the places in `impacts` of its collisions.
pub fn instants(impacts: &[Impact]) -> Vec<Vec<usize>> {
    let mut group_of: Vec<usize> = (0..impacts.len()).collect();
    let mut last_of: BTreeMap<(u64, BodyId), usize> = BTreeMap::new();
    for (index, impact) in impacts.iter().enumerate() {
        for (body, side) in [(impact.a, &impact.side_a), (impact.b, &impact.side_b)] {
            if side.mass.is_infinite() && side.inverse_inertia == DMat3::ZERO {
                continue;
            }
            if let Some(before) = last_of.insert((impact.time.to_bits(), body), index) {
                let (one, other) = (leader(&mut group_of, before), leader(&mut group_of, index));
                group_of[one.max(other)] = one.min(other);
            }
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for index in 0..impacts.len() {
        groups.entry(leader(&mut group_of, index)).or_default().push(index);
    }
    groups.into_values().collect()
}

fn leader(group_of: &mut [usize], mut index: usize) -> usize {
    while group_of[index] != index {
        group_of[index] = group_of[group_of[index]];
        index = group_of[index];
    }
    index
}

/// Numbers the rounds of each instant from 0 and counts its contacts.
pub(super) fn number(impacts: &mut [Impact]) {
    if impacts.is_sorted_by(|one, next| one.time < next.time) {
        impacts.iter_mut().for_each(|impact| (impact.round, impact.together) = (0, 1));
        return;
    }
    for group in instants(impacts) {
        let mut rounds: Vec<u32> = group.iter().map(|&index| impacts[index].round).collect();
        rounds.sort_unstable();
        rounds.dedup();
        let place = |&index: &usize| {
            let impact = &impacts[index];
            let point = impact.point.to_array().map(f64::to_bits);
            (impact.a, impact.collider_a, impact.b, impact.collider_b, point)
        };
        let together = group.iter().map(place).collect::<BTreeSet<_>>().len() as u32;
        for index in group {
            let impact = &mut impacts[index];
            impact.round = rounds.partition_point(|&round| round < impact.round) as u32;
            impact.together = together;
        }
    }
}

/// The rounds in which `impacts`, all of them of one step, were resolved: each as the places in `impacts` of its collisions.
///
/// What was struck at one instant and hangs together through bodies that an impulse can move is resolved in rounds, one after
/// the other; the collisions of a round are resolved at once, so that each of them tells the same of a body. Rounds of one
/// instant come in their order.
pub fn rounds(impacts: &[Impact]) -> Vec<Vec<usize>> {
    let mut all = Vec::new();
    for mut group in instants(impacts) {
        group.sort_by_key(|&index| impacts[index].round);
        let mut told: BTreeMap<BodyId, (Velocity, Velocity)> = BTreeMap::new();
        let mut current: Vec<usize> = Vec::new();
        for index in group {
            let impact = &impacts[index];
            let motions = [
                (impact.a, (impact.side_a.velocity, impact.after_a)),
                (impact.b, (impact.side_b.velocity, impact.after_b)),
            ];
            let is_next = current.last().is_some_and(|&last| impacts[last].round != impact.round);
            // Two instants may have one date, when it is counted from the start of the simulation.
            let differs =
                motions.iter().any(|(body, motion)| told.get(body).is_some_and(|told| told != motion));
            if is_next || differs {
                all.push(std::mem::take(&mut current));
                told.clear();
            }
            told.extend(motions);
            current.push(index);
        }
        all.push(current);
    }
    all
}

/// The round to which `impacts[index]` belongs, and which of its contacts that is.
///
/// # Panics
/// If there is no such impact.
///
/// # Example
/// A cube lands flat: four corners strike at once.
/// ```
/// use carom::prelude::*;
/// use carom::report::round_of;
/// let mut world = World::new();
/// world.add(Body::fixed().with(Shape::cuboid(100.0, 2.0, 100.0)));
/// world.add(Body::dynamic().at(0.0, 1.6, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).restitution(0.5));
/// for _ in 0..20 {
///     let impacts = world.step(1.0 / 60.0).impacts();
///     for (index, impact) in impacts.iter().enumerate() {
///         let (round, strike) = round_of(impacts, index);
///         assert_eq!(round.strikes.len(), 4);
///         assert!(round.conditions(strike, impact.point).hold());
///     }
/// }
/// ```
pub fn round_of(impacts: &[Impact], index: usize) -> (Round, usize) {
    let own = rounds(impacts).into_iter().find(|round| round.contains(&index)).unwrap_or_default();
    match own.iter().position(|&other| other == index) {
        Some(strike) if own.len() > 1 => (round(own.iter().map(|&index| &impacts[index])), strike),
        _ => (Round::from(&impacts[index].hit()), 0),
    }
}

fn round<'a>(impacts: impl Iterator<Item = &'a Impact>) -> Round {
    let mut round = Round { partners: Vec::new(), strikes: Vec::new(), rounding: STORED };
    let mut partner_of: BTreeMap<BodyId, usize> = BTreeMap::new();
    for impact in impacts {
        let sides = [(impact.a, &impact.side_a, impact.after_a), (impact.b, &impact.side_b, impact.after_b)];
        let partners = sides.map(|(body, side, after)| {
            let Side { mass, inertia, inverse_inertia, velocity, .. } = *side;
            *partner_of.entry(body).or_insert_with(|| {
                round.partners.push(Partner { mass, inertia, inverse_inertia, before: velocity, after });
                round.partners.len() - 1
            })
        });
        round.strikes.push(Strike {
            partners,
            point: impact.point,
            arms: [impact.side_a.arm, impact.side_b.arm],
            contact: impact.contact,
            impulse: impact.impulse(),
        });
    }
    round
}
