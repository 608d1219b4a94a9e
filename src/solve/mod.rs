//! The solver: `prepare` builds the frozen field once, `answer` gives one independent, unbiased
//! replicate of everything a [`Demand`] asks. It knows no norm, no observer and no report.

mod aims;
mod answer;
mod beacons;
mod chains;
mod covered;
mod double;
pub mod far_field;
mod flux;
mod gaps;
mod glance;
mod highlights;
mod lobe;
mod local;
mod look;
pub mod nodal;
mod path;
pub mod picture;
mod prepare;
mod refine;
mod survival;
mod sweep;
mod thumbnail;

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use crate::emitters::{ByChance, Emitters, facing_pairs, twice_mirrored, unshadowed};
use crate::field::LuminanceField;
use crate::field::store::StoredField;
use crate::query::{Demand, Kernel, Ray};
use crate::rng::Rng;
use crate::scene::Scene;

use beacons::{Beacons, Chances};
use gaps::Gaps;

pub use glance::{GlanceEffort, Mended, as_stored, glances, mend};
pub use local::{LocalEffort, LocalKernel, SeenForm};
pub use thumbnail::thumbnail;

/// Number of parts in which a sheet keeps every answer.
pub const PARTS: usize = 3;

/// Parts of an answer; their sum is the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Part {
    /// Straight from luminaires, panes on the way included.
    Direct = 0,
    /// From luminaires by one reflection in a planar mirror or pane (their images).
    Image = 1,
    /// All other light.
    Indirect = 2,
}

/// How answers are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Frozen field, gather rays and residual walks (METHOD of this project: links).
    Links,
    /// Independent path tracing; shares only scene and tracer with `Links`.
    Path,
    /// Local estimation: chains of light, every vertex connected to every receiver.
    Local,
    /// Double local estimation: as `Local`, and what lines of sight meet is connected as well.
    Double,
}

/// Effort of one block; any values give unbiased answers, they trade noise against time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Patch area of the field, m²; `None`: chosen from the scene's surface area.
    pub patch_m2: Option<f64>,
    /// Whether patches over which direct light varies strongly are split.
    pub adaptive: bool,
    /// Transport links per patch side.
    pub links: u32,
    /// Gather rays per receiver and block.
    pub gather: u32,
    /// Rays drawn about highlights, per receiver and block where a glossy plane reflects luminaires.
    pub highlights: u32,
    /// Rays drawn to bright patches, per receiver and block where a few of them make most of its light.
    pub beacons: u32,
    /// Residual walks per receiver and block, ≤ `gather`.
    pub walks: u32,
    /// Rays by which a residual vertex looks at the field around it; the walk goes on along the first.
    pub looks: u32,
    /// Shadow rays that a residual vertex spends on average at most.
    pub shadow_rays: f64,
    /// Points of each opening tested for visibility per receiver and block.
    pub opening_points: u32,
    /// Particles of the flux tally per block.
    pub particles: u32,
    /// Paths per receiver and block of the path tracer.
    pub paths: u32,
    /// Of the methods `Local` and `Double`.
    pub local: LocalEffort,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            patch_m2: None,
            adaptive: true,
            links: 32,
            gather: 16,
            highlights: 4,
            beacons: 8,
            walks: 2,
            looks: 4,
            shadow_rays: 8.0,
            opening_points: 1,
            particles: 1024,
            paths: 16,
            local: LocalEffort::default(),
        }
    }
}

/// What is computed once for a scene and a demand, then frozen.
pub struct Prepared<'s> {
    scene: &'s Scene,
    emitters: Emitters<'s>,
    demand: &'s Demand,
    effort: Effort,
    method: Method,
    seed: u64,
    /// Where glossy planes reflect luminaires.
    highlights: highlights::Highlights,
    /// The stored field; empty for the path tracer.
    field: Option<LuminanceField>,
    /// Where something lies right before a patch: there the field counts as dark.
    gaps: Gaps,
    /// Bright patches of the field.
    beacons: Beacons,
    /// Their chances to be aimed at from every receiver; empty where there are none.
    chances: Vec<Chances>,
    /// The same from the middle of every patch side, for walks; empty where there are no beacons.
    side_chances: Vec<Chances>,
    /// What chains start from; only for local estimation.
    origins: Option<chains::Origins>,
    /// Largest G = cos θ cos θ′/d² of a connection, 1/m²; the rest is made up for.
    bound_m2: f64,
    /// Per row and source: unshadowed illuminance, lx.
    unshadowed: Vec<Vec<f64>>,
    /// First row of each receiver.
    first_rows: Vec<usize>,
    /// Per row: what rays find by chance only; empty where no two mirrors show a luminaire.
    by_chance: Vec<Vec<ByChance>>,
    /// Per row of receivers: whether anything from which light may come lies where the kernel responds.
    may_hide: Vec<bool>,
}

