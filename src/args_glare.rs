//! The command line of `gershun glare`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use crate::args_run::{LangChoice, Run};

/// Arguments of `glare`.
#[derive(Args, Debug)]
pub struct Glare {
    /// project.toml or its folder, in place of images: its observers in all their directions
    #[arg(value_name = "PROJECT", conflicts_with = "image")]
    pub project: Option<PathBuf>,
    /// Of a project: UGR by six conventions of sources and position index
    #[arg(long, requires = "project")]
    pub compare_methods: bool,
    /// Of a project: number of blocks
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=16_384))]
    pub blocks: u32,
    /// Of a project: glare maps by blocks of unbiased answers in place of look-ups, which takes far longer
    #[arg(long, requires = "project")]
    pub unbiased: bool,
    /// Of a project: values from a field that `solve` kept (its file or folder) with nothing solved anew; no interval
    #[arg(long, value_name = "FILE", requires = "project", conflicts_with_all = ["compare_methods", "unbiased", "blocks", "seed"])]
    pub field: Option<PathBuf>,
    /// Of a project: folder for the tables and drawings of its glare maps [default: none are written]
    #[arg(long, value_name = "DIR", requires = "project")]
    pub out: Option<PathBuf>,
    /// Of a project: language of the observers' cards
    #[arg(long, value_enum, default_value_t = LangChoice::En)]
    pub lang: LangChoice,
    /// Luminance images: Radiance HDR or OpenEXR
    #[arg(long, value_name = "FILE", required_unless_present = "project", num_args = 1..)]
    pub image: Vec<PathBuf>,
    /// Pixels above L cd/m² are glare sources [default: 2000]
    #[arg(long, value_name = "L", value_parser = positive, conflicts_with = "threshold_factor")]
    pub threshold: Option<f64>,
    /// Pixels above K times the mean luminance (of the task, if one is given) are glare sources
    #[arg(long, value_name = "K", value_parser = positive)]
    pub threshold_factor: Option<f64>,
    /// Task zone: column and row in pixels from the lower left corner, full opening angle in rad; its
    /// luminance times 5 is the threshold unless another is given
    #[arg(long, value_name = "X,Y,ANGLE", value_parser = task)]
    pub task: Option<[f64; 3]>,
    /// Pixels within half of this angle belong to one source, rad
    #[arg(long, value_name = "ANGLE", default_value_t = 0.2, value_parser = positive)]
    pub search_radius: f64,
    /// Luminance above which peaks are sources of their own, cd/m², or "none"
    #[arg(long, value_name = "L", default_value = "50000", value_parser = peak)]
    pub peak: Peak,
    /// Lower DGP in dim scenes
    #[arg(long)]
    pub low_light: bool,
    /// Image of the same size; where it is black nothing is seen
    #[arg(long, value_name = "FILE")]
    pub mask: Option<PathBuf>,
    /// Model of the position index
    #[arg(long, value_enum, default_value_t = PositionChoice::Levin)]
    pub position_index: PositionChoice,
    /// Coefficients of DGP
    #[arg(long, value_enum, default_value_t = DgpChoice::Evalglare)]
    pub dgp: DgpChoice,
    /// Illuminance measured at the eye, lx, in place of the image's own
    #[arg(long, value_name = "LX", value_parser = positive)]
    pub measured_ev: Option<f64>,
    /// View in place of the file's own, as Radiance writes it: "-vta -vh 180 -vv 180"; what it leaves out is
    /// the file's, and without one there it must say -vt, -vh and -vv
    #[arg(long, value_name = "OPTIONS", allow_hyphen_values = true)]
    pub view: Option<String>,
    /// Half height of a horizontal band whose luminance is asked for, rad
    #[arg(long, value_name = "ANGLE", value_parser = positive)]
    pub band: Option<f64>,
    /// Statistics of luminance gradients too: experimental, in no norm and no verdict
    #[arg(long, conflicts_with = "project")]
    pub experimental: bool,
    /// Age of the observer, years; veiling luminance asks for it
    #[arg(long, value_name = "YEARS", default_value_t = 25.0, value_parser = positive)]
    pub age: f64,
    /// What is printed
    #[arg(long, value_enum, default_value_t = GlareFormat::Human)]
    pub format: GlareFormat,
    /// Picture with every source in a colour of its own, .png or .svg; for one image
    #[arg(long, value_name = "FILE")]
    pub check: Option<PathBuf>,
    /// How the run goes; seed and files outside concern a project
    #[command(flatten)]
    pub run: Run,
}

/// Luminance of peaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Peak {
    /// Above this luminance, cd/m².
    Above(f64),
    /// None are split off.
    None,
}

/// Models of the position index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PositionChoice {
    /// Levin's formula, Iwata–Osterhaus below the line of sight
    Levin,
    /// Table of CIE 117
    Table,
}

/// Coefficients of DGP.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DgpChoice {
    /// 0.092 and 0.159
    Evalglare,
    /// 0.0918 and 0.16, Wienold and Christoffersen 2006
    Published,
}

/// Output of `glare`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GlareFormat {
    /// A block per image
    Human,
    /// An object, or an array where several images are named
    Json,
    /// A row for every image and index
    Csv,
}

fn positive(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("\"{text}\" is not a number"))?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("it must be positive".into()) }
}

fn peak(text: &str) -> Result<Peak, String> {
    if text == "none" { Ok(Peak::None) } else { Ok(Peak::Above(positive(text)?)) }
}

fn task(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> =
        text.split(',').filter_map(|part| part.trim().parse().ok()).filter(|x: &f64| x.is_finite()).collect();
    match numbers.as_slice() {
        &[x, y, angle] if angle > 0.0 => Ok([x, y, angle]),
        _ => Err(format!("\"{text}\" is not x,y,angle, for example 400,300,0.6")),
    }
}
