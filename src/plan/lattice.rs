//! Places of a zone: lattices over areas and over the room's shell, read in the plane of an area.

use glam::{DVec2, DVec3};

use super::PlannedArea;
use crate::grid::{distance_to_outline, inside};
use crate::project::AreaShape;

/// Places in which a zone is tried at most.
const MOST_PLACES: f64 = 20_000.0;

/// Places that a zone asks for and those of them that areas cover.
#[derive(Clone, Copy, Default)]
pub(super) struct Tally {
    asked: usize,
    covered: usize,
}

impl Tally {
    pub(super) fn add(&mut self, covered: bool) {
        self.asked += 1;
        self.covered += usize::from(covered);
    }

    /// Share that is covered, where less than `enough` is.
    pub(super) fn short_of(self, enough: f64) -> Option<f64> {
        let share = self.covered as f64 / self.asked.max(1) as f64;
        (self.asked > 0 && share < enough).then_some(share)
    }
}

/// Plane of an area with axes of its own; level ones are read in plan.
pub(super) struct Plane {
    origin: DVec3,
    u: DVec3,
    v: DVec3,
    pub(super) normal: DVec3,
}

impl Plane {
    pub(super) fn of(area: &PlannedArea) -> Self {
        let grid = &area.grid;
        let origin = grid.points.first().map_or(grid.origin, |point| point.position);
        if grid.normal.z.abs() > 0.99 {
            return Self {
                origin: DVec3::new(0.0, 0.0, origin.z),
                u: DVec3::X,
                v: DVec3::Y,
                normal: DVec3::Z,
            };
        }
        let u = if grid.edge_u.length() > 0.0 {
            grid.edge_u.normalize()
        } else {
            DVec3::Z.cross(grid.normal).normalize_or(DVec3::X)
        };
        Self { origin, u, v: grid.normal.cross(u), normal: grid.normal }
    }

    pub(super) fn is_level(&self) -> bool {
        self.normal.z > 0.99
    }

    pub(super) fn flat(&self, place: DVec3) -> DVec2 {
        let offset = place - self.origin;
        DVec2::new(offset.dot(self.u), offset.dot(self.v))
    }

    pub(super) fn height_m(&self, place: DVec3) -> f64 {
        (place - self.origin).dot(self.normal)
    }

    /// Outline of an area in this plane; empty for a list of points.
    pub(super) fn outline(&self, area: &PlannedArea) -> Vec<DVec2> {
        let flat = |p: &DVec3| self.flat(*p);
        match &area.shape {
            AreaShape::Polygon(corners) => corners.iter().map(flat).collect(),
            AreaShape::Rect { origin, u, v } | AreaShape::Surface { origin, u, v, .. } => {
                [*origin, *origin + *u, *origin + *u + *v, *origin + *v].iter().map(flat).collect()
            }
            AreaShape::Points(_) => Vec::new(),
        }
    }

    /// Distance of a place from an area in this plane, 0 inside, m.
    pub(super) fn distance_m(&self, area: &PlannedArea, flat: DVec2) -> f64 {
        if let AreaShape::Points(points) = &area.shape {
            return points.iter().map(|(at, _)| self.flat(*at).distance(flat)).fold(f64::INFINITY, f64::min);
        }
        let outline = self.outline(area);
        if inside(&outline, flat) { 0.0 } else { distance_to_outline(&outline, flat) }
    }

    /// Places of a lattice over the area and `beyond_m` round it.
    pub(super) fn lattice(&self, area: &PlannedArea, beyond_m: f64) -> impl Iterator<Item = (DVec3, DVec2)> {
        let corners: Vec<DVec2> = match &area.shape {
            AreaShape::Points(points) => points.iter().map(|(at, _)| self.flat(*at)).collect(),
            AreaShape::Rect { .. } | AreaShape::Polygon(_) | AreaShape::Surface { .. } => self.outline(area),
        };
        let (lo, hi) = bounds(&corners);
        let (lo, hi) = (lo - beyond_m, hi + beyond_m);
        let size = (hi - lo).max(DVec2::splat(1e-6));
        let step_m = (size.x * size.y / MOST_PLACES).sqrt().max(0.1);
        let count = |side_m: f64| (side_m / step_m).ceil().max(1.0) as usize;
        let (columns, rows) = (count(size.x), count(size.y));
        let (origin, u, v) = (self.origin, self.u, self.v);
        cells(columns, rows).map(move |(column, row)| {
            let part = DVec2::new((column as f64 + 0.5) / columns as f64, (row as f64 + 0.5) / rows as f64);
            let flat = lo + size * part;
            (origin + u * flat.x + v * flat.y, flat)
        })
    }
}

/// Cells over a surface of the room: enough to find a door, few enough for a hundred rooms.
pub(super) fn lattice(one_m: f64, other_m: f64) -> [usize; 2] {
    [one_m, other_m].map(|side_m| (side_m / 0.25).ceil().clamp(4.0, 40.0) as usize)
}

pub(super) fn cells(columns: usize, rows: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)))
}

pub(super) fn bounds(corners: &[DVec2]) -> (DVec2, DVec2) {
    corners.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}
