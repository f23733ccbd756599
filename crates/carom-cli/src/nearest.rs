//! What somebody may have meant.

/// The name that is most like `asked`, if any is at all like it.
pub fn nearest<'a>(asked: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let tolerated = asked.chars().count() / 3 + 1;
    let distances = names.map(|name| (distance(asked, name), name));
    distances
        .filter(|&(distance, _)| distance <= tolerated)
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, name)| name)
}

/// How many letters must be put in, taken out or replaced (Levenshtein 1966); case counts for nothing.
fn distance(a: &str, b: &str) -> usize {
    let letters = |text: &str| text.chars().flat_map(char::to_lowercase).take(100).collect::<Vec<_>>();
    let (a, b) = (letters(a), letters(b));
    // Distances from all of `a` so far to each beginning of `b`.
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_slips_are_understood_and_strangers_are_not() {
        let names = ["floor", "ball", "club head"];
        assert_eq!(nearest("flor", names.into_iter()), Some("floor"));
        assert_eq!(nearest("Balls", names.into_iter()), Some("ball"));
        assert_eq!(nearest("club-head", names.into_iter()), Some("club head"));
        assert_eq!(nearest("elephant", names.into_iter()), None);
        assert_eq!(distance("kitten", "sitting"), 3);
    }
}
