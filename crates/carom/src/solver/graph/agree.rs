//! What is done until velocities agree.
//!
//! A sweep carries an impulse from one contact to the next, so that a tall stack needs many before all of it knows how heavy it is.
//! Every contact gets a few. What rests keeps its impulses from substep to substep, and is done then. Islands that are not, are
//! solved directly if they are small and about to rest. What is left is swept on, there where velocities still change.
//!
//! Conjugate gradients over sweeps (Silcowitz, Niebe and Erleben 2010) carry further, but overshoot where many contacts come
//! and go: piles that plain sweeps bring to rest went on shaking with them.

use super::Graph;
use crate::solver::bundle::{Bundle, field};
use crate::solver::direct::{self, Mobility};
use crate::solver::kernels::{Sweep, SweepSome};
use crate::solver::lanes::{LANES, Row};

/// How far islands are swept.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// An island is done when a sweep changes no velocity by more than this, m/s.
    pub agreement: f32,
    /// A small one that is solved directly, when nothing is further than this from what it asks for, m/s.
    pub exactness: f32,
    /// Bodies of an island that move no faster against each other than this are about to rest, and worth the effort, m/s.
    pub quiet: f32,
    /// Sweeps that every contact gets.
    pub sweeps: u32,
    /// Sweeps that an island in motion may take.
    pub in_motion: u32,
    /// Sweeps times contacts that a quiet island may take, before it has to go on in the next substep.
    pub budget: u32,
}

/// Sweeps between two looks at which bodies agree.
const ROUND: u32 = 4;

/// Substeps to wait before an island that could not be solved directly is tried again.
const PAUSE: u32 = 16;

impl Graph {
    /// Sweeps until velocities agree, island by island. `mobility` tells of a row how impulses move it, if they do.
    pub fn solve(
        &mut self,
        velocities: &mut [Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) {
        for _ in 0..effort.sweeps {
            self.each_color(|machine, bundles| machine.run(Sweep { bundles, velocities }));
        }
        self.find_islands(velocities.len());
        // Islands that are about to rest: no body moves fast against another.
        let quiet: Vec<bool> =
            self.spreads(velocities).iter().map(|&spread| spread <= effort.quiet).collect();
        self.solve_small(velocities, (effort, &quiet), &mobility);
        let sizes = self.islands.sizes.iter().zip(&quiet);
        let most: Vec<u32> =
            sizes
                .map(|(&size, &is_quiet)| {
                    if is_quiet {
                        effort.in_motion.max(effort.budget / size.max(1))
                    } else {
                        effort.in_motion
                    }
                })
                .collect();
        self.sweep_on(velocities, effort, &most);
    }

    /// Sweeps on where velocities do not agree yet, in each island up to so many times: over the contacts of the bodies
    /// concerned, and of their neighbours. Without these, what is passed on to a neighbour would wait for the next look.
    fn sweep_on(&mut self, velocities: &mut [Row], effort: Effort, most: &[u32]) {
        let mut sweeps = effort.sweeps;
        loop {
            let open = self.open_bodies(velocities.len(), effort.agreement, |island| sweeps < most[island]);
            let is_open = self.with_neighbors(&open);
            let concerned =
                |bundle: &Bundle| bundle.a.iter().chain(&bundle.b).any(|&row| is_open[row as usize]);
            let chosen: Vec<(usize, Vec<usize>)> = self
                .order()
                .map(|color| {
                    let bundles = self.colors[color].bundles.iter().enumerate();
                    (color, bundles.filter(|(_, it)| concerned(it)).map(|(index, _)| index).collect())
                })
                .filter(|(_, chosen): &(usize, Vec<usize>)| !chosen.is_empty())
                .collect();
            if chosen.is_empty() {
                return;
            }
            for _ in 0..ROUND {
                for (color, chosen) in &chosen {
                    let bundles = &mut self.colors[*color].bundles;
                    self.machine.run(SweepSome { bundles, chosen, velocities });
                }
            }
            sweeps += ROUND;
        }
    }

    /// The bodies that a contact does not agree about, in islands that may be swept on.
    fn open_bodies(&self, rows: usize, agreement: f32, may_go_on: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut is_open = vec![false; rows];
        for bundle in self.colors.iter().flat_map(|color| &color.bundles) {
            for (lane, &residual) in bundle.lines[field::RESIDUAL].0.iter().enumerate() {
                if residual > agreement {
                    for row in [bundle.a[lane], bundle.b[lane]] {
                        is_open[row as usize] |= self.islands.of(row).is_some_and(&may_go_on);
                    }
                }
            }
        }
        is_open
    }

    /// These bodies, and those that they touch.
    fn with_neighbors(&self, bodies: &[bool]) -> Vec<bool> {
        let mut result = bodies.to_vec();
        for bundle in self.colors.iter().flat_map(|color| &color.bundles) {
            for (&a, &b) in bundle.a.iter().zip(&bundle.b) {
                if bodies[a as usize] != bodies[b as usize] {
                    for row in [a, b] {
                        result[row as usize] |= self.islands.of(row).is_some();
                    }
                }
            }
        }
        result
    }

    /// Solves those small quiet islands directly whose velocities do not agree after the first sweeps.
    fn solve_small(
        &mut self,
        velocities: &mut [Row],
        (effort, quiet): (Effort, &[bool]),
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) {
        let mut members: Vec<Vec<(usize, usize)>> = vec![Vec::new(); quiet.len()];
        let mut is_open = vec![false; quiet.len()];
        for color in self.order() {
            for lane in 0..self.colors[color].contacts.len() {
                let bundle = &self.colors[color].bundles[lane / LANES];
                let Some(island) = self.island_of(bundle, lane % LANES) else { continue };
                if quiet[island] && self.islands.bodies[island] <= direct::BODIES {
                    members[island].push((color, lane));
                    is_open[island] |= bundle.get(lane % LANES, field::RESIDUAL) > effort.exactness;
                }
            }
        }
        for (island, members) in members.iter().enumerate().filter(|(island, _)| is_open[*island]) {
            if self.islands.pauses[island] > 0 {
                self.islands.pauses[island] -= 1;
                continue;
            }
            let is_solved = self.solve_at_once(members, velocities, effort, &mobility);
            self.islands.pauses[island] = if is_solved { 0 } else { PAUSE };
        }
    }

    /// Solves the contacts of an island directly, if that leads to an exact solution; whether it did.
    /// Otherwise nothing changes: where more rows press than bodies can move, what is nearly a solution may hold huge
    /// impulses that cancel, and do so no longer in the next substep.
    fn solve_at_once(
        &mut self,
        members: &[(usize, usize)],
        velocities: &mut [Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) -> bool {
        let mut small = direct::Island::default();
        for &(color, lane) in members {
            let bundle = &self.colors[color].bundles[lane / LANES];
            small.add(bundle, lane % LANES, velocities, &mobility);
        }
        if !small.solve(f64::from(effort.exactness)) {
            return false;
        }
        small.write(velocities);
        for (number, &(color, lane)) in members.iter().enumerate() {
            let bundle = &mut self.colors[color].bundles[lane / LANES];
            for (line, impulse) in field::IMPULSES.into_iter().zip(small.impulses(number)) {
                bundle.lines[line].0[lane % LANES] = impulse;
            }
            bundle.lines[field::RESIDUAL].0[lane % LANES] = 0.0;
        }
        true
    }
}
