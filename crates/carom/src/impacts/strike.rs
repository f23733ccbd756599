//! Carries out a collision: the seed's impulse at the instant of the touch, and the record of it.

use crate::bodies::{Bodies, ColliderRow, WORLD_ROW};
use crate::impacts::time_of_impact::Touch;
use crate::impulse::{Contact, Resolution, Side, Velocity, resolve};
use crate::material::Surface;
use crate::math::{DMat3, DVec3};
use crate::report::Impact;

/// A body at the instant of a touch, as the seed sees it. Its row must have been advanced to that instant.
pub(crate) fn side_of(bodies: &Bodies, collider: &ColliderRow, point: DVec3) -> Side {
    let row = collider.row;
    let (state, constants) = (&bodies.states[row], &bodies.constants[row]);
    let (inertia, inverse_inertia) = if constants.is_movable() {
        (constants.inertia(state.rotation), constants.inverse_inertia(state.rotation))
    } else {
        (DMat3::ZERO, DMat3::ZERO)
    };
    Side {
        mass: 1.0 / constants.inverse_mass,
        inertia,
        inverse_inertia,
        arm: point - bodies.center_pose(collider).position,
        velocity: velocity_of(bodies, row),
    }
}

fn velocity_of(bodies: &Bodies, row: usize) -> Velocity {
    let state = &bodies.states[row];
    Velocity { linear: state.velocity, angular: bodies.constants[row].angular_velocity(state) }
}

/// Gives the body of `row` an impulse (N·s) at `arm` from its centre of mass.
pub(crate) fn push(bodies: &mut Bodies, row: usize, arm: DVec3, impulse: DVec3) {
    if row != WORLD_ROW && bodies.constants[row].is_movable() {
        bodies.states[row].velocity += impulse * bodies.constants[row].inverse_mass;
        bodies.states[row].angular_momentum += arm.cross(impulse);
    }
}

/// Resolves the touch of two colliders with the seed's impulse; the record's `time` is that of the instant.
pub(crate) fn strike(
    bodies: &mut Bodies,
    (key_a, key_b): (u32, u32),
    touch: &Touch,
    surface: &Surface,
    time: f64,
) -> Option<Impact> {
    let (a, b) = (bodies.collider(key_a)?, bodies.collider(key_b)?);
    let (row_a, row_b) = (a.row, b.row);
    let contact = Contact {
        normal: touch.normal,
        restitution: surface.restitution,
        static_friction: surface.static_friction,
        dynamic_friction: surface.dynamic_friction,
    };
    let (side_a, side_b) = (side_of(bodies, a, touch.point), side_of(bodies, b, touch.point));
    let mut impact = Impact {
        time,
        a: bodies.id_of(a.slot)?,
        b: bodies.id_of(b.slot)?,
        collider_a: a.index,
        collider_b: b.index,
        feature_a: touch.contact.feature_a,
        feature_b: touch.contact.feature_b,
        point: touch.point,
        separation: touch.contact.separation,
        contact,
        side_a,
        side_b,
        pose_a: bodies.center_pose(a),
        pose_b: bodies.center_pose(b),
        after_a: side_a.velocity,
        after_b: side_b.velocity,
        fraction: 0.0,
        friction_impulse: DVec3::ZERO,
        sticks: false,
        together: 1,
        round: 0,
    };
    let Resolution { fraction, friction_impulse, sticks, .. } = resolve(&side_a, &side_b, &contact);
    (impact.fraction, impact.friction_impulse, impact.sticks) = (fraction, friction_impulse, sticks);
    let impulse = impact.impulse();
    push(bodies, row_a, side_a.arm, -impulse);
    push(bodies, row_b, side_b.arm, impulse);
    impact.after_a = velocity_of(bodies, row_a);
    impact.after_b = velocity_of(bodies, row_b);
    Some(impact)
}
