//! Single hits in a world against a calculation of their own: free motion in closed form, the instant by bisection, the
//! geometry of each kind of hit by hand, and the seed's formula at that instant.

use carom::impulse::{Contact, Resolution, Side, Velocity, resolve};
use carom::math::{DMat3, DQuat, DVec3, any_tangent};
use carom::prelude::*;
use carom::{Impact, Settings};
use random::Random;

mod random;

const STEP: f64 = 1.0 / 60.0;
const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);

#[derive(Clone, Copy, Debug)]
enum Form {
    Ball {
        radius: f64,
    },
    Cube {
        half: f64,
    },
    /// The half space below the origin of its frame; in the world a plane, or a box so large that it might be one.
    Ground {
        boundless: bool,
    },
}

impl Form {
    fn reach(&self) -> f64 {
        match self {
            Form::Ball { radius } => *radius,
            Form::Cube { half } => 3.0_f64.sqrt() * half,
            Form::Ground { .. } => 0.0,
        }
    }
}

/// A body whose inertia is the same about all axes: without forces it turns evenly.
#[derive(Clone, Copy, Debug)]
struct Flyer {
    form: Form,
    mass: f64,
    position: DVec3,
    rotation: DQuat,
    /// The rotation at the start as the body's description has it.
    described: Quat,
    velocity: DVec3,
    spin: DVec3,
    gravity: DVec3,
}

impl Flyer {
    fn moment(&self) -> f64 {
        match self.form {
            Form::Ball { radius } => 0.4 * self.mass * radius * radius,
            Form::Cube { half } => self.mass * 4.0 * half * half / 6.0,
            Form::Ground { .. } => f64::INFINITY,
        }
    }

    fn after(&self, time: f64) -> Flyer {
        Flyer {
            position: self.position + self.velocity * time + self.gravity * (0.5 * time * time),
            rotation: (DQuat::from_scaled_axis(self.spin * time) * self.rotation).normalize(),
            velocity: self.velocity + self.gravity * time,
            ..*self
        }
    }

    fn side(&self, point: DVec3) -> Side {
        let velocity = Velocity { linear: self.velocity, angular: self.spin };
        let arm = point - self.position;
        let (inertia, inverse_inertia) = if self.mass.is_infinite() {
            (DMat3::ZERO, DMat3::ZERO)
        } else {
            (DMat3::from_diagonal(DVec3::splat(self.moment())), DMat3::IDENTITY * (1.0 / self.moment()))
        };
        Side { mass: self.mass, inertia, inverse_inertia, arm, velocity }
    }

    fn struck(&self, velocity: &Velocity) -> Flyer {
        if self.mass.is_infinite() {
            return *self;
        }
        Flyer { velocity: velocity.linear, spin: velocity.angular, ..*self }
    }

    /// What a body's description can hold: single precision.
    fn rounded(&self) -> Flyer {
        let described = self.rotation.as_quat().normalize();
        Flyer {
            described,
            rotation: described.as_dquat().normalize(),
            velocity: self.velocity.as_vec3().as_dvec3(),
            spin: self.spin.as_vec3().as_dvec3(),
            ..*self
        }
    }

    fn body(&self, restitution: f64, friction: f64) -> Body {
        let [x, y, z] = self.position.to_array();
        let body = match self.form {
            Form::Ball { radius } => Body::dynamic().mass(self.mass).with(Shape::sphere(radius)),
            Form::Cube { half } => {
                let size = 2.0 * half;
                // The mass by density here, by decree for balls.
                let mut collider = Collider::new(Shape::cuboid(size, size, size));
                collider.density = self.mass / size.powi(3);
                Body::dynamic().collider(collider)
            }
            Form::Ground { boundless: true } => Body::fixed().with(Shape::plane()),
            Form::Ground { boundless: false } => {
                Body::fixed().collider(Collider::new(Shape::cuboid(40.0, 1.0, 40.0)).at(0.0, -0.5, 0.0))
            }
        };
        let (v, w) = (self.velocity.as_vec3(), self.spin.as_vec3());
        body.at(x, y, z)
            .rotated(self.described)
            .moving(v.x, v.y, v.z)
            .spinning(w.x, w.y, w.z)
            .restitution(restitution)
            .friction(friction)
    }

    fn corners(&self, half: f64) -> impl Iterator<Item = DVec3> + '_ {
        (0..8).map(move |bits| {
            let sign = |bit: i32| if bits >> bit & 1 == 1 { half } else { -half };
            self.position + self.rotation * DVec3::new(sign(0), sign(1), sign(2))
        })
    }
}

/// Where two bodies are closest: distance (below zero if they overlap), point, normal from `a` to `b`.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    gap: f64,
    point: DVec3,
    normal: DVec3,
    /// Whether point and normal are those of the kind of hit that is looked for.
    sure: bool,
}

