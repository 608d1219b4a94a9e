//! Cards of views: a small picture with the sources in their places, and which luminaire would help most
//! if it were dimmed or shifted. What they say of remedies is a guide, computed with the background as it
//! is; UGR itself is the view's.

use std::f64::consts::PI;

use glam::DVec3;

use crate::emitters::{Emitters, Sighted};
use crate::geometry::polygon;
use crate::glare::position_index::Position;
use crate::glare::source::{Extent, GlareSource};
use crate::glare::ugr::ugr;
use crate::image::{Projection, View};
use crate::measure::glare_sources::{Convention, Counted, label, sources};
use crate::measure::weights;
use crate::outcome::{Card, PlacedSource, Remedy, Shift, ViewpointOutcome};
use crate::plan::PlannedView;
use crate::project::{Project, Room, World};
use crate::solve::{Prepared, thumbnail};
use crate::units::Nits;

/// Pixels of a picture's edge.
const SIZE: usize = 160;
/// Parts of every edge of an outline: straight lines are bent in a fisheye.
const PARTS: usize = 8;
/// Corners of a ring about a source without outline, and its least half angle, rad.
const RING: usize = 24;
const RING_RAD: f64 = 0.03;
/// How far a luminaire is shifted, m, and to what share of its light it is dimmed.
pub const SHIFT_M: f64 = 1.0;
/// How far before its opening a luminaire looks for what stands in its way, m.
const BEFORE_M: f64 = 0.005;
/// Share of its light to which a luminaire is dimmed.
pub const DIMMED: f64 = 0.5;

/// Gives every viewpoint of a room a card in its own light scene and its worst direction. `views` are in the
/// order of the plan, every direction with all light scenes; `seen` is what the plan's directions see.
pub fn add(
    views: &mut [ViewpointOutcome],
    prepared: &Prepared,
    project: &Project,
    world: &World,
    room: usize,
    planned: &[PlannedView],
    seen: &[Sighted],
) {
    let scenes = project.light_scenes.len();
    let place = |number: usize| number * scenes + planned[number].light_scene;
    let ugr = |views: &[ViewpointOutcome], number: usize| {
        views[place(number)].ugr.as_ref().map_or(f64::NEG_INFINITY, |ugr| ugr.value)
    };
    for number in 0..planned.len() {
        let same = |other: &usize| planned[*other].viewpoint == planned[number].viewpoint;
        let worst = (0..planned.len()).filter(same).fold(None, |worst, other| match worst {
            Some(known) if ugr(views, known) >= ugr(views, other) => Some(known),
            _ => Some(other),
        });
        if worst == Some(number) {
            let light_scene = &project.light_scenes[planned[number].light_scene];
            let weights = weights(world, light_scene, &world.rooms[room], false);
            let view = &views[place(number)];
            let card = card(prepared, &world.rooms, &seen[number], view, &weights, Convention::default());
            views[place(number)].card = card;
        }
    }
}

/// The card of a view that is seen by `sighted`, with the factors of its light scene; `None` where
/// the method stores no field. `rooms` are those of the world.
pub fn card(
    prepared: &Prepared,
    rooms: &[Room],
    sighted: &Sighted,
    view: &ViewpointOutcome,
    weights: &[f64],
    convention: Convention,
) -> Option<Card> {
    let emitters = prepared.emitters();
    let mut counted = sources(emitters, sighted, view.direction, weights, convention, view.e_v_lx).counted;
    // What UGR leaves out is not shown among what makes it.
    counted.retain(|source| !source.source.is_off_table());
    let term = |source: &GlareSource| ugr(&[*source], Nits(0.25)).unwrap_or(f64::NEG_INFINITY);
    counted.sort_by(|a, b| term(&b.source).total_cmp(&term(&a.source)));
    let up = if view.direction.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
    let fisheye = Projection::AngularFisheye { horizontal_deg: 180.0, vertical_deg: 180.0 };
    let camera = View::new(fisheye, view.eye, view.direction, up).ok()?;
    let picture = thumbnail(prepared, &camera, [SIZE; 2], weights)?;
    let background = Nits(view.background_cd_m2);
    Some(Card {
        sources: counted.iter().map(|source| placed(emitters, &camera, source)).collect(),
        dimmed: dimmed(emitters, &counted, background),
        moved: moved(emitters, rooms, &counted, view, convention, weights),
        picture,
    })
}

