//! glTF 2.0 → mesh, materials and node names. The `gltf` crate only turns JSON into structs: its
//! own accessors index unchecked, so every reference and length of the file is checked here.
//! glTF is Y up, a project is Z up: (x, y, z) → (x, −z, y).

mod accessor;
mod appearance;
mod container;
mod lights;
mod repeated;
mod walk;

use glam::DVec3;
use gltf::json;

use super::mesh::Mesh;
use accessor::Buffers;
pub use lights::{ImportedLight, LightKind, ProfileFile};
use walk::Walk;

/// What an import yields.
#[derive(Clone, Debug, Default)]
pub struct Imported {
    /// Triangles in project coordinates; a surface is one node's part of one material.
    pub mesh: Mesh,
    /// All materials of the file, and `default` at the end if some primitive has none.
    pub materials: Vec<ImportedMaterial>,
    /// Nodes of the scene, parents first.
    pub nodes: Vec<ImportedNode>,
    /// Light sources at the nodes of the scene.
    pub lights: Vec<ImportedLight>,
    /// Triangles without area, which were dropped.
    pub degenerate: usize,
    /// What was ignored, one sentence each.
    pub biases: Vec<String>,
}

/// A material of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedMaterial {
    /// Name, `material_3` when the file gives none.
    pub name: String,
    /// Rec. 709 Y of a baseColorFactor that is written in the file; absent otherwise.
    pub reflectance: Option<f64>,
    /// metallicFactor (glTF's default where it is not written) and roughnessFactor, if the roughness
    /// is written and no texture changes it.
    pub gloss: Option<[f64; 2]>,
}

/// A node of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedNode {
    /// Name, or its mesh's, or `node_7`.
    pub name: String,
    /// Names from the root, joined with `/`.
    pub path: String,
    /// Index of its parent among the nodes.
    pub parent: Option<usize>,
    /// Surfaces of the node and of everything below it.
    pub surfaces: Vec<u32>,
}

/// Why a file cannot be imported.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GltfError {
    /// The .glb container is damaged.
    #[error("damaged .glb container: {0}")]
    Container(String),
    /// No glTF JSON.
    #[error("not a glTF 2.0 document: {0}")]
    Json(String),
    /// A required extension that would change the geometry.
    #[error("the file requires the extension {0}, which is not supported")]
    Extension(String),
    /// No scene, or no nodes in it.
    #[error("{0}")]
    NoScene(String),
    /// An index that points nowhere.
    #[error("{from} refers to {to}, which does not exist")]
    Reference {
        /// Who refers.
        from: String,
        /// To what.
        to: String,
    },
    /// A cycle, or a node with two parents.
    #[error("node \"{0}\" is reached twice: the node hierarchy has a cycle or a shared child")]
    Cycle(String),
    /// A root that hangs below another node, so that its place is ambiguous.
    #[error(
        "node \"{node}\" is a root of the scene and a child of node \"{parent}\" (a cycle, or a shared node)"
    )]
    NotRoot {
        /// The root.
        node: String,
        /// Its parent.
        parent: String,
    },
    /// Too many levels of nodes.
    #[error("node \"{0}\" lies more than 256 levels deep")]
    TooDeep(String),
    /// A bad transform.
    #[error("node \"{0}\" has a transform that is not finite and affine")]
    Transform(String),
    /// Bytes that cannot be had.
    #[error("buffer {index}: {what}")]
    Buffer {
        /// Index in the file.
        index: usize,
        /// Fault.
        what: String,
    },
    /// Numbers that cannot be read.
    #[error("{name}: {what}")]
    Accessor {
        /// The accessor and who uses it.
        name: String,
        /// Fault.
        what: String,
    },
    /// NaN or infinity among the vertices.
    #[error("vertex {index} of node \"{node}\" is not finite")]
    NotFinite {
        /// The node.
        node: String,
        /// Index within the primitive.
        index: usize,
    },
    /// An index beyond the vertices.
    #[error("node \"{node}\": vertex index {index} is out of range, there are {count} vertices")]
    IndexOutOfRange {
        /// The node.
        node: String,
        /// The index.
        index: u32,
        /// Vertices of the primitive.
        count: usize,
    },
    /// A colour that is no reflectance.
    #[error("material \"{name}\": baseColorFactor {value:?} is outside 0 … 1")]
    Colour {
        /// The material.
        name: String,
        /// As written.
        value: Vec<f64>,
    },
    /// Factors that are no factors.
    #[error("material \"{name}\": metallicFactor and roughnessFactor {value:?} are outside 0 … 1")]
    Gloss {
        /// The material.
        name: String,
        /// As written.
        value: [f64; 2],
    },
    /// Absurd size.
    #[error("more than 100 million triangles or vertices")]
    TooLarge,
}

/// Imports a .gltf or .glb; `read` is asked for the bytes behind relative URIs (percent-decoded).
///
/// # Errors
/// [`GltfError`] names the first object that is broken where geometry or reflectances touch it.
pub fn import(
    document: &[u8],
    read: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Imported, GltfError> {
    let (text, bin) = container::split(document)?;
    let fault = |error: json::Error| GltfError::Json(error.to_string());
    let mut written: json::Value = json::deserialize::from_slice(text).map_err(fault)?;
    let lights = lights::Lights::of(&written);
    // A mistake in what is ignored anyway must not keep the geometry from being read.
    let unused = appearance::take_unused(&mut written);
    let base_colours = appearance::Written::of(&written).map_err(fault)?;
    let root: json::Root = json::deserialize::from_value(written).map_err(fault)?;
    if !root.asset.version.starts_with("2.") {
        let version = &root.asset.version;
        return Err(GltfError::Json(format!("version \"{version}\" is not 2")));
    }
    for extension in &root.extensions_required {
        if !appearance::only_looks(extension) {
            return Err(GltfError::Extension(extension.clone()));
        }
    }
    let mut imported = Imported {
        materials: appearance::materials(&root, &base_colours)?,
        biases: appearance::biases(&root, &base_colours, &unused),
        ..Imported::default()
    };
    let buffers = Buffers::new(&root, bin, read);
    Walk::new(&root, buffers, &lights).run(&mut imported)?;
    Ok(imported)
}

/// Whether a triangle has no area worth the name: height below 1e-10 of its longest edge.
pub fn is_degenerate([a, b, c]: [DVec3; 3]) -> bool {
    let longest2 = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    let doubled_area = (b - a).cross(c - a).length();
    !(doubled_area > 1e-10 * longest2) || !doubled_area.is_normal()
}
