//! Materials by name, and what a collider says of its surface itself.

use super::cursor::{Cursor, Object};
use super::nearest::known;
use crate::SceneError;
use carom::{Combine, Material};
use std::collections::HashMap;

/// The keys of a surface, in a material as on a collider.
pub(super) const SURFACE_KEYS: [&str; 6] = [
    "friction",
    "static_friction",
    "dynamic_friction",
    "restitution",
    "friction_combine",
    "restitution_combine",
];

const COMBINE: [(&str, Combine); 4] = [
    ("average", Combine::Average),
    ("minimum", Combine::Minimum),
    ("maximum", Combine::Maximum),
    ("multiply", Combine::Multiply),
];

/// What a file says of one surface; the rest is left to whatever lies under it.
#[derive(Clone, Copy, Default)]
pub(super) struct SurfaceKeys {
    static_friction: Option<f64>,
    dynamic_friction: Option<f64>,
    restitution: Option<f64>,
    friction_combine: Option<Combine>,
    restitution_combine: Option<Combine>,
}

impl SurfaceKeys {
    /// Reads the surface keys of an object, which may have others too. `friction` stands for both coefficients;
    /// one that has its own key beside it goes by that.
    pub(super) fn read(object: &Object<'_>) -> Result<Self, SceneError> {
        let coefficient = |key| object.optional(key, |entry| entry.not_negative(""));
        let combine = |key| object.optional(key, |entry| entry.choice(&COMBINE));
        let both = coefficient("friction")?;
        Ok(Self {
            static_friction: coefficient("static_friction")?.or(both),
            dynamic_friction: coefficient("dynamic_friction")?.or(both),
            restitution: object.optional("restitution", |entry| entry.within(0.0..=1.0, ""))?,
            friction_combine: combine("friction_combine")?,
            restitution_combine: combine("restitution_combine")?,
        })
    }

    /// `under`, with what these keys say in its place.
    pub(super) fn over(&self, under: Material) -> Material {
        Material {
            static_friction: self.static_friction.unwrap_or(under.static_friction),
            dynamic_friction: self.dynamic_friction.unwrap_or(under.dynamic_friction),
            restitution: self.restitution.unwrap_or(under.restitution),
            friction_combine: self.friction_combine.or(under.friction_combine),
            restitution_combine: self.restitution_combine.or(under.restitution_combine),
        }
    }
}

/// The scene's materials.
#[derive(Default)]
pub(super) struct Materials {
    by_name: HashMap<String, Material>,
    /// In the order of the file, for errors.
    names: Vec<String>,
}

impl Materials {
    pub(super) fn read(materials: &Cursor<'_>) -> Result<Self, SceneError> {
        let mut read = Self::default();
        for (name, entry) in materials.object()?.entries() {
            let material = entry.object()?;
            material.only(&SURFACE_KEYS)?;
            let material = SurfaceKeys::read(&material)?.over(Material::default());
            read.by_name.insert(name.to_owned(), material);
            read.names.push(name.to_owned());
        }
        Ok(read)
    }

    /// The material that the text at `name` names.
    pub(super) fn named(&self, name: &Cursor<'_>) -> Result<Material, SceneError> {
        let text = name.text("the name of a material")?;
        self.by_name.get(text).copied().ok_or_else(|| {
            let known = known(text, self.names.iter().map(String::as_str));
            name.refuse(format!("one of the scene's materials {known}"))
        })
    }
}
