//! The table of `carom truth`: as text, as JSON, as Markdown.

use crate::failure::Failure;
use crate::output::Lines;
use crate::text::{counted, number, rough};
use crate::truth::Measured;
use carom_truth::{Figure, Goal, PEERS, PEERS_SOURCE, Row};
use serde::Serialize;
use serde_json::{Map, Value};

/// A way to show rows one after the other.
pub trait Table {
    /// What comes before the first.
    fn begin(&self, _lines: &mut Lines) -> Result<(), Failure> {
        Ok(())
    }

    /// One row.
    fn row(&self, lines: &mut Lines, measured: &Measured<'_>) -> Result<(), Failure>;

    /// What comes after the last of `count` rows, of which `missed` miss a goal.
    fn end(&self, _lines: &mut Lines, _count: usize, _missed: &[String]) -> Result<(), Failure> {
        Ok(())
    }
}

/// Columns for people.
pub struct Text;

/// A line of JSON for each row.
pub struct Json;

/// The table of the README.
pub struct Markdown;

/// How near a figure must come, in its unit or per cent.
fn goal(figure: &Figure) -> String {
    match figure.goal {
        Goal::Within(0.0) => "exactly".to_owned(),
        Goal::Within(distance) if figure.truth == 0.0 => format!("≤ {}", number(distance)),
        Goal::Within(distance) => format!("± {}", number(distance)),
        Goal::Share(share) => format!("± {} %", number(100.0 * share)),
    }
}

/// A measured number: what should be nothing needs no six digits.
fn shown(figure: &Figure, measured: f64) -> String {
    if figure.truth == 0.0 { rough(measured) } else { number(measured) }
}

/// What a figure is called, with its unit.
fn called(figure: &Figure) -> String {
    if figure.unit.is_empty() { figure.what.clone() } else { format!("{}, {}", figure.what, figure.unit) }
}

fn columns(cells: [&str; 5], peers: [&str; 4]) -> String {
    let [what, truth, measured, goal, verdict] = cells;
    let [a, b, c, d] = peers;
    let line =
        format!("  {what:<46}{truth:>9}{measured:>11}{goal:>11}  {verdict:<7}{a:>10}{b:>9}{c:>9}{d:>9}");
    line.trim_end().to_owned()
}

impl Table for Text {
    fn begin(&self, lines: &mut Lines) -> Result<(), Failure> {
        lines.text(&columns(["", "truth", "Carom", "goal", ""], PEERS))
    }

    fn row(&self, lines: &mut Lines, measured: &Measured<'_>) -> Result<(), Failure> {
        let Row { name, what, law, figures, .. } = measured.row;
        lines.text(&format!("{name}: {what}  [{law}]"))?;
        for (figure, &value) in figures.iter().zip(&measured.numbers) {
            let is_reached = figure.is_reached(value);
            let verdict = if is_reached { "reached" } else { "MISSED" };
            let texts = [called(figure), number(figure.truth), shown(figure, value), goal(figure)];
            let [what, truth, value, goal] = texts.each_ref().map(String::as_str);
            lines.text(&columns([what, truth, value, goal, verdict], figure.peers.unwrap_or([""; 4])))?;
            if let (false, Some(reason)) = (is_reached, figure.missed) {
                lines.text(&format!("    not yet: {reason}"))?;
            }
        }
        Ok(())
    }

    fn end(&self, lines: &mut Lines, count: usize, missed: &[String]) -> Result<(), Failure> {
        let reached = count - missed.len();
        let mut line = format!("\n{reached} of {} reach their goals", counted(count as u64, "row"));
        if !missed.is_empty() {
            line.push_str(&format!("; not {}", missed.join(", ")));
        }
        lines.text(&line)?;
        lines.text(&format!("The others: {PEERS_SOURCE}."))
    }
}

#[derive(Serialize)]
struct JsonRow<'a> {
    row: &'a str,
    what: &'a str,
    law: &'a str,
    reached: bool,
    figures: Vec<JsonFigure<'a>>,
}

#[derive(Serialize)]
struct JsonFigure<'a> {
    what: &'a str,
    unit: &'a str,
    truth: f64,
    measured: f64,
    tolerance: f64,
    reached: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    peers: Option<Map<String, Value>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    missed: Option<&'a str>,
}

