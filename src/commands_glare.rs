//! Runs `gershun glare`. Images are evaluated in parallel; results keep the order in which the files
//! were named.

use std::path::Path;

use gershun::glare::detect::{Search, Threshold};
use gershun::glare::field::Cone;
use gershun::glare::gradient::{SCALE_DEG, gradient};
use gershun::glare::index::Reading;
use gershun::glare::of_image::{Options, glare_of_image};
use gershun::glare::position_index::PositionModel;
use gershun::glare::source::{DgpForm, Given, Ground};
use gershun::image::{LuminanceImage, asked_view, read};
use gershun::observe::map::{MapMethod, Mapped, approximations, maps};
use gershun::observe::stored::observe_stored;
use gershun::observe::{CONVENTIONS, Observed, Sheets, observe, room_tables};
use gershun::project::read_image;
use gershun::report::Lang;
use gershun::report::glare as report;
use gershun::report::{make_folder, write_file};
use gershun::units::Nits;
use rayon::prelude::*;

use crate::args_glare::{DgpChoice, Glare, GlareFormat, Peak, PositionChoice};
use crate::args_run::LangChoice;
use crate::commands_run::{open, use_threads};
use crate::commands_solve::stored;
use crate::{BAD_INPUT, COMPLIES, complain, remark, say};

/// Multiple of the task's luminance that is the threshold if none is given.
const TASK_FACTOR: f64 = 5.0;

pub fn run(glare: &Glare) -> u8 {
    if let Some(option) = glare.misplaced() {
        let (whose, here) =
            if glare.project.is_some() { ("images", "a project") } else { ("a project", "images") };
        return complain(&format!(
            "{option} is for {whose}, and the glare of {here} is asked for\n  hint: leave it out; gershun glare --help says what is for which"
        ));
    }
    if glare.project.is_none() && glare.image.is_empty() {
        return complain("nothing is named\n  hint: gershun glare PROJECT, or gershun glare --image FILE…");
    }
    if let Some(project) = &glare.project {
        return observers(glare, project);
    }
    if let Err(code) = use_threads(glare.run.threads) {
        return code;
    }
    if glare.check.is_some() && glare.image.len() > 1 {
        return complain("--check draws one image; name one");
    }
    let mask = match glare.mask.as_deref().map(|path| image(path, None)).transpose() {
        Ok(mask) => mask,
        Err(error) => return complain(&error),
    };
    let evaluate = |path: &std::path::PathBuf| -> Result<report::Evaluated, String> {
        let image = image(path, glare.view.as_deref())?;
        let options = options(glare, &image).map_err(|error| format!("{}: {error}", path.display()))?;
        let mut found = glare_of_image(&image, mask.as_ref(), &options)
            .map_err(|undefined| format!("{}: {undefined}{}", path.display(), hint(&image)))?;
        name_options(glare, &mut found.readings);
        let gradient = glare.experimental.then(|| gradient(&image, SCALE_DEG));
        Ok(report::Evaluated { file: path.display().to_string(), glare: found, gradient })
    };
    let (mut worst, mut evaluated) = (COMPLIES, Vec::with_capacity(glare.image.len()));
    for result in glare.image.par_iter().map(evaluate).collect::<Vec<_>>() {
        match result {
            Ok(image) => evaluated.push(image),
            Err(error) => worst = complain(&error),
        }
    }
    let many = glare.image.len() > 1;
    if evaluated.is_empty() && !many {
        return BAD_INPUT;
    }
    if let (Some(path), [only]) = (&glare.check, evaluated.as_slice())
        && let Err(error) = check(path, only)
    {
        return complain(&error);
    }
    let text = match glare.format {
        GlareFormat::Human => Ok(report::images_text(&evaluated)),
        GlareFormat::Json => report::images_json(&evaluated, many),
        GlareFormat::Csv => report::indices_csv(&evaluated),
    };
    match text {
        Ok(text) => worst.max(tell(glare, &text)),
        Err(error) => complain(&error.to_string()),
    }
}

