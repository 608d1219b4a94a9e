//! The project file as serde structs, one per table. Whatever is checked later keeps its place in
//! the file (`Spanned`); values with two spellings live in [`super::choices`].

use serde::Deserialize;
use toml::Spanned;

use super::choices::{
    AreaGrid, EmergencyChoice, Factor, GlassChoice, GoalChoice, OneOrTwo, OpeningChoice, Surfacing,
    TextOrDate,
};

/// Numbers and names with their place.
pub type At<T> = Spanned<T>;

/// A named entry of a table such as `[materials]`.
pub type Named<T> = (At<String>, At<T>);

/// A light scene and its factors by group.
pub type LightSceneEntry = (At<String>, Vec<(At<String>, At<f64>)>);

/// The whole file.
#[derive(Debug, Default)]
pub struct File {
    /// A scene or a room could not be read, so that nothing can be said about what lies where.
    pub rooms_lost: bool,
    /// Entries that could not be read, by section; without a name where even that is unknown. They
    /// were reported: whoever refers to them made no second mistake.
    pub lost: Vec<(&'static str, Option<At<String>>)>,
    pub project: ProjectSection,
    pub scene: Option<At<SceneSection>>,
    pub materials: Vec<Named<MaterialSection>>,
    pub luminaires: Vec<Named<LuminaireSection>>,
    pub rooms: Vec<At<RoomSection>>,
    pub furniture: Vec<At<FurnitureSection>>,
    pub places: Vec<At<PlaceSection>>,
    pub light_scenes: Vec<LightSceneEntry>,
    pub has_light_scenes: bool,
    pub areas: Vec<At<AreaSection>>,
    pub viewpoints: Vec<At<ViewpointSection>>,
    pub lists: Option<At<ListsSection>>,
    pub glare_maps: Vec<At<GlareMapSection>>,
    pub cameras: Vec<At<CameraSection>>,
    pub norm: Option<At<NormSection>>,
    pub requirements: Vec<At<RequireSection>>,
    pub declared: Vec<Named<DeclaredSection>>,
    pub accuracy: AccuracySection,
}

impl File {
    /// Whether an entry of this name may have been lost.
    pub fn may_have_lost(&self, section: &str, name: &str) -> bool {
        let mut lost = self.lost.iter().filter(|(of, _)| *of == section);
        lost.any(|(_, known)| known.as_ref().is_none_or(|known| known.get_ref() == name))
    }

