//! What is seen in a drawing's window, from the ground up: room, false colours, furniture,
//! luminaires, isolines, extremes, values. Texts reserve their place so that none covers another.

use glam::DVec2;

use super::canvas::{Anchor, Lettering, Px, text_width};
use super::isolines::{Contours, Values, contours};
use super::plan_sheet::{Drawing, INK, LIMIT, PALE, bold, colour, lettering};
use super::plan_view::{Sight, world_from_cells};
use super::words::{Term, word};
use crate::grid::Exclusion;
use crate::outcome::LuminaireOutcome;
use crate::quantity::Statistic;

impl Drawing<'_> {
    pub(super) fn window(&mut self) {
        let (from, to) = (self.view.corner, self.view.end());
        self.canvas.rectangle(from, to, [247, 247, 245], 1.0);
        self.canvas.clip(from, to);
        if self.view.sight == Sight::Plan {
            let outline: Vec<Px> =
                self.subject.room.footprint.iter().map(|at| self.view.px_of_flat(*at)).collect();
            if outline.len() > 2 {
                self.canvas.polygon(&outline, [255, 255, 255], 1.0);
                self.canvas.ring(&outline, INK, 2.0);
            }
        }
        let lines = self.false_colours();
        self.exclusions();
        let outline: Vec<Px> = self.subject.area.grid.outline.iter().map(|at| self.view.px(*at)).collect();
        if outline.len() > 2 {
            self.canvas.ring(&outline, [70, 90, 120], 1.0);
        }
        if self.view.sight == Sight::Plan {
            for outline in &self.subject.room.furniture {
                let places: Vec<Px> = outline.iter().map(|at| self.view.px_of_flat(*at)).collect();
                self.canvas.ring(&places, [132, 110, 84], 1.0);
            }
            for luminaire in &self.subject.room.luminaires {
                self.luminaire(luminaire);
            }
            for luminaire in &self.subject.room.luminaires {
                self.name_of(luminaire);
            }
        }
        self.isolines(&lines);
        self.extremes();
        for (level, contours, is_limit) in &lines {
            self.label(*level, contours, *is_limit);
        }
        self.point_values();
        self.canvas.end_clip();
        self.canvas.ring(&[from, [to[0], from[1]], to, [from[0], to[1]]], PALE, 0.5);
    }

    /// Fills the regions between levels and returns the lines: level, contours, whether it is the limit.
    fn false_colours(&mut self) -> Vec<(f64, Contours, bool)> {
        let grid = &self.subject.area.grid;
        if grid.columns * grid.rows != self.values.len() || self.values.is_empty() {
            return Vec::new();
        }
        let values = self.values.clone();
        let values = Values { columns: grid.columns, rows: grid.rows, by_point: &values };
        let mut lines = Vec::new();
        let levels = self.levels();
        let steps = levels.len() as f64;
        for (index, (level, is_limit)) in
            std::iter::once((f64::NEG_INFINITY, false)).chain(levels).enumerate()
        {
            let contours = contours(&values, level);
            let regions: Vec<Vec<Px>> = contours.regions.iter().map(|ring| self.ring_px(ring)).collect();
            let share = if steps > 0.0 { index as f64 / steps } else { 0.5 };
            self.canvas.regions(regions.iter().map(Vec::as_slice), colour(share));
            if level.is_finite() {
                lines.push((level, contours, is_limit));
            }
        }
        lines
    }

    fn ring_px(&self, ring: &[[f64; 2]]) -> Vec<Px> {
        ring.iter().map(|place| self.view.px(world_from_cells(&self.subject.area.grid, *place))).collect()
    }

    fn isolines(&mut self, lines: &[(f64, Contours, bool)]) {
        for (_, contours, is_limit) in lines {
            let places: Vec<Vec<Px>> = contours.lines.iter().map(|line| self.ring_px(line)).collect();
            let (colour, width) = if *is_limit { (LIMIT, 2.4) } else { ([92, 100, 112], 0.75) };
            self.canvas.lines(places.iter().map(Vec::as_slice), colour, width);
        }
    }

    /// Writes the level on its longest line where it covers no other text.
    fn label(&mut self, level: f64, contours: &Contours, is_limit: bool) {
        let text = self.text_of(Statistic::Mean, level);
        let Some(line) = contours.lines.iter().max_by_key(|line| line.len()) else {
            return;
        };
        let places = self.ring_px(line);
        let (from, to) = (self.view.corner, self.view.end());
        let look = Lettering { colour: if is_limit { LIMIT } else { INK }, ..bold(10.0, Anchor::Middle) };
        let count = places.len();
        for step in 0..count.min(24) {
            let index = (count / 2 + (step * count / 24.min(count)) * 7) % count;
            let at = places[index];
            let inside = at[0] > from[0] + 16.0
                && at[0] < to[0] - 16.0
                && at[1] > from[1] + 8.0
                && at[1] < to[1] - 8.0;
            if inside && self.take(at, text_width(&text, 10.0) + 4.0, 12.0) {
                let half = text_width(&text, 10.0) / 2.0 + 1.5;
                self.canvas.rectangle(
                    [at[0] - half, at[1] - 6.5],
                    [at[0] + half, at[1] + 6.0],
                    [255, 255, 255],
                    0.85,
                );
                self.canvas.text(at, &text, look);
                return;
            }
        }
    }

    /// Hatches cells whose points are left out though they lie inside the area's outline.
    fn exclusions(&mut self) {
        let grid = &self.subject.area.grid;
        let mut strokes: Vec<[Px; 2]> = Vec::new();
        for point in &grid.points {
            if !matches!(point.excluded, Some(Exclusion::InsideFurniture | Exclusion::InOtherArea)) {
                continue;
            }
            let (c, r) = (point.column as f64, point.row as f64);
            for share in [0.25, 0.5, 0.75, 1.0] {
                let low = ([c + share, r], [c, r + share]);
                let high = ([c + 1.0, r + share], [c + share, r + 1.0]);
                for (from, to) in [low, high] {
                    strokes.push([from, to].map(|place| self.view.px(world_from_cells(grid, place))));
                }
            }
        }
        self.canvas.lines(strokes.iter().map(<[Px; 2]>::as_slice), PALE, 0.6);
    }

    fn luminaire(&mut self, luminaire: &LuminaireOutcome) {
        let centre = self.view.px(luminaire.position);
        let outline: Vec<Px> = luminaire.outline.iter().map(|at| self.view.px(*at)).collect();
        if outline.len() > 2 {
            self.canvas.polygon(&outline, [255, 255, 255], 0.55);
            self.canvas.ring(&outline, INK, 1.0);
        } else {
            self.canvas.circle(centre, 4.0, INK, false);
        }
        self.taken.push([centre[0] - 5.0, centre[1] - 5.0, centre[0] + 5.0, centre[1] + 5.0]);
        let along = self.view.direction(luminaire.c0);
        if along.length() > 0.05 {
            let along = along.normalize();
            let start = DVec2::from(centre) + along * 7.0;
            let tip = start + along * 9.0;
            let wing = |side: f64| (tip - along * 4.0 + along.perp() * side * 2.2).to_array();
            self.canvas.line(&[start.to_array(), tip.to_array()], INK, 0.9);
            self.canvas.polygon(&[tip.to_array(), wing(1.0), wing(-1.0)], INK, 1.0);
        }
    }

    /// The type's name beside the luminaire, where it covers neither opening nor arrow: above, below, at a side; cut
    /// where there is no room for all of it, and left out where there is none at all.
    fn name_of(&mut self, luminaire: &LuminaireOutcome) {
        const SIZE: f64 = 9.0;
        let centre = DVec2::from(self.view.px(luminaire.position));
        let along = self.view.direction(luminaire.c0).normalize_or_zero();
        let outline = luminaire.outline.iter().map(|at| DVec2::from(self.view.px(*at)));
        let marks = [centre - DVec2::splat(4.0), centre + DVec2::splat(4.0), centre + along * 16.0];
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for place in outline.chain(marks) {
            (low, high) = (low.min(place), high.max(place));
        }
        let (from, to) = (self.view.corner, self.view.end());
        for longest in [16, 7] {
            let text = shortened(&luminaire.kind, longest);
            let (width, height) = (text_width(&text, SIZE) + 2.0, SIZE + 2.0);
            let middle = 0.5 * (low + high);
            for at in [
                [middle.x, low.y - 0.5 * height - 1.0],
                [middle.x, high.y + 0.5 * height + 1.0],
                [high.x + 0.5 * width + 1.0, middle.y],
                [low.x - 0.5 * width - 1.0, middle.y],
            ] {
                let seen = at[0] - 0.5 * width > from[0]
                    && at[0] + 0.5 * width < to[0]
                    && at[1] - 0.5 * height > from[1]
                    && at[1] + 0.5 * height < to[1];
                if seen && self.take(at, width, height) {
                    let half = [0.5 * width, 0.5 * height];
                    self.canvas.rectangle(
                        [at[0] - half[0], at[1] - half[1]],
                        [at[0] + half[0], at[1] + half[1]],
                        [255, 255, 255],
                        0.6,
                    );
                    self.canvas.text(at, &text, bold(SIZE, Anchor::Middle));
                    return;
                }
            }
        }
    }

    fn extremes(&mut self) {
        let Some([(low, min), (high, max)]) = self.extreme_points() else {
            return;
        };
        for (index, value, term) in [(low, min, Term::IndexMin), (high, max, Term::IndexMax)] {
            let Some(point) = self.subject.area.grid.points.get(index) else {
                continue;
            };
            let at = self.view.px(point.position);
            let text = format!("{} {}", word(self.lang, term), self.text_of(Statistic::Min, value));
            let half = text_width(&text, 10.0) / 2.0 + 3.0;
            let (from, to) = (self.view.corner, self.view.end());
            let x = at[0].clamp(from[0] + half + 1.0, (to[0] - half - 1.0).max(from[0] + half + 1.0));
            let below = at[1] + 12.0 < to[1] - 6.0;
            let y = if below { at[1] + 12.0 } else { at[1] - 12.0 };
            self.canvas.circle(at, 3.4, INK, false);
            self.canvas.circle(at, 1.2, INK, true);
            self.canvas.rectangle([x - half, y - 6.5], [x + half, y + 6.5], INK, 0.85);
            self.canvas.text(
                [x, y],
                &text,
                Lettering { colour: [255, 255, 255], ..bold(10.0, Anchor::Middle) },
            );
            self.taken.push([x - half, y - 7.0, x + half, y + 7.0]);
            self.taken.push([at[0] - 5.0, at[1] - 5.0, at[0] + 5.0, at[1] + 5.0]);
        }
    }

    /// Writes the values at their points; every second or third only, where they stand too close.
    fn point_values(&mut self) {
        let grid = &self.subject.area.grid;
        let texts: Vec<Option<String>> =
            self.values.iter().map(|v| v.map(|v| self.text_of(Statistic::Min, v))).collect();
        let widest = texts.iter().flatten().map(|text| text_width(text, 8.5)).fold(0.0, f64::max);
        let stride = |spacing_m: f64, needed_px: f64| {
            let spacing_px = spacing_m * self.view.px_per_m;
            if spacing_px > 0.0 { (needed_px / spacing_px).ceil().clamp(1.0, 1e6) as usize } else { 1 }
        };
        let along_u_is_wide =
            self.view.direction(grid.edge_u).x.abs() >= self.view.direction(grid.edge_u).y.abs();
        let needed = if along_u_is_wide { [widest + 5.0, 12.0] } else { [12.0, widest + 5.0] };
        let strides = [stride(grid.spacing_m[0], needed[0]), stride(grid.spacing_m[1], needed[1])];
        let mut shown = Vec::new();
        for (point, text) in grid.points.iter().zip(texts) {
            let Some(text) = text else { continue };
            if point.column % strides[0] == strides[0] / 2
                && (grid.columns == 0 || point.row % strides[1] == strides[1] / 2)
            {
                shown.push((self.view.px(point.position), text));
            }
        }
        for (at, text) in shown {
            if self.take(at, text_width(&text, 8.5), 9.0) {
                self.canvas.text(
                    at,
                    &text,
                    Lettering { colour: [70, 75, 82], ..lettering(8.5, Anchor::Middle) },
                );
            }
        }
    }
}

/// The start of a name, with a sign that there is more.
fn shortened(name: &str, longest: usize) -> String {
    if name.chars().count() <= longest {
        name.to_owned()
    } else {
        name.chars().take(longest - 1).chain(['…']).collect()
    }
}
