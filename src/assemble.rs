//! Plan and sheets → requirements with verdicts, and everything the report shows.

use glam::{DVec2, DVec3};

use crate::emitters::{Emitters, Sighted};
use crate::glare::source::NO_SOURCE;
use crate::judge::{self, Judged};
use crate::luminaire::LuminaireType;
use crate::measure::glare_sources::Convention;
use crate::measure::{self, Answers, Gauged, area, flux, room_ugr, view};
use crate::outcome::{
    AreaOutcome, LuminaireOutcome, PointField, Power, Requirement, RoomOutcome, TypeOutcome, UgrTableOutcome,
    Value, Verdict, ViewpointOutcome,
};
use crate::plan::{Plan, PlannedRequirement, PlannedRoom, Subject};
use crate::project::{Compare, Declared, Project, Room, World};
use crate::quantity::{Property, Quantity, Statistic};
use crate::scene::Channel;
use crate::units::Undefined;

/// Luminance in cd/m² up to which a shining surface (a screen, say) leaves the UGR table of a room valid;
/// brighter ones would dazzle without the method's knowing. A convention of this program.
const BRIGHT_SURFACE_CD_M2: f64 = 500.0;

/// Everything that is measured on one world after some blocks.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The project.
    pub project: &'a Project,
    /// The world.
    pub world: &'a World,
    /// Its plan.
    pub plan: &'a Plan,
    /// Its answers so far.
    pub answers: Answers<'a>,
    /// Its luminaires.
    pub emitters: &'a Emitters<'a>,
    /// What each planned view of each room sees, computed once.
    pub seen: &'a [Vec<Sighted>],
    /// For each room, the UGR table method's values for each spacing-to-height ratio asked for.
    pub tables: &'a [Vec<(f64, Vec<UgrTableOutcome>)>],
    /// Risk of an individual interval.
    pub alpha: f64,
    /// Risk of all requirements of a room at this look.
    pub joint_alpha: f64,
}

/// The table method's values of every room: the norm's ratio first, then others that are required.
pub fn ugr_tables(
    tables: &mut room_ugr::Tables,
    project: &Project,
    world: &World,
    plan: &Plan,
) -> Vec<Vec<(f64, Vec<UgrTableOutcome>)>> {
    let usual = project.norm.as_ref().map_or(0.25, |norm| norm.standard.application.ugr_shr.value);
    let rooms = world.rooms.iter().zip(&plan.rooms);
    rooms
        .map(|(room, planned)| {
            let mut ratios = vec![usual];
            for requirement in &planned.requirements {
                if let Subject::UgrTable(shr) | Subject::DiscomfortTable(shr) = requirement.subject
                    && !ratios.iter().any(|known| known.to_bits() == shr.to_bits())
                {
                    ratios.push(shr);
                }
            }
            ratios.into_iter().map(|shr| (shr, room_ugr::of_room(tables, world, room, shr))).collect()
        })
        .collect()
}

/// The sources seen by every planned view.
pub fn seen_by_views(plan: &Plan, emitters: &Emitters, seed: u64) -> Vec<Vec<Sighted>> {
    use rayon::prelude::*;
    plan.rooms
        .iter()
        .map(|room| {
            room.views
                .par_iter()
                .map(|view| crate::emitters::sighted_from(emitters, view.eye, seed, view.highlights))
                .collect()
        })
        .collect()
}

