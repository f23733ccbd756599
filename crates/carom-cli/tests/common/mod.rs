//! Runs the program, in a folder of its own for each test.
#![allow(dead_code, reason = "no test uses all of it")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder that is empty at the start.
pub struct Folder(PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder for temporary files");
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a temporary file");
        path
    }

    /// `carom` in this folder, ready to run.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carom"));
        command.current_dir(&self.0).args(arguments);
        command
    }

    pub fn carom(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().expect("the program starts")
    }

    /// What `carom` prints where all is well.
    pub fn told(&self, arguments: &[&str]) -> String {
        let output = self.carom(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", stderr(&output));
        stdout(&output)
    }

    /// The only line of complaint of a command that ends with `status`.
    pub fn refused(&self, arguments: &[&str], status: i32) -> String {
        let output = self.carom(arguments);
        let complaint = stderr(&output);
        assert_eq!(output.status.code(), Some(status), "{arguments:?}: {complaint}");
        assert_eq!(complaint.lines().count(), 1, "{arguments:?}: {complaint}");
        assert!(complaint.starts_with("carom: "), "{arguments:?}: {complaint}");
        assert!(!complaint.contains("panicked") && !complaint.contains("mistake"), "{complaint}");
        assert!(output.stdout.is_empty(), "{arguments:?}: {}", stdout(&output));
        complaint
    }
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

/// Two balls on a line without gravity, the first one rolling into the second, with these surfaces.
pub fn two_balls(surface: &str) -> String {
    let collider = format!(r#"{{"shape": {{"type": "sphere", "radius": 0.5}}, {surface}}}"#);
    format!(
        r#"{{"carom": 1, "name": "two balls", "gravity": [0, 0, 0], "bodies": [
            {{"name": "left", "linear_velocity": [2, 0, 0], "angular_velocity": [0, 1, 3],
              "colliders": [{collider}]}},
            {{"name": "right", "position": [3, 0.3, 0], "colliders": [{collider}]}}]}}"#
    )
}

/// A ball that bounces on a floor.
pub fn bouncing() -> String {
    r#"{"carom": 1, "name": "bouncing", "bodies": [
        {"name": "floor", "motion": "static", "colliders": [
            {"shape": {"type": "box", "size": [20, 1, 20]}, "position": [0, -0.5, 0]}]},
        {"name": "ball", "position": [0.1, 1.5, 0], "angular_velocity": [0, 0, 3], "colliders": [
            {"shape": {"type": "sphere", "radius": 0.5}, "restitution": 0.8}]}]}"#
        .to_owned()
}
