//! Areas → grids → receivers.

use glam::{DVec2, DVec3};

use super::hidden::{exclude, holes};
use super::norm_areas::norm_areas;
use super::{Plan, PlanError, PlannedArea, PlannedQuantity, Rows};
use crate::grid::{self, Exclusion, Grid, GridRule};
use crate::norm::GridChoice;
use crate::project::{AreaKind, AreaShape, AreaSpec, CustomSubject, Project, Room, World};
use crate::quantity::Quantity;
use crate::query::{Kernel, Ray, Receiver};
use crate::scene::Scene;
use crate::sphere;

/// How far from a room's nominal wall or ceiling its real surface is looked for, m.
pub(super) const SNAP_M: f64 = 0.25;

/// Cosine of the tilt up to which a plane of work is nearer to level than to upright.
const LEVEL: f64 = std::f64::consts::FRAC_1_SQRT_2;

pub(super) fn plan(project: &Project, world: &World, plan: &mut Plan, errors: &mut Vec<PlanError>) {
    let mut specs: Vec<AreaSpec> = world.areas.clone();
    for (index, room) in world.rooms.iter().enumerate() {
        if !world.areas.iter().any(|area| area.room == index) {
            let own = norm_areas(project, &world.scene, room, index);
            if !own.is_empty() {
                plan.reasons.push(format!(
                    "Room \"{}\" lists no areas: {} were made from its outline (working plane, walls, ceiling, volume).",
                    room.name,
                    own.len()
                ));
            }
            specs.extend(own);
        }
    }
    let sports =
        project.norm.as_ref().is_some_and(|norm| norm.standard.application.grid.value == GridChoice::En12193);
    for spec in specs.iter_mut().filter(|spec| sports && spec.rule == GridRule::En) {
        spec.rule = GridRule::EnSports;
    }
    let is_total =
        project.norm.as_ref().is_some_and(|norm| norm.standard.application.surrounding_of_task.is_some());
    let mut points = 0;
    for (index, spec) in specs.iter().enumerate() {
        let holes = holes(spec, index, &specs, is_total);
        let mut grid = match lay(spec, &world.rooms[spec.room], &world.scene, &holes) {
            Ok(grid) => grid,
            Err(error) => {
                errors.push(PlanError::Grid { area: spec.name.clone(), error, place: spec.written.clone() });
                continue;
            }
        };
        exclude(&mut grid, spec, &holes, &world.scene);
        if grid.points.iter().all(|point| point.excluded.is_some()) {
            errors.push(PlanError::NoPoints { area: spec.name.clone(), place: spec.written.clone() });
            continue;
        }
        let hidden = grid.points.iter().filter(|p| p.excluded == Some(Exclusion::InsideFurniture)).count();
        if hidden > 0 {
            plan.reasons.push(format!(
                "Area \"{}\": {hidden} of {} points lie inside furniture and are left out.",
                spec.name,
                grid.points.len()
            ));
        }
        points += grid.points.len();
        if points > grid::MAX_POINTS {
            let rooms: Vec<&str> = world.rooms.iter().map(|room| room.name.as_str()).collect();
            errors.push(PlanError::TooManyPoints { rooms: rooms.join(", "), points });
            return;
        }
        let wanted = quantities(project, world, spec, index, &grid);
        let quantities = ask(plan, &grid, &wanted);
        let area = PlannedArea {
            name: spec.name.clone(),
            kind: spec.kind,
            of: spec.of.map(|of| specs[of].name.clone()),
            row: row_of(project, world, spec),
            modified: spec.modified.clone().or_else(|| spec.of.and_then(|of| specs[of].modified.clone())),
            light_scene: spec.light_scene.unwrap_or(0),
            shape: spec.shape.clone(),
            grid,
            quantities,
        };
        plan.rooms[spec.room].areas.push(area);
    }
}

/// The row by which an area is judged: its own, its task's, its room's, the norm's default.
fn row_of(project: &Project, world: &World, spec: &AreaSpec) -> Option<String> {
    let task = spec.of.and_then(|of| world.areas[of].row.clone());
    let norm = project.norm.as_ref()?;
    spec.row.clone().or(task).or_else(|| world.rooms[spec.room].row.clone()).or_else(|| norm.row.clone())
}

/// The rule for an area that is no rectangle. What is narrower than its outline counts by its width, as a
/// corridor does, whatever bends it has; a strip round another area has points along its middle.
fn rule_of(spec: &AreaSpec, corners: &[DVec3], normal: DVec3, holes: &[Vec<DVec2>]) -> GridRule {
    if spec.rule != GridRule::En {
        return spec.rule;
    }
    let axes = if normal.z.abs() > 0.99 { [DVec3::X, DVec3::Y] } else { [normal.cross(DVec3::Z), DVec3::Z] };
    let flat: Vec<DVec2> =
        corners.iter().map(|corner| DVec2::from(axes.map(|axis| axis.dot(*corner)))).collect();
    if holes.is_empty() && grid::is_rectangle(&flat) {
        return spec.rule;
    }
    let low = flat.iter().copied().reduce(DVec2::min).unwrap_or_default();
    let size = flat.iter().copied().reduce(DVec2::max).unwrap_or_default() - low;
    let inner = |length_m: f64| length_m - 2.0 * spec.border_m;
    let width_m = inner(grid::width(&flat, holes));
    let step_m = if holes.is_empty() { grid::spacing_m(width_m, inner(size.max_element())) } else { width_m };
    if step_m > 0.0 { GridRule::EnAtMost(step_m) } else { spec.rule }
}

