//! Geometry that a node provides: the triangles of its mesh and of all nodes below it, as it stands in the file.
//!
//! The result is in the node's own space: its transform takes no part, those of the nodes below it do, relative to
//! it. Morph targets count with their default weights (the node's, else the mesh's), skins with the pose that
//! their joints have in the file.

use super::buffers::{Buffers, check_index_type};
use super::frame::Frame;
use super::graph::Graph;
use super::json::{At, Document};
use crate::SceneError;
use carom::math::{DMat3, DVec3};
use std::collections::HashMap;

/// Points and triangles.
#[derive(Default)]
pub(super) struct Surface {
    pub vertices: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Joins vertices at the same place, which exporters split for the sake of normals and textures, and drops
    /// the triangles that this leaves without an area.
    fn weld(&mut self) {
        let mut places: HashMap<[u64; 3], u32> = HashMap::with_capacity(self.vertices.len());
        let mut kept = Vec::new();
        let mut renamed = Vec::with_capacity(self.vertices.len());
        for vertex in &self.vertices {
            // Adding 0 makes −0 the same place as 0.
            let key = vertex.to_array().map(|x| (x + 0.0).to_bits());
            renamed.push(*places.entry(key).or_insert_with(|| {
                kept.push(*vertex);
                kept.len() as u32 - 1
            }));
        }
        self.vertices = kept;
        for triangle in &mut self.triangles {
            *triangle = triangle.map(|corner| renamed[corner as usize]);
        }
        self.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    }

    /// The points under a linear map; a map that mirrors turns the triangles round, so that they still face outwards.
    pub fn mapped(&self, linear: &DMat3) -> Surface {
        let vertices = self.vertices.iter().map(|vertex| *linear * *vertex).collect();
        let mirrors = linear.determinant() < 0.0;
        let turn = |&[a, b, c]: &[u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
        Surface { vertices, triangles: self.triangles.iter().map(turn).collect() }
    }
}

/// What a node does to the vertices of its mesh.
struct Bend {
    /// How far each morph target counts.
    weights: Vec<f64>,
    /// The node in the space of the geometry.
    frame: Frame,
    /// The joints' maps, which go before the frame.
    skin: Option<Vec<Frame>>,
}

/// What is needed to read meshes.
pub(super) struct Reader<'a, 'b> {
    pub document: &'b Document<'a>,
    pub graph: &'b Graph<'a>,
    pub buffers: &'b mut Buffers<'a>,
    pub notes: &'b mut Vec<String>,
}

impl<'a> Reader<'a, '_> {
    /// The surface of node `root` and all below it.
    pub fn surface(&mut self, root: usize) -> Result<Surface, SceneError> {
        let mut surface = Surface::default();
        for (node, frame) in self.graph.below(root)? {
            let at = self.graph.at(node);
            let Some(index) = at.get("mesh")? else { continue };
            let (_, mesh) = self.document.follow(&index, "meshes")?;
            let weights = match at.get("weights")? {
                Some(weights) => Some(weights),
                None => mesh.get("weights")?,
            };
            let weights = match weights {
                Some(weights) => weights.items()?.iter().map(At::number).collect::<Result<Vec<_>, _>>()?,
                None => Vec::new(),
            };
            let skin = at.get("skin")?.map(|skin| self.skin(&skin, node, &frame)).transpose()?;
            let bend = Bend { weights, frame, skin };
            for primitive in mesh.need("primitives", "a list of primitives")?.items()? {
                self.primitive(&primitive, &bend, &mut surface)?;
            }
        }
        surface.weld();
        Ok(surface)
    }

