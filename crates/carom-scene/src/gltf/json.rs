//! A JSON document read with care: every value knows its path, and whatever is wrong with it is said with that path.

use crate::SceneError;
use carom::Invalid;
use carom::math::{DQuat, DVec3};
use serde_json::{Map, Value};
use std::ops::RangeInclusive;

/// A value and where it stands in the file.
#[derive(Clone)]
pub(super) struct At<'a> {
    pub file: &'a str,
    pub path: String,
    pub value: &'a Value,
}

impl<'a> At<'a> {
    /// Says that this value is no good.
    pub fn error(&self, expected: impl Into<String>) -> SceneError {
        SceneError::invalid(self.file, &self.path, shown(self.value), expected)
    }

    /// Says what is wrong with something made from this value.
    pub fn refused(&self, value: impl ToString, expected: impl Into<String>) -> SceneError {
        SceneError::invalid(self.file, &self.path, value, expected)
    }

    /// Passes on what the engine says of something made from this value.
    pub fn engine(&self, error: Invalid) -> SceneError {
        let expected = if error.field.is_empty() {
            error.expected
        } else {
            format!("{} ({})", error.expected, error.field)
        };
        SceneError::invalid(self.file, &self.path, error.value, expected)
    }

    fn inner(&self, step: &str, value: &'a Value) -> At<'a> {
        let path = match (self.path.is_empty(), step.starts_with('[')) {
            (true, _) => step.to_owned(),
            (false, true) => format!("{}{step}", self.path),
            (false, false) => format!("{}.{step}", self.path),
        };
        At { file: self.file, path, value }
    }

    fn object(&self) -> Result<&'a Map<String, Value>, SceneError> {
        self.value.as_object().ok_or_else(|| self.error("an object"))
    }

    /// The value of a key, if the key is there.
    pub fn get(&self, key: &str) -> Result<Option<At<'a>>, SceneError> {
        Ok(self.object()?.get(key).map(|value| self.inner(key, value)))
    }

    /// The value of a key that must be there.
    pub fn need(&self, key: &str, what: &str) -> Result<At<'a>, SceneError> {
        self.get(key)?
            .ok_or_else(|| SceneError::invalid(self.file, format!("{}.{key}", self.path), "nothing", what))
    }

    /// Follows several keys; nothing where one of them is absent.
    pub fn dig(&self, keys: &[&str]) -> Result<Option<At<'a>>, SceneError> {
        let mut place = self.clone();
        for key in keys {
            match place.get(key)? {
                Some(inner) => place = inner,
                None => return Ok(None),
            }
        }
        Ok(Some(place))
    }

    /// Refuses every key but `known`, `extensions` and `extras`.
    pub fn only(&self, known: &[&str]) -> Result<(), SceneError> {
        for (key, value) in self.object()? {
            if !known.contains(&key.as_str()) && key != "extensions" && key != "extras" {
                return Err(self.inner(key, value).error(format!("one of the keys {}", known.join(", "))));
            }
        }
        Ok(())
    }

    /// Whether a key is there.
    pub fn has(&self, key: &str) -> bool {
        self.value.get(key).is_some()
    }

    /// The entries of a list.
    pub fn items(&self) -> Result<Vec<At<'a>>, SceneError> {
        let list = self.value.as_array().ok_or_else(|| self.error("a list"))?;
        Ok(list.iter().enumerate().map(|(i, value)| self.inner(&format!("[{i}]"), value)).collect())
    }

    /// A finite number.
    pub fn number(&self) -> Result<f64, SceneError> {
        let number = self.value.as_f64().filter(|number| number.is_finite());
        number.ok_or_else(|| self.error("a number"))
    }

    /// A number within `range`.
    pub fn within(&self, range: RangeInclusive<f64>, unit: &str) -> Result<f64, SceneError> {
        let expected = || format!("a number from {:e} to {:e}{unit}", range.start(), range.end());
        let number = self.value.as_f64().ok_or_else(|| self.error(expected()))?;
        if range.contains(&number) { Ok(number) } else { Err(self.error(expected())) }
    }

    /// A finite number, 0 or more.
    pub fn not_negative(&self, unit: &str) -> Result<f64, SceneError> {
        let number = self.value.as_f64().filter(|number| number.is_finite() && *number >= 0.0);
        number.ok_or_else(|| self.error(format!("a number, 0 or more{unit}")))
    }

    /// A finite number above 0.
    pub fn positive(&self, unit: &str) -> Result<f64, SceneError> {
        let number = self.value.as_f64().filter(|number| number.is_finite() && *number > 0.0);
        number.ok_or_else(|| self.error(format!("a number above 0{unit}")))
    }

    /// As many entries as asked for.
    pub fn several<const N: usize>(&self) -> Result<[At<'a>; N], SceneError> {
        let list = self.value.as_array().filter(|list| list.len() == N);
        let list = list.ok_or_else(|| self.error(format!("a list of {N} numbers")))?;
        Ok(std::array::from_fn(|i| self.inner(&format!("[{i}]"), &list[i])))
    }

    /// Three numbers, each at most `limit` either way.
    pub fn vector(&self, limit: f64, unit: &str) -> Result<DVec3, SceneError> {
        let [x, y, z] = self.several()?;
        let range = -limit..=limit;
        Ok(DVec3::new(x.within(range.clone(), unit)?, y.within(range.clone(), unit)?, z.within(range, unit)?))
    }

    /// A quaternion `[x, y, z, w]` within 1e-3 of unit length, brought to unit length.
    pub fn rotation(&self) -> Result<DQuat, SceneError> {
        let [x, y, z, w] = self.several()?;
        let rotation = DQuat::from_xyzw(x.number()?, y.number()?, z.number()?, w.number()?);
        if (rotation.length() - 1.0).abs() > 1e-3 {
            return Err(self.error("a quaternion [x, y, z, w] within 1e-3 of unit length"));
        }
        Ok(rotation.normalize())
    }

    /// True or false.
    pub fn boolean(&self) -> Result<bool, SceneError> {
        self.value.as_bool().ok_or_else(|| self.error("true or false"))
    }

    /// A text.
    pub fn text(&self) -> Result<&'a str, SceneError> {
        self.value.as_str().ok_or_else(|| self.error("a text"))
    }

    /// An integer, 0 or more. One with a fraction of zero counts: some writers know no integers.
    pub fn count(&self) -> Result<usize, SceneError> {
        const LARGEST: f64 = 9_007_199_254_740_992.0;
        let whole =
            self.value.as_f64().filter(|number| number.fract() == 0.0 && (0.0..LARGEST).contains(number));
        whole.map(|number| number as usize).ok_or_else(|| self.error("an integer, 0 or more"))
    }

    /// The integer of a key, or `default` where the key is absent.
    pub fn count_or(&self, key: &str, default: usize) -> Result<usize, SceneError> {
        self.get(key)?.map_or(Ok(default), |at| at.count())
    }
}

