//! The observers of a project alone: their glare in every direction, by any convention. Areas and
//! requirements are left out, so that only the light at the eyes is solved for.

pub mod body;
pub mod map;

use glam::DVec3;
use rayon::prelude::*;

use crate::emitters::sighted_from;
use crate::measure::glare_sources::{Convention, SourceModel};
use crate::measure::{Answers, view, weights};
use crate::outcome::{IndexOutcome, Interval};
use crate::project::{Project, World};
use crate::query::{Demand, Kernel, Receiver};
use crate::solve::{Effort, Method, Sheet, answer, prepare};
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
    let demand = Demand { receivers: receivers.collect(), rays: Vec::new(), flux: false };
    if demand.receivers.is_empty() {
        return Vec::new();
    }
    let prepared = prepare(&world.scene, &demand, Method::Links, Effort::default(), seed);
    let sheets: Vec<Sheet> =
        (0..blocks as u64).into_par_iter().map(|block| answer(&prepared, block)).collect();
    let answers = Answers { sheets: &sheets, channels: world.scene.channels.len() };
    let alpha = 1.0 - project.accuracy.confidence;
    let first_rows = demand.first_rows();
    let one = |index: usize| -> Vec<Observed> {
        let viewpoint = &world.viewpoints[index];
        let light_scene = &project.light_scenes[viewpoint.light_scene.unwrap_or(0)];
        let weights = weights(world, light_scene, &world.rooms[viewpoint.room], false);
        let sighted = sighted_from(prepared.emitters(), viewpoint.eye, seed);
        let mut found = Vec::new();
        for &convention in conventions {
            let start = found.len();
            for (number, &gaze) in viewpoint.directions.iter().enumerate() {
                let row = first_rows[index] + number;
                let asked = view::Asked { gaze, row, indices: &viewpoint.indices, convention };
                let glare = view::glare(&answers, prepared.emitters(), &sighted, &asked, &weights, alpha);
                found.push(Observed {
                    viewpoint: viewpoint.name.clone(),
                    light_scene: light_scene.name.clone(),
                    eye: viewpoint.eye,
                    azimuth_deg: gaze.y.atan2(gaze.x).to_degrees() + 0.0,
                    tilt_deg: gaze.z.clamp(-1.0, 1.0).asin().to_degrees(),
                    convention,
                    ugr: glare.ugr.interval(),
                    indices: glare.indices.iter().map(view::GaugedIndex::outcome).collect(),
                    background_cd_m2: glare.background_cd_m2,
                    e_v_lx: glare.e_v_lx,
                    worst: false,
                });
            }
            mark_worst(&mut found[start..]);
        }
        found
    };
    let each: Vec<Vec<Observed>> = (0..world.viewpoints.len()).into_par_iter().map(one).collect();
    each.into_iter().flatten().collect()
}

fn mark_worst(views: &mut [Observed]) {
    let value = |view: &Observed| view.ugr.as_ref().map_or(f64::NEG_INFINITY, |ugr| ugr.value);
    let highest = views.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    if let Some(worst) = views.iter_mut().find(|view| view.ugr.is_ok() && value(view) >= highest) {
        worst.worst = true;
    }
}
