//! A panel for each scene, in it a line for each engine with each number of threads: time of a step over bodies, both
//! logarithmic, so that a power is a straight line and its exponent the slope.

use super::axis::{Axis, number};
use super::drawing::{Anchor, Drawing, GREY, PALE, Place, color};
use super::{Frame, Grid, LINE, engines, scenes, vertical_axis};
use crate::curve::{Curve, Point};
use crate::report::threads;
use crate::rounds::Results;

/// Dashes of the numbers of threads, in their order.
const DASHES: [&str; 4] = ["none", "7 4", "2 3", "9 3 2 3"];

/// Draws below `top`; returns where it ends.
pub fn draw(drawing: &mut Drawing, results: &Results, top: f64) -> f64 {
    let (engines, scenes) = (engines(results), scenes(results));
    let curves =
        |scene: &str| -> Vec<&Curve> { results.curves.iter().filter(|curve| curve.scene == scene).collect() };
    let keys = scenes.iter().map(|scene| curves(scene).len()).max().unwrap_or(0) + 1;
    let height = 390.0 + keys as f64 * LINE;
    let grid = Grid { top: top - 8.0, columns: scenes.len().clamp(1, 2), height };
    for (index, scene) in scenes.iter().enumerate() {
        let panel = Panel { cell: grid.cell(index), keys, engines: &engines };
        drawing.heading(Place(panel.cell.left, panel.cell.top + 14.0), scene);
        panel.draw(drawing, &curves(scene));
    }
    grid.bottom(scenes.len())
}

/// Where a scene is drawn.
struct Panel<'a> {
    cell: Frame,
    /// For how many lines there is space under the axis.
    keys: usize,
    engines: &'a [&'a str],
}

impl Panel<'_> {
    fn draw(&self, drawing: &mut Drawing, curves: &[&Curve]) {
        let cell = self.cell;
        let frame = Frame {
            left: cell.left + 52.0,
            top: cell.top + 46.0,
            right: cell.right - 20.0,
            bottom: cell.bottom - 62.0 - self.keys as f64 * LINE,
        };
        let points = || curves.iter().flat_map(|curve| &curve.points);
        let bodies = points().map(|point| point.bodies as f64);
        let axes = (
            Axis::logarithmic(bodies, [frame.left, frame.right]),
            Axis::logarithmic(points().map(|point| point.ms), [frame.bottom, frame.top]),
        );
        let (Some(across), Some(up)) = axes else {
            drawing.small(Place(frame.left, frame.top), Anchor::Start, "no result");
            return;
        };
        drawing.small(Place(cell.left, cell.top + 14.0 + LINE), Anchor::Start, "ms a step");
        for tick in across.ticks() {
            let x = across.at(tick.value);
            drawing.line(Place(x, frame.top), Place(x, frame.bottom), PALE);
            if tick.labelled {
                drawing.small(Place(x, frame.bottom + LINE), Anchor::Middle, &number(tick.value));
            }
        }
        vertical_axis(drawing, frame, &up);
        let middle = 0.5 * (frame.left + frame.right);
        drawing.small(Place(middle, frame.bottom + 2.1 * LINE), Anchor::Middle, "bodies");

        let place = |point: &Point| Place(across.at(point.bodies as f64), up.at(point.ms));
        if let Some(ends) = proportional(curves, &up) {
            let [from, to] = ends.map(|point| place(&point));
            drawing.line(from, to, GREY);
        }
        for curve in curves {
            let (color, dashes) = self.style(curve, curves);
            drawing.curve(&curve.points.iter().map(place).collect::<Vec<_>>(), color, dashes);
        }
        self.key(drawing, curves, Place(frame.left, frame.bottom + 3.4 * LINE));
    }

    /// Which line is whose, with its exponent.
    fn key(&self, drawing: &mut Drawing, curves: &[&Curve], Place(x, mut y): Place) {
        for curve in curves {
            let (color, dashes) = self.style(curve, curves);
            drawing.sample(Place(x, y - 4.0), color, dashes);
            let mut text = format!("{}, {}", curve.engine, threads(curve.threads));
            if let (Some(all), Some(last)) = (curve.exponent, curve.last_exponent) {
                text += &format!(": n^{all:.2}; n^{last:.2} between the last two");
            }
            drawing.small(Place(x + 36.0, y), Anchor::Start, &text);
            y += LINE;
        }
        drawing.line(Place(x, y - 4.0), Place(x + 28.0, y - 4.0), GREY);
        drawing.small(Place(x + 36.0, y), Anchor::Start, "in proportion to the bodies");
    }

    /// Colour of the engine, dashes of the number of threads.
    fn style(&self, curve: &Curve, curves: &[&Curve]) -> (&'static str, &'static str) {
        let engine = self.engines.iter().position(|engine| *engine == curve.engine).unwrap_or(0);
        let mut numbers: Vec<usize> = curves.iter().map(|curve| curve.threads).collect();
        numbers.dedup();
        let order = numbers.iter().position(|number| *number == curve.threads).unwrap_or(0);
        (color(engine), DASHES[order % DASHES.len()])
    }
}

/// From the first curve's first point on, in proportion to the bodies as far as the panel goes.
fn proportional(curves: &[&Curve], up: &Axis) -> Option<[Point; 2]> {
    let first = *curves.iter().find_map(|curve| curve.points.first())?;
    let most = curves.iter().flat_map(|curve| &curve.points).map(|point| point.bodies).max()?;
    let factor = (most as f64 / first.bodies as f64).min(up.high() / first.ms);
    let last = Point { bodies: (first.bodies as f64 * factor) as usize, ms: first.ms * factor };
    (factor > 1.0).then_some([first, last])
}
