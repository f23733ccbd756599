//! Where many bodies rest against each other.
//!
//! There everything touches everything, and each blow presses hundreds of contacts a little. What touches for the first time strikes at
//! its own instant, as anywhere else. What rests already and does not bounce has nothing that an instant could tell: it is
//! stopped. So a crowd's contacts see to all points of such a pair, also to those that have not touched yet, and nobody asks when these
//! will; unless they come so fast that they would get far into the other body within a substep.

use super::{PRESSED, grain};
use crate::bodies::{Bodies, WORLD_ROW};
use crate::impacts::time_of_impact::RestLaw;
use crate::step::pairs::Pair;

/// More bodies than this, resting against each other, are a crowd.
const CROWD: u32 = 32;

/// Gap that contacts of a crowd see to however slowly its bodies move, as a share of the smaller reach.
const AT_HAND: f64 = 0.1;

/// The bodies in disjoint sets of those that rest against each other.
#[derive(Default)]
pub(super) struct Crowds {
    leaders: Vec<u32>,
    sizes: Vec<u32>,
}

impl Crowds {
    /// Finds the sets, given the rows of all pairs that rest.
    pub fn find(&mut self, bodies: &Bodies, pairs: impl Iterator<Item = [usize; 2]>) {
        let rows = bodies.states.len() as u32;
        self.leaders.clear();
        self.leaders.extend(0..rows);
        let movable = |&row: &usize| row != WORLD_ROW && bodies.constants[row].is_movable();
        for [a, b] in pairs.filter(|rows| rows.iter().all(movable)) {
            let (one, other) = (self.leader(a as u32), self.leader(b as u32));
            self.leaders[one.max(other) as usize] = one.min(other);
        }
        self.sizes.clear();
        self.sizes.resize(rows as usize, 0);
        for row in 0..rows {
            let leader = self.leader(row);
            self.leaders[row as usize] = leader;
            self.sizes[leader as usize] += 1;
        }
    }

    fn leader(&mut self, mut row: u32) -> u32 {
        while self.leaders[row as usize] != row {
            let next = self.leaders[row as usize];
            self.leaders[row as usize] = self.leaders[next as usize];
            row = next;
        }
        row
    }

    /// Whether the body of a row is in a crowd.
    pub fn has(&self, row: usize) -> bool {
        self.leaders.get(row).is_some_and(|&leader| self.sizes[leader as usize] > CROWD)
    }

    /// Whether one of two bodies is.
    pub fn has_either(&self, rows: [usize; 2]) -> bool {
        rows.into_iter().any(|row| self.has(row))
    }

    /// Whether contacts see to all points of a pair that rests.
    pub fn press(&self, bodies: &Bodies, pair: &Pair, law: RestLaw) -> bool {
        !pair.bounces
            && self.has_either(pair.rows())
            && approach(bodies, pair, law.substep) <= PRESSED * grain(bodies, pair)
    }
}

/// Gap (m) up to which contacts of a crowd see to a pair's points when they are looked at with so much (s) of the step `left`.
pub(super) fn reach_in_crowd(bodies: &Bodies, pair: &Pair, left: f64) -> f64 {
    (AT_HAND * grain(bodies, pair)).max(approach(bodies, pair, left))
}

/// How much nearer to each other the points of two bodies can come within `time` (s) on their present paths, m.
fn approach(bodies: &Bodies, pair: &Pair, time: f64) -> f64 {
    let [a, b] = pair.rows();
    let velocity = bodies.states[b].velocity - bodies.states[a].velocity;
    let acceleration = bodies.influences[b].acceleration - bodies.influences[a].acceleration;
    let spin_reaches = pair.spin_reaches(bodies);
    let turn = |side: usize| bodies.paces[pair.rows()[side]].1 * spin_reaches[side];
    time * (velocity.length() + turn(0) + turn(1) + 0.5 * time * acceleration.length())
}

#[cfg(test)]
mod tests {
    use crate::impacts::time_of_impact::{Approach, RestLaw};
    use crate::math::DVec3;
    use crate::solver::bundle::field;
    use crate::solver::tests::Random;
    use crate::{Body, Shape, World};

    const STEP: f64 = 1.0 / 60.0;

