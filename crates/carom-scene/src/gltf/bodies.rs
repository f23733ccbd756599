//! From nodes to bodies.
//!
//! A node with `motion` is a body; colliders and triggers belong to the nearest motion at or above their node.
//! Without one, the node is a static body of its own. A compound trigger (`nodes`) without a motion above it is
//! one static body, which its parts belong to.

use super::buffers::Buffers;
use super::frame::Frame;
use super::graph::Graph;
use super::json::{At, Document};
use super::mesh::{Reader, Surface};
use super::motion;
use super::shapes::Implicit;
use super::surface::{PHYSICS, Tables};
use crate::SceneError;
use carom::math::{DVec3, Pose};
use carom::{Body, Collider, Invalid, Shape};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// The most bodies that a scene may have.
const MOST_BODIES: usize = 10_000_000;

/// What a node's extension says, and which body it says it of.
struct Part<'a> {
    node: usize,
    collider: Option<At<'a>>,
    trigger: Option<At<'a>>,
}

/// A body before it is built.
#[derive(Default)]
struct Draft<'a> {
    motion: Option<At<'a>>,
    parts: Vec<Part<'a>>,
}

/// What building bodies takes.
pub(super) struct Builder<'a, 'b> {
    pub document: &'b Document<'a>,
    pub graph: &'b Graph<'a>,
    pub frames: &'b HashMap<usize, Frame>,
    pub shapes: &'b [Implicit<'a>],
    pub tables: &'b Tables,
    pub buffers: &'b mut Buffers<'a>,
    pub notes: &'b mut Vec<String>,
}

/// The bodies of the nodes in `order` (parents first), each with the node that it stands for, by that node's index.
pub(super) fn build<'a>(
    mut builder: Builder<'a, '_>,
    order: &[usize],
) -> Result<Vec<(usize, Body)>, SceneError> {
    let drafts = builder.drafts(order)?;
    if drafts.len() > MOST_BODIES {
        let found = format!("{} bodies", drafts.len());
        return Err(SceneError::invalid(
            builder.document.root.file,
            "nodes",
            found,
            "at most 10 million bodies",
        ));
    }
    let mut meshes = Meshes::default();
    let mut bodies = Vec::with_capacity(drafts.len());
    for (node, draft) in drafts {
        if let Some(body) = builder.body(node, &draft, &mut meshes)? {
            bodies.push((node, body));
        }
    }
    Ok(bodies)
}

/// Surfaces and shapes that were read already: many colliders may share one.
#[derive(Default)]
struct Meshes {
    surfaces: HashMap<usize, Arc<Surface>>,
    shapes: HashMap<(usize, bool, [u64; 9]), Shape>,
}

