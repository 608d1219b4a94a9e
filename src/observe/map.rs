//! Maps of glare: a grid of eyes, each looking all round, from one solution of the light.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use crate::emitters::sighted_coarsely;
use crate::measure::glare_sources::Convention;
use crate::measure::{Answers, view, weights};
use crate::outcome::{IndexOutcome, Interval};
use crate::project::{GlareMap, Project, World};
use crate::query::{Demand, Kernel, Receiver};
use crate::solve::{Effort, Method, Sheet, answer, prepare};
use crate::units::Undefined;

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
    /// Blocks.
    pub blocks: usize,
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

/// All maps of a project from `blocks` blocks.
pub fn maps(project: &Project, blocks: usize) -> Vec<Mapped> {
    project.worlds.iter().flat_map(|world| of_world(project, world, blocks)).collect()
}

fn of_world(project: &Project, world: &World, blocks: usize) -> Vec<Mapped> {
    if world.glare_maps.is_empty() {
        return Vec::new();
    }
    let seed = project.accuracy.seed;
    let grids: Vec<(Vec<DVec3>, [DVec3; 2])> = world.glare_maps.iter().map(positions).collect();
    let mut demand = Demand { receivers: Vec::new(), rays: Vec::new(), flux: false };
    for (map, (eyes, _)) in world.glare_maps.iter().zip(&grids) {
        let kernels: Vec<Kernel> = sights(map).into_iter().map(|normal| Kernel::Planar { normal }).collect();
        demand.receivers.extend(eyes.iter().map(|&point| Receiver {
            point,
            lift: DVec3::ZERO,
            kernels: kernels.clone(),
        }));
    }
    let prepared = prepare(&world.scene, &demand, Method::Links, Effort::default(), seed);
    let sheets: Vec<Sheet> =
        (0..blocks as u64).into_par_iter().map(|block| answer(&prepared, block)).collect();
    let answers = Answers { sheets: &sheets, channels: world.scene.channels.len() };
    let first_rows = demand.first_rows();
    let alpha = 1.0 - project.accuracy.confidence;
    let convention = Convention::default();
    let mut receiver = 0;
    let mut found = Vec::new();
    for (map, (eyes, spacing)) in world.glare_maps.iter().zip(grids) {
        let light_scene = &project.light_scenes[map.light_scene.unwrap_or(0)];
        let room = &world.rooms[map.room];
        let weights = weights(world, light_scene, room, false);
        let sights = sights(map);
        let eye = |(number, &position): (usize, &DVec3)| -> MappedEye {
            let sighted = sighted_coarsely(prepared.emitters(), position, seed);
            let views = sights.iter().enumerate().map(|(direction, &gaze)| {
                let row = first_rows[receiver + number] + direction;
                let asked = view::Asked { gaze, row, indices: &map.indices, convention };
                let glare = view::glare(&answers, prepared.emitters(), &sighted, &asked, &weights, alpha);
                let further = glare.indices.iter().map(view::GaugedIndex::outcome).collect();
                (glare.ugr.interval(), further)
            });
            MappedEye { position, views: views.collect() }
        };
        let computed: Vec<MappedEye> = eyes.par_iter().enumerate().map(eye).collect();
        receiver += eyes.len();
        found.push(Mapped {
            name: map.name.clone(),
            room: room.name.clone(),
            footprint: room.footprint.clone(),
            light_scene: light_scene.name.clone(),
            spacing,
            azimuths_deg: azimuths_deg(map),
            convention: convention.words(),
            blocks,
            eyes: computed,
        });
    }
    found
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
