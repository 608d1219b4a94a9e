//! What points get from all around, by many cheap look-ups in the frozen field: for maps of many eyes, of
//! which each looks in many directions. All directions of an eye share their rays, and what walks find the
//! field to lack on a patch is shared by all eyes that see it.
//!
//! The field errs where a patch is partly hidden under furniture, say. Walks that start where the eyes'
//! own rays arrive find by how much, on the mean over what is seen of each patch; what is left is the
//! light's variation within patches. (Interpolation between patches was tried for what an eye is near to: it
//! made more errors, at furniture, than it mended.)

use std::f64::consts::PI;

use glam::DVec3;
use rayon::prelude::*;

use super::answer::{ANALOG, Desk, see, walk};
use super::look::{Landing, Sight, add_emission, look};
use super::{Prepared, highlights};
use crate::estimate::Estimate;
use crate::geometry::mesh::Surface;
use crate::geometry::trace::Course;
use crate::material::Bsdf;
use crate::rng::{Rng, Stratified};
use crate::sphere;

/// Streams of look-ups and of walks; blocks use 1, 2, …, the field 0, pictures and eyes the last two.
const STREAMS: [u64; 2] = [u64::MAX - 2, u64::MAX - 4];
/// Item of the directions that all points share.
const SHARED: u64 = u64::MAX;
/// Rays drawn about highlights, as a share of all, where a glossy plane reflects luminaires.
const AIMED: f64 = 0.25;
/// Density of directions over the sphere, 1/sr.
const UNIFORM: f64 = 0.25 / PI;

/// Points whose replicates still scatter get so many times the rays, one after the other.
const TIMES: [u32; 3] = [1, 2, 4];

/// How much glances cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlanceEffort {
    /// Independent replicates: look-ups and walks are split among them.
    pub replicates: u32,
    /// Rays of each replicate.
    pub rays: u32,
    /// Relative standard error, in the mean square over the normals, above which a point gets twice the rays,
    /// and then four times.
    pub rough: f64,
    /// Walks for each replicate and point.
    pub walks: u32,
}

/// The field with what walks found it to lack, for every channel.
#[derive(Clone, Debug)]
pub struct Mended {
    /// A table for each replicate: `[side · channels + channel]`, cd/m².
    tables: Vec<Vec<f64>>,
}

/// The field of `prepared` as it is, for a few points that ask for no walks.
pub fn as_stored(prepared: &Prepared, replicates: u32) -> Mended {
    let Some(field) = &prepared.field else { return Mended { tables: Vec::new() } };
    let table: Vec<f64> =
        (0..field.patches().sides()).flat_map(|side| field.at(side).iter().copied()).collect();
    Mended { tables: vec![table; replicates as usize] }
}

/// Mends the field of `prepared` by walks from what is seen at `points` on planes with these normals. A
/// replicate has walks of its own but where they never reached a patch that others did.
pub fn mend(prepared: &Prepared, points: &[DVec3], normals: &[DVec3], effort: &GlanceEffort) -> Mended {
    let Some(field) = &prepared.field else { return Mended { tables: Vec::new() } };
    let found: Vec<Vec<Lack>> = points
        .par_iter()
        .enumerate()
        .map(|(item, &point)| lacks(prepared, point, normals, effort, item as u64))
        .collect();
    let stored: Vec<&[f64]> = (0..field.patches().sides()).map(|side| field.at(side)).collect();
    let channels = prepared.scene.channels.len();
    Mended { tables: mended(&stored, channels, found.iter().flatten(), effort.replicates as usize) }
}

