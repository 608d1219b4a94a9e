//! A room's flux balance and installed power.

use super::Context;
use crate::luminaire::Luminaire;
use crate::measure::{area, flux};
use crate::norm::{Light, State};
use crate::outcome::{FluxBalance, Power, Value};
use crate::plan::PlannedRoom;
use crate::project::{AreaKind, Room};
use crate::quantity::{Quantity, Statistic};
use crate::scene::Channel;

impl Context<'_> {
    pub(super) fn flux(
        &self,
        room: &Room,
        planned: &PlannedRoom,
        values: &mut Vec<Value>,
    ) -> Vec<FluxBalance> {
        let mut balances = Vec::new();
        for (number, light_scene) in self.project.light_scenes.iter().enumerate() {
            let weights = self.initial(number, room);
            let tasks = self.flux_on_tasks(planned, &weights);
            let balance = flux::balance(
                &self.answers,
                &self.world.scene,
                &light_scene.name,
                &weights,
                tasks.as_deref().map(|tasks| (tasks, self.flux_of_room(room, &weights))),
                self.alpha,
            );
            if let Some(balance) = balance {
                if let Some(utilisation) = balance.utilisation {
                    values.push(Value {
                        room: room.name.clone(),
                        subject: room.name.clone(),
                        light_scene: light_scene.name.clone(),
                        quantity: "utilisation".into(),
                        statistic: Statistic::Value.key().into(),
                        location: None,
                        unit: "1".into(),
                        estimate: Ok(utilisation),
                        n: self.answers.blocks(),
                    });
                }
                balances.push(balance);
            }
        }
        balances
    }

    /// Initial flux of a room's own luminaires, and of emitting surfaces, which belong to no room, lm.
    fn flux_of_room(&self, room: &Room, weights: &[f64]) -> f64 {
        let scene = &self.world.scene;
        let of_luminaires = room.luminaires.iter().map(|&index| {
            let luminaire = &scene.luminaires[index];
            weights[scene.channel_of[index]] * luminaire.kind.flux_lm * luminaire.dim
        });
        let tally = self.answers.sheets.first().and_then(|sheet| sheet.flux.as_ref());
        let channels = scene.channels.iter().zip(weights).zip(tally.map_or(&[][..], |t| &t.emitted));
        let of_surfaces = channels
            .filter(|((channel, _), _)| matches!(channel, Channel::Surfaces { .. }))
            .map(|((_, weight), flux)| weight * flux);
        of_luminaires.chain(of_surfaces).sum()
    }

    /// Installed power by floor area; and what the light scene takes by which the horizontal task areas are
    /// judged, by floor area and 100 lx of their mean. Of several such scenes the one with the most light.
    /// A luminaire takes its power in proportion to its light: what its gear takes when dimmed is not known.
    pub(super) fn power(&self, index: usize) -> Option<Power> {
        let room = &self.world.rooms[index];
        let scene = &self.world.scene;
        let hung = || room.luminaires.iter().map(|&l| &scene.luminaires[l]);
        let watts = hung().map(|luminaire| luminaire.kind.power_w);
        let installed_w = watts.collect::<Option<Vec<f64>>>()?.into_iter().sum::<f64>();
        let corners = &room.footprint;
        let count = corners.len();
        let doubled: f64 = (0..count).map(|i| corners[i].perp_dot(corners[(i + 1) % count])).sum();
        let area_m2 = 0.5 * doubled.abs();
        if !(installed_w > 0.0 && area_m2 > 0.0) {
            return None;
        }
        // In an emergency the mains draw nothing, so that nothing can be related to it.
        let in_emergency = self.condition().state == State::Emergency;
        let tasks = self.plan.rooms[index].areas.iter().filter(|area| area.kind == AreaKind::Task);
        let mut judged: Vec<usize> = tasks.map(|area| area.light_scene).collect();
        judged.sort_unstable();
        judged.dedup();
        let lit = judged.iter().filter_map(|&number| Some((number, self.mean_on_tasks(index, number)?)));
        let lit = lit.filter(|_| !in_emergency).max_by(|(_, a), (_, b)| a.total_cmp(b));
        let light_scene = &self.project.light_scenes[lit.map_or(0, |(number, _)| number)];
        let taken = |luminaire: &Luminaire| {
            luminaire.kind.power_w.unwrap_or(0.0) * luminaire.dim * light_scene.factor(&luminaire.group)
        };
        let scene_w: f64 = hung().map(taken).sum();
        Some(Power {
            installed_w,
            area_m2,
            density_w_m2: installed_w / area_m2,
            mean_lx: lit.map(|(_, mean_lx)| mean_lx),
            density_w_m2_100lx: lit.map(|(_, mean_lx)| scene_w / area_m2 / (mean_lx / 100.0)),
            light_scene: light_scene.name.clone(),
            scene_w,
        })
    }

    /// Mean on the horizontal task areas under a light scene, lx, each by its size; `None` without light.
    fn mean_on_tasks(&self, index: usize, light_scene: usize) -> Option<f64> {
        let weights = self.weights(light_scene, &self.world.rooms[index]);
        let (mut flux_lm, mut lit_m2) = (0.0, 0.0);
        for area in self.plan.rooms[index].areas.iter().filter(|area| area.kind == AreaKind::Task) {
            let Some(entry) = area.quantities.iter().find(|q| q.quantity == Quantity::Horizontal) else {
                continue;
            };
            let blocks = area::blocks(&self.answers, entry, &weights, self.condition().light);
            let cell_m2 = area.grid.spacing_m[0] * area.grid.spacing_m[1];
            if let Ok(mean_lx) = area::gauge(&blocks, Statistic::Mean, self.alpha).value {
                let own_m2 = cell_m2 * blocks.values.len() as f64;
                flux_lm += mean_lx * own_m2;
                lit_m2 += own_m2;
            }
        }
        (flux_lm > 0.0).then(|| flux_lm / lit_m2)
    }

    /// Block values of Σ Ē·A over the task areas, lm.
    fn flux_on_tasks(&self, planned: &PlannedRoom, weights: &[f64]) -> Option<Vec<f64>> {
        let mut sum: Option<Vec<f64>> = None;
        for area in planned.areas.iter().filter(|area| area.kind == AreaKind::Task) {
            let entry = area
                .quantities
                .iter()
                .find(|q| matches!(q.quantity, Quantity::Horizontal | Quantity::Normal))?;
            let blocks = area::blocks(&self.answers, entry, weights, Light::All);
            let cell_m2 = area.grid.spacing_m[0] * area.grid.spacing_m[1];
            let total = sum.get_or_insert_with(|| vec![0.0; self.answers.blocks()]);
            for point in &blocks.values {
                for (total, value) in total.iter_mut().zip(point) {
                    *total += value * cell_m2;
                }
            }
        }
        sum
    }
}
