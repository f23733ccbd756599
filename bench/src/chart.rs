//! What a run found as a picture: SVG, written by hand.
//!
//! | file | what it draws |
//! |---|---|
//! | `bars` | every engine beside the fastest peer, panels for each scene |
//! | `lines` | cost against size, panels for each scene |
//! | `axis` | from values to places, and where to write numbers |
//! | `drawing` | lines, rectangles and text |

mod axis;
mod bars;
mod drawing;
mod lines;

use crate::rounds::Results;
use drawing::{Anchor, Drawing, Place};

/// Width of the picture, pixels.
const WIDTH: f64 = 900.0;
/// Space around everything.
const MARGIN: f64 = 24.0;
/// Height of a line of small text.
const LINE: f64 = 17.0;

/// A part of the picture with axes of its own.
#[derive(Clone, Copy)]
struct Frame {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

/// The picture: lines where cost against size was measured, else bars.
pub fn svg(results: &Results) -> String {
    let grows = !results.curves.is_empty();
    let (title, ratios) = if grows {
        ("Time of a step against the number of bodies", "")
    } else {
        ("Time of a step, and its ratio to the fastest peer's", "; the bars are the ratios, the line is 1")
    };
    let rounds = match results.rounds {
        1 => "the mean of one run".to_string(),
        rounds => format!("the least of the means of {rounds} runs"),
    };
    let mut drawing = Drawing::new();
    drawing.title(Place(MARGIN, MARGIN + 14.0), title);
    drawing.text(
        Place(MARGIN, MARGIN + 34.0),
        Anchor::Start,
        &format!("Milliseconds, {rounds}{ratios}. Less is better."),
    );
    let top = MARGIN + 56.0;
    let bottom =
        if grows { lines::draw(&mut drawing, results, top) } else { bars::draw(&mut drawing, results, top) };
    let bottom = footer(&mut drawing, results, bottom);
    drawing.finish(WIDTH, bottom + MARGIN)
}

/// All scenes, each once, in their order.
fn scenes(results: &Results) -> Vec<&str> {
    let mut scenes: Vec<&str> = results.cases.iter().map(|case| case.scene.as_str()).collect();
    scenes.dedup();
    scenes
}

/// Panels in rows of `columns`, each `height` high.
struct Grid {
    top: f64,
    columns: usize,
    height: f64,
}

impl Grid {
    /// Where panel `index` lies.
    fn cell(&self, index: usize) -> Frame {
        let width = (WIDTH - 2.0 * MARGIN) / self.columns as f64;
        let left = MARGIN + (index % self.columns) as f64 * width;
        let top = self.top + (index / self.columns) as f64 * self.height;
        Frame { left, top, right: left + width, bottom: top + self.height }
    }

