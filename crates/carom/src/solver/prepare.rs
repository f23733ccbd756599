//! A manifold becomes a lane: the points' arms, masses and separations in the contact frame.

use super::bundle::{Lane, field};
use crate::collide::ContactPoint;
use crate::material::Surface;
use crate::math::{DMat3, DVec3, any_tangent};

/// A body as a contact sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    /// Centre of mass in the world, m.
    pub center: DVec3,
    /// 1/kg; 0 where nothing moves it.
    pub inverse_mass: f64,
    /// World axes; zero where nothing turns it.
    pub inverse_inertia: DMat3,
    /// Translation and turn `(x, y, z, w)` since the body's anchor.
    pub drift: (DVec3, [f64; 4]),
    /// Radius of curvature where the surface is round: the point of touch does not turn with it. m.
    pub roundness: f64,
}

/// What decides how a contact is solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    pub surface: Surface,
    /// Gap up to which two points count as touching, m.
    pub margin: f64,
    /// Gap up to which contacts see to a point, m; a pair parts when all of its are further.
    pub horizon: f64,
    /// Whether they see to all points, however far they are.
    pub is_pressed: bool,
}

/// Impulses that a contact starts from.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Remembered {
    /// Of each point, along the normal, N·s.
    pub pressure: [f64; 4],
    /// Across it, in the world, N·s.
    pub friction: DVec3,
    /// About it, N·m·s.
    pub twist: f64,
}

/// A share of what it is compared with that single precision does not see.
const ROUNDING: f64 = 1e-10;

/// Rows of the frame (t₁, t₂, n).
struct Frame {
    first: DVec3,
    second: DVec3,
    normal: DVec3,
}

impl Frame {
    fn inward(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.first), v.dot(self.second), v.dot(self.normal))
    }

    /// A product of inertia that is [`ROUNDING`] counts as none: multiplied by a velocity it would be a denormal number, and a sweep
    /// over those takes about ten times as long.
    fn tensor(&self, world: &DMat3) -> [f64; 6] {
        let (first, second, normal) = (*world * self.first, *world * self.second, *world * self.normal);
        let moments = [first.dot(self.first), second.dot(self.second), normal.dot(self.normal)];
        let least = ROUNDING * (moments[0] + moments[1] + moments[2]);
        let product = |value: f64| if value.abs() > least { value } else { 0.0 };
        [
            moments[0],
            product(first.dot(self.second)),
            product(first.dot(self.normal)),
            moments[1],
            product(second.dot(self.normal)),
            moments[2],
        ]
    }

    /// As the kernel's.
    fn twice_turn(&self, [i, j, k, w]: [f64; 4]) -> DVec3 {
        self.inward(DVec3::new(i, j, k)) * (2.0 * w)
    }

    /// As the kernel's `drift_of_arm`.
    fn drift_of_arm(&self, [i, j, k, w]: [f64; 4]) -> DVec3 {
        let turn = self.inward(DVec3::new(i, j, k));
        let (x, y, z) = (turn.x, turn.y, turn.z);
        2.0 * DVec3::new(x * z - w * y, y * z + w * x, -(x * x + y * y))
    }
}

/// Fills the lane of up to four points that share `normal`, from `a` to `b`.
pub(crate) fn fill_lane(
    lane: &mut Lane,
    (normal, points): (DVec3, &[ContactPoint]),
    sides: &[Side; 2],
    terms: &Terms,
    remembered: &Remembered,
) {
    let first = any_tangent(normal);
    let frame = Frame { first, second: normal.cross(first), normal };
    lane.fill(0.0);
    let mut put = |line: usize, value: f64| lane[line] = value as f32;
    put_vector(&mut put, field::NORMAL, normal);
    put_vector(&mut put, field::TANGENT, first);
    let inertia = sides.each_ref().map(|side| frame.tensor(&side.inverse_inertia));
    for (entry, (a, b)) in inertia[0].into_iter().zip(inertia[1]).enumerate() {
        put(field::INVERSE_INERTIA_A + entry, a);
        put(field::INVERSE_INERTIA_B + entry, b);
    }
    let inverse_mass = sides[0].inverse_mass + sides[1].inverse_mass;
    let apart = normal.dot(sides[1].drift.0 - sides[0].drift.0);
    let drifts = sides.each_ref().map(|side| frame.drift_of_arm(side.drift.1));

    let middle = middle(points, terms.margin);
    for (index, contact) in points.iter().enumerate() {
        let at = |line: usize| field::of_point(index, line);
        let lever = frame.inward(contact.point - middle);
        put(at(field::LEVER), lever.x);
        put(at(field::LEVER) + 1, lever.y);
        put_vector(&mut put, at(field::RENEWED_LEVER), lever);
        let arms = sides.each_ref().map(|side| frame.inward(contact.point - side.center));
        // The part of each arm that turns with its body ends where the surface's centre of curvature is.
        let turning = [arms[0] - sides[0].roundness * DVec3::Z, arms[1] + sides[1].roundness * DVec3::Z];
        put(
            at(field::BASE),
            contact.separation - apart - drifts[1].dot(turning[1]) + drifts[0].dot(turning[0]),
        );
        let response = inverse_mass + about_normal(&inertia[0], arms[0]) + about_normal(&inertia[1], arms[1]);
        put(at(field::MASS), inverse_of(response));
        put(at(field::IMPULSE), remembered.pressure[index]);
        put(at(field::DISTANCE), lever.length());
        put(at(field::SEPARATION), contact.separation);
    }

    let separations = points.iter().map(|contact| contact.separation);
    put(field::GAP, separations.fold(f64::from(f32::MAX), f64::min));
    let arms = sides.each_ref().map(|side| frame.inward(middle - side.center));
    put_vector(&mut put, field::FRICTION_ARM_A, arms[0]);
    put_vector(&mut put, field::FRICTION_ARM_B, arms[1]);
    put_vector(&mut put, field::RENEWED_FRICTION_A, arms[0]);
    put_vector(&mut put, field::RENEWED_FRICTION_B, arms[1]);
    let response = tangent_response(inverse_mass, &inertia, &arms);
    put(field::FRICTION_MASS, inverse_of(response));
    put(field::FRICTION, remembered.friction.dot(frame.first));
    put(field::FRICTION + 1, remembered.friction.dot(frame.second));
    put(field::TWIST_MASS, inverse_of(inertia[0][5] + inertia[1][5]));
    put(field::TWIST, remembered.twist);
    put(field::STATIC_FRICTION, terms.surface.static_friction);
    put(field::DYNAMIC_FRICTION, terms.surface.dynamic_friction);
    put(field::HORIZON, if terms.is_pressed { f64::from(f32::MAX) } else { terms.horizon });
    put(field::PARTING, terms.horizon);
    put(field::ROUNDNESS, sides[0].roundness);
    put(field::ROUNDNESS + 1, sides[1].roundness);
    put(field::SHARE, share(sides));
    put_vector(&mut put, field::DRIFTED, frame.inward(sides[1].drift.0 - sides[0].drift.0));
    let turned = sides.each_ref().map(|side| frame.twice_turn(side.drift.1));
    put_vector(&mut put, field::TURNED_A, turned[0]);
    put_vector(&mut put, field::TURNED_B, turned[1]);
}

