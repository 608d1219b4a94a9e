//! Luminance of red, green and blue. Which share each has depends on the primaries' chromaticities.

use glam::DVec3;

/// lm/W by which Radiance's pictures are made photometric.
pub(super) const RADIANCE_LM_PER_W: f64 = 179.0;
/// Shares of Radiance's own primaries.
pub(super) const RADIANCE: [f64; 3] = [0.265, 0.670, 0.065];
/// Shares of Rec. 709, the default of OpenEXR.
pub(super) const REC_709: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Shares of luminance of primaries at chromaticities `[red, green, blue, white]` (x, y): the amounts
/// a of the primaries that together make white, Σ a_i (x_i, y_i, z_i) = white with Y = 1, give the
/// luminances a_i y_i. `None` if the three do not span a plane.
pub(super) fn shares(chromaticities: [[f64; 2]; 4]) -> Option<[f64; 3]> {
    let [red, green, blue, white] = chromaticities.map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
    let white = white / white.y;
    let determinant = red.dot(green.cross(blue));
    if !(determinant.abs() > 1e-9 && white.is_finite()) {
        return None;
    }
    let solved = [
        white.dot(green.cross(blue)) / determinant * red.y,
        red.dot(white.cross(blue)) / determinant * green.y,
        red.dot(green.cross(white)) / determinant * blue.y,
    ];
    solved.iter().all(|share| *share >= 0.0).then_some(solved)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches: a matrix transposed, white taken as D65 where it is equal energy.
    #[test]
    fn known_primaries_have_their_known_shares() {
        let near = |a: [f64; 3], b: [f64; 3], tolerance: f64| {
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance)
        };
        let rec_709 = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];
        assert!(near(shares(rec_709).expect("a triangle"), REC_709, 1e-4));
        let radiance = [[0.640, 0.330], [0.290, 0.600], [0.150, 0.060], [1.0 / 3.0, 1.0 / 3.0]];
        assert!(near(shares(radiance).expect("a triangle"), RADIANCE, 1e-3));
        assert!(!near(shares(radiance).expect("a triangle"), REC_709, 1e-2));
        assert_eq!(shares([[0.3, 0.3], [0.4, 0.4], [0.5, 0.5], [0.33, 0.33]]), None);
        // The axes of XYZ themselves: only Y shines.
        let axes = shares([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]]);
        assert!(near(axes.expect("a triangle"), [0.0, 1.0, 0.0], 1e-12));
    }
}
