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
        let scenes: Vec<_> = builtin_scenes().iter().filter(|(.., bytes)| bytes.starts_with(b"{")).collect();
        let mut bytes = which.get(&scenes).2.to_vec();
        damage.iter().for_each(|damage| damage.apply(&mut bytes));
        if let Err(error) = Scene::from_json(&String::from_utf8_lossy(&bytes), "damaged.json") {
            let error = error.to_string();
            prop_assert!(error.starts_with("damaged.json: ") && !error.contains('\n'), "{}", error);
        }
    }
}
