//! Pairs against a search of all colliders, while bodies fly, come, go and are meddled with.

use super::watch::merge;
use super::{Entry, Neighbor, Pair, Pairs};
use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::collide::separation;
use crate::filter::{Accepts, Filter, Groups};
use crate::impacts::time_of_impact::{Approach, RestLaw};
use crate::math::DVec3;
use crate::solver::tests::Random;
use crate::step::motion::begin_flight;
use crate::{Body, BodyId, Collider, Settings, Shape, World};

const STEP: f64 = 1.0 / 60.0;

impl Pairs {
    /// Panics unless all tables about pairs agree.
    fn validate(&self, bodies: &Bodies) {
        let mut listed = vec![0; self.list.len()];
        for (row, entries) in self.of_row.iter().enumerate() {
            let colliders = |it: &Neighbor| self[it.index as usize].colliders;
            assert!(entries.is_sorted_by(|a, b| colliders(a) < colliders(b)), "pairs of {row} in order");
            for it in entries {
                let pair = &self[it.index as usize];
                assert!(pair.rows().contains(&row) && pair.has(it.other), "{:?} of {row}", colliders(it));
                assert_ne!(bodies.collider(it.other).expect("it is there").row, row, "{it:?} of {row}");
                listed[it.index as usize] += 1;
            }
        }
        for (index, pair) in self.list.iter().enumerate() {
            let rows = pair.iter().flat_map(|pair| pair.rows()).filter(|&row| row != WORLD_ROW).count();
            assert_eq!(listed[index], rows, "listed by its bodies");
            let Some(pair) = pair else { continue };
            let entry = Entry { colliders: pair.colliders, index: index as u32 };
            let is_listed = self.watch.has(entry);
            assert_eq!(pair.is_watched, is_listed, "{:?} is watched", pair.colliders);
            face(bodies, pair);
            if pair.rests {
                assert!(pair.is_watched || pair.is_pressed, "{:?} rests and is not watched", pair.colliders);
            } else if !pair.is_watched {
                let apart = gap(bodies, pair.colliders);
                assert!(apart > self.watch.margin(), "{:?}: {apart} m apart and not watched", pair.colliders);
            }
        }
    }
}

/// Panics if the direction in which a pair was apart promises more than its bodies' paths keep.
fn face(bodies: &Bodies, pair: &Pair) {
    let law = RestLaw { gravity: DVec3::ZERO, substep: 0.5 * STEP, step: STEP };
    let approach = Approach::of(bodies, pair.colliders, law).expect("a pair's colliders are there");
    let [now, least] = pair.least_facing(bodies, (0.0, STEP));
    // Two boxes may be further apart than the widest gap along their axes.
    let are_boxes = approach.colliders().iter().all(|it| matches!(it.shape, Shape::Cuboid { .. }));
    for (part, bound) in [(0.0, now), (0.25, least), (0.5, least), (0.75, least), (1.0, least)] {
        let apart = approach.separation(part * STEP);
        let holds = if are_boxes { bound <= 1e-8 || apart > 0.0 } else { bound <= apart + 1e-8 };
        assert!(holds, "{:?}: {apart} m apart after {part} of a step, not {bound}", pair.colliders);
    }
}

fn gap(bodies: &Bodies, (a, b): (u32, u32)) -> f64 {
    let [a, b] = [a, b].map(|key| bodies.collider(key).expect("a pair's colliders are there"));
    let pose = |it: &ColliderRow| bodies.center_pose(it).then_local(&it.local);
    separation(&a.shape, &pose(a), &b.shape, &pose(b))
}

/// What a step begins with.
fn look(world: &mut World) {
    begin_flight(&mut world.bodies, world.settings.gravity, STEP);
    world.broad_phase.find_pairs(&world.bodies, STEP);
    let parted = world.pairs.update(&world.bodies, &mut world.broad_phase);
    let law = RestLaw { gravity: world.settings.gravity, substep: 0.5 * STEP, step: STEP };
    world.rest.begin_step(&mut world.bodies, (&mut world.pairs, parted), law);
    world.pairs.begin_watch(&world.bodies, (STEP, 1e-3));
}

