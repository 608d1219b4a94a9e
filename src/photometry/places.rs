//! Lines of the file where its statements stand, so that what shows only in the finished distribution
//! can still be looked up by its reader. All count from 1; `None` where the format has no lines for it.

use std::sync::Arc;

use super::planes::Plane;

/// Where a file says what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// The flux that it rates.
    pub flux: Option<usize>,
    /// The light output ratio.
    pub output_ratio: Option<usize>,
    /// The power.
    pub power: Option<usize>,
    /// The luminous opening.
    pub opening: Option<usize>,
    /// The first and the last γ.
    pub gammas: Option<[usize; 2]>,
    /// Azimuth of a half-plane in the luminaire frame, lines of its intensities by γ.
    pub(super) planes: Vec<(f64, Arc<[usize]>)>,
}

impl Places {
    /// The half-planes of a file, mirror images included, turned into the luminaire frame.
    pub(super) fn with_planes(mut self, planes: &[Plane], turn_deg: f64) -> Self {
        let place = |plane: &Plane| ((plane.angle_deg + turn_deg).rem_euclid(360.0), plane.lines.clone());
        self.planes = planes.iter().map(place).collect();
        self
    }

    /// The line of the intensity at an azimuth and the γ of that index: of the nearest stored plane.
    pub fn intensity(&self, azimuth_deg: f64, gamma_index: usize) -> Option<usize> {
        let apart = |(angle_deg, _): &&(f64, Arc<[usize]>)| {
            let difference = (angle_deg - azimuth_deg).rem_euclid(360.0);
            difference.min(360.0 - difference)
        };
        let (_, lines) = self.planes.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        lines.get(gamma_index).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::super::planes::mirrored;
    use super::*;

    /// Catches: a mirror image that names another plane's line, a turn in the wrong direction.
    #[test]
    fn images_name_the_lines_of_their_origin() {
        let plane = |angle_deg: f64, line: usize| Plane {
            angle_deg,
            cd: vec![1.0, 2.0],
            lines: vec![line, line + 1].into(),
        };
        let planes = mirrored(vec![plane(0.0, 10), plane(90.0, 20), plane(180.0, 30)], 0.0);
        let places = Places::default().with_planes(&planes, -90.0);
        assert_eq!(
            [0.0, 270.0, 180.0, 90.0].map(|azimuth| places.intensity(azimuth, 1)),
            [Some(21), Some(11), Some(21), Some(31)]
        );
        assert_eq!((places.intensity(0.0, 2), Places::default().intensity(0.0, 0)), (None, None));
    }
}
