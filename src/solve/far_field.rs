//! Luminous intensity of luminaires *as installed*: what leaves the scene in each direction, far away,
//! their own light past obstacles and the light that housings and walls reflect.
//!
//! I(ω) = Σ I_l(ω) V + 𝔼 Σ_n W_n f(ω_n → ω) |cosθ_n| V: the first part from the distributions, with the
//! visibility of points of the openings; the second by local estimation, where every diffuse vertex of a
//! particle of weight W (lm) adds to all directions at once. Both are unbiased and smooth. Light whose last
//! turn was by a mirror has no such estimate: it is counted in the cells of the table (hat functions), which
//! blurs it by one step of the table and is reported with its share.

use glam::DVec3;
use rayon::prelude::*;

use crate::estimate::Estimate;
use crate::photometry::{DistributionError, IntensityDistribution};
use crate::rng::{Rng, Stratified};
use crate::scene::Scene;
use crate::sphere;

const MOST_BOUNCES: u32 = 100_000;
/// A ray that goes on for ever, m.
const FOR_EVER: f64 = 1e30;

/// What is asked for.
#[derive(Clone, Debug)]
pub struct FarDemand {
    /// Luminaires of the scene and the factors of their flux.
    pub luminaires: Vec<(usize, f64)>,
    /// Azimuths of the table in project axes, degrees, from 0 up to but without 360.
    pub azimuths_deg: Vec<f64>,
    /// γ of the table, degrees, from 0 (straight down) to 180.
    pub gammas_deg: Vec<f64>,
    /// Particles per block.
    pub particles: u32,
    /// Directions of the table to which a vertex adds, at most.
    pub directions: usize,
    /// Points of each opening per direction and block.
    pub opening_points: u32,
    /// Independent blocks, at least 2.
    pub blocks: u64,
    /// Seed.
    pub seed: u64,
}

/// Luminous intensity of luminaires as installed.
#[derive(Clone, Debug)]
pub struct FarField {
    /// Azimuths of the table, degrees.
    pub azimuths_deg: Vec<f64>,
    /// γ of the table, degrees.
    pub gammas_deg: Vec<f64>,
    /// cd\[azimuth\]\[γ\], with errors over blocks.
    pub cd: Vec<Vec<Estimate>>,
    /// Flux of the luminaires, lm.
    pub emitted_lm: f64,
    /// Flux that leaves the scene, lm, counted apart from the table.
    pub escaped_lm: Estimate,
    /// The part of it whose last turn was by a mirror, lm: blurred by one step of the table.
    pub mirrored_lm: Estimate,
    /// Flux of the table as it is interpolated, lm.
    pub table_lm: Estimate,
}

impl FarField {
    /// The table as a distribution in project axes.
    ///
    /// # Errors
    /// When the axes are none.
    pub fn distribution(&self) -> Result<IntensityDistribution, DistributionError> {
        let means = |plane: &Vec<Estimate>| plane.iter().map(|cd| cd.value.max(0.0)).collect::<Vec<f64>>();
        grid(&self.azimuths_deg, &self.gammas_deg, self.cd.iter().map(means).collect())
    }

    /// Root of the mean square of the nodes' standard errors, as a share of the largest intensity.
    pub fn error(&self) -> f64 {
        let nodes: Vec<&Estimate> = self.cd.iter().flatten().collect();
        let largest = nodes.iter().map(|cd| cd.value).fold(0.0, f64::max);
        let square = nodes.iter().map(|cd| cd.se * cd.se).sum::<f64>() / nodes.len().max(1) as f64;
        square.sqrt() / largest
    }
}

