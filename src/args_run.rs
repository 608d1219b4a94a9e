//! Arguments that commands share: how a run goes, and in which language it speaks.

use clap::{Args, ValueEnum};
use gershun::project::LoadOptions;
use gershun::report::Lang;

/// How a run on a project goes.
#[derive(Args, Debug)]
pub struct Run {
    /// Seed of all randomness [default: the project's, else 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Number of threads; it never changes a result [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
    /// Let the project read files outside its folder
    #[arg(long)]
    pub allow_outside: bool,
    /// Print nothing but errors, and what --format asks for scripts
    #[arg(short, long)]
    pub quiet: bool,
}

impl Run {
    /// How projects are loaded.
    pub fn load_options(&self) -> LoadOptions {
        LoadOptions { allow_outside: self.allow_outside, ..LoadOptions::default() }
    }
}

/// Languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LangChoice {
    /// English
    En,
    /// Russian
    Ru,
}

impl LangChoice {
    /// The library's name of it.
    pub fn lang(self) -> Lang {
        match self {
            Self::En => Lang::En,
            Self::Ru => Lang::Ru,
        }
    }
}
