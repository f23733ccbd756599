//! Energy and momentum of what a user of the engine reads, with masses and moments of their own.

use crate::closed::solids::Solid;
use crate::scene::{rotation, spin, velocity};
use carom::math::{DVec3, rotated_diagonal};
use carom::{Body, BodyId, World};

/// A body whose mass and moments follow from its form.
#[derive(Clone, Copy, Debug)]
pub struct Weighed {
    /// Its id.
    pub id: BodyId,
    mass: f64,
    moments: DVec3,
}

impl Weighed {
    /// Adds a body to the world, of the form and density that `solid` has.
    pub fn add(world: &mut World, solid: &Solid, body: Body) -> Self {
        Self { id: world.add(body), mass: solid.mass(), moments: solid.moments() }
    }
}

/// Sums over some bodies.
#[derive(Clone, Copy, Debug, Default)]
pub struct Books {
    /// Σ m v, N·s.
    pub linear: DVec3,
    /// Σ (x − O) × m v + I ω, N·m·s.
    pub angular: DVec3,
    /// Σ ½ m v² + ½ ω·I ω, J.
    pub kinetic: f64,
    /// Σ |m v|.
    pub linear_scale: f64,
    /// Σ |(x − O) × m v + I ω|.
    pub angular_scale: f64,
}

impl Books {
    /// The books as they are now, angular momentum about the point O = `about`.
    pub fn of(world: &World, bodies: &[Weighed], about: DVec3) -> Self {
        let mut books = Self::default();
        for body in bodies {
            let (v, w) = (velocity(world, body.id), spin(world, body.id));
            let turning = rotated_diagonal(rotation(world, body.id), body.moments) * w;
            let linear = body.mass * v;
            let angular = (world[body.id].position() - about).cross(linear) + turning;
            books.linear += linear;
            books.angular += angular;
            books.kinetic += 0.5 * linear.dot(v) + 0.5 * turning.dot(w);
            books.linear_scale += linear.length();
            books.angular_scale += angular.length();
        }
        books
    }
}

/// How the books of a closed system changed while it was watched.
#[derive(Clone, Copy, Debug)]
pub struct Audit {
    start: Books,
    last: f64,
    /// Largest change of linear momentum over the sum of its absolute parts at the start.
    pub linear: f64,
    /// The same of angular momentum.
    pub angular: f64,
    /// Change of energy since the start, over that at the start; the one furthest from 0.
    pub energy: f64,
    /// Largest rise of energy in one step, over that at the start.
    pub rise: f64,
    /// How many steps had a rise above 1e-6.
    pub rises: u32,
}

impl Audit {
    /// Begins with the books of the start.
    pub fn new(start: Books) -> Self {
        Self { start, last: start.kinetic, linear: 0.0, angular: 0.0, energy: 0.0, rise: 0.0, rises: 0 }
    }

    /// Takes in the books after a step.
    pub fn look(&mut self, now: &Books) {
        let start = &self.start;
        self.linear = self.linear.max((now.linear - start.linear).length() / start.linear_scale);
        self.angular = self.angular.max((now.angular - start.angular).length() / start.angular_scale);
        let change = now.kinetic / start.kinetic - 1.0;
        if change.abs() > self.energy.abs() || change.is_nan() {
            self.energy = change;
        }
        let rise = (now.kinetic - self.last) / start.kinetic;
        self.rise = self.rise.max(rise);
        self.rises += u32::from(rise > 1e-6);
        self.last = now.kinetic;
    }
}
