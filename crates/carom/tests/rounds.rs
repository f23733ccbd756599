//! The three conditions of what is resolved at once, against results that are known in closed form.

use carom::conditions::{Conditions, DOUBLE, Partner, Round, Strike};
use carom::impulse::{Contact, Velocity};
use carom::math::{DMat3, DVec3};
use carom::prelude::*;
use carom::report::{instants, round_of, rounds};

fn smooth(normal: DVec3, restitution: f64) -> Contact {
    Contact { normal, restitution, static_friction: 0.0, dynamic_friction: 0.0 }
}

fn moving(linear: DVec3) -> Velocity {
    Velocity { linear, angular: DVec3::ZERO }
}

const FLOOR: Partner = Partner {
    mass: f64::INFINITY,
    inertia: DMat3::ZERO,
    inverse_inertia: DMat3::ZERO,
    before: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
    after: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
};

/// A cube of 6 kg and 1 m lands flat with 2 m/s: each corner gets a quarter of (1 + C_r)·m·v.
fn landing(restitution: f64) -> Round {
    let cube = Partner {
        mass: 6.0,
        inertia: DMat3::IDENTITY,
        inverse_inertia: DMat3::IDENTITY,
        before: moving(DVec3::NEG_Y * 2.0),
        after: moving(DVec3::Y * 2.0 * restitution),
    };
    let corner = |x: f64, z: f64| {
        let point = DVec3::new(x, 0.0, z);
        Strike {
            partners: [0, 1],
            point,
            arms: [point, point - DVec3::Y * 0.5],
            contact: smooth(DVec3::Y, restitution),
            impulse: DVec3::Y * (3.0 * (1.0 + restitution)),
        }
    };
    let strikes = vec![corner(-0.5, -0.5), corner(-0.5, 0.5), corner(0.5, -0.5), corner(0.5, 0.5)];
    Round { partners: vec![FLOOR, cube], strikes, rounding: DOUBLE }
}

#[test]
fn a_cube_that_lands_flat() {
    for restitution in [0.0, 0.5, 1.0] {
        let round = landing(restitution);
        for corner in 0..4 {
            let laws = round.conditions(corner, DVec3::new(1.0, 2.0, 3.0));
            assert!(laws.hold(), "{laws:#?}");
            assert_eq!(laws.separating_speed.expected, 2.0 * restitution);
            assert_eq!(laws.energy.expected, 12.0 * restitution * restitution);
            assert_eq!(laws.linear_to_world, DVec3::NEG_Y * 12.0 * (1.0 + restitution));
        }
    }
}

fn broken(round: &Round) -> Vec<&'static str> {
    let Conditions { separating_speed, linear_momentum, angular_momentum, energy, .. } =
        round.conditions(0, DVec3::ZERO);
    let all = [
        ("speed", separating_speed.holds),
        ("linear", linear_momentum.holds),
        ("angular", angular_momentum.holds),
        ("energy", energy.holds),
    ];
    all.into_iter().filter(|(_, holds)| !holds).map(|(name, _)| name).collect()
}

#[test]
fn a_corner_without_its_impulse_and_a_bounce_that_is_off() {
    let mut round = landing(0.5);
    round.strikes[2].impulse = DVec3::ZERO;
    assert_eq!(broken(&round), ["linear", "angular", "energy"]);

    // C_r as of 0.6 with impulses to match: each corner parts fast enough, and only the energy tells.
    let mut round = landing(0.5);
    round.partners[1].after = moving(DVec3::Y * 1.2);
    round.strikes.iter_mut().for_each(|strike| strike.impulse = DVec3::Y * 4.8);
    assert_eq!(broken(&round), ["energy"]);

    let mut round = landing(0.5);
    round.partners[1].after = moving(DVec3::Y * 0.99);
    round.strikes.iter_mut().for_each(|strike| strike.impulse = DVec3::Y * 4.485);
    assert_eq!(broken(&round), ["speed", "energy"]);
}

/// Two contacts of different C_r: a ball of 1 kg falls between two walls at right angles, each impulse for its own wall.
#[test]
fn contacts_of_different_restitution() {
    let ball = Partner {
        mass: 1.0,
        inertia: DMat3::IDENTITY * 0.1,
        inverse_inertia: DMat3::IDENTITY * 10.0,
        before: moving(DVec3::new(-1.0, -1.0, 0.0)),
        after: moving(DVec3::new(0.2, 0.8, 0.0)),
    };
    let wall = |partner: usize, normal: DVec3, restitution: f64| Strike {
        partners: [partner, 2],
        point: DVec3::ZERO - 0.5 * normal,
        arms: [DVec3::ZERO, -0.5 * normal],
        contact: smooth(normal, restitution),
        impulse: (1.0 + restitution) * normal,
    };
    let strikes = vec![wall(0, DVec3::X, 0.2), wall(1, DVec3::Y, 0.8)];
    let round = Round { partners: vec![FLOOR, FLOOR, ball], strikes, rounding: DOUBLE };
    for strike in 0..2 {
        let laws = round.conditions(strike, DVec3::Z);
        assert!(laws.hold(), "{laws:#?}");
        assert!((laws.energy.expected - 0.5 * (0.04 + 0.64)).abs() < 1e-15);
    }
}

/// Three balls in a row, the first one moving, the others touching: two rounds of one instant, each of which keeps the laws.
#[test]
fn balls_in_a_row_pass_it_on_in_rounds() {
    let mut world = World::with_settings(carom::Settings { gravity: DVec3::ZERO, ..Default::default() });
    for (x, speed) in [(-2.0, 1.0), (0.0, 0.0), (1.0, 0.0)] {
        let ball = Body::dynamic().at(x, 0.0, 0.0).with(Shape::sphere(0.5)).moving(speed, 0.0, 0.0);
        world.add(ball.friction(0.0).restitution(1.0));
    }
    let mut impacts = Vec::new();
    while impacts.is_empty() {
        impacts = world.step(1.0 / 60.0).impacts().to_vec();
    }
    assert_eq!(instants(&impacts), [[0, 1]]);
    assert_eq!(rounds(&impacts), [[0], [1]]);
    for (index, impact) in impacts.iter().enumerate() {
        let (round, strike) = round_of(&impacts, index);
        assert_eq!(round.strikes.len(), 1);
        assert!(round.conditions(strike, DVec3::ZERO).hold());
        assert_eq!((impact.round, impact.together), (index as u32, 2));
    }
}
