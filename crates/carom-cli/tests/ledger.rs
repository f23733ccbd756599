//! The ledger as a file, and its totals in the summary.

mod common;

use common::{Folder, bouncing};
use serde_json::Value;

const HEADER: &str = "step,time,px,py,pz,lx,ly,lz,kinetic,potential,elastic,\
    gravity_px,gravity_py,gravity_pz,gravity_lx,gravity_ly,gravity_lz,\
    external_px,external_py,external_pz,external_lx,external_ly,external_lz,\
    static_px,static_py,static_pz,static_lx,static_ly,static_lz,\
    kinematic_px,kinematic_py,kinematic_pz,kinematic_lx,kinematic_ly,kinematic_lz,\
    loss_restitution,loss_friction,loss_contact,loss_rest_capture,loss_damping,loss_joint,loss_sleep,\
    work_motor,work_external,work_kinematic,position_correction,integration,\
    residual_px,residual_py,residual_pz,residual_lx,residual_ly,residual_lz,residual_energy";

/// Columns in groups.
const MOMENTUM: usize = 2;
const ENERGY: usize = 8;
const ACCOUNTS: [usize; 4] = [11, 17, 23, 29];
const LOSSES: std::ops::Range<usize> = 35..42;
const WORKS: std::ops::Range<usize> = 42..47;
const RESIDUALS: usize = 47;

fn rows(folder: &Folder, name: &str) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.path(name)).expect("the ledger");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(HEADER));
    let number = |cell: &str| cell.parse::<f64>().unwrap_or_else(|error| panic!("{error} in {cell}"));
    lines.map(|line| line.split(',').map(number).collect()).collect()
}

/// Holds a row to the one before: what it says has changed, has.
fn assert_balanced(before: &[f64], row: &[f64], what: &str) {
    for axis in 0..6 {
        let change = row[MOMENTUM + axis] - before[MOMENTUM + axis];
        let entered: f64 = ACCOUNTS.iter().map(|account| row[account + axis]).sum();
        let size = row[MOMENTUM + axis].abs()
            + ACCOUNTS.iter().map(|account| row[account + axis].abs()).sum::<f64>();
        let residual = row[RESIDUALS + axis];
        assert!((change - entered - residual).abs() <= 1e-12 * size + 1e-12, "{what}, axis {axis}: {row:?}");
        let posts: f64 =
            ACCOUNTS.iter().flat_map(|account| &row[account + axis / 3 * 3..][..3]).map(|it| it.abs()).sum();
        assert!(
            residual.abs() <= 1e-5 * posts + 1e-12 * size + 1e-12,
            "{what}, axis {axis}: {residual} of {posts}"
        );
    }
    let energy = |row: &[f64]| row[ENERGY] + row[ENERGY + 1] + row[ENERGY + 2];
    let entered = row[WORKS].iter().sum::<f64>() - row[LOSSES].iter().sum::<f64>();
    let posts: f64 = row[35..47].iter().map(|it| it.abs()).sum();
    let size = row[ENERGY] + row[ENERGY + 1].abs();
    let residual = row[RESIDUALS + 6];
    assert!(
        (energy(row) - energy(before) - entered - residual).abs() <= 1e-11 * (size + posts),
        "{what}: {row:?}"
    );
    assert!(residual.abs() <= 1e-5 * posts + 1e-12 * size, "{what}: {residual} J of {posts} J");
}

#[test]
fn every_row_of_every_builtin_scene_balances() {
    let folder = Folder::new("ledger_builtin");
    let listed: Value = serde_json::from_str(&folder.told(&["scenes", "--json"])).expect("JSON");
    for scene in listed.as_array().expect("a list") {
        let name = scene["name"].as_str().expect("a name");
        let steps = if name == "pile" { "40" } else { "240" };
        folder.told(&["run", name, "--steps", steps, "--quiet", "--ledger", "ledger.csv"]);
        let rows = rows(&folder, "ledger.csv");
        assert_eq!(rows.len().to_string(), steps);
        for (number, pair) in rows.windows(2).enumerate() {
            assert_balanced(&pair[0], &pair[1], &format!("{name}, step {}", number + 2));
        }
    }
}

#[test]
fn rows_agree_with_the_trace_and_the_summary() {
    let folder = Folder::new("ledger_agrees");
    folder.file("scene.json", bouncing());
    let arguments =
        ["run", "scene.json", "--seconds", "1", "--trace", "t.jsonl", "--ledger", "l.csv", "--json"];
    let summary: Value = serde_json::from_str(&folder.told(&arguments)).expect("JSON");
    let rows = rows(&folder, "l.csv");
    let trace = std::fs::read_to_string(folder.path("t.jsonl")).expect("the trace");
    let trace: Vec<Value> =
        trace.lines().skip(2).map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(trace.len(), rows.len());
    for (step, row) in trace.iter().zip(&rows) {
        assert_eq!(step["step"].as_f64(), Some(row[0]));
        assert_eq!(step["time"].as_f64(), Some(row[1]));
        assert_eq!(step["momentum"]["linear"][1].as_f64(), Some(row[MOMENTUM + 1]));
        assert_eq!(step["energy"]["kinetic"].as_f64(), Some(row[ENERGY]));
    }
    let ledger = &summary["ledger"];
    let near = |found: &Value, truth: f64| (found.as_f64().expect("a number") - truth).abs() < 1e-9;
    for (column, name) in HEADER.split(',').enumerate().take(47).skip(35) {
        assert!(near(&ledger[name], rows.iter().map(|row| row[column]).sum()), "{name} in {ledger}");
    }
    let from_ground: f64 = rows.iter().map(|row| row[ACCOUNTS[2] + 1]).sum();
    assert!(near(&ledger["static"]["linear"][1], from_ground), "{ledger}");
    assert!(ledger["residual"]["relative"][2].as_f64().expect("a number") < 1e-9, "{ledger}");
    // There is none where every step fits to its rounding.
    let worst = &ledger["worst_residual"];
    assert!(worst.is_null() || worst["relative"].as_f64().expect("a number") < 1e-5, "{ledger}");
}

#[test]
fn the_summary_says_where_the_energy_went() {
    let folder = Folder::new("ledger_text");
    let text = folder.told(&["run", "stack", "--steps", "60", "--quiet"]);
    for part in ["energy by cause", "loss contact", "not modelled", "not explained", "within 1e-5"] {
        assert!(text.contains(part), "no {part} in:\n{text}");
    }
    assert!(text.lines().skip(1).all(|line| line.chars().count() <= 90), "{text}");
}

#[test]
fn check_writes_a_ledger_too() {
    let folder = Folder::new("ledger_check");
    folder.told(&["check", "off-centre-hit", "--steps", "30", "--ledger", "l.csv"]);
    assert_eq!(rows(&folder, "l.csv").len(), 30);
}

#[test]
fn files_that_would_overwrite_each_other_are_refused() {
    let folder = Folder::new("ledger_refused");
    let scene = folder.file("scene.json", bouncing());
    let complaint = folder.refused(&["run", "scene.json", "--ledger", "./scene.json"], 2);
    assert!(complaint.contains("--ledger"), "{complaint}");
    folder.refused(&["run", "scene.json", "--ledger", "out", "--trace", "out"], 2);
    assert!(!folder.path("out").exists());
    assert_eq!(std::fs::read_to_string(scene).expect("still there"), bouncing());
    folder.refused(&["run", "scene.json", "--ledger", "nowhere/l.csv"], 3);
}
