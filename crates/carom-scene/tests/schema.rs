//! The schema against the reader: both must accept and refuse the same scenes, as far as a schema can say.

use carom_scene::{Scene, SceneError, builtin_scenes, schema};
use serde_json::{Value, json};

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// A scene with one body of `keys`.
fn with_body(keys: Value) -> Value {
    json!({ "carom": 1, "bodies": [keys] })
}

fn with_shape(shape: Value) -> Value {
    with_body(json!({ "motion": "static", "colliders": [{ "shape": shape }] }))
}

fn with_joint(mut joint: Value) -> Value {
    joint["a"] = json!("body0");
    joint["b"] = json!("body1");
    json!({ "carom": 1, "bodies": [], "joints": [joint] })
}

#[test]
fn the_schema_is_a_schema() {
    assert!(jsonschema::meta::is_valid(&schema()));
    assert_eq!(schema()["$schema"], "https://json-schema.org/draft/2020-12/schema");
}

#[test]
fn scenes_that_load_fit_the_schema() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    for (name, _, bytes) in builtin_scenes().iter().filter(|(.., bytes)| bytes.starts_with(b"{")) {
        let scene = parsed(std::str::from_utf8(bytes).unwrap());
        assert!(validator.is_valid(&scene), "{name}: {:?}", validator.iter_errors(&scene).next());
    }
    let scenes = [
        json!({ "carom": 1, "bodies": [] }),
        json!({ "carom": 1, "name": "n", "gravity": [0, 0, -1], "dt": 0.01, "substeps": 8, "sleeping": true,
            "materials": { "m": { "friction": 1, "static_friction": 1, "dynamic_friction": 1, "restitution": 1,
                "friction_combine": "average", "restitution_combine": "multiply" } },
            "bodies": [], "joints": [] }),
        with_body(json!({ "name": "n", "motion": "dynamic", "position": [1, 2, 3], "rotation": [0, 0, 0, 1],
            "linear_velocity": [1, 2, 3], "angular_velocity": [1, 2, 3], "linear_damping": 1, "angular_damping": 1,
            "gravity_factor": -1, "mass": 0, "center_of_mass": [0, 0, 0], "inertia_diagonal": [0, 0, 0],
            "inertia_orientation": [0, 0, 0, 1], "colliders": [] })),
        with_body(json!({ "motion": "kinematic", "colliders": [{ "shape": { "type": "sphere", "radius": 1 },
            "position": [0, 0, 0], "rotation": [0, 0, 0, 1], "density": 1, "sensor": true, "groups": ["a"],
            "collides_with": [], "friction": 0, "static_friction": 0, "dynamic_friction": 0, "restitution": 0,
            "friction_combine": "minimum", "restitution_combine": "maximum" }] })),
        with_shape(json!({ "type": "box", "size": [1, 2, 3] })),
        with_shape(json!({ "type": "capsule", "height": 1, "radius": 1 })),
        with_shape(json!({ "type": "capsule", "height": 1, "radius_bottom": 1, "radius_top": 0 })),
        with_shape(json!({ "type": "cylinder", "height": 1, "radius": 1 })),
        with_shape(json!({ "type": "cylinder", "height": 1, "radius_bottom": 0, "radius_top": 1 })),
        with_shape(json!({ "type": "cone", "height": 1, "radius": 1 })),
        with_shape(json!({ "type": "plane" })),
        with_shape(json!({ "type": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] })),
        with_shape(
            json!({ "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] }),
        ),
        with_shape(json!({ "type": "heightfield", "heights": [[0, 1], [1, 0]], "size": [4, 5] })),
        with_shape(json!({ "type": "mesh", "file": "tests/tetrahedron.obj" })),
        with_shape(json!({ "type": "hull", "file": "tests/tetrahedron.obj" })),
    ];
    for scene in scenes {
        assert!(validator.is_valid(&scene), "{scene}: {:?}", validator.iter_errors(&scene).next());
        let read = Scene::from_json(&scene.to_string(), "t.json");
        assert!(read.is_ok(), "{scene}: {read:?}");
    }
}

#[test]
fn what_is_documented_but_not_built_fits_the_schema() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let common = json!({ "name": "n", "anchor_a": [0, 0, 0], "anchor_b": [0, 0, 0], "collide": true, "break_force": 1,
        "break_torque": 1 });
    let motor =
        json!({ "target_position": 1, "target_velocity": 1, "stiffness": 1, "damping": 1, "max_force": 1 });
    let along_axis = json!({ "axis_a": [1, 0, 0], "axis_b": [1, 0, 0], "limits": [-1, 1], "limit_stiffness": 1,
        "limit_damping": 1, "motor": motor });
    let frame = json!({ "position": [0, 0, 0], "rotation": [0, 0, 0, 1] });
    let joints = [
        ("ball", json!({})),
        ("hinge", along_axis.clone()),
        ("slider", along_axis),
        ("fixed", json!({})),
        ("distance", json!({ "min": 0, "max": 1, "stiffness": 1, "damping": 1 })),
        (
            "generic",
            json!({ "frame_a": frame, "frame_b": frame,
            "limits": [{ "linear_axes": [0, 1, 2], "min": 0, "max": 0 }, { "angular_axes": [2], "min": -1, "stiffness": 1, "damping": 1 }],
            "drives": [{ "type": "angular", "mode": "acceleration", "axis": 2, "max_force": 1, "position_target": 1,
                "velocity_target": 1, "stiffness": 1, "damping": 1 }] }),
        ),
    ];
    for (kind, own) in joints {
        let mut joint = common.clone();
        joint["type"] = json!(kind);
        for (key, value) in own.as_object().unwrap() {
            joint[key] = value.clone();
        }
        let scene = with_joint(joint.clone());
        assert!(validator.is_valid(&scene), "{scene}: {:?}", validator.iter_errors(&scene).next());
        joint["extra"] = json!(1);
        assert!(!validator.is_valid(&with_joint(joint)), "{kind} takes anything");
        let error = Scene::from_json(&scene.to_string(), "t.json").unwrap_err().to_string();
        assert!(error.contains("joints[0].type") && error.contains("not built yet"), "{error}");
    }
}

