//! Zones of a norm and what of them the listed areas leave out: one wall with an area is not "the walls",
//! and a task area that reaches one side of the room does not fill it. Each wall, the ceiling, each eye
//! height and the strip round each task area is asked for by a lattice of places; a place needs an area
//! over it, unless furniture hides it or the norm lets it be left out along the walls.

use glam::{DVec2, DVec3};

use super::areas::{SNAP_M, on_surface};
use super::lattice::{Plane, Tally, bounds, cells, lattice};
use super::{PlannedArea, PlannedRoom};
use crate::grid::{distance_to_outline, inside, spacing_m, width};
use crate::norm::{Application, Row, Zone};
use crate::project::{AreaKind, AreaShape, Room, World};
use crate::scene::{Scene, inside_furniture};

/// Share of a zone that areas must cover for it to count as assessed: edges and corners may be cut.
const COVERED: f64 = 0.9;
/// The same for a wall: doors are no wall, and CAD files do not say what a door is.
const COVERED_WALL: f64 = 0.75;
/// An area this close to a wall, a ceiling or the plane of a task lies on it, m.
const NEAR_M: f64 = 0.3;
/// Heights that differ by less are one, m.
const SAME_HEIGHT_M: f64 = 0.05;

/// Part of a zone without an area.
pub(super) struct Gap {
    /// Wall, task area or zone.
    pub(super) subject: String,
    /// Why it is not assessed.
    pub(super) reason: String,
    /// The task area round which it lies, by index within the room: the limit follows from the task's.
    pub(super) task: Option<usize>,
}

/// What the areas of a room leave out of a zone that `row` regulates. Zones round a task are asked of every
/// task area of the row; walls, ceiling and volumes only where it is the room's own row.
pub(super) fn gaps(
    world: &World,
    room: &Room,
    planned: &PlannedRoom,
    row: &Row,
    is_own: bool,
    rules: &Application,
    zone: Zone,
) -> Vec<Gap> {
    let survey = Survey { scene: &world.scene, room, planned, row, rules };
    match zone {
        Zone::Task if is_own => survey.task(),
        Zone::Surrounding | Zone::Background => survey.around(zone),
        Zone::Walls if is_own => survey.walls(),
        Zone::Ceiling if is_own => survey.ceiling(),
        Zone::Cylindrical if is_own => survey.volumes(),
        Zone::Task | Zone::Walls | Zone::Ceiling | Zone::Cylindrical | Zone::Room | Zone::Declared => {
            Vec::new()
        }
    }
}

/// Where nothing at all of a zone is listed one line says so instead of one for each part, whose limits are the
/// same.
pub(super) fn in_one(gaps: Vec<Gap>, room: &Room, planned: &PlannedRoom, zone: Zone) -> Vec<Gap> {
    let none = gaps.len() > 1 && !planned.areas.iter().any(|area| zone_of(room, area) == Some(zone));
    if none { vec![Gap { task: gaps[0].task, ..nothing_listed(zone) }] } else { gaps }
}

fn nothing_listed(zone: Zone) -> Gap {
    let name = zone_name(zone);
    Gap { subject: name.into(), reason: format!("the project lists no {name} in this room"), task: None }
}

