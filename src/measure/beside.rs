//! What some indices ask of a view beside its sources and the light in the eye: the mean luminance of the field of
//! view, an illuminated area, how much of the ceiling shines. Each is known, or there is a reason why not.

use std::f64::consts::PI;

use super::area::{self, Blocks};
use super::zones::ZoneLight;
use super::{Answers, Gauged};
use crate::estimate::Estimate;
use crate::geometry::polygon;
use crate::glare::source::{Given, Ground, Sight};
use crate::glare::{ggr, gr, threshold_increment, vcp};
use crate::norm::Light;
use crate::plan::{FIELD_HALF_ANGLE_DEG, NOT_ASKED};
use crate::project::{Room, World};
use crate::scene::Channel;
use crate::units::{Nits, Undefined};

/// Why a viewpoint without a road has no f_TI.
const NO_ROAD_HERE: &str = "a room has no road: f_TI needs its mean luminance (`road` of the viewpoint)";

/// How far below the room's height a surface may shine and still belong to the ceiling, m.
const CEILING_M: f64 = 0.25;

/// What is known beside a view.
#[derive(Clone, Copy, Debug)]
pub struct Beside<'a> {
    /// What the user says about observer and surroundings; it goes before what is computed.
    pub given: Given,
    /// Light of the zones about the task.
    pub zones: Result<&'a ZoneLight, &'a str>,
    /// Mean luminance of the field of view, cd/m².
    pub field: Result<Blockwise, &'a str>,
    /// The illuminated area.
    pub ground: Result<Lit<'a>, &'a str>,
    /// Share of the ceiling that shines.
    pub ceiling: Result<f64, &'a str>,
}

/// A mean over blocks, and what blocks may have missed of it.
#[derive(Clone, Copy, Debug)]
pub struct Blockwise {
    /// The mean.
    pub estimate: Estimate,
    /// What may be missing.
    pub hidden: f64,
}

/// An illuminated area.
#[derive(Clone, Copy, Debug)]
pub struct Lit<'a> {
    /// Its name.
    pub name: &'a str,
    /// Mean horizontal illuminance, lx.
    pub mean_lx: Blockwise,
    /// Diffuse reflectance of what lies under it.
    pub reflectance: f64,
}

impl Blockwise {
    /// Mean luminance over a zone of the field of view that a row answers.
    pub fn of_zone(answers: &Answers, row: usize, weights: &[f64]) -> Self {
        let blocks: Vec<f64> = answers.total(row, weights).into_iter().map(|lx| lx / PI).collect();
        Self {
            estimate: Estimate::from_blocks(&blocks),
            hidden: answers.hidden(row, weights, Light::All) / PI,
        }
    }

    /// Mean over the points of an area.
    pub fn of_area(blocks: &Blocks) -> Self {
        Self { estimate: Estimate::from_blocks(&area::mean_blocks(blocks)), hidden: blocks.hidden_mean() }
    }

    /// Whether its relative standard error is at most `r`.
    pub fn is_within(&self, r: f64) -> bool {
        self.hidden.is_finite() && !(self.estimate.se > r * self.estimate.value.abs())
    }
}

impl<'a> Beside<'a> {
    /// Nothing, for one reason.
    pub fn nothing(reason: &'a str) -> Self {
        let given = Given::default();
        Self { given, zones: Err(reason), field: Err(reason), ground: Err(reason), ceiling: Err(reason) }
    }

