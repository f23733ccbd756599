//! Separations of bodies that have moved since their anchors, against geometry in double precision.

use super::*;
use crate::solver::bundle::field;
use crate::solver::contact::measure;
use crate::solver::rows::LEASH;

/// A rigid motion of a body: of its centre, and about it.
type Drift = (DVec3, DQuat);

const STILL: Drift = (DVec3::ZERO, DQuat::IDENTITY);

fn row((moved, turn): &Drift) -> Row {
    let (moved, turn) = (moved.as_vec3(), turn.as_quat());
    Row([moved.x, moved.y, moved.z, turn.x, turn.y, turn.z, turn.w, 0.0])
}

/// As the rows hold it.
fn coarse(drift: &Drift) -> Drift {
    let [x, y, z, i, j, k, w, _] = row(drift).0.map(f64::from);
    (DVec3::new(x, y, z), DQuat::from_xyzw(i, j, k, w).normalize())
}

fn drift(random: &mut Random, distance: f64) -> Drift {
    coarse(&(random.vector(distance), random.rotation()))
}

/// A contact that was looked at when the bodies had drifted by `seen`, measured when they have drifted by `now`. Centres and the
/// point are those at the anchors and at `seen`.
struct Case {
    centers: [DVec3; 2],
    point: DVec3,
    normal: DVec3,
    separation: f64,
    roundness: [f64; 2],
    seen: [Drift; 2],
    now: [Drift; 2],
}

impl Case {
    fn center(&self, body: usize, drifts: &[Drift; 2]) -> DVec3 {
        self.centers[body] + drifts[body].0
    }

    /// Where a point that is at `place` when seen has gone with its body.
    fn carried(&self, body: usize, place: DVec3) -> DVec3 {
        let local = self.seen[body].1.conjugate() * (place - self.center(body, &self.seen));
        self.center(body, &self.now) + self.now[body].1 * local
    }

    fn bundle(&self) -> Bundle {
        let sides = [0, 1].map(|body| {
            let (moved, turn) = self.seen[body];
            Side {
                center: self.center(body, &self.seen),
                drift: (moved, turn.to_array()),
                roundness: self.roundness[body],
                inverse_mass: 1.0,
                inverse_inertia: DMat3::IDENTITY,
            }
        });
        let surface = Surface { restitution: 0.0, static_friction: 0.0, dynamic_friction: 0.0 };
        let terms = Terms { surface, margin: MARGIN, horizon: 1.0, is_pressed: false };
        let points = [at(self.point, self.separation)];
        let mut bundle = Bundle::EMPTY;
        bundle.write(0, [1, 2], &lane(self.normal, &points, &sides, &terms));
        bundle
    }

    fn measured(&self) -> f64 {
        let mut bundle = self.bundle();
        measure::<Portable<4>>(&mut bundle, &[row(&STILL), row(&self.now[0]), row(&self.now[1])]);
        assert_eq!(bundle.get(0, field::GAP), bundle.get(0, field::of_point(0, field::SEPARATION)));
        f64::from(bundle.get(0, field::GAP))
    }
}

fn case(random: &mut Random) -> Case {
    Case {
        centers: [random.vector(1.0), random.vector(1.0)],
        point: random.vector(1.0),
        normal: random.direction(),
        separation: random.range(-0.01, 0.01),
        roundness: [0.0; 2],
        seen: [STILL; 2],
        now: [drift(random, 0.5), drift(random, 0.5)],
    }
}

#[test]
fn a_vertex_above_a_plane_that_does_not_turn_has_its_true_distance() {
    let mut random = Random(31);
    for round in 0..1000 {
        let mut case = case(&mut random);
        // The plane is the first body in half of the cases, the second in the others.
        let (plane, vertex) = (round % 2, 1 - round % 2);
        case.now[plane].1 = case.seen[plane].1;
        let out = if plane == 0 { case.normal } else { -case.normal };
        let corner = case.point + 0.5 * case.separation * out;
        let foot = case.point - 0.5 * case.separation * out;
        // The arms of a lane end midway between the surfaces; that matters by no more than the gap times the turn.
        let height = (case.carried(vertex, corner) - case.carried(plane, foot)).dot(out);
        let error = (case.measured() - height).abs();
        assert!(error <= 2.0 * case.separation.abs() + 3e-6, "{error} of {height}");
        case.separation = 0.0;
        let height = (case.carried(vertex, case.point) - case.carried(plane, case.point)).dot(out);
        let error = (case.measured() - height).abs();
        assert!(error <= 3e-6, "{error} of {height}");
    }
}

