//! Cost against size: what becomes of an engine's time as bodies become more.

use crate::rounds::{Case, Entrant};
use serde::{Deserialize, Serialize};

/// One engine in one scene with one number of threads, at all sizes.
///
/// Only what did all steps is in it: a run that was cut short shows another part of the scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Curve {
    /// The scene's name.
    pub scene: String,
    /// How many threads stepped each world.
    pub threads: usize,
    /// The engine's name.
    pub engine: String,
    /// From small to large.
    pub points: Vec<Point>,
    /// p where time goes with n^p: the slope of the line with the least squares through all points, in logarithms.
    pub exponent: Option<f64>,
    /// The same between the two largest sizes alone.
    pub last_exponent: Option<f64>,
}

/// One size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Dynamic bodies.
    pub bodies: usize,
    /// The least of the rounds' mean times of a step, ms.
    pub ms: f64,
}

impl Curve {
    /// All curves that these cases make, in their order.
    pub fn all(cases: &[Case]) -> Vec<Self> {
        let mut curves: Vec<Self> = Vec::new();
        for case in cases {
            for entrant in &case.entrants {
                let (scene, engine) = (&case.scene, &entrant.engine);
                let same = |curve: &Self| {
                    (&curve.scene, curve.threads, &curve.engine) == (scene, case.threads, engine)
                };
                let index = curves.iter().position(same).unwrap_or_else(|| {
                    curves.push(Self::empty(scene, case.threads, engine));
                    curves.len() - 1
                });
                curves[index].points.extend(Point::of(entrant));
            }
        }
        curves.iter_mut().for_each(Self::fit);
        curves
    }

    fn empty(scene: &str, threads: usize, engine: &str) -> Self {
        Self {
            scene: scene.to_string(),
            threads,
            engine: engine.to_string(),
            points: Vec::new(),
            exponent: None,
            last_exponent: None,
        }
    }

    /// Works out the exponents.
    fn fit(&mut self) {
        self.points.sort_by_key(|point| point.bodies);
        self.exponent = exponent(&self.points);
        self.last_exponent = exponent(&self.points[self.points.len().saturating_sub(2)..]);
    }

    /// The exponent between a size and the next smaller one.
    pub fn local_exponent(&self, bodies: usize) -> Option<f64> {
        let index = self.points.iter().position(|point| point.bodies == bodies)?;
        exponent(&self.points[index.checked_sub(1)?..=index])
    }
}

impl Point {
    /// What an entrant adds to its curve: nothing if it was stopped.
    fn of(entrant: &Entrant) -> Option<Self> {
        let summary = entrant.summary.as_ref().filter(|summary| summary.whole())?;
        Some(Self { bodies: entrant.first()?.bodies, ms: summary.least })
    }
}

/// The slope of the line with the least squares through ln(ms) over ln(bodies); `None` without two sizes.
///
/// ```text
/// p = Σ (x − x̄)(y − ȳ) / Σ (x − x̄)²        x = ln(bodies), y = ln(ms)
/// ```
fn exponent(points: &[Point]) -> Option<f64> {
    let logarithms: Vec<[f64; 2]> = points.iter().map(|p| [(p.bodies as f64).ln(), p.ms.ln()]).collect();
    let mean = |i: usize| logarithms.iter().map(|point| point[i]).sum::<f64>() / points.len() as f64;
    let (mean_x, mean_y) = (mean(0), mean(1));
    let across: f64 = logarithms.iter().map(|[x, y]| (x - mean_x) * (y - mean_y)).sum();
    let along: f64 = logarithms.iter().map(|[x, _]| (x - mean_x).powi(2)).sum();
    (along > 0.0).then_some(across / along).filter(|slope| slope.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    fn points(of: &[(usize, f64)]) -> Vec<Point> {
        of.iter().map(|&(bodies, ms)| Point { bodies, ms }).collect()
    }

    #[test]
    fn a_power_has_its_exponent() {
        for power in [0.5, 1.0, 1.25, 2.0] {
            let curve = points(&[100, 700, 3000, 100_000].map(|n| (n, 0.3 * (n as f64).powf(power))));
            assert!((exponent(&curve).unwrap() - power).abs() < 1e-12);
        }
    }

    /// By hand, in decades: x = −1, 0, 1 and y = 0, 0, 3 have Σxy = 3 and Σx² = 2.
    #[test]
    fn the_line_has_the_least_squares() {
        let curve = points(&[(10, 1.0), (100, 1.0), (1000, 1000.0)]);
        assert!((exponent(&curve).unwrap() - 1.5).abs() < 1e-12);
    }

    #[test]
    fn one_size_has_no_exponent() {
        assert_eq!(exponent(&[]), None);
        assert_eq!(exponent(&points(&[(10, 1.0)])), None);
        assert_eq!(exponent(&points(&[(10, 1.0), (10, 2.0)])), None);
        assert_eq!(exponent(&points(&[(10, 0.0), (20, 2.0)])), None);
    }

    #[test]
    fn cases_become_curves() {
        let curves = Curve::all(&sample::cases());
        let named: Vec<_> = curves.iter().map(|curve| (curve.threads, curve.engine.as_str())).collect();
        assert_eq!(named, [(1, "carom"), (1, "peer"), (2, "carom"), (2, "peer")]);
        for (curve, power) in curves.iter().zip([1.0, 1.5, 1.0, 1.5]) {
            assert_eq!(curve.points.len(), 3);
            for found in [curve.exponent, curve.last_exponent, curve.local_exponent(1000)] {
                assert!((found.unwrap() - power).abs() < 1e-12, "{curve:?}");
            }
            assert_eq!(curve.local_exponent(100), None);
        }
    }

    #[test]
    fn what_was_cut_short_is_no_part_of_a_curve() {
        let mut cases = sample::cases();
        let summary = cases[2].entrants[0].summary.as_mut().unwrap();
        summary.steps = (1, 2);
        let curves = Curve::all(&cases);
        assert_eq!(curves[0].points.len(), 2);
        assert_eq!(curves[1].points.len(), 3);
    }
}
