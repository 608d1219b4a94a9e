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

#[cfg(test)]
mod tests {
    use super::*;

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
