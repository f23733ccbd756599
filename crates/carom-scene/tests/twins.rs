//! Every kind of shape on every other one, from a glTF file to five seconds of rest.
//!
//! The lower one is fixed and so large, or so flat on top, that the upper one can stay: what is round has a radius of 50 m, on
//! which friction holds a flat face and rolling takes far longer than the test. The upper one starts where they touch.

mod text;

use carom::math::DVec3;
use carom::prelude::*;
use carom_scene::Scene;
use serde_json::{Value, json};
use text::base64;

const STEP: f64 = 1.0 / 60.0;

/// What touches the other one, and what it may do there.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Sphere,
    Box,
    Capsule,
    Cylinder,
    Hull,
    Mesh,
}

const KINDS: [Kind; 6] = [Kind::Sphere, Kind::Box, Kind::Capsule, Kind::Cylinder, Kind::Hull, Kind::Mesh];

/// Radius of what is round below, m.
const LARGE: f64 = 50.0;
/// Half the height of the boxes, hulls and meshes below, m.
const THICK: f64 = 0.5;
/// How high the middle of the upper one starts over what it touches, m.
const HALF: f64 = 0.25;
/// Capsules and cylinders lie along x: a quarter turn about z.
const LYING: [f64; 4] = [0.0, 0.0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2];

/// A glTF document in the making: shapes, meshes and the bytes of their accessors.
#[derive(Default)]
struct Document {
    shapes: Vec<Value>,
    meshes: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    bytes: Vec<u8>,
    nodes: Vec<Value>,
}

impl Document {
    /// A collider's `geometry` for a shape of that kind, whose half height is `half` and whose half width is `wide`.
    fn geometry(&mut self, kind: Kind, half: f64, wide: f64) -> Value {
        let round = |radius: f64, height: f64| json!({ "radiusTop": radius, "radiusBottom": radius, "height": height });
        match kind {
            Kind::Sphere => self.shape(json!({ "type": "sphere", "sphere": { "radius": half } })),
            Kind::Box => {
                self.shape(json!({ "type": "box", "box": { "size": [2.0 * wide, 2.0 * half, 2.0 * wide] } }))
            }
            Kind::Capsule => self.shape(json!({ "type": "capsule", "capsule": round(half, 2.0 * wide) })),
            Kind::Cylinder => self.shape(json!({ "type": "cylinder", "cylinder": round(half, 2.0 * wide) })),
            Kind::Hull => {
                // A prism of eight sides.
                let ring = (0..8).map(|corner| {
                    let (sin, cos) = (f64::from(corner) * std::f64::consts::FRAC_PI_4).sin_cos();
                    [wide * cos, wide * sin]
                });
                let corners: Vec<_> = ring.flat_map(|[x, z]| [[x, -half, z], [x, half, z]]).collect();
                // Its hull counts, so any triangles do that have all the corners.
                let triangles = (0..14).flat_map(|corner| [corner, corner + 1, corner + 2]).collect();
                let node = self.mesh(&corners, triangles);
                json!({ "node": node, "convexHull": true })
            }
            Kind::Mesh => {
                // A box of triangles, anticlockwise from outside; corner 4x + 2y + z.
                let corners: Vec<_> = (0..8)
                    .map(|corner| {
                        let side = |bit: i32| if corner & bit == 0 { -1.0 } else { 1.0 };
                        [wide * side(4), half * side(2), wide * side(1)]
                    })
                    .collect();
                let faces =
                    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
                let triangles = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
                let node = self.mesh(&corners, triangles);
                json!({ "node": node })
            }
        }
    }

    fn shape(&mut self, shape: Value) -> Value {
        self.shapes.push(shape);
        json!({ "shape": self.shapes.len() - 1 })
    }

    /// A node that is not in the scene and carries a mesh.
    fn mesh(&mut self, corners: &[[f64; 3]], triangles: Vec<u16>) -> usize {
        let floats = corners.iter().flatten().flat_map(|&x| (x as f32).to_le_bytes()).collect();
        let kind = json!({ "componentType": 5126, "type": "VEC3", "count": corners.len() });
        let position = self.accessor(floats, kind);
        let kind = json!({ "componentType": 5123, "type": "SCALAR", "count": triangles.len() });
        let indices = triangles.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = self.accessor(indices, kind);
        let primitive = json!({ "attributes": { "POSITION": position }, "indices": indices });
        self.meshes.push(json!({ "primitives": [primitive] }));
        self.nodes.push(json!({ "mesh": self.meshes.len() - 1 }));
        self.nodes.len() - 1
    }

