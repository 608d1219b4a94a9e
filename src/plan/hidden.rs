//! Grid points that are not evaluated: inside closed furniture, or in an area that is judged on its own.

use glam::{DVec2, DVec3};

use crate::geometry::trace::Hit;
use crate::grid::{Exclusion, Grid, distance_to_outline, inside};
use crate::project::{AreaKind, AreaShape, AreaSpec};
use crate::scene::Scene;

/// Surfaces closer than this share a plane, m.
const TOUCHING_M: f64 = 1e-6;

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

/// Whether a point lies inside closed furniture: along every direction it leaves more solids than
/// it enters. Several directions guard against open sheets; on a surface those into it are left
/// out, so that a cabinet sunk into a wall hides the wall's points.
pub fn inside_furniture(scene: &Scene, place: DVec3, normal: DVec3, on_surface: bool) -> bool {
    let at = place + if on_surface { normal * 1e-4 } else { DVec3::ZERO };
    [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z]
        .into_iter()
        .filter(|axis| !on_surface || axis.dot(normal) > -0.5)
        .all(|axis| {
            // Slightly off the axes, so that the rays do not run along faces.
            let direction = (axis + DVec3::new(1.3e-3, 2.7e-3, 3.9e-3)).normalize();
            let into = direction.dot(normal);
            let outward = on_surface && into < 0.0;
            leaves_solid(scene, at, if outward { direction - 2.0 * into * normal } else { direction })
        })
}

/// Counts the furniture faces along a ray up to the room's shell: more back sides than front sides means it starts inside.
fn leaves_solid(scene: &Scene, mut origin: DVec3, direction: DVec3) -> bool {
    const MOST_FACES: usize = 10_000;
    let mut inside = 0;
    for _ in 0..MOST_FACES {
        let Some(hit) = scene.tracer.closest(origin, direction, &[]) else { break };
        let surface = scene.tracer.surface(hit.triangle);
        let is_furniture =
            |hit: &Hit| scene.mesh.surfaces[scene.tracer.surface(hit.triangle) as usize].furniture;
        let leaving = |hit: &Hit| if hit.front { -1 } else { 1 };
        if !is_furniture(&hit) {
            // A piece that stands on the floor shares a plane with it, and a ray may meet the floor first.
            let touching = scene.tracer.closest(origin, direction, &[surface]);
            if let Some(next) = touching.filter(|next| next.distance_m < hit.distance_m + TOUCHING_M)
                && is_furniture(&next)
            {
                inside += leaving(&next);
            }
            break;
        }
        inside += leaving(&hit);
        origin += direction * (hit.distance_m + scene.tracer.offset_m());
    }
    inside > 0
}
