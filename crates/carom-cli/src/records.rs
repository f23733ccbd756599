//! What a run writes step by step: the trace, the ledger.

use crate::arguments::RunArguments;
use crate::failure::Failure;
use crate::ledger::LedgerFile;
use crate::simulate::{Moment, Simulation};
use crate::trace::Trace;

/// The files that were asked for.
pub struct Records {
    trace: Option<Trace>,
    ledger: Option<LedgerFile>,
}

impl Records {
    /// Begins the files; none if none is wanted.
    pub fn begin(arguments: &RunArguments, simulation: &mut Simulation) -> Result<Option<Self>, Failure> {
        let every = arguments.every.unwrap_or(1);
        if arguments.ledger.is_some() {
            simulation.world.keep_ledger(true);
        }
        let trace = arguments.trace.as_ref().map(|path| Trace::begin(path, simulation, every)).transpose()?;
        let ledger =
            arguments.ledger.as_ref().map(|path| LedgerFile::begin(path, simulation.dt)).transpose()?;
        Ok((trace.is_some() || ledger.is_some()).then_some(Self { trace, ledger }))
    }

    /// Writes what is due at the end of a step.
    pub fn step(&mut self, moment: &Moment<'_>) -> Result<(), Failure> {
        if let Some(trace) = &mut self.trace {
            trace.step(moment)?;
        }
        self.ledger.as_mut().map_or(Ok(()), |ledger| ledger.step(moment))
    }

    /// Hands over the last lines.
    pub fn end(self) -> Result<(), Failure> {
        self.trace.map_or(Ok(()), Trace::end)?;
        self.ledger.map_or(Ok(()), LedgerFile::end)
    }
}
