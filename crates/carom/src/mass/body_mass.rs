//! Mass and inertia as a body uses them.

use super::{MassProperties, principal_axes};
use crate::body::{Body, Motion, PrincipalInertia};
use crate::error::{Invalid, limits};
use crate::math::{DQuat, DVec3};

/// Mass and inertia as a body uses them: infinite where nothing can move it; inertia by its principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyMass {
    /// Mass, kg; infinite if nothing can move the body.
    pub mass: f64,
    /// Centre of mass in the body's frame, m.
    pub center: DVec3,
    /// Principal moments of inertia about the centre of mass, kg·m²; infinite where nothing can turn it.
    pub moments: DVec3,
    /// Turns the principal axes into the body's.
    pub principal_rotation: DQuat,
}

impl BodyMass {
    /// What nothing can move: infinite mass and inertia.
    pub const INFINITE: BodyMass = BodyMass {
        mass: f64::INFINITY,
        center: DVec3::ZERO,
        moments: DVec3::INFINITY,
        principal_rotation: DQuat::IDENTITY,
    };

    /// The mass that `body` moves with: its colliders', with what it says of its own in place of theirs.
    ///
    /// - `mass` scales the colliders' mass and inertia; 0 makes both infinite (the inertia unless it is given).
    /// - `mass` on colliders that enclose no volume, such as an open mesh, is spread over their surfaces: thin sheets, all
    ///   of one thickness, so that a uniform density makes them a sheet of uniform area density.
    /// - `center_of_mass` goes before the colliders' centre; the inertia about the centre stays as it is.
    /// - `inertia` goes before the colliders'; 0 on an axis stands for infinite.
    ///
    /// Fixed and kinematic bodies are [`INFINITE`](Self::INFINITE); a kinematic one keeps its centre of mass, which
    /// is what its linear velocity belongs to.
    ///
    /// # Errors
    /// If mass or inertia come out as none that a body can have.
    pub fn of(body: &Body) -> Result<Self, Invalid> {
        if body.motion == Motion::Fixed {
            return Ok(Self::INFINITE);
        }
        let solid = body.collider_mass();
        let is_sheet = body.motion == Motion::Dynamic && body.mass.is_some() && solid.mass <= 0.0;
        let colliders = if is_sheet { body.sheet_mass() } else { solid };
        let center = match body.center_of_mass {
            Some(center) => {
                for axis in 0..3 {
                    let range = -limits::POSITION..=limits::POSITION;
                    limits::within(&format!("center_of_mass[{axis}]"), center[axis], range, "m")?;
                }
                center
            }
            None => colliders.center,
        };
        if body.motion == Motion::Kinematic {
            return Ok(Self { center, ..Self::INFINITE });
        }
        let mass = mass_of(body.mass, &colliders)?;
        let (moments, principal_rotation) = match &body.inertia {
            Some(inertia) => given_inertia(inertia)?,
            None if mass.is_infinite() => (DVec3::INFINITY, DQuat::IDENTITY),
            None if colliders.mass <= 0.0 => {
                let expected = "`inertia_diagonal` as well, or a collider with density and a volume or a surface: \
                                `mass` alone says nothing of how hard the body is to turn";
                return Err(Invalid::new("mass", mass, expected));
            }
            None => principal_axes(&colliders.scaled(mass / colliders.mass).inertia),
        };
        if let Some(axis) = (0..3).find(|&axis| moments[axis].is_nan() || moments[axis] <= 0.0) {
            // Only rounding of colliders thinner than a part in 10⁷ of their distance comes here.
            let expected = "a body thick enough to turn, or `inertia_diagonal`";
            return Err(Invalid::new("colliders", format!("a moment of {} kg·m²", moments[axis]), expected));
        }
        Ok(Self { mass, center, moments, principal_rotation })
    }

    /// 1/mass, 1/kg; 0 where infinite.
    pub fn inverse_mass(&self) -> f64 {
        1.0 / self.mass
    }

    /// 1/moments, 1/(kg·m²); 0 where infinite.
    pub fn inverse_moments(&self) -> DVec3 {
        DVec3::ONE / self.moments
    }

    /// Whether nothing can push the body along.
    pub fn is_infinite(&self) -> bool {
        self.mass.is_infinite()
    }

    /// Whether nothing can turn the body, about any axis.
    pub fn is_infinitely_hard_to_turn(&self) -> bool {
        self.moments.to_array().iter().all(|moment| moment.is_infinite())
    }
}

/// The mass (kg) of a dynamic body that names `given` as its own.
fn mass_of(given: Option<f64>, colliders: &MassProperties) -> Result<f64, Invalid> {
    match given {
        // `-0.0 == 0.0`, so this takes both.
        Some(0.0) => Ok(f64::INFINITY),
        Some(mass) => {
            let (low, high) = (limits::MASS.start(), limits::MASS.end());
            let expected = format!("a number from {low:e} to {high:e} kg, or 0 for infinite");
            limits::within("mass", mass, limits::MASS, "kg")
                .map_err(|error| Invalid { expected, ..error })?;
            Ok(mass)
        }
        None if colliders.mass == 0.0 => {
            let expected =
                "a dynamic body with colliders of some volume, or `mass` together with `inertia_diagonal`";
            Err(Invalid::new("mass", "0 kg from the colliders", expected))
        }
        None => {
            let (low, high) = (limits::MASS.start(), limits::MASS.end());
            if limits::MASS.contains(&colliders.mass) {
                return Ok(colliders.mass);
            }
            let expected =
                format!("{low:e} to {high:e} kg: other densities or sizes of the colliders, or `mass`");
            Err(Invalid::new("mass", format!("{} kg from the colliders", colliders.mass), expected))
        }
    }
}

fn given_inertia(inertia: &PrincipalInertia) -> Result<(DVec3, DQuat), Invalid> {
    if !inertia.orientation.is_finite() || !inertia.orientation.is_normalized() {
        let expected = "a unit quaternion [x, y, z, w] from the principal axes to the body's";
        return Err(Invalid::new("inertia_orientation", inertia.orientation, expected));
    }
    let mut moments = inertia.diagonal;
    for axis in 0..3 {
        let (low, high) = (limits::INERTIA.start(), limits::INERTIA.end());
        if moments[axis] == 0.0 {
            moments[axis] = f64::INFINITY;
        } else if !limits::INERTIA.contains(&moments[axis]) {
            let expected = format!("a number from {low:e} to {high:e} kg·m², or 0 for infinite");
            return Err(Invalid::new(format!("inertia_diagonal[{axis}]"), moments[axis], expected));
        }
    }
    // I_x + I_y − I_z = 2∫z² dm cannot be negative. Where one is infinite that says nothing.
    let excess = 2.0 * moments.max_element() - moments.element_sum();
    if moments.is_finite() && excess > 1e-6 * moments.max_element() {
        let expected = "no moment larger than the sum of the other two (kg·m²), as in every body there is";
        return Err(Invalid::new("inertia_diagonal", inertia.diagonal, expected));
    }
    Ok((moments, inertia.orientation))
}
