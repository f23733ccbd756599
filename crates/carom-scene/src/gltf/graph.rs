//! The nodes of a file: who stands below whom, and where they are.
//!
//! Everything here runs in loops over lists, not in recursion: a chain of a hundred thousand nodes is a valid file.

use super::frame::Frame;
use super::json::{At, Document};
use crate::SceneError;
use carom::limits;
use serde_json::Value;

/// The forest of nodes.
pub(super) struct Graph<'a> {
    document: Document<'a>,
    values: &'a [Value],
    children: Vec<Vec<usize>>,
    parents: Vec<Option<usize>>,
}

impl<'a> Graph<'a> {
    /// Reads who stands below whom; a node has one parent at most, and none is below itself.
    pub fn read(document: &Document<'a>) -> Result<Self, SceneError> {
        let values = document.table("nodes")?;
        let mut graph = Graph {
            document: document.clone(),
            values,
            children: vec![Vec::new(); values.len()],
            parents: vec![None; values.len()],
        };
        for node in 0..values.len() {
            let Some(children) = graph.at(node).get("children")? else { continue };
            for at in children.items()? {
                let child = document.index(&at, values.len(), "nodes")?;
                if let Some(parent) = graph.parents[child].replace(node) {
                    return Err(at.error(format!("a node without another parent (nodes[{parent}] has it)")));
                }
                graph.children[node].push(child);
            }
        }
        // What no root leads to is a ring, or hangs on one.
        let mut reached = vec![false; values.len()];
        let mut next: Vec<usize> = (0..values.len()).filter(|&node| graph.parents[node].is_none()).collect();
        while let Some(node) = next.pop() {
            reached[node] = true;
            next.extend(&graph.children[node]);
        }
        match reached.iter().position(|reached| !reached) {
            Some(node) => {
                let at = SceneError::invalid(
                    document.root.file,
                    format!("nodes[{node}].children"),
                    "a ring of nodes",
                    "nodes of which none is below itself",
                );
                Err(at)
            }
            None => Ok(graph),
        }
    }

    /// How many nodes there are.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// A node's place in the file.
    pub fn at(&self, node: usize) -> At<'a> {
        self.document.entry("nodes", node, &self.values[node])
    }

    /// The node above.
    pub fn parent(&self, node: usize) -> Option<usize> {
        self.parents[node]
    }

    /// The nodes of the scene to load, parents before their children, each with its frame in the world.
    ///
    /// That is the default scene, or the first one if none is named, or all nodes of a file without scenes.
    pub fn scene(&self) -> Result<Vec<(usize, Frame)>, SceneError> {
        let scenes = self.document.table("scenes")?;
        let scene = match self.document.root.get("scene")? {
            Some(index) => Some(self.document.follow(&index, "scenes")?.1),
            None => scenes.first().map(|value| self.document.entry("scenes", 0, value)),
        };
        let mut roots = Vec::new();
        match scene {
            None => roots.extend((0..self.len()).filter(|&node| self.parents[node].is_none())),
            Some(scene) => {
                let mut listed = vec![false; self.len()];
                let nodes = scene.get("nodes")?.map_or(Ok(Vec::new()), |nodes| nodes.items())?;
                for at in nodes {
                    let node = self.document.index(&at, self.len(), "nodes")?;
                    if let Some(parent) = self.parents[node] {
                        return Err(at.error(format!("a node without a parent (nodes[{parent}] has it)")));
                    }
                    if std::mem::replace(&mut listed[node], true) {
                        return Err(at.error("each node once"));
                    }
                    roots.push(node);
                }
            }
        }
        self.walk(
            roots
                .into_iter()
                .map(|root| Ok((root, Frame::read(&self.at(root))?)))
                .collect::<Result<_, _>>()?,
        )
    }

    /// Node `root` and all below it, each with its frame relative to `root`.
    pub fn below(&self, root: usize) -> Result<Vec<(usize, Frame)>, SceneError> {
        self.walk(vec![(root, Frame::IDENTITY)])
    }

    fn walk(&self, mut next: Vec<(usize, Frame)>) -> Result<Vec<(usize, Frame)>, SceneError> {
        next.reverse();
        let mut found = Vec::new();
        while let Some((node, frame)) = next.pop() {
            for &child in self.children[node].iter().rev() {
                next.push((child, frame.child(&Frame::read(&self.at(child))?)));
            }
            found.push((node, frame));
        }
        Ok(found)
    }

    /// A node's frame relative to the root above it.
    pub fn world(&self, node: usize) -> Result<Frame, SceneError> {
        let mut line = vec![node];
        while let Some(parent) = self.parents[line[line.len() - 1]] {
            line.push(parent);
        }
        let mut frame = Frame::IDENTITY;
        for node in line.into_iter().rev() {
            frame = frame.child(&Frame::read(&self.at(node))?);
        }
        Ok(frame)
    }

    /// Refuses a node too far out, or one whose frame is not finite.
    pub fn check_place(&self, node: usize, frame: &Frame) -> Result<(), SceneError> {
        let near = frame.position.to_array().iter().all(|x| x.abs() <= limits::POSITION);
        if !near || !frame.linear.is_finite() {
            let at = self.at(node);
            return Err(at.refused(
                format!("world position {}", frame.position),
                format!("a position within {:e} m and a finite scale", limits::POSITION),
            ));
        }
        Ok(())
    }
}
