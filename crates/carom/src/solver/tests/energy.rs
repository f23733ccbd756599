//! Contacts that want nothing but not to close take energy away.

use super::*;

#[test]
fn sweeps_from_zero_impulses_never_add_kinetic_energy() {
    let mut random = Random(41);
    for _ in 0..400 {
        let count = 1 + random.below(8);
        let problem = Problem::random(&mut random, count);
        let (mut rows, mut bundles) = (problem.rows(), problem.bundles());
        let start = problem.energy(&rows);
        for number in 0..40 {
            for bundle in &mut bundles {
                sweep::<Portable<4>>(bundle, SharedRows::new(&mut rows));
                let energy = problem.energy(&rows);
                assert!(energy <= start * (1.0 + 1e-5), "sweep {number}: {start} J have become {energy} J");
            }
        }
    }
}
