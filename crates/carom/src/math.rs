//! The vocabulary of vectors and rotations: `glam`'s concrete types, and the few things it lacks.
//!
//! World positions are [`DVec3`]; velocities and rotations are stored in single precision ([`Vec3`], [`Quat`])
//! and computed with in double precision wherever truth needs it. All frames are right-handed, y up;
//! quaternions are `[x, y, z, w]`.
//!
//! The engine calls neither `sin` nor `cos` nor `exp` of the standard library, since those differ between
//! platforms: the functions here use `+ − × ÷ √` in one fixed order and give the same bits everywhere.

pub use glam::{DMat3, DQuat, DVec3, Quat, Vec3, Vec3A};

/// A place and an orientation: `world = rotation · local + position`, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where the local origin lies.
    pub position: DVec3,
    /// Turns local directions into outer ones; unit length.
    pub rotation: DQuat,
}

impl Pose {
    /// The pose that changes nothing.
    pub const IDENTITY: Pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };

    /// A pose from its two parts.
    pub fn new(position: DVec3, rotation: DQuat) -> Self {
        Self { position, rotation }
    }

    /// The outer coordinates of a local point.
    pub fn transform_point(&self, local: DVec3) -> DVec3 {
        self.rotation * local + self.position
    }

    /// The local coordinates of an outer point.
    pub fn inverse_transform_point(&self, outer: DVec3) -> DVec3 {
        self.rotation.conjugate() * (outer - self.position)
    }

    /// `self` after `inner`: takes `inner`'s local coordinates to `self`'s outer ones.
    #[inline]
    pub fn then_local(&self, inner: &Pose) -> Pose {
        // Most colliders sit at the middle of their bodies, and what they sit at changes nothing.
        let has_no_negative_zero = self.position.to_array().into_iter().all(|x| x.to_bits() != NEGATIVE_ZERO);
        if *inner == Pose::IDENTITY && has_no_negative_zero && is_tilted(self.rotation) {
            *self
        } else {
            self.after(inner)
        }
    }

    fn after(&self, inner: &Pose) -> Pose {
        Pose { position: self.transform_point(inner.position), rotation: self.rotation * inner.rotation }
    }

    /// The pose of `other` as seen from `self`.
    pub fn relative(&self, other: &Pose) -> Pose {
        Pose {
            position: self.inverse_transform_point(other.position),
            rotation: self.rotation.conjugate() * other.rotation,
        }
    }
}

/// The bits of −0.
const NEGATIVE_ZERO: u64 = 1 << 63;

/// Whether no component of a rotation is 0, so that the product with the identity has all of its bits.
#[inline]
fn is_tilted(rotation: DQuat) -> bool {
    rotation.to_array().into_iter().all(|component| component != 0.0)
}

/// `rotation · inner`, bit by bit; the sooner where `inner` is the identity, as principal axes mostly are.
#[inline]
pub(crate) fn after_inner(rotation: DQuat, inner: DQuat) -> DQuat {
    if inner == DQuat::IDENTITY && is_tilted(rotation) { rotation } else { rotation * inner }
}

/// `R · diagonal · Rᵀ`: a tensor given by its principal values, in the axes that `rotation` leads to.
pub fn rotated_diagonal(rotation: DQuat, diagonal: DVec3) -> DMat3 {
    let axes = DMat3::from_quat(rotation);
    axes * DMat3::from_diagonal(diagonal) * axes.transpose()
}

/// 1/n! for n from 0 to 17.
const INVERSE_FACTORIALS: [f64; 18] = {
    let mut table = [1.0; 18];
    let mut factorial = 1.0;
    let mut n = 1;
    while n < 18 {
        factorial *= n as f64;
        table[n] = 1.0 / factorial;
        n += 1;
    }
    table
};

