//! The graph against a model of it.

use super::*;
use crate::math::DMat3;
use crate::solver::direct::Mobility;
use crate::solver::lanes::Row;
use crate::solver::tests::Random;

/// A contact as the model knows it; its number is written into its lane.
struct Known {
    id: ContactId,
    rows: [u32; 2],
    number: f32,
}

/// Where a lane keeps a number of no meaning for these tests.
const NUMBER: usize = field::of_point(3, field::BASE);

fn numbered(number: f32, points: usize) -> Lane {
    let mut lane = [0.0; field::COUNT];
    lane[NUMBER] = number;
    (0..points).for_each(|point| lane[field::of_point(point, field::MASS)] = 1.0);
    lane
}

#[test]
fn contacts_come_and_go_and_their_bodies_get_other_rows() {
    for seed in 0..8 {
        let mut random = Random(seed);
        let mut graph = Graph::default();
        let mut known: Vec<Known> = Vec::new();
        // Of each row: whether it is movable. Row 0 is the world's.
        let mut movable = vec![false];
        let mut next = 1.0;
        for round in 0..3000 {
            match random.below(if round % 1000 < 600 { 8 } else { 16 }) {
                0 => movable.push(random.below(6) > 0),
                1 if movable.len() > 2 => {
                    // A body goes, first its contacts, and that of the last row gets its row.
                    let (row, last) = (1 + random.below(movable.len() - 1), movable.len() - 1);
                    known.retain(|contact| {
                        let stays = !contact.rows.contains(&(row as u32));
                        if !stays {
                            graph.remove(contact.id);
                        }
                        stays
                    });
                    movable.swap_remove(row);
                    if row != last {
                        graph.rename_row(last as u32, row as u32);
                        let rows = known.iter_mut().flat_map(|contact| &mut contact.rows);
                        rows.filter(|it| **it == last as u32).for_each(|it| *it = row as u32);
                    }
                }
                2..7 if movable.len() > 2 => {
                    let (a, b) = (random.below(movable.len()), random.below(movable.len()));
                    if a != b && (movable[a] || movable[b]) {
                        let rows = [a as u32, b as u32];
                        let lane = numbered(next, 1 + random.below(4));
                        let id = graph.insert(rows, [movable[a], movable[b]], &lane);
                        known.push(Known { id, rows, number: next });
                        next += 1.0;
                    }
                }
                7 if !known.is_empty() => {
                    let contact = random.below(known.len());
                    known[contact].number = next;
                    graph.write(known[contact].id, &numbered(next, 1 + random.below(4)));
                    next += 1.0;
                }
                _ if !known.is_empty() => graph.remove(known.swap_remove(random.below(known.len())).id),
                _ => {}
            }
            if round % 7 == 0 {
                graph.find_islands(movable.len());
            }
            graph.validate(|row| movable[row as usize]);
            assert_eq!(graph.len(), known.len());
            for contact in &known {
                assert_eq!(graph.rows(contact.id), contact.rows);
                assert_eq!(graph.get(contact.id, NUMBER), contact.number);
            }
        }
    }
}

#[test]
fn a_solve_leaves_what_it_does_not_concern() {
    let mut graph = Graph::default();
    let lane = numbered(1.0, 0);
    let one = graph.insert([0, 1], [false, true], &lane);
    graph.remove(one);
    graph.remove(one);
    assert_eq!(graph.rows(one), [0, 0]);
    assert_eq!(graph.get(one, NUMBER), 0.0);
    let effort =
        Effort { agreement: 1e-5, exactness: 1e-7, quiet: 1.0, sweeps: 2, in_motion: 8, budget: 100 };
    let mobility = |row| {
        let inverse_inertia = DMat3::IDENTITY;
        (row > 0).then_some(Mobility { inverse_mass: 1.0, inverse_inertia })
    };
    let row = Row([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 1.0, 1.0]);
    let mut velocities = vec![Row::ZERO, row, row];
    graph.solve(&mut velocities, effort, mobility);
    assert_eq!(velocities, [Row::ZERO, row, row]);
    // A contact none of whose points can press.
    graph.insert([0, 2], [false, true], &lane);
    graph.measure(&[Row::ZERO; 3]);
    graph.solve(&mut velocities, effort, mobility);
    assert_eq!(velocities, [Row::ZERO, row, row]);
}

