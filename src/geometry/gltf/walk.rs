//! From the scene's roots down: transforms, instances, triangles. A node is visited once, so a cycle
//! ends in an error and not in a loop.

use glam::{DMat3, DMat4, DQuat, DVec3, DVec4};
use gltf::json;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::accessor::Buffers;
use super::lights::Lights;
use super::repeated::drop_repeated;
use super::{GltfError, Imported, ImportedMaterial, ImportedNode, is_degenerate};
use crate::geometry::mesh::Triangle;

/// More triangles or vertices than a world may have.
const MAX_ELEMENTS: usize = 100_000_000;
/// Deeper hierarchies than any CAD program writes; paths grow with the square of it.
const MAX_DEPTH: usize = 256;

/// State of the walk.
pub(super) struct Walk<'a> {
    root: &'a json::Root,
    lights: &'a Lights,
    buffers: Buffers<'a>,
    default_material: Option<usize>,
    skipped: usize,
    cut: usize,
    visited: Vec<bool>,
}

impl<'a> Walk<'a> {
    /// Nothing visited yet.
    pub(super) fn new(root: &'a json::Root, buffers: Buffers<'a>, lights: &'a Lights) -> Self {
        Self {
            root,
            lights,
            buffers,
            default_material: None,
            skipped: 0,
            cut: 0,
            visited: vec![false; root.nodes.len()],
        }
    }

