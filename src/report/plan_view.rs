//! From metres in the room to pixels on a drawing: a plan seen from above for areas that lie, and
//! an unrolled view against the normal, u to the right and v up, for areas that stand.

use glam::{DVec2, DVec3};

use super::canvas::Px;
use super::isolines::Place;
use crate::grid::Grid;
use crate::outcome::{AreaOutcome, RoomOutcome};

/// How an area is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// From above, project axes x and y.
    Plan,
    /// From the room against the area's normal.
    Elevation,
}

/// The window of a drawing and its scale.
#[derive(Clone, Debug)]
pub struct View {
    /// How the area is looked at.
    pub sight: Sight,
    right: DVec3,
    up: DVec3,
    origin: DVec3,
    /// Lower left and upper right corner shown, m in the drawing's plane.
    pub low: DVec2,
    /// See `low`.
    pub high: DVec2,
    /// Pixels per metre.
    pub px_per_m: f64,
    /// Upper left corner of the window, px.
    pub corner: Px,
}

impl View {
    /// The view of an area in a window of at most `size` pixels whose upper left corner is `corner`.
    pub fn of(room: &RoomOutcome, area: &AreaOutcome, corner: Px, size: Px) -> Self {
        let grid = &area.grid;
        let lies = grid.normal.z.abs() > 0.5 || grid.columns == 0;
        let (sight, right, up, origin) = if lies {
            (Sight::Plan, DVec3::X, DVec3::Y, DVec3::ZERO)
        } else {
            let right = DVec3::Z.cross(grid.normal).normalize_or(DVec3::X);
            (Sight::Elevation, right, grid.normal.cross(right), grid.origin)
        };
        let mut view =
            Self { sight, right, up, origin, low: DVec2::ZERO, high: DVec2::ONE, px_per_m: 1.0, corner };
        if sight == Sight::Elevation {
            let first = corners(grid).map(|at| view.flat(at)).reduce(DVec2::min).unwrap_or_default();
            view.origin += right * first.x + view.up * first.y;
        }
        view.fit(room, area, size);
        view
    }

    /// Shows the room and the area; only the area and what is near it where it is small in the room.
    fn fit(&mut self, room: &RoomOutcome, area: &AreaOutcome, size: Px) {
        let span = |places: &[DVec2]| {
            places
                .iter()
                .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), at| (low.min(*at), high.max(*at)))
        };
        let of_area: Vec<DVec2> = corners(&area.grid).map(|at| self.flat(at)).collect();
        let (mut low, mut high) = span(&of_area);
        if !low.is_finite() || !high.is_finite() {
            (low, high) = (DVec2::ZERO, DVec2::ONE);
        }
        let extent = (high - low).max_element().max(0.5);
        if self.sight == Sight::Plan && !room.footprint.is_empty() {
            let (room_low, room_high) = span(&room.footprint);
            if extent > 0.3 * (room_high - room_low).max_element() {
                (low, high) = (low.min(room_low), high.max(room_high));
            } else {
                let near = DVec2::splat(0.6 * extent);
                (low, high) = ((low - near).max(room_low.min(low)), (high + near).min(room_high.max(high)));
            }
        }
        let margin = DVec2::splat(0.03 * (high - low).max_element().max(0.5));
        (self.low, self.high) = (low - margin, high + margin);
        let wanted = self.high - self.low;
        self.px_per_m = (size[0] / wanted.x).min(size[1] / wanted.y);
        self.corner[0] += (size[0] - wanted.x * self.px_per_m) / 2.0;
    }

    /// Coordinates in the drawing's plane, m.
    pub fn flat(&self, at: DVec3) -> DVec2 {
        let from_origin = at - self.origin;
        DVec2::new(from_origin.dot(self.right), from_origin.dot(self.up))
    }

    /// Pixels of a place in the drawing's plane.
    pub fn px_of_flat(&self, at: DVec2) -> Px {
        [
            self.corner[0] + (at.x - self.low.x) * self.px_per_m,
            self.corner[1] + (self.high.y - at.y) * self.px_per_m,
        ]
    }

    /// Pixels of a place in the room.
    pub fn px(&self, at: DVec3) -> Px {
        self.px_of_flat(self.flat(at))
    }

    /// Lower right corner of the window, px.
    pub fn end(&self) -> Px {
        let size = (self.high - self.low) * self.px_per_m;
        [self.corner[0] + size.x, self.corner[1] + size.y]
    }

    /// Direction in pixels of a direction in the room, not normalised.
    pub fn direction(&self, direction: DVec3) -> DVec2 {
        DVec2::new(direction.dot(self.right), -direction.dot(self.up))
    }
}

fn corners(grid: &Grid) -> impl Iterator<Item = DVec3> + '_ {
    let rectangle = [
        grid.origin,
        grid.origin + grid.edge_u,
        grid.origin + grid.edge_u + grid.edge_v,
        grid.origin + grid.edge_v,
    ];
    let of_rectangle = rectangle.into_iter().filter(move |_| grid.columns > 0);
    let of_points = grid.points.iter().map(|point| point.position).filter(move |_| grid.columns == 0);
    of_rectangle.chain(of_points).chain(grid.outline.iter().copied())
}

/// Where a place in units of cells lies in the room.
pub fn world_from_cells(grid: &Grid, place: Place) -> DVec3 {
    let first = grid.points.first().map_or(grid.origin, |point| point.position);
    let step = |edge: DVec3, spacing: f64| edge.normalize_or_zero() * spacing;
    first
        + step(grid.edge_u, grid.spacing_m[0]) * (place[0] - 0.5)
        + step(grid.edge_v, grid.spacing_m[1]) * (place[1] - 0.5)
}