/// One replicate of every answer.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// `[(row · channels + channel) · PARTS + part]`.
    pub values: Vec<f64>,
    /// Flux tally, if asked for.
    pub flux: Option<FluxSheet>,
    /// Counts of this block.
    pub counts: Counts,
}

/// Flux tally of one block, lm at initial flux.
#[derive(Clone, Debug, Default)]
pub struct FluxSheet {
    /// Incident on each surface (both sides): `[surface · channels + channel]`.
    pub incident: Vec<f64>,
    /// Absorbed by each surface, same layout.
    pub absorbed: Vec<f64>,
    /// Left the scene, per channel.
    pub escaped: Vec<f64>,
    /// Started from luminaires and emitting surfaces, per channel.
    pub emitted: Vec<f64>,
    /// From *point* sources to diffuse surfaces by specular reflection that no image covers: what the
    /// other answers omit, per channel.
    pub omitted: Vec<f64>,
}

/// Ray counts of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Closest-hit rays.
    pub rays: u64,
    /// Rays that left the scene.
    pub escaped: u64,
    /// Walks cut because light cannot leave a purely specular cage.
    pub cut: u64,
}

impl Counts {
    /// Adds another block's counts.
    pub fn add(&mut self, other: Self) {
        self.rays += other.rays;
        self.escaped += other.escaped;
        self.cut += other.cut;
    }
}

impl std::fmt::Debug for Prepared<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Prepared({:?}, {} rows)", self.method, self.demand.rows())
    }
}

/// Prepares a scene for a demand; draws from stream 0 of `seed`.
pub fn prepare<'s>(
    scene: &'s Scene,
    demand: &'s Demand,
    method: Method,
    effort: Effort,
    seed: u64,
) -> Prepared<'s> {
    let emitters = Emitters::new(scene);
    let highlights = highlights::Highlights::new(&emitters);
    let (field, gaps) = match method {
        Method::Links => Some(prepare::field(&emitters, &highlights, &effort, seed)).unzip(),
        Method::Path | Method::Local | Method::Double => (None, None),
    };
    let beacons = field.as_ref().map_or_else(Beacons::default, |field| {
        Beacons::new(scene, field.patches(), |side| field.at(side).iter().sum())
    });
    let chances = match &field {
        Some(field) if !beacons.is_empty() => chances_of(&emitters, demand, field, &beacons, seed),
        _ => Vec::new(),
    };
    let side_chances = match &field {
        Some(field) if !beacons.is_empty() => side_chances_of(scene, field, &beacons),
        _ => Vec::new(),
    };
    let unshadowed = match method {
        Method::Links | Method::Local | Method::Double => unshadowed_rows(&emitters, demand),
        Method::Path => Vec::new(),
    };
    let by_chance = by_chance_rows(&emitters, demand, rays_of(method, &effort));
    let origins = match method {
        Method::Local | Method::Double => Some(chains::Origins::new(scene)),
        Method::Links | Method::Path => None,
    };
    Prepared {
        scene,
        highlights,
        emitters,
        demand,
        effort,
        method,
        seed,
        field,
        gaps: gaps.unwrap_or_default(),
        beacons,
        chances,
        side_chances,
        origins,
        bound_m2: local::bound_m2(scene, &effort.local),
        unshadowed,
        first_rows: demand.first_rows(),
        by_chance,
        may_hide: may_hide_rows(scene, demand),
    }
}

/// A demand for nothing.
static NOTHING: Demand = Demand { receivers: Vec::new(), rays: Vec::new(), flux: false };

