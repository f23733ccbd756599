//! A JSON document in memory, and the one strict way from text to it.
//!
//! Not `serde_json::Value`: that keeps the last of two equal keys without a word, and takes several kilobytes for
//! a body of a large scene.

use super::path::Path;
use crate::SceneError;
use crate::error::{SHOWN, cut};
use serde::de::{self, DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use std::cell::RefCell;
use std::collections::HashSet;
use std::fmt::{self, Display, Formatter, Write};
use std::rc::Rc;

/// A JSON value. Keys are shared between objects and unique within each.
#[derive(Debug, PartialEq)]
pub(crate) enum Json {
    Null,
    Bool(bool),
    Number(f64),
    Text(Box<str>),
    List(Box<[Json]>),
    Object(Box<[(Rc<str>, Json)]>),
}

impl Json {
    /// Reads `text`, the content of `file`.
    pub(crate) fn parse(text: &str, file: &str) -> Result<Json, SceneError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        if text.trim().is_empty() {
            let expected = r#"a scene: {"carom": 1, "bodies": [...]}"#;
            return Err(SceneError::invalid(file, "", "an empty file", expected));
        }
        let parse = Parse::default();
        let mut deserializer = serde_json::Deserializer::from_str(text);
        let tree = Node { path: Path::Root, parse: &parse }.deserialize(&mut deserializer);
        tree.and_then(|tree| deserializer.end().map(|()| tree))
            .map_err(|error| explain(text, file, &error, parse.trouble.into_inner().unwrap_or_default()))
    }

    /// The value of `key`, if this is an object that has it.
    pub(crate) fn get(&self, key: &str) -> Option<&Json> {
        match self {
            Json::Object(entries) => entries.iter().find(|(name, _)| &**name == key).map(|(_, value)| value),
            _ => None,
        }
    }

    fn write(&self, out: &mut Short) -> fmt::Result {
        match self {
            Json::Null => out.write_str("null"),
            Json::Bool(value) => write!(out, "{value}"),
            Json::Number(value) => out.write_str(&number(*value)),
            Json::Text(text) => write!(out, "{}", serde_json::Value::from(cut(text))),
            Json::List(items) => {
                for (index, item) in items.iter().enumerate() {
                    out.write_str(if index == 0 { "[" } else { ", " })?;
                    item.write(out)?;
                }
                out.write_str(if items.is_empty() { "[]" } else { "]" })
            }
            Json::Object(entries) => {
                for (index, (key, value)) in entries.iter().enumerate() {
                    out.write_str(if index == 0 { "{" } else { ", " })?;
                    write!(out, "{}: ", serde_json::Value::from(cut(key)))?;
                    value.write(out)?;
                }
                out.write_str(if entries.is_empty() { "{}" } else { "}" })
            }
        }
    }
}

/// The value on one line, as far as an error shows it.
impl Display for Json {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut short = Short(String::new());
        // Fails when there is enough.
        let _ = self.write(&mut short);
        f.write_str(&short.0)
    }
}

/// `value` as short as it reads back, without rows of zeros.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
}

/// Text that takes a little more than an error shows.
struct Short(String);

impl Write for Short {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.push_str(text);
        if self.0.len() > 4 * SHOWN { Err(fmt::Error) } else { Ok(()) }
    }
}

/// What the nodes of one document share while it is read.
#[derive(Default)]
struct Parse {
    keys: RefCell<HashSet<Rc<str>>>,
    /// The innermost place at which reading failed.
    trouble: RefCell<Option<Trouble>>,
}

#[derive(Default)]
struct Trouble {
    path: String,
    /// The value of a key that its object has already.
    repeated: Option<String>,
}

impl Parse {
    fn shared_key(&self, key: &str) -> Rc<str> {
        let mut keys = self.keys.borrow_mut();
        if let Some(known) = keys.get(key) {
            return Rc::clone(known);
        }
        let key: Rc<str> = key.into();
        keys.insert(Rc::clone(&key));
        key
    }

    fn note(&self, path: &Path<'_>, repeated: Option<String>) {
        self.trouble.borrow_mut().get_or_insert_with(|| Trouble { path: path.to_string(), repeated });
    }
}

/// A value that is about to be read, at its place.
struct Node<'a> {
    path: Path<'a>,
    parse: &'a Parse,
}

impl<'de> DeserializeSeed<'de> for Node<'_> {
    type Value = Json;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Json, D::Error> {
        let (path, parse) = (self.path, self.parse);
        deserializer.deserialize_any(self).inspect_err(|_| parse.note(&path, None))
    }
}

