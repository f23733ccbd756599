//! glTF scenes, written here as JSON and bytes, and what becomes of them.

#[path = "gltf/broken.rs"]
mod broken;
#[path = "gltf/meshes.rs"]
mod meshes;
#[path = "gltf/nodes.rs"]
mod nodes;
#[path = "gltf/physics.rs"]
mod physics;
mod text;

use carom::math::DVec3;
use carom::{Body, Shape};
use carom_scene::{Scene, SceneError};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};
use text::base64;

/// A fresh folder for the files of one test.
fn folder() -> PathBuf {
    static NEXT: AtomicU32 = AtomicU32::new(0);
    let name = format!("carom-gltf-{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
    let folder = std::env::temp_dir().join(name);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn load_bytes(name: &str, bytes: &[u8]) -> Result<Scene, SceneError> {
    let folder = folder();
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    let scene = Scene::load(&path);
    std::fs::remove_dir_all(folder).unwrap();
    scene
}

fn try_load(document: &Value) -> Result<Scene, SceneError> {
    load_bytes("scene.gltf", document.to_string().as_bytes())
}

fn load(document: &Value) -> Scene {
    try_load(document).unwrap_or_else(|error| panic!("{error}"))
}

/// A file with these nodes, a unit box, a unit sphere, a capsule, a cylinder and planes, and the physics tables.
fn scene(nodes: Value) -> Value {
    let tables = json!({
        "physicsMaterials": [
            { "staticFriction": 0.9, "restitution": 0.5, "restitutionCombine": "maximum", "frictionCombine": "minimum" }
        ],
        "collisionFilters": [
            { "collisionSystems": ["a", "b"], "collideWithSystems": ["a"] },
            { "collisionSystems": ["b"], "notCollideWithSystems": ["a"] },
            { "collisionSystems": ["a"] }
        ]
    });
    let shapes = json!([
        { "type": "box" },
        { "type": "sphere", "sphere": { "radius": 1 } },
        { "type": "capsule", "capsule": { "height": 2, "radiusBottom": 0.5, "radiusTop": 0.5 } },
        { "type": "cylinder", "cylinder": { "height": 2, "radiusBottom": 0.5, "radiusTop": 0 } },
        { "type": "plane" },
        { "type": "plane", "plane": { "sizeX": 2, "sizeZ": 4, "doubleSided": true } },
        { "type": "capsule", "capsule": { "height": 2, "radiusBottom": 0.5, "radiusTop": 0.25 } }
    ]);
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_physics_rigid_bodies", "KHR_implicit_shapes"],
        "extensions": { "KHR_physics_rigid_bodies": tables, "KHR_implicit_shapes": { "shapes": shapes } },
        "nodes": nodes
    })
}

/// A node with a transform and physics.
fn node(transform: Value, physics: Value) -> Value {
    let mut node = transform;
    node["extensions"] = json!({ "KHR_physics_rigid_bodies": physics });
    node
}

/// A collider of the shape of that index.
fn collider(shape: usize) -> Value {
    json!({ "geometry": { "shape": shape } })
}

/// A `.glb` with that JSON and binary chunk.
fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut data = binary.to_vec();
    data.resize(data.len().next_multiple_of(4), 0);
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &data)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

fn body<'a>(scene: &'a Scene, name: &str) -> &'a Body {
    let names: Vec<_> = scene.bodies.iter().map(|body| &body.name).collect();
    scene.bodies.iter().find(|body| body.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"))
}

fn near(found: DVec3, expected: [f64; 3]) {
    assert!((found - DVec3::from_array(expected)).length() < 1e-6, "{found}, not {expected:?}");
}

fn size_of(shape: &Shape) -> DVec3 {
    match shape {
        Shape::Cuboid { size } => *size,
        other => panic!("{other:?}"),
    }
}

/// That the scene has a note about `what`.
fn has_note(scene: &Scene, what: &str) {
    assert!(scene.notes.iter().any(|note| note.contains(what)), "{what}: not in {:?}", scene.notes);
}