/// Indirect illuminances in lx on planes with several normals at many points, with a factor for each
/// channel: for each point `[replicate · normals + normal]`.
pub fn glances(
    prepared: &Prepared,
    mended: &Mended,
    points: &[DVec3],
    normals: &[DVec3],
    weights: &[f64],
    effort: &GlanceEffort,
) -> Vec<Vec<f64>> {
    let weighted = |channels: &[f64]| channels.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>();
    let of_table = |table: &Vec<f64>| table.chunks_exact(weights.len().max(1)).map(weighted).collect();
    let tables: Vec<Vec<f64>> = mended.tables.iter().map(of_table).collect();
    let Some(sides) = tables.first().map(Vec::len) else {
        return vec![vec![0.0; normals.len() * effort.replicates as usize]; points.len()];
    };
    let scene = prepared.scene;
    let material = |surface: &Surface| is_plain(&scene.materials[surface.material].bsdf);
    let looked_up = Looked {
        luminance: (0..sides).flat_map(|side| tables.iter().map(move |table| table[side])).collect(),
        ways: Ways::new(prepared.seed, normals, effort),
        plain: scene.mesh.surfaces.iter().map(material).collect(),
    };
    points
        .par_iter()
        .enumerate()
        .map(|(item, &point)| look_ups(prepared, point, normals, weights, effort, &looked_up, item as u64))
        .collect()
}

/// What look-ups find and where they look.
struct Looked {
    /// `[side · replicates + replicate]`, cd/m².
    luminance: Vec<f64>,
    ways: Ways,
    /// Per surface: whether what a patch stores is all that is seen of it.
    plain: Vec<bool>,
}

/// Whether a ray ends at a surface, and finds there what it reflects and passes on and nothing else.
fn is_plain(bsdf: &Bsdf) -> bool {
    bsdf.specular(1.0).is_none() && bsdf.lobe().is_none() && !(bsdf.emitted() > 0.0)
}

/// Directions of look-ups, stratified over the sphere. All points share them, so that their noise shows no
/// grain from eye to eye and they are made once.
struct Ways {
    /// Those that any normal faces; of each time that rays are added, neighbours follow each other.
    all: Vec<Way>,
    /// Where in `all` each time begins and ends.
    ends: [usize; TIMES.len() + 1],
    /// `[way · normals + normal]`, not below 0.
    cosines: Vec<f64>,
}

/// A direction, and the replicate whose table is asked.
struct Way {
    course: Course,
    replicate: usize,
}

impl Ways {
    fn new(seed: u64, normals: &[DVec3], effort: &GlanceEffort) -> Self {
        let mut rng = Rng::new(seed, STREAMS[0], SHARED);
        let sequence = Stratified::new(&mut rng);
        let (mut all, mut ends) = (Vec::new(), [0; TIMES.len() + 1]);
        let mut done = 0;
        for (time, times) in TIMES.into_iter().enumerate() {
            let run = times * effort.rays - done;
            let first = done * effort.replicates;
            // Runs of the sequence one after the other: every fourth point would lie in a quarter of the sphere.
            // Uniform, not by the cosines: strata of two numbers pay more than they would.
            let mut added: Vec<(DVec3, usize)> = (0..run * effort.replicates)
                .map(|ray| {
                    (sphere::uniform_sphere(sequence.point(first + ray, &mut rng)), (ray / run) as usize)
                })
                .filter(|(direction, _)| in_sight(normals, *direction))
                .collect();
            let belts = f64::from(run * effort.replicates / 2).sqrt().ceil();
            added.sort_by_cached_key(|(direction, _)| along_belts(*direction, belts));
            all.extend(
                added.iter().map(|&(direction, replicate)| Way { course: Course::new(direction), replicate }),
            );
            ends[time + 1] = all.len();
            done += run;
        }
        let cosines = all.iter().flat_map(|way| normals.iter().map(|n| n.dot(way.course.direction).max(0.0)));
        Self { cosines: cosines.collect(), all, ends }
    }
}

