//! Directions: frames and samplers on the sphere. All samplers take uniform numbers in [0, 1).

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

/// A right-handed frame whose z axis is the unit vector `axis` (Duff et al. 2017, JCGT 6(1)).
pub fn frame(axis: DVec3) -> DMat3 {
    let sign = 1f64.copysign(axis.z);
    let a = -1.0 / (sign + axis.z);
    let b = axis.x * axis.y * a;
    DMat3::from_cols(
        DVec3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
        DVec3::new(b, sign + axis.y * axis.y * a, -axis.y),
        axis,
    )
}

/// Direction about +z with density cos θ / π.
pub fn cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let radius = u[0].sqrt();
    let (sin, cos) = (2.0 * PI * u[1]).sin_cos();
    DVec3::new(radius * cos, radius * sin, (1.0 - u[0]).max(0.0).sqrt())
}

/// Direction with density 1 / 4π.
pub fn uniform_sphere(u: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * u[0];
    let radius = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (2.0 * PI * u[1]).sin_cos();
    DVec3::new(radius * cos, radius * sin, z)
}

/// Unit direction with `azimuth_deg` from +x towards +y and `tilt_deg` above the horizon.
pub fn from_azimuth_tilt(azimuth_deg: f64, tilt_deg: f64) -> DVec3 {
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    let (sin_t, cos_t) = tilt_deg.to_radians().sin_cos();
    DVec3::new(cos_t * cos_a, cos_t * sin_a, sin_t)
}

/// Azimuth from +x towards +y and tilt above the horizon of a unit direction, degrees, rounded to 1e-9, so that
/// what was written as 30 is 30 again.
pub fn azimuth_tilt_deg(direction: DVec3) -> [f64; 2] {
    let tilt = direction.z.clamp(-1.0, 1.0).asin();
    [direction.y.atan2(direction.x), tilt].map(|angle| rounded_deg(angle.to_degrees()))
}

/// An angle to 1e-9 degrees, without a minus before a zero.
pub fn rounded_deg(angle_deg: f64) -> f64 {
    (angle_deg * 1e9).round() / 1e9 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: 29.999999999999996° and −0°.
    #[test]
    fn round_angles_come_back_round() {
        for azimuth_deg in (-179..=180).map(f64::from) {
            for tilt_deg in [-60.0, -30.0, 0.0, 0.1, 12.5, 30.0, 45.0] {
                let found = azimuth_tilt_deg(from_azimuth_tilt(azimuth_deg, tilt_deg));
                assert_eq!(found.map(f64::to_bits), [azimuth_deg, tilt_deg].map(|x| (x + 0.0).to_bits()));
            }
        }
    }

    #[test]
    fn frames_are_right_handed_and_orthonormal() {
        for axis in [DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::new(1.0, 2.0, -3.0).normalize()] {
            let m = frame(axis);
            assert!((m.determinant() - 1.0).abs() < 1e-12);
            assert!((m * m.transpose() - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-12));
            assert!((m * DVec3::Z - axis).length() < 1e-12);
        }
    }
}