/// The root of the file with its tables.
#[derive(Clone)]
pub(super) struct Document<'a> {
    pub root: At<'a>,
}

impl<'a> Document<'a> {
    /// The entries of a table of the root; none where it is absent.
    pub fn table(&self, key: &str) -> Result<&'a [Value], SceneError> {
        match self.root.get(key)? {
            None => Ok(&[]),
            Some(at) => at.value.as_array().map(Vec::as_slice).ok_or_else(|| at.error("a list")),
        }
    }

    /// Entry `index` of a table, which must be there.
    pub fn entry(&self, key: &str, index: usize, value: &'a Value) -> At<'a> {
        At { file: self.root.file, path: format!("{key}[{index}]"), value }
    }

    /// What an index names in a table of the root.
    pub fn follow(&self, index: &At<'a>, key: &str) -> Result<(usize, At<'a>), SceneError> {
        let table = self.table(key)?;
        let number = self.index(index, table.len(), key)?;
        Ok((number, self.entry(key, number, &table[number])))
    }

    /// An index into a list of `len` entries that the file calls `name`.
    pub fn index(&self, index: &At<'a>, len: usize, name: &str) -> Result<usize, SceneError> {
        match index.count() {
            Ok(number) if number < len => Ok(number),
            _ if len == 0 => Err(index.error(format!("no index, since the file has no {name}"))),
            _ => Err(index.error(format!("an index into {name}, 0 to {}", len - 1))),
        }
    }
}

/// A value as an error shows it; long ones by their kind.
fn shown(value: &Value) -> String {
    match value {
        Value::Array(list) if list.len() > 16 => format!("a list of {}", list.len()),
        Value::Object(map) if map.len() > 4 => format!("an object of {} keys", map.len()),
        _ => value.to_string(),
    }
}
