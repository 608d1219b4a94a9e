//! Norm rows and `[[require]]` → requirements on what is measured. What a norm regulates and nothing
//! here can judge becomes a requirement that is "not assessed", with the reason: never silence.

use super::instead::set_aside;
use super::whole_room::whole_room;
use super::zones::zone_of;
use super::{Plan, PlanError, PlannedArea, PlannedRequirement, PlannedRoom, Subject};
use crate::norm::{self, Limit, Row, Standard, Unknown, Verified, Zone};
use crate::outcome::{Bound, Modified};
use crate::project::{AreaKind, CustomSubject, Norm, Project, Room, World};
use crate::quantity::{Quantity, Statistic, Unmeasured};

pub(super) fn plan(project: &Project, world: &World, plan: &mut Plan, errors: &mut Vec<PlanError>) {
    if let Some(norm) = &project.norm {
        for (index, room) in world.rooms.iter().enumerate() {
            let required = of_norm(norm, world, index, room, &plan.rooms[index], errors);
            let planes = other_planes(norm, room, &plan.rooms[index]);
            plan.rooms[index].requirements.extend(required);
            plan.reasons.extend(planes);
            let mut hung = room.luminaires.iter().map(|&l| &world.scene.luminaires[l].kind);
            let in_emergency = norm.standard.application.illuminance_state.value == norm::State::Emergency;
            if in_emergency && hung.all(|kind| kind.emergency.is_none()) {
                plan.reasons.push(format!(
                    "Room \"{}\" is dark in an emergency: none of its luminaires has an output then (`emergency`).",
                    room.name
                ));
            }
        }
    }
    for requirement in &world.requirements {
        let (room, subject, subject_name) = subject(project, world, plan, requirement);
        // Like the norm's, a requirement of one's own is judged under the light scene of its subject.
        let own_scene = match requirement.subject {
            CustomSubject::Area(area) => world.areas[area].light_scene,
            CustomSubject::Viewpoint(view) => world.viewpoints[view].light_scene,
            CustomSubject::Room(_) => None,
        };
        let light_scene = requirement.light_scene.or(own_scene).unwrap_or(0);
        let bounds = [requirement.min.map(Bound::Min), requirement.max.map(Bound::Max)];
        for bound in bounds.into_iter().flatten() {
            let own = PlannedRequirement {
                standard: "project".into(),
                clause: "[[require]]".into(),
                subject: subject.clone(),
                subject_name: subject_name.clone(),
                light_scene,
                quantity: requirement.quantity,
                statistic: requirement.statistic,
                bound,
                verified: "project".into(),
                modified: None,
            };
            let required = &mut plan.rooms[room].requirements;
            if let Some(instead) = &requirement.instead {
                set_aside(required, &own, instead, errors);
            }
            required.push(own);
        }
    }
}

/// Room, subject and printed name of a `[[require]]`.
fn subject(
    project: &Project,
    world: &World,
    plan: &Plan,
    requirement: &crate::project::CustomRequirement,
) -> (usize, Subject, String) {
    match requirement.subject {
        CustomSubject::Area(area) => {
            let spec = &world.areas[area];
            let planned = &plan.rooms[spec.room];
            let found = planned.areas.iter().position(|planned| planned.name == spec.name);
            let subject = found.map_or_else(
                || Subject::Missing("the area has no points".into()),
                |place| on(planned, place, requirement.quantity, requirement.statistic),
            );
            (spec.room, subject, spec.name.clone())
        }
        CustomSubject::Viewpoint(view) => {
            let spec = &world.viewpoints[view];
            (spec.room, Subject::Viewpoint(view), spec.name.clone())
        }
        CustomSubject::Room(room) => {
            // One ratio in a project: with another the same room has quite another UGR.
            let shr = project.norm.as_ref().map_or_else(
                || norm::Application::default().ugr_shr.value,
                |norm| norm.standard.application.ugr_shr.value,
            );
            let subject = of_room(requirement.quantity, shr).unwrap_or_else(|| {
                Subject::Missing("a room has no grid of its own: name one of its areas".into())
            });
            (room, subject, world.rooms[room].name.clone())
        }
    }
}

/// What is measured or declared of a room as a whole; `None` for what needs points.
pub(super) fn of_room(quantity: Quantity, shr: f64) -> Option<Subject> {
    match quantity {
        Quantity::Ugr => Some(Subject::UgrTable(shr)),
        Quantity::DiscomfortIndex => Some(Subject::DiscomfortTable(shr)),
        Quantity::ColourRendering => Some(Subject::ColourRendering),
        Quantity::Declared(property) => Some(Subject::Declared(property)),
        Quantity::NotComputed(Unmeasured::GlareRating) => Some(Subject::Missing(
            "the norm rates GR at observers of its own, which gershun does not lay: list viewpoints and require GR of them"
                .into(),
        )),
        Quantity::NotComputed(_) => Some(Subject::Missing("gershun does not compute this quantity".into())),
        Quantity::Intensity => {
            Some(Subject::Missing("gershun does not compute this quantity of a room".into()))
        }
        _ => None,
    }
}

