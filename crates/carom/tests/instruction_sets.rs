//! Every instruction set on any number of threads gives the same bits and tells the same events in the same order, at every level of
//! optimisation.
//!
//! The hashes below hold for x86-64. Who changes what the engine computes changes them on purpose: a failing test tells the new
//! ones. Debug and release builds are held to the same.

use carom::math::DVec3;
use carom::prelude::*;
use carom::{InstructionSet, Settings};
use random::Random;

mod random;

const STEP: f64 = 1.0 / 60.0;

/// FNV-1a, 64 bits.
struct Hash(u64);

impl Hash {
    fn eat(&mut self, value: u64) {
        for byte in value.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

/// What a run comes to: a hash of the state after each step and of what each step told, in its order, and how many impacts there were.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Outcome {
    states: u64,
    events: u64,
    impacts: usize,
}

fn run(scene: &Scene, (instruction_set, threads): (InstructionSet, u32)) -> Outcome {
    let settings = Settings { gravity: scene.gravity, instruction_set, threads, ..Settings::default() };
    let mut world = World::with_settings(settings);
    for body in &scene.bodies {
        world.try_add(body.clone()).unwrap();
    }
    let (mut states, mut events, mut impacts) = (Hash(0xcbf2_9ce4_8422_2325), Hash(0xcbf2_9ce4_8422_2325), 0);
    for _ in 0..scene.steps {
        let report = world.step(STEP);
        assert!(report.quarantined().is_empty(), "{}", scene.name);
        for impact in report.impacts() {
            events.eat(impact.time.to_bits());
            events.eat(((impact.a.index() as u64) << 32) | impact.b.index() as u64);
            events.eat(impact.separating_speed().to_bits());
        }
        impacts += report.impacts().len();
        events.eat(report.contacts() as u64);
        states.eat(world.state_hash());
    }
    Outcome { states: states.0, events: events.0, impacts }
}

struct Scene {
    name: &'static str,
    gravity: DVec3,
    bodies: Vec<Body>,
    steps: usize,
}

impl Scene {
    fn new(name: &'static str, steps: usize, bodies: Vec<Body>) -> Self {
        Self { name, gravity: DVec3::new(0.0, -9.81, 0.0), bodies, steps }
    }
}

fn floor() -> Body {
    Body::fixed().with(Shape::plane())
}

/// Bodies of several shapes that fall on each other.
fn pile() -> Scene {
    let mut random = Random(31);
    let mut bodies = vec![floor().restitution(0.2).friction(0.5)];
    for number in 0..40_u32 {
        let shape = match number % 4 {
            0 => Shape::sphere(random.range(0.2, 0.4)),
            1 => Shape::capsule(random.range(0.2, 0.6), random.range(0.15, 0.3)),
            _ => Shape::cuboid(random.range(0.3, 0.8), random.range(0.3, 0.8), random.range(0.3, 0.8)),
        };
        let (x, z) = (random.range(-0.8, 0.8), random.range(-0.8, 0.8));
        let body = Body::dynamic()
            .at(x, 0.7 + 0.7 * f64::from(number / 4), z)
            .rotated(random.rotation().as_quat().normalize())
            .with(shape)
            .restitution(random.range(0.0, 0.4))
            .friction(random.range(0.2, 0.8));
        bodies.push(body);
    }
    Scene::new("pile", 90, bodies)
}

/// Boxes and balls on hills of triangles.
fn mesh() -> Scene {
    let mut random = Random(32);
    let side: usize = 9;
    let place = |index: usize| index as f64 - 0.5 * (side - 1) as f64;
    let vertices: Vec<DVec3> = (0..side * side)
        .map(|index| DVec3::new(place(index / side), random.range(0.0, 0.5), place(index % side)))
        .collect();
    let cells = (0..side - 1).flat_map(|x| (0..side - 1).map(move |z| x * side + z));
    let faces: Vec<[u32; 3]> = cells
        .flat_map(|first| {
            let [a, b, c, d] = [first, first + 1, first + side, first + side + 1].map(|index| index as u32);
            [[a, b, c], [b, d, c]]
        })
        .collect();
    let mut bodies = vec![Body::fixed().with(Shape::mesh(vertices, faces).unwrap()).friction(0.6)];
    for number in 0..20_u32 {
        let shape = if number % 2 == 0 { Shape::cuboid(0.5, 0.4, 0.6) } else { Shape::sphere(0.25) };
        let (x, z) = (random.range(-2.0, 2.0), random.range(-2.0, 2.0));
        let body = Body::dynamic().at(x, 1.2 + 0.5 * f64::from(number / 4), z).with(shape).friction(0.6);
        bodies.push(body.restitution(0.2));
    }
    Scene::new("mesh", 80, bodies)
}

/// Elastic balls between six walls, without weight.
fn gas() -> Scene {
    let mut random = Random(33);
    let walls = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]).map(|axis| {
        let size = DVec3::splat(6.0) - 5.0 * axis.abs();
        let (middle, wall) = (2.5 * axis, Shape::cuboid(size.x, size.y, size.z));
        Body::fixed().at(middle.x, middle.y, middle.z).with(wall).restitution(1.0).friction(0.0)
    });
    let mut bodies: Vec<Body> = walls.collect();
    for number in 0..64_usize {
        let [x, y, z] = [number % 4, number / 4 % 4, number / 16].map(|index| 0.9 * (index as f64 - 1.5));
        let velocity = random.vector(6.0).as_vec3();
        let ball = Body::dynamic().at(x, y, z).moving(velocity.x, velocity.y, velocity.z);
        bodies.push(ball.with(Shape::sphere(0.2)).restitution(1.0).friction(0.0));
    }
    Scene { gravity: DVec3::ZERO, ..Scene::new("gas", 100, bodies) }
}

