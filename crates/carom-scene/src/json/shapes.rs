//! Shapes.

use super::cursor::{Cursor, Object};
use super::files::Files;
use super::nearest::known;
use super::tree::number;
use crate::SceneError;
use carom::math::DVec3;
use carom::{Invalid, Shape, limits};

/// The shapes that the format knows, in the order in which its description names them.
const TYPES: [&str; 9] =
    ["sphere", "box", "capsule", "cylinder", "cone", "plane", "hull", "mesh", "heightfield"];

/// Reads a shape; one that is in a file of its own comes from `files`.
pub(super) fn read(shape: &Cursor<'_>, files: &mut Files) -> Result<Shape, SceneError> {
    let object = shape.object()?;
    let tag = object.require("type", &format!("the type of the shape, one of {}", TYPES.join(", ")))?;
    match tag.text("the type of the shape")? {
        "sphere" => {
            object.only(&["type", "radius"])?;
            Ok(Shape::Sphere { radius: length(&object, "radius")? })
        }
        "box" => {
            object.only(&["type", "size"])?;
            let size = object.require("size", "the full edge lengths [x, y, z], m")?;
            Ok(Shape::Cuboid { size: size.vector("lengths [x, y, z]", |edge| edge.length())? })
        }
        "capsule" => {
            let Round { height, bottom, top } = Round::read(&object)?;
            Ok(if bottom == top {
                Shape::Capsule { height, radius: bottom }
            } else {
                Shape::TaperedCapsule { height, radius_bottom: bottom, radius_top: top }
            })
        }
        "cylinder" => {
            let Round { height, bottom, top } = Round::read(&object)?;
            Ok(Shape::Cylinder { height, radius_bottom: bottom, radius_top: top })
        }
        "cone" => {
            object.only(&["type", "height", "radius"])?;
            Ok(Shape::cone(length(&object, "height")?, length(&object, "radius")?))
        }
        "plane" => object.only(&["type"]).map(|()| Shape::Plane),
        "hull" => hull(&object, files),
        "mesh" => mesh(&object, files),
        "heightfield" => height_field(&object),
        wrong => Err(tag.refuse(format!("one of {}", known(wrong, TYPES)))),
    }
}

/// Capsule or cylinder, tapered or not.
struct Round {
    height: f64,
    bottom: f64,
    top: f64,
}

impl Round {
    /// `radius` stands for both ends; where the ends have their own, one of them may be a point.
    fn read(object: &Object<'_>) -> Result<Self, SceneError> {
        object.only(&["type", "height", "radius", "radius_bottom", "radius_top"])?;
        let height = length(object, "height")?;
        let (bottom, top) = (object.get("radius_bottom"), object.get("radius_top"));
        if let Some(radius) = object.get("radius") {
            if bottom.is_some() || top.is_some() {
                return Err(radius.refuse("either radius, or radius_bottom and radius_top"));
            }
            let radius = radius.length()?;
            return Ok(Self { height, bottom: radius, top: radius });
        }
        let (bottom, top) = match (bottom, top) {
            (Some(bottom), Some(top)) => (bottom, top),
            (None, None) => {
                return Err(object
                    .at
                    .refuse_lack("radius", "a length in m, or radius_bottom and radius_top"));
            }
            (lack, _) => {
                let key = if lack.is_none() { "radius_bottom" } else { "radius_top" };
                return Err(object.at.refuse_lack(key, "a length in m, since the other end has its own"));
            }
        };
        let (at_bottom, at_top) = (end_radius(&bottom)?, end_radius(&top)?);
        if at_bottom == 0.0 && at_top == 0.0 {
            return Err(top.refuse("a radius above 0 on at least one end"));
        }
        Ok(Self { height, bottom: at_bottom, top: at_top })
    }
}

fn length(object: &Object<'_>, key: &str) -> Result<f64, SceneError> {
    object.require(key, "a length in m")?.length()
}

