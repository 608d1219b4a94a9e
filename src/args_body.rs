//! The command line of `gershun body`.

use std::path::PathBuf;

use clap::Args;

use crate::args_run::{LangChoice, Run};

/// Arguments of `body`.
#[derive(Args, Debug)]
pub struct Body {
    /// project.toml or its folder
    pub project: PathBuf,
    /// Only this viewpoint; may be repeated
    #[arg(long, value_name = "NAME")]
    pub viewpoint: Vec<String>,
    /// A point instead of the viewpoints: metres, as x,y,z
    #[arg(long, value_name = "X,Y,Z", value_parser = point, conflicts_with = "viewpoint", allow_hyphen_values = true)]
    pub at: Option<[f64; 3]>,
    /// Edge of a cell in azimuth and elevation, degrees
    #[arg(long, value_name = "DEG", value_parser = step, default_value = "5")]
    pub step: f64,
    /// Blocks: each draws one ray in every cell
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub blocks: u32,
    /// Light scene [default: the viewpoint's own, else the first]
    #[arg(long, value_name = "NAME")]
    pub light_scene: Option<String>,
    /// Folder whose `bodies` takes the files [default: out/<project name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Language [default: the project's]
    #[arg(long, value_enum)]
    pub lang: Option<LangChoice>,
    /// How the run goes
    #[command(flatten)]
    pub run: Run,
}

/// Help that follows the options.
pub const EXAMPLES: &str =
    "The luminance body is the luminance that arrives at a point from every direction, unbiased, each
direction with its standard error, for the new installation (initial flux). Directions: azimuth from
+x towards +y, elevation above the horizon, where one looks, not where the light goes.

Examples:
  gershun body scenes/office
  gershun body --viewpoint \"Seat 1\" --step 2 --blocks 256 scenes/office
  gershun body --at 4,2.5,1.5 --light-scene evening scenes/office";

fn point(text: &str) -> Result<[f64; 3], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let found = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    found
        .filter(|point| point.iter().all(|x| x.is_finite()))
        .ok_or_else(|| "three numbers with commas between, e.g. 4,2.5,1.5".to_owned())
}

fn step(text: &str) -> Result<f64, String> {
    let parsed: Option<f64> = text.parse().ok().filter(|step| (0.5..=45.0).contains(step));
    let even = parsed.filter(|step| ((90.0 / step).round() * step - 90.0).abs() < 1e-9);
    even.ok_or_else(|| "a divisor of 90 from 0.5 to 45, e.g. 1, 2, 2.5, 5, 10".to_owned())
}
