//! Requirements → queries: what must be computed at all, and why. Areas become grids of receivers,
//! observers become receivers at the eye, norm rows become requirements on them. After this step
//! nobody needs to know of norms or observers until the answers are measured.

mod areas;
mod ground;
mod hidden;
mod instead;
mod lattice;
mod norm_areas;
mod requirements;
mod tasks;
mod whole_room;
mod zones;

use glam::DVec3;

pub use ground::PlannedGround;
pub use requirements::other_plane;
pub use tasks::{
    BEHIND, FIELD_HALF_ANGLE_DEG, NOT_ASKED, PlannedTask, TaskZones, concerns_task, field_of_view,
};

use crate::grid::{self, Grid, GridError};
use crate::outcome::{Bound, Modified};
use crate::project::{AreaKind, AreaShape, CustomSubject, Modification, Place, Project, World};
use crate::quantity::{Property, Quantity, Statistic};
use crate::query::{Demand, Kernel, Receiver};

/// The plan of one world.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// What the solver is asked.
    pub demand: Demand,
    /// One entry for each room of the world.
    pub rooms: Vec<PlannedRoom>,
    /// What was decided and why, one sentence each.
    pub reasons: Vec<String>,
    /// Rows given out to kernels so far.
    kernels: usize,
}

/// What is asked in one room.
#[derive(Clone, Debug, Default)]
pub struct PlannedRoom {
    /// Areas.
    pub areas: Vec<PlannedArea>,
    /// Observers, one entry for each direction.
    pub views: Vec<PlannedView>,
    /// Requirements.
    pub requirements: Vec<PlannedRequirement>,
}

/// An area with its grid and the rows that answer it.
#[derive(Clone, Debug)]
pub struct PlannedArea {
    /// Name.
    pub name: String,
    /// Role.
    pub kind: AreaKind,
    /// Name of the task area it belongs to.
    pub of: Option<String>,
    /// Row of the norm by which it is judged.
    pub row: Option<String>,
    /// Its own modification of the row's illuminance, or that of its task.
    pub modified: Option<Modification>,
    /// Light scene by which it is judged.
    pub light_scene: usize,
    /// Where it lies.
    pub shape: AreaShape,
    /// Points.
    pub grid: Grid,
    /// Quantities with the rows that answer them.
    pub quantities: Vec<PlannedQuantity>,
}

/// One quantity on a grid.
#[derive(Clone, Debug)]
pub struct PlannedQuantity {
    /// Which.
    pub quantity: Quantity,
    /// For each grid point the sheet's row, or the rows of numerator and denominator; `None` where
    /// the point is excluded.
    pub rows: Vec<Option<Rows>>,
}

/// Where a point's answer stands in a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows {
    /// The value itself.
    One(usize),
    /// First over second.
    Ratio(usize, usize),
}

/// An observer looking in one direction.
#[derive(Clone, Debug)]
pub struct PlannedView {
    /// Name.
    pub name: String,
    /// Index among the world's viewpoints.
    pub viewpoint: usize,
    /// Eye, m.
    pub eye: DVec3,
    /// Unit line of sight.
    pub direction: DVec3,
    /// Its azimuth, degrees from +x towards +y.
    pub azimuth_deg: f64,
    /// Row of the illuminance at the eye.
    pub row: usize,
    /// Keys of the indices asked for beside UGR, by the viewpoint or by a requirement.
    pub indices: Vec<&'static str>,
    /// Light scene by which it is judged.
    pub light_scene: usize,
    /// Whether highlights are sources.
    pub highlights: bool,
    /// Zones about its task; `None` where no index asks for them, or the task lies behind the eye.
    pub task: Option<PlannedTask>,
    /// Row of the mean luminance of its field of view times π; `None` where no index asks for it.
    pub field: Option<usize>,
    /// The illuminated area that it is rated against, or why there is none.
    pub ground: Result<PlannedGround, &'static str>,
}

