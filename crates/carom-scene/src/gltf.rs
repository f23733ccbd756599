//! Scenes from glTF files with `KHR_physics_rigid_bodies` and `KHR_implicit_shapes` (drafts of October 2025).
//!
//! What the drafts leave open is settled so:
//!
//! - The frame of a body is its node's place and rotation in the world; the scale goes into the shapes
//!   ([`shapes`] says how). Where a node is sheared in the world, only meshes can follow; all else is refused.
//! - A geometry that names a node is that node's mesh in the node's own space, nodes below it included; the
//!   collider's node places and scales it ([`mesh`]).
//! - A linear velocity is that of the centre of mass; both velocities are turned from the node's axes to the
//!   world's and take no scale, the centre of mass takes the node's ([`motion`]).
//! - A body with a mass whose colliders enclose no volume weighs like a sheet, as everywhere in the engine; a note says so.
//! - Gravity and the length of a step are those of the JSON format, since glTF has neither.
//!
//! Bodies come in the order of their nodes' indices. Unknown keys inside the two extensions are refused; whatever
//! else is passed over leaves a line in [`Scene::notes`].

mod base64;
mod bodies;
mod buffers;
mod container;
mod frame;
mod graph;
mod json;
mod mesh;
mod motion;
mod shapes;
mod surface;

use crate::{Scene, SceneError};
use bodies::Builder;
use buffers::Buffers;
use carom::Body;
use graph::Graph;
use json::{At, Document};
use std::collections::{HashMap, HashSet};
use std::path::Path;
use surface::{PHYSICS, Tables};

/// The length of a step, s.
const DT: f64 = 1.0 / 60.0;

/// Reads a `.gltf` or `.glb` file, whose content is `bytes`. Paths of buffers are relative to `path`.
pub(crate) fn load(path: &Path, bytes: &[u8]) -> Result<Scene, SceneError> {
    let file = path.display().to_string();
    let named_glb = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb"));
    let container = container::open(&file, bytes, named_glb)?;
    let document = Document { root: At { file: &file, path: String::new(), value: &container.json } };
    let mut notes = Vec::new();
    check_asset(&document)?;
    note_extensions(&document, &mut notes)?;

    let shapes = shapes::read(&document, &mut notes)?;
    let tables = Tables::read(&document)?;
    let graph = Graph::read(&document)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut buffers = Buffers::new(&document, container.binary, folder)?;

    let scene = graph.scene()?;
    let order: Vec<usize> = scene.iter().map(|(node, _)| *node).collect();
    let frames: HashMap<usize, _> = scene.into_iter().collect();
    let builder = Builder {
        document: &document,
        graph: &graph,
        frames: &frames,
        shapes: &shapes,
        tables: &tables,
        buffers: &mut buffers,
        notes: &mut notes,
    };
    let bodies = name(&graph, bodies::build(builder, &order)?)?;
    if bodies.is_empty() {
        notes.push(format!("no node of the scene has {PHYSICS}: there is nothing to simulate"));
    }
    note_strangers(&graph, &order, &mut notes);
    note_animations(&document, &graph, &order, &mut notes)?;
    buffers.note_missing(&mut notes)?;
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Ok(Scene { name, settings: carom::Settings::default(), dt: DT, sleeping: false, bodies, notes })
}

/// Names each body after its node, in the order of the nodes; a name that is taken gets the node's index added.
fn name(graph: &Graph, bodies: Vec<(usize, Body)>) -> Result<Vec<Body>, SceneError> {
    let mut taken = HashSet::new();
    let mut named = Vec::with_capacity(bodies.len());
    for (node, mut body) in bodies {
        let name = graph.at(node).get("name")?.map_or(Ok(""), |name| name.text())?;
        body.name = if name.is_empty() { format!("node{node}") } else { name.to_owned() };
        while !taken.insert(body.name.clone()) {
            body.name = format!("{}#{node}", body.name);
        }
        named.push(body);
    }
    Ok(named)
}

fn check_asset(document: &Document) -> Result<(), SceneError> {
    let asset = document.root.get("asset")?.ok_or_else(|| {
        SceneError::invalid(document.root.file, "asset", "nothing", "the asset object of a glTF 2 file")
    })?;
    let version = asset.need("version", "the version of glTF, 2.0")?;
    if version.text()?.split('.').next() != Some("2") {
        return Err(version.error("version 2.0 of glTF"));
    }
    Ok(())
}

/// Notes the extensions that are no physics. One that a file requires and that sounds like physics is refused.
fn note_extensions(document: &Document, notes: &mut Vec<String>) -> Result<(), SceneError> {
    let mut seen = HashSet::from([PHYSICS, "KHR_implicit_shapes"]);
    for key in ["extensionsRequired", "extensionsUsed"] {
        let Some(list) = document.root.get(key)? else { continue };
        for at in list.items()? {
            let name = at.text()?;
            if !seen.insert(name) {
                continue;
            }
            let sounds = ["physics", "rigid", "collision", "collider"];
            let lower = name.to_ascii_lowercase();
            if key == "extensionsRequired" && sounds.iter().any(|sound| lower.contains(sound)) {
                return Err(at.error(format!("no other physics than {PHYSICS} and KHR_implicit_shapes")));
            }
            notes.push(format!("{key}: {name} was passed over"));
        }
    }
    Ok(())
}

/// Notes the nodes outside the scene that have physics.
fn note_strangers(graph: &Graph, order: &[usize], notes: &mut Vec<String>) {
    let inside: HashSet<usize> = order.iter().copied().collect();
    for node in (0..graph.len()).filter(|node| !inside.contains(node)) {
        if has_physics(&graph.at(node)) {
            notes.push(format!("nodes[{node}] is not part of the scene: its physics was passed over"));
        }
    }
}

fn has_physics(node: &At) -> bool {
    node.value.get("extensions").is_some_and(|extensions| extensions.get(PHYSICS).is_some())
}

/// Notes the animations of nodes that bodies or colliders stand on or below.
fn note_animations(
    document: &Document,
    graph: &Graph,
    order: &[usize],
    notes: &mut Vec<String>,
) -> Result<(), SceneError> {
    // Children come after their parents, so that one pass backwards tells all who carry physics.
    let mut carries = vec![false; graph.len()];
    for &node in order.iter().rev() {
        carries[node] |= has_physics(&graph.at(node));
        if let Some(parent) = graph.parent(node).filter(|_| carries[node]) {
            carries[parent] = true;
        }
    }
    for (index, value) in document.table("animations")?.iter().enumerate() {
        let animation = document.entry("animations", index, value);
        let Some(channels) = animation.get("channels")? else { continue };
        for channel in channels.items()? {
            let Some(target) = channel.dig(&["target", "node"])? else { continue };
            let (node, _) = document.follow(&target, "nodes")?;
            if carries[node] {
                notes.push(format!("{}: bodies don't follow the animation of nodes[{node}]", channel.path));
            }
        }
    }
    Ok(())
}
