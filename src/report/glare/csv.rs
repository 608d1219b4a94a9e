//! `glare --image --format csv`: a row for every image and index; no value is an empty cell. What makes an
//! index doubtful, and what is to be known of its image, stand in the last column.

use super::super::ReportError;
use super::Evaluated;
use super::gradient::{UNIT, figures_of};
use crate::glare::gradient::SCALE_DEG;

/// The table of all images.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn indices_csv(images: &[Evaluated]) -> Result<String, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["file", "index", "value", "unit", "reason", "convention", "notes"])?;
    for image in images {
        for reading in &image.glare.readings {
            let (value, reason) = match &reading.value {
                Ok(value) => (value.to_string(), ""),
                Err(undefined) => (String::new(), undefined.reason.as_str()),
            };
            let convention = image.glare.convention.as_str();
            let notes: Vec<&str> =
                reading.notes.iter().chain(&image.glare.notes).map(String::as_str).collect();
            let notes = notes.join("; ");
            let row = [image.file.as_str(), reading.key, &value, reading.unit, reason, convention, &notes];
            writer.write_record(row)?;
        }
        if let Some(found) = &image.gradient {
            let row = |name: &str, value: &str, reason: &str| {
                let index = format!("experimental gradient of lg L, {name}");
                [
                    image.file.clone(),
                    index,
                    value.into(),
                    UNIT.into(),
                    reason.into(),
                    format!("over {SCALE_DEG} deg"),
                    image.glare.notes.join("; "),
                ]
            };
            match found {
                Ok(found) => {
                    for (name, value) in figures_of(found) {
                        writer.write_record(row(name, &value.to_string(), ""))?;
                    }
                }
                Err(undefined) => writer.write_record(row("mean", "", &undefined.reason))?,
            }
        }
    }
    let bytes = writer.into_inner().expect("a vector takes any bytes");
    Ok(String::from_utf8(bytes).expect("only text was written"))
}
