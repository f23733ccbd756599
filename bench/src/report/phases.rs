//! Where the time of a step goes, phase by phase.

use crate::phase::Phase;
use crate::rounds::{Case, Entrant};
use crate::table::{Table, short};

/// Whether phases were measured in this case.
pub fn measured(case: &Case) -> bool {
    case.entrants.iter().filter_map(Entrant::first).any(|first| !first.phases.is_empty())
}

/// A table for each engine that told.
pub fn text(case: &Case) -> String {
    let tables = case.entrants.iter().filter_map(|entrant| {
        let steps: usize = entrant.rounds.iter().map(|round| round.measurement.step_ms.len()).sum();
        let phases = Phase::sum(entrant.rounds.iter().map(|round| &round.measurement.phases[..]));
        (steps > 0 && !phases.is_empty()).then(|| table(&entrant.engine, &phases, steps as f64).text())
    });
    tables.collect::<Vec<_>>().join("\n")
}

/// A row for each phase that has begun at all, and one for the whole step.
fn table(engine: &str, phases: &[Phase], steps: f64) -> Table {
    let mut table = Table::new(&[engine, "ms a step", "share %", "calls a step"]);
    let whole: f64 = phases.iter().map(|phase| phase.ms).sum();
    for phase in phases.iter().filter(|phase| phase.calls > 0) {
        let share = format!("{:.1}", 100.0 * phase.ms / whole);
        table.row(vec![
            phase.name.clone(),
            short(phase.ms / steps),
            share,
            short(phase.calls as f64 / steps),
        ]);
    }
    table.row(vec!["whole step".to_string(), short(whole / steps), "100.0".to_string()]);
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn shares_are_of_all_rounds_and_come_to_the_whole() {
        let mut case = sample::cases().remove(0);
        assert!(!measured(&case));
        let phase = |name: &str, ms: f64, calls: u64| Phase { name: name.into(), ms, calls };
        let entrant = &mut case.entrants[0];
        entrant.rounds[0].measurement.phases =
            vec![phase("find", 1.0, 1), phase("solve", 2.0, 4), phase("never", 0.0, 0)];
        let mut second = entrant.rounds[0].measurement.clone();
        second.phases[1].ms = 4.0;
        entrant.rounds.push(crate::rounds::Round { round: 1, measurement: second });
        assert!(measured(&case));
        let text = text(&case);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(rows[1], ["find", "1.00", "25.0", "1.00"]);
        assert_eq!(rows[2], ["solve", "3.00", "75.0", "4.00"]);
        assert_eq!(rows[3], ["whole", "step", "4.00", "100.0"]);
    }
}
