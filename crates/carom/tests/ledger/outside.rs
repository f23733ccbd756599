//! What comes from outside: forces, commands between steps, sleep, bodies that come and go; and the ledger itself.

use super::*;
use carom::math::DQuat;

#[test]
fn a_force_gives_impulse_and_work() {
    let mut world = weightless();
    let body = world.add(cube().at(0.0, 3.0, 0.0));
    for _ in 0..60 {
        world.body_mut(body).unwrap().add_force(DVec3::new(4.0, 0.0, 0.0)).unwrap();
        run(&mut world, 1);
    }
    let posts = posts(&world);
    assert_near(posts.external.linear.x, 4.0, 1e-12);
    assert_near(posts.external.angular.z, -12.0, 1e-12);
    assert_near(posts.work_external, 4.0, 1e-12);
}

#[test]
fn a_torque_gives_angular_momentum_and_work() {
    let mut world = weightless();
    let body = world.add(cube());
    for _ in 0..60 {
        world.body_mut(body).unwrap().add_torque(DVec3::Y).unwrap();
        run(&mut world, 1);
    }
    assert_near(posts(&world).external.angular.y, 1.0, 1e-12);
    assert_near(posts(&world).work_external, 0.5 * 6.0 / 2.0, 1e-12);
}

#[test]
fn a_hovering_body_shows_both_forces() {
    let mut world = world();
    let body = world.add(cube().at(5.0, 10.0, 0.0));
    for _ in 0..30 {
        world.body_mut(body).unwrap().add_force(DVec3::Y * 2.0 * G).unwrap();
        run(&mut world, 1);
    }
    assert_near(posts(&world).gravity.linear.y, -G, 1e-9);
    assert_near(posts(&world).external.linear.y, G, 1e-9);
    assert_near(posts(&world).work_external, 0.0, 1e-9);
}

#[test]
fn a_push_that_friction_holds_goes_into_the_ground() {
    let mut world = world();
    world.add(ground());
    let body = world.add(cube().at(0.0, 0.5, 0.0));
    run(&mut world, 30);
    let before = posts(&world).fixed.linear.x;
    for _ in 0..60 {
        world.body_mut(body).unwrap().add_force(DVec3::X * 3.0).unwrap();
        run(&mut world, 1);
    }
    assert_near(posts(&world).external.linear.x, 3.0, 1e-9);
    assert_near(posts(&world).fixed.linear.x - before, -3.0, 1e-5);
}

#[test]
fn what_is_done_between_steps_is_from_outside() {
    let mut world = weightless();
    let body = world.add(cube().at(0.0, 2.0, 0.0));
    run(&mut world, 2);
    assert_eq!(posts(&world).external.linear, DVec3::ZERO, "the start is no post");
    world.body_mut(body).unwrap().apply_impulse(DVec3::X * 6.0).unwrap();
    run(&mut world, 1);
    assert_near(posts(&world).external.linear.x, 6.0, 1e-12);
    assert_near(posts(&world).external.angular.z, -12.0, 1e-12);
    assert_near(posts(&world).work_external, 9.0, 1e-12);
    world.body_mut(body).unwrap().set_linear_velocity(DVec3::ZERO).unwrap();
    run(&mut world, 1);
    assert_near(posts(&world).work_external, 0.0, 1e-12);
}

#[test]
fn bodies_that_come_go_or_are_moved_come_from_outside() {
    let mut world = world();
    let body = world.add(cube().at(0.0, 100.0, 0.0));
    run(&mut world, 1);
    let late = world.add(cube().at(0.0, 50.0, 0.0).moving(1.0, 0.0, 0.0));
    run(&mut world, 1);
    assert_near(posts(&world).work_external, 2.0 * G * 50.0 + 1.0, 1e-9);
    assert_near(posts(&world).external.linear.x, 2.0, 1e-12);
    let height = world[late].position().y;
    let (at, turn) = (DVec3::new(0.0, height + 1.0, 0.0), DQuat::IDENTITY);
    world.body_mut(late).unwrap().teleport(at, turn).unwrap();
    run(&mut world, 1);
    assert_near(posts(&world).work_external, 2.0 * G * 51.0 + 1.0, 1e-9);
    world.remove(body);
    run(&mut world, 3);
    assert!(posts(&world).work_external < -800.0, "{}", world.ledger());
}

