//! What the report shows of a room: areas with their points and statistics, observers, luminaires.

use super::Context;
use super::listed::{furniture, luminaire, types};
use crate::judge;
use crate::measure::glare_sources::Convention;
use crate::measure::{area, view};
use crate::outcome::{AreaOutcome, Dimming, PointField, RoomOutcome, Value, ViewpointOutcome};
use crate::plan::PlannedRoom;
use crate::project::Room;
use crate::quantity::{Quantity, Statistic};
use crate::scene::Channel;
use crate::sphere::azimuth_tilt_deg;

impl Context<'_> {
    /// All that the report shows of a room, and the room's values in canonical order.
    pub fn room(&self, index: usize) -> (RoomOutcome, Vec<Value>) {
        let room = &self.world.rooms[index];
        let planned = &self.plan.rooms[index];
        let mut values = Vec::new();
        let areas = planned.areas.iter().map(|area| self.area(room, area, &mut values)).collect();
        let viewpoints = self.viewpoints(index, planned, &mut values);
        let scene = &self.world.scene;
        let luminaires = room.luminaires.iter().map(|&l| luminaire(&scene.luminaires[l])).collect();
        let flux = self.flux(room, planned, &mut values);
        let outcome = RoomOutcome {
            name: room.name.clone(),
            number: room.number.clone(),
            footprint: room.footprint.clone(),
            floor_m: room.floor_m,
            height_m: room.height_m,
            row: room.row.clone().or_else(|| self.project.norm.as_ref().and_then(|norm| norm.row.clone())),
            reflectances: room.reflectances,
            areas,
            viewpoints,
            luminaires,
            types: types(self.world, room),
            furniture: furniture(self.world, room),
            flux,
            ugr_table: self.tables[index].first().map_or_else(Vec::new, |(_, table)| table.clone()),
            power: self.power(index),
            // Surfaces that shine of themselves are not dimmed with the luminaires.
            dimming: if self.world.scene.channels.iter().any(|c| matches!(c, Channel::Surfaces { .. })) {
                None
            } else {
                judge::dimming(&self.requirements(index), |factor| self.dimmed_to(index, factor))
                    .map(|dimming| Dimming { groups: self.group_dimming(index), ..dimming })
            },
        };
        (outcome, values)
    }

    fn area(&self, room: &Room, area: &crate::plan::PlannedArea, values: &mut Vec<Value>) -> AreaOutcome {
        let mut fields = Vec::new();
        for (number, light_scene) in self.project.light_scenes.iter().enumerate() {
            let weights = self.weights(number, room);
            let condition = self.condition();
            for entry in &area.quantities {
                fields.push(PointField {
                    light_scene: light_scene.name.clone(),
                    quantity: entry.quantity,
                    condition,
                    points: area::points(&self.answers, entry, &weights, condition.light, self.alpha),
                    n: self.answers.blocks(),
                });
                let blocks = area::blocks(&self.answers, entry, &weights, condition.light);
                for statistic in
                    [Statistic::Mean, Statistic::Min, Statistic::Max, Statistic::U0, Statistic::Ud]
                {
                    let gauged = area::gauge(&blocks, statistic, self.alpha);
                    let ratio = matches!(statistic, Statistic::U0 | Statistic::Ud);
                    values.push(Value {
                        room: room.name.clone(),
                        subject: area.name.clone(),
                        light_scene: light_scene.name.clone(),
                        quantity: entry.quantity.key(),
                        statistic: statistic.key().into(),
                        location: gauged.place.map(|place| area.grid.points[place].position),
                        unit: if ratio { "1" } else { entry.quantity.unit() }.into(),
                        estimate: gauged.interval(),
                        n: self.answers.blocks(),
                    });
                }
            }
        }
        AreaOutcome {
            name: area.name.clone(),
            kind: area.kind,
            of: area.of.clone(),
            row: area.row.clone(),
            grid: area.grid.clone(),
            fields,
        }
    }

    fn viewpoints(
        &self,
        room: usize,
        planned: &PlannedRoom,
        values: &mut Vec<Value>,
    ) -> Vec<ViewpointOutcome> {
        let mut outcomes = Vec::new();
        for (index, entry) in planned.views.iter().enumerate() {
            for (number, light_scene) in self.project.light_scenes.iter().enumerate() {
                let glare = self.glare(room, index, number, self.alpha, &entry.indices);
                let d = entry.direction;
                values.push(Value {
                    room: self.world.rooms[room].name.clone(),
                    subject: entry.name.clone(),
                    light_scene: light_scene.name.clone(),
                    quantity: Quantity::Ugr.key(),
                    statistic: Statistic::Value.key().into(),
                    location: Some(entry.eye),
                    unit: "1".into(),
                    estimate: glare.ugr.interval(),
                    n: self.answers.blocks(),
                });
                for one in &glare.indices {
                    values.push(Value {
                        room: self.world.rooms[room].name.clone(),
                        subject: entry.name.clone(),
                        light_scene: light_scene.name.clone(),
                        quantity: one.index.key.into(),
                        statistic: Statistic::Value.key().into(),
                        location: Some(entry.eye),
                        unit: one.index.unit.into(),
                        estimate: one.gauged.interval(),
                        n: self.answers.blocks(),
                    });
                }
                outcomes.push(ViewpointOutcome {
                    indices: glare.indices.iter().map(view::GaugedIndex::outcome).collect(),
                    name: entry.name.clone(),
                    light_scene: light_scene.name.clone(),
                    eye: entry.eye,
                    direction: d,
                    azimuth_deg: entry.azimuth_deg,
                    tilt_deg: azimuth_tilt_deg(d)[1],
                    ugr: glare.ugr.interval(),
                    convention: Convention::default().words(),
                    background_cd_m2: glare.background_cd_m2,
                    e_v_lx: glare.e_v_lx,
                    sources: glare.sources,
                    notes: glare.notes,
                    card: None,
                });
            }
        }
        outcomes
    }
}