/// What an index asks for and no image shows is given on the command line: where it was not, its reason says by what.
fn name_options(glare: &Glare, readings: &mut [Reading]) {
    let lacking = [
        ("GGR", "--ceiling-coverage SHARE", glare.ceiling_coverage.is_none()),
        ("GR", "--ground LX,RHO", glare.ground.is_none()),
        ("f_TI", "--road L", glare.road.is_none()),
    ];
    for reading in readings {
        let option = lacking.iter().find(|(key, _, is_lacking)| *key == reading.key && *is_lacking);
        if let (Some((_, option, _)), Err(undefined)) = (option, &mut reading.value) {
            undefined.reason = format!("{} (option {option})", undefined.reason);
        }
    }
}

/// Glare of a project's observers.
fn observers(glare: &Glare, path: &Path) -> u8 {
    let project = match open(path, &glare.run) {
        Ok(project) => project,
        Err(code) => return code,
    };
    let conventions = if glare.compare_methods { &CONVENTIONS[..] } else { &CONVENTIONS[..1] };
    let observed = match &glare.field {
        None => observe(&project, conventions, blocks(glare)),
        Some(field) => {
            let sheets = if glare.out.is_some() { Sheets::All } else { Sheets::None };
            match stored(field, &project) {
                Ok(fields) => observe_stored(&project, fields, sheets),
                Err(error) => return complain(&error),
            }
        }
    };
    let maps = if glare.compare_methods || glare.field.is_some() {
        Vec::new()
    } else {
        maps(&project, method(glare))
    };
    // Maps that the project has and nobody computes here, and why.
    let left_out = if glare.compare_methods {
        "glare maps are left out: conventions are compared at viewpoints"
    } else {
        "glare maps are left out: they need a field that was mended for them"
    };
    let has_maps = project.worlds.iter().any(|world| !world.glare_maps.is_empty());
    let left_out = (has_maps && maps.is_empty()).then_some(left_out);
    if observed.is_empty() && maps.is_empty() {
        let what = left_out.map_or("the project has no viewpoint and no glare map".to_owned(), |left_out| {
            format!("the project has no viewpoint; {left_out}")
        });
        return complain(&format!("{what}\n  hint: add [[viewpoint]] with eye and direction"));
    }
    if !glare.run.quiet {
        left_out.into_iter().for_each(remark);
        if glare.format == GlareFormat::Csv {
            observed.first().into_iter().flat_map(|view| &view.approximations).for_each(|said| remark(said));
            for map in &maps {
                for said in approximations(map) {
                    remark(&format!("{}: {said}", map.name));
                }
            }
        }
    }
    let lang = glare.lang.map_or(Lang::En, LangChoice::lang);
    if let Some(out) = &glare.out
        && let Err(error) = write_maps(out, &maps).and_then(|()| write_cards(out, &observed, lang))
    {
        return complain(&error);
    }
    let text = match glare.format {
        GlareFormat::Human if glare.compare_methods => {
            Ok(report::compared_text(&observed) + &report::tables_text(&room_tables(&project)))
        }
        GlareFormat::Human => {
            let maps: Vec<String> = maps.iter().map(report::map_text).collect();
            Ok(report::observed_text(&observed) + &maps.concat())
        }
        GlareFormat::Json => report::observed_json(&observed, &maps),
        GlareFormat::Csv => report::observed_csv(&observed, &maps),
    };
    match text {
        Ok(text) => tell(glare, &text),
        Err(error) => complain(&error.to_string()),
    }
}

/// Prints the results; to people only if they want to hear.
fn tell(glare: &Glare, text: &str) -> u8 {
    if glare.run.quiet && glare.format == GlareFormat::Human { COMPLIES } else { say(text) }
}

/// Blocks of a project where none are asked for.
const BLOCKS: usize = 64;

fn blocks(glare: &Glare) -> usize {
    glare.blocks.map_or(BLOCKS, |blocks| blocks as usize)
}

/// How maps are computed.
fn method(glare: &Glare) -> MapMethod {
    if glare.unbiased { MapMethod::Unbiased(blocks(glare)) } else { MapMethod::default() }
}

/// `glare_map_1.csv` and `.svg` for every map.
fn write_maps(folder: &Path, maps: &[Mapped]) -> Result<(), String> {
    make_folder(folder).map_err(|error| error.to_string())?;
    for (number, map) in maps.iter().enumerate() {
        let table = report::map_csv(map).map_err(|error| error.to_string())?;
        for (extension, text) in [("csv", table), ("svg", report::map_svg(map))] {
            let path = folder.join(format!("glare_map_{}.{extension}", number + 1));
            write_file(&path, text.as_bytes()).map_err(|error| error.to_string())?;
        }
    }
    Ok(())
}

