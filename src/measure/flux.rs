//! Flux of luminaires and surfaces and the balance of the whole, initial flux.

use super::Answers;
use crate::estimate::Estimate;
use crate::outcome::{FluxBalance, Interval, SurfaceFlux};
use crate::scene::Scene;
use crate::solve::FluxSheet;

/// The balance under one light scene; `None` if no tally was made. `tasks` are block values of the
/// flux on the task areas of a room (Σ Ē·A) and the flux of the room's luminaires, for the
/// utilisation: several rooms may stand in one scene.
pub fn balance(
    answers: &Answers,
    scene: &Scene,
    light_scene: &str,
    weights: &[f64],
    tasks: Option<(&[f64], f64)>,
    alpha: f64,
) -> Option<FluxBalance> {
    let tallies: Vec<&FluxSheet> =
        answers.sheets.iter().map(|sheet| sheet.flux.as_ref()).collect::<Option<_>>()?;
    let emitted_lm: f64 = tallies.first()?.emitted.iter().zip(weights).map(|(flux, w)| flux * w).sum();
    let interval = |blocks: Vec<f64>| interval(&blocks, alpha);
    let channels = answers.channels;
    let weighted = |values: &[f64]| values.iter().zip(weights).map(|(flux, w)| flux * w).sum::<f64>();
    let of_surface = |tally: &FluxSheet, surface: usize, incident: bool| {
        let all = if incident { &tally.incident } else { &tally.absorbed };
        weighted(&all[surface * channels..(surface + 1) * channels])
    };
    let surfaces = scene.mesh.surfaces.len();
    let absorbed: Vec<f64> =
        tallies.iter().map(|tally| (0..surfaces).map(|s| of_surface(tally, s, false)).sum()).collect();
    let escaped: Vec<f64> = tallies.iter().map(|tally| weighted(&tally.escaped)).collect();
    let rest =
        absorbed.iter().zip(&escaped).map(|(a, e)| (emitted_lm - a - e) / emitted_lm.max(f64::MIN_POSITIVE));
    let residual_share = interval(rest.collect());
    let areas = scene.mesh.surface_areas_m2();
    Some(FluxBalance {
        light_scene: light_scene.into(),
        emitted_lm,
        absorbed: interval(absorbed),
        escaped: interval(escaped),
        residual_share,
        utilisation: tasks
            .filter(|(_, room_lm)| *room_lm > 0.0)
            .map(|(blocks, room_lm)| interval(blocks.iter().map(|flux| flux / room_lm).collect())),
        surfaces: (0..surfaces)
            .map(|surface| {
                let incident: Vec<f64> =
                    tallies.iter().map(|tally| of_surface(tally, surface, true)).collect();
                let leaving = tallies
                    .iter()
                    .zip(&incident)
                    .map(|(tally, incident)| incident - of_surface(tally, surface, false))
                    .collect();
                SurfaceFlux {
                    surface: scene.mesh.surfaces[surface].name.clone(),
                    area_m2: areas[surface],
                    incident: interval(incident),
                    leaving: interval(leaving),
                }
            })
            .collect(),
    })
}

/// Flux from point sources that reaches diffuse surfaces only by specular ways no image covers, as a
/// share of the emitted flux: what the answers omit.
pub fn omitted_share(answers: &Answers) -> f64 {
    let sum = |pick: fn(&FluxSheet) -> &Vec<f64>| -> f64 {
        answers.sheets.iter().filter_map(|sheet| sheet.flux.as_ref()).flat_map(pick).sum()
    };
    let (omitted, emitted) = (sum(|tally| &tally.omitted), sum(|tally| &tally.emitted));
    if emitted > 0.0 { omitted / emitted } else { 0.0 }
}

fn interval(blocks: &[f64], alpha: f64) -> Interval {
    let estimate = Estimate::from_blocks(blocks);
    let (lo, hi) = estimate.interval(alpha);
    Interval { value: estimate.value, se: estimate.se, lo, hi }
}