fn nearest(a: &Flyer, b: &Flyer) -> Nearest {
    match (a.form, b.form) {
        (Form::Ball { radius }, Form::Ball { radius: other }) => {
            let between = b.position - a.position;
            let normal = between.normalize();
            let gap = between.length() - radius - other;
            Nearest { gap, point: a.position + radius * normal, normal, sure: true }
        }
        (Form::Cube { half }, Form::Ball { radius }) => {
            let center = a.rotation.conjugate() * (b.position - a.position);
            let closest = center.clamp(DVec3::splat(-half), DVec3::splat(half));
            let out = center - closest;
            let normal = a.rotation * out.normalize_or(DVec3::Y);
            let point = a.position + a.rotation * closest;
            Nearest { gap: out.length() - radius, point, normal, sure: true }
        }
        (Form::Ground { .. }, Form::Cube { half }) => {
            let normal = a.rotation * DVec3::Y;
            let height = |corner: &DVec3| (*corner - a.position).dot(normal);
            let lowest = b.corners(half).min_by(|x, y| height(x).total_cmp(&height(y))).unwrap();
            Nearest { gap: height(&lowest), point: lowest, normal, sure: true }
        }
        (Form::Cube { half }, Form::Cube { half: other }) => nearest_of_cubes((a, half), (b, other)),
        _ => {
            let swapped = nearest(b, a);
            Nearest { normal: -swapped.normal, ..swapped }
        }
    }
}

/// Two cubes by their fifteen axes; point and normal only where two edges cross.
fn nearest_of_cubes((a, half_a): (&Flyer, f64), (b, half_b): (&Flyer, f64)) -> Nearest {
    let axes = |flyer: &Flyer| [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| flyer.rotation * axis);
    let (of_a, of_b) = (axes(a), axes(b));
    let between = b.position - a.position;
    let gap_along = |axis: DVec3| {
        let width =
            |axes: &[DVec3; 3], half: f64| axes.iter().map(|it| it.dot(axis).abs()).sum::<f64>() * half;
        between.dot(axis).abs() - width(&of_a, half_a) - width(&of_b, half_b)
    };
    let mut found = Nearest { gap: f64::NEG_INFINITY, point: DVec3::ZERO, normal: DVec3::ZERO, sure: false };
    for axis in of_a.into_iter().chain(of_b) {
        found.gap = found.gap.max(gap_along(axis));
    }
    for edge_a in of_a {
        for edge_b in of_b {
            let Some(axis) = edge_a.cross(edge_b).try_normalize() else { continue };
            let gap = gap_along(axis);
            if gap <= found.gap {
                continue;
            }
            let normal = axis * between.dot(axis).signum();
            // The middles of both edges: as far along the normal as each cube goes.
            let middle = |axes: &[DVec3; 3], edge: DVec3, half: f64, along: DVec3| {
                axes.iter()
                    .filter(|&&it| it != edge)
                    .map(|it| *it * half * it.dot(along).signum())
                    .sum::<DVec3>()
            };
            let middle_a = a.position + middle(&of_a, edge_a, half_a, normal);
            let middle_b = b.position + middle(&of_b, edge_b, half_b, -normal);
            // middle_a + s·edge_a + gap·normal = middle_b + t·edge_b
            let (offset, cosine) = (middle_b - middle_a, edge_a.dot(edge_b));
            let (p, q) = (offset.dot(edge_a), offset.dot(edge_b));
            let s = (p - cosine * q) / (1.0 - cosine * cosine);
            let t = (cosine * p - q) / (1.0 - cosine * cosine);
            let sure = s.abs() < 0.99 * half_a && t.abs() < 0.99 * half_b && cosine.abs() < 0.95;
            found = Nearest { gap, point: middle_a + s * edge_a, normal, sure };
        }
    }
    found
}

#[derive(Clone, Copy, Debug)]
struct Case {
    a: Flyer,
    b: Flyer,
    gravity: DVec3,
    restitution: f64,
    friction: f64,
}

