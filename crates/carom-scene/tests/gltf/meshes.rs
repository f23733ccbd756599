//! Geometry from meshes: accessors, buffers, primitives.

use crate::{base64, body, folder, glb, load, load_bytes, node, scene};
use carom::math::DVec3;
use carom::{Body, Shape};
use carom_scene::Scene;
use serde_json::{Value, json};

/// A tetrahedron of volume 1/6, anticlockwise from outside.
const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [u8; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

fn floats(corners: &[[f32; 3]]) -> Vec<u8> {
    corners.iter().flatten().flat_map(|x| x.to_le_bytes()).collect()
}

/// A file with one body `it`, whose geometry is node 1 with mesh 0. Views are consecutive pieces of the buffer.
fn document(pieces: &[&[u8]], accessors: Value, primitive: Value, convex: bool) -> (Value, Vec<u8>) {
    let geometry = json!({ "node": 1, "convexHull": convex });
    let physics = json!({ "motion": { "mass": 1, "inertiaDiagonal": [1, 1, 1] }, "collider": { "geometry": geometry } });
    let mut document = scene(json!([node(json!({ "name": "it" }), physics), { "mesh": 0 }]));
    document["scenes"] = json!([{ "nodes": [0] }]);
    document["meshes"] = json!([{ "primitives": [primitive] }]);
    document["accessors"] = accessors;
    let (mut views, mut bytes) = (Vec::new(), Vec::new());
    for piece in pieces {
        views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": piece.len() }));
        bytes.extend_from_slice(piece);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    document["bufferViews"] = json!(views);
    document["buffers"] = json!([{ "byteLength": bytes.len() }]);
    (document, bytes)
}

fn load_glb((document, bytes): &(Value, Vec<u8>)) -> Scene {
    load_bytes("scene.glb", &glb(document, bytes)).unwrap_or_else(|error| panic!("{error}"))
}

fn positions(view: usize, count: usize) -> Value {
    json!({ "bufferView": view, "componentType": 5126, "type": "VEC3", "count": count })
}

fn indices(view: usize, kind: usize, count: usize) -> Value {
    json!({ "bufferView": view, "componentType": kind, "type": "SCALAR", "count": count })
}

fn triangles() -> Value {
    json!({ "attributes": { "POSITION": 0 }, "indices": 1 })
}

/// Triangles as corners, each turned so that the same triangle looks the same.
fn faces(body: &Body) -> Vec<[[i64; 3]; 3]> {
    let Shape::Mesh(mesh) = &body.colliders[0].shape else { panic!("{:?}", body.colliders[0].shape) };
    let corner = |i: u32| mesh.vertices()[i as usize].to_array().map(|x| (x * 1e4).round() as i64);
    let turned = |t: &[u32; 3]| {
        let mut corners = t.map(corner);
        let first = (0..3).min_by_key(|&i| corners[i]).unwrap();
        corners.rotate_left(first);
        corners
    };
    let mut all: Vec<_> = mesh.triangles().iter().map(turned).collect();
    all.sort_unstable();
    all
}

#[test]
fn indices_of_every_width_name_the_same_triangles() {
    let narrow = document(
        &[&floats(&CORNERS), &FACES],
        json!([positions(0, 4), indices(1, 5121, 12)]),
        triangles(),
        false,
    );
    let expected = faces(body(&load_glb(&narrow), "it"));
    assert_eq!(expected.len(), 4);
    let words: Vec<u8> = FACES.iter().flat_map(|&i| u16::from(i).to_le_bytes()).collect();
    let wide: Vec<u8> = FACES.iter().flat_map(|&i| u32::from(i).to_le_bytes()).collect();
    for (kind, bytes) in [(5123, words), (5125, wide)] {
        let accessors = json!([positions(0, 4), indices(1, kind, 12)]);
        let other = document(&[&floats(&CORNERS), &bytes], accessors, triangles(), false);
        assert_eq!(faces(body(&load_glb(&other), "it")), expected);
    }
}

#[test]
fn corners_without_indices_are_welded() {
    let corners: Vec<[f32; 3]> = FACES.iter().map(|&i| CORNERS[usize::from(i)]).collect();
    let loose = document(
        &[&floats(&corners)],
        json!([positions(0, 12)]),
        json!({ "attributes": { "POSITION": 0 } }),
        false,
    );
    let scene = load_glb(&loose);
    let Shape::Mesh(mesh) = &body(&scene, "it").colliders[0].shape else { panic!() };
    assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (4, 4));
}

#[test]
fn strips_and_fans() {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, -1.0]];
    let accessors = json!([positions(0, 4)]);
    let strip = json!({ "attributes": { "POSITION": 0 }, "mode": 5 });
    let strip = faces(body(&load_glb(&document(&[&floats(&square)], accessors.clone(), strip, false)), "it"));
    let around = [square[2], square[0], square[1], square[3]];
    let fan = json!({ "attributes": { "POSITION": 0 }, "mode": 6 });
    let fan = faces(body(&load_glb(&document(&[&floats(&around)], accessors, fan, false)), "it"));
    for (triangles, what) in [(&strip, "strip"), (&fan, "fan")] {
        assert_eq!(triangles.len(), 2, "{what}");
        for [a, b, c] in triangles.iter() {
            // All face +y: (b − a) × (c − a) points up.
            let up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
            assert!(up > 0, "{what}: {triangles:?}");
        }
    }
}

