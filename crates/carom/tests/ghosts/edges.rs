//! Edges that are there: steps, ramps and ridges.

use super::*;

/// How two pieces of ground that meet at x = 0 are made.
#[derive(Clone, Copy, Debug)]
enum Made {
    Boxes,
    Hulls,
    Mesh,
    Meshes,
}

const MADE: [Made; 4] = [Made::Boxes, Made::Hulls, Made::Mesh, Made::Meshes];

const LENGTH: f64 = 8.0;
const WIDTH: f64 = 4.0;

/// The level ground at x < 0, and ground that rises at that angle (rad) at x > 0; falls, if it is negative.
fn ground(made: Made, angle: f64, material: Material) -> Vec<Body> {
    let turned = Frame(Pose::new(DVec3::ZERO, rotation_from_vector(DVec3::Z * angle)));
    let half = DVec3::new(0.5 * LENGTH, 0.5, 0.5 * WIDTH);
    let middle = |side: f64| Pose::new(DVec3::new(side * half.x, -half.y, 0.0), Pose::IDENTITY.rotation);
    let pieces = |shape: Shape| {
        [(Frame::level(), -1.0), (turned, 1.0)]
            .map(|(frame, side)| frame.place(Body::fixed().with(shape.clone()), middle(side)))
            .to_vec()
    };
    let (sine, cosine) = angle.sin_cos();
    let row = |x: f64, y: f64| [-1.0, 1.0].map(|side| DVec3::new(x, y, side * half.z));
    let rows = [row(-LENGTH, 0.0), row(0.0, 0.0), row(LENGTH * cosine, LENGTH * sine)];
    let sheet = |rows: &[[DVec3; 2]]| {
        let triangles = (0..rows.len() as u32 - 1)
            .flat_map(|k| [[2 * k, 2 * k + 1, 2 * k + 2], [2 * k + 1, 2 * k + 3, 2 * k + 2]])
            .collect();
        Body::fixed().with(Shape::mesh(rows.concat(), triangles).unwrap())
    };
    let bodies = match made {
        Made::Boxes => pieces(Shape::cuboid(LENGTH, 1.0, WIDTH)),
        Made::Hulls => {
            let sign = |bits: i32, bit: i32| if bits & bit == 0 { -1.0 } else { 1.0 };
            let corner = |bits: i32| half * DVec3::new(sign(bits, 1), sign(bits, 2), sign(bits, 4));
            pieces(Shape::hull(&(0..8).map(corner).collect::<Vec<_>>()).unwrap())
        }
        Made::Mesh => vec![sheet(&rows)],
        Made::Meshes => vec![sheet(&rows[..2]), sheet(&rows[1..])],
    };
    bodies.into_iter().map(|body| coated(body, material)).collect()
}

fn world_of(bodies: Vec<Body>) -> World {
    let mut world = World::new();
    bodies.into_iter().for_each(|body| {
        world.add(body);
    });
    world
}

#[test]
fn a_step_stops_what_slides_against_it() {
    for (mover, step) in
        movers().into_iter().flat_map(|mover| [0.02, 0.002, 1e-4].map(|step| (mover.shape.clone(), step)))
    {
        if matches!(mover, Shape::Sphere { .. } | Shape::Capsule { .. }) {
            continue;
        }
        let (_, high) = mover.bounds(&Pose::IDENTITY);
        let mut pieces = ground(Made::Boxes, 0.0, coat(0.0, 0.0));
        pieces[1].position.y += step;
        let mut world = world_of(pieces);
        let body = Body::dynamic().with(mover).at(-high.x - 0.5, high.y, 0.0).moving(2.0, 0.0, 0.0);
        let id = world.add(coated(body, coat(0.0, 0.0)));
        let mut hit = None;
        for _ in 0..40 {
            let report = world.step(STEP);
            let mut hits = report.impacts().iter().map(|hit| (hit.time, hit.contact.normal));
            hit = hit.or(hits.find(|(_, normal)| normal.x < -0.5));
        }
        let (time, normal) =
            hit.unwrap_or_else(|| panic!("a step of {step} m is passed over: {:?}", world[id]));
        assert!((time - 0.25).abs() < 1e-4, "at {time} s");
        assert!(normal.x < -0.999, "a step of {step} m, struck along {normal}");
    }
}

