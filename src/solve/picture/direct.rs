//! Direct light at the places a tile of pixels sees. Unshadowed illuminance is exact, or interpolated
//! where that is as good ([`super::even`]); the visible share of each opening is sampled, once a pixel where
//! all of it is seen or none, more often in the half-shadows that a few trial rays find.
//!
//!   L = (ρ/π) Σ E_unshadowed · Σ V I cos/d² / Σ I cos/d²
//!
//! The ratio is exact where nothing shades and where everything does, and never negative.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use super::super::look::Way;
use super::even::{self, Allowance};
use super::{Counts, Picture, Seen, Sight, TILE};
use crate::emitters::{Arrival, Emitters, Source, unshadowed};
use crate::query::Kernel;
use crate::rng::Rng;

/// Most shadow rays a luminaire and pixel in half-shadows.
const HALF_SHADOW: u32 = 8;
/// Trial rays of a tile towards each luminaire: points of the opening.
const TRIALS: [[f64; 2]; 5] = [[0.5, 0.5], [0.06, 0.06], [0.94, 0.06], [0.06, 0.94], [0.94, 0.94]];
/// Nodes of the Gauss rule with two points, and of the same rule on both halves.
const GAUSS_2: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];
const GAUSS_4: [f64; 4] =
    [0.105_662_432_702_593_57, 0.394_337_567_297_406_4, 0.605_662_432_702_593_6, 0.894_337_567_297_406_4];
/// Opening radii within which the finer rule is used, and the error-controlled one.
const NEAR: f64 = 5.0;
const AT_HAND: f64 = 1.5;
/// A lamp with this share of a place's light gets all shadow rays in its half-shadow, others in proportion.
const MUCH: f64 = 0.25;
/// No half-shadow is told from fewer.
const FEWEST: u32 = 2;

/// Points of a square, such as of an opening for the pixels of a tile: Roberts' additive sequence with the plastic number,
/// randomly shifted, so that each point is uniform and neighbours in the sequence lie far apart.
#[derive(Clone, Copy)]
pub(super) struct Points {
    pub shift: [f64; 2],
}

impl Points {
    pub(super) fn point(self, number: u32) -> [f64; 2] {
        const STEP: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];
        std::array::from_fn(|k| (self.shift[k] + f64::from(number) * STEP[k]).fract())
    }
}

/// A place with the side on which light arrives.
struct Spot {
    /// Index of the pixel within the tile.
    pixel: usize,
    /// Triangle on which it lies.
    triangle: u32,
    /// Where shadow rays start.
    origin: DVec3,
    normal: DVec3,
    /// Luminance in the pixel per illuminance, cd/m²/lx.
    factor: f64,
}

/// A luminaire or an image with its factor and the points on its opening.
struct Lamp<'p> {
    source: &'p Source,
    weight: f64,
    points: Points,
}

/// Adds the direct light of a tile, pixel by pixel.
pub(super) fn add(
    picture: &Picture,
    sights: &[Sight; TILE * TILE],
    rng: &mut Rng,
    counts: &mut Counts,
    mut put: impl FnMut(usize, f64),
) {
    let scene = picture.emitters.scene;
    let mut spots: Vec<Spot> = Vec::with_capacity(TILE * TILE);
    let mut straight = true;
    for (pixel, sight) in sights.iter().enumerate() {
        for Seen { landing, share } in &sight.places {
            let (reflectance, transmittance) = scene.bsdf(landing.triangle).diffuse();
            straight &= landing.way == Way::Clear;
            for (albedo, same_side) in [(reflectance, true), (transmittance, false)] {
                if albedo > 0.0 {
                    let normal = if same_side { landing.normal } else { -landing.normal };
                    let origin = landing.origin(scene, same_side);
                    let factor = share * albedo * FRAC_1_PI;
                    spots.push(Spot { pixel, triangle: landing.triangle, origin, normal, factor });
                }
            }
        }
    }
    if spots.is_empty() {
        return;
    }
    let flat = is_flat(&spots);
    let mut lamps: Vec<Lamp> = Vec::with_capacity(scene.luminaires.len());
    for source in &picture.emitters.sources {
        let weight = picture.weights[source.channel];
        if !(weight > 0.0) {
            continue;
        }
        let points = Points { shift: rng.uniforms() };
        if source.mirror.is_some() {
            add_image(picture, source, &spots, flat, points, counts, &mut |pixel, luminance| {
                put(pixel, weight * luminance);
            });
        } else {
            lamps.push(Lamp { source, weight, points });
        }
    }
    let unshadowed = unshadowed_lx(picture, &lamps, &spots, flat && straight);
    let mut whole = vec![0.0; spots.len()];
    for (lamp, lx) in lamps.iter().zip(&unshadowed) {
        whole.iter_mut().zip(lx).for_each(|(whole, lx)| *whole += lamp.weight * lx);
    }
    for (Lamp { source, weight, points }, exact) in lamps.iter().zip(&unshadowed) {
        if exact.iter().all(|lx| !(*lx > 0.0)) {
            continue;
        }
        let clear = flat && is_clear(picture.emitters, source, &spots);
        let most = if clear { 0 } else { rays_wanted(picture, source, &spots, counts) };
        for (index, (spot, lx)) in spots.iter().zip(exact).enumerate() {
            if *lx > 0.0 && picture.emitters.lights(source, spot.triangle) {
                let part = (weight * lx / (MUCH * whole[index])).min(1.0);
                let rays = ((f64::from(most) * part).ceil() as u32).max(FEWEST.min(most));
                let visible = visible_share(picture, source, spot, index as u32, rays, *points, counts);
                put(spot.pixel, weight * spot.factor * lx * visible);
            }
        }
    }
}