#[test]
fn positions_may_be_strided_and_normalised() {
    // 127 stands for 1; each element is padded to eight bytes.
    let bytes: Vec<u8> = CORNERS
        .iter()
        .flat_map(|corner| corner.map(|x| (x * 127.0) as u8).into_iter().chain([0xff; 5]))
        .collect();
    let accessors = json!([
        { "bufferView": 0, "componentType": 5120, "normalized": true, "type": "VEC3", "count": 4 },
        indices(1, 5121, 12)
    ]);
    let mut file = document(&[&bytes, &FACES], accessors, triangles(), false);
    file.0["bufferViews"][0]["byteStride"] = json!(8);
    let plain = document(
        &[&floats(&CORNERS), &FACES],
        json!([positions(0, 4), indices(1, 5121, 12)]),
        triangles(),
        false,
    );
    assert_eq!(faces(body(&load_glb(&file), "it")), faces(body(&load_glb(&plain), "it")));
}

#[test]
fn sparse_positions_replace_what_is_there() {
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 2, "componentType": 5121 },
        "values": { "bufferView": 3 }
    });
    let mut accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    accessors[0]["sparse"] = sparse;
    let moved = floats(&[[0.0, 0.0, 2.0]]);
    let file = document(&[&floats(&CORNERS), &FACES, &[3], &moved], accessors.clone(), triangles(), false);
    let Shape::Mesh(mesh) = body(&load_glb(&file), "it").colliders[0].shape.clone() else { panic!() };
    assert!(mesh.vertices().contains(&DVec3::new(0.0, 0.0, 2.0)) && !mesh.vertices().contains(&DVec3::Z));

    // On a ground of zeros: without a view of its own.
    accessors[0].as_object_mut().unwrap().remove("bufferView");
    accessors[0]["sparse"]["count"] = json!(3);
    let three = floats(&CORNERS[1..]);
    let file = document(&[&[], &FACES, &[1, 2, 3], &three], accessors, triangles(), false);
    assert_eq!(faces(body(&load_glb(&file), "it")).len(), 4);
}

