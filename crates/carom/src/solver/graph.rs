//! All contacts of a world, coloured.
//!
//! Two contacts of one *colour* share no body that can be moved, so that the lanes of a bundle, and the bundles of a colour,
//! have nothing to do with each other: the result does not depend on how many are computed at once. Contacts between two
//! bodies that move come first, those with the ground last, so that in doubt nothing is pushed into the ground.
//!
//! Bodies that contacts connect make an *island*. A sweep carries an impulse from one contact to the next, so that a tall
//! stack needs many before all of it knows how heavy it is. Islands whose velocities still change go on being swept while the
//! others are done: what rests keeps its impulses from substep to substep and is done at once.

use super::bundle::{Bundle, Lane, POINTS, field};
use super::contact;
use super::direct::{self, Mobility};
use super::lanes::{LANES, Line, Portable, Row};

/// The lanes that a plain build computes with.
type Wide = Portable<4>;

/// Names a contact as long as it lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ContactId(u32);

/// Where a contact is.
#[derive(Clone, Copy, Debug)]
struct Place {
    color: usize,
    lane: usize,
}

/// Contacts that share no body that can be moved.
#[derive(Default)]
struct Color {
    bundles: Vec<Bundle>,
    /// The contact of each lane.
    contacts: Vec<u32>,
    /// Whether the body of a row has a contact of this colour, 64 rows to a word.
    taken: Vec<u64>,
}

impl Color {
    fn is_taken(&self, row: u32) -> bool {
        self.taken.get(row as usize / 64).is_some_and(|word| word >> (row % 64) & 1 == 1)
    }

    fn mark(&mut self, row: u32, taken: bool) {
        let word = row as usize / 64;
        if word >= self.taken.len() {
            self.taken.resize(word + 1, 0);
        }
        let bit = 1 << (row % 64);
        self.taken[word] = if taken { self.taken[word] | bit } else { self.taken[word] & !bit };
    }
}

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

/// Contacts with whom the world's row, or what is driven, is one side.
const FIXED: usize = 1;
const MOVING: usize = 0;

/// Every so many colours of contacts between moving bodies there is one of the other kind: `color % 2` tells which.
const KINDS: usize = 2;

/// All contacts.
#[derive(Default)]
pub(crate) struct Graph {
    /// Even: between bodies that move. Odd: with what does not.
    colors: Vec<Color>,
    places: Vec<Option<Place>>,
    free: Vec<u32>,
    islands: Islands,
}

/// Which contacts hang together.
#[derive(Default)]
struct Islands {
    is_stale: bool,
    /// The island of each row.
    of_row: Vec<u32>,
    /// Contacts and bodies in each island.
    sizes: Vec<u32>,
    bodies: Vec<usize>,
    /// For how many more substeps each island is not worth a direct solve: the last one led nowhere.
    pauses: Vec<u32>,
}

/// The box around the velocities of an island's bodies.
#[derive(Clone, Copy)]
struct Spread {
    low: [f32; 3],
    high: [f32; 3],
}

impl Spread {
    const NONE: Spread = Spread { low: [f32::MAX; 3], high: [f32::MIN; 3] };

    fn include(&mut self, velocity: &Row) {
        for axis in 0..3 {
            self.low[axis] = self.low[axis].min(velocity.0[axis]);
            self.high[axis] = self.high[axis].max(velocity.0[axis]);
        }
    }

