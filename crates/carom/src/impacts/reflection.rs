//! Several contacts struck at one instant: impulses for all of them together.
//!
//! The seed's five steps with a *direction of the whole system* in place of one normal. With `v` the velocities of all bodies,
//! `M` their masses and inertias, and for each contact `i` the closing speed `v_i⁻ = J_i v < 0`:
//!
//! 1. Find impulses `λ ≥ 0` such that each contact parts with at least `v_i⁺ ≥ −C_r,i·v_i⁻`, and with just that where `λ_i > 0`:
//!    projected Gauss–Seidel, each contact in turn by the seed's formula.
//! 2. Take all of them together as one first, wrong impulse `D = Σ λ_i J_i`. It changes the velocities by `M⁻¹D`.
//! 3. Its closing speed is `v_D = D·v`, and a unit of it changes that by `K_D = D·M⁻¹D`.
//! 4. Linear again: some multiple of it gives the parting speed `−C_r·v_D`, with `C_r` weighted by what each contact does.
//! 5. Solve for `f = −(1 + C_r)·v_D / K_D`, and apply `f·λ_i` at each contact.
//!
//! # Books
//! Momentum: equal and opposite impulses, at one point each. Energy changes by `−½(1 − C_r²)·v_D²/K_D`, *whatever* `λ` the first
//! step came to: it cannot grow, and is kept for C_r = 1, converged or not. With friction never more than that.
//!
//! # Reference
//! Smith, Kaufman, Vouga, Tamstorf, Grinspun, *Reflections on Simultaneous Impact* (SIGGRAPH 2012): the generalized reflection, which alone
//! lets a pair break away, keeps symmetry, energy, momentum, and only pushes. The weighting for different C_r and the
//! scaling are ours.

mod friction;
mod groups;
mod haste;
mod row;
mod spot;

use crate::fault;
use crate::impulse::Velocity;
use crate::math::DVec3;
use groups::connected;
use haste::Haste;
use row::Row;
pub(crate) use spot::{Blow, Mover, Spot};

/// Sweeps over all contacts of a round, which end when they change no speed by more than this share of the fastest.
const SWEEPS: usize = 400;
const AGREEMENT: f64 = 1e-14;

/// Impulses to start a round from, the change of speed (m/s) that is not worth a sweep, and how many there may be at most of each kind.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start<'a> {
    pub blows: &'a [Blow],
    /// 0 where anything bounces.
    pub negligible: f64,
    pub sweeps: usize,
    /// Whether all that is asked is who pushes.
    pub is_glance: bool,
}

/// Impulses for all `spots` of a round. The first of them may have got some already. Spots that no body connects which can be moved
/// have nothing to do with each other, and none pays for what another gains.
pub(crate) fn reflect(movers: &[Mover], spots: &[Spot], start: Start<'_>) -> Vec<Blow> {
    let groups = connected(movers, spots);
    if groups.len() <= 1 {
        return reflect_connected(movers, spots, start);
    }
    let mut blows = vec![Blow::default(); spots.len()];
    for group in groups {
        let own: Vec<Spot> = group.iter().map(|&index| spots[index]).collect();
        let earlier: Vec<Blow> = group.iter().filter_map(|&index| start.blows.get(index).copied()).collect();
        let found = reflect_connected(movers, &own, Start { blows: &earlier, ..start });
        group.into_iter().zip(found).for_each(|(index, blow)| blows[index] = blow);
    }
    blows
}

fn reflect_connected(movers: &[Mover], spots: &[Spot], start: Start<'_>) -> Vec<Blow> {
    if let [spot] = spots
        && !spot.pulls
    {
        return vec![Blow::alone(movers, spot)];
    }
    let mut round = Round::new(movers, spots, start);
    let is_rough = spots.iter().any(Spot::is_rough);
    if is_rough && start.negligible > 0.0 {
        round.push_and_rub_together();
    } else {
        round.push_along_normals();
        round.scale();
        if is_rough {
            round.rub();
        }
    }
    round.settle_alone();
    round.blows
}

/// The velocities after `blows`.
pub(crate) fn velocities_after(movers: &[Mover], spots: &[Spot], blows: &[Blow]) -> Vec<Velocity> {
    let mut velocities: Vec<Velocity> = movers.iter().map(|mover| mover.velocity).collect();
    for (spot, blow) in spots.iter().zip(blows) {
        push(movers, &mut velocities, spot, blow.impulse(spot));
    }
    velocities
}

fn push(movers: &[Mover], velocities: &mut [Velocity], spot: &Spot, impulse: DVec3) {
    for (side, impulse) in [(0, -impulse), (1, impulse)] {
        let mover = &movers[spot.movers[side]];
        let velocity = &mut velocities[spot.movers[side]];
        velocity.linear += impulse * (1.0 / mover.mass);
        velocity.angular += mover.inverse_inertia * spot.arms[side].cross(impulse);
    }
}

/// A round while its impulses are sought.
struct Round<'a> {
    movers: &'a [Mover],
    spots: &'a [Spot],
    rows: Vec<Row>,
    /// With the present blows.
    velocities: Vec<Velocity>,
    blows: Vec<Blow>,
    /// What speeds are compared with, m/s.
    fastest: f64,
    negligible: f64,
    sweeps: usize,
    is_glance: bool,
}

