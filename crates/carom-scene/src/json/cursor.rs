//! A place in a document, and typed ways to read what stands there. Every error knows its path.

use super::nearest::known;
use super::path::Path;
use super::tree::{Json, number};
use crate::SceneError;
use carom::limits;
use carom::math::{DQuat, DVec3};
use std::ops::RangeInclusive;
use std::rc::Rc;

/// How far from 1 the length of a quaternion may be.
const QUATERNION_TOLERANCE: f64 = 1e-3;

/// A value at its place in a document.
#[derive(Clone, Copy)]
pub(super) struct Cursor<'a> {
    pub(super) file: &'a str,
    pub(super) path: Path<'a>,
    pub(super) value: &'a Json,
}

impl<'a> Cursor<'a> {
    pub(super) fn root(file: &'a str, value: &'a Json) -> Self {
        Self { file, path: Path::Root, value }
    }

    /// The error that this value is not what was `expected`.
    pub(super) fn refuse(&self, expected: impl Into<String>) -> SceneError {
        self.refuse_as(self.value, expected)
    }

    /// [`Cursor::refuse`] with `value` shown in place of the value.
    pub(super) fn refuse_as(&self, value: impl ToString, expected: impl Into<String>) -> SceneError {
        SceneError::invalid(self.file, self.path, value, expected)
    }

    /// The error that this object lacks `key`.
    pub(super) fn refuse_lack(&self, key: &str, expected: impl Into<String>) -> SceneError {
        SceneError::invalid(self.file, Path::Key(&self.path, key), "nothing", expected)
    }

    pub(super) fn object(&'a self) -> Result<Object<'a>, SceneError> {
        match self.value {
            Json::Object(entries) => Ok(Object { at: self, entries }),
            _ => Err(self.refuse("an object {...}")),
        }
    }

    /// The items of a list, each at its place.
    pub(super) fn list(
        &'a self,
        of: &str,
    ) -> Result<impl ExactSizeIterator<Item = Cursor<'a>> + 'a, SceneError> {
        let Json::List(items) = self.value else {
            return Err(self.refuse(format!("a list of {of}")));
        };
        Ok(items.iter().enumerate().map(|(index, value)| Cursor {
            file: self.file,
            path: Path::Index(&self.path, index),
            value,
        }))
    }

    pub(super) fn text(&self, expected: &str) -> Result<&'a str, SceneError> {
        match self.value {
            Json::Text(text) => Ok(text),
            _ => Err(self.refuse(expected)),
        }
    }

    pub(super) fn boolean(&self) -> Result<bool, SceneError> {
        match self.value {
            Json::Bool(value) => Ok(*value),
            _ => Err(self.refuse("true or false")),
        }
    }

    /// A number that `fits`.
    fn number_that(
        &self,
        fits: impl Fn(f64) -> bool,
        expected: impl Fn() -> String,
    ) -> Result<f64, SceneError> {
        match self.value {
            Json::Number(value) if fits(*value) => Ok(*value),
            _ => Err(self.refuse(expected())),
        }
    }

    pub(super) fn finite(&self, unit: &str) -> Result<f64, SceneError> {
        self.number_that(f64::is_finite, || format!("a finite number{}", spaced(unit)))
    }

    pub(super) fn within(&self, range: RangeInclusive<f64>, unit: &str) -> Result<f64, SceneError> {
        let expected = || {
            format!("a number from {} to {}{}", number(*range.start()), number(*range.end()), spaced(unit))
        };
        self.number_that(|value| range.contains(&value), expected)
    }

    pub(super) fn not_negative(&self, unit: &str) -> Result<f64, SceneError> {
        let expected = || format!("a finite number{}, 0 or more", spaced(unit));
        self.number_that(|value| value >= 0.0 && value.is_finite(), expected)
    }

    /// A whole number from `range`.
    pub(super) fn integer(&self, range: RangeInclusive<u32>) -> Result<u32, SceneError> {
        let fits = |value: f64| {
            value.fract() == 0.0 && (f64::from(*range.start())..=f64::from(*range.end())).contains(&value)
        };
        let expected = || format!("a whole number from {} to {}", range.start(), range.end());
        self.number_that(fits, expected).map(|value| value as u32)
    }

    pub(super) fn length(&self) -> Result<f64, SceneError> {
        self.within(limits::LENGTH, "m")
    }

