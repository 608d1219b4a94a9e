//! Writes a model as glTF 2.0 binary. The model is Z-up; the file is Y-up: (x, y, z) → (x, z, −y).

use glam::{DMat3, DVec3};
use serde::Serialize;

use super::solid::Shape;

/// A shape with its material.
pub struct Part {
    pub material: &'static str,
    pub shape: Shape,
}

/// What several nodes may share.
pub struct Mesh {
    pub name: &'static str,
    pub parts: Vec<Part>,
}

/// A named, placed mesh, or a named group of nodes.
pub struct Node {
    pub name: String,
    /// Index of the group it belongs to.
    pub group: Option<usize>,
    pub mesh: Option<usize>,
    pub at: DVec3,
    /// Counter-clockwise turn about z.
    pub turn_deg: f64,
}

/// Everything in the file.
#[derive(Default)]
pub struct Model {
    pub meshes: Vec<Mesh>,
    pub nodes: Vec<Node>,
}

impl Model {
    /// Adds a mesh and returns its index.
    pub fn mesh(&mut self, name: &'static str, parts: Vec<Part>) -> usize {
        self.meshes.push(Mesh { name, parts });
        self.meshes.len() - 1
    }

    /// Adds a group without geometry and returns its index.
    pub fn group(&mut self, name: &str) -> usize {
        self.nodes.push(Node { name: name.into(), group: None, mesh: None, at: DVec3::ZERO, turn_deg: 0.0 });
        self.nodes.len() - 1
    }

    /// Places a mesh.
    pub fn place(&mut self, name: impl Into<String>, mesh: usize, at: DVec3, turn_deg: f64) {
        self.nodes.push(Node { name: name.into(), group: None, mesh: Some(mesh), at, turn_deg });
    }

    /// Adds a mesh that is used once, in place, as a member of a group.
    pub fn fixed(&mut self, group: Option<usize>, name: &'static str, material: &'static str, shape: Shape) {
        let mesh = self.mesh(name, vec![Part { material, shape }]);
        self.place(name, mesh, DVec3::ZERO, 0.0);
        self.nodes.last_mut().expect("just placed").group = group;
    }

    /// All triangles in project coordinates with the index of their node.
    pub fn triangles(&self) -> Vec<(usize, [DVec3; 3])> {
        let mut all = Vec::new();
        for (index, node) in self.nodes.iter().enumerate() {
            let turn = DMat3::from_rotation_z(node.turn_deg.to_radians());
            for part in node.mesh.iter().flat_map(|&mesh| &self.meshes[mesh].parts) {
                for triangle in &part.shape.triangles {
                    let corner = |v: u32| turn * part.shape.vertices[v as usize] + node.at;
                    all.push((index, triangle.map(corner)));
                }
            }
        }
        all
    }
}

/// The file's bytes.
pub fn write(model: &Model) -> Vec<u8> {
    let mut file = File::default();
    let meshes = model
        .meshes
        .iter()
        .map(|mesh| JsonMesh { name: mesh.name, primitives: file.primitives(&mesh.parts) })
        .collect();
    let nodes = model
        .nodes
        .iter()
        .enumerate()
        .map(|(index, node)| JsonNode {
            name: &node.name,
            mesh: node.mesh,
            translation: (node.at != DVec3::ZERO).then(|| y_up(node.at).to_array()),
            rotation: (node.turn_deg != 0.0).then(|| {
                let (sin, cos) = (0.5 * node.turn_deg.to_radians()).sin_cos();
                [0.0, sin, 0.0, cos].map(|q| (q * 1e7).round() / 1e7)
            }),
            children: (0..model.nodes.len())
                .filter(|&child| model.nodes[child].group == Some(index))
                .collect(),
        })
        .collect();
    file.bytes.resize(file.bytes.len().next_multiple_of(4), 0);
    let json = Json {
        asset: Asset { version: "2.0", generator: "gershun make_office" },
        scene: 0,
        scenes: [JsonScene {
            name: "Office",
            nodes: (0..model.nodes.len()).filter(|&node| model.nodes[node].group.is_none()).collect(),
        }],
        nodes,
        meshes,
        materials: file.materials.iter().map(|&name| Named { name }).collect(),
        accessors: file.accessors,
        buffer_views: file.views,
        buffers: [Buffer { byte_length: file.bytes.len() }],
    };
    let mut text = serde_json::to_vec(&json).expect("plain data is always JSON");
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + text.len() + 8 + file.bytes.len();
    let mut out = Vec::with_capacity(length);
    out.extend(b"glTF");
    for word in [2, length, text.len()] {
        out.extend((word as u32).to_le_bytes());
    }
    out.extend(b"JSON");
    out.extend(text);
    out.extend((file.bytes.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(file.bytes);
    out
}

fn y_up(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.z, 0.0 - p.y)
}

/// What is collected while meshes are written.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    materials: Vec<&'static str>,
    accessors: Vec<Accessor>,
    views: Vec<View>,
}

