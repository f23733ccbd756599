//! Bodies and their colliders.

use super::cursor::{Cursor, Object};
use super::files::Files;
use super::materials::{Materials, SURFACE_KEYS, SurfaceKeys};
use super::shapes;
use super::tree::{Json, number};
use crate::SceneError;
use carom::math::{DQuat, DVec3, Pose, Vec3};
use carom::{Accepts, Body, Collider, Filter, Groups, Invalid, Motion, PrincipalInertia, Shape, limits};
use std::collections::HashMap;

const BODY_KEYS: [&str; 14] = [
    "name",
    "motion",
    "position",
    "rotation",
    "linear_velocity",
    "angular_velocity",
    "linear_damping",
    "angular_damping",
    "gravity_factor",
    "mass",
    "center_of_mass",
    "inertia_diagonal",
    "inertia_orientation",
    "colliders",
];

const COLLIDER_KEYS: [&str; 8] =
    ["shape", "position", "rotation", "density", "material", "sensor", "groups", "collides_with"];

const MOTIONS: [(&str, Motion); 3] =
    [("dynamic", Motion::Dynamic), ("static", Motion::Fixed), ("kinematic", Motion::Kinematic)];

/// What bodies share: the scene's materials, shapes from files, and numbers for the names of groups.
pub(super) struct Shared {
    materials: Materials,
    files: Files,
    groups: HashMap<String, u32>,
}

impl Shared {
    pub(super) fn new(materials: Materials, files: Files) -> Self {
        Self { materials, files, groups: HashMap::new() }
    }

    fn groups(&mut self, list: &Cursor<'_>) -> Result<Groups, SceneError> {
        let mut numbers = Vec::new();
        for name in list.list("names of groups")? {
            let name = name.text("the name of a group")?;
            let next = self.groups.len() as u32;
            let number = match self.groups.get(name) {
                Some(&number) => number,
                None => *self.groups.entry(name.to_owned()).or_insert(next),
            };
            numbers.push(number);
        }
        Ok(Groups::new(numbers))
    }
}

/// Reads one body, all but its name.
pub(super) fn read(body: &Cursor<'_>, shared: &mut Shared) -> Result<Body, SceneError> {
    let object = body.object()?;
    object.only(&BODY_KEYS)?;
    let motion = object.optional("motion", |motion| motion.choice(&MOTIONS))?.unwrap_or_default();
    let mut read = match motion {
        Motion::Dynamic => Body::dynamic(),
        Motion::Fixed => Body::fixed(),
        Motion::Kinematic => Body::kinematic(),
    };
    read.position = object.optional("position", Cursor::position)?.unwrap_or(read.position);
    read.rotation = object.optional("rotation", Cursor::rotation)?.unwrap_or(DQuat::IDENTITY).as_quat();
    read.linear_velocity = velocity(&object, "linear_velocity", "m/s", motion)?;
    read.angular_velocity = velocity(&object, "angular_velocity", "rad/s", motion)?;
    let damping = |key| object.optional(key, |damping| damping.not_negative("1/s"));
    read.linear_damping = damping("linear_damping")?.unwrap_or(read.linear_damping);
    read.angular_damping = damping("angular_damping")?.unwrap_or(read.angular_damping);
    read.gravity_factor =
        object.optional("gravity_factor", |factor| factor.finite(""))?.unwrap_or(read.gravity_factor);
    if let Some(colliders) = object.get("colliders") {
        for collider in colliders.list("colliders")? {
            read.colliders.push(read_collider(&collider, motion, shared)?);
        }
    }
    read_mass(&object, &mut read)?;
    match read.check() {
        Ok(()) => Ok(read),
        Err(invalid) => Err(locate(body, invalid)),
    }
}

/// A velocity in single precision, as the engine keeps it. A static body has none.
fn velocity(object: &Object<'_>, key: &str, unit: &str, motion: Motion) -> Result<Vec3, SceneError> {
    let Some(velocity) = object.get(key) else { return Ok(Vec3::ZERO) };
    let read = velocity.vector_within(limits::SPEED, unit)?;
    if motion == Motion::Fixed && read != DVec3::ZERO {
        return Err(velocity.refuse("[0, 0, 0] on a static body; one that moves by itself is kinematic"));
    }
    Ok(read.as_vec3())
}

