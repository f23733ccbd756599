//! What the writer of an unknown name may have meant.

/// At most this many names are listed in an error.
const LISTED: usize = 20;

/// `names` as a list for an error about `wrong`, with the nearest one pointed out.
pub(super) fn known<'n>(wrong: &str, names: impl IntoIterator<Item = &'n str>) -> String {
    let mut names: Vec<&str> = names.into_iter().collect();
    let nearest = nearest(wrong, &names);
    let more = names.len().saturating_sub(LISTED);
    names.truncate(LISTED);
    let mut text = if names.is_empty() { "(there are none)".to_owned() } else { names.join(", ") };
    if more > 0 {
        text += &format!(" and {more} more");
    }
    if let Some(nearest) = nearest {
        text += &format!(" (did you mean {nearest}?)");
    }
    text
}

/// The name with the fewest slips of a pen from `wrong`, the first of equals; none if all are too far to be meant.
fn nearest<'n>(wrong: &str, names: &[&'n str]) -> Option<&'n str> {
    let wrong = letters(wrong);
    let allowed = (wrong.len() / 3).clamp(1, 4);
    let rated = names.iter().filter_map(|&name| {
        let name_letters = letters(name);
        let near = name_letters.len().abs_diff(wrong.len()) <= allowed;
        near.then(|| (slips(&wrong, &name_letters), name))
    });
    rated.min_by_key(|&(slips, _)| slips).filter(|&(slips, _)| slips <= allowed).map(|(_, name)| name)
}

/// The letters that count: case does not, nor how words are joined.
fn letters(name: &str) -> Vec<char> {
    let said = name.chars().filter(|c| !matches!(c, '_' | '-' | ' '));
    said.flat_map(char::to_lowercase).take(64).collect()
}

/// Letters left out, put in, put wrong or swapped with the next (Damerau's distance, no letter touched twice).
fn slips(a: &[char], b: &[char]) -> usize {
    let mut rows = [vec![0; b.len() + 1], (0..=b.len()).collect::<Vec<_>>(), vec![0; b.len() + 1]];
    for i in 0..a.len() {
        let [before, above, row] = &mut rows;
        row[0] = i + 1;
        for j in 0..b.len() {
            let change = above[j] + usize::from(a[i] != b[j]);
            row[j + 1] = change.min(above[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                row[j + 1] = row[j + 1].min(before[j - 1] + 1);
            }
        }
        rows.rotate_left(1);
    }
    rows[1][b.len()]
}

#[cfg(test)]
mod tests {
    use super::{known, nearest};

    #[test]
    fn slips_of_the_pen_are_recognised() {
        let names = ["radius", "radius_bottom", "height", "friction", "static_friction"];
        for (wrong, meant) in [
            ("raduis", "radius"),
            ("Radius", "radius"),
            ("radiusBottom", "radius_bottom"),
            ("hieght", "height"),
            ("frction", "friction"),
            ("staticFriction", "static_friction"),
        ] {
            assert_eq!(nearest(wrong, &names), Some(meant), "{wrong}");
        }
        for wrong in ["", "mass", "x", "restitution"] {
            assert_eq!(nearest(wrong, &names), None, "{wrong}");
        }
    }

    #[test]
    fn long_lists_are_cut() {
        let names: Vec<String> = (0..30).map(|i| format!("material number {i}")).collect();
        let text = known("zinc", names.iter().map(String::as_str));
        assert!(text.starts_with("material number 0, material number 1, ") && text.ends_with(" and 10 more"));
        assert_eq!(known("zinc", []), "(there are none)");
    }
}
