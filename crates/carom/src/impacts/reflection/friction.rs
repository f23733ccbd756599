//! Friction in a round of reflections.

use super::{Blow, Round, velocities_after};
use crate::fault;
use crate::impulse::{Contact, Velocity};
use crate::math::DVec3;

/// Sweeps over all contacts, which end when they change no velocity by more than this share of the fastest.
const SWEEPS: usize = 1000;
const AGREEMENT: f64 = 1e-10;

impl Round<'_> {
    /// Adds friction, as much of it as takes energy away and gives none.
    pub(super) fn rub(&mut self) {
        let smooth = (self.blows.clone(), self.velocities.clone());
        self.rub_from(&smooth);
    }

    /// Pushes and friction together, where nothing bounces: from whatever impulses there are. What comes of that keeps no more energy
    /// than there was before all of them.
    pub(super) fn push_and_rub_together(&mut self) {
        let nothing = vec![Blow::default(); self.spots.len()];
        let before = self.movers.iter().map(|mover| mover.velocity).collect();
        self.rub_from(&(nothing, before));
    }

    /// From the impulses `j₀`, which have led to the velocities with them, to those with friction, `j`, all between them keep to Newton's
    /// rule and to the cones, which are convex. On the way the energy changes by `a·(d·u₀) + ½a²·(d·Kd)` with `d = j − j₀`; the way ends
    /// where this would become positive. Where sweeps do not agree, the pushes are found once more, with friction as it is by then.
    fn rub_from(&mut self, (smooth, before): &(Vec<Blow>, Vec<Velocity>)) {
        if !self.sweep((SWEEPS.min(self.sweeps), AGREEMENT), Self::push_and_rub) && !self.is_glance {
            self.sweep((SWEEPS.min(self.sweeps), AGREEMENT), Self::push_within_cone);
        }
        let mut is_cut = false;
        for group in self.groups(|index| smooth[index].acts() || self.blows[index].acts()) {
            let (mut first, mut second) = (0.0, 0.0);
            for &index in &group {
                let spot = &self.spots[index];
                let further = self.blows[index].impulse(spot) - smooth[index].impulse(spot);
                let without = spot.velocity(|mover| before[mover]);
                first += further.dot(without);
                second += further.dot(self.velocity(index) - without);
            }
            let share = if second > 0.0 { (-2.0 * first / second).clamp(0.0, 1.0) } else { 0.0 };
            if share < 1.0 {
                is_cut = true;
                for index in group {
                    let (blow, smooth) = (&mut self.blows[index], &smooth[index]);
                    blow.normal = smooth.normal + share * (blow.normal - smooth.normal);
                    blow.tangent *= share;
                    blow.sticks = false;
                }
            }
        }
        if is_cut {
            self.velocities = velocities_after(self.movers, self.spots, &self.blows);
        }
    }

    /// Push and friction at one spot among others; how much they change its velocity, m/s. Wherever the sweeps end, friction keeps to the
    /// cone of the push that it belongs to.
    fn push_and_rub(&mut self, index: usize) -> f64 {
        self.stick(index).unwrap_or_else(|| {
            let pushed = self.push_along_normal(index);
            let rubbed = self.rub_one(index);
            pushed.max(rubbed).max(self.push_along_cone(index))
        })
    }

    /// The push that goes with friction as it is, where that will not agree: no less than what its cone needs; how much it changes the
    /// speed, m/s.
    fn push_within_cone(&mut self, index: usize) -> f64 {
        let (spot, row, blow) = (&self.spots[index], &self.rows[index], self.blows[index]);
        let per_impulse = row.per_impulse;
        if per_impulse <= 0.0 || spot.pulls {
            return self.push_along_normal(index);
        }
        let Contact { static_friction, dynamic_friction, .. } = spot.contact;
        let limit = if blow.sticks { static_friction } else { fault::friction(dynamic_friction) };
        let rubbed = blow.tangent.length();
        let least = if limit > 0.0 { rubbed / limit } else { 0.0 };
        let change = (blow.normal + (row.wanted - self.speed(index)) / per_impulse).max(least) - blow.normal;
        if change != 0.0 {
            self.strike(index, change, DVec3::ZERO);
        }
        change.abs() * per_impulse
    }

    /// The impulse that ends the slip and gives the spot its speed, if the cone allows it. Push and friction by turns would come
    /// near it but slowly where they act on each other: on the tip of what is long and thin.
    fn stick(&mut self, index: usize) -> Option<f64> {
        let (spot, row) = (&self.spots[index], &self.rows[index]);
        let stiffness = row.stiffness.as_ref().filter(|_| spot.is_rough() && !spot.pulls)?;
        let normal = spot.contact.normal;
        let lack = row.wanted * normal - self.velocity(index);
        let further = *stiffness * lack;
        let blow = &self.blows[index];
        let along = further.dot(normal);
        let across = further - along * normal;
        let (push, friction) = (blow.normal + along, blow.tangent + across);
        if push <= 0.0 || friction.length() > spot.contact.static_friction * push {
            return None;
        }
        self.blows[index].sticks = true;
        self.strike(index, along, across);
        Some(lack.length())
    }

    /// What slides gets the rest of its push with the friction that belongs to it; how much this changes its speed, m/s.
    fn push_along_cone(&mut self, index: usize) -> f64 {
        let (spot, row, blow) = (&self.spots[index], &self.rows[index], &self.blows[index]);
        if blow.sticks || blow.normal <= 0.0 || blow.tangent == DVec3::ZERO {
            return 0.0;
        }
        let normal = spot.contact.normal;
        let friction = blow.tangent / blow.normal;
        let per_impulse = normal.dot(row.response * (normal + friction));
        if per_impulse <= 0.0 {
            return 0.0;
        }
        let lack = row.wanted - self.velocity(index).dot(normal);
        let along = (lack / per_impulse).max(-blow.normal);
        self.strike(index, along, along * friction);
        lack.abs()
    }

    /// Friction at one spot among others: it ends the slip if the cone allows it; how much it changes its velocity, m/s.
    fn rub_one(&mut self, index: usize) -> f64 {
        let (spot, row) = (&self.spots[index], &self.rows[index]);
        if !spot.is_rough() || row.yielding <= 0.0 {
            return 0.0;
        }
        let slip = self.velocity(index);
        let across = slip - slip.dot(spot.contact.normal) * spot.contact.normal;
        // The step of a gradient: where it slides, what is left points against the slip.
        let old = self.blows[index].tangent;
        let ending = old - across / row.yielding;
        let pressed = self.blows[index].normal.max(0.0);
        let sticks = ending.length() <= spot.contact.static_friction * pressed;
        let limit = fault::friction(spot.contact.dynamic_friction) * pressed;
        let new = if sticks { ending } else { ending.clamp_length_max(limit) };
        self.blows[index].sticks = sticks;
        let changed = row.yielding * (new - old).length();
        if changed > 0.0 {
            self.strike(index, 0.0, new - old);
        }
        changed
    }
}