/// Sine and cosine of `angle` (rad), |angle| at most about 10⁴, to a few units in the last place.
///
/// Reduction by quarter turns (Cody and Waite 1980), then Taylor series on |x| ≤ π/4.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    // In double precision, what is added to this is rounded to a whole number.
    const ROUNDED: f64 = 1.5 * (1_u64 << 52) as f64;
    const HALF_PI_HIGH: f64 = 1.570_796_326_734_125_6;
    const HALF_PI_LOW: f64 = 6.077_100_506_506_192e-11;
    let quarters = angle * std::f64::consts::FRAC_2_PI;
    if quarters.abs() < 0.5 {
        // As below, where −0 becomes 0.
        return sin_cos_of_small(angle + 0.0);
    }
    let quarter = (quarters + ROUNDED) - ROUNDED;
    let x = (angle - quarter * HALF_PI_HIGH) - quarter * HALF_PI_LOW;
    let (sine, cosine) = sin_cos_of_small(x);
    match quarter as i64 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The same up to an angle of about π/4.
#[inline]
fn sin_cos_of_small(x: f64) -> (f64, f64) {
    let xx = x * x;
    if xx <= SMALL * SMALL {
        // To 2e-22.
        return (x * (1.0 - xx * (1.0 / 6.0 - xx / 120.0)), 1.0 - xx * (0.5 - xx / 24.0));
    }
    let (mut sine, mut cosine) = (0.0, 0.0);
    for n in (0..9).rev() {
        sine = INVERSE_FACTORIALS[2 * n + 1] - sine * xx;
        cosine = INVERSE_FACTORIALS[2 * n] - cosine * xx;
    }
    (sine * x, cosine)
}

/// `(1 − e⁻ˣ)/x` for x ≥ 0: 1 at zero, to about 1e-15. The time that a damped motion still has, over the time that passes.
///
/// Taylor series after halving `x` below 1/4, then the doubling formula `φ(2x) = φ(x)(1 + e⁻ˣ)/2`.
pub fn decay_fraction(x: f64) -> f64 {
    if x == 0.0 {
        return 1.0;
    }
    let mut halvings = 0;
    let mut small = x;
    while small > 0.25 && halvings < 64 {
        small *= 0.5;
        halvings += 1;
    }
    let mut fraction = 1.0;
    for n in [14.0, 13.0, 12.0, 11.0, 10.0, 9.0, 8.0, 7.0, 6.0, 5.0, 4.0, 3.0, 2.0] {
        fraction = 1.0 - fraction * small / n;
    }
    for _ in 0..halvings {
        fraction *= 0.5 * (2.0 - small * fraction);
        small *= 2.0;
    }
    fraction
}

/// What is left of a velocity, of the way that it leads, and of the way's integral, against those without decay: for x ≥ 0
///
/// ```text
/// φ = (1 − e⁻ˣ)/x → 1      ψ = (1 − φ)/x → 1/2      χ = (1/2 − ψ)/x → 1/6
/// ```
#[inline]
pub fn decay_fractions(x: f64) -> [f64; 3] {
    if x == 0.0 {
        return [1.0, 0.5, 1.0 / 6.0];
    }
    fractions_of_decay(x)
}

fn fractions_of_decay(x: f64) -> [f64; 3] {
    let first = decay_fraction(x);
    let second = if x < 1e-4 { 0.5 - x / 6.0 + x * x / 24.0 } else { (1.0 - first) / x };
    let third = if x < 1e-2 {
        1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0 - x / 5040.0)))
    } else {
        (0.5 - second) / x
    };
    [first, second, third]
}

/// Angle (rad) for whose sine and cosine three terms of their series are enough.
const SMALL: f64 = 1e-3;

/// The rotation by `vector`: about its direction, by its length in radians.
pub fn rotation_from_vector(vector: DVec3) -> DQuat {
    let square = vector.length_squared();
    if square <= SMALL * SMALL {
        // sin(x/2)/x and cos(x/2), to 3e-23.
        let axis = vector * (0.5 - square * (1.0 / 48.0 - square / 3840.0));
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 1.0 - square * (1.0 / 8.0 - square / 384.0));
    }
    let angle = square.sqrt();
    let (sine, cosine) = sin_cos(0.5 * angle);
    let axis = vector * (sine / angle);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cosine)
}

