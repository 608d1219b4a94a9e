//! Arguments → library → printed diagnostics → exit code. Results go to standard output, progress
//! and diagnostics to standard error.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the one place that prints")]

mod args;
mod args_body;
mod args_glare;
mod args_lamp;
mod args_solve;
mod args_view;
mod commands_body;
mod commands_glare;
mod commands_lamp;
mod commands_solve;
mod commands_view;

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::Parser;
use gershun::norm::{self, Standard, bundled};
use gershun::outcome::{Outcome, Verdict};
use gershun::project::{Diagnostic, Project, load};
use gershun::report::{self, Colour, Lang, Style};
use gershun::{Progress, Watch};
use indicatif::{ProgressBar, ProgressStyle};

use crate::args::{Check, Cli, ColourChoice, Command, Format, Norm, Schema, Undecided};

/// Exit codes of the contract with scripts.
const COMPLIES: u8 = 0;
const FAILS: u8 = 1;
const BAD_INPUT: u8 = 2;
const UNDECIDED: u8 = 3;
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    let code = match Cli::parse().command {
        Command::Check(check) => run_checks(&check),
        Command::New { dir } => new_project(&dir),
        Command::Schema { of: Schema::Result } => say(report::schema()),
        Command::Schema { of: Schema::Norm } => say(norm::schema()),
        Command::Glare(command) => commands_glare::run(&command),
        Command::Solve(solve) => commands_solve::run(&solve),
        Command::Body(body) => commands_body::run(&body),
        Command::View(view) => commands_view::run(&view),
        Command::Lamp(command) => commands_lamp::run(&command),
        Command::Explain { code, lang } => commands_lamp::explain(&code, lang.lang()),
        Command::Norm(Norm::List) => list_norms(),
        Command::Norm(Norm::Show { name, row }) => show_norm(&name, row.as_deref()),
        Command::Norm(Norm::Explain { name, row }) => explain_norm(&name, row.as_deref()),
    };
    ExitCode::from(code)
}

/// Prints to standard output; a closed pipe (`| head`) is no error.
fn say(text: &str) -> u8 {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(&format!("cannot print: {error}"))
        }
        _ => COMPLIES,
    }
}

fn complain(message: &str) -> u8 {
    eprintln!("error: {message}");
    BAD_INPUT
}

/// A word beside the results, on standard error.
fn remark(message: &str) {
    eprintln!("{message}");
}

/// All mistakes of a project.
fn complain_of_all(diagnostics: &[Diagnostic], path: &Path) {
    for diagnostic in diagnostics {
        eprintln!("{diagnostic}\n");
    }
    let count = diagnostics.len();
    eprintln!(
        "{count} mistake{} in {}; nothing was computed",
        if count == 1 { "" } else { "s" },
        path.display()
    );
}

/// Starts the threads asked for, or returns the exit code.
fn use_threads(threads: Option<u16>) -> Result<(), u8> {
    let Some(threads) = threads else { return Ok(()) };
    let started = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    started.map_err(|error| complain(&format!("cannot start {threads} threads: {error}")))
}

fn run_checks(check: &Check) -> u8 {
    if check.out.is_some() && check.projects.len() > 1 {
        return complain("--out takes one project; without it each report goes to out/<project name>");
    }
    if let Err(code) = use_threads(check.threads) {
        return code;
    }
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    // A second interruption ends the program at once.
    let handler = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
    if let Err(error) = handler {
        eprintln!("warning: interruption will not keep results: {error}");
    }
    // Load everything first: mistakes of all projects are reported before any is solved.
    let loaded: Vec<Option<Project>> = check.projects.iter().map(|path| load_one(path, check)).collect();
    let Some(projects) = loaded.into_iter().collect::<Option<Vec<Project>>>() else {
        return BAD_INPUT;
    };
    let mut worst = COMPLIES;
    for project in projects {
        let code = check_one(project, check, &interrupted);
        worst = graver(worst, code);
        if code == INTERRUPTED {
            break;
        }
    }
    worst
}

/// Bad input before failure before undecided; an interruption is reported as such.
fn graver(a: u8, b: u8) -> u8 {
    let order =
        |code: u8| [COMPLIES, UNDECIDED, FAILS, BAD_INPUT, INTERRUPTED].iter().position(|&c| c == code);
    if order(a) >= order(b) { a } else { b }
}

fn load_one(path: &Path, check: &Check) -> Option<Project> {
    match load(path, &check.load_options()) {
        Ok(project) => {
            if !check.quiet {
                for fault in commands_lamp::faults(path, &project) {
                    eprintln!("{fault}");
                }
            }
            Some(project)
        }
        Err(diagnostics) => {
            complain_of_all(&diagnostics, path);
            None
        }
    }
}

