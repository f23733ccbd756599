//! What bodies were made from, as far as no other table has it.
//!
//! A [`Body`] and the list of its colliders take three times the room of what is particular to most: a place, velocities, one collider at
//! the origin. So of such a body only that is kept, and all of it is written out for whoever asks.

use super::{ColliderRow, Record};
use crate::body::{Body, Collider, Motion};
use crate::math::{DVec3, Pose, Quat, Vec3};
use std::sync::OnceLock;

/// What a body was made from: written out, or in short, or both.
#[derive(Clone, Debug)]
pub(crate) struct Description {
    whole: OnceLock<Box<Body>>,
    short: Option<Box<Short>>,
}

/// Of a body with one collider, all in which it differs from others, but for what the [`ColliderRow`] knows.
#[derive(Clone, Debug)]
struct Short {
    motion: Motion,
    position: DVec3,
    /// x, y, z, w.
    rotation: [f32; 4],
    linear_velocity: Vec3,
    angular_velocity: Vec3,
    mass: Option<f64>,
    density: f64,
    user_data: u64,
}

impl Description {
    /// Of a body whose colliders have rows, or have not.
    pub fn new(body: Body, has_rows: bool) -> Self {
        match Short::of(&body).filter(|_| has_rows) {
            Some(short) => Self { whole: OnceLock::new(), short: Some(Box::new(short)) },
            None => Self { whole: OnceLock::from(Box::new(body)), short: None },
        }
    }

    /// Sets what the user has stored with the body.
    pub fn set_user_data(&mut self, user_data: u64) {
        if let Some(whole) = self.whole.get_mut() {
            whole.user_data = user_data;
        }
        if let Some(short) = &mut self.short {
            short.user_data = user_data;
        }
    }
}

impl Record {
    /// What the body was made from; `collider` finds the row of a collider.
    pub fn description<'a>(&self, collider: impl Fn(u32) -> Option<&'a ColliderRow>) -> Option<&Body> {
        let Description { whole, short } = &self.description;
        if whole.get().is_none() {
            let row = self.colliders.first().and_then(|&key| collider(key))?;
            let body = Box::new(short.as_ref()?.written_out(row));
            return Some(whole.get_or_init(|| body));
        }
        whole.get().map(Box::as_ref)
    }
}

impl Short {
    fn of(body: &Body) -> Option<Self> {
        let [Collider { pose, density, .. }] = body.colliders[..] else { return None };
        let is_plain = body.name.is_empty()
            && [body.linear_damping, body.angular_damping, body.gravity_factor] == [0.0, 0.0, 1.0]
            && body.center_of_mass.is_none()
            && body.inertia.is_none()
            && pose == Pose::IDENTITY;
        is_plain.then_some(Self {
            motion: body.motion,
            position: body.position,
            rotation: body.rotation.to_array(),
            linear_velocity: body.linear_velocity,
            angular_velocity: body.angular_velocity,
            mass: body.mass,
            density,
            user_data: body.user_data,
        })
    }

    fn written_out(&self, collider: &ColliderRow) -> Body {
        let collider = Collider {
            shape: collider.shape.clone(),
            pose: Pose::IDENTITY,
            density: self.density,
            material: collider.material,
            filter: collider.filter.as_deref().cloned().unwrap_or_default(),
            sensor: collider.sensor,
        };
        Body {
            motion: self.motion,
            position: self.position,
            rotation: Quat::from_array(self.rotation),
            linear_velocity: self.linear_velocity,
            angular_velocity: self.angular_velocity,
            mass: self.mass,
            user_data: self.user_data,
            ..Body::dynamic().collider(collider)
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::bodies::Bodies;
    use crate::math::{DVec3, Quat};
    use crate::{Accepts, Body, Collider, Filter, Groups, Material, Shape};

    fn plain() -> Body {
        let mut collider = Collider::new(Shape::cuboid(1.0, 2.0, 3.0));
        collider.density = 700.0;
        collider.material = Material { restitution: 0.25, ..Material::default() };
        collider.filter = Filter { groups: Groups::new([3]), accepts: Accepts::NoneOf(Groups::new([4])) };
        let mut body = Body::kinematic().collider(collider).at(1.0, 2.0, 3.0).moving(4.0, 5.0, 6.0).mass(7.0);
        body = body.rotated(Quat::from_rotation_x(0.5)).spinning(0.1, 0.2, 0.3);
        body.user_data = 42;
        body
    }

    fn texts(body: &Body) -> (String, Option<String>) {
        let mut bodies = Bodies::new();
        let (id, _) = bodies.add(body.clone());
        bodies.get_mut(id).expect("it is there").description.set_user_data(body.user_data + 1);
        let mut expected = body.clone();
        expected.user_data += 1;
        (format!("{expected:?}"), bodies.description(id).map(|told| format!("{told:?}")))
    }

    #[test]
    fn what_was_written_down_is_told() {
        let mut others =
            vec![plain(), Body::fixed(), plain().named("a name"), plain().with(Shape::sphere(0.5))];
        let mut change = |change: fn(&mut Body)| {
            let mut body = plain();
            change(&mut body);
            others.push(body);
        };
        change(|body| body.linear_damping = 0.5);
        change(|body| body.angular_damping = 0.5);
        change(|body| body.gravity_factor = 0.5);
        change(|body| body.center_of_mass = Some(DVec3::X));
        change(|body| body.colliders[0].pose.position = DVec3::X);
        change(|body| body.colliders[0].sensor = true);
        change(|body| body.colliders[0].shape = Shape::sphere(-1.0));
        for body in others {
            let (expected, told) = texts(&body);
            assert_eq!(told, Some(expected));
        }
    }

    #[test]
    fn it_is_told_of_what_was_put_into_quarantine_as_well() {
        let mut bodies = Bodies::new();
        let (id, _) = bodies.add(plain());
        bodies.quarantine(0);
        let told = bodies.description(id).map(|told| format!("{told:?}"));
        assert_eq!(told, Some(format!("{:?}", plain())));
    }
}
