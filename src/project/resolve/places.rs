//! `[[place]]` and the list of places → luminaires in their rooms.

use std::collections::BTreeSet;
use std::ops::Range;

use glam::{DVec2, DVec3};

use super::draft::{Draft, Located, locate, room_named, room_names};
use super::lists::{Row, Table};
use super::luminaires::Kind;
use crate::geometry::polygon;
use crate::luminaire::{Luminaire, orientation};
use crate::project::context::Context;
use crate::project::diagnostics::suggestion;
use crate::project::schema::{ArraySection, At, FieldSection, File, PlaceSection};

/// More luminaires than one entry may place.
const MAX_PLACED: usize = 100_000;

/// Columns of the list of places; the first four are required.
const COLUMNS: &[&str] = &["luminaire", "x", "y", "z", "aim_x", "aim_y", "aim_z", "rotate", "dim", "group"];

/// How a luminaire hangs, apart from where.
pub(super) struct Hanging {
    pub(super) kind: usize,
    pub(super) group: String,
    pub(super) rotate_deg: f64,
    pub(super) dim: f64,
}

/// Hangs all luminaires.
pub fn add(file: &File, mut kinds: Vec<Kind>, drafts: &mut [Draft], context: &mut Context) {
    let mut hung = Hung::default();
    for section in &file.places {
        let span = section.span();
        let section = section.get_ref();
        if let Some((hanging, points)) = read(section, &span, &kinds, drafts, context) {
            for point in points {
                let aim = match (&section.aim, &section.target) {
                    (_, Some(target)) => DVec3::from_array(*target.get_ref()) - point,
                    (Some(aim), None) => DVec3::from_array(*aim.get_ref()),
                    (None, None) => DVec3::NEG_Z,
                };
                if !(aim.length() > 1e-9) {
                    let target = section.target.as_ref().or(section.aim.as_ref());
                    let span = target.map_or(span.clone(), At::span);
                    context.error(&span, "the aim has no direction", "");
                    break;
                }
                let mut report = |context: &mut Context, message: String, hint: &str| {
                    context.error(&span, message, hint);
                };
                hang(&hanging, &mut kinds, point, aim, drafts, context, &mut report);
                if let Some(message) = hung.again(&hanging, &kinds, point, aim) {
                    context.warn(&span, message, TWICE);
                }
            }
        }
    }
    let list = file.lists.as_ref().and_then(|lists| lists.get_ref().places.as_ref());
    if let Some(table) = list.and_then(|path| Table::read(path, COLUMNS, 4, context)) {
        for row in &table.rows {
            let Ok((hanging, point, aim)) = read_row(&table, row, &kinds, context) else {
                continue;
            };
            let mut report = |context: &mut Context, message: String, hint: &str| {
                table.error(row, message, hint, context);
            };
            hang(&hanging, &mut kinds, point, aim, drafts, context, &mut report);
            if let Some(message) = hung.again(&hanging, &kinds, point, aim) {
                table.warn(row, message, TWICE, context);
            }
        }
    }
}

/// What to do about two luminaires in one place.
const TWICE: &str = "leave one of them out, or move it";

/// What hangs already: type, group, place in 0.1 mm, aim.
#[derive(Default)]
struct Hung(BTreeSet<(usize, String, [i64; 3], [i64; 3])>);

impl Hung {
    /// Notes a luminaire; where one of its type and group hangs and aims alike already, says so.
    fn again(&mut self, hanging: &Hanging, kinds: &[Kind], point: DVec3, aim: DVec3) -> Option<String> {
        let rounded = |v: DVec3| v.to_array().map(|x| (x * 1e4).round() as i64);
        let key = (hanging.kind, hanging.group.clone(), rounded(point), rounded(aim.normalize_or_zero()));
        (!self.0.insert(key)).then(|| {
            let name = &kinds[hanging.kind].name;
            format!(
                "luminaire \"{name}\" hangs at ({}, {}, {}) more than once; their light adds up",
                point.x, point.y, point.z
            )
        })
    }
}

