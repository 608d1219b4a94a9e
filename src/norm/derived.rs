//! Limits that follow from others by the rules of a norm: surrounding and background from the task,
//! uniformities from means, and the task's own illuminance raised or lowered for reasons of context.

use super::{Background, Bound, Limit, Row, Standard, Verified, Zone};
use crate::quantity::{Quantity, Statistic};

impl Standard {
    /// Required mean illuminance of the immediate surrounding of a task, lx; `None` if the standard
    /// has no such rule.
    pub fn surrounding_illuminance(&self, task_lx: f64) -> Option<f64> {
        let steps = &self.application.surrounding.as_ref()?.illuminance_lx.value;
        Some(steps.iter().find(|[from_lx, _]| task_lx >= *from_lx).map_or(task_lx, |[_, lx]| *lx))
    }

    /// All limits for an area judged by a row: the row's own, then those for surrounding and
    /// background that follow from the task's illuminance, then the uniformities that go with limits
    /// on walls, ceiling and cylindrical illuminance.
    pub fn requirements(&self, row: &Row) -> Vec<Limit> {
        self.requirements_at(row, None)
    }

    /// The same with the task's illuminance raised or lowered to a value for reasons of context;
    /// surrounding and background follow it.
    pub fn requirements_at(&self, row: &Row, modified_lx: Option<f64>) -> Vec<Limit> {
        let mut limits = row.limits.clone();
        if let Some(task) = row.illuminance() {
            let (bound, verified) = match modified_lx {
                None => (task.bound, task.verified),
                Some(lx) => (Bound::Min(lx), self.standing_of_modified(row, task, lx)),
            };
            let task = Limit { bound, verified, ..*task };
            if let Some(own) = limits.iter_mut().find(|limit| limit.is_task_level()) {
                (own.bound, own.verified) = (bound, verified);
            }
            limits.extend(self.around(&task));
        }
        let rules = &self.application;
        for (zone, uniformity) in [
            (Zone::Walls, &rules.walls_u0),
            (Zone::Ceiling, &rules.ceiling_u0),
            (Zone::Cylindrical, &rules.cylindrical_u0),
        ] {
            let mean =
                row.limits.iter().find(|limit| limit.zone == zone && limit.statistic == Statistic::Mean);
            let own = row.limits.iter().any(|limit| limit.zone == zone && limit.statistic == Statistic::U0);
            if let (Some(mean), Some(u0), false) = (mean, uniformity, own) {
                limits.push(minimum(
                    zone,
                    mean.quantity,
                    Statistic::U0,
                    u0.value,
                    mean.verified.min(u0.verified),
                ));
            }
        }
        limits
    }

    /// How well a modified illuminance is known: as the row's own value for difficult conditions, or no
    /// better than the task's and the scale along which it was found.
    fn standing_of_modified(&self, row: &Row, task: &Limit, lx: f64) -> Verified {
        match (row.modified_lx, &self.application.illuminance_scale_lx) {
            (Some((own_lx, verified)), _) if (own_lx - lx).abs() < 1e-9 => verified,
            (_, Some(scale)) => task.verified.min(scale.verified),
            (_, None) => Verified::Unverified,
        }
    }

    /// Limits of surrounding and background that follow from a task's mean illuminance.
    fn around(&self, task: &Limit) -> Vec<Limit> {
        let mut limits = Vec::new();
        if let Some(share) = &self.application.surrounding_of_task {
            let (zone, statistic) = (Zone::Surrounding, Statistic::OfTask);
            limits.push(minimum(zone, task.quantity, statistic, share.value, share.verified));
        }
        let (Some(surrounding), Bound::Min(task_lx)) = (&self.application.surrounding, task.bound) else {
            return limits;
        };
        let lx = self.surrounding_illuminance(task_lx).unwrap_or(task_lx);
        let known = task.verified.min(surrounding.illuminance_lx.verified);
        let quantity = task.quantity;
        let u0 = &surrounding.u0;
        limits.push(minimum(Zone::Surrounding, quantity, Statistic::Mean, lx, known));
        limits.push(minimum(Zone::Surrounding, quantity, Statistic::U0, u0.value, u0.verified));
        if let Some(Background { fraction, u0, .. }) = &self.application.background {
            let known = known.min(fraction.verified);
            limits.push(minimum(Zone::Background, quantity, Statistic::Mean, lx * fraction.value, known));
            limits.push(minimum(Zone::Background, quantity, Statistic::U0, u0.value, u0.verified));
        }
        limits
    }

    /// The task's illuminance some steps further along the norm's scale, lx; no steps: the row's
    /// value for difficult conditions.
    ///
    /// # Errors
    /// Why there is none, in words that end a sentence.
    pub fn modified_illuminance(&self, row: &Row, steps: Option<i32>) -> Result<f64, String> {
        let Some(Limit { bound: Bound::Min(required_lx), .. }) = row.illuminance() else {
            return Err(format!("row {} requires no illuminance", row.reference));
        };
        let Some(steps) = steps else {
            let modified = row.modified_lx.map(|(lx, _)| lx);
            return modified.ok_or_else(|| {
                format!("the modified illuminance of row {} is not known here: give steps", row.reference)
            });
        };
        let Some(scale) = &self.application.illuminance_scale_lx else {
            return Err(format!("{} has no scale of illuminance to step along", self.short));
        };
        let place = scale.value.iter().position(|lx| (lx - required_lx).abs() < 1e-9);
        let place = place.ok_or_else(|| {
            format!("{required_lx} lx of row {} is no step of the norm's scale", row.reference)
        })?;
        let target = i64::try_from(place).unwrap_or(i64::MAX).saturating_add(i64::from(steps));
        let found = usize::try_from(target).ok().and_then(|target| scale.value.get(target));
        found.copied().ok_or_else(|| format!("{steps} steps from {required_lx} lx leave the norm's scale"))
    }
}

/// A lower limit.
fn minimum(zone: Zone, quantity: Quantity, statistic: Statistic, value: f64, verified: Verified) -> Limit {
    Limit { zone, quantity, statistic, bound: Bound::Min(value), verified }
}
