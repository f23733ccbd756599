//! Files that are refused, with the place that the error names; and files torn at random, which never panic.

use crate::{collider, glb, load_bytes, node, scene, try_load};
use carom_scene::SceneError;
use proptest::prelude::*;
use serde_json::{Value, json};

const BODY: &str = "nodes[0].extensions.KHR_physics_rigid_bodies";
const TABLES: &str = "extensions.KHR_physics_rigid_bodies";
const SHAPES: &str = "extensions.KHR_implicit_shapes.shapes";

/// One body with a collider from a mesh: a tetrahedron in a binary chunk.
fn whole() -> (Value, Vec<u8>) {
    let physics = json!({
        "motion": { "mass": 1, "centerOfMass": [0, 0, 0], "inertiaDiagonal": [1, 1, 1],
                    "inertiaOrientation": [0, 0, 0, 1], "linearVelocity": [0, 0, 0] },
        "collider": { "geometry": { "node": 1 }, "physicsMaterial": 0, "collisionFilter": 0 },
        "trigger": { "geometry": { "shape": 0 } }
    });
    let mut document = scene(json!([
        node(json!({ "name": "it", "rotation": [0, 0, 0, 1], "scale": [1, 1, 1] }), physics),
        { "mesh": 0 },
        { "children": [] }
    ]));
    document["scenes"] = json!([{ "nodes": [0, 2] }]);
    document["meshes"] = json!([{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }]);
    document["accessors"] = json!([
        { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4 },
        { "bufferView": 1, "componentType": 5121, "type": "SCALAR", "count": 12 }
    ]);
    document["bufferViews"] = json!([
        { "buffer": 0, "byteLength": 48 },
        { "buffer": 0, "byteOffset": 48, "byteLength": 12 }
    ]);
    document["buffers"] = json!([{ "byteLength": 60 }]);
    let corners = [0_f32, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.];
    let mut bytes: Vec<u8> = corners.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
    (document, bytes)
}

fn path_of(error: SceneError) -> String {
    match error {
        SceneError::Invalid { path, .. } => path,
        other => panic!("{other}"),
    }
}

/// Puts `value` where the pointer leads.
fn put(document: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = document.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer}"));
    match key.parse::<usize>() {
        Ok(index) if parent.is_array() => parent[index] = value,
        _ => parent[key] = value,
    }
}

