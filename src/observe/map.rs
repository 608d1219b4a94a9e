//! Maps of glare: a grid of eyes, each looking all round, from one solution of the light.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::emitters::{Emitters, Lookout, SeenPiece, Sighted, sighted_from};
use crate::estimate::Estimate;
use crate::glare::source::Given;
use crate::measure::beside::{self, Beside};
use crate::measure::glare_sources::Convention;
use crate::measure::{Answers, view, weights};
use crate::outcome::{IndexOutcome, Interval};
use crate::project::{GlareMap, Project, World};
use crate::query::{Demand, Kernel, Receiver};
use crate::scene::{Scene, in_a_surface, inside_furniture};
use crate::solve::{Effort, GlanceEffort, Mended, Method, Prepared, Sheet, answer, glances, mend, prepare};
use crate::units::Undefined;

/// Patches on large surfaces and links of each in the field of maps: finer than answers need.
const PATCHES: f64 = 4500.0;
const LINKS: u32 = 64;

/// A computed map.
#[derive(Clone, Debug)]
pub struct Mapped {
    /// Name of the map.
    pub name: String,
    /// Name of its room and the room's outline, m.
    pub room: String,
    /// Outline of the room in plan, m.
    pub footprint: Vec<DVec2>,
    /// Light scene.
    pub light_scene: String,
    /// Distance of neighbouring eyes along the two edges, m.
    pub spacing: [DVec3; 2],
    /// Azimuths of the lines of sight, degrees from +x towards +y.
    pub azimuths_deg: Vec<f64>,
    /// How the values were computed.
    pub convention: String,
    /// How they were computed besides.
    pub method: MapMethod,
    /// Whether something glossy is there.
    pub glossy: bool,
    /// The eyes, row by row.
    pub eyes: Vec<MappedEye>,
}

/// An eye of a map.
#[derive(Clone, Debug)]
pub struct MappedEye {
    /// Position, m.
    pub position: DVec3,
    /// For each azimuth UGR, and the indices wanted beside it.
    pub views: Vec<(Result<Interval, Undefined>, Vec<IndexOutcome>)>,
}

