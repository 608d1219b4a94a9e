//! The plain figures of a view: illuminances, background and mean luminance, and the ratios of
//! luminance between task, surround and far field.

use super::source::{Sight, positive};
use crate::units::{Nits, Undefined};

/// Half-angles from the line to the task within which the surround and the far field lie, degrees:
/// cones of 60° and 120°, as luminance ratios are customarily given.
pub const FIELD_HALF_ANGLES_DEG: [f64; 2] = [30.0, 60.0];

/// Full opening angle of a task's cone if none is given, degrees: the width of a sheet of 210 mm at 0.6 m. No norm
/// fixes it; it is a convention of this program.
pub const TASK_DEG: f64 = 20.0;

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
    let mean = sight.mean.ok_or_else(|| Undefined::because(super::vcp::NO_MEAN))?;
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

/// One of the zones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The task.
    Task,
    /// What surrounds it.
    Surround,
    /// The far field.
    Far,
}

/// A figure of the zones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZoneFigure {
    /// Mean luminance of a zone.
    Luminance(Part),
    /// The task's over that of another zone.
    TaskOver(Part),
}

/// L_task, cd/m².
///
/// # Errors
/// It is not known.
pub fn l_task(sight: &Sight) -> Result<f64, Undefined> {
    figure(sight, ZoneFigure::Luminance(Part::Task))
}

/// L_surround, cd/m².
///
/// # Errors
/// It is not known.
pub fn l_surround(sight: &Sight) -> Result<f64, Undefined> {
    figure(sight, ZoneFigure::Luminance(Part::Surround))
}

/// L_far, cd/m².
///
/// # Errors
/// It is not known.
pub fn l_far(sight: &Sight) -> Result<f64, Undefined> {
    figure(sight, ZoneFigure::Luminance(Part::Far))
}

/// L_task/L_surround.
///
/// # Errors
/// One is not known, or the surround is dark.
pub fn task_to_surround(sight: &Sight) -> Result<f64, Undefined> {
    figure(sight, ZoneFigure::TaskOver(Part::Surround))
}

/// L_task/L_far.
///
/// # Errors
/// One is not known, or the far field is dark.
pub fn task_to_far(sight: &Sight) -> Result<f64, Undefined> {
    figure(sight, ZoneFigure::TaskOver(Part::Far))
}

fn figure(sight: &Sight, figure: ZoneFigure) -> Result<f64, Undefined> {
    let unknown = || Err(Undefined::because("no task is given whose luminance could be compared"));
    sight.zones.clone().unwrap_or_else(unknown)?.figure(figure)
}

impl ZoneFigure {
    /// Why the ratio has no value where its lower luminance is 0.
    pub fn dark(self) -> &'static str {
        match self {
            Self::Luminance(Part::Task) | Self::TaskOver(Part::Task) => "the task is dark",
            Self::Luminance(Part::Surround) | Self::TaskOver(Part::Surround) => {
                "the surround of the task is dark"
            }
            Self::Luminance(Part::Far) | Self::TaskOver(Part::Far) => "the far field is dark",
        }
    }
}

impl Zones {
    /// Mean luminance of a zone.
    pub fn of(&self, part: Part) -> Nits {
        match part {
            Part::Task => self.task,
            Part::Surround => self.surround,
            Part::Far => self.far,
        }
    }

    /// A figure of them.
    ///
    /// # Errors
    /// It is no number, or a ratio to darkness.
    pub fn figure(&self, figure: ZoneFigure) -> Result<f64, Undefined> {
        match figure {
            ZoneFigure::Luminance(part) => finite(self.of(part).0),
            ZoneFigure::TaskOver(part) => finite(self.task.0 / positive(self.of(part).0, figure.dark())?),
        }
    }

    /// L_task/L_surround; commonly kept within 3 : 1 and 1 : 3.
    ///
    /// # Errors
    /// The surround is dark.
    pub fn task_to_surround(&self) -> Result<f64, Undefined> {
        self.figure(ZoneFigure::TaskOver(Part::Surround))
    }

    /// L_task/L_far; commonly kept within 10 : 1 and 1 : 10.
    ///
    /// # Errors
    /// The far field is dark.
    pub fn task_to_far(&self) -> Result<f64, Undefined> {
        self.figure(ZoneFigure::TaskOver(Part::Far))
    }
}
