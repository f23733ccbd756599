//! `carom explain`: one collision, step by step.

use crate::arguments::ExplainArguments;
use crate::explain_json::Explanation;
use crate::explain_text::explanation;
use crate::failure::Failure;
use crate::nearest::nearest;
use crate::output::Lines;
use crate::simulate::{Moment, Outcome, Simulation, name_of};
use crate::text::{counted, number};
use carom::conditions::conditions;
use carom::report::Impact;
use carom::{BodyId, World};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::process::ExitCode;

/// How many pairs of bodies a message lists.
const LISTED: usize = 5;

/// Which collision is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wanted {
    Index(u64),
    Between(BodyId, BodyId),
}

/// The collisions that were passed on the way to the one that is asked for.
struct Search {
    wanted: Wanted,
    found: Option<(u64, Impact)>,
    passed: BTreeMap<(BodyId, BodyId), u64>,
}

/// Simulates until the collision that was asked for, and explains it.
pub fn explain(arguments: &ExplainArguments) -> Result<ExitCode, Failure> {
    let mut simulation = Simulation::prepare(&arguments.simulation)?;
    if arguments.json {
        simulation = simulation.without_progress();
    }
    let mut search = Search::new(wanted(arguments, &simulation)?);
    let outcome = simulation.run(|moment| Ok(search.look(moment)))?;
    let Some((index, impact)) = &search.found else {
        return Err(Failure::Input(search.in_vain(&simulation, &outcome)));
    };

    let laws = conditions(&impact.hit(), arguments.about.unwrap_or(impact.point));
    let mut lines = Lines::stdout();
    if arguments.json {
        lines.json(&Explanation::new(*index, &simulation.world, impact, &laws))?;
    } else {
        lines.text(&explanation(*index, &simulation.world, impact, &laws))?;
    }
    lines.finish()?;
    Ok(ExitCode::SUCCESS)
}

fn wanted(arguments: &ExplainArguments, simulation: &Simulation) -> Result<Wanted, Failure> {
    let Some([a, b]) = arguments.between.as_deref() else {
        return Ok(Wanted::Index(arguments.collision.unwrap_or(0)));
    };
    let (first, second) = (body(simulation, a)?, body(simulation, b)?);
    if first == second {
        return Err(Failure::Input(format!("--between {a} {b}: expected two different bodies")));
    }
    Ok(Wanted::Between(first, second))
}

fn body(simulation: &Simulation, name: &str) -> Result<BodyId, Failure> {
    let named = |&&id: &&BodyId| simulation.name(id) == name;
    simulation.bodies.iter().find(named).copied().ok_or_else(|| {
        let names = simulation.bodies.iter().map(|&id| simulation.name(id));
        let hint = match nearest(name, names) {
            Some(similar) => format!("; did you mean `{similar}`?"),
            None => String::new(),
        };
        Failure::Input(format!("--between: {} has no body `{name}`{hint}", simulation.scene))
    })
}

impl Search {
    fn new(wanted: Wanted) -> Self {
        Self { wanted, found: None, passed: BTreeMap::new() }
    }

    fn look(&mut self, moment: &Moment<'_>) -> ControlFlow<()> {
        for (index, impact) in (moment.impacts_before..).zip(moment.impacts) {
            let (a, b) = (impact.a, impact.b);
            let is_wanted = match self.wanted {
                Wanted::Index(wanted) => wanted == index,
                Wanted::Between(first, second) => (a, b) == (first, second) || (b, a) == (first, second),
            };
            if is_wanted {
                self.found = Some((index, impact.clone()));
                return ControlFlow::Break(());
            }
            *self.passed.entry((a, b)).or_default() += 1;
        }
        ControlFlow::Continue(())
    }

    /// That there was no such collision, but which there were.
    fn in_vain(&self, simulation: &Simulation, outcome: &Outcome) -> String {
        let world = &simulation.world;
        let lacking = match self.wanted {
            Wanted::Index(index) => format!("no collision {index}"),
            Wanted::Between(a, b) => {
                format!("no collision between `{}` and `{}`", name_of(world, a), name_of(world, b))
            }
        };
        let seconds = number(outcome.steps as f64 * simulation.dt);
        format!(
            "{}: {lacking} in {seconds} s; there {} {}{}",
            simulation.scene,
            if outcome.collisions == 1 { "was" } else { "were" },
            counted(outcome.collisions, "collision"),
            self.pairs(world)
        )
    }

    /// Between whom collisions were, the most frequent first.
    fn pairs(&self, world: &World) -> String {
        let mut pairs: Vec<_> = self.passed.iter().collect();
        pairs.sort_by_key(|&(_, &count)| std::cmp::Reverse(count));
        let mut listed: Vec<String> = pairs
            .iter()
            .take(LISTED)
            .map(|&(&(a, b), count)| format!("`{}` and `{}` ({count})", name_of(world, a), name_of(world, b)))
            .collect();
        if pairs.len() > LISTED {
            listed.push(format!("{} other pairs", pairs.len() - LISTED));
        }
        if listed.is_empty() { String::new() } else { format!(", between {}", listed.join(", ")) }
    }
}