#[test]
fn impulses_act_again_only_where_they_do_no_work() {
    use crate::math::DVec3;
    use crate::solver::tests::{Mover, Problem};
    const GAIN: f64 = 9.81 / 240.0;
    // Two cubes on the ground, far from each other; the impulse on the second is three times what it needs.
    let cube = |x: f64| {
        let mover = Mover::cuboid(DVec3::new(x, 0.5, 0.0), DVec3::ONE, (1.0, crate::math::DQuat::IDENTITY));
        let mut mover = mover;
        mover.velocity.linear = DVec3::Y * -GAIN;
        mover
    };
    let mut problem = Problem::new([cube(0.0), cube(5.0)]);
    for (number, x) in [(1, 0.0), (2, 5.0)] {
        problem.touch([0, number], (DVec3::Y, &[DVec3::X * x]), 0.5);
    }
    let mut graph = Graph::default();
    let mut ids = Vec::new();
    for (number, touch) in problem.touches.iter().enumerate() {
        let mut lane = problem.lane(touch);
        lane[field::of_point(0, field::IMPULSE)] = [1.0, 3.0][number] * GAIN as f32;
        ids.push(graph.insert([0, number as u32 + 1], [false, true], &lane));
    }
    let mut velocities = problem.rows();
    let unpushed = velocities.clone();
    graph.begin(&unpushed, &mut velocities, [1e-4, 0.0], 1.0 / 240.0);
    graph.validate(|row| row > 0);
    assert!(velocities[1].0[1].abs() < 1e-6, "{:?}", velocities[1]);
    assert_eq!(velocities[2], problem.rows()[2]);
    let impulse = |id: ContactId| graph.get(id, field::of_point(0, field::IMPULSE));
    assert_eq!([impulse(ids[0]), impulse(ids[1])], [GAIN as f32, 0.0]);
}

/// What rested under something fast once lost its impulses with it: one body that slid took the support of a pile of thousands away,
/// substep after substep, and the pile shook for more than ten seconds.
#[test]
fn a_lively_contact_loses_its_impulses_without_what_rests_beneath_it() {
    use crate::math::DVec3;
    use crate::solver::tests::{Mover, Problem};
    const GAIN: f64 = 9.81 / 240.0;
    // Two cubes on each other; the upper one slides and gets three times the impulse that it needs.
    let cube = |y: f64, slide: f64| {
        let mut mover = Mover::cuboid(DVec3::Y * y, DVec3::ONE, (1.0, crate::math::DQuat::IDENTITY));
        mover.velocity.linear = DVec3::new(slide, -GAIN, 0.0);
        mover
    };
    let mut problem = Problem::new([cube(0.5, 0.0), cube(1.5, 5.0)]);
    problem.touch([0, 1], (DVec3::Y, &[DVec3::ZERO]), 0.5);
    problem.touch([1, 2], (DVec3::Y, &[DVec3::Y]), 0.5);
    let mut graph = Graph::default();
    let ids: Vec<ContactId> = problem
        .touches
        .iter()
        .zip([2.0, 3.0])
        .map(|(touch, impulse)| {
            let mut lane = problem.lane(touch);
            lane[field::of_point(0, field::IMPULSE)] = impulse * GAIN as f32;
            graph.insert(touch.bodies.map(|body| body as u32), touch.bodies.map(|body| body > 0), &lane)
        })
        .collect();
    let mut velocities = problem.rows();
    let unpushed = velocities.clone();
    graph.begin(&unpushed, &mut velocities, [1e-4, 1.0], 1.0 / 240.0);
    graph.validate(|row| row > 0);
    let impulse = |id: ContactId| graph.get(id, field::of_point(0, field::IMPULSE));
    assert_eq!([impulse(ids[0]), impulse(ids[1])], [2.0 * GAIN as f32, 0.0]);
    assert!((velocities[1].0[1] - GAIN as f32).abs() < 1e-6, "{:?}", velocities[1]);
    assert_eq!(velocities[2], problem.rows()[2]);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    use crate::solver::tests::Problem;
    let mut random = Random(17);
    let problem = Problem::random(&mut random, 1500);
    let effort =
        Effort { agreement: 1e-4, exactness: 1e-6, quiet: 100.0, sweeps: 2, in_motion: 12, budget: 100 };
    let outcome = |threads: usize| {
        let pool = Arc::new(Pool::new(threads));
        let mut graph = Graph::new(Machine::default(), Arc::clone(&pool));
        let is_movable = |row: u32| problem.movers[row as usize].is_movable();
        for touch in &problem.touches {
            let rows = touch.bodies.map(|body| body as u32);
            graph.insert(rows, rows.map(is_movable), &problem.lane(touch));
        }
        graph.validate(is_movable);
        let (mut velocities, drifts) = (problem.rows(), vec![Row([1e-4; 8]); problem.movers.len()]);
        let mut displacements = velocities.clone();
        displacements.iter_mut().for_each(|row| row.0[..6].fill(0.0));
        for _ in 0..2 {
            graph.measure(&drifts);
            let unpushed = velocities.clone();
            graph.begin(&unpushed, &mut velocities, [1e-4, 0.0], 1.0 / 240.0);
            graph.solve(&mut velocities, effort, |row| problem.mobility(row));
        }
        let (mut wrenches, mut pushes) = (Wrenches::default(), Wrenches::default());
        graph.wrenches(&velocities, &mut wrenches);
        let limits = Limits { allowed: 0.0, left: 0.0, share: 0.5 };
        graph.push_out(&mut displacements, limits, &mut pushes);
        assert!(!pushes.list().is_empty());
        assert_eq!(pool.has_workers(), threads > 1);
        let pushes = wrenches.list().iter().chain(pushes.list());
        let pushes = pushes.map(|it| (it.contact, it.impulse(), it.moment())).collect::<Vec<_>>();
        let residuals = graph
            .colors
            .iter()
            .flat_map(|color| &color.bundles)
            .map(|bundle| bundle.lines[field::RESIDUAL].0);
        (velocities, displacements, pushes, residuals.collect::<Vec<_>>())
    };
    let alone = outcome(1);
    assert_ne!(alone.0, problem.rows());
    for threads in [2, 3, 8] {
        assert!(outcome(threads) == alone, "{threads} threads");
    }
}