impl<'de> Visitor<'de> for Node<'_> {
    type Value = Json;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Bool(value))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json, E> {
        Ok(Json::Number(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_str<E>(self, text: &str) -> Result<Json, E> {
        Ok(Json::Text(text.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Json, A::Error> {
        let mut items = Vec::new();
        while let Some(item) =
            list.next_element_seed(Node { path: Path::Index(&self.path, items.len()), parse: self.parse })?
        {
            items.push(item);
        }
        Ok(Json::List(items.into()))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut object: A) -> Result<Json, A::Error> {
        /// From how many entries on a set is faster than looking through all.
        const MANY: usize = 32;
        let mut entries: Vec<(Rc<str>, Json)> = Vec::new();
        let mut names = HashSet::new();
        while let Some(key) = object.next_key_seed(Key(self.parse))? {
            let path = Path::Key(&self.path, &key);
            let value = object.next_value_seed(Node { path, parse: self.parse })?;
            if entries.len() == MANY {
                names.extend(entries.iter().map(|(name, _)| Rc::clone(name)));
            }
            let repeated = match entries.len() {
                ..MANY => entries.iter().any(|(name, _)| Rc::ptr_eq(name, &key)),
                _ => !names.insert(Rc::clone(&key)),
            };
            if repeated {
                self.parse.note(&path, Some(value.to_string()));
                return Err(de::Error::custom("a key stands twice in one object"));
            }
            entries.push((key, value));
        }
        Ok(Json::Object(entries.into()))
    }
}

/// A key that is about to be read.
struct Key<'a>(&'a Parse);

impl<'de> DeserializeSeed<'de> for Key<'_> {
    type Value = Rc<str>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Rc<str>, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl<'de> Visitor<'de> for Key<'_> {
    type Value = Rc<str>;

    fn expecting(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E>(self, key: &str) -> Result<Rc<str>, E> {
        Ok(self.0.shared_key(key))
    }
}

/// The parser's error, with what it can't know: the place in the document, and what a number should have been.
fn explain(text: &str, file: &str, error: &serde_json::Error, trouble: Trouble) -> SceneError {
    let (line, column) = (error.line(), error.column());
    let place = format!("line {line}, column {column}");
    if let Some(value) = trouble.repeated {
        let expected = format!("each key once in an object; this one is there already ({place})");
        return SceneError::invalid(file, trouble.path, value, expected);
    }
    let message = error.to_string();
    let message = message.split(" at line ").next().unwrap_or_default();
    let token = token_at(text, line, column);
    let bare = token.trim_start_matches(['+', '-']).to_ascii_lowercase();
    if message == "number out of range" || ["nan", "inf", "infinity"].contains(&&*bare) {
        let expected = format!("a finite number ({place})");
        return SceneError::invalid(file, trouble.path, token, expected);
    }
    let message = match message {
        "recursion limit exceeded" => {
            "nested too deep; at most 127 lists and objects in each other".to_owned()
        }
        _ if trouble.path.is_empty() => message.to_owned(),
        _ => format!("{message} (in {})", trouble.path),
    };
    SceneError::Syntax { file: file.to_owned(), line, column, message }
}

/// The word that covers the given place (line and byte from 1).
fn token_at(text: &str, line: usize, column: usize) -> &str {
    let ends = |c: char| c.is_whitespace() || matches!(c, ',' | ':' | '[' | ']' | '{' | '}');
    let line = text.split('\n').nth(line.saturating_sub(1)).unwrap_or_default();
    let mut at = column.saturating_sub(1).min(line.len());
    while !line.is_char_boundary(at) {
        at -= 1;
    }
    let start = line[..at]
        .rfind(ends)
        .map_or(0, |before| before + line[before..].chars().next().map_or(1, char::len_utf8));
    let end = line[at..].find(ends).map_or(line.len(), |length| at + length);
    &line[start..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_value_is_kept() {
        let tree =
            Json::parse("\u{feff}{\"a\": [1, -2, 0.1, 1e300, true, null, \"\\u00e9\"], \"b\": {}}", "f")
                .unwrap();
        assert_eq!(tree.to_string(), r#"{"a": [1, -2, 0.1, 1e300, true, null, "é"], "b": {}}"#);
        assert_eq!(tree.get("b"), Some(&Json::Object([].into())));
        assert_eq!(tree.get("c"), None);
    }

    #[test]
    fn numbers_are_the_nearest_doubles() {
        for text in
            ["0.1", "0.30000000000000004", "5e-324", "1.7976931348623157e308", "9007199254740993", "-0.0"]
        {
            let expected: f64 = text.parse().unwrap();
            let Json::Number(value) = Json::parse(text, "f").unwrap() else { panic!("{text}") };
            assert_eq!(value.to_bits(), expected.to_bits(), "{text}");
        }
    }

    #[test]
    fn a_repeated_key_is_found_in_small_and_large_objects() {
        for n in [1, 31, 32, 33, 1000] {
            let keys: String = (0..n).map(|i| format!("\"k{i}\": {i}, ")).collect();
            let text = format!("{{\"in\": {{{keys}\"k0\": 7}}}}");
            let error = Json::parse(&text, "f").unwrap_err().to_string();
            assert!(error.starts_with("f: in.k0: 7; expected each key once"), "{error}");
        }
    }

    #[test]
    fn long_values_are_cut_and_not_written_out() {
        let tree = Json::List((0..1_000_000).map(|i| Json::Number(f64::from(i))).collect());
        assert!(tree.to_string().len() < 300);
    }
}