    /// Three numbers, each as `read` wants it; `what` names the list.
    pub(super) fn vector(
        &self,
        what: &str,
        read: impl Fn(&Cursor<'_>) -> Result<f64, SceneError>,
    ) -> Result<DVec3, SceneError> {
        self.numbers::<3>(what, read).map(DVec3::from_array)
    }

    /// Three numbers from −`limit` to `limit`.
    pub(super) fn vector_within(&self, limit: f64, unit: &str) -> Result<DVec3, SceneError> {
        self.vector("numbers [x, y, z]", |item| item.within(-limit..=limit, unit))
    }

    pub(super) fn position(&self) -> Result<DVec3, SceneError> {
        self.vector_within(limits::POSITION, "m")
    }

    /// A unit quaternion, normalised.
    pub(super) fn rotation(&self) -> Result<DQuat, SceneError> {
        let quaternion =
            self.numbers::<4>("numbers [x, y, z, w]", |item| item.finite("")).map(DQuat::from_array)?;
        let length = quaternion.length();
        if (length - 1.0).abs() <= QUATERNION_TOLERANCE {
            return Ok(quaternion * (1.0 / length));
        }
        Err(self.refuse(format!(
            "a unit quaternion [x, y, z, w], its length within {} of 1; this one's is {}",
            number(QUATERNION_TOLERANCE),
            number(length)
        )))
    }

    /// A list of so many numbers, each as `read` wants it; `what` names the list.
    pub(super) fn numbers<const N: usize>(
        &self,
        what: &str,
        read: impl Fn(&Cursor<'_>) -> Result<f64, SceneError>,
    ) -> Result<[f64; N], SceneError> {
        let mut numbers = [0.0; N];
        let items = self.list(what).ok().filter(|items| items.len() == N);
        let items = items.ok_or_else(|| self.refuse(format!("a list of {N} {what}")))?;
        for (slot, item) in numbers.iter_mut().zip(items) {
            *slot = read(&item)?;
        }
        Ok(numbers)
    }

    /// What the text here stands for, by a table of names.
    pub(super) fn choice<T: Copy>(&self, table: &[(&str, T)]) -> Result<T, SceneError> {
        let wrong = match self.value {
            Json::Text(text) => text,
            _ => "",
        };
        let found = table.iter().find(|(name, _)| *name == wrong).map(|&(_, meaning)| meaning);
        found.ok_or_else(|| {
            self.refuse(format!("one of {}", known(wrong, table.iter().map(|(name, _)| *name))))
        })
    }
}

/// An object at its place in a document.
#[derive(Clone, Copy)]
pub(super) struct Object<'a> {
    pub(super) at: &'a Cursor<'a>,
    entries: &'a [(Rc<str>, Json)],
}

impl<'a> Object<'a> {
    /// Refuses keys that are none of `keys`.
    pub(super) fn only(&self, keys: &[&str]) -> Result<(), SceneError> {
        match self.entries().find(|(key, _)| !keys.contains(key)) {
            None => Ok(()),
            Some((key, entry)) => {
                Err(entry.refuse(format!("no such key; known here are {}", known(key, keys.iter().copied()))))
            }
        }
    }

    pub(super) fn entries(&self) -> impl ExactSizeIterator<Item = (&'a str, Cursor<'a>)> + use<'a> {
        let at = self.at;
        self.entries
            .iter()
            .map(|(key, value)| (&**key, Cursor { file: at.file, path: Path::Key(&at.path, key), value }))
    }

    pub(super) fn get(&self, key: &str) -> Option<Cursor<'a>> {
        self.entries().find(|(name, _)| *name == key).map(|(_, entry)| entry)
    }

    /// The value of `key`, or the error that `expected` is missing there.
    pub(super) fn require(&self, key: &str, expected: &str) -> Result<Cursor<'a>, SceneError> {
        self.get(key).ok_or_else(|| self.at.refuse_lack(key, expected))
    }

    /// The value of `key` as `read` makes it, if the key is there.
    pub(super) fn optional<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Cursor<'a>) -> Result<T, SceneError>,
    ) -> Result<Option<T>, SceneError> {
        self.get(key).map(|entry| read(&entry)).transpose()
    }
}

fn spaced(unit: &str) -> String {
    if unit.is_empty() { String::new() } else { format!(" {unit}") }
}
