//! Bundles: contacts in the layout they are solved in.
//!
//! A *contact* is a manifold that rests: up to four points with one normal between two bodies. It owns one lane of a bundle
//! for as long as it lasts, so that nothing has to be gathered, prepared or stored again while it lies still. All
//! its vectors stand in the *contact frame* (t₁, t₂, n) with `t₂ = n × t₁`, where an arm crossed with the normal is
//! just `(y, −x, 0)`.
//!
//! Conventions: impulses act on `b` and, reversed, on `a`; `n` points from `a` to `b`; separating is positive. N·s, m, s.

use super::lanes::{LANES, Line};

/// Points of a contact.
pub(crate) const POINTS: usize = 4;

/// Which line of a bundle holds what.
pub(crate) mod field {
    /// n in the world, three lines.
    pub const NORMAL: usize = 0;
    /// t₁ in the world, three lines.
    pub const TANGENT: usize = 3;
    /// Inverse inertia of `a`, contact frame, six lines; then of `b`.
    pub const INVERSE_INERTIA_A: usize = 6;
    pub const INVERSE_INERTIA_B: usize = 12;
    /// Arms of the place at which friction acts, three lines each. Those of both bodies end there, also when these have moved against
    /// each other.
    pub const FRICTION_ARM_A: usize = 18;
    pub const FRICTION_ARM_B: usize = 21;
    /// 1 / the largest response to a unit impulse in the tangent plane.
    pub const FRICTION_MASS: usize = 24;
    /// Friction impulse along t₁ and t₂.
    pub const FRICTION: usize = 25;
    /// 1 / the response to a unit angular impulse about n, and that impulse (N·m·s).
    pub const TWIST_MASS: usize = 27;
    pub const TWIST: usize = 28;
    /// Coulomb's coefficients.
    pub const STATIC_FRICTION: usize = 29;
    pub const DYNAMIC_FRICTION: usize = 30;
    /// Slip along t₁ and t₂ that the arms' turning during the substep adds, m/s.
    pub const SWING: usize = 31;
    /// How far the last sweep has changed a velocity, m/s.
    pub const RESIDUAL: usize = 33;
    /// The first point's lines; each further point [`POINT_LINES`] further. They end what a sweep reads.
    pub const POINT: usize = 34;
    /// What comes after that is looked at once in a substep.
    pub const SWEPT: usize = POINT + super::POINTS * POINT_LINES;

    /// Gap up to which a point counts at all: what comes from further away strikes. Huge where contacts see to all points. m.
    pub const HORIZON: usize = SWEPT;
    /// The least separation of all points, m.
    pub const GAP: usize = SWEPT + 1;
    /// Radii of curvature where the surfaces are round, of `a` and `b`, m.
    pub const ROUNDNESS: usize = SWEPT + 2;
    /// How much closer to `b`'s idea of it than to `a`'s the place is at which impulses act, 0 to 1.
    pub const SHARE: usize = SWEPT + 4;
    /// What the bodies' drifts have moved `b` against `a` when the contact was renewed, contact frame, m.
    pub const DRIFTED: usize = SWEPT + 5;
    /// Twice the vector of each body's turn since its anchor when the contact was renewed, contact frame.
    pub const TURNED_A: usize = SWEPT + 8;
    pub const TURNED_B: usize = SWEPT + 11;
    /// The arms of friction when the contact was renewed.
    pub const RENEWED_FRICTION_A: usize = SWEPT + 14;
    pub const RENEWED_FRICTION_B: usize = SWEPT + 17;
    /// How much further the bodies have moved against each other since the contact was renewed than they may, m; negative as long as
    /// they have not.
    pub const STRAY: usize = SWEPT + 20;
    /// Gap from which on the contact has left, m.
    pub const PARTING: usize = SWEPT + 21;
    /// What a sweep does not read of the first point.
    pub const POINT_APART: usize = SWEPT + 22;

    /// Of a point: where it is, seen from where friction acts, along t₁ and t₂, m. With the arm of friction it is the arm of the point.
    pub const LEVER: usize = 0;
    /// 1 / the response to a unit normal impulse; 0 where there is no point.
    pub const MASS: usize = 2;
    /// Normal impulse.
    pub const IMPULSE: usize = 3;
    /// Distance from where friction acts, m.
    pub const DISTANCE: usize = 4;
    /// The least normal velocity that it may have, m/s.
    pub const LEAST: usize = 5;
    pub const POINT_LINES: usize = 6;
    /// Separation when the two bodies are at their anchors, m.
    pub const BASE: usize = 6;
    /// Separation at the start of the substep, m.
    pub const SEPARATION: usize = 7;
    /// Where it was when the contact was renewed, seen from where friction acted then, three lines.
    pub const RENEWED_LEVER: usize = 8;
    pub const POINT_LINES_APART: usize = 5;

