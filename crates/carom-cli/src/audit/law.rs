//! The laws that are held against collisions and steps, and what is found.

use carom::BodyId;

/// How far, relatively, the audit's own geometry may be from the engine's: normals and points of hulls and meshes come out
/// of iterations that agree to about 1e-7, and between steps the engine tells velocities and rotations in single precision. (In the
/// record of a collision its velocities are exact to 1e-12.)
pub const ROUNDING: f64 = 4.0 * f32::EPSILON as f64;

/// How far the shapes' normal may be from the one that was used, rad: curved shapes that go through iterations have
/// normals as precise as the root of their separation.
pub const NORMAL_TOLERANCE: f64 = 5e-4;

/// What is held against collisions and steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Law {
    /// v_s = −C_r·v_c; where several contacts were struck at once v_s ≥ −C_r·v_c.
    SeparatingSpeed,
    /// Momentum, linear, of all that was struck at once: what is missing went into what can't move.
    LinearMomentum,
    /// Momentum, angular, about the (first) point.
    AngularMomentum,
    /// Each body is changed by what its contacts gave it and by nothing else, linear and angular.
    OwnMomentum,
    /// A contact pushes, within the cone of friction.
    Push,
    /// Energy: what C_r takes is lost, no less, and without friction no more.
    Energy,
    /// The normal is the shapes' own.
    Normal,
    /// After its last round no contact of an instant goes on closing.
    Parting,
    /// What touches for the first time, faster than the rest threshold, has a collision.
    Record,
    /// Between touches velocities change by gravity and damping alone.
    Flight,
    /// Between touches the centre of mass stays on its parabola.
    Path,
    /// Between touches the angular momentum stays.
    Spin,
    /// Between touches the energy of turning stays.
    Turning,
    /// What contacts that rest give to a body are pushes, within the cone of friction.
    Support,
    /// Bodies that only touch each other keep their momentum, linear; what stands on others gets no more than pushes from those.
    GroupMomentum,
    /// Bodies that only touch each other keep their momentum, angular.
    GroupSpin,
    /// Bodies that rest on each other gain no energy.
    GroupEnergy,
}

impl Law {
    /// All of them, in the order of reports.
    pub const ALL: [Law; 17] = [
        Law::SeparatingSpeed,
        Law::LinearMomentum,
        Law::AngularMomentum,
        Law::OwnMomentum,
        Law::Push,
        Law::Energy,
        Law::Normal,
        Law::Parting,
        Law::Record,
        Law::Flight,
        Law::Path,
        Law::Spin,
        Law::Turning,
        Law::Support,
        Law::GroupMomentum,
        Law::GroupSpin,
        Law::GroupEnergy,
    ];

