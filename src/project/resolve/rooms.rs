//! Rooms and the worlds they stand in: a world for the box or the CAD file, and one for each room
//! given by its footprint.

use glam::DVec2;

use super::cad;
use super::draft::{Draft, RoomFactors};
use super::materials::{Palette, mean_reflectance};
use super::shell::Shell;
use super::walled::{Boundary, walled_draft};
use crate::geometry::polygon;
use crate::project::context::Context;
use crate::project::schema::{At, BoxSection, File, RoomSection};
use crate::project::{Modification, Room};

/// Builds all worlds with their rooms.
pub fn drafts(file: &File, project_name: &str, palette: &mut Palette, context: &mut Context) -> Vec<Draft> {
    let mut drafts = Vec::new();
    let sections = &file.rooms;
    check_names(sections, context);
    let within: Vec<&At<RoomSection>> =
        sections.iter().filter(|room| room.get_ref().footprint.is_none()).collect();
    let scene = file.scene.as_ref().map(|scene| (scene, scene.get_ref()));
    match scene {
        Some((_, scene)) if scene.file.is_some() && scene.room.is_none() => {
            let path = scene.file.as_ref().expect("guarded above");
            drafts.extend(cad::draft(path, &within, project_name, palette, context));
        }
        Some((_, scene)) if scene.room.is_some() && scene.file.is_none() => {
            let section = scene.room.as_ref().expect("guarded above");
            drafts.extend(box_draft(section, &within, project_name, palette, context));
        }
        Some((at, _)) => {
            let hint = "[scene] file = \"office.glb\", or box = { size = [8, 5, 2.8], … }";
            context.error(&at.span(), "a scene is either `file` or `box`", hint);
        }
        None if file.rooms_lost => {}
        None => {
            for room in within {
                let message = format!(
                    "room \"{}\" has no footprint, and there is no [scene]",
                    room.get_ref().name.get_ref()
                );
                context.error(&room.get_ref().name.span(), message, "");
            }
            if sections.is_empty() {
                let hint = "add [scene] with `file` or `box`, or a [[room]] with a footprint";
                context.error(&(0..0), "the project has no scene and no room", hint);
            }
        }
    }
    for section in sections.iter().filter(|room| room.get_ref().footprint.is_some()) {
        drafts.extend(footprint_draft(section.get_ref(), palette, context));
    }
    drafts
}

/// A room's own keys; the boundary comes from elsewhere.
pub fn add_room(
    draft: &mut Draft,
    section: Option<&RoomSection>,
    name: &str,
    boundary: (Vec<DVec2>, f64, f64),
    shell: &Shell,
    context: &mut Context,
) {
    let (footprint, floor_m, height_m) = boundary;
    let mut factors = RoomFactors::default();
    let mut rsmf = 1.0;
    check_extent(&footprint, height_m, name, section, draft, context);
    if let Some(mf) = section.and_then(|section| section.mf.as_ref()) {
        let span = mf.span();
        let mf = mf.get_ref();
        let mut factor = |value: &Option<At<f64>>, name: &str| {
            let value = value.as_ref()?;
            check_factor(value, name, context).then_some(*value.get_ref())
        };
        factors = RoomFactors {
            span,
            llmf: factor(&mf.llmf, "llmf"),
            lsf: factor(&mf.lsf, "lsf"),
            lmf: factor(&mf.lmf, "lmf"),
        };
        rsmf = factor(&mf.rsmf, "rsmf").unwrap_or(1.0);
    }
    let reflectances =
        [(&shell.ceiling, 0.7, "ceiling"), (&shell.walls, 0.5, "walls"), (&shell.floor, 0.2, "floor")].map(
            |(surfaces, usual, part)| {
                mean_of(draft, surfaces).unwrap_or_else(|| {
                    context.note(format!(
                "room \"{name}\": no {part} with a reflectance was recognised; the UGR table takes {usual}"
            ));
                    usual
                })
            },
        );
    let indices = |part: &[(u32, f64)]| part.iter().map(|(surface, _)| *surface).collect();
    draft.rooms.push(Room {
        name: name.to_owned(),
        number: section.and_then(|s| s.number.clone()).unwrap_or_default(),
        footprint,
        floor_m,
        height_m,
        row: section.and_then(|s| s.row.as_ref().map(|row| row.get_ref().clone())),
        modified: section.and_then(|s| s.modified.as_ref()).map(|modified| Modification {
            steps: modified.get_ref().steps.as_ref().map(|steps| *steps.get_ref()),
            reason: modified.get_ref().reason.get_ref().trim().to_owned(),
        }),
        rsmf,
        reflectances,
        walls: indices(&shell.walls),
        ceiling: indices(&shell.ceiling),
        floor: indices(&shell.floor),
        luminaires: Vec::new(),
    });
    draft.factors.push(factors);
}

/// Longest room that is not asked about, m.
const LONGEST_M: f64 = 1000.0;

/// Rooms beyond a kilometre are drawn in millimetres more often than they are built.
fn check_extent(
    footprint: &[DVec2],
    height_m: f64,
    name: &str,
    section: Option<&RoomSection>,
    draft: &Draft,
    context: &mut Context,
) {
    let low = footprint.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let high = footprint.iter().copied().reduce(DVec2::max).unwrap_or_default();
    let size = high - low;
    if !(size.max_element().max(height_m) > LONGEST_M) {
        return;
    }
    let span = section.map_or_else(|| draft.span.clone(), |section| section.name.span());
    let message = format!("room \"{name}\" measures {:.0} m × {:.0} m × {height_m:.0} m", size.x, size.y);
    let hint = if draft.cad {
        "glTF counts in metres: a drawing in millimetres is exported with the scale 0.001"
    } else {
        "lengths are metres: 6000 mm are 6"
    };
    context.warn(&span, message, hint);
}