/// A statistic of a quantity on an area, if it is measured there.
fn on(planned: &PlannedRoom, place: usize, quantity: Quantity, statistic: Statistic) -> Subject {
    let area = &planned.areas[place];
    // A limit on the plane of the task is measured on the area's own normal where it is not horizontal.
    let found = |area: &PlannedArea, wanted: Quantity| {
        area.quantities.iter().position(|entry| {
            entry.quantity == wanted || (wanted == Quantity::Horizontal && entry.quantity == Quantity::Normal)
        })
    };
    let Some(entry) = found(area, quantity) else {
        let upright = quantity == Quantity::Normal && found(area, Quantity::Horizontal).is_some();
        return Subject::Missing(if upright {
            "the row is for a vertical plane and this area is horizontal".into()
        } else {
            format!("{} is not measured on this area", quantity.key())
        });
    };
    if statistic != Statistic::OfTask {
        return Subject::Area(place, entry);
    }
    let mut tasks = planned.areas.iter().enumerate().filter(|(_, area)| area.kind == AreaKind::Task);
    let task = match &area.of {
        Some(of) => tasks.find(|(_, task)| task.name == *of),
        None if area.kind == AreaKind::Task => Some((place, area)),
        None => tasks.next().filter(|_| tasks.next().is_none()),
    };
    let task = task.and_then(|(place, task)| Some((place, found(task, Quantity::Horizontal)?)));
    match task {
        Some((of, of_entry)) => Subject::OfTask(place, entry, of, of_entry),
        None => Subject::Missing("the area names no task area to compare with (`of`)".into()),
    }
}

fn of_norm(
    norm: &Norm,
    world: &World,
    index: usize,
    room: &Room,
    planned: &PlannedRoom,
    errors: &mut Vec<PlanError>,
) -> Vec<PlannedRequirement> {
    let mut required = Vec::new();
    let standard = &norm.standard;
    let mut no_row = |row: &str, by: String| {
        errors.push(PlanError::NoRow { standard: standard.id.clone(), row: row.into(), by });
    };
    let own = room.row.as_ref().or(norm.row.as_ref());
    let mut rows: Vec<&Row> = Vec::new();
    if let Some(reference) = own {
        match standard.row(reference) {
            Some(row) => rows.push(row),
            None => no_row(reference, format!("room \"{}\"", room.name)),
        }
    }
    for (place, area) in planned.areas.iter().enumerate() {
        let Some(reference) = &area.row else { continue };
        let Some(row) = standard.row(reference) else {
            no_row(reference, format!("area \"{}\"", area.name));
            continue;
        };
        if !rows.iter().any(|known| known.reference == row.reference) {
            rows.push(row);
        }
        let Some(zone) = zone_of(room, area) else { continue };
        let modified = modification(standard, room, Some(area), row, own);
        let level_lx = modified.as_ref().map(|(lx, _)| *lx);
        for limit in standard.requirements_at(row, level_lx).iter().filter(|limit| limit.zone == zone) {
            let subject = on(planned, place, limit.quantity, limit.statistic);
            let mut one = requirement(standard, row, limit, subject, &area.name);
            if let Subject::Area(place, entry) | Subject::OfTask(place, entry, ..) = one.subject {
                one.quantity = planned.areas[place].quantities[entry].quantity;
            }
            one.light_scene = area.light_scene;
            if limit.zone == Zone::Task && limit.statistic == standard_level(row) {
                one.modified = modified.as_ref().map(|(_, modified)| modified.clone());
            }
            required.push(one);
        }
        if own.is_some() && own != Some(&row.reference) {
            for unknown in row.unknown.iter().filter(|unknown| unknown.zone == zone) {
                let mut one = unknown_limit(standard, row, unknown);
                one.subject_name.clone_from(&area.name);
                required.push(one);
            }
        }
    }
    if rows.is_empty() && !standard.rows.is_empty() {
        required.push(without_row(standard, room));
    }
    for (number, row) in rows.into_iter().enumerate() {
        let is_own = own.is_none_or(|own| number == 0 && *own == row.reference);
        required.extend(whole_room(norm, world, index, room, planned, row, is_own));
        // A second row repeats what the first asks of the room: once is enough.
        let mut seen: Vec<PlannedRequirement> = Vec::new();
        required.retain(|one| {
            let same = |other: &PlannedRequirement| {
                other.subject == one.subject
                    && other.subject_name == one.subject_name
                    && other.light_scene == one.light_scene
                    && other.quantity == one.quantity
                    && other.statistic == one.statistic
                    && format!("{:?}", other.bound) == format!("{:?}", one.bound)
            };
            let is_new = !seen.iter().any(same);
            seen.push(one.clone());
            is_new
        });
    }
    for beyond in &standard.application.beyond {
        if let Some(quantity) = Quantity::parse(&beyond.quantity) {
            let mut one = unassessed(standard, "", quantity, Statistic::Value, beyond.reason.clone());
            one.subject_name.clone_from(&room.name);
            required.push(one);
        }
    }
    if let Some(reason) = &standard.application.not_judged {
        for one in &mut required {
            one.subject = Subject::Missing(reason.clone());
        }
    }
    required
}

