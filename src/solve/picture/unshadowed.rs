//! Unshadowed illuminance at the places of a tile: exact, or interpolated over a plane where that is as good
//! ([`super::even`]).

use glam::DVec3;

use super::direct::Lamp;
use super::even::{self, Allowance};
use super::spots::Group;
use crate::emitters::{Emitters, Source, unshadowed};
use crate::query::Kernel;

/// Nodes of the Gauss rule with two points, and of the same rule on both halves.
const GAUSS_2: [f64; 2] = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];
const GAUSS_4: [f64; 4] =
    [0.105_662_432_702_593_57, 0.394_337_567_297_406_4, 0.605_662_432_702_593_6, 0.894_337_567_297_406_4];
/// Opening radii within which the finer rule is used, and the error-controlled one.
const NEAR: f64 = 5.0;
pub(super) const AT_HAND: f64 = 1.5;

/// Illuminance of every place of a group by every lamp, lx; images as if their planes had no edges.
pub(super) fn unshadowed_lx(emitters: &Emitters, lamps: &[&Lamp], group: &Group) -> Vec<Vec<f64>> {
    let exact = |lamp: &Lamp, point: DVec3| quick_lx(emitters, lamp, point, group.spots[0].normal);
    let Some(nodes) = group.nodes else {
        let of_lamp = |lamp: &&Lamp| {
            group.spots.iter().map(|spot| quick_lx(emitters, lamp, spot.origin, spot.normal)).collect()
        };
        return lamps.iter().map(of_lamp).collect();
    };
    let middle: Vec<f64> = lamps.iter().map(|lamp| exact(lamp, nodes.at(even::MIDDLE))).collect();
    let whole: f64 = lamps.iter().zip(&middle).map(|(lamp, lx)| lamp.weight * lx).sum();
    let share_lx = whole / lamps.len().max(1) as f64;
    let of_lamp = |(lamp, middle): (&&Lamp, &f64)| {
        let allowance = Allowance { anyway_lx: share_lx / lamp.weight };
        let at = |pixel: usize| if pixel == even::MIDDLE { *middle } else { exact(lamp, nodes.at(pixel)) };
        let filled = even::filled(at, allowance);
        group.spots.iter().map(|spot| filled[spot.pixel]).collect()
    };
    lamps.iter().zip(&middle).map(of_lamp).collect()
}

/// Illuminance on a plane, lx: Lambert's formula for uniform polygons; a Gauss rule of 2 × 2 points for
/// tabulated openings, 4 × 4 near them or where the plane cuts them, and the error-controlled one where the
/// opening is at hand. Of an image the same rules with its plane's reflectance.
fn quick_lx(emitters: &Emitters, lamp: &Lamp, point: DVec3, normal: DVec3) -> f64 {
    let source = lamp.source;
    if source.is_behind(point) {
        return 0.0;
    }
    let towards = source.position - point;
    let distance_m = towards.length();
    let Some(rule) = &lamp.rule else {
        return unshadowed(emitters, source, point, &Kernel::Planar { normal });
    };
    let image = source.mirror.is_some();
    if !image && distance_m < AT_HAND * source.radius_m {
        return unshadowed(emitters, source, point, &Kernel::Planar { normal });
    }
    let cut = normal.dot(towards).abs() < source.radius_m;
    let near = cut || distance_m < NEAR * source.radius_m;
    let places: &[DVec3] = if near { &rule.near } else { &rule.far };
    let mut sum = 0.0;
    for &place in places {
        let facing = |direction: DVec3| normal.dot(direction) > 0.0;
        if let Some((direction, normal_lx)) = emitters.lit_from(source, point, place, facing) {
            let reflectance = if image { emitters.reflectance(source, direction) } else { 1.0 };
            sum += reflectance * normal_lx * normal.dot(direction);
        }
    }
    sum / places.len() as f64
}

/// Places on an opening at which Gauss rules look.
#[derive(Debug)]
pub(super) struct Rule {
    far: [DVec3; 4],
    near: [DVec3; 16],
}

impl Rule {
    /// For tabulated level openings and images of all that are level or points; `None` where other rules hold.
    pub(super) fn of(emitters: &Emitters, source: &Source) -> Option<Self> {
        let kind = &emitters.luminaire(source).kind;
        let uniform = kind.distribution.lambert_flux().is_some() && kind.opening.is_polygon();
        let image = source.mirror.is_some();
        // A rule over all pieces of a body would see jumps between them.
        let by_rule = kind.opening.pieces() == 0 && !source.is_point() && !uniform;
        let as_image = image && (source.is_point() || kind.opening.is_level());
        (by_rule || as_image).then(|| Self {
            far: emitters.places(source, std::array::from_fn(|k| [GAUSS_2[k / 2], GAUSS_2[k % 2]])),
            near: emitters.places(source, std::array::from_fn(|k| [GAUSS_4[k / 4], GAUSS_4[k % 4]])),
        })
    }
}