fn grid(
    azimuths_deg: &[f64],
    gammas_deg: &[f64],
    mut cd: Vec<Vec<f64>>,
) -> Result<IntensityDistribution, DistributionError> {
    // One direction has one intensity: at the poles the planes are averaged.
    for pole in [0, gammas_deg.len().saturating_sub(1)] {
        let is_pole = gammas_deg.get(pole).is_some_and(|gamma| !(*gamma > 0.0 && *gamma < 180.0));
        let mean = cd.iter().map(|plane| plane[pole]).sum::<f64>() / cd.len().max(1) as f64;
        cd.iter_mut().filter(|_| is_pole).for_each(|plane| plane[pole] = mean);
    }
    let first = cd.first().cloned().unwrap_or_default();
    cd.push(first);
    let azimuths = azimuths_deg.iter().copied().chain([360.0]).collect();
    IntensityDistribution::from_grid(azimuths, gammas_deg.to_vec(), cd)
}

/// Computes the far field.
///
/// # Panics
/// When the axes are no axes or fewer than two blocks are asked for: the caller chooses them.
pub fn far_field(scene: &Scene, demand: &FarDemand) -> FarField {
    assert!(demand.blocks >= 2, "an error needs two blocks");
    let table = Table::new(&demand.azimuths_deg, &demand.gammas_deg);
    let sheets: Vec<Sheet> =
        (0..demand.blocks).into_par_iter().map(|block| block_of(scene, demand, &table, block)).collect();
    let over =
        |value: &dyn Fn(&Sheet) -> f64| Estimate::from_blocks(&sheets.iter().map(value).collect::<Vec<_>>());
    let columns = demand.gammas_deg.len();
    let node = |j: usize, i: usize| over(&|sheet| sheet.cd[j * columns + i]);
    let plane = |j: usize| (0..columns).map(|i| node(j, i)).collect::<Vec<_>>();
    let table_lm =
        |sheet: &Sheet| sheet.cd.iter().zip(&table.solid_angles_sr).map(|(cd, sr)| cd * sr).sum::<f64>();
    FarField {
        cd: (0..demand.azimuths_deg.len()).map(plane).collect(),
        emitted_lm: demand.luminaires.iter().map(|(index, factor)| flux_lm(scene, *index, *factor)).sum(),
        escaped_lm: over(&|sheet| sheet.escaped_lm),
        mirrored_lm: over(&|sheet| sheet.mirrored_lm),
        table_lm: over(&table_lm),
        azimuths_deg: demand.azimuths_deg.clone(),
        gammas_deg: demand.gammas_deg.clone(),
    }
}

fn flux_lm(scene: &Scene, index: usize, factor: f64) -> f64 {
    let lamp = &scene.luminaires[index];
    lamp.kind.flux_lm * lamp.dim * factor
}

/// One block's values.
struct Sheet {
    cd: Vec<f64>,
    escaped_lm: f64,
    mirrored_lm: f64,
}

/// Directions of the table and the solid angles of their hat functions: Σ I Δ is the interpolant's flux.
struct Table {
    azimuths_deg: Vec<f64>,
    gammas_deg: Vec<f64>,
    directions: Vec<DVec3>,
    solid_angles_sr: Vec<f64>,
}

impl Table {
    fn new(azimuths_deg: &[f64], gammas_deg: &[f64]) -> Self {
        let directions = azimuths_deg.iter().flat_map(|azimuth| {
            let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
            gammas_deg.iter().map(move |gamma| {
                let (sin, cos) = gamma.to_radians().sin_cos();
                DVec3::new(sin * cos_a, sin * sin_a, -cos)
            })
        });
        // The flux of a table that is 1 at one γ and 0 elsewhere, shared out by the planes' wedges.
        let ring_sr = |i: usize| {
            let hat = gammas_deg.iter().enumerate().map(|(k, _)| if k == i { 1.0 } else { 0.0 }).collect();
            IntensityDistribution::from_grid(vec![0.0, 360.0], gammas_deg.to_vec(), vec![hat; 2])
                .map_or(0.0, |ring| ring.flux().0)
        };
        let rings: Vec<f64> = (0..gammas_deg.len()).map(ring_sr).collect();
        let count = azimuths_deg.len();
        let wedge = |j: usize| {
            let next = azimuths_deg.get(j + 1).copied().unwrap_or(azimuths_deg[0] + 360.0);
            let before = if j == 0 { azimuths_deg[count - 1] - 360.0 } else { azimuths_deg[j - 1] };
            0.5 * (next - before) / 360.0
        };
        let share = |j: usize| rings.iter().map(move |ring| ring * wedge(j)).collect::<Vec<_>>();
        Self {
            directions: directions.collect(),
            solid_angles_sr: (0..count).flat_map(share).collect(),
            azimuths_deg: azimuths_deg.to_vec(),
            gammas_deg: gammas_deg.to_vec(),
        }
    }