    /// The lower end of `panels` panels.
    fn bottom(&self, panels: usize) -> f64 {
        self.top + panels.div_ceil(self.columns) as f64 * self.height
    }
}

/// What was compared, and on what; returns where it ends.
fn footer(drawing: &mut Drawing, results: &Results, top: f64) -> f64 {
    let machine = &results.machine;
    let mut lines = Vec::new();
    for entrant in results.engines() {
        lines.push(format!("{}: {}", entrant.engine, entrant.version));
    }
    lines.push(format!(
        "{}, {} threads at once; compiled for {}",
        machine.processor, machine.threads, machine.compiled_for
    ));
    let whole = |entrant: &crate::rounds::Entrant| entrant.summary.as_ref().is_none_or(|s| s.whole());
    if !results.cases.iter().flat_map(|case| &case.entrants).all(whole) {
        let stopped = if results.curves.is_empty() {
            "* was stopped at the limit of time: the mean of the steps that were done, and no bar."
        } else {
            "What was stopped at the limit of time is not drawn."
        };
        lines.push(stopped.to_string());
    }
    let mut y = top + LINE;
    for line in lines {
        drawing.small(Place(MARGIN, y), Anchor::Start, &line);
        y += LINE;
    }
    y - LINE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    /// Every element is closed, and nothing that came from outside is markup.
    fn well_formed(svg: &str) {
        let mut open = Vec::new();
        for part in svg.split('<').skip(1) {
            let (tag, _) = part.split_once('>').expect("a tag that ends");
            if let Some(name) = tag.strip_prefix('/') {
                assert_eq!(open.pop(), Some(name));
            } else if !tag.ends_with('/') {
                open.push(tag.split(' ').next().unwrap());
            }
        }
        assert!(open.is_empty() && svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{svg}");
    }

    /// What the bars' attribute says, one after the other.
    fn lengths(svg: &str) -> Vec<f64> {
        let width =
            |line: &str| -> Option<f64> { line.split_once(" width=\"")?.1.split_once('"')?.0.parse().ok() };
        svg.lines().filter(|line| line.contains("class=\"bar\"")).filter_map(width).collect()
    }

    #[test]
    fn bars_are_as_long_as_their_ratios_to_the_peer() {
        let cases = sample::cases().into_iter().filter(|case| case.entrants[0].job.count == Some(1000));
        let svg = svg(&sample::results(cases.collect(), false));
        well_formed(&svg);
        let lengths = lengths(&svg);
        assert_eq!(lengths.len(), 4, "{svg}");
        for (length, ratio) in lengths.iter().zip([0.3162, 1.0, 0.3162, 1.0]) {
            assert!((length / lengths[1] - ratio).abs() < 0.001, "{lengths:?}");
        }
        for text in [
            ">pile<",
            ">1 thread, 1,000 bodies, 1 steps<",
            ">2 threads, ",
            ">carom<",
            ">peer<",
            ">3.16 ms, 1.00×<",
            "&lt;1 &amp; 2&gt;",
            "prefers-color-scheme: dark",
        ] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }

    #[test]
    fn a_missing_engine_keeps_its_place_and_its_colour() {
        let mut cases: Vec<_> = sample::cases().into_iter().take(2).collect();
        cases[1].scene = "gas".to_string();
        cases[0].entrants.insert(1, sample::entrant("third", 100, 0.05));
        cases[1].entrants.insert(1, sample::entrant("third", 1000, 0.5));
        cases[1].entrants[1].summary = None;
        let svg = svg(&sample::results(cases, false));
        well_formed(&svg);
        let colors = svg.lines().filter_map(|line| line.split_once("class=\"bar\"")?.1.split_once("fill="));
        let colors: Vec<&str> = colors.map(|(_, color)| color).collect();
        assert_eq!(colors[..3], colors[3..]);
        assert_eq!(lengths(&svg)[4], 0.0);
        assert_eq!(svg.matches(">no result<").count(), 1);
    }

    #[test]
    fn lines_go_through_every_size_and_name_their_exponents() {
        let svg = svg(&sample::results(sample::cases(), true));
        well_formed(&svg);
        let count = |text: &str| svg.matches(text).count();
        assert_eq!((count("class=\"curve\""), count("<circle ")), (4, 4 * 3));
        for text in [">carom: n^1.00; ", ">peer: n^1.50; ", ">bodies<", ">10,000<", ">2 threads, ms a step<"]
        {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }

    #[test]
    fn what_was_written_and_read_draws_the_same() {
        let measured = sample::results(sample::cases(), true);
        let read: Results = serde_json::from_str(&serde_json::to_string(&measured).unwrap()).unwrap();
        assert_eq!(svg(&read), svg(&measured));
        assert_eq!(crate::report::text(&read), crate::report::text(&measured));
    }

    #[test]
    fn what_was_stopped_is_marked() {
        let mut cases = sample::cases();
        cases[0].entrants[1].summary.as_mut().unwrap().steps = (1, 2);
        cases.truncate(1);
        let svg = svg(&sample::results(cases, false));
        well_formed(&svg);
        assert!(svg.contains(">0.100 ms*<") && svg.contains("* was stopped at the limit"), "{svg}");
    }

    #[test]
    fn nothing_measured_is_an_empty_picture() {
        for grows in [false, true] {
            well_formed(&svg(&sample::results(Vec::new(), grows)));
            let mut cases = sample::cases();
            cases.iter_mut().flat_map(|case| &mut case.entrants).for_each(|entrant| entrant.summary = None);
            well_formed(&svg(&sample::results(cases, grows)));
        }
    }
}