/// A requirement and what it is measured on.
#[derive(Clone, Debug)]
pub struct PlannedRequirement {
    /// Norm key or `project`.
    pub standard: String,
    /// Row or clause.
    pub clause: String,
    /// What it limits.
    pub subject: Subject,
    /// As printed.
    pub subject_name: String,
    /// Light scene.
    pub light_scene: usize,
    /// Quantity.
    pub quantity: Quantity,
    /// Statistic.
    pub statistic: Statistic,
    /// Limit.
    pub bound: Bound,
    /// Standing of the limit.
    pub verified: String,
    /// Where the limit stands instead of the norm's own.
    pub modified: Option<Modified>,
}

/// Subject of a planned requirement, by index within the planned room.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// Quantity `1` of area `0`.
    Area(usize, usize),
    /// All directions of a viewpoint (world index): the worst is judged.
    Viewpoint(usize),
    /// The room's UGR by the table method with this spacing-to-height ratio.
    UgrTable(f64),
    /// The same as discomfort index M.
    DiscomfortTable(f64),
    /// Mean of quantity `1` of area `0` over the mean of quantity `3` of its task area `2`.
    OfTask(usize, usize, usize, usize),
    /// Declared colour rendering of the room's luminaires.
    ColourRendering,
    /// Another declared property of the room's luminaires.
    Declared(Property),
    /// Emergency intensity of the luminaires of a type that hang in a class of heights.
    Intensity {
        /// Luminaire type.
        kind: String,
        /// Mounting heights from and below, m above the floor.
        heights_m: [f64; 2],
        /// Zone, degrees from straight down.
        zone_deg: [f64; 2],
    },
    /// Nothing in the project lets it be assessed; the reason.
    Missing(String),
}

/// A mistake that only planning can find.
#[derive(Clone, Debug, PartialEq)]
pub enum PlanError {
    /// The grid of an area cannot be laid.
    Grid {
        /// Area name.
        area: String,
        /// What is wrong.
        error: GridError,
        /// Where the area is written, if a user wrote it.
        place: Option<Place>,
    },
    /// Every point is excluded.
    NoPoints {
        /// Area name.
        area: String,
        /// Where the area is written, if a user wrote it.
        place: Option<Place>,
    },
    /// More points than can be answered.
    TooManyPoints {
        /// Rooms of the world, joined.
        rooms: String,
        /// How many there are at least.
        points: usize,
    },
    /// A requirement that is to hold instead of a limit which the norm does not have.
    NothingSetAside {
        /// What it limits.
        what: String,
        /// Where it is written.
        place: Option<Place>,
    },
    /// A row that does not exist.
    NoRow {
        /// Norm key.
        standard: String,
        /// Row as written.
        row: String,
        /// Who asked.
        by: String,
    },
}

impl std::error::Error for PlanError {}

impl std::fmt::Display for PlanError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (message, hint, place) = match self {
            Self::Grid { area, error, place } => (format!("area \"{area}\": {error}"), String::new(), place),
            Self::NoPoints { area, place } => (
                format!("area \"{area}\": every grid point lies inside furniture or another area"),
                "move the area, or give it a finer grid".to_owned(),
                place,
            ),
            Self::TooManyPoints { rooms, points } => (
                format!("room \"{rooms}\": {points} points and more are asked for, {} at most", grid::MAX_POINTS),
                "lengths are metres, in a CAD file too; else give the areas coarser grids: grid = { step = 1 }"
                    .to_owned(),
                &None,
            ),
            Self::NothingSetAside { what, place } => (
                format!("the norm has no such limit on {what} that could be set aside"),
                "leave `instead` out; `gershun check --explain-plan` lists what is required".to_owned(),
                place,
            ),
            Self::NoRow { standard, row, by } => (
                format!("norm {standard} has no row \"{row}\" (asked for by {by})"),
                format!("`gershun norm show {standard}` lists its rows"),
                &None,
            ),
        };
        match place {
            Some(place) => write!(f, "{}", place.mistake(message, hint)),
            None if hint.is_empty() => write!(f, "error: {message}"),
            None => write!(f, "error: {message}\n  = hint: {hint}"),
        }
    }
}

