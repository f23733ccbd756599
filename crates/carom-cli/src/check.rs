//! `carom check`: every collision and every step against the laws.

use crate::arguments::RunArguments;
use crate::audit::{Auditor, Finding, Law, Place};
use crate::failure::Failure;
use crate::output::{Lines, note};
use crate::records::Records;
use crate::run::prepare;
use crate::simulate::{Moment, Outcome, Simulation, name_of};
use crate::text::{counted, number, rough};
use serde::Serialize;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::process::ExitCode;

/// How many violations are kept to be listed; all are counted.
const LISTED: usize = 1000;

/// How many bodies a finding names.
const NAMED: usize = 6;

/// A law, and one collision, or one body or more in a step.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Judged {
    law: &'static str,
    step: u64,
    /// None where the law is about a step.
    collision: Option<u64>,
    /// The first of them, where there are many.
    bodies: Vec<String>,
    /// How many there are besides.
    more_bodies: usize,
    time: f64,
    error: f64,
    tolerance: f64,
    unit: &'static str,
}

/// A law, and all that it was held against.
#[derive(Serialize)]
struct Tally {
    law: &'static str,
    says: &'static str,
    checked: u64,
    violations: u64,
    /// The one with the largest error for its tolerance.
    worst: Option<Judged>,
    tolerance_rule: &'static str,
    #[serde(skip)]
    worst_ratio: f64,
}

/// What `check --json` prints.
#[derive(Serialize)]
struct Verdict {
    scene: String,
    collisions: u64,
    laws: Vec<Tally>,
    violations: Vec<Judged>,
    #[serde(skip)]
    without_normal: u64,
    /// How far the simulation has come.
    #[serde(skip)]
    reached: Outcome,
}