/// Reads mass, centre of mass and inertia into `body`, whose colliders are there already.
fn read_mass(object: &Object<'_>, body: &mut Body) -> Result<(), SceneError> {
    let own = ["mass", "center_of_mass", "inertia_diagonal", "inertia_orientation"];
    let mut given = own.iter().filter_map(|key| object.get(key));
    if body.motion != Motion::Dynamic {
        let word = if body.motion == Motion::Fixed { "static" } else { "kinematic" };
        return given.next().map_or(Ok(()), |value| {
            Err(value.refuse(format!("no such key on a {word} body, which nothing can push")))
        });
    }
    body.mass = object.optional("mass", mass)?;
    body.center_of_mass = object.optional("center_of_mass", Cursor::position)?;
    let orientation = object.optional("inertia_orientation", Cursor::rotation)?;
    let diagonal = object.optional("inertia_diagonal", |list| {
        list.vector("moments of inertia", |item| item.not_negative("kg·m²"))
    })?;
    body.inertia = match (diagonal, orientation) {
        (Some(diagonal), orientation) => {
            Some(PrincipalInertia { diagonal, orientation: orientation.unwrap_or(DQuat::IDENTITY) })
        }
        (None, None) => None,
        (None, Some(_)) => {
            return Err(object
                .at
                .refuse_lack("inertia_diagonal", "the moments that inertia_orientation turns"));
        }
    };
    if body.mass.is_some() {
        return Ok(());
    }
    if let Some(alone) = given.next() {
        return Err(alone.refuse("this key only together with mass"));
    }
    let solid = || body.colliders.iter().filter(|collider| !collider.sensor);
    if solid().next().is_none() {
        return Err(object.at.refuse_lack("mass", "a mass in kg, since no collider gives the body any"));
    }
    if solid().any(|collider| matches!(collider.shape, Shape::Mesh(_))) {
        return Err(object.at.refuse_lack("mass", "a mass in kg, since a mesh has none of its own"));
    }
    Ok(())
}

fn mass(mass: &Cursor<'_>) -> Result<f64, SceneError> {
    let value = mass.finite("kg").unwrap_or(-1.0);
    if value == 0.0 || limits::MASS.contains(&value) {
        return Ok(value);
    }
    let (low, high) = (number(*limits::MASS.start()), number(*limits::MASS.end()));
    Err(mass.refuse(format!("a number from {low} to {high} kg, or 0 for infinite")))
}

fn read_collider(collider: &Cursor<'_>, motion: Motion, shared: &mut Shared) -> Result<Collider, SceneError> {
    let object = collider.object()?;
    object.only(&[COLLIDER_KEYS.as_slice(), SURFACE_KEYS.as_slice()].concat())?;
    let shape = object.require("shape", "a shape, such as {\"type\": \"sphere\", \"radius\": 0.5}")?;
    let mut read = Collider::new(shapes::read(&shape, &mut shared.files)?);
    if motion != Motion::Fixed
        && let Some(name) = read.shape.only_fixed()
    {
        let tag = shape.object()?.require("type", "a type")?;
        return Err(tag.refuse(format!("another shape; a {name} only on a static body")));
    }
    read.pose = Pose {
        position: object.optional("position", Cursor::position)?.unwrap_or(DVec3::ZERO),
        rotation: object.optional("rotation", Cursor::rotation)?.unwrap_or(DQuat::IDENTITY),
    };
    read.density =
        object.optional("density", |density| density.not_negative("kg/m³"))?.unwrap_or(read.density);
    let material = object.optional("material", |name| shared.materials.named(name))?.unwrap_or_default();
    read.material = SurfaceKeys::read(&object)?.over(material);
    read.sensor = object.optional("sensor", Cursor::boolean)?.unwrap_or(read.sensor);
    read.filter = Filter {
        groups: object.optional("groups", |list| shared.groups(list))?.unwrap_or_default(),
        accepts: match object.optional("collides_with", |list| shared.groups(list))? {
            Some(groups) => Accepts::AnyOf(groups),
            None => Accepts::All,
        },
    };
    Ok(read)
}

/// The engine's complaint about a body, at the place of the file that it is about.
///
/// The engine and the format mostly use the same words. Where they differ, the nearest place that the file has goes
/// in their stead: a cone's `radius_bottom` is the file's `radius`, a coefficient may come from the material.
fn locate(body: &Cursor<'_>, invalid: Invalid) -> SceneError {
    let field = invalid.field.replace("inertia.diagonal", "inertia_diagonal");
    let field = field.replace("inertia.orientation", "inertia_orientation");
    let field = match field.rsplit_once('.') {
        Some((outer, "radius_bottom" | "radius_top")) if value_at(body.value, &field).is_none() => {
            format!("{outer}.radius")
        }
        Some((outer, key)) if outer.ends_with("].material") => {
            let collider = outer.trim_end_matches(".material");
            let both = if key.ends_with("_friction") { "friction" } else { key };
            let own = [format!("{collider}.{key}"), format!("{collider}.{both}")];
            own.into_iter().find(|own| value_at(body.value, own).is_some()).unwrap_or(outer.to_owned())
        }
        _ => field,
    };
    // Of all colliders together the engine says more than the file.
    let in_file = value_at(body.value, &field).filter(|_| field != "colliders");
    let value = in_file.map_or(invalid.value, ToString::to_string);
    let path = if field.is_empty() { body.path.to_string() } else { format!("{}.{field}", body.path) };
    SceneError::invalid(body.file, path, value, invalid.expected)
}

/// The value at `path`, written like `colliders[0].shape`, below `value`.
fn value_at<'v>(value: &'v Json, path: &str) -> Option<&'v Json> {
    path.split(['.', '[']).try_fold(value, |value, step| match (value, step.strip_suffix(']')) {
        (Json::List(items), Some(index)) => items.get(index.parse::<usize>().ok()?),
        (_, None) => value.get(step),
        _ => None,
    })
}
