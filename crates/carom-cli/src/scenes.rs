//! Finding the scene that was asked for.

use crate::failure::Failure;
use crate::nearest::nearest;
use carom_scene::{Scene, builtin_scenes};
use std::path::Path;

/// The built-in scene of that name, else the file.
pub fn load(asked: &Path) -> Result<Scene, Failure> {
    let scene = match asked.to_str().and_then(Scene::builtin) {
        Some(scene) => scene,
        None if asked.exists() => Scene::load(asked),
        None => return Err(Failure::Input(nothing_there(asked))),
    };
    scene.map_err(|error| Failure::Input(error.to_string()))
}

fn nothing_there(asked: &Path) -> String {
    let name = asked.display().to_string();
    let hint = match nearest(&name, builtin_scenes().iter().map(|&(name, ..)| name)) {
        Some(similar) => format!("did you mean `{similar}`?"),
        None => "`carom scenes` lists those".to_owned(),
    };
    format!("{name}: no such file, and no built-in scene of that name; {hint}")
}
