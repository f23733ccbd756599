//! Lanes never see each other.

use super::*;
use crate::solver::bundle::field;
use crate::solver::contact::{begin, measure, resume, sweep_normals, work};
use crate::solver::lanes::{InstructionSet, Kernel, LANES, Lanes, Line, Machine};

/// A full bundle between 16 bodies and the world, a `share` of whose lanes is empty.
fn bundle(random: &mut Random, share: f64) -> (Problem, Bundle) {
    let mut problem = Problem::new((0..2 * LANES).map(|_| Mover::random(random)));
    let mut bundle = Bundle::EMPTY;
    for lane in 0..LANES {
        if random.range(0.0, 1.0) < share {
            continue;
        }
        let (a, b) = (2 * lane + 1, 2 * lane + 2);
        let bodies = [[a, b], [0, b], [a, 0]][random.below(3)];
        problem.random_touch(random, bodies);
        let touch = &problem.touches[problem.touches.len() - 1];
        let mut values = problem.lane(touch);
        for (number, line) in field::IMPULSES.into_iter().enumerate() {
            let low = if number < 4 { 0.0 } else { -0.5 };
            values[line] =
                if values[field::MASSES[number]] > 0.0 { random.range(low, 0.5) as f32 } else { 0.0 };
        }
        for point in 0..touch.points.len() {
            values[field::of_point(point, field::BASE)] = random.range(-1e-3, 1e-3) as f32;
        }
        bundle.write(lane, touch.bodies.map(|body| body as u32), &values);
    }
    (problem, bundle)
}

/// Everything that the kernels do, one after the other: the bits of the bundle and of all rows.
#[inline(always)]
fn run<L: Lanes>(bundle: &Bundle, rows: &[Row], drifts: &[Row]) -> Vec<u32> {
    let (mut bundle, mut rows) = (bundle.clone(), rows.to_vec());
    let mut displacements = rows.clone();
    measure::<L>(&mut bundle, drifts);
    begin::<L>(&mut bundle, &rows, [MARGIN as f32, 240.0]);
    resume::<L>(&bundle, SharedRows::new(&mut rows));
    for _ in 0..3 {
        sweep::<L>(&mut bundle, SharedRows::new(&mut rows));
    }
    sweep_normals::<L>(&mut bundle, SharedRows::new(&mut displacements));
    let work = work::<L>(&bundle, &displacements, &rows);
    let lines = bundle.lines.iter().chain([&work]).flat_map(|line| line.0);
    let rows = rows.iter().chain(&displacements).flat_map(|row| row.0);
    lines.chain(rows).map(f32::to_bits).collect()
}

/// [`run`] in a given machine's lanes.
struct Run<'a> {
    bundle: &'a Bundle,
    rows: &'a [Row],
    drifts: &'a [Row],
}

impl Kernel for Run<'_> {
    type Output = Vec<u32>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<u32> {
        run::<L>(self.bundle, self.rows, self.drifts)
    }
}

fn drifts(random: &mut Random) -> Vec<Row> {
    let drift = |_| {
        let (moved, turn) = (random.vector(1e-3).as_vec3(), random.rotation().as_quat());
        Row([moved.x, moved.y, moved.z, turn.x, turn.y, turn.z, turn.w, 0.0])
    };
    (0..2 * LANES + 1).map(drift).collect()
}

#[test]
fn all_widths_give_the_same_bits() {
    let mut random = Random(21);
    let (sets, missing): (Vec<_>, Vec<_>) =
        InstructionSet::ALL.into_iter().partition(|set| set.is_available());
    missing.iter().for_each(|set| println!("{set:?}: not tested, this machine does not have it"));
    for _ in 0..200 {
        let (problem, bundle) = bundle(&mut random, 0.2);
        let rows = problem.rows();
        let drifts = drifts(&mut random);
        let narrow = run::<Portable<1>>(&bundle, &rows, &drifts);
        assert_eq!(narrow, run::<Portable<2>>(&bundle, &rows, &drifts));
        assert_eq!(narrow, run::<Portable<4>>(&bundle, &rows, &drifts));
        assert_eq!(narrow, run::<Portable<8>>(&bundle, &rows, &drifts));
        for &set in &sets {
            let work = Run { bundle: &bundle, rows: &rows, drifts: &drifts };
            assert_eq!(narrow, Machine::new(set).run(work), "{set:?}");
        }
    }
}

