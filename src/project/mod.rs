//! The project file: schema, and its resolution into worlds ready to be planned. The only code
//! that reads files. All mistakes of a file are reported in one run, each with line and hint.

mod choices;
mod context;
mod diagnostics;
mod photometric;
mod read;
mod resolve;
// The structs of the schema are described by the project file's own documentation.
#[allow(missing_docs)]
mod schema;

use std::path::Path;

use glam::{DVec2, DVec3};
use serde::Deserialize;

pub use diagnostics::{Diagnostic, Place, suggestion};
pub use photometric::{ReadError, is_same_file, read_field, read_image, read_photometry};

use crate::geometry::polygon;
use crate::geometry::trace::Simd;
use crate::glare::luminances::TASK_DEG;
use crate::glare::source::Given;
use crate::grid::GridRule;
use crate::image::View;
use crate::norm::Standard;
use crate::quantity::{Quantity, Statistic};
use crate::scene::Scene;

/// How to load.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// Whether files outside the project's folder may be read.
    pub allow_outside: bool,
    /// SIMD level of the tracer; results do not depend on it.
    pub simd: Simd,
}

/// Loads a project.toml, or the one in a folder.
///
/// # Errors
/// All mistakes of the project, in the order of the file.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Project, Vec<Diagnostic>> {
    let path = if path.is_dir() { path.join("project.toml") } else { path.to_owned() };
    let shown = path.display().to_string();
    let unreadable = |what: String| {
        vec![Diagnostic::file(&shown, what, "a project is a project.toml or its folder".to_owned())]
    };
    let full =
        path.canonicalize().map_err(|error| unreadable(format!("cannot read the project: {error}")))?;
    let metadata =
        full.metadata().map_err(|error| unreadable(format!("cannot read the project: {error}")))?;
    if !metadata.is_file() || metadata.len() > context::SMALL_FILE {
        return Err(unreadable("the project is not a file of at most 64 MiB".to_owned()));
    }
    let bytes =
        std::fs::read(&full).map_err(|error| unreadable(format!("cannot read the project: {error}")))?;
    let text =
        String::from_utf8(bytes).map_err(|_| unreadable("the project file is not UTF-8 text".to_owned()))?;
    let folder = full.parent().unwrap_or(Path::new("/")).to_owned();
    let mut context = context::Context {
        folder,
        file: shown,
        text,
        diagnostics: Vec::new(),
        misspelt: Vec::new(),
        warnings: Vec::new(),
        biases: Vec::new(),
        inputs: Vec::new(),
        allow_outside: options.allow_outside,
        simd: options.simd,
    };
    let name = full.file_name().map_or("project.toml".into(), |name| name.to_string_lossy());
    let text = context.text.clone();
    context.record(&name, text.as_bytes());
    let file = read::read(&text, &mut context);
    let project = resolve::resolve(&file, &mut context);
    let mut diagnostics = context.diagnostics;
    match project {
        Some(project) if diagnostics.is_empty() => Ok(project),
        _ => {
            diagnostics.sort_by_key(|d| (d.file != context.file, d.file.clone(), d.line, d.column));
            Err(diagnostics)
        }
    }
}

/// A resolved project.
#[derive(Debug)]
pub struct Project {
    /// Names and dates for the report's head.
    pub info: Info,
    /// Independent worlds: one for the box or CAD file, and one for each footprint room.
    pub worlds: Vec<World>,
    /// Light scenes; never empty.
    pub light_scenes: Vec<LightScene>,
    /// The norm to judge by.
    pub norm: Option<Norm>,
    /// Declared properties, shown beside the norm's limits and never computed.
    pub declared: Vec<Declared>,
    /// How exactly to solve.
    pub accuracy: Accuracy,
    /// What was ignored or approximated while loading.
    pub biases: Vec<String>,
    /// What is allowed and may well be a mistake, with its place; each stands among the biases too.
    pub warnings: Vec<Diagnostic>,
    /// Input files in order of use.
    pub inputs: Vec<InputFile>,
}

/// Head of the report.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Info {
    /// Project name; names the default output folder too.
    pub name: String,
    /// Client, may be empty.
    pub client: String,
    /// Revision, may be empty.
    pub revision: String,
    /// Date as written by the user, may be empty (the clock is never read).
    pub date: String,
    /// Report languages, `en` and `ru`; never empty.
    pub language: Vec<String>,
}

/// Properties declared for a luminaire type or a room, `[declared]`.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Declared {
    /// Name of the luminaire type or room.
    pub subject: String,
    /// Colour rendering index R_a.
    pub ra: Option<f64>,
    /// Correlated colour temperature, K.
    pub cct_k: Option<f64>,
    /// Short-term flicker P_st^LM.
    pub pst_lm: Option<f64>,
    /// Stroboscopic visibility measure.
    pub svm: Option<f64>,
    /// Pulsation of the illuminance, %.
    pub pulsation_percent: Option<f64>,
}

/// An input file and what it contained.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct InputFile {
    /// As written in the project.
    pub path: String,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// A scene with the rooms, areas and viewpoints in it.
