//! Areas → grids → receivers: the user's areas, and those a norm implies for a room without any.

use glam::{DVec2, DVec3};

use super::{Plan, PlanError, PlannedArea, PlannedQuantity, Rows};
use crate::geometry::trace::Hit;
use crate::grid::{self, Exclusion, Grid, GridRule};
use crate::norm::{GridChoice, Plane, Zone};
use crate::project::{AreaKind, AreaShape, AreaSpec, CustomSubject, Project, Room, World};
use crate::quantity::Quantity;
use crate::query::{Kernel, Ray, Receiver};
use crate::scene::Scene;
use crate::sphere;

/// How far from a room's nominal wall or ceiling its real surface is looked for, m.
const SNAP_M: f64 = 0.25;
/// Surfaces closer than this share a plane, m.
const TOUCHING_M: f64 = 1e-6;

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
    for (index, spec) in specs.iter().enumerate() {
        let mut grid = match lay(spec, &world.rooms[spec.room], &world.scene) {
            Ok(grid) => grid,
            Err(error) => {
                errors.push(PlanError::Grid { area: spec.name.clone(), error, place: spec.written.clone() });
                continue;
            }
        };
        exclude(&mut grid, spec, index, &specs, &world.scene, is_total);
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
        let wanted = quantities(project, world, spec, index, &grid);
        let quantities = ask(plan, &grid, &wanted);
        let area = PlannedArea {
            name: spec.name.clone(),
            kind: spec.kind,
            of: spec.of.map(|of| specs[of].name.clone()),
            row: row_of(project, world, spec),
            light_scene: spec.light_scene.unwrap_or(0),
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

/// Areas for a room that lists none: the whole working plane, a volume at eye height, walls, ceiling.
fn norm_areas(project: &Project, scene: &Scene, room: &Room, index: usize) -> Vec<AreaSpec> {
    let Some(norm) = &project.norm else { return Vec::new() };
    let Some(reference) = room.row.as_ref().or(norm.row.as_ref()) else { return Vec::new() };
    let Some(row) = norm.standard.row(reference) else { return Vec::new() };
    let standard = &norm.standard;
    let application = &standard.application;
    let plane_m = row.plane_m.unwrap_or(application.working_plane_m.value);
    let flat = |height_m: f64| -> Vec<DVec3> {
        room.footprint.iter().map(|p| DVec3::new(p.x, p.y, room.floor_m + height_m)).collect()
    };
    let spec = |name: &str, kind, shape, border_m| AreaSpec {
        name: format!("{} · {name}", room.name),
        kind,
        of: None,
        room: index,
        row: None,
        light_scene: None,
        shape,
        rule: GridRule::En,
        border_m,
        quantities: Vec::new(),
        written: None,
    };
    let narrow = narrowest(&room.footprint);
    let border_m = if narrow > 3.0 * application.border_m.value { application.border_m.value } else { 0.0 };
    let mut areas = Vec::new();
    // A vertical plane lies where the board or the rack is: nobody can make it from the outline.
    if row.plane == Plane::Horizontal {
        let plane = AreaShape::Polygon(flat(plane_m));
        areas.push(spec("working plane", AreaKind::Task, plane, border_m));
    }
    if standard.regulates(Zone::Cylindrical) {
        let heights = application.eye_heights_m(row.posture);
        for height_m in &heights {
            let name = if heights.len() > 1 { format!("volume {height_m} m") } else { "volume".to_owned() };
            areas.push(spec(&name, AreaKind::Volume, AreaShape::Polygon(flat(*height_m)), border_m));
        }
    }
    if standard.regulates(Zone::Ceiling) {
        let ceiling = AreaShape::Polygon(flat(room.height_m).into_iter().rev().collect());
        areas.push(spec("ceiling", AreaKind::Surface, ceiling, 0.0));
    }
    if !standard.regulates(Zone::Walls) {
        return areas;
    }
    let count = room.footprint.len();
    let names = wall_names(scene, room);
    for (number, &a) in room.footprint.iter().enumerate() {
        let b = room.footprint[(number + 1) % count];
        let origin = DVec3::new(b.x, b.y, room.floor_m);
        let shape = AreaShape::Rect { origin, u: (a - b).extend(0.0), v: DVec3::Z * room.height_m };
        areas.push(spec(&names[number], AreaKind::Surface, shape, 0.0));
    }
    areas
}

/// Names of the walls in the order of the footprint: those of the surfaces that stand there, since
/// materials and areas call them so; numbers where a surface is several walls, as CAD files have it.
fn wall_names(scene: &Scene, room: &Room) -> Vec<String> {
    let count = room.footprint.len();
    let mesh = &scene.mesh;
    let found: Vec<Option<&str>> = (0..count)
        .map(|number| {
            let (a, b) = (room.footprint[number], room.footprint[(number + 1) % count]);
            let along = (b - a).normalize_or_zero();
            let stands_there = |&wall: &u32| {
                let mut own = (0..mesh.triangles.len()).filter(|&t| mesh.triangles[t].surface == wall);
                own.any(|triangle| {
                    mesh.corners(triangle).iter().all(|corner| {
                        let p = DVec2::new(corner.x, corner.y) - a;
                        let t = p.dot(along);
                        p.perp_dot(along).abs() < 0.01 && t > -0.01 && t < (b - a).length() + 0.01
                    })
                })
            };
            let wall = room.walls.iter().copied().find(stands_there)?;
            Some(mesh.surfaces[wall as usize].name.as_str())
        })
        .collect();
    let unique = |name: &str| found.iter().filter(|other| **other == Some(name)).count() == 1;
    if let Some(names) = found.iter().copied().collect::<Option<Vec<&str>>>()
        && names.iter().all(|name| unique(name))
    {
        return names.into_iter().map(str::to_owned).collect();
    }
    (1..=count).map(|number| format!("wall {number}")).collect()
}

fn narrowest(footprint: &[DVec2]) -> f64 {
    let (lo, hi) =
        footprint.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    (hi - lo).min_element()
}

fn lay(spec: &AreaSpec, room: &Room, scene: &Scene) -> Result<Grid, grid::GridError> {
    // The grid of a plane must not repeat the pattern of the luminaires above it.
    let lights: Vec<DVec3> = room.luminaires.iter().map(|&l| scene.luminaires[l].position).collect();
    let spacing = |axis: DVec3| grid::regular_spacing_m(&lights, axis.normalize_or_zero());
    match &spec.shape {
        AreaShape::Rect { origin, u, v } => {
            let grid = grid::rectangle(
                *origin,
                *u,
                *v,
                u.cross(*v),
                spec.rule,
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
            let ceiling = spec.kind == AreaKind::Surface
                && normal.z < -0.99
                && corners.iter().all(|p| (p.z - top).abs() < SNAP_M);
            let normal = if normal.z.abs() > 0.99 && !ceiling { DVec3::Z } else { normal };
            let grid = grid::polygon(corners, normal, spec.rule, spec.border_m, &lights)?;
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
fn on_surface(scene: &Scene, surface: u32, at: DVec3) -> bool {
    let mesh = &scene.mesh;
    (0..mesh.triangles.len()).filter(|&index| mesh.triangles[index].surface == surface).any(|index| {
        let [a, b, c] = mesh.corners(index);
        let n = (b - a).cross(c - a);
        let inside = |p: DVec3, q: DVec3| (q - p).cross(at - p).dot(n) >= -1e-9 * n.length_squared();
        inside(a, b) && inside(b, c) && inside(c, a)
    })
}

/// Marks points inside closed furniture, and points of surroundings and backgrounds that belong to
/// a task or surrounding area.
///
/// Where a norm compares the surrounding's mean with the task's, it is the total area, task included.
fn exclude(
    grid: &mut Grid,
    spec: &AreaSpec,
    index: usize,
    specs: &[AreaSpec],
    scene: &Scene,
    is_total: bool,
) {
    let others: Vec<Vec<DVec2>> = specs
        .iter()
        .enumerate()
        .filter(|&(other, area)| {
            let owns = match spec.kind {
                AreaKind::Surrounding => area.kind == AreaKind::Task && !is_total,
                AreaKind::Background => matches!(area.kind, AreaKind::Task | AreaKind::Surrounding),
                AreaKind::Task | AreaKind::Surface | AreaKind::Volume => false,
            };
            owns && other != index && area.room == spec.room
        })
        .filter_map(|(_, area)| plan_outline(&area.shape))
        .collect();
    for point in grid.points.iter_mut().filter(|point| point.excluded.is_none()) {
        let flat = DVec2::new(point.position.x, point.position.y);
        if others.iter().any(|outline| contains(outline, flat)) {
            point.excluded = Some(Exclusion::InOtherArea);
        } else if inside_furniture(scene, point, spec.kind == AreaKind::Surface) {
            point.excluded = Some(Exclusion::InsideFurniture);
        }
    }
}

/// Outline in plan of a horizontal area.
fn plan_outline(shape: &AreaShape) -> Option<Vec<DVec2>> {
    let flat = |p: DVec3| DVec2::new(p.x, p.y);
    match shape {
        AreaShape::Rect { origin, u, v } if u.z == 0.0 && v.z == 0.0 => {
            Some([*origin, *origin + *u, *origin + *u + *v, *origin + *v].map(flat).to_vec())
        }
        AreaShape::Polygon(corners) => Some(corners.iter().copied().map(flat).collect()),
        AreaShape::Rect { .. } | AreaShape::Surface { .. } | AreaShape::Points(_) => None,
    }
}

/// Even–odd rule.
fn contains(outline: &[DVec2], p: DVec2) -> bool {
    let mut inside = false;
    for (index, &a) in outline.iter().enumerate() {
        let b = outline[(index + 1) % outline.len()];
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

/// Whether a point lies inside closed furniture: along every direction it leaves more solids than
/// it enters. Several directions guard against open sheets; on a surface those into it are left
/// out, so that a cabinet sunk into a wall hides the wall's points.
fn inside_furniture(scene: &Scene, point: &grid::GridPoint, on_surface: bool) -> bool {
    let at = point.position + if on_surface { point.normal * 1e-4 } else { DVec3::ZERO };
    [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z]
        .into_iter()
        .filter(|axis| !on_surface || axis.dot(point.normal) > -0.5)
        .all(|axis| {
            // Slightly off the axes, so that the rays do not run along faces.
            let direction = (axis + DVec3::new(1.3e-3, 2.7e-3, 3.9e-3)).normalize();
            let into = direction.dot(point.normal);
            let outward = on_surface && into < 0.0;
            leaves_solid(scene, at, if outward { direction - 2.0 * into * point.normal } else { direction })
        })
}

/// Counts the furniture faces along a ray up to the room's shell: more back sides than front sides means it starts inside.
fn leaves_solid(scene: &Scene, mut origin: DVec3, direction: DVec3) -> bool {
    const MOST_FACES: usize = 10_000;
    let mut inside = 0;
    for _ in 0..MOST_FACES {
        let Some(hit) = scene.tracer.closest(origin, direction, &[]) else { break };
        let surface = scene.tracer.surface(hit.triangle);
        let is_furniture =
            |hit: &Hit| scene.mesh.surfaces[scene.tracer.surface(hit.triangle) as usize].furniture;
        let leaving = |hit: &Hit| if hit.front { -1 } else { 1 };
        if !is_furniture(&hit) {
            // A piece that stands on the floor shares a plane with it, and a ray may meet the floor first.
            let touching = scene.tracer.closest(origin, direction, &[surface]);
            if let Some(next) = touching.filter(|next| next.distance_m < hit.distance_m + TOUCHING_M)
                && is_furniture(&next)
            {
                inside += leaving(&next);
            }
            break;
        }
        inside += leaving(&hit);
        origin += direction * (hit.distance_m + scene.tracer.offset_m());
    }
    inside > 0
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
        | Quantity::ColourRendering
        | Quantity::DiscomfortIndex
        | Quantity::Declared(_)
        | Quantity::NotComputed(_) => None,
    }
}