/// Panics unless all colliders whose boxes meet are pairs, and all that overlap.
fn validate(world: &World) {
    let bodies = &world.bodies;
    world.pairs.validate(bodies);
    let colliders: Vec<(u32, &ColliderRow)> =
        (0..).map_while(|key| (key < 400).then(|| Some((key, bodies.collider(key)?)))).flatten().collect();
    for (number, &(key, one)) in colliders.iter().enumerate() {
        let outline = bodies.outline(key);
        assert_eq!((outline.row as usize, outline.reach), (one.row, one.reach));
        for &(other_key, other) in &colliders[..number] {
            let movable = |it: &ColliderRow| bodies.constants[it.row].is_movable();
            let fixed = one.row == WORLD_ROW && other.row == WORLD_ROW;
            let sensors = usize::from(one.sensor) + usize::from(other.sensor);
            let meet = match sensors {
                0 => movable(one) || movable(other),
                _ => sensors == 1 && !fixed,
            };
            if one.slot == other.slot || !meet || !one.allows(other) {
                continue;
            }
            let colliders = if one.slot < other.slot { (key, other_key) } else { (other_key, key) };
            let is_known = world.pairs.iter().any(|pair| pair.colliders == colliders);
            let must = world.broad_phase.are_near(bodies, colliders) || gap(bodies, colliders) <= 0.0;
            assert!(is_known || !must, "{colliders:?} are near and no pair");
        }
    }
}

fn anything(random: &mut Random, origin: DVec3) -> Body {
    let scale = [0.02, 0.3, 0.3, 0.3, 1.5][random.below(5)];
    let shape = match random.below(3) {
        0 => Shape::sphere(scale),
        1 => Shape::capsule(scale, 0.4 * scale),
        _ => Shape::cuboid(scale, 2.0 * scale, scale),
    };
    let place = origin + random.vector(3.0);
    let body = if random.below(8) == 0 { Body::kinematic() } else { Body::dynamic() };
    let (speed, spin) = (random.vector(6.0).as_vec3(), random.vector(4.0).as_vec3());
    let mut collider = Collider::new(shape.clone());
    collider.sensor = random.below(8) == 0;
    if random.below(6) == 0 {
        collider.filter = Filter { groups: Groups::new([2]), accepts: Accepts::NoneOf(Groups::new([2])) };
    }
    let second = Collider::new(shape).at(2.0 * scale, 0.0, 0.0);
    let mut body = body.at(place.x, place.y, place.z).collider(collider);
    if random.below(3) == 0 {
        body = body.collider(second);
    }
    body.moving(speed.x, speed.y, speed.z).spinning(spin.x, spin.y, spin.z).restitution(0.5)
}

fn meddle(world: &mut World, ids: &mut Vec<BodyId>, random: &mut Random, origin: DVec3) {
    let one = random.below(ids.len());
    let mut commands = world.body_mut(ids[one]).expect("it is there");
    match random.below(7) {
        0 => drop(world.remove(ids.swap_remove(one))),
        1 | 2 => ids.push(world.add(anything(random, origin))),
        3 => commands.teleport(origin + random.vector(3.0), random.rotation()).expect("a place"),
        4 => commands.put_to_sleep(),
        5 => commands.set_linear_velocity(random.vector(500.0)).expect("a velocity"),
        _ => commands.add_force(random.vector(5000.0)).expect("a force"),
    }
}

#[test]
fn no_pair_is_missed_wherever_the_scene_is() {
    for (number, origin) in [DVec3::ZERO, DVec3::new(1e6, 2e5, -1e6)].into_iter().enumerate() {
        let mut random = Random(91 + number as u64);
        let gravity = if number == 0 { DVec3::new(0.0, -9.81, 0.0) } else { DVec3::ZERO };
        let mut world = World::with_settings(Settings { gravity, ..Settings::default() });
        let ground = origin - 4.0 * DVec3::Y;
        let floor = Body::fixed().at(ground.x, ground.y, ground.z);
        let ground = world.add(floor.clone().with(Shape::plane()));
        world.add(floor.with(Shape::cuboid(3.0, 2.0, 3.0)));
        let mut ids: Vec<BodyId> = (0..40).map(|_| world.add(anything(&mut random, origin))).collect();
        for step in 0..120 {
            world.step(STEP);
            look(&mut world);
            validate(&world);
            if step % 2 == 1 {
                meddle(&mut world, &mut ids, &mut random, origin);
            }
            if step == 60 {
                let mut plane = world.body_mut(ground).expect("it is there");
                plane.teleport(origin - 5.0 * DVec3::Y, random.rotation()).expect("a place");
            }
        }
        assert!(world.pairs.iter().count() > 20, "nothing was near");
    }
}

#[test]
fn who_joins_the_watched_pairs_gets_into_their_order() {
    let entries = |numbers: &[u32]| -> Vec<Entry> {
        numbers.iter().map(|&number| Entry { colliders: (number, number), index: number }).collect()
    };
    for (list, joining, both) in [
        (&[1, 4, 6][..], &[0, 5, 7][..], &[0, 1, 4, 5, 6, 7][..]),
        (&[], &[2, 3], &[2, 3]),
        (&[2, 3], &[], &[2, 3]),
        (&[5, 6], &[1, 5], &[1, 5, 5, 6]),
    ] {
        let (mut list, mut joining) = (entries(list), entries(joining));
        merge(&mut list, &mut joining);
        assert_eq!((list, joining), (entries(both), Vec::new()));
    }
}
