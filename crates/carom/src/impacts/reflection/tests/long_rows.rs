//! Rounds that take many sweeps.

use super::*;

/// A hundred sweeps with friction left balls of a long row closing.
#[test]
fn what_is_struck_with_friction_in_a_long_row_closes_no_more() {
    let slant = DVec3::new(0.8, 0.6, 0.0);
    let movers: Vec<Mover> =
        (0..40).map(|index| ball(1.0, if index == 0 { slant } else { DVec3::ZERO })).collect();
    let rough = |spot: Spot| Spot {
        contact: Contact { static_friction: 0.5, dynamic_friction: 0.5, ..spot.contact },
        ..spot
    };
    let spots: Vec<Spot> = (1..40).map(|index| rough(between([index - 1, index], DVec3::X, 0.0))).collect();
    let blows = reflect(
        &movers,
        &spots,
        Start { blows: &[], negligible: 1e-9, sweeps: usize::MAX, is_glance: false },
    );
    let after = velocities_after(&movers, &spots, &blows);
    let slowest = spots
        .iter()
        .map(|spot| spot.velocity(|mover| after[mover]).dot(spot.contact.normal))
        .fold(0.0, f64::min);
    assert!(slowest > -1e-6, "{slowest} m/s");
}

/// Two hundred sweeps that make haste come to where two hundred others are not nearly yet.
#[test]
fn sweeps_that_make_haste_come_to_the_same_velocities_sooner() {
    let mut random = Random(3);
    let movers: Vec<Mover> = (0..40)
        .map(|index| ball(random.range(0.5, 2.0), if index == 0 { DVec3::X } else { DVec3::ZERO }))
        .collect();
    let spots: Vec<Spot> = (1..40).map(|index| between([index - 1, index], DVec3::X, 0.0)).collect();
    let after = |sweeps, negligible| {
        let blows = reflect(&movers, &spots, Start { blows: &[], negligible, sweeps, is_glance: false });
        velocities_after(&movers, &spots, &blows)
    };
    // All stick together: momentum tells how fast they are.
    let mass: f64 = movers.iter().map(|mover| mover.mass).sum();
    let truth = movers[0].mass / mass;
    let worst = |velocities: Vec<Velocity>| {
        velocities.iter().map(|velocity| (velocity.linear.x - truth).abs()).fold(0.0, f64::max)
    };
    let hasty = worst(after(200, 1e-12));
    assert!(hasty < 1e-7, "off by {hasty} m/s");
    let slow = worst(after(200, 0.0));
    assert!(slow > 1e-3, "{slow} m/s without haste");
}
