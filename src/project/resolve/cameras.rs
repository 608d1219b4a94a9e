//! `[[camera]]` → views. Without `fisheye` a camera is a perspective of `fov` degrees across; a
//! fisheye of 180° sees all that an eye at its place could.

use glam::DVec3;

use super::draft::{Draft, Located, locate};
use crate::image::{MOST_PIXELS, Projection, View};
use crate::project::Camera;
use crate::project::context::Context;
use crate::project::schema::{CameraSection, File, Fisheye};

/// Columns and rows where a camera states none.
const SIZE: [usize; 2] = [1000, 1000];
/// Degrees across where a perspective states none.
const FOV_DEG: f64 = 60.0;
/// Most columns or rows.
const LONGEST: u32 = 32_000;

/// Adds all cameras to their worlds.
pub fn add(file: &File, drafts: &mut [Draft], context: &mut Context) {
    for section in &file.cameras {
        let span = section.span();
        let section = section.get_ref();
        let name = section.name.get_ref();
        if drafts.iter().any(|draft| draft.cameras.iter().any(|other| other.name == *name)) {
            context.error(&section.name.span(), format!("a second camera \"{name}\""), "");
            continue;
        }
        let size = match &section.size {
            None => SIZE,
            Some(given) => {
                let [width, height] = *given.get_ref();
                let fits = (1..=LONGEST).contains(&width)
                    && (1..=LONGEST).contains(&height)
                    && width as usize * height as usize <= MOST_PIXELS;
                if !fits {
                    let message = format!("a picture of {width} × {height} pixels");
                    let hint = "at most 32 000 columns or rows and 64 million pixels";
                    context.error(&given.span(), message, hint);
                    continue;
                }
                [width as usize, height as usize]
            }
        };
        let eye = DVec3::from_array(*section.eye.get_ref());
        let direction = match (&section.direction, &section.target) {
            (Some(direction), None) => DVec3::from_array(*direction.get_ref()),
            (None, Some(target)) => DVec3::from_array(*target.get_ref()) - eye,
            (Some(_), Some(target)) => {
                context.error(&target.span(), "give either `direction` or `target`", "");
                continue;
            }
            (None, None) => {
                let hint = "direction = [x, y, z] or target = [x, y, z]";
                context.missing(&span, "the camera looks nowhere", hint);
                continue;
            }
        };
        let up =
            section.up.as_ref().map_or_else(|| upwards(direction), |up| DVec3::from_array(*up.get_ref()));
        let view = match View::new(projection(section, size), eye, direction, up) {
            Ok(view) => view,
            Err(error) => {
                context.error(&span, format!("camera \"{name}\": {error}"), "");
                continue;
            }
        };
        let camera = Camera { name: name.clone(), room: 0, view, size };
        match locate(drafts, eye) {
            Located::In(world, room) => drafts[world].cameras.push(Camera { room, ..camera }),
            Located::Outside if drafts.is_empty() => {}
            Located::Outside => {
                let message = format!("camera \"{name}\" stands outside of every room");
                context.error(&section.eye.span(), message, "");
            }
            Located::Ambiguous(rooms) => {
                let message = format!("camera \"{name}\" stands in more than one room: {rooms}");
                context.error(&section.eye.span(), message, "");
            }
        }
    }
}

/// Z, or Y for a camera that looks straight up or down.
fn upwards(direction: DVec3) -> DVec3 {
    if direction.normalize_or_zero().z.abs() > 1.0 - 1e-9 { DVec3::Y } else { DVec3::Z }
}

fn projection(section: &CameraSection, size: [usize; 2]) -> Projection {
    let given = section.fov.as_ref().map(|fov| *fov.get_ref());
    let across = given.unwrap_or(if section.fisheye.is_some() { 180.0 } else { FOV_DEG });
    let (horizontal_deg, vertical_deg) = (across, across);
    let projection = match section.fisheye {
        None => Projection::Perspective { horizontal_deg, vertical_deg },
        Some(Fisheye::Angular) => Projection::AngularFisheye { horizontal_deg, vertical_deg },
        Some(Fisheye::Hemispherical) => Projection::HemisphericalFisheye { horizontal_deg, vertical_deg },
    };
    projection.with_square_pixels(size)
}