    /// The four nodes around a direction and their shares, which add up to 1.
    fn around(&self, direction: DVec3) -> [(usize, f64); 4] {
        let gamma = (-direction.z).clamp(-1.0, 1.0).acos().to_degrees();
        let azimuth = direction.y.atan2(direction.x).to_degrees().rem_euclid(360.0);
        let (rows, columns) = (self.azimuths_deg.len(), self.gammas_deg.len());
        let i = (self.gammas_deg.partition_point(|known| *known <= gamma)).clamp(1, columns - 1) - 1;
        let s =
            ((gamma - self.gammas_deg[i]) / (self.gammas_deg[i + 1] - self.gammas_deg[i])).clamp(0.0, 1.0);
        let j = (self.azimuths_deg.partition_point(|known| *known <= azimuth)).max(1) - 1;
        let next_deg = self.azimuths_deg.get(j + 1).copied().unwrap_or(360.0);
        let t = ((azimuth - self.azimuths_deg[j]) / (next_deg - self.azimuths_deg[j])).clamp(0.0, 1.0);
        let node = |j: usize, i: usize| (j % rows) * columns + i;
        [
            (node(j, i), (1.0 - t) * (1.0 - s)),
            (node(j, i + 1), (1.0 - t) * s),
            (node(j + 1, i), t * (1.0 - s)),
            (node(j + 1, i + 1), t * s),
        ]
    }
}

fn block_of(scene: &Scene, demand: &FarDemand, table: &Table, block: u64) -> Sheet {
    let mut rng = Rng::new(demand.seed, block + 1, 1 << 42);
    let mut sheet = Sheet { cd: vec![0.0; table.directions.len()], escaped_lm: 0.0, mirrored_lm: 0.0 };
    own_light(scene, demand, table, &mut rng, &mut sheet);
    let total: f64 = demand.luminaires.iter().map(|(index, factor)| flux_lm(scene, *index, *factor)).sum();
    for (index, factor) in &demand.luminaires {
        let flux = flux_lm(scene, *index, *factor);
        if !(flux > 0.0) {
            continue;
        }
        let particles = (f64::from(demand.particles) * flux / total).ceil().max(1.0) as u32;
        let (places, directions) = (Stratified::new(&mut rng), Stratified::new(&mut rng));
        for particle in 0..particles {
            let u = [places.point(particle % 65_536, &mut rng)];
            let start = (u[0], directions.point(particle % 65_536, &mut rng));
            follow(scene, demand, table, *index, flux / f64::from(particles), start, &mut rng, &mut sheet);
        }
    }
    sheet
}

/// The luminaires' own light, straight and through panes.
fn own_light(scene: &Scene, demand: &FarDemand, table: &Table, rng: &mut Rng, sheet: &mut Sheet) {
    for (index, factor) in &demand.luminaires {
        let lamp = &scene.luminaires[*index];
        let into = lamp.world_from_luminaire.transpose();
        let points = if lamp.kind.opening.is_point() { 1 } else { demand.opening_points.max(1) };
        for (cd, direction) in sheet.cd.iter_mut().zip(&table.directions) {
            let local = into * *direction;
            let own_cd = lamp.kind.distribution.intensity_along(local) * lamp.dim * factor;
            if !(own_cd > 0.0) {
                continue;
            }
            let sequence = Stratified::new(rng);
            let passed = |point: u32, rng: &mut Rng| {
                let at = lamp.kind.opening.leaving(local, sequence.point(point, rng));
                let from =
                    lamp.position + lamp.world_from_luminaire * at + *direction * scene.tracer.offset_m();
                scene.tracer.transmittance(from, *direction, FOR_EVER, &lamp.body)
            };
            let seen: f64 = (0..points).map(|point| passed(point, rng)).sum();
            *cd += own_cd * seen / f64::from(points);
        }
    }
}

