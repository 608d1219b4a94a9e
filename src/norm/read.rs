//! TOML → [`Standard`]. The shape is checked by serde, the values here, with their place in the file.

mod mistake;

use std::ops::Range;

use toml::Spanned;

use mistake::plainly;
pub use mistake::{Mistake, NormError};

use super::text::{COLUMNS, Column, Kind, LimitText, RowText, StandardText};
use super::{Application, Bound, IntensityLimit, Limit, Plane, Row, Standard, Unknown, Verified};
use crate::quantity::{Quantity, SPELLINGS, Statistic};

impl Kind {
    fn range(self) -> (f64, f64, &'static str) {
        match self {
            Self::Illuminance => (0.01, 200_000.0, "an illuminance lies between 0.01 and 200 000 lx"),
            Self::Fraction => (0.001, 1.0, "a uniformity or fraction lies between 0.001 and 1"),
            Self::Ugr => (5.0, 40.0, "UGR limits lie between 5 and 40"),
            Self::ColourRendering => (0.0, 100.0, "R_a lies between 0 and 100"),
            Self::Percentage => (0.0, 100.0, "a percentage lies between 0 and 100"),
            Self::GlareRating => (10.0, 90.0, "the glare rating lies between 10 and 90"),
            Self::DiscomfortIndex => (1.0, 200.0, "the discomfort index M lies between 1 and 200"),
            Self::Height => (0.0, 100.0, "heights and widths lie between 0 and 100 m"),
            Self::Ratio => (0.1, 1.0, "the ratio lies between 0.1 and 1"),
        }
    }
}

/// The text and the mistakes found in it.
struct Reader<'a> {
    text: &'a str,
    file: &'a str,
    mistakes: Vec<Mistake>,
}

/// Reads and checks a standard.
pub(super) fn standard(text: &str, file: &str) -> Result<Standard, NormError> {
    let mut reader = Reader { text, file, mistakes: Vec::new() };
    let parsed: StandardText = match toml::from_str(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let (what, hint) = plainly(error.message());
            reader.mistake(&span, what, &hint);
            return Err(NormError { mistakes: reader.mistakes });
        }
    };
    if parsed.id.get_ref().trim().is_empty() {
        reader.mistake(&parsed.id.span(), "the id is empty".into(), "give the standard a short name");
    }
    if parsed.row.is_empty() {
        reader.mistake(&(0..0), "the standard has no rows".into(), "add a [[row]] with ref and em");
    }
    let application = match parsed.application {
        Some(application) => {
            let span = application.span();
            let application = application.into_inner();
            reader.check_application(&application, &span);
            application
        }
        None => Application::default(),
    };
    let mut rows: Vec<Row> = Vec::new();
    for row in parsed.row {
        if rows.iter().any(|earlier| earlier.reference == *row.reference.get_ref()) {
            let what = format!("the row {} is there twice", row.reference.get_ref());
            reader.mistake(&row.reference.span(), what, "references must differ");
        }
        rows.push(reader.row(row, &application));
    }
    if reader.mistakes.is_empty() {
        let StandardText { id, short, title, edition, note, .. } =
            StandardText { row: Vec::new(), application: None, ..parsed };
        let id = id.into_inner();
        // A house norm without a short name is called by its id.
        let short = if short.trim().is_empty() { id.clone() } else { short };
        Ok(Standard { id, short, title, edition, note, application, rows })
    } else {
        Err(NormError { mistakes: reader.mistakes })
    }
}

