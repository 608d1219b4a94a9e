//! Luminaires, their types and the furniture of a room, as drawings and schedules list them.

use glam::{DVec2, DVec3};

use crate::luminaire::Luminaire;
use crate::outcome::{LuminaireOutcome, TypeOutcome};
use crate::project::{Room, World};

pub(super) fn luminaire(entry: &Luminaire) -> LuminaireOutcome {
    let axes = entry.world_from_luminaire;
    LuminaireOutcome {
        kind: entry.kind.name.clone(),
        group: entry.group.clone(),
        position: entry.position,
        outline: entry.kind.opening.outline().iter().map(|&p| entry.position + axes * p).collect(),
        // C0 lies across the length in every format, as in `lamp`.
        c0: axes * DVec3::NEG_Y,
        aim: entry.beam_axis(),
    }
}

pub(super) fn types(world: &World, room: &Room) -> Vec<TypeOutcome> {
    let mut types: Vec<TypeOutcome> = Vec::new();
    for &index in &room.luminaires {
        let kind = &world.scene.luminaires[index].kind;
        if let Some(known) = types.iter_mut().find(|known| known.name == kind.name) {
            known.count += 1;
            continue;
        }
        let m = kind.maintenance;
        types.push(TypeOutcome {
            distribution: kind.distribution.clone(),
            name: kind.name.clone(),
            description: kind.description.clone(),
            file: kind.file.clone(),
            count: 1,
            flux_lm: kind.flux_lm,
            rated_flux_lm: kind.rated_flux_lm,
            power_w: kind.power_w,
            maintenance_factor: m.factor() * room.rsmf,
            maintenance: [m.llmf, m.lsf, m.lmf, room.rsmf],
        });
    }
    types
}

/// Convex outlines in plan of the furniture whose centre lies over the room.
pub(super) fn furniture(world: &World, room: &Room) -> Vec<Vec<DVec2>> {
    let mesh = &world.scene.mesh;
    let mut corners: Vec<Vec<DVec2>> = vec![Vec::new(); mesh.surfaces.len()];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        if mesh.surfaces[triangle.surface as usize].furniture {
            corners[triangle.surface as usize]
                .extend(mesh.corners(index).map(|p: DVec3| DVec2::new(p.x, p.y)));
        }
    }
    let (lo, hi) = room
        .footprint
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    corners
        .into_iter()
        .filter(|points| !points.is_empty())
        .map(hull)
        .filter(|outline| {
            let centre = outline.iter().sum::<DVec2>() / outline.len() as f64;
            outline.len() >= 3 && centre.cmpge(lo).all() && centre.cmple(hi).all()
        })
        .collect()
}

/// Convex hull, counter-clockwise (Andrew's monotone chain).
fn hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut outline = half(&mut points.iter().copied());
    outline.extend(half(&mut points.iter().rev().copied()));
    outline
}
