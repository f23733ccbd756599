//! The shapes of `KHR_implicit_shapes`, and what a node's scale makes of them.
//!
//! Shapes take the scale of the node they stand on, as absolute values. A box follows any scale. Round shapes
//! stay round: a sphere takes the largest of the three, capsules and cylinders take |y| for their height and the
//! larger of |x| and |z| for their radii. Where that is not exact, a note says so.

use super::json::{At, Document};
use crate::SceneError;
use carom::Shape;
use carom::math::DVec3;

/// Relative difference up to which the components of a scale count as equal: single precision, multiplied a few
/// times.
const EVEN: f64 = 1e-4;

/// The extent that stands for an infinite one of a plane that is bounded the other way, m: the longest there is.
const ENDLESS: f64 = 1e6;

/// An entry of the file's `shapes`, before any scale.
pub(super) struct Implicit<'a> {
    /// The shape's parameters, or the shape itself where they are absent.
    at: At<'a>,
    form: Form,
}

#[derive(Clone, Copy)]
enum Form {
    Sphere { radius: f64 },
    Box { size: DVec3 },
    Capsule { height: f64, bottom: f64, top: f64 },
    Cylinder { height: f64, bottom: f64, top: f64 },
    Plane { x: Option<f64>, z: Option<f64>, double_sided: bool },
}

const KINDS: [(&str, &[&str]); 5] = [
    ("sphere", &["radius"]),
    ("box", &["size"]),
    ("capsule", &["height", "radiusBottom", "radiusTop"]),
    ("cylinder", &["height", "radiusBottom", "radiusTop"]),
    ("plane", &["sizeX", "sizeZ", "doubleSided"]),
];

/// Reads all shapes of the file.
pub(super) fn read<'a>(
    document: &Document<'a>,
    notes: &mut Vec<String>,
) -> Result<Vec<Implicit<'a>>, SceneError> {
    let Some(extension) = document.root.dig(&["extensions", "KHR_implicit_shapes"])? else {
        return Ok(Vec::new());
    };
    extension.only(&["shapes"])?;
    let list = extension.need("shapes", "a list of shapes")?;
    list.items()?.into_iter().map(|shape| Implicit::read(shape, notes)).collect()
}

impl<'a> Implicit<'a> {
    fn read(shape: At<'a>, notes: &mut Vec<String>) -> Result<Self, SceneError> {
        let names = KINDS.map(|(name, _)| name);
        shape.only(&["name", "type", "plane", "sphere", "box", "capsule", "cylinder"])?;
        let kind = shape.need("type", "the shape's type")?;
        let Some((name, keys)) = KINDS.into_iter().find(|(name, _)| kind.value.as_str() == Some(name)) else {
            return Err(kind.error(format!("one of the types {}", names.join(", "))));
        };
        for other in names {
            if other != name && shape.has(other) {
                notes.push(format!("{}.{other} has no effect, since the type is {name}", shape.path));
            }
        }
        let Some(at) = shape.get(name)? else {
            let default = |key: &str| match key {
                "height" | "radius" => 0.5,
                _ => 0.25,
            };
            let form = Form::of(name, default, DVec3::ONE, (None, None, false));
            return Ok(Self { at: shape, form });
        };
        at.only(keys)?;
        Ok(Self { form: Form::read(name, &at)?, at })
    }
}

impl Form {
    fn of(
        name: &str,
        length: impl Fn(&str) -> f64,
        size: DVec3,
        (x, z, double_sided): (Option<f64>, Option<f64>, bool),
    ) -> Form {
        let round = || (length("height"), length("radiusBottom"), length("radiusTop"));
        match name {
            "sphere" => Form::Sphere { radius: length("radius") },
            "box" => Form::Box { size },
            "capsule" => {
                let (height, bottom, top) = round();
                Form::Capsule { height, bottom, top }
            }
            "cylinder" => {
                let (height, bottom, top) = round();
                Form::Cylinder { height, bottom, top }
            }
            _ => Form::Plane { x, z, double_sided },
        }
    }