/// Follows a particle to its end; every diffuse vertex adds to the table.
#[allow(
    clippy::too_many_arguments,
    reason = "one particle has this much state; a struct would only rename it"
)]
fn follow(
    scene: &Scene,
    demand: &FarDemand,
    table: &Table,
    index: usize,
    flux_lm: f64,
    (place, u): ([f64; 2], [f64; 3]),
    rng: &mut Rng,
    sheet: &mut Sheet,
) {
    let lamp = &scene.luminaires[index];
    let lift = scene.tracer.offset_m();
    let (local, _) = lamp.kind.distribution.sample_direction(u);
    let mut direction = lamp.world_from_luminaire * local;
    let at = lamp.world_from_luminaire * lamp.kind.opening.leaving(local, place);
    let mut origin = lamp.position + at + direction * lift;
    let mut blind: &[u32] = &lamp.body;
    let mut by_mirror = false;
    for _ in 0..MOST_BOUNCES {
        let Some(hit) = scene.tracer.closest(origin, direction, blind) else {
            sheet.escaped_lm += flux_lm;
            if by_mirror {
                sheet.mirrored_lm += flux_lm;
                for (node, share) in table.around(direction) {
                    sheet.cd[node] += share * flux_lm / table.solid_angles_sr[node];
                }
            }
            return;
        };
        let face = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { face } else { -face };
        let frame = sphere::frame(normal);
        let incoming = frame.transpose() * -direction;
        let point = origin + direction * hit.distance_m;
        add_vertex(scene, demand, table, (point, frame, incoming, hit.triangle), flux_lm, rng, sheet);
        let next = scene.bsdf(hit.triangle).sample(incoming, rng.uniforms());
        let Some(next) = next.filter(|next| rng.uniform() < next.weight) else { return };
        let reflected = next.direction.z > 0.0;
        if !next.specular {
            by_mirror = false;
        } else if reflected {
            by_mirror = true;
        }
        if !next.specular || reflected {
            blind = &[];
        }
        origin = point + normal * if reflected { lift } else { -lift };
        direction = frame * next.direction;
    }
}

/// Local estimation: what the diffuse part of a vertex sends far away, in a random even choice of the
/// table's directions.
fn add_vertex(
    scene: &Scene,
    demand: &FarDemand,
    table: &Table,
    (point, frame, incoming, triangle): (DVec3, glam::DMat3, DVec3, u32),
    flux_lm: f64,
    rng: &mut Rng,
    sheet: &mut Sheet,
) {
    let bsdf = scene.bsdf(triangle);
    let (count, lift) = (table.directions.len(), scene.tracer.offset_m());
    let step = count.div_ceil(demand.directions.clamp(1, count));
    let first = ((rng.uniform() * step as f64) as usize).min(step - 1);
    for node in (first..count).step_by(step) {
        let direction = table.directions[node];
        let local = frame.transpose() * direction;
        let cd = flux_lm * bsdf.f(local, incoming) * local.z.abs() * step as f64;
        if cd > 0.0 {
            let origin = point + frame.z_axis * lift.copysign(local.z);
            sheet.cd[node] += cd * scene.tracer.transmittance(origin, direction, FOR_EVER, &[]);
        }
    }
}

/// Evenly spaced angles of a table: azimuths without 360°, γ with 180°.
pub fn axes(azimuth_step_deg: f64, gamma_step_deg: f64) -> (Vec<f64>, Vec<f64>) {
    let (planes, rings) = ((360.0 / azimuth_step_deg).round(), (180.0 / gamma_step_deg).round());
    let even = |count: f64, span: f64, closed: usize| {
        (0..count as usize + closed).map(|k| span * k as f64 / count).collect::<Vec<f64>>()
    };
    (even(planes, 360.0, 0), even(rings, 180.0, 1))
}