impl Table for Json {
    fn row(&self, lines: &mut Lines, measured: &Measured<'_>) -> Result<(), Failure> {
        let figures = measured.row.figures.iter().zip(&measured.numbers).map(|(figure, &value)| {
            let by_name = |peers: [&str; 4]| PEERS.map(str::to_owned).into_iter().zip(peers.map(Value::from));
            let reached = figure.is_reached(value);
            JsonFigure {
                what: &figure.what,
                unit: figure.unit,
                truth: figure.truth,
                measured: value,
                tolerance: figure.tolerance(),
                reached,
                peers: figure.peers.map(|peers| by_name(peers).collect()),
                missed: figure.missed.filter(|_| !reached),
            }
        });
        let Row { name, what, law, .. } = measured.row;
        let reached = measured.is_reached();
        lines.json(&JsonRow { row: name, what, law, reached, figures: figures.collect() })
    }
}

/// The lines of a row, one for each figure: nine cells.
fn cells(measured: &Measured<'_>) -> Vec<[String; 9]> {
    let Row { name, what, figures, .. } = measured.row;
    let line = |(k, (figure, &value)): (usize, (&Figure, &f64))| {
        let value = match (shown(figure, value), figure.is_reached(value)) {
            (text, true) => text,
            (text, false) => format!("**{text}**"),
        };
        let truth = format!("{} {}", number(figure.truth), figure.unit);
        let [a, b, c, d] = figure.peers.unwrap_or([""; 4]);
        let (name, what) = match k {
            0 => (format!("`{name}`"), format!("{what}: {}", figure.what)),
            _ => (String::new(), figure.what.clone()),
        };
        [&name, &what, truth.trim_end(), &value, &goal(figure), a, b, c, d]
            .map(|cell| cell.replace('|', "&#124;"))
    };
    figures.iter().zip(&measured.numbers).enumerate().map(line).collect()
}

fn markdown_line<T: AsRef<str>>(cells: &[T; 9]) -> String {
    let line: String = cells.iter().map(|cell| format!("| {} ", cell.as_ref())).collect();
    format!("{line}|")
}

impl Table for Markdown {
    fn begin(&self, lines: &mut Lines) -> Result<(), Failure> {
        let [a, b, c, d] = PEERS;
        lines.text(&markdown_line(&["row", "what", "truth", "Carom", "goal", a, b, c, d]))?;
        lines.text(&format!("{}|", "|---".repeat(9)))
    }

    fn row(&self, lines: &mut Lines, measured: &Measured<'_>) -> Result<(), Failure> {
        cells(measured).iter().try_for_each(|cells| lines.text(&markdown_line(cells)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_truth::suite;

    /// A line without what Carom reaches, which may differ from machine to machine.
    fn fixed(line: &str) -> Vec<&str> {
        let cells = line.split('|').map(str::trim).enumerate();
        cells.filter(|&(column, _)| column != 4).map(|(_, cell)| cell).collect()
    }

    #[test]
    fn the_readme_has_the_rows_of_the_suite() {
        let readme = include_str!("../../../README.md");
        let table = readme.lines().skip_while(|line| !line.starts_with("| row | what |")).skip(2);
        let found: Vec<Vec<&str>> = table.take_while(|line| line.starts_with('|')).map(fixed).collect();
        let unmeasured = |row| Measured { row, numbers: vec![f64::NAN; row.figures.len()] };
        let suite = suite();
        let lines = suite.iter().flat_map(|row| cells(&unmeasured(row)));
        let lines: Vec<String> = lines.map(|cells| markdown_line(&cells)).collect();
        let expected: Vec<Vec<&str>> = lines.iter().map(|line| fixed(line)).collect();
        assert_eq!(found, expected, "`carom truth --markdown` writes the table anew");
    }

    #[test]
    fn goals_are_told_as_limits_distances_or_per_cent() {
        let told = |truth: f64, of: Goal| goal(&Figure::new("way", "m", truth, of));
        assert_eq!(told(0.0, Goal::Within(0.0)), "exactly");
        assert_eq!(told(0.0, Goal::Within(1e-5)), "≤ 1e-5");
        assert_eq!(told(2.0, Goal::Within(1e-3)), "± 0.001");
        assert_eq!(told(2.0, Goal::Share(1e-3)), "± 0.1 %");
    }
}