    fn read(name: &str, at: &At) -> Result<Form, SceneError> {
        let positive = |key: &str, default: f64| match at.get(key)? {
            Some(length) => length.positive(" m"),
            None => Ok(default),
        };
        let radius = |key: &str| match at.get(key)? {
            Some(length) => length.not_negative(" m"),
            None => Ok(0.25),
        };
        let round = || -> Result<(f64, f64, f64), SceneError> {
            let all = (positive("height", 0.5)?, radius("radiusBottom")?, radius("radiusTop")?);
            if all.1 == 0.0 && all.2 == 0.0 {
                return Err(at.error("at least one radius above 0 m"));
            }
            Ok(all)
        };
        Ok(match name {
            "sphere" => Form::Sphere { radius: positive("radius", 0.5)? },
            "box" => match at.get("size")? {
                None => Form::Box { size: DVec3::ONE },
                Some(size) => {
                    let [x, y, z] = size.several()?;
                    Form::Box { size: DVec3::new(x.positive(" m")?, y.positive(" m")?, z.positive(" m")?) }
                }
            },
            "capsule" => {
                let (height, bottom, top) = round()?;
                Form::Capsule { height, bottom, top }
            }
            "cylinder" => {
                let (height, bottom, top) = round()?;
                Form::Cylinder { height, bottom, top }
            }
            _ => {
                let size = |key: &str| at.get(key)?.map(|size| size.positive(" m")).transpose();
                let double_sided = at.get("doubleSided")?.map_or(Ok(false), |at| at.boolean())?;
                Form::Plane { x: size("sizeX")?, z: size("sizeZ")?, double_sided }
            }
        })
    }
}

impl Implicit<'_> {
    /// The shape under `scale`, that of the node at `user`.
    pub fn scaled(&self, scale: DVec3, user: &At, notes: &mut Vec<String>) -> Result<Shape, SceneError> {
        let scale = scale.abs();
        let across = scale.x.max(scale.z);
        let round = even(scale.x, scale.z);
        let mut note = |text: &str| notes.push(format!("{}: {text}", user.path));
        let shape = match self.form {
            Form::Sphere { radius } => {
                if !(round && even(across, scale.y)) {
                    note("a sphere under an uneven scale stays a sphere and takes the largest component");
                }
                Shape::sphere(radius * scale.max_element())
            }
            Form::Box { size } => Shape::Cuboid { size: size * scale },
            Form::Capsule { height, bottom, top } => {
                if !(round && even(across, scale.y)) {
                    note(
                        "a capsule under an uneven scale keeps round ends: height by y, radii by the larger of x and z",
                    );
                }
                let (height, bottom, top) = (height * scale.y, bottom * across, top * across);
                if bottom == top {
                    Shape::capsule(height, bottom)
                } else {
                    Shape::TaperedCapsule { height, radius_bottom: bottom, radius_top: top }
                }
            }
            Form::Cylinder { height, bottom, top } => {
                if !round {
                    note("a cylinder under an uneven scale stays round and takes the larger of x and z");
                }
                Shape::Cylinder {
                    height: height * scale.y,
                    radius_bottom: bottom * across,
                    radius_top: top * across,
                }
            }
            Form::Plane { x: None, z: None, double_sided } => {
                if double_sided {
                    note("an infinite plane is solid below, also where the file says doubleSided");
                }
                Shape::Plane
            }
            Form::Plane { x, z, double_sided } => {
                if !double_sided {
                    note("a bounded plane is solid from both sides");
                }
                if x.is_none() || z.is_none() {
                    note("a plane that is bounded one way only reaches 1e6 m the other way");
                }
                let extent = |size: Option<f64>, scale: f64| size.map_or(ENDLESS, |size| size * scale);
                return self.sheet(extent(x, scale.x), extent(z, scale.z), user);
            }
        };
        shape.check().map_err(|error| self.refused(error, scale, user))?;
        Ok(shape)
    }

    /// A rectangle across y, of two triangles facing +y.
    fn sheet(&self, x: f64, z: f64, user: &At) -> Result<Shape, SceneError> {
        for (field, length) in [("sizeX", x), ("sizeZ", z)] {
            carom::limits::within(field, length, carom::limits::LENGTH, "m")
                .map_err(|error| self.refused(error, DVec3::ONE, user))?;
        }
        let (x, z) = (0.5 * x, 0.5 * z);
        let corners = [(-x, -z), (-x, z), (x, z), (x, -z)].map(|(x, z)| DVec3::new(x, 0.0, z));
        Shape::mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).map_err(|error| self.at.engine(error))
    }

    /// A length that is out of range once scaled: said of the file's own value.
    fn refused(&self, error: carom::Invalid, scale: DVec3, user: &At) -> SceneError {
        let field = match (error.field.as_str(), self.form) {
            ("radius", Form::Capsule { .. }) | ("radius_bottom", _) => "radiusBottom",
            ("radius_top", _) => "radiusTop",
            (field, _) => field,
        };
        let after = if scale == DVec3::ONE {
            String::new()
        } else {
            format!(" under the scale [{}, {}, {}] of {}", scale.x, scale.y, scale.z, user.path)
        };
        let path = format!("{}.{field}", self.at.path);
        SceneError::invalid(self.at.file, path, error.value, format!("{}{after}", error.expected))
    }
}

fn even(a: f64, b: f64) -> bool {
    (a - b).abs() <= EVEN * a.max(b)
}
