//! The observers of a project alone: their glare in every direction, by any convention. Areas and
//! requirements are left out, so that only the light at the eyes is solved for.

pub mod body;
pub mod cards;
pub mod map;
pub mod stored;

use glam::DVec3;
use rayon::prelude::*;

use crate::emitters::{Sighted, sighted_from};
use crate::glare::of_image::{Options, glare_of_image};
use crate::glare::ugr::ugr;
use crate::image::{Projection, View};
use crate::measure::beside::{self, Beside, Blockwise};
use crate::measure::glare_sources::{Convention, SourceModel};
use crate::measure::zones::ZoneLight;
use crate::measure::{Answers, room_ugr, view, weights};
use crate::outcome::{GlareSourceOutcome, IndexOutcome, Interval, UgrTableOutcome, ViewpointOutcome};
use crate::plan::{BEHIND, NOT_ASKED, PlannedTask, TaskZones, concerns_task, field_of_view};
use crate::project::{Project, Room, Viewpoint, World};
use crate::query::{Demand, Kernel, Receiver};
use crate::solve::{Effort, Method, Prepared, Sheet, answer, prepare, thumbnail};
use crate::units::Undefined;

/// All conventions that a comparison shows: the default first.
pub const CONVENTIONS: [Convention; 6] = {
    use crate::glare::position_index::PositionModel::{Levin, Table};
    use SourceModel::{Centre, Subdivided, Visible};
    [
        Convention { sources: Visible, position: Table },
        Convention { sources: Visible, position: Levin },
        Convention { sources: Subdivided, position: Table },
        Convention { sources: Subdivided, position: Levin },
        Convention { sources: Centre, position: Table },
        Convention { sources: Centre, position: Levin },
    ]
};

/// Glare of an observer in one direction under one light scene by one convention.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Name of the viewpoint.
    pub viewpoint: String,
    /// Light scene.
    pub light_scene: String,
    /// Eye, m.
    pub eye: DVec3,
    /// Azimuth of the line of sight, degrees from +x towards +y.
    pub azimuth_deg: f64,
    /// Its tilt above the horizon, degrees.
    pub tilt_deg: f64,
    /// The convention.
    pub convention: Convention,
    /// UGR.
    pub ugr: Result<Interval, Undefined>,
    /// The indices that the viewpoint asks for beside it.
    pub indices: Vec<IndexOutcome>,
    /// L_b, cd/m².
    pub background_cd_m2: f64,
    /// E_v, lx.
    pub e_v_lx: f64,
    /// Whether no other direction of this viewpoint has a higher UGR by this convention.
    pub worst: bool,
    /// What makes UGR doubtful here, and what was counted as what.
    pub notes: Vec<String>,
    /// The sources, the most glaring first.
    pub sources: Vec<GlareSourceOutcome>,
    /// What its values approximate, one sentence each; empty where they are unbiased.
    pub approximations: Vec<String>,
    /// UGR of a picture of the view, where conventions are compared and a card is made.
    pub image: Option<ImageReading>,
    /// The view with its card: of the worst direction, or the only one, by the default convention.
    pub sheet: Option<Box<ViewpointOutcome>>,
}

/// UGR as image-based programs find it, in a picture of the stored field.
#[derive(Clone, Debug)]
pub struct ImageReading {
    /// UGR of the sources found in the picture.
    pub ugr: Result<f64, Undefined>,
    /// How many there are.
    pub found: usize,
    /// L_b of the picture, cd/m².
    pub background_cd_m2: f64,
    /// Edge of the picture, pixels.
    pub pixels: usize,
    /// How sources are found.
    pub convention: String,
}

/// Edge of the pictures in which sources are searched.
const IMAGE_PIXELS: usize = 500;

/// UGR of every room of a project by the table method, for the two customary spacings.
pub fn room_tables(project: &Project) -> Vec<(String, Vec<UgrTableOutcome>)> {
    let mut tables = room_ugr::Tables::default();
    let mut found = Vec::new();
    for world in &project.worlds {
        for room in &world.rooms {
            let mut of_room = Vec::new();
            for shr in [0.25, 1.0] {
                of_room.extend(room_ugr::of_room(&mut tables, world, room, shr));
            }
            found.push((room.name.clone(), of_room));
        }
    }
    found
}

/// All viewpoints of a project in all directions under their own light scene, from `blocks` blocks.
pub fn observe(project: &Project, conventions: &[Convention], blocks: usize) -> Vec<Observed> {
    let mut observed = Vec::new();
    for world in &project.worlds {
        observed.extend(of_world(project, world, conventions, blocks));
    }
    observed
}