    /// Names of entries that were lost.
    pub fn lost_names<'a>(&'a self, section: &'a str) -> impl Iterator<Item = &'a At<String>> {
        self.lost.iter().filter(move |(of, _)| *of == section).filter_map(|(_, name)| name.as_ref())
    }
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProjectSection {
    pub name: Option<At<String>>,
    pub client: Option<String>,
    pub revision: Option<String>,
    pub date: Option<TextOrDate>,
    pub language: Option<At<Vec<At<String>>>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneSection {
    pub file: Option<At<String>>,
    pub lights: Option<At<bool>>,
    #[serde(rename = "box")]
    pub room: Option<At<BoxSection>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxSection {
    pub size: At<[f64; 3]>,
    pub floor: Option<At<Surfacing>>,
    pub walls: Option<At<Surfacing>>,
    pub ceiling: Option<At<Surfacing>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MaterialSection {
    pub reflectance: Option<At<f64>>,
    pub specular: Option<At<f64>>,
    pub phong: Option<At<f64>>,
    pub phong_paper: Option<At<f64>>,
    pub ward: Option<At<f64>>,
    pub mirror: Option<At<f64>>,
    pub glass: Option<At<GlassChoice>>,
    pub opal: Option<At<OpalSection>>,
    pub emit: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpalSection {
    pub reflectance: At<f64>,
    pub transmittance: At<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LuminaireSection {
    pub file: Option<At<String>>,
    pub lambert: Option<At<FluxSection>>,
    pub point: Option<At<FluxSection>>,
    pub flux: Option<At<f64>>,
    pub area: Option<At<OpeningChoice>>,
    pub maintenance: Option<At<Factor>>,
    pub emergency: Option<At<EmergencyChoice>>,
    #[serde(default)]
    pub body: Vec<At<String>>,
    pub ra: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FluxSection {
    pub flux: At<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomSection {
    pub name: At<String>,
    pub number: Option<String>,
    pub footprint: Option<At<Vec<[f64; 2]>>>,
    pub height: Option<At<f64>>,
    pub floor: Option<At<f64>>,
    pub node: Option<At<String>>,
    pub row: Option<At<String>>,
    pub modified: Option<At<ModifiedSection>>,
    pub mf: Option<At<RoomMaintenance>>,
    pub reflectances: Option<At<ReflectancesSection>>,
    #[serde(default)]
    pub openings: Vec<At<OpeningSection>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModifiedSection {
    pub steps: Option<At<i32>>,
    pub reason: At<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RoomMaintenance {
    pub llmf: Option<At<f64>>,
    pub lsf: Option<At<f64>>,
    pub lmf: Option<At<f64>>,
    pub rsmf: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReflectancesSection {
    pub floor: At<Surfacing>,
    pub walls: At<Surfacing>,
    pub ceiling: At<Surfacing>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OpeningSection {
    pub wall: At<String>,
    pub from: At<[f64; 2]>,
    pub to: At<[f64; 2]>,
    pub material: At<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FurnitureSection {
    pub name: Option<At<String>>,
    pub at: At<[f64; 3]>,
    pub size: At<[f64; 3]>,
    pub material: At<String>,
    pub rotate: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaceSection {
    pub luminaire: At<String>,
    pub at: Option<At<[f64; 3]>>,
    pub array: Option<At<ArraySection>>,
    pub field: Option<At<FieldSection>>,
    pub group: Option<At<String>>,
    pub aim: Option<At<[f64; 3]>>,
    pub target: Option<At<[f64; 3]>>,
    pub rotate: Option<At<f64>>,
    pub dim: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArraySection {
    pub from: At<[f64; 3]>,
    pub step: At<OneOrTwo<[f64; 3]>>,
    pub count: At<OneOrTwo<u32>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FieldSection {
    pub room: Option<At<String>>,
    pub rows: At<u32>,
    pub columns: At<u32>,
    pub height: At<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AreaSection {
    pub name: At<String>,
    pub kind: Option<super::AreaKind>,
    pub of: Option<At<String>>,
    pub room: Option<At<String>>,
    pub row: Option<At<String>>,
    pub modified: Option<At<ModifiedSection>>,
    pub light_scene: Option<At<String>>,
    pub rect: Option<At<RectSection>>,
    pub polygon: Option<At<Vec<[f64; 3]>>>,
    pub surface: Option<At<String>>,
    pub points: Option<At<String>>,
    pub grid: Option<At<AreaGrid>>,
    pub border: Option<At<f64>>,
    #[serde(default)]
    pub quantities: Vec<At<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RectSection {
    pub origin: At<[f64; 3]>,
    pub u: At<[f64; 3]>,
    pub v: At<[f64; 3]>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewpointSection {
    pub name: At<String>,
    pub eye: At<[f64; 3]>,
    pub direction: Option<At<[f64; 3]>>,
    pub target: Option<At<[f64; 3]>>,
    pub sweep: Option<At<SweepSection>>,
    #[serde(default)]
    pub indices: Vec<At<String>>,
    pub light_scene: Option<At<String>>,
    pub highlights: Option<At<bool>>,
    pub task: Option<At<[f64; 3]>>,
    pub task_deg: Option<At<f64>>,
    pub age: Option<At<f64>>,
    pub ceiling_coverage: Option<At<f64>>,
    pub ground: Option<At<GroundSection>>,
    pub road: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroundSection {
    pub area: Option<At<String>>,
    pub lx: Option<At<f64>>,
    pub reflectance: Option<At<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepSection {
    pub from: At<f64>,
    pub to: At<f64>,
    pub step: At<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ListsSection {
    pub places: Option<At<String>>,
    pub viewpoints: Option<At<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GlareMapSection {
    pub name: Option<At<String>>,
    pub rect: At<RectSection>,
    pub step: At<f64>,
    pub directions: Option<At<u32>>,
    #[serde(default)]
    pub indices: Vec<At<String>>,
    pub light_scene: Option<At<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraSection {
    pub name: At<String>,
    pub eye: At<[f64; 3]>,
    pub direction: Option<At<[f64; 3]>>,
    pub target: Option<At<[f64; 3]>>,
    pub up: Option<At<[f64; 3]>>,
    pub fov: Option<At<f64>>,
    pub fisheye: Option<Fisheye>,
    pub size: Option<At<[u32; 2]>>,
}

/// Fisheye projections of a camera.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Fisheye {
    Angular,
    Hemispherical,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NormSection {
    pub standard: At<String>,
    pub row: Option<At<String>>,
    pub compare: Option<super::Compare>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RequireSection {
    pub room: Option<At<String>>,
    pub area: Option<At<String>>,
    pub viewpoint: Option<At<String>>,
    pub quantity: At<String>,
    pub statistic: Option<At<String>>,
    pub min: Option<At<f64>>,
    pub max: Option<At<f64>>,
    pub light_scene: Option<At<String>>,
    pub instead: Option<At<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeclaredSection {
    pub ra: Option<At<f64>>,
    pub cct: Option<At<f64>>,
    pub flicker: Option<FlickerSection>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FlickerSection {
    pub pst_lm: Option<At<f64>>,
    pub svm: Option<At<f64>>,
    pub pulsation: Option<At<f64>>,
}

#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccuracySection {
    pub goal: Option<At<GoalChoice>>,
    pub confidence: Option<At<f64>>,
    pub seed: Option<u64>,
}
