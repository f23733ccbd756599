//! The laws that are held against collisions, and what is found.

/// How far, relatively, the audit's own geometry may be from the engine's: normals and points of hulls and meshes come out
/// of iterations that agree to about 1e-7. (The engine's velocities themselves are exact to 1e-12.)
pub const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// How far the shapes' normal may be from the one that was used, rad: curved shapes that go through iterations have
/// normals as precise as the root of their separation.
pub const NORMAL_TOLERANCE: f64 = 1e-4;

/// What is held against collisions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    /// v_s = −C_r·v_c; where several contacts were struck at once v_s ≥ −C_r·v_c.
    SeparatingSpeed,
    /// Momentum, linear: whatever the sum changed by came through contacts with what can't move.
    LinearMomentum,
    /// Momentum, angular, about the (first) point of the instant.
    AngularMomentum,
    /// Each body was changed by impulses at its contact points, along the normal where there is no friction.
    LineOfAction,
    /// Energy: what C_r takes is lost, no less, and without friction no more.
    Energy,
    /// The normal is the shapes' own.
    Normal,
}

impl Law {
    /// All of them, in the order of reports.
    pub const ALL: [Law; 6] = [
        Law::SeparatingSpeed,
        Law::LinearMomentum,
        Law::AngularMomentum,
        Law::LineOfAction,
        Law::Energy,
        Law::Normal,
    ];

    /// Its name in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "separating_speed",
            Law::LinearMomentum => "linear_momentum",
            Law::AngularMomentum => "angular_momentum",
            Law::LineOfAction => "line_of_action",
            Law::Energy => "energy",
            Law::Normal => "normal",
        }
    }

    /// The unit of its error.
    pub fn unit(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "m/s",
            Law::LinearMomentum | Law::LineOfAction => "N·s",
            Law::AngularMomentum => "N·m·s",
            Law::Energy => "J",
            Law::Normal => "rad",
        }
    }

    /// How its tolerance comes about; ε is [`ROUNDING`].
    pub fn tolerance_rule(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "ε·Σ(|v| + |r|·(|I⁻¹|·|Iω| + |ω|)), over both bodies, before and after",
            Law::LinearMomentum => "ε·Σ(m|v| + (|x−p|·m|v| + |Iω|)/ℓ), before and after; ℓ the longest |x−p|",
            Law::AngularMomentum => "ε·Σ(ℓ·m|v| + |x−p|·m|v| + |Iω|), before and after, p the point",
            Law::LineOfAction => "as momentum, of that body alone",
            Law::Energy => "ε·Σ(m|v|² + |ω|·|Iω|) + (1−C_r²)·|v_c|·(tolerance of the speed)/K",
            Law::Normal => "1e-4 rad: what iterations on curved shapes leave of a normal",
        }
    }
}

/// One law held against one collision (the first of its instant, where the law is about all of them).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Which law.
    pub law: Law,
    /// Which of the impacts that the audit was given.
    pub impact: usize,
    /// How far off.
    pub error: f64,
    /// How far rounding can put it.
    pub tolerance: f64,
}

impl Finding {
    /// Whether the law was broken. An error that is no number breaks every law.
    pub fn is_violation(&self) -> bool {
        self.error > self.tolerance || self.error.is_nan() || self.tolerance.is_nan()
    }

    /// Error over tolerance.
    pub fn ratio(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.tolerance }
    }
}
