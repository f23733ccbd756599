//! Principal axes of inertia.

use crate::math::{DMat3, DQuat, DVec3};

/// Principal moments of a symmetric `tensor`, and the rotation from its principal axes to the axes it is given in:
/// `tensor = R · diagonal · Rᵀ`.
///
/// Cyclic Jacobi rotations, which keep `R` proper, in one fixed order of `+ − × ÷ √`. Moments are not sorted: a tensor that
/// is diagonal already keeps its order and gets the identity. Products of inertia below `2·10⁻¹⁵ √(I_p I_q)`, which
/// is rounding, count as zero; so even the small moments of a thin body are good to their own last digits.
///
/// # Reference
/// Golub and Van Loan, *Matrix Computations*, 4th ed. (2013), section 8.5; the relative threshold is that of Demmel
/// and Veselić, *Jacobi's method is more accurate than QR* (1992).
pub fn principal_axes(tensor: &DMat3) -> (DVec3, DQuat) {
    const NEGLIGIBLE: f64 = 2e-15;
    const SWEEPS: usize = 32;
    // Rows and columns agree up to rounding; their mean is symmetric exactly.
    let mut a = ((*tensor + tensor.transpose()) * 0.5).to_cols_array_2d();
    let mut axes = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let product = a[p][q];
            if product.abs() <= NEGLIGIBLE * (a[p][p] * a[q][q]).abs().sqrt() {
                a[p][q] = 0.0;
                a[q][p] = 0.0;
                continue;
            }
            rotated = true;
            // tan of the smaller angle that makes the product vanish; a vast `slope` gives 0 and not NaN.
            let slope = (a[q][q] - a[p][p]) / (2.0 * product);
            let tangent = slope.signum() / (slope.abs() + (1.0 + slope * slope).sqrt());
            let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
            let sine = tangent * cosine;

            a[p][p] -= tangent * product;
            a[q][q] += tangent * product;
            a[p][q] = 0.0;
            a[q][p] = 0.0;
            let r = 3 - p - q;
            let (rp, rq) = (a[r][p], a[r][q]);
            a[r][p] = cosine * rp - sine * rq;
            a[r][q] = sine * rp + cosine * rq;
            a[p][r] = a[r][p];
            a[q][r] = a[r][q];
            for k in 0..3 {
                let (vp, vq) = (axes[p][k], axes[q][k]);
                axes[p][k] = cosine * vp - sine * vq;
                axes[q][k] = sine * vp + cosine * vq;
            }
        }
        if !rotated {
            break;
        }
    }
    let rotation = DQuat::from_mat3(&DMat3::from_cols_array_2d(&axes)).normalize();
    (DVec3::new(a[0][0], a[1][1], a[2][2]), rotation)
}
