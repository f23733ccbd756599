//! Momentum is kept, whatever acts.

use super::*;
use crate::solver::bundle::field;
use crate::solver::contact::{begin, resume};

type Wide = Portable<4>;

fn assert_kept(problem: &Problem, before: &[Row], after: &[Row], impulses: f64) {
    let (before, after) = (problem.momentum(before), problem.momentum(after));
    let size = before[0].length() + before[1].length() + impulses;
    for (one, other) in before.into_iter().zip(after) {
        assert!((one - other).length() <= 3e-6 * size, "{one} became {other}; impulses {impulses}");
    }
}

/// Two free bodies and up to three contacts between them, with impulses in them.
fn problem(random: &mut Random) -> (Problem, Vec<Bundle>) {
    let mut problem = Problem::new([Mover::random(random), Mover::random(random)]);
    for _ in 0..1 + random.below(3) {
        let bodies = if random.below(2) == 0 { [1, 2] } else { [2, 1] };
        problem.random_touch(random, bodies);
    }
    let mut bundles = problem.bundles();
    for bundle in &mut bundles {
        for line in &field::IMPULSES[..bundle.points] {
            bundle.lines[*line].0[0] = random.range(0.0, 1.0) as f32;
        }
        for line in &field::IMPULSES[4..] {
            bundle.lines[*line].0[0] = random.range(-1.0, 1.0) as f32;
        }
    }
    (problem, bundles)
}

#[test]
fn begin_and_sweep_keep_the_momentum_of_two_free_bodies() {
    let mut random = Random(11);
    for _ in 0..500 {
        let (problem, mut bundles) = problem(&mut random);
        let start = problem.rows();
        let mut rows = start.clone();
        for bundle in &mut bundles {
            begin::<Wide>(bundle, &rows, [MARGIN as f32, 240.0]);
            resume::<Wide>(bundle, SharedRows::new(&mut rows));
        }
        assert_kept(&problem, &start, &rows, 10.0);
        for _ in 0..3 {
            for bundle in &mut bundles {
                sweep::<Wide>(bundle, SharedRows::new(&mut rows));
                assert_kept(&problem, &start, &rows, 10.0);
            }
        }
    }
}

#[test]
fn a_direct_solution_keeps_the_momentum_of_two_free_bodies() {
    let mut random = Random(12);
    for _ in 0..500 {
        let (problem, bundles) = problem(&mut random);
        assert_kept_directly(&problem, &bundles);
    }
}

#[test]
fn a_point_out_of_reach_leaves_a_direct_solution_its_momentum() {
    // Swept, such a point once asked for 1e30 m/s and was refused it: this left nothing of the velocities.
    let mut random = Random(13);
    for _ in 0..500 {
        let (problem, mut bundles) = problem(&mut random);
        for bundle in &mut bundles {
            bundle.lines[field::of_point(0, field::LEAST)].0[0] = -1e30;
        }
        assert_kept_directly(&problem, &bundles);
    }
}

fn assert_kept_directly(problem: &Problem, bundles: &[Bundle]) {
    let start = problem.rows();
    let mut rows = start.clone();
    let mut island = problem.island(bundles, &rows);
    island.solve(1e-6);
    island.write(&mut rows);
    let pressed: f32 = (0..bundles.len()).flat_map(|contact| island.impulses(contact)).map(f32::abs).sum();
    assert_kept(problem, &start, &rows, 10.0 + f64::from(pressed));
}
