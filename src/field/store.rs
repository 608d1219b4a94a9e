//! `field.safetensors`: stored fields as a file that other programs read too. docs/field-file.md
//! describes it. Parsers take bytes; the file itself is mapped by `project`.

use glam::DVec3;
use safetensors::tensor::{Dtype, Metadata, SafeTensors, TensorView, serialize};
use serde::{Deserialize, Serialize};

use super::{LuminanceField, Patches, Reached};
use crate::digest::Hash;
use crate::scene::{Channel, Scene};

/// Name of the file in a result folder.
pub const FILE: &str = "field.safetensors";
/// Version of the layout.
const VERSION: u32 = 1;
/// Key of the one entry of the header's metadata; its value is a JSON document.
const KEY: &str = "gershun";

/// The stored field of one world, as solved.
#[derive(Clone, Debug)]
pub struct StoredField {
    /// What it was solved with.
    pub made: Made,
    /// Luminance of every patch side for every channel, cd/m² at initial flux.
    pub field: LuminanceField,
    /// Its part that luminaires and their images make at first hand.
    pub direct: LuminanceField,
    /// How much of every patch side light reaches.
    pub reached: Vec<Reached>,
}

/// What a stored field was solved with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Made {
    /// Seed of its links.
    pub seed: u64,
    /// Most links of a patch side.
    pub links: u32,
    /// Patch area on large surfaces, m².
    pub patch_m2: f64,
}

/// Why bytes are not the stored field of a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StoreError {
    /// No safetensors file, or one of somebody else.
    #[error("this is no stored field: {0}\n  hint: `gershun solve PROJECT` makes one")]
    NotOurs(String),
    /// Another layout.
    #[error("the stored field has layout {0}, this program reads {VERSION}\n  hint: solve it again")]
    Version(u32),
    /// Bytes changed after they were written.
    #[error("the stored field is damaged: its checksum does not fit\n  hint: solve it again")]
    Checksum,
    /// The project has another number of worlds.
    #[error(
        "the stored field holds {found} separate rooms or buildings, the project has {wanted}\n  hint: solve it again"
    )]
    Worlds {
        /// In the file.
        found: usize,
        /// In the project.
        wanted: usize,
    },
    /// Geometry, materials or luminaires differ.
    #[error(
        "the stored field belongs to another scene: geometry, materials or luminaires of \"{0}\" were changed since it was solved, or another version of the program solved it\n  hint: solve it again"
    )]
    OtherScene(String),
    /// A tensor is missing or of the wrong shape, or holds impossible values.
    #[error("the stored field is malformed: {0}")]
    Malformed(String),
}

#[derive(Serialize, Deserialize)]
struct Head {
    version: u32,
    program_version: String,
    /// SHA-256 over the tensors' bytes in the order of their names.
    sha256: String,
    worlds: Vec<WorldHead>,
}

#[derive(Serialize, Deserialize)]
struct WorldHead {
    name: String,
    /// Of geometry, materials and luminaires.
    scene_sha256: String,
    seed: u64,
    links: u32,
    /// A text, since it must come back to the last bit.
    patch_m2: String,
    channels: Vec<String>,
    surfaces: Vec<String>,
}