/// Zone of the norm that an area plays; `None` for surfaces that are neither wall nor ceiling.
pub(super) fn zone_of(room: &Room, area: &PlannedArea) -> Option<Zone> {
    match area.kind {
        AreaKind::Task => Some(Zone::Task),
        AreaKind::Surrounding => Some(Zone::Surrounding),
        AreaKind::Background => Some(Zone::Background),
        AreaKind::Volume => Some(Zone::Cylindrical),
        AreaKind::Surface => {
            let normal = area.grid.normal;
            let top = room.floor_m + room.height_m;
            let high = area.grid.points.iter().all(|point| (point.position.z - top).abs() < NEAR_M);
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
fn on_outline(room: &Room, at: DVec3) -> bool {
    distance_to_outline(&room.footprint, DVec2::new(at.x, at.y)) < NEAR_M
}

/// What a zone is called where no area of it is listed.
pub(super) fn zone_name(zone: Zone) -> &'static str {
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

/// A room, its areas, and the row by which they are surveyed.
struct Survey<'a> {
    scene: &'a Scene,
    room: &'a Room,
    planned: &'a PlannedRoom,
    row: &'a Row,
    rules: &'a Application,
}

impl Survey<'_> {
    fn areas(&self, zone: Zone) -> impl Iterator<Item = &PlannedArea> {
        self.planned.areas.iter().filter(move |area| zone_of(self.room, area) == Some(zone))
    }

    /// Task areas of the row.
    fn tasks(&self) -> impl Iterator<Item = &PlannedArea> {
        self.areas(Zone::Task).filter(|area| area.row.as_deref() == Some(self.row.reference.as_str()))
    }

    /// What is missing round a task.
    fn beside(&self, task: &PlannedArea, zone: Zone, reason: String) -> Gap {
        let subject = format!("{} · {}", task.name, zone_name(zone));
        let place = self.planned.areas.iter().position(|area| std::ptr::eq(area, task));
        Gap { subject, reason, task: place }
    }

    fn task(&self) -> Vec<Gap> {
        if self.tasks().next().is_some() {
            return Vec::new();
        }
        let reference = &self.row.reference;
        if self.areas(Zone::Task).next().is_none() && self.row.part_of_room {
            let reason = format!("row {reference} speaks of a part of the room: list that part as an area");
            return vec![Gap { reason, ..nothing_listed(Zone::Task) }];
        }
        if self.areas(Zone::Task).next().is_none() {
            return vec![nothing_listed(Zone::Task)];
        }
        let reason = format!("the project lists no task area of row {reference} in this room");
        vec![Gap { subject: zone_name(Zone::Task).into(), reason, task: None }]
    }

    /// The strip along walls that need not be covered, m: as in grids, none where the room is narrow.
    fn border_m(&self) -> f64 {
        let border_m = self.rules.border_m.value;
        if width(&self.room.footprint, &[]) > 3.0 * border_m { border_m } else { 0.0 }
    }

    /// The strip round each task area, in the plane of the task.
    fn around(&self, zone: Zone) -> Vec<Gap> {
        let rules = self.rules;
        let Some(surrounding) = &rules.surrounding else { return self.total_areas(zone) };
        let band_m = surrounding.band_m.value;
        let (from_m, to_m, own): (f64, f64, &[AreaKind]) = match (zone, &rules.background) {
            (Zone::Background, Some(background)) => (
                band_m,
                band_m + background.width_m.value,
                &[AreaKind::Task, AreaKind::Surrounding, AreaKind::Background],
            ),
            (Zone::Surrounding, _) => (0.0, band_m, &[AreaKind::Task, AreaKind::Surrounding]),
            _ => return Vec::new(),
        };
        let name = zone_name(zone);
        let mut gaps = Vec::new();
        for task in self.tasks() {
            let plane = Plane::of(task);
            let over: Vec<&PlannedArea> =
                self.planned.areas.iter().filter(|area| own.contains(&area.kind)).collect();
            let mut tally = Tally::default();
            for (place, flat) in plane.lattice(task, to_m) {
                let distance_m = plane.distance_m(task, flat);
                if distance_m > from_m && distance_m <= to_m {
                    self.count(&mut tally, &plane, place, &over);
                }
            }
            if let Some(share) = tally.short_of(COVERED) {
                let reason = if share > 0.0 {
                    format!("areas cover only {:.0} % of the {name} round this task area", 100.0 * share)
                } else {
                    format!("the project lists no {name} round this task area")
                };
                gaps.push(self.beside(task, zone, reason));
            }
        }
        gaps
    }

    /// Total areas of sports: one that names the principal area or lies round it.
    fn total_areas(&self, zone: Zone) -> Vec<Gap> {
        let mut gaps = Vec::new();
        for task in self.tasks().filter(|_| zone == Zone::Surrounding) {
            let plane = Plane::of(task);
            let holds = |area: &PlannedArea| {
                let mut tally = Tally::default();
                for (place, flat) in plane.lattice(task, 0.0) {
                    if plane.distance_m(task, flat) <= 0.0 {
                        tally.add(self.is_under(&plane, area, place, 0.0));
                    }
                }
                tally.short_of(COVERED).is_none()
            };
            if !self.areas(zone).any(|area| area.of.as_ref() == Some(&task.name) || holds(area)) {
                let reason = format!("the project lists no {} round this task area", zone_name(zone));
                gaps.push(self.beside(task, zone, reason));
            }
        }
        gaps
    }

    /// Counts a place that needs one of `areas` over it: inside the room, away from its walls by the border
    /// that may be left out, and, where no area lies, not inside furniture, which takes rays to know.
    fn count(&self, tally: &mut Tally, plane: &Plane, place: DVec3, areas: &[&PlannedArea]) {
        if self.is_within(place, plane) {
            let covered =
                areas.iter().any(|area| self.is_under(plane, area, place, self.rules.border_m.value));
            if covered || !inside_furniture(self.scene, place, plane.normal, false) {
                tally.add(covered);
            }
        }
    }

    fn is_within(&self, place: DVec3, plane: &Plane) -> bool {
        let flat = DVec2::new(place.x, place.y);
        let border_m = self.border_m();
        let height_m = place.z - self.room.floor_m;
        let within = if plane.is_level() {
            distance_to_outline(&self.room.footprint, flat) >= border_m - 1e-9
        } else {
            // An upright task may hang at a wall; its strip ends at floor, ceiling and the other walls.
            (0.0..=self.room.height_m).contains(&height_m)
        };
        within && inside(&self.room.footprint, flat)
    }

    /// Whether an area lies over a place: parallel, near the plane (level ones at any height), and not
    /// only with a border wider than the norm's.
    fn is_under(&self, plane: &Plane, area: &PlannedArea, place: DVec3, border_m: f64) -> bool {
        let near = plane.is_level() || plane.height_m(area.grid.points[0].position).abs() <= NEAR_M;
        if !(near && area.grid.normal.dot(plane.normal).abs() > 0.99) {
            return false;
        }
        let flat = plane.flat(place);
        let left_out_m = area.grid.border_m - border_m;
        match &area.shape {
            AreaShape::Points(_) => plane.distance_m(area, flat) <= 1.0,
            shape @ (AreaShape::Rect { .. } | AreaShape::Polygon(_) | AreaShape::Surface { .. }) => {
                let outline = plane.outline(area);
                let on_own = |place| match shape {
                    AreaShape::Surface { surface, .. } => on_surface(self.scene, *surface, place),
                    AreaShape::Rect { .. } | AreaShape::Polygon(_) | AreaShape::Points(_) => true,
                };
                inside(&outline, flat)
                    && (!(left_out_m > 0.0) || distance_to_outline(&outline, flat) >= left_out_m)
                    && on_own(place)
            }
        }
    }

    fn walls(&self) -> Vec<Gap> {
        let corners = &self.room.footprint;
        let names = super::norm_areas::wall_names(self.scene, self.room);
        let mut gaps = Vec::new();
        for (number, name) in names.iter().enumerate() {
            let (a, b) = (corners[number], corners[(number + 1) % corners.len()]);
            let (length_m, height_m) = (a.distance(b), self.room.height_m);
            let along = (b - a).normalize_or_zero();
            // The outline runs counter-clockwise: the room lies on its left.
            let inward = along.perp().extend(0.0);
            let [columns, rows] = lattice(length_m, height_m);
            let own: Vec<&PlannedArea> =
                self.areas(Zone::Walls).filter(|area| area.grid.normal.dot(inward).abs() > 0.99).collect();
            let mut tally = Tally::default();
            for (column, row) in cells(columns, rows) {
                let s = (column as f64 + 0.5) / columns as f64 * length_m;
                let z = (row as f64 + 0.5) / rows as f64 * height_m;
                let place = (a + along * s).extend(self.room.floor_m + z);
                if let Some(surface) = self.seen_surface(place, inward, &self.room.walls) {
                    let wide_m = spacing_m(length_m, height_m);
                    tally.add(own.iter().any(|area| is_before(area, place, surface, wide_m)));
                }
            }
            if let Some(share) = tally.short_of(COVERED_WALL) {
                gaps.push(Gap { subject: name.clone(), reason: on_wall(share), task: None });
            }
        }
        gaps
    }

    fn ceiling(&self) -> Vec<Gap> {
        let corners = &self.room.footprint;
        let (lo, hi) = bounds(corners);
        let top_m = self.room.floor_m + self.room.height_m;
        let [columns, rows] = lattice(hi.x - lo.x, hi.y - lo.y);
        let mut tally = Tally::default();
        for (column, row) in cells(columns, rows) {
            let part = DVec2::new((column as f64 + 0.5) / columns as f64, (row as f64 + 0.5) / rows as f64);
            let flat = lo + (hi - lo) * part;
            if !inside(corners, flat) {
                continue;
            }
            let place = flat.extend(top_m);
            if let Some(surface) = self.seen_surface(place, DVec3::NEG_Z, &self.room.ceiling) {
                let wide_m = spacing_m(hi.x - lo.x, hi.y - lo.y);
                let mut own = self.areas(Zone::Ceiling);
                tally.add(own.any(|area| is_before(area, place, surface, wide_m)));
            }
        }
        let short = tally.short_of(COVERED).filter(|_| self.areas(Zone::Ceiling).next().is_some());
        match short {
            Some(share) => {
                vec![Gap { subject: zone_name(Zone::Ceiling).into(), reason: on_ceiling(share), task: None }]
            }
            None if self.areas(Zone::Ceiling).next().is_none() => vec![nothing_listed(Zone::Ceiling)],
            None => Vec::new(),
        }
    }

    /// A volume at each eye height of the row, over every level task area of it.
    fn volumes(&self) -> Vec<Gap> {
        if self.areas(Zone::Cylindrical).next().is_none() {
            return vec![nothing_listed(Zone::Cylindrical)];
        }
        let mut gaps = Vec::new();
        for height_m in self.rules.eye_heights_m(self.row.posture) {
            let at_height = |area: &&PlannedArea| {
                let found_m = area.grid.points.first().map_or(f64::NAN, |point| point.position.z);
                (found_m - self.room.floor_m - height_m).abs() <= SAME_HEIGHT_M
            };
            let volumes: Vec<&PlannedArea> = self.areas(Zone::Cylindrical).filter(at_height).collect();
            if volumes.is_empty() {
                let reason =
                    format!("the project lists no volume at {height_m} m, the eye height of the row");
                gaps.push(Gap { subject: zone_name(Zone::Cylindrical).into(), reason, task: None });
                continue;
            }
            for task in self.tasks() {
                let plane = Plane::of(task);
                let mut tally = Tally::default();
                for (place, flat) in plane.lattice(task, 0.0).filter(|_| plane.is_level()) {
                    if plane.distance_m(task, flat) <= 0.0 {
                        self.count(&mut tally, &plane, place, &volumes);
                    }
                }
                if let Some(share) = tally.short_of(COVERED) {
                    let percent = 100.0 * share;
                    let reason =
                        format!("volumes at {height_m} m lie over only {percent:.0} % of this task area");
                    gaps.push(self.beside(task, Zone::Cylindrical, reason));
                }
            }
        }
        gaps
    }

    /// The surface of the room's shell that shows at a place of it, seen from the room; `None` where
    /// furniture hides it or where it is a pane or none of `shell` (a door of another surface is still shell).
    fn seen_surface(&self, place: DVec3, inward: DVec3, shell: &[u32]) -> Option<u32> {
        let hit = self.scene.tracer.closest(place + inward * SNAP_M, -inward, &[])?;
        let surface = self.scene.tracer.surface(hit.triangle);
        let entry = &self.scene.mesh.surfaces[surface as usize];
        let is_pane = self.scene.materials[entry.material].bsdf.specular(1.0).is_some();
        let is_shell = shell.is_empty() || shell.contains(&surface);
        (!entry.furniture && !is_pane && is_shell && hit.distance_m < 2.0 * SNAP_M).then_some(surface)
    }
}

fn on_wall(share: f64) -> String {
    if share > 0.0 {
        format!("areas cover only {:.0} % of this wall", 100.0 * share)
    } else {
        "no area lies on this wall".into()
    }
}

fn on_ceiling(share: f64) -> String {
    if share > 0.0 {
        format!("areas cover only {:.0} % of this ceiling", 100.0 * share)
    } else {
        "no area lies on this ceiling".into()
    }
}

/// Whether an area lies over a place of the shell, of which `surface` is seen there.
fn is_before(area: &PlannedArea, place: DVec3, surface: u32, wide_m: f64) -> bool {
    match &area.shape {
        AreaShape::Surface { surface: own, .. } => *own == surface,
        AreaShape::Points(points) => points.iter().any(|(at, _)| at.distance(place) <= wide_m),
        AreaShape::Rect { .. } | AreaShape::Polygon(_) => {
            let plane = Plane::of(area);
            plane.height_m(place).abs() <= NEAR_M && plane.distance_m(area, plane.flat(place)) <= 1e-9
        }
    }
}
