//! The command line of `gershun solve`.

use std::path::PathBuf;

use clap::Args;

use crate::args_run::Run;

/// Arguments of `solve`.
#[derive(Args, Debug)]
pub struct Solve {
    /// project.toml or its folder
    pub project: PathBuf,
    /// Folder that takes field.safetensors [default: out/<project name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// How the run goes
    #[command(flatten)]
    pub run: Run,
}

/// Help that follows the options.
pub const EXAMPLES: &str =
    "The field is the luminance of every patch of the surfaces for every channel (luminaire group or
luminous material) at initial flux. It holds for all light scenes, cameras and viewpoints, also for
those added later; another geometry, material or luminaire needs a new one. docs/field-file.md
describes the file and reads it in Python.

Examples:
  gershun solve scenes/office
  gershun view --field out/office scenes/office";