    /// Bakes every node of the scene into the mesh.
    pub(super) fn run(mut self, out: &mut Imported) -> Result<(), GltfError> {
        let index = self.root.scene.map_or(0, |scene| scene.value());
        let scene = self.root.scenes.get(index).ok_or_else(|| {
            GltfError::NoScene(match self.root.scene {
                Some(_) => format!("scene {index} does not exist"),
                None => "the file has no scene".to_owned(),
            })
        })?;
        if scene.nodes.is_empty() {
            return Err(GltfError::NoScene(format!("scene {index} has no root nodes")));
        }
        if self.root.scene.is_none() && self.root.scenes.len() > 1 {
            out.biases.push("the file names no default scene; its first one was read".to_owned());
        }
        let children = |node: &json::Node| node.children.clone().unwrap_or_default();
        for (index, node) in self.root.nodes.iter().enumerate() {
            if let Some(child) = children(node).iter().find(|c| scene.nodes.contains(c)) {
                let (parent, child) = (self.name_of(node, index), child.value());
                let name = self.root.nodes.get(child).map(|node| self.name_of(node, child));
                return Err(GltfError::NotRoot { node: name.unwrap_or_default(), parent });
            }
        }
        let z_up = DMat4::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y));
        let mut stack: Vec<(usize, Option<usize>, DMat4, usize)> =
            scene.nodes.iter().rev().map(|node| (node.value(), None, z_up, 1)).collect();
        while let Some((index, parent, world_from_parent, depth)) = stack.pop() {
            let user =
                parent.map_or("the scene".to_owned(), |p: usize| format!("node \"{}\"", out.nodes[p].name));
            let node = self
                .root
                .nodes
                .get(index)
                .ok_or_else(|| GltfError::Reference { from: user, to: format!("node {index}") })?;
            let name = self.name_of(node, index);
            if std::mem::replace(&mut self.visited[index], true) {
                return Err(GltfError::Cycle(name));
            }
            if depth > MAX_DEPTH {
                return Err(GltfError::TooDeep(name));
            }
            let world_from_node = world_from_parent * transform(node);
            let last_row_error = (world_from_node.row(3) - DVec4::W).length();
            if !(world_from_node.is_finite() && last_row_error < 1e-6) {
                return Err(GltfError::Transform(name));
            }
            let path = parent.map_or(name.clone(), |p| format!("{}/{name}", out.nodes[p].path));
            let mut view = |index: usize| self.buffers.view(index, &name);
            out.lights.extend(self.lights.at(index, &name, world_from_node, &mut view));
            let own = out.nodes.len();
            out.nodes.push(ImportedNode { name, path, parent, surfaces: Vec::new() });
            if let Some(mesh) = node.mesh {
                self.bake(mesh.value(), own, world_from_node, out)?;
            }
            for child in node.children.iter().flatten().rev() {
                stack.push((child.value(), Some(own), world_from_node, depth + 1));
            }
        }
        // Children come after their parents, so one backward pass hands every surface up to the root.
        for index in (0..out.nodes.len()).rev() {
            if let Some(parent) = out.nodes[index].parent {
                let below = out.nodes[index].surfaces.clone();
                out.nodes[parent].surfaces.extend(below);
            }
        }
        for node in &mut out.nodes {
            node.surfaces.sort_unstable();
        }
        let repeated = drop_repeated(&mut out.mesh);
        let mut say = |count: usize, what: &str| {
            if count > 0 {
                out.biases.push(format!("{count} {what}"));
            }
        };
        say(self.skipped, "primitives of points or lines were ignored");
        say(self.cut, "primitives end in an incomplete triangle");
        say(out.degenerate, "triangles without area were dropped");
        say(repeated, "triangles repeat another one of their surface (double-sided faces) and were dropped");
        Ok(())
    }

    fn name_of(&self, node: &json::Node, index: usize) -> String {
        let mesh = node.mesh.and_then(|mesh| self.root.meshes.get(mesh.value()));
        node.name
            .clone()
            .or_else(|| mesh?.name.clone())
            .filter(|name| !name.is_empty())
            .unwrap_or_else(|| format!("node_{index}"))
    }

    fn bake(
        &mut self,
        mesh_index: usize,
        node: usize,
        world_from_node: DMat4,
        out: &mut Imported,
    ) -> Result<(), GltfError> {
        let name = out.nodes[node].name.clone();
        let mesh = self.root.meshes.get(mesh_index).ok_or_else(|| GltfError::Reference {
            from: format!("node \"{name}\""),
            to: format!("mesh {mesh_index}"),
        })?;
        let mut of_material: Vec<(usize, u32)> = Vec::new();
        for primitive in &mesh.primitives {
            let Some(faces) = self.faces(primitive, &name, world_from_node, out)? else {
                continue;
            };
            let material = self.material_of(primitive, &name, out)?;
            let known = of_material.iter().find(|(known, _)| *known == material);
            let surface = known
                .map_or_else(|| out.mesh.add_surface(name.clone(), material, false), |(_, surface)| *surface);
            if known.is_none() {
                of_material.push((material, surface));
                out.nodes[node].surfaces.push(surface);
            }
            for vertices in faces {
                if is_degenerate(vertices.map(|v| out.mesh.positions[v as usize])) {
                    out.degenerate += 1;
                } else {
                    out.mesh.triangles.push(Triangle { vertices, surface });
                }
            }
        }
        if of_material.len() > 1 {
            for (material, surface) in of_material {
                out.mesh.surfaces[surface as usize].name = format!("{name}.{}", out.materials[material].name);
            }
        }
        Ok(())
    }

    /// Vertices of the primitive go into the mesh; returns its triangles, `None` for points and lines.
    fn faces(
        &mut self,
        primitive: &Primitive,
        name: &str,
        world_from_node: DMat4,
        out: &mut Imported,
    ) -> Result<Option<Vec<[u32; 3]>>, GltfError> {
        let user = format!("node \"{name}\"");
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) => {
                self.skipped += 1;
                return Ok(None);
            }
            Checked::Invalid => {
                return Err(GltfError::Reference { from: user, to: "a drawing mode".to_owned() });
            }
        };
        let accessor = primitive.attributes.get(&Checked::Valid(Semantic::Positions)).ok_or_else(|| {
            GltfError::Reference { from: user.clone(), to: "a POSITION attribute".to_owned() }
        })?;
        let points = self.buffers.positions(*accessor, &user)?;
        let indices = match primitive.indices {
            Some(indices) => self.buffers.indices(indices, &user)?,
            None => (0..points.len() as u32).collect(),
        };
        if out.mesh.positions.len() + points.len() > MAX_ELEMENTS
            || out.mesh.triangles.len() + indices.len() / 3 > MAX_ELEMENTS
        {
            return Err(GltfError::TooLarge);
        }
        if let Some(&index) = indices.iter().find(|&&i| i as usize >= points.len()) {
            return Err(GltfError::IndexOutOfRange { node: name.to_owned(), index, count: points.len() });
        }
        if mode == Mode::Triangles && !indices.len().is_multiple_of(3) {
            self.cut += 1;
        }
        let first = out.mesh.positions.len() as u32;
        for (index, &point) in points.iter().enumerate() {
            let point = world_from_node.transform_point3(point);
            if !point.is_finite() {
                return Err(GltfError::NotFinite { node: name.to_owned(), index });
            }
            out.mesh.positions.push(point);
        }
        let mirrored = world_from_node.determinant() < 0.0;
        let orient = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [first + a, first + b, first + c];
            if mirrored { [a, c, b] } else { [a, b, c] }
        };
        Ok(Some(triangles_of(mode, &indices).into_iter().map(orient).collect()))
    }

    fn material_of(
        &mut self,
        primitive: &Primitive,
        name: &str,
        out: &mut Imported,
    ) -> Result<usize, GltfError> {
        let Some(index) = primitive.material else {
            return Ok(*self.default_material.get_or_insert_with(|| {
                out.materials.push(ImportedMaterial {
                    name: "default".to_owned(),
                    reflectance: None,
                    gloss: None,
                });
                out.materials.len() - 1
            }));
        };
        if index.value() >= self.root.materials.len() {
            return Err(GltfError::Reference {
                from: format!("node \"{name}\""),
                to: format!("material {}", index.value()),
            });
        }
        Ok(index.value())
    }
}

fn triangles_of(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::TriangleFan => indices.windows(2).skip(1).map(|w| [indices[0], w[0], w[1]]).collect(),
        Mode::Triangles | Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => {
            indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
        }
    }
}

fn transform(node: &json::Node) -> DMat4 {
    if let Some(matrix) = node.matrix {
        return DMat4::from_cols_array(&matrix.map(f64::from));
    }
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let quaternion = node.rotation.unwrap_or_default().0.map(f64::from);
    DMat4::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, vector),
        // A zero quaternion becomes NaN here and is reported as a transform that is not finite.
        DQuat::from_array(quaternion) / DQuat::from_array(quaternion).length(),
        node.translation.map_or(DVec3::ZERO, vector),
    )
}
