//! Direct light at the places a tile of pixels sees. Unshadowed illuminance is exact or as good
//! ([`super::unshadowed`]); the visible share of each opening is sampled, once a pixel where all of it is seen
//! or none, more often in the half-shadows that a few trial rays find, and not at all where a shaft tells that
//! nothing stands between.
//!
//!   L = (ρ/π) Σ E_unshadowed · Σ V I cos/d² / Σ I cos/d²
//!
//! The ratio is exact where nothing shades and where everything does, and never negative. Images in mirrors and
//! panes are lamps like others; whether the plane ends before a line meets it is part of V.

use glam::DVec3;

use super::spots::{Group, Lines, Spot, gather};
use super::unshadowed::{AT_HAND, Rule, unshadowed_lx};
use super::{Counts, FAINTEST, Picture, Sight, TILE};
use crate::emitters::{Arrival, Emitters, Glimpse, Source};
use crate::rng::Rng;

/// Most shadow rays a luminaire and pixel in half-shadows.
const HALF_SHADOW: u32 = 8;
/// Trial rays of a tile towards each luminaire: points of the opening.
const TRIALS: [[f64; 2]; 5] = [[0.5, 0.5], [0.06, 0.06], [0.94, 0.06], [0.06, 0.94], [0.94, 0.94]];
/// A lamp with this share of a place's light gets all shadow rays in its half-shadow, others in proportion.
const MUCH: f64 = 0.25;
/// No half-shadow is told from fewer.
const FEWEST: u32 = 2;
/// Images with less than this share of the light have one ray for four pixels.
const FAINT: f64 = 0.01;

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

/// A luminaire or an image with its factor.
#[derive(Debug)]
pub(super) struct Lamp<'p> {
    pub source: &'p Source,
    pub weight: f64,
    /// Of a rectangle that holds a level opening, m.
    corners: [DVec3; 4],
    /// How its unshadowed light is found, where that is quick.
    pub rule: Option<Rule>,
}

/// All that shine under a light scene.
pub(super) fn lamps<'e>(emitters: &'e Emitters, weights: &[f64]) -> Vec<Lamp<'e>> {
    let lamp = |source: &'e Source| {
        let weight = weights[source.channel];
        (weight > 0.0).then(|| Lamp {
            source,
            weight,
            corners: emitters.corners(source),
            rule: Rule::of(emitters, source),
        })
    };
    emitters.sources.iter().filter_map(lamp).collect()
}

/// A lamp that may shine on a group.
struct Shining<'p> {
    lamp: &'p Lamp<'p>,
    /// Points on its opening for this tile.
    points: Points,
    /// Where all its light meets the plane of an image, if it does.
    met: Option<[DVec3; 4]>,
}

/// Adds the direct light of a tile, pixel by pixel.
pub(super) fn add(
    picture: &Picture,
    sights: &[Sight; TILE * TILE],
    lines: Lines,
    rng: &mut Rng,
    counts: &mut Counts,
    mut put: impl FnMut(usize, f64),
) {
    let groups = gather(picture, sights, lines);
    if groups.is_empty() {
        return;
    }
    let points: Vec<Points> = picture.lamps.iter().map(|_| Points { shift: rng.uniforms() }).collect();
    for group in &groups {
        add_group(picture, group, &points, counts, &mut put);
    }
}

fn add_group(
    picture: &Picture,
    group: &Group,
    points: &[Points],
    counts: &mut Counts,
    put: &mut impl FnMut(usize, f64),
) {
    let emitters = picture.emitters;
    let mut shining: Vec<Shining> = Vec::with_capacity(points.len());
    for (lamp, &points) in picture.lamps.iter().zip(points) {
        match glimpse(emitters, lamp, group) {
            Some(Glimpse::Nothing) => {}
            Some(Glimpse::Some) => shining.push(Shining { lamp, points, met: None }),
            Some(Glimpse::All(met)) => shining.push(Shining { lamp, points, met: Some(met) }),
            None => add_image(picture, lamp, points, &group.spots, counts, put),
        }
    }
    let lamps: Vec<&Lamp> = shining.iter().map(|one| one.lamp).collect();
    let unshadowed = unshadowed_lx(emitters, &lamps, group);
    let mut whole = vec![0.0; group.spots.len()];
    for (lamp, lx) in lamps.iter().zip(&unshadowed) {
        whole.iter_mut().zip(lx).for_each(|(whole, lx)| *whole += lamp.weight * lx);
    }
    for (one, lx) in shining.iter().zip(&unshadowed) {
        // Of all light of the group the most that the lamp may have at any place.
        let share = |(lx, whole): (&f64, &f64)| if *lx > 0.0 { one.lamp.weight * lx / whole } else { 0.0 };
        let most = lx.iter().zip(&whole).map(share).fold(0.0, f64::max);
        let least = if one.lamp.source.mirror.is_some() { FAINTEST } else { 0.0 };
        if !(most > least) {
            continue;
        }
        if is_clear(emitters, one, &group.spots, group.rectangle.is_some()) {
            for (spot, lx) in group.spots.iter().zip(lx) {
                if emitters.lights(one.lamp.source, spot.triangle) {
                    put(spot.pixel, one.lamp.weight * spot.factor * lx);
                }
            }
            continue;
        }
        for range in &group.blocks {
            let spots = &group.spots[range.clone()];
            let block =
                Block { spots, of: group.spots.len(), lx: &lx[range.clone()], whole: &whole[range.clone()] };
            add_block(picture, one, &block, group.rectangle.is_some(), most, counts, put);
        }
    }
}