/// The source in the picture.
fn placed(emitters: &Emitters, camera: &View, source: &Counted) -> PlacedSource {
    let place = |direction: DVec3| {
        // What lies behind the eye is drawn on the rim.
        let ahead = direction.dot(camera.forward()).max(0.0);
        let aside = direction - camera.forward() * direction.dot(camera.forward());
        let direction = (camera.forward() * ahead + aside).normalize_or_zero();
        camera.place([1, 1], direction).unwrap_or([0.5; 2])
    };
    let corners = source.emitter.map_or(Vec::new(), |index| emitters.outline(&emitters.sources[index]));
    let mut outline = Vec::new();
    for (index, &a) in corners.iter().enumerate() {
        let b = corners[(index + 1) % corners.len()];
        let at = |part: usize| a + (b - a) * (part as f64 / PARTS as f64) - camera.eye;
        outline.extend((0..PARTS).map(|part| place(at(part))));
    }
    if outline.is_empty() {
        let half_rad = (source.source.solid_angle_sr / PI).sqrt().clamp(RING_RAD, 1.2);
        let frame = crate::sphere::frame(source.direction);
        outline.extend((0..RING).map(|corner| {
            let (sin, cos) = (2.0 * PI * corner as f64 / RING as f64).sin_cos();
            let radius = half_rad.sin();
            place(frame * DVec3::new(radius * cos, radius * sin, half_rad.cos()))
        }));
    }
    PlacedSource { centre: place(source.direction), outline }
}

/// UGR with some sources changed; `None` where there is none.
fn changed(
    counted: &[Counted],
    background: Nits,
    change: impl Fn(&Counted) -> Option<GlareSource>,
) -> Option<f64> {
    let sources: Vec<GlareSource> = counted.iter().filter_map(change).collect();
    ugr(&sources, background).ok()
}

/// Scene index of the luminaire behind a source.
fn luminaire(emitters: &Emitters, source: &Counted) -> Option<usize> {
    source.emitter.map(|index| emitters.sources[index].luminaire)
}

/// The luminaire itself among the sources, or its first image.
fn each_luminaire<'c>(emitters: &Emitters, counted: &'c [Counted]) -> Vec<&'c Counted> {
    let mut found: Vec<&Counted> = Vec::new();
    for source in counted.iter().filter(|source| source.emitter.is_some()) {
        let same = |known: &&Counted| luminaire(emitters, known) == luminaire(emitters, source);
        if !found.iter().any(same) {
            found.push(source);
        }
    }
    found
}

fn least(remedies: impl Iterator<Item = Remedy>) -> Option<Remedy> {
    remedies.min_by(|a, b| a.ugr.total_cmp(&b.ugr))
}

fn dimmed(emitters: &Emitters, counted: &[Counted], background: Nits) -> Option<Remedy> {
    least(each_luminaire(emitters, counted).into_iter().filter_map(|one| {
        let own = luminaire(emitters, one);
        let ugr = changed(counted, background, |source| {
            let mut changed = source.source;
            if luminaire(emitters, source) == own {
                changed.luminance = Nits(changed.luminance.0 * DIMMED);
                changed.eye_lx *= DIMMED;
                changed.extent = changed
                    .extent
                    .map(|extent| Extent { intensity_cd: extent.intensity_cd * DIMMED, ..extent });
            }
            Some(changed)
        })?;
        let index = own?;
        // A luminaire that is not seen itself glares by its images only.
        let is_seen = counted.iter().any(|source| source.emitter == Some(index));
        let image = one.emitter.and_then(|image| emitters.sources[image].mirror).filter(|_| !is_seen);
        let mirror = image.map(|mirror| {
            let surface = emitters.scene.tracer.surface(emitters.mirrors[mirror].triangles[0]);
            emitters.scene.mesh.surfaces[surface as usize].name.clone()
        });
        Some(Remedy { luminaire: label(emitters, index), ugr, shift: None, mirror })
    }))
}