/// `glare_card_1.svg` for every observer's worst direction.
fn write_cards(folder: &Path, observed: &[Observed], lang: Lang) -> Result<(), String> {
    let sheets = observed.iter().filter_map(|view| report::card_svg(view.sheet.as_ref()?, lang));
    for (number, svg) in sheets.enumerate() {
        let path = folder.join(format!("glare_card_{}.svg", number + 1));
        write_file(&path, svg.as_bytes()).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The image of a file; what `view` says, if it is given, takes the place of what the file says.
fn image(path: &Path, view: Option<&str>) -> Result<LuminanceImage, String> {
    let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = read_image(path).map_err(|error| error.to_string())?;
    let mut image = read(&bytes).map_err(|error| at(&error))?;
    if let Some(text) = view {
        let view = asked_view(text, image.view.as_ref())
            .map_err(|error| format!("{}: --view: {error}", path.display()))?;
        image.notes.push(format!("the view is that of the command line: {}", view.to_options()));
        image.view = Some(view);
    }
    Ok(image)
}

fn hint(image: &LuminanceImage) -> String {
    let notes = image.notes.iter().map(|note| format!("\n  note: {note}")).collect::<Vec<_>>().concat();
    let view = "\n  hint: name the view, for example --view \"-vta -vv 180 -vh 180\"";
    if image.view.is_some() { notes } else { notes + view }
}

fn options(glare: &Glare, image: &LuminanceImage) -> Result<Options, String> {
    let task = match (glare.task, image.view) {
        (Some([x, y, opening_rad]), Some(view)) => {
            let place = [x, image.height as f64 - y];
            let direction = view
                .direction(image.size(), place)
                .ok_or("the task's centre lies outside the image's projection")?;
            let axes = [view.right(), view.up(), view.forward()];
            let direction = glam::DVec3::from_array(axes.map(|axis| direction.dot(axis)));
            Some(Cone { direction, opening_rad })
        }
        _ => None,
    };
    let threshold = match (glare.threshold, glare.threshold_factor, task) {
        (Some(luminance), _, _) => Threshold::Absolute(Nits(luminance)),
        (None, Some(factor), Some(task)) => Threshold::TimesTask(factor, task),
        (None, None, Some(task)) => Threshold::TimesTask(TASK_FACTOR, task),
        (None, Some(factor), None) => Threshold::TimesMean(factor),
        (None, None, None) => Search::default().threshold,
    };
    let usual = Options::default();
    Ok(Options {
        search: Search {
            threshold,
            radius_rad: glare.search_radius.unwrap_or(usual.search.radius_rad),
            peak: match glare.peak {
                Some(Peak::Above(luminance)) => Some(Nits(luminance)),
                Some(Peak::None) => None,
                None => usual.search.peak,
            },
        },
        position: match glare.position_index {
            Some(PositionChoice::Levin) | None => PositionModel::Levin,
            Some(PositionChoice::Table) => PositionModel::Table,
        },
        given: Given {
            age_years: glare.age,
            low_light: glare.low_light,
            ceiling_coverage: glare.ceiling_coverage,
            ground: glare.ground.map(|[mean_lx, reflectance]| Ground { mean_lx, reflectance }),
            road: glare.road.map(Nits),
            dgp: match glare.dgp {
                Some(DgpChoice::Evalglare) | None => DgpForm::Evalglare,
                Some(DgpChoice::Published) => DgpForm::Published,
            },
            ..usual.given
        },
        measured_e_v_lx: glare.measured_ev,
        task,
        band_rad: glare.band,
    })
}

fn check(path: &Path, image: &report::Evaluated) -> Result<(), String> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let bytes = match extension.as_str() {
        "png" => report::check_png(image),
        "svg" => report::check_svg(image).into_bytes(),
        _ => {
            return Err(format!(
                "{}: a check picture is .png or .svg\n  hint: name a file with one of them",
                path.display()
            ));
        }
    };
    write_file(path, &bytes).map_err(|error| error.to_string())
}
