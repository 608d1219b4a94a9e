//! Runs `gershun lamp …`. Files are read and examined in parallel; results keep the order in which
//! the files were named.

use std::path::{Path, PathBuf};

use gershun::lamp::convert::Target;
use gershun::lamp::{self, RULES, Severity, installed, rules};
use gershun::photometry::Finding;
use gershun::project::{Project, is_same_file, read_photometry, suggestion};
use gershun::report::words::{Lang, found};
use gershun::report::{lamp as report, write_file};
use gershun::solve::far_field::{self, FarDemand};
use rayon::prelude::*;

use crate::args_lamp::{FarFieldArgs, InfoFormat, Lamp, LintFormat, TableFormat};
use crate::commands_run::open;
use crate::{BAD_INPUT, COMPLIES, FAILS, complain, remark, say};

pub fn run(command: &Lamp) -> u8 {
    match command {
        Lamp::Info { files, format, lang } => info(files, *format, lang.lang()),
        Lamp::Lint { files, format, lang } => lint(files, *format, lang.lang()),
        Lamp::UgrTable { files, shr, format, lang } => ugr_table(files, *shr, *format, lang.lang()),
        Lamp::Polar { file, out, lang } => {
            polar(file, out.as_deref(), lang.lang()).unwrap_or_else(|error| complain(&error))
        }
        Lamp::Convert { input, output, lang } => {
            convert(input, output, lang.lang()).unwrap_or_else(|error| complain(&error))
        }
        Lamp::FarField(args) => match open(&args.project, &args.run) {
            Ok(project) => far_field(args, &project).unwrap_or_else(|error| complain(&error)),
            Err(code) => code,
        },
    }
}

/// All files in their order. Those that cannot be opened are complained about, and `listed` among the others
/// for programs, which read standard output alone.
fn read_all(files: &[PathBuf], listed: bool) -> (Vec<report::Batch>, u8) {
    let read = |path: &PathBuf| -> Result<report::Batch, String> {
        let bytes = read_photometry(path).map_err(|error| error.to_string())?;
        let file = path.display().to_string();
        let read = lamp::read(&bytes, &file).map_err(|error| lamp::unreadable(&error));
        Ok(report::Batch { file, read })
    };
    let mut worst = COMPLIES;
    let mut batch = Vec::with_capacity(files.len());
    for (path, result) in files.iter().zip(files.par_iter().map(read).collect::<Vec<_>>()) {
        match result {
            Ok(file) => batch.push(file),
            Err(error) => {
                worst = complain(&error);
                if listed {
                    let finding = Finding::new("unreadable", None, "it cannot be opened", error);
                    batch.push(report::Batch { file: path.display().to_string(), read: Err(finding) });
                }
            }
        }
    }
    (batch, worst)
}

fn print(text: Result<String, gershun::report::ReportError>) -> u8 {
    match text {
        Ok(text) => say(&text),
        Err(error) => complain(&error.to_string()),
    }
}

fn info(files: &[PathBuf], format: InfoFormat, lang: Lang) -> u8 {
    let (batch, opened) = read_all(files, format != InfoFormat::Human);
    let printed = print(match format {
        InfoFormat::Human => Ok(report::info_text(&batch, lang)),
        InfoFormat::Json => report::info_json(&batch),
    });
    let unreadable = batch.iter().any(|file| file.read.is_err());
    opened.max(printed).max(if unreadable { BAD_INPUT } else { COMPLIES })
}

fn lint(files: &[PathBuf], format: LintFormat, lang: Lang) -> u8 {
    let (batch, opened) = read_all(files, format != LintFormat::Human);
    let printed = print(match format {
        LintFormat::Human => Ok(report::lint_human(&batch, lang)),
        LintFormat::Json => report::lint_json(&batch),
        LintFormat::Sarif => Ok(report::lint_sarif(&batch)),
    });
    let grave = |finding: &Finding| rules::severity(finding.code) == Severity::Error;
    let failed = batch.iter().any(|file| match &file.read {
        Ok(lamps) => lamps.iter().flat_map(|lamp| &lamp.findings).any(grave),
        Err(finding) => grave(finding),
    });
    opened.max(printed).max(if failed { FAILS } else { COMPLIES })
}

