//! `carom truth`: what mechanics fixes, and how near the engine comes to it.

use crate::arguments::TruthArguments;
use crate::failure::Failure;
use crate::interrupt::Interrupt;
use crate::nearest::nearest;
use crate::output::{Lines, progress_bar};
use crate::truth_table::{Json, Markdown, Table, Text};
use carom_truth::{Row, suite};
use std::io::IsTerminal;
use std::process::ExitCode;

/// A row of the suite with what was measured, a number for each of its figures.
pub struct Measured<'a> {
    pub row: &'a Row,
    pub numbers: Vec<f64>,
}

impl Measured<'_> {
    /// Whether every figure reaches its goal.
    pub fn is_reached(&self) -> bool {
        let mut figures = self.row.figures.iter().zip(&self.numbers);
        figures.all(|(figure, &number)| figure.is_reached(number))
    }
}

/// Measures the rows that were asked for and shows each as soon as it is done.
pub fn truth(arguments: &TruthArguments) -> Result<ExitCode, Failure> {
    let rows = chosen(suite(), &arguments.rows)?;
    let table: &dyn Table = match (arguments.json, arguments.markdown) {
        (true, _) => &Json,
        (_, true) => &Markdown,
        _ => &Text,
    };
    let with_bar = !arguments.quiet && !arguments.json && std::io::stderr().is_terminal();
    let missed = measure(&rows, table, with_bar)?;
    Ok(if missed.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// The rows of those names, in the order of the suite; all of them if none is named.
fn chosen(suite: Vec<Row>, asked: &[String]) -> Result<Vec<Row>, Failure> {
    if let Some(name) = asked.iter().find(|name| suite.iter().all(|row| row.name != **name)) {
        let hint = match nearest(name, suite.iter().map(|row| row.name.as_str())) {
            Some(similar) => format!("did you mean `{similar}`?"),
            None => "`carom truth` shows them all".to_owned(),
        };
        return Err(Failure::Input(format!("{name}: no such row; {hint}")));
    }
    let is_asked = |row: &Row| asked.is_empty() || asked.contains(&row.name);
    Ok(suite.into_iter().filter(is_asked).collect())
}

/// Measures and shows; returns the names of the rows that miss a goal.
fn measure(rows: &[Row], table: &dyn Table, with_bar: bool) -> Result<Vec<String>, Failure> {
    let interrupt = Interrupt::listen();
    let mut lines = Lines::stdout();
    let bar = progress_bar(with_bar, rows.len() as u64, "rows");
    let mut missed = Vec::new();
    bar.suspend(|| table.begin(&mut lines))?;
    for row in rows {
        interrupt.check()?;
        let measured = Measured { row, numbers: row.measure() };
        if !measured.is_reached() {
            missed.push(row.name.clone());
        }
        bar.suspend(|| table.row(&mut lines, &measured).and_then(|()| lines.finish()))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    table.end(&mut lines, rows.len(), &missed)?;
    lines.finish()?;
    Ok(missed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_truth::{Figure, Goal};

    fn row(name: &str, number: f64) -> Row {
        let figure = Figure::new("way", "m", 1.0, Goal::Within(0.1));
        Row::new(name, "something moves", "v·t", move || vec![number]).figure(figure)
    }

    #[test]
    fn rows_that_miss_a_goal_are_told() {
        let rows = [row("near", 1.05), row("far", 1.2), row("lost", f64::NAN)];
        for table in [&Text as &dyn Table, &Json, &Markdown] {
            assert_eq!(measure(&rows, table, false).unwrap(), ["far", "lost"]);
        }
    }

    #[test]
    fn rows_are_chosen_by_name_in_the_order_of_the_suite() {
        let suite = || vec![row("one", 0.0), row("two", 0.0), row("three", 0.0)];
        let names = |asked: &[&str]| {
            let asked: Vec<String> = asked.iter().map(|&name| name.to_owned()).collect();
            chosen(suite(), &asked).map(|rows| rows.iter().map(|row| row.name.clone()).collect::<Vec<_>>())
        };
        assert_eq!(names(&[]).unwrap(), ["one", "two", "three"]);
        assert_eq!(names(&["three", "one"]).unwrap(), ["one", "three"]);
        let Err(Failure::Input(message)) = names(&["one", "thre"]) else { panic!("accepted") };
        assert!(message.contains("`three`"), "{message}");
    }
}