/// One tensor: name, type, shape and bytes.
struct Tensor {
    name: String,
    dtype: Dtype,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl Tensor {
    fn floats(name: String, shape: Vec<usize>, values: impl Iterator<Item = f64>) -> Self {
        Self { name, dtype: Dtype::F64, shape, bytes: values.flat_map(f64::to_le_bytes).collect() }
    }
}

/// The file's bytes: `worlds` are a name, the scene, and its stored field.
///
/// # Errors
/// [`StoreError::Malformed`] if a field does not belong to its scene.
pub fn to_bytes(worlds: &[(String, &Scene, &StoredField)]) -> Result<Vec<u8>, StoreError> {
    let mut tensors = Vec::new();
    let mut heads = Vec::new();
    for (number, (name, scene, stored)) in worlds.iter().enumerate() {
        describe(number, scene, stored, &mut tensors);
        heads.push(WorldHead {
            name: name.clone(),
            scene_sha256: scene.fingerprint(),
            seed: stored.made.seed,
            links: stored.made.links,
            patch_m2: stored.made.patch_m2.to_string(),
            channels: scene.channels.iter().map(|channel| channel_name(scene, channel)).collect(),
            surfaces: scene.mesh.surfaces.iter().map(|surface| surface.name.clone()).collect(),
        });
    }
    tensors.sort_by(|a, b| a.name.cmp(&b.name));
    let head = Head {
        version: VERSION,
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        sha256: checksum(tensors.iter().map(|tensor| tensor.bytes.as_slice())),
        worlds: heads,
    };
    let malformed = |error: &dyn std::fmt::Display| StoreError::Malformed(error.to_string());
    let head = serde_json::to_string(&head).map_err(|error| malformed(&error))?;
    let views: Result<Vec<(&str, TensorView)>, _> = tensors
        .iter()
        .map(|t| Ok((t.name.as_str(), TensorView::new(t.dtype, t.shape.clone(), &t.bytes)?)))
        .collect();
    let views = views.map_err(|error: safetensors::SafeTensorError| malformed(&error))?;
    // One entry: a map of several would be written in any order.
    serialize(views, Some([(KEY.to_owned(), head)].into())).map_err(|error| malformed(&error))
}

/// Nodes and luminances of one world: everything a reader needs without the project.
fn describe(world: usize, scene: &Scene, stored: &StoredField, tensors: &mut Vec<Tensor>) {
    let patches = stored.field.patches();
    let (count, channels) = (patches.len(), scene.channels.len());
    let centres: Vec<_> = (0..count).map(|patch| patches.centre(2 * patch)).collect();
    let name = |what: &str| format!("world{world}.{what}");
    let points = centres.iter().flat_map(|(point, _)| point.to_array());
    tensors.push(Tensor::floats(name("point_m"), vec![count, 3], points));
    let normals = centres.iter().flat_map(|(_, normal)| normal.normalize_or_zero().to_array());
    tensors.push(Tensor::floats(name("normal"), vec![count, 3], normals));
    let areas = (0..count).map(|patch| patches.area_m2(2 * patch));
    tensors.push(Tensor::floats(name("area_m2"), vec![count], areas));
    let surface = |patch: usize| scene.mesh.triangles[patches.triangle(2 * patch) as usize].surface;
    let bytes = (0..count).flat_map(|patch| surface(patch).to_le_bytes()).collect();
    tensors.push(Tensor { name: name("surface"), dtype: Dtype::U32, shape: vec![count], bytes });
    let bytes: Vec<u8> = patches.splits().iter().flat_map(|patch| patch.to_le_bytes()).collect();
    tensors.push(Tensor {
        name: name("split"),
        dtype: Dtype::U32,
        shape: vec![patches.splits().len()],
        bytes,
    });
    for (what, field) in [("luminance_cd_m2", &stored.field), ("direct_cd_m2", &stored.direct)] {
        let values = (0..patches.sides()).flat_map(|side| field.at(side).iter().copied());
        tensors.push(Tensor::floats(name(what), vec![count, 2, channels], values));
    }
    let reached = stored.reached.iter().flat_map(|reached| numbers(*reached));
    tensors.push(Tensor::floats(name("reached"), vec![count, 2, 7], reached));
}

/// Share, middle and a place of the part that light reaches.
fn numbers(reached: Reached) -> [f64; 7] {
    match reached {
        Reached::Whole => [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        Reached::Dark => [0.0; 7],
        Reached::Part { share, middle: m, place: p } => [share, m.x, m.y, m.z, p.x, p.y, p.z],
    }
}

fn channel_name(scene: &Scene, channel: &Channel) -> String {
    match channel {
        Channel::Luminaires { group, kind } => format!("luminaires {kind} of group {group}"),
        Channel::Surfaces { material } => format!("material {}", scene.materials[*material].name),
    }
}

fn checksum<'b>(parts: impl Iterator<Item = &'b [u8]>) -> String {
    let mut hash = Hash::default();
    parts.for_each(|part| hash.add(part));
    hash.hex()
}

/// A stored file that was opened and whose checksum fits.
#[derive(Debug)]
pub struct FieldFile<'b> {
    tensors: SafeTensors<'b>,
    worlds: Vec<WorldHead>,
}

impl std::fmt::Debug for WorldHead {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "WorldHead({})", self.name)
    }
}

impl<'b> FieldFile<'b> {
    /// Reads the bytes of a file.
    ///
    /// # Errors
    /// [`StoreError`] says what is wrong with them.
    pub fn parse(bytes: &'b [u8]) -> Result<Self, StoreError> {
        let not_ours = |what: String| StoreError::NotOurs(what);
        let (_, header) = SafeTensors::read_metadata(bytes)
            .map_err(|error| not_ours(format!("no safetensors file ({error})")))?;
        let head = Metadata::metadata(&header).as_ref().and_then(|entries| entries.get(KEY));
        let head = head.ok_or_else(|| not_ours(format!("its header has no \"{KEY}\"")))?;
        let head: serde_json::Value = serde_json::from_str(head)
            .map_err(|error| not_ours(format!("its header cannot be read ({error})")))?;
        let version = head.get("version").and_then(serde_json::Value::as_u64).unwrap_or(0) as u32;
        if version != VERSION {
            return Err(StoreError::Version(version));
        }
        let head: Head = serde_json::from_value(head)
            .map_err(|error| StoreError::Malformed(format!("header: {error}")))?;
        let tensors = SafeTensors::deserialize(bytes).map_err(|error| not_ours(error.to_string()))?;
        let mut all = tensors.tensors();
        all.sort_by(|a, b| a.0.cmp(&b.0));
        if checksum(all.iter().map(|(_, view)| view.data())) != head.sha256 {
            return Err(StoreError::Checksum);
        }
        Ok(Self { tensors, worlds: head.worlds })
    }

