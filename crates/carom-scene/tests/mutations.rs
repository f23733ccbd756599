//! Damaged scenes: whatever happens to the bytes of a file, reading it ends in a scene or an error of one line.

use carom_scene::{Scene, builtin_scenes};
use proptest::prelude::*;

/// One thing that can happen to a text.
#[derive(Clone, Debug)]
enum Damage {
    Overwrite(prop::sample::Index, u8),
    Remove(prop::sample::Index, usize),
    Insert(prop::sample::Index, &'static str),
    Repeat(prop::sample::Index, usize),
}

impl Damage {
    fn strategy() -> impl Strategy<Value = Damage> {
        let pieces = [
            "null",
            "-",
            "1e999",
            "NaN",
            "{",
            "[",
            "]",
            "}",
            ",",
            "\"",
            "\\u0000",
            "0",
            "9999999999",
            "\"mass\":0,",
            "\"type\":\"mesh\",",
            "{\"carom\":1,\"bodies\":[]}",
            "1e-7",
            "true",
            "\u{feff}",
            "é",
        ];
        let at = any::<prop::sample::Index>;
        prop_oneof![
            (at(), any::<u8>()).prop_map(|(at, byte)| Damage::Overwrite(at, byte)),
            (at(), 1..40_usize).prop_map(|(at, length)| Damage::Remove(at, length)),
            (at(), prop::sample::select(pieces.to_vec())).prop_map(|(at, piece)| Damage::Insert(at, piece)),
            (at(), 1..200_usize).prop_map(|(at, length)| Damage::Repeat(at, length)),
        ]
    }

    fn apply(&self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        match self {
            Damage::Overwrite(at, byte) => *at.get_mut(bytes) = *byte,
            Damage::Remove(at, length) => {
                let start = at.index(bytes.len());
                bytes.drain(start..(start + length).min(bytes.len()));
            }
            Damage::Insert(at, piece) => {
                let start = at.index(bytes.len());
                bytes.splice(start..start, piece.bytes());
            }
            Damage::Repeat(at, length) => {
                let start = at.index(bytes.len());
                let piece = bytes[start..(start + length).min(bytes.len())].to_vec();
                bytes.splice(start..start, piece);
            }
        }
    }
}

/// Shapes that no built-in scene has, files included.
const SHAPES: &str = r#"{ "carom": 1, "bodies": [
    { "motion": "static", "colliders": [ { "shape":
        { "type": "heightfield", "heights": [[0, 0.5, 1], [0, 0.25, 0], [1e-3, -2, 3]], "size": [4, 5] } } ] },
    { "mass": 2, "colliders": [ { "shape": { "type": "mesh", "file": "tests/tetrahedron.obj" } },
        { "shape": { "type": "hull", "file": "tests/tetrahedron.obj" } },
        { "shape": { "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] } } ] } ] }"#;

#[test]
fn the_scene_to_be_damaged_is_whole() {
    assert!(Scene::from_json(SHAPES, "whole.json").is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000,
        failure_persistence: None,
        rng_seed: prop::test_runner::RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn a_damaged_scene_never_panics(
        which in any::<prop::sample::Index>(),
        damage in prop::collection::vec(Damage::strategy(), 1..6),
    ) {
        let builtin = builtin_scenes().iter().map(|(.., bytes)| *bytes).filter(|bytes| bytes.starts_with(b"{"));
        // Every other one is of shapes.
        let scenes: Vec<_> = builtin.flat_map(|bytes| [bytes, SHAPES.as_bytes()]).collect();
        let mut bytes = which.get(&scenes).to_vec();
        damage.iter().for_each(|damage| damage.apply(&mut bytes));
        if let Err(error) = Scene::from_json(&String::from_utf8_lossy(&bytes), "damaged.json") {
            let error = error.to_string();
            prop_assert!(error.starts_with("damaged.json: ") && !error.contains('\n'), "{}", error);
        }
    }

    #[test]
    fn a_damaged_obj_file_never_panics(damage in prop::collection::vec(Damage::strategy(), 1..6)) {
        let mut bytes = include_bytes!("tetrahedron.obj").to_vec();
        damage.iter().for_each(|damage| damage.apply(&mut bytes));
        let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
        std::fs::write(folder.join("damaged.obj"), &bytes).unwrap();
        for kind in ["hull", "mesh"] {
            let scene = format!(
                r#"{{ "carom": 1, "bodies": [ {{ "motion": "static", "colliders": [ {{ "shape": {{ "type": "{kind}", "file": "damaged.obj" }} }} ] }} ] }}"#
            );
            let origin = folder.join("damaged-obj.json").display().to_string();
            if let Err(error) = Scene::from_json(&scene, &origin) {
                let error = error.to_string();
                prop_assert!(error.contains("damaged.obj") && !error.contains('\n'), "{}", error);
            }
        }
    }
}
