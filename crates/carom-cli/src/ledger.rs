//! The ledger: momentum and energy of every step, by cause. As a file, a row a step (CSV), and for the summary.

use crate::failure::Failure;
use crate::output::Lines;
use crate::simulate::{Moment, name_of};
use crate::text::{number, rough};
use carom::ledger::{Books, Posts};
use carom::math::DVec3;
use carom::{Momentum, World};
use serde::Serialize;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Writes a simulation's ledger.
pub struct LedgerFile {
    lines: Lines,
    dt: f64,
}

impl LedgerFile {
    /// Begins a file with the header; steps are `dt` long (s).
    pub fn begin(path: &Path, dt: f64) -> Result<Self, Failure> {
        let mut file = Self { lines: Lines::create(path)?, dt };
        file.lines.text(&header())?;
        Ok(file)
    }

    /// Writes the step.
    pub fn step(&mut self, moment: &Moment<'_>) -> Result<(), Failure> {
        let time = moment.step as f64 * self.dt;
        self.lines.text(&row(moment.step, time, moment.world.ledger().last_step()))
    }

    /// Hands over the last lines.
    pub fn end(mut self) -> Result<(), Failure> {
        self.lines.finish()
    }
}

const AXES: [&str; 6] = ["px", "py", "pz", "lx", "ly", "lz"];

/// The names of all columns.
fn header() -> String {
    let posts = Posts::default();
    let mut names: Vec<String> = ["step", "time"].iter().chain(&AXES).map(ToString::to_string).collect();
    names.extend(["kinetic", "potential", "elastic"].map(str::to_owned));
    for (account, _) in posts.momenta() {
        names.extend(AXES.map(|axis| format!("{account}_{axis}")));
    }
    names.extend(posts.energies().map(|(cause, _)| cause.to_owned()));
    names.extend(AXES.map(|axis| format!("residual_{axis}")));
    names.push("residual_energy".to_owned());
    names.join(",")
}

fn row(step: u64, time: f64, books: &Books) -> String {
    let six = |linear: DVec3, angular: DVec3| linear.to_array().into_iter().chain(angular.to_array());
    let (end, residual) = (&books.end, books.residual());
    let mut values = vec![time];
    values.extend(six(end.momentum.linear, end.momentum.angular));
    values.extend([end.energy.kinetic, end.energy.potential, end.elastic]);
    for (_, momentum) in books.posts.momenta() {
        values.extend(six(momentum.linear, momentum.angular));
    }
    values.extend(books.posts.energies().map(|(_, value)| value));
    values.extend(six(residual.linear, residual.angular));
    values.push(residual.energy);
    let mut row = step.to_string();
    for value in values {
        // As in the trace: the shortest that reads back bit for bit.
        let _ = write!(row, ",{value:?}");
    }
    row
}

/// The totals of all steps, and which step and body fitted worst.
#[derive(Serialize)]
pub struct LedgerTotals {
    #[serde(flatten)]
    posts: serde_json::Map<String, serde_json::Value>,
    residual: ResidualTotals,
    worst_residual: Option<WorstPost>,
    worst_artefact: Option<WorstPost>,
    /// Energy that artefacts have moved, against all that went through the books.
    artefact_share: f64,
}

/// What no cause explains, and its share of what went through the books; the tolerance is for these shares.
#[derive(Serialize)]
struct ResidualTotals {
    linear: [f64; 3],
    angular: [f64; 3],
    energy: f64,
    relative: [f64; 3],
    tolerance: f64,
}

/// A post that stands out.
#[derive(Serialize)]
struct WorstPost {
    post: &'static str,
    step: u64,
    time: f64,
    body: Option<String>,
    amount: f64,
    relative: f64,
}

impl LedgerTotals {
    /// Those of a world that keeps a ledger.
    pub fn new(world: &World) -> Self {
        let ledger = world.ledger();
        let total = ledger.total();
        let residual = total.residual();
        let worst = |worst: &carom::ledger::Worst| WorstPost {
            post: worst.post,
            step: worst.step,
            time: worst.time,
            body: worst.body.map(|body| name_of(world, body).to_owned()),
            amount: worst.amount,
            relative: worst.relative,
        };
        let vectors =
            |it: &Momentum| json!({ "linear": it.linear.to_array(), "angular": it.angular.to_array() });
        let momenta = total.posts.momenta().map(|(account, momentum)| (account, vectors(&momentum)));
        let energies = total.posts.energies().map(|(cause, value)| (cause, json!(value)));
        let posts = momenta.into_iter().chain(energies).map(|(name, value)| (name.to_owned(), value));
        let throughput = total.throughput()[2];
        Self {
            posts: posts.collect(),
            residual: ResidualTotals {
                linear: residual.linear.to_array(),
                angular: residual.angular.to_array(),
                energy: residual.energy,
                relative: total.relative_residual(),
                tolerance: Books::TOLERANCE,
            },
            worst_residual: ledger.worst_residual().map(worst),
            worst_artefact: ledger.worst_artefact().map(worst),
            artefact_share: if throughput > 0.0 { ledger.artefacts() / throughput } else { 0.0 },
        }
    }

    /// For people: what went where, then what is not modelled, then what is not explained. Each with what it is about.
    pub fn rows(&self) -> Vec<(&'static str, String)> {
        let energies = self.posts.iter().filter_map(|(cause, value)| Some((cause, value.as_f64()?)));
        let mut rows: Vec<(&str, String)> = energies
            .filter(|(_, value)| *value != 0.0)
            .map(|(cause, value)| ("", format!("{:<22}{} J", cause.replace('_', " "), number(value))))
            .collect();
        if let Some(first) = rows.first_mut() {
            first.0 = "energy by cause";
        }
        if let Some(worst) = &self.worst_artefact {
            let share = rough(100.0 * self.artefact_share);
            rows.push((
                "not modelled",
                format!("{share} % of this; most: {} J by {},", rough(worst.amount), worst.name()),
            ));
            rows.push(("", worst.place()));
        }
        let [p, l, e] =
            [length(self.residual.linear), length(self.residual.angular), self.residual.energy].map(rough);
        rows.push(("not explained", format!("{p} N·s, {l} N·m·s, {e} J")));
        if let Some(worst) = &self.worst_residual {
            let verdict = if worst.relative <= self.residual.tolerance { "within" } else { "BEYOND" };
            let (relative, tolerance) = (rough(worst.relative), rough(self.residual.tolerance));
            rows.push(("", format!("at most {relative} of a step's posts, {verdict} {tolerance}:")));
            rows.push(("", format!("{}, {}", worst.name(), worst.place())));
        } else {
            let tolerance = rough(self.residual.tolerance);
            rows.push(("", format!("in no step more than its rounding, within {tolerance} of its posts")));
        }
        rows
    }
}

fn length(v: [f64; 3]) -> f64 {
    DVec3::from_array(v).length()
}

impl WorstPost {
    fn name(&self) -> String {
        self.post.replace('_', " ")
    }

    fn place(&self) -> String {
        let body = self.body.as_ref().map_or(String::new(), |body| format!(" at {body}"));
        format!("in step {} ({} s){body}", self.step, number(self.time))
    }
}
