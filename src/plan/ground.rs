//! The illuminated area that an observer rates glare against (GR): which one it is, and what lies under it.

use glam::DVec3;

use super::PlannedArea;
use crate::project::Viewpoint;
use crate::quantity::Quantity;
use crate::scene::Scene;

/// How far over a point the look down begins, m: an area at floor level lies on the floor.
const ABOVE_M: f64 = 1e-3;

/// An area with the reflectance of what lies under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedGround {
    /// Index among the room's areas.
    pub area: usize,
    /// Index of its horizontal illuminance among the area's quantities.
    pub quantity: usize,
    /// Mean diffuse reflectance of what lies straight under its points, or as given.
    pub reflectance: f64,
}

/// The area of a viewpoint: the one it names, else the only horizontal one of its room.
///
/// # Errors
/// Why there is none.
pub(super) fn ground(
    scene: &Scene,
    areas: &[PlannedArea],
    viewpoint: &Viewpoint,
    named: Option<&str>,
) -> Result<PlannedGround, &'static str> {
    let level = |area: &PlannedArea| {
        let is_level = area.grid.normal.z.abs() > 0.99;
        area.quantities.iter().position(|entry| match entry.quantity {
            Quantity::Horizontal => true,
            Quantity::Normal => is_level,
            _ => false,
        })
    };
    let mut found = areas.iter().enumerate().filter_map(|(area, planned)| {
        let is_wanted = named.is_none_or(|name| planned.name == name);
        Some((area, level(planned).filter(|_| is_wanted)?))
    });
    let (area, quantity) = match (found.next(), found.next(), named) {
        (Some(one), None, _) => one,
        (None, _, Some(_)) => return Err("the area has no horizontal illuminance"),
        (None, _, None) => {
            return Err("no area of the room has a horizontal illuminance, against which GR rates glare");
        }
        (Some(_), Some(_), _) => {
            return Err("the room has several areas: name that of the viewpoint (`ground = { area = … }`)");
        }
    };
    let reflectance = match viewpoint.area_reflectance {
        Some(given) => given,
        None => under(scene, &areas[area])?,
    };
    Ok(PlannedGround { area, quantity, reflectance })
}

/// Mean diffuse reflectance of what lies straight under the points that count.
fn under(scene: &Scene, area: &PlannedArea) -> Result<f64, &'static str> {
    let counted = area.grid.points.iter().filter(|point| point.excluded.is_none());
    let (mut sum, mut count) = (0.0, 0.0);
    for point in counted {
        let Some(hit) = scene.tracer.closest(point.position + ABOVE_M * DVec3::Z, DVec3::NEG_Z, &[]) else {
            return Err(
                "nothing lies under the area whose reflectance could be taken (`ground = { reflectance = … }`)",
            );
        };
        sum += scene.bsdf(hit.triangle).diffuse().0;
        count += 1.0;
    }
    Ok(sum / count)
}
