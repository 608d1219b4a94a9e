//! A drawing's paper: title block, axes, legend, and what all its parts share.

use glam::DVec2;

use super::canvas::{Anchor, Canvas, Lettering, Px, Rgb, Weight, text_width};
use super::isolines::levels;
use super::number;
use super::plan::{Subject, grid_facts, maintenance, statistic_of};
use super::plan_view::{Sight, View};
use super::sentence::bound;
use super::words::{self, Lang, Term, phrase, word};
use crate::grid::Exclusion;
use crate::outcome::Requirement;
use crate::quantity::Statistic;

pub(super) const WIDTH: f64 = 760.0;
pub(super) const WINDOW: Px = [690.0, 500.0];
pub(super) const CORNER: Px = [54.0, 95.0];
pub(super) const INK: Rgb = [32, 36, 42];
pub(super) const PALE: Rgb = [120, 126, 134];
pub(super) const LIMIT: Rgb = [176, 24, 38];
/// From low to high; light enough for black letters.
pub(super) const COLOURS: [Rgb; 5] =
    [[206, 219, 236], [222, 236, 231], [250, 246, 219], [250, 225, 176], [243, 190, 146]];

/// A drawing in progress.
pub(super) struct Drawing<'a> {
    pub canvas: Canvas,
    pub subject: Subject<'a>,
    pub lang: Lang,
    pub values: Vec<Option<f64>>,
    pub limit: Option<&'a Requirement>,
    pub view: View,
    /// Boxes of texts that others must not cover: left, top, right, bottom.
    pub taken: Vec<[f64; 4]>,
}

pub(super) fn lettering(size: f64, anchor: Anchor) -> Lettering {
    Lettering { size, anchor, weight: Weight::Normal, colour: INK }
}

pub(super) fn bold(size: f64, anchor: Anchor) -> Lettering {
    Lettering { weight: Weight::Bold, ..lettering(size, anchor) }
}

/// A line that fits a width: smaller first, down to `smallest`, and only then cut. A letter counts as `em` of the
/// size, as wide as Cyrillic runs in the fonts that the page asks for.
pub(super) fn fitted(text: &str, size: f64, smallest: f64, em: f64, width: f64) -> (String, f64) {
    let letters = text.chars().count().max(1) as f64;
    let size = (width / (em * letters)).clamp(smallest, size);
    let room = (width / (em * size) + 1e-9) as usize;
    let cut = || text.chars().take(room.saturating_sub(1)).chain(['…']).collect();
    (if text.chars().count() <= room { text.to_owned() } else { cut() }, size)
}