impl File {
    /// One primitive for each material of the mesh.
    fn primitives(&mut self, parts: &[Part]) -> Vec<Primitive> {
        let mut names: Vec<&'static str> = Vec::new();
        for part in parts {
            if !names.contains(&part.material) {
                names.push(part.material);
            }
        }
        names
            .iter()
            .map(|&name| {
                let mut positions: Vec<[f32; 3]> = Vec::new();
                let mut indices: Vec<u16> = Vec::new();
                for part in parts.iter().filter(|part| part.material == name) {
                    let first = positions.len() as u32;
                    let corners = part.shape.vertices.iter();
                    positions.extend(corners.map(|&p| y_up(p).as_vec3().to_array()));
                    let used = part.shape.triangles.iter().flatten();
                    indices.extend(
                        used.map(|&v| {
                            u16::try_from(first + v).expect("a piece of furniture has few vertices")
                        }),
                    );
                }
                self.primitive(name, &positions, &indices)
            })
            .collect()
    }

    fn primitive(&mut self, material: &'static str, positions: &[[f32; 3]], indices: &[u16]) -> Primitive {
        let extreme = |pick: fn(f32, f32) -> f32| {
            let axis = |k: usize| positions.iter().map(|p| p[k]).reduce(pick);
            Some([0, 1, 2].map(|k| axis(k).expect("a shape has vertices")))
        };
        let bytes: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let position = self.accessor(&bytes, 34962, 5126, "VEC3", positions.len());
        self.accessors[position].min = extreme(f32::min);
        self.accessors[position].max = extreme(f32::max);
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let index = self.accessor(&bytes, 34963, 5123, "SCALAR", indices.len());
        Primitive { attributes: Attributes { position }, indices: index, material: self.material(material) }
    }

    fn material(&mut self, name: &'static str) -> usize {
        let known = self.materials.iter().position(|&known| known == name);
        known.unwrap_or_else(|| {
            self.materials.push(name);
            self.materials.len() - 1
        })
    }

    fn accessor(
        &mut self,
        bytes: &[u8],
        target: u32,
        component_type: u32,
        kind: &'static str,
        count: usize,
    ) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(View { buffer: 0, byte_offset: self.bytes.len(), byte_length: bytes.len(), target });
        self.bytes.extend(bytes);
        self.accessors.push(Accessor {
            buffer_view: self.views.len() - 1,
            component_type,
            count,
            kind,
            min: None,
            max: None,
        });
        self.accessors.len() - 1
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Json<'a> {
    asset: Asset,
    scene: usize,
    scenes: [JsonScene; 1],
    nodes: Vec<JsonNode<'a>>,
    meshes: Vec<JsonMesh>,
    materials: Vec<Named>,
    accessors: Vec<Accessor>,
    buffer_views: Vec<View>,
    buffers: [Buffer; 1],
}

#[derive(Serialize)]
struct Asset {
    version: &'static str,
    generator: &'static str,
}

#[derive(Serialize)]
struct JsonScene {
    name: &'static str,
    nodes: Vec<usize>,
}

#[derive(Serialize)]
struct JsonNode<'a> {
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    translation: Option<[f64; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<[f64; 4]>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    children: Vec<usize>,
}

#[derive(Serialize)]
struct JsonMesh {
    name: &'static str,
    primitives: Vec<Primitive>,
}

#[derive(Serialize)]
struct Primitive {
    attributes: Attributes,
    indices: usize,
    material: usize,
}

#[derive(Serialize)]
struct Attributes {
    #[serde(rename = "POSITION")]
    position: usize,
}

#[derive(Serialize)]
struct Named {
    name: &'static str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Accessor {
    buffer_view: usize,
    component_type: u32,
    count: usize,
    #[serde(rename = "type")]
    kind: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    min: Option<[f32; 3]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    max: Option<[f32; 3]>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct View {
    buffer: usize,
    byte_offset: usize,
    byte_length: usize,
    target: u32,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Buffer {
    byte_length: usize,
}
