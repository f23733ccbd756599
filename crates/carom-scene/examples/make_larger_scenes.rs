//! Writes those scenes in `scenes/` that nobody wants to type: the stack, the wall, the dominoes, the pile, the marble run.
//!
//! ```text
//! cargo run -p carom-scene --example make_larger_scenes
//! ```

use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::Path;

fn main() -> std::io::Result<()> {
    for scene in [stack(), wall(), dominoes(), pile(), marble_run()] {
        scene.write()?;
    }
    Ok(())
}

/// A scene file: one line for each material and body.
struct Scene {
    file: &'static str,
    name: &'static str,
    materials: Value,
    bodies: Vec<Value>,
}

impl Scene {
    fn write(&self) -> std::io::Result<()> {
        let lines: Vec<String> = self.bodies.iter().map(|body| format!("    {body}")).collect();
        let text = format!(
            "{{\n  \"carom\": 1,\n  \"name\": {},\n  \"materials\": {},\n  \"bodies\": [\n{}\n  ]\n}}\n",
            json!(self.name),
            self.materials,
            lines.join(",\n")
        );
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        std::fs::write(folder.join(format!("{}.json", self.file)), text)
    }
}

/// Four digits behind the point: enough for a scene, and easy on the eye.
fn short(numbers: impl IntoIterator<Item = f64>) -> Vec<f64> {
    // Adding zero makes −0 plain.
    numbers.into_iter().map(|number| (number * 1e4).round() / 1e4 + 0.0).collect()
}

fn collider(shape: Value, material: &str) -> Value {
    json!([{ "shape": shape, "material": material }])
}

fn floor(material: &str) -> Value {
    json!({ "name": "floor", "motion": "static", "colliders": collider(json!({ "type": "plane" }), material) })
}

fn cuboid(size: [f64; 3]) -> Value {
    json!({ "type": "box", "size": size })
}

/// The rotation about y by that angle, rad.
fn turned(angle: f64) -> Vec<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    [0.0, sin, 0.0, cos].map(|number| (number * 1e9).round() / 1e9 + 0.0).to_vec()
}

fn stack() -> Scene {
    let mut bodies = vec![floor("wood")];
    for level in 0..20 {
        let place = [0.0, 0.5 + f64::from(level), 0.0];
        let name = format!("box {}", level + 1);
        let shape = collider(cuboid([1.0, 1.0, 1.0]), "wood");
        bodies.push(json!({ "name": name, "position": place, "mass": 100, "colliders": shape }));
    }
    for (name, y, mass) in [("light", 0.5, 100), ("heavy", 1.5, 10_000)] {
        let shape = collider(cuboid([1.0, 1.0, 1.0]), "wood");
        bodies.push(json!({ "name": name, "position": [3, y, 0], "mass": mass, "colliders": shape }));
    }
    Scene {
        file: "stack",
        name: "Twenty boxes on top of each other, and beside them ten tonnes on a box of 100 kg: nothing sinks",
        materials: json!({ "wood": { "friction": 0.5 } }),
        bodies,
    }
}

fn wall() -> Scene {
    const ROWS: u32 = 10;
    const BRICK: [f64; 3] = [0.4, 0.2, 0.2];
    let mut bodies = vec![floor("brick")];
    for row in 0..ROWS {
        // Every other row begins and ends with half a brick.
        let y = (f64::from(row) + 0.5) * BRICK[1];
        let mut left = -2.0;
        let mut number = 0;
        while left < 2.0 - 1e-9 {
            let is_half = row % 2 == 1 && (number == 0 || left > 1.7);
            let length = if is_half { 0.5 * BRICK[0] } else { BRICK[0] };
            let place = short([0.0, y, left + 0.5 * length]);
            let name = format!("row {} brick {}", row + 1, number + 1);
            let shape = collider(cuboid([BRICK[2], BRICK[1], length]), "brick");
            bodies.push(json!({ "name": name, "position": place, "colliders": shape }));
            left += length;
            number += 1;
        }
    }
    let shape =
        json!([{ "shape": { "type": "sphere", "radius": 0.25 }, "density": 7800, "material": "steel" }]);
    let thrown = json!([8, 4, 0]);
    bodies.push(
        json!({ "name": "ball", "position": [-12, 0.45, 0.1], "linear_velocity": thrown, "colliders": shape }),
    );
    Scene {
        file: "wall",
        name: "A wall of 105 bricks stands until a steel ball is thrown into it",
        materials: json!({ "brick": { "friction": 0.6 }, "steel": { "friction": 0.3, "restitution": 0.3 } }),
        bodies,
    }
}

