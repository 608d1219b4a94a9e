//! Unified glare rating. The background luminance belongs to the *indirect vertical* illuminance at
//! the eye (L_b = E_i/π): with the sources' own light in it the index comes out low.

use super::source::{ALL_OFF_TABLE, Extent, GlareSource, NO_SOURCE, positioned_sum, positive, square};
use crate::units::{Nits, Undefined};

/// Below this projected area (m²) UGR weights the intensity instead of the luminance, CIE 147.
pub const SMALL_SOURCE_M2: f64 = 0.005;

/// Above this projected area (m²) a source is large and UGR understates it, CIE 147.
pub const LARGE_SOURCE_M2: f64 = 1.5;

/// Solid angles (sr) for which UGR was fitted.
pub const VALID_SOLID_ANGLE_SR: [f64; 2] = [3e-4, 0.1];

/// UGR = 8 lg(0.25/L_b · Σ L²ω/P²), CIE 117:1995; L²ω is replaced by 200 I²/r² for sources with
/// less than 0.005 m² of projected area, CIE 147. Initial flux, no maintenance factor. Sources off the table
/// of position indices are left out, as the method has it.
///
/// # Errors
/// No source shines, the background is not positive, or a source is no physical one.
pub fn ugr(sources: &[GlareSource], background: Nits) -> Result<f64, Undefined> {
    index(sources, background, |source| match source.extent {
        Some(extent) if is_small(source) => {
            let per_distance = extent.intensity_cd / extent.distance_m;
            Ok(200.0 * per_distance * per_distance)
        }
        Some(_) | None => square(source),
    })
}

/// Whether UGR takes a source by its intensity. One that fills much of the view is no small one, however
/// little of it is projected: a luminous ceiling right over the eye is seen on edge.
fn is_small(source: &GlareSource) -> bool {
    let [_, largest] = VALID_SOLID_ANGLE_SR;
    let of_small_area = |extent: Extent| extent.projected_area_m2 < SMALL_SOURCE_M2;
    source.extent.is_some_and(of_small_area) && !(source.solid_angle_sr > largest)
}

/// UGR = 8 lg(0.25/L_b · Σ L²ω/P²) for sources of any size, as the tables of CIE 190 take it.
///
/// # Errors
/// As for [`ugr`].
pub fn ugr_by_luminance(sources: &[GlareSource], background: Nits) -> Result<f64, Undefined> {
    index(sources, background, square)
}

/// 8 lg(0.25/L_b · Σ term/P²).
fn index(
    sources: &[GlareSource],
    background: Nits,
    term: impl Fn(&GlareSource) -> Result<f64, Undefined>,
) -> Result<f64, Undefined> {
    let counts = |source: &GlareSource| {
        if source.is_off_table() { Ok(0.0) } else { Ok(source.ugr_share * term(source)?) }
    };
    let sum = positioned_sum(sources, 2, counts).map_err(|undefined| {
        let ignored = sources.iter().any(|source| source.is_off_table() && source.eye_lx > 0.0);
        if ignored && undefined.reason == NO_SOURCE { Undefined::because(ALL_OFF_TABLE) } else { undefined }
    })?;
    let background = positive(background.0, "the background luminance is not positive")?;
    Ok(8.0 * (0.25 / background * sum).log10())
}