    fn width(&self) -> f32 {
        (0..3).map(|axis| self.high[axis] - self.low[axis]).fold(0.0, f32::max)
    }
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

/// No island: the world and what is driven.
const NONE: u32 = u32::MAX;

impl Graph {
    /// Adds a contact between the bodies of two rows; `movable` tells which of them an impulse can move.
    pub fn insert(&mut self, rows: [u32; 2], movable: [bool; 2], lane: &Lane) -> ContactId {
        let kind = if movable == [true, true] { MOVING } else { FIXED };
        let is_open = |color: &Color| (0..2).all(|side| !movable[side] || !color.is_taken(rows[side]));
        let mut color = kind;
        while self.colors.get(color).is_some_and(|it| !is_open(it)) {
            color += KINDS;
        }
        while self.colors.len() <= color {
            self.colors.push(Color::default());
        }
        let id = self.free.pop().unwrap_or_else(|| {
            self.places.push(None);
            (self.places.len() - 1) as u32
        });
        let target = &mut self.colors[color];
        let place = Place { color, lane: target.contacts.len() };
        for side in (0..2).filter(|&side| movable[side]) {
            target.mark(rows[side], true);
        }
        target.contacts.push(id);
        if place.lane.is_multiple_of(LANES) {
            target.bundles.push(Bundle::EMPTY);
        }
        target.bundles[place.lane / LANES].write(place.lane % LANES, rows, lane);
        self.places[id as usize] = Some(place);
        self.islands.is_stale = true;
        ContactId(id)
    }

    fn place(&self, id: ContactId) -> Option<Place> {
        self.places.get(id.0 as usize).copied().flatten()
    }

    /// Gives a contact other numbers.
    pub fn write(&mut self, id: ContactId, lane: &Lane) {
        if let Some(place) = self.place(id) {
            let bundle = &mut self.colors[place.color].bundles[place.lane / LANES];
            let (rows, _) = bundle.read(place.lane % LANES);
            bundle.write(place.lane % LANES, rows, lane);
        }
    }

    /// One of a contact's numbers.
    pub fn get(&self, id: ContactId, field: usize) -> f32 {
        self.place(id).map_or(0.0, |place| {
            self.colors[place.color].bundles[place.lane / LANES].get(place.lane % LANES, field)
        })
    }

    /// The rows of a contact's bodies.
    pub fn rows(&self, id: ContactId) -> [u32; 2] {
        self.place(id).map_or([0; 2], |place| {
            let bundle = &self.colors[place.color].bundles[place.lane / LANES];
            [bundle.a[place.lane % LANES], bundle.b[place.lane % LANES]]
        })
    }

    /// Removes a contact; the last of its colour takes its lane.
    pub fn remove(&mut self, id: ContactId) {
        let Some(Place { color, lane }) = self.place(id) else { return };
        let color = &mut self.colors[color];
        let last = color.contacts.len() - 1;
        let (rows, _) = color.bundles[lane / LANES].read(lane % LANES);
        rows.into_iter().for_each(|row| color.mark(row, false));
        if last != lane {
            let (rows, moved) = color.bundles[last / LANES].read(last % LANES);
            color.bundles[lane / LANES].write(lane % LANES, rows, &moved);
            let contact = color.contacts[last];
            color.contacts[lane] = contact;
            if let Some(place) = &mut self.places[contact as usize] {
                place.lane = lane;
            }
        }
        color.contacts.pop();
        if last.is_multiple_of(LANES) {
            color.bundles.pop();
        } else {
            color.bundles[last / LANES].write(last % LANES, [0; 2], &[0.0; field::COUNT]);
        }
        self.places[id.0 as usize] = None;
        self.free.push(id.0);
        self.islands.is_stale = true;
    }

    /// The body of row `from` has moved to row `to`.
    pub fn rename_row(&mut self, from: u32, to: u32) {
        for color in &mut self.colors {
            for bundle in &mut color.bundles {
                for row in bundle.a.iter_mut().chain(&mut bundle.b).filter(|row| **row == from) {
                    *row = to;
                }
            }
            let taken = color.is_taken(from);
            color.mark(from, false);
            color.mark(to, taken);
        }
        self.islands.is_stale = true;
    }

    /// Colours in the order in which they are swept.
    fn order(&self) -> impl Iterator<Item = usize> + use<> {
        let count = self.colors.len();
        (MOVING..count).step_by(KINDS).chain((FIXED..count).step_by(KINDS))
    }

