//! The scene that every format is read into.

use crate::SceneError;
use carom::{Body, BodyId, Settings, World};

/// A scene that was read: what to put into a world.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What reports call it.
    pub name: String,
    /// Gravity and substeps.
    pub settings: Settings,
    /// Length of a step, s.
    pub dt: f64,
    /// Whether bodies at rest may fall asleep.
    pub sleeping: bool,
    /// The bodies in the order of the file, each with a unique non-empty name.
    pub bodies: Vec<Body>,
    /// What was passed over or has no effect yet, a line each, for stderr.
    pub notes: Vec<String>,
}

impl Scene {
    /// A world with the scene's bodies, and their ids in the order of [`Scene::bodies`].
    ///
    /// # Errors
    /// Names the first body that no world can hold; there is none in a scene that was read from a file.
    pub fn world(&self) -> Result<(World, Vec<BodyId>), SceneError> {
        build(self.settings, self.bodies.iter().cloned())
    }

    /// [`Scene::world`] without copying the bodies.
    ///
    /// # Errors
    /// As [`Scene::world`].
    pub fn into_world(self) -> Result<(World, Vec<BodyId>), SceneError> {
        build(self.settings, self.bodies.into_iter())
    }
}

fn build(
    settings: Settings,
    bodies: impl Iterator<Item = Body>,
) -> Result<(World, Vec<BodyId>), SceneError> {
    let mut world = World::with_settings(settings);
    let mut ids = Vec::with_capacity(bodies.size_hint().0);
    for body in bodies {
        let name = body.name.clone();
        ids.push(world.try_add(body).map_err(|source| SceneError::Refused { body: name, source })?);
    }
    Ok((world, ids))
}