fn ugr_table(files: &[PathBuf], shr: f64, format: TableFormat, lang: Lang) -> u8 {
    let (batch, mut worst) = read_all(files, false);
    let contained: usize = batch.iter().map(|file| file.read.as_ref().map_or(0, Vec::len)).sum();
    let mut tables = Vec::new();
    let mut text = String::new();
    for file in &batch {
        let lamps = match &file.read {
            Ok(lamps) => lamps,
            Err(finding) => {
                let [message, consequence] =
                    [&finding.message, &finding.consequence].map(|text| found(lang, text));
                worst = complain(&format!("{}: {message}: {consequence}", file.file));
                continue;
            }
        };
        for lamp in lamps {
            match lamp::ugr::ugr_table(&lamp.photometry, shr) {
                Ok(table) => {
                    if !text.is_empty() {
                        text.push('\n');
                    }
                    text.push_str(&report::ugr_text(
                        &lamp.file,
                        lamp.photometry.distribution.flux().0,
                        &table,
                        lang,
                    ));
                    tables.push((lamp.file.clone(), table));
                }
                Err(undefined) => {
                    worst = complain(&format!("{}: {}", lamp.file, found(lang, &undefined.reason)));
                }
            }
        }
    }
    let printed = print(match format {
        TableFormat::Human => Ok(text),
        TableFormat::Csv => report::ugr_csv(&tables, files.len() > 1 || contained > 1),
    });
    worst.max(printed)
}

fn read_only(path: &Path) -> Result<lamp::Lamp, String> {
    let bytes = read_photometry(path).map_err(|error| error.to_string())?;
    let lamps = lamp::read(&bytes, &path.display().to_string()).map_err(|error| error.to_string())?;
    let names: Vec<&str> = lamps.iter().map(|lamp| lamp.file.as_str()).collect();
    let several =
        format!("{} photometries: {}\n  hint: unpack the one you need", names.len(), names.join(", "));
    let [only] = <[lamp::Lamp; 1]>::try_from(lamps).map_err(|_| several)?;
    Ok(only)
}

fn polar(file: &Path, out: Option<&Path>, lang: Lang) -> Result<u8, String> {
    let is_svg = |out: &Path| out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
    if let Some(out) = out.filter(|out| !is_svg(out)) {
        return Err(format!("{}: the diagram is an SVG\n  hint: name a file .svg", out.display()));
    }
    let svg = report::polar(&read_only(file)?, lang);
    let Some(out) = out else {
        return Ok(say(&svg));
    };
    write_file(out, svg.as_bytes()).map_err(|error| error.to_string())?;
    Ok(COMPLIES)
}

fn convert(input: &Path, output: &Path, lang: Lang) -> Result<u8, String> {
    let target = target_of(output)?;
    if is_same_file(input, output) {
        return Err(format!("{} would replace itself\n  hint: name another file", input.display()));
    }
    let lamp = read_only(input)?;
    let converted = lamp::convert::convert(&lamp.photometry, target)
        .map_err(|error| format!("{}: {error}", input.display()))?;
    write_file(output, &converted.bytes).map_err(|error| error.to_string())?;
    Ok(say(&format!("{}\n{}", output.display(), report::dropped(&converted.dropped, lang))))
}

/// A line for each photometric file of a project that has faults.
pub fn faults(path: &Path, project: &Project) -> Vec<String> {
    let mut told = Vec::new();
    let folder = if path.is_dir() { path } else { path.parent().unwrap_or(path) };
    let luminaires = project.worlds.iter().flat_map(|world| &world.scene.luminaires);
    let mut files: Vec<&str> = luminaires.map(|luminaire| luminaire.kind.file.as_str()).collect();
    files.sort_unstable();
    files.dedup();
    for file in files.into_iter().filter(|file| !file.is_empty()) {
        let path = folder.join(file);
        let Ok(bytes) = read_photometry(&path) else { continue };
        let Ok(lamps) = lamp::read(&bytes, file) else { continue };
        let mut codes: Vec<&str> = lamps
            .iter()
            .flat_map(|lamp| &lamp.findings)
            .map(|finding| finding.code)
            .filter(|code| rules::severity(code) != Severity::Note)
            .collect();
        codes.sort_unstable();
        codes.dedup();
        if !codes.is_empty() {
            let (codes, path) = (codes.join(", "), path.display());
            told.push(format!(
                "warning: {file}: {codes}; `gershun lamp lint {path}` says what follows from it"
            ));
        }
    }
    told
}

