//! Whatever is wrong with the input: exit status 2, one line on stderr, nothing written.

mod common;

use common::{Folder, bouncing};

/// A scene with one dynamic body of one collider, with these keys.
fn with_collider(keys: &str) -> String {
    with_body(&format!(r#""colliders": [{{{keys}}}]"#))
}

fn with_body(keys: &str) -> String {
    format!(r#"{{"carom": 1, "bodies": [{{{keys}}}]}}"#)
}

const BALL: &str = r#""colliders": [{"shape": {"type": "sphere", "radius": 0.5}}]"#;

#[test]
fn broken_scenes() {
    let folder = Folder::new("broken_scenes");
    let ball = |more: &str| with_body(&format!("{BALL}, {more}"));
    let cases: Vec<(&str, String)> = vec![
        ("empty", String::new()),
        ("no JSON", "hello".into()),
        ("cut short", bouncing()[..100].into()),
        ("no object", "[1, 2]".into()),
        ("no version", r#"{"bodies": []}"#.into()),
        ("a later version", r#"{"carom": 2, "bodies": []}"#.into()),
        ("no bodies", r#"{"carom": 1}"#.into()),
        ("bodies no list", r#"{"carom": 1, "bodies": 1000000000}"#.into()),
        ("unknown key", r#"{"carom": 1, "bodies": [], "gravitation": 1}"#.into()),
        ("NaN", r#"{"carom": 1, "bodies": [], "gravity": [0, NaN, 0]}"#.into()),
        ("infinite", r#"{"carom": 1, "bodies": [], "gravity": [0, 1e999, 0]}"#.into()),
        ("two coordinates", r#"{"carom": 1, "bodies": [], "gravity": [0, 1]}"#.into()),
        ("dt 0", r#"{"carom": 1, "bodies": [], "dt": 0}"#.into()),
        ("dt negative", r#"{"carom": 1, "bodies": [], "dt": -0.01}"#.into()),
        ("substeps 0", r#"{"carom": 1, "bodies": [], "substeps": 0}"#.into()),
        ("no shape", with_collider(r#""density": 1"#)),
        ("unknown shape", with_collider(r#""shape": {"type": "sper", "radius": 1}"#)),
        ("radius negative", with_collider(r#""shape": {"type": "sphere", "radius": -1}"#)),
        ("radius 0", with_collider(r#""shape": {"type": "sphere", "radius": 0}"#)),
        ("radius text", with_collider(r#""shape": {"type": "sphere", "radius": "1"}"#)),
        ("radius too large", with_collider(r#""shape": {"type": "sphere", "radius": 1e7}"#)),
        ("size of two", with_collider(r#""shape": {"type": "box", "size": [1, 2]}"#)),
        ("moving height field", {
            let field = r#"{"type": "heightfield", "heights": [[0, 0], [0, 0]], "size": [1, 1]}"#;
            with_collider(&format!(r#""shape": {field}"#))
        }),
        ("missing OBJ file", with_collider(r#""shape": {"type": "hull", "file": "nowhere.obj"}"#)),
        ("moving plane", with_collider(r#""shape": {"type": "plane"}"#)),
        ("unknown collider key", with_collider(r#""shape": {"type": "sphere", "radius": 1}, "bounce": 1"#)),
        (
            "dangling material",
            with_collider(r#""shape": {"type": "sphere", "radius": 1}, "material": "gold""#),
        ),
        ("restitution 2", with_collider(r#""shape": {"type": "sphere", "radius": 1}, "restitution": 2"#)),
        ("friction negative", with_collider(r#""shape": {"type": "sphere", "radius": 1}, "friction": -1"#)),
        ("far away", ball(r#""position": [2e9, 0, 0]"#)),
        ("too fast", ball(r#""linear_velocity": [1e7, 0, 0]"#)),
        ("no unit quaternion", ball(r#""rotation": [0, 0, 0, 2]"#)),
        ("unknown motion", ball(r#""motion": "floating""#)),
        ("mass negative", ball(r#""mass": -1"#)),
        ("mass too large", ball(r#""mass": 1e16"#)),
        ("inertia without mass", ball(r#""inertia_diagonal": [1, 1, 1]"#)),
        ("impossible inertia", ball(r#""mass": 1, "inertia_diagonal": [1, 1, 3]"#)),
        ("massless", with_body(r#""name": "ghost""#)),
        (
            "name twice",
            format!(r#"{{"carom": 1, "bodies": [{{"name": "x", {BALL}}}, {{"name": "x", {BALL}}}]}}"#),
        ),
        ("deep", "[".repeat(100_000)),
    ];
    assert!(cases.len() >= 20);
    let trace = folder.path("trace.jsonl");
    for (case, content) in &cases {
        folder.file("scene.json", content);
        for command in ["run", "check"] {
            let complaint =
                folder.refused(&[command, "scene.json", "--steps", "2", "--trace", "trace.jsonl"], 2);
            assert!(complaint.contains("scene.json"), "{case}: {complaint}");
        }
        folder.refused(&["explain", "scene.json"], 2);
        assert!(!trace.exists(), "{case}: a trace was begun");
    }
}

#[test]
fn an_obj_file_that_is_missing_or_broken_is_named_with_its_place_in_the_scene() {
    let folder = Folder::new("an_obj_file_that_is_missing_or_broken");
    folder.file("scene.json", with_collider(r#""shape": {"type": "hull", "file": "bunny.obj"}"#));
    let complaint = folder.refused(&["run", "scene.json"], 2);
    assert!(
        complaint.contains(r#"scene.json: bodies[0].colliders[0].shape.file: "bunny.obj"; expected"#),
        "{complaint}"
    );
    folder.file("bunny.obj", "v 0 0 0\nv 1 0 ear\n");
    let complaint = folder.refused(&["run", "scene.json"], 2);
    assert!(complaint.contains("shape.file (bunny.obj, line 2): ear; expected a number"), "{complaint}");
}

#[test]
fn broken_binary_files() {
    let folder = Folder::new("broken_binary_files");
    let mut cut = b"glTF".to_vec();
    cut.extend([2, 0, 0, 0, 0xff, 0, 0, 0, 0xff]);
    for (name, content) in [
        ("empty.glb", Vec::new()),
        ("cut.glb", cut),
        ("wild.glb", vec![0xff; 64]),
        ("wild.json", vec![0xff; 64]),
    ] {
        folder.file(name, content);
        folder.refused(&["run", name, "--trace", "trace.jsonl"], 2);
    }
    assert!(!folder.path("trace.jsonl").exists());
}

#[test]
fn scenes_that_are_not_there() {
    let folder = Folder::new("scenes_that_are_not_there");
    let complaint = folder.refused(&["run", "of-centre-hit"], 2);
    assert!(complaint.contains("off-centre-hit"), "{complaint}");
    folder.refused(&["run", "nowhere/scene.json"], 2);
    folder.refused(&["run", "."], 2);
    folder.refused(&["explain", ""], 2);
}

#[test]
fn arguments() {
    let folder = Folder::new("arguments");
    for arguments in [
        &["fly"][..],
        &["run"],
        &["run", "off-centre-hit", "--steps", "-1"],
        &["run", "off-centre-hit", "--steps", "1", "--seconds", "1"],
        &["run", "off-centre-hit", "--dt", "nan"],
        &["run", "off-centre-hit", "--dt", "0"],
        &["run", "off-centre-hit", "--substeps", "0"],
        &["run", "off-centre-hit", "--threads", "0"],
        &["run", "off-centre-hit", "--bake", "bake.glb"],
        &["explain", "off-centre-hit", "--about", "1,2"],
        &["view"],
    ] {
        folder.refused(arguments, 2);
    }
    let left = std::fs::read_dir(folder.path("")).expect("the folder").count();
    assert_eq!(left, 0, "nothing was written");
}

#[test]
fn the_scene_is_not_overwritten_by_its_trace() {
    let folder = Folder::new("the_scene_is_not_overwritten_by_its_trace");
    let scene = folder.file("scene.json", bouncing());
    folder.refused(&["run", "scene.json", "--trace", "./scene.json"], 2);
    assert_eq!(std::fs::read_to_string(scene).expect("still there"), bouncing());
}