#[test]
fn large_islands_that_are_not_to_be_solved_wait_twice_as_long_each_time() {
    for (count, expected) in [(300, [16, 32, 64, 0, 16]), (200, [16, 16, 16, 0, 16])] {
        let mut graph = Graph::default();
        for row in 1..count {
            graph.insert([row, row + 1], [true; 2], &numbered(f32::from(row as u16), 1));
        }
        graph.find_islands(count as usize + 1);
        let members = graph.members(&[true]).remove(0).1;
        assert_eq!(members.len(), count as usize - 1);
        let lengths = [false, false, false, true, false].map(|is_solved| {
            graph.pause((0, &members), is_solved);
            graph.islands.pauses[7].length
        });
        assert_eq!(lengths, expected, "{count} bodies");
    }
}

/// The lane of one point between two bodies of 1 kg, the second one above the first, which presses with 3 N·s.
fn upright(separation: f32) -> Lane {
    let mut lane = NO_CONTACT;
    (lane[field::NORMAL + 1], lane[field::TANGENT]) = (1.0, 1.0);
    lane[field::GAP] = separation;
    lane[field::of_point(0, field::MASS)] = 0.5;
    lane[field::of_point(0, field::IMPULSE)] = 3.0;
    lane[field::of_point(0, field::SEPARATION)] = separation;
    lane
}

#[test]
fn overlaps_are_pushed_out_of_what_they_reach_and_impulses_stay() {
    let mut graph = Graph::default();
    // Three on each other, of which the lower two overlap; far from them two that touch.
    let contacts = [([1, 2], -1e-3), ([2, 3], 0.0), ([4, 5], 0.0)]
        .map(|(rows, separation)| graph.insert(rows, [true; 2], &upright(separation)));
    let mut rows = vec![Row([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]); 6];
    rows[0] = Row::ZERO;
    let mut pushes = Wrenches::default();
    graph.push_out(&mut rows, Limits { allowed: 1e-4, left: 0.5e-4, share: 0.5 }, &mut pushes);

    let heights: Vec<f32> = rows.iter().map(|row| row.0[1]).collect();
    assert!((heights[2] - heights[1] - 0.5 * 0.95e-3).abs() < 1e-5, "{heights:?}");
    assert!(heights[3] >= heights[2] - 1e-5, "the third is pushed along: {heights:?}");
    assert!(heights.iter().sum::<f32>().abs() < 1e-9, "the centre of mass stays: {heights:?}");
    assert_eq!(heights[4..], [0.0; 2]);
    let pushing: Vec<ContactId> = pushes.list().iter().map(|push| push.contact).collect();
    assert_eq!(pushing, contacts[..2]);
    assert!(contacts.iter().all(|&id| graph.get(id, field::of_point(0, field::IMPULSE)) == 3.0));

    let mut still = vec![Row::ZERO; 6];
    graph.push_out(&mut still, Limits { allowed: 2e-3, left: 1e-3, share: 0.5 }, &mut pushes);
    assert!(
        pushes.list().is_empty() && still.iter().all(|row| *row == Row::ZERO),
        "less than is allowed stays"
    );
}