#[test]
fn data_uris_and_files_beside_the_scene() {
    let accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    let (mut file, bytes) = document(&[&floats(&CORNERS), &FACES], accessors, triangles(), true);
    file["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{}", base64(&bytes)));
    let hull = |scene: &Scene| match &body(scene, "it").colliders[0].shape {
        Shape::Hull(hull) => hull.vertices().len(),
        other => panic!("{other:?}"),
    };
    assert_eq!(hull(&load(&file)), 4);

    let folder = folder();
    file["buffers"][0]["uri"] = json!("my%20data/b.bin");
    std::fs::create_dir(folder.join("my data")).unwrap();
    std::fs::write(folder.join("my data/b.bin"), &bytes).unwrap();
    std::fs::write(folder.join("scene.gltf"), file.to_string()).unwrap();
    assert_eq!(hull(&Scene::load(&folder.join("scene.gltf")).unwrap()), 4);
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn the_collider_places_a_geometry_and_children_count() {
    let accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    let mut file = document(&[&floats(&CORNERS), &FACES], accessors, triangles(), false);
    // Node 1, the geometry, is far away and has a child with the same mesh; the collider's node mirrors x.
    file.0["nodes"][0]["scale"] = json!([-2, 1, 1]);
    file.0["nodes"][1]["translation"] = json!([100, 0, 0]);
    file.0["nodes"][1]["children"] = json!([2]);
    file.0["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0, "translation": [5, 0, 0] }));
    let scene = load_glb(&file);
    let it = body(&scene, "it");
    let Shape::Mesh(mesh) = &it.colliders[0].shape else { panic!() };
    assert_eq!((mesh.vertices().len(), mesh.triangles().len()), (8, 8));
    let lowest = mesh.vertices().iter().map(|v| v.x).fold(0.0, f64::min);
    assert_eq!(lowest, -12.0);
    let volume: f64 = mesh
        .triangles()
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| mesh.vertices()[i as usize]);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((volume - 4.0 / 6.0).abs() < 1e-12, "still facing outwards: {volume}");
}

/// The tetrahedron as the geometry of a body with a mass and no moments, in nodes of their own: `collider` for the
/// body's, `geometry` for that of the mesh, `child` for another one below it with the same mesh.
fn family(collider: Value, geometry: Value, child: Value, convex: bool) -> Scene {
    let accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    let mut file = document(&[&floats(&CORNERS), &FACES], accessors, triangles(), convex);
    let nodes = file.0["nodes"].as_array_mut().unwrap();
    nodes.push(json!({ "mesh": 0 }));
    nodes[1]["children"] = json!([2]);
    for (node, transform) in nodes.iter_mut().zip([collider, geometry, child]) {
        node.as_object_mut().unwrap().extend(transform.as_object().unwrap().clone());
    }
    let motion = &mut nodes[0]["extensions"]["KHR_physics_rigid_bodies"]["motion"];
    motion.as_object_mut().unwrap().remove("inertiaDiagonal");
    load_glb(&file)
}

#[test]
fn scales_count_in_every_node_and_mirrors_keep_the_outside_outside() {
    for (scale, child, volume, center_x) in [
        ([2.0, 3.0, 4.0], [1.0, 1.0, 1.0], 24.0, 0.25),
        ([2.0, 3.0, 4.0], [0.5, 2.0, 1.0], 24.0, 0.125),
        ([-2.0, 3.0, 4.0], [1.0, 1.0, 1.0], 24.0, 0.25),
        ([-2.0, -3.0, -4.0], [1.0, 1.0, 1.0], 24.0, 0.25),
        ([1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], 1.0, -0.25),
        ([1.0, -1.0, 1.0], [-1.0, -1.0, -1.0], 1.0, -0.25),
    ] {
        let scene = family(
            json!({ "scale": scale }),
            json!({ "translation": [100, 0, 0], "scale": [7, 7, 7] }),
            json!({ "translation": [5, 0, 0], "scale": child }),
            false,
        );
        let it = body(&scene, "it");
        let whole = it.collider_mass();
        // The geometry's own transform has no part; each tetrahedron has a sixth of its box.
        let share = child.iter().product::<f64>().abs();
        let expected = volume * (1.0 + share) / 6.0 * 1000.0;
        assert!((whole.mass - expected).abs() < 1e-9 * expected, "{scale:?} {child:?}: {}", whole.mass);
        let center = scale[0] * (0.25 + share * (5.0 + center_x)) / (1.0 + share);
        assert!((whole.center.x - center).abs() < 1e-9, "{scale:?} {child:?}: {}", whole.center);
    }
}

#[test]
fn a_convex_hull_holds_the_meshes_of_all_nodes_below() {
    let scene = family(
        json!({ "scale": [-2, 1, 3] }),
        json!({ "translation": [100, 0, 0] }),
        json!({ "translation": [5, 0, 0], "scale": [1, -1, 1] }),
        true,
    );
    let it = body(&scene, "it");
    let Shape::Hull(hull) = &it.colliders[0].shape else { panic!("{:?}", it.colliders[0].shape) };
    let (low, high) = it.colliders[0].shape.bounds(&carom::math::Pose::IDENTITY);
    assert_eq!((low, high), (DVec3::new(-12.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 3.0)));
    // One corner of the first lies between others: (0, 0, 0), (5, 0, 0) and (1, 0, 0) are in a row.
    assert_eq!(hull.vertices().len(), 6, "{:?}", hull.vertices());
    assert!(it.collider_mass().mass > 0.0);
}

