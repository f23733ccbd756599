//! The format `carom` 1: a scene as JSON that people write by hand.
//!
//! [`tree`] turns text into a document, [`cursor`] walks it with a path at hand, and one file for each part of a scene
//! reads what it knows. `schema.rs` says the same to editors, key by key.

mod bodies;
mod cursor;
mod files;
mod joints;
mod materials;
mod nearest;
mod path;
mod shapes;
mod tree;

pub(crate) use tree::Json;

use crate::{Scene, SceneError};
use bodies::Shared;
use carom::math::DVec3;
use carom::{Body, Settings};
use cursor::{Cursor, Object};
use files::Files;
use materials::Materials;
use std::collections::HashMap;
use std::path::Path;

/// The version of the format.
pub(crate) const VERSION: u32 = 1;
/// Length of a step where the scene says none, s.
pub(crate) const DEFAULT_DT: f64 = 1.0 / 60.0;
/// Lengths of a step, s.
pub(crate) const DT_RANGE: std::ops::RangeInclusive<f64> = 1e-6..=1.0;
/// Substeps of a step.
pub(crate) const SUBSTEPS_RANGE: std::ops::RangeInclusive<u32> = 1..=1000;
/// Each component of gravity, m/s², either sign.
pub(crate) const GRAVITY: f64 = 1e6;
/// How many bodies a scene may have.
pub(crate) const MAX_BODIES: usize = 10_000_000;

const SCENE_KEYS: [&str; 9] =
    ["carom", "name", "gravity", "dt", "substeps", "sleeping", "materials", "bodies", "joints"];

/// The scene in a document that was read from `file`; the files that it names are relative to `folder`.
pub(crate) fn scene(document: &Json, file: &str, folder: &Path) -> Result<Scene, SceneError> {
    let root = Cursor::root(file, document);
    let object = root.object()?;
    // The version first: all other keys are those of this version.
    object
        .require("carom", &format!("{VERSION}, the version of the format"))?
        .integer(VERSION..=VERSION)
        .map_err(|_| {
            object.get("carom").unwrap_or(root).refuse(format!("{VERSION}, the version of the format"))
        })?;
    object.only(&SCENE_KEYS)?;
    let name = object.optional("name", |name| name.text("the name of the scene").map(str::to_owned))?;
    let defaults = Settings::default();
    let settings = Settings {
        gravity: gravity(&object)?.unwrap_or(defaults.gravity),
        substeps: object
            .optional("substeps", |substeps| substeps.integer(SUBSTEPS_RANGE))?
            .unwrap_or(defaults.substeps),
        ..defaults
    };
    let dt = object.optional("dt", |dt| dt.within(DT_RANGE, "s"))?.unwrap_or(DEFAULT_DT);
    let sleeping = object.optional("sleeping", Cursor::boolean)?.unwrap_or(false);
    let materials = object.optional("materials", Materials::read)?.unwrap_or_default();
    let list = object.require("bodies", "a list of bodies")?;
    let bodies = bodies(&list, Shared::new(materials, Files::new(folder)))?;
    object.optional("joints", joints::read)?;
    let mut notes = Vec::new();
    if sleeping {
        notes.push(format!("{file}: sleeping: no effect yet; all bodies stay awake"));
    }
    Ok(Scene { name: name.unwrap_or_else(|| stem(file)), settings, dt, sleeping, bodies, notes })
}

fn gravity(object: &Object<'_>) -> Result<Option<DVec3>, SceneError> {
    object.optional("gravity", |gravity| gravity.vector_within(GRAVITY, "m/s²"))
}

/// What a scene without a name is called: its file, without folder and ending.
fn stem(file: &str) -> String {
    Path::new(file).file_stem().map_or_else(|| file.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

fn bodies(list: &Cursor<'_>, mut shared: Shared) -> Result<Vec<Body>, SceneError> {
    let items = list.list("bodies")?;
    if items.len() > MAX_BODIES {
        return Err(list.refuse_as(format!("{} bodies", items.len()), "at most 10 million bodies"));
    }
    let mut bodies = Vec::with_capacity(items.len());
    let mut index_by_name = HashMap::with_capacity(items.len());
    for (index, item) in items.enumerate() {
        let mut body = bodies::read(&item, &mut shared)?;
        body.name = name(&item, index)?;
        if let Some(before) = index_by_name.insert(body.name.clone(), index) {
            return Err(named_twice(&item, &body.name, before));
        }
        bodies.push(body);
    }
    Ok(bodies)
}

/// The body's own name, or `body<index>`.
fn name(body: &Cursor<'_>, index: usize) -> Result<String, SceneError> {
    const EXPECTED: &str = "a name that is not empty";
    let Some(name) = body.object()?.get("name") else { return Ok(format!("body{index}")) };
    let text = name.text(EXPECTED)?;
    if text.is_empty() { Err(name.refuse(EXPECTED)) } else { Ok(text.to_owned()) }
}

fn named_twice(body: &Cursor<'_>, name: &str, before: usize) -> SceneError {
    match body.object().ok().and_then(|object| object.get("name")) {
        Some(own) => own.refuse(format!(
            "a name of its own; bodies[{before}] is called so too (a body without a name is body<index>)"
        )),
        None => body.refuse_lack(
            "name",
            format!("a name of its own; without one this body is {name:?}, as bodies[{before}] is called"),
        ),
    }
}
