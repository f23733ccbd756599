//! Random shapes and poses, the same ones in every run.

pub use crate::random::Random;
use carom::Shape;
use carom::collide::{Manifold, manifolds, separation};
use carom::math::{DVec3, Pose, rotation_from_vector};

impl Random {
    pub fn shape(&mut self, kind: Kind) -> Shape {
        let mut length = || self.range(0.1, 2.0);
        match kind {
            Kind::Sphere => Shape::sphere(length()),
            Kind::Capsule => Shape::capsule(2.0 * length(), 0.5 * length()),
            Kind::Cuboid => Shape::cuboid(length(), length(), length()),
            Kind::Plane => Shape::plane(),
            Kind::Hull => {
                let size = DVec3::new(length(), length(), length());
                let corners = 4 + self.bits() % 20;
                let points: Vec<DVec3> = (0..corners).map(|_| self.direction() * 0.5 * size).collect();
                // Four points of a sphere lie in a plane once in a blue moon.
                Shape::hull(&points).unwrap_or_else(|_| self.shape(Kind::Hull))
            }
        }
    }

    /// Two shapes, turned at random: half of the time near each other, half of the time near touching.
    pub fn pair(&mut self, kinds: (Kind, Kind)) -> ((Shape, Pose), (Shape, Pose)) {
        let (a, b) = (self.shape(kinds.0), self.shape(kinds.1));
        let reach = [&a, &b].iter().map(|s| s.reach(DVec3::ZERO)).filter(|r| r.is_finite()).sum::<f64>();
        let pose_a = Pose::new(self.direction() * self.range(0.0, 1.0), self.rotation());
        let away = self.direction();
        let mut pose_b = Pose::new(pose_a.position + away * self.range(0.0, 1.2 * reach), self.rotation());
        if self.bits() & 1 == 0 {
            for _ in 0..6 {
                pose_b.position += away * (0.01 - separation(&a, &pose_a, &b, &pose_b)).clamp(-reach, reach);
            }
        }
        ((a, pose_a), (b, pose_b))
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Sphere,
    Capsule,
    Cuboid,
    Plane,
    Hull,
}

/// All ordered pairs of shapes that can touch.
pub fn kinds() -> impl Iterator<Item = (Kind, Kind)> {
    const ALL: [Kind; 5] = [Kind::Sphere, Kind::Capsule, Kind::Cuboid, Kind::Plane, Kind::Hull];
    ALL.into_iter()
        .flat_map(|a| ALL.into_iter().map(move |b| (a, b)))
        .filter(|&pair| pair != (Kind::Plane, Kind::Plane))
}

/// The pairs of shapes that formulas describe: all but hulls.
pub fn plain_kinds() -> impl Iterator<Item = (Kind, Kind)> {
    kinds().filter(|pair| pair.0 != Kind::Hull && pair.1 != Kind::Hull)
}

/// The one manifold of a pair, if there is one.
pub fn touch(a: &(Shape, Pose), b: &(Shape, Pose), margin: f64) -> Option<Manifold> {
    let mut out = Vec::new();
    manifolds((&a.0, &a.1), (&b.0, &b.1), margin, &mut out);
    assert!(out.len() <= 1);
    out.pop()
}

pub fn gap(a: &(Shape, Pose), b: &(Shape, Pose)) -> f64 {
    separation(&a.0, &a.1, &b.0, &b.1)
}

pub fn least(manifold: &Manifold) -> f64 {
    manifold.points().iter().map(|p| p.separation).fold(f64::INFINITY, f64::min)
}

/// `shape` at a place, turned by a rotation vector.
pub fn at(shape: Shape, position: [f64; 3], turn: [f64; 3]) -> (Shape, Pose) {
    (shape, Pose::new(DVec3::from_array(position), rotation_from_vector(DVec3::from_array(turn))))
}
