//! The command line.

use crate::engine::{self, ENGINES};
use crate::scene::{self, DEFAULT_SCENES, Growth, SCENES, SIZES_SCENES, Size};
use clap::Parser;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::str::FromStr;

/// Runs the same scenes through Carom and its peers, interleaved, each measurement in a process of its own.
///
/// Speed is reported as ratios to Carom, quality (overlap, displacement, rest, energy) beside it. Only ratios of one run
/// mean anything; README.md says how to read them.
#[derive(Debug, Parser)]
#[command(version, after_help = lists())]
pub struct Arguments {
    /// Scenes, separated by commas, or `all` [default: pyramid,pile_boxes,pile_mixed]
    #[arg(long = "scene", value_name = "NAMES")]
    scenes: Option<Names>,

    /// Engines, separated by commas [default: all that are compiled in]
    #[arg(long = "engine", value_name = "NAMES")]
    engines: Option<Names>,

    /// Numbers of threads, separated by commas
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', default_value = "1", value_parser = at_least_one)]
    pub threads: Vec<usize>,

    /// How often everything is measured
    #[arg(long, default_value = "3", value_parser = at_least_one)]
    pub rounds: usize,

    /// Steps of 1/60 s in place of the scene's own number
    #[arg(long, value_parser = at_least_one)]
    pub steps: Option<usize>,

    /// Dynamic bodies of piles, terrain and gas; the pit keeps its proportions
    #[arg(long, value_parser = at_least_one)]
    count: Option<usize>,

    /// Cost against size: runs each scene with each of these counts, separated by commas [scenes: packed_boxes]
    #[arg(
        long,
        value_name = "NUMBERS",
        value_delimiter = ',',
        value_parser = at_least_one,
        conflicts_with_all = ["count", "base", "settle"]
    )]
    sizes: Vec<usize>,

    /// Boxes in the lowest course of pyramids
    #[arg(long, value_parser = at_least_one)]
    base: Option<usize>,

    /// Friction of every surface that rubs, in place of 0.5
    #[arg(long, value_name = "COEFFICIENT", value_parser = coefficient)]
    pub friction: Option<f32>,

    /// Instead of timing: run each scene for so long and tell from when on nothing is faster than 1 mm/s
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub settle: Option<f64>,

    /// Instead of comparing: what the steps of Carom spend their time on; needs the cargo feature `profile`
    #[arg(long, conflicts_with_all = ["engines", "settle", "sizes"])]
    pub phases: bool,

    /// A measurement that takes longer stops where it is, and says so
    #[arg(long, value_name = "SECONDS", default_value = "600", value_parser = limit)]
    pub limit: f64,

    /// Write everything that was measured to this file
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,

    /// Draw a chart into this file: bars, or with `--sizes` lines
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,

    /// What README.md shows: a comparison on six scenes and cost against size, as text, JSON, tables and charts in a folder
    #[arg(
        long,
        value_name = "FOLDER",
        conflicts_with_all = [
            "scenes", "threads", "rounds", "steps", "count", "sizes", "base", "friction", "settle", "phases", "limit",
            "json", "svg",
        ]
    )]
    pub publish: Option<PathBuf>,

    /// Measure nothing: report, and draw, what an earlier run wrote with `--json`, or the folder of an earlier `--publish`
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    pub from: Option<PathBuf>,

    /// One measurement, described as the program itself does it
    #[arg(long, hide = true, value_name = "JOB")]
    pub worker: Option<String>,
}

/// Names separated by commas.
#[derive(Clone, Debug)]
struct Names(Vec<String>);

impl FromStr for Names {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(
            text.split(',').map(|name| name.trim().to_string()).filter(|name| !name.is_empty()).collect(),
        ))
    }
}

impl Arguments {
    /// What a command line without the program's name asks for.
    pub fn of_line(line: &str) -> Result<Self, String> {
        let words = ["bench"].into_iter().chain(line.split_whitespace());
        Self::try_parse_from(words).map_err(|error| error.to_string())
    }

    /// The engines asked for as the command line has them; `None` if it does not say.
    pub fn engine_names(&self) -> Option<String> {
        self.engines.as_ref().map(|Names(names)| names.join(","))
    }

    /// How large scenes are to be: one size, or from small to large those of `--sizes`.
    pub fn sizes(&self) -> Vec<Size> {
        if !self.grows() {
            return vec![Size { count: self.count, base: self.base }];
        }
        let counts: BTreeSet<usize> = self.sizes.iter().copied().collect();
        counts.into_iter().map(|count| Size { count: Some(count), base: None }).collect()
    }

    /// Whether cost against size is asked for.
    pub fn grows(&self) -> bool {
        !self.sizes.is_empty()
    }

