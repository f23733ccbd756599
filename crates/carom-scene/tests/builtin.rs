//! The built-in scenes.

use carom_scene::{DEFAULT_SCENE, Scene, builtin_scenes};
use std::collections::HashSet;
use std::path::Path;

#[test]
fn every_built_in_scene_loads_without_notes() {
    for (name, description, _) in builtin_scenes() {
        let scene = Scene::builtin(name).unwrap().unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.notes.is_empty() && !scene.bodies.is_empty(), "{name}: {:?}", scene.notes);
        assert!(!scene.name.is_empty() && !description.is_empty() && !description.contains('\n'), "{name}");
        let names: HashSet<_> = scene.bodies.iter().map(|body| &body.name).collect();
        assert_eq!(names.len(), scene.bodies.len(), "{name}");
    }
}

#[test]
fn the_default_scene_is_the_first_and_names_are_unique() {
    assert_eq!(builtin_scenes()[0].0, DEFAULT_SCENE);
    let names: HashSet<_> = builtin_scenes().iter().map(|(name, ..)| name).collect();
    assert_eq!(names.len(), builtin_scenes().len());
    assert!(Scene::builtin("off-center-hit").is_none());
}

#[test]
fn the_folder_and_the_list_are_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut files: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "json" || ending == "glb"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    files.sort();
    let mut names: Vec<&str> = builtin_scenes().iter().map(|(name, ..)| *name).collect();
    names.sort_unstable();
    assert_eq!(files, names);
}

#[test]
fn the_handle_spins_about_its_middle_axis() {
    let scene = Scene::builtin("tumbling-handle").unwrap().unwrap();
    let inertia = scene.bodies[0].collider_mass().inertia;
    let (x, y, z) = (inertia.x_axis.x, inertia.y_axis.y, inertia.z_axis.z);
    assert!(x < 0.9 * y && y < 0.9 * z, "{x} {y} {z}");
    assert!(scene.bodies[0].angular_velocity.y > 100.0 * scene.bodies[0].angular_velocity.x);
}
