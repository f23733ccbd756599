//! Motion, materials, filters, triggers.

use crate::{body, collider, has_note, load, near, node, scene};
use carom::math::DVec3;
use carom::{Combine, Material, Motion};
use serde_json::json;

const QUARTER: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn velocities_turn_with_the_node_and_take_no_scale() {
    let scene = load(&scene(json!([
        { "rotation": [0, 0, QUARTER, QUARTER], "scale": [3, 3, 3], "children": [1] },
        node(json!({ "name": "ball" }), json!({
            "motion": { "linearVelocity": [1, 0, 0], "angularVelocity": [0, 2, 0], "gravityFactor": -0.5 },
            "collider": collider(1)
        })),
    ])));
    let ball = body(&scene, "ball");
    near(ball.linear_velocity.as_dvec3(), [0.0, 1.0, 0.0]);
    near(ball.angular_velocity.as_dvec3(), [-2.0, 0.0, 0.0]);
    assert_eq!((ball.gravity_factor, ball.mass), (-0.5, None));
}

#[test]
fn mass_centre_and_inertia() {
    let scene = load(&scene(json!([
        node(
            json!({ "name": "given", "scale": [2, -3, 4] }),
            json!({
                "motion": { "mass": 5, "centerOfMass": [1, 1, 1], "inertiaDiagonal": [1, 0, 2],
                            "inertiaOrientation": [0, QUARTER, 0, QUARTER] },
                "collider": collider(0)
            })
        ),
        node(
            json!({ "name": "endless" }),
            json!({
                "motion": { "mass": 0, "inertiaDiagonal": [0, 1, 0] }, "collider": collider(0)
            })
        ),
        node(
            json!({ "name": "completed" }),
            json!({
                "motion": { "centerOfMass": [0, 0.25, 0] }, "collider": collider(0)
            })
        ),
    ])));
    let given = body(&scene, "given");
    near(given.center_of_mass.unwrap(), [2.0, -3.0, 4.0]);
    let inertia = given.inertia.unwrap();
    assert_eq!((given.mass, inertia.diagonal), (Some(5.0), DVec3::new(1.0, 0.0, 2.0)));
    near(inertia.orientation * DVec3::Z, [1.0, 0.0, 0.0]);
    assert_eq!(body(&scene, "endless").mass, Some(0.0));
    let mass = body(&scene, "completed").mass.unwrap();
    assert!(
        (mass - 1000.0).abs() < 1e-9,
        "the mass of the colliders where a centre goes without one: {mass}"
    );
}

#[test]
fn materials_default_key_by_key() {
    let with = json!({ "geometry": { "shape": 0 }, "physicsMaterial": 0 });
    let scene = load(&scene(json!([
        node(json!({ "name": "with" }), json!({ "collider": with })),
        node(json!({ "name": "without" }), json!({ "collider": collider(0) })),
    ])));
    assert_eq!(body(&scene, "without").colliders[0].material, Material::default());
    let expected = Material {
        static_friction: 0.9,
        dynamic_friction: 0.6,
        restitution: 0.5,
        friction_combine: Some(Combine::Minimum),
        restitution_combine: Some(Combine::Maximum),
    };
    assert_eq!(body(&scene, "with").colliders[0].material, expected);
}

#[test]
fn filters_share_a_name() {
    let part = |name: &str, filter: usize| {
        let collider = json!({ "geometry": { "shape": 0 }, "collisionFilter": filter });
        node(json!({ "name": name }), json!({ "collider": collider }))
    };
    let scene = load(&scene(json!([
        part("ab", 0),
        part("b", 1),
        part("a", 2),
        node(json!({ "name": "open" }), json!({ "collider": collider(0) })),
    ])));
    let allows =
        |a: &str, b: &str| body(&scene, a).colliders[0].filter.allows(&body(&scene, b).colliders[0].filter);
    assert!(allows("ab", "a") && allows("ab", "ab") && allows("a", "open") && allows("b", "open"));
    assert!(!allows("ab", "b"), "b is in no group that ab collides with");
    assert!(!allows("b", "a"), "b names a as one that it passes");
    assert!(!allows("ab", "open"), "open is in no group at all");
}