/// Some unit vector at right angles to the unit vector `normal`, the same one for the same bits.
pub fn any_tangent(normal: DVec3) -> DVec3 {
    let axis = if normal.x.abs() < 0.6 { DVec3::X } else { DVec3::Y };
    normal.cross(axis).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_the_standard_library() {
        for k in -4000..4000 {
            let angle = f64::from(k) * 0.013_37;
            let (sine, cosine) = sin_cos(angle);
            assert!((sine - angle.sin()).abs() < 1e-14, "{angle}");
            assert!((cosine - angle.cos()).abs() < 1e-14, "{angle}");
        }
    }

    #[test]
    fn small_rotations_go_over_into_large_ones() {
        let direction = DVec3::new(0.6, -0.48, 0.64);
        for angle in [0.0, 1e-300, 1e-12, 1e-6, 0.3e-3, SMALL, SMALL * (1.0 + 1e-12), 2.0 * SMALL] {
            let found = rotation_from_vector(direction * angle);
            let (sine, cosine) = (0.5 * angle).sin_cos();
            let truth = direction * sine;
            assert!((DVec3::new(found.x, found.y, found.z) - truth).length() <= 2e-16 * sine, "{angle}");
            assert!((found.w - cosine).abs() <= 2e-16, "{angle}");
        }
    }

    #[test]
    fn decay_fraction_agrees_with_exp_m1() {
        assert_eq!(decay_fraction(0.0), 1.0);
        for k in 1..400 {
            let x = f64::from(k) * 0.05;
            assert!((decay_fraction(x) + (-x).exp_m1() / x).abs() < 1e-14, "{x}");
        }
    }

    #[test]
    fn decay_fractions_agree_with_their_series() {
        for k in 0..400 {
            let x = f64::from(k) * 0.002;
            let mut truth = [0.0; 3];
            for (number, truth) in truth.iter_mut().enumerate() {
                // Σ (−x)ⁱ/(i + number + 1)!
                let mut term: f64 = (1..=number + 1).map(|n| 1.0 / n as f64).product();
                for i in 0..24 {
                    *truth += term;
                    term *= -x / (i + number + 2) as f64;
                }
            }
            for (found, truth) in decay_fractions(x).into_iter().zip(truth) {
                assert!((found - truth).abs() < 1e-11, "{x}: {found} is {truth}");
            }
        }
    }

    #[test]
    fn what_sits_in_the_middle_is_where_its_body_is() {
        let tilted = rotation_from_vector(DVec3::new(0.3, -0.2, 0.9));
        let halves = [DQuat::from_xyzw(0.0, -0.0, 1.0, 0.0), DQuat::from_xyzw(-0.0, 0.6, -0.8, 0.0)];
        let zeros = DVec3::new(-0.0, 0.0, -3.0);
        let bits = |pose: Pose| {
            let (position, rotation) = (pose.position.to_array(), pose.rotation.to_array());
            (position.map(f64::to_bits), rotation.map(f64::to_bits))
        };
        for rotation in [tilted, -tilted, DQuat::IDENTITY, -DQuat::IDENTITY, halves[0], halves[1]] {
            for position in [DVec3::ONE, zeros, -zeros] {
                let pose = Pose::new(position, rotation);
                for inner in [DVec3::ZERO, -DVec3::ZERO, DVec3::X] {
                    let inner = Pose::new(inner, DQuat::IDENTITY);
                    assert_eq!(bits(pose.then_local(&inner)), bits(pose.after(&inner)), "{pose:?}");
                }
            }
            for inner in [DQuat::IDENTITY, DQuat::IDENTITY.conjugate(), tilted] {
                let (quick, full) = (after_inner(rotation, inner), rotation * inner);
                assert_eq!(quick.to_array().map(f64::to_bits), full.to_array().map(f64::to_bits));
            }
        }
    }

    #[test]
    fn poses_compose_and_invert() {
        let a = Pose::new(DVec3::new(1.0, 2.0, 3.0), rotation_from_vector(DVec3::new(0.3, -0.2, 0.9)));
        let b = Pose::new(DVec3::new(-4.0, 0.5, 1.0), rotation_from_vector(DVec3::new(-1.0, 0.2, 0.1)));
        let point = DVec3::new(0.1, 0.2, 0.3);
        let there = a.then_local(&b).transform_point(point);
        assert!((there - a.transform_point(b.transform_point(point))).length() < 1e-14);
        assert!((a.relative(&a.then_local(&b)).position - b.position).length() < 1e-14);
    }
}
