//! Light sources of a glTF file: KHR_lights_punctual and EXT_lights_ies. They are only told here; whether
//! they shine is the project's choice, so nothing in them can keep the geometry from being read.

use glam::{DMat4, DVec3};
use gltf::json::Value;

use super::GltfError;
use super::container::{Source, source};

/// A light source at its node, in project coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedLight {
    /// Name of its node, or of the light, or `light_3`.
    pub name: String,
    /// Where it is, m.
    pub position: DVec3,
    /// Unit direction of its beam, the node's −Z.
    pub direction: DVec3,
    /// Unit direction of the node's +X: a photometric file's 0° plane lies on its side of the beam.
    pub right: DVec3,
    /// The node's transform turns left into right.
    pub mirrored: bool,
    /// What it is.
    pub kind: LightKind,
    /// A range beyond which renderers cut its light off, in m; light knows none.
    pub range_m: Option<f64>,
}

/// Kinds of light sources. Intensities hold the luminance (Rec. 709 Y) of the light's colour.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// The same in all directions.
    Point {
        /// Intensity.
        cd: f64,
    },
    /// Constant within the inner cone, falling to 0 at the outer one.
    Spot {
        /// Intensity on the axis.
        cd: f64,
        /// Half-angle of the inner cone, rad.
        inner_rad: f64,
        /// Half-angle of the outer cone, rad.
        outer_rad: f64,
    },
    /// From infinity, in lx.
    Directional,
    /// A photometric file (EXT_lights_ies).
    Profile {
        /// Where it lies.
        file: ProfileFile,
        /// Factor of its intensities.
        factor: f64,
    },
    /// One that cannot be read, and why.
    Unreadable(String),
}

/// Where a photometric file lies.
#[derive(Clone, Debug, PartialEq)]
pub enum ProfileFile {
    /// Relative to the glTF file.
    Path(String),
    /// Within the glTF file or one of its buffers.
    Bytes(Vec<u8>),
}

/// What the file says about lights, before its JSON is taken apart.
pub(super) struct Lights {
    /// Of each node: what it holds.
    of_node: Vec<Vec<Described>>,
}

struct Described {
    name: Option<String>,
    kind: Stored,
    range_m: Option<f64>,
    count: usize,
}

/// A light, or where the rest of it is.
enum Stored {
    Light(LightKind),
    /// A photometric file in a buffer view.
    View {
        index: usize,
        factor: f64,
    },
}

impl Lights {
    /// Collects the lights of a document.
    pub(super) fn of(document: &Value) -> Self {
        let list = |extension: &str| document.pointer(&format!("/extensions/{extension}/lights")).cloned();
        let [punctual, profiles] = ["KHR_lights_punctual", "EXT_lights_ies"].map(list);
        let nodes = document.get("nodes").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        let of_node = nodes.iter().map(|node| {
            let mut held = Vec::new();
            if let Some(light) = node.pointer("/extensions/KHR_lights_punctual") {
                held.push(described(light, punctual.as_ref(), |_, light| {
                    punctual_kind(light).map(Stored::Light)
                }));
            }
            if let Some(light) = node.pointer("/extensions/EXT_lights_ies") {
                held.push(described(light, profiles.as_ref(), profile_kind));
            }
            held
        });
        Self { of_node: of_node.collect() }
    }

    /// The lights at a node; `view` is asked for the bytes of a buffer view.
    pub(super) fn at(
        &self,
        node: usize,
        node_name: &str,
        world_from_node: DMat4,
        view: &mut dyn FnMut(usize) -> Result<Vec<u8>, GltfError>,
    ) -> Vec<ImportedLight> {
        let mut kind = |light: &Described| match &light.kind {
            Stored::Light(kind) => kind.clone(),
            Stored::View { index, factor } => match view(*index) {
                Ok(bytes) => LightKind::Profile { file: ProfileFile::Bytes(bytes), factor: *factor },
                Err(error) => LightKind::Unreadable(error.to_string()),
            },
        };
        let place = |light: &Described| ImportedLight {
            name: light.name.clone().unwrap_or_else(|| {
                if node_name.is_empty() { format!("light_{}", light.count) } else { node_name.to_owned() }
            }),
            position: world_from_node.w_axis.truncate(),
            direction: world_from_node.transform_vector3(DVec3::NEG_Z).normalize_or_zero(),
            right: world_from_node.transform_vector3(DVec3::X).normalize_or_zero(),
            mirrored: world_from_node.determinant() < 0.0,
            kind: kind(light),
            range_m: light.range_m,
        };
        self.of_node.get(node).into_iter().flatten().map(place).collect()
    }
}

