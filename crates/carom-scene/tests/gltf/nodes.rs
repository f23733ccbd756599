//! Transforms, ownership, names.

use crate::{body, collider, has_note, load, load_bytes, near, node, scene, size_of};
use carom::{Motion, Shape};
use serde_json::{Value, json};

const QUARTER: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn scales_and_rotations_compose_down_the_tree() {
    let scene = load(&scene(json!([
        { "translation": [1, 0, 0], "scale": [2, 2, 2], "rotation": [0, QUARTER, 0, QUARTER], "children": [1] },
        { "translation": [0, 0, 3], "children": [2] },
        node(json!({ "name": "box", "translation": [0, 1, 0], "scale": [1, -3, 0.5] }),
             json!({ "motion": { "mass": 1 }, "collider": collider(0) })),
    ])));
    let found = body(&scene, "box");
    // z of the root's child is the world's x: a quarter turn about y takes z to x.
    near(found.position, [1.0 + 6.0, 2.0, 0.0]);
    near((found.rotation.as_dquat() * carom::math::DVec3::Z).as_vec3().as_dvec3(), [1.0, 0.0, 0.0]);
    near(size_of(&found.colliders[0].shape), [2.0, 6.0, 1.0]);
    assert_eq!(found.colliders[0].pose, carom::math::Pose::IDENTITY);
}

#[test]
fn a_matrix_says_the_same_as_its_parts() {
    // By columns: x → 2z, y → 3y, z → −4x: a quarter turn about y with the scale 2, 3, 4, and a place.
    let matrix = [0, 0, -2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 5, 6, 7, 1];
    let found = load(&scene(json!([node(
        json!({ "name": "box", "matrix": matrix }),
        json!({ "collider": collider(0) })
    )])));
    let found = body(&found, "box");
    near(found.position, [5.0, 6.0, 7.0]);
    near(size_of(&found.colliders[0].shape), [2.0, 3.0, 4.0]);
    near(found.rotation.as_dquat() * carom::math::DVec3::X, [0.0, 0.0, -1.0]);
    assert_eq!(found.motion, Motion::Fixed);
}

#[test]
fn descendants_belong_to_the_nearest_motion_above() {
    let scene = load(&scene(json!([
        node(json!({ "name": "car", "translation": [0, 5, 0], "rotation": [0, 0, QUARTER, QUARTER], "children": [1, 3] }),
             json!({ "motion": { "mass": 2 } })),
        { "translation": [1, 0, 0], "children": [2] },
        node(json!({ "name": "wheel", "translation": [0, 2, 0], "rotation": [QUARTER, 0, 0, QUARTER] }),
             json!({ "collider": collider(3) })),
        node(json!({ "name": "load", "translation": [3, 0, 0], "children": [4] }),
             json!({ "motion": { "mass": 7, "isKinematic": true }, "collider": collider(1) })),
        node(json!({ "name": "lid" }), json!({ "collider": collider(0) })),
    ])));
    assert_eq!(scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(), ["car", "load"]);
    let car = body(&scene, "car");
    assert_eq!((car.motion, car.mass, car.colliders.len()), (Motion::Dynamic, Some(2.0), 1));
    near(car.colliders[0].pose.position, [1.0, 2.0, 0.0]);
    near(car.colliders[0].pose.rotation * carom::math::DVec3::Y, [0.0, 0.0, 1.0]);
    let load = body(&scene, "load");
    assert_eq!((load.motion, load.mass, load.colliders.len()), (Motion::Kinematic, None, 2));
    near(load.position, [0.0, 8.0, 0.0]);
    has_note(&scene, "no effect on a kinematic body");
}

#[test]
fn names_come_from_nodes_and_repetitions_get_the_index() {
    let part = |name: Value| {
        let named = if name.is_null() { json!({}) } else { json!({ "name": name }) };
        node(named, json!({ "collider": collider(0) }))
    };
    let nodes = ["a", "a", "", "node2", "a", "a#5", "a#1"].map(|name| part(json!(name)));
    let mut nodes = nodes.to_vec();
    nodes.push(part(Value::Null));
    let scene = load(&scene(json!(nodes)));
    let names: Vec<_> = scene.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["a", "a#1", "node2", "node2#3", "a#4", "a#5", "a#1#6", "node7"]);
}

