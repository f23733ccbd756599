//! Each cause alone, against its closed form.

use super::*;

#[test]
fn a_bounce_loses_what_restitution_takes() {
    let mut world = world();
    world.add(ground().restitution(0.8));
    world.add(ball().at(0.0, 1.5, 0.0).restitution(0.8));
    run(&mut world, 30);
    let posts = posts(&world);
    let speed = (2.0 * G).sqrt();
    assert_near(posts.loss_restitution, 0.5 * speed * speed * (1.0 - 0.64), 1e-9);
    assert_near(posts.fixed.linear.y, 1.8 * speed, 1e-9);
    assert_near(posts.gravity.linear.y, -G * 0.5, 1e-9);
    for (cause, value) in posts.energies().into_iter().filter(|(cause, _)| *cause != "loss_restitution") {
        assert_eq!(value, 0.0, "{cause}");
    }
}

#[test]
fn a_bounce_across_the_normal_loses_to_friction() {
    let mut world = weightless();
    world.add(ground().friction(0.5).restitution(1.0));
    world.add(ball().friction(0.5).at(0.0, 1.0, 0.0).moving(1.0, -6.0, 0.0).restitution(1.0));
    run(&mut world, 30);
    // A solid ball that sticks keeps 5/7 of its slip's direction of motion: it loses ½·(2/7)·m·v².
    assert_near(posts(&world).loss_friction, 0.5 * 2.0 / 7.0, 1e-9);
    assert_near(posts(&world).loss_restitution, 0.0, 1e-12);
    assert_near(posts(&world).fixed.linear.x, -2.0 / 7.0, 1e-9);
}

#[test]
fn a_box_that_slides_to_rest_loses_all_to_friction() {
    let mut world = world();
    world.add(ground().friction(0.3));
    world.add(
        Body::dynamic()
            .with(Shape::cuboid(1.0, 0.2, 1.0))
            .mass(2.0)
            .friction(0.3)
            .at(0.0, 0.1, 0.0)
            .moving(3.0, 0.0, 0.0),
    );
    run(&mut world, 120);
    let posts = posts(&world);
    assert_near(posts.loss_friction, 9.0, 0.01);
    assert_near(posts.fixed.linear.x, -6.0, 1e-5);
    assert_near(posts.fixed.linear.y, 2.0 * G * 2.0, 1e-4);
    assert!(world.ledger().artefacts() < 0.01, "{}", world.ledger());
}

#[test]
fn what_comes_slowly_and_does_not_bounce_is_lost_to_the_contact() {
    let mut world = world();
    world.add(ground());
    let speed = 0.01;
    let body = world.add(cube().at(0.0, 0.5, 0.0).moving(0.0, -speed as f32, 0.0));
    run(&mut world, 10);
    // It is stopped at the start of a substep, before gravity has done its work.
    let posts = posts(&world);
    let gained = 2.0 * G * (0.5 - world[body].position().y) + posts.integration + posts.position_correction;
    assert_near(posts.loss_contact, 0.5 * 2.0 * speed * speed + gained, 1e-6);
    assert!(posts.loss_contact > 1e-4, "{}", world.ledger());
    assert!(posts.loss_restitution == 0.0 && posts.loss_rest_capture.abs() < 1e-12, "{}", world.ledger());
}

#[test]
fn bounces_too_slow_to_be_resolved_are_rest_capture() {
    let mut world = world();
    world.add(ground().friction(0.0).restitution(0.8));
    world.add(ball().at(0.0, 0.6, 0.0).restitution(0.8));
    run(&mut world, 240);
    let posts = posts(&world);
    assert!((1e-6..1e-3).contains(&posts.loss_rest_capture), "{}", world.ledger());
    let lost =
        posts.loss_restitution + posts.loss_rest_capture - posts.position_correction - posts.integration;
    assert_near(lost, 0.1 * G, 1e-3 * G);
    let worst = world.ledger().worst_artefact().expect("the ball was captured");
    assert_eq!(worst.body.map(|body| body.index()), Some(1));
}