impl<'a> Round<'a> {
    fn new(movers: &'a [Mover], spots: &'a [Spot], start: Start<'_>) -> Self {
        let rows: Vec<Row> = spots.iter().map(|spot| Row::new(movers, spot)).collect();
        let fastest = rows.iter().map(|row| row.before.abs()).fold(0.0, f64::max);
        let mut blows = vec![Blow::default(); spots.len()];
        for (blow, earlier) in blows.iter_mut().zip(start.blows) {
            *blow = if start.negligible > 0.0 { *earlier } else { Blow::smooth(earlier.normal) };
        }
        let velocities = velocities_after(movers, spots, &blows);
        Self {
            movers,
            spots,
            rows,
            velocities,
            blows,
            fastest,
            negligible: start.negligible,
            sweeps: start.sweeps,
            is_glance: start.is_glance,
        }
    }

    fn velocity(&self, index: usize) -> DVec3 {
        self.spots[index].velocity(|mover| self.velocities[mover])
    }

    /// The speed of spot `index` along its normal, m/s.
    fn speed(&self, index: usize) -> f64 {
        let (spot, row) = (&self.spots[index], &self.rows[index]);
        let [a, b] = spot.movers.map(|mover| &self.velocities[mover]);
        (b.linear - a.linear).dot(spot.contact.normal)
            + a.angular.dot(row.moments[0])
            + b.angular.dot(row.moments[1])
    }

    /// The seed's formula for one spot among others; how much it changes its speed, m/s.
    fn push_along_normal(&mut self, index: usize) -> f64 {
        let (spot, row) = (&self.spots[index], &self.rows[index]);
        if row.per_impulse <= 0.0 {
            return 0.0;
        }
        let old = self.blows[index].normal;
        let new = old + (row.wanted - self.speed(index)) / row.per_impulse;
        let new = if spot.pulls { new } else { new.max(0.0) };
        let change = new - old;
        if change != 0.0 {
            self.blows[index].normal = new;
            for (&mover, gain) in spot.movers.iter().zip(&row.gains) {
                self.velocities[mover].linear += change * gain.linear;
                self.velocities[mover].angular += change * gain.angular;
            }
        }
        change.abs() * row.per_impulse
    }

    /// Step 1.
    fn push_along_normals(&mut self) {
        self.sweep((SWEEPS.min(self.sweeps), AGREEMENT), Self::push_along_normal);
    }

    /// Lets one spot after the other `act`, which tells how much it has changed a speed (m/s), until nothing changes by more than a
    /// share of the fastest or what is negligible; at most so many times. Spots none of whose bodies has changed since have nothing
    /// to do. Where something is negligible, sweeps make [haste](Haste). Whether nothing changes any more.
    fn sweep(&mut self, (sweeps, agreement): (usize, f64), act: impl Fn(&mut Self, usize) -> f64) -> bool {
        let limit = (agreement * self.fastest).max(self.negligible);
        let can_stir: Vec<bool> = self.movers.iter().map(Mover::is_movable).collect();
        let (mut stirred, mut stirs) = (vec![true; self.movers.len()], vec![false; self.movers.len()]);
        let mut haste = (self.negligible > 0.0).then(Haste::default);
        for _ in 0..sweeps {
            if let Some(haste) = &mut haste
                && haste.hurry(self)
            {
                stirred.fill(true);
            }
            let mut is_done = true;
            for index in 0..self.spots.len() {
                let movers = self.spots[index].movers;
                if movers.into_iter().any(|mover| stirred[mover] || stirs[mover]) && act(self, index) > limit
                {
                    movers.into_iter().for_each(|mover| stirs[mover] = can_stir[mover]);
                    is_done = false;
                }
            }
            if is_done {
                return true;
            }
            std::mem::swap(&mut stirred, &mut stirs);
            stirs.fill(false);
        }
        false
    }

    /// Steps 2 to 5.
    fn scale(&mut self) {
        for group in self.groups(|index| self.blows[index].acts()) {
            let (mut closing, mut bounced, mut per_unit) = (0.0, 0.0, 0.0);
            for &index in &group {
                let (spot, before) = (&self.spots[index], self.rows[index].before);
                let pushed = self.blows[index].normal;
                let gained = self.velocity(index).dot(spot.contact.normal) - before;
                closing += pushed * before;
                bounced += pushed * before * fault::restitution(spot.contact.restitution);
                per_unit += pushed * gained;
            }
            if per_unit > 0.0 {
                let fraction = -(closing + bounced) / per_unit;
                group.into_iter().for_each(|index| self.blows[index].normal *= fraction.max(0.0));
            }
        }
        self.velocities = velocities_after(self.movers, self.spots, &self.blows);
    }

    /// The spots that `act`, in groups that bodies connect which can be moved. The spots of a round hang together, but some of them may
    /// push nothing: what is on either side of these keeps books of its own.
    fn groups(&self, act: impl Fn(usize) -> bool) -> Vec<Vec<usize>> {
        let acting: Vec<usize> = (0..self.spots.len()).filter(|&index| act(index)).collect();
        let spots: Vec<Spot> = acting.iter().map(|&index| self.spots[index]).collect();
        let groups = connected(self.movers, &spots).into_iter();
        groups.map(|group| group.into_iter().map(|number| acting[number]).collect()).collect()
    }

    /// A spot whose bodies nothing else pushes gets what the seed has for it, to the last digit.
    fn settle_alone(&mut self) {
        for group in self.groups(|index| self.blows[index].acts()) {
            if let [alone] = group[..]
                && !self.spots[alone].pulls
            {
                self.blows[alone] = Blow::alone(self.movers, &self.spots[alone]);
            }
        }
    }

    /// Gives spot `index` a further impulse, of which `along` is the part along the normal.
    fn strike(&mut self, index: usize, along: f64, across: DVec3) {
        let spot = &self.spots[index];
        self.blows[index].normal += along;
        self.blows[index].tangent += across;
        push(self.movers, &mut self.velocities, spot, along * spot.contact.normal + across);
    }
}

#[cfg(test)]
mod tests;
