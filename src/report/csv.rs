//! Tables for machines: UTF-8, full precision, units in the headers. `{}` of an `f64` reads back
//! to the same bits; a value that does not exist is an empty cell.

use super::ReportError;
use super::sentence::{bound, verdict_key};
use crate::outcome::{AreaOutcome, Interval, Outcome, RoomOutcome};
use crate::quantity::Quantity;

/// Separator and decimal sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// Comma and point.
    Standard,
    /// Semicolon and decimal comma, as spreadsheets with Russian or German settings read them.
    Excel,
}

/// File names and contents of all tables that have rows.
pub(super) fn tables(outcome: &Outcome, dialect: Dialect) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let all = [
        ("check.csv", check(outcome, dialect)?),
        ("points.csv", points(outcome, dialect)?),
        ("viewpoints.csv", viewpoints(outcome, dialect)?),
        ("glare_sources.csv", glare_sources(outcome, dialect)?),
        ("flux.csv", flux(outcome, dialect)?),
    ];
    Ok(all
        .into_iter()
        .filter(|(_, table)| table.rows > 0)
        .map(|(name, table)| (name.to_owned(), table.bytes))
        .collect())
}

struct Written {
    bytes: Vec<u8>,
    rows: usize,
}

struct Table {
    writer: csv::Writer<Vec<u8>>,
    dialect: Dialect,
    rows: usize,
}

impl Table {
    fn new(dialect: Dialect, header: &[&str]) -> Result<Self, ReportError> {
        let delimiter = match dialect {
            Dialect::Standard => b',',
            Dialect::Excel => b';',
        };
        let mut start = Vec::new();
        if dialect == Dialect::Excel {
            start.extend_from_slice("\u{feff}".as_bytes());
        }
        let mut writer = csv::WriterBuilder::new().delimiter(delimiter).from_writer(start);
        writer.write_record(header)?;
        Ok(Self { writer, dialect, rows: 0 })
    }

    fn row(&mut self, cells: &[Cell]) -> Result<(), ReportError> {
        let dialect = self.dialect;
        self.writer.write_record(cells.iter().map(|cell| cell.text(dialect)))?;
        self.rows += 1;
        Ok(())
    }

    fn finish(self) -> Result<Written, ReportError> {
        let bytes = self.writer.into_inner().map_err(|error| ReportError::Csv(error.into_error().into()))?;
        Ok(Written { bytes, rows: self.rows })
    }
}

enum Cell<'a> {
    Text(&'a str),
    Count(usize),
    Number(f64),
    Empty,
}

impl Cell<'_> {
    fn text(&self, dialect: Dialect) -> String {
        match self {
            Self::Text(text) => (*text).to_owned(),
            Self::Count(count) => count.to_string(),
            Self::Number(number) if !number.is_finite() => String::new(),
            Self::Number(number) => match dialect {
                Dialect::Standard => number.to_string(),
                Dialect::Excel => number.to_string().replace('.', ","),
            },
            Self::Empty => String::new(),
        }
    }

    fn optional(number: Option<f64>) -> Self {
        number.map_or(Self::Empty, Self::Number)
    }
}

fn interval(interval: Interval) -> [Cell<'static>; 4] {
    [interval.value, interval.se, interval.lo, interval.hi].map(Cell::Number)
}

fn check(outcome: &Outcome, dialect: Dialect) -> Result<Written, ReportError> {
    let header = "standard,clause,room,subject,light_scene,quantity,statistic,bound,limit,unit,value,lo_joint,hi_joint,margin,outcome,at_the_limit,other_comparison,verified,undefined,note";
    let mut table = Table::new(dialect, &header.split(',').collect::<Vec<_>>())?;
    for r in &outcome.requirements {
        let (limit, is_minimum) = bound(r.bound);
        let (value, lo, hi, undefined) = match &r.value {
            Ok(value) => (Cell::Number(*value), Cell::Number(r.lo_joint), Cell::Number(r.hi_joint), ""),
            Err(undefined) => (Cell::Empty, Cell::Empty, Cell::Empty, undefined.reason.as_str()),
        };
        table.row(&[
            Cell::Text(&r.standard),
            Cell::Text(&r.clause),
            Cell::Text(&r.room),
            Cell::Text(&r.subject),
            Cell::Text(&r.light_scene),
            Cell::Text(&r.quantity.key()),
            Cell::Text(r.statistic.key()),
            Cell::Text(if is_minimum { "min" } else { "max" }),
            Cell::Number(limit),
            Cell::Text(super::json::unit(r.quantity, r.statistic)),
            value,
            lo,
            hi,
            Cell::optional(r.margin),
            Cell::Text(verdict_key(r.verdict)),
            Cell::Text(if r.at_the_limit { "yes" } else { "no" }),
            Cell::Text(r.other_comparison.map_or("", verdict_key)),
            Cell::Text(&r.verified),
            Cell::Text(undefined),
            Cell::Text(&r.note),
        ])?;
    }
    table.finish()
}

