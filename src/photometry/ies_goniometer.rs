//! Types A and B of LM-63 → type C. All share the photometric horizontal (+x at γ = 90°); A turns its
//! planes about the vertical axis like C, B about the horizontal axis x. Horizontal angles count
//! *clockwise* in A and B, counter-clockwise in C.

use std::f64::consts::TAU;

use glam::DVec3;

use super::numbers::{DAMAGED, Number};
use super::planes::Plane;
use super::{DistributionError, Fault, Finding, IntensityDistribution};

/// How the goniometer turned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goniometer {
    A,
    B,
    C,
}

/// Steps of the type C grid, degrees; the first that keeps the error below [`GOOD`] is taken.
const STEPS_DEG: [f64; 3] = [2.5, 1.0, 0.5];
/// Resampling error as a part of the largest intensity.
const GOOD: f64 = 0.002;

impl Goniometer {
    fn name(self) -> &'static str {
        match self {
            Self::A => "type A",
            Self::B => "type B",
            Self::C => "type C",
        }
    }

    /// (horizontal, vertical) in degrees of a unit direction of the luminaire frame.
    /// A: γ = 90° + V, azimuth = −H. B: (sin V, −cos V sin H, −cos V cos H), IES LM-63 and CIE 121.
    fn angles_deg(self, direction: DVec3) -> (f64, f64) {
        match self {
            Self::A | Self::C => {
                let v = direction.z.clamp(-1.0, 1.0).asin();
                (-direction.y.atan2(direction.x).to_degrees(), v.to_degrees())
            }
            Self::B => {
                let v = direction.x.clamp(-1.0, 1.0).asin();
                ((-direction.y).atan2(-direction.z).to_degrees(), v.to_degrees())
            }
        }
    }
}

/// The measured grid; angles that start at 0 are mirrored.
struct Measured<'a> {
    goniometer: Goniometer,
    vertical_deg: Vec<f64>,
    planes: &'a [Plane],
}

impl Measured<'_> {
    /// Bilinear in the goniometer's own angles; 0 cd outside the measured range.
    fn cd(&self, direction: DVec3) -> f64 {
        // Type B ends at the horizon: its planes are half as wide as those of A and C.
        if self.goniometer == Goniometer::B && direction.z > 0.0 {
            return 0.0;
        }
        let (mut h, mut v) = self.goniometer.angles_deg(direction);
        if self.vertical_deg[0] >= 0.0 {
            v = v.abs();
        }
        if self.planes.len() > 1 && self.planes[0].angle_deg >= 0.0 {
            h = h.abs();
        }
        let Some((i, t)) = locate(&self.vertical_deg, |v| *v, v) else {
            return 0.0;
        };
        let along = |plane: &Plane| plane.cd[i] + t * (plane.cd[i + 1] - plane.cd[i]);
        if self.planes.len() == 1 {
            return along(&self.planes[0]);
        }
        let Some((j, s)) = locate(self.planes, |plane| plane.angle_deg, h) else {
            return 0.0;
        };
        let (here, next) = (along(&self.planes[j]), along(&self.planes[j + 1]));
        here + s * (next - here)
    }
}

fn locate<T>(values: &[T], angle: impl Fn(&T) -> f64, at: f64) -> Option<(usize, f64)> {
    const ROUNDING_DEG: f64 = 1e-9;
    let last = values.len() - 1;
    if !(at >= angle(&values[0]) - ROUNDING_DEG && at <= angle(&values[last]) + ROUNDING_DEG) {
        return None;
    }
    let cell = values.partition_point(|value| angle(value) <= at).clamp(1, last) - 1;
    let (from, to) = (angle(&values[cell]), angle(&values[cell + 1]));
    Some((cell, ((at - from) / (to - from)).clamp(0.0, 1.0)))
}

/// The distribution on a type C grid, and what resampling did to it.
pub(super) fn resampled(
    goniometer: Goniometer,
    vertical: &[Number],
    horizontal: &[Number],
    planes: &[Plane],
) -> Result<(IntensityDistribution, Vec<Finding>), Fault> {
    check_range(vertical, 90.0)?;
    check_range(horizontal, if goniometer == Goniometer::A { 180.0 } else { 90.0 })?;
    let line = horizontal[0].line;
    let vertical_deg = vertical.iter().map(|angle| angle.value).collect();
    let measured = Measured { goniometer, vertical_deg, planes };
    let fault = |error: DistributionError| Fault::new(line, error.to_string(), DAMAGED);
    let mut best = None;
    for step_deg in STEPS_DEG {
        let distribution = on_grid(&measured, step_deg).map_err(fault)?;
        let (error, flux_error) = errors(&measured, &distribution);
        best = Some((distribution, step_deg, error, flux_error));
        if error < GOOD {
            break;
        }
    }
    let (distribution, step_deg, error, flux_error) = best.expect("there is at least one step");
    let message = format!("{} photometry, resampled to type C in steps of {step_deg}°", goniometer.name());
    let consequence = format!(
        "intensities are kept within {:.2} % of the largest, the flux within {:.2} %",
        100.0 * error,
        100.0 * flux_error
    );
    let resampled = Finding::new("resampled", line, message, consequence);
    let cut = cut_off(goniometer, [vertical, horizontal], planes);
    Ok((distribution, std::iter::once(resampled).chain(cut).collect()))
}