/// Two balls that strike five which touch, between elastic walls.
fn cradle() -> Scene {
    let elastic = |body: Body| body.restitution(1.0).friction(0.0);
    let wall = |x: f64| elastic(Body::fixed().at(x, 0.0, 0.0).with(Shape::cuboid(1.0, 4.0, 4.0)));
    let ball = |x: f64, speed: f32| {
        elastic(Body::dynamic().at(x, 0.0, 0.0).moving(speed, 0.0, 0.0).with(Shape::sphere(0.5)))
    };
    let mut bodies = vec![wall(-6.0), wall(6.0), ball(-4.0, 3.0), ball(-3.0, 3.0)];
    bodies.extend((0..5).map(|number| ball(f64::from(number), 0.0)));
    Scene { gravity: DVec3::ZERO, ..Scene::new("cradle", 200, bodies) }
}

/// Boxes on boxes, and a ball that comes by.
fn stack() -> Scene {
    let mut bodies = vec![floor().friction(0.6)];
    let place =
        |row: u32, number: u32| (1.02 * (f64::from(number) + 0.5 * f64::from(row)), 0.5 + f64::from(row));
    for (row, number) in (0..9).flat_map(|row| (0..9 - row).map(move |number| (row, number))) {
        let (x, y) = place(row, number);
        bodies.push(Body::dynamic().at(x, y, 0.0).with(Shape::cuboid(1.0, 1.0, 1.0)).friction(0.6));
    }
    bodies
        .push(Body::dynamic().at(4.0, 3.0, 6.0).moving(0.0, 0.0, -8.0).with(Shape::sphere(0.4)).mass(500.0));
    Scene::new("stack", 100, bodies)
}

/// Pairs of boxes that drop and slide about on a floor: enough of them for threads to share their contacts.
fn crowd() -> Scene {
    let mut random = Random(34);
    let mut bodies = vec![floor().friction(0.4)];
    for number in 0..560_u32 {
        let [x, z] = [number / 2 % 20, number / 40].map(|index| 1.2 * f64::from(index));
        let velocity = random.vector(1.0).as_vec3();
        let body = Body::dynamic()
            .at(x, 0.52 + 1.04 * f64::from(number % 2), z)
            .moving(velocity.x, 0.0, velocity.z)
            .with(Shape::cuboid(1.0, 1.0, 1.0));
        bodies.push(body.friction(random.range(0.2, 0.8)));
    }
    Scene::new("crowd", 12, bodies)
}

const THREADS: [u32; 3] = [1, 2, 4];

/// The hashes of states and events of [pile, mesh, gas, cradle, stack, crowd].
const EXPECTED: [[u64; 2]; 6] = [
    [0x7623_fac3_3412_09c5, 0xc1a5_7f80_7822_f2e0],
    [0x426a_40e3_47d1_b486, 0x21b0_5f5e_1dfb_decc],
    [0xb7c9_a597_8de9_22c8, 0x12d9_d339_e94d_7830],
    [0x495a_c80e_1b79_9fde, 0x046b_b65b_a085_2bf1],
    [0xbc47_0e2b_a20b_0184, 0x31cc_a431_edc0_9197],
    [0x9566_edbf_d451_df88, 0xe1d8_5cec_8d60_1593],
];

#[test]
fn all_instruction_sets_and_numbers_of_threads_give_the_same_bits() {
    let (sets, missing): (Vec<_>, Vec<_>) =
        InstructionSet::ALL.into_iter().partition(|set| set.is_available());
    missing.iter().for_each(|set| println!("{set:?}: not tested, this machine does not have it"));
    let rows: Vec<(InstructionSet, u32)> =
        sets.iter().flat_map(|&set| THREADS.map(|threads| (set, threads))).collect();
    let mut found = Vec::new();
    let scenes = [pile(), mesh(), gas(), cradle(), stack(), crowd()];
    for scene in scenes {
        let outcomes: Vec<Outcome> = rows.iter().map(|&row| run(&scene, row)).collect();
        for (outcome, (set, threads)) in outcomes.iter().zip(&rows) {
            assert_eq!(*outcome, outcomes[0], "{} with {set:?} on {threads} threads", scene.name);
        }
        let it = outcomes[0];
        println!("{}: {} impacts, the same with {sets:?} on {THREADS:?} threads", scene.name, it.impacts);
        assert!(it.impacts >= 3, "{}: {} impacts", scene.name, it.impacts);
        found.push([it.states, it.events]);
    }
    if cfg!(target_arch = "x86_64") {
        assert!(found == EXPECTED, "not what is expected, but now: {found:#018x?}");
    }
}
