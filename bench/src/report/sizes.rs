//! Cost against size, one table for each scene and number of threads.

use super::{remarks, thousandths, threads};
use crate::curve::Curve;
use crate::rounds::{Case, Entrant, Results};
use crate::summary::Summary;
use crate::table::{Table, short};

/// All tables; nothing if cost against size was not asked for.
pub fn text(results: &Results) -> String {
    let mut text = String::new();
    // Curves of the same scene and threads lie side by side.
    for curves in results.curves.chunk_by(|a, b| (&a.scene, a.threads) == (&b.scene, b.threads)) {
        let Curve { scene, threads: number, .. } = &curves[0];
        let cases = || results.cases.iter().filter(|case| case.scene == *scene && case.threads == *number);
        text += &format!("\n{scene} against size, {}\n", threads(*number));
        text += &table(curves, &cases().collect::<Vec<_>>()).text();
        text.push('\n');
        text += &exponents(curves).text();
        text.extend(cases().map(sized_remarks));
    }
    text
}

/// A row for each engine at each size.
fn table(curves: &[Curve], cases: &[&Case]) -> Table {
    let times = format!("× {}", curves[0].engine);
    let mut table = Table::new(&[
        "ms a step",
        "bodies",
        "steps",
        "least",
        "mean",
        "median",
        "p99",
        "µs a body",
        "exponent",
        "peak MiB",
        "own MiB",
        &times,
        "overlap p99 mm",
        "escaped",
    ]);
    for curve in curves {
        for case in cases {
            for entrant in case.entrants.iter().filter(|entrant| entrant.engine == curve.engine) {
                table.row(row(curve, entrant));
            }
        }
    }
    table
}

fn row(curve: &Curve, entrant: &Entrant) -> Vec<String> {
    let mut row = vec![entrant.engine.clone()];
    let (Some(measurement), Some(summary)) = (entrant.first(), &entrant.summary) else {
        row.push(entrant.job.count.map_or(String::new(), |count| count.to_string()));
        return row;
    };
    let Summary { least, mean, median, p99, memory_peak, memory_own, .. } = *summary;
    let bodies = measurement.bodies;
    let number = |value: Option<f64>| value.map_or("–".to_string(), |value| format!("{value:.2}"));
    row.extend([bodies, summary.steps.0].map(|number| number.to_string()));
    row.extend([least, mean, median, p99, least * 1e3 / bodies as f64].map(short));
    row.push(number(curve.local_exponent(bodies)));
    row.extend([memory_peak, memory_own].map(|memory| format!("{memory:.1}")));
    row.push(summary.ratio.map_or("–".to_string(), |ratio| short(ratio.least)));
    row.extend([thousandths(measurement.quality.overlap.p99), measurement.quality.escaped.to_string()]);
    row
}

/// What the sizes of each engine come to.
fn exponents(curves: &[Curve]) -> Table {
    let mut table = Table::new(&["time goes with bodies to the power", "all sizes", "last two"]);
    for curve in curves {
        let power = [curve.exponent, curve.last_exponent]
            .map(|power| power.map_or("–".to_string(), |power| format!("{power:.2}")));
        table.row([curve.engine.clone()].into_iter().chain(power).collect());
    }
    table
}

/// A case's remarks, with its size before them.
fn sized_remarks(case: &Case) -> String {
    let bodies = case.entrants.iter().find_map(Entrant::first).map_or(0, |first| first.bodies);
    remarks(case).lines().map(|line| format!("  {bodies} bodies:{}\n", &line[1..])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn every_size_has_a_row_and_every_engine_its_exponent() {
        let mut cases = sample::cases();
        cases[5].entrants[1].summary.as_mut().unwrap().steps = (1, 2);
        let text = text(&sample::results(cases, true));
        let row = |start: &str| text.lines().filter(|line| line.trim_start().starts_with(start)).count();
        assert_eq!((row("pile against size, "), row("carom "), row("peer ")), (2, 8, 8), "{text}");
        let powers: Vec<Vec<&str>> = text
            .lines()
            .map(|line| line.split_whitespace().collect())
            .filter(|words: &Vec<&str>| words.len() == 3 && ["carom", "peer"].contains(&words[0]))
            .collect();
        assert_eq!(powers[0], ["carom", "1.00", "1.00"], "{text}");
        assert_eq!(powers[1], ["peer", "1.50", "1.50"], "{text}");
        assert!(text.contains("10000 bodies: peer was stopped after 1 of 2 steps"), "{text}");
    }

    #[test]
    fn without_sizes_there_is_no_table() {
        assert_eq!(text(&sample::results(sample::cases(), false)), "");
    }
}