#[test]
fn scenes_outside_the_schema_do_not_load() {
    let validator = jsonschema::validator_for(&schema()).unwrap();
    let scenes = [
        json!([]),
        json!({ "bodies": [] }),
        json!({ "carom": 1 }),
        json!({ "carom": 2, "bodies": [] }),
        json!({ "carom": 1, "bodies": [], "dt": 0 }),
        json!({ "carom": 1, "bodies": [], "substeps": 1.5 }),
        json!({ "carom": 1, "bodies": [], "gravity": [0, 0] }),
        json!({ "carom": 1, "bodies": [], "materials": { "m": { "density": 1 } } }),
        json!({ "carom": 1, "bodies": [], "materials": { "m": { "friction_combine": "mean" } } }),
        with_body(json!({ "motion": "fixed" })),
        with_body(json!({ "name": "", "motion": "static" })),
        with_body(json!({ "mass": 1e-12 })),
        with_body(json!({ "motion": "static", "linear_damping": -1 })),
        with_body(json!({ "motion": "static", "position": [1e10, 0, 0] })),
        with_body(json!({ "motion": "kinematic", "linear_velocity": [0, 1e7, 0] })),
        with_body(json!({ "motion": "static", "colliders": [{}] })),
        with_shape(json!({ "type": "ball", "radius": 1 })),
        with_shape(json!({ "type": "sphere", "radius": 0 })),
        with_shape(json!({ "type": "sphere", "radius": 1, "height": 1 })),
        with_shape(
            json!({ "type": "capsule", "height": 1, "radius": 1, "radius_top": 1, "radius_bottom": 1 }),
        ),
        with_shape(json!({ "type": "cone", "height": 1 })),
        with_shape(json!({ "type": "mesh", "vertices": [], "triangles": [], "file": "a.obj" })),
        with_shape(json!({ "type": "hull", "points": [], "file": "a.obj" })),
        with_shape(json!({ "type": "mesh", "file": 7 })),
        with_shape(json!({ "type": "heightfield", "heights": [[0, 1]], "size": [4, 5] })),
        with_shape(json!({ "type": "heightfield", "heights": [[0], [1]], "size": [4, 5] })),
        with_shape(json!({ "type": "heightfield", "heights": [[0, 1], [1, 2e6]], "size": [4, 5] })),
        with_shape(json!({ "type": "heightfield", "heights": [[0, 1], [1, 0]], "size": [4, 0] })),
        with_shape(json!({ "type": "heightfield", "heights": [[0, 1], [1, 0]] })),
    ];
    for scene in scenes {
        assert!(!validator.is_valid(&scene), "{scene}");
        assert!(Scene::from_json(&scene.to_string(), "t.json").is_err(), "{scene}");
    }
}

/// The keys that the reader says it knows where it is given one that it does not.
fn known_keys(scene: &Value) -> Vec<String> {
    let Err(SceneError::Invalid { expected, .. }) = Scene::from_json(&scene.to_string(), "t.json") else {
        panic!("{scene}");
    };
    let keys = expected.strip_prefix("no such key; known here are ").unwrap_or_else(|| panic!("{expected}"));
    let mut keys: Vec<String> = keys.split(", ").map(str::to_owned).collect();
    keys.sort();
    keys
}

fn keys(schema: &Value) -> Vec<String> {
    let mut keys: Vec<String> = schema["properties"].as_object().unwrap().keys().cloned().collect();
    keys.sort();
    keys
}

#[test]
fn reader_and_schema_know_the_same_keys() {
    let schema = schema();
    let definitions = &schema["$defs"];
    let odd = "qqqqqqqqqqqqqqqqqqqqqqqqqqqqqq";
    assert_eq!(known_keys(&json!({ "carom": 1, odd: 1 })), keys(&schema));
    assert_eq!(known_keys(&with_body(json!({ odd: 1 }))), keys(&definitions["body"]));
    assert_eq!(known_keys(&with_body(json!({ "colliders": [{ odd: 1 }] }))), keys(&definitions["collider"]));
    let material = json!({ "carom": 1, "bodies": [], "materials": { "m": { odd: 1 } } });
    assert_eq!(known_keys(&material), keys(&definitions["material"]));
    for tag in ["sphere", "box", "capsule", "cylinder", "cone", "plane", "hull", "mesh", "heightfield"] {
        let kinds = definitions["shape"]["oneOf"].as_array().unwrap().iter();
        let mut expected: Vec<String> =
            kinds.filter(|kind| kind["properties"]["type"]["const"] == tag).flat_map(keys).collect();
        expected.sort();
        expected.dedup();
        assert_eq!(known_keys(&with_shape(json!({ "type": tag, odd: 1 }))), expected, "{tag}");
    }
}
