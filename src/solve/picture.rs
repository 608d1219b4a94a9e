//! Pictures: the luminance seen along every pixel's ray from the stored field. Mirrors and panes are
//! followed exactly, both branches at glass; openings count by the share of the pixel that they fill.
//!
//! Two of the three ways have no interval, for what they approximate is not sampled again:
//! [`Detail::Stored`] shows the field as it is, [`Detail::Exact`] adds direct light computed where it
//! is seen to the interpolated indirect part of the field, and samples glossy lobes. [`replicate`] is
//! unbiased: independent blocks of the solver's own answer.

mod bends;
mod direct;
mod even;
mod exposure;
mod lobes;
mod openings;
mod spots;
mod tile;
mod unshadowed;

use glam::DVec3;
use rayon::prelude::*;

pub use self::exposure::{Exposure, expose, from_store};
use self::openings::Beam;
use self::tile::Tile;
use super::look::{Landing, Way};
use super::{Counts, PARTS, Prepared, answer};
use crate::emitters::Emitters;
use crate::field::{LuminanceField, Smooth};
use crate::geometry::trace::Hit;
use crate::image::{LuminanceImage, View};
use crate::query::Ray;
use crate::rng::Rng;
use crate::scene::{BodiesMet, Channel, Scene};

/// Edge of the squares of pixels that are worked on together, and of the smaller ones whose shadows are.
const TILE: usize = 16;
const BLOCK: usize = 8;
/// Branches of a ray at mirrors and panes that carry less than this share of its light are cut.
pub const FAINTEST: f64 = 1e-4;
/// Longest row of mirrors and panes that is followed.
pub const MOST_BOUNCES: u32 = 24;
/// Stream of what pictures draw at random; blocks use 1, 2, …, and the field stream 0.
const STREAM: u64 = u64::MAX - 1;
/// What a picture shows of the field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// The stored luminance of patches.
    Stored,
    /// Direct light computed at every pixel and the interpolated indirect light.
    Exact,
}

/// A field under one light scene.
#[derive(Debug)]
pub struct Picture<'e> {
    detail: Detail,
    emitters: &'e Emitters<'e>,
    field: &'e LuminanceField,
    /// Factor of each channel.
    weights: Vec<f64>,
    /// Luminaires and images that shine.
    lamps: Vec<direct::Lamp<'e>>,
    /// Luminaires that shine and are more than points.
    openings: Vec<usize>,
    /// Stored luminance of each patch side, cd/m².
    stored: Vec<f64>,
    /// Indirect luminance per unit of reflectance, cd/m², unless the stored one is shown.
    indirect: Option<Smooth>,
    /// The same of all diffuse light, where glossy surfaces may look at it.
    whole: Option<Smooth>,
    seed: u64,
}

/// What a picture without interval approximates or leaves out, one sentence each.
pub fn omissions(scene: &Scene, detail: Detail) -> Vec<String> {
    let mut all = vec![match detail {
        Detail::Stored => {
            "Surfaces show the stored luminance of patches: a mean over each patch, with the noise of the field's random links."
        }
        Detail::Exact => {
            "Indirect light is interpolated between stored patches: it has the noise of the field's random links and is blurred where furniture stands on or against a surface."
        }
    }];
    if detail == Detail::Exact {
        all.push("The visible share of an opening is taken from one ray a pixel outside of half-shadows and from two to eight in them, by its part of the light, that of a reflected one from one ray a pixel, or for four pixels where it has less than 1 % of the light; unshadowed light may be off by 0.4 %.");
    }
    all.push("Every pixel is looked at in its centre only, but for the openings of luminaires: edges of surfaces are not smoothed, and what is narrower than a pixel may be missed.");
    if scene.surfaces().any(|bsdf| bsdf.specular(1.0).is_some()) {
        all.push("Reflections that carry less than 1e-4 of a pixel's light, and those beyond 24 mirrors or panes, are cut.");
    }
    if scene.has_lobes() {
        all.push(match detail {
            Detail::Stored => "What glossy surfaces reflect in their lobe is left out: their highlights are missing. Without --preview they are there.",
            Detail::Exact => "What glossy surfaces reflect in their lobe is sampled by four rays a pixel, which find surfaces as the field has them, shadows blurred. The noise of these rays alone is given for every pixel; it is no interval.",
        });
    }
    all.into_iter().map(str::to_owned).collect()
}