fn dominoes() -> Scene {
    const COUNT: u32 = 21;
    /// Of the circle on whose quarters the dominoes stand, m.
    const RADIUS: f64 = 2.0;
    const SPACING: f64 = 0.28;
    let mut bodies = vec![floor("table")];
    for number in 0..COUNT {
        let way = f64::from(number) * SPACING;
        // Left round a quarter of a circle, then right round another one.
        let quarter = 0.25 * TAU;
        let angle = way / RADIUS;
        let (x, z, heading) = if angle <= quarter {
            (RADIUS * angle.sin(), RADIUS * (1.0 - angle.cos()), -angle)
        } else {
            let rest = angle - quarter;
            (RADIUS * (2.0 - rest.cos()), RADIUS * (1.0 + rest.sin()), rest - quarter)
        };
        let shape = collider(cuboid([0.08, 0.5, 0.25]), "ivory");
        bodies.push(json!({
            "name": format!("domino {}", number + 1), "position": short([x, 0.25, z]), "rotation": turned(heading),
            "colliders": shape
        }));
    }
    let shape = collider(json!({ "type": "sphere", "radius": 0.1 }), "ivory");
    let (place, thrown) = (json!([-0.6, 0.45, 0]), json!([2, 0.8, 0]));
    bodies.push(json!({ "name": "ball", "position": place, "linear_velocity": thrown, "colliders": shape }));
    Scene {
        file: "dominoes",
        name: "Twenty-one dominoes on a winding line; a ball tips the first",
        materials: json!({ "table": { "friction": 0.8 }, "ivory": { "friction": 0.3, "restitution": 0.2 } }),
        bodies,
    }
}

/// Random numbers that are the same everywhere (a linear congruential generator; Knuth, *MMIX*).
struct Random(u64);

impl Random {
    /// Even in [low, high).
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 33) as f64 / f64::from(1_u32 << 31))
    }

    /// A rotation, not quite even over all of them.
    fn rotation(&mut self) -> Vec<f64> {
        let parts = [(); 4].map(|()| self.within(-1.0, 1.0));
        let length = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        parts.map(|part| (part / length * 1e6).round() / 1e6).to_vec()
    }
}

fn pile() -> Scene {
    const SIDE: u32 = 5;
    const LAYERS: u32 = 20;
    const KINDS: [&str; 6] = ["ball", "box", "capsule", "cylinder", "cone", "wedge"];
    let mut random = Random(1);
    let mut bodies = vec![floor("stone")];
    for (name, x, z) in [("west", -1.0, 0.0), ("east", 1.0, 0.0), ("south", 0.0, -1.0), ("north", 0.0, 1.0)] {
        let size = if x == 0.0 { [6.0, 4.0, 1.0] } else { [1.0, 4.0, 4.0] };
        let (place, shape) = ([2.5 * x, 2.0, 2.5 * z], collider(cuboid(size), "stone"));
        bodies.push(json!({ "name": name, "motion": "static", "position": place, "colliders": shape }));
    }
    for number in 0..SIDE * SIDE * LAYERS {
        let (layer, cell) = (number / (SIDE * SIDE), number % (SIDE * SIDE));
        let spot = |index: u32, shift: f64| 0.75 * (f64::from(index) - 2.0) + shift;
        let [dx, dz] = [(); 2].map(|()| random.within(-0.04, 0.04));
        let place = [spot(cell % SIDE, dx), 1.0 + 0.8 * f64::from(layer), spot(cell / SIDE, dz)];
        let size = random.within(0.8, 1.2);
        let kind = KINDS[number as usize % KINDS.len()];
        let [a, b, c] = [0.36, 0.28, 0.32].map(|edge| (edge * size * 1e3).round() / 1e3);
        let shape = match kind {
            "ball" => json!({ "type": "sphere", "radius": 0.5 * a }),
            "box" => cuboid([a, b, c]),
            "capsule" => json!({ "type": "capsule", "height": b, "radius": 0.4 * b }),
            "cylinder" => json!({ "type": "cylinder", "height": a, "radius": 0.5 * b }),
            "cone" => json!({ "type": "cone", "height": a, "radius": 0.5 * a }),
            _ => {
                let [x, y, z] = [0.5 * a, 0.5 * b, 0.5 * c];
                let corners = [[-x, -y, -z], [x, -y, -z], [-x, -y, z], [x, -y, z], [-x, y, -z], [-x, y, z]];
                json!({ "type": "hull", "points": corners.map(short) })
            }
        };
        bodies.push(json!({
            "name": format!("{kind} {}", number + 1), "position": short(place), "rotation": random.rotation(),
            "colliders": collider(shape, "wood")
        }));
    }
    Scene {
        file: "pile",
        name: "Five hundred balls, boxes, capsules, cylinders, cones and wedges fall into a pit",
        materials: json!({ "stone": { "friction": 0.6 }, "wood": { "friction": 0.5 } }),
        bodies,
    }
}

