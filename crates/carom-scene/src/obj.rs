//! Points and triangles from Wavefront OBJ files.
//!
//! Read are `v` and `f`, whatever groups, objects and materials they stand in; all else is passed over: normals, texture
//! coordinates, lines, curves, names. A face of more than three corners is cut into a fan from its first one. Indices
//! count from 1, or backwards from the last vertex so far where they are negative. A backslash at its end goes on with a
//! line in the next.

use carom::limits;
use carom::math::DVec3;

/// What a file holds of geometry.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Obj {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

/// What is wrong with a file, and where.
#[derive(Debug, PartialEq)]
pub(crate) struct Trouble {
    /// From 1.
    pub line: usize,
    pub value: String,
    pub expected: String,
}

impl Obj {
    /// Reads the content of a file.
    pub fn parse(bytes: &[u8]) -> Result<Obj, Trouble> {
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
        let mut obj = Obj::default();
        // Indices of vertices that are still to come, with their lines.
        let mut ahead = Vec::new();
        let mut lines = text.lines().enumerate();
        while let Some((index, line)) = lines.next() {
            let mut words = Words { line: index + 1, words: Vec::new() };
            let mut rest = line;
            loop {
                let said = rest.split('#').next().unwrap_or_default();
                let continued = said.trim_end().strip_suffix('\\').filter(|_| said.len() == rest.len());
                words.words.extend(continued.unwrap_or(said).split_whitespace());
                let Some((_, next)) = continued.and_then(|_| lines.next()) else { break };
                rest = next;
            }
            match words.words.first() {
                Some(&"v") => obj.vertices.push(words.point()?),
                Some(&"f") => obj.face(&words, &mut ahead)?,
                _ => {}
            }
            if obj.vertices.len() > u32::MAX as usize {
                return Err(words.trouble("a vertex", "at most 4294967295 vertices in a file"));
            }
        }
        let n_vertices = obj.vertices.len();
        match ahead.into_iter().find(|&(_, number)| number > n_vertices as i64) {
            Some((line, number)) => {
                let expected = format!("the number of one of the file's {n_vertices} vertices");
                Err(Trouble { line, value: number.to_string(), expected })
            }
            None => Ok(obj),
        }
    }

    fn face(&mut self, words: &Words<'_>, ahead: &mut Vec<(usize, i64)>) -> Result<(), Trouble> {
        let corners = &words.words[1..];
        if corners.len() < 3 {
            return Err(words.trouble(words.words.join(" "), "at least three corners in a face"));
        }
        let n_vertices = self.vertices.len() as i64;
        let mut fan = Vec::with_capacity(corners.len());
        for corner in corners {
            let number = words.corner(corner)?;
            let from_start = if number < 0 { n_vertices + number + 1 } else { number };
            if from_start < 1 {
                let expected =
                    format!("a number from -{n_vertices} to -1, counted back from the last vertex so far");
                return Err(words.trouble(corner, expected));
            }
            if from_start > n_vertices {
                ahead.push((words.line, from_start));
            }
            fan.push(u32::try_from(from_start - 1).unwrap_or(u32::MAX));
        }
        self.triangles.extend(fan[1..].windows(2).map(|pair| [fan[0], pair[0], pair[1]]));
        Ok(())
    }
}

/// The words of a line, and of those that it goes on in.
struct Words<'t> {
    line: usize,
    words: Vec<&'t str>,
}