/// Places two bodies so that they touch, with velocities that close, and takes them back in time.
fn random_case(random: &mut Random, number: usize) -> Case {
    let gravity = if number % 8 < 4 { DVec3::ZERO } else { GRAVITY };
    let restitution = [0.0, 1.0, random.unit(), random.unit()][number / 8 % 4];
    let friction = if (number / 32).is_multiple_of(2) { 0.0 } else { random.range(0.05, 1.2) };
    let normal = random.direction();
    let still = |form, mass| Flyer {
        form,
        mass,
        position: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        described: Quat::IDENTITY,
        velocity: DVec3::ZERO,
        spin: DVec3::ZERO,
        gravity,
    };
    let mass = |random: &mut Random| 10.0_f64.powf(random.range(-1.0, 2.0));
    let ball = Form::Ball { radius: random.range(0.2, 1.0) };
    let cube = Form::Cube { half: random.range(0.2, 0.8) };
    let (mut a, mut b, point);
    match number % 4 {
        0 => {
            (a, b) = (
                still(ball, mass(random)),
                still(Form::Ball { radius: random.range(0.2, 1.0) }, mass(random)),
            );
            b.position = normal * (a.form.reach() + b.form.reach());
            point = normal * a.form.reach();
        }
        1 => {
            (a, b) = (still(cube, mass(random)), still(ball, mass(random)));
            let half = 2.0_f64 / 12.0_f64.sqrt() * a.form.reach();
            a.rotation = random.rotation();
            let face = [DVec3::X, DVec3::NEG_Y, DVec3::Z][number / 4 % 3];
            let within = random.vector(0.95 * half);
            let local = within - within * face.abs() + face * half;
            point = a.rotation * local;
            b.position = point + a.rotation * face * b.form.reach();
            if random.unit() < 0.5 {
                (a, b) = (b, a);
            }
        }
        2 => {
            let ground = Form::Ground { boundless: random.unit() < 0.5 };
            (a, b) = (still(ground, f64::INFINITY), still(cube, mass(random)));
            a.gravity = DVec3::ZERO;
            a.rotation = DQuat::from_rotation_arc(DVec3::Y, normal);
            b.rotation = random.rotation();
            let Form::Cube { half } = b.form else { unreachable!() };
            let lowest = b.corners(half).min_by(|x, y| x.dot(normal).total_cmp(&y.dot(normal))).unwrap();
            point = a.rotation * DVec3::new(random.range(-5.0, 5.0), 0.0, random.range(-5.0, 5.0));
            b.position = point - lowest;
        }
        _ => {
            (a, b) =
                (still(cube, mass(random)), still(Form::Cube { half: random.range(0.2, 0.8) }, mass(random)));
            let first = DQuat::from_axis_angle(normal, random.range(0.0, 6.0)) * any_tangent(normal);
            let second = DQuat::from_axis_angle(normal, random.range(0.6, 2.5)) * first;
            point = DVec3::ZERO;
            for (flyer, edge, outward) in [(&mut a, first, normal), (&mut b, second, -normal)] {
                let Form::Cube { half } = flyer.form else { unreachable!() };
                // x along the edge, y and z half way to both sides of the way out, then leaning a little.
                let side = outward.cross(edge);
                let upright = DMat3::from_cols(
                    edge,
                    (outward + side) / 2.0_f64.sqrt(),
                    (outward - side) / 2.0_f64.sqrt(),
                );
                let lean = DQuat::from_axis_angle(edge, random.range(-0.6, 0.6));
                flyer.rotation = lean * DQuat::from_mat3(&upright);
                flyer.position = -(flyer.rotation * DVec3::new(random.range(-0.8, 0.8) * half, half, half));
            }
        }
    }
    let place = random.vector(3.0);
    let normal = nearest(&a, &b).normal;
    loop {
        for flyer in [&mut a, &mut b] {
            if flyer.mass.is_finite() {
                (flyer.velocity, flyer.spin) = (random.vector(6.0), random.vector(10.0));
            }
        }
        let speed = |flyer: &Flyer| flyer.velocity + flyer.spin.cross(point - flyer.position);
        if (speed(&b) - speed(&a)).dot(normal) < -0.3 {
            break;
        }
    }
    let ago = -random.range(0.01, 0.15);
    let back = |flyer: Flyer| {
        let before = if flyer.mass.is_finite() { flyer.after(ago) } else { flyer };
        Flyer { position: before.position + place, ..before }.rounded()
    };
    Case { a: back(a), b: back(b), gravity, restitution, friction }
}

/// What must happen.
struct Reference {
    time: f64,
    nearest: Nearest,
    resolution: Resolution,
    /// Both bodies at the end of the step.
    end: [Flyer; 2],
    steps: usize,
    speed_scale: f64,
}

