//! The document's part of `KHR_physics_rigid_bodies`: materials and collision filters.

use super::json::{At, Document};
use crate::SceneError;
use carom::{Accepts, Combine, Filter, Groups, Material};
use std::collections::HashMap;

/// The name of the extension, in the document and on nodes.
pub(super) const PHYSICS: &str = "KHR_physics_rigid_bodies";

/// Materials and filters by their indices.
pub(super) struct Tables {
    pub materials: Vec<Material>,
    pub filters: Vec<Filter>,
}

impl Tables {
    /// Reads the document's part of the extension.
    pub fn read(document: &Document) -> Result<Self, SceneError> {
        let mut tables = Tables { materials: Vec::new(), filters: Vec::new() };
        let Some(extension) = document.root.dig(&["extensions", PHYSICS])? else { return Ok(tables) };
        extension.only(&["physicsMaterials", "collisionFilters", "physicsJoints"])?;
        if let Some(materials) = extension.get("physicsMaterials")? {
            tables.materials = materials.items()?.iter().map(material).collect::<Result<_, _>>()?;
        }
        if let Some(filters) = extension.get("collisionFilters")? {
            let mut systems = Systems::default();
            tables.filters =
                filters.items()?.iter().map(|at| systems.filter(at)).collect::<Result<_, _>>()?;
        }
        Ok(tables)
    }
}

fn material(at: &At) -> Result<Material, SceneError> {
    at.only(&[
        "name",
        "staticFriction",
        "dynamicFriction",
        "restitution",
        "frictionCombine",
        "restitutionCombine",
    ])?;
    let friction = |key: &str, default: f64| at.get(key)?.map_or(Ok(default), |at| at.not_negative(""));
    let combine = |key: &str| at.get(key)?.map(|at| rule(&at)).transpose();
    let default = Material::default();
    Ok(Material {
        static_friction: friction("staticFriction", default.static_friction)?,
        dynamic_friction: friction("dynamicFriction", default.dynamic_friction)?,
        restitution: at.get("restitution")?.map_or(Ok(default.restitution), |at| at.within(0.0..=1.0, ""))?,
        friction_combine: combine("frictionCombine")?,
        restitution_combine: combine("restitutionCombine")?,
    })
}

fn rule(at: &At) -> Result<Combine, SceneError> {
    match at.value.as_str() {
        Some("average") => Ok(Combine::Average),
        Some("minimum") => Ok(Combine::Minimum),
        Some("maximum") => Ok(Combine::Maximum),
        Some("multiply") => Ok(Combine::Multiply),
        _ => Err(at.error("average, minimum, maximum or multiply")),
    }
}

/// The names of collision systems, numbered as they turn up.
#[derive(Default)]
struct Systems(HashMap<String, u32>);

impl Systems {
    fn filter(&mut self, at: &At) -> Result<Filter, SceneError> {
        at.only(&["name", "collisionSystems", "collideWithSystems", "notCollideWithSystems"])?;
        let groups = at.get("collisionSystems")?.map(|at| self.groups(&at)).transpose()?.unwrap_or_default();
        let with = at.get("collideWithSystems")?.map(|at| self.groups(&at)).transpose()?;
        let accepts = match (with, at.get("notCollideWithSystems")?) {
            (Some(_), Some(not)) => return Err(not.error("no such key beside collideWithSystems")),
            (Some(with), None) => Accepts::AnyOf(with),
            (None, Some(not)) => Accepts::NoneOf(self.groups(&not)?),
            (None, None) => Accepts::All,
        };
        Ok(Filter { groups, accepts })
    }

    fn groups(&mut self, at: &At) -> Result<Groups, SceneError> {
        let mut numbers = Vec::new();
        for name in at.items()? {
            let next = self.0.len() as u32;
            numbers.push(*self.0.entry(name.text()?.to_owned()).or_insert(next));
        }
        Ok(Groups::new(numbers))
    }
}
