//! The five requirements of Smith et al. (2012), what mixed restitution, friction and ties keep, and that one contact is the seed's.

mod long_rows;
mod together;

use super::*;
use crate::impulse::{Contact, resolve};
use crate::math::DMat3;
use crate::random::Random;

const AT_ONCE: Start<'static> = Start { blows: &[], negligible: 0.0, sweeps: usize::MAX, is_glance: false };

fn ball(mass: f64, velocity: DVec3) -> Mover {
    let moment = 0.1 * mass;
    Mover {
        mass,
        inertia: DMat3::from_diagonal(DVec3::splat(moment)),
        inverse_inertia: DMat3::from_diagonal(DVec3::splat(1.0 / moment)),
        velocity: Velocity { linear: velocity, angular: DVec3::ZERO },
    }
}

fn wall() -> Mover {
    Mover {
        mass: f64::INFINITY,
        inertia: DMat3::ZERO,
        inverse_inertia: DMat3::ZERO,
        velocity: Velocity::default(),
    }
}

fn between(movers: [usize; 2], normal: DVec3, restitution: f64) -> Spot {
    let contact = Contact { normal, restitution, static_friction: 0.0, dynamic_friction: 0.0 };
    Spot { movers, arms: [0.5 * normal, -0.5 * normal], contact, pulls: false }
}

/// Round after round until nothing closes; how many it took.
fn settle(movers: &mut [Mover], spots: &[Spot]) -> usize {
    for round in 0..1000 {
        let closes = |spot: &&Spot| speed(movers, spot) < -1e-9;
        let closing: Vec<Spot> = spots.iter().filter(closes).copied().collect();
        if closing.is_empty() {
            return round;
        }
        apply(movers, &closing);
    }
    panic!("it does not end");
}

fn apply(movers: &mut [Mover], spots: &[Spot]) -> Vec<Blow> {
    let blows = reflect(movers, spots, AT_ONCE);
    let after = velocities_after(movers, spots, &blows);
    movers.iter_mut().zip(after).for_each(|(mover, velocity)| mover.velocity = velocity);
    blows
}

fn speed(movers: &[Mover], spot: &Spot) -> f64 {
    spot.velocity(|mover| movers[mover].velocity).dot(spot.contact.normal)
}

fn energy(movers: &[Mover]) -> f64 {
    let of = |mover: &Mover| {
        let Velocity { linear, angular } = mover.velocity;
        let moving = if mover.mass.is_finite() { mover.mass * linear.length_squared() } else { 0.0 };
        0.5 * (moving + angular.dot(mover.inertia * angular))
    };
    movers.iter().map(of).sum()
}

fn momentum(movers: &[Mover]) -> DVec3 {
    movers.iter().map(|mover| mover.mass * mover.velocity.linear).sum()
}

/// Balls in a row along x, of which the first `moving` come with 1 m/s.
fn cradle(count: usize, moving: usize) -> (Vec<Mover>, Vec<Spot>) {
    let velocity = |index: usize| if index < moving { DVec3::X } else { DVec3::ZERO };
    let movers = (0..count).map(|index| ball(1.0, velocity(index))).collect();
    (movers, (1..count).map(|index| between([index - 1, index], DVec3::X, 1.0)).collect())
}

#[test]
fn break_away_as_many_leave_a_cradle_as_come() {
    for (count, moving) in [(5, 1), (5, 2), (5, 3), (5, 4), (2, 1), (100, 1), (30, 11)] {
        let (mut movers, spots) = cradle(count, moving);
        settle(&mut movers, &spots);
        for (index, mover) in movers.iter().enumerate() {
            let wanted = if index >= count - moving { 1.0 } else { 0.0 };
            assert!((mover.velocity.linear.x - wanted).abs() < 1e-12, "{moving} of {count}: ball {index}");
        }
    }
}

