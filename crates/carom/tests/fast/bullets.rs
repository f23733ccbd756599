//! Bullets against walls, and against each other.

use super::*;
use carom::height_field::HeightField;
use std::sync::Arc;

/// Small things to shoot, of 5 cm.
fn bullets() -> Vec<(&'static str, Shape)> {
    let prism: Vec<DVec3> = (0..10)
        .map(|k| {
            let angle = f64::from(k / 2) * std::f64::consts::TAU / 5.0;
            DVec3::new(0.025 * angle.cos(), if k % 2 == 0 { -0.02 } else { 0.02 }, 0.025 * angle.sin())
        })
        .collect();
    vec![
        ("ball", Shape::sphere(0.025)),
        ("box", Shape::cuboid(0.05, 0.03, 0.04)),
        ("capsule", Shape::capsule(0.03, 0.01)),
        ("hull", Shape::hull(&prism).unwrap()),
        ("cylinder", Shape::cylinder(0.05, 0.02)),
    ]
}

/// A wall across x at 0, 4 m square, of that thickness.
fn walls(thickness: f64) -> Vec<(&'static str, Body)> {
    let half = 0.5 * thickness;
    let slab = Shape::cuboid(thickness, 4.0, 4.0);
    let corners: Vec<DVec3> = (0..8)
        .map(|bits| {
            let sign = |bit: u32| if bits & bit == 0 { -1.0 } else { 1.0 };
            DVec3::new(half * sign(1), 2.0 * sign(2), 2.0 * sign(4))
        })
        .collect();
    let count = 8;
    let vertices: Vec<DVec3> = (0..=count)
        .flat_map(|i| {
            (0..=count).map(move |j| DVec3::new(0.0, f64::from(i) * 0.5 - 2.0, f64::from(j) * 0.5 - 2.0))
        })
        .collect();
    let at = |i: u32, j: u32| i * (count as u32 + 1) + j;
    let triangles: Vec<[u32; 3]> = (0..count as u32)
        .flat_map(|i| (0..count as u32).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
        })
        .collect();
    let field = HeightField::new(&vec![vec![0.0; 9]; 9], [4.0, 4.0]).unwrap();
    let upright =
        carom::math::rotation_from_vector(DVec3::new(0.0, 0.0, -std::f64::consts::FRAC_PI_2)).as_quat();
    let mut tiles = Body::fixed();
    for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
        let tile = Collider::new(Shape::cuboid(thickness, 0.5, 0.5));
        tiles = tiles.collider(tile.at(0.0, f64::from(i) * 0.5 - 1.75, f64::from(j) * 0.5 - 1.75));
    }
    vec![
        ("box", Body::fixed().with(slab.clone())),
        ("hull", Body::fixed().with(Shape::hull(&corners).unwrap())),
        ("mesh", Body::fixed().with(Shape::mesh(vertices, triangles).unwrap())),
        ("height field", Body::fixed().rotated(upright).with(Shape::HeightField(Arc::new(field)))),
        ("tiles", tiles),
        ("kinematic box", Body::kinematic().with(slab)),
    ]
}

#[test]
fn no_wall_is_too_thin_and_no_bullet_too_fast() {
    let mut random = Random(1);
    let mut shots = 0;
    for (bullet, shape) in bullets() {
        for thickness in [0.01, 0.001] {
            for (wall, body) in walls(thickness) {
                for speed in [100.0, 500.0, 2000.0] {
                    for _ in 0..3 {
                        let mut world = weightless();
                        world.add(elastic(body.clone()));
                        // Up to 70 degrees off, starting up to a step's flight before the wall, with spin.
                        let aim = DVec3::new(0.0, random.range(-1.0, 1.0), random.range(-1.0, 1.0));
                        let direction =
                            DVec3::new(1.0, random.range(-1.0, 1.0) * 1.9, random.range(-1.0, 1.0) * 1.9)
                                .normalize();
                        let start = aim - direction * (0.1 + random.unit() * speed * STEP) / direction.x;
                        let spin = random.vector(50.0);
                        let mut shot = Body::dynamic().with(shape.clone()).at(start.x, start.y, start.z);
                        shot.rotation = random.rotation().as_quat();
                        shot.linear_velocity = (direction * speed).as_vec3();
                        shot.angular_velocity = spin.as_vec3();
                        let id = world.add(elastic(shot));
                        let before = world.energy().kinetic;
                        let flight = (aim - start).length() / speed;
                        let mut hits = 0;
                        for _ in 0..(flight / STEP) as usize + 2 {
                            hits += world.step(STEP).impacts().len();
                        }
                        let state = &world[id];
                        let case = format!(
                            "{bullet} at {speed} m/s along {direction} through a {wall} of {thickness} m"
                        );
                        assert!(hits >= 1 && state.position().x < 0.0, "{case}: {hits} hits, {state:?}");
                        let kept = world.energy().kinetic / before - 1.0;
                        assert!(kept.abs() < 1e-6, "{case}: energy changed by {kept:e}");
                        shots += 1;
                    }
                }
            }
        }
    }
    println!("{shots} shots");
}

#[test]
fn bullets_meet_each_other_head_on() {
    let mut random = Random(2);
    let mut struck = 0;
    for (name, shape) in bullets() {
        for (other_name, other_shape) in bullets() {
            for speed in [100.0, 500.0, 2000.0] {
                for _ in 0..4 {
                    let mut world = weightless();
                    let direction = random.direction();
                    let meeting = random.vector(1.0);
                    let apart = 0.1 + random.unit() * speed * STEP;
                    let shot = |shape: &Shape, side: f64, random: &mut Random| {
                        let start = meeting - direction * side * apart + random.vector(0.004);
                        let mut body = Body::dynamic().with(shape.clone()).at(start.x, start.y, start.z);
                        body.linear_velocity = (direction * side * speed).as_vec3();
                        body.rotation = random.rotation().as_quat();
                        elastic(body)
                    };
                    let a = world.add(shot(&shape, 1.0, &mut random));
                    let b = world.add(shot(&other_shape, -1.0, &mut random));
                    let before = world.energy().kinetic;
                    let mut hits = 0;
                    for _ in 0..(apart / speed / STEP) as usize + 2 {
                        hits += world.step(STEP).impacts().len();
                    }
                    let case = format!("{name} against {other_name} at {speed} m/s");
                    assert!(hits >= 1, "{case}: passed, {:?} {:?}", world[a], world[b]);
                    let kept = world.energy().kinetic / before - 1.0;
                    assert!(kept.abs() < 1e-5, "{case}: energy changed by {kept:e}");
                    struck += 1;
                }
            }
        }
    }
    println!("{struck} pairs");
}

#[test]
fn a_fast_wall_takes_along_what_stands_in_its_way() {
    // A kinematic sheet of 1 mm that moves at up to 500 m/s: what it strikes leaves at twice its speed.
    for (name, shape) in bullets() {
        for speed in [50.0_f64, 500.0] {
            let mut world = weightless();
            let sheet = Body::kinematic().at(-1.3, 0.0, 0.0).with(Shape::cuboid(0.001, 4.0, 4.0));
            world.add(elastic(sheet.moving(speed as f32, 0.0, 0.0)));
            let id = world.add(elastic(Body::dynamic().with(shape.clone()).at(0.0, 0.1, 0.2)));
            for _ in 0..(2.0 / speed / STEP) as usize + 2 {
                world.step(STEP);
            }
            let left = f64::from(world[id].linear_velocity().x);
            assert!((left / (2.0 * speed) - 1.0).abs() < 1e-5 || left > speed, "{name} at {speed}: {left}");
        }
    }
}