/// Plans one world.
///
/// # Errors
/// [`PlanError`]s of all areas at once.
pub fn plan(project: &Project, world: &World) -> Result<Plan, Vec<PlanError>> {
    let mut plan = Plan { rooms: vec![PlannedRoom::default(); world.rooms.len()], ..Plan::default() };
    let mut errors = Vec::new();
    areas::plan(project, world, &mut plan, &mut errors);
    for (index, viewpoint) in world.viewpoints.iter().enumerate() {
        let indices = indices(world, index);
        let named = viewpoint.area.map(|area| world.areas[area].name.as_str());
        let areas = &plan.rooms[viewpoint.room].areas;
        let ground = if indices.contains(&"GR") {
            ground::ground(&world.scene, areas, viewpoint, named)
        } else {
            Err(NOT_ASKED)
        };
        for (&direction, &azimuth_deg) in viewpoint.directions.iter().zip(&viewpoint.azimuths_deg) {
            let row = plan.ask(Receiver {
                point: viewpoint.eye,
                lift: DVec3::ZERO,
                kernels: vec![Kernel::Planar { normal: direction }],
            });
            let zones = concerns_task(&indices)
                .then(|| TaskZones::of(&viewpoint.task, viewpoint.eye, direction))
                .flatten();
            let task = zones.map(|about| {
                let rows = about.receivers(viewpoint.eye).map(|receiver| plan.ask(receiver));
                PlannedTask { about, rows }
            });
            let field = field_of_view(&indices, viewpoint.eye, direction).map(|field| plan.ask(field));
            plan.rooms[viewpoint.room].views.push(PlannedView {
                name: viewpoint.name.clone(),
                viewpoint: index,
                eye: viewpoint.eye,
                direction,
                azimuth_deg,
                row,
                indices: indices.clone(),
                light_scene: viewpoint.light_scene.unwrap_or(0),
                highlights: viewpoint.highlights,
                task,
                field,
                ground,
            });
        }
    }
    areas::number_rays(&mut plan);
    requirements::plan(project, world, &mut plan, &mut errors);
    plan.demand.flux = true;
    explain(project, world, &mut plan);
    if errors.is_empty() { Ok(plan) } else { Err(errors) }
}

/// Keys of the indices that a viewpoint lists, and of those that are required there.
fn indices(world: &World, viewpoint: usize) -> Vec<&'static str> {
    let mut keys = world.viewpoints[viewpoint].indices.clone();
    for requirement in &world.requirements {
        if let (Quantity::OfView { key, .. }, CustomSubject::Viewpoint(view)) =
            (requirement.quantity, requirement.subject)
            && view == viewpoint
            && !keys.contains(&key)
        {
            keys.push(key);
        }
    }
    keys
}

impl Plan {
    /// Adds a receiver and returns the row of its first kernel.
    fn ask(&mut self, receiver: Receiver) -> usize {
        let row = self.kernels;
        self.kernels += receiver.kernels.len();
        self.demand.receivers.push(receiver);
        row
    }
}

fn explain(project: &Project, world: &World, plan: &mut Plan) {
    let points = plan.demand.receivers.len();
    let specular = world.scene.surfaces().filter(|bsdf| bsdf.specular(1.0).is_some()).count();
    let glossy = world.scene.surfaces().filter(|bsdf| bsdf.lobe().is_some()).count();
    let mut say = |text: String| plan.reasons.push(text);
    say(format!(
        "{points} receivers and {} lines of sight ask for a stored field: light is solved once, then looked up.",
        plan.demand.rays.len()
    ));
    if glossy > 0 {
        say(format!(
            "Every scattering surface stores one number a side, the luminance of its diffuse part, which has no direction. The highlights of {glossy} glossy surfaces are not stored: their lobe is drawn at every look, luminaires in it by their openings as well."
        ));
    } else {
        say("Every surface stores one number a side: all scattering materials are diffuse, so their luminance has no direction.".into());
    }
    if specular > 0 {
        say(format!(
            "{specular} specular surfaces store nothing: rays are followed through them, and luminaires are imaged in their planes."
        ));
    } else {
        say("No surface is specular: rays end at the first surface.".into());
    }
    let groups = world.scene.channels.len();
    say(format!(
        "{groups} channels are solved at once; {} light scenes and the maintenance factors are weights on them.",
        project.light_scenes.len()
    ));
}