/// Steps of angle that a table may have, degrees.
const STEPS_DEG: std::ops::RangeInclusive<f64> = 0.5..=45.0;

fn far_field(args: &FarFieldArgs, project: &Project) -> Result<u8, String> {
    for (name, step, whole) in [("--c-step", args.c_step, 360.0), ("--gamma-step", args.gamma_step, 180.0)] {
        let steps = whole / step;
        if !STEPS_DEG.contains(&step) || (steps - steps.round()).abs() > 1e-9 {
            let (least, most) = (STEPS_DEG.start(), STEPS_DEG.end());
            return Err(format!(
                "{name} {step}: needs {least} to {most}, and a whole number of steps in {whole}°"
            ));
        }
    }
    if args.blocks < 32 {
        return Err(format!("--blocks {}: an interval needs at least 32", args.blocks));
    }
    let target = match &args.out {
        Some(out) => Some((out, target_of(out)?)),
        None => None,
    };
    let chosen = installed::choose(project, &args.group, args.light_scene.as_deref())
        .map_err(|error| format!("{}: {error}", args.project.display()))?;
    let (azimuths_deg, gammas_deg) = far_field::axes(args.c_step, args.gamma_step);
    let demand = FarDemand {
        luminaires: chosen.luminaires.clone(),
        azimuths_deg,
        gammas_deg,
        particles: 1000,
        directions: 64,
        opening_points: 4,
        blocks: args.blocks,
        seed: project.accuracy.seed,
    };
    let field = far_field::far_field(&chosen.world.scene, &demand);
    let name = [project.info.name.as_str(), &args.group.join(" ")].join(" ");
    let photometry = installed::photometry(&field, &chosen, name.trim()).ok_or_else(|| {
        format!(
            "{}: no light leaves the scene\n  hint: the far field is that of luminaires seen from outside; leave the \
             room's walls out of the CAD file",
            args.project.display()
        )
    })?;
    let mut text = String::new();
    if let Some((apparent_m2, luminous_m2)) = installed::spread(&photometry, &chosen)
        && !args.run.quiet
    {
        remark(&format!(
            "the file's luminous area is the rectangle around all openings, {apparent_m2:.2} m², of which {luminous_m2:.2} m² \
             shine: luminance and UGR from this file are too low, illuminance is not concerned"
        ));
    }
    if let Some((out, target)) = target {
        let converted = lamp::convert::convert(&photometry, target).map_err(|error| error.to_string())?;
        write_file(out, &converted.bytes).map_err(|error| error.to_string())?;
        text.push_str(&format!("{}\n", out.display()));
    }
    Ok(match args.format {
        InfoFormat::Human if args.run.quiet => COMPLIES,
        InfoFormat::Human => say(&(text + &report::far_field_text(&field, args.lang.lang()))),
        InfoFormat::Json => print(report::far_field_json(&field)),
    })
}

fn target_of(output: &Path) -> Result<Target, String> {
    let extension = output.extension().unwrap_or_default().to_string_lossy();
    Target::of_extension(&extension).ok_or_else(|| {
        format!("{}: unknown format \".{extension}\"\n  hint: name a file .ies or .ldt", output.display())
    })
}

/// The explanation of a finding's code.
pub fn explain(code: &str, lang: Lang) -> u8 {
    if let Some(text) = report::explanation(code, lang) {
        return say(&text);
    }
    let hint = suggestion(code, RULES.iter().map(|rule| rule.code));
    complain(&format!("no finding has the code \"{code}\"\n  hint: {hint}"))
}
