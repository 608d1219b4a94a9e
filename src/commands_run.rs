//! What commands on a project share: threads, loading, where results go, which language, a bar for
//! what takes longer than a second.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::Duration;

use gershun::project::{Diagnostic, LoadOptions, Project, load, suggestion};
use gershun::report::Lang;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args_run::{LangChoice, Run};
use crate::{BAD_INPUT, complain, remark};

/// Starts the threads asked for and loads the project with the seed asked for; or tells what is
/// wrong and returns the exit code.
pub fn open(path: &Path, run: &Run) -> Result<Project, u8> {
    use_threads(run.threads)?;
    let mut project = opened(path, run.load_options())?;
    warn(&project, run.quiet);
    if let Some(seed) = run.seed {
        project.accuracy.seed = seed;
    }
    Ok(project)
}

/// Loads a project; or tells all its mistakes and returns the exit code.
pub fn opened(path: &Path, options: LoadOptions) -> Result<Project, u8> {
    load(path, &options).map_err(|diagnostics| complain_of_all(&diagnostics, path))
}

/// Tells what may well be a mistake.
pub fn warn(project: &Project, quiet: bool) {
    for warning in project.warnings.iter().filter(|_| !quiet) {
        remark(&format!("{}\n", warning.as_warning()));
    }
}

fn complain_of_all(diagnostics: &[Diagnostic], path: &Path) -> u8 {
    for diagnostic in diagnostics {
        remark(&format!("{diagnostic}\n"));
    }
    let count = diagnostics.len();
    let plural = if count == 1 { "" } else { "s" };
    remark(&format!("{count} mistake{plural} in {}; nothing was computed", path.display()));
    BAD_INPUT
}

/// Starts the threads asked for, or returns the exit code.
pub fn use_threads(threads: Option<u16>) -> Result<(), u8> {
    let Some(threads) = threads else { return Ok(()) };
    let started = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    started.map_err(|error| complain(&format!("cannot start {threads} threads: {error}")))
}

/// The folder asked for, else `out/<project name>`.
pub fn folder(asked: Option<&Path>, name: &str) -> PathBuf {
    asked.map_or_else(|| Path::new("out").join(folder_name(name)), Path::to_owned)
}

/// A name as a folder: no separators, never empty or hidden.
pub fn folder_name(name: &str) -> PathBuf {
    let clean: String = name
        .trim()
        .chars()
        .map(|c| if c.is_alphanumeric() || "-_ .".contains(c) { c } else { '_' })
        .collect();
    let clean = clean.trim_start_matches('.').trim();
    PathBuf::from(if clean.is_empty() { "project" } else { clean })
}

/// The language asked for, else the first of the project's that we speak, else English.
pub fn spoken(asked: Option<LangChoice>, of_project: &[String]) -> Lang {
    let own = || of_project.first().and_then(|code| Lang::parse(code)).unwrap_or(Lang::En);
    asked.map_or_else(own, LangChoice::lang)
}

/// Index of the light scene of this name.
pub fn light_scene(project: &Project, name: &str) -> Result<usize, String> {
    let known = || project.light_scenes.iter().map(|scene| scene.name.as_str());
    known()
        .position(|known| known == name)
        .ok_or_else(|| format!("no light scene \"{name}\"\n  hint: {}", suggestion(name, known())))
}

/// A progress bar that appears once the work has taken a second, on a terminal alone.
pub struct LateBar {
    bar: ProgressBar,
    wanted: bool,
}

impl LateBar {
    /// `unit` follows the count: "blocks", "rooms".
    pub fn new(quiet: bool, unit: &str) -> Self {
        let bar = ProgressBar::hidden();
        let template = format!("{{bar:24}} {{pos}}/{{len}} {unit} · {{msg}}{{elapsed}}");
        bar.set_style(
            ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        Self { bar, wanted: !quiet && std::io::stderr().is_terminal() }
    }

    /// So much is done of so much, here.
    pub fn show(&self, done: usize, of: usize, place: &str) {
        if self.wanted && self.bar.is_hidden() && self.bar.elapsed() > Duration::from_secs(1) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
        self.bar.set_message(if place.is_empty() { String::new() } else { format!("{place} · ") });
    }

    /// Wipes it.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}