/// The statistic of the row's required illuminance.
pub(super) fn standard_level(row: &Row) -> Statistic {
    row.illuminance().map_or(Statistic::Mean, |limit| limit.statistic)
}

/// The illuminance asked for in this context and how it came about: the area's own modification, or the
/// room's for the room's own row.
pub(super) fn modification(
    standard: &Standard,
    room: &Room,
    area: Option<&PlannedArea>,
    row: &Row,
    own: Option<&String>,
) -> Option<(f64, Modified)> {
    let of_room = room.modified.as_ref().filter(|_| own == Some(&row.reference));
    let modified = area.and_then(|area| area.modified.as_ref()).or(of_room)?;
    let level_lx = standard.modified_illuminance(row, modified.steps).ok()?;
    let norm::Bound::Min(required_lx) = row.illuminance()?.bound else { return None };
    Some((level_lx, Modified { required_lx, steps: modified.steps, reason: modified.reason.clone() }))
}

/// A room of which nobody says which row of the norm holds: nothing of the norm is judged there.
fn without_row(standard: &Standard, room: &Room) -> PlannedRequirement {
    let illuminance = standard.rows.iter().find_map(Row::illuminance);
    let (quantity, statistic) = illuminance
        .map_or((Quantity::Horizontal, Statistic::Mean), |limit| (limit.quantity, limit.statistic));
    let reason = "no row of the norm is given: name one in the room, its areas or [norm]".into();
    let mut one = unassessed(standard, "", quantity, statistic, reason);
    one.subject_name.clone_from(&room.name);
    one
}

/// What the norm limits and its file does not know.
pub(super) fn unknown_limit(standard: &Standard, row: &Row, unknown: &Unknown) -> PlannedRequirement {
    let reason = format!("the norm's file has no value of {} for row {}", unknown.column, row.reference);
    unassessed(standard, &row.reference, unknown.quantity, unknown.statistic, reason)
}

pub(super) fn requirement(
    standard: &Standard,
    row: &Row,
    limit: &Limit,
    subject: Subject,
    subject_name: &str,
) -> PlannedRequirement {
    PlannedRequirement {
        standard: standard.id.clone(),
        clause: row.reference.clone(),
        subject,
        subject_name: subject_name.into(),
        light_scene: 0,
        quantity: limit.quantity,
        statistic: limit.statistic,
        bound: bound(limit.bound),
        verified: verified(limit.verified),
        modified: None,
    }
}

/// Something regulated whose limit is not known: no number, no verdict, a reason.
pub(super) fn unassessed(
    standard: &Standard,
    clause: &str,
    quantity: Quantity,
    statistic: Statistic,
    reason: String,
) -> PlannedRequirement {
    PlannedRequirement {
        standard: standard.id.clone(),
        clause: clause.into(),
        subject: Subject::Missing(reason),
        subject_name: String::new(),
        light_scene: 0,
        quantity,
        statistic,
        bound: Bound::Min(f64::NAN),
        verified: "unknown".into(),
        modified: None,
    }
}

/// Areas that lie in another plane than the one their row names: said, not judged otherwise.
fn other_planes(norm: &Norm, room: &Room, planned: &PlannedRoom) -> Vec<String> {
    let said = planned.areas.iter().filter_map(|area| {
        let row = norm.standard.row(area.row.as_ref()?)?;
        let [found_m, named_m] = other_plane(row, room, area)?;
        Some(format!(
            "Area \"{}\" lies at {found_m:.2} m, row {} names a plane at {named_m:.2} m.",
            area.name, row.reference
        ))
    });
    said.collect()
}

/// Height of a level task area and of the plane that its row names, m, where they are not one; the middle of
/// an upright one.
pub fn other_plane(row: &Row, room: &Room, area: &PlannedArea) -> Option<[f64; 2]> {
    let named_m = row.plane_m.filter(|_| area.kind == AreaKind::Task)?;
    let count = area.grid.points.len().max(1) as f64;
    let found_m = area.grid.points.iter().map(|point| point.position.z).sum::<f64>() / count - room.floor_m;
    let tilt = area.grid.normal.z.abs();
    let apart_m = match row.plane {
        norm::Plane::Horizontal if tilt > 0.99 => SAME_PLANE_M,
        norm::Plane::Vertical if tilt < 0.01 => SAME_MIDDLE_M,
        norm::Plane::Horizontal | norm::Plane::Vertical => return None,
    };
    ((found_m - named_m).abs() > apart_m).then_some([found_m, named_m])
}

/// Level planes that differ by less are one (a floor is laid 2 cm above the slab), m.
const SAME_PLANE_M: f64 = 0.021;
/// The same for the middles of boards and screens, which hang as tall as their users are, m.
const SAME_MIDDLE_M: f64 = 0.25;

fn bound(bound: norm::Bound) -> Bound {
    match bound {
        norm::Bound::Min(limit) => Bound::Min(limit),
        norm::Bound::Max(limit) => Bound::Max(limit),
    }
}

pub(super) fn verified(verified: Verified) -> String {
    verified.key().into()
}
