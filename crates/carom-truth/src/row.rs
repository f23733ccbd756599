//! What a row of the suite is made of.

/// The engines that figures of others belong to, in the order of [`Figure::peers`].
pub const PEERS: [&str; 4] = ["Rapier", "Box3D", "Jolt", "PhysX"];

/// Where the figures of other engines come from.
pub const PEERS_SOURCE: &str = "rapier3d 0.36.1, Box3D 0.1, Jolt 5.5, PhysX 5.1.3, each with its default settings at \
     the same dt, measured once by one program that drives all of them through these scenes (random ones with other \
     numbers); RaiSim as published with SimBenchmark";

/// How near to the truth a figure must come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// By so much, in the figure's unit.
    Within(f64),
    /// By this share of the truth.
    Share(f64),
}

/// One quantity of a row.
#[derive(Clone, Debug)]
pub struct Figure {
    /// What is measured.
    pub what: String,
    /// Its unit; empty for pure numbers.
    pub unit: &'static str,
    /// What it must be.
    pub truth: f64,
    /// How near to the truth it must come.
    pub goal: Goal,
    /// What other engines reach in this scene, in the order of [`PEERS`].
    pub peers: Option<[&'static str; 4]>,
    /// Why the goal is not reached yet.
    pub missed: Option<&'static str>,
}

impl Figure {
    /// A figure that nobody else has been measured for.
    pub fn new(what: impl Into<String>, unit: &'static str, truth: f64, goal: Goal) -> Self {
        Self { what: what.into(), unit, truth, goal, peers: None, missed: None }
    }

    /// What other engines reach.
    pub fn peers(mut self, peers: [&'static str; 4]) -> Self {
        self.peers = Some(peers);
        self
    }

    /// Why the goal is not reached yet.
    pub fn missed(mut self, reason: &'static str) -> Self {
        self.missed = Some(reason);
        self
    }

    /// How far from the truth `measured` may be, in the figure's unit.
    pub fn tolerance(&self) -> f64 {
        match self.goal {
            Goal::Within(distance) => distance,
            Goal::Share(share) => share * self.truth.abs(),
        }
    }

    /// Whether `measured` is as near to the truth as it must be.
    pub fn is_reached(&self, measured: f64) -> bool {
        (measured - self.truth).abs() <= self.tolerance()
    }
}

/// One scene, and what must come of it.
pub struct Row {
    /// What it is called on the command line.
    pub name: String,
    /// What happens.
    pub what: String,
    /// The law that decides the outcome.
    pub law: &'static str,
    /// What is measured.
    pub figures: Vec<Figure>,
    measure: Box<dyn Fn() -> Vec<f64> + Send + Sync>,
}

impl Row {
    /// A row whose figures are what `measure` returns, in that order.
    pub fn new(
        name: impl Into<String>,
        what: impl Into<String>,
        law: &'static str,
        measure: impl Fn() -> Vec<f64> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.into(), what: what.into(), law, figures: Vec::new(), measure: Box::new(measure) }
    }

    /// Adds the next figure.
    pub fn figure(mut self, figure: Figure) -> Self {
        self.figures.push(figure);
        self
    }

    /// Runs the scene. One number for each figure.
    pub fn measure(&self) -> Vec<f64> {
        (self.measure)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goals_are_distances_or_shares_and_what_is_no_number_reaches_none() {
        let figure = Figure::new("way", "m", 20.0, Goal::Share(0.01));
        assert!(figure.is_reached(19.81) && !figure.is_reached(20.21) && !figure.is_reached(f64::NAN));
        let figure = Figure::new("way", "m", 0.0, Goal::Within(0.0));
        assert!(figure.is_reached(0.0) && !figure.is_reached(-1e-300));
    }
}