    /// The illuminated area, unless the user gives another ground.
    fn lit(&self) -> Option<Lit<'a>> {
        if self.given.ground.is_some() { None } else { self.ground.ok() }
    }

    /// What the indices take for given.
    pub fn given(&self) -> Given {
        let ground = |lit: Lit| Ground { mean_lx: lit.mean_lx.estimate.value, reflectance: lit.reflectance };
        Given {
            ceiling_coverage: self.given.ceiling_coverage.or(self.ceiling.ok()),
            ground: self.given.ground.or(self.lit().map(ground)),
            ..self.given
        }
    }

    /// Mean luminance of the field of view.
    pub fn mean(&self) -> Option<Nits> {
        self.field.ok().map(|field| Nits(field.estimate.value))
    }

    /// Standard errors of field and ground.
    pub fn errors(&self) -> [f64; 2] {
        [self.field.ok(), self.lit().map(|lit| lit.mean_lx)]
            .map(|known| known.map_or(0.0, |known| known.estimate.se))
    }

    /// Why an index has no value here: that something is not given says less than why it is not.
    pub fn reason(&self, undefined: Undefined) -> Undefined {
        let why = match undefined.reason.as_str() {
            vcp::NO_MEAN => self.field.err(),
            gr::NO_GROUND => self.ground.err(),
            ggr::NO_COVERAGE => self.ceiling.err(),
            threshold_increment::NO_ROAD => Some(NO_ROAD_HERE),
            _ => None,
        };
        why.map_or(undefined, Undefined::because)
    }

    /// What was taken for what by an index.
    pub fn words(&self, key: &str) -> Option<String> {
        match key {
            "DGR" | "VCP" | "L_mean" => self.field.ok().map(|_| {
                format!("field of view: a cone of 5 sr, {FIELD_HALF_ANGLE_DEG:.1}° about the line of sight, luminaires included")
            }),
            "GGR" => match self.given.ceiling_coverage {
                Some(share) => Some(format!("{share:.3} of the ceiling shines, as given")),
                None => self.ceiling.ok().map(|share| format!("{share:.3} of the ceiling shines")),
            },
            "GR" => match (self.given.ground, self.lit()) {
                (Some(Ground { mean_lx, reflectance }), _) => {
                    Some(format!("ground of {mean_lx:.1} lx, reflectance {reflectance:.3}, as given"))
                }
                (None, lit) => lit.map(|lit| {
                    format!(
                        "area \"{}\" of {:.1} lx at initial flux, reflectance {:.3}",
                        lit.name, lit.mean_lx.estimate.value, lit.reflectance
                    )
                }),
            },
            _ => None,
        }
    }

    /// Views with more light in the field or on the ground by `added`, each with what it takes of it: for skewed and
    /// hidden light.
    pub(super) fn brighter(
        &self,
        sight: &Sight,
        added: impl Fn(&Blockwise) -> f64,
    ) -> Vec<(Sight, Blockwise)> {
        let field = self.field.ok().map(|known| {
            (Sight { mean: Some(Nits(known.estimate.value + added(&known))), ..sight.clone() }, known)
        });
        let ground = self.lit().zip(sight.given.ground).map(|(lit, ground)| {
            let ground = Ground { mean_lx: ground.mean_lx + added(&lit.mean_lx), ..ground };
            let given = Given { ground: Some(ground), ..sight.given };
            (Sight { given, ..sight.clone() }, lit.mean_lx)
        });
        field.into_iter().chain(ground).collect()
    }

    /// Farther ends for light that blocks may have missed: an index with more of it lies there.
    pub(super) fn with_hidden(
        &self,
        gauged: Gauged,
        sight: &Sight,
        index: impl Fn(&Sight) -> Result<f64, Undefined>,
    ) -> Gauged {
        let Ok(value) = gauged.value else { return gauged };
        let mut found = gauged;
        for (brighter, known) in self.brighter(sight, |known| known.hidden) {
            if !(known.hidden > 0.0) {
                continue;
            }
            let [down, up] = match index(&brighter) {
                Ok(there) => [there.min(value) - value, there.max(value) - value],
                Err(_) => [f64::NEG_INFINITY, f64::INFINITY],
            };
            (found.lo, found.hi) = (found.lo + down, found.hi + up);
        }
        found
    }
}

/// Share of a room's ceiling that shines under these weights, as seen from straight below: openings of its
/// luminaires, hung ones too, and surfaces that emit within 0.25 m of its height, one beside the other; CIE 147.
///
/// # Errors
/// Nothing of it shines, or none of the indices asks for it: a large scene takes its time.
pub fn ceiling(
    world: &World,
    room: &Room,
    weights: &[f64],
    indices: &[&'static str],
) -> Result<f64, &'static str> {
    if !indices.contains(&"GGR") {
        return Err(NOT_ASKED);
    }
    let scene = &world.scene;
    let shining = room.luminaires.iter().map(|&index| (&scene.luminaires[index], scene.channel_of[index]));
    let openings_m2: f64 = shining
        .filter(|(luminaire, channel)| weights[*channel] * luminaire.dim > 0.0)
        .map(|(luminaire, _)| {
            let down = luminaire.world_from_luminaire.transpose() * glam::DVec3::NEG_Z;
            luminaire.kind.opening.projected_area_m2(down)
        })
        .sum();
    let shines = |material: usize| {
        let own =
            |channel: &Channel| matches!(channel, Channel::Surfaces { material: own } if *own == material);
        scene.channels.iter().position(own).is_some_and(|channel| weights[channel] > 0.0)
    };
    let mesh = &scene.mesh;
    let mut surfaces_m2 = 0.0;
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let middle = mesh.corners(index).iter().sum::<glam::DVec3>() / 3.0;
        let is_high = middle.z > room.floor_m + room.height_m - CEILING_M;
        let surface = triangle.surface;
        if is_high
            && shines(mesh.surfaces[surface as usize].material)
            && polygon::contains(&room.footprint, middle.truncate(), 0.0)
        {
            let (normal, area_m2) = mesh.normal_and_area(index);
            // A solid has as much above as below.
            let seen = if scene.is_closed(surface) { 0.5 } else { 1.0 };
            surfaces_m2 += seen * normal.z.abs() * area_m2;
        }
    }
    let share = (openings_m2 + surfaces_m2) / polygon::signed_area_m2(&room.footprint).abs();
    if !(share > 0.0) {
        return Err("nothing of the ceiling shines");
    }
    // From below no more than all of it is seen: what hangs under a luminous ceiling hides as much as it adds.
    Ok(share.min(1.0))
}