/// A diffuse place seen by a pixel, and how much of its luminance arrives.
#[derive(Clone, Copy, Debug)]
struct Seen {
    landing: Landing,
    share: f64,
}

/// Everything a pixel's ray meets.
#[derive(Clone, Debug, Default)]
struct Sight {
    /// Luminance of openings and emitting surfaces, cd/m².
    luminance: f64,
    places: Vec<Seen>,
}

/// Takes a picture; `tell` is called with the number of rows done. Where lobes are sampled, its standard
/// errors are those of this sampling and of nothing else.
pub fn render(
    picture: &Picture,
    view: &View,
    size: [usize; 2],
    tell: &(dyn Fn(usize) + Sync),
) -> (LuminanceImage, Counts) {
    let [width, height] = size;
    let done = std::sync::atomic::AtomicUsize::new(0);
    let noisy = picture.whole.is_some();
    let raster = view.raster(size);
    let bands: Vec<(Vec<f64>, Vec<f64>, Counts)> = (0..height.div_ceil(TILE))
        .into_par_iter()
        .map(|band| {
            let rows = TILE.min(height - band * TILE);
            let mut values = vec![0.0; rows * width];
            let mut squares = vec![0.0; if noisy { rows * width } else { 0 }];
            let mut counts = Counts::default();
            let mut sights: [Sight; TILE * TILE] = std::array::from_fn(|_| Sight::default());
            for column in (0..width).step_by(TILE) {
                let tile = Tile::of(&raster, size, [column, band * TILE]);
                tile.work(picture, view.eye, &mut sights, [&mut values, &mut squares], &mut counts);
            }
            tell(done.fetch_add(rows, std::sync::atomic::Ordering::Relaxed) + rows);
            (values, squares, counts)
        })
        .collect();
    let mut counts = Counts::default();
    let mut luminance = Vec::with_capacity(width * height);
    let mut error = Vec::new();
    for (values, squares, count) in bands {
        luminance.extend(values);
        error.extend(squares.into_iter().map(f64::sqrt));
        counts.add(count);
    }
    let mut image = LuminanceImage::new(width, height, Some(*view), luminance);
    image.standard_error_cd_m2 = noisy.then_some(error);
    (image, counts)
}

/// A branch of a ray.
#[derive(Clone, Debug)]
struct Path<'o> {
    share: f64,
    bounces: u32,
    way: Way,
    beam: Option<Beam>,
    /// Openings that it may meet.
    openings: &'o [usize],
    bodies: BodiesMet,
}

impl<'o> Path<'o> {
    fn fresh(beam: Option<Beam>, openings: &'o [usize]) -> Self {
        Self { share: 1.0, bounces: 0, way: Way::Clear, beam, openings, bodies: BodiesMet::default() }
    }
}

impl Sight {
    /// Follows a ray that meets `hit`, and its branches.
    fn look<'o>(
        &mut self,
        picture: &'o Picture,
        (origin, direction): (DVec3, DVec3),
        hit: Option<Hit>,
        path: &Path<'o>,
        counts: &mut Counts,
    ) {
        let scene = picture.emitters.scene;
        self.luminance += path.share * picture.openings((origin, direction), hit.as_ref(), path);
        let Some(hit) = hit else {
            counts.escaped += 1;
            return;
        };
        let front = scene.tracer.normal(hit.triangle);
        let normal = if hit.front { front } else { -front };
        let point = origin + direction * hit.distance_m;
        let cos = -direction.dot(normal);
        let Some((reflected, passed)) = scene.bsdf(hit.triangle).specular(cos) else {
            self.luminance += path.share * picture.emitted(hit.triangle);
            let (triangle, barycentric) = (hit.triangle, hit.barycentric);
            let landing = Landing {
                point,
                normal,
                triangle,
                barycentric,
                front: hit.front,
                to_eye: -direction,
                weight: 1.0,
                way: path.way,
            };
            self.places.push(Seen { landing, share: path.share });
            return;
        };
        let lift = normal * scene.tracer.offset_m();
        let onward =
            [(reflected, point + lift, direction + 2.0 * cos * normal), (passed, point - lift, direction)];
        for (share, origin, direction) in onward {
            let (share, bounces) = (path.share * share, path.bounces + 1);
            let mut next = Path { share, bounces, bodies: path.bodies.clone(), ..*path };
            if direction.dot(normal) > 0.0 {
                next.openings = &picture.openings;
                next.way = Way::Turned;
                next.beam = path.beam.map(|beam| beam.reflected(point, normal));
                next.bodies.reflected(scene, hit.triangle);
            } else {
                next.bodies.passed(scene, hit.triangle);
                next.way = if path.way == Way::Turned { Way::Turned } else { Way::Panes };
            }
            if next.share < FAINTEST {
                continue;
            }
            if next.bounces > MOST_BOUNCES {
                counts.cut += 1;
                continue;
            }
            counts.rays += 1;
            let hit = scene.tracer.closest(origin, direction, &[]);
            self.look(picture, (origin, direction), hit, &next, counts);
        }
    }
}

