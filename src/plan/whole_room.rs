//! What a row of a norm asks of a room as a whole: glare, declared properties, intensities of luminaires, and
//! the zones that no area of the project covers.

use super::requirements::{
    modification, of_room, requirement, standard_level, unassessed, unknown_limit, verified,
};
use super::zones::{self, Gap, zone_name};
use super::{PlannedRequirement, PlannedRoom, Subject};
use crate::norm::{Row, Standard, UgrMethod, Zone};
use crate::outcome::Bound;
use crate::project::{Norm, Room, World};
use crate::quantity::{Quantity, Statistic};

/// What a row asks of the room as a whole, and what of it nothing in the project lets one judge.
pub(super) fn whole_room(
    norm: &Norm,
    world: &World,
    index: usize,
    room: &Room,
    planned: &PlannedRoom,
    row: &Row,
    is_own: bool,
) -> Vec<PlannedRequirement> {
    let standard = &norm.standard;
    let application = &standard.application;
    let mut required = Vec::new();
    let own = room.row.as_ref().or(norm.row.as_ref());
    // What is not assessed has the limit that it would be judged by: that of its task, as modified.
    let modified_at = |gap: &Gap| {
        let task = gap.task.map(|place| &planned.areas[place]);
        modification(standard, room, task, row, own)
    };
    for (number, limit) in standard.requirements(row).iter().enumerate() {
        let subjects: Vec<(Subject, String)> = match limit.zone {
            Zone::Room | Zone::Declared => {
                let observed = application.ugr_method.value == UgrMethod::Observers;
                if limit.quantity == Quantity::Ugr && observed {
                    observers(world, index, room)
                } else {
                    let subject = of_room(limit.quantity, application.ugr_shr.value).unwrap_or_else(|| {
                        Subject::Missing("gershun does not compute this quantity of a room".into())
                    });
                    vec![(subject, room.name.clone())]
                }
            }
            zone => {
                let leading = matches!(limit.statistic, Statistic::Mean | Statistic::Min | Statistic::OfTask);
                let gaps = if leading {
                    zones::gaps(world, room, planned, row, is_own, application, zone)
                } else {
                    Vec::new()
                };
                let level = |gap: &Gap| modified_at(gap).map(|(lx, _)| lx.to_bits());
                let alike = gaps.windows(2).all(|two| level(&two[0]) == level(&two[1]));
                let gaps = if alike { zones::in_one(gaps, room, planned, zone) } else { gaps };
                for gap in gaps {
                    let modified = modified_at(&gap);
                    let limits = standard.requirements_at(row, modified.as_ref().map(|(lx, _)| *lx));
                    let subject = Subject::Missing(gap.reason);
                    let mut one = requirement(standard, row, &limits[number], subject, &gap.subject);
                    if zone == Zone::Task && limit.statistic == standard_level(row) {
                        one.modified = modified.map(|(_, modified)| modified);
                    }
                    required.push(one);
                }
                Vec::new()
            }
        };
        for (subject, name) in subjects {
            required.push(requirement(standard, row, limit, subject, &name));
        }
    }
    required.extend(intensities(standard, world, room, planned, row));
    for reason in &row.not_judged {
        let statistic = standard_level(row);
        let mut one = unassessed(standard, &row.reference, Quantity::Horizontal, statistic, reason.clone());
        one.subject_name.clone_from(&room.name);
        required.push(one);
    }
    for unknown in &row.unknown {
        let of_room = matches!(unknown.zone, Zone::Room | Zone::Declared);
        if !is_own && !of_room {
            continue;
        }
        let mut one = unknown_limit(standard, row, unknown);
        one.subject_name = if of_room { room.name.clone() } else { zone_name(unknown.zone).to_owned() };
        required.push(one);
    }
    required
}

/// Limits on the intensity of the luminaires that shine in an emergency: one for each type and class of
/// mounting heights, under each light scene in which an area of the row is judged.
fn intensities(
    standard: &Standard,
    world: &World,
    room: &Room,
    planned: &PlannedRoom,
    row: &Row,
) -> Vec<PlannedRequirement> {
    let own = planned.areas.iter().filter(|area| area.row.as_ref() == Some(&row.reference));
    let mut scenes: Vec<usize> = own.map(|area| area.light_scene).collect();
    scenes.sort_unstable();
    scenes.dedup();
    if scenes.is_empty() {
        scenes.push(0);
    }
    scenes.into_iter().flat_map(|scene| intensities_under(standard, world, room, row, scene)).collect()
}

fn intensities_under(
    standard: &Standard,
    world: &World,
    room: &Room,
    row: &Row,
    light_scene: usize,
) -> Vec<PlannedRequirement> {
    let Some(limit) = &row.intensity else { return Vec::new() };
    let mut required: Vec<PlannedRequirement> = Vec::new();
    let hung = room.luminaires.iter().map(|&index| &world.scene.luminaires[index]);
    for luminaire in hung.filter(|luminaire| luminaire.kind.emergency.is_some()) {
        let Some((from_m, to_m, limit_cd)) = limit.class(luminaire.position.z - room.floor_m) else {
            continue;
        };
        let subject = Subject::Intensity {
            kind: luminaire.kind.name.clone(),
            heights_m: [from_m, to_m],
            zone_deg: [limit.from_deg, limit.to_deg],
        };
        if required.iter().any(|known| known.subject == subject) {
            continue;
        }
        required.push(PlannedRequirement {
            standard: standard.id.clone(),
            clause: row.reference.clone(),
            subject,
            subject_name: luminaire.kind.name.clone(),
            light_scene,
            quantity: Quantity::Intensity,
            statistic: Statistic::Max,
            bound: Bound::Max(limit_cd),
            verified: verified(limit.verified),
            modified: None,
        });
    }
    required
}

/// A norm that judges glare at observers: every one of the room, by its worst direction.
fn observers(world: &World, index: usize, room: &Room) -> Vec<(Subject, String)> {
    let own = world.viewpoints.iter().enumerate().filter(|(_, view)| view.room == index);
    let own: Vec<(Subject, String)> =
        own.map(|(view, spec)| (Subject::Viewpoint(view), spec.name.clone())).collect();
    if own.is_empty() {
        let reason = "the norm judges UGR at observers and the project lists no viewpoint here".into();
        return vec![(Subject::Missing(reason), room.name.clone())];
    }
    own
}