#[test]
fn symmetry_a_ball_between_two_sends_both_off_alike() {
    let slant = DVec3::new(0.75f64.sqrt(), 0.5, 0.0);
    let mirrored = DVec3::new(slant.x, -slant.y, 0.0);
    for restitution in [0.0, 0.5, 1.0] {
        let mut movers = [ball(1.0, DVec3::X), ball(1.0, DVec3::ZERO), ball(1.0, DVec3::ZERO)];
        let spots = [between([0, 1], slant, restitution), between([0, 2], mirrored, restitution)];
        settle(&mut movers, &spots);
        let [cue, up, down] = movers.map(|mover| mover.velocity.linear);
        assert!((up.x - down.x).abs() < 1e-13 && (up.y + down.y).abs() < 1e-13, "{up} {down}");
        assert!(cue.y.abs() < 1e-13, "{cue}");
        // The closed form: both parting speeds are C_r times the closing speed, and momentum is kept.
        let each = (1.0 + restitution) * slant.x / 2.5;
        assert!((up - each * slant).length() < 1e-12, "{up} instead of {}", each * slant);
    }
}

/// A heap of balls and a floor: who touches whom at random.
fn heap(random: &mut Random, restitution: impl Fn(&mut Random) -> f64) -> (Vec<Mover>, Vec<Spot>) {
    let count = 3 + random.below(10);
    let mut movers: Vec<Mover> = (0..count)
        .map(|_| ball(random.range(0.1, 10.0), random.direction() * random.range(0.0, 3.0)))
        .collect();
    movers.push(wall());
    let mut spots = Vec::new();
    for _ in 0..2 * count {
        let (a, b) = (random.below(count), random.below(count + 1));
        if a != b {
            let mut spot = between([a, b], random.direction(), restitution(random));
            spot.arms = [random.direction(), random.direction()];
            spots.push(spot);
        }
    }
    (movers, spots)
}

/// The energy was bounded over all of a round: what slid in one corner of the world could pay for a gain in another.
#[test]
fn what_nothing_connects_keeps_its_own_books() {
    let mut random = Random(7);
    for number in 0..500 {
        let (mut movers, mut spots) = heap(&mut random, |random| random.range(0.0, 1.0));
        let first = movers.len();
        let (others, other_spots) = heap(&mut random, |_| 1.0);
        movers.extend(others);
        spots.extend(other_spots.into_iter().map(|mut spot| {
            spot.movers = spot.movers.map(|mover| mover + first);
            spot
        }));
        for spot in &mut spots {
            (spot.contact.static_friction, spot.contact.dynamic_friction) = (1.5, 1.0);
        }
        let spots: Vec<Spot> = spots.into_iter().filter(|spot| speed(&movers, spot) < -1e-9).collect();
        let before = [energy(&movers[..first]), energy(&movers[first..])];
        apply(&mut movers, &spots);
        let after = [energy(&movers[..first]), energy(&movers[first..])];
        for (before, after) in before.into_iter().zip(after) {
            assert!(after <= before * (1.0 + 1e-12), "case {number}: {before} J became {after} J");
        }
    }
}

#[test]
fn energy_is_kept_with_full_restitution_and_never_grows() {
    let mut random = Random(1);
    for number in 0..2000 {
        let kind = number % 3;
        let friction = if number % 2 == 0 { 0.0 } else { random.range(0.0, 2.0) };
        let (mut movers, mut spots) = heap(&mut random, |random| match kind {
            0 => 1.0,
            1 => random.range(0.0, 1.0),
            _ => 0.0,
        });
        for spot in &mut spots {
            (spot.contact.static_friction, spot.contact.dynamic_friction) = (friction, 0.7 * friction);
        }
        for _ in 0..20 {
            let before = energy(&movers);
            let closes = |spot: &&Spot| speed(&movers, spot) < -1e-9;
            let closing: Vec<Spot> = spots.iter().filter(closes).copied().collect();
            if closing.is_empty() {
                break;
            }
            apply(&mut movers, &closing);
            let change = energy(&movers) - before;
            assert!(change <= 1e-12 * before, "case {number} gains {change} J of {before}");
            if kind == 0 && friction == 0.0 {
                assert!(change.abs() <= 1e-12 * before, "case {number} loses {change} J of {before}");
            }
        }
    }
}

#[test]
fn momentum_is_kept_where_nothing_is_fixed() {
    let mut random = Random(2);
    for _ in 0..500 {
        let (mut movers, mut spots) = heap(&mut random, |random| random.range(0.0, 1.0));
        let floor = movers.len() - 1;
        spots.retain(|spot| !spot.movers.contains(&floor));
        movers.pop();
        let before = momentum(&movers);
        let scale: f64 = movers.iter().map(|mover| mover.mass * mover.velocity.linear.length()).sum();
        apply(&mut movers, &spots);
        assert!((momentum(&movers) - before).length() < 1e-12 * scale);
    }
}