    /// Impulses of a contact: of its points along the normal, friction, twist.
    pub const ROWS: usize = super::POINTS + 3;
    pub const IMPULSES: [usize; ROWS] = [
        of_point(0, IMPULSE),
        of_point(1, IMPULSE),
        of_point(2, IMPULSE),
        of_point(3, IMPULSE),
        FRICTION,
        FRICTION + 1,
        TWIST,
    ];
    /// 1 / the response to each of them.
    pub const MASSES: [usize; ROWS] = [
        of_point(0, MASS),
        of_point(1, MASS),
        of_point(2, MASS),
        of_point(3, MASS),
        FRICTION_MASS,
        FRICTION_MASS,
        TWIST_MASS,
    ];

    /// Lines of a bundle.
    pub const COUNT: usize = POINT_APART + super::POINTS * POINT_LINES_APART;

    /// A line of point number `point`.
    pub const fn of_point(point: usize, line: usize) -> usize {
        if line < POINT_LINES {
            POINT + point * POINT_LINES + line
        } else {
            POINT_APART + point * POINT_LINES_APART + line - POINT_LINES
        }
    }
}

/// One contact's numbers, line by line.
pub(crate) type Lane = [f32; field::COUNT];

/// The numbers of a lane that touches nothing: no mass to push, and nothing that it could leave.
pub(crate) const NO_CONTACT: Lane = {
    let mut lane = [0.0; field::COUNT];
    lane[field::PARTING] = f32::MAX;
    lane
};

/// Contacts that share no body that can be moved.
#[derive(Clone, Debug)]
pub(crate) struct Bundle {
    pub a: [u32; LANES],
    pub b: [u32; LANES],
    /// The largest number of points in a lane.
    pub points: usize,
    pub lines: [Line; field::COUNT],
}

impl Bundle {
    /// A bundle of lanes that touch nothing, between the world and the world.
    pub const EMPTY: Bundle = {
        let mut lines = [Line::ZERO; field::COUNT];
        let mut line = 0;
        while line < field::COUNT {
            lines[line] = Line([NO_CONTACT[line]; LANES]);
            line += 1;
        }
        Bundle { a: [0; LANES], b: [0; LANES], points: 0, lines }
    };

    pub fn write(&mut self, lane: usize, [a, b]: [u32; 2], values: &Lane) {
        (self.a[lane], self.b[lane]) = (a, b);
        for (line, &value) in self.lines.iter_mut().zip(values) {
            line.0[lane] = value;
        }
        self.count_points();
    }

    pub fn read(&self, lane: usize) -> ([u32; 2], Lane) {
        let mut values = [0.0; field::COUNT];
        for (value, line) in values.iter_mut().zip(&self.lines) {
            *value = line.0[lane];
        }
        ([self.a[lane], self.b[lane]], values)
    }

    pub fn get(&self, lane: usize, field: usize) -> f32 {
        self.lines[field].0[lane]
    }

    /// Whether the bodies of a contact have moved too far against each other since it was renewed.
    #[inline(always)]
    pub fn has_strayed(&self, lane: usize) -> bool {
        self.lines[field::STRAY].0[lane] > 0.0
    }

    /// Whether all its points are within its horizon.
    pub fn is_closed(&self, lane: usize) -> bool {
        let real = (0..POINTS).filter(|&point| self.get(lane, field::of_point(point, field::MASS)) > 0.0);
        let mut separations = real.map(|point| self.get(lane, field::of_point(point, field::SEPARATION)));
        separations.all(|separation| separation <= self.get(lane, field::HORIZON))
    }

    /// Whether all its points are out of its reach.
    #[inline(always)]
    pub fn has_left(&self, lane: usize) -> bool {
        self.lines[field::GAP].0[lane] > self.lines[field::PARTING].0[lane]
    }

    fn count_points(&mut self) {
        let has =
            |point: usize| self.lines[field::of_point(point, field::MASS)].0.iter().any(|&mass| mass > 0.0);
        self.points = (0..POINTS).rev().find(|&point| has(point)).map_or(0, |point| point + 1);
    }
}
