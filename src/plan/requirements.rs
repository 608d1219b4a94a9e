//! Norm rows and `[[require]]` → requirements on what is measured.

use super::{Plan, PlanError, PlannedArea, PlannedRequirement, PlannedRoom, Subject};
use crate::norm::{self, Limit, Verified, Zone};
use crate::outcome::Bound;
use crate::project::{AreaKind, CustomSubject, Norm, Project, Room, World};
use crate::quantity::{Quantity, Statistic};

pub(super) fn plan(project: &Project, world: &World, plan: &mut Plan, errors: &mut Vec<PlanError>) {
    if let Some(norm) = &project.norm {
        for (index, room) in world.rooms.iter().enumerate() {
            let required = of_norm(norm, room, &plan.rooms[index], errors);
            plan.rooms[index].requirements.extend(required);
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
            plan.rooms[room].requirements.push(PlannedRequirement {
                standard: "project".into(),
                clause: "[[require]]".into(),
                subject: subject.clone(),
                subject_name: subject_name.clone(),
                light_scene,
                quantity: requirement.quantity,
                statistic: requirement.statistic,
                bound,
                verified: "project".into(),
            });
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
            let found =
                plan.rooms[spec.room].areas.iter().enumerate().find(|(_, planned)| planned.name == spec.name);
            let subject = found
                .and_then(|(place, planned)| {
                    let entry =
                        planned.quantities.iter().position(|entry| entry.quantity == requirement.quantity)?;
                    Some(Subject::Area(place, entry))
                })
                .unwrap_or_else(|| Subject::Missing("this quantity is not measured on an area".into()));
            (spec.room, subject, spec.name.clone())
        }
        CustomSubject::Viewpoint(view) => {
            let spec = &world.viewpoints[view];
            (spec.room, Subject::Viewpoint(view), spec.name.clone())
        }
        CustomSubject::Room(room) => {
            let subject = match requirement.quantity {
                // One ratio in a project: with another the same room has quite another UGR.
                Quantity::Ugr => Subject::UgrTable(project.norm.as_ref().map_or_else(
                    || norm::Application::default().ugr_shr.value,
                    |norm| norm.standard.application.ugr_shr.value,
                )),
                Quantity::ColourRendering => Subject::ColourRendering,
                _ => Subject::Missing("a room has no grid of its own: name one of its areas".into()),
            };
            (room, subject, world.rooms[room].name.clone())
        }
    }
}

fn of_norm(
    norm: &Norm,
    room: &Room,
    planned: &PlannedRoom,
    errors: &mut Vec<PlanError>,
) -> Vec<PlannedRequirement> {
    let mut required = Vec::new();
    let standard = &norm.standard;
    let mut no_row = |row: &str, by: String| {
        errors.push(PlanError::NoRow { standard: standard.id.clone(), row: row.into(), by });
    };
    for (place, area) in planned.areas.iter().enumerate() {
        let Some(reference) = &area.row else { continue };
        let Some(row) = standard.row(reference) else {
            no_row(reference, format!("area \"{}\"", area.name));
            continue;
        };
        let Some(zone) = zone_of(room, area) else { continue };
        for limit in standard.requirements(row).iter().filter(|limit| limit.zone == zone) {
            required.push(on_area(standard, reference, limit, place, area));
        }
    }
    let Some(reference) = room.row.as_ref().or(norm.row.as_ref()) else { return required };
    let Some(row) = standard.row(reference) else {
        no_row(reference, format!("room \"{}\"", room.name));
        return required;
    };
    for limit in standard.requirements(row) {
        let subject = match (limit.zone, limit.quantity) {
            (Zone::Room, Quantity::Ugr) => Subject::UgrTable(standard.application.ugr_shr.value),
            (Zone::Declared, Quantity::ColourRendering) => Subject::ColourRendering,
            (Zone::Room | Zone::Declared, _) => {
                Subject::Missing("gershun does not compute this quantity".into())
            }
            (zone, _) if !has_zone(room, planned, zone) && limit.statistic == Statistic::Mean => {
                Subject::Missing(format!("the project lists no {} in this room", zone_name(zone)))
            }
            _ => continue,
        };
        required.push(PlannedRequirement {
            standard: standard.id.clone(),
            clause: reference.clone(),
            subject,
            subject_name: match limit.zone {
                Zone::Room | Zone::Declared => room.name.clone(),
                zone => zone_name(zone).into(),
            },
            light_scene: 0,
            quantity: limit.quantity,
            statistic: limit.statistic,
            bound: bound(limit.bound),
            verified: verified(limit.verified),
        });
    }
    required
}

