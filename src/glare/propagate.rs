//! Standard error of any index by the delta method: its inputs' errors, declared here, times its
//! derivatives. L_b and E_v share the indirect light, so the inputs are not they but what they are
//! made of: E_i, and the light and solid angle of each source.

use super::source::{GlareSource, Sight};
use crate::units::{Nits, Undefined};

/// Relative step of the difference quotients.
const STEP: f64 = 1e-4;

/// Standard errors of what a view is made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SightError {
    /// Of E_i, lx; it moves E_v by as much and L_b by 1/π of it.
    pub e_indirect_lx: f64,
    /// Of E_dir, lx, where it was estimated on its own; it moves E_v by as much. `None`: E_dir is what the
    /// sources add up to, and moves with them.
    pub e_direct_lx: Option<f64>,
    /// Of every source, in the order of the view.
    pub sources: Vec<SourceError>,
}

/// Relative standard errors of one source.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SourceError {
    /// Of ∫ L dω: luminance, intensity, illuminance at the eye.
    pub light: f64,
    /// Of ω at the same light: a larger ω means a lower luminance.
    pub solid_angle: f64,
}

/// Standard error of an index of first order. Sources and indirect light are independent; the two
/// errors of a source come from the same rays, so their effects are added, which no correlation
/// between them can exceed.
///
/// # Errors
/// The index is undefined here or next to here.
pub fn standard_error(
    index: impl Fn(&Sight) -> Result<f64, Undefined>,
    sight: &Sight,
    error: &SightError,
) -> Result<f64, Undefined> {
    let mut changed = sight.clone();
    let mut slope = |change: &dyn Fn(&mut Sight, f64), touched: Option<usize>, step: f64| {
        let mut at = |step: f64| {
            change(&mut changed, step);
            let value = index(&changed);
            changed.e_v_lx = sight.e_v_lx;
            changed.e_direct_lx = sight.e_direct_lx;
            changed.background = sight.background;
            if let Some(position) = touched {
                changed.sources[position] = sight.sources[position];
            }
            value
        };
        Ok::<f64, Undefined>((at(step)? - at(-step)?).abs() / (2.0 * step))
    };
    let mut variance = 0.0;
    if error.e_indirect_lx > 0.0 {
        let per_lx = slope(
            &|sight, step_lx| {
                sight.e_v_lx += step_lx;
                sight.background = Nits(sight.background.0 + step_lx / std::f64::consts::PI);
            },
            None,
            STEP * sight.e_indirect_lx().abs(),
        )?;
        variance += (per_lx * error.e_indirect_lx).powi(2);
    }
    if let Some(se_lx) = error.e_direct_lx.filter(|se_lx| *se_lx > 0.0) {
        let per_lx = slope(
            &|sight, step_lx| {
                sight.e_v_lx += step_lx;
                sight.e_direct_lx += step_lx;
            },
            None,
            STEP * sight.e_v_lx.abs(),
        )?;
        variance += (per_lx * se_lx).powi(2);
    }
    let own = error.e_direct_lx.is_some();
    for (position, source) in error.sources.iter().enumerate() {
        let mut effects = 0.0;
        if source.light > 0.0 {
            let by_share = slope(&|sight, step| brighten(sight, position, step, own), Some(position), STEP)?;
            effects += source.light * by_share;
        }
        if source.solid_angle > 0.0 {
            let change = |sight: &mut Sight, step| widen(&mut sight.sources[position], step);
            effects += source.solid_angle * slope(&change, Some(position), STEP)?;
        }
        variance += effects * effects;
    }
    Ok(variance.sqrt())
}

/// More light from a source of the same size; E_dir is left alone where it was estimated on its own.
fn brighten(sight: &mut Sight, position: usize, step: f64, own_direct: bool) {
    let source = &mut sight.sources[position];
    let added_lx = source.eye_lx * step;
    source.luminance = source.luminance * (1.0 + step);
    source.eye_lx += added_lx;
    if let Some(extent) = &mut source.extent {
        extent.intensity_cd *= 1.0 + step;
    }
    if !own_direct {
        sight.e_v_lx += added_lx;
        sight.e_direct_lx += added_lx;
    }
}