impl Drawing<'_> {
    pub(super) fn text_of(&self, statistic: Statistic, value: f64) -> String {
        number::value(self.lang, self.subject.field.quantity, statistic, value)
    }

    pub(super) fn title_block(&mut self) {
        let Subject { room, area, .. } = self.subject;
        let head = format!("{} {} · {}", room.number, room.name, words::place_name(self.lang, &area.name));
        let (head, size) = fitted(head.trim_start(), 15.0, 11.0, 0.64, WIDTH - 24.0);
        self.canvas.text([12.0, 16.0], &head, bold(size, Anchor::Start));
        let lines = [self.quantity(), self.conditions(), self.results()];
        for (line, y) in lines.into_iter().zip([36.0, 53.0, 70.0]) {
            let (line, size) = fitted(&line, 11.0, 9.0, 0.6, WIDTH - 24.0);
            self.canvas.text([12.0, y], &line, lettering(size, Anchor::Start));
        }
        self.canvas.line(&[[12.0, 82.0], [WIDTH - 12.0, 82.0]], PALE, 0.5);
    }

    fn quantity(&self) -> String {
        let Subject { room, area, field, .. } = self.subject;
        let lang = self.lang;
        let first = area.grid.points.first();
        let height_m = first.map_or(area.grid.origin.z, |point| point.position.z) - room.floor_m;
        let place = match self.view.sight {
            Sight::Plan => {
                let height = number::fixed(lang, height_m, 2);
                format!("{} {height} {}", word(lang, Term::PlaneHeight), word(lang, Term::UnitMetre))
            }
            Sight::Elevation => word(lang, Term::ViewedFromRoom).to_owned(),
        };
        format!(
            "{}, {} · {place}",
            words::quantity(lang, field.quantity),
            words::condition(lang, field.condition)
        )
    }

    fn conditions(&self) -> String {
        let Subject { room, area, field, .. } = self.subject;
        let lang = self.lang;
        let mut parts = vec![grid_facts(lang, area)];
        parts.extend(maintenance(lang, room));
        parts.push(format!("{}: {}", word(lang, Term::LightScene), field.light_scene));
        parts.join(" · ")
    }

    fn results(&self) -> String {
        let quantity = self.subject.field.quantity;
        let lang = self.lang;
        let mut parts = Vec::new();
        for statistic in [Statistic::Mean, Statistic::Min, Statistic::Max, Statistic::U0] {
            if let Some(value) = statistic_of(self.subject, statistic) {
                let unit = number::unit(lang, quantity, statistic);
                let value = self.text_of(statistic, value);
                parts.push(format!("{} = {value}{unit}", self.short(statistic)));
            }
        }
        if let Some(requirement) = self.limit {
            let (limit, is_minimum) = bound(requirement.bound);
            let limit = self.text_of(requirement.statistic, limit);
            let unit = number::unit(lang, quantity, requirement.statistic);
            let term = if is_minimum { Term::AtLeast } else { Term::AtMost };
            let required = phrase(lang, term, &[&format!("{limit}{unit}")]);
            let symbol = self.short(requirement.statistic);
            parts.push(format!("{}: {symbol} {required}", word(lang, Term::Required)));
        }
        parts.join(" · ")
    }

    /// `Ē`, `Emin`: the quantity is named above, and what is left of the index reads as one word.
    fn short(&self, statistic: Statistic) -> String {
        let symbol = words::symbol(self.lang, self.subject.field.quantity, statistic);
        let index = symbol.index.rsplit(',').next().unwrap_or_default();
        let index = if symbol.letter == "Ē" { "" } else { index };
        format!("{}{index}", symbol.letter)
    }

    pub(super) fn axes(&mut self) {
        let (from, to) = (self.view.corner, self.view.end());
        let (low, high) = (self.view.low, self.view.high);
        let step = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]
            .into_iter()
            .find(|step| step * self.view.px_per_m >= 44.0)
            .unwrap_or(100.0);
        let ticks = |low: f64, high: f64| {
            let first = (low / step).ceil() as i64;
            (first..).map(move |i| i as f64 * step).take_while(move |at| *at <= high)
        };
        let small = Lettering { colour: PALE, ..lettering(9.0, Anchor::Middle) };
        let names = match self.view.sight {
            Sight::Plan => ["x", "y"],
            Sight::Elevation => ["u", "v"],
        };
        for at in ticks(low.x, high.x) {
            let x = self.view.px_of_flat(DVec2::new(at, low.y))[0];
            self.canvas.line(&[[x, to[1]], [x, to[1] + 4.0]], PALE, 0.5);
            self.canvas.text([x, to[1] + 11.0], &number::metres(self.lang, at), small);
        }
        for at in ticks(low.y, high.y) {
            let y = self.view.px_of_flat(DVec2::new(low.x, at))[1];
            self.canvas.line(&[[from[0] - 4.0, y], [from[0], y]], PALE, 0.5);
            self.canvas.text(
                [from[0] - 7.0, y],
                &number::metres(self.lang, at),
                Lettering { anchor: Anchor::End, ..small },
            );
        }
        let metre = word(self.lang, Term::UnitMetre);
        self.canvas.text(
            [to[0], to[1] + 22.0],
            &format!("{}, {metre}", names[0]),
            Lettering { anchor: Anchor::End, ..small },
        );
        self.canvas.text([from[0] - 34.0, from[1] + 4.0], &format!("{}, {metre}", names[1]), small);
    }

    pub(super) fn legend(&mut self) {
        let (from, to) = (self.view.corner[0].min(CORNER[0]), self.view.end());
        let lang = self.lang;
        let y = to[1] + 40.0;
        let length_m = [0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0]
            .into_iter()
            .rfind(|length| length * self.view.px_per_m <= 150.0)
            .unwrap_or(0.1);
        let length = length_m * self.view.px_per_m;
        let small = lettering(9.5, Anchor::Start);
        self.canvas.rectangle([from, y - 2.0], [from + length / 2.0, y + 2.0], INK, 1.0);
        self.canvas.ring(
            &[[from, y - 2.0], [from + length, y - 2.0], [from + length, y + 2.0], [from, y + 2.0]],
            INK,
            0.7,
        );
        let text = format!("{} {}", number::metres(lang, length_m), word(lang, Term::UnitMetre));
        self.canvas.text([from + length + 6.0, y], &text, small);
        let mut x = from + length + 6.0 + text_width(&text, 9.5) + 18.0;
        let is_drawn =
            self.subject.area.grid.columns > 0 && self.levels().iter().any(|(_, is_limit)| *is_limit);
        if let Some(requirement) = self.limit.filter(|_| is_drawn) {
            let (limit, _) = bound(requirement.bound);
            let unit = number::unit(lang, requirement.quantity, requirement.statistic);
            let text = format!(
                "{} {}{unit}",
                word(lang, Term::LimitLine),
                self.text_of(requirement.statistic, limit)
            );
            self.canvas.line(&[[x, y], [x + 22.0, y]], LIMIT, 2.4);
            self.canvas.text([x + 27.0, y], &text, small);
            x += 27.0 + text_width(&text, 9.5) + 14.0;
        }
        if self
            .subject
            .area
            .grid
            .points
            .iter()
            .any(|p| matches!(p.excluded, Some(Exclusion::InsideFurniture | Exclusion::InOtherArea)))
        {
            for offset in [0.0, 5.0, 10.0] {
                self.canvas.line(&[[x + offset, y + 5.0], [x + offset + 8.0, y - 5.0]], PALE, 0.6);
            }
            let text = word(lang, Term::ExcludedPoints);
            self.canvas.text([x + 22.0, y], text, small);
            x += 22.0 + text_width(text, 9.5) + 14.0;
        }
        if self.view.sight == Sight::Plan && !self.subject.room.luminaires.is_empty() {
            self.canvas.line(&[[x, y], [x + 16.0, y]], INK, 0.9);
            self.canvas.polygon(&[[x + 18.0, y], [x + 13.0, y - 2.4], [x + 13.0, y + 2.4]], INK, 1.0);
            self.canvas.text([x + 23.0, y], "C0", small);
        }
        self.scale_of_colours([from, y + 18.0]);
    }

    fn scale_of_colours(&mut self, at: Px) {
        let levels = self.levels();
        if levels.is_empty() || self.subject.area.grid.columns == 0 {
            return;
        }
        let count = levels.len();
        let width = ((WIDTH - at[0] - 60.0) / (count as f64 + 1.0)).min(52.0);
        for index in 0..=count {
            let left = at[0] + index as f64 * width;
            self.canvas.rectangle(
                [left, at[1]],
                [left + width, at[1] + 9.0],
                colour(index as f64 / count as f64),
                1.0,
            );
            if let Some((level, is_limit)) = levels.get(index) {
                let text = self.text_of(Statistic::Mean, *level);
                let look = if *is_limit {
                    Lettering { colour: LIMIT, ..bold(9.0, Anchor::Middle) }
                } else {
                    lettering(9.0, Anchor::Middle)
                };
                self.canvas.text([left + width, at[1] + 17.0], &text, look);
            }
        }
        let end = at[0] + (count as f64 + 1.0) * width;
        self.canvas.ring(&[at, [end, at[1]], [end, at[1] + 9.0], [at[0], at[1] + 9.0]], PALE, 0.5);
        let unit = number::unit(self.lang, self.subject.field.quantity, Statistic::Mean);
        self.canvas.text(
            [end + 6.0, at[1] + 5.0],
            unit.trim_start_matches('\u{a0}'),
            lettering(9.5, Anchor::Start),
        );
    }

    /// Nice levels between the extremes and the limit; nice ones too near the limit give way.
    pub(super) fn levels(&self) -> Vec<(f64, bool)> {
        let Some([(_, min), (_, max)]) = self.extreme_points() else {
            return Vec::new();
        };
        let limit = self.limit.map(|r| bound(r.bound).0).filter(|limit| *limit > min && *limit < max);
        let nice = levels(min, max);
        let gap = (max - min) / (nice.len() as f64 + 1.0);
        let mut all: Vec<(f64, bool)> = nice
            .into_iter()
            .filter(|level| limit.is_none_or(|limit| (level - limit).abs() > 0.4 * gap.min(0.5 * limit)))
            .map(|level| (level, false))
            .chain(limit.map(|limit| (limit, true)))
            .collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    /// Index and value of the smallest and of the largest point.
    pub(super) fn extreme_points(&self) -> Option<[(usize, f64); 2]> {
        let known = self.values.iter().enumerate();
        let known = known.filter_map(|(index, value)| value.map(|value| (index, value)));
        let smallest = known.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let largest = known.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some([smallest, largest])
    }

    /// Reserves a box around a place unless another text is there.
    pub(super) fn take(&mut self, at: Px, width: f64, height: f64) -> bool {
        let new = [at[0] - width / 2.0, at[1] - height / 2.0, at[0] + width / 2.0, at[1] + height / 2.0];
        let free = self
            .taken
            .iter()
            .all(|old| new[0] > old[2] || new[2] < old[0] || new[1] > old[3] || new[3] < old[1]);
        if free {
            self.taken.push(new);
        }
        free
    }
}

/// Colour of a share of the way from the lowest to the highest band.
pub(super) fn colour(share: f64) -> Rgb {
    let place = share.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let index = (place.floor() as usize).min(COLOURS.len() - 2);
    let part = place - index as f64;
    std::array::from_fn(|i| {
        let (a, b) = (f64::from(COLOURS[index][i]), f64::from(COLOURS[index + 1][i]));
        (a + (b - a) * part).round() as u8
    })
}