fn of_world(project: &Project, world: &World, conventions: &[Convention], blocks: usize) -> Vec<Observed> {
    let seed = project.accuracy.seed;
    // One receiver for each eye; its kernels share rays, so all directions do.
    let receivers = world.viewpoints.iter().map(|viewpoint| Receiver {
        point: viewpoint.eye,
        lift: DVec3::ZERO,
        kernels: viewpoint.directions.iter().map(|&normal| Kernel::Planar { normal }).collect(),
    });
    let mut demand = Demand { receivers: receivers.collect(), rays: Vec::new(), flux: false };
    if demand.receivers.is_empty() {
        return Vec::new();
    }
    let tasks: Vec<Vec<Option<PlannedTask>>> =
        world.viewpoints.iter().map(|viewpoint| ask_tasks(viewpoint, &mut demand)).collect();
    let fields: Vec<Vec<Option<usize>>> =
        world.viewpoints.iter().map(|viewpoint| ask_fields(viewpoint, &mut demand)).collect();
    let prepared = prepare(&world.scene, &demand, Method::Links, Effort::default(), seed);
    let sheets: Vec<Sheet> =
        (0..blocks as u64).into_par_iter().map(|block| answer(&prepared, block)).collect();
    let answers = Answers::of(&sheets, &world.scene);
    let first_rows = demand.first_rows();
    let light = |index: usize, number: usize, weights: &[f64], _: &Sighted| {
        view::EyeLight::of_row(&answers, first_rows[index] + number, weights)
    };
    let zones = |index: usize, number: usize, weights: &[f64]| {
        let planned = tasks[index][number].as_ref().ok_or(BEHIND)?;
        Ok(ZoneLight::of_rows(&answers, planned, weights))
    };
    let field = |index: usize, number: usize, weights: &[f64]| {
        let row = fields[index][number].ok_or(NOT_ASKED)?;
        Ok(Blockwise::of_zone(&answers, row, weights))
    };
    let found = Light { at_eye: light, zones, field };
    let one = |index: usize| of_viewpoint(project, world, index, &prepared, conventions, Sheets::All, &found);
    let each: Vec<Vec<Observed>> = (0..world.viewpoints.len()).into_par_iter().map(one).collect();
    each.into_iter().flatten().collect()
}

/// Adds receivers for the zones about a viewpoint's task, one entry for each direction; none where no index asks for
/// them, or the task lies behind the eye.
fn ask_tasks(viewpoint: &Viewpoint, demand: &mut Demand) -> Vec<Option<PlannedTask>> {
    let wanted = concerns_task(&viewpoint.indices);
    let one = |&gaze: &DVec3| {
        let about = TaskZones::of(&viewpoint.task, viewpoint.eye, gaze).filter(|_| wanted)?;
        let first = demand.rows();
        demand.receivers.extend(about.receivers(viewpoint.eye));
        Some(PlannedTask { about, rows: [first, first + 1, first + 2] })
    };
    viewpoint.directions.iter().map(one).collect()
}

/// Adds a receiver for the field of view of every direction whose mean luminance is asked for.
fn ask_fields(viewpoint: &Viewpoint, demand: &mut Demand) -> Vec<Option<usize>> {
    let one = |&gaze: &DVec3| {
        let row = demand.rows();
        demand.receivers.push(field_of_view(&viewpoint.indices, viewpoint.eye, gaze)?);
        Some(row)
    };
    viewpoint.directions.iter().map(one).collect()
}

/// Why the observers alone have no GR.
const NO_AREA: &str = "GR is rated against the illuminance of an area, which `gershun check` computes";

/// Light for a viewpoint, the number of a direction and factors: two sources of it, one way to take it.
struct Light<E, Z, F> {
    /// In the eye.
    at_eye: E,
    /// Of the zones about the task.
    zones: Z,
    /// Mean luminance of the field of view.
    field: F,
}

/// Which views get a sheet with a card, whose picture takes most of the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sheets {
    /// The worst direction of every viewpoint.
    All,
    /// None.
    None,
}

