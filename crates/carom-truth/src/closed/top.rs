//! A heavy symmetric top with a fixed point.

/// A heavy symmetric top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Top {
    /// Mass, kg.
    pub mass: f64,
    /// From the fixed point to the centre of mass, m.
    pub length: f64,
    /// Moment about its axis, kg·m².
    pub axial: f64,
    /// Moment across its axis, about the centre of mass, kg·m².
    pub across: f64,
}

impl Top {
    /// The slower of the two rates (rad/s) at which its axis goes round evenly, at `tilt` (rad) from upright, with the whole
    /// angular velocity having the part `spin` (rad/s) along the axis: a root of
    ///
    /// ```text
    /// I₁ cos θ·Ω² − I₃ ω₃·Ω + m g l = 0          I₁ about the fixed point
    /// ```
    ///
    /// Goldstein, *Classical Mechanics*, § 5.7. NaN where the top is too slow to go round evenly.
    pub fn slow_precession(&self, spin: f64, tilt: f64, g: f64) -> f64 {
        let about_point = self.across + self.mass * self.length * self.length;
        let torque = self.mass * g * self.length;
        let (a, b) = (about_point * tilt.cos(), self.axial * spin);
        2.0 * torque / (b + (b * b - 4.0 * a * torque).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom::math::{DQuat, DVec3};

    /// Euler's equations about the fixed point with the torque of the weight, by RK4: the axis must go round at that rate and
    /// keep its tilt.
    #[test]
    fn a_top_that_starts_in_even_precession_keeps_to_it() {
        let top = Top { mass: 10.0, length: 0.5, axial: 1.7, across: 0.9 };
        let (spin, tilt, g, seconds) = (30.0, std::f64::consts::FRAC_PI_3, 9.81, 2.0);
        let rate = top.slow_precession(spin, tilt, g);
        let about_point = top.across + top.mass * top.length * top.length;
        let moments = DVec3::new(about_point, top.axial, about_point);
        let start = DQuat::from_rotation_z(-tilt);
        let axis = start * DVec3::Y;
        let mut state = (start, start.conjugate() * (DVec3::Y * rate + axis * (spin - rate * tilt.cos())));
        let change = |(q, w): (DQuat, DVec3)| {
            let up = q.conjugate() * DVec3::Y;
            let torque = (DVec3::Y * top.length).cross(up * (-top.mass * g));
            (q * DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * 0.5, (torque - w.cross(moments * w)) / moments)
        };
        let h = 1e-4;
        let moved = |(q, w): (DQuat, DVec3), (dq, dw): (DQuat, DVec3), s: f64| (q + dq * s, w + dw * s);
        for _ in 0..(seconds / h) as usize {
            let k1 = change(state);
            let k2 = change(moved(state, k1, 0.5 * h));
            let k3 = change(moved(state, k2, 0.5 * h));
            let k4 = change(moved(state, k3, h));
            let sum = (k1.0 + k2.0 * 2.0 + k3.0 * 2.0 + k4.0, k1.1 + k2.1 * 2.0 + k3.1 * 2.0 + k4.1);
            state = moved(state, sum, h / 6.0);
        }
        let axis = state.0.normalize() * DVec3::Y;
        assert!((axis.y - tilt.cos()).abs() < 1e-8, "{axis}");
        let expected = DQuat::from_rotation_y(rate * seconds) * start * DVec3::Y;
        assert!((axis - expected).length() < 1e-6, "{axis} {expected}");
    }
}