/// Whether a luminaire may be shifted so: it stays in its room, and nothing stands in its way. Looked at from places
/// along the outline of its opening and from its middle, a little before the surface that it may be set into.
fn may_shift(emitters: &Emitters, rooms: &[Room], index: usize, shift: DVec3) -> bool {
    let source = &emitters.sources[index];
    let luminaire = emitters.luminaire(source);
    let outline = emitters.outline(source);
    let edges = outline.iter().enumerate();
    let along = edges.flat_map(|(corner, &from)| {
        let to = outline[(corner + 1) % outline.len()];
        (0..PARTS).map(move |part| from.lerp(to, part as f64 / PARTS as f64))
    });
    let before = BEFORE_M * luminaire.beam_axis();
    let way = shift.normalize_or_zero();
    let room = rooms.iter().find(|room| room.luminaires.contains(&source.luminaire));
    std::iter::once(source.position).chain(along).all(|place| {
        let hit = emitters.scene.tracer.closest(place + before, way, &luminaire.body);
        let is_free = hit.is_none_or(|hit| hit.distance_m > shift.length());
        let there = (place + shift).truncate();
        is_free && room.is_none_or(|room| polygon::contains(&room.footprint, there, 0.0))
    })
}

fn moved(
    emitters: &Emitters,
    rooms: &[Room],
    counted: &[Counted],
    view: &ViewpointOutcome,
    convention: Convention,
    weights: &[f64],
) -> Option<Remedy> {
    let ahead = DVec3::new(view.direction.x, view.direction.y, 0.0).try_normalize()?;
    let right = ahead.cross(DVec3::Z);
    let ways = [(Shift::Away, ahead), (Shift::Nearer, -ahead), (Shift::Right, right), (Shift::Left, -right)];
    let up = if view.direction.z.abs() > 0.999 { DVec3::Y } else { DVec3::Z };
    let own = counted.iter().filter_map(|one| {
        let index = one.emitter.filter(|&index| emitters.sources[index].mirror.is_none())?;
        Some((one, index))
    });
    least(own.flat_map(|(one, index)| ways.map(|way| (one, index, way))).filter_map(
        |(one, index, (shift, way))| {
            let source = &emitters.sources[index];
            if !may_shift(emitters, rooms, index, SHIFT_M * way) {
                return None;
            }
            let [luminance, solid_angle_sr] = emitters.shifted(source, view.eye, SHIFT_M * way)?;
            let towards = source.position + SHIFT_M * way - view.eye;
            let position = convention.position.position(view.direction, up, towards.normalize());
            let ugr = changed(counted, Nits(view.background_cd_m2), |other| {
                if other.emitter != Some(index) {
                    return Some(other.source);
                }
                let cos = towards.normalize().dot(view.direction);
                let (position_index, off_table) = match position {
                    _ if !(cos > 0.0) => return None,
                    Position::Index(index) | Position::BelowTable(index) => (index, false),
                    Position::OffTable(index) => (index, true),
                };
                let luminance = weights[source.channel] * luminance;
                Some(GlareSource {
                    luminance: Nits(luminance),
                    solid_angle_sr,
                    position_index,
                    ugr_share: if off_table { 0.0 } else { 1.0 },
                    off_axis_deg: cos.clamp(-1.0, 1.0).acos().to_degrees(),
                    eye_lx: luminance * solid_angle_sr * cos,
                    extent: Some(Extent {
                        projected_area_m2: solid_angle_sr * towards.length_squared(),
                        intensity_cd: luminance * solid_angle_sr * towards.length_squared(),
                        distance_m: towards.length(),
                    }),
                })
            })?;
            Some(Remedy { luminaire: one.label.clone(), ugr, shift: Some(shift), mirror: None })
        },
    ))
}
