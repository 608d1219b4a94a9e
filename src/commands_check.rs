//! Runs `gershun check`: projects → the library's line → table and report → exit code.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use gershun::outcome::{Outcome, Verdict};
use gershun::project::Project;
use gershun::report::words::{Term, phrase};
use gershun::report::{self, Colour, Style};
use gershun::{Progress, Watch};

use crate::args::{Check, ColourChoice, Format, Undecided};
use crate::args_run::LangChoice;
use crate::commands_lamp::faults;
use crate::commands_run::{LateBar, folder, opened, spoken, use_threads, warn};
use crate::{BAD_INPUT, COMPLIES, FAILS, INTERRUPTED, UNDECIDED, complain, remark, say};

/// Runs the command.
pub fn run(check: &Check) -> u8 {
    if check.out.is_some() && check.projects.len() > 1 {
        return complain("--out takes one project; without it each report goes to out/<project name>");
    }
    if let Err(code) = use_threads(check.run.threads) {
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
        remark(&format!("warning: interruption will not keep results: {error}"));
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
    let project = opened(path, check.load_options()).ok()?;
    warn(&project, check.run.quiet);
    if !check.run.quiet {
        for fault in faults(path, &project) {
            remark(&fault);
        }
    }
    Some(project)
}

fn check_one(mut project: Project, check: &Check, interrupted: &AtomicBool) -> u8 {
    let settings = check.settings(&mut project);
    if check.explain_plan {
        return explain(&project);
    }
    let bar = LateBar::new(check.run.quiet, "blocks");
    let tell = |progress: Progress| bar.show(progress.blocks, progress.target, &place(&progress));
    let outcome = match gershun::run(&project, &settings, &Watch { progress: &tell, interrupted }) {
        Ok(outcome) => outcome,
        Err(error) => {
            bar.clear();
            remark(&format!("{error}\n\nnothing was computed"));
            return BAD_INPUT;
        }
    };
    bar.clear();
    let out = folder(check.out.as_deref(), &outcome.info.name);
    let options = report::Options {
        languages: check.lang.map(LangChoice::lang).into_iter().collect(),
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

/// What the bar says beside the count.
fn place(progress: &Progress) -> String {
    let room = if progress.worlds > 1 {
        format!("{} ({} of {})", progress.room, progress.world + 1, progress.worlds)
    } else {
        progress.room.to_owned()
    };
    if progress.open > 0 { format!("{room}, {} still open", progress.open) } else { room }
}

fn print(outcome: &Outcome, check: &Check, out: &Path) -> u8 {
    if check.run.quiet && check.format == Format::Human {
        return COMPLIES;
    }
    let lang = spoken(check.lang, &outcome.info.language);
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
            let page = out.join("report.html").display().to_string();
            let done = phrase(lang, Term::BlocksDone, &[&outcome.solver.blocks.to_string(), stopped]);
            remark(&format!("{done}\n{}", phrase(lang, Term::ReportAt, &[&page])));
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
                    remark(&format!("{error}\n"));
                }
                return BAD_INPUT;
            }
        }
    }
    say(&text)
}