fn on_area(
    standard: &norm::Standard,
    reference: &str,
    limit: &Limit,
    place: usize,
    area: &PlannedArea,
) -> PlannedRequirement {
    // A limit on the plane of the task is measured on the area's own normal where it is not horizontal.
    let same = |entry: &super::PlannedQuantity| {
        entry.quantity == limit.quantity
            || (limit.quantity == Quantity::Horizontal && entry.quantity == Quantity::Normal)
    };
    let subject = area.quantities.iter().position(same).map_or_else(
        || Subject::Missing(format!("{} is not measured on this area", limit.quantity.key())),
        |entry| Subject::Area(place, entry),
    );
    let quantity = match subject {
        Subject::Area(_, entry) => area.quantities[entry].quantity,
        _ => limit.quantity,
    };
    PlannedRequirement {
        standard: standard.id.clone(),
        clause: reference.into(),
        subject,
        subject_name: area.name.clone(),
        light_scene: area.light_scene,
        quantity,
        statistic: limit.statistic,
        bound: bound(limit.bound),
        verified: verified(limit.verified),
    }
}

/// Zone of the norm that an area plays; `None` for surfaces that are neither wall nor ceiling.
fn zone_of(room: &Room, area: &PlannedArea) -> Option<Zone> {
    match area.kind {
        AreaKind::Task => Some(Zone::Task),
        AreaKind::Surrounding => Some(Zone::Surrounding),
        AreaKind::Background => Some(Zone::Background),
        AreaKind::Volume => Some(Zone::Cylindrical),
        AreaKind::Surface => {
            let normal = area.grid.normal;
            let top = room.floor_m + room.height_m;
            let high = area.grid.points.iter().all(|point| (point.position.z - top).abs() < 0.3);
            if normal.z < -0.99 && high {
                Some(Zone::Ceiling)
            } else if normal.z.abs() < 0.01 && area.grid.points.iter().all(|p| on_outline(room, p.position)) {
                Some(Zone::Walls)
            } else {
                None
            }
        }
    }
}

/// Whether a point stands at a wall of the room: a board or a screen elsewhere is no wall.
fn on_outline(room: &Room, at: glam::DVec3) -> bool {
    let p = glam::DVec2::new(at.x, at.y);
    (0..room.footprint.len()).any(|index| {
        let (a, b) = (room.footprint[index], room.footprint[(index + 1) % room.footprint.len()]);
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + (b - a) * t) < 0.3
    })
}

fn has_zone(room: &Room, planned: &PlannedRoom, zone: Zone) -> bool {
    // The zones beyond the task are optional where the task area is the whole room.
    let optional = matches!(zone, Zone::Surrounding | Zone::Background);
    optional || planned.areas.iter().any(|area| zone_of(room, area) == Some(zone))
}

fn zone_name(zone: Zone) -> &'static str {
    match zone {
        Zone::Task => "task area",
        Zone::Surrounding => "surrounding area",
        Zone::Background => "background area",
        Zone::Walls => "wall",
        Zone::Ceiling => "ceiling",
        Zone::Cylindrical => "volume",
        Zone::Room => "room",
        Zone::Declared => "declared value",
    }
}

fn bound(bound: norm::Bound) -> Bound {
    match bound {
        norm::Bound::Min(limit) => Bound::Min(limit),
        norm::Bound::Max(limit) => Bound::Max(limit),
    }
}

fn verified(verified: Verified) -> String {
    match verified {
        Verified::Unverified => "unverified",
        Verified::OneSource => "one-source",
        Verified::TwoSources => "two-sources",
    }
    .into()
}
