//! What the file says about looks: reflectances, and everything about looks that is ignored.

use gltf::json;
use serde::Deserialize;

use super::{GltfError, ImportedMaterial};

/// Extensions that may be required and still leave geometry and reflectance alone.
const LOOKS: &[&str] = &[
    "EXT_lights_ies",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
];

/// Whether an extension only concerns looks or light sources, which a project states itself.
pub(super) fn only_looks(extension: &str) -> bool {
    LOOKS.iter().any(|known| extension.starts_with(known))
}

/// The part of the JSON for which it matters whether a value was written or is a default.
#[derive(Deserialize)]
pub(super) struct Written {
    #[serde(default)]
    materials: Vec<WrittenMaterial>,
}

#[derive(Deserialize)]
struct WrittenMaterial {
    #[serde(rename = "pbrMetallicRoughness")]
    pbr: Option<WrittenPbr>,
}

#[derive(Deserialize)]
struct WrittenPbr {
    #[serde(rename = "baseColorFactor")]
    base_color: Option<Vec<f64>>,
    #[serde(rename = "metallicFactor")]
    metallic: Option<f64>,
    #[serde(rename = "roughnessFactor")]
    roughness: Option<f64>,
    #[serde(rename = "metallicRoughnessTexture")]
    texture: Option<serde::de::IgnoredAny>,
}

impl WrittenPbr {
    /// Metallic and roughness factors where the second is written and no texture changes them.
    fn gloss(&self) -> Option<[f64; 2]> {
        let roughness = self.roughness.filter(|_| self.texture.is_none())?;
        // glTF: absent, the metallic factor is 1.
        Some([self.metallic.unwrap_or(1.0), roughness])
    }
}

impl Written {
    /// Reads the materials of a document.
    pub(super) fn of(document: &json::Value) -> Result<Self, json::Error> {
        Self::deserialize(document)
    }

    fn pbr(&self, index: usize) -> Option<&WrittenPbr> {
        self.materials.get(index)?.pbr.as_ref()
    }
}

/// Sections that neither geometry nor reflectance need, and the bias that goes with each.
const UNUSED: &[(&str, &str)] = &[
    ("animations", "animations of the glTF file are ignored"),
    ("skins", "skins of the glTF file are ignored"),
    ("cameras", ""),
    ("images", ""),
    ("samplers", ""),
    ("textures", ""),
    ("extras", ""),
    ("extensions", ""),
];

/// Takes the sections that are not used out of a document; returns their biases.
pub(super) fn take_unused(document: &mut json::Value) -> Vec<&'static str> {
    let Some(sections) = document.as_object_mut() else {
        return Vec::new();
    };
    UNUSED
        .iter()
        .filter(|(section, bias)| sections.remove(*section).is_some() && !bias.is_empty())
        .map(|(_, bias)| *bias)
        .collect()
}

/// All materials of the file with the reflectances written in it.
pub(super) fn materials(root: &json::Root, written: &Written) -> Result<Vec<ImportedMaterial>, GltfError> {
    root.materials
        .iter()
        .enumerate()
        .map(|(index, material)| {
            let name = name_of(material, index);
            let colour = written.pbr(index).and_then(|pbr| pbr.base_color.as_ref());
            let reflectance = colour.map(|colour| luminance(&name, colour)).transpose()?;
            let gloss = written.pbr(index).and_then(WrittenPbr::gloss);
            if let Some(value) = gloss.filter(|gloss| gloss.iter().any(|x| !(0.0..=1.0).contains(x))) {
                return Err(GltfError::Gloss { name, value });
            }
            Ok(ImportedMaterial { name, reflectance, gloss })
        })
        .collect()
}

/// Y = 0.2126 R + 0.7152 G + 0.0722 B of linear Rec. 709 components.
fn luminance(name: &str, colour: &[f64]) -> Result<f64, GltfError> {
    let within = colour.iter().all(|c| (0.0..=1.0).contains(c));
    match colour {
        [r, g, b, _] if within => Ok(0.2126 * r + 0.7152 * g + 0.0722 * b),
        _ => Err(GltfError::Colour { name: name.to_owned(), value: colour.to_vec() }),
    }
}

/// Sentences about what the import leaves out.
pub(super) fn biases(root: &json::Root, written: &Written, unused: &[&str]) -> Vec<String> {
    let mut biases = Vec::new();
    let mut listing = |what: &str, applies: &dyn Fn(&json::Material, usize) -> bool| {
        let names: Vec<String> = root
            .materials
            .iter()
            .enumerate()
            .filter(|(index, material)| applies(material, *index))
            .map(|(index, material)| name_of(material, index))
            .collect();
        if !names.is_empty() {
            biases.push(format!("{what}: {}", names.join(", ")));
        }
    };
    listing("colour reduced to its reflectance", &|m, _| {
        let [r, g, b, _] = m.pbr_metallic_roughness.base_color_factor.0;
        (r - g).abs() > 1e-3 || (g - b).abs() > 1e-3
    });
    listing("texture ignored", &|m, _| {
        let pbr = &m.pbr_metallic_roughness;
        pbr.base_color_texture.is_some()
            || pbr.metallic_roughness_texture.is_some()
            || m.normal_texture.is_some()
            || m.occlusion_texture.is_some()
            || m.emissive_texture.is_some()
    });
    // 1 is glTF's default and says nothing; a value that was written does.
    listing(
        "metallic-roughness of the file used, its diffuse part taken as constant with angle",
        &|_, index| {
            let pbr = written.pbr(index);
            pbr.is_some_and(|pbr| pbr.base_color.is_some() && pbr.gloss().is_some())
        },
    );
    listing("metal treated as diffuse", &|_, index| {
        let metallic = written.pbr(index).filter(|pbr| pbr.gloss().is_none()).and_then(|pbr| pbr.metallic);
        metallic.is_some_and(|metallic| metallic > 0.5)
    });
    listing("emission ignored (use `emit` in [materials])", &|m, _| {
        m.emissive_factor.0.iter().any(|c| *c > 0.0)
    });
    let translucent = json::material::AlphaMode::Opaque;
    listing("transparency ignored (use `glass` or `opal`)", &|m, _| {
        m.alpha_mode != json::validation::Checked::Valid(translucent)
    });
    let morphs =
        root.meshes.iter().flat_map(|mesh| &mesh.primitives).any(|primitive| primitive.targets.is_some());
    if morphs {
        biases.push("morph targets of the glTF file are ignored".to_owned());
    }
    biases.extend(unused.iter().map(|&bias| bias.to_owned()));
    biases
}

fn name_of(material: &json::Material, index: usize) -> String {
    material.name.clone().unwrap_or_else(|| format!("material_{index}"))
}