    fn primitive(
        &mut self,
        primitive: &At<'a>,
        bend: &Bend,
        surface: &mut Surface,
    ) -> Result<(), SceneError> {
        let mode = match primitive.get("mode")? {
            None => 4,
            Some(mode) => match mode.count()? {
                number if number <= 6 => number,
                _ => return Err(mode.error("a mode from 0 to 6")),
            },
        };
        if mode < 4 {
            self.notes
                .push(format!("{}: points and lines have no surface and were passed over", primitive.path));
            return Ok(());
        }
        let attributes = primitive.need("attributes", "the attributes of the vertices")?;
        let positions = attributes.need("POSITION", "an index into accessors")?;
        let (_, accessor) = self.document.follow(&positions, "accessors")?;
        let mut points = vectors(&self.buffers.numbers(&accessor, "VEC3", 3)?);
        self.morph(primitive, &bend.weights, &mut points)?;
        let frame = &bend.frame;
        match &bend.skin {
            Some(joints) => self.deform(&attributes, joints, &mut points)?,
            None => points.iter_mut().for_each(|point| *point = frame.linear * *point + frame.position),
        }
        let corners = match primitive.get("indices")? {
            Some(indices) => self.indices(&indices, points.len())?,
            None => (0..points.len() as u32).collect(),
        };
        if mode == 4 && corners.len() % 3 != 0 {
            let found = format!("{} corners", corners.len());
            return Err(primitive.refused(found, "triangles of three corners each"));
        }
        let base = surface.vertices.len();
        if base + points.len() > u32::MAX as usize {
            return Err(primitive.refused(base + points.len(), "at most 4294967295 vertices in a geometry"));
        }
        surface.vertices.append(&mut points);
        let base = base as u32;
        // A node that mirrors would turn its triangles to face inwards. A skin's vertices follow the joints instead.
        let mirrors = bend.skin.is_none() && frame.linear.determinant() < 0.0;
        let mut add = |a: u32, b: u32, c: u32| {
            let (b, c) = if mirrors { (c, b) } else { (b, c) };
            surface.triangles.push([base + a, base + b, base + c]);
        };
        match mode {
            4 => corners.chunks_exact(3).for_each(|t| add(t[0], t[1], t[2])),
            // Every second triangle of a strip runs the other way round.
            5 => corners
                .windows(3)
                .enumerate()
                .for_each(|(i, t)| if i % 2 == 0 { add(t[0], t[1], t[2]) } else { add(t[1], t[0], t[2]) }),
            _ => corners.windows(2).skip(1).for_each(|t| add(corners[0], t[0], t[1])),
        }
        Ok(())
    }

    fn indices(&mut self, indices: &At<'a>, vertices: usize) -> Result<Vec<u32>, SceneError> {
        let (_, accessor) = self.document.follow(indices, "accessors")?;
        check_index_type(&accessor)?;
        let corners: Vec<u32> =
            self.buffers.numbers(&accessor, "SCALAR", 1)?.iter().map(|&corner| corner as u32).collect();
        match corners.iter().find(|&&corner| corner as usize >= vertices) {
            Some(corner) => Err(accessor.refused(
                format!("the index {corner}"),
                format!("indices below the {vertices} vertices of the primitive"),
            )),
            None => Ok(corners),
        }
    }