/// A scene with its field as it was stored, for look-ups ([`glances`]) and pictures; blocks of it answer nothing.
pub fn prepare_stored(scene: &Scene, stored: StoredField) -> Prepared<'_> {
    let emitters = Emitters::new(scene);
    let effort = Effort::default();
    Prepared {
        scene,
        highlights: highlights::Highlights::new(&emitters),
        emitters,
        demand: &NOTHING,
        effort,
        method: Method::Links,
        seed: stored.made.seed,
        field: Some(stored.field),
        gaps: Gaps::default(),
        beacons: Beacons::default(),
        chances: Vec::new(),
        side_chances: Vec::new(),
        origins: None,
        bound_m2: local::bound_m2(scene, &effort.local),
        unshadowed: Vec::new(),
        first_rows: Vec::new(),
        by_chance: Vec::new(),
        may_hide: Vec::new(),
    }
}

/// Block `block` (0-based) of the answers: draws from stream `block + 1` of the seed.
pub fn answer(prepared: &Prepared, block: u64) -> Sheet {
    let mut sheet = match prepared.method {
        Method::Links => answer::block(prepared, block + 1),
        Method::Path => path::block(prepared, block + 1),
        Method::Local | Method::Double => local::block(prepared, block + 1),
    };
    if prepared.demand.flux {
        sheet.flux = Some(flux::block(prepared, block + 1, &mut sheet.counts));
    }
    sheet
}

/// Luminance along a ray by the method of links, added to `row`: one value per channel and part, cd/m².
/// For those who have more rays than a sheet should hold.
pub fn answer_ray(prepared: &Prepared, ray: &Ray, rng: &mut Rng, row: &mut [f64]) {
    answer::one_ray(prepared, ray, rng, row);
}

impl Prepared<'_> {
    /// Seed of all randomness.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Per row of receivers, what a block finds by chance only and how often; empty if there is no such light.
    pub fn by_chance(&self) -> &[Vec<ByChance>] {
        &self.by_chance
    }

    /// Per row of receivers, whether there may be light that no luminaire sends straight.
    pub fn may_hide(&self) -> &[bool] {
        &self.may_hide
    }

    /// The emitters, for what an observer sees.
    pub fn emitters(&self) -> &Emitters<'_> {
        &self.emitters
    }

    /// Chances of bright patches at a place of a patch side.
    fn chances_of_side(&self, side: usize) -> &Chances {
        self.side_chances.get(side).unwrap_or(&beacons::NOWHERE)
    }

    /// Number of stored patches, for the result's record.
    pub fn patches(&self) -> usize {
        self.field.as_ref().map_or(0, |field| field.patches().len())
    }
}

/// Chances of bright patches at every receiver.
fn chances_of(
    emitters: &Emitters,
    demand: &Demand,
    field: &LuminanceField,
    beacons: &Beacons,
    seed: u64,
) -> Vec<Chances> {
    let receivers = demand.receivers.par_iter().enumerate();
    receivers
        .map(|(index, receiver)| {
            let origin = lifted(emitters.scene, receiver.point, receiver.lift);
            let kernels = &receiver.kernels;
            let response = |direction| kernels.iter().map(|kernel| kernel.response(direction)).sum();
            let mut rng = Rng::new(seed, 0, beacons::ITEM + index as u64);
            let seen = beacons.seen(emitters, field, origin, kernels, &mut rng);
            let mut chances = Chances::default();
            beacons.about(origin, response, kernels.len(), None, Some(&seen), &mut chances);
            chances
        })
        .collect()
}

/// Chances of bright patches at places of every patch side, as seen from its middle.
fn side_chances_of(scene: &Scene, field: &LuminanceField, beacons: &Beacons) -> Vec<Chances> {
    let patches = field.patches();
    let of_side = |side: usize| {
        let mut chances = Chances::default();
        let (reflectance, transmittance) = scene.bsdf(patches.triangle(side)).diffuse();
        let albedo = reflectance + transmittance;
        if albedo > 0.0 {
            let (middle, front) = patches.centre(side);
            let normal = if side.is_multiple_of(2) { front } else { -front }.normalize_or_zero();
            // Density of the directions that reflection and transmission draw, times π.
            let scattered = |direction: DVec3| {
                let cos = normal.dot(direction);
                cos.abs() * if cos > 0.0 { reflectance } else { transmittance } / albedo
            };
            // The field's luminance here is albedo/π times what comes: ∫ scattered · L dω = π L̃/albedo.
            let known = PI * field.at(side).iter().sum::<f64>() / albedo;
            beacons.about(middle, scattered, 1, Some(known), None, &mut chances);
        }
        chances
    };
    (0..patches.sides()).into_par_iter().map(of_side).collect()
}

