//! What `gershun lamp` prints: text for people, JSON, SARIF and CSV for machines.

mod convert;
mod far_field;
mod json;
mod lint;
mod opening;
mod polar;
mod text;
mod ugr;

pub use convert::dropped;
pub use far_field::{json as far_field_json, text as far_field_text};
pub use json::info as info_json;
pub use lint::{explanation, human as lint_human, json as lint_json, sarif as lint_sarif};
pub use polar::{diagram, polar};
pub use text::info_text;
pub use ugr::{csv as ugr_csv, text as ugr_text};

use super::words::Lang;
use crate::lamp::Lamp;
use crate::photometry::{Finding, Format, Lm63Version};

/// A file named on the command line: its luminaires, or why there are none.
#[derive(Clone, Debug)]
pub struct Batch {
    /// As named by the user.
    pub file: String,
    /// The luminaires, or one finding of severity error.
    pub read: Result<Vec<Lamp>, Finding>,
}

/// Name of a format with its edition.
fn format_name(format: Format) -> &'static str {
    match format {
        Format::Eulumdat => "EULUMDAT",
        Format::Tm33 => "TM-33",
        Format::Lm63 { version } => match version {
            Lm63Version::Y1986 => "LM-63-1986",
            Lm63Version::Y1991 => "LM-63-1991",
            Lm63Version::Y1995 => "LM-63-1995",
            Lm63Version::Y2002 => "LM-63-2002",
            Lm63Version::Y2019 => "LM-63-2019",
        },
    }
}

/// A number as it is, with the language's decimal sign.
fn decimal(lang: Lang, value: f64) -> String {
    match lang {
        Lang::En => value.to_string(),
        Lang::Ru => value.to_string().replace('.', ","),
    }
}
