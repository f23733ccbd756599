//! Joints.

use super::cursor::Cursor;
use crate::SceneError;

/// Refuses every joint: the engine has none yet.
pub(super) fn read(joints: &Cursor<'_>) -> Result<(), SceneError> {
    match joints.list("joints")?.next() {
        None => Ok(()),
        Some(joint) => {
            let tag = joint.object()?.require("type", "the type of the joint")?;
            Err(tag.refuse("a scene without joints; joints are not built yet"))
        }
    }
}
