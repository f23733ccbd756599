//! A panel for each scene with each number of threads, in it a line for each engine: time of a step over bodies, both
//! logarithmic, so that a power is a straight line and its exponent the slope.

use super::axis::{Axis, number};
use super::drawing::{Anchor, Drawing, GREY, INK, PALE, Place, color};
use super::{Frame, Grid, LINE};
use crate::curve::{Curve, Point};
use crate::report::threads;
use crate::rounds::Results;

/// Draws below `top`; returns where it ends.
pub fn draw(drawing: &mut Drawing, results: &Results, top: f64) -> f64 {
    let engines = results.engine_names();
    let panels: Vec<&[Curve]> =
        results.curves.chunk_by(|a, b| (&a.scene, a.threads) == (&b.scene, b.threads)).collect();
    let keys = panels.iter().map(|curves| curves.len()).max().unwrap_or(0) + 1;
    let height = 360.0 + keys as f64 * LINE;
    let grid = Grid { top: top - 8.0, columns: panels.len().clamp(1, 2), height };
    for (index, curves) in panels.iter().enumerate() {
        let cell = grid.cell(index);
        let (scene, threads) = (&curves[0].scene, threads(curves[0].threads));
        drawing.heading(Place(cell.left, cell.top + 14.0), scene, &format!("{threads}, ms a step"));
        // Panels of the same scene have the same axes, so that eyes can compare them.
        let of_scene = results.curves.iter().filter(|curve| curve.scene == *scene);
        Panel { cell, keys, engines: &engines, of_scene: of_scene.collect() }.draw(drawing, curves);
    }
    grid.bottom(panels.len())
}

/// Where curves are drawn.
struct Panel<'a> {
    cell: Frame,
    /// For how many lines there is space under the axis.
    keys: usize,
    engines: &'a [&'a str],
    /// What has to have a place on the axes.
    of_scene: Vec<&'a Curve>,
}

impl Panel<'_> {
    fn draw(&self, drawing: &mut Drawing, curves: &[Curve]) {
        let cell = self.cell;
        let frame = Frame {
            left: cell.left + 46.0,
            top: cell.top + 34.0,
            right: cell.right - 20.0,
            bottom: cell.bottom - 62.0 - self.keys as f64 * LINE,
        };
        let points = || self.of_scene.iter().flat_map(|curve| &curve.points);
        let bodies = points().map(|point| point.bodies as f64);
        let axes = (
            Axis::logarithmic(bodies, [frame.left, frame.right]),
            Axis::logarithmic(points().map(|point| point.ms), [frame.bottom, frame.top]),
        );
        let (Some(across), Some(up)) = axes else {
            drawing.small(Place(frame.left, frame.top), Anchor::Start, "no result");
            return;
        };
        rule(drawing, frame, &across, &up);
        let place = |point: &Point| Place(across.at(point.bodies as f64), up.at(point.ms));
        if let Some(ends) = proportional(curves, &up) {
            let [from, to] = ends.map(|point| place(&point));
            drawing.line(from, to, GREY);
        }
        for curve in curves {
            drawing.curve(&curve.points.iter().map(place).collect::<Vec<_>>(), self.color(curve));
        }
        self.key(drawing, curves, Place(frame.left, frame.bottom + 3.4 * LINE));
    }

    /// Which line is whose, with its exponent.
    fn key(&self, drawing: &mut Drawing, curves: &[Curve], Place(x, mut y): Place) {
        for curve in curves {
            drawing.sample(Place(x, y - 4.0), self.color(curve));
            let mut text = curve.engine.clone();
            if let (Some(all), Some(last)) = (curve.exponent, curve.last_exponent) {
                text += &format!(": n^{all:.2}; n^{last:.2} between the last two");
            }
            drawing.small(Place(x + 36.0, y), Anchor::Start, &text);
            y += LINE;
        }
        drawing.line(Place(x, y - 4.0), Place(x + 28.0, y - 4.0), GREY);
        drawing.small(Place(x + 36.0, y), Anchor::Start, "in proportion to the bodies");
    }

    fn color(&self, curve: &Curve) -> &'static str {
        color(self.engines.iter().position(|engine| *engine == curve.engine).unwrap_or(0))
    }
}

/// Both axes with their numbers and the lines across.
fn rule(drawing: &mut Drawing, frame: Frame, across: &Axis, up: &Axis) {
    for tick in across.ticks() {
        let x = across.at(tick.value);
        drawing.line(Place(x, frame.top), Place(x, frame.bottom), PALE);
        if tick.labelled {
            drawing.small(Place(x, frame.bottom + LINE), Anchor::Middle, &number(tick.value));
        }
    }
    for tick in up.ticks() {
        let y = up.at(tick.value);
        drawing.line(Place(frame.left, y), Place(frame.right, y), PALE);
        if tick.labelled {
            drawing.small(Place(frame.left - 6.0, y + 4.0), Anchor::End, &number(tick.value));
        }
    }
    drawing.line(Place(frame.left, frame.bottom), Place(frame.right, frame.bottom), INK);
    let middle = 0.5 * (frame.left + frame.right);
    drawing.small(Place(middle, frame.bottom + 2.1 * LINE), Anchor::Middle, "bodies");
}

/// From the first curve's first point on, in proportion to the bodies as far as the panel goes.
fn proportional(curves: &[Curve], up: &Axis) -> Option<[Point; 2]> {
    let first = *curves.iter().find_map(|curve| curve.points.first())?;
    let most = curves.iter().flat_map(|curve| &curve.points).map(|point| point.bodies).max()?;
    let factor = (most as f64 / first.bodies as f64).min(up.high() / first.ms);
    let last = Point { bodies: (first.bodies as f64 * factor) as usize, ms: first.ms * factor };
    (factor > 1.0).then_some([first, last])
}