/// What makes UGR doubtful for these sources, one note per reason; the index is computed all the same.
pub fn validity(sources: &[GlareSource]) -> Vec<String> {
    let [smallest, largest] = VALID_SOLID_ANGLE_SR;
    let area_m2 = |source: &GlareSource| source.extent.map(|extent| extent.projected_area_m2);
    let of_ordinary_size = |source: &&GlareSource| !is_small(source);
    let count = |is: &dyn Fn(&GlareSource) -> bool| {
        let counted = sources.iter().filter(|source| !source.is_off_table()).filter(of_ordinary_size);
        counted.filter(|source| is(source)).count()
    };
    [
        (
            count(&|source| source.solid_angle_sr < smallest),
            format!("seen under less than {smallest} sr, where UGR is not validated"),
        ),
        (
            count(&|source| source.solid_angle_sr > largest),
            format!("seen under more than {largest} sr, where UGR is not validated"),
        ),
        (
            count(&|source| area_m2(source).is_some_and(|area_m2| area_m2 > LARGE_SOURCE_M2)),
            format!("with more than {LARGE_SOURCE_M2} m² of projected area, which UGR understates"),
        ),
    ]
    .into_iter()
    .filter(|(sources, _)| *sources > 0)
    .map(|(sources, reason)| format!("{sources} source(s) {reason}"))
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(luminance: f64, solid_angle_sr: f64, position_index: f64) -> GlareSource {
        let distance_m: f64 = 3.0;
        let projected_area_m2 = solid_angle_sr * distance_m * distance_m;
        GlareSource {
            luminance: Nits(luminance),
            solid_angle_sr,
            position_index,
            ugr_share: 1.0,
            off_axis_deg: 20.0,
            eye_lx: luminance * solid_angle_sr * 0.94,
            extent: Some(Extent {
                projected_area_m2,
                intensity_cd: luminance * projected_area_m2,
                distance_m,
            }),
        }
    }

    #[test]
    fn one_panel_by_hand() {
        // 0.25/20 · 2000²·0.01/2² = 125; 8 lg 125 = 16.7753. Catches P unsquared and 0.25 forgotten.
        let index = ugr(&[panel(2000.0, 0.01, 2.0)], Nits(20.0)).unwrap();
        assert!((index - 16.775_280_104).abs() < 1e-8, "{index}");
    }

    #[test]
    fn ugr_follows_the_flux_and_the_number_of_sources() {
        // Halving all light lowers UGR by 8 lg 2; doubling the sources raises it as much. Catches a
        // wrong power of L or L_b.
        let [bright, dim] = [2000.0, 1000.0].map(|luminance| panel(luminance, 0.01, 2.0));
        let step = 8.0 * 2f64.log10();
        let whole = ugr(&[bright], Nits(20.0)).unwrap();
        assert!((whole - ugr(&[dim], Nits(10.0)).unwrap() - step).abs() < 1e-12);
        assert!((ugr(&[bright, bright], Nits(20.0)).unwrap() - whole - step).abs() < 1e-12);
        assert!((step - 2.408).abs() < 5e-4);
    }

    #[test]
    fn a_small_source_counts_by_its_intensity() {
        // At exactly 0.005 m² both forms agree: L²ω = I²/(A r²) = 200 I²/r². Catches a jump at the border.
        let mut source = panel(1e5, 0.005 / 9.0, 1.5);
        let sized = |area_m2| Some(Extent { projected_area_m2: area_m2, ..source.extent.unwrap() });
        let [at_border, below] = [0.005, 0.004_999].map(sized);
        source.extent = at_border;
        let ordinary = ugr(&[source], Nits(10.0)).unwrap();
        source.extent = below;
        assert!((ugr(&[source], Nits(10.0)).unwrap() - ordinary).abs() < 1e-9);
        // Smaller still, at the same intensity: the luminance soars, the index stays.
        source.luminance = Nits(1e7);
        assert!((ugr(&[source], Nits(10.0)).unwrap() - ordinary).abs() < 1e-9);
    }

    /// Catches: a luminous ceiling right over the eye, whose projected area is next to nothing, weighed as a point.
    #[test]
    fn what_fills_the_view_is_no_small_source() {
        let mut source = panel(1500.0, 3.0, 2.0);
        source.extent = source.extent.map(|extent| Extent { projected_area_m2: 0.001, ..extent });
        let by_luminance = ugr_by_luminance(&[source], Nits(100.0)).unwrap();
        assert!((ugr(&[source], Nits(100.0)).unwrap() - by_luminance).abs() < 1e-12);
        assert_eq!(validity(&[source]).len(), 1, "and it is told that it is large");
        source.solid_angle_sr = 0.01;
        assert!((ugr(&[source], Nits(100.0)).unwrap() - by_luminance).abs() > 1.0, "a small one is");
    }

    /// Catches: a source of which a part lies off the table counted whole, or not at all.
    #[test]
    fn ugr_counts_the_share_of_a_source_that_its_table_knows() {
        let whole = panel(2000.0, 0.01, 2.0);
        let half = GlareSource { ugr_share: 0.5, ..whole };
        let drop = ugr(&[whole], Nits(20.0)).unwrap() - ugr(&[half], Nits(20.0)).unwrap();
        assert!((drop - 8.0 * 2f64.log10()).abs() < 1e-12, "{drop}");
        let none = GlareSource { ugr_share: 0.0, ..whole };
        assert_eq!(ugr(&[none], Nits(20.0)).unwrap_err().reason, ALL_OFF_TABLE);
    }

    #[test]
    fn without_a_source_or_a_background_there_is_no_index() {
        let source = panel(2000.0, 0.01, 2.0);
        let reason = |sources: &[GlareSource], background| ugr(sources, Nits(background)).unwrap_err().reason;
        assert_eq!(reason(&[], 20.0), "no light source is visible");
        assert_eq!(reason(&[panel(0.0, 0.01, 2.0)], 20.0), "no light source is visible");
        for background in [0.0, -1.0, f64::NAN] {
            assert!(reason(&[source], background).contains("background"));
        }
        assert!(reason(&[panel(f64::NAN, 0.01, 2.0)], 20.0).contains("luminance"));
        assert!(reason(&[panel(2000.0, 0.01, 0.0)], 20.0).contains("position index"));
    }

    #[test]
    fn doubtful_sources_are_named_and_sound_ones_are_not() {
        assert!(validity(&[panel(2000.0, 0.01, 2.0)]).is_empty());
        let notes = validity(&[panel(2000.0, 0.2, 2.0), panel(2000.0, 1e-3, 2.0)]);
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert!(notes[0].contains("0.1 sr") && notes[1].contains("1.5 m²"), "{notes:?}");
    }
}
