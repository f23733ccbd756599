//! Holds what rests to the graph of its contacts, step after step. For tests; slow.

use super::Rest;
use crate::World;
use crate::bodies::{Bodies, WORLD_ROW};
use crate::solver::graph::ContactId;
use crate::step::pairs::Pairs;

impl Rest {
    /// Panics unless pairs, rows and graph know of the same contacts.
    pub fn validate(&self, bodies: &Bodies, pairs: &Pairs) {
        let is_movable = |row: u32| bodies.constants[row as usize].is_movable();
        self.graph.validate(is_movable);
        let mut contacts = 0;
        for pair in pairs.iter() {
            assert_eq!(
                pair.rests,
                pair.first_contact != ContactId::NONE,
                "{:?} rests without contacts",
                pair.colliders
            );
            for contact in self.contacts(pair) {
                let rows = pair.rows().map(|row| row as u32);
                assert_eq!(self.graph.rows(contact), rows, "rows of {:?}", pair.colliders);
                contacts += 1;
            }
            let (a, b) = (bodies.collider(pair.colliders.0), bodies.collider(pair.colliders.1));
            let rows = [a, b].map(|collider| collider.expect("a pair's colliders are there").row);
            assert_eq!(rows, pair.rows(), "bodies of {:?}", pair.colliders);
        }
        assert_eq!(contacts, self.graph.len(), "contacts that no pair knows of");
        let mut counts = vec![0; bodies.states.len()];
        for row in self.graph.all_rows().into_iter().flatten().filter(|&row| row as usize != WORLD_ROW) {
            counts[row as usize] += 1;
        }
        for (row, count) in counts.into_iter().enumerate() {
            assert_eq!(self.rows.count(row), count, "contacts of body {row}");
        }
    }

    /// Panics unless the list of resting pairs is that of the pairs that rest: so it must be at the end of a step.
    fn validate_resting(&self, pairs: &Pairs) {
        let mut resting = self.resting.clone();
        resting.sort_unstable();
        let truth: Vec<usize> = (0..pairs.bound()).filter(|&index| pairs.rests(index)).collect();
        assert_eq!(resting, truth, "pairs that rest");
    }
}

impl World {
    /// Panics unless all tables about contacts agree.
    pub(crate) fn validate(&self) {
        self.rest.validate(&self.bodies, &self.pairs);
    }

    /// One step, after which all tables about contacts agree.
    pub(crate) fn step_validated(&mut self, time: f64) {
        self.step(time);
        self.validate();
        self.rest.validate_resting(&self.pairs);
    }
}

mod tests {
    use crate::math::{DQuat, DVec3};
    use crate::solver::tests::Random;
    use crate::{Body, BodyId, Shape, World};

    const STEP: f64 = 1.0 / 60.0;

    fn anything(random: &mut Random) -> Body {
        let size = |random: &mut Random| random.range(0.2, 0.8);
        let shape = match random.below(5) {
            0 => Shape::sphere(0.5 * size(random)),
            1 => Shape::capsule(size(random), 0.4 * size(random)),
            2 => Shape::cylinder(size(random), 0.5 * size(random)),
            _ => Shape::cuboid(size(random), size(random), size(random)),
        };
        let place = random.vector(1.5);
        let body = if random.below(12) == 0 { Body::kinematic() } else { Body::dynamic() };
        let restitution = if random.below(3) == 0 { 0.5 } else { 0.0 };
        let turn = random.rotation().as_quat();
        body.with(shape).at(place.x, 1.0 + place.y.abs(), place.z).rotated(turn).restitution(restitution)
    }

    /// What users do to bodies between steps.
    fn meddle(world: &mut World, ids: &mut Vec<BodyId>, random: &mut Random) {
        let one = random.below(ids.len());
        let mut commands = world.body_mut(ids[one]).expect("it is there");
        match random.below(9) {
            0 => drop(world.remove(ids.swap_remove(one))),
            1 | 2 => ids.push(world.add(anything(random))),
            3 => {
                let place = random.vector(1.0) + DVec3::Y * 1.5;
                commands.teleport(place, random.rotation()).expect("a place");
            }
            4 => commands.put_to_sleep(),
            5 => commands.wake(),
            6 => commands.set_linear_velocity(random.vector(3.0)).expect("a velocity"),
            7 => commands.apply_angular_impulse(random.vector(5.0)).expect("an impulse"),
            _ => commands.add_force(random.vector(5000.0)).expect("a force"),
        }
        world.validate();
    }

    #[test]
    fn a_pile_of_mixed_shapes_keeps_its_tables_while_bodies_come_and_go() {
        for seed in 0..3 {
            let mut random = Random(71 + seed);
            let mut world = World::new();
            world.add(Body::fixed().with(Shape::cuboid(20.0, 1.0, 20.0)).at(0.0, -0.5, 0.0));
            world.add(Body::fixed().with(Shape::plane()).at(0.0, -3.0, 0.0));
            let mut ids: Vec<BodyId> = (0..30).map(|_| world.add(anything(&mut random))).collect();
            let mut rested = 0;
            for step in 0..150 {
                world.step_validated(STEP);
                rested = rested.max(world.report.contacts());
                if step % 3 == 2 {
                    meddle(&mut world, &mut ids, &mut random);
                }
            }
            assert!(rested > 20, "{rested}");
        }
    }

    #[test]
    fn a_stack_that_loses_its_lowest_keeps_its_tables() {
        let mut world = World::new();
        let ground = world.add(Body::fixed().with(Shape::cuboid(20.0, 1.0, 20.0)).at(0.0, -0.5, 0.0));
        let cube = |y: f64| Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0)).at(0.0, y, 0.0);
        let ids: Vec<BodyId> = (0..5).map(|number| world.add(cube(0.5 + f64::from(number)))).collect();
        for _ in 0..30 {
            world.step_validated(STEP);
        }
        assert_eq!(world.report.contacts(), 5);
        world.remove(ids[0]);
        world.validate();
        for _ in 0..60 {
            world.step_validated(STEP);
        }
        assert_eq!(world.report.contacts(), 4);
        world.body_mut(ground).unwrap().teleport(DVec3::Y * -5.0, DQuat::IDENTITY).unwrap();
        world.validate();
        world.step_validated(STEP);
        assert!(world.report.contacts() < 4);
    }
}
