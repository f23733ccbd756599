//! The truth suite: scenes whose outcome mechanics fixes, and how near to it Carom comes.
//!
//! Every [`Row`] is one scene: its name, what happens in it, the law that decides it, how it is measured, and a few
//! [`Figure`]s, each with its truth, how near to it the engine must come, and what other engines reach.
//!
//! | module | what it has |
//! |---|---|
//! | [`row`] | rows, figures, goals |
//! | [`closed`] | the closed forms, each tested against integration of its own |
//! | [`balls`] | elastic balls from event to event, for what has no closed form |
//! | `rows/` | the rows themselves, by topic |
//! | `scene`, `books`, `random` | what the rows are built with: bodies, sums of energy and momentum, chance |
//!
//! Unless a row says otherwise, a step is 1/60 s and all settings are the defaults. Figures come from what a user of the
//! engine can read: positions in double precision, velocities and rotations in single precision.
//!
//! ```
//! let suite = carom_truth::suite();
//! let row = suite.iter().find(|row| row.name == "free-fall").expect("the suite has it");
//! let measured = row.measure();
//! assert!(row.figures[0].is_reached(measured[0]));
//! ```

pub mod balls;
mod books;
pub mod closed;
mod random;
pub mod row;
mod rows;
mod scene;

pub use row::{Figure, Goal, PEERS, PEERS_SOURCE, Row};
pub use rows::suite;