    fn each_bundle(&mut self, mut act: impl FnMut(&mut Bundle)) {
        for color in self.order() {
            self.colors[color].bundles.iter_mut().for_each(&mut act);
        }
    }

    /// Finds all separations from the bodies' drifts.
    pub fn measure(&mut self, drifts: &[Row]) {
        self.each_bundle(|bundle| contact::measure::<Wide>(bundle, drifts));
    }

    /// Lets the impulses of the last substep act again, where they are a good start.
    ///
    /// They are asked for work only in islands whose bodies move faster than `lively` against each other: near rest their
    /// work is noise.
    pub fn begin(&mut self, velocities: &mut [Row], [margin, lively]: [f64; 2], substep: f64) {
        let limits = [margin as f32, (1.0 / substep) as f32];
        let before = velocities.to_vec();
        self.each_bundle(|bundle| contact::begin::<Wide>(bundle, velocities, limits));
        self.each_bundle(|bundle| contact::resume::<Wide>(bundle, velocities));
        self.find_islands(velocities.len());
        self.refuse_gains(&before, velocities, lively);
    }

    /// Takes back the impulses that act again in those islands in which they do work: all forces of contacts together never do, so that
    /// these would be a worse start than none.
    fn refuse_gains(&mut self, before: &[Row], velocities: &mut [Row], lively: f64) {
        let mut gains = vec![0.0; self.islands.sizes.len()];
        for bundle in self.colors.iter().flat_map(|color| &color.bundles) {
            for (lane, work) in contact::work::<Wide>(bundle, before, velocities).0.into_iter().enumerate() {
                if let Some(island) = self.island_of(bundle, lane) {
                    gains[island] += f64::from(work);
                }
            }
        }
        for (gain, spread) in gains.iter_mut().zip(self.spreads(before)) {
            *gain = if f64::from(spread) > lively { *gain } else { 0.0 };
        }
        if gains.iter().all(|&gain| gain <= 0.0) {
            return;
        }
        let refused = |islands: &Islands, row: u32| {
            islands
                .of_row
                .get(row as usize)
                .is_some_and(|&island| island != NONE && gains[island as usize] > 0.0)
        };
        for (row, velocity) in velocities.iter_mut().enumerate() {
            if refused(&self.islands, row as u32) {
                *velocity = before[row];
            }
        }
        for bundle in self.colors.iter_mut().flat_map(|color| &mut color.bundles) {
            for lane in 0..LANES {
                if refused(&self.islands, bundle.a[lane]) || refused(&self.islands, bundle.b[lane]) {
                    field::IMPULSES.into_iter().for_each(|line| bundle.lines[line].0[lane] = 0.0);
                }
            }
        }
    }

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

