//! Whether a place lies inside closed furniture, where nobody can be and nothing is lit.

use glam::DVec3;

use super::Scene;
use crate::geometry::trace::Hit;

/// Surfaces closer than this share a plane, m.
const TOUCHING_M: f64 = 1e-6;

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