/// Whether nothing at all stands between a flat tile and a luminaire, so that no ray need ask.
fn is_clear(emitters: &Emitters, source: &Source, spots: &[Spot]) -> bool {
    let luminaire = emitters.luminaire(source);
    let opening = luminaire.kind.opening;
    if !(source.is_point() || opening.is_level()) {
        return false;
    }
    let corner = |sign: [f64; 2]| {
        let (x, y) = opening.outline().iter().fold((0.0f64, 0.0f64), |m, p| (m.0.max(p.x), m.1.max(p.y)));
        luminaire.position + luminaire.world_from_luminaire * DVec3::new(sign[0] * x, sign[1] * y, 0.0)
    };
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]].map(corner);
    let mut origins = [DVec3::ZERO; TILE * TILE];
    for (origin, spot) in origins.iter_mut().zip(spots) {
        *origin = spot.origin;
    }
    emitters.scene.tracer.is_clear(&origins, &corners, spots[0].normal, &luminaire.body)
}

/// Whether a whole tile sees one plane, each pixel once.
fn is_flat(spots: &[Spot]) -> bool {
    let first = &spots[0];
    spots.len() == TILE * TILE
        && spots.iter().enumerate().all(|(index, spot)| {
            spot.pixel == index
                && spot.normal.dot(first.normal) > 1.0 - 1e-9
                && first.normal.dot(spot.origin - first.origin).abs() < 1e-6
        })
}

/// Unshadowed illuminance of every spot by every lamp, lx. `even`: the spots are those of a plane that the
/// eye sees straight.
fn unshadowed_lx(picture: &Picture, lamps: &[Lamp], spots: &[Spot], even: bool) -> Vec<Vec<f64>> {
    let exact =
        |lamp: &Lamp, spot: &Spot| quick_unshadowed(picture.emitters, lamp.source, spot.origin, spot.normal);
    if !even {
        return lamps.iter().map(|lamp| spots.iter().map(|spot| exact(lamp, spot)).collect()).collect();
    }
    let middle: Vec<f64> = lamps.iter().map(|lamp| exact(lamp, &spots[even::MIDDLE])).collect();
    let whole: f64 = lamps.iter().zip(&middle).map(|(lamp, lx)| lamp.weight * lx).sum();
    let share_lx = whole / lamps.len().max(1) as f64;
    let of_lamp = |(lamp, middle): (&Lamp, &f64)| {
        let allowance = Allowance { anyway_lx: share_lx / lamp.weight };
        let at = |pixel: usize| if pixel == even::MIDDLE { *middle } else { exact(lamp, &spots[pixel]) };
        even::filled(at, allowance)
    };
    lamps.iter().zip(&middle).map(of_lamp).collect()
}

