//! The trace: where every body is and how it moves, a step a line.

use crate::failure::Failure;
use crate::output::Lines;
use crate::simulate::{Moment, Simulation, name_of};
use carom::{BodyId, Motion, World};
use serde::Serialize;
use std::path::Path;

/// The first line.
#[derive(Serialize)]
struct Header<'a> {
    format: &'static str,
    version: u32,
    scene: &'a str,
    dt: f64,
    bodies: Vec<&'a str>,
}

/// Each further line.
#[derive(Serialize)]
struct Step<'a> {
    step: u64,
    time: f64,
    bodies: Vec<BodyLine<'a>>,
    contacts: usize,
    energy: Energy,
    momentum: Momentum,
}

#[derive(Serialize)]
struct BodyLine<'a> {
    name: &'a str,
    position: [f64; 3],
    rotation: [f32; 4],
    linear_velocity: [f32; 3],
    angular_velocity: [f32; 3],
    asleep: bool,
}

/// Energy of the dynamic bodies, J.
#[derive(Serialize)]
pub struct Energy {
    pub kinetic: f64,
    pub potential: f64,
}

impl From<carom::Energy> for Energy {
    fn from(energy: carom::Energy) -> Self {
        Self { kinetic: energy.kinetic, potential: energy.potential }
    }
}

/// Momentum of the dynamic bodies, about the world's origin.
#[derive(Serialize)]
pub struct Momentum {
    pub linear: [f64; 3],
    pub angular: [f64; 3],
}

impl From<carom::Momentum> for Momentum {
    fn from(momentum: carom::Momentum) -> Self {
        Self { linear: momentum.linear.to_array(), angular: momentum.angular.to_array() }
    }
}

/// Writes a simulation's trace.
pub struct Trace {
    lines: Lines,
    /// All bodies that are not static.
    bodies: Vec<BodyId>,
    dt: f64,
    every: u64,
    n_steps: u64,
}

impl Trace {
    /// Begins a file with the header and the start of `simulation`; then comes each `every`-th step.
    pub fn begin(path: &Path, simulation: &Simulation, every: u64) -> Result<Self, Failure> {
        let mut trace = Self {
            lines: Lines::create(path)?,
            bodies: moving(simulation),
            dt: simulation.dt,
            every,
            n_steps: simulation.n_steps,
        };
        trace.lines.json(&header(simulation, &trace.bodies))?;
        let start =
            Moment { step: 0, world: &simulation.world, impacts: &[], impacts_before: 0, contacts: 0 };
        trace.write(&start)?;
        Ok(trace)
    }

    /// Writes the step if its turn has come.
    pub fn step(&mut self, moment: &Moment<'_>) -> Result<(), Failure> {
        if moment.step.is_multiple_of(self.every) || moment.step == self.n_steps {
            self.write(moment)?;
        }
        Ok(())
    }

    /// Hands over the last lines.
    pub fn end(mut self) -> Result<(), Failure> {
        self.lines.finish()
    }

    fn write(&mut self, moment: &Moment<'_>) -> Result<(), Failure> {
        let world = moment.world;
        self.lines.json(&Step {
            step: moment.step,
            time: moment.step as f64 * self.dt,
            bodies: self.bodies.iter().filter_map(|&id| body_line(world, id)).collect(),
            contacts: moment.contacts,
            energy: world.energy().into(),
            momentum: world.momentum().into(),
        })
    }
}

fn moving(simulation: &Simulation) -> Vec<BodyId> {
    let moves =
        |id: &BodyId| simulation.world.description(*id).is_some_and(|body| body.motion != Motion::Fixed);
    simulation.bodies.iter().copied().filter(moves).collect()
}

fn header<'a>(simulation: &'a Simulation, bodies: &[BodyId]) -> Header<'a> {
    Header {
        format: "carom-trace",
        version: 1,
        scene: &simulation.scene,
        dt: simulation.dt,
        bodies: bodies.iter().map(|&id| simulation.name(id)).collect(),
    }
}

fn body_line(world: &World, id: BodyId) -> Option<BodyLine<'_>> {
    let state = world.body(id)?;
    Some(BodyLine {
        name: name_of(world, id),
        position: state.position().to_array(),
        rotation: state.rotation().to_array(),
        linear_velocity: state.linear_velocity().to_array(),
        angular_velocity: state.angular_velocity().to_array(),
        asleep: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_come_in_the_promised_order_and_numbers_as_short_as_they_read_back() {
        let header = Header { format: "carom-trace", version: 1, scene: "s", dt: 0.1, bodies: vec!["a"] };
        assert_eq!(
            serde_json::to_string(&header).unwrap(),
            r#"{"format":"carom-trace","version":1,"scene":"s","dt":0.1,"bodies":["a"]}"#
        );
        let step = Step {
            step: 3,
            time: 3.0 * 0.1,
            bodies: vec![BodyLine {
                name: "a",
                position: [0.1, 2.0, -0.0],
                rotation: [0.0, 0.1, 0.0, 0.995],
                linear_velocity: [0.3, 1e-9, 0.0],
                angular_velocity: [1.0 / 3.0, 0.0, 0.0],
                asleep: false,
            }],
            contacts: 1,
            energy: carom::Energy { kinetic: 0.1, potential: 1e20 }.into(),
            momentum: carom::Momentum::default().into(),
        };
        assert_eq!(
            serde_json::to_string(&step).unwrap(),
            concat!(
                r#"{"step":3,"time":0.30000000000000004,"bodies":[{"name":"a","position":[0.1,2.0,-0.0],"#,
                r#""rotation":[0.0,0.1,0.0,0.995],"linear_velocity":[0.3,1e-9,0.0],"#,
                r#""angular_velocity":[0.33333334,0.0,0.0],"asleep":false}],"contacts":1,"#,
                r#""energy":{"kinetic":0.1,"potential":1e+20},"#,
                r#""momentum":{"linear":[0.0,0.0,0.0],"angular":[0.0,0.0,0.0]}}"#
            )
        );
    }
}