    /// Adds the morph targets' displacements, each times its weight.
    fn morph(&mut self, primitive: &At<'a>, weights: &[f64], points: &mut [DVec3]) -> Result<(), SceneError> {
        let Some(targets) = primitive.get("targets")? else { return Ok(()) };
        for (target, &weight) in targets.items()?.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let Some(position) = target.get("POSITION")? else { continue };
            let (_, accessor) = self.document.follow(&position, "accessors")?;
            let moves = vectors(&self.buffers.numbers(&accessor, "VEC3", 3)?);
            if moves.len() != points.len() {
                return Err(accessor.refused(
                    format!("{} elements", moves.len()),
                    format!("one for each of the {} vertices", points.len()),
                ));
            }
            points.iter_mut().zip(moves).for_each(|(point, by)| *point += weight * by);
        }
        Ok(())
    }

    /// For each joint of a skin the map from the mesh's vertices, in bind pose, to the space of the geometry:
    /// `geometry⁻¹ · joint · bind⁻¹`, which for a joint below the geometry's node is its frame relative to it.
    fn skin(&mut self, skin: &At<'a>, node: usize, frame: &Frame) -> Result<Vec<Frame>, SceneError> {
        let (_, skin) = self.document.follow(skin, "skins")?;
        let joints = skin.need("joints", "the nodes that are the skin's joints")?.items()?;
        let mut binds = match skin.get("inverseBindMatrices")? {
            Some(index) => {
                let (_, accessor) = self.document.follow(&index, "accessors")?;
                let numbers = self.buffers.numbers(&accessor, "MAT4", 16)?;
                if numbers.len() < 16 * joints.len() {
                    let found = format!("{} matrices", numbers.len() / 16);
                    return Err(
                        accessor.refused(found, format!("one for each of the {} joints", joints.len()))
                    );
                }
                numbers.chunks_exact(16).map(affine).collect()
            }
            None => vec![Frame::IDENTITY; joints.len()],
        };
        // The mesh's node cancels: vertices follow the joints alone. `frame` leads from that node to the geometry.
        let from_world = inverse(&self.graph.world(node)?).ok_or_else(|| {
            let at = self.graph.at(node);
            at.refused("a transform without inverse", "a scale other than 0 for a node with a skin")
        })?;
        let from_world = compose(frame, &from_world);
        for (joint, bind) in joints.iter().zip(&mut binds) {
            let (joint, _) = self.document.follow(joint, "nodes")?;
            *bind = compose(&compose(&from_world, &self.graph.world(joint)?), bind);
        }
        binds.truncate(joints.len());
        Ok(binds)
    }

    /// Moves each vertex by the weighted mean of its joints' maps.
    fn deform(
        &mut self,
        attributes: &At<'a>,
        joints: &[Frame],
        points: &mut [DVec3],
    ) -> Result<(), SceneError> {
        let mut moved = vec![DVec3::ZERO; points.len()];
        for set in 0.. {
            let (names, shares) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let Some(names) = attributes.get(&names)? else { break };
            let shares = attributes.need(&shares, "an index into accessors")?;
            let (_, names) = self.document.follow(&names, "accessors")?;
            let (_, shares) = self.document.follow(&shares, "accessors")?;
            let which = self.buffers.numbers(&names, "VEC4", 4)?;
            let share = self.buffers.numbers(&shares, "VEC4", 4)?;
            if which.len() != 4 * points.len() || share.len() != which.len() {
                return Err(names.refused(
                    format!("{} elements", which.len() / 4),
                    format!("joints and weights for each of the {} vertices", points.len()),
                ));
            }
            for (i, (which, share)) in
                which.iter().zip(share).enumerate().filter(|(_, (_, share))| *share != 0.0)
            {
                let Some(joint) = joints.get(*which as usize) else {
                    let found = format!("the joint {which}");
                    return Err(names.refused(found, format!("one of the skin's {} joints", joints.len())));
                };
                moved[i / 4] += share * (joint.linear * points[i / 4] + joint.position);
            }
        }
        points.copy_from_slice(&moved);
        Ok(())
    }
}

fn vectors(numbers: &[f64]) -> Vec<DVec3> {
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

/// The affine part of a 4 × 4 matrix, listed by columns. Its rotation is not asked for here.
fn affine(m: &[f64]) -> Frame {
    let linear = DMat3::from_cols_array(&[m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]]);
    Frame { linear, position: DVec3::new(m[12], m[13], m[14]), ..Frame::IDENTITY }
}

fn compose(outer: &Frame, inner: &Frame) -> Frame {
    let position = outer.linear * inner.position + outer.position;
    Frame { linear: outer.linear * inner.linear, position, ..Frame::IDENTITY }
}

fn inverse(frame: &Frame) -> Option<Frame> {
    let determinant = frame.linear.determinant();
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    let linear = frame.linear.inverse();
    Some(Frame { linear, position: -(linear * frame.position), ..Frame::IDENTITY })
}
