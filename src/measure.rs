//! Sheets → named quantities with intervals. Light scenes, dimming and maintenance are weights on
//! channels here; nothing is solved again. It does not know which solver ran, and nothing leaves it
//! without its uncertainty.

pub mod area;
pub mod beside;
pub mod flux;
pub mod glare_sources;
pub mod intensity;
pub mod room_ugr;
mod stray;
pub mod view;
pub mod zones;

use crate::emitters::ByChance;
use crate::norm::Light;
use crate::outcome::Interval;
use crate::project::{LightScene, Room, World};
use crate::scene::{Channel, Scene};
use crate::solve::{PARTS, Part, Sheet};
use crate::units::Undefined;

/// The sheets of one world, read by row and weighted by channel.
#[derive(Clone, Copy, Debug)]
pub struct Answers<'s> {
    /// One sheet for each block, in order.
    pub sheets: &'s [Sheet],
    /// Channels of the scene.
    pub channels: usize,
    /// Per row of receivers, whether there may be light that no block has found; empty: that is not asked.
    pub may_hide: &'s [bool],
    /// Per row, light that blocks find by chance only, with how many rays of a block do; empty: none.
    pub by_chance: &'s [Vec<ByChance>],
}

/// A known part of the light counts as found if so many rays are expected to have come to it.
const FOUND: f64 = 10.0;

/// A gauged quantity: its value and an interval that errs with a given probability.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauged {
    /// Point estimate.
    pub value: Result<f64, Undefined>,
    /// Standard error of first order; 0 where it is exact.
    pub se: f64,
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
    /// Index of the extreme point or direction.
    pub place: Option<usize>,
}

impl Gauged {
    /// No value.
    pub fn undefined(reason: Undefined) -> Self {
        Self { value: Err(reason), se: f64::NAN, lo: f64::NEG_INFINITY, hi: f64::INFINITY, place: None }
    }

    /// A value without numerical error.
    pub fn exact(value: f64) -> Self {
        Self { value: Ok(value), se: 0.0, lo: value, hi: value, place: None }
    }

    /// As an interval for reports.
    ///
    /// # Errors
    /// The reason why there is no value.
    pub fn interval(&self) -> Result<Interval, Undefined> {
        let value = self.value.clone()?;
        Ok(Interval { value, se: self.se, lo: self.lo, hi: self.hi })
    }
}

impl<'s> Answers<'s> {
    /// Sheets of a scene.
    pub fn of(sheets: &'s [Sheet], scene: &Scene) -> Self {
        Self { sheets, channels: scene.channels.len(), may_hide: &[], by_chance: &[] }
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.sheets.len()
    }

    /// Block values of a row, of the light that counts.
    pub fn counted(&self, row: usize, weights: &[f64], light: Light) -> Vec<f64> {
        match light {
            Light::All => self.total(row, weights),
            Light::Direct => self.part(row, weights, Part::Direct),
        }
    }

    /// Block values of a row: all parts, weighted by channel.
    pub fn total(&self, row: usize, weights: &[f64]) -> Vec<f64> {
        let span = self.channels * PARTS;
        self.sheets
            .iter()
            .map(|sheet| {
                let values = &sheet.values[row * span..(row + 1) * span];
                values.chunks_exact(PARTS).zip(weights).map(|(parts, w)| w * parts.iter().sum::<f64>()).sum()
            })
            .collect()
    }

    /// Block values of one part of a row.
    pub fn part(&self, row: usize, weights: &[f64], part: Part) -> Vec<f64> {
        let span = self.channels * PARTS;
        self.sheets
            .iter()
            .map(|sheet| {
                let values = &sheet.values[row * span..(row + 1) * span];
                values.chunks_exact(PARTS).zip(weights).map(|(parts, w)| w * parts[part as usize]).sum()
            })
            .collect()
    }

    /// Light of a row that blocks may have missed: what its upper end must allow for beyond the scatter of blocks.
    /// Infinite where all blocks agree that only direct light arrives though other light may exist: that none was
    /// found says nothing of how much there is. Else what is known to come by two mirrors, where few rays met it.
    pub fn hidden(&self, row: usize, weights: &[f64], light: Light) -> f64 {
        let found = || self.part(row, weights, Part::Indirect).iter().any(|value| *value > 0.0);
        let blocks = self.blocks() as f64;
        let missed = |one: &&ByChance| one.per_ray * blocks < FOUND;
        let by_chance = self.by_chance.get(row).map_or(&[][..], Vec::as_slice);
        match light {
            Light::Direct => 0.0,
            Light::All if !weights.iter().any(|weight| *weight > 0.0) => 0.0,
            Light::All if self.may_hide.get(row).is_some_and(|may| *may) && !found() => f64::INFINITY,
            Light::All => by_chance.iter().filter(missed).map(|one| weights[one.channel] * one.lx).sum(),
        }
    }

    /// Mean over blocks of one part of a row.
    pub fn part_mean(&self, row: usize, weights: &[f64], part: Part) -> f64 {
        let blocks = self.part(row, weights, part);
        blocks.iter().sum::<f64>() / blocks.len().max(1) as f64
    }
}

/// Weights of the channels in an emergency: the group's factor, the share of the flux that the type has
/// left then, and the maintenance factor. Surfaces that shine of themselves, and luminaires without
/// emergency output, are dark.
pub fn emergency_weights(world: &World, light_scene: &LightScene, room: &Room) -> Vec<f64> {
    let scene = &world.scene;
    let maintained = weights(world, light_scene, room, true);
    let share = |channel: &Channel| match channel {
        Channel::Luminaires { kind, .. } => {
            let of_kind = scene.luminaires.iter().find(|l| l.kind.name == *kind);
            of_kind.and_then(|l| l.kind.emergency).unwrap_or(0.0)
        }
        Channel::Surfaces { .. } => 0.0,
    };
    scene.channels.iter().zip(maintained).map(|(channel, weight)| weight * share(channel)).collect()
}

/// Weights of the channels for a light scene: the group's factor, and for maintained values
/// MF = LLMF·LSF·LMF of the type times the room's RSMF. Emitting surfaces have the group of their
/// material's name and no maintenance factor.
pub fn weights(world: &World, light_scene: &LightScene, room: &Room, maintained: bool) -> Vec<f64> {
    let scene = &world.scene;
    scene
        .channels
        .iter()
        .map(|channel| match channel {
            Channel::Luminaires { group, kind } => {
                let maintenance = if maintained {
                    let of_kind = scene.luminaires.iter().find(|l| l.kind.name == *kind);
                    of_kind.map_or(1.0, |l| l.kind.maintenance.factor()) * room.rsmf
                } else {
                    1.0
                };
                light_scene.factor(group) * maintenance
            }
            Channel::Surfaces { material } => light_scene.factor(&scene.materials[*material].name),
        })
        .collect()
}
