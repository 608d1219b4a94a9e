//! UGR tables: for people with one decimal, as CSV at full precision. Columns are the reflectance
//! sets, crosswise first, then endwise; a cell without a value is empty and its reason is printed.

use std::collections::BTreeSet;

use super::super::ReportError;
use super::super::number::fixed;
use super::super::words::{Lang, found, lamp_word};
use super::super::xml::{printable, put};
use super::decimal;
use crate::glare::ugr_table::UgrTable;

/// The table of one luminaire.
pub fn text(file: &str, flux_lm: f64, table: &UgrTable, lang: Lang) -> String {
    let say = |english: &'static str| lamp_word(lang, english);
    let mut text = format!(
        "{}\n  {} {} {}, {} {}\n",
        printable(file),
        say("UGR by CIE 117 and CIE 190, for the file's"),
        fixed(lang, flux_lm, 0),
        say("lm"),
        say("spacing to height"),
        decimal(lang, table.shr)
    );
    let sets =
        |k: usize| table.reflectances.map(|set| format!("{:>6}", format!("{:.0}", 100.0 * set[k]))).concat();
    for (k, surface) in [say("ceiling"), say("walls"), say("floor")].iter().enumerate() {
        put(&mut text, format_args!("  {surface:<10}{}  {}\n", sets(k), sets(k)));
    }
    put(&mut text, format_args!("  {:<10}{:>30}  {:>30}\n", "X × Y", say("crosswise"), say("endwise")));
    let mut reasons = BTreeSet::new();
    for (room, (x, y)) in table.rooms.iter().enumerate() {
        let mut cells = |row: &[Result<f64, _>; 5]| {
            let mut cell = |value: &Result<f64, crate::units::Undefined>| match value {
                Ok(ugr) => format!("{:>6}", fixed(lang, *ugr, 1)),
                Err(undefined) => {
                    reasons.insert(undefined.reason.clone());
                    format!("{:>6}", "—")
                }
            };
            row.iter().map(&mut cell).collect::<String>()
        };
        let (crosswise, endwise) = (cells(&table.crosswise[room]), cells(&table.endwise[room]));
        put(&mut text, format_args!("  {:<10}{crosswise}  {endwise}\n", format!("{x}H × {y}H")));
    }
    for reason in reasons {
        put(&mut text, format_args!("  — {}\n", found(lang, &reason)));
    }
    text
}

/// Rows rooms, columns reflectance sets crosswise then endwise; a leading column `file` where `many`
/// luminaires were named, whatever became of them.
///
/// # Errors
/// Where a table cannot be encoded.
pub fn csv(tables: &[(String, UgrTable)], many: bool) -> Result<String, ReportError> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let Some((_, first)) = tables.first() else {
        return Ok(String::new());
    };
    let set = |sight: &str, set: &[f64; 3]| {
        format!("{sight}_{}", set.map(|rho| format!("{:.0}", 100.0 * rho)).join("_"))
    };
    let mut header: Vec<String> = many.then(|| "file".to_owned()).into_iter().collect();
    header.extend(["x_h".to_owned(), "y_h".to_owned()]);
    for sight in ["crosswise", "endwise"] {
        header.extend(first.reflectances.iter().map(|reflectances| set(sight, reflectances)));
    }
    writer.write_record(&header)?;
    for (file, table) in tables {
        for (room, (x, y)) in table.rooms.iter().enumerate() {
            let mut record: Vec<String> = many.then(|| file.clone()).into_iter().collect();
            record.extend([x.to_string(), y.to_string()]);
            for value in table.crosswise[room].iter().chain(&table.endwise[room]) {
                record.push(value.as_ref().map_or(String::new(), f64::to_string));
            }
            writer.write_record(&record)?;
        }
    }
    let bytes = writer.into_inner().map_err(|error| ::csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
