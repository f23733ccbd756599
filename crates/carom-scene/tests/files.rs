//! Files: which format they are taken for, and what is said of those that are no scene at all.

use carom::Shape;
use carom_scene::{Scene, SceneError};
use std::fs;
use std::path::{Path, PathBuf};

const ANCHOR: &str = r#"{ "carom": 1, "bodies": [ { "motion": "static" } ] }"#;

/// A file with `content` in a folder of this test run.
fn file(name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("scene-files");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

/// What is said of a file with `content`, after its name.
fn said(name: &str, content: impl AsRef<[u8]>) -> String {
    let path = file(name, content);
    let error = Scene::load(&path).unwrap_err().to_string();
    let said = error.strip_prefix(&format!("{}: ", path.display()));
    said.unwrap_or_else(|| panic!("{error}")).to_owned()
}

#[test]
fn a_scene_is_known_by_its_ending_or_its_content() {
    for name in ["anchor.json", "anchor.JSON", "anchor.scene", "anchor"] {
        let scene = Scene::load(&file(name, ANCHOR)).unwrap();
        assert_eq!((scene.name.as_str(), scene.bodies.len()), ("anchor", 1), "{name}");
    }
    assert!(Scene::load(&file("marked.json", format!("\u{feff}{ANCHOR}"))).is_ok(), "a byte order mark");
    assert!(
        said("asset.json", r#"{ "asset": { "version": "2.0" } }"#).starts_with("carom: nothing; expected 1")
    );
}

#[test]
fn files_that_cannot_be_read() {
    let missing = Scene::load(Path::new("no/such/scene.json")).unwrap_err();
    assert!(matches!(&missing, SceneError::Unreadable { file, .. } if file == "no/such/scene.json"));
    assert!(missing.to_string().starts_with("no/such/scene.json: "));
    let folder = Scene::load(Path::new(env!("CARGO_TARGET_TMPDIR"))).unwrap_err();
    assert!(matches!(folder, SceneError::Unreadable { .. }), "{folder}");
}

#[test]
fn a_file_over_a_gibibyte_is_not_even_read() {
    let path = file("huge.json", "");
    // All hole: takes no place on the disk.
    fs::File::options().write(true).open(&path).unwrap().set_len((1 << 30) + 1).unwrap();
    let error = Scene::load(&path).unwrap_err().to_string();
    fs::remove_file(&path).unwrap();
    assert!(error.ends_with("huge.json: 1073741825 bytes; expected a file of at most 1 GiB"), "{error}");
}

#[test]
fn text_that_is_no_json_is_refused_with_line_and_column() {
    let cases = [
        ("{\n  \"carom\": 1,\n  \"bodies\": [\n", "line 4, column 0: EOF while parsing a list (in bodies)"),
        ("{\n  \"carom\": 1\n  \"bodies\": []\n}", "line 3, column 3: expected `,` or `}`"),
        ("{ \"carom\": 1, \"bodies\": [], }", "line 1, column 29: trailing comma"),
        ("{ \"carom\": 1, \"bodies\": [] } x", "line 1, column 30: trailing characters"),
        ("{ 'carom': 1 }", "line 1, column 3: key must be a string"),
        ("{ \"carom\": 01 }", "line 1, column 13: invalid number (in carom)"),
        ("{ \"carom\": yes }", "line 1, column 12: expected value (in carom)"),
        ("\"caf\u{e9}", "line 1, column 6: EOF while parsing a string"),
        ("carom: 1", "line 1, column 1: expected value"),
    ];
    for (text, expected) in cases {
        assert_eq!(said("broken.json", text), expected, "{text}");
    }
}

#[test]
fn empty_files_and_other_values_are_refused() {
    for text in ["", " \n\t", "\u{feff}"] {
        assert!(said("empty.json", text).starts_with("an empty file; expected a scene: {"), "{text:?}");
    }
    for text in ["null", "[]", "7", "\"scene\""] {
        assert_eq!(said("other.json", text), format!("{text}; expected an object {{...}}"));
    }
}

const TETRAHEDRON: &str = include_str!("tetrahedron.obj");

/// A scene whose one dynamic body has that shape.
fn with_shape(shape: &str) -> String {
    format!(
        r#"{{ "carom": 1, "bodies": [ {{ "mass": 1, "colliders": [ {{ "shape": {shape} }}, {{ "shape": {shape} }} ] }} ] }}"#
    )
}

#[test]
fn shapes_come_from_obj_files_beside_the_scene() {
    let obj = file("tetrahedron.obj", TETRAHEDRON);
    let scene = |shape: &str| Scene::load(&file("shape.json", with_shape(shape))).unwrap().bodies.remove(0);
    for name in ["tetrahedron.obj", "../scene-files/tetrahedron.obj", obj.to_str().unwrap()] {
        let mesh = scene(&format!(r#"{{ "type": "mesh", "file": {name:?} }}"#));
        let [Shape::Mesh(one), Shape::Mesh(other)] = [0, 1].map(|i| mesh.colliders[i].shape.clone()) else {
            panic!("{mesh:?}");
        };
        assert_eq!((one.vertices().len(), one.triangles().len()), (4, 4));
        assert!(std::sync::Arc::ptr_eq(&one, &other), "read once");
        assert!((mesh.colliders[0].shape.mass_properties(6.0).mass - 1.0).abs() < 1e-12, "closed");
        let hull = scene(&format!(r#"{{ "type": "hull", "file": {name:?} }}"#));
        assert!(matches!(&hull.colliders[0].shape, Shape::Hull(hull) if hull.vertices().len() == 4));
    }
    // From text the folder is that of the name, else the current one: that of the crate.
    let shape = with_shape(r#"{ "type": "hull", "file": "tetrahedron.obj" }"#);
    assert!(Scene::from_json(&shape, "tests/text.json").is_ok());
    assert!(Scene::from_json(&shape, "text.json").is_err());
}

#[test]
fn a_hull_takes_all_vertices_with_or_without_a_face() {
    file("stray.obj", format!("{TETRAHEDRON}v 9 9 9\n"));
    let scene = with_shape(r#"{ "type": "hull", "file": "stray.obj" }"#);
    let scene = Scene::load(&file("stray.json", scene)).unwrap();
    assert_eq!(scene.bodies[0].colliders[0].shape.bounds(&carom::math::Pose::IDENTITY).1.x, 9.0);
}

#[test]
fn trouble_in_an_obj_file_is_told_with_its_line() {
    let said = |content: &str, kind: &str| {
        let obj = file("trouble.obj", content);
        let scene = with_shape(&format!(r#"{{ "type": "{kind}", "file": "trouble.obj" }}"#));
        let said = said("trouble.json", scene);
        let start = format!("bodies[0].colliders[0].shape.file ({}", obj.display());
        said.strip_prefix(&start).unwrap_or_else(|| panic!("{said}")).to_owned()
    };
    let face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(
        said(&format!("{face}f 1 2 9\n"), "mesh"),
        ", line 5): 9; expected the number of one of the file's 3 vertices"
    );
    assert_eq!(said("v 0 0 x", "hull"), ", line 1): x; expected a number from -1e6 to 1e6 m");
    assert_eq!(said("", "mesh"), "): no face; expected at least one face (a line `f 1 2 3`)");
    assert!(said(face, "hull").starts_with("): 3 vertices; expected at least 4 vertices"));
    assert!(said(&format!("{face}v 1 1 0"), "hull").contains("expected"), "a flat hull");
    assert!(said("v 0 0 0\nf 1 1 1", "mesh").contains("at least one triangle with an area"));
}

#[test]
fn bytes_that_are_no_utf8_are_refused_with_their_place() {
    assert_eq!(said("latin.json", b"{\n \"caf\xe9\": 1 }"), "line 2, column 6: byte 0xe9 is not UTF-8 text");
    assert_eq!(said("binary", [0xff, 0xfe, 0x00]), "line 1, column 1: byte 0xff is not UTF-8 text");
    assert_eq!(said("cut.json", b"\"\xe2\x82"), "line 1, column 2: byte 0xe2 is not UTF-8 text");
}

#[test]
fn towers_of_brackets_are_refused() {
    for (open, n) in [("[", 100_000), ("{\"a\":", 100_000)] {
        let said = said("tower.json", open.repeat(n));
        assert!(
            said.starts_with("line 1, column ") && said.contains(": nested too deep; at most 127 "),
            "{said}"
        );
    }
    let deep = format!(r#"{{ "carom": 1, "bodies": {}{} }}"#, "[".repeat(126), "]".repeat(126));
    assert!(said("deep.json", deep).starts_with("bodies[0]: [[["));
}

#[test]
fn numbers_that_no_double_holds_are_refused() {
    let scene = |number: &str| format!("{{ \"carom\": 1, \"bodies\": [],\n  \"dt\": {number} }}");
    for number in ["NaN", "nan", "Infinity", "-Infinity", "+inf", "1e999", "-1e999"] {
        let said = said("number.json", scene(number));
        let expected = format!("dt: {number}; expected a finite number (line 2, column ");
        assert!(said.starts_with(&expected), "{said}");
    }
    let digits = "9".repeat(400);
    assert!(said("digits.json", scene(&digits)).contains("99…; expected a finite number (line 2"));
    assert_eq!(said("tiny.json", scene("1e-999")), "dt: 0; expected a number from 1e-6 to 1 s");
    assert_eq!(
        said("large.json", scene("18446744073709551616")),
        "dt: 1.8446744073709552e19; expected a number from 1e-6 to 1 s"
    );
}

#[test]
fn a_repeated_key_is_refused_at_any_depth() {
    assert!(said("twice.json", r#"{ "carom": 1, "carom": 1, "bodies": [] }"#).starts_with(
        "carom: 1; expected each key once in an object; this one is there already (line 1, column "
    ));
    let deep = r#"{ "carom": 1, "bodies": [ {}, { "colliders": [ { "shape": { "type": "a", "\u0074ype": "b" } } ] } ] }"#;
    assert!(
        said("deep.json", deep)
            .starts_with(r#"bodies[1].colliders[0].shape.type: "b"; expected each key once"#)
    );
}
