//! What is printed.

mod overview;
mod phases;
mod sizes;

use crate::quality::{Quality, Settling};
use crate::rounds::{Case, Entrant, Results};
use crate::summary::{Ratio, Summary};
use crate::table::{Table, short};
use crate::worker::Measurement;
pub use overview::markdown;

/// Everything, for people.
pub fn text(results: &Results) -> String {
    let mut text = heading(results);
    text += &sizes::text(results);
    // Curves say in one table what so many cases would say in as many.
    let cases = if results.curves.is_empty() { &results.cases[..] } else { &[] };
    for case in cases {
        text += &title(case);
        if case.entrants.is_empty() {
            text += "  no engine here runs with so many threads\n";
        } else if results.settle {
            text += &settling(case).text();
        } else if phases::measured(case) {
            // Times with so many clocks read in between are for shares, not for comparisons.
            text += &phases::text(case);
        } else {
            text += &speed(case).text();
            text.push('\n');
            text += &quality(case).text();
        }
        text += &remarks(case);
    }
    if !results.cases.iter().any(phases::measured) {
        text += &overview::text(results);
    }
    for failure in &results.failures {
        text += &format!("\nNo result: {failure}\n");
    }
    text
}

/// What ran, and on what.
fn heading(results: &Results) -> String {
    let machine = &results.machine;
    let mut text = format!(
        "{}, {} threads at once; compiled for {}; rounds: {}\n",
        machine.processor, machine.threads, machine.compiled_for, results.rounds
    );
    for Entrant { engine, version, settings, .. } in results.engines() {
        text += &format!("  {engine}: {version}; {settings}\n");
    }
    text
}

fn title(case: &Case) -> String {
    let threads = threads(case.threads);
    let Some(first) = case.entrants.iter().find_map(Entrant::first) else {
        return format!("\n{}, {threads}\n", case.scene);
    };
    format!("\n{}: {} bodies, {} steps, {threads}\n", case.scene, first.bodies, first.steps)
}

/// A number of threads for people.
pub fn threads(number: usize) -> String {
    if number == 1 { "1 thread".to_string() } else { format!("{number} threads") }
}

/// Time and memory. The ratios are to the first row.
fn speed(case: &Case) -> Table {
    let times = format!("× {}", case.entrants[0].engine);
    let headings =
        ["ms a step", "least", "mean", "median", "p99", "cpu", "peak MiB", "own MiB", &times, "rounds"];
    let mut table = Table::new(&headings);
    for entrant in &case.entrants {
        let mut row = vec![entrant.engine.clone()];
        if let Some(summary) = &entrant.summary {
            let Summary { least, mean, median, p99, cpu, .. } = *summary;
            row.extend([least, mean, median, p99, cpu].map(short));
            row.extend([summary.memory_peak, summary.memory_own].map(|memory| format!("{memory:.1}")));
            row.extend(ratio(summary.ratio));
        }
        table.row(row);
    }
    table
}

/// The ratio of least means, and its spread over the rounds.
fn ratio(ratio: Option<Ratio>) -> [String; 2] {
    match ratio {
        Some(Ratio { least, low, high }) => [short(least), format!("{} to {}", short(low), short(high))],
        None => ["–".to_string(), String::new()],
    }
}

/// How good the results are, from the first round.
fn quality(case: &Case) -> Table {
    let mut table = Table::new(&[
        "overlap in mm, speed in mm/s",
        "pairs",
        "mean",
        "p99",
        "max",
        "moved m",
        "escaped",
        "fastest",
        "p99",
        "surface",
        "moving",
        "reported",
        "kinetic J",
        "energy %",
    ]);
    for entrant in &case.entrants {
        let mut row = vec![entrant.engine.clone()];
        if let Some(Measurement { quality, .. }) = entrant.first() {
            let Quality { overlap, motion, .. } = quality;
            row.push(overlap.pairs.to_string());
            row.extend([overlap.mean, overlap.p99, overlap.max].map(thousandths));
            row.extend([short(quality.displacement_max), quality.escaped.to_string()]);
            if motion.steps > 0 {
                row.extend([motion.speed_max, motion.speed_p99, motion.surface_speed_max].map(thousandths));
                row.push(motion.moving.to_string());
            } else {
                row.extend([0; 4].map(|_| "–".to_string()));
            }
            row.push(thousandths(quality.reported_speed_max));
            row.extend([short(quality.energy_end.kinetic), energy_change(quality)]);
        }
        table.row(row);
    }
    table
}

/// When rest came, and how good it is.
fn settling(case: &Case) -> Table {
    let mut table = Table::new(&[
        "at rest (1 mm/s) from",
        "centres s",
        "surfaces s",
        "moving",
        "fastest mm/s",
        "ms a step",
        "overlap mm: mean",
        "p99",
        "max",
        "escaped",
    ]);
    for entrant in &case.entrants {
        let mut row = vec![entrant.engine.clone()];
        if let (Some(measurement), Some(summary)) = (entrant.first(), &entrant.summary) {
            let Quality { overlap, motion, .. } = &measurement.quality;
            let Settling { centers, surfaces } = measurement.settling.unwrap_or_default();
            row.extend(
                [centers, surfaces].map(|time| time.map_or("never".to_string(), |time| format!("{time:.2}"))),
            );
            row.extend([motion.moving.to_string(), thousandths(motion.speed_max), short(summary.mean)]);
            row.extend([overlap.mean, overlap.p99, overlap.max].map(thousandths));
            row.push(measurement.quality.escaped.to_string());
        }
        table.row(row);
    }
    table
}

/// What a reader must know before comparing.
fn remarks(case: &Case) -> String {
    let mut text = String::new();
    for entrant in &case.entrants {
        let Some(summary) = &entrant.summary else { continue };
        if !summary.whole() {
            let (done, asked) = summary.steps;
            text += &format!(
                "  {} was stopped after {done} of {asked} steps: its figures are of that part only\n",
                entrant.engine
            );
        } else if !summary.repeats {
            text += &format!("  {} did not end with the same bits in every round\n", entrant.engine);
        }
    }
    text
}

/// Metres as millimetres.
fn thousandths(value: f64) -> String {
    short(value * 1e3)
}

/// How much of the energy at the start is there more at the end, in percent.
fn energy_change(quality: &Quality) -> String {
    let total = |energy: crate::quality::Energy| energy.kinetic + energy.potential;
    let (start, end) = (total(quality.energy_start), total(quality.energy_end));
    if start.abs() > 0.0 { format!("{:+.3}", (end - start) / start * 100.0) } else { "–".to_string() }
}
