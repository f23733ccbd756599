//! The scenes that the program carries with it.

use crate::{Scene, SceneError, gltf};
use std::path::Path;

/// A built-in scene: its name, what it shows in a line, and its file.
pub type BuiltinScene = (&'static str, &'static str, &'static [u8]);

/// The scene to start with where none is named.
pub const DEFAULT_SCENE: &str = "off-centre-hit";

/// An entry of the list, with the file `scenes/<name>.<ending>`. A `.glb` goes the same way as a `.json`.
macro_rules! builtin {
    ($name:literal, $ending:literal, $description:literal) => {
        ($name, $description, include_bytes!(concat!("../../../scenes/", $name, ".", $ending)).as_slice())
    };
}

const SCENES: &[BuiltinScene] = &[
    builtin!(
        "off-centre-hit",
        "json",
        "a cube's corner hits a plank off its centre, without friction or gravity"
    ),
    builtin!("ball-drop", "json", "three balls of different restitution dropped from 2 m"),
    builtin!("tumbling-handle", "json", "a handle spun about its middle axis turns over in free fall"),
    builtin!("spinning-balls", "json", "balls thrown with top, back and side spin on a rough floor"),
    builtin!("box-on-its-corner", "json", "a box falls on its corner and tumbles"),
    builtin!("two-rods", "json", "two turning rods meet edge on edge"),
    builtin!("bat-and-ball", "json", "a swung bat meets a thrown ball"),
    builtin!(
        "basketball-and-bowling-ball",
        "glb",
        "two balls dropped from 1.5 m: one bounces, one hardly does"
    ),
    builtin!(
        "galilean-cannon",
        "json",
        "balls of falling mass dropped together: the lightest flies off many times as high"
    ),
    builtin!("slope", "json", "on a slope of 20 degrees ice slides, wood and rubber hold"),
    builtin!("stack", "json", "twenty boxes, and ten tonnes on a box of 100 kg: nothing sinks"),
    builtin!("wall", "json", "a wall of bricks stands until a steel ball is thrown into it"),
    builtin!("dominoes", "json", "a ball tips the first of 21 dominoes on a winding line"),
    builtin!("pile", "json", "500 balls, boxes, capsules, cylinders, cones and wedges fall into a pit"),
    builtin!("marble-run", "json", "marbles roll down a winding track of triangles into a bowl"),
    builtin!(
        "conveyor-and-turntable",
        "json",
        "a belt takes bodies along; a turntable carries two boxes and loses the third"
    ),
];

/// The built-in scenes, the one to start with first.
pub fn builtin_scenes() -> &'static [BuiltinScene] {
    SCENES
}

impl Scene {
    /// Reads the built-in scene of that name, if there is one.
    ///
    /// ```
    /// assert!(carom_scene::Scene::builtin("no-such-scene").is_none());
    /// ```
    pub fn builtin(name: &str) -> Option<Result<Scene, SceneError>> {
        let (name, _, bytes) = SCENES.iter().find(|(known, ..)| *known == name)?;
        Some(if bytes.starts_with(b"glTF") {
            gltf::load(Path::new(name), bytes)
        } else {
            Scene::from_json(&String::from_utf8_lossy(bytes), name)
        })
    }
}
