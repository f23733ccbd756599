//! What passes by is left alone, to the last bit.

use super::*;

fn shapes() -> Vec<Shape> {
    let mut shapes: Vec<Shape> = movers().into_iter().map(|mover| mover.shape).collect();
    shapes.push(Shape::cone(0.4, 0.3));
    shapes
}

/// Farthest point of a shape along x, y or z when it is not turned.
fn reach(shape: &Shape) -> DVec3 {
    shape.bounds(&Pose::IDENTITY).1
}

#[test]
fn a_near_miss_is_a_miss() {
    for first in shapes() {
        for second in shapes() {
            for (clearance, speed) in [(2e-3, 10.0_f32), (1e-6, 10.0), (1e-6, 300.0), (2e-3, 0.5)] {
                let weightless = Settings { gravity: DVec3::ZERO, ..Settings::default() };
                let mut world = World::with_settings(weightless);
                let other = world.add(Body::dynamic().with(first.clone()).restitution(1.0));
                // Past each other along x, the one over the other.
                let height = reach(&first).y + reach(&second).y + clearance;
                let body =
                    Body::dynamic().with(second.clone()).at(-2.5, height, 0.02).moving(speed, 0.0, 0.0);
                let id = world.add(body.restitution(1.0));
                let before = [world[other], world[id]];
                for _ in 0..(5.0 / f64::from(speed) / STEP) as usize + 2 {
                    let report = world.step(STEP);
                    assert!(report.impacts().is_empty() && report.contacts() == 0, "{first:?} {second:?}");
                }
                for (state, before) in [world[other], world[id]].into_iter().zip(before) {
                    assert_eq!(state.linear_velocity(), before.linear_velocity(), "{first:?} {second:?}");
                    assert_eq!(state.angular_velocity(), before.angular_velocity(), "{first:?} {second:?}");
                }
            }
        }
    }
}

#[test]
fn past_the_edge_of_a_floor_it_falls_freely() {
    // Down beside the floor's border, 1e-6 m clear of it; triangles count as touched from a millionth of the size on.
    for mover in movers() {
        for floor in [Floor::Bodies, Floor::Mesh, Floor::Field] {
            let frame = Frame::level();
            let mut world = world_over(frame);
            floor.lay(&mut world, frame, coat(0.5, 1.0));
            let border = 0.13 - 4.0 * floors::TILE[0];
            let body = Body::dynamic().with(mover.shape.clone());
            let clearance = if floor == Floor::Bodies { 1e-6 } else { 1e-5 };
            let at = DVec3::new(border - reach(&mover.shape).x - clearance, 1.0, 0.0);
            let id = world.add(coated(body.at(at.x, at.y, at.z), coat(0.5, 1.0)));
            for number in 1..=60 {
                assert!(world.step(STEP).impacts().is_empty());
                let time = f64::from(number) * STEP;
                let truth = at.y - 0.5 * G * time * time;
                assert!((world[id].position().y - truth).abs() < 1e-9, "{} beside {floor:?}", mover.name);
                assert_eq!(world[id].angular_velocity(), Vec3::ZERO);
            }
        }
    }
}
