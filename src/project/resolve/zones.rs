//! Zones that a norm draws round a task area: `[[area]] kind = "surrounding" | "background"` with `of` and
//! no shape of its own. The zone is the room's outline cut to a rectangle that is wider than the task by
//! the norm's band; the points of the task and of nearer zones are left out by `plan`.

use glam::{DVec2, DVec3};

use super::draft::Draft;
use crate::project::context::Context;
use crate::project::schema::{AreaSection, File};
use crate::project::{AreaKind, AreaShape, Norm};

/// Corners closer than this are one, m.
const SAME_M: f64 = 1e-6;

/// Whether the norm is to draw the area.
pub fn is_drawn(section: &AreaSection) -> bool {
    let around = matches!(section.kind, Some(AreaKind::Surrounding | AreaKind::Background));
    let shapeless = section.rect.is_none()
        && section.polygon.is_none()
        && section.surface.is_none()
        && section.points.is_none();
    around && shapeless && section.of.is_some()
}

/// The zone, and the world and room of its task.
pub fn around(
    section: &AreaSection,
    file: &File,
    drafts: &[Draft],
    norm: Option<&Norm>,
    context: &mut Context,
) -> Option<(AreaShape, usize, usize)> {
    let of = section.of.as_ref()?;
    let name = section.name.get_ref();
    let bands = norm.and_then(|norm| {
        let rules = &norm.standard.application;
        let band_m = rules.surrounding.as_ref()?.band_m.value;
        match section.kind {
            Some(AreaKind::Background) => Some(band_m + rules.background.as_ref()?.width_m.value),
            _ => Some(band_m),
        }
    });
    let Some(band_m) = bands else {
        // A norm that could not be read was reported already.
        if norm.is_some() || file.norm.is_none() && !file.may_have_lost("norm", "") {
            let message = format!("area \"{name}\" has no shape, and no norm says how wide it is");
            context.error(&section.name.span(), message, "give it a rect or a polygon");
        }
        return None;
    };
    let found = drafts.iter().enumerate().find_map(|(world, draft)| {
        let task = draft.areas.iter().find(|a| a.name == *of.get_ref() && a.kind == AreaKind::Task)?;
        Some((world, task))
    });
    let Some((world, task)) = found else {
        let known = file.areas.iter().any(|area| area.get_ref().name.get_ref() == of.get_ref());
        if !known && !file.may_have_lost("area", of.get_ref()) && !drafts.is_empty() {
            let message = format!("no task area \"{}\"", of.get_ref());
            context.error(&of.span(), message, "a zone belongs to a task area");
        }
        return None;
    };
    let level_rectangle = match task.shape {
        AreaShape::Rect { origin, u, v } if u.z == 0.0 && v.z == 0.0 => Some((origin, u, v)),
        _ => None,
    };
    let Some((origin, u, v)) = level_rectangle else {
        let message = format!("\"{}\" is no level rectangle, round which a zone could be drawn", task.name);
        context.error(&of.span(), message, "give the zone a polygon");
        return None;
    };
    let footprint = &drafts[world].rooms[task.room].footprint;
    let corners = cut(footprint, origin, u, v, band_m);
    if corners.len() < 3 {
        let message = format!("area \"{name}\" lies outside of its room");
        context.error(&section.name.span(), message, "");
        return None;
    }
    let polygon = corners.iter().map(|p| p.extend(origin.z)).collect();
    Some((AreaShape::Polygon(polygon), world, task.room))
}

/// An outline cut to the rectangle that is `band_m` wider on every side (Sutherland and Hodgman: the
/// rectangle is convex, the outline need not be).
fn cut(outline: &[DVec2], origin: DVec3, u: DVec3, v: DVec3, band_m: f64) -> Vec<DVec2> {
    let origin = DVec2::new(origin.x, origin.y);
    let mut corners = outline.to_vec();
    for edge in [u, v] {
        let (axis, length_m) = (DVec2::new(edge.x, edge.y).normalize(), edge.length());
        for (inward, limit_m) in [(axis, -band_m), (-axis, -length_m - band_m)] {
            // A corner stays where this is positive.
            let inside = |p: DVec2| (p - origin).dot(inward) - limit_m;
            let mut kept: Vec<DVec2> = Vec::new();
            for (index, &a) in corners.iter().enumerate() {
                let b = corners[(index + 1) % corners.len()];
                let (at_a, at_b) = (inside(a), inside(b));
                if at_a >= 0.0 {
                    kept.push(a);
                }
                if (at_a >= 0.0) != (at_b >= 0.0) {
                    kept.push(a + (b - a) * (at_a / (at_a - at_b)));
                }
            }
            corners = kept;
        }
    }
    corners.dedup_by(|a, b| a.distance(*b) < SAME_M);
    if corners.len() > 1 && corners[0].distance(corners[corners.len() - 1]) < SAME_M {
        corners.pop();
    }
    corners
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_m2(corners: &[DVec2]) -> f64 {
        let count = corners.len();
        0.5 * (0..count).map(|i| corners[i].perp_dot(corners[(i + 1) % count])).sum::<f64>().abs()
    }

    /// Catches: a band on one side only, a zone that leaves the room, an L-shaped room taken for its hull.
    #[test]
    fn a_band_is_as_wide_on_every_side_and_ends_at_the_walls() {
        let room = [(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)].map(DVec2::from);
        let desk = |x: f64, y: f64| cut(&room, DVec3::new(x, y, 0.75), DVec3::X * 1.6, DVec3::Y * 0.8, 0.5);
        assert!((area_m2(&desk(3.0, 2.0)) - 2.6 * 1.8).abs() < 1e-9);
        assert!((area_m2(&desk(0.0, 0.0)) - 2.1 * 1.3).abs() < 1e-9, "in the corner");
        assert!(desk(20.0, 20.0).is_empty());
        let turned = DVec3::new(0.6, 0.8, 0.0);
        let slanted = cut(&room, DVec3::new(3.0, 2.0, 0.0), turned, DVec3::new(-0.8, 0.6, 0.0), 0.1);
        assert!((area_m2(&slanted) - 1.2 * 1.2).abs() < 1e-9);
        let l = [(0.0, 0.0), (8.0, 0.0), (8.0, 2.0), (4.0, 2.0), (4.0, 5.0), (0.0, 5.0)].map(DVec2::from);
        let at_the_notch = cut(&l, DVec3::new(3.0, 1.0, 0.0), DVec3::X, DVec3::Y, 0.5);
        // 2 × 2 m about (3.5, 1.5) less the quarter beyond the inner corner, 0.5 × 0.5 m.
        assert!((area_m2(&at_the_notch) - 3.75).abs() < 1e-9);
    }
}
