//! A collision as a JSON object.

use carom::World;
use carom::conditions::{Condition, Conditions};
use carom::impulse::{UnitResponse, Velocity};
use carom::math::{DMat3, DVec3};
use serde::Serialize;

use crate::explain::Collision;
use crate::simulate::name_of;

type Vector = [f64; 3];

/// Something that each of the two bodies has.
#[derive(Serialize)]
struct Pair<T> {
    a: T,
    b: T,
}

#[derive(Serialize)]
struct VelocityJson {
    linear: Vector,
    angular: Vector,
}

#[derive(Serialize)]
struct ResponseJson {
    linear: Vector,
    angular: Vector,
    at_point: Vector,
}

#[derive(Serialize)]
struct FrictionImpulse {
    vector: Vector,
    sticks: bool,
}

#[derive(Serialize)]
struct Together {
    contacts: u32,
    round: u32,
    /// The numbers of the other collisions of the instant, in all rounds.
    others: Vec<u64>,
}

#[derive(Serialize)]
struct ConditionJson<T> {
    before: T,
    after: T,
    expected: T,
    error: f64,
    tolerance: f64,
    holds: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    to_world: Option<Vector>,
}

#[derive(Serialize)]
struct ConditionsJson {
    separating_speed: ConditionJson<f64>,
    linear_momentum: ConditionJson<Vector>,
    angular_momentum: ConditionJson<Vector>,
    energy: ConditionJson<f64>,
}

/// What `explain --json` prints on a line.
#[derive(Serialize)]
pub struct Explanation {
    index: u64,
    time: f64,
    a: String,
    b: String,
    point: Vector,
    normal: Vector,
    restitution: f64,
    friction: f64,
    /// None where infinite.
    mass: Pair<Option<f64>>,
    /// Row by row, in the world's axes; zero where infinite.
    inverse_inertia: Pair<[Vector; 3]>,
    lever_arm: Pair<Vector>,
    velocity_before: Pair<VelocityJson>,
    velocity_after: Pair<VelocityJson>,
    closing_speed: f64,
    unit_response: Pair<ResponseJson>,
    fraction: f64,
    friction_impulse: FrictionImpulse,
    separating_speed: f64,
    together: Together,
    conditions: ConditionsJson,
    reference_point: Vector,
}

impl Explanation {
    /// A collision in `world`, and how the laws held.
    pub fn new(world: &World, collision: &Collision, conditions: &Conditions) -> Self {
        let impact = &collision.impact;
        let (a, b) = (&impact.side_a, &impact.side_b);
        let resolution = impact.resolve();
        let contact = &impact.contact;
        let finite = |mass: f64| mass.is_finite().then_some(mass);
        Self {
            index: collision.index,
            time: impact.time,
            a: name_of(world, impact.a).to_owned(),
            b: name_of(world, impact.b).to_owned(),
            point: impact.point.to_array(),
            normal: contact.normal.to_array(),
            restitution: contact.restitution,
            friction: if impact.sticks { contact.static_friction } else { contact.dynamic_friction },
            mass: Pair { a: finite(a.mass), b: finite(b.mass) },
            inverse_inertia: Pair { a: rows(&a.inverse_inertia), b: rows(&b.inverse_inertia) },
            lever_arm: Pair { a: a.arm.to_array(), b: b.arm.to_array() },
            velocity_before: Pair { a: velocity(&a.velocity), b: velocity(&b.velocity) },
            velocity_after: Pair { a: velocity(&impact.after_a), b: velocity(&impact.after_b) },
            closing_speed: resolution.closing_speed,
            unit_response: Pair { a: response(&resolution.response_a), b: response(&resolution.response_b) },
            fraction: impact.fraction,
            friction_impulse: FrictionImpulse {
                vector: impact.friction_impulse.to_array(),
                sticks: impact.sticks,
            },
            separating_speed: conditions.separating_speed.after,
            together: Together {
                contacts: impact.together,
                round: impact.round,
                others: collision.others.iter().map(|(index, _)| *index).collect(),
            },
            conditions: ConditionsJson {
                separating_speed: scalar(&conditions.separating_speed),
                linear_momentum: vector(&conditions.linear_momentum, conditions.linear_to_world),
                angular_momentum: vector(&conditions.angular_momentum, conditions.angular_to_world),
                energy: scalar(&conditions.energy),
            },
            reference_point: conditions.reference_point.to_array(),
        }
    }
}

fn rows(tensor: &DMat3) -> [Vector; 3] {
    tensor.transpose().to_cols_array_2d()
}

fn velocity(velocity: &Velocity) -> VelocityJson {
    VelocityJson { linear: velocity.linear.to_array(), angular: velocity.angular.to_array() }
}

fn response(response: &UnitResponse) -> ResponseJson {
    ResponseJson {
        linear: response.linear.to_array(),
        angular: response.angular.to_array(),
        at_point: response.at_point.to_array(),
    }
}

fn scalar(condition: &Condition<f64>) -> ConditionJson<f64> {
    ConditionJson {
        before: condition.before,
        after: condition.after,
        expected: condition.expected,
        error: condition.error,
        tolerance: condition.tolerance,
        holds: condition.holds,
        to_world: None,
    }
}

fn vector(condition: &Condition<DVec3>, to_world: DVec3) -> ConditionJson<Vector> {
    ConditionJson {
        before: condition.before.to_array(),
        after: condition.after.to_array(),
        expected: condition.expected.to_array(),
        error: condition.error,
        tolerance: condition.tolerance,
        holds: condition.holds,
        to_world: Some(to_world.to_array()),
    }
}