#[derive(Debug)]
pub struct World {
    /// Geometry, materials, luminaires.
    pub scene: Scene,
    /// Rooms in this world; never empty.
    pub rooms: Vec<Room>,
    /// Areas the user listed (the norm's own areas are added by `plan`).
    pub areas: Vec<AreaSpec>,
    /// Observers.
    pub viewpoints: Vec<Viewpoint>,
    /// Maps of glare.
    pub glare_maps: Vec<GlareMap>,
    /// Cameras for pictures.
    pub cameras: Vec<Camera>,
    /// Requirements of `[[require]]` that concern this world.
    pub requirements: Vec<CustomRequirement>,
}

/// A room.
#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    /// Name, unique in the project.
    pub name: String,
    /// Number on the plan, may be empty.
    pub number: String,
    /// Plan outline, counter-clockwise, m.
    pub footprint: Vec<DVec2>,
    /// Height of the finished floor, m.
    pub floor_m: f64,
    /// Clear height, m.
    pub height_m: f64,
    /// Row of the norm, if the project names one.
    pub row: Option<String>,
    /// Whether the row's illuminance is raised or lowered here, and why.
    pub modified: Option<Modification>,
    /// Room surface maintenance factor.
    pub rsmf: f64,
    /// Mean reflectances of ceiling, walls, floor (area-weighted shell materials), for the UGR table.
    pub reflectances: [f64; 3],
    /// Surfaces (mesh indices) that are this room's walls, ceiling, floor; empty where unknown.
    pub walls: Vec<u32>,
    /// See `walls`.
    pub ceiling: Vec<u32>,
    /// See `walls`.
    pub floor: Vec<u32>,
    /// Luminaires (scene indices) that hang in this room.
    pub luminaires: Vec<usize>,
}

impl Room {
    /// Whether a point lies in the room.
    pub fn contains(&self, point: DVec3) -> bool {
        let height_m = point.z - self.floor_m;
        (0.0..=self.height_m).contains(&height_m) && polygon::contains(&self.footprint, point.truncate(), 0.0)
    }
}

/// Context of a room that changes the illuminance its row asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Modification {
    /// Steps along the norm's scale; `None`: the row's value for difficult conditions.
    pub steps: Option<i32>,
    /// Why, in the user's words; never empty.
    pub reason: String,
}

/// What an area is in the sense of the norm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AreaKind {
    /// Task area.
    Task,
    /// Immediate surrounding of a task area.
    Surrounding,
    /// Background area.
    Background,
    /// A surface of the room: wall, ceiling, board.
    Surface,
    /// Points of a space, for cylindrical illuminance.
    Volume,
}

/// An area as the user wrote it.
#[derive(Clone, Debug, PartialEq)]
pub struct AreaSpec {
    /// Name, unique in the project.
    pub name: String,
    /// Role.
    pub kind: AreaKind,
    /// For surroundings: index of the task area within the world's areas.
    pub of: Option<usize>,
    /// Index of its room within the world.
    pub room: usize,
    /// Row of the norm for this area; `None`: the room's, then the norm's default.
    pub row: Option<String>,
    /// Whether the illuminance of its row is raised or lowered here, and why; over the room's.
    pub modified: Option<Modification>,
    /// Light scene by which it is judged; `None`: the first.
    pub light_scene: Option<usize>,
    /// Where it lies.
    pub shape: AreaShape,
    /// How points are laid.
    pub rule: GridRule,
    /// Border left out, m.
    pub border_m: f64,
    /// Quantities to report; empty: those of the norm for its kind, else E_h (E_n on surfaces).
    pub quantities: Vec<Quantity>,
    /// Where the user wrote its name; `None` where a norm made the area from a room.
    pub written: Option<Place>,
}

/// Where an area lies.
#[derive(Clone, Debug, PartialEq)]
pub enum AreaShape {
    /// A rectangle with full edges `u` and `v`; its normal is u × v.
    Rect {
        /// Corner, m.
        origin: DVec3,
        /// Full edge, m.
        u: DVec3,
        /// Full edge, m.
        v: DVec3,
    },
    /// A planar polygon; its normal is upward where it is horizontal, else by its corners' order.
    Polygon(Vec<DVec3>),
    /// The room's side of a planar named surface: its bounding rectangle and outline triangles.
    Surface {
        /// Mesh surface index.
        surface: u32,
        /// Bounding rectangle in the surface's plane; u × v points into the room.
        origin: DVec3,
        /// Full edge, m.
        u: DVec3,
        /// Full edge, m.
        v: DVec3,
    },
    /// A free list of points with optional normals.
    Points(Vec<(DVec3, Option<DVec3>)>),
}

