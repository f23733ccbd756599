//! The format `carom` 1 as a JSON Schema, for editors and for whoever writes scenes by program.
//!
//! The reader is what decides; this says the same in a form that tools know. What a schema can't say (names used
//! twice, hulls without a volume, inertias that no body can have) only the reader refuses.

mod joints;

use crate::json::{DEFAULT_DT, DT_RANGE, GRAVITY, MAX_BODIES, SUBSTEPS_RANGE, VERSION};
use carom::{Body, Collider, Material, Settings, Shape, limits};
use serde_json::{Map, Value, json};
use std::ops::RangeInclusive;

/// The JSON Schema (2020-12) of the scene file.
///
/// ```
/// let schema = carom_scene::schema();
/// assert_eq!(schema["required"], serde_json::json!(["carom", "bodies"]));
/// ```
pub fn schema() -> Value {
    let settings = Settings::default();
    let mut scene = object(
        "A scene for the Carom physics engine. SI units, radians, right-handed, y up.",
        &["carom", "bodies"],
        [
            ("carom", described("Version of the format.", json!({ "const": VERSION }))),
            ("name", text("What reports call the scene; otherwise its file's name.")),
            (
                "gravity",
                with_default(
                    vector("Acceleration of gravity, m/s².", &within(-GRAVITY..=GRAVITY)),
                    json!(settings.gravity.to_array()),
                ),
            ),
            ("dt", with_default(number("Length of a step, s.", &within(DT_RANGE)), json!(DEFAULT_DT))),
            (
                "substeps",
                described(
                    "Into how many parts a step divides for what rests.",
                    json!({
                        "type": "integer", "default": settings.substeps,
                        "minimum": SUBSTEPS_RANGE.start(), "maximum": SUBSTEPS_RANGE.end(),
                    }),
                ),
            ),
            ("sleeping", flag("Whether bodies at rest may fall asleep.")),
            (
                "materials",
                described(
                    "Materials by name, for colliders to refer to.",
                    json!({ "type": "object", "additionalProperties": reference("material") }),
                ),
            ),
            ("bodies", {
                let mut bodies =
                    list("The bodies; collisions are reported in their order.", reference("body"));
                bodies["maxItems"] = json!(MAX_BODIES);
                bodies
            }),
            ("joints", list("Joints between bodies. Not built yet: must be empty.", reference("joint"))),
        ],
    );
    scene["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    scene["title"] = json!("Carom scene, format 1");
    let mut definitions = Map::new();
    definitions.insert("material".into(), object("What a surface is made of.", &[], surface_keys()));
    definitions.insert("body".into(), body());
    definitions.insert("collider".into(), collider());
    definitions.insert("shape".into(), shape());
    definitions.insert("rotation".into(), rotation());
    definitions.insert("points".into(), list("Points [x, y, z], m.", point()));
    definitions.extend(joints::definitions());
    scene["$defs"] = Value::Object(definitions);
    scene
}

fn body() -> Value {
    let default = Body::dynamic();
    let speed = within(-limits::SPEED..=limits::SPEED);
    let mass = json!({ "anyOf": [{ "const": 0 }, within(limits::MASS)] });
    object(
        "A rigid body. A dynamic one needs colliders with a mass, or `mass`; others take neither mass nor inertia.",
        &[],
        [
            ("name", {
                let mut name = text("Unique in the scene; otherwise body<index>.");
                name["minLength"] = json!(1);
                name
            }),
            (
                "motion",
                described(
                    "dynamic: under forces. static: not at all. kinematic: with its velocities, feeling nothing.",
                    json!({ "enum": ["dynamic", "static", "kinematic"], "default": "dynamic" }),
                ),
            ),
            ("position", place("The body's origin in the world, m; need not be its centre of mass.")),
            ("rotation", described("Body frame to world frame.", reference("rotation"))),
            ("linear_velocity", zero(vector("Velocity of the centre of mass in the world, m/s.", &speed))),
            ("angular_velocity", zero(vector("Angular velocity in the world, rad/s.", &speed))),
            (
                "linear_damping",
                amount("Share of the velocity lost, 1/s: v falls as e^(-c t).", default.linear_damping),
            ),
            ("angular_damping", amount("Share of the angular momentum lost, 1/s.", default.angular_damping)),
            (
                "gravity_factor",
                with_default(
                    number("Gravity acts times this; may be negative.", &json!({})),
                    json!(default.gravity_factor),
                ),
            ),
            (
                "mass",
                number(
                    "Mass, kg, in place of the colliders', whose densities then only share it out. 0: infinite.",
                    &mass,
                ),
            ),
            (
                "center_of_mass",
                vector(
                    "Centre of mass in the body frame, m, in place of the shapes'. Needs mass.",
                    &within(-limits::POSITION..=limits::POSITION),
                ),
            ),
            (
                "inertia_diagonal",
                vector(
                    "Principal moments about the centre of mass, kg·m², in place of the shapes'. 0: infinite. Needs mass.",
                    &json!({ "minimum": 0 }),
                ),
            ),
            (
                "inertia_orientation",
                described("Principal axes to body frame. Needs inertia_diagonal.", reference("rotation")),
            ),
            (
                "colliders",
                list("The body's shapes. None: an anchor, or a mass alone.", reference("collider")),
            ),
        ],
    )
}

fn collider() -> Value {
    let default = Collider::new(Shape::plane());
    let names = |description| list(description, json!({ "type": "string" }));
    let own = [
        ("shape", reference("shape")),
        ("position", place("Origin of the shape in the body frame, m.")),
        ("rotation", described("Shape to body frame.", reference("rotation"))),
        ("density", amount("Density, kg/m³.", default.density)),
        ("material", text("Name of one of the scene's materials; the collider's own values go before it.")),
        ("sensor", flag("Reports what overlaps it, pushes nothing and weighs nothing.")),
        ("groups", names("Groups that this collider is in.")),
        ("collides_with", names("Groups that it touches; absent: everything, empty: nothing.")),
    ];
    object("A shape on a body.", &["shape"], own.into_iter().chain(surface_keys()))
}

fn surface_keys() -> [(&'static str, Value); 6] {
    let default = Material::default();
    let rule = |description| {
        described(description, json!({ "enum": ["average", "minimum", "maximum", "multiply"] }))
    };
    [
        ("friction", amount("Both friction coefficients.", default.static_friction)),
        (
            "static_friction",
            number("Coefficient while surfaces stick; before friction.", &json!({ "minimum": 0 })),
        ),
        (
            "dynamic_friction",
            number("Coefficient while they slide; before friction.", &json!({ "minimum": 0 })),
        ),
        (
            "restitution",
            with_default(
                number("Parting speed over closing speed of a collision, C_r.", &within(0.0..=1.0)),
                json!(default.restitution),
            ),
        ),
        (
            "friction_combine",
            rule("How friction combines with the other collider's; absent: the other decides, else average."),
        ),
        (
            "restitution_combine",
            rule("How restitution combines with the other's; absent: the other decides, else maximum."),
        ),
    ]
}

fn shape() -> Value {
    let length = |description| number(description, &within(limits::LENGTH));
    let end =
        |description| number(description, &json!({ "anyOf": [{ "const": 0 }, within(limits::LENGTH)] }));
    let kind = |tag, description, keys: &[(&'static str, Value)]| {
        let required: Vec<&str> = keys.iter().map(|(key, _)| *key).collect();
        tagged(tag, description, &required, keys.iter().cloned())
    };
    let file = || text("OBJ file, relative to the scene: all its groups, polygons cut into fans.");
    let straight = [("height", length("Of the cylindrical part, m.")), ("radius", length("Radius, m."))];
    let tapered = [
        ("height", length("Distance of the two ends' centres, m.")),
        ("radius_bottom", end("Radius at the low end, m; one end may have 0.")),
        ("radius_top", end("Radius at the high end, m; one end may have 0.")),
    ];
    let corners = described("Corners, m.", reference("points"));
    let triangle = described(
        "Indices of three vertices.",
        json!({ "type": "array", "items": { "type": "integer", "minimum": 0 }, "minItems": 3, "maxItems": 3 }),
    );
    let reach = *limits::LENGTH.end();
    let mut heights =
        list("Heights along x, as many as in the first row, m.", number("m", &within(-reach..=reach)));
    heights["minItems"] = json!(2);
    let mut rows = list("Rows along z, each a list along x, m.", heights);
    rows["minItems"] = json!(2);
    let size = json!({ "type": "array", "items": within(limits::LENGTH), "minItems": 2, "maxItems": 2 });
    let kinds = [
        kind("sphere", "A ball.", &[("radius", length("Radius, m."))]),
        kind("box", "A box.", &[("size", vector("Full edge lengths, m.", &within(limits::LENGTH)))]),
        kind("capsule", "All within a radius of a segment along y.", &straight),
        kind("capsule", "The hull of two balls on the y axis.", &tapered),
        kind("cylinder", "A cylinder along y.", &straight),
        kind("cylinder", "The hull of two discs across the y axis.", &tapered),
        kind("cone", "A cone along y, apex at the top.", &straight),
        kind("plane", "The half space y <= 0 of the collider's frame; on static bodies only.", &[]),
        kind("hull", "The convex hull of points.", &[("points", corners.clone())]),
        kind("hull", "The convex hull of a file's points.", &[("file", file())]),
        kind(
            "mesh",
            "A surface, solid from both sides; on a dynamic body it needs the body's mass, and weighs like a thin sheet if open.",
            &[("vertices", corners), ("triangles", list("The triangles.", triangle))],
        ),
        kind("mesh", "A surface from a file.", &[("file", file())]),
        kind(
            "heightfield",
            "Heights over a grid, centred, each cell cut from its low to its high corner; on static bodies only.",
            &[("heights", rows), ("size", described("Full extent [x, z], m.", size))],
        ),
    ];
    described("The form of a collider.", json!({ "oneOf": kinds }))
}

/// An object with no keys but `properties`.
fn object(
    description: &str,
    required: &[&str],
    properties: impl IntoIterator<Item = (&'static str, Value)>,
) -> Value {
    let properties: Map<String, Value> =
        properties.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    described(
        description,
        json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false }),
    )
}

/// An object that says in `type` which of several it is.
fn tagged(
    tag: &str,
    description: &str,
    required: &[&str],
    properties: impl IntoIterator<Item = (&'static str, Value)>,
) -> Value {
    let required: Vec<&str> = ["type"].iter().chain(required).copied().collect();
    object(description, &required, [("type", json!({ "const": tag }))].into_iter().chain(properties))
}

fn reference(definition: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{definition}") })
}

fn described(description: &str, mut schema: Value) -> Value {
    schema["description"] = json!(description);
    schema
}

fn with_default(mut schema: Value, default: Value) -> Value {
    schema["default"] = default;
    schema
}

fn zero(vector: Value) -> Value {
    with_default(vector, json!([0, 0, 0]))
}

fn text(description: &str) -> Value {
    described(description, json!({ "type": "string" }))
}

/// A boolean that is false unless said.
fn flag(description: &str) -> Value {
    described(description, json!({ "type": "boolean", "default": false }))
}

fn within(range: RangeInclusive<f64>) -> Value {
    json!({ "minimum": range.start(), "maximum": range.end() })
}

/// A number with `bounds`.
fn number(description: &str, bounds: &Value) -> Value {
    let mut number = bounds.clone();
    number["type"] = json!("number");
    described(description, number)
}

/// A number from 0 on.
fn amount(description: &str, default: f64) -> Value {
    with_default(number(description, &json!({ "minimum": 0 })), json!(default))
}

fn list(description: &str, items: Value) -> Value {
    described(description, json!({ "type": "array", "items": items }))
}

/// Three numbers, each with `bounds`.
fn vector(description: &str, bounds: &Value) -> Value {
    let mut vector = list(description, number("x, y, z", bounds));
    vector["minItems"] = json!(3);
    vector["maxItems"] = json!(3);
    vector
}

fn place(description: &str) -> Value {
    zero(vector(description, &within(-limits::POSITION..=limits::POSITION)))
}

fn point() -> Value {
    let reach = *limits::LENGTH.end();
    vector("A point, m.", &within(-reach..=reach))
}

fn rotation() -> Value {
    described(
        "Unit quaternion [x, y, z, w], its length within 1e-3 of 1.",
        json!({
            "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4, "default": [0, 0, 0, 1],
        }),
    )
}
