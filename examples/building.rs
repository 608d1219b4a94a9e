//! A building of many rooms as one project: how long does a whole floor plan take? Writes a folder
//! with a project.toml (rooms 3–8 × 3–6 m, footprints without CAD, panels in a field sized for 500 lx
//! by the lumen method, the norm's own areas), to be checked like any other:
//!
//!     cargo run --release --example building [FOLDER [ROOMS]]
//!     cargo run --release -- check out/building
#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Flux of one panel, lm.
const PANEL_LM: f64 = 4000.0;
/// Maintained illuminance aimed at, lx, with room for the surroundings' share.
const AIM_LX: f64 = 620.0;
/// Utilisation and maintenance assumed by the lumen method.
const UTILISATION: f64 = 0.62;
const MAINTENANCE: f64 = 0.8;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out/building".into()));
    let rooms: usize = std::env::args().nth(2).map_or(Ok(100), |text| text.parse())?;
    let file = folder.join("project.toml");
    if file.exists() {
        return Err(format!("{} exists already", file.display()).into());
    }
    std::fs::create_dir_all(&folder)?;
    std::fs::write(&file, building(rooms)?)?;
    println!("{rooms} rooms written to {}", file.display());
    Ok(())
}

/// The project: rooms in rows of ten, 10 m apart.
fn building(rooms: usize) -> Result<String, std::fmt::Error> {
    let mut text = format!(
        "[project]\nname = \"Building\"\n\n\
         [luminaires.P]\nlambert = {{ flux = {PANEL_LM} }}\narea = {{ rect = [0.6, 0.6] }}\n\
         maintenance = {MAINTENANCE}\n\n[declared]\nP = {{ ra = 90 }}\n\n\
         [norm]\nstandard = \"en-12464-1-2021\"\nrow = \"34.2\"\n"
    );
    for index in 0..rooms {
        let (x, y) = (10.0 * (index % 10) as f64, 10.0 * (index / 10) as f64);
        let (length_m, width_m) = (3.0 + 0.5 * (index % 11) as f64, 3.0 + 0.5 * (index % 7) as f64);
        let panels = AIM_LX * length_m * width_m / (PANEL_LM * UTILISATION * MAINTENANCE);
        let rows = (panels * width_m / length_m).sqrt().round().max(1.0);
        let columns = (panels / rows).ceil();
        let (right, top) = (x + length_m, y + width_m);
        write!(
            text,
            "\n[[room]]\nname = \"R{index:03}\"\nnumber = \"{}.{:02}\"\n\
             footprint = [[{x}, {y}], [{right}, {y}], [{right}, {top}], [{x}, {top}]]\nheight = 2.8\n\
             reflectances = {{ floor = 0.2, walls = 0.5, ceiling = 0.7 }}\n\n\
             [[place]]\nluminaire = \"P\"\n\
             field = {{ room = \"R{index:03}\", rows = {rows}, columns = {columns}, height = 2.8 }}\n",
            index / 10 + 1,
            index % 10 + 1,
        )?;
    }
    Ok(text)
}
