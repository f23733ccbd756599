//! Every row reaches its goals, or says why it does not yet.

use carom_truth::{Row, suite};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What is wrong with a row, if anything: a figure that misses its goal and has no reason, or has one and reaches it.
fn complaints(row: &Row) -> Vec<String> {
    let measured = row.measure();
    if measured.len() != row.figures.len() {
        return vec![format!("{}: {} numbers for {} figures", row.name, measured.len(), row.figures.len())];
    }
    let mut complaints = Vec::new();
    for (figure, measured) in row.figures.iter().zip(measured) {
        let (name, what, truth) = (&row.name, &figure.what, figure.truth);
        let goal = figure.tolerance();
        match (figure.is_reached(measured), figure.missed) {
            (true, Some(reason)) => {
                complaints
                    .push(format!("{name}, {what}: {measured:e} reaches its goal, yet is listed: {reason}"));
            }
            (false, None) => {
                complaints.push(format!("{name}, {what}: {measured:e} instead of {truth:e}, goal {goal:e}"));
            }
            _ => {}
        }
    }
    complaints
}

#[test]
fn every_row_reaches_its_goals_or_says_why_not() {
    let suite = suite();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut found = Vec::new();
        while let Some(row) = suite.get(next.fetch_add(1, Ordering::Relaxed)) {
            found.extend(complaints(row));
        }
        found
    };
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    let found: Vec<String> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no row panics")).collect()
    });
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_row_has_a_name_of_its_own_that_can_be_typed() {
    let mut names = BTreeSet::new();
    for row in suite() {
        let typable = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-.".contains(c);
        assert!(row.name.chars().all(typable), "{}", row.name);
        assert!(!row.figures.is_empty(), "{}", row.name);
        assert!(names.insert(row.name.clone()), "{} twice", row.name);
    }
}
