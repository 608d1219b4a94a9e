//! Grid points that are not evaluated: inside closed furniture, or in an area that is judged on its own.

use glam::{DVec2, DVec3};

use crate::grid::{Exclusion, Grid, distance_to_outline, inside};
use crate::project::{AreaKind, AreaShape, AreaSpec};
use crate::scene::{Scene, inside_furniture};

/// A point this near to the edge of another area belongs to it, m.
const EDGE_M: f64 = 1e-6;

/// Outlines in plan of the task and surrounding areas that a surrounding or background leaves out.
///
/// Where a norm compares the surrounding's mean with the task's, it is the total area, task included.
pub(super) fn holes(spec: &AreaSpec, index: usize, specs: &[AreaSpec], is_total: bool) -> Vec<Vec<DVec2>> {
    specs
        .iter()
        .enumerate()
        .filter(|&(other, area)| {
            let owns = match spec.kind {
                AreaKind::Surrounding => area.kind == AreaKind::Task && !is_total,
                AreaKind::Background => matches!(area.kind, AreaKind::Task | AreaKind::Surrounding),
                AreaKind::Task | AreaKind::Surface | AreaKind::Volume => false,
            };
            owns && other != index && area.room == spec.room
        })
        .filter_map(|(_, area)| plan_outline(&area.shape))
        .collect()
}

/// Marks points inside closed furniture, and points in the areas that are left out.
pub(super) fn exclude(grid: &mut Grid, spec: &AreaSpec, holes: &[Vec<DVec2>], scene: &Scene) {
    let in_hole = |hole: &Vec<DVec2>, place| inside(hole, place) || distance_to_outline(hole, place) < EDGE_M;
    for point in grid.points.iter_mut().filter(|point| point.excluded.is_none()) {
        let flat = DVec2::new(point.position.x, point.position.y);
        if holes.iter().any(|hole| in_hole(hole, flat)) {
            point.excluded = Some(Exclusion::InOtherArea);
        } else if inside_furniture(scene, point.position, point.normal, spec.kind == AreaKind::Surface) {
            point.excluded = Some(Exclusion::InsideFurniture);
        }
    }
}

/// Outline in plan of a horizontal area.
fn plan_outline(shape: &AreaShape) -> Option<Vec<DVec2>> {
    let flat = |p: DVec3| DVec2::new(p.x, p.y);
    match shape {
        AreaShape::Rect { origin, u, v } if u.z == 0.0 && v.z == 0.0 => {
            Some([*origin, *origin + *u, *origin + *u + *v, *origin + *v].map(flat).to_vec())
        }
        AreaShape::Polygon(corners) => Some(corners.iter().copied().map(flat).collect()),
        AreaShape::Rect { .. } | AreaShape::Surface { .. } | AreaShape::Points(_) => None,
    }
}
