//! Numbers for people: about six digits, in columns.

use carom::math::DVec3;

/// Width of a column of numbers.
pub const COLUMN: usize = 13;

/// `value` with six digits, without needless zeros.
pub fn number(value: f64) -> String {
    digits(value, 6)
}

/// `value` with two digits, as suits errors and tolerances.
pub fn rough(value: f64) -> String {
    digits(value, 2)
}

fn digits(value: f64, count: usize) -> String {
    if value.is_infinite() {
        return if value > 0.0 { "infinite" } else { "-infinite" }.to_owned();
    }
    if value == 0.0 || !value.is_finite() {
        return format!("{}", value.abs());
    }
    // Rounded first, so that 999999.9 counts as the seven digits that it becomes.
    let scientific = format!("{value:.*e}", count - 1);
    let Some((mantissa, exponent)) = scientific.split_once('e') else { return scientific };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..6).contains(&exponent) {
        let decimals = (count as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// Without zeros at the end of a decimal fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// `(x, y, z)`.
pub fn point(vector: DVec3) -> String {
    format!("({}, {}, {})", number(vector.x), number(vector.y), number(vector.z))
}

/// A named quantity on a line: what, symbol, number, unit.
pub fn scalar_row(what: &str, symbol: &str, value: f64, unit: &str) -> String {
    let row = format!("  {what:<18}{symbol:<8}{:>COLUMN$}  {unit}", number(value));
    format!("{}\n", row.trim_end())
}

/// A named vector on a line: what, symbol, x, y, z, unit.
pub fn vector_row(what: &str, symbol: &str, value: DVec3, unit: &str) -> String {
    let [x, y, z] = value.to_array().map(number);
    let row = format!("  {what:<18}{symbol:<8}{x:>COLUMN$}{y:>COLUMN$}{z:>COLUMN$}  {unit}");
    format!("{}\n", row.trim_end())
}

/// `1 collision`, `2 collisions`.
pub fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_and_no_needless_zeros() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (100.0, "100"),
            (1.0 / 3.0, "0.333333"),
            (-1234.56789, "-1234.57"),
            (123456.7, "123457"),
            (999999.9, "1e6"),
            (1234567.0, "1.23457e6"),
            (0.000123456789, "0.000123457"),
            (0.0000123456789, "1.23457e-5"),
            (-1e-300, "-1e-300"),
            (f64::INFINITY, "infinite"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
        assert_eq!(rough(1.2345e-7), "1.2e-7");
        assert_eq!(rough(123.0), "123");
    }

    #[test]
    fn rows_keep_their_columns() {
        let widest = vector_row("angular velocity", "Δv_r,a", DVec3::splat(-1.23456e-100), "1/(kg·m)");
        assert!(widest.chars().count() <= 80, "{} in {widest}", widest.chars().count());
        let narrow = vector_row("angular velocity", "Δv_r,a", DVec3::ZERO, "1/(kg·m)");
        let unit_at = |row: &str| row.chars().position(|c| c == '/');
        assert_eq!(unit_at(&narrow), unit_at(&widest));
    }
}