#[test]
fn triggers_are_sensors() {
    let trigger = json!({ "geometry": { "shape": 0 }, "collisionFilter": 0 });
    let scene = load(&scene(json!([
        node(json!({ "name": "car", "children": [1] }), json!({ "motion": {}, "collider": collider(1) })),
        node(json!({ "name": "feeler", "translation": [0, 0, 2] }), json!({ "trigger": trigger })),
        node(json!({ "name": "gate" }), json!({ "trigger": trigger, "collider": collider(1) })),
        node(
            json!({ "name": "zone", "translation": [9, 0, 0], "children": [4, 5] }),
            json!({ "trigger": { "nodes": [4, 5] } })
        ),
        node(json!({ "name": "left", "translation": [-1, 0, 0] }), json!({ "trigger": trigger })),
        node(json!({ "name": "right", "translation": [1, 0, 0] }), json!({ "trigger": trigger })),
    ])));
    assert_eq!(
        scene.bodies.iter().map(|body| body.name.as_str()).collect::<Vec<_>>(),
        ["car", "gate", "zone"]
    );
    let sensors = |name: &str| body(&scene, name).colliders.iter().map(|c| c.sensor).collect::<Vec<_>>();
    assert_eq!(sensors("car"), [false, true]);
    assert_eq!(sensors("gate"), [false, true]);
    assert_eq!(sensors("zone"), [true, true]);
    let zone = body(&scene, "zone");
    assert_eq!(zone.motion, Motion::Fixed);
    near(zone.colliders[1].pose.position, [1.0, 0.0, 0.0]);
    near(zone.position, [9.0, 0.0, 0.0]);
}

#[test]
fn shapes_have_the_defaults_of_the_draft() {
    let mut document = scene(json!([]));
    let kinds = ["sphere", "box", "capsule", "cylinder"];
    let shapes: Vec<_> = kinds.iter().map(|kind| json!({ "type": kind })).collect();
    document["extensions"]["KHR_implicit_shapes"]["shapes"] = json!(shapes);
    let nodes: Vec<_> =
        (0..4).map(|i| node(json!({ "name": kinds[i] }), json!({ "collider": collider(i) }))).collect();
    document["nodes"] = json!(nodes);
    let scene = load(&document);
    let text = |name: &str| format!("{:?}", body(&scene, name).colliders[0].shape);
    assert_eq!(text("sphere"), "Sphere { radius: 0.5 }");
    assert_eq!(text("box"), "Cuboid { size: DVec3(1.0, 1.0, 1.0) }");
    assert_eq!(text("capsule"), "Capsule { height: 0.5, radius: 0.25 }");
    assert_eq!(text("cylinder"), "Cylinder { height: 0.5, radius_bottom: 0.25, radius_top: 0.25 }");
}

#[test]
fn an_orientation_without_moments_is_noted() {
    let motion = json!({ "inertiaOrientation": [0, 1, 0, 0] });
    let scene = load(&scene(json!([node(json!({}), json!({ "motion": motion, "collider": collider(0) }))])));
    has_note(&scene, "inertiaOrientation");
}

#[test]
fn a_mass_without_a_volume_is_spread_over_the_surface() {
    let plate =
        node(json!({ "name": "plate" }), json!({ "motion": { "mass": 12 }, "collider": collider(5) }));
    let scene = load(&scene(json!([plate])));
    let plate = body(&scene, "plate");
    let mass = carom::mass::BodyMass::of(plate).unwrap();
    near(mass.center, [0.0, 0.0, 0.0]);
    let tensor = carom::math::rotated_diagonal(mass.principal_rotation, mass.moments);
    // A plate of 2 m by 4 m: m z²/12, the sum of both, m x²/12.
    let expected = carom::math::DMat3::from_diagonal(DVec3::new(16.0, 20.0, 4.0));
    assert!((tensor - expected).abs_diff_eq(carom::math::DMat3::ZERO, 1e-9), "{tensor}");
    has_note(&scene, "spread over their surface");
}
