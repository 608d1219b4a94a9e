//! The command line of `gershun view`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args_run::{LangChoice, Run};

/// Arguments of `view`.
#[derive(Args, Debug)]
pub struct View {
    /// project.toml or its folder
    pub project: PathBuf,
    /// Only this camera or viewpoint; may be repeated
    #[arg(long, value_name = "NAME")]
    pub camera: Vec<String>,
    /// Show the stored field as it is: fast, no interval
    #[arg(long, conflicts_with = "blocks")]
    pub preview: bool,
    /// Unbiased mean of this many blocks (at least 2), with a standard error for every pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub blocks: Option<u32>,
    /// Take the pictures from a field that `solve` kept: its file or folder
    #[arg(long, value_name = "FILE", conflicts_with_all = ["blocks", "seed"])]
    pub field: Option<PathBuf>,
    /// Columns and rows instead of the camera's own, e.g. 600x400
    #[arg(long, value_name = "WxH", value_parser = pixels)]
    pub size: Option<Pixels>,
    /// Files to write
    #[arg(long, value_enum, value_delimiter = ',', default_value = "exr,svg")]
    pub format: Vec<FormatChoice>,
    /// Light scene [default: the viewpoint's own, else the first]
    #[arg(long, value_name = "NAME")]
    pub light_scene: Option<String>,
    /// Folder whose `views` takes the pictures [default: out/<project name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Language of the drawings [default: the project's]
    #[arg(long, value_enum)]
    pub lang: Option<LangChoice>,
    /// How the run goes
    #[command(flatten)]
    pub run: Run,
}

/// Help that follows the options.
pub const EXAMPLES: &str =
    "Luminances are those of the new installation (initial flux). Without --blocks a picture has no
interval; views.json beside it says what it approximates. A viewpoint is an angular fisheye of 180°;
viewpoints are shown where they are named, and all of them where the project has no [[camera]].

Examples:
  gershun view scenes/office
  gershun view --preview --format png --camera \"Seat 1\" scenes/office
  gershun solve scenes/office && gershun view --field out/office scenes/office
  gershun view --format hdr --size 1200x1200 scenes/office      # for evalglare
  gershun view --blocks 64 --format exr,svg --light-scene evening scenes/office";

/// Formats of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormatChoice {
    /// OpenEXR: cd/m² in channel Y, standard errors in channel se (without --blocks: of glossy lobes alone)
    Exr,
    /// Radiance HDR with VIEW and EXPOSURE
    Hdr,
    /// False colours with scale and text
    Svg,
    /// False colours with scale
    Png,
}

/// Columns and rows.
pub type Pixels = [usize; 2];

fn pixels(text: &str) -> Result<Pixels, String> {
    let sides: Option<Vec<usize>> = text.split(['x', '×']).map(|side| side.trim().parse().ok()).collect();
    match sides.as_deref() {
        Some(&[width, height])
            if (1..=32_000).contains(&width)
                && (1..=32_000).contains(&height)
                && width * height <= gershun::image::MOST_PIXELS =>
        {
            Ok([width, height])
        }
        Some([_, _]) => Err("at most 32 000 columns or rows and 64 million pixels".into()),
        _ => Err(format!("\"{text}\" is not a size; write 600x400")),
    }
}