fn check_one(mut project: Project, check: &Check, interrupted: &AtomicBool) -> u8 {
    let settings = check.settings(&mut project);
    if check.explain_plan {
        return explain(&project);
    }
    let started = Instant::now();
    let bar = bar(check.quiet);
    let tell = |progress: Progress| show(&bar, started, &progress);
    let outcome = match gershun::run(&project, &settings, &Watch { progress: &tell, interrupted }) {
        Ok(outcome) => outcome,
        Err(error) => {
            bar.finish_and_clear();
            eprintln!("{error}\n\nnothing was computed");
            return BAD_INPUT;
        }
    };
    bar.finish_and_clear();
    let out = check.out.clone().unwrap_or_else(|| Path::new("out").join(folder_name(&outcome.info.name)));
    let options = report::Options {
        languages: check.lang.map(args::LangChoice::lang).into_iter().collect(),
        dialect: if check.csv_excel { report::csv::Dialect::Excel } else { report::csv::Dialect::Standard },
    };
    if let Err(error) = report::write(&outcome, &out, &options) {
        return complain(&error.to_string());
    }
    let printed = print(&outcome, check, &out);
    if printed != COMPLIES {
        return printed;
    }
    if interrupted.load(Ordering::Relaxed) {
        return INTERRUPTED;
    }
    match outcome.verdict() {
        Some(Verdict::Fail) => FAILS,
        Some(Verdict::Undecided | Verdict::Undefined) => match check.undecided {
            Undecided::Fail => FAILS,
            Undecided::Apart => UNDECIDED,
            // A requirement without a value was not looked at, let alone nearly met.
            Undecided::Pass if has_no_value(&outcome) => UNDECIDED,
            Undecided::Pass => COMPLIES,
        },
        Some(Verdict::Pass | Verdict::Declared | Verdict::NotAssessed) | None => COMPLIES,
    }
}

fn has_no_value(outcome: &Outcome) -> bool {
    outcome.requirements.iter().any(|requirement| requirement.verdict == Verdict::Undefined)
}

/// A bar that appears once a run has taken a second.
fn bar(quiet: bool) -> ProgressBar {
    if quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:24} {pos}/{len} blocks · {msg} · {elapsed}");
    let bar = ProgressBar::hidden();
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

fn show(bar: &ProgressBar, started: Instant, progress: &Progress) {
    if bar.is_hidden() && started.elapsed() > Duration::from_secs(1) && std::io::stderr().is_terminal() {
        bar.set_draw_target(indicatif::ProgressDrawTarget::stderr());
    }
    bar.set_length(progress.target as u64);
    bar.set_position(progress.blocks as u64);
    let room = if progress.worlds > 1 {
        format!("{} ({} of {})", progress.room, progress.world + 1, progress.worlds)
    } else {
        progress.room.to_owned()
    };
    bar.set_message(if progress.open > 0 { format!("{room}, {} still open", progress.open) } else { room });
}

fn print(outcome: &Outcome, check: &Check, out: &Path) -> u8 {
    if check.quiet && check.format == Format::Human {
        return COMPLIES;
    }
    let lang = check.lang.map_or_else(
        || outcome.info.language.first().and_then(|code| Lang::parse(code)).unwrap_or(Lang::En),
        args::LangChoice::lang,
    );
    match check.format {
        Format::Human => {
            let mut text = report::table(outcome, Style { lang, colour: colour(check.color) });
            if check.verbose {
                for reason in &outcome.plan {
                    text.push_str(&format!("plan: {reason}\n"));
                }
                for bias in &outcome.biases {
                    text.push_str(&format!("bias: {} ({})\n", bias.what, bias.effect));
                }
            }
            let code = say(&text);
            let stopped = report::words::stopped(lang, &outcome.solver.stopped);
            eprintln!(
                "{} blocks: {stopped}\nreport: {}",
                outcome.solver.blocks,
                out.join("report.html").display()
            );
            code
        }
        Format::Json => match std::fs::read_to_string(out.join("result.json")) {
            Ok(text) => say(&text),
            Err(error) => complain(&format!("cannot read back the result: {error}")),
        },
        Format::Junit => say(&report::junit(outcome)),
        Format::Sarif => say(&report::sarif(outcome)),
    }
}

fn colour(choice: ColourChoice) -> Colour {
    let wanted = match choice {
        ColourChoice::Always => true,
        ColourChoice::Never => false,
        ColourChoice::Auto => std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none(),
    };
    if wanted { Colour::Ansi } else { Colour::Plain }
}

