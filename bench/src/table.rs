//! Columns of text that line up.

/// A heading and rows of cells; the first column is set to the left, all others to the right.
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these headings.
    pub fn new(headings: &[&str]) -> Self {
        Self { rows: vec![headings.iter().map(ToString::to_string).collect()] }
    }

    /// Adds a row. Cells may be missing at its end.
    pub fn row(&mut self, cells: Vec<String>) {
        self.rows.push(cells);
    }

    /// The rows as Markdown has them.
    pub fn markdown(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut text = String::new();
        for (i, row) in self.rows.iter().enumerate() {
            text += &format!("| {} |\n", row.join(" | "));
            if i == 0 {
                text += &format!("|---|{}\n", "--:|".repeat(columns.saturating_sub(1)));
            }
        }
        text
    }

    /// The lines, each indented by two.
    pub fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            self.rows
                .iter()
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        let mut text = String::new();
        for row in &self.rows {
            let cells = row.iter().zip(&widths).enumerate();
            let line: String = cells
                .map(
                    |(i, (cell, width))| {
                        if i == 0 { format!("  {cell:<width$}") } else { format!("  {cell:>width$}") }
                    },
                )
                .collect();
            text += line.trim_end();
            text.push('\n');
        }
        text
    }
}

/// A positive number with three digits or more: `0.0123`, `1.23`, `123`, `1234`.
pub fn short(value: f64) -> String {
    let decimals = match value.abs() {
        0.0 => return "0".to_string(),
        size if size < 0.0001 => return format!("{value:.0e}"),
        size if size < 0.1 => 4,
        size if size < 1.0 => 3,
        size if size < 10.0 => 2,
        size if size < 100.0 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new(&["", "ms", "×"]);
        table.row(vec!["carom".into(), "1.5".into(), "1".into()]);
        table.row(vec!["x".into(), "12.25".into()]);
        assert_eq!(table.text(), "            ms  ×\n  carom    1.5  1\n  x      12.25\n");
    }

    #[test]
    fn markdown_has_a_line_below_its_headings() {
        let mut table = Table::new(&["", "ms"]);
        table.row(vec!["carom".into(), "1.5".into()]);
        assert_eq!(table.markdown(), "|  | ms |\n|---|--:|\n| carom | 1.5 |\n");
    }

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 0.000_05, 0.012_34, 0.1234, 1.234, 12.34, 1234.4, -2.5].map(short);
        assert_eq!(shown, ["0", "5e-5", "0.0123", "0.123", "1.23", "12.3", "1234", "-2.50"]);
    }
}
