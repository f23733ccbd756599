//! Shapes that a scene leaves to files of their own.

use super::cursor::Cursor;
use crate::SceneError;
use crate::obj::Obj;
use crate::scene::read_file;
use carom::{Invalid, Shape};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The OBJ files of a scene. Each is read once, and its shape is shared by all colliders that name it.
pub(super) struct Files {
    folder: PathBuf,
    /// By the name in the scene, and whether it is a hull.
    shapes: HashMap<(String, bool), Shape>,
}

impl Files {
    /// Files that are relative to `folder`.
    pub(super) fn new(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), shapes: HashMap::new() }
    }

    /// The convex hull of all vertices of the file that is named here.
    pub(super) fn hull(&mut self, name: &Cursor<'_>) -> Result<Shape, SceneError> {
        self.shape(name, true, |place, obj| match obj.vertices.len() {
            n_vertices @ ..4 => {
                let expected = "at least 4 vertices (lines `v x y z`), since the hull needs a volume";
                Err(place.refuse(format!("{n_vertices} vertices"), expected))
            }
            _ => Shape::hull(&obj.vertices).map_err(|invalid| place.engine(invalid)),
        })
    }

    /// The surface of all faces of the file that is named here.
    pub(super) fn mesh(&mut self, name: &Cursor<'_>) -> Result<Shape, SceneError> {
        self.shape(name, false, |place, Obj { vertices, triangles }| {
            if triangles.is_empty() {
                return Err(place.refuse("no face", "at least one face (a line `f 1 2 3`)"));
            }
            Shape::mesh(vertices, triangles).map_err(|invalid| place.engine(invalid))
        })
    }

    fn shape(
        &mut self,
        name: &Cursor<'_>,
        convex: bool,
        build: impl FnOnce(&Place<'_>, Obj) -> Result<Shape, SceneError>,
    ) -> Result<Shape, SceneError> {
        const EXPECTED: &str = "the name of an OBJ file, relative to the scene's folder";
        let text = name.text(EXPECTED)?;
        if text.is_empty() {
            return Err(name.refuse(EXPECTED));
        }
        let key = (text.to_owned(), convex);
        if let Some(shape) = self.shapes.get(&key) {
            return Ok(shape.clone());
        }
        let path = self.folder.join(text);
        let place = Place { name, file: path.display().to_string() };
        let bytes = read_file(&path, &place.file).map_err(|error| match error {
            SceneError::Unreadable { source, .. } => {
                name.refuse(format!("an OBJ file that can be read; {}: {source}", place.file))
            }
            SceneError::Invalid { value, expected, .. } => place.refuse(value, expected),
            other => other,
        })?;
        let obj = Obj::parse(&bytes).map_err(|trouble| {
            let file = format!("{}, line {}", place.file, trouble.line);
            Place { name, file }.refuse(trouble.value, trouble.expected)
        })?;
        let shape = build(&place, obj)?;
        self.shapes.insert(key, shape.clone());
        Ok(shape)
    }
}

/// A place in a file that the scene names.
struct Place<'a> {
    /// Where the scene names it.
    name: &'a Cursor<'a>,
    file: String,
}

impl Place<'_> {
    fn refuse(&self, value: impl ToString, expected: impl Into<String>) -> SceneError {
        let path = format!("{} ({})", self.name.path, self.file);
        SceneError::invalid(self.name.file, path, value, expected)
    }

    fn engine(&self, invalid: Invalid) -> SceneError {
        self.refuse(invalid.value, invalid.expected)
    }
}