/// A larger solid angle with the same light.
fn widen(source: &mut GlareSource, step: f64) {
    source.solid_angle_sr *= 1.0 + step;
    source.luminance = source.luminance * (1.0 / (1.0 + step));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::glare::index::{INDICES, parse};
    use crate::rng::Rng;

    /// Two sources under 250 lx of indirect light, 80 cd/m² background.
    fn view(light: [f64; 2], size: [f64; 2], indirect_lx: f64) -> Sight {
        let cos = [0.9, 0.8];
        let source = |i: usize| {
            let solid_angle_sr = [0.01, 0.03][i] * size[i];
            let luminance = [5000.0, 1500.0][i] * light[i] / size[i];
            GlareSource {
                luminance: Nits(luminance),
                solid_angle_sr,
                position_index: [1.8, 3.0][i],
                off_axis_deg: f64::acos(cos[i]).to_degrees(),
                eye_lx: luminance * solid_angle_sr * cos[i],
                extent: None,
            }
        };
        let sources = vec![source(0), source(1)];
        let e_direct_lx = sources.iter().map(|source| source.eye_lx).sum();
        Sight {
            sources,
            e_v_lx: e_direct_lx + indirect_lx,
            e_direct_lx,
            background: Nits(indirect_lx / std::f64::consts::PI),
            mean: Some(Nits(120.0)),
            ..Sight::default()
        }
    }

    #[test]
    fn ugr_moves_as_the_method_says() {
        // 0.0347 per 1 % of E_i, 0.0695 per 1 % of one source's light. Catches a wrong derivative.
        let sight = view([1.0; 2], [1.0; 2], 250.0);
        let ugr = parse("UGR").unwrap().value;
        let error = SightError { e_indirect_lx: 2.5, ..SightError::default() };
        let se = standard_error(ugr, &sight, &error).unwrap();
        assert!((se - 0.08 / std::f64::consts::LN_10).abs() < 1e-6, "{se}");
        let mut single = sight.clone();
        single.sources.truncate(1);
        let light = SourceError { light: 0.01, solid_angle: 0.0 };
        let se = standard_error(ugr, &single, &SightError { sources: vec![light], ..SightError::default() })
            .unwrap();
        assert!((se - 0.16 / std::f64::consts::LN_10).abs() < 1e-6, "{se}");
        let size = SourceError { light: 0.0, solid_angle: 0.01 };
        let se = standard_error(ugr, &single, &SightError { sources: vec![size], ..SightError::default() })
            .unwrap();
        assert!((se - 0.08 / std::f64::consts::LN_10).abs() < 1e-6, "{se}");
    }

    #[test]
    fn every_index_spreads_as_its_error_says() {
        // Inputs drawn with their errors: the spread of the index is the error of first order. Catches
        // an input that is not moved, moved twice, or E_v that forgets the indirect light.
        let relative = [0.01, 0.02];
        let error = SightError {
            e_indirect_lx: 4.0,
            e_direct_lx: None,
            sources: relative.map(|light| SourceError { light, solid_angle: 0.0 }).to_vec(),
        };
        let sight = view([1.0; 2], [1.0; 2], 250.0);
        for index in INDICES {
            let Ok(se) = standard_error(index.value, &sight, &error) else { continue };
            let mut rng = Rng::new(3, 0, 0);
            let mut normal = || (0..12).map(|_| rng.uniform()).sum::<f64>() - 6.0;
            let drawn: Vec<f64> = (0..4000)
                .map(|_| {
                    let light = relative.map(|relative| 1.0 + relative * normal());
                    (index.value)(&view(light, [1.0; 2], 250.0 + 4.0 * normal())).unwrap()
                })
                .collect();
            let mean = drawn.iter().sum::<f64>() / 4000.0;
            let spread = (drawn.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 3999.0).sqrt();
            if index.key == "L_mean" {
                assert!(se.abs() < 1e-12, "a given mean has no error");
                continue;
            }
            // 4000 draws know a spread within 1.1 %; 5 sigma and the second order.
            assert!((spread / se - 1.0).abs() < 0.07, "{}: {spread} against {se}", index.key);
        }
    }
}