/// Light at the edge of what was measured, as a part of the largest intensity, above which a beam is cut.
const CUT: f64 = 0.01;

/// A measured range that ends where the lamp still shines.
fn cut_off(
    goniometer: Goniometer,
    [vertical, horizontal]: [&[Number]; 2],
    planes: &[Plane],
) -> Option<Finding> {
    let largest = |cd: &mut dyn Iterator<Item = f64>| cd.fold(0.0, f64::max);
    let most = largest(&mut planes.iter().flat_map(|plane| plane.cd.iter().copied()));
    let around_deg = if goniometer == Goniometer::A { 180.0 } else { 90.0 };
    let last_gamma = vertical.len() - 1;
    let of_plane = |plane: &Plane| largest(&mut plane.cd.iter().copied());
    // A range from 0 on is mirrored, and a single plane turned about: no edge is there.
    let mut edges = Vec::new();
    let [low, high] = [vertical[0], vertical[last_gamma]];
    if low.value < 0.0 && low.value > -90.0 {
        edges.push((low, "V", largest(&mut planes.iter().map(|plane| plane.cd[0]))));
    }
    if high.value < 90.0 {
        edges.push((high, "V", largest(&mut planes.iter().map(|plane| plane.cd[last_gamma]))));
    }
    if let [first, .., last] = planes {
        let [low, high] = [horizontal[0], horizontal[horizontal.len() - 1]];
        if low.value < 0.0 && low.value > -around_deg {
            edges.push((low, "H", of_plane(first)));
        }
        if high.value < around_deg {
            edges.push((high, "H", of_plane(last)));
        }
    }
    let (angle, name, cd) = edges.into_iter().max_by(|a, b| a.2.total_cmp(&b.2))?;
    let message = format!("{name} ends at {}°", angle.value);
    let consequence = format!(
        "there the lamp still shines with {:.1} % of its largest intensity, and directions beyond are taken as dark: \
         flux and illuminance are too low",
        100.0 * cd / most
    );
    (cd > CUT * most).then(|| Finding::new("missing-range", angle.line, message, consequence))
}

fn check_range(angles: &[Number], limit_deg: f64) -> Result<(), Fault> {
    let (first, last) = (angles[0], angles[angles.len() - 1]);
    if first.value >= -limit_deg && last.value <= limit_deg {
        return Ok(());
    }
    let message = format!("angles run from {}° to {}°", first.value, last.value);
    let hint = "types A and B count from −90° to 90° vertically; the file's type may be wrong";
    Err(Fault::new(first.line, message, hint))
}

fn direction(azimuth_deg: f64, gamma_deg: f64) -> DVec3 {
    let (sin, cos) = gamma_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    DVec3::new(sin * cos_a, sin * sin_a, -cos)
}

fn on_grid(measured: &Measured, step_deg: f64) -> Result<IntensityDistribution, DistributionError> {
    let count = (360.0 / step_deg).round() as usize;
    let azimuths: Vec<f64> = (0..=count).map(|k| k as f64 * step_deg).collect();
    // B never looks up: beyond the horizon is dark by the end of the table, not by a slope.
    let last = if measured.goniometer == Goniometer::B { count / 4 } else { count / 2 };
    let gammas: Vec<f64> = (0..=last).map(|k| k as f64 * step_deg).collect();
    let plane = |azimuth: f64| gammas.iter().map(|gamma| measured.cd(direction(azimuth, *gamma))).collect();
    let mut cd: Vec<Vec<f64>> = azimuths[..count].iter().map(|azimuth| plane(*azimuth)).collect();
    cd.push(cd[0].clone());
    IntensityDistribution::from_grid(azimuths, gammas, cd)
}

/// Largest difference as a part of the largest intensity, and the flux's, both at the grid's own
/// cell centres, where interpolation is worst.
fn errors(measured: &Measured, distribution: &IntensityDistribution) -> (f64, f64) {
    const STEP_DEG: f64 = 1.25;
    let (mut widest, mut true_lm, mut kept_lm) = (0.0_f64, 0.0, 0.0);
    for i in 0..144 {
        let gamma = STEP_DEG * (f64::from(i) + 0.5);
        let ring = TAU * gamma.to_radians().sin() * STEP_DEG.to_radians() / 288.0;
        for j in 0..288 {
            let azimuth = STEP_DEG * (f64::from(j) + 0.5);
            let (truth, kept) =
                (measured.cd(direction(azimuth, gamma)), distribution.intensity_at(azimuth, gamma));
            widest = widest.max((truth - kept).abs());
            true_lm += truth * ring;
            kept_lm += kept * ring;
        }
    }
    let peak = distribution.max_intensity().0;
    let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
    (share(widest, peak), share((kept_lm - true_lm).abs(), true_lm))
}

