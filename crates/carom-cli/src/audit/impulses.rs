//! Which changes of momentum a set of impulses can make.

use super::law::ROUNDING;
use carom::math::DVec3;

/// Linear momentum, and angular momentum about some reference point: both change by an impulse at once.
#[derive(Clone, Copy)]
pub(super) struct Twist {
    pub(super) linear: DVec3,
    pub(super) angular: DVec3,
}

impl Twist {
    pub(super) fn dot(&self, other: &Twist) -> f64 {
        self.linear.dot(other.linear) + self.angular.dot(other.angular)
    }

    pub(super) fn minus(&self, other: &Twist, times: f64) -> Twist {
        Twist { linear: self.linear - times * other.linear, angular: self.angular - times * other.angular }
    }
}

/// An orthonormal basis of all changes of momentum that some impulses can make (at most six dimensions).
pub(super) struct Basis {
    /// Angular momentum is measured in this length's units, m.
    pub(super) length: f64,
    pub(super) vectors: Vec<Twist>,
}

impl Basis {
    pub(super) fn new(length: f64) -> Self {
        Self { length, vectors: Vec::new() }
    }

    pub(super) fn add_impulses_at(&mut self, lever: DVec3) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            self.add(Twist { linear: axis, angular: lever.cross(axis) });
        }
    }

    pub(super) fn add(&mut self, change: Twist) {
        let scaled = Twist { linear: change.linear, angular: change.angular / self.length };
        let size = scaled.dot(&scaled).sqrt();
        let rest = self.outside(self.outside(scaled));
        let left = rest.dot(&rest).sqrt();
        if self.vectors.len() < 6 && left > 1e-9 * size {
            let unit = 1.0 / left;
            self.vectors.push(Twist { linear: rest.linear * unit, angular: rest.angular * unit });
        }
    }

    /// What no combination of the basis explains (scaled).
    pub(super) fn outside(&self, scaled: Twist) -> Twist {
        self.vectors.iter().fold(scaled, |rest, vector| rest.minus(vector, rest.dot(vector)))
    }

    /// What no combination of the basis explains of a `change`.
    pub(super) fn unexplained(&self, change: Twist) -> Twist {
        let scaled = Twist { linear: change.linear, angular: change.angular / self.length };
        let rest = self.outside(scaled);
        Twist { linear: rest.linear, angular: rest.angular * self.length }
    }

    /// How much of a change with its scales of rounding is unexplained: linear, angular, and the tolerance (linear).
    /// None if the basis explains everything, so that nothing is judged.
    pub(super) fn judge(
        &self,
        (change, linear_scale, angular_scale): (Twist, f64, f64),
    ) -> Option<(f64, f64, f64)> {
        let rest = self.unexplained(change);
        let tolerance = ROUNDING * (linear_scale + angular_scale / self.length);
        (self.vectors.len() < 6).then(|| (rest.linear.length(), rest.angular.length(), tolerance))
    }
}