/// Place of a direction on a line that goes to and fro along belts of the sphere: rays from one point that follow
/// each other meet the same things, which are then at hand.
fn along_belts(direction: DVec3, belts: f64) -> (u32, u32) {
    let belt = (0.5 * (1.0 + direction.z) * belts).min(belts - 1.0) as u32;
    let turn = 0.5 + 0.5 * direction.y.atan2(direction.x) / PI;
    let along = if belt.is_multiple_of(2) { turn } else { 1.0 - turn };
    (belt, (along * f64::from(1u32 << 24)) as u32)
}

/// What one walk found the field to lack on a patch side, cd/m² for each channel.
struct Lack {
    side: u32,
    replicate: u32,
    luminance: Vec<f64>,
}

fn side(prepared: &Prepared, landing: &Landing) -> usize {
    let field = prepared.field.as_ref().expect("glances need a field");
    field.patches().side_at(landing.triangle, landing.barycentric, landing.front)
}

/// Behind an eye that looks one way only there is nothing to see.
fn in_sight(normals: &[DVec3], direction: DVec3) -> bool {
    normals.iter().any(|normal| normal.dot(direction) > 0.0)
}

fn lacks(
    prepared: &Prepared,
    point: DVec3,
    normals: &[DVec3],
    effort: &GlanceEffort,
    item: u64,
) -> Vec<Lack> {
    let mut rng = Rng::new(prepared.seed, STREAMS[1], item);
    let mut desk = Desk::new(prepared.scene.channels.len());
    let ways = Stratified::new(&mut rng);
    let mut found = Vec::new();
    for number in 0..effort.replicates * effort.walks {
        let direction = sphere::uniform_sphere(ways.point(number, &mut rng));
        if !in_sight(normals, direction) {
            continue;
        }
        see(prepared, point, direction, ANALOG, &mut rng, &mut desk);
        let landings = std::mem::take(&mut desk.sight.landings);
        for landing in &landings {
            desk.sight.landings = vec![Landing { weight: 1.0, ..*landing }];
            walk(prepared, &mut rng, &mut desk);
            let side = side(prepared, landing) as u32;
            let luminance = desk.residual.clone();
            found.push(Lack { side, replicate: number % effort.replicates, luminance });
        }
    }
    found
}

/// The field with what was found to lack, on the mean over the walks of a patch: a table a replicate.
fn mended<'l>(
    stored: &[&[f64]],
    channels: usize,
    lacks: impl Iterator<Item = &'l Lack>,
    replicates: usize,
) -> Vec<Vec<f64>> {
    let (mut light, mut counts) = (
        vec![vec![0.0; stored.len() * channels]; replicates + 1],
        vec![vec![0.0f64; stored.len()]; replicates + 1],
    );
    for lack in lacks {
        let side = lack.side as usize;
        for table in [lack.replicate as usize, replicates] {
            counts[table][side] += 1.0;
            let sums = &mut light[table][side * channels..(side + 1) * channels];
            for (sum, lacking) in sums.iter_mut().zip(&lack.luminance) {
                *sum += lacking;
            }
        }
    }
    let of_replicate = |own: usize| -> Vec<f64> {
        let of_side = |side: usize| {
            let table = if counts[own][side] > 0.0 { own } else { replicates };
            let count = counts[table][side].max(1.0);
            let sums = &light[table][side * channels..(side + 1) * channels];
            stored[side].iter().zip(sums).map(move |(stored, sum)| stored + sum / count)
        };
        (0..stored.len()).flat_map(of_side).collect()
    };
    (0..replicates).map(of_replicate).collect()
}