#[test]
fn one_sidedness_contacts_push_and_part_at_least_as_told() {
    let mut random = Random(3);
    for number in 0..1000 {
        let (mut movers, spots) = heap(&mut random, |random| random.range(0.0, 1.0));
        let closing: Vec<Spot> = spots.iter().filter(|spot| speed(&movers, spot) < -1e-9).copied().collect();
        if closing.is_empty() {
            continue;
        }
        let before: Vec<f64> = closing.iter().map(|spot| speed(&movers, spot)).collect();
        let blows = apply(&mut movers, &closing);
        for ((spot, before), blow) in closing.iter().zip(before).zip(blows) {
            assert!(blow.normal >= 0.0, "case {number} pulls");
            let (wanted, parting) = (-spot.contact.restitution * before, speed(&movers, spot));
            // What touches at random arms may be all but fixed by the others: sweeps then take their time.
            assert!(parting > wanted - 2e-2 * before.abs(), "case {number}: {parting} instead of {wanted}");
        }
    }
}

#[test]
fn a_single_contact_is_the_seeds() {
    let mut random = Random(4);
    for _ in 0..200 {
        let (movers, mut spots) = heap(&mut random, |random| random.range(0.0, 1.0));
        spots.truncate(1);
        let Some(spot) = spots.first_mut() else { continue };
        (spot.contact.static_friction, spot.contact.dynamic_friction) = (0.6, 0.4);
        let seed = resolve(&spot.side(&movers, 0), &spot.side(&movers, 1), &spot.contact);
        let blow = Blow { normal: seed.fraction, tangent: seed.friction_impulse, sticks: seed.sticks };
        assert_eq!(reflect(&movers, &spots, AT_ONCE), [blow]);
    }
}

/// A cylinder that tipped onto the floor once closed by 4e-5 m/s, since the round had ended where that was good enough: a contact with
/// another body, which did not push in the end, had made it one of several.
#[test]
fn what_is_pushed_at_one_spot_gets_the_seeds_also_where_idle_spots_connect_it() {
    let falling = |x: f64| ball(1.0, DVec3::new(x, -2.0, 0.3));
    let movers = [wall(), falling(-1.0), falling(1.0)];
    let floor = |mover: usize| Spot {
        arms: [DVec3::ZERO, DVec3::new(0.3, -0.4, 0.1)],
        contact: Contact {
            static_friction: 0.3,
            dynamic_friction: 0.2,
            ..between([0, mover], DVec3::Y, 0.0).contact
        },
        ..between([0, mover], DVec3::Y, 0.0)
    };
    let spots = [floor(1), between([1, 2], DVec3::X, 0.0), floor(2)];
    let blows = reflect(&movers, &spots, Start { negligible: 0.1, sweeps: 2, ..AT_ONCE });
    assert!(!blows[1].acts(), "{:?}", blows[1]);
    for index in [0, 2] {
        assert_eq!(blows[index], Blow::alone(&movers, &spots[index]));
    }
}

/// A cube of 1 m and 1 kg over a floor, and its four lower corners.
fn cube(velocity: Velocity, friction: f64) -> ([Mover; 2], [Spot; 4]) {
    let inertia = DMat3::from_diagonal(DVec3::splat(1.0 / 6.0));
    let inverse_inertia = DMat3::from_diagonal(DVec3::splat(6.0));
    let corner = |x: f64, z: f64| {
        let mut spot = between([0, 1], DVec3::Y, 0.5);
        spot.arms = [DVec3::new(x, 0.0, z), DVec3::new(x, -0.5, z)];
        (spot.contact.static_friction, spot.contact.dynamic_friction) = (friction, friction);
        spot
    };
    let spots = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(-0.5, 0.5), corner(0.5, 0.5)];
    ([wall(), Mover { mass: 1.0, inertia, inverse_inertia, velocity }], spots)
}