/// A maintenance factor: greater than 0, at most 1.
pub fn check_factor(value: &At<f64>, name: &str, context: &mut Context) -> bool {
    let ok = *value.get_ref() > 0.0 && *value.get_ref() <= 1.0;
    if !ok {
        let message = format!("{name} must be greater than 0 and at most 1, found {}", value.get_ref());
        context.error(&value.span(), message, "");
    }
    ok
}

/// Mean reflectance weighted by area in m²; panes do not count.
fn mean_of(draft: &Draft, part: &[(u32, f64)]) -> Option<f64> {
    let (mut sum, mut total) = (0.0, 0.0);
    for &(surface, area_m2) in part {
        let material = draft.mesh.surfaces[surface as usize].material;
        if let Some(reflectance) = mean_reflectance(&draft.materials[material].bsdf) {
            sum += area_m2 * reflectance;
            total += area_m2;
        }
    }
    (total > 0.0).then(|| sum / total)
}

fn check_names(sections: &[At<RoomSection>], context: &mut Context) {
    for (index, section) in sections.iter().enumerate() {
        let RoomSection { name, footprint, node, height, floor, reflectances, .. } = section.get_ref();
        if name.get_ref().trim().is_empty() {
            context.error(&name.span(), "the room's name is empty", "");
        }
        let earlier = &sections[..index];
        if earlier.iter().any(|other| other.get_ref().name.get_ref() == name.get_ref()) {
            let message = format!("a second room \"{}\"", name.get_ref());
            context.error(&name.span(), message, "names of rooms are unique");
        }
        if let (Some(_), Some(node)) = (footprint, node) {
            let message = "a room has either a footprint or a node";
            context.error(&node.span(), message, "");
        }
        if footprint.is_none() {
            let lone = [
                height.as_ref().map(|at| (at.span(), "height")),
                floor.as_ref().map(|at| (at.span(), "floor")),
                reflectances.as_ref().map(|at| (at.span(), "reflectances")),
            ];
            for (span, key) in lone.into_iter().flatten() {
                let message = format!("`{key}` needs a `footprint`");
                context.error(&span, message, "the scene decides it for this room");
            }
        }
    }
}

fn box_draft(
    section: &At<BoxSection>,
    rooms: &[&At<RoomSection>],
    project_name: &str,
    palette: &mut Palette,
    context: &mut Context,
) -> Option<Draft> {
    for room in rooms.iter().filter(|room| room.get_ref().node.is_some()) {
        let span = room.get_ref().name.span();
        context.error(&span, "a box has no nodes", "leave `node` out");
    }
    for second in rooms.iter().skip(1) {
        let span = second.get_ref().name.span();
        context.error(&span, "a box is one room", "give further rooms a `footprint`");
    }
    let room = rooms.first().map(|room| room.get_ref());
    let BoxSection { size, floor, walls, ceiling } = section.get_ref();
    let [x, y, z] = *size.get_ref();
    for edge in size.get_ref() {
        if !context.positive(*edge, &size.span(), "an edge of the box") {
            return None;
        }
    }
    let outline = [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]].map(DVec2::from_array);
    let surfacings = [floor.as_ref(), walls.as_ref(), ceiling.as_ref()];
    let boundary = Boundary {
        outline: outline.to_vec(),
        floor_m: 0.0,
        height_m: z,
        span: section.span(),
        surfacings,
        by_name: true,
    };
    let name = room.map_or(project_name, |room| room.name.get_ref());
    walled_draft(&boundary, room, name, palette, context)
}

fn footprint_draft(section: &RoomSection, palette: &mut Palette, context: &mut Context) -> Option<Draft> {
    let footprint = section.footprint.as_ref()?;
    let span = footprint.span();
    let name = section.name.get_ref();
    let mut outline: Vec<DVec2> = footprint.get_ref().iter().map(|p| DVec2::from_array(*p)).collect();
    if !outline.iter().all(|p| p.is_finite()) {
        context.error(&span, "coordinates must be finite", "");
        return None;
    }
    if outline.len() < 3 {
        context.error(&span, "a footprint needs at least three corners", "");
        return None;
    }
    if let Some(edge) = polygon::crossing(&outline) {
        let message =
            format!("the footprint of \"{name}\" intersects itself at the edge from corner {}", edge + 1);
        context.error(&span, message, "list the corners once around the room, without repeating the first");
        return None;
    }
    if polygon::signed_area_m2(&outline) < 0.0 {
        outline.reverse();
    }
    let Some(height) = &section.height else {
        let message = format!("room \"{name}\" has a footprint and no `height`");
        context.error(&span, message, "");
        return None;
    };
    if !context.positive(*height.get_ref(), &height.span(), "the height") {
        return None;
    }
    let floor_m = section.floor.as_ref().map_or(0.0, |floor| *floor.get_ref());
    if let Some(floor) = &section.floor
        && !context.finite(&[floor_m], &floor.span())
    {
        return None;
    }
    let Some(reflectances) = &section.reflectances else {
        let message = format!("room \"{name}\" has a footprint and no `reflectances`");
        let hint = "reflectances = { floor = 0.2, walls = 0.5, ceiling = 0.7 }";
        context.error(&section.name.span(), message, hint);
        return None;
    };
    let parts = reflectances.get_ref();
    let boundary = Boundary {
        outline,
        floor_m,
        height_m: *height.get_ref(),
        span: section.name.span(),
        surfacings: [Some(&parts.floor), Some(&parts.walls), Some(&parts.ceiling)],
        by_name: false,
    };
    walled_draft(&boundary, Some(section), name, palette, context)
}