fn points(outcome: &Outcome, dialect: Dialect) -> Result<Written, ReportError> {
    let header =
        "area,light_scene,i,row,column,x_m,y_m,z_m,quantity,unit,value,se,lo,hi,direct,indirect,n,room";
    let mut table = Table::new(dialect, &header.split(',').collect::<Vec<_>>())?;
    for room in &outcome.rooms {
        for area in &room.areas {
            area_points(&mut table, room, area)?;
        }
    }
    table.finish()
}

fn area_points(table: &mut Table, room: &RoomOutcome, area: &AreaOutcome) -> Result<(), ReportError> {
    for field in &area.fields {
        let key = field.quantity.key();
        for (index, (place, point)) in area.grid.points.iter().zip(&field.points).enumerate() {
            let Some(point) = point else { continue };
            table.row(&[
                Cell::Text(&area.name),
                Cell::Text(&field.light_scene),
                Cell::Count(index),
                Cell::Count(place.row),
                Cell::Count(place.column),
                Cell::Number(place.position.x),
                Cell::Number(place.position.y),
                Cell::Number(place.position.z),
                Cell::Text(&key),
                Cell::Text(field.quantity.unit()),
                Cell::Number(point.value),
                Cell::Number(point.se),
                Cell::Number(point.lo),
                Cell::Number(point.hi),
                Cell::Number(point.direct),
                Cell::Number(point.indirect),
                Cell::Count(field.n),
                Cell::Text(&room.name),
            ])?;
        }
    }
    Ok(())
}

fn viewpoints(outcome: &Outcome, dialect: Dialect) -> Result<Written, ReportError> {
    let header = "viewpoint,light_scene,azimuth_deg,tilt_deg,index,convention,value,se,lo,hi,L_b_cd_m2,E_v_lx,room,undefined,unit";
    let mut table = Table::new(dialect, &header.split(',').collect::<Vec<_>>())?;
    for room in &outcome.rooms {
        for kind in &room.ugr_table {
            for (sight, ugr) in [("crosswise", &kind.crosswise), ("endwise", &kind.endwise)] {
                let (value, undefined) = match ugr {
                    Ok(ugr) => (Cell::Number(*ugr), ""),
                    Err(undefined) => (Cell::Empty, undefined.reason.as_str()),
                };
                let mut cells = [const { Cell::Empty }; 15];
                let (name, method) =
                    (format!("{}, {sight}", kind.kind), format!("table method CIE 190, SHR {}", kind.shr));
                cells[0] = Cell::Text(&name);
                cells[4] = Cell::Text("UGR_table");
                cells[5] = Cell::Text(&method);
                cells[6] = value;
                cells[12] = Cell::Text(&room.name);
                cells[13] = Cell::Text(undefined);
                cells[14] = Cell::Text("1");
                table.row(&cells)?;
            }
        }
        for view in &room.viewpoints {
            let ([value, se, lo, hi], undefined) = match &view.ugr {
                Ok(ugr) => (interval(*ugr), ""),
                Err(undefined) => ([const { Cell::Empty }; 4], undefined.reason.as_str()),
            };
            table.row(&[
                Cell::Text(&view.name),
                Cell::Text(&view.light_scene),
                Cell::Number(view.azimuth_deg),
                Cell::Number(view.tilt_deg),
                Cell::Text(&Quantity::Ugr.key()),
                Cell::Text(&view.convention),
                value,
                se,
                lo,
                hi,
                Cell::Number(view.background_cd_m2),
                Cell::Number(view.e_v_lx),
                Cell::Text(&room.name),
                Cell::Text(undefined),
                Cell::Text("1"),
            ])?;
            for index in &view.indices {
                let ([value, se, lo, hi], undefined) = match &index.estimate {
                    Ok(estimate) => (interval(*estimate), ""),
                    Err(undefined) => ([const { Cell::Empty }; 4], undefined.reason.as_str()),
                };
                table.row(&[
                    Cell::Text(&view.name),
                    Cell::Text(&view.light_scene),
                    Cell::Number(view.azimuth_deg),
                    Cell::Number(view.tilt_deg),
                    Cell::Text(&index.key),
                    Cell::Text(&view.convention),
                    value,
                    se,
                    lo,
                    hi,
                    Cell::Number(view.background_cd_m2),
                    Cell::Number(view.e_v_lx),
                    Cell::Text(&room.name),
                    Cell::Text(undefined),
                    Cell::Text(&index.unit),
                ])?;
            }
        }
    }
    table.finish()
}