/// A strip of quads: rows of points, each cut in two.
fn sheet(rows: &[Vec<[f64; 3]>]) -> Value {
    let width = rows[0].len();
    let vertices: Vec<Vec<f64>> = rows.iter().flatten().map(|&point| short(point)).collect();
    let mut triangles = Vec::new();
    for row in 0..rows.len() - 1 {
        for column in 0..width - 1 {
            let corner = row * width + column;
            triangles.push([corner, corner + 1, corner + width]);
            triangles.push([corner + 1, corner + width + 1, corner + width]);
        }
    }
    json!({ "type": "mesh", "vertices": vertices, "triangles": triangles })
}

fn marble_run() -> Scene {
    /// Of the helix that the track follows, m, and how far it comes down.
    const RADIUS: f64 = 1.2;
    const DROP: f64 = 0.8;
    /// Of the track's bed, m.
    const BED: f64 = 0.12;
    /// Height over radius², 1/m, and the radius of the bowl's rim, m.
    const BOWL: f64 = 0.25;
    const RIM: f64 = 2.4;
    let turn = |share: f64| (TAU * share).sin_cos();
    // The bed is an arc of 200° across the way.
    let track: Vec<Vec<[f64; 3]>> = (0..=64)
        .map(|row| {
            let share = f64::from(row) / 64.0;
            let (sin, cos) = turn(share);
            (0..=14)
                .map(|column| {
                    let (across, down) = (f64::from(column - 7) / 14.0 * 200.0_f64.to_radians()).sin_cos();
                    let out = RADIUS + BED * across;
                    [out * cos, 1.45 - DROP * share - BED * down, out * sin]
                })
                .collect()
        })
        .collect();
    let bowl: Vec<Vec<[f64; 3]>> = (0..=20)
        .map(|ring| {
            // A hole too small to see, so that no triangle is without area.
            let out = (RIM * f64::from(ring) / 20.0).max(0.001);
            (0..=64)
                .map(|sector| {
                    let (sin, cos) = turn(f64::from(sector) / 64.0);
                    [out * cos, BOWL * out * out, out * sin]
                })
                .collect()
        })
        .collect();
    let mut bodies: Vec<Value> = [("track", track), ("bowl", bowl)]
        .map(|(name, rows)| json!({ "name": name, "motion": "static", "colliders": collider(sheet(&rows), "wood") }))
        .to_vec();
    for number in 0..5 {
        let share = 0.02 + 0.02 * f64::from(number);
        let (sin, cos) = turn(share);
        let place = short([RADIUS * cos, 1.45 - DROP * share - BED + 0.055, RADIUS * sin]);
        let shape =
            json!([{ "shape": { "type": "sphere", "radius": 0.05 }, "density": 2500, "material": "glass" }]);
        let name = format!("marble {}", number + 1);
        bodies.push(json!({ "name": name, "position": place, "colliders": shape }));
    }
    Scene {
        file: "marble-run",
        name: "Five marbles roll down a winding track of triangles into a bowl",
        materials: json!({ "wood": { "friction": 0.4 }, "glass": { "friction": 0.3, "restitution": 0.5 } }),
        bodies,
    }
}