#[test]
fn a_ball_rolls_against_a_ramp_at_the_right_place() {
    let (radius, speed, angle) = (0.25, 3.0, 0.4_f64);
    for made in MADE {
        let mut world = world_of(ground(made, angle, coat(0.0, 0.0)));
        let ball = Body::dynamic().with(Shape::sphere(radius)).at(-2.0, radius, 0.1);
        let id = world.add(coated(ball.moving(speed as f32, 0.0, 0.0), coat(0.0, 0.0)));
        let mut hits = Vec::new();
        for _ in 0..60 {
            hits.extend(world.step(STEP).impacts().iter().map(|hit| (hit.time, hit.contact.normal)));
        }
        let truth = (2.0 - radius * (0.5 * angle).tan()) / speed;
        let normal = DVec3::new(-angle.sin(), angle.cos(), 0.0);
        assert_eq!(hits.len(), 1, "{made:?}: {hits:?}");
        for (time, struck) in hits {
            assert!((time - truth).abs() < 1e-5, "{made:?}: {time} for {truth}");
            assert!((struck - normal).length() < 1e-5, "{made:?}: {struck} for {normal}");
        }
        let left = 1.0 - truth;
        let along = speed * angle.cos() - G * angle.sin() * left;
        let error = (velocity(&world[id]) - DVec3::new(angle.cos(), angle.sin(), 0.0) * along).length();
        assert!(error < 2e-3, "{made:?}: {:?} for {along} along the ramp", world[id]);
    }
}

#[test]
fn over_a_ridge_a_fast_ball_flies_and_a_slow_one_rolls_down() {
    let (radius, angle) = (0.25, -0.4_f64);
    for made in MADE {
        // Fast: v² > g·r, so that it leaves the ridge; the contact holds it to the end of the substep, that is for 2 cm of fall.
        let mut world = world_of(ground(made, angle, coat(0.0, 0.0)));
        let ball = Body::dynamic().with(Shape::sphere(radius)).at(-1.0, radius, 0.1);
        let id = world.add(coated(ball.moving(4.0, 0.0, 0.0), coat(0.0, 0.0)));
        for _ in 0..30 {
            world.step(STEP);
        }
        let fall = 0.25_f64;
        let truth = DVec3::new(1.0, radius - 0.5 * G * fall * fall, 0.1);
        assert!((world[id].position() - truth).length() < 2.2e-2, "{made:?}: {:?} for {truth}", world[id]);

        // Slow: it rolls around the ridge, and no energy is lost.
        let mut world = world_of(ground(made, angle, coat(0.0, 0.0)));
        let ball = Body::dynamic().with(Shape::sphere(radius)).at(-0.1, radius, 0.1);
        let id = world.add(coated(ball.moving(0.3, 0.0, 0.0), coat(0.0, 0.0)));
        for _ in 0..70 {
            world.step(STEP);
        }
        let (place, v) = (world[id].position(), velocity(&world[id]));
        let height = DVec3::new(-angle.sin(), angle.cos(), 0.0).dot(place);
        assert!((height - radius).abs() < 1e-3, "{made:?}: {height} above the slope");
        let energy = 0.5 * v.length_squared() + G * place.y;
        let truth = 0.5 * 0.3 * 0.3 + G * radius;
        assert!((energy - truth).abs() < 0.03, "{made:?}: {energy} for {truth}");
    }
}

#[test]
fn a_box_takes_a_gentle_ramp() {
    // Struck at its lower edge, with C_r = 0, it loses what points into the ramp, and turns; it must not be stopped as by a wall.
    for made in MADE {
        for angle in [0.02_f64, 0.1] {
            let mut world = world_of(ground(made, angle, coat(0.0, 0.0)));
            let body =
                Body::dynamic().with(Shape::cuboid(0.6, 0.2, 0.4)).at(-1.0, 0.1, 0.1).moving(3.0, 0.0, 0.0);
            let id = world.add(coated(body, coat(0.0, 0.0)));
            for _ in 0..40 {
                world.step(STEP);
            }
            let state = &world[id];
            let energy = 0.5 * velocity(state).length_squared() + G * (state.position().y - 0.1);
            let lost = 0.5 * (3.0 * angle.sin()).powi(2);
            println!("{made:?} {angle}: {}", energy - 4.5);
            assert!(
                energy < 4.5 + 1e-3 && energy > 4.5 - 2.0 * lost - 0.02,
                "{made:?} of {angle} rad: {energy}, {state:?}"
            );
            assert!(state.position().x > 0.8, "{made:?} of {angle} rad: {state:?}");
        }
    }
}
