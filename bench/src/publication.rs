//! What README.md shows: one run that compares all engines and measures cost against size, written into a folder.

use crate::arguments::Arguments;
use crate::engine::ENGINES;
use crate::rounds::{self, Results};
use crate::{chart, file, report};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// What is compared: every kind of scene, each so small that all of them take a few minutes.
const SPEED: &str = "--scene pyramid,pile_boxes,pile_mixed,pile_spheres,mesh_terrain,elastic_gas \
                     --count 1000 --threads 1,2 --rounds 2 --limit 60";

/// How cost against size is measured; every step costs about the same, so few of them do.
const SIZES: &str = "--sizes 100,1000,10000,100000 --steps 4 --threads 1,2 --rounds 1 --limit 60";

/// The file in the folder that the others can be made from once more.
const RESULTS: &str = "results.json";

/// Both parts.
#[derive(Debug, Serialize, Deserialize)]
pub struct Publication {
    /// All engines on all scenes.
    pub speed: Results,
    /// Cost against size.
    pub sizes: Results,
}

impl Publication {
    /// Measures both parts with the engines that `arguments` name or, if they name none, with all but Carom's variants.
    pub fn measure(arguments: &Arguments) -> Result<Self, String> {
        let names = arguments.engine_names().unwrap_or_else(|| {
            let plain = ENGINES.iter().map(|entry| entry.name).filter(|name| !name.contains('+'));
            plain.collect::<Vec<_>>().join(",")
        });
        let run = |line: &str| {
            let mut results = rounds::run(&Arguments::of_line(&format!("{line} --engine {names}"))?)?;
            results.forget_steps();
            Ok::<_, String>(results)
        };
        Ok(Self { speed: run(SPEED)?, sizes: run(SIZES)? })
    }

    /// What an earlier run wrote into the folder.
    pub fn read(folder: &Path) -> Result<Self, String> {
        file::read_json(&folder.join(RESULTS))
    }

    /// Writes everything into the folder, which is made if it is not there.
    pub fn write(&self, folder: &Path) -> Result<(), String> {
        std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        file::write_json(&folder.join(RESULTS), self)?;
        let texts = [
            ("report.txt", self.text()),
            ("tables.md", self.markdown()),
            ("speed.svg", chart::svg(&self.speed)),
            ("sizes.svg", chart::svg(&self.sizes)),
        ];
        texts.iter().try_for_each(|(name, text)| file::write(&folder.join(name), text))
    }

    /// Everything, for people.
    pub fn text(&self) -> String {
        format!("{}\n{}", report::text(&self.speed), report::text(&self.sizes))
    }

    /// The tables for a page.
    fn markdown(&self) -> String {
        let [speed, sizes] = [&self.speed, &self.sizes].map(report::markdown);
        format!("{speed}\n{sizes}")
    }

    /// Whether every measurement gave a result.
    pub fn whole(&self) -> bool {
        self.speed.failures.is_empty() && self.sizes.failures.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use clap::Parser;

    #[test]
    fn both_parts_are_good_command_lines() {
        for line in [SPEED, SIZES] {
            let arguments = Arguments::of_line(&format!("{line} --engine carom")).unwrap();
            assert!(arguments.scenes().is_ok() && arguments.engines().is_ok());
            assert_eq!(arguments.threads, [1, 2]);
        }
        assert!(Arguments::of_line("--sizes 1 --count 1").is_err());
        assert!(Arguments::try_parse_from(["bench", "--publish", "x", "--count", "9"]).is_err());
    }

    #[test]
    fn what_was_published_can_be_published_again() {
        let folder = std::env::temp_dir().join(format!("bench-publication-{}", std::process::id()));
        let speed = sample::results(sample::cases(), false);
        let publication = Publication { speed, sizes: sample::results(sample::cases(), true) };
        publication.write(&folder).unwrap();
        let texts = || {
            ["results.json", "report.txt", "tables.md", "speed.svg", "sizes.svg"]
                .map(|name| std::fs::read_to_string(folder.join(name)).unwrap())
        };
        let before = texts();
        Publication::read(&folder).unwrap().write(&folder).unwrap();
        assert_eq!(texts(), before);
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(publication.whole() && Publication::read(&folder).is_err());
    }
}
