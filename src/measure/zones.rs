//! Luminances of a task, its surround and the far field, and their ratios: each zone is a receiver of its own, so
//! its mean luminance comes in blocks like any illuminance, and a ratio has Fieller's interval.

use std::f64::consts::PI;

use super::area::ratio;
use super::{Answers, Gauged};
use crate::estimate::Estimate;
use crate::glare::luminances::{Part, ZoneFigure, Zones};
use crate::norm::Light;
use crate::plan::PlannedTask;
use crate::units::{Nits, Undefined};

/// Light of the zones about a task.
#[derive(Clone, Debug)]
pub struct ZoneLight {
    task: OneZone,
    surround: OneZone,
    far: OneZone,
    /// What was taken for what.
    pub words: Vec<String>,
}

#[derive(Clone, Debug)]
struct OneZone {
    /// Block values of the mean luminance, cd/m².
    blocks: Vec<f64>,
    /// Mean luminance that blocks may have missed, cd/m².
    hidden: f64,
}

impl ZoneLight {
    /// Of the rows of the sheets.
    pub fn of_rows(answers: &Answers, planned: &PlannedTask, weights: &[f64]) -> Self {
        let zone = |row: usize| OneZone {
            blocks: answers.total(row, weights).into_iter().map(|lx| lx / PI).collect(),
            hidden: answers.hidden(row, weights, Light::All) / PI,
        };
        let [task, surround, far] = planned.rows.map(zone);
        Self { task, surround, far, words: planned.about.words() }
    }

    fn of(&self, part: Part) -> &OneZone {
        match part {
            Part::Task => &self.task,
            Part::Surround => &self.surround,
            Part::Far => &self.far,
        }
    }

    /// Mean luminances.
    pub fn zones(&self) -> Zones {
        let mean = |part: Part| Nits(Estimate::from_blocks(&self.of(part).blocks).value);
        Zones { task: mean(Part::Task), surround: mean(Part::Surround), far: mean(Part::Far) }
    }

    /// A figure whose interval errs with probability `alpha`.
    pub fn gauge(&self, figure: ZoneFigure, alpha: f64) -> Gauged {
        match figure {
            ZoneFigure::Luminance(part) => {
                let zone = self.of(part);
                let estimate = Estimate::from_blocks(&zone.blocks);
                let (lo, hi) = estimate.interval(alpha);
                let value = self.zones().figure(figure);
                Gauged { value, se: estimate.se, lo, hi: hi + zone.hidden, place: None }
            }
            ZoneFigure::TaskOver(part) => {
                let [own, other] = [&self.task, self.of(part)];
                ratio([&own.blocks, &other.blocks], [own.hidden, other.hidden], alpha)
                    .unwrap_or_else(|| Gauged::undefined(Undefined::because(figure.dark())))
            }
        }
    }

    /// Whether the luminances of all zones have reached a relative standard error `r`.
    pub fn is_within(&self, r: f64) -> bool {
        [Part::Task, Part::Surround, Part::Far].into_iter().all(|part| {
            let estimate = Estimate::from_blocks(&self.of(part).blocks);
            self.of(part).hidden.is_finite() && !(estimate.se > r * estimate.value.abs())
        })
    }
}
