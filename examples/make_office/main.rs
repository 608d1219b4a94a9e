//! Writes the geometry and the photometric files of `scenes/office`; run from the crate's root.

pub(crate) mod check;
mod furniture;
pub(crate) mod glb;
mod lm63;
pub(crate) mod photometry;
mod quadrant;
pub(crate) mod room;
mod solid;

use std::path::Path;

/// A file of the scene.
pub struct Made {
    /// Its name within `scenes/office`.
    pub name: &'static str,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// The office after all checks, with its number of triangles.
///
/// # Panics
/// If the office is not built soundly: see [`check::faults`], [`check_flux`] and [`check_luminances`].
pub fn make() -> (usize, [Made; 3]) {
    let office = room::office();
    let faults = check::faults(&office);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let (panel, louvre) = (photometry::panel_ldt(), photometry::louvre_ies());
    check_flux(&panel, photometry::PANEL_LM);
    check_flux(&louvre, photometry::LOUVRE_LM);
    check_luminances();
    let files = [
        ("office.glb", glb::write(&office)),
        ("panel.ldt", panel.into_bytes()),
        ("louvre.ies", louvre.into_bytes()),
    ];
    let made = files.map(|(name, bytes)| Made { name, bytes });
    (office.triangles().len(), made)
}

/// Rated and integrated flux differ by less than 0.1 %.
fn check_flux(text: &str, rated_lm: f64) {
    let flux_lm = photometry::flux_of(text);
    assert!((flux_lm / rated_lm - 1.0).abs() < 1e-3, "{flux_lm} lm integrated, {rated_lm} lm rated");
}

/// Beyond 65° the panel stays below 3000 cd/m² and the louvre luminaire below 200 cd/m².
fn check_luminances() {
    let klm = photometry::PANEL_LM / 1000.0;
    let panel_m2 = photometry::PANEL_M * photometry::PANEL_M;
    let panel_nits = klm * photometry::panel().luminance_beyond_65(panel_m2);
    assert!(panel_nits < 3000.0, "panel: {panel_nits} cd/m²");
    let [length_m, width_m] = photometry::LOUVRE_M;
    let louvre_nits = photometry::louvre().luminance_beyond_65(length_m * width_m);
    assert!(louvre_nits < 200.0, "louvre: {louvre_nits} cd/m²");
}

#[expect(clippy::print_stdout, reason = "a generator says what it wrote")]
fn main() -> std::io::Result<()> {
    let folder = Path::new("scenes/office");
    let (triangles, files) = make();
    println!("{triangles} triangles");
    for file in files {
        std::fs::write(folder.join(file.name), &file.bytes)?;
        println!("{}: {} bytes", folder.join(file.name).display(), file.bytes.len());
    }
    Ok(())
}