fn described(
    at_node: &Value,
    list: Option<&Value>,
    kind: impl FnOnce(&Value, &Value) -> Result<Stored, String>,
) -> Described {
    let index = at_node.get("light").and_then(Value::as_u64).unwrap_or(u64::MAX) as usize;
    let light = list.and_then(|list| list.get(index));
    let kind = match light {
        None => Err("it refers to a light that does not exist".to_owned()),
        Some(light) => kind(at_node, light),
    };
    let text = |key: &str| light.and_then(|light| light.get(key)?.as_str().map(str::to_owned));
    Described {
        name: text("name").filter(|name| !name.is_empty()),
        kind: kind.unwrap_or_else(|why| Stored::Light(LightKind::Unreadable(why))),
        range_m: light.and_then(|light| light.get("range")?.as_f64()),
        count: index,
    }
}

/// KHR_lights_punctual: cd, colour in linear Rec. 709.
fn punctual_kind(light: &Value) -> Result<LightKind, String> {
    let cd = positive(light, "intensity", 1.0)? * luminance(light, f64::MAX)?;
    match light.get("type").and_then(Value::as_str) {
        Some("directional") => Ok(LightKind::Directional),
        Some("point") => Ok(LightKind::Point { cd }),
        Some("spot") => {
            let spot = light.get("spot").unwrap_or(&Value::Null);
            let inner_rad = positive(spot, "innerConeAngle", 0.0)?;
            let outer_rad = positive(spot, "outerConeAngle", std::f64::consts::FRAC_PI_4)?;
            if !(inner_rad < outer_rad && outer_rad <= std::f64::consts::FRAC_PI_2 + 1e-6) {
                return Err(format!("its cones of {inner_rad} and {outer_rad} rad are none"));
            }
            Ok(LightKind::Spot { cd, inner_rad, outer_rad })
        }
        other => Err(format!("its type is {}", other.unwrap_or("not stated"))),
    }
}

/// EXT_lights_ies: multiplier and colour, cut at 1, stand at the node; the file is a path, inline or in a
/// buffer view.
fn profile_kind(at_node: &Value, light: &Value) -> Result<Stored, String> {
    let factor = positive(at_node, "multiplier", 1.0)? * luminance(at_node, 1.0)?;
    if let Some(uri) = light.get("uri").and_then(Value::as_str) {
        let file = match source(uri)? {
            Source::Path(path) => ProfileFile::Path(path),
            Source::Inline(bytes) => ProfileFile::Bytes(bytes),
        };
        return Ok(Stored::Light(LightKind::Profile { file, factor }));
    }
    let index = light.get("bufferView").and_then(Value::as_u64);
    let index = index.ok_or("it names no photometric file, neither by `uri` nor by `bufferView`")?;
    Ok(Stored::View { index: usize::try_from(index).unwrap_or(usize::MAX), factor })
}

fn positive(of: &Value, key: &str, default: f64) -> Result<f64, String> {
    let Some(value) = of.get(key) else { return Ok(default) };
    let value = value.as_f64().filter(|value| value.is_finite() && *value >= 0.0);
    value.ok_or_else(|| format!("its {key} is no number ≥ 0"))
}

/// Y of a colour whose parts are cut at `most`, 1 where none is written.
fn luminance(of: &Value, most: f64) -> Result<f64, String> {
    let Some(colour) = of.get("color") else { return Ok(1.0) };
    let parts: Vec<f64> = colour.as_array().into_iter().flatten().filter_map(Value::as_f64).collect();
    match parts[..] {
        [r, g, b] if parts.iter().all(|c| *c >= 0.0) => {
            let [r, g, b] = [r, g, b].map(|c| c.min(most));
            Ok(0.2126 * r + 0.7152 * g + 0.0722 * b)
        }
        _ => Err("its color is none".to_owned()),
    }
}