/// Farther than this before a plane, m, lies what a receiver on it may see.
const BEFORE_M: f64 = 1e-6;

/// For every kernel row whether a surface that may send it light lies where it responds: ground under the open sky
/// sends none to planes that look up.
fn may_hide_rows(scene: &Scene, demand: &Demand) -> Vec<bool> {
    let returning = scene.returning();
    let before = |point: DVec3, kernel: &Kernel| match *kernel {
        Kernel::Planar { normal } => returning.iter().any(|&triangle| {
            let corners = scene.mesh.corners(triangle as usize);
            corners.iter().any(|corner| (*corner - point).dot(normal) > BEFORE_M)
        }),
        Kernel::Cylindrical { .. }
        | Kernel::Semicylindrical { .. }
        | Kernel::Hemispherical { .. }
        | Kernel::Spherical
        | Kernel::Zone(_) => !returning.is_empty(),
    };
    let receivers = demand.receivers.par_iter();
    receivers
        .flat_map_iter(|receiver| receiver.kernels.iter().map(|kernel| before(receiver.point, kernel)))
        .collect()
}

/// Unshadowed illuminance of every kernel row from every luminaire (images excluded); none where the kernel has
/// edges, which is sampled with what is kept off.
fn unshadowed_rows(emitters: &Emitters, demand: &Demand) -> Vec<Vec<f64>> {
    demand
        .receivers
        .par_iter()
        .flat_map_iter(|receiver| {
            // Lifted as shadow rays are, so that what is wholly shaded gets nothing to the last digit.
            let point = lifted(emitters.scene, receiver.point, receiver.lift);
            receiver.kernels.iter().map(move |kernel| {
                let own = &emitters.sources[..emitters.scene.luminaires.len()];
                let own = if kernel.has_edge() { &[] } else { own };
                own.iter().map(|source| unshadowed(emitters, source, point, kernel)).collect()
            })
        })
        .collect()
}

/// Rays that follow the responses of a receiver with one kernel in each block.
fn rays_of(method: Method, effort: &Effort) -> u32 {
    match method {
        Method::Links => effort.gather,
        Method::Path => effort.paths,
        Method::Local | Method::Double => effort.local.returns,
    }
}

/// Light by two mirrors of every receiver's rows, with how often one *block* of so many rays finds it.
fn by_chance_rows(emitters: &Emitters, demand: &Demand, rays: u32) -> Vec<Vec<ByChance>> {
    let pairs = facing_pairs(emitters);
    if pairs.is_empty() || emitters.scene.luminaires.is_empty() {
        return Vec::new();
    }
    let per_block = |one: ByChance| ByChance { per_ray: one.per_ray * f64::from(rays), ..one };
    let receivers = demand.receivers.par_iter();
    receivers
        .flat_map_iter(|receiver| {
            let point = lifted(emitters.scene, receiver.point, receiver.lift);
            let rows = twice_mirrored(emitters, &pairs, point, &receiver.kernels);
            rows.into_iter().map(|row| row.into_iter().map(per_block).collect())
        })
        .collect()
}

/// Kernel of ray `sample` of `rays`, and its place in the sequence. Kernels take turns, and each has a run
/// of the sequence of its own: every second or eighth point would lie in one half or eighth of the square.
fn turn(sample: u32, rays: u32, kernels: usize) -> (usize, u32) {
    let kernel = sample as usize % kernels;
    (kernel, kernel as u32 * (rays / kernels as u32) + sample / kernels as u32)
}

/// The point moved off a surface it lies on; one in free space stays where it is.
fn lifted(scene: &Scene, point: DVec3, lift: DVec3) -> DVec3 {
    let offset_m = scene.tracer.offset_m();
    let moved = point + lift * offset_m;
    let touches = lift != DVec3::ZERO && scene.tracer.transmittance(moved, -lift, 4.0 * offset_m, &[]) < 1.0;
    if touches { moved } else { point }
}
