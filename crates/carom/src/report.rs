//! What a step has to tell.

mod rounds;

pub use rounds::{instants, round_of, rounds};

use crate::bodies::BodyId;
use crate::conditions::{Hit, STORED};
use crate::impulse::{Contact, Resolution, Side, Velocity, resolve};
use crate::math::{DVec3, Pose};

/// Where on a shape a contact lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A smooth surface: a ball, a capsule's side, a plane.
    Surface,
    /// A corner, numbered by the shape. A cuboid's corner has bit 0, 1, 2 set where x, y, z is positive.
    Vertex(u32),
    /// An edge, numbered by the shape.
    Edge(u32),
    /// A flat face, numbered by the shape. A cuboid's faces are −x, +x, −y, +y, −z, +z.
    Face(u32),
}

impl Feature {
    /// A number that tells features of a shape apart, up to 2³⁰ of each kind.
    pub(crate) fn key(self) -> u32 {
        match self {
            Feature::Surface => 0,
            Feature::Vertex(number) => number << 2 | 1,
            Feature::Edge(number) => number << 2 | 2,
            Feature::Face(number) => number << 2 | 3,
        }
    }
}

/// A collider that was in a sensor at some time of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlap {
    /// The body with the sensor.
    pub sensor: BodyId,
    /// Which of its colliders.
    pub sensor_collider: u32,
    /// The body that was in it.
    pub visitor: BodyId,
    /// Which of its colliders.
    pub visitor_collider: u32,
}

/// What happened in a step.
#[derive(Clone, Debug, Default)]
pub struct StepReport {
    pub(crate) impacts: Vec<Impact>,
    pub(crate) overlaps: Vec<Overlap>,
    pub(crate) quarantined: Vec<BodyId>,
    pub(crate) contacts: usize,
}

impl StepReport {
    /// The collisions, ordered by (time, a, b).
    pub fn impacts(&self) -> &[Impact] {
        &self.impacts
    }

    /// What was in sensors at any time of the step, however fast it passed, in order of its fields.
    pub fn overlaps(&self) -> &[Overlap] {
        &self.overlaps
    }

    /// How many pairs of bodies touch at the end of the step.
    pub fn contacts(&self) -> usize {
        self.contacts
    }

    /// Bodies taken out of the simulation in this step, since their state was no longer finite or never was valid.
    pub fn quarantined(&self) -> &[BodyId] {
        &self.quarantined
    }

    /// Takes the impacts of a step that began at `start`, with rounds that ascend in the order in which they were carried out:
    /// counts rounds and contacts for each instant, puts impacts in order and dates them.
    pub(crate) fn record(&mut self, mut impacts: Vec<Impact>, start: f64) {
        rounds::number(&mut impacts);
        impacts.sort_by(|x, y| x.time.total_cmp(&y.time).then((x.a, x.b, x.round).cmp(&(y.a, y.b, y.round))));
        for impact in &mut impacts {
            impact.time += start;
        }
        self.impacts = impacts;
    }
}

/// A collision that was resolved: a first touch of two bodies that closed faster than the rest threshold.
///
/// Holds all that the seed's formula needs, so that [`Impact::resolve`] gives its five steps again.
#[derive(Clone, Debug, PartialEq)]
pub struct Impact {
    /// Simulated time at which it happened, s.
    pub time: f64,
    /// The body of the lower index: in a scene, the one that is listed first.
    pub a: BodyId,
    /// The other body.
    pub b: BodyId,
    /// Which of `a`'s colliders was struck.
    pub collider_a: u32,
    /// Which of `b`'s colliders was struck.
    pub collider_b: u32,
    /// What of `a` was struck.
    pub feature_a: Feature,
    /// What of `b` was struck.
    pub feature_b: Feature,
    /// Where, in the world, m.
    pub point: DVec3,
    /// Distance of the surfaces along the normal at that instant, m: rounding, above or below zero.
    pub separation: f64,
    /// Normal (from `a` to `b`), C_r and friction as used.
    pub contact: Contact,
    /// `a` as it came.
    pub side_a: Side,
    /// `b` as it came.
    pub side_b: Side,
    /// Centre of mass and orientation of `a`'s frame at that instant.
    pub pose_a: Pose,
    /// Centre of mass and orientation of `b`'s frame at that instant.
    pub pose_b: Pose,
    /// `a` as it left, read back from what the engine has stored.
    pub after_a: Velocity,
    /// `b` as it left.
    pub after_b: Velocity,
    /// f as it was carried out: the impulse along the normal, N·s. Struck alone, that of [`Impact::resolve`].
    pub fraction: f64,
    /// The impulse across the normal that `b` got, N·s; `a` got its opposite.
    pub friction_impulse: DVec3,
    /// Whether friction brought the points to a common tangential velocity.
    pub sticks: bool,
    /// How many contacts were struck at that instant together with this one, itself included.
    pub together: u32,
    /// In which round of that instant this one was resolved, from 0.
    pub round: u32,
}

impl Impact {
    /// v_s: speed of `b` against `a` along the normal as they left, m/s; negative if they still close.
    pub fn separating_speed(&self) -> f64 {
        (self.after_b.at(self.side_b.arm) - self.after_a.at(self.side_a.arm)).dot(self.contact.normal)
    }

    /// The impulse that `b` got, N·s; `a` got its opposite.
    pub fn impulse(&self) -> DVec3 {
        self.fraction * self.contact.normal + self.friction_impulse
    }

    /// The seed's five steps for this collision if it were alone, in double precision.
    pub fn resolve(&self) -> Resolution {
        resolve(&self.side_a, &self.side_b, &self.contact)
    }

    /// The collision as the engine has carried it out, for [`conditions`](crate::conditions::conditions).
    pub fn hit(&self) -> Hit {
        Hit {
            point: self.point,
            contact: self.contact,
            a: self.side_a,
            b: self.side_b,
            after_a: self.after_a,
            after_b: self.after_b,
            rounding: STORED,
        }
    }
}

/// One line: when, where, how fast, and with which impulse.
impl std::fmt::Display for Impact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let closing_speed = self.resolve().closing_speed;
        let separating_speed = self.separating_speed();
        let fraction = self.fraction;
        let [x, y, z] = self.point.to_array();
        write!(
            f,
            "{:.6} s: body {} and body {} at ({x:.4}, {y:.4}, {z:.4}) m close with {:.6} m/s; C_r = {}, f = {fraction:.6} N·s; \
             they part with {separating_speed:.6} m/s",
            self.time,
            self.a.index(),
            self.b.index(),
            -closing_speed,
            self.contact.restitution,
        )
    }
}