impl Reader<'_> {
    fn mistake(&mut self, span: &Range<usize>, what: String, hint: &str) {
        let boundary = |mut at: usize| {
            at = at.min(self.text.len());
            while !self.text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let (start, end) = (boundary(span.start), boundary(span.end.max(span.start)));
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let source_line = self.text[line_start..].lines().next().unwrap_or_default();
        let last = end.min(line_start + source_line.len()).max(start);
        self.mistakes.push(Mistake {
            file: self.file.into(),
            line: 1 + self.text[..start].matches('\n').count(),
            column: 1 + self.text[line_start..start].chars().count(),
            source_line: source_line.to_owned(),
            width: self.text[start..last].chars().count().max(1),
            what,
            hint: hint.into(),
        });
    }

    /// Notes a number outside its range; `!(inside)` stops NaN too.
    fn check(&mut self, span: &Range<usize>, name: &str, value: f64, kind: Kind) {
        let (low, high, hint) = kind.range();
        if !(low..=high).contains(&value) {
            self.mistake(span, format!("{name} = {value} is out of range"), hint);
        }
    }

    /// The rules carry no places of their own: mistakes point to the section and name the key.
    fn check_application(&mut self, rules: &Application, section: &Range<usize>) {
        // The header alone: a section may be long.
        let header = section.start..section.start + 1;
        let header = &header;
        let mut numbers = vec![
            ("ugr_shr", rules.ugr_shr.value, Kind::Ratio),
            ("working_plane_m", rules.working_plane_m.value, Kind::Height),
            ("eye_height_seated_m", rules.eye_height_seated_m.value, Kind::Height),
            ("eye_height_standing_m", rules.eye_height_standing_m.value, Kind::Height),
            ("border_m", rules.border_m.value, Kind::Height),
        ];
        if let Some(surrounding) = &rules.surrounding {
            numbers.push(("surrounding.band_m", surrounding.band_m.value, Kind::Height));
            numbers.push(("surrounding.u0", surrounding.u0.value, Kind::Fraction));
            let steps = &surrounding.illuminance_lx.value;
            numbers.extend(
                steps.iter().flatten().map(|lx| ("surrounding.illuminance_lx", *lx, Kind::Illuminance)),
            );
            if !steps.windows(2).all(|pair| pair[0][0] > pair[1][0]) {
                self.mistake(
                    header,
                    "surrounding.illuminance_lx does not fall".into(),
                    "begin with the brightest task",
                );
            }
        }
        if let Some(background) = &rules.background {
            numbers.push(("background.width_m", background.width_m.value, Kind::Height));
            numbers.push(("background.fraction", background.fraction.value, Kind::Fraction));
            numbers.push(("background.u0", background.u0.value, Kind::Fraction));
        }
        for (name, u0) in [
            ("walls_u0", &rules.walls_u0),
            ("ceiling_u0", &rules.ceiling_u0),
            ("cylindrical_u0", &rules.cylindrical_u0),
        ] {
            numbers.extend(u0.iter().map(|fact| (name, fact.value, Kind::Fraction)));
        }
        numbers.extend(
            rules.surrounding_of_task.iter().map(|fact| ("surrounding_of_task", fact.value, Kind::Fraction)),
        );
        if let Some(scale) = &rules.illuminance_scale_lx {
            numbers.extend(scale.value.iter().map(|lx| ("illuminance_scale_lx", *lx, Kind::Illuminance)));
            if !scale.value.windows(2).all(|pair| pair[0] < pair[1]) {
                let what = "illuminance_scale_lx does not rise".into();
                self.mistake(header, what, "begin with the smallest step");
            }
        }
        for (name, value, kind) in numbers {
            self.check(header, name, value, kind);
        }
        for name in &rules.columns {
            if !COLUMNS.iter().any(|column| column.name == name) {
                self.mistake(header, format!("no column {name}"), &known_columns());
            }
        }
        for beyond in &rules.beyond {
            if Quantity::parse(&beyond.quantity).is_none() {
                let what = format!("unknown quantity {}", beyond.quantity);
                self.mistake(header, what, &format!("known are {}", SPELLINGS.join(", ")));
            }
        }
    }

    fn quantity(&mut self, text: &Spanned<String>) -> Quantity {
        Quantity::parse(text.get_ref()).unwrap_or_else(|| {
            let what = format!("unknown quantity {}", text.get_ref());
            self.mistake(&text.span(), what, &format!("known are {}", SPELLINGS.join(", ")));
            Quantity::Horizontal
        })
    }

    fn row(&mut self, text: RowText, rules: &Application) -> Row {
        let plane = text.plane.unwrap_or_default();
        let usual = match plane {
            Plane::Horizontal => Quantity::Horizontal,
            Plane::Vertical => Quantity::Normal,
        };
        let own = text.quantity.as_ref().map_or(usual, |quantity| self.quantity(quantity));
        let level = text.statistic.unwrap_or(rules.illuminance_statistic.value).statistic();
        let mut limits = Vec::new();
        let mut present = Vec::new();
        for column in &COLUMNS {
            let Some(value) = text.value(column.name) else { continue };
            let number = *value.get_ref();
            self.check(&value.span(), column.name, number, column.kind);
            let (zone, quantity, statistic) = column.limits(own, level);
            let verified = text.standing(column.name);
            limits.push(Limit { zone, quantity, statistic, bound: column.bound(number), verified });
            present.push(column.name);
        }
        let modified_lx = text.em_modified.as_ref().map(|value| {
            present.push("em_modified");
            self.check(&value.span(), "em_modified", *value.get_ref(), Kind::Illuminance);
            (*value.get_ref(), text.standing("em_modified"))
        });
        for column in text.two_sources.iter().chain(&text.one_source) {
            let name = column.get_ref();
            if !present.contains(&name.as_str()) {
                let what = format!("{name} is called verified, but the row has no such value");
                let hint = format!("the row has {}", present.join(", "));
                self.mistake(&column.span(), what, &hint);
            }
        }
        for column in &text.unregulated {
            let name = column.get_ref().as_str();
            if present.contains(&name) {
                let what = format!("{name} is called unregulated, but the row has a value");
                self.mistake(&column.span(), what, "leave out one of the two");
            } else if !COLUMNS.iter().any(|column| column.name == name) {
                self.mistake(&column.span(), format!("no column {name}"), &known_columns());
            }
        }
        let unknown = unknown(&text, rules, own, level);
        limits.extend(text.limit.iter().map(|limit| self.limit(limit)));
        if limits.is_empty() {
            let what = format!("the row {} limits nothing", text.reference.get_ref());
            let hint = "give it em, u0, ugr, ra or a limit";
            self.mistake(&text.reference.span(), what, hint);
        }
        if let Some(plane) = &text.plane_m {
            self.check(&plane.span(), "plane_m", *plane.get_ref(), Kind::Height);
        }
        if let Some(border) = &text.border_m {
            self.check(&border.span(), "border_m", *border.get_ref(), Kind::Height);
        }
        if let Some(intensity) = &text.intensity {
            self.check_intensity(&intensity.span(), intensity.get_ref());
        }
        Row {
            intensity: text.intensity.map(Spanned::into_inner),
            not_judged: text.not_judged,
            reference: text.reference.into_inner(),
            area: text.area,
            task: text.task,
            clause: text.clause,
            verified: limits.first().map_or(Verified::Unverified, |limit| limit.verified),
            limits,
            unknown,
            plane,
            plane_name: text.plane_name,
            posture: text.posture.unwrap_or_default(),
            modified_lx,
            plane_m: text.plane_m.map(Spanned::into_inner),
            border_m: text.border_m.map(Spanned::into_inner),
            part_of_room: text.part_of_room.unwrap_or(rules.part_of_room),
            note: text.note,
            sources: text.sources,
        }
    }

    fn check_intensity(&mut self, span: &Range<usize>, limit: &IntensityLimit) {
        let steps = &limit.by_height_cd;
        let rising = steps.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1]);
        let from_the_floor =
            steps.first().is_some_and(|[from_m, limit_cd]| from_m.abs() < f64::EPSILON && *limit_cd > 0.0);
        if !(rising && from_the_floor && steps.iter().flatten().all(|number| number.is_finite())) {
            let what = "by_height_cd does not rise from 0 m".into();
            self.mistake(span, what, "pairs [mounting height from in m, limit in cd], the first from 0");
        }
        if !(0.0 <= limit.from_deg && limit.from_deg < limit.to_deg && limit.to_deg <= 180.0) {
            let what = format!("no zone from {}° to {}°", limit.from_deg, limit.to_deg);
            self.mistake(span, what, "angles from straight down, between 0 and 180");
        }
    }

    fn limit(&mut self, text: &LimitText) -> Limit {
        let quantity = self.quantity(&text.quantity);
        let statistic = Statistic::parse(text.statistic.get_ref()).unwrap_or_else(|| {
            let what = format!("unknown statistic {}", text.statistic.get_ref());
            let known: Vec<&str> = Statistic::ALL.into_iter().map(Statistic::key).collect();
            self.mistake(&text.statistic.span(), what, &format!("known are {}", known.join(", ")));
            Statistic::Mean
        });
        let (value, bound) = match (&text.min, &text.max) {
            (Some(min), None) => (min, Bound::Min(*min.get_ref())),
            (None, Some(max)) => (max, Bound::Max(*max.get_ref())),
            (Some(_), Some(_)) | (None, None) => {
                self.mistake(
                    &text.quantity.span(),
                    "a limit needs either min or max".into(),
                    "write two limits for a range",
                );
                return Limit {
                    zone: text.zone,
                    quantity,
                    statistic,
                    bound: Bound::Min(0.0),
                    verified: text.verified,
                };
            }
        };
        let number = *value.get_ref();
        if !(number >= 0.0 && number.is_finite()) {
            self.mistake(
                &value.span(),
                format!("the limit {number} is out of range"),
                "limits are positive numbers",
            );
        }
        if matches!(statistic, Statistic::U0 | Statistic::Ud) {
            self.check(&value.span(), statistic.key(), number, Kind::Fraction);
        }
        Limit { zone: text.zone, quantity, statistic, bound, verified: text.verified }
    }
}

/// Columns that the norm has for all rows and this row neither fills nor calls unregulated.
fn unknown(text: &RowText, rules: &Application, own: Quantity, level: Statistic) -> Vec<Unknown> {
    let absent = |column: &&Column| {
        rules.columns.iter().any(|name| name == column.name)
            && text.value(column.name).is_none()
            && !text.unregulated.iter().any(|name| name.get_ref() == column.name)
    };
    let unknown = COLUMNS.iter().filter(absent).map(|column| {
        let (zone, quantity, statistic) = column.limits(own, level);
        Unknown { column: column.name.into(), zone, quantity, statistic }
    });
    unknown.collect()
}

fn known_columns() -> String {
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    format!("there is: {}", names.join(", "))
}

#[cfg(test)]
mod tests;
