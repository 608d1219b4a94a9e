//! What an observer looks at → receivers: the field of view, the task's cone, its surround and the far field, each a
//! zone before the eye. The task's zones are those of images ([`crate::glare::field`]), so that both tell the same.

use glam::DVec3;

use crate::glare::index::parse;
use crate::glare::luminances::FIELD_HALF_ANGLES_DEG;
use crate::project::Task;
use crate::query::{Kernel, Receiver, Zone};

/// Half-angle of a cone of 5 sr, degrees: 2π (1 − cos α) = 5. IES takes F = Σ Lω/5 sr as the mean luminance of the
/// field of view and says nothing of its shape; a cone about the line of sight is a convention of this program.
pub const FIELD_HALF_ANGLE_DEG: f64 = 78.215848291344;

/// Indices that ask for the mean luminance of the field of view.
const OF_FIELD: [&str; 3] = ["DGR", "VCP", "L_mean"];

/// Why something is not known beside a view: no index that is computed asks for it.
pub const NOT_ASKED: &str = "it was not asked for";

/// The receiver of the mean luminance of the field of view, times π, where some of the indices ask for it.
pub fn field_of_view(indices: &[&'static str], eye: DVec3, gaze: DVec3) -> Option<Receiver> {
    let zone = Zone::new(gaze, gaze, [0.0, FIELD_HALF_ANGLE_DEG])?;
    let wanted = indices.iter().any(|key| OF_FIELD.contains(key));
    wanted.then(|| Receiver { point: eye, lift: DVec3::ZERO, kernels: vec![Kernel::Zone(zone)] })
}

/// Why there are no luminances of a task.
pub const BEHIND: &str = "the task lies behind the eye";

/// The zones about a task before one eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskZones {
    /// Task, surround, far field.
    pub zones: [Zone; 3],
    /// Full opening angle of the task's cone, degrees.
    pub opening_deg: f64,
    /// Angle between its middle and the line of sight, degrees.
    pub aside_deg: f64,
}

/// Zones with the rows that answer them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedTask {
    /// The zones.
    pub about: TaskZones,
    /// Rows of their luminances times π.
    pub rows: [usize; 3],
}

/// Whether some of the indices compare a task with what surrounds it.
pub fn concerns_task(indices: &[&'static str]) -> bool {
    indices.iter().any(|key| parse(key).is_some_and(|index| index.zones.is_some()))
}

impl TaskZones {
    /// The zones about a task for an eye that looks along the unit `gaze`; `None` where its middle lies behind the eye.
    pub fn of(task: &Task, eye: DVec3, gaze: DVec3) -> Option<Self> {
        let axis = task.direction(eye, gaze);
        let [near_deg, far_deg] = FIELD_HALF_ANGLES_DEG;
        let half_deg = 0.5 * task.opening_deg;
        let zone = |angles_deg| Zone::new(axis, gaze, angles_deg).filter(|_| axis.dot(gaze) > 0.0);
        let zones = [zone([0.0, half_deg])?, zone([half_deg, near_deg])?, zone([near_deg, far_deg])?];
        Some(Self { zones, opening_deg: task.opening_deg, aside_deg: axis.angle_between(gaze).to_degrees() })
    }

    /// Its receivers, one for each zone: zones have no direction in common, so no ray would serve two.
    pub fn receivers(&self, eye: DVec3) -> [Receiver; 3] {
        self.zones.map(|zone| Receiver { point: eye, lift: DVec3::ZERO, kernels: vec![Kernel::Zone(zone)] })
    }

    /// What was taken for what, in words.
    pub fn words(&self) -> Vec<String> {
        let [near_deg, far_deg] = FIELD_HALF_ANGLES_DEG;
        let (opening_deg, aside_deg) = (self.opening_deg, self.aside_deg);
        let mut said = vec![if aside_deg > 0.05 {
            format!(
                "the task is a cone of {opening_deg}° at {aside_deg:.1}° from the line of sight, its surround up to {near_deg}° and the far field up to {far_deg}° from its middle"
            )
        } else {
            format!(
                "the task is a cone of {opening_deg}° about the line of sight, its surround up to {near_deg}° and the far field up to {far_deg}° from its middle"
            )
        }];
        if self.zones.iter().any(Zone::is_cut) {
            said.push("what of the zones lies behind the plane of the eye is left out".into());
        }
        said
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: the full angle for the half-angle, a field of another size, a receiver where nothing asks for it.
    #[test]
    fn the_field_of_view_is_5_sr() {
        let field = field_of_view(&["UGR", "VCP"], DVec3::ZERO, DVec3::X).expect("VCP asks for it");
        let [Kernel::Zone(zone)] = field.kernels[..] else { panic!("a zone") };
        assert!((zone.size_sr() - 5.0).abs() < 1e-10, "{}", zone.size_sr());
        assert!(!zone.is_cut());
        assert!(field_of_view(&["UGR", "DGP"], DVec3::ZERO, DVec3::X).is_none());
    }
}
