//! Tests of the solver's arithmetic, and the small problems that they share.

mod books;
mod energy;
mod islands;
mod measure;
mod prepare;
mod seed;
mod width;

pub(crate) use crate::random::Random;

use super::bundle::{Bundle, Lane, NO_CONTACT};
use super::contact::sweep;
use super::direct::{Island, Mobility};
use super::lanes::{Portable, Row};
use super::prepare::{Remembered, Side, Terms, fill_lane};
use super::rows::SharedRows;
use crate::collide::ContactPoint;
use crate::impulse::Velocity;
use crate::material::Surface;
use crate::math::{DMat3, DQuat, DVec3, rotated_diagonal};
use crate::report::Feature;

/// The lane of these points, which have exerted nothing yet.
fn lane(normal: DVec3, points: &[ContactPoint], sides: &[Side; 2], terms: &Terms) -> Lane {
    let mut lane = NO_CONTACT;
    fill_lane(&mut lane, (normal, points), sides, terms, &Remembered::default());
    lane
}

/// A body of a problem.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mover {
    /// kg and 1/kg; zero and zero where infinite.
    pub mass: f64,
    pub inverse_mass: f64,
    /// World axes; zero on axes of infinite inertia.
    pub inertia: DMat3,
    pub inverse_inertia: DMat3,
    pub center: DVec3,
    pub velocity: Velocity,
}

impl Mover {
    pub const WORLD: Mover = Mover {
        mass: 0.0,
        inverse_mass: 0.0,
        inertia: DMat3::ZERO,
        inverse_inertia: DMat3::ZERO,
        center: DVec3::ZERO,
        velocity: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
    };

    /// A body of `mass` (kg; 0 = infinite) and principal `moments` (kg·m²; 0 = infinite) about turned axes.
    pub fn new(center: DVec3, mass: f64, (moments, axes): (DVec3, DQuat)) -> Self {
        let inverse = |value: f64| if value > 0.0 { 1.0 / value } else { 0.0 };
        Self {
            mass,
            inverse_mass: inverse(mass),
            inertia: rotated_diagonal(axes, moments),
            inverse_inertia: rotated_diagonal(axes, moments.map(inverse)),
            center,
            velocity: Velocity::default(),
        }
    }

    /// A box of `size` (m), turned.
    pub fn cuboid(center: DVec3, size: DVec3, (mass, axes): (f64, DQuat)) -> Self {
        let square = size * size;
        let moments = mass / 12.0 * (DVec3::splat(square.element_sum()) - square);
        Self::new(center, mass, (moments, axes))
    }

    /// Any body near the origin, moving.
    pub fn random(random: &mut Random) -> Self {
        let mass = 10.0_f64.powf(random.range(-1.0, 1.0));
        let square = DVec3::new(random.range(0.1, 1.0), random.range(0.1, 1.0), random.range(0.1, 1.0));
        let moments = mass / 5.0 * (DVec3::splat(square.element_sum()) - square);
        let mut mover = Self::new(random.vector(1.0), mass, (moments, random.rotation()));
        let coarse = |v: DVec3| v.as_vec3().as_dvec3();
        mover.velocity = Velocity { linear: coarse(random.vector(3.0)), angular: coarse(random.vector(3.0)) };
        mover
    }

    pub fn is_movable(&self) -> bool {
        self.inverse_mass > 0.0 || self.inverse_inertia != DMat3::ZERO
    }

    pub fn row(&self) -> Row {
        let (linear, angular) = (self.velocity.linear.as_vec3(), self.velocity.angular.as_vec3());
        let writable = f32::from(self.is_movable());
        let [v, w] = [linear, angular];
        Row([v.x, v.y, v.z, w.x, w.y, w.z, self.inverse_mass as f32, writable])
    }
}

/// A contact of a problem.
#[derive(Clone, Debug)]
pub(crate) struct Touch {
    /// Which bodies; `normal` points from the first to the second.
    pub bodies: [usize; 2],
    pub normal: DVec3,
    /// Points in the world and their separations, m.
    pub points: Vec<(DVec3, f64)>,
    /// Coulomb's coefficients, static and dynamic.
    pub friction: [f64; 2],
}

/// Bodies and contacts; body 0 is the world.
#[derive(Clone, Debug, Default)]
pub(crate) struct Problem {
    pub movers: Vec<Mover>,
    pub touches: Vec<Touch>,
}

/// Gap up to which two points touch, m.
pub(crate) const MARGIN: f64 = 1e-4;

impl Problem {
    pub fn new(movers: impl IntoIterator<Item = Mover>) -> Self {
        let movers = std::iter::once(Mover::WORLD).chain(movers).collect();
        Self { movers, touches: Vec::new() }
    }

    /// Two boxes' common side: `corners` in one plane.
    pub fn touch(&mut self, bodies: [usize; 2], (normal, corners): (DVec3, &[DVec3]), friction: f64) {
        let points = corners.iter().map(|&corner| (corner, 0.0)).collect();
        self.touches.push(Touch { bodies, normal, points, friction: [friction; 2] });
    }