fn glare_sources(outcome: &Outcome, dialect: Dialect) -> Result<Written, ReportError> {
    let header = "viewpoint,light_scene,azimuth_deg,tilt_deg,source,luminance_cd_m2,solid_angle_sr,position_index,visible_fraction,share,room";
    let mut table = Table::new(dialect, &header.split(',').collect::<Vec<_>>())?;
    for room in &outcome.rooms {
        for view in &room.viewpoints {
            for source in &view.sources {
                table.row(&[
                    Cell::Text(&view.name),
                    Cell::Text(&view.light_scene),
                    Cell::Number(view.azimuth_deg),
                    Cell::Number(view.tilt_deg),
                    Cell::Text(&source.label),
                    Cell::Number(source.luminance_cd_m2),
                    Cell::Number(source.solid_angle_sr),
                    Cell::Number(source.position_index),
                    Cell::Number(source.visible_fraction),
                    Cell::Number(source.share),
                    Cell::Text(&room.name),
                ])?;
            }
        }
    }
    table.finish()
}

fn flux(outcome: &Outcome, dialect: Dialect) -> Result<Written, ReportError> {
    let header = "room,light_scene,surface,area_m2,incident_lm,incident_se_lm,incident_lo_lm,incident_hi_lm,leaving_lm,leaving_se_lm,leaving_lo_lm,leaving_hi_lm";
    let mut table = Table::new(dialect, &header.split(',').collect::<Vec<_>>())?;
    for room in &outcome.rooms {
        for balance in &room.flux {
            for surface in &balance.surfaces {
                let mut cells = vec![
                    Cell::Text(&room.name),
                    Cell::Text(&balance.light_scene),
                    Cell::Text(&surface.surface),
                    Cell::Number(surface.area_m2),
                ];
                cells.extend(interval(surface.incident));
                cells.extend(interval(surface.leaving));
                table.row(&cells)?;
            }
        }
    }
    table.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    fn read(bytes: &[u8], delimiter: u8) -> (csv::StringRecord, Vec<csv::StringRecord>) {
        let mut reader = csv::ReaderBuilder::new().delimiter(delimiter).from_reader(bytes);
        let header = reader.headers().expect("header").clone();
        (header, reader.records().map(|record| record.expect("record")).collect())
    }

    fn file(name: &str, dialect: Dialect) -> Vec<u8> {
        let tables = tables(&sample::outcome(), dialect).expect("tables");
        tables.into_iter().find(|(n, _)| n == name).expect("present").1
    }

    #[test]
    fn points_read_back_to_the_same_bits_in_both_dialects() {
        let outcome = sample::outcome();
        let expected: Vec<f64> = outcome
            .rooms
            .iter()
            .flat_map(|room| &room.areas)
            .flat_map(|area| &area.fields)
            .flat_map(|field| field.points.iter().flatten())
            .map(|point| point.value)
            .collect();
        for (dialect, delimiter, sign) in [(Dialect::Standard, b',', '.'), (Dialect::Excel, b';', ',')] {
            let (header, rows) = read(&file("points.csv", dialect), delimiter);
            let column = header.iter().position(|h| h == "value").expect("value");
            let found: Vec<f64> =
                rows.iter().map(|row| row[column].replace(sign, ".").parse().expect("number")).collect();
            assert_eq!(found.len(), expected.len());
            assert!(found.iter().zip(&expected).all(|(a, b)| a.to_bits() == b.to_bits()));
        }
    }

    #[test]
    fn names_with_quotes_and_separators_survive() {
        let (_, rows) = read(&file("check.csv", Dialect::Standard), b',');
        assert!(rows.iter().any(|row| &row[3] == sample::NASTY));
        assert_eq!(rows.len(), sample::outcome().requirements.len());
    }

    #[test]
    fn an_undefined_value_is_an_empty_cell_with_its_reason() {
        let (header, rows) = read(&file("viewpoints.csv", Dialect::Standard), b',');
        let column = |name: &str| header.iter().position(|h| h == name).expect("column");
        let row = rows.iter().find(|row| row[column("value")].is_empty()).expect("one is undefined");
        assert!(!row[column("undefined")].is_empty());
    }
}