/// Where the two bodies' ideas of a place differ: what is round touches where it is, on what is not. Else the lighter one's counts
/// more, as an error of the arm would turn it more.
fn share([a, b]: &[Side; 2]) -> f64 {
    let [round_a, round_b] = [a, b].map(|side| side.roundness > 0.0 && side.inverse_mass > 0.0);
    let weights = if round_a != round_b {
        [round_a, round_b].map(f64::from)
    } else if a.inverse_mass + b.inverse_mass > 0.0 {
        [a.inverse_mass, b.inverse_mass]
    } else {
        [a, b].map(|side| f64::from(side.inverse_inertia != DMat3::ZERO))
    };
    weights[1] / (weights[0] + weights[1]).max(f64::MIN_POSITIVE)
}

fn put_vector(put: &mut impl FnMut(usize, f64), line: usize, v: DVec3) {
    put(line, v.x);
    put(line + 1, v.y);
    put(line + 2, v.z);
}

fn inverse_of(response: f64) -> f64 {
    if response > 0.0 { 1.0 / response } else { 0.0 }
}

/// Where friction acts: the middle of the points, those that touch counting most.
pub(crate) fn middle(points: &[ContactPoint], margin: f64) -> DVec3 {
    let least = points.iter().map(|point| point.separation).fold(f64::INFINITY, f64::min);
    let weight = |point: &ContactPoint| {
        let nearness = margin / (margin + (point.separation - least.max(0.0)).max(0.0));
        nearness * nearness
    };
    let total: f64 = points.iter().map(weight).sum();
    let origin = points.first().map_or(DVec3::ZERO, |point| point.point);
    let offset = |point: &ContactPoint| (weight(point) / total) * (point.point - origin);
    origin + points.iter().map(offset).sum::<DVec3>()
}

/// `(r × n)·I⁻¹(r × n)` in the contact frame.
fn about_normal([xx, xy, _, yy, ..]: &[f64; 6], arm: DVec3) -> f64 {
    xx * arm.y * arm.y - 2.0 * xy * arm.x * arm.y + yy * arm.x * arm.x
}

/// The largest response to a unit impulse in the tangent plane: the larger eigenvalue of
/// `K = (1/m_a + 1/m_b)·1 + Σ [r]ᵀI⁻¹[r]`, its upper left 2×2 block.
fn tangent_response(inverse_mass: f64, inertia: &[[f64; 6]; 2], arms: &[DVec3; 2]) -> f64 {
    let (mut k11, mut k12, mut k22) = (inverse_mass, 0.0, inverse_mass);
    for ([xx, xy, xz, yy, yz, zz], r) in inertia.iter().zip(arms) {
        k11 += yy * r.z * r.z - 2.0 * yz * r.y * r.z + zz * r.y * r.y;
        k22 += xx * r.z * r.z - 2.0 * xz * r.x * r.z + zz * r.x * r.x;
        k12 += yz * r.x * r.z - xy * r.z * r.z + xz * r.y * r.z - zz * r.x * r.y;
    }
    let difference = k11 - k22;
    0.5 * (k11 + k22) + (0.25 * difference * difference + k12 * k12).sqrt()
}
