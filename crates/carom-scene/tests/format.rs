//! What the format `carom` 1 means: defaults, names, materials, filters, shapes, mass.

use carom::math::{DVec3, Quat, Vec3};
use carom::{Accepts, Body, Combine, Material, Motion, Settings, Shape};
use carom_scene::Scene;

const EXAMPLE: &str = r#"
{ "carom": 1, "name": "drop",
  "gravity": [0, -9.81, 0], "dt": 0.016666667, "substeps": 4, "sleeping": false,
  "materials": { "steel": { "friction": 0.3, "restitution": 0.9 } },
  "bodies": [
    { "name": "floor", "motion": "static",
      "colliders": [ { "shape": { "type": "box", "size": [20, 1, 20] }, "position": [0, -0.5, 0], "material": "steel" } ] },
    { "name": "ball", "position": [0, 2, 0], "rotation": [0, 0, 0, 1],
      "linear_velocity": [0, 0, 0], "angular_velocity": [0, 0, 3],
      "colliders": [ { "shape": { "type": "sphere", "radius": 0.5 }, "density": 1000, "friction": 0.5, "restitution": 1.0 } ] } ],
  "joints": [] }"#;

fn scene(text: &str) -> Scene {
    Scene::from_json(text, "test.json").unwrap_or_else(|error| panic!("{error}"))
}