#[cfg(test)]
mod tests {
    use super::super::parse;
    use super::*;

    /// A smooth beam towards (H, V) = (20, 10), so that no symmetry hides a wrong sign.
    fn file(kind: u8) -> String {
        let angles: Vec<f64> = (-18..=18).map(|k| 5.0 * f64::from(k)).collect();
        let list = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        let mut text = format!(
            "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 37 37 {kind} 2 0.1 0.1 0\n1 1 50\n{0}\n{0}\n",
            list(&angles)
        );
        for h in &angles {
            let plane: Vec<f64> = angles
                .iter()
                .map(|v| 1000.0 * (-((h - 20.0).powi(2) + (v - 10.0).powi(2)) / 800.0).exp())
                .collect();
            text.push_str(&(list(&plane) + "\n"));
        }
        text
    }

    fn at(kind: u8, toward: DVec3) -> f64 {
        let lamp = parse(file(kind).as_bytes(), "x.ies").expect("sound");
        assert!(lamp.findings.iter().any(|finding| finding.code == "resampled"));
        lamp.distribution.intensity_along(toward.normalize())
    }

    /// Catches: type B read as C, its axes exchanged, horizontal angles counted the other way.
    #[test]
    fn beams_point_where_they_were_measured() {
        let [sin_h, cos_h] = [20_f64.to_radians().sin(), 20_f64.to_radians().cos()];
        let [sin_v, cos_v] = [10_f64.to_radians().sin(), 10_f64.to_radians().cos()];
        let b = DVec3::new(sin_v, -cos_v * sin_h, -cos_v * cos_h);
        assert!((at(2, b) - 1000.0).abs() < 5.0, "{}", at(2, b));
        assert!(at(2, DVec3::new(b.x, -b.y, b.z)) < 200.0);
        let a = DVec3::new(cos_v * cos_h, -cos_v * sin_h, sin_v);
        assert!((at(3, a) - 1000.0).abs() < 5.0, "{}", at(3, a));
        assert!(at(3, DVec3::new(a.x, -a.y, a.z)) < 200.0);
    }

    /// Catches: flux lost at the seam or counted with the wrong Jacobian: for type B
    /// Φ = ∫∫ I cosV dV dH.
    #[test]
    fn flux_is_that_of_the_measurement() {
        let lamp = parse(file(2).as_bytes(), "x.ies").expect("sound");
        let (mut flux, step) = (0.0, 0.5_f64.to_radians());
        for i in -180..180 {
            for j in -180..180 {
                let (h, v) = (0.5 * (f64::from(i) + 0.5), 0.5 * (f64::from(j) + 0.5));
                let cd = 1000.0 * (-((h - 20.0).powi(2) + (v - 10.0).powi(2)) / 800.0).exp();
                flux += cd * v.to_radians().cos() * step * step;
            }
        }
        let found = lamp.distribution.flux().0;
        // 5° steps of the file itself cost about 0.5 %.
        assert!((found / flux - 1.0).abs() < 0.01, "{found} lm, expected {flux}");
    }

    /// Catches: a single plane of type B carried on above the horizon: half of the flux would be missing.
    #[test]
    fn type_b_never_looks_up() {
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 2 2 0.1 0.1 0\n1 1 50\n-90 0 90\n0\n0 500 0\n";
        let lamp = parse(text.as_bytes(), "x.ies").expect("sound");
        let told = lamp.findings.iter().find(|finding| finding.code == "resampled").expect("told");
        assert!(told.consequence.contains("the flux within 0."), "{told:?}");
        assert!(lamp.distribution.intensity_along(DVec3::new(0.0, 0.6, 0.8)) < 1e-9);
    }

    /// Catches: files that start at 0° read as a quarter of the beam.
    #[test]
    fn half_ranges_are_mirrored() {
        let text = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 3 2 2 0.1 0.1 0\n1 1 50\n0 45 90\n0 45 90\n\
                    900 400 0\n500 200 0\n0 0 0\n";
        let lamp = parse(text.as_bytes(), "x.ies").expect("sound");
        let cd = |x: f64, y: f64| lamp.distribution.intensity_along(DVec3::new(x, y, -1.0).normalize());
        for (x, y, expected) in [(1.0, 0.0, 400.0), (-1.0, 0.0, 400.0), (0.0, 1.0, 500.0), (0.0, -1.0, 500.0)]
        {
            assert!((cd(x, y) - expected).abs() < 5.0, "{}", cd(x, y));
        }
        let wrong = text.replace("0 45 90\n0 45 90", "0 45 120\n0 45 90");
        assert!(parse(wrong.as_bytes(), "x.ies").is_err());
    }
}