    fn accessor(&mut self, bytes: Vec<u8>, mut accessor: Value) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// The whole, with the last two nodes as the scene.
    fn finish(self) -> Value {
        let count = self.nodes.len();
        let mut document = json!({
            "asset": { "version": "2.0" },
            "extensionsUsed": ["KHR_physics_rigid_bodies", "KHR_implicit_shapes"],
            "extensions": { "KHR_implicit_shapes": { "shapes": self.shapes } },
            "scenes": [{ "nodes": [count - 2, count - 1] }],
            "scene": 0,
            "nodes": self.nodes
        });
        // glTF allows no empty lists.
        if !self.bytes.is_empty() {
            document["meshes"] = json!(self.meshes);
            document["accessors"] = json!(self.accessors);
            document["bufferViews"] = json!(self.views);
            let data = format!("data:application/octet-stream;base64,{}", base64(&self.bytes));
            document["buffers"] = json!([{ "byteLength": self.bytes.len(), "uri": data }]);
        }
        if document["extensions"]["KHR_implicit_shapes"]["shapes"].as_array().is_some_and(Vec::is_empty) {
            document.as_object_mut().unwrap().remove("extensions");
        }
        document
    }
}

fn is_lying(kind: Kind) -> bool {
    matches!(kind, Kind::Capsule | Kind::Cylinder)
}

/// Half the height of the fixed body, m.
fn half_below(kind: Kind) -> f64 {
    if is_lying(kind) || kind == Kind::Sphere { LARGE } else { THICK }
}

/// The scene of a pair: `below` with its highest point at the origin, `above` standing on it.
fn pair(below: Kind, above: Kind) -> Scene {
    let mut document = Document::default();
    let half = half_below(below);
    let wide = if is_lying(below) { LARGE } else { 5.0 };
    let floor = document.geometry(below, half, wide);
    let upper = document.geometry(above, HALF, HALF);
    let physics = |value: Value| json!({ "KHR_physics_rigid_bodies": value });
    let turned = |kind: Kind| if is_lying(kind) { json!(LYING) } else { json!([0, 0, 0, 1]) };
    document.nodes.push(json!({
        "name": "below", "translation": [0, -half, 0], "rotation": turned(below),
        "extensions": physics(json!({ "collider": { "geometry": floor } }))
    }));
    document.nodes.push(json!({
        "name": "above", "translation": [0, HALF, 0], "rotation": turned(above),
        "extensions": physics(json!({ "motion": { "mass": 1 }, "collider": { "geometry": upper } }))
    }));
    let name = format!("carom-twins-{}-{below:?}-{above:?}.gltf", std::process::id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, document.finish().to_string()).unwrap();
    let scene = Scene::load(&path);
    std::fs::remove_file(path).unwrap();
    scene.unwrap_or_else(|error| panic!("{above:?} on {below:?}: {error}"))
}

/// How high the upper one's middle must be where it is now: on what is round, the ground falls away from the top.
fn ground(below: Kind, place: DVec3) -> f64 {
    let out = match below {
        Kind::Sphere => place.x.hypot(place.z),
        Kind::Capsule | Kind::Cylinder => place.z,
        _ => return 0.0,
    };
    (LARGE * LARGE - out * out).sqrt() - LARGE
}

/// Lets the upper one rest for five seconds; what went wrong, if anything did.
fn fault(below: Kind, above: Kind) -> Option<String> {
    let mut scene = pair(below, above);
    assert_eq!(scene.bodies.len(), 2);
    let upper = scene.bodies.pop().unwrap();
    let mut world = World::new();
    world.add(scene.bodies.pop().unwrap());
    let id = world.add(upper);
    let mut lowest = 0.0_f64;
    for _ in 0..300 {
        world.step(STEP);
        let state = &world[id];
        let place = state.position();
        if !place.is_finite() || !state.linear_velocity().is_finite() || !state.angular_velocity().is_finite()
        {
            return Some(format!("no longer finite at {} s", world.time()));
        }
        if place.x.hypot(place.z) > 1.0 {
            return Some(format!("it has gone to {place} at {} s", world.time()));
        }
        lowest = lowest.min(place.y - HALF - ground(below, place));
    }
    let state = &world[id];
    let speed = state.linear_velocity().length();
    let height = state.position().y - HALF - ground(below, state.position());
    if lowest < -1e-3 {
        Some(format!("it sank by {} m", -lowest))
    } else if height > 1e-3 || speed > 0.1 {
        Some(format!("it is {height} m too high and moves with {speed} m/s"))
    } else {
        None
    }
}

#[test]
fn every_kind_of_shape_stays_on_every_kind() {
    let faults: Vec<String> = KINDS
        .into_iter()
        .flat_map(|below| KINDS.map(|above| (below, above)))
        .filter_map(|(below, above)| Some(format!("{above:?} on {below:?}: {}", fault(below, above)?)))
        .collect();
    assert!(faults.is_empty(), "{} pairs:\n{}", faults.len(), faults.join("\n"));
}
