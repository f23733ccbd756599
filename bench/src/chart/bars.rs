//! A row of panels for each scene, in it a panel for each number of threads: a bar for each engine, as long as its ratio
//! to the fastest peer. All bars of a picture have the same scale, from 0.

use super::axis::number;
use super::drawing::{Anchor, Drawing, GREY, Place, color};
use super::{Frame, Grid, scenes};
use crate::comparison::{Comparison, Share};
use crate::report::threads;
use crate::rounds::Results;
use crate::table::short;

/// Space for a panel's heading, for each bar, and below them, pixels.
const HEAD: f64 = 26.0;
const PITCH: f64 = 17.0;
const FOOT: f64 = 16.0;
/// How thick a bar is, pixels.
const THICK: f64 = 12.0;
/// Space for names to the left of the bars, and for numbers to their right, pixels.
const NAMES: f64 = 84.0;
const NUMBERS: f64 = 118.0;

/// Draws below `top`; returns where it ends.
pub fn draw(drawing: &mut Drawing, results: &Results, mut top: f64) -> f64 {
    let engines = results.engine_names();
    let ratios = results.comparisons.iter().flat_map(|comparison| &comparison.shares);
    let longest = ratios.filter_map(|share| share.ratio).fold(1.0, f64::max);
    let height = HEAD + PITCH * engines.len() as f64 + FOOT;
    for scene in scenes(results) {
        let of_scene = |comparison: &&Comparison| comparison.scene == scene;
        let comparisons: Vec<&Comparison> = results.comparisons.iter().filter(of_scene).collect();
        let grid = Grid { top, columns: comparisons.len().clamp(1, 3), height };
        for (index, comparison) in comparisons.iter().enumerate() {
            Panel { cell: grid.cell(index), engines: &engines, longest }.draw(drawing, comparison);
        }
        top = grid.bottom(comparisons.len());
    }
    top
}

/// Where a comparison is drawn.
struct Panel<'a> {
    cell: Frame,
    engines: &'a [&'a str],
    /// The largest ratio of the picture.
    longest: f64,
}

impl Panel<'_> {
    fn draw(&self, drawing: &mut Drawing, comparison: &Comparison) {
        let cell = self.cell;
        let Comparison { scene, bodies, steps, .. } = comparison;
        let note =
            format!("{}, {} bodies, {steps} steps", threads(comparison.threads), number(*bodies as f64));
        drawing.heading(Place(cell.left, cell.top + 14.0), scene, &note);
        let foot = cell.left + NAMES;
        for (index, engine) in self.engines.iter().enumerate() {
            let middle = cell.top + HEAD + PITCH * (index as f64 + 0.5);
            drawing.small(Place(foot - 6.0, middle + 4.0), Anchor::End, engine);
            let share = comparison.share(engine);
            let length = share.and_then(|share| share.ratio).map_or(0.0, |ratio| self.length(ratio));
            drawing.bar(Place(foot, middle - 0.5 * THICK), [length, THICK], color(index));
            // Beyond the line, which would strike through the figures of short bars.
            let end = foot + length.max(self.length(1.0));
            drawing.small(Place(end + 6.0, middle + 4.0), Anchor::Start, &figures(share));
        }
        let (one, bottom) =
            (foot + self.length(1.0), cell.top + HEAD + PITCH * self.engines.len() as f64 + 2.0);
        drawing.line(Place(one, cell.top + HEAD - 2.0), Place(one, bottom), GREY);
    }

    /// The length of a bar, pixels.
    fn length(&self, ratio: f64) -> f64 {
        (self.cell.right - self.cell.left - NAMES - NUMBERS) * ratio / self.longest
    }
}

/// What stands beside a bar.
fn figures(share: Option<&Share>) -> String {
    match share {
        Some(Share { ms, ratio: Some(ratio), .. }) => format!("{} ms, {ratio:.2}×", short(*ms)),
        Some(Share { ms, ratio: None, .. }) => format!("{} ms*", short(*ms)),
        None => "no result".to_string(),
    }
}