#[test]
fn the_whole_file_loads() {
    let (document, bytes) = whole();
    let scene = load_bytes("a.glb", &glb(&document, &bytes)).unwrap();
    assert_eq!(scene.bodies[0].colliders.len(), 2);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn every_fault_is_named_with_its_place() {
    let body = |rest: &str| format!("{BODY}.{rest}");
    let table = |rest: &str| format!("{TABLES}.{rest}");
    let shape = |rest: &str| format!("{SHAPES}{rest}");
    let there = |path: &str| path.to_owned();
    let cases: Vec<(String, Value, String)> = [
        (body("motion.mass"), json!(-1), ""),
        (body("motion.mass"), json!(1e16), ""),
        (body("motion.mass"), json!(null), ""),
        (body("motion.mass"), json!("1"), ""),
        (body("motion.linearVelocity"), json!([0, 0, 2e6]), "[2]"),
        (body("motion.linearVelocity"), json!([0, 0]), ""),
        (body("motion.centerOfMass"), json!([0, 0, 2e9]), "[2]"),
        (body("motion.inertiaDiagonal"), json!([1, 1, -1]), "[2]"),
        (body("motion.inertiaDiagonal"), json!([1, 1, 5]), ""),
        (body("motion.inertiaOrientation"), json!([0, 0, 0, 1.1]), ""),
        (body("motion.isKinematic"), json!(1), ""),
        (body("motion.gravityFactor"), json!([]), ""),
        (body("motion.maxSpeed"), json!(1), ""),
        (body("motion"), json!([]), ""),
        (body("collider.shape"), json!(0), ""),
        (body("collider.physicsMaterial"), json!(1), ""),
        (body("collider.collisionFilter"), json!(3), ""),
        (body("collider.geometry.node"), json!(9), ""),
        (body("collider.geometry.shape"), json!(0), "<"),
        (body("collider.geometry.node"), json!(2), "<"),
        (body("collider.geometry"), json!({}), ""),
        (body("collider.geometry"), json!({ "shape": 7 }), ".shape"),
        (body("collider.geometry"), json!({ "shape": -1 }), ".shape"),
        (body("collider.geometry"), json!({ "shape": 4 }), "<"),
        (body("trigger.nodes"), json!([0]), "<.geometry"),
        (body("trigger"), json!({ "nodes": [2] }), ".nodes[0]"),
        (body("joint"), json!({ "joint": 0, "connectedNode": 1 }), ""),
        (body("velocity"), json!(0), ""),
        (table("physicsMaterials[0].restitution"), json!(1.5), ""),
        (table("physicsMaterials[0].staticFriction"), json!(-0.1), ""),
        (table("physicsMaterials[0].frictionCombine"), json!("mean"), ""),
        (table("physicsMaterials[0].friction"), json!(1), ""),
        (table("collisionFilters[0].notCollideWithSystems"), json!([]), ""),
        (table("collisionFilters[0].collisionSystems"), json!([1]), "[0]"),
        (table("materials"), json!([]), ""),
        (shape("[0].type"), json!("torus"), ""),
        (shape("[0].box"), json!({ "size": [1, 0, 1] }), ".size[1]"),
        (shape("[0].box"), json!({ "size": [1, 1e7, 1] }), ".size[1]"),
        (shape("[0].box"), json!({ "extent": 1 }), ".extent"),
        (shape("[1].sphere.radius"), json!(-1), ""),
        (shape("[2].capsule"), json!({ "radiusTop": 0, "radiusBottom": 0 }), ""),
        (there("nodes[0].rotation"), json!([0, 0, 0, 0.9]), ""),
        (there("nodes[0].translation"), json!([2e9, 0, 0]), "[0]"),
        (there("nodes[0].matrix"), json!([1]), "!nodes[0].rotation"),
        (there("nodes[0].scale"), json!(2), ""),
        (there("nodes[0].children"), json!([3]), "[0]"),
        (there("nodes[1].children"), json!([1]), ""),
        (there("nodes[2].children"), json!([0]), "!scenes[0].nodes[0]"),
        (there("scene"), json!(1), ""),
        (there("scenes[0].nodes"), json!([0, 0]), "[1]"),
        (there("scenes[0].nodes"), json!([0, 5]), "[1]"),
        (there("meshes[0].primitives[0].indices"), json!(2), ""),
        (there("meshes[0].primitives[0].mode"), json!(7), ""),
        (there("meshes[0].primitives[0].attributes"), json!({}), ".POSITION"),
        (there("nodes[1].mesh"), json!(1), ""),
        (there("accessors[0].bufferView"), json!(2), ""),
        (there("accessors[0].componentType"), json!(5130), ""),
        (there("accessors[0].type"), json!("VEC2"), ""),
        (there("accessors[0].count"), json!(5), ""),
        (there("accessors[0].count"), json!(9e15), ""),
        (there("accessors[0].count"), json!(3), "!accessors[1]"),
        (there("accessors[1].componentType"), json!(5120), ""),
        (there("accessors[0].byteOffset"), json!(9_007_199_254_740_991_u64), "!accessors[0].count"),
        (there("bufferViews[0].byteLength"), json!(100), ""),
        (there("bufferViews[0].byteStride"), json!(4), ""),
        (there("bufferViews[0].buffer"), json!(1), ""),
        (there("buffers[0].byteLength"), json!(1000), ""),
        (there("buffers[0].uri"), json!("data:;base64,A"), ""),
        (there("buffers[0].uri"), json!("no-such.bin"), ""),
        (there("buffers[0].uri"), json!("https://example.com/b.bin"), ""),
        (there("asset.version"), json!("1.0"), ""),
        (there("extensionsRequired"), json!(["OMI_physics_body"]), "[0]"),
    ]
    .into_iter()
    .map(|(path, value, rest)| {
        // `<` stands for the place around, `!` for another one.
        let around = path.rsplit_once('.').map_or("", |(around, _)| around).to_owned();
        let expected = match rest.chars().next() {
            Some('<') if path.ends_with("geometry") => path.clone(),
            Some('<') => format!("{around}{}", &rest[1..]),
            Some('!') => rest[1..].to_owned(),
            _ => format!("{path}{rest}"),
        };
        (path, value, expected)
    })
    .collect();
    for (path, value, expected) in cases {
        let (mut document, bytes) = whole();
        let pointer = format!("/{}", path.replace("].", "/").replace(']', "").replace(['.', '['], "/"));
        put(&mut document, &pointer, value.clone());
        match load_bytes("a.glb", &glb(&document, &bytes)) {
            Ok(_) => panic!("{path} = {value} was taken"),
            Err(error) => {
                let text = error.to_string();
                assert_eq!(path_of(error), expected, "{path} = {value}: {text}");
                assert!(text.contains("expected") && !text.contains('\n'), "{text}");
            }
        }
    }
}

#[test]
fn a_body_of_no_mass_is_told_what_to_add() {
    let error = try_load(&scene(json!([node(json!({}), json!({ "motion": {} }))]))).unwrap_err();
    assert!(error.to_string().contains("inertiaDiagonal"), "{error}");
    assert_eq!(path_of(error), format!("{BODY}.motion.mass"));
    let centre = json!({ "motion": { "centerOfMass": [0, 0, 0] } });
    let error = try_load(&scene(json!([node(json!({}), centre)]))).unwrap_err();
    assert_eq!(path_of(error), format!("{BODY}.motion.mass"));
}

#[test]
fn a_sheared_shape_is_refused() {
    let nodes = json!([
        { "scale": [1, 4, 1], "children": [1] },
        node(json!({ "rotation": [0, 0, 0.3826834323650898, 0.9238795325112867] }), json!({ "collider": collider(0) })),
    ]);
    let error = try_load(&scene(nodes)).unwrap_err();
    assert!(error.to_string().contains("perpendicular"), "{error}");
    assert_eq!(path_of(error), "nodes[1]");
}

#[test]
fn rings_and_two_parents_are_refused() {
    let error = try_load(&scene(json!([{ "children": [1] }, { "children": [2] }, { "children": [1] }])));
    assert_eq!(path_of(error.unwrap_err()), "nodes[2].children[0]");
    let error = try_load(&scene(json!([{}, { "children": [2] }, { "children": [1] }])));
    assert_eq!(path_of(error.unwrap_err()), "nodes[1].children");
}

#[test]
fn a_length_out_of_range_is_named_with_the_scale_that_made_it_so() {
    let small = node(json!({ "scale": [1e-7, 1e-7, 1e-7] }), json!({ "collider": collider(1) }));
    let error = try_load(&scene(json!([small]))).unwrap_err();
    assert!(error.to_string().contains("under the scale"), "{error}");
    assert_eq!(path_of(error), format!("{SHAPES}[1].sphere.radius"));
}

#[test]
fn torn_containers_are_one_clear_error() {
    let (document, bytes) = whole();
    let good = glb(&document, &bytes);
    let changed = |at: usize, byte: u8| {
        let mut bytes = good.clone();
        bytes[at] = byte;
        bytes
    };
    let mut latin = good.clone();
    latin[25] = 0xff;
    let cases = [
        ("magic", changed(0, b'G')),
        ("version", changed(4, 1)),
        ("length", changed(8, 0)),
        ("chunk length", changed(15, 0x7f)),
        ("chunk type", changed(16, b'j')),
        ("cut", good[..good.len() - 1].to_vec()),
        ("header only", good[..12].to_vec()),
        ("half a header", good[..7].to_vec()),
        ("nothing", Vec::new()),
        ("no UTF-8", latin),
    ];
    for (what, bytes) in cases {
        match load_bytes("a.glb", &bytes) {
            Err(SceneError::Invalid { path, .. }) => assert_eq!(path, "", "{what}"),
            other => panic!("{what}: {other:?}"),
        }
    }
    let error = load_bytes("a.gltf", br#"{ "asset": "#).unwrap_err();
    assert!(matches!(error, SceneError::Syntax { line: 1, .. }), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn mutations_never_panic(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8), cut in any::<Option<prop::sample::Index>>()) {
        let (document, bytes) = whole();
        let mut bytes = glb(&document, &bytes);
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        _ = load_bytes("a.glb", &bytes);
    }

    #[test]
    fn numbers_of_any_kind_never_panic(place in 0_usize..14, number in prop_oneof![
        any::<f64>().prop_filter("JSON", |x| x.is_finite()), (-3_i64..20).prop_map(|x| x as f64)
    ]) {
        let (mut document, bytes) = whole();
        let pointers = [
            "/nodes/0/scale/0", "/nodes/0/rotation/2", "/scenes/0/nodes/1", "/accessors/0/count",
            "/accessors/0/componentType", "/accessors/1/count", "/bufferViews/1/byteOffset",
            "/bufferViews/0/byteLength", "/buffers/0/byteLength", "/accessors/1/bufferView",
            "/nodes/0/extensions/KHR_physics_rigid_bodies/motion/mass",
            "/nodes/0/extensions/KHR_physics_rigid_bodies/motion/inertiaDiagonal/1",
            "/nodes/0/extensions/KHR_physics_rigid_bodies/collider/geometry/node",
            "/nodes/0/extensions/KHR_physics_rigid_bodies/motion/centerOfMass/0",
        ];
        put(&mut document, pointers[place], json!(number));
        _ = load_bytes("a.glb", &glb(&document, &bytes));
    }
}