/// A viewpoint in all its directions.
fn of_viewpoint<E, Z, F>(
    project: &Project,
    world: &World,
    index: usize,
    prepared: &Prepared,
    conventions: &[Convention],
    sheets: Sheets,
    light: &Light<E, Z, F>,
) -> Vec<Observed>
where
    E: Fn(usize, usize, &[f64], &Sighted) -> view::EyeLight,
    Z: Fn(usize, usize, &[f64]) -> Result<ZoneLight, &'static str>,
    F: Fn(usize, usize, &[f64]) -> Result<Blockwise, &'static str>,
{
    let alpha = 1.0 - project.accuracy.confidence;
    let viewpoint = &world.viewpoints[index];
    let light_scene = &project.light_scenes[viewpoint.light_scene.unwrap_or(0)];
    let weights = weights(world, light_scene, &world.rooms[viewpoint.room], false);
    let sighted = sighted_from(prepared.emitters(), viewpoint.eye, prepared.seed(), viewpoint.highlights);
    let ceiling = beside::ceiling(world, &world.rooms[viewpoint.room], &weights, &viewpoint.indices);
    let mut found = Vec::new();
    for &convention in conventions {
        let start = found.len();
        let mut glares = Vec::with_capacity(viewpoint.directions.len());
        for (number, &gaze) in viewpoint.directions.iter().enumerate() {
            let zones = (light.zones)(index, number, &weights);
            let beside = Beside {
                given: viewpoint.given,
                zones: zones.as_ref().map_err(|reason| *reason),
                field: (light.field)(index, number, &weights),
                ground: Err(NO_AREA),
                ceiling,
            };
            let asked = view::Asked { gaze, indices: &viewpoint.indices, convention, beside };
            let at_eye = (light.at_eye)(index, number, &weights, &sighted);
            let glare = view::glare(&at_eye, prepared.emitters(), &sighted, &asked, &weights, alpha);
            found.push(Observed {
                viewpoint: viewpoint.name.clone(),
                light_scene: light_scene.name.clone(),
                eye: viewpoint.eye,
                azimuth_deg: viewpoint.azimuths_deg[number],
                tilt_deg: crate::sphere::azimuth_tilt_deg(gaze)[1],
                convention,
                ugr: glare.ugr.interval(),
                indices: glare.indices.iter().map(view::GaugedIndex::outcome).collect(),
                background_cd_m2: glare.background_cd_m2,
                e_v_lx: glare.e_v_lx,
                worst: false,
                notes: glare.notes.clone(),
                sources: glare.sources.clone(),
                approximations: Vec::new(),
                sheet: None,
                image: None,
            });
            glares.push(glare);
        }
        mark_worst(&mut found[start..]);
        if sheets == Sheets::None {
            continue;
        }
        for (view, number) in found[start..].iter_mut().zip(0..) {
            if convention == Convention::default() && (view.worst || viewpoint.directions.len() == 1) {
                let gaze = viewpoint.directions[number];
                view.image =
                    (conventions.len() > 1).then(|| of_image(prepared, viewpoint.eye, gaze, &weights));
                let glare = glares.swap_remove(number);
                let rooms = &world.rooms;
                view.sheet = Some(Box::new(sheet(view, gaze, prepared, rooms, &sighted, &weights, glare)));
                break;
            }
        }
    }
    found
}

fn of_image(prepared: &Prepared, eye: DVec3, gaze: DVec3, weights: &[f64]) -> ImageReading {
    let options = Options::default();
    let up = if gaze.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
    let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let glare = View::new(fisheye, eye, gaze, up)
        .ok()
        .and_then(|view| thumbnail(prepared, &view, [IMAGE_PIXELS; 2], weights))
        .ok_or_else(|| Undefined::because("there is no picture"))
        .and_then(|image| glare_of_image(&image, None, &options));
    match glare {
        Ok(glare) => ImageReading {
            ugr: ugr(&glare.sight.sources, glare.sight.background),
            found: glare.sources.len(),
            background_cd_m2: glare.sight.background.0,
            pixels: IMAGE_PIXELS,
            convention: glare.convention,
        },
        Err(undefined) => ImageReading {
            ugr: Err(undefined),
            found: 0,
            background_cd_m2: 0.0,
            pixels: IMAGE_PIXELS,
            convention: String::new(),
        },
    }
}

/// A view with its card.
fn sheet(
    view: &Observed,
    gaze: DVec3,
    prepared: &Prepared,
    rooms: &[Room],
    sighted: &Sighted,
    weights: &[f64],
    glare: view::Glare,
) -> ViewpointOutcome {
    let mut outcome = ViewpointOutcome {
        name: view.viewpoint.clone(),
        light_scene: view.light_scene.clone(),
        eye: view.eye,
        direction: gaze,
        azimuth_deg: view.azimuth_deg,
        tilt_deg: view.tilt_deg,
        ugr: view.ugr.clone(),
        indices: view.indices.clone(),
        convention: view.convention.words(),
        background_cd_m2: view.background_cd_m2,
        e_v_lx: view.e_v_lx,
        sources: glare.sources,
        notes: glare.notes,
        card: None,
    };
    outcome.card = cards::card(prepared, rooms, sighted, &outcome, weights, view.convention);
    outcome
}

fn mark_worst(views: &mut [Observed]) {
    let value = |view: &Observed| view.ugr.as_ref().map_or(f64::NEG_INFINITY, |ugr| ugr.value);
    let highest = views.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    if let Some(worst) = views.iter_mut().find(|view| view.ugr.is_ok() && value(view) >= highest) {
        worst.worst = true;
    }
}