#[test]
fn a_mesh_follows_shear_that_a_shape_cannot() {
    let accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    let mut file = document(&[&floats(&CORNERS), &FACES], accessors, triangles(), true);
    let turned = json!({ "rotation": [0, 0, 0.3826834323650898, 0.9238795325112867] });
    let collider = json!({ "collider": { "geometry": { "node": 1, "convexHull": true } } });
    let mut child = node(turned, collider);
    child["name"] = json!("it");
    file.0["nodes"][0] = json!({ "scale": [1, 4, 1], "children": [2] });
    file.0["nodes"].as_array_mut().unwrap().push(child);
    let scene = load_glb(&file);
    let it = body(&scene, "it");
    let Shape::Hull(hull) = &it.colliders[0].shape else { panic!() };
    let world = |v: &DVec3| it.rotation.as_dquat() * *v;
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for corner in [DVec3::new(half, 4.0 * half, 0.0), DVec3::new(-half, 4.0 * half, 0.0), DVec3::Z] {
        assert!(hull.vertices().iter().any(|v| (world(v) - corner).length() < 1e-6), "{corner}");
    }
}

#[test]
fn morph_weights_and_skins_bend_the_surface() {
    let up = floats(&[[0.0, 1.0, 0.0]; 4]);
    let accessors = json!([positions(0, 4), indices(1, 5121, 12), positions(2, 4)]);
    let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": 1, "targets": [{ "POSITION": 2 }] });
    let mut file = document(&[&floats(&CORNERS), &FACES, &up], accessors, primitive, false);
    file.0["meshes"][0]["weights"] = json!([0.25]);
    let lowest = |scene: &Scene| {
        let Shape::Mesh(mesh) = &body(scene, "it").colliders[0].shape else { panic!() };
        mesh.vertices().iter().map(|v| v.y).fold(f64::INFINITY, f64::min)
    };
    assert_eq!(lowest(&load_glb(&file)), 0.25);
    file.0["nodes"][1]["weights"] = json!([2]);
    assert_eq!(lowest(&load_glb(&file)), 2.0, "the node's weights go before the mesh's");

    // One joint, 3 m above the mesh's node, carries all vertices.
    let joints = [0_u8; 16];
    let weights: Vec<u8> =
        [[1.0_f32, 0.0, 0.0, 0.0]; 4].iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    let accessors = json!([
        positions(0, 4),
        indices(1, 5121, 12),
        { "bufferView": 2, "componentType": 5121, "type": "VEC4", "count": 4 },
        { "bufferView": 3, "componentType": 5126, "type": "VEC4", "count": 4 }
    ]);
    let primitive = json!({ "attributes": { "POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3 }, "indices": 1 });
    let mut file = document(&[&floats(&CORNERS), &FACES, &joints, &weights], accessors, primitive, false);
    file.0["skins"] = json!([{ "joints": [2] }]);
    file.0["nodes"][1]["skin"] = json!(0);
    file.0["nodes"][1]["translation"] = json!([0, 10, 0]);
    file.0["nodes"].as_array_mut().unwrap().push(json!({ "translation": [0, 13, 0] }));
    assert_eq!(lowest(&load_glb(&file)), 3.0);
}

#[test]
fn points_and_lines_have_no_surface() {
    let accessors = json!([positions(0, 4), indices(1, 5121, 12)]);
    let mut file = document(&[&floats(&CORNERS), &FACES], accessors, triangles(), false);
    let lines = json!({ "attributes": { "POSITION": 0 }, "mode": 1 });
    file.0["meshes"][0]["primitives"].as_array_mut().unwrap().push(lines);
    let scene = load_glb(&file);
    assert_eq!(faces(body(&scene, "it")).len(), 4);
    crate::has_note(&scene, "meshes[0].primitives[1]");
}