    /// `count` moving bodies with contacts between neighbours and some with the world.
    pub fn random(random: &mut Random, count: usize) -> Self {
        let mut problem = Self::new((0..count).map(|_| Mover::random(random)));
        for b in 1..=count {
            let a = if random.below(3) == 0 { 0 } else { random.below(b) };
            problem.random_touch(random, [a, b]);
        }
        for _ in 0..count / 2 {
            let (a, b) = (random.below(count + 1), random.below(count + 1));
            if a != b {
                problem.random_touch(random, [a, b]);
            }
        }
        problem
    }

    pub fn random_touch(&mut self, random: &mut Random, bodies: [usize; 2]) {
        let normal = random.direction();
        let middle = 0.5 * (self.movers[bodies[0]].center + self.movers[bodies[1]].center);
        let points = (0..1 + random.below(4))
            .map(|_| {
                let offset = random.vector(0.5);
                (middle + offset - normal * normal.dot(offset), 0.0)
            })
            .collect();
        let dynamic = random.range(0.0, 0.8);
        let friction = [dynamic * random.range(1.0, 1.5), dynamic];
        self.touches.push(Touch { bodies, normal, points, friction });
    }

    pub fn rows(&self) -> Vec<Row> {
        self.movers.iter().map(Mover::row).collect()
    }

    pub fn lane(&self, touch: &Touch) -> Lane {
        let points: Vec<_> = touch.points.iter().map(|&(point, separation)| at(point, separation)).collect();
        let sides = touch.bodies.map(|body| side(&self.movers[body]));
        let [static_friction, dynamic_friction] = touch.friction;
        let surface = Surface { restitution: 0.0, static_friction, dynamic_friction };
        let terms = Terms { surface, margin: MARGIN, horizon: 1.0, is_pressed: false };
        lane(touch.normal, &points, &sides, &terms)
    }

    /// Each contact in a bundle of its own.
    pub fn bundles(&self) -> Vec<Bundle> {
        let bundle = |touch: &Touch| {
            let mut bundle = Bundle::EMPTY;
            bundle.write(0, touch.bodies.map(|body| body as u32), &self.lane(touch));
            bundle
        };
        self.touches.iter().map(bundle).collect()
    }

    pub fn mobility(&self, row: u32) -> Option<Mobility> {
        let mover = &self.movers[row as usize];
        let Mover { inverse_mass, inverse_inertia, .. } = *mover;
        mover.is_movable().then_some(Mobility { inverse_mass, inverse_inertia })
    }

    /// Kinetic energy of the bodies that move with `rows`, J.
    pub fn energy(&self, rows: &[Row]) -> f64 {
        let of = |(mover, row): (&Mover, &Row)| {
            let velocity = velocity(row);
            let turning = mover.inertia * velocity.angular;
            0.5 * (mover.mass * velocity.linear.length_squared() + turning.dot(velocity.angular))
        };
        self.movers.iter().zip(rows).map(of).sum()
    }

    /// Linear and angular momentum about the origin.
    pub fn momentum(&self, rows: &[Row]) -> [DVec3; 2] {
        let mut total = [DVec3::ZERO; 2];
        for (mover, row) in self.movers.iter().zip(rows) {
            let velocity = velocity(row);
            let linear = mover.mass * velocity.linear;
            total[0] += linear;
            total[1] += mover.inertia * velocity.angular + mover.center.cross(linear);
        }
        total
    }

    /// The velocities after `count` sweeps over all contacts, and the contacts.
    pub fn swept(&self, count: usize) -> (Vec<Row>, Vec<Bundle>) {
        let (mut rows, mut bundles) = (self.rows(), self.bundles());
        for _ in 0..count {
            bundles.iter_mut().for_each(|bundle| sweep::<Portable<1>>(bundle, SharedRows::new(&mut rows)));
        }
        (rows, bundles)
    }

    /// All contacts as one island, its bodies moving with `rows`.
    pub fn island(&self, bundles: &[Bundle], rows: &[Row]) -> Island {
        let mut island = Island::default();
        for bundle in bundles {
            island.add(bundle, 0, rows, |row| self.mobility(row));
        }
        island
    }
}

pub(crate) fn at(point: DVec3, separation: f64) -> ContactPoint {
    ContactPoint { point, separation, feature_a: Feature::Surface, feature_b: Feature::Surface }
}

/// A body that has not moved since its anchor.
pub(crate) fn side(mover: &Mover) -> Side {
    Side {
        center: mover.center,
        inverse_mass: mover.inverse_mass,
        inverse_inertia: mover.inverse_inertia,
        drift: (DVec3::ZERO, [0.0, 0.0, 0.0, 1.0]),
        roundness: 0.0,
    }
}

pub(crate) fn velocity(row: &Row) -> Velocity {
    let [x, y, z, i, j, k, ..] = row.0.map(f64::from);
    Velocity { linear: DVec3::new(x, y, z), angular: DVec3::new(i, j, k) }
}

/// The largest difference of two sets of velocities, m/s.
pub(crate) fn difference(one: &[Row], other: &[Row]) -> f64 {
    let between = |(one, other): (&Row, &Row)| {
        (0..6).map(|axis| f64::from(one.0[axis] - other.0[axis]).abs()).fold(0.0, f64::max)
    };
    one.iter().zip(other).map(between).fold(0.0, f64::max)
}
