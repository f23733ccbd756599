//! What simple solids weigh, and how hard they are to turn.

use carom::math::DVec3;
use carom::{Body, Collider, Shape};
use std::f64::consts::PI;

/// A simple solid of even density, along the axes of its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Its form.
    pub form: Form,
    /// Density, kg/m³.
    pub density: f64,
}

/// The form of a [`Solid`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// A ball of that radius, m.
    Ball(f64),
    /// A box with these edge lengths, m.
    Cuboid(DVec3),
    /// A capsule along y.
    Capsule {
        /// Length of the cylindrical part, m.
        height: f64,
        /// Radius, m.
        radius: f64,
    },
}

impl Solid {
    /// Volume, m³, times density, kg.
    pub fn mass(&self) -> f64 {
        self.density
            * match self.form {
                Form::Ball(radius) => 4.0 / 3.0 * PI * radius.powi(3),
                Form::Cuboid(size) => size.x * size.y * size.z,
                Form::Capsule { height, radius } => {
                    PI * radius * radius * height + 4.0 / 3.0 * PI * radius.powi(3)
                }
            }
    }

    /// Moments of inertia about the centre, kg·m².
    pub fn moments(&self) -> DVec3 {
        match self.form {
            Form::Ball(radius) => DVec3::splat(0.4 * self.mass() * radius * radius),
            Form::Cuboid(size) => {
                let square = size * size;
                let sums = DVec3::new(square.y + square.z, square.x + square.z, square.x + square.y);
                self.mass() / 12.0 * sums
            }
            Form::Capsule { height, radius } => {
                let (r, h) = (radius, height);
                let cylinder = self.density * PI * r * r * h;
                let balls = self.density * 4.0 / 3.0 * PI * r.powi(3);
                let along = cylinder * r * r / 2.0 + balls * 0.4 * r * r;
                // Two half balls: 2/5 r² of each about its flat side's middle, h/2 away, its own centre another 3/8 r.
                let across = cylinder * (r * r / 4.0 + h * h / 12.0)
                    + balls * (0.4 * r * r + h * h / 4.0 + 0.375 * h * r);
                DVec3::new(across, along, across)
            }
        }
    }

    /// A body of this form and density.
    pub fn body(&self) -> Body {
        let shape = match self.form {
            Form::Ball(radius) => Shape::sphere(radius),
            Form::Cuboid(size) => Shape::Cuboid { size },
            Form::Capsule { height, radius } => Shape::capsule(height, radius),
        };
        let mut collider = Collider::new(shape);
        collider.density = self.density;
        Body::dynamic().collider(collider)
    }

    /// Largest distance of its surface from its centre, m.
    pub fn reach(&self) -> f64 {
        match self.form {
            Form::Ball(radius) => radius,
            Form::Cuboid(size) => 0.5 * size.length(),
            Form::Capsule { height, radius } => 0.5 * height + radius,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holds(form: Form, point: DVec3) -> bool {
        match form {
            Form::Ball(radius) => point.length() < radius,
            Form::Cuboid(size) => point.abs().cmplt(0.5 * size).all(),
            Form::Capsule { height, radius } => {
                let nearest = point.y.clamp(-0.5 * height, 0.5 * height);
                (point - DVec3::Y * nearest).length() < radius
            }
        }
    }

    #[test]
    fn mass_and_moments_are_sums_over_small_cells() {
        const CELLS: i32 = 120;
        for form in [
            Form::Ball(0.5),
            Form::Cuboid(DVec3::new(1.2, 0.6, 0.2)),
            Form::Capsule { height: 0.8, radius: 0.3 },
        ] {
            let solid = Solid { form, density: 700.0 };
            let extent = match form {
                Form::Ball(radius) => DVec3::splat(2.0 * radius),
                Form::Cuboid(size) => size,
                Form::Capsule { height, radius } => DVec3::splat(2.0 * radius) + DVec3::Y * height,
            };
            let cell = extent / f64::from(CELLS);
            let (mut mass, mut moments) = (0.0, DVec3::ZERO);
            for index in 0..CELLS.pow(3) {
                let number = DVec3::new(
                    f64::from(index % CELLS),
                    f64::from(index / CELLS % CELLS),
                    f64::from(index / CELLS / CELLS),
                );
                let point = (number + 0.5) * cell - 0.5 * extent;
                if holds(form, point) {
                    let part = solid.density * cell.element_product();
                    let square = point * point;
                    mass += part;
                    moments += part * (square.element_sum() - square);
                }
            }
            assert!((mass / solid.mass() - 1.0).abs() < 0.01, "{form:?}: {mass} {}", solid.mass());
            let off = (moments / solid.moments() - 1.0).abs().max_element();
            assert!(off < 0.02, "{form:?}: {moments} {}", solid.moments());
        }
    }
}
