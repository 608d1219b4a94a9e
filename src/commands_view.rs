//! Runs `gershun view`: cameras → field → pictures → files.

use gershun::field::store::StoredField;
use gershun::image::{LuminanceImage, Projection, View};
use gershun::measure::weights;
use gershun::project::{Project, World, suggestion};
use gershun::query::Demand;
use gershun::report::picture::{Album, Format, Shot, Way, write};
use gershun::solve::picture::{Detail, Exposure, expose, from_store, omissions, render, replicate};
use gershun::solve::{Effort, Method, Prepared, prepare};

use crate::args_view::{FormatChoice, View as Arguments};
use crate::commands_run::{LateBar, folder, light_scene, open, spoken};
use crate::commands_solve::stored;
use crate::{COMPLIES, complain, remark, say};

/// Columns and rows of a fisheye at a viewpoint.
const FISHEYE: [usize; 2] = [800, 800];

/// A picture to be taken.
struct Wanted {
    world: usize,
    room: usize,
    name: String,
    view: View,
    size: [usize; 2],
    light_scene: usize,
}

/// What the pictures of one world are taken from.
enum Source<'w> {
    Field(Box<Exposure<'w>>, Detail),
    Blocks(Box<Prepared<'w>>, u32),
}

/// Runs the command.
pub fn run(arguments: &Arguments) -> u8 {
    let project = match open(&arguments.project, &arguments.run) {
        Ok(project) => project,
        Err(code) => return code,
    };
    let wanted = match wanted(&project, arguments) {
        Ok(wanted) => wanted,
        Err(message) => return complain(&message),
    };
    let stored = match arguments.field.as_deref().map(|path| stored(path, &project)).transpose() {
        Ok(stored) => stored,
        Err(message) => return complain(&message),
    };
    let of_field = stored.as_ref().and_then(|fields| fields.first()).map(|field| field.made.seed);
    let seed = of_field.unwrap_or(project.accuracy.seed);
    let shots = take_all(&project, &wanted, stored, arguments);
    let album = Album { project: &project.info.name, seed, inputs: &project.inputs, shots };
    let out = folder(arguments.out.as_deref(), &project.info.name);
    let formats: Vec<Format> = arguments.format.iter().map(|format| chosen(*format)).collect();
    let lang = spoken(arguments.lang, &project.info.language);
    if let Err(error) = write(&album, &out, &formats, lang) {
        return complain(&error.to_string());
    }
    if arguments.run.quiet {
        return COMPLIES;
    }
    let lines: Vec<String> = album.shots.iter().map(line).collect();
    let printed = say(&lines.concat());
    remark(&format!("pictures: {}", out.join("views").display()));
    printed
}

fn chosen(format: FormatChoice) -> Format {
    match format {
        FormatChoice::Exr => Format::Exr,
        FormatChoice::Hdr => Format::Hdr,
        FormatChoice::Svg => Format::Svg,
        FormatChoice::Png => Format::Png,
    }
}

/// One line per picture for the terminal.
fn line(shot: &Shot) -> String {
    let values = &shot.image.luminance_cd_m2;
    let largest = values.iter().copied().fold(0.0, f64::max);
    let lx = shot.illuminance_lx.map_or(String::new(), |lx| format!(" · {lx:.1} lx from the picture"));
    let error = match (shot.way, shot.median_relative_error()) {
        (Way::Blocks(blocks), Some(error)) => {
            format!("{blocks} blocks, median standard error {:.1} %", 100.0 * error)
        }
        _ => "no interval".to_owned(),
    };
    let [width, height] = shot.image.size();
    format!(
        "{} · {} · {width} × {height} · at most {largest:.0} cd/m²{lx} · {error}\n",
        shot.name, shot.light_scene
    )
}

/// Those that were asked for by name, cameras or viewpoints; else all cameras, or all viewpoints where
/// there is none.
fn wanted(project: &Project, arguments: &Arguments) -> Result<Vec<Wanted>, String> {
    let asked = arguments.light_scene.as_ref().map(|name| light_scene(project, name)).transpose()?;
    let mut all = Vec::new();
    for (index, world) in project.worlds.iter().enumerate() {
        for camera in &world.cameras {
            let (size, view) = sized(&camera.name, camera.view, camera.size, arguments.size)?;
            let light_scene = asked.unwrap_or(0);
            let (name, room) = (camera.name.clone(), camera.room);
            all.push(Wanted { world: index, room, name, view, size, light_scene });
        }
    }
    let no_camera = all.is_empty();
    if no_camera || !arguments.camera.is_empty() {
        all.extend(viewpoints(project, arguments, asked)?);
        if no_camera && !all.is_empty() && !arguments.run.quiet {
            remark("the project has no [[camera]]: its viewpoints are shown as fisheyes of 180°");
        }
    }
    if all.is_empty() {
        return Err("nothing to show from\n  hint: add a [[camera]] with name, eye and direction".into());
    }
    for name in &arguments.camera {
        if !all.iter().any(|wanted| wanted.name == *name) {
            let hint = suggestion(name, all.iter().map(|wanted| wanted.name.as_str()));
            return Err(format!("no camera \"{name}\"\n  hint: {hint}"));
        }
    }
    all.retain(|wanted| arguments.camera.is_empty() || arguments.camera.contains(&wanted.name));
    Ok(all)
}

/// Every viewpoint, a sweep by its first direction.
fn viewpoints(project: &Project, arguments: &Arguments, asked: Option<usize>) -> Result<Vec<Wanted>, String> {
    let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let mut all = Vec::new();
    for (index, world) in project.worlds.iter().enumerate() {
        for viewpoint in &world.viewpoints {
            let direction = viewpoint.directions[0];
            let up = if direction.z.abs() > 1.0 - 1e-9 { glam::DVec3::Y } else { glam::DVec3::Z };
            let view = View::new(fisheye, viewpoint.eye, direction, up).map_err(|error| error.to_string())?;
            let (size, view) = sized(&viewpoint.name, view, FISHEYE, arguments.size)?;
            all.push(Wanted {
                world: index,
                room: viewpoint.room,
                name: viewpoint.name.clone(),
                view,
                size,
                light_scene: asked.or(viewpoint.light_scene).unwrap_or(0),
            });
        }
    }
    Ok(all)
}

/// A view in the size that was asked for, its pixels square.
fn sized(
    name: &str,
    view: View,
    own: [usize; 2],
    asked: Option<[usize; 2]>,
) -> Result<([usize; 2], View), String> {
    let Some(size) = asked else { return Ok((own, view)) };
    let projection = view.projection.with_square_pixels(size);
    let view = View::new(projection, view.eye, view.forward(), view.up()).map_err(|_| {
        let [width, height] = size;
        format!("{name}: a picture of {width}x{height} would show more from top to bottom than its projection has\n  hint: take a size that is wider for its height, or other cameras by --camera")
    })?;
    Ok((size, view))
}

fn take_all(
    project: &Project,
    wanted: &[Wanted],
    stored: Option<Vec<StoredField>>,
    arguments: &Arguments,
) -> Vec<Shot> {
    let demand = Demand::default();
    let mut stored: Vec<Option<StoredField>> = match stored {
        Some(fields) => fields.into_iter().map(Some).collect(),
        None => project.worlds.iter().map(|_| None).collect(),
    };
    let seed = project.accuracy.seed;
    let mut shots = Vec::with_capacity(wanted.len());
    for (index, world) in project.worlds.iter().enumerate() {
        let here: Vec<&Wanted> = wanted.iter().filter(|wanted| wanted.world == index).collect();
        if here.is_empty() {
            continue;
        }
        let source = if let Some(blocks) = arguments.blocks {
            let effort = Effort { gather: 1, ..Effort::default() };
            let prepared = prepare(&world.scene, &demand, Method::Links, effort, seed);
            Source::Blocks(Box::new(prepared), blocks)
        } else {
            let exposure = match stored[index].take() {
                Some(stored) => from_store(&world.scene, stored),
                None => expose(&world.scene, seed),
            };
            let detail = if arguments.preview { Detail::Stored } else { Detail::Exact };
            Source::Field(Box::new(exposure), detail)
        };
        for wanted in here {
            shots.push(take(project, world, wanted, &source, arguments.run.quiet));
        }
    }
    shots
}

fn take(project: &Project, world: &World, wanted: &Wanted, source: &Source, quiet: bool) -> Shot {
    let light_scene = &project.light_scenes[wanted.light_scene];
    let weights = weights(world, light_scene, &world.rooms[wanted.room], false);
    let (image, way, mut biases) = match source {
        Source::Field(exposure, detail) => {
            let bar = LateBar::new(quiet, "rows");
            let tell = |rows| bar.show(rows, wanted.size[1], &wanted.name);
            let picture = exposure.picture(&weights, *detail);
            let (image, _) = render(&picture, &wanted.view, wanted.size, &tell);
            bar.clear();
            let way = match detail {
                Detail::Stored => Way::Stored,
                Detail::Exact => Way::Exact,
            };
            (image, way, omissions(&world.scene, *detail))
        }
        Source::Blocks(prepared, blocks) => {
            let bar = LateBar::new(quiet, "blocks");
            let image = mean(prepared, wanted, &weights, *blocks, &bar);
            bar.clear();
            (image, Way::Blocks(*blocks), Vec::new())
        }
    };
    biases.extend(project.biases.iter().cloned());
    Shot {
        name: wanted.name.clone(),
        light_scene: light_scene.name.clone(),
        illuminance_lx: image.illuminance_lx(),
        image,
        way,
        biases,
    }
}

/// Mean of the blocks and its standard error, pixel by pixel (Welford's recurrence).
fn mean(prepared: &Prepared, wanted: &Wanted, weights: &[f64], blocks: u32, bar: &LateBar) -> LuminanceImage {
    let [width, height] = wanted.size;
    let (mut mean, mut squares) = (vec![0.0; width * height], vec![0.0; width * height]);
    for block in 0..blocks {
        let values = replicate(prepared, &wanted.view, wanted.size, weights, u64::from(block));
        for ((mean, square), value) in mean.iter_mut().zip(&mut squares).zip(values) {
            let off = value - *mean;
            *mean += off / f64::from(block + 1);
            *square += off * (value - *mean);
        }
        bar.show(block as usize + 1, blocks as usize, &wanted.name);
    }
    let count = f64::from(blocks) * f64::from(blocks - 1);
    let mut image = LuminanceImage::new(width, height, Some(wanted.view), mean);
    image.standard_error_cd_m2 =
        Some(squares.into_iter().map(|square: f64| (square / count).sqrt()).collect());
    image
}