fn end_radius(radius: &Cursor<'_>) -> Result<f64, SceneError> {
    if radius.finite("m").is_ok_and(|value| value == 0.0) {
        return Ok(0.0);
    }
    radius.length().map_err(|_| {
        let (low, high) = (number(*limits::LENGTH.start()), number(*limits::LENGTH.end()));
        radius.refuse(format!("a number from {low} to {high} m, or 0 on one end"))
    })
}

fn hull(object: &Object<'_>, files: &mut Files) -> Result<Shape, SceneError> {
    object.only(&["type", "points", "file"])?;
    if let Some(file) = object.get("file") {
        refuse_beside_file(object, &["points"])?;
        return files.hull(&file);
    }
    let points = object.require("points", "a list of points [x, y, z], m, or a file")?;
    let corners = vertices(&points)?;
    if corners.len() < 4 {
        return Err(
            points.refuse(format!("at least 4 points, not {}, since the hull needs a volume", corners.len()))
        );
    }
    Shape::hull(&corners).map_err(|invalid| within(object, "points", invalid))
}

fn mesh(object: &Object<'_>, files: &mut Files) -> Result<Shape, SceneError> {
    object.only(&["type", "vertices", "triangles", "file"])?;
    if let Some(file) = object.get("file") {
        refuse_beside_file(object, &["vertices", "triangles"])?;
        return files.mesh(&file);
    }
    let corners = object.require("vertices", "a list of points [x, y, z], m, or a file")?;
    let corners = vertices(&corners)?;
    let list = object.require("triangles", "a list of triangles, each three indices of vertices")?;
    let n_vertices = u32::try_from(corners.len()).unwrap_or(u32::MAX);
    let mut triangles = Vec::new();
    for triangle in list.list("triangles")? {
        let index = |item: &Cursor<'_>| match n_vertices.checked_sub(1) {
            Some(last) => item.integer(0..=last).map(f64::from),
            None => Err(item.refuse("an index of a vertex, but there are no vertices")),
        };
        let [a, b, c] = triangle.vector("indices of vertices", index)?.to_array();
        triangles.push([a as u32, b as u32, c as u32]);
    }
    if triangles.is_empty() {
        return Err(list.refuse("at least one triangle"));
    }
    Shape::mesh(corners, triangles).map_err(|invalid| within(object, "triangles", invalid))
}

fn refuse_beside_file(object: &Object<'_>, keys: &[&str]) -> Result<(), SceneError> {
    match keys.iter().find_map(|key| object.get(key)) {
        Some(other) => Err(other.refuse("no such key beside file, which has the points")),
        None => Ok(()),
    }
}

fn height_field(object: &Object<'_>) -> Result<Shape, SceneError> {
    object.only(&["type", "heights", "size"])?;
    let reach = *limits::LENGTH.end();
    let rows = object.require("heights", "rows of heights along z, each a list along x, m")?;
    let mut heights: Vec<Vec<f64>> = Vec::new();
    for row in rows.list("rows of heights")? {
        let height = |item: Cursor<'_>| item.within(-reach..=reach, "m");
        heights.push(row.list("heights along x")?.map(height).collect::<Result<_, _>>()?);
    }
    let size = object.require("size", "the full extent [x, z], m")?;
    let size = size.numbers::<2>("lengths [x, z]", |extent| extent.length())?;
    Shape::height_field(&heights, size).map_err(|invalid| within(object, "heights", invalid))
}

fn vertices(list: &Cursor<'_>) -> Result<Vec<DVec3>, SceneError> {
    let reach = *limits::LENGTH.end();
    list.list("points [x, y, z]")?.map(|point| point.vector_within(reach, "m")).collect()
}

/// The engine's complaint about a shape, at the place where it stands; `key` where it names none that the file has.
fn within(object: &Object<'_>, key: &str, invalid: Invalid) -> SceneError {
    let field = invalid.field;
    let known =
        ["points", "vertices", "triangles", "heights", "size"].iter().any(|known| field.starts_with(known));
    let field = if known { field } else { key.to_owned() };
    SceneError::invalid(
        object.at.file,
        format!("{}.{field}", object.at.path),
        invalid.value,
        invalid.expected,
    )
}