/// The body that `keys` describe, beside a material and with a sphere if it is dynamic.
fn body(keys: &str) -> Body {
    let materials = r#"{
        "ice": { "friction": 0.02 },
        "rubber": { "static_friction": 1.1, "dynamic_friction": 0.9, "restitution": 0.8, "friction_combine": "maximum" }
    }"#;
    scene(&format!(r#"{{ "carom": 1, "materials": {materials}, "bodies": [ {{ {keys} }} ] }}"#))
        .bodies
        .remove(0)
}

/// The material of a ball with `keys` on its collider.
fn material(keys: &str) -> Material {
    body(&format!(r#""colliders": [ {{ "shape": {{ "type": "sphere", "radius": 1 }}, {keys} }} ]"#)).colliders
        [0]
    .material
}

/// The shape that `shape` describes, on a static body.
fn shape(shape: &str) -> Shape {
    body(&format!(r#""motion": "static", "colliders": [ {{ "shape": {shape} }} ]"#)).colliders[0]
        .shape
        .clone()
}

#[test]
fn the_example_reads_as_it_is_written() {
    let scene = scene(EXAMPLE);
    assert_eq!((scene.name.as_str(), scene.dt, scene.sleeping), ("drop", 0.016666667, false));
    assert_eq!(scene.settings, Settings { substeps: 4, ..Settings::default() });
    assert!(scene.notes.is_empty());
    let [floor, ball] = &scene.bodies[..] else { panic!("two bodies") };
    assert_eq!((floor.name.as_str(), floor.motion), ("floor", Motion::Fixed));
    assert!(
        matches!(floor.colliders[0].shape, Shape::Cuboid { size } if size == DVec3::new(20.0, 1.0, 20.0))
    );
    assert_eq!(floor.colliders[0].pose.position, DVec3::new(0.0, -0.5, 0.0));
    assert_eq!(floor.colliders[0].material.static_friction, 0.3);
    assert_eq!(floor.colliders[0].material.restitution, 0.9);
    assert_eq!((ball.name.as_str(), ball.motion), ("ball", Motion::Dynamic));
    assert_eq!(ball.position, DVec3::new(0.0, 2.0, 0.0));
    assert_eq!(ball.angular_velocity, Vec3::new(0.0, 0.0, 3.0));
    assert!(matches!(ball.colliders[0].shape, Shape::Sphere { radius: 0.5 }));
    assert_eq!(ball.colliders[0].density, 1000.0);
    assert_eq!(ball.colliders[0].material.dynamic_friction, 0.5);
    assert_eq!(ball.colliders[0].material.restitution, 1.0);
}

#[test]
fn what_is_not_said_has_the_documented_default() {
    let scene = Scene::from_json(
        r#"{ "carom": 1, "bodies": [ { "colliders": [ { "shape": { "type": "sphere", "radius": 1 } } ] } ] }"#,
        "scenes/one-ball.json",
    );
    let scene = scene.unwrap();
    assert_eq!(scene.name, "one-ball");
    assert_eq!((scene.settings, scene.dt, scene.sleeping), (Settings::default(), 1.0 / 60.0, false));
    let ball = &scene.bodies[0];
    assert_eq!((ball.name.as_str(), ball.motion), ("body0", Motion::Dynamic));
    assert_eq!((ball.position, ball.rotation), (DVec3::ZERO, Quat::IDENTITY));
    assert_eq!((ball.linear_velocity, ball.angular_velocity), (Vec3::ZERO, Vec3::ZERO));
    assert_eq!((ball.linear_damping, ball.angular_damping, ball.gravity_factor), (0.0, 0.0, 1.0));
    assert_eq!((ball.mass, ball.center_of_mass, ball.inertia), (None, None, None));
    let collider = &ball.colliders[0];
    assert_eq!(
        (collider.density, collider.sensor, collider.pose),
        (1000.0, false, carom::math::Pose::IDENTITY)
    );
    assert_eq!(
        collider.material,
        Material { static_friction: 0.6, dynamic_friction: 0.6, ..Material::default() }
    );
    assert_eq!((collider.material.restitution, collider.material.friction_combine), (0.0, None));
    assert_eq!(collider.filter, carom::Filter::default());
}

#[test]
fn own_values_go_before_the_material_and_the_particular_before_the_general() {
    let both = |friction: f64| (friction, friction);
    let friction = |keys| {
        let material = material(keys);
        (material.static_friction, material.dynamic_friction)
    };
    assert_eq!(friction(r#""material": "ice""#), both(0.02));
    assert_eq!(friction(r#""material": "rubber""#), (1.1, 0.9));
    assert_eq!(friction(r#""material": "rubber", "friction": 0.5"#), both(0.5));
    assert_eq!(friction(r#""material": "rubber", "dynamic_friction": 0.5"#), (1.1, 0.5));
    assert_eq!(friction(r#""static_friction": 0.9"#), (0.9, 0.6));
    assert_eq!(friction(r#""friction": 0.4, "static_friction": 0.9"#), (0.9, 0.4));
    let rubber = material(r#""material": "rubber", "restitution": 0.1, "restitution_combine": "multiply""#);
    assert_eq!((rubber.restitution, rubber.restitution_combine), (0.1, Some(Combine::Multiply)));
    assert_eq!(rubber.friction_combine, Some(Combine::Maximum));
    assert_eq!(
        material(r#""material": "rubber", "friction_combine": "average""#).friction_combine,
        Some(Combine::Average)
    );
    assert_eq!(material(r#""friction_combine": "minimum""#).friction_combine, Some(Combine::Minimum));
}

#[test]
fn filters_share_the_names_of_the_whole_scene() {
    let of = |keys: &str| {
        format!(
            r#"{{ "colliders": [ {{ "shape": {{ "type": "sphere", "radius": 1 }}, {keys} "sensor": false }} ] }}"#
        )
    };
    let keys = [
        r#""groups": ["ball", "red"],"#,
        r#""groups": ["wall"], "collides_with": ["red"],"#,
        r#""collides_with": [],"#,
        "",
        r#""groups": ["red"], "collides_with": ["wall", "ball"],"#,
    ];
    let bodies = keys.map(of).join(", ");
    let scene = scene(&format!(r#"{{ "carom": 1, "bodies": [ {bodies} ] }}"#));
    let filters: Vec<_> = scene.bodies.iter().map(|body| &body.colliders[0].filter).collect();
    let touching = |a: usize| (0..5).filter(|&b| filters[a].allows(filters[b])).collect::<Vec<_>>();
    assert_eq!(touching(0), [0, 1, 3, 4]);
    assert_eq!(touching(1), [0, 4]);
    assert_eq!(touching(2), [0; 0], "an empty list means nothing");
    assert_eq!(touching(3), [0, 3]);
    assert_eq!(touching(4), [0, 1]);
    assert!(matches!(filters[2].accepts, Accepts::AnyOf(_)) && filters[3].accepts == Accepts::All);
}

#[test]
fn every_shape_is_read() {
    assert!(matches!(
        shape(r#"{ "type": "capsule", "height": 2, "radius": 0.5 }"#),
        Shape::Capsule { height: 2.0, radius: 0.5 }
    ));
    assert!(matches!(
        shape(r#"{ "type": "capsule", "height": 2, "radius_bottom": 0.5, "radius_top": 0.25 }"#),
        Shape::TaperedCapsule { height: 2.0, radius_bottom: 0.5, radius_top: 0.25 }
    ));
    assert!(matches!(
        shape(r#"{ "type": "cylinder", "height": 2, "radius": 0.5 }"#),
        Shape::Cylinder { height: 2.0, radius_bottom: 0.5, radius_top: 0.5 }
    ));
    assert!(matches!(
        shape(r#"{ "type": "cylinder", "height": 2, "radius_bottom": 0, "radius_top": 0.5 }"#),
        Shape::Cylinder { height: 2.0, radius_bottom: 0.0, radius_top: 0.5 }
    ));
    assert!(matches!(
        shape(r#"{ "type": "cone", "height": 2, "radius": 0.5 }"#),
        Shape::Cylinder { height: 2.0, radius_bottom: 0.5, radius_top: 0.0 }
    ));
    assert!(matches!(shape(r#"{ "type": "plane" }"#), Shape::Plane));
    let hull = shape(r#"{ "type": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }"#);
    assert!(matches!(hull, Shape::Hull(hull) if hull.vertices().len() == 4));
    let mesh =
        r#"{ "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] }"#;
    assert!(matches!(shape(mesh), Shape::Mesh(mesh) if mesh.triangles() == [[0, 1, 2]]));
    let field = shape(r#"{ "type": "heightfield", "heights": [[0, 1, 2], [3, 4, 5]], "size": [4, 2] }"#);
    let Shape::HeightField(field) = field else { panic!("{field:?}") };
    assert_eq!((field.columns(), field.rows(), field.size()), (3, 2, [4.0, 2.0]));
    assert_eq!(
        (field.height(2, 0), field.height(0, 1)),
        (Some(2.0), Some(3.0)),
        "rows along z, each along x"
    );
}

#[test]
fn an_open_mesh_with_a_mass_is_a_thin_sheet() {
    let mesh = r#"{ "type": "mesh", "vertices": [[-1, 0, -2], [-1, 0, 2], [1, 0, 2], [1, 0, -2]], "triangles": [[0, 1, 2], [0, 2, 3]] }"#;
    let plate =
        body(&format!(r#""mass": 12, "colliders": [ {{ "shape": {mesh}, "position": [1, 2, 3] }} ]"#));
    let mass = carom::mass::BodyMass::of(&plate).unwrap();
    assert!((mass.center - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-12);
    let tensor = carom::math::rotated_diagonal(mass.principal_rotation, mass.moments);
    let diagonal = DVec3::new(tensor.x_axis.x, tensor.y_axis.y, tensor.z_axis.z);
    assert!((diagonal - DVec3::new(16.0, 20.0, 4.0)).length() < 1e-9, "{tensor}");
}

#[test]
fn mass_and_inertia_are_passed_on() {
    let ball = r#""colliders": [ { "shape": { "type": "sphere", "radius": 1 } } ]"#;
    let given = body(&format!(
        r#"{ball}, "mass": 3, "center_of_mass": [0.5, 0, 0], "inertia_diagonal": [1, 2, 2.5], "inertia_orientation": [0, 0.6, 0, 0.8]"#
    ));
    assert_eq!((given.mass, given.center_of_mass), (Some(3.0), Some(DVec3::new(0.5, 0.0, 0.0))));
    let inertia = given.inertia.unwrap();
    assert_eq!(inertia.diagonal, DVec3::new(1.0, 2.0, 2.5));
    assert!((inertia.orientation.y - 0.6).abs() < 1e-15);
    assert_eq!(body(&format!(r#"{ball}, "mass": 0"#)).mass, Some(0.0), "0 stands for infinite");
    let point = body(r#""mass": 2, "inertia_diagonal": [0, 0, 0]"#);
    assert!(point.colliders.is_empty() && point.inertia.unwrap().diagonal == DVec3::ZERO);
    for motion in ["static", "kinematic"] {
        assert!(body(&format!(r#""motion": "{motion}""#)).colliders.is_empty());
    }
    assert_eq!(body(r#""motion": "static", "linear_velocity": [0, 0, 0]"#).linear_velocity, Vec3::ZERO);
}

#[test]
fn rotations_are_normalised_in_double_precision() {
    let body = body(
        r#""motion": "static", "rotation": [0, 0.6004, 0, 0.8004], "colliders": [
        { "shape": { "type": "sphere", "radius": 1 }, "rotation": [0, 0.6004, 0, 0.8004] } ]"#,
    );
    assert!(body.rotation.is_normalized());
    assert!((body.colliders[0].pose.rotation.length() - 1.0).abs() < 1e-15);
    let exact = 0.6004 / f64::hypot(0.6004, 0.8004);
    assert_eq!(body.rotation.y, exact as f32);
}

#[test]
fn numbers_keep_all_their_bits() {
    let body = body(r#""motion": "static", "position": [0.1, 1e-300, -999999999.9999999]"#);
    assert_eq!(body.position, DVec3::new(0.1, 1e-300, -999_999_999.999_999_9));
}

#[test]
fn sleeping_is_kept_and_noted() {
    let scene = scene(r#"{ "carom": 1, "sleeping": true, "bodies": [] }"#);
    assert!(scene.sleeping);
    assert_eq!(scene.notes.len(), 1);
    assert!(scene.notes[0].starts_with("test.json: sleeping: "), "{}", scene.notes[0]);
}

#[test]
fn a_scene_becomes_a_world_in_its_own_order() {
    let (world, ids) = scene(EXAMPLE).world().unwrap();
    assert_eq!(ids.len(), 2);
    let names: Vec<_> = ids.iter().map(|&id| world.description(id).unwrap().name.clone()).collect();
    assert_eq!(names, ["floor", "ball"]);
    let (_, again) = scene(EXAMPLE).into_world().unwrap();
    assert_eq!(ids, again);
}

#[test]
fn many_bodies_are_read_in_linear_time() {
    // Quadratic work on so many names would take minutes.
    let bodies = vec![r#"{"motion":"static"}"#; 300_000].join(",");
    let scene = scene(&format!(r#"{{"carom":1,"bodies":[{bodies}]}}"#));
    assert_eq!(scene.bodies.len(), 300_000);
    assert_eq!(scene.bodies[299_999].name, "body299999");
}
