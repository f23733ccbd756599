//! What is done until velocities agree.
//!
//! A sweep carries an impulse from one contact to the next, so that a tall stack needs many before all of it knows how heavy it is.
//! Every contact gets a few. What rests keeps its impulses from substep to substep, and is done then. Islands that are not, are
//! solved directly if they are small and about to rest. What is left is swept on, there where velocities still change.
//!
//! Conjugate gradients over sweeps (Silcowitz, Niebe and Erleben 2010) carry further, but overshoot where many contacts come
//! and go: piles that plain sweeps bring to rest went on shaking with them.

use super::islands::{Islands, NONE, Pause};
use super::passes::{Chosen, GLANCES, Spot};
use super::{Color, Graph};
use crate::solver::bundle::{Bundle, field};
use crate::solver::direct::{self, Mobility};
use crate::solver::lanes::{LANES, Row};
use crate::step::profile::{self, Phase};

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

/// Bundles of each colour that may have to be swept on, by their indices, ascending.
type Candidates = Vec<Vec<u32>>;

/// Sweeps between two looks at which bodies agree.
const ROUND: u32 = 4;

/// Substeps to wait before an island that could not be solved directly is tried again. One of more than so many bodies, for which that
/// takes long, has to wait twice as long each time, up to a limit: piles are not to be solved, and go on not to be.
const PAUSE: u32 = 16;
const PATIENT: usize = 256;
const LONGEST_PAUSE: u32 = 1024;

/// Contacts from which on islands that are solved directly are shared out among the threads.
const WORTH_SHARING: usize = 64;

