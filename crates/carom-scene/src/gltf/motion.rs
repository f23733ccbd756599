//! `motion`: what makes a node a body that moves.

use super::frame::Frame;
use super::json::At;
use crate::SceneError;
use carom::math::{DQuat, DVec3};
use carom::{Body, PrincipalInertia, limits};

/// Makes the body of a node with a `motion`, without its colliders. Its frame is the node's without the scale.
///
/// - `centerOfMass` is a point of the node's space: it takes the scale of the node.
/// - Velocities are turned from the node's axes to the world's; metres stay metres, whatever the scale. The
///   linear one is that of the centre of mass, as in the engine.
/// - Moments of inertia are in kg·m² of the world and take no scale.
pub(super) fn body(motion: &At, frame: &Frame, notes: &mut Vec<String>) -> Result<Body, SceneError> {
    motion.only(&[
        "isKinematic",
        "mass",
        "centerOfMass",
        "inertiaDiagonal",
        "inertiaOrientation",
        "linearVelocity",
        "angularVelocity",
        "gravityFactor",
    ])?;
    if frame.scale().is_none() {
        return Err(motion.refused("a sheared node", "a node whose axes are perpendicular in the world"));
    }
    let kinematic = motion.get("isKinematic")?.map_or(Ok(false), |at| at.boolean())?;
    let mut body = if kinematic { Body::kinematic() } else { Body::dynamic() };
    let velocity = |key: &str, unit: &str| match motion.get(key)? {
        Some(at) => Ok((frame.rotation * at.vector(limits::SPEED, unit)?).as_vec3()),
        None => Ok(carom::math::Vec3::ZERO),
    };
    body.linear_velocity = velocity("linearVelocity", " m/s")?;
    body.angular_velocity = velocity("angularVelocity", " rad/s")?;
    body.gravity_factor = motion.get("gravityFactor")?.map_or(Ok(1.0), |at| at.number())?;
    body.mass = motion.get("mass")?.map(|at| mass(&at)).transpose()?;
    body.center_of_mass = motion
        .get("centerOfMass")?
        .map(|at| at.vector(limits::POSITION, " m"))
        .transpose()?
        .map(|center| frame.stretch() * center);
    let diagonal = motion.get("inertiaDiagonal")?.map(|at| moments(&at)).transpose()?;
    let orientation = motion.get("inertiaOrientation")?.map(|at| at.rotation()).transpose()?;
    match (diagonal, orientation) {
        (Some(diagonal), orientation) => {
            let orientation = orientation.unwrap_or(DQuat::IDENTITY);
            body.inertia = Some(PrincipalInertia { diagonal, orientation });
        }
        (None, Some(orientation)) if orientation.w.abs() < 1.0 => {
            notes.push(format!("{}.inertiaOrientation has no effect without inertiaDiagonal", motion.path))
        }
        (None, _) => {}
    }
    if kinematic {
        let given = body.mass.is_some() || body.center_of_mass.is_some() || body.inertia.is_some();
        if given {
            notes.push(format!("{}: mass and inertia have no effect on a kinematic body", motion.path));
        }
        (body.mass, body.center_of_mass, body.inertia) = (None, None, None);
    }
    Ok(body)
}

/// Adds the mass of the colliders where the file states a centre or an inertia, but no mass to go with them.
pub(super) fn complete_mass(body: &mut Body, motion: &At) -> Result<(), SceneError> {
    if body.mass.is_some() || (body.center_of_mass.is_none() && body.inertia.is_none()) {
        return Ok(());
    }
    let mass = body.collider_mass().mass;
    if !limits::MASS.contains(&mass) {
        let (path, file) = (format!("{}.mass", motion.path), motion.file);
        let expected = "a mass in kg, since the volume of the colliders gives none";
        return Err(SceneError::invalid(file, path, format!("{mass} kg"), expected));
    }
    body.mass = Some(mass);
    Ok(())
}

fn mass(at: &At) -> Result<f64, SceneError> {
    if at.value.as_f64() == Some(0.0) {
        return Ok(0.0);
    }
    let (low, high) = (limits::MASS.start(), limits::MASS.end());
    at.within(limits::MASS, "")
        .map_err(|_| at.error(format!("a mass from {low:e} to {high:e} kg, or 0 for an infinite one")))
}

fn moments(at: &At) -> Result<DVec3, SceneError> {
    let [x, y, z] = at.several()?;
    let moment = |at: At| at.not_negative(" kg·m² (0 stands for infinite)");
    Ok(DVec3::new(moment(x)?, moment(y)?, moment(z)?))
}

/// Where in `motion` stands what the engine calls `field`, if it is stated there.
pub(super) fn key_of(field: &str) -> Option<String> {
    let names = [
        ("mass", "mass"),
        ("center_of_mass", "centerOfMass"),
        ("inertia_orientation", "inertiaOrientation"),
        ("inertia_diagonal", "inertiaDiagonal"),
        ("linear_velocity", "linearVelocity"),
        ("angular_velocity", "angularVelocity"),
        ("gravity_factor", "gravityFactor"),
    ];
    names.into_iter().find_map(|(name, key)| {
        let rest = field.strip_prefix(name)?;
        (rest.is_empty() || rest.starts_with('[')).then(|| format!("{key}{rest}"))
    })
}
