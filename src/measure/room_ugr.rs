//! A room's UGR by the table method: the value on which norms decide for a new installation.

use std::cell::RefCell;

use glam::DVec2;

use crate::glare::ugr_table::{self, TableInput, UgrTable};
use crate::luminaire::LuminaireType;
use crate::outcome::UgrTableOutcome;
use crate::project::{Room, World};
use crate::units::Undefined;

/// Tables of luminaire types, each computed once for a project whatever the number of rooms.
#[derive(Debug, Default)]
pub struct Tables {
    known: Vec<(String, f64, Result<UgrTable, Undefined>)>,
}

impl Tables {
    /// The table of a type, from its name.
    fn of(&mut self, kind: &LuminaireType, shr: f64) -> Result<&UgrTable, Undefined> {
        let same = |name: &str, ratio: f64| name == kind.name && ratio.to_bits() == shr.to_bits();
        if let Some(place) = self.known.iter().position(|(name, ratio, _)| same(name, *ratio)) {
            return self.known[place].2.as_ref().map_err(Clone::clone);
        }
        // The method asks for the same few zones again and again.
        let zones: RefCell<Vec<(f64, f64, f64)>> = RefCell::default();
        let zonal_flux_lm = |from: f64, to: f64| {
            let same = |zone: &(f64, f64, f64)| {
                zone.0.to_bits() == from.to_bits() && zone.1.to_bits() == to.to_bits()
            };
            if let Some(zone) = zones.borrow().iter().find(|zone| same(zone)) {
                return zone.2;
            }
            let flux = kind.distribution.zonal_flux(from, to).0;
            zones.borrow_mut().push((from, to, flux));
            flux
        };
        let input = TableInput {
            intensity_cd: &|direction| kind.distribution.intensity_along(direction),
            projected_area_m2: &|direction| kind.opening.projected_area_m2(direction),
            zonal_flux_lm: &zonal_flux_lm,
            flux_lm: kind.flux_lm,
        };
        let table = ugr_table::table(&input, shr);
        self.known.push((kind.name.clone(), shr, table));
        let (_, _, table) = self.known.last().expect("just pushed");
        table.as_ref().map_err(Clone::clone)
    }
}

/// Table values of every luminaire type in a room.
pub fn of_room(tables: &mut Tables, world: &World, room: &Room, shr: f64) -> Vec<UgrTableOutcome> {
    let mut kinds: Vec<&LuminaireType> = Vec::new();
    for &index in &room.luminaires {
        let kind = &*world.scene.luminaires[index].kind;
        if !kinds.iter().any(|known| known.name == kind.name) {
            kinds.push(kind);
        }
    }
    kinds.into_iter().map(|kind| of_kind(tables, world, room, kind, shr)).collect()
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

fn of_kind(
    tables: &mut Tables,
    world: &World,
    room: &Room,
    kind: &LuminaireType,
    shr: f64,
) -> UgrTableOutcome {
    let mut outcome = UgrTableOutcome {
        kind: kind.name.clone(),
        shr,
        crosswise: Err(Undefined::because("not computed")),
        endwise: Err(Undefined::because("not computed")),
        notes: Vec::new(),
    };
    match values(tables, world, room, kind, shr, &mut outcome.notes) {
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
    tables: &mut Tables,
    world: &World,
    room: &Room,
    kind: &LuminaireType,
    shr: f64,
    notes: &mut Vec<String>,
) -> Result<(TableValue, TableValue), Undefined> {
    let Rectangle { size, axes } = rectangle(&room.footprint)
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
    let table = tables.of(kind, shr)?;
    // Length axis of the luminaires in plan: along the room's first edge, its second, or mixed.
    let along = |axis: usize| {
        placed.iter().all(|l| axes[axis].dot(l.world_from_luminaire.x_axis.truncate()).abs() > 0.999)
    };
    let reflectances = room.reflectances;
    let mut look = |across: f64, depth: f64| {
        let found = table.room(across / height_m, depth / height_m, reflectances)?;
        notes.extend(found.notes.iter().cloned());
        Ok::<_, Undefined>(found)
    };
    // x and y are the room's own: looking along y sees the width x, and the other way round.
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

/// A rectangle in plan.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rectangle {
    /// Lengths along its axes, m.
    size: DVec2,
    /// Unit vectors along its edges, the first nearest to x.
    axes: [DVec2; 2],
}

/// A footprint that is a rectangle, turned however it may be; `None` for any other.
fn rectangle(footprint: &[DVec2]) -> Option<Rectangle> {
    let edges =
        || (0..footprint.len()).map(|index| footprint[(index + 1) % footprint.len()] - footprint[index]);
    let longest = edges().max_by(|a, b| a.length().total_cmp(&b.length()))?.try_normalize()?;
    let first = if longest.x.abs() >= longest.y.abs() { longest } else { longest.perp() };
    let axes = [first, first.perp()];
    let (lo, hi) = footprint.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| {
        let own = DVec2::new(p.dot(axes[0]), p.dot(axes[1]));
        (lo.min(own), hi.max(own))
    });
    let doubled: f64 = edges().zip(footprint).map(|(edge, corner)| corner.perp_dot(*corner + edge)).sum();
    let size = hi - lo;
    let whole = size.x * size.y;
    (size.min_element() > 0.0 && (0.5 * doubled.abs() - whole).abs() < 1e-6 * whole)
        .then_some(Rectangle { size, axes })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a turned room that is none, an L or a trapezium that is one, edges that are not the room's.
    #[test]
    fn a_rectangle_is_one_however_it_is_turned() {
        let corners = [[0.0, 0.0], [6.0, 0.0], [6.0, 2.5], [6.0, 4.0], [0.0, 4.0]].map(DVec2::from_array);
        for degrees in [0.0f64, 30.0, 44.0, 90.0, 137.0, -120.0] {
            let turn = DVec2::from_angle(degrees.to_radians());
            let turned: Vec<DVec2> =
                corners.iter().map(|p| turn.rotate(*p) + DVec2::new(3.0, -7.0)).collect();
            for footprint in [turned.clone(), turned.iter().rev().copied().collect()] {
                let Rectangle { size, axes } = rectangle(&footprint).expect("a rectangle");
                let along = axes[0].dot(turn.rotate(DVec2::X)).abs();
                let expected = if along > 0.5 { DVec2::new(6.0, 4.0) } else { DVec2::new(4.0, 6.0) };
                assert!((size - expected).length() < 1e-9, "{degrees}°: {size}");
                assert!(
                    (along - along.round()).abs() < 1e-12 && axes[0].x.abs() > 0.7,
                    "{degrees}°: {axes:?}"
                );
            }
        }
        let l = [[0.0, 0.0], [6.0, 0.0], [6.0, 4.0], [3.0, 4.0], [3.0, 2.0], [0.0, 2.0]];
        assert_eq!(rectangle(&l.map(DVec2::from_array)), None);
        let trapezium = [[0.0, 0.0], [6.0, 0.0], [5.0, 4.0], [0.0, 4.0]];
        assert_eq!(rectangle(&trapezium.map(DVec2::from_array)), None);
    }
}
