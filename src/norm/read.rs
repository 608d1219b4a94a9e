//! TOML → [`Standard`]. The shape is checked by serde, the values here, with their place in the file.

use toml::Spanned;

use super::text::{Kind, LimitText, RowText, StandardText};
use super::{Application, Bound, Limit, Row, Standard, Verified, Zone};
use crate::quantity::{Quantity, SPELLINGS, Statistic};

/// All mistakes of a norm file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .mistakes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
pub struct NormError {
    /// At least one, in the order of their discovery.
    pub mistakes: Vec<Mistake>,
}

/// One mistake and its place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {what}; {hint}")]
pub struct Mistake {
    /// File as given to the parser.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub hint: String,
}

impl Kind {
    fn range(self) -> (f64, f64, &'static str) {
        match self {
            Self::Illuminance => (0.01, 200_000.0, "an illuminance lies between 0.01 and 200 000 lx"),
            Self::Fraction => (0.001, 1.0, "a uniformity or fraction lies between 0.001 and 1"),
            Self::Ugr => (5.0, 40.0, "UGR limits lie between 5 and 40"),
            Self::ColourRendering => (0.0, 100.0, "R_a lies between 0 and 100"),
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
            let offset = error.span().map_or(0, |span| span.start);
            let what = error.message().trim().replace('\n', ", ");
            reader.mistake(offset, what, "compare with a bundled standard, `norm show en-12464-1-2021`");
            return Err(NormError { mistakes: reader.mistakes });
        }
    };
    if parsed.id.get_ref().trim().is_empty() {
        reader.mistake(parsed.id.span().start, "the id is empty".into(), "give the standard a short name");
    }
    if parsed.row.is_empty() {
        reader.mistake(0, "the standard has no rows".into(), "add a [[row]] with ref and em");
    }
    let application = match parsed.application {
        Some(application) => {
            let offset = application.span().start;
            let application = application.into_inner();
            reader.check_application(&application, offset);
            application
        }
        None => Application::default(),
    };
    let mut rows: Vec<Row> = Vec::new();
    for row in parsed.row {
        if rows.iter().any(|earlier| earlier.reference == *row.reference.get_ref()) {
            let what = format!("the row {} is there twice", row.reference.get_ref());
            reader.mistake(row.reference.span().start, what, "references must differ");
        }
        rows.push(reader.row(row));
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
    fn mistake(&mut self, offset: usize, what: String, hint: &str) {
        let line = 1 + self.text.bytes().take(offset).filter(|byte| *byte == b'\n').count();
        self.mistakes.push(Mistake { file: self.file.into(), line, what, hint: hint.into() });
    }

    /// Notes a number outside its range; `!(inside)` stops NaN too.
    fn check(&mut self, offset: usize, name: &str, value: f64, kind: Kind) {
        let (low, high, hint) = kind.range();
        if !(low..=high).contains(&value) {
            self.mistake(offset, format!("{name} = {value} is out of range"), hint);
        }
    }

    /// The rules carry no places of their own: mistakes point to the section and name the key.
    fn check_application(&mut self, rules: &Application, offset: usize) {
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
                    offset,
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
        for (name, value, kind) in numbers {
            self.check(offset, name, value, kind);
        }
    }

    fn quantity(&mut self, text: &Spanned<String>) -> Quantity {
        Quantity::parse(text.get_ref()).unwrap_or_else(|| {
            let what = format!("unknown quantity {}", text.get_ref());
            self.mistake(text.span().start, what, &format!("known are {}", SPELLINGS.join(", ")));
            Quantity::Horizontal
        })
    }

    fn row(&mut self, text: RowText) -> Row {
        let own = text.quantity.as_ref();
        let own = own.map_or(Quantity::Horizontal, |quantity| self.quantity(quantity));
        let mut limits = Vec::new();
        let mut present = Vec::new();
        for column in text.filled(own) {
            let number = *column.value.get_ref();
            self.check(column.value.span().start, column.name, number, column.kind);
            let bound = match column.zone {
                Zone::Room => Bound::Max(number),
                _ => Bound::Min(number),
            };
            let verified = text.standing(column.name);
            let (zone, quantity, statistic) = (column.zone, column.quantity, column.statistic);
            limits.push(Limit { zone, quantity, statistic, bound, verified });
            present.push(column.name);
        }
        let modified_lx = text.em_modified.as_ref().map(|value| {
            present.push("em_modified");
            self.check(value.span().start, "em_modified", *value.get_ref(), Kind::Illuminance);
            (*value.get_ref(), text.standing("em_modified"))
        });
        for column in text.two_sources.iter().chain(&text.one_source) {
            let name = column.get_ref();
            if !present.contains(&name.as_str()) {
                let what = format!("{name} is called verified, but the row has no such value");
                let hint = format!("the row has {}", present.join(", "));
                self.mistake(column.span().start, what, &hint);
            }
        }
        limits.extend(text.limit.iter().map(|limit| self.limit(limit)));
        if limits.is_empty() {
            let what = format!("the row {} limits nothing", text.reference.get_ref());
            let hint = "give it em, u0, ugr, ra or a limit";
            self.mistake(text.reference.span().start, what, hint);
        }
        if let Some(plane) = &text.plane_m {
            self.check(plane.span().start, "plane_m", *plane.get_ref(), Kind::Height);
        }
        Row {
            reference: text.reference.into_inner(),
            area: text.area,
            task: text.task,
            verified: limits.first().map_or(Verified::Unverified, |limit| limit.verified),
            limits,
            modified_lx,
            plane_m: text.plane_m.map(Spanned::into_inner),
            note: text.note,
            sources: text.sources,
        }
    }

    fn limit(&mut self, text: &LimitText) -> Limit {
        let quantity = self.quantity(&text.quantity);
        let statistic = Statistic::parse(text.statistic.get_ref()).unwrap_or_else(|| {
            let what = format!("unknown statistic {}", text.statistic.get_ref());
            self.mistake(text.statistic.span().start, what, "known are mean, min, max, U0, Ud, value");
            Statistic::Mean
        });
        let (value, bound) = match (&text.min, &text.max) {
            (Some(min), None) => (min, Bound::Min(*min.get_ref())),
            (None, Some(max)) => (max, Bound::Max(*max.get_ref())),
            (Some(_), Some(_)) | (None, None) => {
                let offset = text.quantity.span().start;
                self.mistake(
                    offset,
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
                value.span().start,
                format!("the limit {number} is out of range"),
                "limits are positive numbers",
            );
        }
        if matches!(statistic, Statistic::U0 | Statistic::Ud) {
            self.check(value.span().start, statistic.key(), number, Kind::Fraction);
        }
        Limit { zone: text.zone, quantity, statistic, bound, verified: text.verified }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mistakes(text: &str) -> Vec<Mistake> {
        Standard::parse(text, "house.toml").unwrap_err().mistakes
    }

    #[test]
    fn a_wrong_key_or_type_is_named_with_its_line() {
        // Catches silently ignored misspellings, the worst a norm file can have.
        let found = mistakes("id = \"house\"\n[[row]]\nref = \"1\"\nemm = 300\n");
        assert_eq!(found[0].line, 4, "{found:?}");
        assert!(found[0].what.contains("emm") && found[0].what.contains("em_walls"), "{found:?}");
        let found = mistakes("id = \"house\"\n[[row]]\nref = \"1\"\nem = \"300 lx\"\n");
        assert_eq!(found[0].line, 4, "{found:?}");
        let found =
            mistakes("id = \"house\"\n[application]\nugr_shr = 0.25\n[[row]]\nref = \"1\"\nem = 300\n");
        assert_eq!(found[0].line, 3, "{found:?}");
        let found = mistakes(
            "id = \"house\"\n[application]\nugr_method = { value = \"guess\" }\n[[row]]\nref = \"1\"\nem = 3\n",
        );
        assert_eq!(found[0].line, 3, "{found:?}");
    }

    #[test]
    fn all_wrong_values_come_at_once() {
        let text = "id = \"house\"\n[[row]]\nref = \"1\"\nem = -300\nu0 = 1.4\n[[row]]\nref = \"1\"\nugr = nan\n\
                    one_source = [\"em\"]\n[[row]]\nref = \"3\"\n";
        let found = mistakes(text);
        let lines: Vec<usize> = found.iter().map(|mistake| mistake.line).collect();
        assert_eq!(lines, [4, 5, 7, 8, 9, 11], "{found:#?}");
        let error = Standard::parse(text, "house.toml").unwrap_err().to_string();
        assert!(error.starts_with("house.toml:4: em = -300 is out of range; an illuminance"), "{error}");
        assert!(mistakes("id = \"\"\n").len() == 2);
    }

    #[test]
    fn a_limit_may_be_a_maximum_or_on_another_statistic() {
        // A screen's 200 lx is a maximum; some norms limit the minimum, not the mean.
        let text = "id = \"house\"\n[[row]]\nref = \"17\"\n\
                    [[row.limit]]\nzone = \"task\"\nquantity = \"E_v@0\"\nstatistic = \"max\"\nmax = 200\n\
                    [[row.limit]]\nzone = \"task\"\nquantity = \"E_h\"\nstatistic = \"min\"\nmin = 300\nverified = \"one-source\"\n";
        let limits = Standard::parse(text, "house.toml").unwrap().rows[0].limits.clone();
        assert_eq!(limits[0].bound, Bound::Max(200.0));
        assert_eq!(limits[0].quantity, Quantity::Vertical { azimuth_deg: 0.0 });
        assert_eq!((limits[1].statistic, limits[1].verified), (Statistic::Min, Verified::OneSource));
        let both = text.replace("max = 200", "max = 200\nmin = 100").replace("\"min\"", "\"least\"");
        assert_eq!(mistakes(&both).iter().map(|mistake| mistake.line).collect::<Vec<_>>(), [6, 13]);
    }
}
