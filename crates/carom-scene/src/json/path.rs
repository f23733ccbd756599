//! Where a value stands in a JSON document.

use std::fmt::{self, Display, Formatter};

/// The way from the document's root to a value. Kept on the stack, so that walking a document allocates nothing;
/// it is written out only into an error.
#[derive(Clone, Copy)]
pub(super) enum Path<'a> {
    Root,
    Key(&'a Path<'a>, &'a str),
    Index(&'a Path<'a>, usize),
}

/// As a JavaScript programmer would write it: `bodies[3].colliders[0].shape.radius`, `materials["oiled steel"]`.
impl Display for Path<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Path::Root => Ok(()),
            Path::Index(parent, index) => write!(f, "{parent}[{index}]"),
            Path::Key(parent, key) if !is_plain(key) => {
                write!(f, "{parent}[{}]", serde_json::Value::from(crate::error::cut(key)))
            }
            Path::Key(Path::Root, key) => f.write_str(key),
            Path::Key(parent, key) => write!(f, "{parent}.{key}"),
        }
    }
}

fn is_plain(key: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    !key.is_empty() && key.chars().count() <= crate::error::SHOWN && key.chars().all(plain)
}

#[cfg(test)]
mod tests {
    use super::Path;

    #[test]
    fn reads_like_javascript() {
        let bodies = Path::Key(&Path::Root, "bodies");
        let body = Path::Index(&bodies, 3);
        assert_eq!(Path::Root.to_string(), "");
        assert_eq!(Path::Key(&body, "mass").to_string(), "bodies[3].mass");
        assert_eq!(Path::Key(&body, "a \"b\"\n").to_string(), r#"bodies[3]["a \"b\"\n"]"#);
        assert_eq!(Path::Key(&Path::Root, "").to_string(), r#"[""]"#);
    }
}
