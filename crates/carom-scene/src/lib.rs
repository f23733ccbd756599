//! Scene files for [Carom](carom): what a world starts from, as files that people and tools write.
//!
//! A [`Scene`] is what a file holds after every check: settings, and bodies with unique names, ready for a world.
//! Three ways lead to one:
//!
//! - the JSON format `carom` 1 ([`Scene::from_json`]; [`schema`] describes it to editors),
//! - glTF with the `KHR_physics_rigid_bodies` and `KHR_implicit_shapes` extensions,
//! - a name from the list of built-in scenes ([`builtin_scenes`], [`Scene::builtin`]).
//!
//! [`Scene::load`] picks the format by the file's name, or by its content where the name says nothing. Whatever is
//! wrong with a file comes back as a [`SceneError`] that names the file, the place in it, the value found and what
//! was expected. Nothing is guessed and nothing is dropped without a note.

mod builtin;
mod error;
mod gltf;
mod json;
mod obj;
mod scene;
mod schema;

pub use builtin::{BuiltinScene, DEFAULT_SCENE, builtin_scenes};
pub use error::SceneError;
pub use scene::Scene;
pub use schema::schema;
