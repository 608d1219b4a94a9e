//! A planned requirement → its value and joint interval, by what it is asked of: area, viewpoint, table
//! method, declaration.

use super::Context;
use crate::glare::source::nothing_glares;
use crate::luminaire::LuminaireType;
use crate::measure::beside::{self, Beside, Blockwise, Lit};
use crate::measure::glare_sources::Convention;
use crate::measure::zones::ZoneLight;
use crate::measure::{Gauged, area, intensity, room_ugr, view};
use crate::norm::Light;
use crate::outcome::{Bound, Condition, UgrTableOutcome, Verdict};
use crate::plan::{BEHIND, NOT_ASKED, PlannedRequirement, Subject, other_plane};
use crate::project::{Declared, Room};
use crate::quantity::{Property, Quantity};
use crate::scene::Channel;
use crate::units::Undefined;

/// Luminance in cd/m² up to which a shining surface (a screen, say) leaves the UGR table of a room valid;
/// brighter ones would dazzle without the method's knowing. A convention of this program.
const BRIGHT_SURFACE_CD_M2: f64 = 500.0;

/// Said where a viewpoint looks in directions that have nothing to do with its task.
const TASK_LEFT_OUT: &str = "directions that have the task behind the eye are left out";

/// Said where blocks agree on what they may all have missed.
const UNSEEN: &str = "no block has found reflected or emitted light here, though surfaces reflect or shine: there is no upper end";

/// Said where light by two mirrors is known of and was seldom met.
const MISSED: &str = "few rays have met what comes from luminaires by two mirrors, one after the other: the upper end allows for all of it";

