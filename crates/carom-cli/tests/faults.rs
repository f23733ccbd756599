//! Faults planted in the engine (`crates/carom/src/fault.rs`): `carom check` finds each and says which law, whose and when.

mod common;

use common::{Folder, bouncing, stderr, stdout};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program, with all faults in it, of which `CAROM_FAULT` picks one.
fn program() -> PathBuf {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("faults");
    let output = Command::new(env!("CARGO"))
        .args(["build", "--locked", "--package", "carom-cli", "--target-dir"])
        .arg(&target)
        .env("RUSTFLAGS", "--cfg carom_fault=\"any\"")
        .env_remove("CARGO_ENCODED_RUSTFLAGS")
        .current_dir(&workspace)
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{}", stderr(&output));
    target.join("debug").join("carom")
}

/// A scene, a fault, and the laws that it breaks there, among others.
const FAULTS: [(&str, &str, &[&str]); 11] = [
    ("off-centre-hit", "restitution", &["separating_speed", "energy"]),
    ("box-on-its-corner", "restitution", &["separating_speed"]),
    ("flat.json", "restitution", &["separating_speed"]),
    ("box-on-its-corner", "friction", &["push"]),
    ("off-centre-hit", "lever_arm", &["angular_momentum", "own_momentum"]),
    ("bat-and-ball", "lever_arm", &["angular_momentum", "own_momentum"]),
    ("off-centre-hit", "lost_impulse", &["linear_momentum", "own_momentum"]),
    ("off-centre-hit", "normal", &["linear_momentum", "own_momentum"]),
    ("off-centre-hit", "lost_collision", &["record"]),
    ("bouncing.json", "gravity", &["flight", "path"]),
    ("box-on-its-corner", "spin", &["spin", "turning"]),
];

fn checked(program: &Path, folder: &Folder, scene: &str, fault: &str) -> (Output, Value) {
    let arguments = ["check", scene, "--seconds", "2", "--quiet", "--json"];
    let output = Command::new(program)
        .args(arguments)
        .env("CAROM_FAULT", fault)
        .current_dir(folder.path(""))
        .output()
        .expect("the program starts");
    let verdict = serde_json::from_str(&stdout(&output))
        .unwrap_or_else(|error| panic!("{scene} with {fault}: {error}: {}", stderr(&output)));
    (output, verdict)
}

#[test]
#[ignore = "builds the program once more, with faults; .ci/run runs it"]
fn each_planted_fault_is_found_and_none_where_there_is_none() {
    let program = program();
    let folder = Folder::new("planted");
    folder.file("bouncing.json", bouncing());
    // Four corners at once.
    let corners = r#"{"type": "box", "size": [1, 1, 1]}, "friction": 0"#;
    let ball = r#"{"type": "sphere", "radius": 0.5}"#;
    assert!(bouncing().contains(ball));
    folder.file("flat.json", bouncing().replace(ball, corners).replace("[0, 0, 3]", "[0, 0, 0]"));
    for (scene, fault, laws) in FAULTS {
        let (output, verdict) = checked(&program, &folder, scene, "none");
        assert_eq!(output.status.code(), Some(0), "{scene} without a fault: {}", verdict["violations"]);
        assert_eq!(verdict["violations"], Value::Array(Vec::new()));

        let (output, verdict) = checked(&program, &folder, scene, fault);
        assert_eq!(output.status.code(), Some(1), "{scene} with {fault}: {}", verdict["laws"]);
        let violations = verdict["violations"].as_array().expect("a list");
        for law in laws {
            let found = violations.iter().find(|violation| violation["law"] == *law);
            let found = found.unwrap_or_else(|| panic!("{scene} with {fault}: no {law} in {violations:?}"));
            assert!(found["time"].as_f64().is_some_and(|time| (0.0..=2.0).contains(&time)), "{found}");
            let bodies = found["bodies"].as_array().expect("a list");
            assert!(!bodies.is_empty() && bodies.iter().all(|name| name != "?"), "{found}");
            assert!(found["error"].is_null() || found["error"].as_f64() > found["tolerance"].as_f64());
        }
    }
}