/// Unshadowed illuminance on a plane, lx: Lambert's formula for uniform polygons; a Gauss rule of
/// 2 × 2 points for tabulated openings, 4 × 4 near them or where the plane cuts them, and the
/// error-controlled one where the opening is at hand.
fn quick_unshadowed(emitters: &Emitters, source: &Source, point: DVec3, normal: DVec3) -> f64 {
    if source.is_behind(point) {
        return 0.0;
    }
    let towards = source.position - point;
    let distance_m = towards.length();
    let uniform = emitters.luminaire(source).kind.distribution.lambert_flux().is_some();
    // A rule over all pieces of a body would see jumps between them.
    let in_pieces = emitters.luminaire(source).kind.opening.pieces() > 0;
    if (uniform && emitters.luminaire(source).kind.opening.is_polygon())
        || in_pieces
        || source.is_point()
        || distance_m < AT_HAND * source.radius_m
    {
        return unshadowed(emitters, source, point, &Kernel::Planar { normal });
    }
    let cut = normal.dot(towards).abs() < source.radius_m;
    let nodes: &[f64] = if cut || distance_m < NEAR * source.radius_m { &GAUSS_4 } else { &GAUSS_2 };
    let mut sum = 0.0;
    for &u in nodes {
        for &v in nodes {
            let facing = |direction: DVec3| normal.dot(direction) > 0.0;
            if let Some(arrival) = emitters.arrival_if(source, point, [u, v], facing) {
                sum += arrival.normal_lx * normal.dot(arrival.direction);
            }
        }
    }
    sum / (nodes.len() * nodes.len()) as f64
}

/// Shadow rays per pixel, from trial rays of the spots at the tile's middle and corners.
fn rays_wanted(picture: &Picture, source: &Source, spots: &[Spot], counts: &mut Counts) -> u32 {
    if source.is_point() {
        return 1;
    }
    let (mut seen, mut hidden) = (false, false);
    for place in [0, spots.len() / 2, spots.len() - 1] {
        let spot = &spots[place];
        for u in TRIALS {
            let facing = |direction: DVec3| spot.normal.dot(direction) > 0.0;
            let Some(arrival) = picture.emitters.arrival_if(source, spot.origin, u, facing) else { continue };
            counts.rays += 1;
            if picture.emitters.passed(source, spot.origin, &arrival) > 0.0 {
                seen = true;
            } else {
                hidden = true;
            }
            if seen && hidden {
                return HALF_SHADOW;
            }
        }
    }
    1
}

/// Share of a luminaire's light that reaches a spot, panes on the way included.
fn visible_share(
    picture: &Picture,
    source: &Source,
    spot: &Spot,
    number: u32,
    rays: u32,
    points: Points,
    counts: &mut Counts,
) -> f64 {
    if rays == 0 {
        return 1.0;
    }
    if rays == 1 {
        // One ray is all seen or not: how much light it would carry does not matter.
        let u = points.point(number);
        let Some((direction, distance_m)) = picture.emitters.towards(source, spot.origin, u) else {
            return 1.0;
        };
        counts.rays += 1;
        let arrival = Arrival { direction, distance_m, normal_lx: 0.0, weight: 1.0 };
        return picture.emitters.passed(source, spot.origin, &arrival);
    }
    let (mut whole, mut passed) = (0.0, 0.0);
    for ray in 0..rays {
        let u = points.point(number * HALF_SHADOW + ray);
        let facing = |direction: DVec3| spot.normal.dot(direction) > 0.0;
        let Some(arrival) = picture.emitters.arrival_if(source, spot.origin, u, facing) else { continue };
        let light = arrival.normal_lx * spot.normal.dot(arrival.direction);
        counts.rays += 1;
        whole += light;
        passed += light * picture.emitters.passed(source, spot.origin, &arrival);
    }
    if whole > 0.0 { passed / whole } else { 1.0 }
}

/// Light by one reflection in a plane: sampled at every pixel that may see the image.
fn add_image(
    picture: &Picture,
    source: &Source,
    spots: &[Spot],
    flat: bool,
    points: Points,
    counts: &mut Counts,
    put: &mut impl FnMut(usize, f64),
) {
    let emitters = picture.emitters;
    if flat {
        let corners = [0, TILE - 1, TILE * TILE / 2 + TILE / 2, TILE * (TILE - 1), TILE * TILE - 1];
        if corners.iter().all(|&index| !emitters.may_show(source, spots[index].origin)) {
            return;
        }
    }
    for (number, spot) in spots.iter().enumerate() {
        if !emitters.may_show(source, spot.origin) {
            continue;
        }
        let u = if source.is_point() { [0.5, 0.5] } else { points.point(number as u32) };
        let facing = |direction: DVec3| spot.normal.dot(direction) > 0.0;
        let Some(arrival) = emitters.arrival_if(source, spot.origin, u, facing) else { continue };
        counts.rays += 2;
        let passed = emitters.passed(source, spot.origin, &arrival);
        let light = arrival.normal_lx * spot.normal.dot(arrival.direction) * passed;
        if light > 0.0 {
            put(spot.pixel, spot.factor * light);
        }
    }
}