#[test]
fn only_the_default_scene_counts() {
    let mut document = scene(json!([
        node(json!({ "name": "in" }), json!({ "collider": collider(0) })),
        node(json!({ "name": "out" }), json!({ "collider": collider(0) })),
    ]));
    document["scenes"] = json!([{ "nodes": [1] }, { "nodes": [0] }]);
    assert_eq!(load(&document).bodies[0].name, "out", "the first scene where none is the default");
    document["scene"] = json!(1);
    let scene = load(&document);
    assert_eq!(scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(), ["in"]);
    has_note(&scene, "nodes[1] is not part of the scene");
    assert_eq!((scene.name.as_str(), scene.dt, scene.sleeping), ("scene", 1.0 / 60.0, false));
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_is_no_problem() {
    let count = 100_000;
    let mut nodes: Vec<Value> =
        (1..count).map(|next| json!({ "children": [next], "translation": [0, 0.5, 0] })).collect();
    nodes.push(node(json!({ "name": "end" }), json!({ "collider": collider(1) })));
    let scene = load(&scene(json!(nodes)));
    near(body(&scene, "end").position, [0.0, 0.5 * f64::from(count - 1), 0.0]);
}

#[test]
fn round_shapes_stay_round_under_uneven_scales() {
    let part = |name: &str, shape: usize| {
        node(json!({ "name": name, "scale": [2, 3, -4] }), json!({ "collider": collider(shape) }))
    };
    let nodes =
        json!([part("sphere", 1), part("capsule", 2), part("cone", 3), part("sheet", 5), part("taper", 6)]);
    let scene = load(&scene(nodes));
    let shape = |name: &str| body(&scene, name).colliders[0].shape.clone();
    assert!(matches!(shape("sphere"), Shape::Sphere { radius: 4.0 }));
    assert!(matches!(shape("capsule"), Shape::Capsule { height: 6.0, radius: 2.0 }));
    assert!(matches!(shape("cone"), Shape::Cylinder { height: 6.0, radius_bottom: 2.0, radius_top: 0.0 }));
    assert!(matches!(
        shape("taper"),
        Shape::TaperedCapsule { height: 6.0, radius_bottom: 2.0, radius_top: 1.0 }
    ));
    let Shape::Mesh(sheet) = shape("sheet") else { panic!() };
    assert_eq!(sheet.triangles().len(), 2);
    assert!(sheet.vertices().iter().all(|v| v.abs() == carom::math::DVec3::new(2.0, 0.0, 8.0)));
    for what in ["a sphere under", "a capsule under", "a cylinder under"] {
        has_note(&scene, what);
    }
}

#[test]
fn a_scale_of_zero_switches_a_collider_off() {
    let scene = load(&scene(json!([
        node(json!({ "name": "off", "scale": [0, 0, 0] }), json!({ "collider": collider(0) })),
        node(json!({ "name": "ground" }), json!({ "collider": collider(4) })),
    ])));
    assert_eq!(scene.bodies.len(), 1);
    assert!(matches!(body(&scene, "ground").colliders[0].shape, Shape::Plane));
    has_note(&scene, "switched off");
}

#[test]
fn what_is_no_physics_is_noted() {
    let mut document = scene(json!([node(json!({ "name": "box" }), json!({ "collider": collider(0) }))]));
    document["extensionsRequired"] = json!(["KHR_lights_punctual"]);
    document["images"] = json!([{ "uri": "no%20such.png" }]);
    document["buffers"] = json!([{ "uri": "none.bin", "byteLength": 8 }]);
    document["animations"] =
        json!([{ "channels": [{ "sampler": 0, "target": { "node": 0, "path": "rotation" } }] }]);
    let scene = load(&document);
    for what in ["KHR_lights_punctual", "no%20such.png", "none.bin", "animations[0].channels[0]"] {
        has_note(&scene, what);
    }
    let empty = load_bytes("empty.gltf", br#"{ "asset": { "version": "2.0" } }"#).unwrap();
    assert!(empty.bodies.is_empty());
    has_note(&empty, "nothing to simulate");
}
