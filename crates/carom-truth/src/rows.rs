//! The rows of the suite, by topic.

mod benchmark;
mod bounce;
mod clusters;
mod fast;
mod flight;
mod friction;
mod hits;
mod line;
mod racks;
mod stacks;
mod tiles;
mod together;

use crate::row::Row;

/// All rows, in the order in which they are shown.
pub fn suite() -> Vec<Row> {
    [
        flight::rows(),
        hits::rows(),
        bounce::rows(),
        friction::rows(),
        stacks::rows(),
        line::rows(),
        together::rows(),
        racks::rows(),
        clusters::rows(),
        fast::rows(),
        tiles::rows(),
        benchmark::rows(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
