//! What collisions do.
//!
//! The impulse j at a point whose velocity it changes from u to u' does the work `j·½(u + u')`: of one contact alone, and of each of
//! several that act at once.

use super::journal::Journal;
use crate::bodies::{Bodies, BodyId, WORLD_ROW};
use crate::flight::Constants;
use crate::impulse::{Side, Velocity};
use crate::math::{DVec3, Pose};
use crate::report::Impact;

/// One of the two bodies of a collision.
struct Struck<'a> {
    row: usize,
    constants: &'a Constants,
    pose: &'a Pose,
    /// Where it was struck, and from its own centre.
    point: DVec3,
    arm: DVec3,
    /// Means of the velocities before and after.
    velocity: DVec3,
    spin: DVec3,
}

/// Books the collisions of a step.
pub(crate) fn book(bodies: &mut Bodies, impacts: &[Impact]) {
    let Some(mut journal) = bodies.journal.take() else { return };
    for impact in impacts {
        let point = impact.point;
        let a = struck(bodies, impact.a, (&impact.side_a, &impact.after_a), (&impact.pose_a, point));
        let b = struck(bodies, impact.b, (&impact.side_b, &impact.after_b), (&impact.pose_b, point));
        let along = impact.fraction * impact.contact.normal;
        journal.posts.loss_restitution -= journal.hit(&a, -along) + journal.hit(&b, along);
        let across = impact.friction_impulse;
        if across != DVec3::ZERO {
            journal.posts.loss_friction -= journal.hit(&a, -across) + journal.hit(&b, across);
        }
    }
    bodies.journal = Some(journal);
}

fn struck<'a>(
    bodies: &'a Bodies,
    id: BodyId,
    (side, after): (&Side, &Velocity),
    (pose, point): (&'a Pose, DVec3),
) -> Struck<'a> {
    let row = bodies.get(id).map_or(WORLD_ROW, |record| record.row);
    Struck {
        row,
        constants: &bodies.constants[row],
        pose,
        point,
        arm: side.arm,
        velocity: 0.5 * (side.velocity.linear + after.linear),
        spin: 0.5 * (side.velocity.angular + after.angular),
    }
}

impl Journal {
    /// A body gets an impulse; the work that this does.
    fn hit(&mut self, body: &Struck, impulse: DVec3) -> f64 {
        let turn = body.arm.cross(impulse);
        let (mut linear, mut moment) = (impulse, body.pose.position.cross(impulse) + turn);
        let work = impulse.dot(body.velocity) + turn.dot(body.spin);
        if !body.constants.is_movable() {
            let is_fixed = body.row == WORLD_ROW;
            let account = if is_fixed { &mut self.posts.fixed } else { &mut self.posts.kinematic };
            account.add(-linear, -body.point.cross(impulse));
            self.posts.work_kinematic -= work;
            return work;
        }
        let mut beyond = turn.dot(body.constants.driven_velocity(body.pose.rotation));
        if body.constants.inverse_mass == 0.0 {
            self.posts.kinematic.add(-linear, turn - moment);
            beyond += impulse.dot(body.velocity);
            (linear, moment) = (DVec3::ZERO, turn);
        }
        self.posts.work_kinematic -= beyond;
        self.gets(body.row, linear, moment, work - beyond);
        work
    }
}