impl Graph {
    /// Sweeps until velocities agree, island by island. `mobility` tells of a row how impulses move it, if they do.
    pub fn solve(
        &mut self,
        velocities: &mut [Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility> + Sync,
    ) {
        (1..effort.sweeps).for_each(|_| drop(self.sweep(velocities, None, f32::INFINITY)));
        let open = self.sweep(velocities, None, effort.exactness.min(effort.agreement));
        self.find_islands(velocities.len());
        if open.is_empty() {
            return;
        }
        // Islands that are about to rest: no body moves fast against another.
        let quiet: Vec<bool> =
            self.spreads(velocities).iter().map(|spread| spread.width() <= effort.quiet).collect();
        self.solve_small(velocities, (effort, &quiet, &open), mobility);
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
        self.sweep_on(velocities, (effort, &most), open);
    }

    /// Sweeps on where velocities do not agree yet, in each island up to so many times: over the contacts of the bodies
    /// concerned, and of their neighbours. Without these, what is passed on to a neighbour would wait for the next look.
    ///
    /// Only bundles that the last sweep has left `open` can be so now: what it left out it did because nothing there was, or
    /// because no more sweeps are due to its island. So when all islands in motion have had theirs, the bundles of the few that go on
    /// are all that has to be looked through.
    fn sweep_on(&mut self, velocities: &mut [Row], (effort, most): (Effort, &[u32]), mut open: Vec<Spot>) {
        let mut sweeps = effort.sweeps;
        let mut candidates: Candidates =
            self.colors.iter().map(|color| (0..color.bundles.len() as u32).collect()).collect();
        loop {
            let may_go_on = |island: usize| sweeps < most[island];
            let bodies = self.open_bodies(velocities.len(), (&open, effort.agreement), may_go_on);
            if !bodies.contains(&true) {
                return;
            }
            if sweeps >= effort.in_motion {
                self.keep_islands(&bodies, &mut candidates);
            }
            let chosen = self.choose(&self.with_neighbors(&bodies, &candidates), &candidates);
            (1..ROUND).for_each(|_| drop(self.sweep(velocities, Some(&chosen), f32::INFINITY)));
            open = self.sweep(velocities, Some(&chosen), effort.agreement);
            sweeps += ROUND;
        }
    }

    /// The bodies that a contact does not agree about, in islands that may be swept on.
    fn open_bodies(
        &self,
        rows: usize,
        (open, agreement): (&[Spot], f32),
        may_go_on: impl Fn(usize) -> bool,
    ) -> Vec<bool> {
        let mut is_open = vec![false; rows];
        for &(color, index) in open {
            let bundle = &self.colors[color].bundles[index];
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

    /// Keeps those of the candidates that have a contact of an island with one of these bodies.
    fn keep_islands(&self, bodies: &[bool], candidates: &mut Candidates) {
        let mut is_open = vec![false; self.islands.sizes.len()];
        for (row, _) in bodies.iter().enumerate().filter(|(_, is_open)| **is_open) {
            if let Some(island) = self.islands.of(row as u32) {
                is_open[island] = true;
            }
        }
        for (Color { bundles, .. }, candidates) in self.colors.iter().zip(candidates) {
            candidates.retain(|&index| {
                let bundle = &bundles[index as usize];
                (0..LANES).any(|lane| self.island_of(bundle, lane).is_some_and(|island| is_open[island]))
            });
        }
    }

    /// These bodies, and those that they touch, by contacts of the candidates.
    fn with_neighbors(&self, bodies: &[bool], candidates: &Candidates) -> Vec<bool> {
        let mut result = bodies.to_vec();
        for (Color { bundles, .. }, candidates) in self.colors.iter().zip(candidates) {
            let found = self.pool.ranges(candidates.len(), GLANCES, |range| {
                let bundles = candidates[range].iter().map(|&index| &bundles[index as usize]);
                let lanes = bundles.flat_map(|bundle| bundle.a.into_iter().zip(bundle.b));
                let reached = lanes.filter(|&(a, b)| bodies[a as usize] != bodies[b as usize]);
                reached.flat_map(|(a, b)| [a, b]).collect::<Vec<u32>>()
            });
            for row in found.into_iter().flatten() {
                result[row as usize] |= self.islands.of(row).is_some();
            }
        }
        result
    }

    /// Those of the candidates with a contact of these bodies.
    fn choose(&self, bodies: &[bool], candidates: &Candidates) -> Vec<Chosen> {
        let concerned = |bundle: &Bundle| bundle.a.iter().chain(&bundle.b).any(|&row| bodies[row as usize]);
        let of_color = |(Color { bundles, .. }, candidates): (&Color, &Vec<u32>)| {
            let stretches = self.pool.ranges(candidates.len(), GLANCES, |range| {
                let indices = candidates[range].iter().copied();
                indices.filter(|&index| concerned(&bundles[index as usize])).collect::<Vec<u32>>()
            });
            let mut chosen = Chosen { is_chosen: vec![false; bundles.len()], count: 0 };
            for index in stretches.into_iter().flatten() {
                chosen.is_chosen[index as usize] = true;
                chosen.count += 1;
            }
            chosen
        };
        self.colors.iter().zip(candidates).map(of_color).collect()
    }

    /// Solves those small quiet islands directly whose velocities do not agree after the first sweeps, which has left these bundles
    /// `open`. Islands share no body that can be moved, so that each is solved for itself.
    fn solve_small(
        &mut self,
        velocities: &mut [Row],
        (effort, quiet, open): (Effort, &[bool], &[Spot]),
        mobility: impl Fn(u32) -> Option<Mobility> + Sync,
    ) {
        let _phase = profile::phase(Phase::Direct);
        let mut is_due = vec![false; quiet.len()];
        for &(color, index) in open {
            let bundle = &self.colors[color].bundles[index];
            for lane in (0..LANES).filter(|&lane| bundle.get(lane, field::RESIDUAL) > effort.exactness) {
                if let Some(island) = self.island_of(bundle, lane) {
                    is_due[island] |= quiet[island] && self.islands.bodies[island] <= direct::BODIES;
                }
            }
        }
        let Islands { of_row, pauses, .. } = &mut self.islands;
        let mut is_paused = vec![false; is_due.len()];
        for (&island, pause) in of_row.iter().zip(pauses).filter(|(_, pause)| pause.left > 0) {
            if island != NONE && is_due[island as usize] {
                is_paused[island as usize] = true;
                pause.left -= 1;
            }
        }
        is_due.iter_mut().zip(is_paused).for_each(|(is_due, is_paused)| *is_due &= !is_paused);
        let due = self.members(&is_due);
        let contacts: usize = due.iter().map(|(_, members)| members.len()).sum();
        let grain = if contacts < WORTH_SHARING { due.len() } else { 1 };
        let solved = self
            .pool
            .map(&due, grain, |(_, members)| self.solve_at_once(members, velocities, effort, &mobility));
        for ((island, members), solved) in due.into_iter().zip(solved) {
            self.pause((island, &members), solved.is_some());
            if let Some(solved) = solved {
                solved.write(velocities);
                self.take_over(&members, &solved);
            }
        }
    }

    /// The contacts of each of some islands, by colour and lane.
    pub(super) fn members(&self, is_wanted: &[bool]) -> Vec<(usize, Vec<Spot>)> {
        if !is_wanted.contains(&true) {
            return Vec::new();
        }
        let mut members = vec![Vec::new(); is_wanted.len()];
        for color in self.order() {
            for lane in 0..self.colors[color].contacts.len() {
                let bundle = &self.colors[color].bundles[lane / LANES];
                if let Some(island) = self.island_of(bundle, lane % LANES).filter(|&it| is_wanted[it]) {
                    members[island].push((color, lane));
                }
            }
        }
        members.into_iter().enumerate().filter(|(island, _)| is_wanted[*island]).collect()
    }

    /// Solves the contacts of an island directly, if that leads to an exact solution. No other is of any use: where more rows
    /// press than bodies can move, what is nearly a solution may hold huge impulses that cancel, and do so no longer in the next
    /// substep.
    fn solve_at_once(
        &self,
        members: &[Spot],
        velocities: &[Row],
        effort: Effort,
        mobility: impl Fn(u32) -> Option<Mobility>,
    ) -> Option<direct::Island> {
        let mut small = direct::Island::with_room(members.len());
        for &(color, lane) in members {
            let bundle = &self.colors[color].bundles[lane / LANES];
            small.add(bundle, lane % LANES, velocities, &mobility);
        }
        small.solve(f64::from(effort.exactness)).then_some(small)
    }

    /// Lets the bodies of an island be for a while if it was not to be solved. That is kept body by body, since islands change whenever a
    /// contact comes or goes, as with all that rolls.
    pub(super) fn pause(&mut self, (island, members): (usize, &[Spot]), is_solved: bool) {
        let Self { colors, islands, .. } = self;
        let rows = members.iter().flat_map(|&(color, lane)| {
            let bundle = &colors[color].bundles[lane / LANES];
            [bundle.a[lane % LANES] as usize, bundle.b[lane % LANES] as usize]
        });
        let rows = rows.filter(|&row| islands.of_row[row] != NONE);
        let before = rows.clone().map(|row| islands.pauses[row].length).max().unwrap_or(0);
        let length = match is_solved {
            true => 0,
            false if islands.bodies[island] > PATIENT => (2 * before).clamp(PAUSE, LONGEST_PAUSE),
            false => PAUSE,
        };
        for row in rows {
            islands.pauses[row] = Pause { left: length, length };
        }
    }

    /// Gives the contacts of an island the impulses found.
    fn take_over(&mut self, members: &[Spot], solved: &direct::Island) {
        for (number, &(color, lane)) in members.iter().enumerate() {
            let bundle = &mut self.colors[color].bundles[lane / LANES];
            for (line, impulse) in field::IMPULSES.into_iter().zip(solved.impulses(number)) {
                bundle.lines[line].0[lane % LANES] = impulse;
            }
            bundle.lines[field::RESIDUAL].0[lane % LANES] = 0.0;
        }
    }
}
