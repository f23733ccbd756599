//! Which instructions there are.

use super::{InstructionSet, Machine};

#[test]
fn the_widest_one_there_is_is_taken() {
    let widest = InstructionSet::default();
    assert!(widest.is_available());
    assert!(InstructionSet::ALL.into_iter().all(|set| set <= widest || !set.is_available()));
    for set in InstructionSet::ALL {
        let taken = set.or_narrower();
        assert!(taken <= set && taken.is_available(), "{set:?}: {taken:?}");
        assert_eq!(taken == set, set.is_available(), "{set:?}: {taken:?}");
        assert!(format!("{:?}", Machine::new(set)).contains(&format!("{taken:?}")));
    }
}

#[test]
fn a_world_tells_what_it_uses() {
    for set in InstructionSet::ALL {
        let settings = crate::Settings { instruction_set: set, ..crate::Settings::default() };
        assert_eq!(crate::World::with_settings(settings).settings().instruction_set, set.or_narrower());
    }
}