fn look_ups(
    prepared: &Prepared,
    point: DVec3,
    normals: &[DVec3],
    weights: &[f64],
    effort: &GlanceEffort,
    looked: &Looked,
    item: u64,
) -> Vec<f64> {
    let scene = prepared.scene;
    let patches = prepared.field.as_ref().expect("glances need a field").patches();
    let mut rng = Rng::new(prepared.seed, STREAMS[0], item);
    let mut sight = Sight::new(scene.channels.len());
    let mut met = vec![0.0; scene.channels.len()];
    let mut bundles = Vec::new();
    let (count, replicates) = (normals.len(), effort.replicates as usize);
    let cosine = |normal: &DVec3, direction: DVec3| normal.dot(direction).max(0.0);
    let of_all = |direction| normals.iter().map(|normal| cosine(normal, direction)).sum();
    prepared.highlights.about(&prepared.emitters, point, of_all, &mut bundles);
    let aimed = if bundles.is_empty() { 0.0 } else { AIMED };
    let mixture = |direction: DVec3| {
        UNIFORM + if aimed > 0.0 { aimed * highlights::density(&bundles, direction) } else { 0.0 }
    };
    // What is seen along a ray through mirrors, panes and lobes, by the table of a replicate.
    let mut luminance = |direction: DVec3, replicate: usize, rng: &mut Rng| {
        look(&prepared.emitters, point, direction, ANALOG, rng, &mut sight);
        met.copy_from_slice(&sight.met);
        let mut stored = 0.0;
        for landing in &sight.landings {
            add_emission(scene, landing.triangle, &mut met, landing.weight);
            stored += landing.weight * looked.luminance[side(prepared, landing) * replicates + replicate];
        }
        stored + met.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>()
    };
    let mut sums = vec![0.0; replicates * count];
    // The replicates share one sequence, so that the mean has the strata of all rays; that they keep apart makes
    // their spread, the stated error, larger than the mean's own.
    let aims = Stratified::new(&mut rng);
    let mut done = [0; 2];
    for (time, times) in TIMES.into_iter().enumerate() {
        if time > 0 && spread(&sums, count) <= effort.rough {
            break;
        }
        let rays = times * effort.rays;
        let due = [rays, (aimed * f64::from(rays)).ceil() as u32];
        let ways = &looked.ways;
        for number in ways.ends[time]..ways.ends[time + 1] {
            let Way { course, replicate } = &ways.all[number];
            let Some(hit) = scene.tracer.closest_on(point, course, &[]) else { continue };
            let seen = if looked.plain[scene.tracer.surface(hit.triangle) as usize] {
                let side = patches.side_at(hit.triangle, hit.barycentric, hit.front);
                looked.luminance[side * replicates + replicate]
            } else {
                luminance(course.direction, *replicate, &mut rng)
            };
            let seen = seen / mixture(course.direction);
            let own = &mut sums[replicate * count..(replicate + 1) * count];
            for (sum, cosine) in own.iter_mut().zip(&ways.cosines[number * count..(number + 1) * count]) {
                *sum += cosine * seen;
            }
        }
        for replicate in 0..replicates {
            let first = done[1] * effort.replicates + replicate as u32 * (due[1] - done[1]);
            for number in first..first + due[1] - done[1] {
                let direction = highlights::draw(&bundles, aims.point(number, &mut rng));
                if !in_sight(normals, direction) {
                    continue;
                }
                let seen = luminance(direction, replicate, &mut rng) / mixture(direction);
                for (sum, normal) in sums[replicate * count..(replicate + 1) * count].iter_mut().zip(normals)
                {
                    *sum += cosine(normal, direction) * seen;
                }
            }
        }
        done = due;
    }
    sums.iter().map(|sum| sum / f64::from(done[0].max(1))).collect()
}

/// Relative standard error of the means over replicates (`[replicate · count + one]`), root of the mean square.
fn spread(sums: &[f64], count: usize) -> f64 {
    let replicates = sums.len() / count.max(1);
    let square = |one: usize| {
        let blocks: Vec<f64> = (0..replicates).map(|replicate| sums[replicate * count + one]).collect();
        let estimate = Estimate::from_blocks(&blocks);
        if estimate.value > 0.0 { (estimate.se / estimate.value).powi(2) } else { 0.0 }
    };
    ((0..count).map(square).sum::<f64>() / count as f64).sqrt()
}