/// The places of a group in a square of pixels.
struct Block<'g> {
    spots: &'g [Spot],
    /// Places of the whole group.
    of: usize,
    /// Unshadowed light of one lamp, lx.
    lx: &'g [f64],
    /// That of all, weighted, lx.
    whole: &'g [f64],
}

/// Adds what of a lamp's light reaches a block.
fn add_block(
    picture: &Picture,
    one: &Shining,
    block: &Block,
    in_plane: bool,
    share: f64,
    counts: &mut Counts,
    put: &mut impl FnMut(usize, f64),
) {
    let emitters = picture.emitters;
    let Lamp { source, weight, .. } = *one.lamp;
    if !block.lx.iter().any(|lx| *lx > 0.0) {
        return;
    }
    let image = source.mirror.is_some();
    let most = if block.spots.len() < block.of && is_clear(emitters, one, block.spots, in_plane) {
        0
    } else if image {
        1
    } else {
        rays_wanted(picture, source, block.spots, counts)
    };
    // Faint images: one ray for four pixels, told by the cell in which they lie.
    let cell = |pixel: usize| pixel / TILE / 2 * TILE + pixel % TILE / 2;
    let mut known: Vec<(usize, f64)> = Vec::new();
    for (index, (spot, lx)) in block.spots.iter().zip(block.lx).enumerate() {
        if !(*lx > 0.0 && emitters.lights(source, spot.triangle)) {
            continue;
        }
        let before =
            known.iter().find(|(cell_of, _)| *cell_of == cell(spot.pixel)).map(|(_, visible)| *visible);
        let visible = before.unwrap_or_else(|| {
            let part = (weight * lx / (MUCH * block.whole[index])).min(1.0);
            let rays = ((f64::from(most) * part).ceil() as u32).max(FEWEST.min(most));
            visible_share(picture, source, spot, index as u32, rays, one.points, counts)
        });
        if image && before.is_none() && share < FAINT {
            known.push((cell(spot.pixel), visible));
        }
        put(spot.pixel, weight * spot.factor * lx * visible);
    }
}

/// What a group sees of a lamp by way of its plane, if it is an image; `None` where light by one reflection is
/// better sampled as a whole: at loose places, of bodies, and of openings at hand.
fn glimpse(emitters: &Emitters, lamp: &Lamp, group: &Group) -> Option<Glimpse> {
    let source = lamp.source;
    let Some(mirror) = source.mirror else { return Some(Glimpse::Some) };
    let plane = &emitters.mirrors[mirror];
    let rectangle = group.rectangle?;
    let opening = emitters.luminaire(source).kind.opening;
    let size_m = rectangle[0].distance(rectangle[2]);
    let near = source.position.distance(rectangle[0]) < AT_HAND * source.radius_m + size_m;
    if near || !(source.is_point() || opening.is_level()) {
        return None;
    }
    Some(plane.glimpse(&rectangle, &lamp.corners))
}

/// Whether nothing at all stands between places in a plane and a lamp, so that no ray need ask.
fn is_clear(emitters: &Emitters, one: &Shining, spots: &[Spot], in_plane: bool) -> bool {
    let source = one.lamp.source;
    let luminaire = emitters.luminaire(source);
    if !in_plane || !(source.is_point() || luminaire.kind.opening.is_level()) {
        return false;
    }
    let mut origins = [DVec3::ZERO; TILE * TILE];
    for (origin, spot) in origins.iter_mut().zip(spots) {
        *origin = spot.origin;
    }
    let (origins, facing) = (&origins[..spots.len()], spots[0].normal);
    match (source.mirror, one.met) {
        (None, _) => emitters.scene.tracer.is_clear(origins, &one.lamp.corners, &[facing], &luminaire.body),
        (Some(_), Some(met)) => emitters.is_clear_by_mirror(source, origins, facing, met),
        (Some(_), None) => false,
    }
}

/// Shadow rays per pixel, from trial rays of the spots at the middle and both ends.
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
    let emitters = picture.emitters;
    if rays == 0 {
        return 1.0;
    }
    if rays == 1 {
        // One ray is all seen or not: how much light it would carry does not matter.
        let u = points.point(number);
        let Some((direction, distance_m)) = emitters.towards(source, spot.origin, u) else {
            return 1.0;
        };
        counts.rays += 1;
        let arrival = Arrival { direction, distance_m, normal_lx: 0.0, weight: 1.0, mirrored: None };
        let passed = emitters.passed(source, spot.origin, &arrival);
        return if passed > 0.0 { passed / emitters.reflectance(source, direction) } else { 0.0 };
    }
    let (mut whole, mut passed) = (0.0, 0.0);
    for ray in 0..rays {
        let u = points.point(number * HALF_SHADOW + ray);
        let facing = |direction: DVec3| spot.normal.dot(direction) > 0.0;
        let Some(arrival) = emitters.arrival_if(source, spot.origin, u, facing) else { continue };
        let light = arrival.normal_lx * spot.normal.dot(arrival.direction);
        counts.rays += 1;
        whole += light;
        passed += light * emitters.passed(source, spot.origin, &arrival);
    }
    if whole > 0.0 { passed / whole } else { 1.0 }
}

/// Light by one reflection in a plane: sampled at every pixel that may see the image.
fn add_image(
    picture: &Picture,
    lamp: &Lamp,
    points: Points,
    spots: &[Spot],
    counts: &mut Counts,
    put: &mut impl FnMut(usize, f64),
) {
    let (emitters, source) = (picture.emitters, lamp.source);
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
            put(spot.pixel, lamp.weight * spot.factor * light);
        }
    }
}
