//! The command line: flags, their help and examples, resolved into settings of the library.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use gershun::Settings;
use gershun::geometry::trace::Simd;
use gershun::project::{Goal, LoadOptions, Project};
use gershun::solve::Method;

use crate::args_run::{LangChoice, Run};

/// Lighting quality from spatial-angular luminance: illuminance, flux and glare with intervals,
/// judged against norms.
#[derive(Parser, Debug)]
#[command(name = "gershun", version, about, after_help = EXIT_CODES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "Exit codes:
  0    complies (or nothing was required, which is said)
  1    some requirement certainly fails
  3    some requirement is undecided or undefined, none fails
  2    bad input, usage or input/output
  130  interrupted; what was done is kept";

/// Commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Solve as far as the verdicts need, print the table, write the report
    #[command(after_help = "Examples:
  gershun check scenes/office
  gershun check --accuracy fine --lang ru --out result scenes/office
  gershun check --format json scenes/box > box.json
  gershun check --blocks 256 --seed 7 scenes/box      # the same bytes every time")]
    Check(Check),
    /// Solve the luminance field once and keep it in a file
    #[command(after_help = crate::args_solve::EXAMPLES)]
    Solve(crate::args_solve::Solve),
    /// Luminance pictures of the cameras
    #[command(after_help = crate::args_view::EXAMPLES)]
    View(crate::args_view::View),
    /// Luminance from every direction at a point: the luminance body and the light vector
    #[command(after_help = crate::args_body::EXAMPLES)]
    Body(crate::args_body::Body),
    /// Start a new project from a small commented example
    #[command(after_help = "Example:
  gershun new my-office && gershun check my-office")]
    New {
        /// Folder to make; it must not exist
        dir: PathBuf,
    },
    /// Print the JSON Schema of result.json, or of norm files
    Schema {
        /// Of which file
        #[arg(value_enum, default_value = "result")]
        of: Schema,
    },
    /// Glare of luminance images, or of a project's observers
    #[command(
        after_help = "Every index is printed with its convention; one that is not defined here says why.
The options mean what evalglare's mean. Positions count from the lower left corner.

Examples:
  gershun glare --image view.hdr
  gershun glare --image view.hdr --task 400,300,0.6 --check sources.svg
  gershun glare --image *.exr --threshold 1500 --format csv > glare.csv
  gershun glare scenes/office --compare-methods"
    )]
    Glare(crate::args_glare::Glare),
    /// Photometric files: figures, faults, UGR tables
    #[command(subcommand)]
    Lamp(crate::args_lamp::Lamp),
    /// Explain the code of a finding
    #[command(after_help = "Example:
  gershun explain flux-mismatch")]
    Explain {
        /// Code as printed in brackets, e.g. flux-mismatch
        code: String,
        /// Language of the explanation
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// The norms that gershun knows
    #[command(subcommand)]
    Norm(Norm),
}

/// Norm commands.
#[derive(Subcommand, Debug)]
pub enum Norm {
    /// List the bundled norms
    List,
    /// Show the rows of a norm, or one row
    #[command(after_help = "Examples:
  gershun norm show en-12464-1-2021
  gershun norm show en-12464-1-2021 34.2")]
    Show {
        /// Name of a bundled norm, or a file
        name: String,
        /// Row
        row: Option<String>,
    },
    /// Say how a norm is applied and what its columns mean, or what one row asks for
    #[command(after_help = "Examples:
  gershun norm explain en-12193-2018
  gershun norm explain sanpin-1.2.3685-21 15-board")]
    Explain {
        /// Name of a bundled norm, or a file
        name: String,
        /// Row
        row: Option<String>,
    },
}

/// Arguments of `check`.
#[derive(Args, Debug)]
pub struct Check {
    /// project.toml files or their folders
    #[arg(required = true, value_name = "PROJECT")]
    pub projects: Vec<PathBuf>,
    /// Folder for the report [default: out/<project name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// How far to go at most: 64, 1024 or 16384 blocks; relative goal 2.5, 0.5 or 0.15 %
    #[arg(long, value_enum, default_value_t = Accuracy::Normal)]
    pub accuracy: Accuracy,
    /// Go on until the relative standard error is reached, e.g. 0.01
    #[arg(long, value_name = "R", value_parser = fraction)]
    pub relative: Option<f64>,
    /// Stop after this time at a block's end, e.g. 30s, 2m
    #[arg(long, value_name = "TIME", value_parser = duration)]
    pub time: Option<Duration>,
    /// Compute exactly this many blocks (at least 2); a list gives one number for each room or
    /// CAD file solved on its own, as blocks_by_world in result.json, and repeats that run
    #[arg(long, value_name = "N,…", value_delimiter = ',', value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub blocks: Vec<u32>,
    /// Estimator
    #[arg(long, value_enum, default_value_t = MethodChoice::Auto)]
    pub method: MethodChoice,
    /// Print what would be computed and why, then stop
    #[arg(long)]
    pub explain_plan: bool,
    /// Memory for the answers, e.g. 4GiB
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = size)]
    pub memory: usize,
    /// What is printed on standard output
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub format: Format,
    /// Language of the table and the report [default: the project's]
    #[arg(long, value_enum)]
    pub lang: Option<LangChoice>,
    /// CSV files for Excel: semicolons and decimal commas
    #[arg(long)]
    pub csv_excel: bool,
    /// What an undecided requirement means to a script, where none fails: exit code 1, 0, or one of
    /// its own (3)
    #[arg(long, value_enum, value_name = "MEANS", default_value_t = Undecided::Apart)]
    pub undecided: Undecided,
    /// SIMD level of the ray tracer; it never changes a result, which a test proves by switching it off
    #[arg(long, value_enum, default_value_t = SimdChoice::Detect, hide = true)]
    pub simd: SimdChoice,
    /// How the run goes
    #[command(flatten)]
    pub run: Run,
    /// Print biases and the plan's reasons too
    #[arg(short, long)]
    pub verbose: bool,
    /// Colour in the terminal
    #[arg(long, value_enum, default_value_t = ColourChoice::Auto)]
    pub color: ColourChoice,
}