/// The side on which an area is measured, in whichever order its corners or edges were listed: planes of work
/// nearer to level than to upright are lit from above, what stands or hangs at the room's shell is lit from the room.
/// As it is where both sides lie in the room, or none, and where the project asks for `E_n` in so many words.
fn lit_side(spec: &AreaSpec, room: &Room, middle: DVec3, normal: DVec3) -> DVec3 {
    let unit = normal.normalize_or_zero();
    let is_chosen = spec.quantities.contains(&Quantity::Normal) && spec.kind != AreaKind::Surface;
    if is_chosen {
        return normal;
    }
    match spec.kind {
        AreaKind::Volume => normal,
        AreaKind::Task | AreaKind::Surrounding | AreaKind::Background if unit.z.abs() > LEVEL => {
            normal * normal.z.signum()
        }
        AreaKind::Task | AreaKind::Surrounding | AreaKind::Background | AreaKind::Surface => {
            let is_in = |side: f64| room.contains(middle + side * 2.0 * SNAP_M * unit);
            if is_in(-1.0) && !is_in(1.0) { -normal } else { normal }
        }
    }
}

fn lay(spec: &AreaSpec, room: &Room, scene: &Scene, holes: &[Vec<DVec2>]) -> Result<Grid, grid::GridError> {
    // The grid of a plane must not repeat the pattern of the luminaires above it.
    let lights: Vec<DVec3> = room.luminaires.iter().map(|&l| scene.luminaires[l].position).collect();
    let spacing = |axis: DVec3| grid::regular_spacing_m(&lights, axis.normalize_or_zero());
    match &spec.shape {
        AreaShape::Rect { origin, u, v } => {
            let normal = lit_side(spec, room, *origin + 0.5 * (*u + *v), u.cross(*v));
            let corners = [*origin, *origin + *u, *origin + *u + *v, *origin + *v];
            let grid = grid::rectangle(
                *origin,
                *u,
                *v,
                normal,
                rule_of(spec, &corners, normal.normalize_or_zero(), holes),
                spec.border_m,
                Some([spacing(*u), spacing(*v)]),
            )?;
            Ok(if spec.kind == AreaKind::Surface { snapped(grid, scene) } else { grid })
        }
        AreaShape::Surface { origin, u, v, surface } => {
            let mut grid = grid::rectangle(
                *origin,
                *u,
                *v,
                u.cross(*v),
                spec.rule,
                spec.border_m,
                Some([spacing(*u), spacing(*v)]),
            )?;
            for point in &mut grid.points {
                if !on_surface(scene, *surface, point.position) {
                    point.excluded = Some(Exclusion::OutsideArea);
                }
            }
            Ok(grid)
        }
        AreaShape::Polygon(corners) => {
            let normal = polygon_normal(corners);
            let top = room.floor_m + room.height_m;
            let is_shell = spec.kind == AreaKind::Surface;
            let ceiling = is_shell && corners.iter().all(|p| (p.z - top).abs() < SNAP_M);
            let normal = match normal.z.abs() > 0.99 {
                true if ceiling => DVec3::NEG_Z,
                true => DVec3::Z,
                false => {
                    let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
                    lit_side(spec, room, middle, normal)
                }
            };
            let rule = rule_of(spec, corners, normal, holes);
            let grid = grid::polygon(corners, normal, rule, spec.border_m, &lights)?;
            Ok(if spec.kind == AreaKind::Surface { snapped(grid, scene) } else { grid })
        }
        AreaShape::Points(points) => Ok(grid::list(points, DVec3::Z)),
    }
}

/// Newell's normal of a polygon.
fn polygon_normal(corners: &[DVec3]) -> DVec3 {
    let sum: DVec3 = corners
        .iter()
        .enumerate()
        .map(|(index, a)| (*a - corners[0]).cross(corners[(index + 1) % corners.len()] - corners[0]))
        .sum();
    sum.normalize_or_zero()
}

/// Points on a room's nominal shell moved onto the real surface: a shell read from a CAD file may
/// stand a little inside its bounds, and a point behind it would measure darkness.
fn snapped(mut grid: Grid, scene: &Scene) -> Grid {
    for point in &mut grid.points {
        let start = point.position + point.normal * SNAP_M;
        if let Some(hit) = scene.tracer.closest(start, -point.normal, &[])
            && hit.distance_m < 2.0 * SNAP_M
        {
            point.position = start - point.normal * hit.distance_m;
        }
    }
    grid
}

