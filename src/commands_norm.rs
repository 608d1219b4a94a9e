//! Runs `gershun norm …`.

use gershun::norm::{self, Standard, bundled};

use crate::{BAD_INPUT, complain, remark, say};

/// Runs `norm list`.
pub fn list() -> u8 {
    let mut text = String::new();
    for (id, source) in bundled() {
        match Standard::parse(source, id) {
            Ok(standard) => {
                text.push_str(&format!(
                    "{id}  {}  {} ({} rows)\n",
                    standard.short,
                    standard.title,
                    standard.rows.len()
                ));
            }
            Err(error) => return complain(&error.to_string()),
        }
    }
    say(&text)
}

/// A bundled norm, or a file; mistakes are told and become an exit code.
fn read_norm(name: &str) -> Result<Standard, u8> {
    let text = match bundled().iter().find(|(id, _)| *id == name) {
        Some((_, text)) => (*text).to_owned(),
        None => std::fs::read_to_string(name).map_err(|error| {
            complain(&format!(
                "\"{name}\" is neither a bundled norm (see `gershun norm list`) nor a file: {error}"
            ))
        })?,
    };
    Standard::parse(&text, name).map_err(|error| {
        remark(&error.to_string());
        BAD_INPUT
    })
}

fn row_of<'a>(standard: &'a Standard, name: &str, row: &str) -> Result<&'a norm::Row, u8> {
    standard.row(row).ok_or_else(|| {
        let known = standard.rows.iter().map(|row| row.reference.as_str());
        let hint = gershun::project::suggestion(row, known);
        complain(&format!("{name} has no row \"{row}\"; {hint} (`gershun norm show {name}` lists them)"))
    })
}

/// Runs `norm show`.
pub fn show(name: &str, row: Option<&str>) -> u8 {
    let standard = match read_norm(name) {
        Ok(standard) => standard,
        Err(code) => return code,
    };
    let rows = match row {
        None => standard.rows.iter().collect(),
        Some(row) => match row_of(&standard, name, row) {
            Ok(row) => vec![row],
            Err(code) => return code,
        },
    };
    let mut text = standard.head();
    for entry in rows {
        text.push_str(format!("\n{}  {}", entry.reference, entry.called()).trim_end());
        text.push('\n');
        let limits = if row.is_some() { standard.requirements(entry) } else { entry.limits.clone() };
        for limit in limits {
            let statistic = limit.statistic.key();
            let line =
                norm::limit_line(limit.zone, limit.quantity, statistic, limit.bound, limit.verified.key());
            text.push_str(&format!("    {line}\n"));
        }
        for unknown in &entry.unknown {
            let quantity = format!("{} {}", unknown.quantity.key(), unknown.statistic.key());
            text.push_str(&format!("    {:<12} {quantity:<16} unknown   not assessed\n", unknown.zone.key()));
        }
    }
    say(&text)
}

/// Runs `norm explain`.
pub fn explain(name: &str, row: Option<&str>) -> u8 {
    let standard = match read_norm(name) {
        Ok(standard) => standard,
        Err(code) => return code,
    };
    match row.map(|row| row_of(&standard, name, row)) {
        None => say(&norm::explain(&standard)),
        Some(Ok(row)) => say(&norm::explain_row(&standard, row)),
        Some(Err(code)) => code,
    }
}