/// Accuracy presets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Accuracy {
    /// 2.5 %, at most 64 blocks
    Draft,
    /// 0.5 %, at most 1024 blocks
    Normal,
    /// 0.15 %, at most 16384 blocks
    Fine,
}

/// Estimators on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodChoice {
    /// The fastest unbiased one: links
    Auto,
    /// Frozen field, gather rays, residual walks
    Links,
    /// Independent path tracing, for cross-checks
    Path,
    /// Local estimation: chains of light connected to every receiver
    Local,
    /// Double local estimation: local, and surfaces that are seen are connected too
    Double,
}

/// Output formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table
    Human,
    /// result.json
    Json,
    /// JUnit XML, for build servers
    Junit,
    /// SARIF, for code scanners
    Sarif,
}

/// What a JSON Schema describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Schema {
    /// result.json
    Result,
    /// A norm file, read as JSON
    Norm,
}

/// What undecided requirements mean to a script.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Undecided {
    /// Exit code 1, as if they failed
    Fail,
    /// Exit code 0, as if they passed; requirements without a value still end with 3
    Pass,
    /// Exit code 3
    #[value(name = "3")]
    Apart,
}

/// SIMD levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SimdChoice {
    /// AVX2 where the machine has it
    Detect,
    /// The baseline of the build only
    Off,
}

/// Use of colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ColourChoice {
    /// In a terminal, unless NO_COLOR is set
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

impl Check {
    /// How projects are loaded.
    pub fn load_options(&self) -> LoadOptions {
        LoadOptions {
            simd: match self.simd {
                SimdChoice::Detect => Simd::Detect,
                SimdChoice::Off => Simd::Off,
            },
            ..self.run.load_options()
        }
    }

    /// Settings of the run; the command line beats the project file.
    pub fn settings(&self, project: &mut Project) -> Settings {
        let (relative, most_blocks) = match self.accuracy {
            Accuracy::Draft => (0.025, 64),
            Accuracy::Normal => (0.005, 1024),
            Accuracy::Fine => (0.0015, 16_384),
        };
        if let Some(seed) = self.run.seed {
            project.accuracy.seed = seed;
        }
        if let Some(relative) = self.relative {
            project.accuracy.goal = Goal::Relative(relative);
        }
        let file_time = match project.accuracy.goal {
            Goal::Seconds(seconds) => Some(seconds),
            Goal::Verdict | Goal::Relative(_) => None,
        };
        Settings {
            method: match self.method {
                MethodChoice::Auto | MethodChoice::Links => Method::Links,
                MethodChoice::Path => Method::Path,
                MethodChoice::Local => Method::Local,
                MethodChoice::Double => Method::Double,
            },
            most_blocks,
            exact_blocks: (!self.blocks.is_empty())
                .then(|| self.blocks.iter().map(|&n| n as usize).collect()),
            seconds: self.time.map(|time| time.as_secs_f64()).or(file_time),
            relative,
            memory_bytes: self.memory,
            ..Settings::default()
        }
    }
}

fn fraction(text: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| format!("\"{text}\" is not a number"))?;
    if value > 0.0 && value < 1.0 {
        Ok(value)
    } else {
        Err("a relative error lies between 0 and 1, e.g. 0.01".into())
    }
}

fn duration(text: &str) -> Result<Duration, String> {
    let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(split);
    let number: f64 =
        number.trim().parse().map_err(|_| format!("\"{text}\" is not a time; write 30s, 2m or 1h"))?;
    let factor = match unit {
        "ms" => 1e-3,
        "" | "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(format!("unknown unit \"{unit}\"; write 30s, 2m or 1h")),
    };
    if number * factor <= 0.0 {
        return Err(format!("\"{text}\" is no time to compute in; write 30s, 2m or 1h"));
    }
    Duration::try_from_secs_f64(number * factor)
        .map_err(|_| format!("\"{text}\" is not a time that can be waited for"))
}

fn size(text: &str) -> Result<usize, String> {
    let split = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(split);
    let number: f64 =
        number.trim().parse().map_err(|_| format!("\"{text}\" is not a size; write 500MiB or 4GiB"))?;
    let factor = match unit {
        "" | "B" => 1.0,
        "KiB" | "K" => 1024.0,
        "MiB" | "M" => 1024.0 * 1024.0,
        "GiB" | "G" => 1024.0 * 1024.0 * 1024.0,
        _ => return Err(format!("unknown unit \"{unit}\"; write 500MiB or 4GiB")),
    };
    if number > 0.0 && number.is_finite() {
        Ok((number * factor) as usize)
    } else {
        Err("a size is positive".into())
    }
}
