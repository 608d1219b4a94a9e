//! The plain figures of a view: illuminances, background and mean luminance, and the ratios of
//! luminance between task, surround and far field.

use super::source::{Sight, positive};
use crate::units::{Nits, Undefined};

/// Half-angles from the line to the task within which the surround and the far field lie, degrees:
/// cones of 60° and 120°, as luminance ratios are customarily given.
pub const FIELD_HALF_ANGLES_DEG: [f64; 2] = [30.0, 60.0];

/// E_v, lx.
///
/// # Errors
/// It is no number.
pub fn e_v(sight: &Sight) -> Result<f64, Undefined> {
    finite(sight.e_v_lx)
}

/// The part of E_v that comes from the sources, lx.
///
/// # Errors
/// It is no number.
pub fn e_direct(sight: &Sight) -> Result<f64, Undefined> {
    finite(sight.e_direct_lx)
}

/// L_b, cd/m².
///
/// # Errors
/// It is no number.
pub fn l_b(sight: &Sight) -> Result<f64, Undefined> {
    finite(sight.background.0)
}

/// Mean luminance of the field of view, cd/m².
///
/// # Errors
/// It is not known.
pub fn l_mean(sight: &Sight) -> Result<f64, Undefined> {
    let mean = sight
        .mean
        .ok_or_else(|| Undefined::because("the mean luminance of the field of view is not known"))?;
    finite(mean.0)
}

fn finite(value: f64) -> Result<f64, Undefined> {
    if value.is_finite() { Ok(value) } else { Err(Undefined::because("it is no number")) }
}

/// Mean luminances of a task, of what surrounds it and of the far field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zones {
    /// Of the task zone.
    pub task: Nits,
    /// Within 30° of the task, the task left out.
    pub surround: Nits,
    /// From 30° to 60° of the task.
    pub far: Nits,
}

impl Zones {
    /// L_task/L_surround; commonly kept within 3 : 1 and 1 : 3.
    ///
    /// # Errors
    /// The surround is dark.
    pub fn task_to_surround(&self) -> Result<f64, Undefined> {
        Ok(self.task.0 / positive(self.surround.0, "the surround of the task is dark")?)
    }

    /// L_task/L_far; commonly kept within 10 : 1 and 1 : 10.
    ///
    /// # Errors
    /// The far field is dark.
    pub fn task_to_far(&self) -> Result<f64, Undefined> {
        Ok(self.task.0 / positive(self.far.0, "the far field is dark")?)
    }
}
