//! Where our UGR tables differ from those that DIALux and Relux print, cell by cell. Needs the reference
//! data (`GERSHUN_DATA`, else ../shared/data). Writes a page and a list to reports/ugr-tables:
//!
//!     cargo run --release --example ugr_tables
#![allow(clippy::print_stdout, reason = "a study prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use gershun::glare::ugr_table::UgrTable;
use gershun::lamp::{read, ugr::ugr_table};

const SAMPLES: [&str; 6] = ["01", "02", "03", "04", "05", "11"];
/// The spacing-to-height ratio with which catalogues are made.
const SHR: f64 = 0.25;
/// What counts as an outlier, UGR.
const LIMIT: f64 = 0.5;

/// One cell: ours, and ours minus each program's.
struct Cell {
    place: (usize, usize),
    sample: &'static str,
    room: (f64, f64),
    sight: &'static str,
    reflectances: [f64; 3],
    ours: f64,
    dialux: f64,
    relux: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let data =
        std::env::var_os("GERSHUN_DATA").map_or_else(|| PathBuf::from("../shared/data"), PathBuf::from);
    let folder = data.join("ugr_tables");
    let mut cells = Vec::new();
    for sample in SAMPLES {
        let name = format!("ugr_sample_{sample}.ldt");
        let lamps = read(&std::fs::read(folder.join(&name))?, &name)?;
        let lamp = lamps.first().ok_or("a container without luminaires")?;
        let table = ugr_table(&lamp.photometry, SHR).map_err(|undefined| undefined.to_string())?;
        let [dialux, relux] = ["Dialux", "Relux"].map(|program| published(&folder, sample, program));
        cells.extend(compared(sample, &table, &dialux?, &relux?));
    }
    let out = Path::new("reports/ugr-tables");
    std::fs::create_dir_all(out)?;
    let outliers: Vec<&Cell> = cells.iter().filter(|cell| cell.dialux.abs() > LIMIT).collect();
    std::fs::write(out.join("outliers.csv"), list(&outliers))?;
    let page = page(&cells, &outliers);
    std::fs::write(out.join("README.md"), &page)?;
    println!("{page}");
    Ok(())
}

/// Rows rooms, ten columns; `None` where the program prints no number.
fn published(folder: &Path, sample: &str, program: &str) -> Result<Vec<Vec<Option<f64>>>, std::io::Error> {
    let text = std::fs::read_to_string(folder.join(format!("ugr_table_{sample}_{program}.csv")))?;
    Ok(text.lines().map(|line| line.trim().split(',').map(|cell| cell.parse().ok()).collect()).collect())
}

fn compared(
    sample: &'static str,
    table: &UgrTable,
    dialux: &[Vec<Option<f64>>],
    relux: &[Vec<Option<f64>>],
) -> Vec<Cell> {
    let mut cells = Vec::new();
    let at = |rows: &[Vec<Option<f64>>], room: usize, column: usize| *rows.get(room)?.get(column)?;
    for (index, room) in table.rooms.iter().enumerate() {
        for column in 0..10 {
            let row = if column < 5 { &table.crosswise[index] } else { &table.endwise[index] };
            let theirs = (at(dialux, index, column), at(relux, index, column));
            let (Ok(ours), (Some(dialux), Some(relux))) = (row[column % 5].clone(), theirs) else { continue };
            cells.push(Cell {
                place: (index, column % 5),
                sample,
                room: *room,
                sight: if column < 5 { "crosswise" } else { "endwise" },
                reflectances: table.reflectances[column % 5],
                ours,
                dialux: ours - dialux,
                relux: ours - relux,
            });
        }
    }
    cells
}

fn list(outliers: &[&Cell]) -> String {
    let mut text =
        "sample,x_h,y_h,sight,ceiling,walls,floor,ours,ours_minus_dialux,ours_minus_relux\n".to_owned();
    for cell in outliers {
        let Cell {
            place: _,
            sample,
            room: (x, y),
            sight,
            reflectances: [ceiling, walls, floor],
            ours,
            dialux,
            relux,
        } = cell;
        let _ = writeln!(
            text,
            "{sample},{x},{y},{sight},{ceiling},{walls},{floor},{ours:.2},{dialux:+.2},{relux:+.2}"
        );
    }
    text
}

fn page(cells: &[Cell], outliers: &[&Cell]) -> String {
    let mut text = format!(
        "# UGR tables against DIALux and Relux\n\n{} cells of six luminaires, spacing to height {SHR}; differences are ours \
         minus theirs, UGR.\nMade by `cargo run --release --example ugr_tables` (needs the reference data).\n\n\
         | luminaire | cells | DIALux: mean | worst | beyond {LIMIT} | Relux: mean | worst |\n|---|---|---|---|---|---|---|\n",
        cells.len()
    );
    for sample in SAMPLES {
        let own: Vec<&Cell> = cells.iter().filter(|cell| cell.sample == sample).collect();
        let mean = |of: fn(&Cell) -> f64| own.iter().map(|cell| of(cell)).sum::<f64>() / own.len() as f64;
        let worst = |of: fn(&Cell) -> f64| own.iter().map(|cell| of(cell).abs()).fold(0.0, f64::max);
        let beyond = own.iter().filter(|cell| cell.dialux.abs() > LIMIT).count();
        let _ = writeln!(
            text,
            "| {sample} | {} | {:+.2} | {:.2} | {beyond} | {:+.2} | {:.2} |",
            own.len(),
            mean(|cell| cell.dialux),
            worst(|cell| cell.dialux),
            mean(|cell| cell.relux),
            worst(|cell| cell.relux)
        );
    }
    let agree = outliers.iter().filter(|cell| cell.relux.abs() <= 0.3).count();
    let small = outliers.iter().filter(|cell| cell.room.0.min(cell.room.1) <= 4.0).count();
    let dark = outliers.iter().filter(|cell| cell.reflectances[1] <= 0.3).count();
    let high = outliers.iter().filter(|cell| cell.dialux > 0.0).count();
    let paired = outliers
        .iter()
        .filter(|cell| {
            let twin = |other: &&&Cell| {
                other.sample == cell.sample && other.place == cell.place && other.sight != cell.sight
            };
            outliers.iter().any(|other| twin(&other))
        })
        .count();
    let _ = write!(
        text,
        "\nOf the {} cells that differ from DIALux by more than {LIMIT}, Relux agrees with ours within 0.3 in {agree}; ours \
         are higher in {high}; {small} are rooms whose shorter side is at most 4H, {dark} have walls of 30 % or less, and in \
         {paired} both lines of sight of the room are off. A difference that does not depend on the line of sight cannot \
         come from the luminaires that are seen: it points to another background luminance. Each cell stands in \
         outliers.csv.\n",
        outliers.len()
    );
    text
}
