//! A free body that turns about no principal axis: Jacobi's elliptic functions.

/// Complete elliptic integral of the first kind, `K(k)`, from the complementary modulus `k' = √(1 − k²)`, by the
/// arithmetic-geometric mean (Gauss 1799).
pub fn elliptic_k(complement: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, complement);
    while (a - b).abs() > 4e-16 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    std::f64::consts::PI / (a + b)
}

/// Time (s) between two flips of a free body: between zeros of its spin about the middle axis.
///
/// `moments` (kg·m²) rise strictly; `spin` (rad/s) is about the same axes. Half the period of Jacobi's functions, `2K(k)/p`
/// (Landau and Lifshitz, *Mechanics*, § 37). The differences `L² − 2E·I` are written so that nothing cancels.
pub fn flip_time(moments: [f64; 3], spin: [f64; 3]) -> f64 {
    let [a, b, c] = moments;
    let [x, y, z] = spin.map(|rate| rate * rate);
    let above_least = b * (b - a) * y + c * (c - a) * z;
    let below_greatest = a * (c - a) * x + b * (c - b) * y;
    let about_middle = a * (a - b) * x + c * (c - b) * z;
    let product = a * b * c;
    let strongest = if about_middle > 0.0 { (c - b) * above_least } else { (b - a) * below_greatest };
    let complement = ((c - a) * about_middle.abs() / strongest).sqrt();
    2.0 * elliptic_k(complement) / (strongest / product).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn k_is_the_integral_that_defines_it() {
        for k in [0.0_f64, 0.3, 0.7, 0.95] {
            let n = 20_000;
            let share = std::f64::consts::FRAC_PI_2 / f64::from(n);
            let integrand =
                |j: i32| (1.0 - (k * ((f64::from(j) + 0.5) * share).sin()).powi(2)).sqrt().recip();
            let sum: f64 = (0..n).map(integrand).sum();
            let found = elliptic_k((1.0 - k * k).sqrt());
            assert!((found - sum * share).abs() < 1e-9, "{k}: {found}");
        }
    }

    #[test]
    fn flips_come_when_eulers_equations_say() {
        let moments = [0.1, 0.37, 0.45];
        for spin in [[0.01, 5.0, 0.0], [0.0, 5.0, 0.02], [0.5, 3.0, 0.4]] {
            let rate = |[x, y, z]: [f64; 3]| {
                let [a, b, c] = moments;
                [(b - c) * y * z / a, (c - a) * z * x / b, (a - b) * x * y / c]
            };
            let (h, mut w, mut t, mut zeros) = (1e-4, spin, 0.0, Vec::new());
            while zeros.len() < 3 {
                let add = |u: [f64; 3], d: [f64; 3], s: f64| [0, 1, 2].map(|i| u[i] + s * d[i]);
                let k1 = rate(w);
                let k2 = rate(add(w, k1, 0.5 * h));
                let k3 = rate(add(w, k2, 0.5 * h));
                let k4 = rate(add(w, k3, h));
                let next = [0, 1, 2].map(|i| w[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
                if w[1] * next[1] < 0.0 {
                    zeros.push(t + h * w[1] / (w[1] - next[1]));
                }
                (w, t) = (next, t + h);
            }
            let closed = flip_time(moments, spin);
            assert!((zeros[2] - zeros[1] - closed).abs() < 1e-6, "{spin:?}: {closed}");
            assert!((zeros[1] - zeros[0] - closed).abs() < 1e-6, "{spin:?}: {closed}");
        }
    }
}
