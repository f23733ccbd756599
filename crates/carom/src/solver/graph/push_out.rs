//! Overlaps pushed out: sweeps over the normals that find displacements, in place of velocities.
//!
//! A sweep changes nothing where nothing overlaps and no body has been displaced since the last one. So it leaves that out: what few
//! overlaps a large world has cost no pass over all of it, nor do those that are out soon.

use super::passes::{GRAIN, Spot};
use super::wrench::{Find, Which};
use super::{Graph, Wrenches};
use crate::bodies::WORLD_ROW;
use crate::room::Room;
use crate::solver::bundle::{Bundle, POINTS, field};
use crate::solver::kernels::SweepNormals;
use crate::solver::lanes::{LANES, Line, Row};
use crate::solver::rows::SharedRows;

/// Sweeps that push overlaps out, at most.
const SWEEPS: u32 = 12;

/// A displacement below this share of the overlap that may stay is none that others have to be told of.
const NOTHING: f32 = 0.02;

/// How far overlaps are pushed out.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Overlaps up to here stay, m.
    pub allowed: f32,
    /// What is more than this (m) is pushed out, by a `share` of it.
    pub left: f32,
    pub share: f32,
}

impl Limits {
    fn finds_overlap(&self, bundle: &Bundle) -> bool {
        bundle.lines[field::GAP].0.iter().any(|&gap| gap < -self.allowed)
    }
}

/// How far overlaps have been pushed through a graph. Passes over a colour are counted from 1 on.
struct Reach {
    pass: u32,
    /// The last pass that went through each bundle of each colour, and that displaced each row; 0 for none.
    swept: Vec<Vec<u32>>,
    displaced: Vec<u32>,
    /// Which bundles of a colour the present pass goes through.
    is_due: Vec<bool>,
    /// Those that any has gone through, and the impulses that their points had before.
    drawn: Vec<Spot>,
    impulses: Vec<[Line; POINTS]>,
}

impl Graph {
    /// Finds displacements for all overlaps, into rows that hold none yet. And tells which contact pushes how: displacements times
    /// masses, in place of impulses (kg·m).
    pub fn push_out(&mut self, displacements: &mut [Row], limits: Limits, wrenches: &mut Wrenches) {
        wrenches.begin(false);
        let bundles = self.colors.iter().flat_map(|color| &color.bundles);
        let overlapping = bundles.filter(|bundle| limits.finds_overlap(bundle)).count();
        if overlapping == 0 {
            return;
        }
        let mut reach = Reach {
            pass: 0,
            swept: self.colors.iter().map(|color| vec![0; color.bundles.len()]).collect(),
            displaced: vec![0; displacements.len()],
            is_due: Vec::new(),
            drawn: Vec::with_capacity(overlapping),
            impulses: Vec::with_capacity(overlapping),
        };
        for _ in 0..SWEEPS {
            for color in self.order() {
                reach.pass += 1;
                let due = self.draw(color, &mut reach, limits);
                if due > 0 {
                    self.displace(color, displacements, (&mut reach, due), NOTHING * limits.allowed);
                }
            }
        }
        for ((color, index), impulses) in reach.drawn.into_iter().zip(reach.impulses) {
            let contacts = self.contacts_of((color, index));
            let bundles = std::slice::from_ref(&self.colors[color].bundles[index]);
            let (rows, found) = (&*displacements, &mut *wrenches);
            self.machine.run(Find { bundles, contacts, rows, found, which: Which::Normal });
            let bundle = &mut self.colors[color].bundles[index];
            for (point, line) in impulses.into_iter().enumerate() {
                bundle.lines[field::of_point(point, field::IMPULSE)] = line;
            }
        }
    }

    /// Finds the bundles of a colour that overlap or hold what has been displaced since they were last swept; how many there are.
    fn draw(&mut self, color: usize, reach: &mut Reach, limits: Limits) -> usize {
        let Reach { pass, swept, displaced, is_due, drawn, impulses } = reach;
        is_due.clear();
        for (index, bundle) in self.colors[color].bundles.iter_mut().enumerate() {
            let last = &mut swept[color][index];
            let mut rows = bundle.a.iter().chain(&bundle.b);
            let is_moved = rows.any(|&row| displaced[row as usize] >= (*last).max(1));
            let is_new = *last == 0 && (is_moved || limits.finds_overlap(bundle));
            is_due.push(is_moved || is_new);
            if is_new {
                drawn.put((color, index));
                impulses.put(begin(bundle, limits));
            }
            if is_moved || is_new {
                *last = *pass;
            }
        }
        is_due.iter().filter(|is_due| **is_due).count()
    }

    /// Goes through those of a colour; what moves by more than `nothing` (m) is displaced.
    fn displace(
        &mut self,
        color: usize,
        displacements: &mut [Row],
        (reach, due): (&mut Reach, usize),
        nothing: f32,
    ) {
        let bundles = &mut self.colors[color].bundles;
        let (machine, grain) = (self.machine, GRAIN * bundles.len() / due);
        let Reach { pass, displaced, is_due, .. } = reach;
        let shared = SharedRows::new(displacements);
        self.pool.chunks(bundles, grain, |first, bundles| {
            let chosen = &is_due[first..first + bundles.len()];
            machine.run(SweepNormals { bundles, chosen, displacements: shared });
        });
        for (bundle, _) in bundles.iter().zip(is_due).filter(|(_, is_due)| **is_due) {
            for lane in (0..LANES).filter(|&lane| bundle.get(lane, field::RESIDUAL) > nothing) {
                displaced[bundle.a[lane] as usize] = *pass;
                displaced[bundle.b[lane] as usize] = *pass;
            }
        }
        // The world's row goes nowhere.
        displaced[WORLD_ROW] = 0;
    }
}

/// Has the points of a bundle ask for displacements, and starts from none; comes to the impulses that they had.
fn begin(bundle: &mut Bundle, limits: Limits) -> [Line; POINTS] {
    let wanted = |separation: f32| {
        let overlap = -separation;
        if overlap > limits.allowed { limits.share * (overlap - limits.left) } else { overlap.min(0.0) }
    };
    [0, 1, 2, 3].map(|point| {
        let at = |line: usize| field::of_point(point, line);
        bundle.lines[at(field::LEAST)] = Line(bundle.lines[at(field::SEPARATION)].0.map(wanted));
        std::mem::replace(&mut bundle.lines[at(field::IMPULSE)], Line::ZERO)
    })
}
