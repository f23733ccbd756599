//! `carom truth`: single rows, their formats, and names that are none.

mod common;

use common::Folder;
use serde_json::Value;

#[test]
fn a_row_can_be_asked_for_by_name() {
    let told = Folder::new("truth-one").told(&["truth", "near-miss", "free-fall"]);
    let rows: Vec<&str> = told.lines().filter(|line| line.contains(": ") && line.contains('[')).collect();
    assert_eq!(rows.len(), 2, "{told}");
    assert!(rows[0].starts_with("free-fall: ") && rows[1].starts_with("near-miss: "), "{told}");
    assert!(told.contains("2 of 2 rows reach their goals"), "{told}");
    assert!(told.contains("rapier3d 0.36.1"), "{told}");
}

#[test]
fn json_has_a_line_for_each_row() {
    let told = Folder::new("truth-json").told(&["truth", "free-fall", "--json"]);
    assert_eq!(told.lines().count(), 1);
    let row: Value = serde_json::from_str(&told).unwrap();
    assert_eq!((&row["row"], &row["reached"]), (&Value::from("free-fall"), &Value::from(true)));
    let figure = &row["figures"][0];
    let measured = figure["measured"].as_f64().unwrap();
    assert!(measured <= figure["tolerance"].as_f64().unwrap(), "{told}");
    assert_eq!((&figure["truth"], &figure["peers"]["Jolt"]), (&Value::from(0.0), &Value::from("0.33")));
}

#[test]
fn markdown_is_a_table() {
    let told = Folder::new("truth-markdown").told(&["truth", "near-miss", "--markdown"]);
    let columns = |line: &str| line.matches('|').count();
    assert_eq!(told.lines().count(), 3, "{told}");
    assert!(told.lines().all(|line| columns(line) == 10), "{told}");
}

#[test]
fn a_name_that_no_row_has_is_refused_with_one_that_is_like_it() {
    let folder = Folder::new("truth-refused");
    let complaint = folder.refused(&["truth", "near-mis"], 2);
    assert!(complaint.contains("`near-miss`"), "{complaint}");
    let complaint = folder.refused(&["truth", "elephants-on-parade"], 2);
    assert!(complaint.contains("carom truth"), "{complaint}");
    folder.refused(&["truth", "--json", "--markdown"], 2);
}
