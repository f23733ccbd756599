//! The scene that every format is read into.

use crate::json::{self, Json};
use crate::{SceneError, gltf};
use carom::{Body, BodyId, Settings, World};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Longest file, bytes.
const MAX_FILE: u64 = 1 << 30;

/// A scene that was read: what to put into a world.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What reports call it.
    pub name: String,
    /// Gravity and substeps.
    pub settings: Settings,
    /// Length of a step, s.
    pub dt: f64,
    /// Whether bodies at rest may fall asleep.
    pub sleeping: bool,
    /// The bodies in the order of the file, each with a unique non-empty name.
    pub bodies: Vec<Body>,
    /// What was passed over or has no effect yet, a line each, for stderr.
    pub notes: Vec<String>,
}

impl Scene {
    /// Reads a scene file: `.json` as the format `carom` 1, `.gltf` and `.glb` as glTF, anything else by its content.
    ///
    /// # Errors
    /// Names the file, the place in it, the value found and what was expected.
    pub fn load(path: &Path) -> Result<Scene, SceneError> {
        let file = path.display().to_string();
        let folder = path.parent().unwrap_or(Path::new(""));
        let bytes = read_file(path, &file)?;
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_deref().and_then(|ending| ending.to_str()) {
            Some("json") => json::scene(&Json::parse(as_text(&bytes, &file)?, &file)?, &file, folder),
            Some("gltf" | "glb") => gltf::load(path, &bytes),
            _ if bytes.starts_with(b"glTF") => gltf::load(path, &bytes),
            _ => {
                let document = Json::parse(as_text(&bytes, &file)?, &file)?;
                let is_gltf = document.get("carom").is_none() && document.get("asset").is_some();
                if is_gltf { gltf::load(path, &bytes) } else { json::scene(&document, &file, folder) }
            }
        }
    }

    /// Reads a scene from text in the format `carom` 1. Errors call it `origin`; so is a scene without a name.
    /// Files that the scene names are looked for in the folder of `origin`, which is the current one where it has none.
    ///
    /// ```
    /// use carom_scene::Scene;
    /// let scene = Scene::from_json(r#"{ "carom": 1, "bodies": [ { "motion": "static" } ] }"#, "anchor.json")?;
    /// assert_eq!((scene.name.as_str(), scene.bodies[0].name.as_str()), ("anchor", "body0"));
    ///
    /// let error = Scene::from_json(r#"{ "carom": 1, "bodies": [ { "motion": "statc" } ] }"#, "anchor.json").unwrap_err();
    /// assert_eq!(
    ///     error.to_string(),
    ///     r#"anchor.json: bodies[0].motion: "statc"; expected one of dynamic, static, kinematic (did you mean static?)"#
    /// );
    /// # Ok::<(), carom_scene::SceneError>(())
    /// ```
    ///
    /// # Errors
    /// Names the place, the value found and what was expected.
    pub fn from_json(text: &str, origin: &str) -> Result<Scene, SceneError> {
        let folder = Path::new(origin).parent().unwrap_or(Path::new(""));
        json::scene(&Json::parse(text, origin)?, origin, folder)
    }

    /// A world with the scene's bodies, and their ids in the order of [`Scene::bodies`].
    ///
    /// # Errors
    /// Names the first body that no world can hold; there is none in a scene that was read from a file.
    pub fn world(&self) -> Result<(World, Vec<BodyId>), SceneError> {
        build(self.settings, self.bodies.iter().cloned())
    }

    /// [`Scene::world`] without copying the bodies.
    ///
    /// # Errors
    /// As [`Scene::world`].
    pub fn into_world(self) -> Result<(World, Vec<BodyId>), SceneError> {
        build(self.settings, self.bodies.into_iter())
    }
}

fn build(settings: Settings, bodies: impl Iterator<Item = Body>) -> Result<(World, Vec<BodyId>), SceneError> {
    let mut world = World::with_settings(settings);
    let mut ids = Vec::with_capacity(bodies.size_hint().0);
    for body in bodies {
        let name = body.name.clone();
        ids.push(world.try_add(body).map_err(|source| SceneError::Refused { body: name, source })?);
    }
    Ok((world, ids))
}

/// The bytes of the file at `path`, which errors call `file`.
pub(crate) fn read_file(path: &Path, file: &str) -> Result<Vec<u8>, SceneError> {
    let unreadable = |source| SceneError::Unreadable { file: file.to_owned(), source };
    let too_long = |length: String| SceneError::invalid(file, "", length, "a file of at most 1 GiB");
    let opened = File::open(path).map_err(unreadable)?;
    let length = opened.metadata().map_err(unreadable)?.len();
    if length > MAX_FILE {
        return Err(too_long(format!("{length} bytes")));
    }
    // What says nothing of its length, such as a pipe, is stopped as it comes.
    let mut bytes = Vec::new();
    opened.take(MAX_FILE + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_FILE { Err(too_long("more than 1 GiB".to_owned())) } else { Ok(bytes) }
}

fn as_text<'b>(bytes: &'b [u8], file: &str) -> Result<&'b str, SceneError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let before = &bytes[..error.valid_up_to()];
        let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |newline| newline + 1);
        SceneError::Syntax {
            file: file.to_owned(),
            line: before.iter().filter(|&&byte| byte == b'\n').count() + 1,
            column: before.len() - line_start + 1,
            message: format!("byte 0x{:02x} is not UTF-8 text", bytes[before.len()]),
        }
    })
}
