//! Limits of the norm that a `[[require]]` of the user's sets aside: they stay where they are, with the reason, and are
//! not assessed.

use super::{PlanError, PlannedRequirement, Subject};
use crate::outcome::{Bound, SET_ASIDE};
use crate::project::Instead;

/// Sets aside what the norm asks of the same place, quantity, statistic and side as `own`, or does not know of it.
pub(super) fn set_aside(
    required: &mut [PlannedRequirement],
    own: &PlannedRequirement,
    instead: &Instead,
    errors: &mut Vec<PlanError>,
) {
    let same_side = |other: &Bound| match (other, &own.bound) {
        (Bound::Min(limit), _) if limit.is_nan() => true,
        (Bound::Min(_), Bound::Min(_)) | (Bound::Max(_), Bound::Max(_)) => true,
        (Bound::Min(_), Bound::Max(_)) | (Bound::Max(_), Bound::Min(_)) => false,
    };
    let replaced = |other: &PlannedRequirement| {
        other.standard != own.standard
            && other.subject_name == own.subject_name
            && other.light_scene == own.light_scene
            && (other.quantity == own.quantity || other.subject == own.subject)
            && other.statistic == own.statistic
            && same_side(&other.bound)
    };
    let mut any = false;
    for other in required.iter_mut().filter(|other| replaced(other)) {
        any = true;
        other.subject = Subject::Missing(format!("{SET_ASIDE}: {}", instead.reason));
    }
    if !any {
        let what = format!("{} {} of \"{}\"", own.statistic.key(), own.quantity.key(), own.subject_name);
        errors.push(PlanError::NothingSetAside { what, place: Some(instead.written.clone()) });
    }
}
