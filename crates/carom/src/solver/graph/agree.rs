//! What is done until velocities agree.
//!
//! A sweep carries an impulse from one contact to the next, so that a tall stack needs many before all of it knows how heavy it is.
//! Every contact gets a few. What rests keeps its impulses from substep to substep, and is done then. Islands that are not, are
//! solved directly if they are small and about to rest; so are the few places at which a large one does not agree; and
//! what is left is swept on, by conjugate gradients.

use super::islands::Spread;
use super::{Graph, Wide};
use crate::solver::bundle::field;
use crate::solver::contact;
use crate::solver::direct::{self, Mobility};
use crate::solver::lanes::{LANES, Line, Row};

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

/// A bundle whose contacts do not agree yet, and where the search for their impulses is going.
struct Search {
    color: usize,
    bundle: usize,
    change: [Line; field::ROWS],
    direction: [Line; field::ROWS],
}

impl Search {
    fn new((color, bundle): (usize, usize)) -> Self {
        Self { color, bundle, change: [Line::ZERO; field::ROWS], direction: [Line::ZERO; field::ROWS] }
    }
}

/// Bodies in a patch of a large island.
const PATCH: usize = 128;

/// Sweeps between two looks at which islands agree.
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
            self.each_bundle(|bundle| contact::sweep::<Wide>(bundle, velocities));
        }
        self.find_islands(velocities.len());
        // Islands that are about to rest: no body moves fast against another.
        let quiet: Vec<bool> =
            self.spreads(velocities).iter().map(|&spread| spread <= effort.quiet).collect();
        self.solve_small(velocities, (effort, &quiet), &mobility);
        self.solve_patches(velocities, effort, &mobility);
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

    /// Sweeps the islands that do not agree yet, each up to so many times.
    fn sweep_on(&mut self, velocities: &mut [Row], effort: Effort, most: &[u32]) {
        let mut searches: Vec<Search> = self
            .order()
            .flat_map(|color| (0..self.colors[color].bundles.len()).map(move |bundle| (color, bundle)))
            .map(Search::new)
            .collect();
        let mut changed = vec![0.0; most.len()];
        let mut sweeps = effort.sweeps;
        loop {
            let mut open = self.open_islands(&searches, effort.agreement);
            open.iter_mut().zip(most).for_each(|(open, &most)| *open &= sweeps < most);
            searches.retain(|search| {
                let bundle = &self.colors[search.color].bundles[search.bundle];
                (0..LANES).any(|lane| self.island_of(bundle, lane).is_some_and(|island| open[island]))
            });
            if searches.is_empty() {
                return;
            }
            for _ in 1..ROUND {
                self.search(velocities, &mut searches, &mut changed);
            }
            for search in &searches {
                contact::sweep::<Wide>(&mut self.colors[search.color].bundles[search.bundle], velocities);
            }
            sweeps += ROUND;
        }
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
            let residual = self.solve_at_once(members, velocities, effort, &mobility);
            self.islands.pauses[island] = if residual <= effort.exactness { 0 } else { PAUSE };
        }
    }

    /// Solves some contacts directly, with all bodies as they are that `mobility` knows nothing of; returns how far they were
    /// from agreeing in the end, and takes the result if that is near enough.
    fn solve_at_once(
        &mut self,
        members: &[(usize, usize)],
        velocities: &mut [Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) -> f32 {
        let mut small = direct::Island::default();
        for &(color, lane) in members {
            let bundle = &self.colors[color].bundles[lane / LANES];
            small.add(bundle, lane % LANES, velocities, &mobility);
        }
        let residual = small.solve(f64::from(effort.exactness)) as f32;
        if residual > effort.agreement {
            return residual;
        }
        small.write(velocities);
        for (number, &(color, lane)) in members.iter().enumerate() {
            let bundle = &mut self.colors[color].bundles[lane / LANES];
            for (line, impulse) in field::IMPULSES.into_iter().zip(small.impulses(number)) {
                bundle.lines[line].0[lane % LANES] = impulse;
            }
            bundle.lines[field::RESIDUAL].0[lane % LANES] = 0.0;
        }
        residual
    }

    /// Solves the places directly at which large islands do not agree, where these are few: the bodies there and their
    /// neighbours, with all others as they are.
    fn solve_patches(
        &mut self,
        velocities: &mut [Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) {
        let mut contacts_of: Vec<Vec<(usize, usize)>> = vec![Vec::new(); velocities.len()];
        let mut patch: Vec<u32> = Vec::new();
        let mut in_patch = vec![false; velocities.len()];
        for color in self.order() {
            for lane in 0..self.colors[color].contacts.len() {
                let bundle = &self.colors[color].bundles[lane / LANES];
                let is_large = |island: usize| self.islands.bodies[island] > direct::BODIES;
                if !self.island_of(bundle, lane % LANES).is_some_and(is_large) {
                    continue;
                }
                let is_open = bundle.get(lane % LANES, field::RESIDUAL) > effort.agreement;
                for row in [bundle.a[lane % LANES], bundle.b[lane % LANES]] {
                    contacts_of[row as usize].push((color, lane));
                    if is_open && !in_patch[row as usize] && mobility(row).is_some() {
                        in_patch[row as usize] = true;
                        patch.push(row);
                    }
                }
            }
        }
        if patch.is_empty() || patch.len() > PATCH / 2 {
            return;
        }
        let mut spread = Spread::NONE;
        let mut next = 0;
        while let Some(&row) = patch.get(next).filter(|_| patch.len() < PATCH) {
            next += 1;
            spread.include(&velocities[row as usize]);
            for &(color, lane) in &contacts_of[row as usize] {
                let bundle = &self.colors[color].bundles[lane / LANES];
                for row in [bundle.a[lane % LANES], bundle.b[lane % LANES]] {
                    if !in_patch[row as usize] && mobility(row).is_some() {
                        in_patch[row as usize] = true;
                        patch.push(row);
                    }
                }
            }
        }
        if spread.width() > effort.quiet {
            return;
        }
        let mut members: Vec<(usize, usize)> =
            patch.iter().flat_map(|&row| contacts_of[row as usize].iter().copied()).collect();
        members.sort_unstable();
        members.dedup();
        self.solve_at_once(&members, velocities, effort, |row| {
            if in_patch[row as usize] { mobility(row) } else { None }
        });
    }

    /// One sweep, and a step further in the direction in which sweeps have been going: nonsmooth nonlinear conjugate gradients
    /// (Silcowitz, Niebe and Erleben 2010), with the change of kinetic energy as the norm, island by island.
    ///
    /// A tall stack bends like a beam: plain sweeps would need the fourth power of its height, these about its square.
    fn search(&mut self, velocities: &mut [Row], searches: &mut [Search], changed: &mut [f64]) {
        let mut changes = vec![0.0; changed.len()];
        for search in searches.iter_mut() {
            let bundle = &mut self.colors[search.color].bundles[search.bundle];
            let before = field::IMPULSES.map(|line| bundle.lines[line]);
            contact::sweep::<Wide>(bundle, velocities);
            search.change = std::array::from_fn(|row| {
                let after = bundle.lines[field::IMPULSES[row]].0;
                Line(std::array::from_fn(|lane| after[lane] - before[row].0[lane]))
            });
        }
        for search in searches.iter() {
            let bundle = &self.colors[search.color].bundles[search.bundle];
            for lane in 0..LANES {
                let Some(island) = self.island_of(bundle, lane) else { continue };
                for (change, mass) in search.change.iter().zip(field::MASSES) {
                    let (change, mass) = (f64::from(change.0[lane]), f64::from(bundle.lines[mass].0[lane]));
                    changes[island] += if mass > 0.0 { change * change / mass } else { 0.0 };
                }
            }
        }
        for search in searches {
            let place = (search.color, search.bundle);
            let bundle = &self.colors[place.0].bundles[place.1];
            let share: [f32; LANES] = std::array::from_fn(|lane| {
                let Some(island) = self.island_of(bundle, lane) else { return 0.0 };
                let share = changes[island] / changed[island];
                if share < 1.0 { share as f32 } else { 0.0 }
            });
            let step: [Line; field::ROWS] = std::array::from_fn(|row| {
                let direction = search.direction[row].0;
                Line(std::array::from_fn(|lane| share[lane] * direction[lane]))
            });
            search.direction = std::array::from_fn(|row| {
                Line(std::array::from_fn(|lane| step[row].0[lane] + search.change[row].0[lane]))
            });
            contact::nudge::<Wide>(&mut self.colors[place.0].bundles[place.1], velocities, &step);
        }
        changed.copy_from_slice(&changes);
    }

    /// Which islands do not agree.
    fn open_islands(&self, searches: &[Search], agreement: f32) -> Vec<bool> {
        let mut open = vec![false; self.islands.sizes.len()];
        for search in searches {
            let bundle = &self.colors[search.color].bundles[search.bundle];
            for (lane, &residual) in bundle.lines[field::RESIDUAL].0.iter().enumerate() {
                if residual > agreement
                    && let Some(island) = self.island_of(bundle, lane)
                {
                    open[island] = true;
                }
            }
        }
        open
    }
}