impl<'a> Builder<'a, '_> {
    fn drafts(&mut self, order: &[usize]) -> Result<BTreeMap<usize, Draft<'a>>, SceneError> {
        let mut drafts: BTreeMap<usize, Draft<'a>> = BTreeMap::new();
        let mut movers: HashMap<usize, usize> = HashMap::new();
        let mut compounds: HashMap<usize, usize> = HashMap::new();
        for &node in order {
            let mut mover = self.graph.parent(node).and_then(|parent| movers.get(&parent).copied());
            if let Some(physics) = self.graph.at(node).dig(&["extensions", PHYSICS])? {
                physics.only(&["motion", "collider", "trigger", "joint"])?;
                if let Some(joint) = physics.get("joint")? {
                    return Err(joint.refused("a joint", "no joint: joints are not built yet"));
                }
                if let Some(motion) = physics.get("motion")? {
                    mover = Some(node);
                    drafts.entry(node).or_default().motion = Some(motion);
                }
                let (collider, trigger) = (physics.get("collider")?, physics.get("trigger")?);
                if let Some(members) = trigger.as_ref().map(|at| self.members(node, at)).transpose()? {
                    let whole = compounds.get(&node).copied().unwrap_or(node);
                    members.into_iter().for_each(|member| _ = compounds.entry(member).or_insert(whole));
                }
                if collider.is_some() || trigger.is_some() {
                    // A collider that shares its node with a part of a compound keeps a body of its own.
                    let compound = compounds.get(&node).copied().filter(|_| collider.is_none());
                    let owner = mover.or(compound).unwrap_or(node);
                    drafts.entry(owner).or_default().parts.push(Part { node, collider, trigger });
                }
            }
            if let Some(mover) = mover {
                movers.insert(node, mover);
            }
        }
        Ok(drafts)
    }

    /// The nodes of a compound trigger: below the trigger's own node, each with a trigger.
    fn members(&self, node: usize, trigger: &At<'a>) -> Result<Vec<usize>, SceneError> {
        trigger.only(&["geometry", "nodes", "collisionFilter"])?;
        let Some(nodes) = trigger.get("nodes")? else { return Ok(Vec::new()) };
        for key in ["geometry", "collisionFilter"] {
            if let Some(at) = trigger.get(key)? {
                return Err(at.error("no such key beside nodes"));
            }
        }
        let below: HashSet<usize> = self.graph.below(node)?.iter().map(|(member, _)| *member).collect();
        let mut members = Vec::new();
        for at in nodes.items()? {
            let (member, value) = self.document.follow(&at, "nodes")?;
            let has_trigger = value.dig(&["extensions", PHYSICS, "trigger"])?.is_some();
            if member == node || !below.contains(&member) || !has_trigger {
                return Err(at.error(format!("a node with a trigger below nodes[{node}]")));
            }
            if members.contains(&member) {
                return Err(at.error("each node once"));
            }
            members.push(member);
        }
        Ok(members)
    }

    /// The body of a draft; nothing for a static one whose colliders are all switched off.
    fn body(
        &mut self,
        node: usize,
        draft: &Draft<'a>,
        meshes: &mut Meshes,
    ) -> Result<Option<Body>, SceneError> {
        let frame = self.frames[&node];
        self.graph.check_place(node, &frame)?;
        let mut body = match &draft.motion {
            Some(motion) => motion::body(motion, &frame, self.notes)?,
            None => Body::fixed(),
        };
        body.position = frame.position;
        body.rotation = frame.rotation.as_quat().normalize();
        let mut places = Vec::new();
        for part in &draft.parts {
            let pose = self.pose(node, part.node)?;
            for (at, sensor) in [(&part.collider, false), (&part.trigger, true)] {
                let Some(at) = at else { continue };
                if let Some(collider) = self.collider(at, sensor, part.node, meshes)? {
                    body.colliders.push(Collider { pose, ..collider });
                    places.push(at);
                }
            }
        }
        let Some(motion) = &draft.motion else {
            return match body.check() {
                _ if body.colliders.is_empty() => Ok(None),
                Ok(()) => Ok(Some(body)),
                Err(error) => Err(blame(error, &self.graph.at(node), &places)),
            };
        };
        if body.motion == carom::Motion::Dynamic {
            motion::complete_mass(&mut body, motion)?;
            let is_sheet = body.mass.is_some_and(|mass| mass > 0.0)
                && body.inertia.is_none()
                && body.collider_mass().mass <= 0.0;
            if is_sheet {
                let note = "the colliders enclose no volume, so the mass is spread over their surface";
                self.notes.push(format!("{}: {note}", motion.path));
            }
        }
        match body.check() {
            Ok(()) => Ok(Some(body)),
            Err(error) => Err(blame(error, motion, &places)),
        }
    }

    /// Where node `part` sits in the frame of body `node`.
    fn pose(&self, node: usize, part: usize) -> Result<Pose, SceneError> {
        if node == part {
            return Ok(Pose::IDENTITY);
        }
        let outer = self.frames[&part];
        self.graph.check_place(part, &outer)?;
        let pose = self.frames[&node].pose().relative(&outer.pose());
        Ok(Pose::new(pose.position, pose.rotation.normalize()))
    }

    /// A collider or a trigger at the origin of its node; nothing where a scale of zero switches it off, and
    /// nothing for a compound trigger, whose parts speak for themselves.
    fn collider(
        &mut self,
        at: &At<'a>,
        sensor: bool,
        node: usize,
        meshes: &mut Meshes,
    ) -> Result<Option<Collider>, SceneError> {
        if sensor {
            at.only(&["geometry", "nodes", "collisionFilter"])?;
            if at.has("nodes") {
                return Ok(None);
            }
        } else {
            at.only(&["geometry", "physicsMaterial", "collisionFilter"])?;
        }
        let geometry = at.need("geometry", "a geometry")?;
        let shape = self.shape(&geometry, node, meshes)?;
        let mut collider = match shape {
            Some(shape) => Collider::new(shape),
            None => {
                self.notes.push(format!("{} is switched off by its node's scale of zero", at.path));
                return Ok(None);
            }
        };
        collider.sensor = sensor;
        if let Some(index) = at.get("physicsMaterial")? {
            let index = self.document.index(&index, self.tables.materials.len(), "physicsMaterials")?;
            collider.material = self.tables.materials[index];
        }
        if let Some(index) = at.get("collisionFilter")? {
            let index = self.document.index(&index, self.tables.filters.len(), "collisionFilters")?;
            collider.filter = self.tables.filters[index].clone();
        }
        Ok(Some(collider))
    }

    fn shape(
        &mut self,
        geometry: &At<'a>,
        node: usize,
        meshes: &mut Meshes,
    ) -> Result<Option<Shape>, SceneError> {
        geometry.only(&["convexHull", "shape", "node"])?;
        let convex = geometry.get("convexHull")?.map_or(Ok(false), |at| at.boolean())?;
        let frame = self.frames[&node];
        let off = frame.scale() == Some(DVec3::ZERO);
        match (geometry.get("shape")?, geometry.get("node")?) {
            (Some(index), None) => {
                let index = self.document.index(&index, self.shapes.len(), "shapes")?;
                let Some(scale) = frame.scale() else {
                    let at = self.graph.at(node);
                    return Err(at.refused(
                        "a sheared transform",
                        "perpendicular axes in the world, which a shape can follow (or a mesh as geometry)",
                    ));
                };
                if off {
                    return Ok(None);
                }
                self.shapes[index].scaled(scale, &self.graph.at(node), self.notes).map(Some)
            }
            (None, Some(index)) => {
                let (source, _) = self.document.follow(&index, "nodes")?;
                if off {
                    return Ok(None);
                }
                self.mesh(geometry, source, convex, (&frame, meshes)).map(Some)
            }
            _ => Err(geometry.error("either a shape or a node")),
        }
    }

    /// The geometry of node `source` in the space of a collider's node, whose frame is given.
    fn mesh(
        &mut self,
        geometry: &At<'a>,
        source: usize,
        convex: bool,
        (frame, meshes): (&Frame, &mut Meshes),
    ) -> Result<Shape, SceneError> {
        let stretch = frame.stretch();
        let key = (source, convex, stretch.to_cols_array().map(f64::to_bits));
        if let Some(shape) = meshes.shapes.get(&key) {
            return Ok(shape.clone());
        }
        let surface = match meshes.surfaces.get(&source) {
            Some(surface) => surface.clone(),
            None => {
                let mut reader = Reader {
                    document: self.document,
                    graph: self.graph,
                    buffers: self.buffers,
                    notes: self.notes,
                };
                let surface = Arc::new(reader.surface(source)?);
                meshes.surfaces.insert(source, surface.clone());
                surface
            }
        };
        if surface.triangles.is_empty() {
            let found = format!("nodes[{source}] without triangles");
            return Err(geometry.refused(found, "a node with a mesh, of its own or below it"));
        }
        let Surface { vertices, triangles } = surface.mapped(&stretch);
        let shape = if convex { Shape::hull(&vertices) } else { Shape::mesh(vertices, triangles) };
        let shape = shape.map_err(|error| geometry.engine(error))?;
        meshes.shapes.insert(key, shape.clone());
        Ok(shape)
    }
}

/// Finds the place in the file for what the engine says of a body: `whole` stands for the body, `places` for its
/// colliders.
fn blame(error: Invalid, whole: &At, places: &[&At]) -> SceneError {
    let expected = error.expected.replace("inertia_diagonal", "inertiaDiagonal");
    let error = Invalid { expected, ..error };
    let collider = error.field.strip_prefix("colliders[").and_then(|rest| rest.split_once(']'));
    if let Some((index, rest)) = collider
        && let Some(place) = index.parse().ok().and_then(|index: usize| places.get(index))
    {
        let field = rest.trim_start_matches('.').to_owned();
        let inner = if field.starts_with("shape") { ".geometry" } else { "" };
        let place = At { path: format!("{}{inner}", place.path), ..(*place).clone() };
        return place.engine(Invalid { field, ..error });
    }
    match motion::key_of(&error.field) {
        Some(key) => {
            let path = format!("{}.{key}", whole.path);
            SceneError::invalid(whole.file, path, error.value, error.expected)
        }
        None => whole.engine(error),
    }
}