#[test]
fn damping_takes_its_share_and_its_momentum() {
    let mut world = weightless();
    let mut body = cube().moving(3.0, 0.0, 4.0).spinning(0.0, 2.0, 0.0);
    (body.linear_damping, body.angular_damping) = (0.5, 1.5);
    world.add(body.at(1.0, 2.0, 3.0));
    run(&mut world, 60);
    let inertia = 2.0 / 6.0;
    let linear = 25.0 * (1.0 - (-1.0_f64).exp());
    let angular = 0.5 * inertia * 4.0 * (1.0 - (-3.0_f64).exp());
    assert_near(posts(&world).loss_damping, linear + angular, 1e-9);
    let taken = posts(&world).external.linear;
    assert_near(taken.x, -6.0 * (1.0 - (-0.5_f64).exp()), 1e-9);
    assert_near(taken.z, -8.0 * (1.0 - (-0.5_f64).exp()), 1e-9);
}

#[test]
fn a_parachute_loses_to_damping_what_it_does_not_gain() {
    for damping in [1e-6, 1e-3, 0.4, 5.0, 400.0] {
        let mut world = world();
        let mut body = cube().at(30.0, 1000.0, -20.0).moving(8.0, 1.0, 2.0);
        body.linear_damping = damping;
        world.add(body);
        run(&mut world, 120);
        assert!(posts(&world).loss_damping > 0.0);
    }
}

#[test]
fn a_belt_works_twice_what_the_box_gains() {
    let mut world = world();
    let belt = Body::kinematic().with(Shape::cuboid(50.0, 1.0, 4.0)).at(0.0, -0.5, 0.0).moving(2.0, 0.0, 0.0);
    world.add(belt.friction(0.5));
    let flat = Body::dynamic().with(Shape::cuboid(1.0, 0.2, 1.0)).mass(2.0).friction(0.5);
    let carried = world.add(flat.at(0.0, 0.1, 0.0));
    run(&mut world, 90);
    assert_near(world[carried].linear_velocity().x.into(), 2.0, 1e-5);
    let posts = posts(&world);
    assert_near(posts.work_kinematic, 2.0 * 4.0, 0.02);
    assert_near(posts.loss_friction, 4.0, 0.02);
    assert_near(posts.kinematic.linear.x, 4.0, 1e-4);
    assert_eq!(posts.fixed.linear, DVec3::ZERO);
}

#[test]
fn a_bat_that_nothing_stops_works() {
    let mut world = weightless();
    world.add(Body::kinematic().with(Shape::cuboid(0.2, 2.0, 2.0)).moving(5.0, 0.0, 0.0).restitution(1.0));
    let struck = world.add(ball().at(1.5, 0.0, 0.0).restitution(1.0));
    run(&mut world, 60);
    assert_near(world[struck].linear_velocity().x.into(), 10.0, 1e-5);
    let posts = posts(&world);
    assert_near(posts.work_kinematic, 50.0, 1e-9);
    assert_near(posts.kinematic.linear.x, 10.0, 1e-9);
    assert_near(posts.loss_restitution, 0.0, 1e-9);
}

#[test]
fn overlaps_pushed_out_are_position_correction() {
    let mut world = world();
    world.add(ground());
    let body = world.add(cube().at(0.0, 0.49, 0.0));
    run(&mut world, 60);
    let raised = world[body].position().y - 0.49;
    assert_near(raised, 0.01, 1e-4);
    assert_near(posts(&world).position_correction, 2.0 * G * raised, 1e-3);
}

#[test]
fn a_tumbling_body_is_integrated_well() {
    let mut world = weightless();
    let book = Body::dynamic().with(Shape::cuboid(0.2, 1.0, 0.6)).spinning(0.1, 0.1, 10.0);
    world.add(book.at(3.0, 0.0, 1.0).moving(0.0, 1.0, 0.0));
    run(&mut world, 600);
    let ledger = world.ledger();
    let energy = ledger.total().end.total_energy();
    assert!(ledger.artefacts() < 1e-4 * energy, "{ledger}");
    assert_near(posts(&world).integration, energy - ledger.total().start.total_energy(), 1e-9 * energy);
    assert_eq!(posts(&world).external.angular, DVec3::ZERO);
}