#[test]
fn empty_lanes_change_nothing() {
    let mut random = Random(22);
    for _ in 0..100 {
        let (problem, bundle) = bundle(&mut random, 0.6);
        let (rows, drifts) = (problem.rows(), drifts(&mut random));
        // The same lanes, each alone in its bundle, then all of them together.
        let mut apart = rows.clone();
        for lane in 0..LANES {
            let (indices, values) = bundle.read(lane);
            let mut alone = Bundle::EMPTY;
            alone.write(random.below(LANES), indices, &values);
            measure::<Portable<4>>(&mut alone, &drifts);
            begin::<Portable<4>>(&mut alone, &apart, [MARGIN as f32, 240.0]);
            resume::<Portable<4>>(&alone, SharedRows::new(&mut apart));
            for _ in 0..3 {
                sweep::<Portable<4>>(&mut alone, SharedRows::new(&mut apart));
            }
        }
        let mut together = rows.clone();
        let mut whole = bundle.clone();
        measure::<Portable<4>>(&mut whole, &drifts);
        begin::<Portable<4>>(&mut whole, &together, [MARGIN as f32, 240.0]);
        resume::<Portable<4>>(&whole, SharedRows::new(&mut together));
        for _ in 0..3 {
            sweep::<Portable<4>>(&mut whole, SharedRows::new(&mut together));
        }
        assert_eq!(apart, together);
        assert_eq!(together[0], rows[0], "the world moves");
        for lane in (0..LANES).filter(|&lane| bundle.a[lane] == bundle.b[lane]) {
            assert!(field::IMPULSES.into_iter().all(|line| whole.get(lane, line) == 0.0));
            assert_eq!(whole.get(lane, field::RESIDUAL), 0.0);
            assert_eq!(whole.get(lane, field::GAP), f32::MAX);
        }
        let before = run::<Portable<4>>(&Bundle::EMPTY, &rows, &drifts);
        let unchanged: Vec<u32> = rows.iter().chain(&rows).flat_map(|row| row.0).map(f32::to_bits).collect();
        assert_eq!(before[(field::COUNT + 1) * LANES..], unchanged);
    }
}

/// What is neither greater nor less, one by one: the second one is taken, zeros keep their signs.
struct Odd;

impl Kernel for Odd {
    type Output = Vec<u32>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<u32> {
        let values = [0.0, -0.0, 1.0, -1.0, f32::NAN, f32::INFINITY, f32::MIN_POSITIVE, 1e-42];
        let mut results = Vec::new();
        for left in values {
            for right in values {
                let (one, other) = (L::splat(left), L::splat(right));
                let answers = [
                    one.max(other),
                    one.min(other),
                    L::select_greater(one, other, [L::splat(1.0), L::splat(2.0)]),
                    -one * other,
                    other / one,
                    one.sqrt() - other,
                ];
                for answer in answers {
                    let mut line = Line::ZERO;
                    for part in 0..LANES / L::WIDTH {
                        answer.store(&mut line, part);
                    }
                    // Not a number is not a number, whatever its sign.
                    results
                        .extend(line.0.map(|value| if value.is_nan() { u32::MAX } else { value.to_bits() }));
                }
            }
        }
        results
    }
}

#[test]
fn odd_numbers_are_treated_alike() {
    let reference = Odd.run::<Portable<1>>();
    for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        assert_eq!(reference, Machine::new(set).run(Odd), "{set:?}");
    }
}
