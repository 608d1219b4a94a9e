//! Sources of a view by the angles of their parts, for veiling luminance: an opening that reaches near the line of
//! sight, or covers it, has no one angle.

use std::f64::consts::PI;

use glam::DVec3;

use super::glare_sources::Counted;
use crate::emitters::{Emitters, Shiner, Sighted, rings};
use crate::glare::source::StrayPart;

/// Within so many times the radius of its nearest piece from the line of sight a source counts by rings; farther out
/// every piece has one angle, which then errs by less than 2 % of its veil.
const NEAR: f64 = 8.0;

/// The parts of the sources of a view, in their order; a point, a highlight or the image of a luminous surface has none.
pub fn parts(emitters: &Emitters, sighted: &Sighted, counted: &[Counted], gaze: DVec3) -> Vec<StrayPart> {
    let mut found = Vec::new();
    for (source, one) in counted.iter().enumerate() {
        // (direction, solid angle in sr, light on a plane that faces it in lx at full factor)
        let (pieces, shiner): (Vec<(DVec3, f64, f64)>, Shiner) = match (one.emitter, one.surface) {
            (Some(index), _) => {
                let Some(seen) = sighted.luminaires.iter().find(|seen| seen.source == index) else {
                    continue;
                };
                let pieces =
                    seen.pieces.iter().map(|piece| (piece.direction, piece.visible_sr, piece.normal_lx));
                (pieces.collect(), Shiner::Opening(index))
            }
            (None, Some(index)) if sighted.surfaces[index].mirror.is_none() => {
                let surface = &sighted.surfaces[index];
                let pieces = surface.pieces.iter();
                let light = |passed_sr: f64| surface.luminance_cd_m2 * passed_sr;
                let pieces = pieces.map(|piece| (piece.direction, piece.visible_sr, light(piece.passed_sr)));
                (pieces.collect(), Shiner::Surface(surface.surface))
            }
            (None, _) => continue,
        };
        let ahead: Vec<(f64, f64, f64)> = pieces
            .iter()
            .filter(|(direction, ..)| direction.dot(gaze) > 0.0)
            .map(|(direction, size_sr, light)| {
                let off_axis_deg = direction.angle_between(gaze).to_degrees();
                (off_axis_deg, f64::sqrt(size_sr / PI).to_degrees(), light * direction.dot(gaze))
            })
            .collect();
        let is_near = ahead.iter().any(|(off_axis_deg, radius_deg, _)| *off_axis_deg < NEAR * radius_deg);
        let lights: Vec<(f64, f64)> = if is_near {
            let to_deg = ahead.iter().map(|(angle, radius, _)| angle + 2.0 * radius).fold(0.0, f64::max);
            let rings = rings(emitters, shiner, sighted.eye, gaze, to_deg);
            rings.iter().map(|ring| (ring.off_axis_deg, ring.eye_lx)).collect()
        } else {
            ahead.iter().map(|(angle, _, light)| (*angle, *light)).collect()
        };
        // The whole is known better by pieces than by wide rings that an edge crosses.
        let whole: f64 = ahead.iter().map(|(.., lx)| lx).sum();
        if whole > 0.0 {
            let part = |(off_axis_deg, lx)| StrayPart { source, off_axis_deg, share: lx / whole };
            found.extend(lights.into_iter().filter(|(_, lx)| *lx > 0.0).map(part));
        }
    }
    found
}