/// None where the hit is not a single one, or at a place that is not sure.
fn reference(case: &Case) -> Option<Reference> {
    const SCAN: f64 = 1e-4;
    let gap = |time: f64| nearest(&case.a.after(time), &case.b.after(time)).gap;
    if gap(0.0) <= 1e-4 {
        return None;
    }
    let over = (1..4000).find(|&scan| gap(f64::from(scan) * SCAN) <= 0.0)?;
    let (mut low, mut high) = (f64::from(over - 1) * SCAN, f64::from(over) * SCAN);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if gap(middle) > 0.0 { low = middle } else { high = middle }
    }
    let time = 0.5 * (low + high);
    let (a, b) = (case.a.after(time), case.b.after(time));
    let nearest_there = nearest(&a, &b);
    let contact = Contact {
        normal: nearest_there.normal,
        restitution: case.restitution,
        static_friction: case.friction,
        dynamic_friction: case.friction,
    };
    let resolution = resolve(&a.side(nearest_there.point), &b.side(nearest_there.point), &contact);
    let steps = (time / STEP).ceil();
    let left = steps * STEP - time;
    let (after_a, after_b) = (a.struck(&resolution.after_a), b.struck(&resolution.after_b));
    let again = (1..=200).any(|share| {
        let time = left * f64::from(share) / 200.0;
        nearest(&after_a.after(time), &after_b.after(time)).gap < -1e-9
    });
    let slow = resolution.closing_speed > -0.1;
    if !nearest_there.sure || again || slow || left < 1e-5 || STEP - left < 1e-5 {
        return None;
    }
    let speed = |flyer: &Flyer| flyer.velocity.length().max(flyer.spin.length() * flyer.form.reach());
    Some(Reference {
        time,
        nearest: nearest_there,
        resolution,
        end: [after_a.after(left), after_b.after(left)],
        steps: steps as usize,
        speed_scale: speed(&a).max(speed(&b)),
    })
}

/// The impacts until the end of the step in which the reference has one, and both bodies' velocities then.
fn carried_out(case: &Case, steps: usize) -> (Vec<Impact>, [Velocity; 2]) {
    let mut world = World::with_settings(Settings { gravity: case.gravity, ..Settings::default() });
    let ids = [case.a, case.b].map(|flyer| world.add(flyer.body(case.restitution, case.friction)));
    let mut impacts = Vec::new();
    for _ in 0..steps {
        impacts.extend_from_slice(world.step(STEP).impacts());
    }
    let velocities = ids.map(|id| Velocity {
        linear: world[id].linear_velocity().as_dvec3(),
        angular: world[id].angular_velocity().as_dvec3(),
    });
    (impacts, velocities)
}

#[test]
fn five_hundred_single_hits_go_as_calculated() {
    let mut random = Random(77);
    let (mut errors, mut of_kind, mut left_out) = (Vec::new(), [0; 4], 0);
    let (mut time_error, mut point_error, mut normal_error) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut number = 0;
    while errors.len() < 500 {
        let case = random_case(&mut random, number);
        number += 1;
        let Some(reference) = reference(&case) else {
            left_out += 1;
            continue;
        };
        let (impacts, velocities) = carried_out(&case, reference.steps);
        assert_eq!(impacts.len(), 1, "hit {number} at {} s: {impacts:#?} {case:#?}", reference.time);
        let impact = &impacts[0];
        let about = || format!("hit {number} at {} s: {impact:#?} {case:#?}", reference.time);
        time_error = time_error.max((impact.time - reference.time).abs());
        point_error = point_error.max((impact.point - reference.nearest.point).length());
        normal_error = normal_error.max((impact.contact.normal - reference.nearest.normal).length());
        assert!((impact.time - reference.time).abs() < 1e-8, "{}", about());
        assert!((impact.point - reference.nearest.point).length() < 1e-7, "{}", about());
        assert!((impact.contact.normal - reference.nearest.normal).length() < 1e-7, "{}", about());

        let mut worst = 0.0_f64;
        let mut compare = |flyer: &Flyer, found: &Velocity, expected: &Velocity| {
            let turned = (found.angular - expected.angular).length() * flyer.form.reach();
            let moved = (found.linear - expected.linear).length();
            worst = worst.max(moved.max(turned) / reference.speed_scale);
        };
        compare(&case.a, &impact.after_a, &reference.resolution.after_a);
        compare(&case.b, &impact.after_b, &reference.resolution.after_b);
        for (found, end) in velocities.iter().zip(&reference.end) {
            compare(end, found, &Velocity { linear: end.velocity, angular: end.spin });
        }
        assert!(worst < 1e-6, "off by {worst:e}: {}", about());
        errors.push(worst);
        of_kind[(number - 1) % 4] += 1;
    }
    errors.sort_by(f64::total_cmp);
    println!(
        "velocities: median {:.1e}, worst {:.1e}; time {time_error:.1e} s, point {point_error:.1e} m, normal {normal_error:.1e}",
        errors[250], errors[499]
    );
    println!("ball/ball, cube/ball, cube/ground, edge/edge: {of_kind:?}; left out: {left_out}");
    assert!(errors[250] < 1e-7);
    assert!(of_kind.iter().all(|&count| count > 50), "{of_kind:?}");
}