    /// Its name in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "separating_speed",
            Law::LinearMomentum => "linear_momentum",
            Law::AngularMomentum => "angular_momentum",
            Law::OwnMomentum => "own_momentum",
            Law::Push => "push",
            Law::Energy => "energy",
            Law::Normal => "normal",
            Law::Parting => "parting",
            Law::Record => "record",
            Law::Flight => "flight",
            Law::Path => "path",
            Law::Spin => "spin",
            Law::Turning => "turning",
            Law::Support => "support",
            Law::GroupMomentum => "group_momentum",
            Law::GroupSpin => "group_spin",
            Law::GroupEnergy => "group_energy",
        }
    }

    /// The unit of its error.
    pub fn unit(self) -> &'static str {
        match self {
            Law::SeparatingSpeed | Law::Parting | Law::Record | Law::Flight => "m/s",
            Law::LinearMomentum | Law::OwnMomentum | Law::Push | Law::Support | Law::GroupMomentum => "N·s",
            Law::AngularMomentum | Law::Spin | Law::GroupSpin => "N·m·s",
            Law::Energy | Law::Turning | Law::GroupEnergy => "J",
            Law::Normal => "rad",
            Law::Path => "m",
        }
    }

    /// What it says, in a line.
    pub fn says(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => "v_s = −C_r·v_c; ≥ where several are struck at once",
            Law::LinearMomentum => "of all struck at once, with what the immovable took",
            Law::AngularMomentum => "the same, about the first point",
            Law::OwnMomentum => "each body gets the impulses of its contacts, no more",
            Law::Push => "a contact pushes, within the cone of friction",
            Law::Energy => "C_r takes its share; friction never gives",
            Law::Normal => "the normal is the shapes' own",
            Law::Parting => "after its last round nothing closes",
            Law::Record => "a first touch above the rest threshold is a collision",
            Law::Flight => "in flight only gravity and damping change velocities",
            Law::Path => "in flight the centre keeps to its parabola",
            Law::Spin => "in flight angular momentum stays",
            Law::Turning => "in flight the energy of turning stays",
            Law::Support => "what rests is pushed, within the cone of friction",
            Law::GroupMomentum => "what rests on others only gets what they push",
            Law::GroupSpin => "what rests on nothing fixed keeps angular momentum",
            Law::GroupEnergy => "what rests gains no energy",
        }
    }

    /// How its tolerance comes about; ε is [`ROUNDING`].
    pub fn tolerance_rule(self) -> &'static str {
        match self {
            Law::SeparatingSpeed => {
                "ε·Σ(|v| + |r|·(|I⁻¹|·|Iω| + |ω|)) + |u|·(error of the normal); of several, + 0.1·(that of parting; all of ½·g·h for C_r = 0) or 1e-3·(fastest |v_c|)"
            }
            Law::LinearMomentum => "ε·Σ m|v|, before and after",
            Law::AngularMomentum => "ε·Σ(|x−p|·m|v| + |Iω|), before and after, p the point",
            Law::OwnMomentum => "ε·Σ(m|v| + |Iω|/ℓ), before and after, + ε·Σf; ℓ the longest lever arm",
            Law::Push => "ε·(Σ m|v| of the lighter body + f) + 2f·(error of the normal)",
            Law::Energy => "ε·Σ(m|v|² + |ω|·|Iω|) + (1−C_r)·f·(tolerance of the speed)",
            Law::Normal => "5e-4 rad: what iterations on curved shapes leave of a normal",
            Law::Parting => {
                "tolerance of the speed + ½·g·h; what rested already 2 % of its size per h, if more"
            }
            Law::Record => "the rest threshold ½·a·h; g·h for what contacts hold",
            Law::Flight => "ε·(|v| + |v'| + |a|·t)",
            Law::Path => "ε·(|v| + |v'|)·t + 2e-7·|centre of mass from origin| + 1e-15·|x|",
            Law::Spin => "ε·I_max·(|ω| + |ω'|)",
            Law::Turning => "ε·I_max·(|ω|² + |ω'|²), 4ε·… where more than 1e-2 rad are turned",
            Law::Support => {
                "ε·m(|v| + |v'| + g·t + k·(|ω| + |ω'|)) + 1e-3·f; the cone as much wider as the contact turns"
            }
            Law::GroupMomentum => {
                "ε·Σ m(|v| + |v'|) + ε·Σ(what contacts gave); + 1e-3 of what fixed bodies gave"
            }
            Law::GroupSpin => {
                "as group momentum, times distances + (gaps that contacts close)·(what they gave)"
            }
            Law::GroupEnergy => {
                "Σ ½·m·a²·h·dt + m·a·h·|Δv| of collisions + m·g·overlap + ε·Σ(m|v|² + …); a = g + f/(m·dt)"
            }
        }
    }
}

/// What a finding is about.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// A collision: its place among those that the audit was given (the first, where the law is about several at once).
    Collision(usize),
    /// Bodies, at a time (s).
    Bodies(Vec<BodyId>, f64),
}

/// One law held against one collision, or one body or more in a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Which law.
    pub law: Law,
    /// Where.
    pub place: Place,
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

/// `value` if it is positive or no number at all, else 0.
pub fn positive(value: f64) -> f64 {
    if value <= 0.0 { 0.0 } else { value }
}