impl MappedEye {
    /// Highest UGR over all directions with the direction's number; `None` where nothing glares.
    pub fn worst(&self) -> Option<(usize, f64)> {
        let values = self.views.iter().enumerate();
        values
            .filter_map(|(number, (ugr, _))| Some((number, ugr.as_ref().ok()?.value)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// How a map is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MapMethod {
    /// By look-ups in the stored field, see [`swift_eyes`].
    Swift(GlanceEffort),
    /// By this many blocks: every value unbiased, with an interval that holds.
    Unbiased(usize),
}

impl Default for MapMethod {
    fn default() -> Self {
        Self::Swift(USUAL)
    }
}

/// What a map approximates, one sentence each.
pub fn approximations(map: &Mapped) -> Vec<&'static str> {
    let mut all = Vec::new();
    if matches!(map.method, MapMethod::Swift(_)) {
        all.push("Indirect light is looked up in a stored field that walks have mended on the mean over each patch; how it varies within a patch is left, and no interval holds it.");
        all.push("A luminaire is wholly visible if its corners and 16 points of it are; what none of 52 points shows is not seen; luminous surfaces are seen in pieces of 0.02 sr.");
    }
    if map.glossy {
        all.push("Highlights on glossy surfaces belong to the background.");
    }
    all
}

/// Why no eye of a map has luminances of task and surround; its project may not ask for them.
const NO_TASK: &str = "the eyes of a map have no task";

/// Why the eyes of a map have no VCP and GR.
const ON_VIEWPOINTS: &str = "maps do not compute it: list a viewpoint, and run `check`";

/// What is known beside the views of a map.
fn beside_views(world: &World, map: &GlareMap, weights: &[f64]) -> Beside<'static> {
    let ceiling = beside::ceiling(world, &world.rooms[map.room], weights, &map.indices);
    Beside {
        given: Given::default(),
        zones: Err(NO_TASK),
        field: Err(ON_VIEWPOINTS),
        ground: Err(ON_VIEWPOINTS),
        ceiling,
    }
}

/// The usual effort of a swift map. Rays by powers of two: Sobol points fill their strata only so.
pub const USUAL: GlanceEffort = GlanceEffort { replicates: 4, rays: 512, rough: 0.0105, walks: 32 };

/// All maps of a project.
pub fn maps(project: &Project, method: MapMethod) -> Vec<Mapped> {
    let mut found = Vec::new();
    for world in project.worlds.iter().filter(|world| !world.glare_maps.is_empty()) {
        let eyes = match method {
            MapMethod::Swift(effort) => {
                let demand = Demand::default();
                let prepared = prepare(
                    &world.scene,
                    &demand,
                    Method::Links,
                    field_effort(&world.scene),
                    project.accuracy.seed,
                );
                let of_map = |map: &GlareMap| {
                    let mended = mend_for(map, &prepared, &effort);
                    swift_eyes(project, world, map, &prepared, &mended, &effort)
                };
                world.glare_maps.iter().map(of_map).collect()
            }
            MapMethod::Unbiased(blocks) => unbiased_eyes(project, world, blocks, Effort::default()),
        };
        for (map, eyes) in world.glare_maps.iter().zip(eyes) {
            let room = &world.rooms[map.room];
            found.push(Mapped {
                name: map.name.clone(),
                room: room.name.clone(),
                footprint: room.footprint.clone(),
                light_scene: project.light_scenes[map.light_scene.unwrap_or(0)].name.clone(),
                spacing: positions(map).1,
                azimuths_deg: azimuths_deg(map),
                convention: Convention::default().words(),
                method,
                glossy: world.scene.has_lobes(),
                eyes,
            });
        }
    }
    found
}

/// What the field costs in which maps look things up.
pub fn field_effort(scene: &Scene) -> Effort {
    Effort { patch_m2: Some(scene.scattering_m2() / PATCHES), links: LINKS, ..Effort::default() }
}

/// The field of `prepared` (of no demand) mended for what a map's eyes see: the rest of the solution.
pub fn mend_for(map: &GlareMap, prepared: &Prepared, effort: &GlanceEffort) -> Mended {
    mend(prepared, &positions(map).0, &sights(map), effort)
}

/// The eyes of a map by look-ups in a mended field.
pub fn swift_eyes(
    project: &Project,
    world: &World,
    map: &GlareMap,
    prepared: &Prepared,
    mended: &Mended,
    effort: &GlanceEffort,
) -> Vec<MappedEye> {
    let (eyes, _) = positions(map);
    let sights = sights(map);
    let light_scene = &project.light_scenes[map.light_scene.unwrap_or(0)];
    let weights = weights(world, light_scene, &world.rooms[map.room], false);
    let seed = project.accuracy.seed;
    let indirect = glances(prepared, mended, &eyes, &sights, &weights, effort);
    let emitters = prepared.emitters();
    let alpha = 1.0 - project.accuracy.confidence;
    let convention = Convention::default();
    let lookout = Lookout::new(emitters, seed);
    let beside = beside_views(world, map, &weights);
    let eye = |(number, &position): (usize, &DVec3)| -> MappedEye {
        if let Some(shut) = shut_eye(world, map, position) {
            return shut;
        }
        let sighted = lookout.from(position);
        let views = sights.iter().enumerate().map(|(direction, &gaze)| {
            let of_replicates: Vec<f64> =
                indirect[number].chunks_exact(sights.len()).map(|lx| lx[direction]).collect();
            let light = view::EyeLight {
                from_luminaires: from_luminaires(&sighted, emitters, gaze, &weights),
                indirect: Estimate::from_blocks(&of_replicates),
            };
            let asked = view::Asked { gaze, indices: &map.indices, convention, beside };
            let glare = view::glare(&light, emitters, &sighted, &asked, &weights, alpha);
            let further = glare.indices.iter().map(view::GaugedIndex::outcome).collect();
            (glare.ugr.interval(), further)
        });
        MappedEye { position, views: views.collect() }
    };
    eyes.par_iter().enumerate().map(eye).collect()
}

/// Illuminance of the plane of the eye straight from the luminaires that it sees.
pub(super) fn from_luminaires(
    sighted: &Sighted,
    emitters: &Emitters,
    gaze: DVec3,
    weights: &[f64],
) -> Estimate {
    let (mut value, mut variance) = (0.0, 0.0);
    for one in &sighted.luminaires {
        let weight = weights[emitters.sources[one.source].channel];
        // Piece by piece: an opening overhead lies partly behind the eye.
        let light = |piece: &SeenPiece| piece.normal_lx * piece.direction.dot(gaze).max(0.0);
        let whole: f64 = match one.pieces.as_slice() {
            [] => one.light.dot(gaze).max(0.0),
            pieces => pieces.iter().map(light).sum(),
        };
        value += weight * whole;
        variance += (weight * one.normal_lx.se * one.direction.dot(gaze).max(0.0)).powi(2);
    }
    Estimate { value, se: f64::sqrt(variance), n: 0, skew: 0.0 }
}

/// The eyes of all maps of a world from blocks of unbiased answers.
pub fn unbiased_eyes(project: &Project, world: &World, blocks: usize, effort: Effort) -> Vec<Vec<MappedEye>> {
    let all: Vec<(&GlareMap, Vec<DVec3>)> =
        world.glare_maps.iter().map(|map| (map, positions(map).0)).collect();
    let see = |emitters: &Emitters, eye: DVec3| sighted_from(emitters, eye, project.accuracy.seed, false);
    unbiased_at(project, world, &all, blocks, effort, see)
}

/// Some eyes of maps from blocks of unbiased answers; `see` tells what an eye sees of the luminaires.
pub fn unbiased_at(
    project: &Project,
    world: &World,
    all: &[(&GlareMap, Vec<DVec3>)],
    blocks: usize,
    effort: Effort,
    see: impl Fn(&Emitters, DVec3) -> Sighted + Sync,
) -> Vec<Vec<MappedEye>> {
    let seed = project.accuracy.seed;
    let mut demand = Demand::default();
    for (map, eyes) in all {
        let kernels: Vec<Kernel> = sights(map).into_iter().map(|normal| Kernel::Planar { normal }).collect();
        let receiver = |&point: &DVec3| Receiver { point, lift: DVec3::ZERO, kernels: kernels.clone() };
        demand.receivers.extend(eyes.iter().map(receiver));
    }
    let prepared = prepare(&world.scene, &demand, Method::Links, effort, seed);
    let sheets: Vec<Sheet> =
        (0..blocks as u64).into_par_iter().map(|block| answer(&prepared, block)).collect();
    let answers = Answers::of(&sheets, &world.scene);
    let (first_rows, emitters) = (demand.first_rows(), prepared.emitters());
    let alpha = 1.0 - project.accuracy.confidence;
    let convention = Convention::default();
    let mut receiver = 0;
    let mut found = Vec::new();
    for (map, eyes) in all {
        let light_scene = &project.light_scenes[map.light_scene.unwrap_or(0)];
        let weights = weights(world, light_scene, &world.rooms[map.room], false);
        let (sights, beside) = (sights(map), beside_views(world, map, &weights));
        let eye = |(number, &position): (usize, &DVec3)| -> MappedEye {
            if let Some(shut) = shut_eye(world, map, position) {
                return shut;
            }
            let sighted = see(emitters, position);
            let views = sights.iter().enumerate().map(|(direction, &gaze)| {
                let row = first_rows[receiver + number] + direction;
                let light = view::EyeLight::of_row(&answers, row, &weights);
                let asked = view::Asked { gaze, indices: &map.indices, convention, beside };
                let glare = view::glare(&light, emitters, &sighted, &asked, &weights, alpha);
                let further = glare.indices.iter().map(view::GaugedIndex::outcome).collect();
                (glare.ugr.interval(), further)
            });
            MappedEye { position, views: views.collect() }
        };
        let computed: Vec<MappedEye> = eyes.par_iter().enumerate().map(eye).collect();
        receiver += eyes.len();
        found.push(computed);
    }
    found
}

/// What is said of a position where nobody can be: outside of the map's room, or inside furniture.
fn shut_eye(world: &World, map: &GlareMap, position: DVec3) -> Option<MappedEye> {
    let reason = if !world.rooms[map.room].contains(position) {
        "the position lies outside of the room"
    } else if inside_furniture(&world.scene, position, DVec3::Z, false) {
        "the position lies inside furniture"
    } else if in_a_surface(&world.scene, position) {
        "the position lies in a surface"
    } else {
        return None;
    };
    let nothing = |_| (Err(Undefined::because(reason)), Vec::new());
    Some(MappedEye { position, views: (0..map.directions).map(nothing).collect() })
}

/// Cell centres of the rectangle and the cells' edges.
fn positions(map: &GlareMap) -> (Vec<DVec3>, [DVec3; 2]) {
    let counts = map.edges.map(|edge| (edge.length() / map.step_m).round().max(1.0));
    let [u, v] = [map.edges[0] / counts[0], map.edges[1] / counts[1]];
    let mut eyes = Vec::new();
    for row in 0..counts[1] as u32 {
        for column in 0..counts[0] as u32 {
            eyes.push(map.origin + (f64::from(column) + 0.5) * u + (f64::from(row) + 0.5) * v);
        }
    }
    (eyes, [u, v])
}

fn azimuths_deg(map: &GlareMap) -> Vec<f64> {
    (0..map.directions).map(|k| 360.0 * f64::from(k) / f64::from(map.directions)).collect()
}

fn sights(map: &GlareMap) -> Vec<DVec3> {
    let of = |azimuth: f64| DVec3::new(azimuth.to_radians().cos(), azimuth.to_radians().sin(), 0.0);
    azimuths_deg(map).into_iter().map(of).collect()
}
