//! Scenes that are refused: each with the place, the value and what was expected.

use Frame::{Ball, Collider, Shape, Static, StaticShape, Top};
use carom_scene::{Scene, SceneError};

/// What stands at `HERE` in one of the frames below, and what the error says: path, value, and a part of the expectation.
struct Case(Frame, &'static str, &'static str, &'static str, &'static str);

#[derive(Clone, Copy, Debug)]
enum Frame {
    /// Keys of the scene.
    Top,
    /// Keys of a dynamic body with a ball.
    Ball,
    /// Keys of a static body.
    Static,
    /// Keys of a collider with a ball on a dynamic body.
    Collider,
    /// The shape of a collider on a dynamic body.
    Shape,
    /// The shape of a collider on a static body.
    StaticShape,
}

impl Frame {
    fn around(self, text: &str) -> String {
        const BALL: &str = r#"{ "shape": { "type": "sphere", "radius": 1 } }"#;
        let body = match self {
            Top => return format!("{{ {text} }}"),
            Ball => format!(r#""colliders": [ {BALL} ], {text}"#),
            Static => format!(r#""motion": "static", {text}"#),
            Collider => {
                format!(
                    r#""colliders": [ {BALL}, {{ "shape": {{ "type": "sphere", "radius": 1 }}, {text} }} ]"#
                )
            }
            Shape => format!(r#""colliders": [ {{ "shape": {text} }} ]"#),
            StaticShape => format!(r#""motion": "static", "colliders": [ {{ "shape": {text} }} ]"#),
        };
        let materials = r#"{ "steel": { "friction": 0.3 }, "oiled steel": { "friction": 0.1 } }"#;
        format!(
            r#"{{ "carom": 1, "materials": {materials}, "bodies": [ {{ "motion": "static" }}, {{ {body} }} ] }}"#
        )
    }
}

#[rustfmt::skip]
const CASES: &[Case] = &[
    // The scene
    Case(Top, r#""bodies": []"#, "carom", "nothing", "1, the version"),
    Case(Top, r#""carom": 2, "news": 1, "bodies": []"#, "carom", "2", "1, the version"),
    Case(Top, r#""carom": "1", "bodies": []"#, "carom", r#""1""#, "1, the version"),
    Case(Top, r#""carom": 1"#, "bodies", "nothing", "a list of bodies"),
    Case(Top, r#""carom": 1, "bodies": {}"#, "bodies", "{}", "a list of bodies"),
    Case(Top, r#""carom": 1, "bodies": [], "grvity": [0, 0, 0]"#, "grvity", "[0, 0, 0]", "(did you mean gravity?)"),
    Case(Top, r#""carom": 1, "bodies": [], "extra": null"#, "extra", "null", "known here are carom, name, gravity, dt, substeps, sleeping, materials, bodies, joints"),
    Case(Top, r#""carom": 1, "bodies": [], "name": 7"#, "name", "7", "the name of the scene"),
    Case(Top, r#""carom": 1, "bodies": [], "gravity": -9.81"#, "gravity", "-9.81", "a list of 3 numbers [x, y, z]"),
    Case(Top, r#""carom": 1, "bodies": [], "gravity": [0, "down", 0]"#, "gravity[1]", r#""down""#, "m/s²"),
    Case(Top, r#""carom": 1, "bodies": [], "dt": 0"#, "dt", "0", "a number from 1e-6 to 1 s"),
    Case(Top, r#""carom": 1, "bodies": [], "dt": 1.5"#, "dt", "1.5", "a number from 1e-6 to 1 s"),
    Case(Top, r#""carom": 1, "bodies": [], "dt": null"#, "dt", "null", "a number from 1e-6 to 1 s"),
    Case(Top, r#""carom": 1, "bodies": [], "substeps": 0"#, "substeps", "0", "a whole number from 1 to 1000"),
    Case(Top, r#""carom": 1, "bodies": [], "substeps": 2.5"#, "substeps", "2.5", "a whole number from 1 to 1000"),
    Case(Top, r#""carom": 1, "bodies": [], "substeps": 1e30"#, "substeps", "1e30", "a whole number from 1 to 1000"),
    Case(Top, r#""carom": 1, "bodies": [], "sleeping": 1"#, "sleeping", "1", "true or false"),
    Case(Top, r#""carom": 1, "bodies": [], "joints": [{ "type": "hinge", "a": "x", "b": "y" }]"#, "joints[0].type", r#""hinge""#, "joints are not built yet"),
    Case(Top, r#""carom": 1, "bodies": [], "joints": {}"#, "joints", "{}", "a list of joints"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "my ice": { "fiction": 0 } }"#, r#"materials["my ice"].fiction"#, "0", "(did you mean friction?)"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "ice": { "density": 900 } }"#, "materials.ice.density", "900", "known here are friction, static_friction"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "ice": { "restitution": 1.01 } }"#, "materials.ice.restitution", "1.01", "a number from 0 to 1"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "ice": { "dynamic_friction": -0.1 } }"#, "materials.ice.dynamic_friction", "-0.1", "0 or more"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "ice": 0.1 }"#, "materials.ice", "0.1", "an object {...}"),
    Case(Top, r#""carom": 1, "bodies": [7]"#, "bodies[0]", "7", "an object {...}"),
    // Names
    Case(Top, r#""carom": 1, "bodies": [{ "motion": "static", "name": "a" }, { "motion": "static", "name": "a" }]"#, "bodies[1].name", r#""a""#, "bodies[0] is called so too"),
    Case(Top, r#""carom": 1, "bodies": [{ "motion": "static", "name": "body1" }, { "motion": "static" }]"#, "bodies[1].name", "nothing", r#"without one this body is "body1", as bodies[0] is called"#),
    Case(Top, r#""carom": 1, "bodies": [{ "motion": "static" }, { "motion": "static", "name": "body0" }]"#, "bodies[1].name", r#""body0""#, "bodies[0] is called so too"),
    Case(Static, r#""name": """#, "bodies[1].name", r#""""#, "a name that is not empty"),
    Case(Static, r#""name": ["a"]"#, "bodies[1].name", r#"["a"]"#, "a name that is not empty"),
    // Bodies
    Case(Static, r#""postion": [1, 2, 3]"#, "bodies[1].postion", "[1, 2, 3]", "(did you mean position?)"),
    Case(Ball, r#""motion": "Static""#, "bodies[1].motion", r#""Static""#, "one of dynamic, static, kinematic (did you mean static?)"),
    Case(Ball, r#""motion": true"#, "bodies[1].motion", "true", "one of dynamic, static, kinematic"),
    Case(Ball, r#""position": [0, 0]"#, "bodies[1].position", "[0, 0]", "a list of 3 numbers [x, y, z]"),
    Case(Ball, r#""position": [0, -1.5e9, 0]"#, "bodies[1].position[1]", "-1.5e9", "a number from -1e9 to 1e9 m"),
    Case(Ball, r#""rotation": [0, 0, 0, 1.01]"#, "bodies[1].rotation", "[0, 0, 0, 1.01]", "a unit quaternion [x, y, z, w], its length within 0.001 of 1; this one's is 1.01"),
    Case(Ball, r#""rotation": [0, 0, 0, 0]"#, "bodies[1].rotation", "[0, 0, 0, 0]", "this one's is 0"),
    Case(Ball, r#""rotation": [0, 0, 0, 1e200]"#, "bodies[1].rotation", "[0, 0, 0, 1e200]", "a unit quaternion"),
    Case(Ball, r#""rotation": [0, 0, 1]"#, "bodies[1].rotation", "[0, 0, 1]", "a list of 4 numbers [x, y, z, w]"),
    Case(Ball, r#""linear_velocity": [1000001, 0, 0]"#, "bodies[1].linear_velocity[0]", "1.000001e6", "a number from -1e6 to 1e6 m/s"),
    Case(Ball, r#""angular_velocity": [0, 0, -2e6]"#, "bodies[1].angular_velocity[2]", "-2e6", "a number from -1e6 to 1e6 rad/s"),
    Case(Static, r#""linear_velocity": [1, 0, 0]"#, "bodies[1].linear_velocity", "[1, 0, 0]", "[0, 0, 0] on a static body"),
    Case(Ball, r#""linear_damping": -1"#, "bodies[1].linear_damping", "-1", "a finite number 1/s, 0 or more"),
    Case(Ball, r#""angular_damping": "0""#, "bodies[1].angular_damping", r#""0""#, "a finite number 1/s, 0 or more"),
    Case(Ball, r#""gravity_factor": []"#, "bodies[1].gravity_factor", "[]", "a finite number"),
    // Mass
    Case(Ball, r#""mass": -1"#, "bodies[1].mass", "-1", "a number from 1e-9 to 1e15 kg, or 0 for infinite"),
    Case(Ball, r#""mass": 1e-10"#, "bodies[1].mass", "1e-10", "a number from 1e-9 to 1e15 kg, or 0 for infinite"),
    Case(Ball, r#""mass": 2e15"#, "bodies[1].mass", "2e15", "a number from 1e-9 to 1e15 kg"),
    Case(Ball, r#""center_of_mass": [0, 0, 0]"#, "bodies[1].center_of_mass", "[0, 0, 0]", "only together with mass"),
    Case(Ball, r#""inertia_diagonal": [1, 1, 1]"#, "bodies[1].inertia_diagonal", "[1, 1, 1]", "only together with mass"),
    Case(Ball, r#""mass": 1, "inertia_diagonal": [1, -1, 1]"#, "bodies[1].inertia_diagonal[1]", "-1", "0 or more"),
    Case(Ball, r#""mass": 1, "inertia_orientation": [0, 0, 0, 1]"#, "bodies[1].inertia_diagonal", "nothing", "the moments that inertia_orientation turns"),
    Case(Ball, r#""mass": 1, "inertia_diagonal": [1, 1, 5]"#, "bodies[1].inertia_diagonal", "[1, 1, 5]", ""),
    Case(Static, r#""mass": 1"#, "bodies[1].mass", "1", "no such key on a static body"),
    Case(Static, r#""inertia_orientation": [0, 0, 0, 1]"#, "bodies[1].inertia_orientation", "[0, 0, 0, 1]", "no such key on a static body"),
    Case(Ball, r#""motion": "kinematic", "center_of_mass": [0, 0, 0]"#, "bodies[1].center_of_mass", "[0, 0, 0]", "no such key on a kinematic body"),
    Case(Top, r#""carom": 1, "bodies": [{}]"#, "bodies[0].mass", "nothing", "a mass in kg, since no collider gives the body any"),
    Case(Collider, r#""density": 1e20"#, "bodies[1].mass", "", "kg"),
    Case(Top, r#""carom": 1, "bodies": [{ "mass": 1 }]"#, "bodies[0].mass", "1", "inertia_diagonal"),
    Case(Top, r#""carom": 1, "bodies": [{ "colliders": [{ "sensor": true, "shape": { "type": "sphere", "radius": 1 } }] }]"#, "bodies[0].mass", "nothing", "a mass in kg"),
    Case(Top, r#""carom": 1, "bodies": [{ "colliders": [{ "density": 0, "shape": { "type": "sphere", "radius": 1 } }] }]"#, "bodies[0].mass", "", ""),
    // Colliders
    Case(Static, r#""colliders": 3"#, "bodies[1].colliders", "3", "a list of colliders"),
    Case(Static, r#""colliders": [{}]"#, "bodies[1].colliders[0].shape", "nothing", "a shape, such as"),
    Case(Static, r#""colliders": [[]]"#, "bodies[1].colliders[0]", "[]", "an object {...}"),
    Case(Collider, r#""Density": 1"#, "bodies[1].colliders[1].Density", "1", "(did you mean density?)"),
    Case(Collider, r#""density": -1"#, "bodies[1].colliders[1].density", "-1", "a finite number kg/m³, 0 or more"),
    Case(Collider, r#""friction": -0.5"#, "bodies[1].colliders[1].friction", "-0.5", "0 or more"),
    Case(Collider, r#""restitution": 2"#, "bodies[1].colliders[1].restitution", "2", "a number from 0 to 1"),
    Case(Collider, r#""restitution": -0.0001"#, "bodies[1].colliders[1].restitution", "-1e-4", "a number from 0 to 1"),
    Case(Collider, r#""material": "steal""#, "bodies[1].colliders[1].material", r#""steal""#, "one of the scene's materials steel, oiled steel (did you mean steel?)"),
    Case(Collider, r#""material": 1"#, "bodies[1].colliders[1].material", "1", "the name of a material"),
    Case(Collider, r#""friction_combine": "mean""#, "bodies[1].colliders[1].friction_combine", r#""mean""#, "one of average, minimum, maximum, multiply"),
    Case(Collider, r#""restitution_combine": "max""#, "bodies[1].colliders[1].restitution_combine", r#""max""#, "one of average, minimum, maximum, multiply"),
    Case(Collider, r#""sensor": "yes""#, "bodies[1].colliders[1].sensor", r#""yes""#, "true or false"),
    Case(Collider, r#""groups": "red""#, "bodies[1].colliders[1].groups", r#""red""#, "a list of names of groups"),
    Case(Collider, r#""collides_with": [1]"#, "bodies[1].colliders[1].collides_with[0]", "1", "the name of a group"),
    Case(Collider, r#""position": [1e10, 0, 0]"#, "bodies[1].colliders[1].position[0]", "1e10", "a number from -1e9 to 1e9 m"),
    Case(Collider, r#""rotation": [1, 1, 1, 1]"#, "bodies[1].colliders[1].rotation", "[1, 1, 1, 1]", "this one's is 2"),
    // Shapes
    Case(Shape, r#""sphere""#, "bodies[1].colliders[0].shape", r#""sphere""#, "an object {...}"),
    Case(Shape, r#"{ "radius": 1 }"#, "bodies[1].colliders[0].shape.type", "nothing", "one of sphere, box, capsule, cylinder, cone, plane, hull, mesh, heightfield"),
    Case(Shape, r#"{ "type": "shpere", "radius": 1 }"#, "bodies[1].colliders[0].shape.type", r#""shpere""#, "(did you mean sphere?)"),
    Case(Shape, r#"{ "type": "sphere", "radius": 0 }"#, "bodies[1].colliders[0].shape.radius", "0", "a number from 1e-6 to 1e6 m"),
    Case(Shape, r#"{ "type": "sphere", "radius": 1e-7 }"#, "bodies[1].colliders[0].shape.radius", "1e-7", "a number from 1e-6 to 1e6 m"),
    Case(Shape, r#"{ "type": "sphere", "radius": "1" }"#, "bodies[1].colliders[0].shape.radius", r#""1""#, "a number from 1e-6 to 1e6 m"),
    Case(Shape, r#"{ "type": "sphere" }"#, "bodies[1].colliders[0].shape.radius", "nothing", "a length in m"),
    Case(Shape, r#"{ "type": "sphere", "radius": 1, "size": 2 }"#, "bodies[1].colliders[0].shape.size", "2", "known here are type, radius"),
    Case(Shape, r#"{ "type": "box", "size": [1, 1, 2000000] }"#, "bodies[1].colliders[0].shape.size[2]", "2e6", "a number from 1e-6 to 1e6 m"),
    Case(Shape, r#"{ "type": "box", "size": [1, 1, 1, 1] }"#, "bodies[1].colliders[0].shape.size", "[1, 1, 1, 1]", "a list of 3 lengths [x, y, z]"),
    Case(Shape, r#"{ "type": "box" }"#, "bodies[1].colliders[0].shape.size", "nothing", "full edge lengths"),
    Case(Shape, r#"{ "type": "capsule", "height": 1 }"#, "bodies[1].colliders[0].shape.radius", "nothing", "or radius_bottom and radius_top"),
    Case(Shape, r#"{ "type": "capsule", "radius": 1 }"#, "bodies[1].colliders[0].shape.height", "nothing", "a length in m"),
    Case(Shape, r#"{ "type": "capsule", "height": 1, "radius": 1, "radius_top": 2 }"#, "bodies[1].colliders[0].shape.radius", "1", "either radius, or radius_bottom and radius_top"),
    Case(Shape, r#"{ "type": "cylinder", "height": 1, "radius_bottom": 1 }"#, "bodies[1].colliders[0].shape.radius_top", "nothing", "since the other end has its own"),
    Case(Shape, r#"{ "type": "cylinder", "height": 1, "radius_bottom": 0, "radius_top": 0 }"#, "bodies[1].colliders[0].shape.radius_top", "0", "above 0 on at least one end"),
    Case(Shape, r#"{ "type": "cylinder", "height": 1, "radius_bottom": -1, "radius_top": 1 }"#, "bodies[1].colliders[0].shape.radius_bottom", "-1", "or 0 on one end"),
    Case(Shape, r#"{ "type": "cone", "height": 1, "radius_bottom": 1, "radius_top": 0 }"#, "bodies[1].colliders[0].shape.radius_bottom", "1", "known here are type, height, radius"),
    Case(Shape, r#"{ "type": "plane" }"#, "bodies[1].colliders[0].shape.type", r#""plane""#, "a plane only on a static body"),
    Case(StaticShape, r#"{ "type": "plane", "normal": [0, 1, 0] }"#, "bodies[1].colliders[0].shape.normal", "[0, 1, 0]", "known here are type"),
    Case(Shape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, 0]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.type", r#""heightfield""#, "a height field only on a static body"),
    Case(StaticShape, r#"{ "type": "heightField" }"#, "bodies[1].colliders[0].shape.type", r#""heightField""#, "(did you mean heightfield?)"),
    Case(StaticShape, r#"{ "type": "heightfield", "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights", "nothing", "rows of heights along z"),
    Case(StaticShape, r#"{ "type": "heightfield", "hights": [] }"#, "bodies[1].colliders[0].shape.hights", "[]", "(did you mean heights?)"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, 0]] }"#, "bodies[1].colliders[0].shape.size", "nothing", "the full extent [x, z]"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": 1, "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights", "1", "a list of rows of heights"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [0, 0], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights[0]", "0", "a list of heights along x"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights", "0 rows", "at least two rows"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights", "1 row", "at least two rows"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0], [0]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights[0]", "1 height", "at least two heights"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, 0, 0]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights[1]", "3 heights", "2 heights, as in the first row"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, null]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights[1][1]", "null", "a number from -1e6 to 1e6 m"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 2e6], [0, 0]], "size": [1, 1] }"#, "bodies[1].colliders[0].shape.heights[0][1]", "2e6", "a number from -1e6 to 1e6 m"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, 0]], "size": [1, 1, 1] }"#, "bodies[1].colliders[0].shape.size", "[1, 1, 1]", "a list of 2 lengths [x, z]"),
    Case(StaticShape, r#"{ "type": "heightfield", "heights": [[0, 0], [0, 0]], "size": [1, 0] }"#, "bodies[1].colliders[0].shape.size[1]", "0", "a number from 1e-6 to 1e6 m"),
    Case(StaticShape, r#"{ "type": "hull" }"#, "bodies[1].colliders[0].shape.points", "nothing", "a list of points"),
    Case(StaticShape, r#"{ "type": "hull", "file": "no/such.obj" }"#, "bodies[1].colliders[0].shape.file", r#""no/such.obj""#, "an OBJ file that can be read; no/such.obj: "),
    Case(StaticShape, r#"{ "type": "mesh", "file": "no/such.obj" }"#, "bodies[1].colliders[0].shape.file", r#""no/such.obj""#, "an OBJ file that can be read; no/such.obj: "),
    Case(StaticShape, r#"{ "type": "mesh", "file": 7 }"#, "bodies[1].colliders[0].shape.file", "7", "the name of an OBJ file"),
    Case(StaticShape, r#"{ "type": "mesh", "file": "" }"#, "bodies[1].colliders[0].shape.file", r#""""#, "the name of an OBJ file"),
    Case(StaticShape, r#"{ "type": "mesh", "fil": "a.obj" }"#, "bodies[1].colliders[0].shape.fil", r#""a.obj""#, "(did you mean file?)"),
    Case(StaticShape, r#"{ "type": "sphere", "file": "a.obj" }"#, "bodies[1].colliders[0].shape.file", r#""a.obj""#, "known here are type, radius"),
    Case(StaticShape, r#"{ "type": "mesh", "file": "a.obj", "triangles": [] }"#, "bodies[1].colliders[0].shape.triangles", "[]", "no such key beside file"),
    Case(StaticShape, r#"{ "type": "hull", "file": "a.obj", "points": [] }"#, "bodies[1].colliders[0].shape.points", "[]", "no such key beside file"),
    Case(StaticShape, r#"{ "type": "hull", "points": [[0, 0, 0]] }"#, "bodies[1].colliders[0].shape.points", "[[0, 0, 0]]", "at least 4 points, not 1"),
    Case(StaticShape, r#"{ "type": "hull", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]] }"#, "bodies[1].colliders[0].shape.points", "", ""),
    Case(StaticShape, r#"{ "type": "hull", "points": [[0, 0, 0], [1, 0, 1e7]] }"#, "bodies[1].colliders[0].shape.points[1][2]", "1e7", "a number from -1e6 to 1e6 m"),
    Case(StaticShape, r#"{ "type": "mesh", "vertices": [[0, 0, 0]] }"#, "bodies[1].colliders[0].shape.triangles", "nothing", "a list of triangles"),
    Case(StaticShape, r#"{ "type": "mesh", "vertices": [[0, 0, 0]], "triangles": [] }"#, "bodies[1].colliders[0].shape.triangles", "[]", "at least one triangle"),
    Case(StaticShape, r#"{ "type": "mesh", "vertices": [], "triangles": [[0, 0, 0]] }"#, "bodies[1].colliders[0].shape.triangles[0][0]", "0", "but there are no vertices"),
    Case(StaticShape, r#"{ "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 3]] }"#, "bodies[1].colliders[0].shape.triangles[0][2]", "3", "a whole number from 0 to 2"),
    Case(StaticShape, r#"{ "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 0.5]] }"#, "bodies[1].colliders[0].shape.triangles[0][2]", "0.5", "a whole number from 0 to 2"),
    Case(Shape, r#"{ "type": "mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]] }"#, "bodies[1].mass", "nothing", "a mesh has none of its own"),
    // What JSON itself does not have
    Case(Ball, r#""mass": NaN"#, "bodies[1].mass", "NaN", "a finite number (line 1, column "),
    Case(Ball, r#""position": [0, -Infinity, 0]"#, "bodies[1].position[1]", "-Infinity", "a finite number (line 1, column "),
    Case(Ball, r#""position": [0, 0, 1e999]"#, "bodies[1].position[2]", "1e999", "a finite number (line 1, column "),
    Case(Ball, r#""mass": 1, "mass": 2"#, "bodies[1].mass", "2", "each key once in an object"),
    Case(Top, r#""carom": 1, "bodies": [], "materials": { "a": {}, "b": {}, "a": {} }"#, "materials.a", "{}", "each key once in an object"),
];

#[test]
fn every_refusal_names_place_value_and_expectation() {
    let mut wrong = Vec::new();
    for Case(frame, text, path, value, expected) in CASES {
        let told = match Scene::from_json(&frame.around(text), "t.json") {
            Err(SceneError::Invalid { path: p, value: v, expected: e, .. }) => {
                // An empty value in the table: the engine's words, which are not this table's business.
                let same_value = value.is_empty() || v == *value;
                if p == *path && same_value && e.contains(expected) {
                    continue;
                }
                format!("{p}: {v}; expected {e}")
            }
            other => format!("{other:?}"),
        };
        wrong.push(format!(
            "{frame:?} {text}\n  should be {path}: {value}; expected {expected}\n  but is    {told}"
        ));
    }
    assert!(wrong.is_empty(), "{} of {} cases:\n{}", wrong.len(), CASES.len(), wrong.join("\n"));
}

#[test]
fn an_error_is_one_line_of_bounded_length() {
    for Case(frame, text, ..) in CASES {
        let error = Scene::from_json(&frame.around(text), "t.json").unwrap_err().to_string();
        assert!(error.starts_with("t.json: ") && error.contains("; expected "), "{error}");
        assert!(!error.contains('\n') && error.chars().count() < 500, "{error}");
    }
}

#[test]
fn long_values_end_in_an_ellipsis() {
    let long = "ö".repeat(1000);
    let error = Scene::from_json(&Static.around(&format!(r#""motoin": "{long}""#)), "t.json")
        .unwrap_err()
        .to_string();
    let shown = format!("t.json: bodies[1].motoin: \"{}…; expected no such key;", "ö".repeat(59));
    assert!(error.starts_with(&shown), "{error}");
    let list = format!("[{}]", vec!["[1, 2, 3]"; 100_000].join(","));
    let error = Scene::from_json(&Static.around(&format!(r#""position": {list}"#)), "t.json")
        .unwrap_err()
        .to_string();
    assert!(error.contains("position: [[1, 2, 3], ") && error.len() < 200, "{error}");
}

#[test]
fn more_than_ten_million_bodies_are_refused() {
    let text = format!(r#"{{"carom":1,"bodies":[{}0]}}"#, "0,".repeat(10_000_000));
    let error = Scene::from_json(&text, "t.json").unwrap_err().to_string();
    assert_eq!(error, "t.json: bodies: 10000001 bodies; expected at most 10 million bodies");
}
