//! What `gershun glare --image` prints and draws: text for people, JSON and CSV for machines, and a
//! check picture in which every source can be found again.

mod card;
mod check;
mod csv;
mod gradient;
mod json;
mod map;
mod observed;
mod observed_files;
mod png;
mod text;

pub use card::{card_svg, picture_svg, remedies};
pub use check::{check_png, check_svg};
pub use csv::indices_csv;
pub use json::images_json;
pub use map::{map_csv, map_svg, map_text};
pub use observed::{compared_text, observed_text, tables_text};
pub use observed_files::{observed_csv, observed_json};
pub use text::images_text;

use crate::glare::gradient::Gradient;
use crate::glare::of_image::ImageGlare;
use crate::units::Undefined;

/// Glare of one image file.
#[derive(Clone, Debug)]
pub struct Evaluated {
    /// As named by the user.
    pub file: String,
    /// What was found.
    pub glare: ImageGlare,
    /// Statistics of luminance gradients, where experimental figures are wanted.
    pub gradient: Option<Result<Gradient, Undefined>>,
}

/// Angles of a direction (right, up, ahead) for people: to the right and upwards, degrees.
fn right_and_up_deg(direction: glam::DVec3) -> [f64; 2] {
    [direction.x.atan2(direction.z).to_degrees(), direction.y.clamp(-1.0, 1.0).asin().to_degrees()]
}
