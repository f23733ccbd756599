//! Where the sweeps of a substep start from: the impulses of the substep before.
//!
//! What rests is pushed as it was, so that these are nearly right. What moves may have got elsewhere since; then they can do work, which the
//! forces of contacts never do: neither all together nor those of any one contact. They would be a worse start than none, and feed on
//! themselves from substep to substep. Near rest their work is noise, so that only *lively* contacts are asked for it: those whose
//! bodies move fast against each other. Lively contacts that bodies connect answer together, and for themselves alone: what rests
//! beneath them keeps its impulses.

use super::Graph;
use super::islands::Sets;
use crate::solver::bundle::{Bundle, field};
use crate::solver::kernels::Work;
use crate::solver::lanes::{LANES, Line, Row};
use crate::step::profile::{self, Phase};

/// A lively contact: its colour, its lane there, its bodies, and what its impulses have done, J.
struct Lively {
    color: usize,
    lane: usize,
    rows: [u32; 2],
    work: f32,
}

impl Graph {
    /// Lets the impulses of the last substep act again on the velocities `before`, where they are a good start. Contacts are lively whose
    /// bodies move faster than `lively` (m/s) against each other.
    pub fn begin(
        &mut self,
        before: &[Row],
        velocities: &mut [Row],
        [margin, lively]: [f64; 2],
        substep: f64,
    ) {
        let _phase = profile::phase(Phase::Solve);
        let limits = [margin as f32, (1.0 / substep) as f32];
        velocities.copy_from_slice(before);
        self.resume((before, velocities), limits);
        self.find_islands(velocities.len());
        if self.refuse_gains([before, velocities], lively as f32) {
            velocities.copy_from_slice(before);
            self.resume((before, velocities), limits);
        }
    }

    /// Takes the impulses of those lively contacts away that have done work together; whether there are any.
    fn refuse_gains(&mut self, [before, after]: [&[Row]; 2], lively: f32) -> bool {
        if !self.spreads(before).iter().any(|spread| spread.width() > lively) {
            return false;
        }
        let contacts = self.lively([before, after], lively);
        let mut sets = Sets::of_each(before.len());
        for &Lively { rows: [a, b], .. } in &contacts {
            if [a, b].into_iter().all(|row| self.islands.of(row).is_some()) {
                sets.unite(a, b);
            }
        }
        let mut gains = vec![0.0; before.len()];
        for contact in &contacts {
            gains[self.group_of(contact, &mut sets)] += f64::from(contact.work);
        }
        let mut is_refused = false;
        for contact in &contacts {
            if gains[self.group_of(contact, &mut sets)] > 0.0 {
                is_refused = true;
                let bundle = &mut self.colors[contact.color].bundles[contact.lane / LANES];
                field::IMPULSES.into_iter().for_each(|line| bundle.lines[line].0[contact.lane % LANES] = 0.0);
            }
        }
        is_refused
    }

    /// The lively contacts, and the work of their impulses on bodies that get from the velocities `before` to those `after`.
    fn lively(&self, [before, after]: [&[Row]; 2], lively: f32) -> Vec<Lively> {
        let is_lively = |bundle: &Bundle, lane: usize| {
            let [a, b] = [bundle.a[lane], bundle.b[lane]].map(|row| &before[row as usize].0);
            (0..3).any(|axis| (b[axis] - a[axis]).abs() > lively)
        };
        let mut found = Vec::new();
        for (color, it) in self.colors.iter().enumerate() {
            for (index, bundle) in it.bundles.iter().enumerate() {
                let mut lanes = (0..LANES).filter(|&lane| is_lively(bundle, lane)).peekable();
                if lanes.peek().is_none() {
                    continue;
                }
                let works: Line = self.machine.run(Work { bundle, before, after });
                found.extend(lanes.map(|lane| Lively {
                    color,
                    lane: index * LANES + lane,
                    rows: [bundle.a[lane], bundle.b[lane]],
                    work: works.0[lane],
                }));
            }
        }
        found
    }

    /// The row that stands for the group of a lively contact.
    fn group_of(&self, &Lively { rows, .. }: &Lively, sets: &mut Sets) -> usize {
        let movable = rows.into_iter().find(|&row| self.islands.of(row).is_some());
        sets.find(movable.unwrap_or(rows[0])) as usize
    }
}