    /// The scenes asked for. Those for `--sizes` must know a count.
    pub fn scenes(&self) -> Result<Vec<&'static scene::Entry>, String> {
        let able = |entry: &&scene::Entry| !self.grows() || entry.growth != Growth::None;
        match &self.scenes {
            None => {
                let names = if self.grows() { &SIZES_SCENES[..] } else { &DEFAULT_SCENES[..] };
                Ok(names.iter().filter_map(|name| scene::find(name)).collect())
            }
            Some(Names(names)) if names[..] == ["all"] => Ok(SCENES.iter().filter(able).collect()),
            Some(Names(names)) => {
                let known = SCENES.iter().filter(able).map(|entry| entry.name);
                names
                    .iter()
                    .map(|name| {
                        let found = scene::find(name).filter(able);
                        let what = if self.grows() { "scene of many sizes" } else { "scene" };
                        found.ok_or_else(|| unknown(what, name, known.clone()))
                    })
                    .collect()
            }
        }
    }

    /// The engines asked for, each once, those to compare with first.
    pub fn engines(&self) -> Result<Vec<&'static engine::Entry>, String> {
        if self.phases {
            let telling: Vec<_> = ENGINES.iter().filter(|entry| entry.tells_phases).collect();
            let nobody = "no engine here tells its phases; build with `--features profile`";
            return if telling.is_empty() { Err(nobody.to_string()) } else { Ok(telling) };
        }
        let Some(Names(names)) = &self.engines else { return Ok(ENGINES.iter().collect()) };
        let known = ENGINES.iter().map(|entry| entry.name);
        if let Some(name) = names.iter().find(|name| engine::find(name).is_none()) {
            return Err(unknown("engine", name, known) + "; others need a cargo feature (see README.md)");
        }
        Ok(ENGINES.iter().filter(|entry| names.iter().any(|name| name == entry.name)).collect())
    }
}

fn unknown(what: &str, name: &str, known: impl Iterator<Item = &'static str>) -> String {
    format!("no {what} `{name}`; there are {}", known.collect::<Vec<_>>().join(", "))
}

fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse()
        .ok()
        .filter(|number| *number >= 1)
        .ok_or_else(|| "expected a whole number of at least 1".into())
}

fn coefficient(text: &str) -> Result<f32, String> {
    text.parse()
        .ok()
        .filter(|number: &f32| (0.0..=10.0).contains(number))
        .ok_or_else(|| "expected 0 to 10".into())
}

fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|number: &f64| *number > 0.0 && number.is_finite())
        .ok_or_else(|| "expected seconds".into())
}

/// A day is enough for any measurement.
fn limit(text: &str) -> Result<f64, String> {
    seconds(text)
        .and_then(|limit| if limit <= 86_400.0 { Ok(limit) } else { Err("expected at most 86400".into()) })
}

/// What can be asked for.
fn lists() -> String {
    let mut text = String::from("Scenes:\n");
    for entry in SCENES {
        text += &format!("  {:<14} {}\n", entry.name, entry.about);
    }
    text += "\nEngines:\n";
    for entry in ENGINES {
        text += &format!("  {:<14} {}; {}\n", entry.name, entry.version, entry.settings);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Arguments {
        Arguments::try_parse_from(line.split_whitespace()).expect("a good command line")
    }

    #[test]
    fn names_become_entries() {
        let arguments = parse("bench --scene pile_boxes,pyramid --engine carom --threads 1,2 --count 2000");
        let names: Vec<_> = arguments.scenes().unwrap().iter().map(|entry| entry.name).collect();
        assert_eq!(names, ["pile_boxes", "pyramid"]);
        assert_eq!(arguments.engines().unwrap().len(), 1);
        assert_eq!(arguments.threads, [1, 2]);
        assert_eq!(arguments.sizes(), [Size { count: Some(2000), base: None }]);
        assert_eq!(parse("bench --scene all").scenes().unwrap().len(), SCENES.len());
        assert_eq!(parse("bench").engines().unwrap().len(), ENGINES.len());
    }

    #[test]
    fn sizes_come_in_order_and_only_to_scenes_that_know_a_count() {
        let arguments = parse("bench --sizes 500,100,500");
        let counts: Vec<_> = arguments.sizes().iter().map(|size| size.count).collect();
        assert_eq!(counts, [Some(100), Some(500)]);
        assert_eq!(arguments.scenes().unwrap()[0].name, "packed_boxes");
        assert!(parse("bench --sizes 9 --scene all").scenes().unwrap().len() < SCENES.len());
        assert!(parse("bench --sizes 9 --scene pyramid").scenes().err().unwrap().contains("pile_boxes"));
    }

    #[test]
    fn phases_are_for_who_tells_them() {
        let engines = parse("bench --phases").engines();
        assert_eq!(engines.is_ok(), cfg!(feature = "profile"));
        assert!(engines.iter().flatten().all(|entry| entry.name == "carom"));
    }

    #[test]
    fn what_is_not_there_is_named() {
        assert!(parse("bench --scene pyramids").scenes().err().unwrap().contains("pile_boxes"));
        assert!(parse("bench --engine bullet").engines().err().unwrap().contains("carom"));
        for bad in [
            "--threads 0",
            "--rounds x",
            "--settle -1",
            "--settle inf",
            "--friction -1",
            "--sizes 9 --count 9",
            "--phases --settle 9",
        ] {
            assert!(Arguments::try_parse_from(format!("bench {bad}").split_whitespace()).is_err(), "{bad}");
        }
    }
}