impl Context<'_> {
    /// Value and joint interval, a note, and a verdict that does not come from comparison.
    pub(super) fn gauge(
        &self,
        room: usize,
        planned: &PlannedRequirement,
        alpha: f64,
    ) -> (Gauged, String, Option<Verdict>) {
        let entry = &self.world.rooms[room];
        match &planned.subject {
            Subject::Area(place, quantity) => {
                let asked = &self.plan.rooms[room].areas[*place].quantities[*quantity];
                let condition = self.condition_of(planned);
                let weights = self.weights_in(condition.state, planned.light_scene, entry);
                let blocks = area::blocks(&self.answers, asked, &weights, condition.light);
                let mut note = noted(condition, &[&blocks]);
                if let Some([found_m, named_m]) = self.other_plane(room, *place, planned) {
                    note = format!("{note}; area at {found_m:.2} m, the row names a plane at {named_m:.2} m");
                }
                (area::gauge(&blocks, planned.statistic, alpha), note, None)
            }
            Subject::Viewpoint(viewpoint) => {
                let (worst, notes) = self.worst_view(room, *viewpoint, planned, alpha);
                let mut note = Convention::default().words();
                for said in notes {
                    note = format!("{note}; {said}");
                }
                (worst, note, None)
            }
            Subject::OfTask(place, quantity, task, of) => {
                let areas = &self.plan.rooms[room].areas;
                let own = self.blocks(&areas[*place].quantities[*quantity], planned.light_scene, entry);
                let task = self.blocks(&areas[*task].quantities[*of], planned.light_scene, entry);
                let note = noted(self.condition(), &[&own, &task]);
                (area::gauge_of_task(&own, &task, alpha), note, None)
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
            Subject::Intensity { kind, heights_m, zone_deg } => {
                let peak_cd = self.peak_intensity(room, planned.light_scene, kind, *heights_m, *zone_deg);
                (
                    peak_cd.map_or_else(Gauged::undefined, Gauged::exact),
                    "emergency output, initial".into(),
                    None,
                )
            }
            Subject::Missing(reason) => (
                Gauged::undefined(Undefined::because(reason.clone())),
                String::new(),
                Some(Verdict::NotAssessed),
            ),
        }
    }

    /// Height of an area and of the plane that the norm's row names, where they differ, m.
    fn other_plane(&self, room: usize, place: usize, planned: &PlannedRequirement) -> Option<[f64; 2]> {
        let norm = self.project.norm.as_ref().filter(|norm| norm.standard.id == planned.standard)?;
        let row = norm.standard.row(&planned.clause)?;
        other_plane(row, &self.world.rooms[room], &self.plan.rooms[room].areas[place])
    }

    /// Largest emergency intensity among the luminaires of a type that hang in a class of heights, initial.
    fn peak_intensity(
        &self,
        room: usize,
        light_scene: usize,
        kind: &str,
        [from_m, to_m]: [f64; 2],
        zone_deg: [f64; 2],
    ) -> Result<f64, Undefined> {
        let entry = &self.world.rooms[room];
        let scene = &self.world.scene;
        let weights = self.initial(light_scene, entry);
        let hung = entry.luminaires.iter().map(|&l| (l, &scene.luminaires[l])).filter(|(_, luminaire)| {
            let height_m = luminaire.position.z - entry.floor_m;
            luminaire.kind.name == kind && height_m >= from_m && height_m < to_m
        });
        let peaks = hung.map(|(index, luminaire)| {
            let share = luminaire.kind.emergency.unwrap_or(0.0) * weights[scene.channel_of[index]];
            share * intensity::peak_cd(luminaire, zone_deg)
        });
        peaks.reduce(f64::max).ok_or_else(|| Undefined::because("the room has no luminaire"))
    }

    /// The worst table value of a room at a spacing-to-height ratio. The method knows luminaires only:
    /// where other surfaces shine brightly it says nothing.
    fn worst_table(&self, room: usize, shr: f64, light_scene: usize) -> Result<f64, Undefined> {
        let weights = self.initial(light_scene, &self.world.rooms[room]);
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

    /// The worst direction of a viewpoint for a requirement, with what is to be said of it: its end next to
    /// the limit for all directions, the other one uncorrected. Worst is the largest value under an upper
    /// limit, the smallest above a lower one. A direction in which no source is visible is never the worst,
    /// unless it is so in all; one that has the task behind the eye is not asked, and that is said.
    fn worst_view(
        &self,
        room: usize,
        viewpoint: usize,
        planned: &PlannedRequirement,
        alpha: f64,
    ) -> (Gauged, Vec<String>) {
        let views: Vec<usize> = (0..self.plan.rooms[room].views.len())
            .filter(|&index| self.plan.rooms[room].views[index].viewpoint == viewpoint)
            .collect();
        let each = alpha / views.len().max(1) as f64;
        let worse: fn(f64, f64) -> f64 = match planned.bound {
            Bound::Max(_) => f64::max,
            Bound::Min(_) => f64::min,
        };
        let (mut worst, mut dark): (Option<(Gauged, Vec<String>)>, Option<Gauged>) = (None, None);
        let mut behind = None;
        for &index in &views {
            let (gauged, notes) = self.of_view(room, index, planned, each);
            let value = match &gauged.value {
                Err(undefined) if nothing_glares(undefined) => {
                    dark = Some(gauged);
                    continue;
                }
                Err(undefined) if undefined.reason == BEHIND => {
                    behind = Some(gauged);
                    continue;
                }
                Err(_) => return (gauged, Vec::new()),
                Ok(value) => *value,
            };
            worst = Some(match worst {
                None => (gauged, notes),
                Some((known, known_notes)) => {
                    let (lo, hi) = (worse(known.lo, gauged.lo), worse(known.hi, gauged.hi));
                    let before = known.value.clone().unwrap_or(f64::NAN);
                    let is_worse = value.to_bits() != before.to_bits()
                        && worse(value, before).to_bits() == value.to_bits();
                    let (found, notes) = if is_worse { (gauged, notes) } else { (known, known_notes) };
                    (Gauged { lo, hi, ..found }, notes)
                }
            });
        }
        let nowhere = || Gauged::undefined(Undefined::because("the viewpoint has no direction"));
        let left_out = behind.is_some().then(|| TASK_LEFT_OUT.to_owned());
        let (gauged, mut notes) =
            worst.unwrap_or_else(|| (dark.or(behind).unwrap_or_else(nowhere), Vec::new()));
        notes.extend(left_out);
        (gauged, notes)
    }

    /// The quantity that a requirement asks of one direction, and what is to be said of it there. UGR's own
    /// notes stand with its observer.
    fn of_view(
        &self,
        room: usize,
        index: usize,
        planned: &PlannedRequirement,
        alpha: f64,
    ) -> (Gauged, Vec<String>) {
        let Quantity::OfView { key, .. } = planned.quantity else {
            return (self.glare(room, index, planned.light_scene, alpha, &[]).ugr, Vec::new());
        };
        let mut asked = self.glare(room, index, planned.light_scene, alpha, &[key]).indices;
        let Some(one) = asked.pop() else {
            return (Gauged::undefined(Undefined::because("no such index")), Vec::new());
        };
        let mut notes = vec!["initial flux".to_owned()];
        notes.extend(one.notes);
        (one.gauged, notes)
    }

    /// Light of the zones about the task of a planned view, where it is asked for and lies before the eye.
    pub(super) fn zones(&self, room: usize, index: usize, weights: &[f64]) -> Option<ZoneLight> {
        let planned = self.plan.rooms[room].views[index].task.as_ref()?;
        Some(ZoneLight::of_rows(&self.answers, planned, weights))
    }

    /// Mean luminance of the field of view of a planned view, where it is asked for.
    pub(super) fn field(&self, room: usize, index: usize, weights: &[f64]) -> Option<Blockwise> {
        let row = self.plan.rooms[room].views[index].field?;
        Some(Blockwise::of_zone(&self.answers, row, weights))
    }

    /// The area that a planned view is rated against, with its illuminance under the same factors.
    fn ground(
        &self,
        room: usize,
        index: usize,
        weights: &[f64],
        indices: &[&'static str],
    ) -> Result<Lit<'_>, &'static str> {
        let planned = &self.plan.rooms[room];
        let asked = planned.views[index]
            .ground
            .and_then(|ground| if indices.contains(&"GR") { Ok(ground) } else { Err(NOT_ASKED) });
        let ground = asked?;
        let area = &planned.areas[ground.area];
        let blocks = area::blocks(&self.answers, &area.quantities[ground.quantity], weights, Light::All);
        let mean_lx = Blockwise::of_area(&blocks);
        Ok(Lit { name: &area.name, mean_lx, reflectance: ground.reflectance })
    }

    /// Glare of a planned view; `indices` are wanted beside UGR.
    pub(super) fn glare(
        &self,
        room: usize,
        index: usize,
        light_scene: usize,
        alpha: f64,
        indices: &[&'static str],
    ) -> view::Glare {
        let planned = &self.plan.rooms[room].views[index];
        let weights = self.initial(light_scene, &self.world.rooms[room]);
        let sighted = &self.seen[room][index];
        let convention = Convention::default();
        let light = view::EyeLight::of_row(&self.answers, planned.row, &weights);
        let zones = self.zones(room, index, &weights).ok_or(BEHIND);
        let beside = Beside {
            given: self.world.viewpoints[planned.viewpoint].given,
            zones: zones.as_ref().map_err(|reason| *reason),
            field: self.field(room, index, &weights).ok_or(NOT_ASKED),
            ground: self.ground(room, index, &weights, indices),
            ceiling: beside::ceiling(self.world, &self.world.rooms[room], &weights, indices),
        };
        let asked = view::Asked { gaze: planned.direction, indices, convention, beside };
        view::glare(&light, self.emitters, sighted, &asked, &weights, alpha)
    }
}

/// The condition of illuminances, and whether light may be missing in them.
fn noted(condition: Condition, blocks: &[&area::Blocks]) -> String {
    let note = condition.note();
    if blocks.iter().any(|blocks| blocks.is_unseen()) {
        format!("{note}; {UNSEEN}")
    } else if blocks.iter().any(|blocks| blocks.is_missed()) {
        format!("{note}; {MISSED}")
    } else {
        note.into()
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
