//! A panel for each scene, in it a group of bars for each number of threads. Every panel has its own axis from 0.

use super::axis::Axis;
use super::drawing::{Anchor, Drawing, Place, color};
use super::{Frame, Grid, LINE, MARGIN, WIDTH, engines, scenes, vertical_axis};
use crate::report::threads;
use crate::rounds::{Case, Results};
use crate::table::short;

/// How much of the space for a bar it fills.
const FILLED: f64 = 0.8;
/// No bar is wider, pixels.
const WIDEST: f64 = 44.0;
/// A number above a bar has this much space, so that it does not run into the next one, pixels.
const NUMBER: f64 = 33.0;
/// Share of a group's space that its bars have; what a panel needs to their left and right, pixels.
const GROUP: f64 = 0.9;
const SIDES: [f64; 2] = [44.0, 16.0];

/// Draws below `top`; returns where it ends.
pub fn draw(drawing: &mut Drawing, results: &Results, top: f64) -> f64 {
    let (engines, scenes) = (engines(results), scenes(results));
    let mut x = MARGIN;
    for (index, engine) in engines.iter().enumerate() {
        drawing.swatch(Place(x, top - 10.0), color(index));
        drawing.text(Place(x + 18.0, top), Anchor::Start, engine);
        x += 110.0;
    }
    let groups = scenes.iter().map(|scene| results.cases.iter().filter(|case| case.scene == *scene).count());
    let columns = columns(groups.max().unwrap_or(0) * engines.len());
    let grid = Grid { top: top + 22.0, columns: scenes.len().clamp(1, columns), height: 250.0 };
    for (index, scene) in scenes.iter().enumerate() {
        let cases: Vec<&Case> = results.cases.iter().filter(|case| case.scene == *scene).collect();
        panel(drawing, grid.cell(index), &engines, &cases);
    }
    grid.bottom(scenes.len())
}

/// So many panels side by side, three at most, leave each of a panel's bars enough space.
fn columns(bars: usize) -> usize {
    let least = bars as f64 * NUMBER / GROUP + SIDES.iter().sum::<f64>();
    (((WIDTH - 2.0 * MARGIN) / least) as usize).clamp(1, 3)
}

/// One scene.
fn panel(drawing: &mut Drawing, cell: Frame, engines: &[&str], cases: &[&Case]) {
    drawing.heading(Place(cell.left, cell.top + 14.0), &cases[0].scene);
    drawing.small(Place(cell.left, cell.top + 14.0 + LINE), Anchor::Start, &subtitle(cases));
    let frame = Frame {
        left: cell.left + SIDES[0],
        top: cell.top + 58.0,
        right: cell.right - SIDES[1],
        bottom: cell.bottom - 44.0,
    };
    let summaries = cases.iter().flat_map(|case| &case.entrants).filter_map(|e| e.summary.as_ref());
    let high = summaries.map(|summary| summary.least).fold(0.0, f64::max);
    let axis = Axis::from_zero(high, [frame.bottom, frame.top]);
    vertical_axis(drawing, frame, &axis);
    let group = (frame.right - frame.left) / cases.len() as f64;
    for (index, case) in cases.iter().enumerate() {
        let middle = frame.left + (index as f64 + 0.5) * group;
        drawing.small(Place(middle, frame.bottom + LINE), Anchor::Middle, &threads(case.threads));
        bars(drawing, case, engines, &Group { middle, width: GROUP * group, axis: &axis });
    }
}

/// What the panel's numbers are, and of how much.
fn subtitle(cases: &[&Case]) -> String {
    let mut measurements = cases.iter().flat_map(|case| &case.entrants).filter_map(|entrant| entrant.first());
    measurements.next().map_or("no result".to_string(), |first| {
        format!("ms a step; {} bodies, {} steps", super::axis::number(first.bodies as f64), first.steps)
    })
}

/// Where the bars of one case stand.
struct Group<'a> {
    middle: f64,
    width: f64,
    axis: &'a Axis,
}

/// One case: a bar for each engine, its time above it.
fn bars(drawing: &mut Drawing, case: &Case, engines: &[&str], group: &Group) {
    let space = group.width / engines.len() as f64;
    let space = space.min(WIDEST / FILLED);
    let first = group.middle - 0.5 * space * (engines.len() - 1) as f64;
    let foot = group.axis.at(0.0);
    for entrant in &case.entrants {
        let Some(summary) = &entrant.summary else { continue };
        let index = engines.iter().position(|engine| *engine == entrant.engine).unwrap_or(0);
        let (x, y) = (first + index as f64 * space, group.axis.at(summary.least));
        drawing.bar(Place(x, foot), [FILLED * space, foot - y], color(index));
        let mark = if summary.whole() { "" } else { "*" };
        drawing.small(Place(x, y - 4.0), Anchor::Middle, &(short(summary.least) + mark));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_bars_get_wide_panels() {
        assert_eq!([1, 5, 6, 8, 20].map(columns), [3, 3, 3, 2, 1]);
    }
}