impl Words<'_> {
    fn trouble(&self, value: impl ToString, expected: impl Into<String>) -> Trouble {
        Trouble { line: self.line, value: value.to_string(), expected: expected.into() }
    }

    /// The first three numbers; a weight or a colour may follow.
    fn point(&self) -> Result<DVec3, Trouble> {
        let reach = *limits::LENGTH.end();
        let mut point = [0.0; 3];
        for (axis, x) in point.iter_mut().enumerate() {
            let Some(word) = self.words.get(axis + 1) else {
                return Err(self.trouble(self.words.join(" "), "a vertex with three numbers x y z, m"));
            };
            *x = word
                .parse()
                .ok()
                .filter(|x: &f64| x.abs() <= reach)
                .ok_or_else(|| self.trouble(word, format!("a number from -{reach:e} to {reach:e} m")))?;
        }
        Ok(DVec3::from_array(point))
    }

    /// The vertex of a corner, which may have a texture coordinate and a normal: `v`, `v/vt`, `v//vn`, `v/vt/vn`.
    fn corner(&self, corner: &str) -> Result<i64, Trouble> {
        let is_number = |part: &str| part.parse::<i64>().is_ok_and(|number| number != 0);
        let mut parts = corner.split('/');
        let vertex = parts.next().unwrap_or_default();
        let rest: Vec<&str> = parts.collect();
        let well_formed = match rest[..] {
            [] => true,
            [texture] => is_number(texture),
            [texture, normal] => (texture.is_empty() || is_number(texture)) && is_number(normal),
            _ => false,
        };
        match vertex.parse() {
            Ok(number) if number != 0 && well_formed => Ok(number),
            _ => Err(self.trouble(
                corner,
                "a corner v, v/vt, v//vn or v/vt/vn of whole numbers, counted from 1 or back from -1",
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Obj {
        Obj::parse(text.as_bytes()).unwrap_or_else(|trouble| panic!("{trouble:?}"))
    }

    #[test]
    fn all_groups_count_and_polygons_become_fans() {
        let obj = parsed(
            "# a house\r\nmtllib house.mtl\no house\nv 0 0 0\nv 1 0 0 1.0\nv 1. 1e0 +0 0.5 0.5 0.5\nv 0 1 0\n\
             vt 0 0\nvn 0 0 1\ng walls\nusemtl brick\ns off\nf 1/1/1 2//1 3/1 4\ng roof\n\tv .5 1.5 -2E-1 # tip\nf -2 -3 -1\nl 1 2\n",
        );
        assert_eq!(obj.vertices.len(), 5);
        assert_eq!(obj.vertices[4], DVec3::new(0.5, 1.5, -0.2));
        assert_eq!(obj.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 4]]);
    }

    #[test]
    fn lines_go_on_after_a_backslash_and_indices_may_run_ahead() {
        let obj = parsed("f 1 2 \\\n 3 \\\r\n  4\nv 0 0 0\nv 1 0 \\\n0\nv 1 1 0\nv 0 1 0\n# no \\\nf 1 2 3");
        assert_eq!(obj.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 2]]);
        assert_eq!(obj.vertices[1], DVec3::X);
        assert_eq!(parsed(""), Obj::default());
        assert_eq!(parsed("\u{feff}v 1 2 3\n\\").vertices.len(), 1);
        assert_eq!(
            Obj::parse(b"o caf\xe9\nv 1 2 3\n").unwrap().vertices.len(),
            1,
            "names may be in any encoding"
        );
    }

    #[test]
    fn trouble_has_line_value_and_expectation() {
        let cases = [
            ("v 1 2", 1, "v 1 2", "three numbers"),
            ("v 1 2 x", 1, "x", "a number from -1e6 to 1e6 m"),
            ("\nv 1 nan 2", 2, "nan", "a number from"),
            ("v 1 inf 2", 1, "inf", "a number from"),
            ("v 1 2e6 2", 1, "2e6", "a number from"),
            ("v 0 0 0\nf 1 1", 2, "f 1 1", "at least three corners"),
            ("v 0 0 0\n\nf 1 1 0", 3, "0", "counted from 1"),
            ("v 0 0 0\nf 1 1 1.5", 2, "1.5", "a corner v, v/vt"),
            ("v 0 0 0\nf 1 1 1/", 2, "1/", "a corner v, v/vt"),
            ("v 0 0 0\nf 1 1 1/a/1", 2, "1/a/1", "a corner v, v/vt"),
            ("v 0 0 0\nf 1 1 1/1/1/1", 2, "1/1/1/1", "a corner v, v/vt"),
            ("v 0 0 0\nf 1 1 /1", 2, "/1", "a corner v, v/vt"),
            ("v 0 0 0\nf 1 1 -2", 2, "-2", "a number from -1 to -1"),
            ("v 0 0 0\nf 1 1 2", 2, "2", "one of the file's 1 vertices"),
            ("v 0 0 0\nf 1 \\\n1 99999999999999999999", 2, "99999999999999999999", "a corner v, v/vt"),
            ("f 9223372036854775807 1 -9223372036854775808", 1, "-9223372036854775808", "back from the last"),
        ];
        for (text, line, value, expected) in cases {
            let trouble = Obj::parse(text.as_bytes()).unwrap_err();
            assert_eq!((trouble.line, trouble.value.as_str()), (line, value), "{text}");
            assert!(trouble.expected.contains(expected), "{text}: {}", trouble.expected);
        }
    }
}