#[test]
fn two_points_that_turn_with_their_bodies_have_their_distance_along_the_normal() {
    let mut random = Random(32);
    for _ in 0..1000 {
        let mut case = case(&mut random);
        case.separation = 0.0;
        let apart = (case.carried(1, case.point) - case.carried(0, case.point)).dot(case.normal);
        let error = (case.measured() - apart).abs();
        assert!(error <= 3e-6, "{error} of {apart}");
    }
}

#[test]
fn a_contact_between_bodies_that_have_already_moved_begins_with_its_separation() {
    let mut random = Random(35);
    for _ in 0..1000 {
        let mut case = case(&mut random);
        case.seen = [drift(&mut random, 0.5), drift(&mut random, 0.5)];
        case.now = case.seen;
        let error = (case.measured() - case.separation).abs();
        assert!(error <= 3e-6, "{error}");
    }
}

/// The arms are those that the bodies have when the contact is looked at, not those of their anchors.
#[test]
fn a_contact_between_bodies_that_have_already_moved_errs_by_turn_times_turn() {
    let mut random = Random(36);
    for size in [2e-2, 1e-3] {
        let mut worst: f64 = 0.0;
        for _ in 0..300 {
            let mut case = case(&mut random);
            case.separation = 0.0;
            for body in 0..2 {
                let turn = |random: &mut Random| DQuat::from_scaled_axis(random.direction() * size);
                let before = turn(&mut random);
                case.seen[body] = coarse(&(random.vector(size), before));
                case.now[body] = coarse(&(random.vector(size), turn(&mut random) * before));
            }
            let apart = (case.carried(1, case.point) - case.carried(0, case.point)).dot(case.normal);
            worst = worst.max((case.measured() - apart).abs());
        }
        assert!(worst <= 4.0 * size * size + 1e-6, "{worst} for turns by {size}");
    }
}

#[test]
fn a_plane_that_turns_leaves_an_error_of_second_order() {
    let mut random = Random(33);
    for size in [1e-2, 1e-3] {
        for _ in 0..200 {
            let mut case = case(&mut random);
            case.separation = 0.0;
            for body in 0..2 {
                let turn = DQuat::from_scaled_axis(random.vector(size));
                case.seen[body] = STILL;
                case.now[body] = coarse(&(random.vector(size), turn));
            }
            let normal = case.now[0].1 * case.normal;
            let height = (case.carried(1, case.point) - case.carried(0, case.point)).dot(normal);
            let error = (case.measured() - height).abs();
            assert!(error <= 30.0 * size * size + 1e-6, "{error} of {height}");
        }
    }
}

#[test]
fn a_ball_on_a_plane_may_roll_as_far_as_it_likes() {
    let mut random = Random(34);
    for round in 0..1000 {
        let mut case = case(&mut random);
        let (plane, ball) = (round % 2, 1 - round % 2);
        let out = if plane == 0 { case.normal } else { -case.normal };
        let radius = random.range(0.1, 1.0);
        case.roundness[ball] = radius;
        case.now[plane].1 = case.seen[plane].1;
        // The ball's middle need not be the centre of mass.
        let middle = case.point + (0.5 * case.separation + radius) * out;
        let foot = case.point - 0.5 * case.separation * out;
        let height = (case.carried(ball, middle) - case.carried(plane, foot)).dot(out) - radius;
        let error = (case.measured() - height).abs();
        assert!(error <= case.separation.abs() + 4e-6, "{error} of {height}");
        case.separation = 0.0;
        let middle = case.point + radius * out;
        let height = (case.carried(ball, middle) - case.carried(plane, case.point)).dot(out) - radius;
        let error = (case.measured() - height).abs();
        assert!(error <= 4e-6, "{error} of {height}");
    }
}

#[test]
fn a_contact_has_strayed_when_its_bodies_are_off_the_longer_leash() {
    let mut random = Random(37);
    for _ in 0..1000 {
        let case = case(&mut random);
        let mut bundle = case.bundle();
        let leashes = [random.range(0.0, 1.0), random.range(0.0, 1.0)];
        let rows = [0, 1].map(|body| {
            let mut row = row(&case.now[body]);
            row.0[LEASH] = leashes[body] as f32;
            row
        });
        measure::<Portable<4>>(&mut bundle, &[row(&STILL), rows[0], rows[1]]);
        let strayed = (case.now[1].0 - case.now[0].0).length() - leashes[0].max(leashes[1]);
        assert!((f64::from(bundle.get(0, field::STRAY)) - strayed).abs() < 1e-6);
        assert_eq!(bundle.has_strayed(0), bundle.get(0, field::STRAY) > 0.0);
        assert!(!bundle.has_strayed(1), "a lane without a contact");
    }
}