impl Picture<'_> {
    /// Sum over the channels under the light scene.
    fn weighted(&self, channels: &[f64]) -> f64 {
        channels.iter().zip(&self.weights).map(|(value, weight)| value * weight).sum()
    }

    /// Luminance of a place but for its lobe, as the field has it: emitted, and all diffuse light.
    fn whole(&self, landing: &Landing) -> f64 {
        let side = self.field.patches().side_at(landing.triangle, landing.barycentric, landing.front);
        let diffuse = self.whole.as_ref().map_or(self.stored[side], |whole| {
            let (reflectance, transmittance) = self.emitters.scene.bsdf(landing.triangle).diffuse();
            (reflectance + transmittance) * whole.at(side, landing.point)
        });
        self.emitted(landing.triangle) + diffuse
    }

    /// Luminance that a surface emits itself.
    fn emitted(&self, triangle: u32) -> f64 {
        let scene = self.emitters.scene;
        let emitted = scene.bsdf(triangle).emitted();
        if !(emitted > 0.0) {
            return 0.0;
        }
        let surface = scene.mesh.triangles[triangle as usize].surface as usize;
        let own = Channel::Surfaces { material: scene.mesh.surfaces[surface].material };
        let channel = scene.channels.iter().position(|channel| *channel == own);
        channel.map_or(0.0, |channel| emitted * self.weights[channel])
    }

    /// Luminance that the field states at a place: all of it, or the interpolated indirect part.
    fn reflected(&self, landing: &Landing) -> f64 {
        let side = self.field.patches().side_at(landing.triangle, landing.barycentric, landing.front);
        self.indirect.as_ref().map_or(self.stored[side], |indirect| {
            let (reflectance, transmittance) = self.emitters.scene.bsdf(landing.triangle).diffuse();
            (reflectance + transmittance) * indirect.at(side, landing.point)
        })
    }
}

/// One block of unbiased luminances, cd/m²: each pixel's mean over its area, from one random ray in
/// it. `prepared` needs no demand; blocks are independent, so their scatter is an honest error.
pub fn replicate(
    prepared: &Prepared,
    view: &View,
    size: [usize; 2],
    weights: &[f64],
    block: u64,
) -> Vec<f64> {
    let [width, height] = size;
    let channels = weights.len();
    let rows: Vec<Vec<f64>> = (0..height)
        .into_par_iter()
        .map(|row| {
            let mut sheet = vec![0.0; channels * PARTS];
            let mut line = vec![0.0; width];
            for (column, value) in line.iter_mut().enumerate() {
                let item = (row * width + column) as u64;
                let mut rng = Rng::new(prepared.seed, block + 1, item);
                let [u, v] = rng.uniforms();
                let Some(direction) = view.direction(size, [column as f64 + u, row as f64 + v]) else {
                    continue;
                };
                sheet.fill(0.0);
                answer::one_ray(prepared, &Ray { point: view.eye, direction }, &mut rng, &mut sheet);
                let channel = |k: usize| sheet[k * PARTS..(k + 1) * PARTS].iter().sum::<f64>();
                *value = (0..channels).map(|k| weights[k] * channel(k)).sum();
            }
            line
        })
        .collect();
    rows.concat()
}