    /// How fast the bodies of each island move against each other, m/s.
    fn spreads(&self, velocities: &[Row]) -> Vec<f32> {
        let mut spreads = vec![Spread::NONE; self.islands.sizes.len()];
        for bundle in self.colors.iter().flat_map(|color| &color.bundles) {
            for lane in 0..LANES {
                if let Some(island) = self.island_of(bundle, lane) {
                    spreads[island].include(&velocities[bundle.a[lane] as usize]);
                    spreads[island].include(&velocities[bundle.b[lane] as usize]);
                }
            }
        }
        spreads.iter().map(Spread::width).collect()
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

    fn island_of(&self, bundle: &Bundle, lane: usize) -> Option<usize> {
        let of_row =
            |row: u32| self.islands.of_row.get(row as usize).copied().filter(|&island| island != NONE);
        of_row(bundle.a[lane]).or(of_row(bundle.b[lane])).map(|island| island as usize)
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

    fn find_islands(&mut self, rows: usize) {
        if !self.islands.is_stale {
            return;
        }
        let mut movable = Color::default();
        for color in &self.colors {
            movable.taken.resize(movable.taken.len().max(color.taken.len()), 0);
            movable.taken.iter_mut().zip(&color.taken).for_each(|(all, word)| *all |= word);
        }
        let is_movable = |row: usize| movable.is_taken(row as u32);
        let mut root: Vec<u32> = (0..rows as u32).collect();
        fn find(root: &mut [u32], mut row: u32) -> u32 {
            while root[row as usize] != row {
                root[row as usize] = root[root[row as usize] as usize];
                row = root[row as usize];
            }
            row
        }
        let lanes = || {
            let bundles = self.colors.iter().flat_map(|color| &color.bundles);
            bundles.flat_map(|bundle| bundle.a.iter().copied().zip(bundle.b))
        };
        for (a, b) in lanes().filter(|&(a, b)| is_movable(a as usize) && is_movable(b as usize)) {
            let (a, b) = (find(&mut root, a), find(&mut root, b));
            root[a.max(b) as usize] = a.min(b);
        }
        let mut of_row = vec![NONE; rows];
        let mut sizes = Vec::new();
        for (a, b) in lanes() {
            let Some(row) = [a, b].into_iter().find(|&row| is_movable(row as usize)) else { continue };
            let top = find(&mut root, row) as usize;
            if of_row[top] == NONE {
                of_row[top] = sizes.len() as u32;
                sizes.push(0);
            }
            sizes[of_row[top] as usize] += 1;
        }
        for row in 0..rows {
            of_row[row] = if is_movable(row) { of_row[find(&mut root, row as u32) as usize] } else { NONE };
        }
        let mut bodies = vec![0; sizes.len()];
        of_row.iter().filter(|&&island| island != NONE).for_each(|&island| bodies[island as usize] += 1);
        let pauses = vec![0; sizes.len()];
        self.islands = Islands { is_stale: false, of_row, sizes, bodies, pauses };
    }

    /// Finds displacements that take `share` of every overlap beyond `allowed` (m) away, into rows that hold none yet; false if
    /// there is no such overlap.
    pub fn push_out(&mut self, displacements: &mut [Row], share: f32, allowed: f32) -> bool {
        let overlaps = |bundle: &Bundle| bundle.lines[field::GAP].0.iter().any(|&gap| gap < -allowed);
        if !self.colors.iter().flat_map(|color| &color.bundles).any(overlaps) {
            return false;
        }
        let impulses: Vec<[Line; POINTS]> = self
            .order()
            .flat_map(|color| &self.colors[color].bundles)
            .map(|bundle| [0, 1, 2, 3].map(|point| bundle.lines[field::of_point(point, field::IMPULSE)]))
            .collect();
        self.each_bundle(|bundle| {
            for point in 0..POINTS {
                let separation = bundle.lines[field::of_point(point, field::SEPARATION)].0;
                bundle.lines[field::of_point(point, field::IMPULSE)] = Line::ZERO;
                bundle.lines[field::of_point(point, field::LEAST)] =
                    Line(separation.map(|s| if s < -allowed { share * (-s - allowed) } else { -s.max(0.0) }));
            }
        });
        for _ in 0..PUSH_SWEEPS {
            self.each_bundle(|bundle| contact::sweep_normals::<Wide>(bundle, displacements));
        }
        let mut impulses = impulses.into_iter();
        self.each_bundle(|bundle| {
            for (point, line) in impulses.next().into_iter().flatten().enumerate() {
                bundle.lines[field::of_point(point, field::IMPULSE)] = line;
            }
        });
        true
    }
}

/// Bodies in a patch of a large island.
const PATCH: usize = 128;

/// Sweeps between two looks at which islands agree.
const ROUND: u32 = 4;

/// Substeps to wait before an island that could not be solved directly is tried again.
const PAUSE: u32 = 16;

/// Sweeps that push overlaps out.
const PUSH_SWEEPS: usize = 4;

#[cfg(test)]
mod tests;
#[cfg(test)]
mod validate;