/// A project's name as a folder: no separators, never empty or hidden.
fn folder_name(name: &str) -> PathBuf {
    let clean: String = name
        .trim()
        .chars()
        .map(|c| if c.is_alphanumeric() || "-_ .".contains(c) { c } else { '_' })
        .collect();
    let clean = clean.trim_start_matches('.').trim();
    PathBuf::from(if clean.is_empty() { "project" } else { clean })
}

fn explain(project: &Project) -> u8 {
    let mut text = String::new();
    for world in &project.worlds {
        match gershun::plan::plan(project, world) {
            Ok(plan) => {
                for room in &world.rooms {
                    text.push_str(&format!("room {}\n", room.name));
                }
                for reason in &plan.reasons {
                    text.push_str(&format!("  {reason}\n"));
                }
            }
            Err(errors) => {
                for error in errors {
                    eprintln!("{error}\n");
                }
                return BAD_INPUT;
            }
        }
    }
    say(&text)
}

fn new_project(dir: &Path) -> u8 {
    if dir.exists() {
        return complain(&format!("{} exists already; name a new folder", dir.display()));
    }
    let text = include_str!("../scenes/box/project.toml");
    let made = std::fs::create_dir_all(dir).and_then(|()| std::fs::write(dir.join("project.toml"), text));
    match made {
        Ok(()) => say(&format!("{}\n", dir.join("project.toml").display())),
        Err(error) => complain(&format!("{}: {error}", dir.display())),
    }
}

fn list_norms() -> u8 {
    let mut text = String::new();
    for (id, source) in bundled() {
        match Standard::parse(source, id) {
            Ok(standard) => {
                text.push_str(&format!(
                    "{id}  {}  {} ({} rows)\n",
                    standard.short,
                    standard.title,
                    standard.rows.len()
                ));
            }
            Err(error) => return complain(&error.to_string()),
        }
    }
    say(&text)
}

/// A bundled norm, or a file; mistakes are told and become an exit code.
fn read_norm(name: &str) -> Result<Standard, u8> {
    let text = match bundled().iter().find(|(id, _)| *id == name) {
        Some((_, text)) => (*text).to_owned(),
        None => std::fs::read_to_string(name).map_err(|error| {
            complain(&format!(
                "\"{name}\" is neither a bundled norm (see `gershun norm list`) nor a file: {error}"
            ))
        })?,
    };
    Standard::parse(&text, name).map_err(|error| {
        eprintln!("{error}");
        BAD_INPUT
    })
}

fn row_of<'a>(standard: &'a Standard, name: &str, row: &str) -> Result<&'a norm::Row, u8> {
    standard.row(row).ok_or_else(|| {
        let known = standard.rows.iter().map(|row| row.reference.as_str());
        let hint = gershun::project::suggestion(row, known);
        complain(&format!("{name} has no row \"{row}\"; {hint} (`gershun norm show {name}` lists them)"))
    })
}

fn show_norm(name: &str, row: Option<&str>) -> u8 {
    let standard = match read_norm(name) {
        Ok(standard) => standard,
        Err(code) => return code,
    };
    let rows = match row {
        None => standard.rows.iter().collect(),
        Some(row) => match row_of(&standard, name, row) {
            Ok(row) => vec![row],
            Err(code) => return code,
        },
    };
    let mut text =
        format!("{}: {}, {}\n{}\n", standard.short, standard.title, standard.edition, standard.note);
    for entry in rows {
        text.push_str(&format!("\n{}  {}: {}\n", entry.reference, entry.area, entry.task));
        let limits = if row.is_some() { standard.requirements(entry) } else { entry.limits.clone() };
        for limit in limits {
            let statistic = limit.statistic.key();
            let line =
                norm::limit_line(limit.zone, limit.quantity, statistic, limit.bound, limit.verified.key());
            text.push_str(&format!("    {line}\n"));
        }
        for unknown in &entry.unknown {
            let quantity = format!("{} {}", unknown.quantity.key(), unknown.statistic.key());
            text.push_str(&format!("    {:<12} {quantity:<16} unknown   not assessed\n", unknown.zone.key()));
        }
    }
    say(&text)
}

fn explain_norm(name: &str, row: Option<&str>) -> u8 {
    let standard = match read_norm(name) {
        Ok(standard) => standard,
        Err(code) => return code,
    };
    match row.map(|row| row_of(&standard, name, row)) {
        None => say(&norm::explain(&standard)),
        Some(Ok(row)) => say(&norm::explain_row(&standard, row)),
        Some(Err(code)) => code,
    }
}
