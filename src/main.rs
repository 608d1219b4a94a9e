//! Arguments → library → printed diagnostics → exit code. Results go to standard output, progress
//! and diagnostics to standard error.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the one place that prints")]

mod args;
mod args_body;
mod args_glare;
mod args_lamp;
mod args_run;
mod args_solve;
mod args_view;
mod commands_body;
mod commands_check;
mod commands_glare;
mod commands_lamp;
mod commands_norm;
mod commands_run;
mod commands_solve;
mod commands_view;

use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use gershun::{norm, report};

use crate::args::{Cli, Command, Norm, Schema};

/// Exit codes of the contract with scripts.
const COMPLIES: u8 = 0;
const FAILS: u8 = 1;
const BAD_INPUT: u8 = 2;
const UNDECIDED: u8 = 3;
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    let code = match Cli::parse().command {
        Command::Check(check) => commands_check::run(&check),
        Command::New { dir } => new_project(&dir),
        Command::Schema { of: Schema::Result } => say(report::schema()),
        Command::Schema { of: Schema::Norm } => say(norm::schema()),
        Command::Glare(command) => commands_glare::run(&command),
        Command::Solve(solve) => commands_solve::run(&solve),
        Command::Body(body) => commands_body::run(&body),
        Command::View(view) => commands_view::run(&view),
        Command::Lamp(command) => commands_lamp::run(&command),
        Command::Explain { code, lang } => commands_lamp::explain(&code, lang.lang()),
        Command::Norm(Norm::List) => commands_norm::list(),
        Command::Norm(Norm::Show { name, row }) => commands_norm::show(&name, row.as_deref()),
        Command::Norm(Norm::Explain { name, row }) => commands_norm::explain(&name, row.as_deref()),
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

fn new_project(dir: &Path) -> u8 {
    if dir.exists() {
        return complain(&format!("{} exists already; name a new folder", dir.display()));
    }
    let name = dir.file_name().unwrap_or_default().to_string_lossy();
    let text = include_str!("../scenes/box/project.toml")
        .replacen("name = \"box\"", &format!("name = {}", toml::Value::from(name.as_ref())), 1)
        .replace("out/box", &format!("out/{}", commands_run::folder_name(&name).display()))
        .replace("scenes/box", &dir.display().to_string());
    let made = std::fs::create_dir_all(dir).and_then(|()| std::fs::write(dir.join("project.toml"), text));
    match made {
        Ok(()) => say(&format!("{}\n", dir.join("project.toml").display())),
        Err(error) => complain(&format!("{}: {error}", dir.display())),
    }
}
