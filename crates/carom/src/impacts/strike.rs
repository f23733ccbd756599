//! The bodies at the instant of a touch, what impulses do to them, and the record of it.

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::collide::ContactPoint;
use crate::fault;
use crate::flight::fly_center;
use crate::impacts::reflection::{Blow, Mover, Spot};
use crate::impulse::Velocity;
use crate::math::{DMat3, DVec3, Pose};
use crate::report::Impact;
use crate::step::motion::state_at;

/// The body of a row as it will be at `time` within the step if nothing touches it before.
pub(crate) fn mover_at(bodies: &Bodies, row: usize, time: f64) -> Mover {
    let (state, constants) = (state_at(bodies, row, time), &bodies.constants[row]);
    let (inertia, inverse_inertia) = if constants.is_movable() {
        (constants.inertia(state.rotation), constants.inverse_inertia(state.rotation))
    } else {
        (DMat3::ZERO, DMat3::ZERO)
    };
    let velocity = Velocity { linear: state.velocity, angular: constants.angular_velocity(&state) };
    Mover { mass: 1.0 / constants.inverse_mass, inertia, inverse_inertia, velocity }
}

/// Its centre of mass and orientation at that time; those of the collider's body where the row is the world's.
pub(crate) fn pose_at(bodies: &Bodies, collider: &ColliderRow, time: f64) -> Pose {
    if collider.row == WORLD_ROW {
        return bodies.center_pose(collider);
    }
    let state = state_at(bodies, collider.row, time);
    Pose::new(state.position, state.rotation)
}

/// Its centre of mass alone.
pub(crate) fn center_at(bodies: &Bodies, collider: &ColliderRow, time: f64) -> DVec3 {
    let row = collider.row;
    if row == WORLD_ROW {
        return bodies.center_pose(collider).position;
    }
    let (state, flown) = (&bodies.states[row], time - bodies.clocks[row]);
    fly_center(state, &bodies.constants[row], &bodies.influences[row], flown.max(0.0)).0
}

/// The velocity of a row as it is stored.
pub(crate) fn velocity_of(bodies: &Bodies, row: usize) -> Velocity {
    let state = &bodies.states[row];
    Velocity { linear: state.velocity, angular: bodies.constants[row].angular_velocity(state) }
}

/// Gives the body of `row` an impulse (N·s) at `arm` from its centre of mass.
pub(crate) fn push(bodies: &mut Bodies, row: usize, arm: DVec3, impulse: DVec3) {
    push_and_turn(bodies, row, arm, [impulse, impulse]);
}

/// The same where only a part of it turns the body.
pub(crate) fn push_and_turn(bodies: &mut Bodies, row: usize, arm: DVec3, impulse_and_part: [DVec3; 2]) {
    if row != WORLD_ROW && bodies.constants[row].is_movable() {
        let [impulse, part] = impulse_and_part.map(|it| fault::lost_impulse(row, fault::normal(it)));
        bodies.states[row].velocity += impulse * bodies.constants[row].inverse_mass;
        bodies.states[row].angular_momentum += fault::lever_arm(arm).cross(part);
    }
}

/// The record of a spot that gets a blow, before it does; both rows must have been advanced to its instant.
pub(crate) fn record(
    bodies: &Bodies,
    (key_a, key_b): (u32, u32),
    touch: &ContactPoint,
    (movers, spot, blow): (&[Mover], &Spot, &Blow),
    (time, round): (f64, u32),
) -> Option<Impact> {
    let (a, b) = (bodies.collider(key_a)?, bodies.collider(key_b)?);
    let (side_a, side_b) = (spot.side(movers, 0), spot.side(movers, 1));
    Some(Impact {
        time,
        a: bodies.id_of(a.slot)?,
        b: bodies.id_of(b.slot)?,
        collider_a: a.index,
        collider_b: b.index,
        feature_a: touch.feature_a,
        feature_b: touch.feature_b,
        point: touch.point,
        separation: touch.separation,
        contact: spot.contact,
        side_a,
        side_b,
        pose_a: pose_at(bodies, a, time),
        pose_b: pose_at(bodies, b, time),
        after_a: side_a.velocity,
        after_b: side_b.velocity,
        fraction: blow.normal,
        friction_impulse: blow.tangent,
        sticks: blow.sticks,
        together: 1,
        round,
    })
}