fn read(
    section: &PlaceSection,
    span: &Range<usize>,
    kinds: &[Kind],
    drafts: &[Draft],
    context: &mut Context,
) -> Option<(Hanging, Vec<DVec3>)> {
    let kind = kinds.iter().position(|kind| kind.name == *section.luminaire.get_ref());
    if kind.is_none() {
        let name = section.luminaire.get_ref();
        let hint = suggestion(name, kinds.iter().map(|kind| kind.name.as_str()));
        let message = format!("no luminaire \"{name}\" in [luminaires]");
        context.error(&section.luminaire.span(), message, &hint);
    }
    let mut ok = true;
    if let (Some(_), Some(target)) = (&section.aim, &section.target) {
        context.error(&target.span(), "give either `aim` or `target`", "");
        ok = false;
    }
    for vector in [&section.aim, &section.target].into_iter().flatten() {
        ok &= context.finite(vector.get_ref(), &vector.span());
    }
    if let Some(rotate) = &section.rotate {
        ok &= context.finite(&[*rotate.get_ref()], &rotate.span());
    }
    if let Some(dim) = &section.dim {
        ok &= context.in_range(dim, 0.0, 1.0, "dim");
    }
    let points = match (&section.at, &section.array, &section.field) {
        (Some(at), None, None) => {
            context.finite(at.get_ref(), &at.span()).then(|| vec![DVec3::from_array(*at.get_ref())])
        }
        (None, Some(array), None) => array_points(array.get_ref(), context),
        (None, None, Some(field)) => field_points(field, drafts, context),
        _ => {
            context.missing(span, "give exactly one of `at`, `array`, `field`", "");
            None
        }
    }?;
    let hanging = Hanging {
        kind: kind?,
        group: section.group.as_ref().unwrap_or(&section.luminaire).get_ref().clone(),
        rotate_deg: section.rotate.as_ref().map_or(0.0, |rotate| *rotate.get_ref()),
        dim: section.dim.as_ref().map_or(1.0, |dim| *dim.get_ref()),
    };
    ok.then_some((hanging, points))
}

fn array_points(array: &ArraySection, context: &mut Context) -> Option<Vec<DVec3>> {
    let ArraySection { from, step, count } = array;
    let steps = &step.get_ref().0;
    let counts = &count.get_ref().0;
    let mut ok = context.finite(from.get_ref(), &from.span());
    for vector in steps {
        ok &= context.finite(vector, &step.span());
    }
    if steps.len() != counts.len() {
        let message = format!("{} steps for {} counts", steps.len(), counts.len());
        let hint = "step = [x, y, z] with count = n, or two steps with count = [n, m]";
        context.error(&count.span(), message, hint);
        ok = false;
    }
    let n = counts[0] as usize;
    let m = counts.get(1).map_or(1, |m| *m as usize);
    if n == 0 || m == 0 || n.saturating_mul(m) > MAX_PLACED {
        let message = format!("an array places 1 … {MAX_PLACED} luminaires, here {n} × {m}");
        context.error(&count.span(), message, "");
        ok = false;
    }
    ok.then(|| {
        let from = DVec3::from_array(*from.get_ref());
        let first = DVec3::from_array(steps[0]);
        let second = steps.get(1).map_or(DVec3::ZERO, |step| DVec3::from_array(*step));
        (0..m).flat_map(|j| (0..n).map(move |i| from + i as f64 * first + j as f64 * second)).collect()
    })
}

/// Rows lie along x, columns are counted along x; half a spacing to the walls.
fn field_points(field: &At<FieldSection>, drafts: &[Draft], context: &mut Context) -> Option<Vec<DVec3>> {
    let span = field.span();
    let FieldSection { room, rows, columns, height } = field.get_ref();
    let ok = context.finite(&[*height.get_ref()], &height.span());
    let names = room_names(drafts);
    let (world, index) = match (room, &names[..]) {
        (Some(room), _) => {
            let found = room_named(drafts, room.get_ref());
            if found.is_none() && !drafts.is_empty() {
                let hint = suggestion(room.get_ref(), names.iter().copied());
                let message = format!("no room \"{}\"", room.get_ref());
                context.error(&room.span(), message, &hint);
            }
            found?
        }
        (None, [only]) => room_named(drafts, only)?,
        (None, []) => return None,
        (None, _) => {
            let hint = suggestion("", names.iter().copied());
            context.error(&span, "there are several rooms; name the field's `room`", &hint);
            return None;
        }
    };
    let room = &drafts[world].rooms[index];
    let (n, m) = (*columns.get_ref() as usize, *rows.get_ref() as usize);
    if n == 0 || m == 0 || n.saturating_mul(m) > MAX_PLACED {
        let message = format!("a field places 1 … {MAX_PLACED} luminaires, here {m} × {n}");
        context.error(&span, message, "");
        return None;
    }
    let low = room.footprint.iter().copied().reduce(DVec2::min)?;
    let high = room.footprint.iter().copied().reduce(DVec2::max)?;
    let step = (high - low) / DVec2::new(n as f64, m as f64);
    let mut points = Vec::with_capacity(n * m);
    for j in 0..m {
        for i in 0..n {
            let at = low + step * DVec2::new(i as f64 + 0.5, j as f64 + 0.5);
            if !polygon::contains(&room.footprint, at, 0.0) {
                let message = format!("the field leaves the footprint of \"{}\"", room.name);
                let hint = "a field fills the bounding rectangle; use `array` or `at` here";
                context.error(&span, message, hint);
                return None;
            }
            points.push(at.extend(room.floor_m + height.get_ref()));
        }
    }
    ok.then_some(points)
}

