//! Joints in the schema.

use super::{amount, described, flag, list, number, object, place, reference, tagged, text, vector};
use serde_json::{Value, json};

/// The definitions `joint`, `motor`, `frame`, `limit` and `drive`.
pub(super) fn definitions() -> impl Iterator<Item = (String, Value)> {
    [("joint", joint()), ("motor", motor()), ("frame", frame()), ("limit", limit()), ("drive", drive())]
        .into_iter()
        .map(|(name, schema)| (name.to_owned(), schema))
}

fn joint() -> Value {
    let kinds = [
        kind("ball", "Holds two points together.", &[], []),
        kind(
            "hinge",
            "Leaves one turn, positive as b turns right-handed about axis_a.",
            &["axis_a", "axis_b"],
            along_axis(),
        ),
        kind(
            "slider",
            "Leaves one shift: (anchor b - anchor a) along axis_a. No turning.",
            &["axis_a", "axis_b"],
            along_axis(),
        ),
        kind("fixed", "Holds two bodies together as they start.", &[], []),
        kind(
            "distance",
            "Keeps the anchors' distance within a range: a rope with min 0, a rod with min = max.",
            &["min", "max"],
            [
                ("min", positive("Least distance, m.")),
                ("max", positive("Largest distance, m.")),
                ("stiffness", positive("Spring back into the range, N/m; absent: rigid.")),
                ("damping", amount("Damping outside the range, N·s/m.", 0.0)),
            ],
        ),
        kind(
            "generic",
            "Limits and drives on any of six axes, as in glTF's KHR_physics_rigid_bodies.",
            &[],
            [
                ("frame_a", reference("frame")),
                ("frame_b", reference("frame")),
                ("limits", list("What the joint keeps within a range.", reference("limit"))),
                ("drives", list("What the joint pushes towards.", reference("drive"))),
            ],
        ),
    ];
    described("A joint between two bodies. Not built yet.", json!({ "oneOf": kinds }))
}

fn kind(
    tag: &str,
    description: &str,
    own_required: &[&str],
    own: impl IntoIterator<Item = (&'static str, Value)>,
) -> Value {
    let common = [
        ("name", text("What reports call the joint.")),
        ("a", text("Name of the first body; a static one stands for the world.")),
        ("b", text("Name of the second body.")),
        ("anchor_a", place("Where the joint holds a, in a's frame, m.")),
        ("anchor_b", place("Where the joint holds b, in b's frame, m.")),
        ("collide", flag("Whether the two bodies still collide.")),
        ("break_force", positive("The joint breaks above this force, N; absent: never.")),
        ("break_torque", positive("The joint breaks above this torque, N·m; absent: never.")),
    ];
    let required: Vec<&str> = ["a", "b"].iter().chain(own_required).copied().collect();
    tagged(tag, description, &required, common.into_iter().chain(own))
}

/// The keys of hinge and slider.
fn along_axis() -> [(&'static str, Value); 6] {
    let range = json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    [
        ("axis_a", vector("Axis in a's frame.", &json!({}))),
        ("axis_b", vector("The same axis in b's frame.", &json!({}))),
        ("limits", described("Range [lo, hi] of the angle (rad) or position (m); absent: free.", range)),
        ("limit_stiffness", positive("Spring back into the range, N/m or N·m/rad; absent: rigid.")),
        ("limit_damping", amount("Damping outside the range, N·s/m or N·m·s/rad.", 0.0)),
        ("motor", reference("motor")),
    ]
}

fn motor() -> Value {
    object(
        "Pushes along or about the joint's axis.",
        &[],
        [
            ("target_position", any("Position (m) or angle (rad) that stiffness pulls to.")),
            ("target_velocity", any("Speed, m/s or rad/s, that damping pulls to.")),
            ("stiffness", amount("N/m or N·m/rad.", 0.0)),
            ("damping", amount("N·s/m or N·m·s/rad.", 0.0)),
            ("max_force", positive("Largest force, N, or torque on a hinge, N·m; absent: no bound.")),
        ],
    )
}

fn frame() -> Value {
    object(
        "The joint's frame on a body.",
        &[],
        [
            ("position", place("Origin in the body frame, m.")),
            ("rotation", described("Joint frame to body frame.", reference("rotation"))),
        ],
    )
}

fn limit() -> Value {
    let mut limit = object(
        "Keeps a distance or an angle within a range.",
        &[],
        [
            ("min", any("Least distance (m) or angle (rad); absent: no bound.")),
            ("max", any("Largest distance (m) or angle (rad); absent: no bound.")),
            ("stiffness", positive("Spring back into the range; absent: rigid.")),
            ("damping", amount("Damping outside the range.", 0.0)),
            (
                "linear_axes",
                axes(
                    "1 axis: the shift along it. 2: the distance from the line along the third. 3: the distance.",
                ),
            ),
            (
                "angular_axes",
                axes("1 axis: the twist about it. 2: the tilt of the third. 3: the whole angle."),
            ),
        ],
    );
    limit["oneOf"] = json!([{ "required": ["linear_axes"] }, { "required": ["angular_axes"] }]);
    limit
}

fn drive() -> Value {
    object(
        "A motor or spring on one axis.",
        &["type", "mode", "axis"],
        [
            ("type", described("Along or about the axis.", json!({ "enum": ["linear", "angular"] }))),
            (
                "mode",
                described(
                    "What the spring's formula gives: a force (or torque), or an acceleration.",
                    json!({ "enum": ["force", "acceleration"] }),
                ),
            ),
            (
                "axis",
                described(
                    "0: x, 1: y, 2: z of frame a.",
                    json!({ "type": "integer", "minimum": 0, "maximum": 2 }),
                ),
            ),
            ("max_force", positive("Largest force, N, or torque, N·m; absent: no bound.")),
            ("position_target", any("Position (m) or angle (rad) that stiffness pulls to.")),
            ("velocity_target", any("Speed, m/s or rad/s, that damping pulls to.")),
            ("stiffness", amount("Force or acceleration for each m or rad off the target.", 0.0)),
            ("damping", amount("Force or acceleration for each m/s or rad/s off the target.", 0.0)),
        ],
    )
}

fn axes(description: &str) -> Value {
    let axis = json!({ "type": "integer", "minimum": 0, "maximum": 2 });
    let mut axes = list(description, axis);
    axes["minItems"] = json!(1);
    axes["maxItems"] = json!(3);
    axes["uniqueItems"] = json!(true);
    axes
}

fn any(description: &str) -> Value {
    number(description, &json!({}))
}

fn positive(description: &str) -> Value {
    number(description, &json!({ "minimum": 0 }))
}
