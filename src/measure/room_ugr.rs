//! A room's UGR by the table method: the value on which norms decide for a new installation.

use glam::DVec2;

use crate::glare::ugr_table::{self, TableInput};
use crate::luminaire::LuminaireType;
use crate::outcome::UgrTableOutcome;
use crate::project::{Room, World};
use crate::units::Undefined;

/// Table values of every luminaire type in a room.
pub fn table(world: &World, room: &Room, shr: f64) -> Vec<UgrTableOutcome> {
    let mut kinds: Vec<&LuminaireType> = Vec::new();
    for &index in &room.luminaires {
        let kind = &*world.scene.luminaires[index].kind;
        if !kinds.iter().any(|known| known.name == kind.name) {
            kinds.push(kind);
        }
    }
    kinds.into_iter().map(|kind| of_kind(world, room, kind, shr)).collect()
}

/// The worst of all types and directions, on which the norm decides.
///
/// # Errors
/// The reason if it is undefined for any type.
pub fn worst(tables: &[UgrTableOutcome]) -> Result<f64, Undefined> {
    let mut worst: Option<f64> = None;
    for value in tables.iter().flat_map(|table| [&table.crosswise, &table.endwise]) {
        let value = value.clone()?;
        worst = Some(worst.map_or(value, |known| known.max(value)));
    }
    worst.ok_or_else(|| Undefined::because("the room has no luminaire"))
}

fn of_kind(world: &World, room: &Room, kind: &LuminaireType, shr: f64) -> UgrTableOutcome {
    let mut outcome = UgrTableOutcome {
        kind: kind.name.clone(),
        shr,
        crosswise: Err(Undefined::because("not computed")),
        endwise: Err(Undefined::because("not computed")),
        notes: Vec::new(),
    };
    match values(world, room, kind, shr, &mut outcome.notes) {
        Ok((crosswise, endwise)) => {
            outcome.crosswise = crosswise;
            outcome.endwise = endwise;
        }
        Err(reason) => {
            outcome.crosswise = Err(reason.clone());
            outcome.endwise = Err(reason);
        }
    }
    outcome
}

type TableValue = Result<f64, Undefined>;

fn values(
    world: &World,
    room: &Room,
    kind: &LuminaireType,
    shr: f64,
    notes: &mut Vec<String>,
) -> Result<(TableValue, TableValue), Undefined> {
    let size = rectangle(&room.footprint)
        .ok_or_else(|| Undefined::because("table method not applicable: the room is not rectangular"))?;
    let placed: Vec<_> = room
        .luminaires
        .iter()
        .map(|&index| &world.scene.luminaires[index])
        .filter(|luminaire| luminaire.kind.name == kind.name)
        .collect();
    if placed.iter().any(|luminaire| luminaire.beam_axis().z > -0.999) {
        return Err(Undefined::because(
            "table method not applicable: luminaires are not aimed straight down",
        ));
    }
    if !(kind.opening.area_m2() > 0.0) {
        return Err(Undefined::because("table method not applicable: the luminaire has no luminous area"));
    }
    let eye_m = room.floor_m + 1.2;
    let heights: Vec<f64> = placed.iter().map(|luminaire| luminaire.position.z - eye_m).collect();
    let height_m = heights.iter().sum::<f64>() / heights.len().max(1) as f64;
    if !(height_m > 0.0) || heights.iter().any(|h| (h - height_m).abs() > 0.05 * height_m) {
        return Err(Undefined::because(
            "table method not applicable: luminaires hang at different heights or below the eye",
        ));
    }
    let input = TableInput {
        intensity_cd: &|direction| kind.distribution.intensity_along(direction),
        projected_area_m2: &|direction| kind.opening.projected_area_m2(direction),
        zonal_flux_lm: &|from, to| kind.distribution.zonal_flux(from, to).0,
        flux_lm: kind.flux_lm,
    };
    // Length axis of the luminaires in plan: along x, along y, or mixed.
    let along =
        |axis: usize| placed.iter().all(|l| l.world_from_luminaire.x_axis.to_array()[axis].abs() > 0.999);
    let reflectances = room.reflectances;
    let mut look = |across: f64, depth: f64| {
        let found = ugr_table::for_room(&input, shr, across / height_m, depth / height_m, reflectances)?;
        notes.extend(found.notes.iter().cloned());
        Ok::<_, Undefined>(found)
    };
    // Looking along y sees the width x, and the other way round.
    let (facing_y, facing_x) = (look(size.x, size.y)?, look(size.y, size.x)?);
    notes.sort();
    notes.dedup();
    if along(0) {
        Ok((facing_y.crosswise, facing_x.endwise))
    } else if along(1) {
        Ok((facing_x.crosswise, facing_y.endwise))
    } else {
        notes.push("luminaires are turned: the worse of both directions of the room is taken".into());
        let worse = |a: TableValue, b: TableValue| Ok::<_, Undefined>(a?.max(b?));
        Ok((worse(facing_x.crosswise, facing_y.crosswise), worse(facing_x.endwise, facing_y.endwise)))
    }
}

/// Extent of an axis-aligned rectangular footprint; `None` for any other.
fn rectangle(footprint: &[DVec2]) -> Option<DVec2> {
    let (lo, hi) =
        footprint.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let area: f64 = 0.5
        * footprint
            .iter()
            .enumerate()
            .map(|(index, a)| a.perp_dot(footprint[(index + 1) % footprint.len()]))
            .sum::<f64>();
    let size = hi - lo;
    (size.min_element() > 0.0 && (area.abs() - size.x * size.y).abs() < 1e-6 * size.x * size.y)
        .then_some(size)
}
