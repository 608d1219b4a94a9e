//! The command line of `gershun lamp`.

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use crate::args_run::{LangChoice, Run};

/// Commands for photometric files.
#[derive(Subcommand, Debug)]
pub enum Lamp {
    /// Flux, efficacy, angles, flux code, luminances and faults of photometric files
    #[command(
        after_help = "C0 lies across the opening's length in every format; an LM-63 file's own 0° plane is C90.
A file that cannot be read is listed, the others follow; the exit code is then 2.

Examples:
  gershun lamp info panel.ldt
  gershun lamp info --format json catalogue/*.ldt > catalogue.json"
    )]
    Info {
        /// Photometric files (LM-63, EULUMDAT, GLDF)
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// What is printed
        #[arg(long, value_enum, default_value_t = InfoFormat::Human)]
        format: InfoFormat,
        /// Language of what is printed for people
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// Faults of photometric files and what they would do to the result
    #[command(after_help = "Exit code 1 if a finding has severity error, 2 if a file cannot be opened.

Examples:
  gershun lamp lint catalogue/*.ies
  gershun explain flux-mismatch
  gershun lamp lint --format sarif *.ldt > photometry.sarif")]
    Lint {
        /// Photometric files (LM-63, EULUMDAT, GLDF)
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// What is printed
        #[arg(long, value_enum, default_value_t = LintFormat::Human)]
        format: LintFormat,
        /// Language of what is printed for people
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// UGR tables by CIE 117 and CIE 190: 19 rooms, 5 reflectance sets, crosswise and endwise
    #[command(after_help = "With several files, the CSV has a leading column `file`.

Examples:
  gershun lamp ugr-table panel.ldt
  gershun lamp ugr-table --shr 0.25 --format csv panel.ldt > ugr.csv")]
    UgrTable {
        /// Photometric files (LM-63, EULUMDAT, GLDF)
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Spacing to height: 1 (CIE 190, GOST 33392), 0.25 (most catalogues) or another 1/n
        #[arg(long, value_name = "RATIO", default_value_t = 1.0)]
        shr: f64,
        /// What is printed
        #[arg(long, value_enum, default_value_t = TableFormat::Human)]
        format: TableFormat,
        /// Language of what is printed for people
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// Polar diagram as SVG: C0–C180 and C90–C270, cd and cd/klm, beam angles
    #[command(after_help = "Example:
  gershun lamp polar panel.ldt --out panel.svg")]
    Polar {
        /// Photometric file (LM-63, EULUMDAT, GLDF with one photometry)
        file: PathBuf,
        /// File to write [default: standard output]
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Language of the words in the drawing
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// LM-63 to EULUMDAT or back; prints what the new file does not hold
    #[command(
        after_help = "The formats are recognised by content (input) and extension (output: .ies or .ldt).
The new file is read back: no stored intensity differs by more than 1e-6.

Example:
  gershun lamp convert panel.ldt panel.ies"
    )]
    Convert {
        /// Photometric file (LM-63, EULUMDAT, GLDF with one photometry)
        input: PathBuf,
        /// File to write, .ies or .ldt
        output: PathBuf,
        /// Language of what is printed for people
        #[arg(long, value_enum, default_value_t = LangChoice::En)]
        lang: LangChoice,
    },
    /// Luminous intensity of luminaires as installed, with what their housing reflects, as .ldt or .ies
    #[command(
        after_help = "The scene must be open: only light that leaves it counts. C90 lies along +x of the
project, γ = 0 points down. A housing is geometry of the project's CAD file; luminaires keep the
intensities of their files inside it. Initial flux.

Examples:
  gershun lamp far-field cove --out cove.ldt
  gershun lamp far-field pendant --group up --out up.ies --gamma-step 2.5 --blocks 256"
    )]
    FarField(FarFieldArgs),
}

/// Arguments of `lamp far-field`.
#[derive(clap::Args, Debug)]
pub struct FarFieldArgs {
    /// project.toml or its folder
    pub project: PathBuf,
    /// Only luminaires of this group; may be given several times
    #[arg(long, value_name = "NAME")]
    pub group: Vec<String>,
    /// Light scene whose factors count [default: the first]
    #[arg(long, value_name = "NAME")]
    pub light_scene: Option<String>,
    /// File to write, .ies or .ldt
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Step of C, degrees
    #[arg(long, value_name = "DEG", default_value_t = 15.0)]
    pub c_step: f64,
    /// Step of γ, degrees
    #[arg(long, value_name = "DEG", default_value_t = 5.0)]
    pub gamma_step: f64,
    /// Independent blocks: four times as many halve the error
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub blocks: u64,
    /// What is printed
    #[arg(long, value_enum, default_value_t = InfoFormat::Human)]
    pub format: InfoFormat,
    /// Language of what is printed for people
    #[arg(long, value_enum, default_value_t = LangChoice::En)]
    pub lang: LangChoice,
    /// How the run goes
    #[command(flatten)]
    pub run: Run,
}

/// Output of `lamp info`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum InfoFormat {
    /// A block per luminaire
    Human,
    /// An array of objects
    Json,
}

/// Output of `lamp lint`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LintFormat {
    /// A paragraph per finding
    Human,
    /// An array of objects
    Json,
    /// SARIF, for code scanners
    Sarif,
}

/// Output of `lamp ugr-table`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TableFormat {
    /// A table
    Human,
    /// Rows rooms, columns reflectance sets
    Csv,
}
