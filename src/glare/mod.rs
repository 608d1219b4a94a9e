//! Glare indices as pure formulas. Nothing here knows a scene: a source arrives as luminance, solid
//! angle and position index, and every index is a `Result`, because no visible source means no
//! index, never 0.

// `!(x > 0.0)` is the guard that stops NaN too.
#![allow(clippy::neg_cmp_op_on_partial_ord)]

pub mod cgi;
pub mod detect;
pub mod dgi;
pub mod dgp;
pub mod discomfort;
pub mod field;
pub mod ggr;
pub mod gr;
pub mod gradient;
mod image_parts;
pub mod index;
pub mod luminances;
pub mod of_image;
pub mod position_index;
pub mod propagate;
pub mod source;
pub mod threshold_increment;
pub mod ugp;
pub mod ugr;
pub mod ugr_exp;
pub mod ugr_table;
pub mod vcp;
pub mod veiling;
pub mod wall_luminance;

/// A file of the reference data (`GERSHUN_DATA`, else `../shared/data` beside the crate). The data
/// is not part of the project; without it the test says so and ends.
#[cfg(test)]
pub(crate) fn reference_data(path: &str) -> Option<String> {
    let folder = std::env::var("GERSHUN_DATA")
        .unwrap_or_else(|_| format!("{}/../shared/data", env!("CARGO_MANIFEST_DIR")));
    let text = std::fs::read_to_string(format!("{folder}/{path}")).ok();
    if text.is_none() {
        println!("skipped: no reference data {path}");
    }
    text
}
