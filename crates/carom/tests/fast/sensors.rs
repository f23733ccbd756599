//! Sensors tell of whatever was in them at any time of a step.

use super::*;

fn visits(world: &mut World, steps: usize) -> usize {
    (0..steps).map(|_| world.step(STEP).overlaps().len()).sum()
}

#[test]
fn a_bullet_that_passes_within_one_step_is_reported() {
    let curtain = |body: Body| {
        let mut collider = Collider::new(Shape::cuboid(0.001, 4.0, 4.0));
        collider.sensor = true;
        body.collider(collider)
    };
    for speed in [1.0_f64, 100.0, 2000.0] {
        for shape in [Shape::sphere(0.025), Shape::cuboid(0.05, 0.02, 0.03), Shape::cylinder(0.05, 0.02)] {
            let bob = Collider::new(Shape::sphere(0.1)).at(0.0, 10.0, 0.0);
            for kind in [Body::fixed(), Body::kinematic(), Body::dynamic().collider(bob)] {
                let mut world = weightless();
                let sensor = world.add(curtain(kind));
                let shot = Body::dynamic().with(shape.clone()).at(-0.3 * speed * STEP - 0.05, 0.1, 0.2);
                let id = world.add(shot.moving(speed as f32, 0.0, 0.0));
                let before = world[id].linear_velocity();
                let mut seen = 0;
                for _ in 0..(0.4 / speed / STEP) as usize + 3 {
                    let report = world.step(STEP);
                    assert!(report.impacts().is_empty());
                    seen +=
                        report.overlaps().iter().filter(|it| it.sensor == sensor && it.visitor == id).count();
                    assert!(report.overlaps().len() <= 1);
                }
                assert!(seen >= 1, "{speed} m/s");
                assert_eq!(world[id].linear_velocity(), before);
            }
        }
    }
}

#[test]
fn a_bullet_that_bounces_inside_of_a_sensor_is_reported() {
    // It comes to a wall through the sensor in front of it and is back out within the step.
    let mut world = weightless();
    world.add(elastic(Body::fixed().with(Shape::cuboid(0.1, 4.0, 4.0))));
    let mut collider = Collider::new(Shape::cuboid(0.02, 4.0, 4.0));
    collider.sensor = true;
    world.add(Body::fixed().at(-0.1, 0.0, 0.0).collider(collider));
    let id = world
        .add(elastic(Body::dynamic().with(Shape::sphere(0.01)).at(-3.0, 0.0, 0.0).moving(500.0, 0.0, 0.0)));
    assert_eq!(visits(&mut world, 1), 1);
    assert!(world[id].linear_velocity().x < 0.0);
    assert_eq!(visits(&mut world, 3), 0);
}

#[test]
fn what_is_stopped_before_a_sensor_is_not_reported() {
    let mut world = weightless();
    world.add(elastic(Body::fixed().with(Shape::cuboid(0.1, 4.0, 4.0))));
    let mut collider = Collider::new(Shape::cuboid(0.02, 4.0, 4.0));
    collider.sensor = true;
    world.add(Body::fixed().at(0.2, 0.0, 0.0).collider(collider));
    world.add(elastic(Body::dynamic().with(Shape::sphere(0.01)).at(-3.0, 0.0, 0.0).moving(500.0, 0.0, 0.0)));
    assert_eq!(visits(&mut world, 3), 0);
}

#[test]
fn a_turning_sensor_sweeps_over_what_it_passes() {
    let mut world = weightless();
    let mut collider = Collider::new(Shape::cuboid(2.0, 0.002, 0.002));
    collider.sensor = true;
    let mut body = Body::kinematic().collider(collider);
    body.angular_velocity = Vec3::new(0.0, 0.0, 100.0);
    world.add(body);
    // 100 rad/s are 1.67 rad a step: the arm passes it between the ends of steps.
    let angle = 0.8_f64;
    world.add(Body::dynamic().with(Shape::sphere(0.01)).at(0.9 * angle.cos(), 0.9 * angle.sin(), 0.0));
    assert_eq!(visits(&mut world, 1), 1);
}

#[test]
fn a_near_miss_is_none() {
    let mut world = weightless();
    let mut collider = Collider::new(Shape::cuboid(0.02, 1.0, 1.0));
    collider.sensor = true;
    world.add(Body::fixed().collider(collider));
    world.add(Body::dynamic().with(Shape::sphere(0.01)).at(-3.0, 0.51 + 1e-6, 0.0).moving(500.0, 0.0, 0.0));
    assert_eq!(visits(&mut world, 3), 0);
}
