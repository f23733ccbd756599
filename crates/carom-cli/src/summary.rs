//! What a run came to.

use crate::ledger::LedgerTotals;
use crate::simulate::{Moment, Outcome, Simulation, name_of};
use crate::text::{counted, number, point, rough};
use crate::trace::{Energy, Momentum};
use carom::World;
use carom::conditions::conditions;
use serde::Serialize;
use std::fmt::Write;

/// A quantity at the start and at the end.
#[derive(Serialize)]
struct Change<T> {
    before: T,
    after: T,
}

/// The collision that came closest to breaking a law, or went furthest beyond it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Worst {
    index: u64,
    law: &'static str,
    a: String,
    b: String,
    time: f64,
    error: f64,
    tolerance: f64,
}

impl Worst {
    fn ratio(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.tolerance }
    }
}

/// Gathers what the summary tells while the simulation runs.
pub struct Watcher {
    energy: carom::Energy,
    momentum: carom::Momentum,
    worst: Option<Worst>,
}

impl Watcher {
    /// Begins with the start of a simulation.
    pub fn new(world: &World) -> Self {
        Self { energy: world.energy(), momentum: world.momentum(), worst: None }
    }

    /// Looks at the collisions of a step. Those of one instant obey the laws only all together, so they are not judged
    /// one by one.
    pub fn look(&mut self, moment: &Moment<'_>) {
        for (index, impact) in (moment.impacts_before..).zip(moment.impacts) {
            if impact.together > 1 {
                continue;
            }
            let laws = conditions(&impact.hit(), impact.point);
            for (law, error, tolerance) in [
                ("separating_speed", laws.separating_speed.error, laws.separating_speed.tolerance),
                ("linear_momentum", laws.linear_momentum.error, laws.linear_momentum.tolerance),
                ("angular_momentum", laws.angular_momentum.error, laws.angular_momentum.tolerance),
                ("energy", laws.energy.error, laws.energy.tolerance),
            ] {
                let ratio = if error == 0.0 { 0.0 } else { error / tolerance };
                if self.worst.as_ref().is_none_or(|worst| ratio > worst.ratio()) {
                    self.worst = Some(Worst {
                        index,
                        law,
                        a: name_of(moment.world, impact.a).to_owned(),
                        b: name_of(moment.world, impact.b).to_owned(),
                        time: impact.time,
                        error,
                        tolerance,
                    });
                }
            }
        }
    }
}

/// What a run came to; as JSON it has these keys in this order.
#[derive(Serialize)]
pub struct Summary {
    scene: String,
    steps: u64,
    dt: f64,
    seconds: f64,
    wall_seconds: f64,
    ms_per_step: Option<f64>,
    real_time_factor: Option<f64>,
    bodies: usize,
    collisions: u64,
    contacts: usize,
    energy: Change<Energy>,
    momentum: Change<Momentum>,
    worst_collision: Option<Worst>,
    ledger: LedgerTotals,
    state_hash: String,
}

impl Summary {
    /// The end of `simulation`.
    pub fn new(simulation: &Simulation, outcome: &Outcome, watcher: Watcher) -> Self {
        let world = &simulation.world;
        let seconds = outcome.steps as f64 * simulation.dt;
        let wall_seconds = outcome.wall_time.as_secs_f64();
        let ratio = |a: f64, b: f64| (b > 0.0).then(|| a / b);
        Self {
            scene: simulation.scene.clone(),
            steps: outcome.steps,
            dt: simulation.dt,
            seconds,
            wall_seconds,
            ms_per_step: ratio(1e3 * wall_seconds, outcome.steps as f64),
            real_time_factor: ratio(seconds, wall_seconds),
            bodies: simulation.bodies.len(),
            collisions: outcome.collisions,
            contacts: outcome.contacts,
            energy: Change { before: watcher.energy.into(), after: world.energy().into() },
            momentum: Change { before: watcher.momentum.into(), after: world.momentum().into() },
            worst_collision: watcher.worst,
            ledger: LedgerTotals::new(world),
            state_hash: format!("{:016x}", world.state_hash()),
        }
    }