#[test]
fn a_cube_that_lands_flat_goes_straight_up() {
    let falling = Velocity { linear: DVec3::new(0.0, -2.0, 0.0), angular: DVec3::ZERO };
    for friction in [0.0, 0.6] {
        let (mut movers, spots) = cube(falling, friction);
        apply(&mut movers, &spots);
        assert!((movers[1].velocity.linear - DVec3::Y).length() < 1e-12, "{:?}", movers[1].velocity);
        assert!(movers[1].velocity.angular.length() < 1e-12, "{:?}", movers[1].velocity);
    }
}

#[test]
fn a_cube_that_slides_as_it_lands_flat_is_braked_by_mu_times_what_it_lands_with() {
    let sliding = Velocity { linear: DVec3::new(4.0, -2.0, 0.0), angular: DVec3::ZERO };
    let (mut movers, spots) = cube(sliding, 0.1);
    let blows = apply(&mut movers, &spots);
    // All corners press: 3 N·s in all, and 0.3 N·s against the slip.
    let pressed: f64 = blows.iter().map(|blow| blow.normal).sum();
    assert!((pressed - 3.0).abs() < 1e-9, "{blows:?}");
    assert!(
        (movers[1].velocity.linear - DVec3::new(3.7, 1.0, 0.0)).length() < 1e-9,
        "{:?}",
        movers[1].velocity
    );
    assert!(blows[1].normal > blows[0].normal, "the leading corners press harder");
}

#[test]
fn a_needle_struck_with_friction_keeps_its_speed_also_beside_others() {
    // Push and friction by turns came near it only slowly, and were 4e-4 m/s off after a hundred turns.
    let mut random = Random(29);
    for _ in 0..2000 {
        let axis = random.direction();
        let moment = |along: f64, across: f64| {
            DMat3::IDENTITY * across
                + DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z) * (along - across)
        };
        let needle = Mover {
            inertia: moment(0.001, 0.08),
            inverse_inertia: moment(1000.0, 12.5),
            ..ball(1.0, random.vector(3.0))
        };
        let movers = [wall(), needle, ball(1.0, -DVec3::Y)];
        let friction = random.range(0.1, 1.0);
        let mut spots = [between([0, 1], random.direction(), 0.4), between([0, 2], DVec3::Y, 0.4)];
        spots[0].arms[1] = 0.5 * axis + random.vector(0.02);
        (spots[0].contact.static_friction, spots[0].contact.dynamic_friction) = (friction, friction);
        let before = speed(&movers, &spots[0]);
        if before >= 0.0 {
            continue;
        }
        let mut after = movers;
        let blows = apply(&mut after, &spots);
        let error = speed(&after, &spots[0]) + 0.4 * before;
        assert!(error.abs() <= 1e-9 * before.abs(), "{error:e} m/s of {before}");
        assert!(blows[0].tangent.length() <= friction * blows[0].normal * (1.0 + 1e-12), "{:?}", blows[0]);
        assert!(energy(&after) <= energy(&movers));
    }
}

#[test]
fn different_restitutions_are_each_kept() {
    let mut movers =
        [ball(1.0, DVec3::X), ball(1.0, DVec3::new(-2.0, 0.0, 0.0)), ball(1.0, DVec3::new(0.0, -1.0, 0.0))];
    let spots = [between([0, 1], DVec3::X, 0.8), between([0, 2], DVec3::Y, 0.3)];
    apply(&mut movers, &spots);
    for (spot, wanted) in spots.iter().zip([2.4, 0.3]) {
        assert!((speed(&movers, spot) - wanted).abs() < 1e-12);
    }
}

#[test]
fn what_is_tied_together_is_struck_as_one() {
    // Two balls on a rod, struck along it, part from the striker like one of twice the mass.
    let mut movers = [ball(1.0, DVec3::X), ball(1.0, DVec3::ZERO), ball(1.0, DVec3::ZERO)];
    let rod = Spot { pulls: true, ..between([1, 2], DVec3::X, 0.0) };
    apply(&mut movers, &[between([0, 1], DVec3::X, 1.0), rod]);
    for (mover, wanted) in movers.iter().zip([-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]) {
        assert!((mover.velocity.linear.x - wanted).abs() < 1e-12, "{:?}", mover.velocity);
    }
}