    /// Sixty lumps, boxes and wedges, poured into a shaft.
    fn heap(random: &mut Random) -> World {
        let mut world = World::new();
        world.add(Body::fixed().with(Shape::plane()));
        for (x, z) in [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)] {
            world.add(Body::fixed().with(Shape::cuboid(2.0, 50.0, 2.0)).at(x, 20.0, z));
        }
        for number in 0..60 {
            let size = |random: &mut Random| random.range(0.3, 0.6);
            let (x, y, z) = (size(random), size(random), size(random));
            let wedge = [[0.0, 0.0, 0.0], [x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z], [x, 0.0, z]];
            let shape = match number % 3 {
                0 => Shape::cuboid(x, y, z),
                1 => Shape::hull(&wedge.map(DVec3::from_array)).expect("a wedge"),
                _ => Shape::cylinder(x, 0.4 * y),
            };
            let place =
                DVec3::new(random.range(-0.8, 0.8), 0.6 + 0.3 * f64::from(number), random.range(-0.8, 0.8));
            let turn = random.rotation().as_quat();
            world.add(Body::dynamic().with(shape).at(place.x, place.y, place.z).rotated(turn).friction(0.8));
        }
        world
    }

    #[test]
    fn nothing_in_a_crowd_that_has_come_to_rest_is_held_by_what_it_does_not_touch() {
        for seed in 0..6 {
            let mut world = heap(&mut Random(41 + seed));
            let law = RestLaw { gravity: world.settings.gravity, substep: 0.5 * STEP, step: STEP };
            for step in 0..300 {
                world.step_validated(STEP);
                if step < 240 {
                    continue;
                }
                let (bodies, rest, pairs) = (&world.bodies, &world.rest, &world.pairs);
                for pair in rest.resting.iter().map(|&index| &pairs[index]) {
                    let pushes = |point: usize, contact| {
                        rest.graph.get(contact, field::of_point(point, field::IMPULSE)) > 0.0
                    };
                    let is_pressed =
                        rest.contacts(pair).any(|contact| (0..4).any(|point| pushes(point, contact)));
                    let is_slow =
                        pair.rows().into_iter().all(|row| bodies.states[row].velocity.length() < 1e-3);
                    if is_pressed && is_slow {
                        let approach = Approach::of(bodies, pair.colliders, law).expect("both are there");
                        let gap = approach.separation(STEP);
                        assert!(gap < 4e-4, "held over a gap of {gap} m in step {step}, heap {seed}");
                    }
                }
            }
        }
    }

    /// Thirty-four boxes on each other slide along a wall, which contacts see but which is out of their reach. Such a pair was looked at in
    /// every substep: one of its contacts had left, and the others had not.
    #[test]
    fn a_pair_with_one_contact_of_several_out_of_reach_is_not_looked_at_all_the_time() {
        let mut world = World::new();
        let corners = [(0.0, 0.0, -9.0), (0.0, 0.0, 9.0), (5.0, 0.0, 9.0), (5.0, 0.0, -9.0)];
        let wall = [(0.0, 2.0, -9.0), (0.0, 2.0, 9.0)];
        let vertices = corners.into_iter().chain(wall).map(DVec3::from).collect();
        let ground = Shape::mesh(vertices, vec![[0, 1, 2], [0, 2, 3], [0, 4, 5], [0, 5, 1]]);
        world.add(Body::fixed().with(ground.expect("triangles")).friction(0.0));
        for number in 0..34 {
            let cube = Body::dynamic().with(Shape::cuboid(1.0, 1.0, 1.0)).friction(0.0);
            world.add(cube.at(0.55, 0.5 + f64::from(number), 0.3).moving(0.0, 0.0, 0.05));
        }
        let mut looks = 0;
        let mut last = Vec::new();
        for step in 0..40 {
            world.step_validated(STEP);
            let (rest, pairs) = (&world.rest, &world.pairs);
            let lowest = rest.resting.iter().map(|&index| &pairs[index]).find(|pair| pair.rows()[0] == 0);
            let contacts: Vec<_> = rest.contacts(lowest.expect("it stands on the ground")).collect();
            let now: Vec<[f32; 3]> = contacts
                .iter()
                .map(|&contact| [0, 1, 2].map(|axis| rest.graph.get(contact, field::DRIFTED + axis)))
                .collect();
            if step >= 20 {
                assert!(contacts.iter().any(|&contact| rest.graph.has_left(contact)), "step {step}");
                assert!(!contacts.iter().all(|&contact| rest.graph.has_left(contact)), "step {step}");
                looks += usize::from(now != last);
            }
            last = now;
        }
        assert!((1..=8).contains(&looks), "looked at in {looks} of 20 steps");
    }
}
