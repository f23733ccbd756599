//! Writes `scenes/basketball-and-bowling-ball.glb`: two balls that fall from the same height and bounce as they do.
//!
//! ```text
//! cargo run -p carom-scene --example make_basketball_scene
//! ```

use serde_json::{Value, json};
use std::f32::consts::PI;
use std::path::Path;

/// Lowest point of either ball above the floor, m.
const DROP: f64 = 1.5;

fn main() -> std::io::Result<()> {
    let mut meshes = Meshes::default();
    let floor = meshes.add("floor", &cuboid([5.0, 0.1, 5.0]), 0);
    let basketball = meshes.add("basketball", &sphere(0.12), 1);
    let bowling_ball = meshes.add("bowling ball", &sphere(0.108), 2);

    // A basketball is a shell: I = 2/3 m r².
    let shell = 2.0 / 3.0 * 0.62 * 0.12 * 0.12;
    let collider = |index: usize| json!({ "geometry": { "shape": index }, "physicsMaterial": index });
    let physics = |value: Value| json!({ "KHR_physics_rigid_bodies": value });
    let document = json!({
        "asset": { "version": "2.0", "generator": "carom make_basketball_scene" },
        "extensionsUsed": ["KHR_implicit_shapes", "KHR_physics_rigid_bodies"],
        "extensions": {
            "KHR_implicit_shapes": { "shapes": [
                { "type": "box", "box": { "size": [10, 0.2, 10] } },
                { "type": "sphere", "sphere": { "radius": 0.12 } },
                { "type": "sphere", "sphere": { "radius": 0.108 } }
            ] },
            "KHR_physics_rigid_bodies": { "physicsMaterials": [
                { "name": "wood", "staticFriction": 0.5, "dynamicFriction": 0.5 },
                { "name": "rubber", "staticFriction": 0.5, "dynamicFriction": 0.5,
                  "restitution": 0.82, "restitutionCombine": "maximum" },
                { "name": "resin", "staticFriction": 0.2, "dynamicFriction": 0.2,
                  "restitution": 0.3, "restitutionCombine": "maximum" }
            ] }
        },
        "scene": 0,
        "scenes": [{ "name": "basketball and bowling ball", "nodes": [0, 1, 2] }],
        "nodes": [
            { "name": "floor", "mesh": floor, "translation": [0, -0.1, 0],
              "extensions": physics(json!({ "collider": collider(0) })) },
            { "name": "basketball", "mesh": basketball, "translation": [-0.5, DROP + 0.12, 0],
              "extensions": physics(json!({
                  "motion": { "mass": 0.62, "inertiaDiagonal": [shell, shell, shell], "angularVelocity": [0, 0, 8] },
                  "collider": collider(1)
              })) },
            { "name": "bowling-ball", "mesh": bowling_ball, "translation": [0.5, DROP + 0.108, 0],
              "extensions": physics(json!({ "motion": { "mass": 6.8 }, "collider": collider(2) })) }
        ],
        "materials": [
            paint("wood", [0.76, 0.6, 0.42], 0.8), paint("rubber", [0.85, 0.35, 0.1], 0.9),
            paint("resin", [0.05, 0.07, 0.25], 0.2)
        ],
        "meshes": meshes.meshes,
        "accessors": meshes.accessors,
        "bufferViews": meshes.views,
        "buffers": [{ "byteLength": meshes.bytes.len() }]
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/basketball-and-bowling-ball.glb");
    std::fs::write(path, container(&document, meshes.bytes))
}

/// Positions, normals and triangles, anticlockwise from outside.
#[derive(Default)]
struct Mesh {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    corners: Vec<u16>,
}

impl Mesh {
    fn vertex(&mut self, position: [f32; 3], normal: [f32; 3]) {
        self.positions.push(position);
        self.normals.push(normal);
    }

    /// Two triangles with the corners a, b, c, d, anticlockwise.
    fn quad(&mut self, [a, b, c, d]: [u16; 4]) {
        self.corners.extend([a, b, c, a, c, d]);
    }
}

/// A ball of 16 rings and 32 sectors.
fn sphere(radius: f32) -> Mesh {
    let (rings, sectors) = (16_u16, 32_u16);
    let mut mesh = Mesh::default();
    for ring in 0..=rings {
        let (out, up) = (PI * f32::from(ring) / f32::from(rings)).sin_cos();
        for sector in 0..=sectors {
            let (east, south) = (2.0 * PI * f32::from(sector) / f32::from(sectors)).sin_cos();
            let normal = [out * east, up, out * south];
            mesh.vertex(normal.map(|x| x * radius), normal);
        }
    }
    let row = sectors + 1;
    for ring in 0..rings {
        for sector in 0..sectors {
            let corner = ring * row + sector;
            mesh.quad([corner, corner + row, corner + row + 1, corner + 1]);
        }
    }
    mesh
}

/// A box with the given half edges.
fn cuboid(half: [f32; 3]) -> Mesh {
    let mut mesh = Mesh::default();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            let base = mesh.positions.len() as u16;
            for (u, v) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let (mut position, mut normal) = ([0.0; 3], [0.0; 3]);
                position[axis] = sign * half[axis];
                position[next] = u * half[next];
                position[last] = v * sign * half[last];
                normal[axis] = sign;
                mesh.vertex(position, normal);
            }
            mesh.quad([base, base + 1, base + 2, base + 3]);
        }
    }
    mesh
}

/// The tables of a glTF file that meshes take.
#[derive(Default)]
struct Meshes {
    meshes: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    bytes: Vec<u8>,
}

impl Meshes {
    /// Adds a mesh; its index.
    fn add(&mut self, name: &str, mesh: &Mesh, material: usize) -> usize {
        let along = |axis: usize| mesh.positions.iter().map(move |p| p[axis]);
        let bound = |pick: fn(f32, f32) -> f32| [0, 1, 2].map(|axis| along(axis).reduce(pick));
        let floats = |rows: &[[f32; 3]]| rows.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let count = mesh.positions.len();
        let corners = mesh.corners.iter().flat_map(|corner| corner.to_le_bytes()).collect();
        let position = self.accessor(
            floats(&mesh.positions),
            json!({ "componentType": 5126, "type": "VEC3", "count": count,
                    "min": bound(f32::min), "max": bound(f32::max) }),
        );
        let normal = self.accessor(
            floats(&mesh.normals),
            json!({ "componentType": 5126, "type": "VEC3", "count": count }),
        );
        let indices = self.accessor(
            corners,
            json!({ "componentType": 5123, "type": "SCALAR", "count": mesh.corners.len() }),
        );
        let attributes = json!({ "POSITION": position, "NORMAL": normal });
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        self.meshes.len() - 1
    }

    fn accessor(&mut self, bytes: Vec<u8>, mut accessor: Value) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        accessor["bufferView"] = json!(self.views.len() - 1);
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

fn paint(name: &str, [red, green, blue]: [f64; 3], roughness: f64) -> Value {
    json!({ "name": name, "pbrMetallicRoughness": {
        "baseColorFactor": [red, green, blue, 1], "metallicFactor": 0, "roughnessFactor": roughness
    } })
}

/// The document and its binary data as a `.glb` file.
fn container(document: &Value, binary: Vec<u8>) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let mut file = b"glTF".to_vec();
    file.extend([2, length as u32].map(u32::to_le_bytes).concat());
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