#[test]
fn sleep_takes_what_is_left() {
    let mut world = weightless();
    let body = world.add(cube().moving(3.0, 0.0, 0.0));
    run(&mut world, 1);
    world.body_mut(body).unwrap().put_to_sleep();
    run(&mut world, 1);
    assert_near(posts(&world).loss_sleep, 9.0, 1e-12);
    assert_near(posts(&world).fixed.linear.x, -6.0, 1e-12);
    assert_near(posts(&world).work_external, 0.0, 1e-12);
}

#[test]
fn a_lost_body_leaves_the_books_of_the_others_in_order() {
    let mut world = world();
    world.add(ground());
    world.add(cube().at(3.0, 0.5, 0.0));
    let ill = world.add(cube().at(-3.0, 0.5, 0.0));
    run(&mut world, 10);
    for _ in 0..4 {
        world.body_mut(ill).unwrap().apply_impulse(DVec3::X * f64::MAX).unwrap();
    }
    for _ in 0..60 {
        world.step(STEP);
    }
    assert!(!world.body_mut(ill).unwrap().is_active());
    run(&mut world, 10);
    let books = world.ledger().total();
    assert!(books.residual().energy.is_finite() && books.end.total_energy().is_finite(), "{books}");
}

#[test]
fn totals_are_the_sums_of_the_steps() {
    let mut world = world();
    world.add(ground().restitution(0.5));
    world.add(cube().at(0.0, 2.0, 0.0).spinning(1.0, 2.0, 3.0));
    let mut sum = Posts::default();
    for _ in 0..90 {
        run(&mut world, 1);
        sum += world.ledger().last_step().posts;
    }
    assert_eq!(world.ledger().steps(), 90);
    assert_eq!(sum, posts(&world));
    let text = world.ledger().to_string();
    assert!(text.contains("loss_restitution") && text.contains("unexplained"), "{text}");
}

#[test]
fn a_ledger_is_kept_when_asked_for_and_changes_nothing() {
    let scene = |ledger: bool| {
        let mut world = World::with_settings(Settings { ledger, ..Settings::default() });
        world.add(ground());
        for number in 0..12 {
            let at = f64::from(number);
            world.add(cube().at(0.1 * at, 1.0 + 1.3 * at, 0.05 * at));
        }
        for _ in 0..120 {
            world.step(STEP);
        }
        world
    };
    let (with, mut without) = (scene(true), scene(false));
    assert_eq!(with.state_hash(), without.state_hash());
    assert_eq!((with.ledger().steps(), without.ledger().steps()), (120, 0));
    assert_eq!(without.ledger().to_string(), "no steps in the books");
    without.keep_ledger(true);
    run(&mut without, 5);
    assert_eq!(without.ledger().steps(), 5);
    without.keep_ledger(false);
    without.step(STEP);
    assert_eq!(without.ledger().steps(), 0);
}

/// What bodies have is looked up from step to step. Asking for access to a body makes the ledger look at all of them: it finds the same.
#[test]
fn what_is_looked_up_is_what_is_found() {
    let books = [false, true].map(|looks| {
        let mut world = world();
        world.add(ground().restitution(0.5));
        let bodies = [0.6, 1.7, 4.0].map(|y| world.add(cube().at(0.1 * y, y, 0.0).spinning(0.0, 1.0, 0.5)));
        for step in 0..120 {
            if looks {
                let _ = world.body_mut(bodies[step % 3]);
            }
            run(&mut world, 1);
        }
        (*world.ledger().total(), *world.ledger().last_step(), world.ledger().worst_artefact().cloned())
    });
    assert_eq!(books[0], books[1]);
}

/// Whoever changes a body between steps, comes or goes is seen in the next step's books, and only there.
#[test]
fn the_books_begin_anew_with_whom_somebody_has_been_at() {
    let mut world = weightless();
    let body = world.add(cube().moving(1.0, 0.0, 0.0));
    run(&mut world, 3);
    world.body_mut(body).unwrap().set_linear_velocity(DVec3::X * 3.0).unwrap();
    let other = world.add(cube().at(0.0, 5.0, 0.0).moving(2.0, 0.0, 0.0));
    run(&mut world, 1);
    assert_near(world.ledger().last_step().posts.work_external, 9.0 - 1.0 + 4.0, 1e-12);
    run(&mut world, 1);
    assert_eq!(world.ledger().last_step().posts, Posts::default());
    world.remove(other);
    run(&mut world, 1);
    assert_near(world.ledger().last_step().posts.work_external, -4.0, 1e-12);
    assert_near(world.ledger().last_step().posts.external.linear.x, -4.0, 1e-12);
}