/// Simulates a scene and holds its collisions and steps to the laws.
pub fn check(arguments: &RunArguments) -> Result<ExitCode, Failure> {
    let (mut simulation, mut trace) = prepare(arguments)?;
    let mut verdict = Verdict::new(&simulation);
    let mut auditor = Auditor::new(&simulation.world);
    let outcome = simulation.run(|moment| {
        verdict.look(&mut auditor, moment);
        if let Some(trace) = &mut trace {
            trace.step(moment)?;
        }
        Ok(ControlFlow::Continue(()))
    });
    let outcome = match outcome {
        Ok(outcome) => outcome,
        // What broke a law before it broke the simulation is what the user wants to know.
        Err(Failure::NonFinite(message)) if verdict.n_violations() > 0 => {
            note(&message);
            verdict.reached
        }
        Err(failure) => return Err(failure),
    };
    trace.map_or(Ok(()), Records::end)?;

    verdict.collisions = outcome.collisions;
    if verdict.without_normal > 0 && !arguments.simulation.quiet {
        let contacts = counted(verdict.without_normal, "contact");
        note(&format!("{contacts} took the normal from the record: the shapes gave none at the point"));
    }
    let mut lines = Lines::stdout();
    if arguments.json {
        lines.json(&verdict)?;
    } else {
        lines.text(&verdict.text(outcome.steps, outcome.steps as f64 * simulation.dt))?;
    }
    lines.finish()?;
    Ok(if verdict.n_violations() == 0 { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

impl Verdict {
    fn new(simulation: &Simulation) -> Self {
        let tally = |law: Law| Tally {
            law: law.key(),
            says: law.says(),
            checked: 0,
            violations: 0,
            worst: None,
            tolerance_rule: law.tolerance_rule(),
            worst_ratio: -1.0,
        };
        Self {
            scene: simulation.scene.clone(),
            collisions: 0,
            laws: Law::ALL.into_iter().map(tally).collect(),
            violations: Vec::new(),
            without_normal: 0,
            reached: Outcome::default(),
        }
    }

    fn look(&mut self, auditor: &mut Auditor, moment: &Moment<'_>) {
        let audit = auditor.step(moment.world, moment.impacts);
        self.without_normal += audit.without_normal;
        self.reached.steps = moment.step;
        self.reached.collisions = moment.impacts_before + moment.impacts.len() as u64;
        for finding in &audit.findings {
            self.enter(finding, moment);
        }
    }

    fn enter(&mut self, finding: &Finding, moment: &Moment<'_>) {
        let tally = &mut self.laws[finding.law as usize];
        tally.checked += 1;
        // No number is the worst of all, and JSON has no word for it.
        let ratio = if finding.ratio().is_nan() { f64::INFINITY } else { finding.ratio() };
        let is_worst = ratio > tally.worst_ratio;
        let is_listed = finding.is_violation() && self.violations.len() < LISTED;
        if is_worst || is_listed {
            let judged = judged(finding, moment);
            if is_listed {
                self.violations.push(judged.clone());
            }
            if is_worst {
                tally.worst = Some(judged);
                tally.worst_ratio = ratio;
            }
        }
        tally.violations += u64::from(finding.is_violation());
    }

    fn n_violations(&self) -> u64 {
        self.laws.iter().map(|tally| tally.violations).sum()
    }

    fn text(&self, steps: u64, seconds: f64) -> String {
        let mut text = format!(
            "{}\n{} in {} ({} s)\n\n",
            self.scene,
            counted(self.collisions, "collision"),
            counted(steps, "step"),
            number(seconds)
        );
        let _ = writeln!(
            text,
            "  {:<18}{:>8}{:>10}   worst, and the tolerance there",
            "law", "checked", "violated"
        );
        for tally in &self.laws {
            let mark = if tally.violations == 0 { '✓' } else { '✗' };
            let worst = tally.worst.as_ref().map_or("-".to_owned(), |worst| {
                format!("{} of {} {}", rough(worst.error), rough(worst.tolerance), worst.unit)
            });
            let law = tally.law.replace('_', " ");
            let _ = writeln!(text, "{mark} {law:<18}{:>8}{:>10}   {worst}", tally.checked, tally.violations);
        }
        text.push_str(
            "\nTolerances allow for geometry that is worked out anew and states that are told in single precision, ε = 4·2⁻²³;\n\
             and for what a substep h can not tell, where contacts hold bodies.\n",
        );
        for tally in &self.laws {
            let _ = writeln!(
                text,
                "  {:<18}{}\n{:20}{}",
                tally.law.replace('_', " "),
                tally.says,
                "",
                tally.tolerance_rule
            );
        }
        text.push('\n');
        match self.n_violations() {
            0 => text.push_str("Every law held.\n"),
            count => {
                let _ = writeln!(text, "{}:", counted(count, "violation"));
                for violation in &self.violations {
                    let _ = writeln!(text, "  {}", violation.text());
                }
                let unlisted = count - self.violations.len() as u64;
                if unlisted > 0 {
                    let _ = writeln!(text, "  and {unlisted} more");
                }
            }
        }
        text
    }
}

impl Judged {
    fn text(&self) -> String {
        let mut bodies = self.bodies.join(" and ");
        if self.more_bodies > 0 {
            let _ = write!(bodies, " and {} more", self.more_bodies);
        }
        let place = match self.collision {
            Some(collision) => format!("of collision {collision} ({bodies})"),
            None => format!("of {bodies} in step {}", self.step),
        };
        format!(
            "{} {place} at t = {} s: off by {} {}, tolerance {}",
            self.law.replace('_', " "),
            number(self.time),
            rough(self.error),
            self.unit,
            rough(self.tolerance)
        )
    }
}

fn judged(finding: &Finding, moment: &Moment<'_>) -> Judged {
    let (collision, bodies, time) = match &finding.place {
        Place::Collision(index) => {
            let impact = &moment.impacts[*index];
            (Some(moment.impacts_before + *index as u64), vec![impact.a, impact.b], impact.time)
        }
        Place::Bodies(bodies, time) => (None, bodies.clone(), *time),
    };
    Judged {
        law: finding.law.key(),
        step: moment.step,
        collision,
        bodies: bodies.iter().take(NAMED).map(|&id| name_of(moment.world, id).to_owned()).collect(),
        more_bodies: bodies.len().saturating_sub(NAMED),
        time,
        error: finding.error,
        tolerance: finding.tolerance,
        unit: finding.law.unit(),
    }
}
