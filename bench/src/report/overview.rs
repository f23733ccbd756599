//! Everything at one glance: a row for each case, a column for each engine.

use crate::engine::is_peer;
use crate::rounds::Results;
use crate::table::{Table, short};

/// The ratios for people; nothing where there is nobody to compare with, or nothing to compare.
pub fn text(results: &Results) -> String {
    let told = results.engine_names();
    if results.settle || !told.iter().any(|engine| is_peer(engine)) || told.len() < 2 {
        return String::new();
    }
    format!("\nAll at one glance\n{}", ratios(results).text())
}

/// The same for a page, with the exponents where cost against size was measured.
pub fn markdown(results: &Results) -> String {
    let mut text = ratios(results).markdown();
    if !results.curves.is_empty() {
        text += &format!("\n{}", exponents(results).markdown());
    }
    text
}

/// A heading for each engine behind `columns`.
fn headed(columns: &[&str], results: &Results) -> Table {
    Table::new(&[columns, &results.engine_names()].concat())
}

/// Time of a step, and behind it its ratio to the fastest peer's.
fn ratios(results: &Results) -> Table {
    let mut table = headed(&["ms a step (× fastest peer)", "bodies", "threads"], results);
    for comparison in &results.comparisons {
        let mut row = vec![comparison.scene.clone()];
        row.extend([comparison.bodies, comparison.threads].map(|number| number.to_string()));
        row.extend(results.engine_names().iter().map(|engine| {
            let Some(share) = comparison.share(engine) else { return "–".to_string() };
            let ratio = share.ratio.map_or("stopped".to_string(), |ratio| format!("{ratio:.2}"));
            format!("{} ({ratio})", short(share.ms))
        }));
        table.row(row);
    }
    table
}

/// p where time goes with bodies to the power p, for all sizes and, behind it, between the last two.
fn exponents(results: &Results) -> Table {
    let mut table = headed(&["exponent, all sizes (last two)", "threads"], results);
    for curves in results.curves.chunk_by(|a, b| (&a.scene, a.threads) == (&b.scene, b.threads)) {
        let mut row = vec![curves[0].scene.clone(), curves[0].threads.to_string()];
        row.extend(results.engine_names().iter().map(|engine| {
            let curve = curves.iter().find(|curve| curve.engine == *engine);
            let power = |power: Option<f64>| power.map_or("–".to_string(), |power| format!("{power:.2}"));
            curve.map_or("–".to_string(), |curve| {
                format!("{} ({})", power(curve.exponent), power(curve.last_exponent))
            })
        }));
        table.row(row);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn every_case_is_a_row_with_ratios_to_the_peer() {
        let mut results = sample::results(sample::cases(), true);
        results.comparisons[1].shares.pop();
        results.comparisons[2].shares[0].ratio = None;
        let text = markdown(&results);
        assert!(
            text.starts_with("| ms a step (× fastest peer) | bodies | threads | carom | peer |\n|---|--:|")
        );
        for row in [
            "| pile | 100 | 1 | 0.100 (1.00) | 0.100 (1.00) |",
            "| pile | 1000 | 1 | 1.00 (0.32) | – |",
            "| pile | 10000 | 1 | 10.0 (stopped) | 100 (1.00) |",
            "| pile | 2 | 1.00 (1.00) | 1.50 (1.50) |",
        ] {
            assert!(text.contains(row), "{row}: {text}");
        }
    }

    #[test]
    fn who_runs_alone_is_compared_with_nobody() {
        let mut cases = sample::cases();
        assert!(text(&sample::results(sample::cases(), false)).contains("pile"));
        cases.iter_mut().for_each(|case| case.entrants.truncate(1));
        assert_eq!(text(&sample::results(cases, false)), "");
    }
}