impl Context<'_> {
    /// All requirements of a room, judged.
    pub fn requirements(&self, room: usize) -> Vec<Requirement> {
        let planned = &self.plan.rooms[room];
        let family = planned.requirements.iter().filter(|r| is_computed(&r.subject)).count().max(1);
        let alpha = self.joint_alpha / family as f64;
        planned.requirements.iter().map(|requirement| self.requirement(room, requirement, alpha)).collect()
    }

    fn requirement(&self, room: usize, planned: &PlannedRequirement, alpha: f64) -> Requirement {
        let compare = self.project.norm.as_ref().map_or(Compare::Exact, |norm| norm.compare);
        let (gauged, note, forced) = self.gauge(room, planned, alpha);
        let other = if compare == Compare::Exact { Compare::Printed } else { Compare::Exact };
        let judge =
            |compare| judge::judge(&gauged, planned.quantity, planned.statistic, planned.bound, compare);
        let Judged { verdict, at_the_limit, margin } = judge(compare);
        let verdict = match (forced, verdict) {
            (Some(Verdict::Declared), Verdict::Fail) => Verdict::Fail,
            (Some(forced), _) => forced,
            (None, verdict) => verdict,
        };
        let otherwise = judge(other).verdict;
        let blocks_needed = (verdict == Verdict::Undecided)
            .then(|| judge::blocks_needed(&gauged, planned.quantity, planned.bound, self.answers.blocks()))
            .flatten();
        Requirement {
            standard: planned.standard.clone(),
            clause: planned.clause.clone(),
            room: self.world.rooms[room].name.clone(),
            subject: planned.subject_name.clone(),
            light_scene: self.project.light_scenes[planned.light_scene].name.clone(),
            quantity: planned.quantity,
            statistic: planned.statistic,
            bound: planned.bound,
            value: gauged.value.clone(),
            lo_joint: gauged.lo,
            hi_joint: gauged.hi,
            margin,
            verdict,
            at_the_limit,
            other_comparison: (forced.is_none() && otherwise != verdict).then_some(otherwise),
            blocks_needed,
            modified: planned.modified.clone(),
            verified: planned.verified.clone(),
            note,
            at_risk: Vec::new(),
        }
    }

    /// Value and joint interval, a note, and a verdict that does not come from comparison.
    fn gauge(
        &self,
        room: usize,
        planned: &PlannedRequirement,
        alpha: f64,
    ) -> (Gauged, String, Option<Verdict>) {
        let entry = &self.world.rooms[room];
        match &planned.subject {
            Subject::Area(place, quantity) => {
                let weights = self.weights(planned.light_scene, entry, true);
                let asked = &self.plan.rooms[room].areas[*place].quantities[*quantity];
                let blocks = area::blocks(&self.answers, asked, &weights);
                (area::gauge(&blocks, planned.statistic, alpha), "maintained".into(), None)
            }
            Subject::Viewpoint(viewpoint) => (
                self.worst_view(room, *viewpoint, planned.light_scene, alpha),
                Convention::default().words(),
                None,
            ),
            Subject::OfTask(place, quantity, task, of) => {
                let weights = self.weights(planned.light_scene, entry, true);
                let areas = &self.plan.rooms[room].areas;
                let own = area::blocks(&self.answers, &areas[*place].quantities[*quantity], &weights);
                let task = area::blocks(&self.answers, &areas[*task].quantities[*of], &weights);
                (area::gauge_of_task(&own, &task, alpha), "maintained".into(), None)
            }
            Subject::UgrTable(shr) => {
                let mut note = format!("table method CIE 190, SHR {shr}, worst direction, initial flux");
                for said in self.table_notes(room, *shr) {
                    note = format!("{note}; {said}");
                }
                let value = self.worst_table(room, *shr, planned.light_scene);
                (value.map_or_else(Gauged::undefined, Gauged::exact), note, None)
            }
            Subject::DiscomfortTable(shr) => {
                let note = format!("M = 10^((UGR + 4.8)/16), UGR by the table method, SHR {shr}");
                let value =
                    self.worst_table(room, *shr, planned.light_scene).map(crate::glare::discomfort::index_m);
                (value.map_or_else(Gauged::undefined, Gauged::exact), note, None)
            }
            Subject::ColourRendering => {
                let all = entry
                    .luminaires
                    .iter()
                    .map(|&l| self.declared(entry, l, |d| d.ra, |kind| kind.declared_ra));
                declared(all, f64::min, "ra")
            }
            Subject::Declared(property) => {
                let (of, key): (fn(&Declared) -> Option<f64>, _) = match property {
                    Property::Pulsation => (|d| d.pulsation_percent, "flicker = { pulsation }"),
                    Property::PstLm => (|d| d.pst_lm, "flicker = { pst_lm }"),
                    Property::Svm => (|d| d.svm, "flicker = { svm }"),
                };
                declared(
                    entry.luminaires.iter().map(|&l| self.declared(entry, l, of, |_| None)),
                    f64::max,
                    key,
                )
            }
            Subject::Missing(reason) => (
                Gauged::undefined(Undefined::because(reason.clone())),
                String::new(),
                Some(Verdict::NotAssessed),
            ),
        }
    }

    /// The worst table value of a room at a spacing-to-height ratio. The method knows luminaires only:
    /// where other surfaces shine brightly it says nothing.
    fn worst_table(&self, room: usize, shr: f64, light_scene: usize) -> Result<f64, Undefined> {
        let weights = self.weights(light_scene, &self.world.rooms[room], false);
        let scene = &self.world.scene;
        let bright = scene.channels.iter().zip(&weights).any(|(channel, weight)| match channel {
            Channel::Surfaces { material } => {
                weight * scene.materials[*material].bsdf.emitted() > BRIGHT_SURFACE_CD_M2
            }
            Channel::Luminaires { .. } => false,
        });
        if bright {
            return Err(Undefined::because(
                "table method not applicable: bright luminous surfaces shine in the room",
            ));
        }
        room_ugr::worst(self.table(room, shr))
    }

    /// The table values of a room at a spacing-to-height ratio.
    fn table(&self, room: usize, shr: f64) -> &[UgrTableOutcome] {
        let of_ratio = self.tables[room].iter().find(|(ratio, _)| ratio.to_bits() == shr.to_bits());
        of_ratio.map_or(&[], |(_, table)| table)
    }

    /// What had to be taken otherwise than it is, each once.
    fn table_notes(&self, room: usize, shr: f64) -> Vec<&String> {
        let mut notes: Vec<&String> = self.table(room, shr).iter().flat_map(|table| &table.notes).collect();
        notes.sort();
        notes.dedup();
        notes
    }

    /// A property declared for a luminaire: under its type's name, under the room's, or in its file.
    fn declared(
        &self,
        room: &Room,
        luminaire: usize,
        property: fn(&Declared) -> Option<f64>,
        of_file: fn(&LuminaireType) -> Option<f64>,
    ) -> Option<f64> {
        let kind = &*self.world.scene.luminaires[luminaire].kind;
        let of =
            |subject: &str| self.project.declared.iter().find(|d| d.subject == subject).and_then(property);
        // A type that hangs with the maintenance of several rooms is called "A (room)" from the second on.
        let listed = kind.name.split_once(" (").and_then(|(listed, _)| of(listed));
        of(&kind.name).or(listed).or_else(|| of(&room.name)).or(of_file(kind))
    }

    /// The worst direction of a viewpoint: its lower end uncorrected, its upper end for all directions.
    /// A direction in which no source is visible is never the worst, unless it is so in all.
    fn worst_view(&self, room: usize, viewpoint: usize, light_scene: usize, alpha: f64) -> Gauged {
        let views: Vec<usize> = (0..self.plan.rooms[room].views.len())
            .filter(|&index| self.plan.rooms[room].views[index].viewpoint == viewpoint)
            .collect();
        let each = alpha / views.len().max(1) as f64;
        let (mut worst, mut dark): (Option<Gauged>, Option<Gauged>) = (None, None);
        for &index in &views {
            let gauged = self.glare(room, index, light_scene, each, &[]).ugr;
            match &gauged.value {
                Err(undefined) if undefined.reason == NO_SOURCE => {
                    dark = Some(gauged);
                    continue;
                }
                Err(_) => return gauged,
                Ok(_) => {}
            }
            let value = gauged.value.clone().unwrap_or(f64::NAN);
            worst = Some(match worst {
                None => gauged,
                Some(known) => {
                    let (lo, hi) = (known.lo.max(gauged.lo), known.hi.max(gauged.hi));
                    let greater = value > known.value.clone().unwrap_or(f64::NAN);
                    Gauged { lo, hi, ..if greater { gauged } else { known } }
                }
            });
        }
        worst
            .or(dark)
            .unwrap_or_else(|| Gauged::undefined(Undefined::because("the viewpoint has no direction")))
    }

    /// Glare of a planned view; `indices` are wanted beside UGR.
    fn glare(
        &self,
        room: usize,
        index: usize,
        light_scene: usize,
        alpha: f64,
        indices: &[&'static str],
    ) -> view::Glare {
        let planned = &self.plan.rooms[room].views[index];
        let weights = self.weights(light_scene, &self.world.rooms[room], false);
        let sighted = &self.seen[room][index];
        let convention = Convention::default();
        let light = view::EyeLight::of_row(&self.answers, planned.row, &weights);
        let asked = view::Asked { gaze: planned.direction, indices, convention };
        view::glare(&light, self.emitters, sighted, &asked, &weights, alpha)
    }

    fn weights(&self, light_scene: usize, room: &Room, maintained: bool) -> Vec<f64> {
        measure::weights(self.world, &self.project.light_scenes[light_scene], room, maintained)
    }

    /// Whether every requested value has reached a relative standard error `r` (UGR: 3.5 r).
    pub fn accurate(&self, r: f64) -> bool {
        (0..self.plan.rooms.len()).all(|room| {
            let entry = &self.world.rooms[room];
            let planned = &self.plan.rooms[room];
            let areas = planned.areas.iter().all(|area| {
                let weights = self.weights(area.light_scene, entry, true);
                area.quantities
                    .iter()
                    .all(|quantity| fine(&area::blocks(&self.answers, quantity, &weights), r))
            });
            let views = (0..planned.views.len()).all(|index| {
                let ugr = self.glare(room, index, planned.views[index].light_scene, self.alpha, &[]).ugr;
                ugr.value.is_err() || ugr.se <= 3.5 * r
            });
            areas && views
        })
    }

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
                judge::dimming(&self.requirements(index))
            },
        };
        (outcome, values)
    }

    fn area(&self, room: &Room, area: &crate::plan::PlannedArea, values: &mut Vec<Value>) -> AreaOutcome {
        let mut fields = Vec::new();
        for (number, light_scene) in self.project.light_scenes.iter().enumerate() {
            let weights = self.weights(number, room, true);
            for entry in &area.quantities {
                fields.push(PointField {
                    light_scene: light_scene.name.clone(),
                    quantity: entry.quantity,
                    maintained: true,
                    points: area::points(&self.answers, entry, &weights, self.alpha),
                    n: self.answers.blocks(),
                });
                let blocks = area::blocks(&self.answers, entry, &weights);
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
                let azimuth_deg = d.y.atan2(d.x).to_degrees();
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
                    azimuth_deg: if azimuth_deg == 0.0 { 0.0 } else { azimuth_deg },
                    tilt_deg: d.z.clamp(-1.0, 1.0).asin().to_degrees(),
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

    fn flux(
        &self,
        room: &Room,
        planned: &PlannedRoom,
        values: &mut Vec<Value>,
    ) -> Vec<crate::outcome::FluxBalance> {
        let mut balances = Vec::new();
        for (number, light_scene) in self.project.light_scenes.iter().enumerate() {
            let weights = self.weights(number, room, false);
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

    /// Installed power, per floor area and per 100 lx of the mean on the horizontal task areas under the
    /// first light scene.
    fn power(&self, index: usize) -> Option<Power> {
        let (room, planned) = (&self.world.rooms[index], &self.plan.rooms[index]);
        let scene = &self.world.scene;
        let watts = room.luminaires.iter().map(|&l| scene.luminaires[l].kind.power_w);
        let installed_w = watts.collect::<Option<Vec<f64>>>()?.into_iter().sum::<f64>();
        let corners = &room.footprint;
        let count = corners.len();
        let doubled: f64 = (0..count).map(|i| corners[i].perp_dot(corners[(i + 1) % count])).sum();
        let area_m2 = 0.5 * doubled.abs();
        if !(installed_w > 0.0 && area_m2 > 0.0) {
            return None;
        }
        let weights = self.weights(0, room, true);
        let (mut flux_lm, mut lit_m2) = (0.0, 0.0);
        for area in planned.areas.iter().filter(|area| area.kind == crate::project::AreaKind::Task) {
            let Some(entry) = area.quantities.iter().find(|q| q.quantity == Quantity::Horizontal) else {
                continue;
            };
            let blocks = area::blocks(&self.answers, entry, &weights);
            let cell_m2 = area.grid.spacing_m[0] * area.grid.spacing_m[1];
            if let Ok(mean_lx) = area::gauge(&blocks, Statistic::Mean, self.alpha).value {
                let own_m2 = cell_m2 * blocks.values.len() as f64;
                flux_lm += mean_lx * own_m2;
                lit_m2 += own_m2;
            }
        }
        let mean_lx = (lit_m2 > 0.0).then(|| flux_lm / lit_m2).filter(|mean| *mean > 0.0);
        let density_w_m2 = installed_w / area_m2;
        Some(Power {
            installed_w,
            area_m2,
            density_w_m2,
            mean_lx,
            density_w_m2_100lx: mean_lx.map(|mean| density_w_m2 / (mean / 100.0)),
            light_scene: self.project.light_scenes[0].name.clone(),
        })
    }

    /// Block values of Σ Ē·A over the task areas, lm.
    fn flux_on_tasks(&self, planned: &PlannedRoom, weights: &[f64]) -> Option<Vec<f64>> {
        let mut sum: Option<Vec<f64>> = None;
        for area in planned.areas.iter().filter(|area| area.kind == crate::project::AreaKind::Task) {
            let entry = area
                .quantities
                .iter()
                .find(|q| matches!(q.quantity, Quantity::Horizontal | Quantity::Normal))?;
            let blocks = area::blocks(&self.answers, entry, weights);
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

/// The worst of what is declared for a room's luminaires; nothing is declared if one of them lacks it.
fn declared(
    of_luminaires: impl Iterator<Item = Option<f64>>,
    worse: fn(f64, f64) -> f64,
    key: &str,
) -> (Gauged, String, Option<Verdict>) {
    let all = of_luminaires.collect::<Option<Vec<f64>>>();
    if let Some(worst) = all.and_then(|all| all.into_iter().reduce(worse)) {
        return (Gauged::exact(worst), "declared, not computed".into(), Some(Verdict::Declared));
    }
    let reason = Undefined::because(format!("not declared for every luminaire type ([declared] {key})"));
    (Gauged::undefined(reason), "not computed".into(), Some(Verdict::NotAssessed))
}

/// RMS over points of se/value and the relative errors of the mean within `r`.
fn fine(blocks: &area::Blocks, r: f64) -> bool {
    let relative = |values: &[f64]| {
        let estimate = crate::estimate::Estimate::from_blocks(values);
        if estimate.se > 0.0 { estimate.se / estimate.value.abs() } else { 0.0 }
    };
    let count = blocks.values.len().max(1) as f64;
    let square = blocks.values.iter().map(|point| relative(point).powi(2)).sum::<f64>() / count;
    let statistics = [Statistic::Mean, Statistic::Min, Statistic::Max].map(|s| area::gauge(blocks, s, 0.5));
    let all = statistics.iter().all(|g| g.value.as_ref().map_or(true, |v| !(g.se > r * v.abs())));
    square.sqrt() <= r && all
}

fn is_computed(subject: &Subject) -> bool {
    matches!(subject, Subject::Area(..) | Subject::OfTask(..) | Subject::Viewpoint(_))
}

fn luminaire(entry: &crate::luminaire::Luminaire) -> LuminaireOutcome {
    let axes = entry.world_from_luminaire;
    LuminaireOutcome {
        kind: entry.kind.name.clone(),
        group: entry.group.clone(),
        position: entry.position,
        outline: entry.kind.opening.outline().iter().map(|&p| entry.position + axes * p).collect(),
        c0: axes * crate::sphere::from_azimuth_tilt(entry.kind.c0_azimuth_deg, 0.0),
        aim: entry.beam_axis(),
    }
}

fn types(world: &World, room: &Room) -> Vec<TypeOutcome> {
    let mut types: Vec<TypeOutcome> = Vec::new();
    for &index in &room.luminaires {
        let kind = &world.scene.luminaires[index].kind;
        if let Some(known) = types.iter_mut().find(|known| known.name == kind.name) {
            known.count += 1;
            continue;
        }
        let m = kind.maintenance;
        types.push(TypeOutcome {
            distribution: kind.distribution.clone(),
            name: kind.name.clone(),
            description: kind.description.clone(),
            file: kind.file.clone(),
            count: 1,
            flux_lm: kind.flux_lm,
            rated_flux_lm: kind.rated_flux_lm,
            power_w: kind.power_w,
            maintenance_factor: m.factor() * room.rsmf,
            maintenance: [m.llmf, m.lsf, m.lmf, room.rsmf],
        });
    }
    types
}

/// Convex outlines in plan of the furniture whose centre lies over the room.
fn furniture(world: &World, room: &Room) -> Vec<Vec<DVec2>> {
    let mesh = &world.scene.mesh;
    let mut corners: Vec<Vec<DVec2>> = vec![Vec::new(); mesh.surfaces.len()];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        if mesh.surfaces[triangle.surface as usize].furniture {
            corners[triangle.surface as usize]
                .extend(mesh.corners(index).map(|p: DVec3| DVec2::new(p.x, p.y)));
        }
    }
    let (lo, hi) = room
        .footprint
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    corners
        .into_iter()
        .filter(|points| !points.is_empty())
        .map(hull)
        .filter(|outline| {
            let centre = outline.iter().sum::<DVec2>() / outline.len() as f64;
            outline.len() >= 3 && centre.cmpge(lo).all() && centre.cmple(hi).all()
        })
        .collect()
}

/// Convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut outline = half(&mut points.iter().copied());
    outline.extend(half(&mut points.iter().rev().copied()));
    outline
}
