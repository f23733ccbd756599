//! From values to places on the picture, and where along an axis to write numbers.

/// A range of values laid along a line.
pub struct Axis {
    low: f64,
    high: f64,
    logarithmic: bool,
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
    /// From 0 to a round value that is not below `high`.
    pub fn from_zero(high: f64, ends: [f64; 2]) -> Self {
        let step = round_step(high);
        Self { low: 0.0, high: step * (high / step).ceil().max(1.0), logarithmic: false, ends }
    }

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
        Some(Self { low, high, logarithmic: true, ends })
    }

    /// Where a value lies, pixels.
    pub fn at(&self, value: f64) -> f64 {
        let scale = |value: f64| if self.logarithmic { value.ln() } else { value };
        let [low, high, value] = [self.low, self.high, value].map(scale);
        self.ends[0] + (self.ends[1] - self.ends[0]) * (value - low) / (high - low)
    }

    /// Its highest value.
    pub fn high(&self) -> f64 {
        self.high
    }

    /// Round values from end to end.
    pub fn ticks(&self) -> Vec<Tick> {
        if !self.logarithmic {
            let step = round_step(self.high);
            let n = (self.high / step).round() as usize;
            return (0..=n).map(|i| Tick { value: i as f64 * step, labelled: true }).collect();
        }
        let is_power = |value: f64| (value.log10() - value.log10().round()).abs() < 1e-9;
        let values: Vec<f64> = steps(self.low, self.high).collect();
        let few = values.iter().filter(|value| is_power(**value)).count() < 3;
        values.iter().map(|&value| Tick { value, labelled: few || is_power(value) }).collect()
    }
}

/// 1, 2 or 5 times a power of ten, such that at most six of them are not above `high`.
fn round_step(high: f64) -> f64 {
    if high > 0.0 && high.is_finite() {
        steps(high / 100.0, high).find(|step| high / step <= 6.0).unwrap_or(high)
    } else {
        1.0
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

    fn values(axis: &Axis, labelled: bool) -> Vec<f64> {
        axis.ticks().iter().filter(|tick| tick.labelled || !labelled).map(|tick| tick.value).collect()
    }

    #[test]
    fn an_axis_from_zero_ends_at_a_round_value() {
        let axis = Axis::from_zero(13.6, [100.0, 0.0]);
        assert_eq!(values(&axis, true), [0.0, 5.0, 10.0, 15.0]);
        assert_eq!([0.0, 7.5, 15.0].map(|value| axis.at(value)), [100.0, 50.0, 0.0]);
        let shown: Vec<String> =
            values(&Axis::from_zero(0.0, [1.0, 0.0]), true).into_iter().map(number).collect();
        assert_eq!(shown, ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
    }

    #[test]
    fn a_logarithmic_axis_has_its_decades() {
        let axis = Axis::logarithmic([100.0, 100_000.0].into_iter(), [0.0, 1.0]).unwrap();
        assert_eq!(values(&axis, true), [100.0, 1000.0, 10_000.0, 100_000.0]);
        assert_eq!((axis.low, axis.high), (50.0, 200_000.0));
        assert!((axis.at(10_000.0_f64.sqrt() * 1000.0_f64.sqrt()) - 0.5).abs() < 1e-12);
        let short = Axis::logarithmic([0.3, 0.6].into_iter(), [0.0, 1.0]).unwrap();
        assert_eq!(values(&short, true), [0.2, 0.5, 1.0]);
        assert!(Axis::logarithmic([0.0].into_iter(), [0.0, 1.0]).is_none());
    }

    #[test]
    fn numbers_are_easy_to_read() {
        let shown = [0.0, 0.05, 0.2, 5.0, 100.0, 1000.0, 100_000.0, 2_000_000.0].map(number);
        assert_eq!(shown, ["0", "0.05", "0.2", "5", "100", "1,000", "100,000", "2,000,000"]);
    }
}