    /// For people.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n", self.scene);
        let mut row = |what: &str, value: String| {
            let _ = writeln!(text, "  {what:<18}{value}");
        };
        let bodies = if self.bodies == 1 { "body" } else { "bodies" };
        let (steps, dt) = (counted(self.steps, "step"), number(self.dt));
        row("simulated", format!("{} {bodies}, {} s: {steps} of {dt} s", self.bodies, number(self.seconds)));
        if let (Some(step), Some(factor)) = (self.ms_per_step, self.real_time_factor) {
            let wall = number(self.wall_seconds);
            let (step, factor) = (number(step), rough(factor));
            row("took", format!("{wall} s, {step} ms a step, {factor} times real time"));
        }
        row("collisions", self.collisions.to_string());
        row("contacts", format!("{} at the end", self.contacts));
        let (before, after) = (&self.energy.before, &self.energy.after);
        row("energy before", before.text());
        row("energy after", after.text());
        row("momentum before", self.momentum.before.text());
        row("momentum after", self.momentum.after.text());
        if let Some(worst) = &self.worst_collision {
            let law = worst.law.replace('_', " ");
            let verdict = if worst.ratio() <= 1.0 { "within" } else { "BEYOND" };
            row(
                "laws of collision",
                format!(
                    "nearest to breaking: {law} of collision {} ({} and {}),\n{:20}off by {}, {verdict} the tolerance {}",
                    worst.index,
                    worst.a,
                    worst.b,
                    "",
                    rough(worst.error),
                    rough(worst.tolerance)
                ),
            );
        }
        for (what, value) in self.ledger.rows() {
            row(what, value);
        }
        row("state hash", self.state_hash.clone());
        text
    }
}

impl Energy {
    fn text(&self) -> String {
        let total = self.kinetic + self.potential;
        format!(
            "{} J = {} kinetic + {} potential",
            number(total),
            number(self.kinetic),
            number(self.potential)
        )
    }
}

impl Momentum {
    fn text(&self) -> String {
        let [linear, angular] = [self.linear, self.angular].map(|vector| point(vector.into()));
        format!("{linear} N·s,\n{:20}angular {angular} N·m·s", "")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Summary {
        let worst = Worst {
            index: 2,
            law: "energy",
            a: "floor".to_owned(),
            b: "ball".to_owned(),
            time: 0.25,
            error: 1e-9,
            tolerance: 1e-7,
        };
        Summary {
            scene: "drop".to_owned(),
            steps: 1,
            dt: 0.01,
            seconds: 0.01,
            wall_seconds: 0.0,
            ms_per_step: Some(0.0),
            real_time_factor: None,
            bodies: 2,
            collisions: 3,
            contacts: 0,
            energy: Change {
                before: carom::Energy::default().into(),
                after: carom::Energy::default().into(),
            },
            momentum: Change {
                before: carom::Momentum::default().into(),
                after: carom::Momentum::default().into(),
            },
            worst_collision: Some(worst),
            ledger: LedgerTotals::new(&World::new()),
            state_hash: format!("{:016x}", 0xabc),
        }
    }

    #[test]
    fn the_json_object_has_its_keys_in_order() {
        let json = serde_json::to_value(example()).unwrap();
        let keys: Vec<_> = json.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(
            keys,
            [
                "scene",
                "steps",
                "dt",
                "seconds",
                "wall_seconds",
                "ms_per_step",
                "real_time_factor",
                "bodies",
                "collisions",
                "contacts",
                "energy",
                "momentum",
                "worst_collision",
                "ledger",
                "state_hash"
            ]
        );
        assert_eq!(json["state_hash"], "0000000000000abc");
        assert_eq!(json["worst_collision"]["index"], 2);
    }

    #[test]
    fn the_text_names_the_worst_collision() {
        let text = example().text();
        assert!(text.contains("energy of collision 2 (floor and ball)"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    }
}
