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
    #[arg(long)]
    pub compare_methods: bool,
    /// Of a project: number of blocks [default: 64]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=16_384))]
    pub blocks: Option<u32>,
    /// Of a project: glare maps by blocks of unbiased answers in place of look-ups, which takes far longer
    #[arg(long)]
    pub unbiased: bool,
    /// Of a project: values from a field that `solve` kept (its file or folder) with nothing solved anew; no interval
    #[arg(long, value_name = "FILE", conflicts_with_all = ["compare_methods", "unbiased", "blocks", "seed"])]
    pub field: Option<PathBuf>,
    /// Of a project: folder for the tables and drawings of its glare maps [default: none are written]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Of a project: language of the observers' cards [default: en]
    #[arg(long, value_enum)]
    pub lang: Option<LangChoice>,
    /// Luminance images: Radiance HDR or OpenEXR
    #[arg(long, value_name = "FILE", num_args = 1..)]
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
    /// Pixels within half of this angle belong to one source, rad [default: 0.2]
    #[arg(long, value_name = "ANGLE", value_parser = positive)]
    pub search_radius: Option<f64>,
    /// Luminance above which peaks are sources of their own, cd/m², or "none" [default: 50000]
    #[arg(long, value_name = "L", value_parser = peak)]
    pub peak: Option<Peak>,
    /// Lower DGP in dim scenes
    #[arg(long)]
    pub low_light: bool,
    /// Image of the same size; where it is black nothing is seen
    #[arg(long, value_name = "FILE")]
    pub mask: Option<PathBuf>,
    /// Model of the position index [default: levin]
    #[arg(long, value_enum)]
    pub position_index: Option<PositionChoice>,
    /// Coefficients of DGP [default: evalglare]
    #[arg(long, value_enum)]
    pub dgp: Option<DgpChoice>,
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
    #[arg(long)]
    pub experimental: bool,
    /// Age of the observer, years; veiling luminance asks for it [default: 25]
    #[arg(long, value_name = "YEARS", value_parser = positive)]
    pub age: Option<f64>,
    /// Share of the ceiling that shines, above 0 and up to 1; GGR asks for it
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub ceiling_coverage: Option<f64>,
    /// Mean horizontal illuminance of an outdoor area in lx and its reflectance; GR asks for them
    #[arg(long, value_name = "LX,RHO", value_parser = ground)]
    pub ground: Option<[f64; 2]>,
    /// Mean luminance of the road or lane, cd/m²; f_TI asks for it
    #[arg(long, value_name = "L", value_parser = positive)]
    pub road: Option<f64>,
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

impl Glare {
    /// The first option that means nothing for what is named: images or a project. Clap's `requires` cannot
    /// say this beside `conflicts_with`, and an option that is accepted and not heeded is a wrong number.
    pub fn misplaced(&self) -> Option<&'static str> {
        let of_images = [
            ("--threshold", self.threshold.is_some()),
            ("--threshold-factor", self.threshold_factor.is_some()),
            ("--task", self.task.is_some()),
            ("--search-radius", self.search_radius.is_some()),
            ("--peak", self.peak.is_some()),
            ("--low-light", self.low_light),
            ("--mask", self.mask.is_some()),
            ("--position-index", self.position_index.is_some()),
            ("--dgp", self.dgp.is_some()),
            ("--measured-ev", self.measured_ev.is_some()),
            ("--view", self.view.is_some()),
            ("--band", self.band.is_some()),
            ("--experimental", self.experimental),
            ("--age", self.age.is_some()),
            ("--ceiling-coverage", self.ceiling_coverage.is_some()),
            ("--ground", self.ground.is_some()),
            ("--road", self.road.is_some()),
            ("--check", self.check.is_some()),
        ];
        let of_projects = [
            ("--compare-methods", self.compare_methods),
            ("--blocks", self.blocks.is_some()),
            ("--unbiased", self.unbiased),
            ("--field", self.field.is_some()),
            ("--out", self.out.is_some()),
            ("--lang", self.lang.is_some()),
            ("--seed", self.run.seed.is_some()),
            ("--allow-outside", self.run.allow_outside),
        ];
        let foreign = if self.project.is_some() { &of_images[..] } else { &of_projects };
        foreign.iter().find(|(_, given)| *given).map(|(name, _)| *name)
    }
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

fn share(text: &str) -> Result<f64, String> {
    let value = positive(text)?;
    if value <= 1.0 { Ok(value) } else { Err("it is a share, at most 1".into()) }
}

fn ground(text: &str) -> Result<[f64; 2], String> {
    let example = || format!("\"{text}\" is not illuminance,reflectance, for example 200,0.25");
    let (lx, reflectance) = text.split_once(',').ok_or_else(example)?;
    Ok([positive(lx.trim()).map_err(|_| example())?, share(reflectance.trim()).map_err(|_| example())?])
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
