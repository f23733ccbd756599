//! What the program writes where all is well, and where an output fails.

mod common;

use common::{Folder, bouncing, stderr, stdout, two_balls};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error} in {text}"))
}

fn vector(value: &Value) -> [f64; 3] {
    let list = value.as_array().unwrap_or_else(|| panic!("no vector: {value}"));
    [0, 1, 2].map(|axis| list[axis].as_f64().expect("a number"))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[test]
fn alone_it_explains_a_collision_and_says_what_to_try_next() {
    let text = Folder::new("alone").told(&[]);
    for part in ["STEP 5", "THREE CONDITIONS", "state hash", "carom scenes", "carom explain"] {
        assert!(text.contains(part), "no {part} in:\n{text}");
    }
    assert!(!text.contains('✗'), "{text}");
}

#[test]
fn scenes_are_listed_and_the_schema_is_json() {
    let folder = Folder::new("lists");
    let text = folder.told(&["scenes"]);
    assert!(text.lines().any(|line| line.starts_with("off-centre-hit ")), "{text}");
    let listed = json(&folder.told(&["scenes", "--json"]));
    assert_eq!(listed.as_array().expect("a list").len(), text.lines().count());
    assert_eq!(json(&folder.told(&["schema"]))["type"], "object");
    assert!(folder.told(&["--version"]).starts_with("carom "));
    assert!(folder.told(&["run", "--help"]).contains("--substeps"));
}

#[test]
fn every_builtin_scene_keeps_the_laws() {
    let folder = Folder::new("builtin");
    let listed = json(&folder.told(&["scenes", "--json"]));
    let names =
        listed.as_array().expect("a list").iter().map(|scene| scene["name"].as_str().expect("a name"));
    for name in names.filter(|name| *name != "pile") {
        let output = folder.carom(&["check", name, "--seconds", "4", "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    }
}

#[test]
fn the_pile_keeps_the_laws() {
    let output = Folder::new("pile").carom(&["check", "pile", "--seconds", "2", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
}

#[test]
fn the_summary_is_one_json_object() {
    let folder = Folder::new("summary");
    folder.file("scene.json", bouncing());
    let text = folder.told(&["run", "scene.json", "--seconds", "1", "--dt", "0.01", "--json"]);
    assert_eq!(text.lines().count(), 1);
    let summary = json(&text);
    assert_eq!(summary["scene"], "bouncing");
    assert_eq!(summary["steps"], 100);
    assert_eq!(summary["bodies"], 2);
    assert_eq!(summary["collisions"], 1);
    assert_eq!(summary["state_hash"].as_str().expect("a hash").len(), 16);
    let again = json(&folder.told(&["run", "scene.json", "--steps", "100", "--dt", "0.01", "--json"]));
    assert_eq!(summary["state_hash"], again["state_hash"]);
}

#[test]
fn the_trace_is_as_promised_and_the_same_each_time() {
    let folder = Folder::new("trace");
    folder.file("scene.json", bouncing());
    let run = |trace: &str, every: &str| {
        folder.told(&["run", "scene.json", "--steps", "65", "--trace", trace, "--every", every]);
        std::fs::read_to_string(folder.path(trace)).expect("a trace")
    };
    let all = run("all.jsonl", "1");
    assert_eq!(all, run("again.jsonl", "1"));
    let lines: Vec<&str> = all.lines().collect();
    assert_eq!(lines.len(), 1 + 66);
    assert!(all.ends_with('\n'));
    assert!(
        lines[0].starts_with(r#"{"format":"carom-trace","version":1,"scene":"bouncing","dt":"#),
        "{}",
        lines[0]
    );
    assert!(lines[0].ends_with(r#""bodies":["ball"]}"#), "{}", lines[0]);
    assert!(
        lines[1].starts_with(r#"{"step":0,"time":0.0,"bodies":[{"name":"ball","position":[0.1,1.5,0.0],"#)
    );
    for (step, line) in lines[1..].iter().enumerate() {
        let line = json(line);
        assert_eq!(line["step"], step);
        assert_eq!(line["time"].as_f64(), Some(step as f64 * json(lines[0])["dt"].as_f64().expect("dt")));
    }

    let some = run("some.jsonl", "10");
    let steps: Vec<u64> =
        some.lines().skip(1).map(|line| json(line)["step"].as_u64().expect("step")).collect();
    assert_eq!(steps, [0, 10, 20, 30, 40, 50, 60, 65]);
    assert!(some.lines().all(|line| lines.contains(&line)));
}

#[test]
fn no_steps_at_all_are_a_start_without_an_end() {
    let folder = Folder::new("no_steps");
    folder.told(&["run", "off-centre-hit", "--steps", "0", "--trace", "trace.jsonl"]);
    let trace = std::fs::read_to_string(folder.path("trace.jsonl")).expect("a trace");
    assert_eq!(trace.lines().count(), 2);
}

#[test]
fn an_explanation_has_the_promised_keys_and_its_numbers_agree() {
    let folder = Folder::new("explanation");
    for (name, surface) in [
        ("smooth.json", r#""friction": 0, "restitution": 0.7"#),
        ("rough.json", r#""friction": 0.4, "restitution": 0.7"#),
    ] {
        folder.file(name, two_balls(surface));
        let it = json(&folder.told(&["explain", name, "--json"]));
        let keys: Vec<&str> = it.as_object().expect("an object").keys().map(String::as_str).collect();
        assert_eq!(
            keys.join(" "),
            "index time a b point normal restitution friction mass inverse_inertia lever_arm velocity_before \
             velocity_after closing_speed unit_response fraction friction_impulse separating_speed together \
             conditions reference_point"
        );
        assert_eq!((&it["index"], &it["a"], &it["b"]), (&0.into(), &"left".into(), &"right".into()));
        let number = |key: &str| it[key].as_f64().unwrap_or_else(|| panic!("{key}: {}", it[key]));
        let normal = vector(&it["normal"]);
        assert!((number("separating_speed") + 0.7 * number("closing_speed")).abs() < 1e-5);

        let at_point = |side: &str| vector(&it["unit_response"][side]["at_point"]);
        let change = number("fraction") * (dot(at_point("b"), normal) - dot(at_point("a"), normal));
        assert!((number("closing_speed") + change - number("separating_speed")).abs() < 1e-5);
        let momentum = |when: &str| {
            ["a", "b"].map(|side| {
                let mass = it["mass"][side].as_f64().expect("a mass");
                vector(&it[when][side]["linear"]).map(|speed| mass * speed)
            })
        };
        let (before, after) = (momentum("velocity_before"), momentum("velocity_after"));
        for axis in 0..3 {
            let change = after[0][axis] + after[1][axis] - before[0][axis] - before[1][axis];
            assert!(change.abs() < 1e-3, "{change}");
        }
        for law in ["separating_speed", "linear_momentum", "angular_momentum", "energy"] {
            assert_eq!(it["conditions"][law]["holds"], true, "{law}: {}", it["conditions"]);
        }
    }
}

#[test]
fn what_was_struck_at_once_is_told_with_the_laws_of_all_of_it() {
    let folder = Folder::new("at_once");
    let cuboid = |size: &str, more: &str| {
        format!(r#""colliders": [{{"shape": {{"type": "box", "size": {size}}}, "friction": 0, {more}}}]"#)
    };
    let scene = format!(
        r#"{{"carom": 1, "name": "flat", "bodies": [
            {{"name": "floor", "motion": "static", {}}},
            {{"name": "cube", "position": [0, 2.5, 0], "linear_velocity": [0.5, 0, 0], {}}}]}}"#,
        cuboid("[20, 2, 20]", r#""restitution": 0"#),
        cuboid("[1, 1, 1]", r#""restitution": 0.6"#)
    );
    folder.file("scene.json", scene);
    for number in 0..4 {
        let it = json(&folder.told(&["explain", "scene.json", "--collision", &number.to_string(), "--json"]));
        assert_eq!(it["together"]["contacts"], 4);
        assert_eq!(it["together"]["round"], 0);
        let others: Vec<u64> = (0..4).filter(|&other| other != number).collect();
        assert_eq!(it["together"]["others"], serde_json::json!(others));
        for law in ["separating_speed", "linear_momentum", "angular_momentum", "energy"] {
            assert_eq!(it["conditions"][law]["holds"], true, "{law}: {}", it["conditions"]);
        }
        let energy = |when: &str| it["conditions"]["energy"][when].as_f64().expect("a number");
        // 125 J across the fall stay as they are.
        let ratio = (energy("after") - 125.0) / (energy("before") - 125.0);
        assert!((ratio - 0.36).abs() < 1e-9, "{ratio}");
        let alone = -1.6 * it["closing_speed"].as_f64().expect("a number") / 4e-3;
        assert!(it["fraction"].as_f64().expect("a number") != alone);
    }
    let text = folder.told(&["explain", "scene.json"]);
    for part in
        ["AT THE SAME INSTANT: 4 contacts", "collision 3, floor and cube", "TOGETHER", "What floor took"]
    {
        assert!(text.contains(part), "no {part} in:\n{text}");
    }
    assert!(!text.contains('✗') && text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn what_can_not_move_has_no_mass_in_json() {
    let folder = Folder::new("infinite");
    folder.file("scene.json", bouncing());
    let it = json(&folder.told(&["explain", "scene.json", "--json"]));
    assert_eq!(it["mass"]["a"], Value::Null);
    assert_eq!(it["inverse_inertia"]["a"], json("[[0.0,0.0,0.0],[0.0,0.0,0.0],[0.0,0.0,0.0]]"));
    assert!(vector(&it["conditions"]["linear_momentum"]["to_world"])[1] < 0.0);
    let text = folder.told(&["explain", "scene.json"]);
    assert!(text.contains("infinite") && text.contains("What floor took"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
}

#[test]
fn collisions_are_found_by_number_and_by_name() {
    let folder = Folder::new("found");
    folder.file("scene.json", bouncing());
    let explained = |more: &[&str]| {
        let arguments: Vec<&str> = ["explain", "scene.json", "--json"].iter().chain(more).copied().collect();
        json(&folder.told(&arguments))
    };
    let (first, third) = (explained(&[]), explained(&["--collision", "2"]));
    assert_eq!(third["index"], 2);
    assert!(first["time"].as_f64() < third["time"].as_f64());
    assert_eq!(explained(&["--between", "ball", "floor"]), first);
    assert_eq!(explained(&["--between", "floor", "ball"]), first);
    let about = explained(&["--about", "-1,2.5,0"]);
    assert_eq!(vector(&about["reference_point"]), [-1.0, 2.5, 0.0]);
    assert_eq!(about["conditions"]["angular_momentum"]["holds"], true);

    let refused = |more: &[&str]| {
        let arguments: Vec<&str> =
            ["explain", "scene.json", "--seconds", "1"].iter().chain(more).copied().collect();
        folder.refused(&arguments, 2)
    };
    let complaint = refused(&["--collision", "7"]);
    assert!(complaint.contains("1 collision") && complaint.contains("`floor` and `ball` (1)"), "{complaint}");
    assert!(refused(&["--between", "flor", "ball"]).contains("did you mean `floor`"));
    refused(&["--between", "ball", "ball"]);
}

#[test]
fn a_verdict_is_one_json_object() {
    let folder = Folder::new("verdict");
    folder.file("scene.json", two_balls(r#""friction": 0.3, "restitution": 1"#));
    let verdict = json(&folder.told(&["check", "scene.json", "--json"]));
    assert_eq!(verdict["collisions"], 1);
    assert_eq!(verdict["violations"], json("[]"));
    for law in verdict["laws"].as_array().expect("a list") {
        assert!(law["worst"].is_null() == (law["checked"] == 0), "{law}");
        assert!(law["worst"]["error"].as_f64() <= law["worst"]["tolerance"].as_f64(), "{law}");
        assert!(law["says"].is_string() && law["tolerance_rule"].is_string());
        assert_eq!(law["violations"], 0);
    }
}

#[test]
fn an_output_that_can_not_be_written_is_status_three() {
    let folder = Folder::new("unwritable");
    let complaint = folder.refused(&["run", "off-centre-hit", "--trace", "nowhere/trace.jsonl"], 3);
    assert!(complaint.contains("nowhere/trace.jsonl"), "{complaint}");
    folder.refused(&["run", "off-centre-hit", "--trace", "."], 3);
    if cfg!(target_os = "linux") {
        folder.refused(&["run", "off-centre-hit", "--trace", "/dev/full"], 3);
    }
}

#[test]
fn a_reader_that_goes_away_ends_it_quietly() {
    let folder = Folder::new("closed_pipe");
    for arguments in [
        &["schema"][..],
        &["explain", "off-centre-hit"],
        &["run", "off-centre-hit", "--seconds", "100", "--trace", "/dev/stdout"],
    ] {
        if !cfg!(unix) {
            return;
        }
        let mut child = folder
            .command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        let mut line = String::new();
        let mut reader = BufReader::with_capacity(16, child.stdout.take().expect("a pipe"));
        reader.read_line(&mut line).expect("a line");
        drop(reader);
        let output = child.wait_with_output().expect("an end");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        assert_eq!(stderr(&output), "", "{arguments:?}");
    }
}

#[cfg(unix)]
#[test]
fn whoever_interrupts_it_finds_whole_lines() {
    let folder = Folder::new("interrupted");
    folder.file("scene.json", bouncing());
    let trace = folder.path("trace.jsonl");
    let mut child = folder
        .command(&["run", "scene.json", "--steps", "1000000000", "--trace", "trace.jsonl"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    while std::fs::metadata(&trace).map_or(0, |file| file.len()) < 1 << 20 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let pid = child.id().to_string();
    let sent = std::process::Command::new("kill").args(["-INT", &pid]).status().expect("kill");
    assert!(sent.success());
    let status = child.wait().expect("an end");
    assert_ne!(status.code(), Some(0));
    let content = std::fs::read_to_string(&trace).expect("a trace");
    assert!(content.ends_with("}\n"));
    json(content.lines().last().expect("lines"));
}
