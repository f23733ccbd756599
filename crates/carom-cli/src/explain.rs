//! `carom explain`: one collision, step by step.

use crate::arguments::ExplainArguments;
use crate::explain_json::Explanation;
use crate::explain_text::explanation;
use crate::failure::Failure;
use crate::nearest::nearest;
use crate::output::Lines;
use crate::simulate::{Moment, Outcome, Simulation, name_of};
use crate::text::{counted, number};
use carom::conditions::{Conditions, Round};
use carom::math::DVec3;
use carom::report::{Impact, instants, round_of};
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

/// A collision, with all that was struck at the same instant.
#[derive(Clone)]
pub struct Collision {
    /// Its number.
    pub index: u64,
    /// The record of it.
    pub impact: Impact,
    /// What was resolved at once with it, itself included, and its place there.
    pub round: Round,
    pub strike: usize,
    /// The others of the instant, in all rounds, each with its number.
    pub others: Vec<(u64, Impact)>,
}

impl Collision {
    /// The collision at `place` among those of a step.
    pub fn of(moment: &Moment<'_>, place: usize) -> Self {
        let (round, strike) = round_of(moment.impacts, place);
        let number = |place: usize| moment.impacts_before + place as u64;
        let instant = instants(moment.impacts).into_iter().find(|instant| instant.contains(&place));
        let others = instant.unwrap_or_default().into_iter().filter(|&other| other != place);
        let others = others.map(|other| (number(other), moment.impacts[other].clone())).collect();
        Self { index: number(place), impact: moment.impacts[place].clone(), round, strike, others }
    }

    /// How the laws held, angular momentum about a point or else about that of the collision.
    pub fn conditions(&self, about: Option<DVec3>) -> Conditions {
        self.round.conditions(self.strike, about.unwrap_or(self.impact.point))
    }

    /// Whether it was resolved together with others.
    pub fn is_among_others(&self) -> bool {
        self.round.strikes.len() > 1
    }
}

/// The collisions that were passed on the way to the one that is asked for.
struct Search {
    wanted: Wanted,
    found: Option<Collision>,
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
    let Some(collision) = &search.found else {
        return Err(Failure::Input(search.in_vain(&simulation, &outcome)));
    };

    let laws = collision.conditions(arguments.about);
    let mut lines = Lines::stdout();
    if arguments.json {
        lines.json(&Explanation::new(&simulation.world, collision, &laws))?;
    } else {
        lines.text(&explanation(&simulation.world, collision, &laws))?;
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
        for (place, impact) in moment.impacts.iter().enumerate() {
            let index = moment.impacts_before + place as u64;
            let (a, b) = (impact.a, impact.b);
            let is_wanted = match self.wanted {
                Wanted::Index(wanted) => wanted == index,
                Wanted::Between(first, second) => (a, b) == (first, second) || (b, a) == (first, second),
            };
            if is_wanted {
                self.found = Some(Collision::of(moment, place));
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