    /// The stored fields of all worlds of a project, in its order.
    ///
    /// # Errors
    /// [`StoreError`] if the file belongs to other scenes.
    pub fn fields(&self, scenes: &[(String, &Scene)]) -> Result<Vec<StoredField>, StoreError> {
        if self.worlds.len() != scenes.len() {
            return Err(StoreError::Worlds { found: self.worlds.len(), wanted: scenes.len() });
        }
        scenes.iter().enumerate().map(|(world, (name, scene))| self.field(world, name, scene)).collect()
    }

    fn field(&self, world: usize, name: &str, scene: &Scene) -> Result<StoredField, StoreError> {
        let head = &self.worlds[world];
        if head.scene_sha256 != scene.fingerprint() {
            return Err(StoreError::OtherScene(name.to_owned()));
        }
        let patch_m2 = head.patch_m2.parse::<f64>().ok().filter(|area| *area > 0.0 && area.is_finite());
        let patch_m2 = patch_m2
            .ok_or_else(|| StoreError::Malformed(format!("patch area \"{}\" is no area", head.patch_m2)))?;
        // Divided that finely, the scene would have more patches than the file.
        let triangles = scene.mesh.triangles.len();
        let held =
            self.tensors.tensor(&format!("world{world}.area_m2")).map_or(0, |view| view.data().len() / 8);
        if scene.scattering_m2() / patch_m2 > (held + triangles) as f64 {
            return Err(StoreError::Malformed(format!("{held} patches are too few for {patch_m2} m² each")));
        }
        let mut patches = Patches::of_scene(scene, patch_m2);
        for patch in self.splits(world)? {
            let known = (patch as usize) < patches.len() && patches.len() < held;
            if !known || patches.split(&scene.mesh, patch as usize).is_none() {
                return Err(StoreError::Malformed(format!("patch {patch} cannot be split")));
            }
        }
        let load = |what: &str| -> Result<LuminanceField, StoreError> {
            let mut field = LuminanceField::dark(patches.clone(), scene.channels.len());
            let values =
                self.floats(&format!("world{world}.{what}"), &[patches.len(), 2, scene.channels.len()])?;
            field.luminance.copy_from_slice(&values);
            Ok(field)
        };
        let made = Made { seed: head.seed, links: head.links, patch_m2 };
        let reached = self
            .finite(&format!("world{world}.reached"), &[patches.len(), 2, 7])?
            .chunks_exact(7)
            .map(|n| match n[0] {
                share if share >= 1.0 => Reached::Whole,
                share if share > 0.0 => {
                    let at = |first: usize| DVec3::new(n[first], n[first + 1], n[first + 2]);
                    Reached::Part { share, middle: at(1), place: at(4) }
                }
                _ => Reached::Dark,
            })
            .collect();
        Ok(StoredField { made, field: load("luminance_cd_m2")?, direct: load("direct_cd_m2")?, reached })
    }

    fn splits(&self, world: usize) -> Result<Vec<u32>, StoreError> {
        let name = format!("world{world}.split");
        let malformed = |what: String| StoreError::Malformed(format!("tensor {name}: {what}"));
        let view = self.tensors.tensor(&name).map_err(|error| malformed(error.to_string()))?;
        if view.dtype() != Dtype::U32 || view.shape().len() != 1 {
            return Err(malformed(format!("{:?} {:?} instead of a list of U32", view.dtype(), view.shape())));
        }
        let numbers = view.data().chunks_exact(4);
        Ok(numbers.map(|chunk| u32::from_le_bytes(std::array::from_fn(|k| chunk[k]))).collect())
    }

    fn floats(&self, name: &str, shape: &[usize]) -> Result<Vec<f64>, StoreError> {
        let values = self.finite(name, shape)?;
        match values.iter().position(|value| !(*value >= 0.0)) {
            Some(at) => Err(StoreError::Malformed(format!(
                "tensor {name}: value {at} is {}, no luminance",
                values[at]
            ))),
            None => Ok(values),
        }
    }

    fn finite(&self, name: &str, shape: &[usize]) -> Result<Vec<f64>, StoreError> {
        let malformed = |what: String| StoreError::Malformed(format!("tensor {name}: {what}"));
        let view = self.tensors.tensor(name).map_err(|error| malformed(error.to_string()))?;
        if view.dtype() != Dtype::F64 || view.shape() != shape {
            return Err(malformed(format!("{:?} {:?} instead of F64 {shape:?}", view.dtype(), view.shape())));
        }
        let values: Vec<f64> = view
            .data()
            .chunks_exact(8)
            .map(|chunk| f64::from_le_bytes(std::array::from_fn(|k| chunk[k])))
            .collect();
        match values.iter().position(|value| !value.is_finite()) {
            Some(at) => Err(malformed(format!("value {at} is {}", values[at]))),
            None => Ok(values),
        }
    }
}