fn read_row(
    table: &Table,
    row: &Row,
    kinds: &[Kind],
    context: &mut Context,
) -> Result<(Hanging, DVec3, DVec3), ()> {
    let point = DVec3::from_array(table.needed3(row, 1, context)?);
    let name = row.cells[0].as_deref().unwrap_or_default();
    let Some(kind) = kinds.iter().position(|kind| kind.name == name) else {
        let hint = suggestion(name, kinds.iter().map(|kind| kind.name.as_str()));
        let message = format!("no luminaire \"{name}\" in [luminaires]");
        table.error(row, message, &hint, context);
        return Err(());
    };
    let aim = match (&row.cells[4], &row.cells[5], &row.cells[6]) {
        (None, None, None) => DVec3::NEG_Z,
        _ => DVec3::from_array(table.needed3(row, 4, context)?),
    };
    if !(aim.length() > 1e-9) {
        table.error(row, "the aim has no direction".to_owned(), "", context);
        return Err(());
    }
    let rotate_deg = table.number(row, 7, context)?.unwrap_or(0.0);
    let dim = table.number(row, 8, context)?.unwrap_or(1.0);
    if !(0.0..=1.0).contains(&dim) {
        table.error(row, format!("dim must lie in 0 … 1, found {dim}"), "", context);
        return Err(());
    }
    let hanging =
        Hanging { kind, group: row.cells[9].clone().unwrap_or_else(|| name.to_owned()), rotate_deg, dim };
    Ok((hanging, point, aim))
}

/// Hangs one luminaire in the room where it is.
pub(super) fn hang(
    hanging: &Hanging,
    kinds: &mut [Kind],
    point: DVec3,
    aim: DVec3,
    drafts: &mut [Draft],
    context: &mut Context,
    report: &mut dyn FnMut(&mut Context, String, &str),
) {
    let kind = &mut kinds[hanging.kind];
    let (world, room) = match locate(drafts, point) {
        Located::In(world, room) => (world, room),
        Located::Outside if drafts.is_empty() => return,
        Located::Outside if drafts.len() == 1 && drafts[0].cad && drafts[0].rooms.len() == 1 => {
            context.note(format!(
                "luminaire \"{}\" at ({}, {}, {}) hangs outside of the room's bounds and counts as in it",
                kind.name, point.x, point.y, point.z
            ));
            (0, 0)
        }
        Located::Outside => {
            let message = format!(
                "luminaire \"{}\" at ({}, {}, {}) hangs outside of every room",
                kind.name, point.x, point.y, point.z
            );
            report(context, message, "");
            return;
        }
        Located::Ambiguous(rooms) => {
            let message = format!("luminaire \"{}\" hangs in more than one room: {rooms}", kind.name);
            report(context, message, "move the rooms' footprints apart");
            return;
        }
    };
    let draft = &mut drafts[world];
    let mut body = Vec::new();
    for node in &kind.body {
        let found = draft.surfaces_named(node.get_ref());
        if found.is_empty() {
            let hint = suggestion(node.get_ref(), draft.surface_names());
            let message = format!("no node \"{}\" in {}", node.get_ref(), draft.label);
            context.error(&node.span(), message, &hint);
        }
        body.extend(found);
    }
    let name = draft.rooms[room].name.clone();
    let passed_over = kind.passed_over(&draft.factors[room]);
    if !passed_over.is_empty() {
        let message = format!(
            "luminaire \"{}\" has a maintenance of its own: {} of room \"{name}\" does not hold for it",
            kind.name,
            passed_over.join(", ")
        );
        let hint = "leave the luminaire's `maintenance` out where the room's factors are to hold";
        context.warn(&draft.factors[room].span, message, hint);
    }
    let Some(kind) = kind.in_room(&draft.factors[room], &name) else {
        return;
    };
    draft.rooms[room].luminaires.push(draft.luminaires.len());
    draft.luminaires.push(Luminaire {
        kind,
        position: point,
        world_from_luminaire: orientation(aim, hanging.rotate_deg),
        group: hanging.group.clone(),
        dim: hanging.dim,
        body,
    });
}