/// An observer.
#[derive(Clone, Debug, PartialEq)]
pub struct Viewpoint {
    /// Name, unique in the project.
    pub name: String,
    /// Index of its room within the world.
    pub room: usize,
    /// Eye position, m.
    pub eye: DVec3,
    /// Unit lines of sight: one, or a sweep about the vertical.
    pub directions: Vec<DVec3>,
    /// Their azimuths as they were written, else as they follow, degrees from +x towards +y.
    pub azimuths_deg: Vec<f64>,
    /// Keys of the indices asked for, as the table of indices has them; UGR is always computed.
    pub indices: Vec<&'static str>,
    /// Light scene; `None`: the first.
    pub light_scene: Option<usize>,
    /// Whether highlights in glossy planes are glare sources.
    pub highlights: bool,
    /// What is looked at, for the luminances of task and surround.
    pub task: Task,
    /// The illuminated area that GR is rated against, an index within the world; `None`: the only one of its room.
    pub area: Option<usize>,
    /// Diffuse reflectance of that area; `None`: of what lies under it.
    pub area_reflectance: Option<f64>,
    /// What no view tells and some indices ask for.
    pub given: Given,
    /// Where the user wrote its eye; `None` where no file has it.
    pub written: Option<Place>,
}

/// What an observer looks at: a cone of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// The place in its middle, m; `None`: the line of sight.
    pub at: Option<DVec3>,
    /// Full opening angle of the cone, degrees.
    pub opening_deg: f64,
}

impl Default for Task {
    fn default() -> Self {
        Self { at: None, opening_deg: TASK_DEG }
    }
}

impl Task {
    /// Unit direction to its middle for an eye that looks along `gaze`.
    pub fn direction(&self, eye: DVec3, gaze: DVec3) -> DVec3 {
        self.at.and_then(|at| (at - eye).try_normalize()).unwrap_or(gaze)
    }
}

/// A grid of eyes that look in several directions each.
#[derive(Clone, Debug, PartialEq)]
pub struct GlareMap {
    /// Name, unique in the project.
    pub name: String,
    /// Index of its room within the world.
    pub room: usize,
    /// Corner of the rectangle, m; its height is the eyes'.
    pub origin: DVec3,
    /// Edges of the rectangle, m.
    pub edges: [DVec3; 2],
    /// Wanted distance of the eyes, m.
    pub step_m: f64,
    /// Lines of sight, horizontal, equally spaced from +x on.
    pub directions: u32,
    /// Keys of the indices wanted beside UGR.
    pub indices: Vec<&'static str>,
    /// Light scene; `None`: the first.
    pub light_scene: Option<usize>,
}

/// A camera for luminance pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name, unique among the cameras of the project.
    pub name: String,
    /// Index of its room within the world.
    pub room: usize,
    /// Where it stands, how it looks, and its projection.
    pub view: View,
    /// Columns and rows.
    pub size: [usize; 2],
}

/// A light scene: factors of the groups, multiplied with each luminaire's `dim`.
#[derive(Clone, Debug, PartialEq)]
pub struct LightScene {
    /// Name, `all` when the project lists none.
    pub name: String,
    /// Factor of each group; `None`: every group at 1. A group that is not listed is off.
    pub factors: Option<Vec<(String, f64)>>,
}

impl LightScene {
    /// Factor of a group in this scene.
    pub fn factor(&self, group: &str) -> f64 {
        match &self.factors {
            None => 1.0,
            Some(factors) => {
                factors.iter().find(|(name, _)| name == group).map_or(0.0, |(_, factor)| *factor)
            }
        }
    }
}

/// The norm and how it is applied.
#[derive(Clone, Debug)]
pub struct Norm {
    /// Its rows.
    pub standard: Standard,
    /// Default row for rooms and areas.
    pub row: Option<String>,
    /// Exact or printed comparison.
    pub compare: Compare,
}

/// How a value is compared with a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Compare {
    /// Unrounded.
    Exact,
    /// Rounded half-up first: E to three significant figures, ratios to 0.01, UGR to 0.1.
    Printed,
}

/// A requirement beyond or instead of the norm.
#[derive(Clone, Debug, PartialEq)]
pub struct CustomRequirement {
    /// What it limits.
    pub subject: CustomSubject,
    /// Quantity.
    pub quantity: Quantity,
    /// Statistic.
    pub statistic: Statistic,
    /// Lower limit.
    pub min: Option<f64>,
    /// Upper limit.
    pub max: Option<f64>,
    /// Light scene; `None`: the first.
    pub light_scene: Option<usize>,
    /// Why it holds instead of the norm's limit on the same; `None`: beyond the norm.
    pub instead: Option<Instead>,
}

/// A limit of the norm set aside by one of the user's own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instead {
    /// Why, in the user's words.
    pub reason: String,
    /// Where it is written.
    pub written: Place,
}

/// Subject of a [`CustomRequirement`], by index within the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CustomSubject {
    /// A room.
    Room(usize),
    /// An area.
    Area(usize),
    /// A viewpoint.
    Viewpoint(usize),
}

/// When to stop, and with which seed.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// Stopping goal.
    pub goal: Goal,
    /// Confidence of intervals, 0.95 by default.
    pub confidence: f64,
    /// Seed of all randomness.
    pub seed: u64,
}

/// Stopping goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Until every verdict is certain (or the block limit).
    Verdict,
    /// Until the relative standard error is reached.
    Relative(f64),
    /// For this many seconds of wall time, at a block's end.
    Seconds(f64),
}
