//! `glare --image --format csv`: a row for every image and index; no value is an empty cell.

use super::super::ReportError;
use super::Evaluated;

/// The table of all images.
///
/// # Errors
/// Where a value cannot be encoded.
pub fn indices_csv(images: &[Evaluated]) -> Result<String, ReportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["file", "index", "value", "unit", "reason", "convention"])?;
    for image in images {
        for reading in &image.glare.readings {
            let (value, reason) = match &reading.value {
                Ok(value) => (value.to_string(), ""),
                Err(undefined) => (String::new(), undefined.reason.as_str()),
            };
            let convention = image.glare.convention.as_str();
            let row = [image.file.as_str(), reading.key, value.as_str(), reading.unit, reason, convention];
            writer.write_record(row)?;
        }
    }
    let bytes = writer.into_inner().expect("a vector takes any bytes");
    Ok(String::from_utf8(bytes).expect("only text was written"))
}
