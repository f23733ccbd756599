//! From values to places on the picture, and where along an axis to write numbers.

/// A range of values laid along a line by their logarithms.
pub struct Axis {
    low: f64,
    high: f64,
    /// Where `low` and `high` lie, pixels.
    ends: [f64; 2],
}

/// A value worth a line across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tick {
    /// Where.
    pub value: f64,
    /// Whether there is space for its number.
    pub labelled: bool,
}

impl Axis {
    /// Between 1, 2 or 5 times powers of ten that leave a little space around all values; `None` of no values.
    pub fn logarithmic(values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Option<Self> {
        let (low, high) = values
            .filter(|value| *value > 0.0 && value.is_finite())
            .fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return None;
        }
        let low = steps(low / 100.0, low).rfind(|step| *step <= 0.9 * low)?;
        let high = steps(high, 100.0 * high).find(|step| *step >= 1.1 * high)?;
        Some(Self { low, high, ends })
    }

    /// Where a value lies, pixels.
    pub fn at(&self, value: f64) -> f64 {
        let [low, high, value] = [self.low, self.high, value].map(f64::ln);
        self.ends[0] + (self.ends[1] - self.ends[0]) * (value - low) / (high - low)
    }

    /// Its highest value.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Round values from end to end.
    pub fn ticks(&self) -> Vec<Tick> {
        let is_power = |value: f64| (value.log10() - value.log10().round()).abs() < 1e-9;
        let values: Vec<f64> = steps(self.low, self.high).collect();
        let few = values.iter().filter(|value| is_power(**value)).count() < 3;
        values.iter().map(|&value| Tick { value, labelled: few || is_power(value) }).collect()
    }
}

/// All 1, 2 and 5 times powers of ten from `low` to `high`, both included.
fn steps(low: f64, high: f64) -> impl DoubleEndedIterator<Item = f64> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let (low, high) = (low * (1.0 - 1e-9), high * (1.0 + 1e-9));
    // Quotients are the nearest numbers to what is meant, and so are printed short.
    let power = |power: i32, of: f64| {
        if power < 0 { of / 10.0_f64.powi(-power) } else { of * 10.0_f64.powi(power) }
    };
    let all = powers.flat_map(move |exponent| [1.0, 2.0, 5.0].map(|of| power(exponent, of)));
    all.filter(move |step| (low..=high).contains(step))
}

/// A tick's number: as short as it can be, thousands set apart.
pub fn number(value: f64) -> String {
    let rounded = (value * 1e9).round() / 1e9;
    let text = rounded.to_string();
    let (whole, rest) = text.find('.').map_or((text.as_str(), ""), |point| text.split_at(point));
    let mut grouped = String::new();
    for (i, digit) in whole.chars().enumerate() {
        if i > 0 && (whole.len() - i).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labelled(axis: &Axis) -> Vec<f64> {
        axis.ticks().iter().filter(|tick| tick.labelled).map(|tick| tick.value).collect()
    }

    #[test]
    fn a_logarithmic_axis_has_its_decades() {
        let axis = Axis::logarithmic([100.0, 100_000.0].into_iter(), [0.0, 1.0]).unwrap();
        assert_eq!(labelled(&axis), [100.0, 1000.0, 10_000.0, 100_000.0]);
        assert_eq!((axis.low, axis.high), (50.0, 200_000.0));
        assert!((axis.at(10_000.0_f64.sqrt() * 1000.0_f64.sqrt()) - 0.5).abs() < 1e-12);
        let short = Axis::logarithmic([0.3, 0.6].into_iter(), [0.0, 1.0]).unwrap();
        assert_eq!(labelled(&short), [0.2, 0.5, 1.0]);
        assert!(Axis::logarithmic([0.0].into_iter(), [0.0, 1.0]).is_none());
    }

    #[test]
    fn numbers_are_easy_to_read() {
        let shown = [0.0, 0.05, 0.2, 5.0, 100.0, 1000.0, 100_000.0, 2_000_000.0].map(number);
        assert_eq!(shown, ["0", "0.05", "0.2", "5", "100", "1,000", "100,000", "2,000,000"]);
    }
}