/// Whether a point of a planar surface's bounding rectangle lies on the surface itself.
pub(super) fn on_surface(scene: &Scene, surface: u32, at: DVec3) -> bool {
    let mesh = &scene.mesh;
    (0..mesh.triangles.len()).filter(|&index| mesh.triangles[index].surface == surface).any(|index| {
        let [a, b, c] = mesh.corners(index);
        let n = (b - a).cross(c - a);
        let inside = |p: DVec3, q: DVec3| (q - p).cross(at - p).dot(n) >= -1e-9 * n.length_squared();
        inside(a, b) && inside(b, c) && inside(c, a)
    })
}

/// What is measured on an area: what the user listed, what its kind implies, what `[[require]]` needs.
fn quantities(project: &Project, world: &World, spec: &AreaSpec, index: usize, grid: &Grid) -> Vec<Quantity> {
    // A plane is lit from above in whichever order its edges were listed; only surfaces look down.
    let horizontal = grid.points.iter().all(|point| point.normal.z.abs() > 0.99);
    let mut wanted = spec.quantities.clone();
    if wanted.is_empty() || project.norm.is_some() {
        let usual = match spec.kind {
            AreaKind::Volume => Quantity::Cylindrical,
            AreaKind::Surface => Quantity::Normal,
            _ if horizontal => Quantity::Horizontal,
            _ => Quantity::Normal,
        };
        if !wanted.contains(&usual) {
            wanted.insert(0, usual);
        }
    }
    for requirement in &world.requirements {
        if requirement.subject == CustomSubject::Area(index) && !wanted.contains(&requirement.quantity) {
            wanted.push(requirement.quantity);
        }
    }
    wanted.retain(|quantity| !quantity.is_single());
    wanted
}

/// Adds the receivers and rays of a grid. Planar quantities get receivers of their own; kernels
/// that look all around share one.
fn ask(plan: &mut Plan, grid: &Grid, wanted: &[Quantity]) -> Vec<PlannedQuantity> {
    let mut planned: Vec<PlannedQuantity> = wanted
        .iter()
        .map(|&quantity| PlannedQuantity { quantity, rows: vec![None; grid.points.len()] })
        .collect();
    let open = |index: usize| grid.points[index].excluded.is_none();
    for entry in &mut planned {
        for (index, point) in grid.points.iter().enumerate().filter(|&(index, _)| open(index)) {
            let lift = point.normal;
            let mut one =
                |kernel: Kernel| plan.ask(Receiver { point: point.position, lift, kernels: vec![kernel] });
            let rows = match entry.quantity {
                Quantity::Modelling => {
                    let cylinder = one(Kernel::Cylindrical { axis: DVec3::Z });
                    Rows::Ratio(cylinder, one(Kernel::Planar { normal: DVec3::Z }))
                }
                Quantity::Luminance { azimuth_deg, tilt_deg } => {
                    let direction = sphere::from_azimuth_tilt(azimuth_deg, tilt_deg);
                    plan.demand.rays.push(Ray { point: point.position, direction });
                    Rows::One(RAY | (plan.demand.rays.len() - 1))
                }
                quantity => match kernel(quantity, point.normal) {
                    Some(kernel) => Rows::One(one(kernel)),
                    None => continue,
                },
            };
            entry.rows[index] = Some(rows);
        }
    }
    planned
}

/// Marks a row number that counts rays until all receivers are known.
const RAY: usize = 1 << (usize::BITS - 1);

/// Gives rays their final rows, behind all kernels.
pub(super) fn number_rays(plan: &mut Plan) {
    let kernels = plan.demand.rows() - plan.demand.rays.len();
    let areas = plan.rooms.iter_mut().flat_map(|room| &mut room.areas);
    for rows in areas.flat_map(|area| &mut area.quantities).flat_map(|entry| entry.rows.iter_mut().flatten())
    {
        if let Rows::One(row) = rows
            && *row & RAY != 0
        {
            *row = kernels + (*row & !RAY);
        }
    }
}

/// The response that measures an illuminance.
fn kernel(quantity: Quantity, normal: DVec3) -> Option<Kernel> {
    let facing = |azimuth_deg: f64| sphere::from_azimuth_tilt(azimuth_deg, 0.0);
    match quantity {
        Quantity::Horizontal => Some(Kernel::Planar { normal: DVec3::Z }),
        Quantity::Vertical { azimuth_deg } => Some(Kernel::Planar { normal: facing(azimuth_deg) }),
        Quantity::Normal => Some(Kernel::Planar { normal }),
        Quantity::Cylindrical => Some(Kernel::Cylindrical { axis: DVec3::Z }),
        Quantity::Semicylindrical { azimuth_deg } => {
            Some(Kernel::Semicylindrical { axis: DVec3::Z, facing: facing(azimuth_deg) })
        }
        Quantity::Hemispherical => Some(Kernel::Hemispherical { axis: DVec3::Z }),
        Quantity::Spherical => Some(Kernel::Spherical),
        Quantity::Modelling
        | Quantity::Luminance { .. }
        | Quantity::Ugr
        | Quantity::Intensity
        | Quantity::ColourRendering
        | Quantity::DiscomfortIndex
        | Quantity::OfView { .. }
        | Quantity::Declared(_)
        | Quantity::NotComputed(_) => None,
    }
}
